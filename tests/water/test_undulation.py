import numpy as np
import pytest
from tests.swims import crocodile_swim

from suchus.core.errors import InvalidDesign
from suchus.robot.motion import as_table
from suchus.robot.robots import ROBOTS
from suchus.swimming.water import ExactWave, FilmedWave, Outline, cycle, fit, printed_wave, undulation

TIME = np.linspace(0.0, 1.0, 17)


def filmed_wave(robot, frequency):
    return FilmedWave(length=robot.length, frequency=frequency, wavelength=0.9, head=0.02, tail=0.1)


WAVES = {
    "I": printed_wave,
    "I as printed": lambda robot: printed_wave(robot, sign=1),
    "A": lambda robot: printed_wave(robot, "A"),
    "G": lambda robot: printed_wave(robot, "G"),
    "filmed": lambda robot: filmed_wave(robot, 1.0),
}


@pytest.mark.parametrize("name", WAVES)
def test_the_midline_lies_on_its_wave(robot, name):
    wave = WAVES[name](robot)
    curve = undulation(Outline(robot, 513), ExactWave(name=name, wave=wave)).curve(TIME)
    away = [curve.y[i] - wave.displacement(curve.x[i], t) for i, t in enumerate(TIME)]
    assert np.abs(away).max() < 1e-4 * robot.length


@pytest.mark.parametrize("name", WAVES)
def test_the_midline_keeps_its_length(robot, name):
    curve = undulation(Outline(robot, 65), ExactWave(name=name, wave=WAVES[name](robot))).curve(TIME)
    length = np.hypot(np.diff(curve.x), np.diff(curve.y)).sum(axis=-1)
    np.testing.assert_allclose(length, robot.length, rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", WAVES)
def test_velocities_are_the_derivatives_of_positions(robot, name):
    bent, h = undulation(Outline(robot, 65), ExactWave(name=name, wave=WAVES[name](robot))), 1e-5
    for grown, growing in ((1.0, 0.0), (0.4, 0.7)):
        now = bent.curve(TIME, grown, growing)
        before, after = (bent.curve(TIME + step, grown + step * growing, growing) for step in (-h, h))
        for what in ("x", "y", "heading"):
            difference = (getattr(after, what) - getattr(before, what)) / (2 * h)
            np.testing.assert_allclose(getattr(now, f"{what}_rate"), difference, atol=2e-6)


def test_joints_bend_the_midline_as_the_outline_says(robot):
    outline = Outline(robot)
    servos = np.array([0.5, 0.4, 0.2, 1.1]) * np.exp(-2j * np.pi * np.array([0.3, 0.1, 0.0, 0.6]))
    gait = crocodile_swim(frequency=0.8, yaw=(0.5, 0.4, 0.2), yaw_lag=(0.3, 0.1, 0.0), tail=1.1, tail_lag=0.6)
    bent = undulation(outline, gait)
    middles = outline.bending_at(0.5 * (outline.s[1:] + outline.s[:-1])) @ servos
    np.testing.assert_allclose(bent.middles, [0 * middles, middles], atol=1e-12)
    np.testing.assert_allclose(bent.stations[1], outline.bending_at(outline.s) @ servos, atol=1e-12)


@pytest.mark.parametrize("name", ["caiman", "salamander", "swimmer"])
def test_measured_curves_bend_the_midline_as_the_gait_that_they_are_of(name):
    """Curves of 64 samples have their harmonics exactly; a cable's pulley turns by a sine of the bend."""
    robot = ROBOTS[name]
    gait = fit(robot, printed_wave(robot, frequency=1.0)).gait
    outline = Outline(robot, 65)
    meant, measured = undulation(outline, gait), undulation(outline, as_table(robot, gait))
    np.testing.assert_allclose(measured.stations[:2], meant.stations, atol=2e-3)
    assert np.abs(meant.stations).max() > 0.2


def test_a_head_that_is_turned_turns_every_section(robot):
    outline, wave = Outline(robot, 65), printed_wave(robot)
    found = fit(robot, wave)
    still, turned = (cycle(outline, found.gait, 0.01, turn) for turn in (0.0, found.head))
    np.testing.assert_allclose((turned.heading - still.heading).std(axis=1), 0.0, atol=1e-12)
    assert turned.y[:, 0].max() == pytest.approx(0.01)


def test_a_wave_without_a_period_is_refused(robot):
    with pytest.raises(InvalidDesign, match="period"):
        ExactWave(name="slow", wave=filmed_wave(robot, -1.0))
