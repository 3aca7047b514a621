"""Distances between parts, exact where they can be."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.bodies import eight, hatchling

from suchus.core.errors import UnsuitedRobot
from suchus.experiments.optimise.clearance import part_distance, segment_distance
from suchus.robot.design import joint_names, layout
from suchus.robot.gaits import default_gait
from suchus.robot.motion import middle_stance
from suchus.robot.robots import ROBOTS

POINT = st.tuples(*[st.floats(-1.0, 1.0, allow_subnormal=False)] * 3).map(np.array)


@pytest.mark.parametrize(
    ("one", "other", "apart"),
    [
        (((0, 0, 0), (1, 0, 0)), ((0, 2, 0), (1, 2, 0)), 2.0),  # side by side
        (((0, 0, 0), (1, 0, 0)), ((3, 0, 0), (4, 0, 0)), 2.0),  # in one line
        (((-1, 0, 0), (1, 0, 0)), ((0, -1, 0.5), (0, 1, 0.5)), 0.5),  # crossing above
        (((0, 0, 0), (1, 0, 0)), ((2, 1, 0), (3, 5, 0)), 2**0.5),  # end to end
        (((0, 0, 0), (0, 0, 0)), ((1, -1, 0), (1, 1, 0)), 1.0),  # a point
    ],
)
def test_segments_are_as_far_apart_as_geometry_says(one, other, apart):
    p, p_end, q, q_end = (np.array(x, dtype=float) for x in (*one, *other))
    assert segment_distance(p, p_end, q, q_end) == pytest.approx(apart, abs=1e-12)
    assert segment_distance(q_end, q, p, p_end) == pytest.approx(apart, abs=1e-12)


@given(POINT, POINT, POINT, POINT)
def test_no_two_points_of_two_segments_are_nearer(p, p_end, q, q_end):
    apart = float(segment_distance(p, p_end, q, q_end))
    share = np.linspace(0.0, 1.0, 41)[:, None]
    one, other = p + share * (p_end - p), q + share * (q_end - q)
    nearest = np.linalg.norm(one[:, None] - other[None], axis=-1).min()
    step = (np.linalg.norm(p_end - p) + np.linalg.norm(q_end - q)) / 80
    assert apart <= nearest + 1e-9
    assert apart >= nearest - step - 1e-9


def posture(robot, **angles):
    names = list(joint_names(robot))
    held = np.zeros(len(names))
    for name, angle in angles.items():
        held[names.index(name)] = angle
    return held


def test_a_straight_robot_is_clear_and_one_that_folds_is_not(robot):
    # a thigh 11 mm thick from 63 mm aside, and a head 40 mm thick that begins 40 mm ahead of it; the thorax carries it
    assert part_distance(robot, posture(robot)) == pytest.approx(np.hypot(0.040, 0.063) - 0.040 - 0.011)
    bent = {f"spine_yaw_{i}": 0.78 for i in (1, 2, 3)}
    forward, back = {"LH_yaw": 1.0}, {"LF_yaw": -1.0}
    assert part_distance(robot, posture(robot, **bent, **forward, **back)) < 0.0


@pytest.mark.parametrize("name", [name for name in ROBOTS if name != "swimmer"])
def test_every_body_with_limbs_is_clear_where_it_stands(name):
    robot = ROBOTS[name]
    angles = np.zeros(len(joint_names(robot)))
    assert part_distance(robot, angles) > 0.0
    place, servos = layout(robot), middle_stance(robot, default_gait(robot))
    for limb in place.limbs:
        angles[limb.hinges] = servos[limb.servos]
    assert part_distance(robot, angles) > 0.0


def test_legs_in_the_middle_are_held_against_the_trunk_and_against_each_other():
    """Their hips lie 63 mm from the axis, the trunk is 32 mm thick, the thigh 11 mm; legs are 60.5 mm apart."""
    robot = eight()
    assert part_distance(robot, posture(robot)) == pytest.approx(0.063 - 0.032 - 0.011)
    meeting = posture(robot, LM_yaw=-0.3, LN_yaw=0.3)
    assert part_distance(robot, meeting) < 0.0
    assert part_distance(robot, posture(robot, LM_yaw=0.3, LN_yaw=-0.3)) > 0.0


def test_a_body_in_another_size_is_as_clear_in_that_size(robot):
    small, angles = hatchling(), {"spine_yaw_1": 0.5, "LF_yaw": -0.6, "LH_yaw": 0.7, "LF_knee": 0.3}
    large = part_distance(robot, posture(robot, **angles))
    assert part_distance(small, posture(small, **angles)) == pytest.approx(large * 0.3 / robot.length, rel=1e-9)


def test_a_body_without_limbs_is_refused():
    swimmer = ROBOTS["swimmer"]
    with pytest.raises(UnsuitedRobot, match="distance between limbs and body needs limbs to walk on; robot 'swimmer'"):
        part_distance(swimmer, posture(swimmer))


def test_a_mirrored_posture_is_as_clear(robot):
    left = posture(robot, spine_yaw_1=0.5, spine_yaw_3=0.3, LF_yaw=-0.4, RH_pitch=0.5, tail_yaw_1=0.2)
    right = posture(robot, spine_yaw_1=-0.5, spine_yaw_3=-0.3, RF_yaw=-0.4, LH_pitch=0.5, tail_yaw_1=-0.2)
    both = part_distance(robot, np.array([left, right]))
    assert both[0] == pytest.approx(both[1], abs=1e-12)
