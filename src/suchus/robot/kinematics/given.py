"""Validation of the arguments of closed forms: arrays of finite numbers of the right shape."""

from typing import Any

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.core.kinds import show


def numbers(values: Any, label: str, *, finite: bool = True) -> np.ndarray:
    """Return numbers as an array in double precision.

    Args:
        values: a number, or an array of any shape.
        label: what they are, for the message.
        finite: whether those that are not finite are refused.

    Raises:
        InvalidDesign: they are no numbers, or one of them is not finite.
    """
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidDesign(f"{label} is {show(values)}; a number or an array of numbers is needed.") from error
    if finite and not np.isfinite(array).all():
        bad = array[~np.isfinite(array)].flat[0]
        raise InvalidDesign(f"{label} holds {bad}; finite numbers are needed.")
    return array


def check_sign(value: Any, label: str) -> None:
    """Refuse what is neither 1 nor -1.

    Raises:
        InvalidDesign: it is something else, or several.
    """
    if not (isinstance(value, int) and value in (1, -1)):
        raise InvalidDesign(f"{label} is {show(value)}; 1 or -1 is allowed.")


def number(value: Any, label: str) -> float:
    """Return one finite number.

    Raises:
        InvalidDesign: it is none, or more than one.
    """
    array = numbers(value, label)
    if array.ndim:
        raise InvalidDesign(f"{label} has the shape {array.shape}; a single number is needed.")
    return float(array)


def broadcast_to_shape(values: Any, shape: tuple[int, ...], label: str) -> np.ndarray:
    """Return finite numbers broadcast to a shape.

    Raises:
        InvalidDesign: they are no numbers, one of them is not finite, or there are more or fewer than can be.
    """
    array = numbers(values, label)
    try:
        return np.broadcast_to(array, shape)
    except ValueError as error:
        raise InvalidDesign(f"{label} has the shape {array.shape}; one number, or {shape}, is needed.") from error


def check_broadcast(*arrays: np.ndarray, label: str) -> None:
    """Refuse arrays that do not broadcast against each other.

    Raises:
        InvalidDesign: naming their shapes.
    """
    try:
        np.broadcast_shapes(*(array.shape for array in arrays))
    except ValueError as error:
        shapes = ", ".join(str(array.shape) for array in arrays)
        raise InvalidDesign(f"{label} have the shapes {shapes}, which do not go together; give one each.") from error


def rows(values: Any, count: int, label: str) -> np.ndarray:
    """Return an array whose last axis has so many numbers; those that are not finite pass.

    Args:
        values: shape (..., count).
        count: how many numbers one row has.
        label: what they are, for the message.

    Raises:
        InvalidDesign: they are no numbers, or of another shape.
    """
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidDesign(f"{label} is {show(values)}; an array of numbers is needed.") from error
    if array.ndim == 0 or array.shape[-1] != count:
        raise InvalidDesign(f"{label} has the shape {array.shape}; {count} numbers are needed along the last axis.")
    return array
