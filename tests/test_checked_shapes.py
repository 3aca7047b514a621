"""Shapes of arrays are checked in the tests, whichever version of jaxtyping is there."""

import numpy as np
import pytest
from jaxtyping import TypeCheckError

from suchus.kinematics.body import from_leg_frame


def test_an_array_of_another_shape_is_refused():
    assert from_leg_frame(np.zeros((2, 3)), "LF").shape == (2, 3)
    with pytest.raises(TypeCheckError, match="point"):
        from_leg_frame(np.zeros((2, 4)), "LF")
