"""The article's signs against where the body goes: left -, right +, up -, down +."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.joint_sums import to_joint_sums

from suchus.article.paper import BendAngles, JointSums, to_bend_angles
from suchus.robot.design import joint_names
from suchus.robot.kinematics import landmarks
from suchus.robot.robots import ROBOTS

CAIMAN = ROBOTS["caiman"]
NAMES = joint_names(CAIMAN)
angle = st.floats(-3, 3)


def bent(bends: BendAngles) -> tuple[np.ndarray, np.ndarray]:
    """Return snout and tail tip of the robot with the article's bend angles shared among its joints."""
    sums = to_joint_sums(bends)
    q = np.zeros(len(NAMES))
    for i in (1, 2, 3):
        q[NAMES.index(f"spine_yaw_{i}")] = sums.spine_yaw / 3
    for i in (1, 2):
        q[NAMES.index(f"spine_pitch_{i}")] = sums.spine_pitch / 2
    for i in range(CAIMAN.tail.joints):
        q[NAMES.index(f"tail_yaw_{i + 1}")] = sums.tail_yaw / CAIMAN.tail.joints
    q[NAMES.index("tail_pitch")] = sums.tail_pitch
    found = landmarks(CAIMAN, q)
    return found.snout, found.tail


@pytest.mark.parametrize(
    ("bends", "part", "axis", "way"),
    [
        (BendAngles(0.3, 0, 0, 0), 0, 1, -1),  # positive: spine to the right
        (BendAngles(-0.3, 0, 0, 0), 0, 1, 1),
        (BendAngles(0, 0.3, 0, 0), 0, 2, -1),  # positive: spine down
        (BendAngles(0, -0.3, 0, 0), 0, 2, 1),
        (BendAngles(0, 0, 0.3, 0), 1, 1, -1),  # positive: tail to the right
        (BendAngles(0, 0, -0.3, 0), 1, 1, 1),
        (BendAngles(0, 0, 0, 0.3), 1, 2, -1),  # positive: tail down
        (BendAngles(0, 0, 0, -0.3), 1, 2, 1),
    ],
)
def test_body_goes_where_the_article_says(bends, part, axis, way):
    moved = bent(bends)[part] - bent(BendAngles(0, 0, 0, 0))[part]
    assert way * moved[axis] > 0.01


@given(angle, angle, angle, angle)
def test_signs_undo_themselves(a, b, c, d):
    assert to_bend_angles(to_joint_sums(BendAngles(a, b, c, d))) == BendAngles(a, b, c, d)
    assert to_joint_sums(to_bend_angles(JointSums(a, b, c, d))) == JointSums(a, b, c, d)


def test_arrays_are_converted_too():
    sums = to_joint_sums(BendAngles(*np.ones((4, 3))))
    np.testing.assert_array_equal(sums.spine_yaw, [-1, -1, -1])
    np.testing.assert_array_equal(sums.tail_yaw, [1, 1, 1])
