"""Draft, trim and righting lever of a robot at rest."""

from dataclasses import replace
from math import pi, radians

import mujoco
import numpy as np
import pytest

from suchus.core import rotation
from suchus.core.errors import InvalidDesign
from suchus.core.rotation import from_axis_angle
from suchus.core.water_table import column, unpack_table
from suchus.robot.design import servo_names
from suchus.robot.design.pieces import pieces
from suchus.robot.motion import LIMBS_UP, cycle_targets, straight_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.model.build import TIMESTEP
from suchus.sim.model.hydrostatics import Hydrostatics, _root, hydrostatics
from suchus.sim.model.wet import wet_model

BARE, FLOATING = ROBOTS["caiman"], ROBOTS["floating_caiman"]
POSTURE = cycle_targets(BARE, straight_gait(BARE, limbs=LIMBS_UP), np.zeros(1))[0]


@pytest.fixture(scope="module")
def floating():
    return hydrostatics(FLOATING, POSTURE, heel_count=13)


@pytest.fixture(scope="module")
def bare():
    return hydrostatics(BARE, heel_count=7)


def test_the_published_robot_sinks_by_what_it_is_too_heavy(bare):
    volume = column(pieces(BARE), "volume").sum()
    assert not bare.is_floating
    assert bare.missing_volume == pytest.approx(BARE.mass / 1000 - volume)
    assert bare.surplus_mass == pytest.approx(BARE.mass - 1000 * volume)
    assert np.isnan(bare.draft)
    salty = hydrostatics(BARE, density=1.001 * BARE.mass / volume, heel_count=3)
    assert salty.is_floating
    assert np.isnan([salty.trim, salty.draft]).all()  # it hangs upright: no trim up to 80 degrees balances it
    saltier = hydrostatics(BARE, density=1.2 * BARE.mass / volume, heel_count=3)
    assert saltier.draft > 0
    assert abs(saltier.trim) < radians(80)


def test_under_water_the_lever_is_that_of_buoyancy_over_mass(bare):
    model = wet_model(BARE, TIMESTEP, None, len(pieces(BARE)))
    data = mujoco.MjData(model)
    for name, angle in zip(servo_names(), POSTURE, strict=True):
        if name != "tail_cable":
            data.joint(name).qpos = angle
    mujoco.mj_fwdPosition(model, data)
    rows = unpack_table(model.numeric_data)
    ids = rows[:, 0].astype(int)
    at = data.xpos[ids] + np.einsum("nij,nj->ni", data.xmat[ids].reshape(-1, 3, 3), column(rows, "at"))
    over = np.average(at, axis=0, weights=column(rows, "volume")[:, 0]) - data.subtree_com[0]
    found = hydrostatics(BARE, POSTURE, heel_count=7)
    assert found.metacentric_height == pytest.approx(over[2], rel=1e-3)
    assert found.lever == pytest.approx(over[2] * np.sin(found.heel), abs=1e-9)
    assert over[2] < 0  # the limbs are heavy: it turns onto its side and on
    assert bare.lever == pytest.approx(0.0, abs=1e-9)


def test_the_floating_one_rights_itself_from_any_heel_below_150_degrees(floating):
    assert floating.is_floating
    assert floating.vanishing >= radians(150)
    assert floating.metacentric_height > 0.01
    assert floating.lever[[0, -1]] == pytest.approx(0.0, abs=1e-5)
    flat = replace(
        FLOATING, hull=replace(FLOATING.hull, foam=tuple(replace(f, raised=0.0) for f in FLOATING.hull.foam))
    )
    assert hydrostatics(flat, POSTURE, heel_count=13).vanishing < radians(
        150
    )  # without the foam on its back it does not


def test_the_lever_begins_with_the_metacentric_height(floating):
    fine = hydrostatics(FLOATING, POSTURE, heel_count=121)
    assert fine.lever[1] == pytest.approx(floating.metacentric_height * fine.heel[1], rel=0.05)


def test_air_let_out_takes_buoyancy(floating):
    less = hydrostatics(FLOATING, POSTURE, air_fraction=0.6, heel_count=3)
    assert floating.volume - less.volume == pytest.approx(0.4 * FLOATING.hull.air)
    assert less.draft > floating.draft
    assert not hydrostatics(FLOATING, POSTURE, air_fraction=0.0, heel_count=3).is_floating


@pytest.mark.parametrize(
    ("lever", "expected"),
    [((0, 1, 1, 0), 180), ((0, 1, -1, 0), 90), ((0, -1, -1, 0), 0), ((0, 1, 3, -1), 165), ((0, 1, 1, 1), 180)],
)
def test_where_the_lever_vanishes(floating, lever, expected):
    one = {name: getattr(floating, name) for name in Hydrostatics.__dataclass_fields__}
    made = Hydrostatics(**(one | {"heel": np.linspace(0, pi, 4), "lever": np.array(lever, dtype=float)}))
    assert made.vanishing == pytest.approx(radians(expected), abs=1e-9)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"density": 0.0}, "density is 0 kg/m3"),
        ({"air_fraction": 2.0}, "air_fraction is 2; 0 to 1"),
        ({"servo_angles": np.zeros(3)}, "3 servo angles are given and robot 'caiman' has 19"),
    ],
)
def test_bad_hydrostatics_are_refused(given, message):
    with pytest.raises(InvalidDesign, match=message):
        hydrostatics(BARE, **given)


def test_a_moment_that_never_vanishes_is_told_and_one_that_does_is_found():
    for zero in (-1.2, 0.0, 0.3):
        assert _root(lambda trim: trim - zero, 0.1) == pytest.approx(zero, abs=1e-6)  # noqa: B023  called at once
    assert np.isnan(_root(lambda _: 1.0, 0.1))


def test_heel_is_told_all_round():
    angles = np.radians([-170, -90, -10, 0, 10, 90, 170])
    assert rotation.heel(from_axis_angle(np.array([1.0, 0.0, 0.0]), angles)) == pytest.approx(angles)


@pytest.mark.parametrize("name", sorted(ROBOTS))
def test_every_robot_that_floats_displaces_its_weight(name):
    """Also one that is smaller than the height at which its model begins."""
    robot = ROBOTS[name]
    found = hydrostatics(robot, heel_count=3)
    assert np.isfinite(found.lever).all()
    assert found.is_floating == (found.missing_volume < 0)
    if found.is_floating:
        assert 0 < found.draft < robot.length
        assert abs(found.lever[0]) < 1e-6 * robot.length
