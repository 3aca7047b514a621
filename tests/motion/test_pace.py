"""How fast a movement may be: no servo turns faster than it can."""

from dataclasses import replace

import numpy as np
import pytest

from suchus.design import layout
from suchus.gaits import GAITS
from suchus.motion import AngleTable, Curve, cycle_targets, intended, shortest_period
from suchus.motion.timing import START
from suchus.robots import ROBOTS

WALKS = [("caiman", "belly_crawl"), ("strider", "tripod"), ("salamandra", "salamandra_walk")]


@pytest.mark.parametrize(("name", "gait"), WALKS)
def test_a_cycle_is_what_is_intended_once_the_walk_has_begun(name, gait):
    robot, gait = ROBOTS[name], GAITS[gait]
    clock = np.linspace(0.0, 2.0, 9)
    there = intended(robot, gait, START + clock * gait.period).targets
    np.testing.assert_allclose(cycle_targets(robot, gait, clock), there, atol=1e-12)


def test_a_sawtooth_needs_the_time_of_its_steepest_side():
    robot = ROBOTS["caiman"]
    speed = robot.servo("LF_yaw").speed
    teeth = tuple(float(angle) for angle in np.interp(np.arange(200) / 200, [0.0, 0.75, 1.0], [0.0, 0.3, 0.0]))
    gait = AngleTable(
        name="teeth",
        period=1.0,
        duty_factor=0.5,
        limb_phases=(0.0, 0.5, 0.5, 0.0),
        curves=(Curve(servo="LF_yaw", angles=teeth),),
    )
    period, servo = shortest_period(robot, gait)
    assert servo == "LF_yaw"
    assert period == pytest.approx(0.3 / 0.25 / speed, rel=1e-6)


@pytest.mark.parametrize(("name", "gait"), WALKS[:2])
def test_the_shortest_period_is_the_one_at_which_a_servo_turns_as_fast_as_it_can(name, gait):
    robot, gait = ROBOTS[name], GAITS[gait]
    period, servo = shortest_period(robot, gait)
    assert shortest_period(robot, replace(gait, period=3.0 * gait.period)) == (period, servo)
    i = layout(robot).servos.index(servo)
    clock = np.arange(201) / 200
    assert np.abs(np.diff(cycle_targets(robot, gait, clock)[:, i])).max() * 200 / period == pytest.approx(
        robot.servo(servo).speed
    )
