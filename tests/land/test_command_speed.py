"""A run that commands a servo beyond its speed warns."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

from suchus.core.errors import Doubtful
from suchus.robot.design.servos import with_servos
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.land.command_speed import CommandSpeeds


def _messages(runs: list[Run], duration: float = 2.0) -> list[str]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        simulate(runs, duration=duration, timestep=0.005, effort=False)
    return [str(warning.message) for warning in caught if isinstance(warning.message, Doubtful)]


def test_a_constant_rate_is_its_own_greatest_speed():
    run = Run(robot=ROBOTS["caiman"], gait=GAITS["low_crawl"])
    speeds = CommandSpeeds([run], 0.01)
    for tick in range(5):
        speeds.observe(np.full((1, 19), 0.03 * tick), np.array([False]))
    assert speeds.max_speeds == pytest.approx(3.0)


def test_a_gait_within_the_servos_speeds_says_nothing():
    assert _messages([Run(robot=ROBOTS["caiman"], gait=GAITS["high_walk"])]) == []


def test_noise_on_the_commands_is_not_a_command():
    assert _messages([Run(robot=ROBOTS["caiman"], gait=GAITS["low_crawl"], noise=0.1)]) == []


def test_a_robot_with_slow_servos_says_which_how_fast_and_the_limit():
    robot = with_servos(ROBOTS["caiman"], lambda servo: replace(servo, speed=0.5))
    (message,) = _messages([Run(robot=robot, gait=GAITS["low_crawl"])])
    assert "'low_crawl' commands " in message
    assert "the servo's speed is 0.5 rad/s" in message


def test_a_batch_warns_once_of_its_worst_run():
    robot = ROBOTS["pleurobot"]
    gaits = ("animal_walk", "pleurobot_walk")
    (message,) = _messages([Run(robot=robot, gait=GAITS[gait]) for gait in gaits])
    assert "gait 'animal_walk' commands RH_yaw of robot 'pleurobot'" in message
    assert "1 of 2 runs" in message
