"""Servo targets of every gait of the shelf on the robots that it was made for, as they were before."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from suchus.robot.gaits import GAITS
from suchus.robot.motion import Steer, intended, movement
from suchus.robot.robots import ROBOTS

FROZEN = json.loads((Path(__file__).with_name("servo_targets.json")).read_text())
"""Times [s] and angles in open loop [rad]; phases, size, strokes, heights and bends that steer, and angles then."""


PERIODS = {"semi_erect": 0.8, "high_walk": 0.8}
"""Periods that gaits had when their targets were frozen; a period moves no target over the phase [s]."""


def frozen(pair):
    """Return the robot and the gait of a pair, in the period that it had."""
    robot, gait = (shelf[name] for shelf, name in zip((ROBOTS, GAITS), pair.split("|"), strict=True))
    return robot, replace(gait, period=PERIODS.get(gait.name, gait.period))


@pytest.mark.parametrize("pair", FROZEN)
def test_the_targets_are_what_they_were(pair):
    robot, gait = frozen(pair)
    angles = intended(robot, gait, np.array(FROZEN[pair]["time"])).targets
    expected = np.array(FROZEN[pair]["open"])
    assert angles == pytest.approx(expected, abs=4e-15)  # machines differ in the last bit, see suchus.core.machine


@pytest.mark.parametrize("pair", [pair for pair in FROZEN if "steered" in FROZEN[pair]])
def test_the_steered_targets_are_what_they_were(pair):
    robot, gait = frozen(pair)
    asked = {name: np.array(values) for name, values in FROZEN[pair]["steered"].items()}
    here, limbs = movement(robot, gait), asked["sphase"]
    steer = Steer(size=asked["size"], stroke=asked["stroke"], lowering=asked["lower"], bend=asked["trunk"])
    angles = here.targets(limbs, here.axis_phase(limbs), steer)
    assert angles == pytest.approx(asked["steered"], abs=1e-12)
