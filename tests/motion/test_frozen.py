"""Servo targets of every gait of the shelf on the robots that it was made for, as they were before."""

import json
from pathlib import Path

import numpy as np
import pytest

from suchus.gaits import GAITS
from suchus.motion import Steer, intended, movement
from suchus.robots import ROBOTS

FROZEN = json.loads((Path(__file__).parent.parent / "golden" / "servo_targets.json").read_text())
"""Times [s] and angles in open loop [rad]; phases, size, strokes, heights and bends that steer, and angles then."""


@pytest.mark.parametrize("pair", FROZEN)
def test_the_targets_are_what_they_were(pair):
    robot, gait = (shelf[name] for shelf, name in zip((ROBOTS, GAITS), pair.split("|"), strict=True))
    angles = intended(robot, gait, np.array(FROZEN[pair]["time"])).targets
    expected = np.array(FROZEN[pair]["open"])
    assert angles == pytest.approx(expected, abs=4e-15)  # machines differ in the last bit, see suchus.machine


@pytest.mark.parametrize("pair", [pair for pair in FROZEN if "steered" in FROZEN[pair]])
def test_the_steered_targets_are_what_they_were(pair):
    robot, gait = (shelf[name] for shelf, name in zip((ROBOTS, GAITS), pair.split("|"), strict=True))
    asked = {name: np.array(values) for name, values in FROZEN[pair]["steered"].items()}
    here, limbs = movement(robot, gait), asked["sphase"]
    steer = Steer(size=asked["size"], stroke=asked["stroke"], lower=asked["lower"], bend=asked["trunk"])
    angles = here.targets(limbs, here.axis_phase(limbs), steer)
    assert angles == pytest.approx(asked["steered"], abs=1e-12)
