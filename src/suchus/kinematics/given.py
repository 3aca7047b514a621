"""What is given to the closed forms: arrays of finite numbers of the right shape, or a sentence that says otherwise."""

from typing import Any

import numpy as np

from suchus.errors import InvalidDesign
from suchus.kinds import show


def numbers(values: Any, what: str) -> np.ndarray:
    """Return numbers as an array in double precision.

    Args:
        values: a number, or an array of any shape.
        what: what they are, for the message.

    Raises:
        InvalidDesign: they are no numbers, or one of them is not finite.
    """
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidDesign(f"{what} is {show(values)}; a number or an array of numbers is needed.") from error
    if not np.isfinite(array).all():
        bad = array[~np.isfinite(array)].flat[0]
        raise InvalidDesign(f"{what} holds {bad}; finite numbers are needed.")
    return array


def rows(values: Any, count: int, what: str) -> np.ndarray:
    """Return an array whose last axis has so many numbers; those that are not finite pass.

    Args:
        values: shape (..., count).
        count: how many numbers one row has.
        what: what they are, for the message.

    Raises:
        InvalidDesign: they are no numbers, or of another shape.
    """
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidDesign(f"{what} is {show(values)}; an array of numbers is needed.") from error
    if array.ndim == 0 or array.shape[-1] != count:
        raise InvalidDesign(f"{what} has the shape {array.shape}; {count} numbers are needed along the last axis.")
    return array
