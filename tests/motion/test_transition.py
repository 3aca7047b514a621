from dataclasses import replace
from itertools import permutations

import numpy as np
import pytest

from suchus.robot.design import layout, servo_names
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import cycle_targets, servo_range
from suchus.robot.motion.transition import transition
from suchus.robot.robots import ROBOTS

POSTURES = ("belly_crawl", "low_crawl", "semi_erect", "high_walk")


@pytest.mark.parametrize(("here", "there"), list(permutations(POSTURES, 2)))
def test_a_transition_takes_three_to_five_seconds_without_a_jolt_and_within_the_joints(robot, here, there):
    way = transition(robot, GAITS[here], GAITS[there])
    assert 3.0 <= way.duration <= 5.0
    start = cycle_targets(robot, GAITS[here], np.array(0.0))
    course = np.array([way.angles_at(t, start) for t in np.arange(0.0, way.duration, 0.01)])
    assert np.abs(np.diff(course, axis=0)).max() / 0.01 < 9.0  # [rad/s]
    assert np.abs(np.diff(course, n=2, axis=0)).max() / 0.01**2 < 150.0  # [rad/s2]
    for i, name in enumerate(servo_names()):
        low, high = servo_range(robot, name)
        assert course[:, i].min() >= low - 1e-9
        assert course[:, i].max() <= high + 1e-9


def test_it_begins_where_the_robot_is_and_ends_where_the_new_gait_stands(robot):
    here, there = GAITS["belly_crawl"], GAITS["high_walk"]
    way = transition(robot, here, there)
    start = np.linspace(-0.3, 0.3, 19)
    assert way.angles_at(0.0, start) == pytest.approx(start)
    end = way.angles_at(way.duration + 1.0, start)
    assert end[[0, 3, 6, 9]] == pytest.approx(np.array([-1, -1, 1, 1]) * np.pi / 2)
    assert end[12:17] == pytest.approx(np.zeros(5))
    assert end[17] == pytest.approx(there.number("tail_pitch"))


def test_one_diagonal_pair_keeps_its_posture_while_the_other_turns(robot):
    here, there = GAITS["low_crawl"], GAITS["high_walk"]
    way = transition(robot, here, there)
    first, second = [0, 1, 2, 9, 10, 11], [3, 4, 5, 6, 7, 8]
    assert way.targets[:4, second] == pytest.approx(np.tile(way.targets[0, second], (4, 1)))
    assert way.targets[3:7, first] == pytest.approx(np.tile(way.targets[3, first], (4, 1)))


def test_the_way_up_begins_where_the_way_down_ends(robot):
    a, b = GAITS["belly_crawl"], GAITS["semi_erect"]
    up, down = transition(robot, a, b), transition(robot, b, a)
    assert up.targets[0, :12] == pytest.approx(down.targets[-1, :12])  # standing in the crawl at 90 mm


@pytest.mark.parametrize("name", ["pleurobot", "salamander", "strider"])
def test_a_change_of_height_of_any_body_ends_in_the_new_posture(name):
    robot, gait = ROBOTS[name], default_gait(ROBOTS[name])
    other = replace(gait, name="low", height=0.9 * gait.height)
    course = transition(robot, gait, other)
    assert course.targets.shape == (len(course.times), len(layout(robot).servos))
    assert (np.diff(course.times) > 0).all()
    assert course.angles_at(course.duration, course.targets[0]) == pytest.approx(course.targets[-1])
    assert np.ptp(course.targets, axis=0).max() > 0.05  # limbs are lifted on the way


def test_a_gait_in_metres_and_one_by_places_turn_into_each_other():
    course = transition(ROBOTS["caiman"], GAITS["belly_crawl"], GAITS["salamander_walk"])
    assert np.isfinite(course.targets).all()
