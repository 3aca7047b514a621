"""Slip: sliding of the point at which a foot touches the ground, without the rolling of its ball."""

import numpy as np
import pytest
import xarray as xr

from suchus.core import rotation
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import crawl
from suchus.sim.land.readings import rolling_displacement
from suchus.sim.metrics import slip
from suchus.sim.metrics.contact import contact_path

RADIUS = 0.02


def turns(axis, angles):
    """Return quaternions of a ball that turns about an axis, shape (run, time, limb, 4)."""
    return np.array([rotation.from_axis_angle(np.array(axis), angle) for angle in angles])[None, :, None]


@pytest.mark.parametrize(
    ("axis", "way"), [((0.0, 1.0, 0.0), (1, 0, 0)), ((1.0, 0.0, 0.0), (0, -1, 0)), ((0.0, 0.0, 1.0), (0, 0, 0))]
)
def test_a_ball_rolls_by_its_angle_times_its_radius(axis, way):
    angles = np.linspace(0.0, 5.0, 40)  # beyond a turn, where a quaternion changes its sign
    rolled = rolling_displacement(turns(axis, angles), np.array([[RADIUS]]))[0, :, 0]
    assert rolled == pytest.approx(RADIUS * angles[:, None] * np.array(way), abs=1e-12)
    signs = np.where(np.arange(40) % 2, 1.0, -1.0)[None, :, None, None]
    flipped = rolling_displacement(signs * turns(axis, angles), np.array([[RADIUS]]))[0, :, 0]
    assert flipped == pytest.approx(rolled, abs=1e-12)


def test_a_gap_stays_a_gap():
    quaternions = turns((0.0, 1.0, 0.0), np.linspace(0.0, 1.0, 5))
    quaternions[:, 3:] = np.nan
    rolled = rolling_displacement(quaternions, np.array([[RADIUS]]))
    assert np.isfinite(rolled[:, :3]).all()
    assert np.isnan(rolled[:, 3:]).all()


def test_the_high_walk_slides_by_less_than_a_third_of_what_its_feet_roll():
    record = crawl(ROBOTS["caiman"], GAITS["high_walk"])
    assert float(slip(record)) == pytest.approx(0.024, abs=0.006)
    assert float(slip(record.drop_vars("foot_roll"))) == pytest.approx(0.104, abs=0.015)


def test_a_thinned_record_has_the_same_path():
    record = crawl(ROBOTS["strider"], GAITS["tripod"], duration=2.0)
    assert (
        xr.testing.assert_allclose(
            contact_path(record.isel(time=slice(None, None, 5))), contact_path(record).isel(time=slice(None, None, 5))
        )
        is None
    )
