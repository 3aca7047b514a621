from dataclasses import replace

import numpy as np
import pytest

import suchus
from suchus.robot.design import crocodile, with_values
from suchus.robot.motion import straight_gait
from suchus.robot.robots import ROBOTS
from suchus.swimming.water import Outline, fit, printed_wave, undulation, with_passive_end

STILL = straight_gait(ROBOTS["caiman"])


def _stiffer(robot, factor):
    stiffness = factor * robot.tail.fin_stiffness_lateral
    return crocodile(
        replace(robot.tables, tail=replace(robot.tables.tail, fin_stiffness_lateral=stiffness, fin_damping=0.0))
    )


def _tip(robot, motion, speed=0.2):
    outline = Outline(robot)
    return with_passive_end(outline, motion, speed).stations[1] - undulation(outline, motion).stations[1]


def test_a_still_body_leaves_its_end_straight(robot):
    assert np.all(_tip(robot, STILL) == 0.0)


def test_only_the_end_gives_way_and_a_stiff_one_in_proportion_less(robot):
    motion = fit(robot, printed_wave(robot)).gait
    root = robot.length - robot.tail.fin_length * (1 + 1 / robot.tail.fin_segments)
    soft, stiff, hard = (_tip(_stiffer(robot, factor), motion) for factor in (1.0, 100.0, 200.0))
    np.testing.assert_allclose(soft[Outline(robot).s < root - 1e-9], 0.0, atol=1e-12)
    assert abs(soft[-1]) > abs(stiff[-1]) > 0.0
    assert stiff[-1] == pytest.approx(2 * hard[-1], rel=0.01)


def test_a_hard_spring_bends_by_moment_over_stiffness(robot):
    """At rest, with the head held by a fast beat's recoil: the root spring carries the moment of all beyond it."""
    motion = fit(robot, printed_wave(robot)).gait
    one = crocodile(
        replace(
            robot.tables, tail=replace(robot.tables.tail, fin_segments=1, fin_stiffness_lateral=50.0, fin_damping=0.0)
        )
    )
    tip = _tip(one, motion)[-1]
    twice = _tip(with_values(one, {"tail.fin_damping": 50.0 / (2 * np.pi)}), motion)[-1]
    assert twice / tip == pytest.approx(
        1 / (1 + 1j), rel=0.01
    )  # the damper holds as much as the spring, a quarter later


def test_a_springy_end_changes_the_speed_by_little(robot):
    motion = fit(robot, printed_wave(robot)).gait
    straight, bent = (
        suchus.swim(robot, m, stations=129) for m in (motion, with_passive_end(Outline(robot, 129), motion, 0.2))
    )
    change = bent.speed.values / straight.speed.values - 1
    assert np.all(np.abs(change) < 0.2)
    assert np.all(change != 0.0)
