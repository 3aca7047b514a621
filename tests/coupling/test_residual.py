"""The section model beside a flow: R2, fits on blocks, and that the model is found again where it made the forces."""

import numpy as np
import pytest
import xarray as xr

from suchus.robot.design import with_values
from suchus.robot.motion.axis import yaw_hinges
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake
from suchus.sim.land.prescribed import sections_along
from suchus.swimming.coupling.residual import _between_joints, _row, r2

TIME = np.arange(400) / 100.0
ALL = np.ones(400, bool)
HALVES = TIME < 2.0, TIME >= 2.0


def test_the_share_that_a_model_explains():
    values = np.sin(2 * np.pi * TIME)
    assert r2(values, values) == 1.0
    assert r2(values, 0 * values) == pytest.approx(0.0, abs=1e-9)
    assert r2(values, -values) == pytest.approx(-3.0)
    assert np.isnan(r2(0 * values, values))


def test_factors_are_found_with_intervals_that_hold_them():
    rng = np.random.default_rng(0)
    added, drag = np.sin(2 * np.pi * TIME), np.cos(2 * np.pi * TIME) * np.abs(np.cos(2 * np.pi * TIME))
    values = 2.0 * added + 4.0 * drag + 0.05 * rng.normal(size=400)
    rms, _, as_shipped, a, a_low, a_high, d, d_low, d_high, fitted, held = _row(values, added, drag, ALL, HALVES, 100.0)
    assert rms == pytest.approx(np.sqrt((values**2).mean()))
    assert a_low < a < a_high
    assert d_low < d < d_high
    assert (a, d) == pytest.approx((2.0, 4.0), abs=0.05)
    assert as_shipped < 0.8 < 0.99 < min(fitted, held)
    *_, held = _row(np.where(HALVES[0], values, -values), added, drag, ALL, HALVES, 100.0)
    assert held < 0.0  # what does not hold in other cycles is seen


def test_links_and_joints_of_the_sections_add_up():
    """A body that is pushed aside feels in sum what its links feel, and more where more of it bends."""
    robot = with_values(ROBOTS["floating_caiman"], {"hull": None})
    joints = tuple(yaw_hinges(robot).names)
    place = np.zeros((2, 3 + len(joints)))
    rate, push = place.copy(), place.copy()
    push[0, 1], rate[1, 1] = 1.0, 0.5
    found = sections_along(robot, joints, place, rate, push, Lake(level=0.0))
    total = found.links[:, :, 1].sum(axis=1)
    assert (total < 0).all()
    assert -total[0] == pytest.approx(1.9, rel=0.05)  # kg, aside: shared/design/coupling.md
    assert np.abs(found.links[:, :, 0].sum(axis=1)).max() < 0.02 * np.abs(total).max()
    still = sections_along(robot, joints, place, rate, push, Lake(level=0.0, added_mass=0.0))
    assert np.abs(still.links[0]).max() < 1e-9
    assert still.links[1, :, 1].sum() == pytest.approx(total[1], rel=0.2)


def test_a_joint_that_nothing_drives_feels_the_water_too():
    robot = with_values(ROBOTS["floating_caiman"], {"hull": None})
    joints = tuple(hinge.name for hinge in robot.axis_hinges if hinge.turn == "yaw")
    assert joints[-1] not in yaw_hinges(robot).names
    place = np.zeros((1, 3 + len(joints)))
    push = place.copy()
    push[0, -1] = 10.0
    found = sections_along(robot, joints, place, place, push, Lake(level=0.0))
    assert np.abs(found.links[0, :-1]).max() < 1e-9  # the links ahead of it rest
    assert abs(found.links[0, -1, 1]) > 1e-4
    assert found.joints[0, -1] < -1e-6


def test_a_record_that_is_too_short_has_no_interval():
    wave = np.sin(2 * np.pi * TIME), np.cos(2 * np.pi * TIME)
    *_, a, low, high, _, _, _, _, _ = _row(wave[0] + wave[1], *wave, ALL, (TIME < 1.4, TIME >= 1.4), 100.0)
    assert a == pytest.approx(1.0)
    assert np.isnan([low, high]).all()
    *_, low, high, _, _, _, _, _ = _row(wave[0] + wave[1], *wave, ALL, (TIME < 1.6, TIME >= 1.6), 100.0)
    assert low <= 1.0 + 1e-9
    assert high >= 1.0 - 1e-9


def test_bodies_that_have_each_their_own_force_are_added_up_between_lateral_joints():
    robot = ROBOTS["floating_caiman"]
    joints = [hinge.name for hinge in robot.axis_hinges if hinge.turn == "yaw"]
    bodies = [segment.name for segment in robot.axis]
    names = [*reversed(bodies), "LF_tibia"]  # in no particular order, and a limb
    force = np.random.default_rng(2).normal(size=(3, len(names), 3))
    loads = {"link_force": (("time", "link", "xyz"), force), "link_torque": (("time", "link"), force[..., 2])}
    record = xr.Dataset(loads, coords={"link": names, "xyz": list("xyz")})
    found = _between_joints(robot, record, joints)
    assert list(found.link.values) == [f"link_{k + 1}" for k in range(len(joints) + 1)]
    first = bodies[: 1 + next(k for k, one in enumerate(robot.axis) if any(h.name in joints for h in one.hinges))]
    summed = record.link_force.sel(link=first).sum("link")
    assert found.link_force.sel(link="link_1").values == pytest.approx(summed.values)
    whole = record.link_force.sel(link=bodies).sum("link")
    assert found.link_force.sum("link").values == pytest.approx(whole.values)
    assert _between_joints(robot, found, joints) is found
