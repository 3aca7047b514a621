"""Robots that are drawn below each other, from above."""

import numpy as np
import pytest
import xarray as xr

from suchus.experiments.catalog.displacement.figure import _width


@pytest.mark.parametrize(("aside", "wide"), [(0.05, 0.19), (0.129, 0.19), (0.131, 0.191), (0.5, 0.56)])
def test_strips_are_as_far_apart_as_their_feet_reach(aside, wide):
    """The usual distance holds as long as the farthest foot with its toes lies within it."""
    feet = np.zeros((2, 3, 4, 3))
    feet[1, 2, 3, 1] = -aside
    shown = xr.Dataset({"foot_position": (("run", "time", "leg", "xyz"), feet)}, {"xyz": list("xyz")})
    assert _width(shown, 1.0) == pytest.approx(wide)
    assert _width(shown.isel(leg=slice(0)), 0.5) == pytest.approx(0.095)  # no legs
