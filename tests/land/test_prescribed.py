"""The water of the runs on a body whose motion is given: exact answers, signs, and what a fit finds again."""

import sys
from dataclasses import replace
from math import tau
from pathlib import Path

import numpy as np
import pytest
from tests.swims import crocodile_swim

from suchus.core.water_table import column
from suchus.robot.design.pieces import pieces
from suchus.robot.design.water import Water
from suchus.robot.motion import straight_gait
from suchus.robot.motion.axis import yaw_hinges
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake
from suchus.sim.land.prescribed import INSTANTS, _Submerged, free_sections, held_sections, towed_sections

sys.path.insert(0, str(Path(__file__).parents[2] / "tools"))

from water_coefficients import NAMES, QUANTITIES, WaterCoefficients, composed, fitted, left, responses

ROBOT = ROBOTS["caiman"]
TABLE = pieces(replace(ROBOT, girdles=(), hull=None))
SWIM = crocodile_swim(frequency=0.8)
STILL = straight_gait(ROBOT, frequency=0.8)
HEAD = {"sway": -0.03 + 0.01j, "turn": 0.13 + 0.02j}
THICK = 1.5e-4
NOTHING = WaterCoefficients(cross_drag=0.0, thickening=0.0, added_mass=0.0)
PHASE = np.arange(1, INSTANTS + 1) / INSTANTS


@pytest.fixture(scope="module")
def parts():
    return responses(ROBOT, SWIM, THICK, **HEAD)


@pytest.mark.parametrize("speed", [0.02, 0.5])
def test_a_tow_is_friction_along_the_skin_and_the_nose(speed):
    water = Water(viscosity=THICK)
    area = column(TABLE, "skin").sum() * water.friction(speed, ROBOT.length) + column(TABLE, "end").sum()
    drag = towed_sections(ROBOT, speed, Lake(level=0.0, water=water))
    assert drag == pytest.approx(0.5 * water.density * speed**2 * area, rel=1e-9)
    assert towed_sections(ROBOT, speed, Lake(level=0.0, water=replace(water, cross_drag=5.0))) == drag


def test_a_body_at_rest_feels_nothing():
    found = held_sections(ROBOT, STILL, WaterCoefficients().lake(THICK))
    assert all(np.abs(found[name].values).max() < 1e-12 for name in QUANTITIES)
    still = free_sections(ROBOT, STILL, WaterCoefficients().lake(THICK), 1)
    assert np.abs([still.speed.values, still.power.values]).max() < 1e-12


def test_a_straight_body_that_sways_feels_its_added_mass_and_its_drag():
    """Of a section that moves square to the body both are in closed form."""
    amplitude, omega = 0.05, tau * STILL.frequency
    velocity = -omega * amplitude * np.sin(tau * PHASE)
    rate = -(omega**2) * amplitude * np.cos(tau * PHASE)
    mass = 1000.0 * column(TABLE, "added")[:, 0].sum()
    felt = held_sections(ROBOT, STILL, replace(NOTHING, added_mass=1.0).lake(THICK), sway=amplitude)
    assert felt.aside.values == pytest.approx(-mass * rate, abs=1e-9)
    assert felt.power.values == pytest.approx(mass * rate * velocity, abs=1e-9)
    area = column(TABLE, "area")[:, 0].sum()
    dragged = held_sections(ROBOT, STILL, replace(NOTHING, cross_drag=1.3).lake(THICK), sway=amplitude)
    assert dragged.aside.values == pytest.approx(-650.0 * area * np.abs(velocity) * velocity, abs=1e-9)
    assert dragged.power.values == pytest.approx(650.0 * area * np.abs(velocity) ** 3, abs=1e-9)


def test_the_mirrored_swim_is_pushed_to_the_other_side(parts):
    mirrored = SWIM.lagged(0.5)
    whole, other = composed(parts, WaterCoefficients()), WaterCoefficients().lake(THICK)
    there = held_sections(ROBOT, mirrored, other, **{name: -value for name, value in HEAD.items()})
    assert there.aside.values == pytest.approx(-whole.aside.values, abs=1e-9)
    assert there.thrust.values == pytest.approx(whole.thrust.values, abs=1e-9)
    half = INSTANTS // 2
    assert np.roll(whole.aside.values, half) == pytest.approx(-whole.aside.values, abs=1e-9)
    assert np.abs(whole.aside.values).max() > 0.1


def test_what_a_body_feels_is_linear_in_the_coefficients(parts):
    some = WaterCoefficients(cross_drag=2.7, thickening=11.0, added_mass=1.4)
    felt = held_sections(ROBOT, SWIM, some.lake(THICK), **HEAD)
    for name in QUANTITIES:
        assert composed(parts, some)[name].values == pytest.approx(felt[name].values, abs=1e-9)


def test_a_fit_finds_the_coefficients_that_a_force_was_made_with(parts):
    some = WaterCoefficients(cross_drag=2.7, thickening=11.0, added_mass=1.4)
    made = composed(parts, some)
    found = fitted(made, parts, NAMES)
    assert [found.cross_drag, found.thickening, found.added_mass] == pytest.approx([2.7, 11.0, 1.4])
    assert max(left(made, composed(parts, found)).values()) < 1e-9
    two = fitted(made, parts, ("cross_drag", "thickening"))
    assert two.added_mass == WaterCoefficients().added_mass
    assert max(left(made, composed(parts, two)).values()) > 1e-3  # one of them is not what it was made with
    assert max(left(made, composed(parts, WaterCoefficients())).values()) > 0.1


def test_a_swim_without_water_stays_where_it_is():
    """Nothing acts from outside: the centre of mass rests, however the body bends; with drag it does not."""
    alone = free_sections(ROBOT, SWIM, NOTHING.lake(THICK), 2)
    assert np.abs(alone.speed.values).max() < 1e-5
    swum = free_sections(ROBOT, SWIM, WaterCoefficients().lake(THICK), 2)
    assert swum.speed.values[-1] > 0.01
    assert swum.power.values[-1] > 0.01
    back = free_sections(ROBOT, SWIM.reversed(), WaterCoefficients().lake(THICK), 2)
    assert back.speed.values[-1] < 0.5 * swum.speed.values[-1]


def test_a_free_body_is_as_heavy_as_the_water_that_it_displaces():
    body = _Submerged(ROBOT, Lake(level=0.0))
    body.fill(1000.0)
    assert body._model.body_mass.sum() == pytest.approx(1000.0 * column(TABLE, "volume").sum())


@pytest.mark.parametrize("name", ["salamander", "pleurobot"])
def test_a_robot_with_a_neck_is_towed_and_swims_without_its_limbs(name):
    """Without girdles the neck's hinges are the trunk's: their names there do not matter to the water."""
    robot = ROBOTS[name]
    lake = Lake(level=3.0)
    assert towed_sections(robot, 0.1, lake) > 0.0
    joints = yaw_hinges(robot).names
    assert any(joint.startswith("neck_yaw_") for joint in joints)
    assert len(set(_Submerged(robot, lake, joints)._places)) == len(joints)
