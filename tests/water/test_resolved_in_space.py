"""The body in three dimensions whose motion is given: at rest, mirrored, interrupted, towed."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.core.progress import silent
from suchus.robot.motion import straight_gait
from suchus.robot.robots import ROBOTS
from suchus.swimming.water import Outline, Water, fit, printed_wave, recoil
from suchus.swimming.water.resolved import TETHERED, SwimSetting, resolved_swim, towed_drag

ROBOT = ROBOTS["caiman"]
MOTION = fit(ROBOT, printed_wave(ROBOT, "I", sign=-1)).gait
SETTING = SwimSetting(axes=3, cells=54, viscosity=2e-3, cycles=1, free=TETHERED)


def held(motion, **given):
    """A swim on the spot whose head moves as the balance of lateral momentum says."""
    sway, turn = recoil(Outline(ROBOT, SETTING.cells + 1), motion, 0.0, Water())
    return resolved_swim(ROBOT, motion, SETTING, sway=sway, turn=turn, **given)


@pytest.fixture(scope="module")
def swum():
    return held(MOTION, progress=silent)


def test_a_body_at_rest_feels_nothing():
    found = held(straight_gait(ROBOT), progress=silent)
    assert all(np.abs(found[name].values).max() == 0.0 for name in ("thrust", "aside", "power", "sway", "turn"))


def test_a_mirrored_swim_is_pushed_to_the_other_side(swum):
    other = held(MOTION.lagged(0.5), progress=silent)
    peak = np.abs(swum.aside.values).max()
    assert peak > 0.1
    assert other.aside.values == pytest.approx(-swum.aside.values, abs=1e-3 * peak)
    assert other.thrust.values == pytest.approx(swum.thrust.values, abs=1e-3 * peak)
    assert other.sway.values == pytest.approx(-swum.sway.values)
    assert float(swum.power.mean()) == pytest.approx(float(swum.cycle_power[-1]), rel=0.05)
    assert float(swum.cycle_power[-1]) > 0


@pytest.mark.slow("a second run: a swim that was interrupted goes on")
def test_a_swim_on_the_spot_that_was_interrupted_goes_on_to_the_same_numbers(swum, tmp_path):
    def stop(stage, share):
        if share > 0.6:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        held(MOTION, checkpoint=tmp_path / "swim", progress=stop)
    assert held(MOTION, checkpoint=tmp_path / "swim", progress=silent).identical(swum)


def test_a_tow_takes_more_than_the_friction_of_a_plate_and_less_than_that_of_a_square_block():
    speed, water = 2.0, Water(viscosity=SETTING.viscosity, thickening=1.0)
    wide, high = Outline(ROBOT, 129).silhouette
    skin = float(2.0 * np.pi * np.sqrt(0.5 * (wide**2 + high**2)).mean()) * ROBOT.length
    pressure, front = 0.5 * water.density * speed**2, 4.0 * float((wide * high).max())
    drag = towed_drag(ROBOT, speed, replace(SETTING, beside=0.1), lengths=1.5)
    assert pressure * skin * water.friction(speed, ROBOT.length) < drag
    assert drag < pressure * (skin * water.friction(speed, ROBOT.length) + 2.0 * front)


@pytest.mark.validate
def test_a_faster_tow_takes_more_than_in_proportion():
    slow, fast = (towed_drag(ROBOT, speed, SETTING, lengths=1.5) for speed in (0.5, 1.0))
    assert slow > 0
    assert fast > 2.0 * slow


@pytest.mark.parametrize(("given", "said"), [
    ({"speed": 0.0}, "speed of the tow is 0 m/s; 0.0001 to 10 m/s is allowed"),
    ({"speed": float("nan")}, "speed of the tow is nan"),
    ({"speed": 11.0}, "speed of the tow is 11 m/s"),
    ({"speed": 0.1, "lengths": 1.4}, "lengths of the tow is 1.4 body lengths; 1.5 to 100 body lengths is allowed"),
])  # fmt: skip
def test_a_tow_that_is_none_is_refused(given, said):
    with pytest.raises(OutsideLimits, match=said):
        towed_drag(ROBOT, given.pop("speed"), SETTING, **given)


def test_water_too_thin_for_the_grid_is_refused_before_anything_runs():
    with pytest.raises(InvalidDesign, match="boundary layer"):
        resolved_swim(ROBOT, MOTION, replace(SETTING, viscosity=1e-5))
