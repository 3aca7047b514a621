"""Shapes of arrays are checked in the tests, whichever version of jaxtyping is there."""

import numpy as np
import pytest
from jaxtyping import TypeCheckError

import first_calls
from suchus.kinematics.body import from_leg_frame


def test_an_array_of_another_shape_is_refused():
    assert from_leg_frame(np.zeros((2, 3)), "LF").shape == (2, 3)
    with pytest.raises(TypeCheckError, match="point"):
        from_leg_frame(np.zeros((2, 4)), "LF")


def refused():
    try:
        from_leg_frame(np.zeros((2, 4)), "LF")
    except TypeCheckError:
        return True
    except ValueError:  # what numpy says of it
        return False
    return False


def test_only_the_first_calls_of_a_test_are_looked_at():
    for _ in range(first_calls.CALLS // 2 - 1):
        from_leg_frame(np.zeros((2, 3)), "LF")
    assert refused()
    for _ in range(first_calls.CALLS):
        from_leg_frame(np.zeros((2, 3)), "LF")
    assert not refused()
    first_calls.begin()
    assert refused()
