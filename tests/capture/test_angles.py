"""The article's signs on keypoints: left -, right +, up -, down +."""

import numpy as np
import pytest
from tests.joint_sums import to_joint_sums

from suchus.animals.capture import Camera
from suchus.animals.capture.angles import bend_angles
from suchus.animals.capture.film import keypoints, tracked
from suchus.animals.capture.retarget import driven_fraction
from suchus.article.paper import BendAngles
from suchus.robot.design import joint_names


def posed(robot, crawl, bends):
    """Keypoints of the robot in a posture, lying level, seen without error."""
    sums, names = to_joint_sums(bends), joint_names(robot)
    record = crawl.isel(time=[0, 1]).copy(deep=True)
    q = np.zeros(len(names))
    for i in (1, 2, 3):
        q[names.index(f"spine_yaw_{i}")] = sums.spine_yaw / 3
    for i in (1, 2):
        q[names.index(f"spine_pitch_{i}")] = sums.spine_pitch / 2
    for i in range(robot.tail.joints):
        q[names.index(f"tail_yaw_{i + 1}")] = sums.tail_yaw / robot.tail.joints
    q[names.index("tail_pitch")] = sums.tail_pitch
    record["joint_angle"][:] = q
    record["orientation"][:] = [1.0, 0.0, 0.0, 0.0]
    camera = Camera(rate=100.0, noise=0.0, lost=0.0, heading=0.9, scale=None, heights=True, seed=0)
    return tracked(keypoints(robot, record), record.time.values, camera, source="a posture")


@pytest.mark.parametrize(
    "bends",
    [
        BendAngles(0.6, 0.0, 0.0, 0.0),
        BendAngles(-0.6, 0.0, 0.0, 0.0),
        BendAngles(0.0, 0.3, 0.0, 0.0),
        BendAngles(0.0, -0.3, 0.0, 0.0),
        BendAngles(0.0, 0.0, 0.8, 0.0),
        BendAngles(0.0, 0.0, -0.8, 0.0),
        BendAngles(0.0, 0.0, 0.0, 0.4),
        BendAngles(0.0, 0.0, 0.0, -0.4),
        BendAngles(0.9, 0.0, -0.7, 0.0),
    ],
)
def test_a_bent_robot_shows_its_angles(caiman, crawl, bends):
    found = bend_angles(posed(caiman, crawl, bends), driven_fraction(caiman))
    for name, value in bends._asdict().items():
        np.testing.assert_allclose(getattr(found, name), value, atol=1e-9, err_msg=name)


def test_keypoints_are_where_the_simulation_has_them(caiman, crawl):
    found = keypoints(caiman, crawl)
    np.testing.assert_allclose(found["snout"], crawl.snout.values, atol=1e-9)
    np.testing.assert_allclose(found["tail_tip"], crawl.tail_tip.values, atol=1e-9)
    for i, leg in enumerate(crawl.leg.values):
        np.testing.assert_allclose(found[leg], crawl.foot_position.values[:, i], atol=1e-9)


def test_points_of_one_rigid_part_keep_their_distance(caiman, crawl):
    found = keypoints(caiman, crawl)
    for one, two, length in (
        ("neck", "shoulder", 0.05),
        ("snout", "shoulder", caiman.head.snout - caiman.thorax.shoulder),
        ("shoulder", "spine_3", caiman.thorax.shoulder),
        ("spine_1", "hip", caiman.spine.base),
        ("hip", "tail_base", caiman.tail.offset),
        ("tail_base", "tail_1", caiman.tail.root + caiman.tail.pitch / 2),
    ):
        apart = np.linalg.norm(found[one] - found[two], axis=1)
        np.testing.assert_allclose(apart, length, atol=1e-9, err_msg=f"{one} {two}")
    for one, two in (("spine_3", "spine_2"), ("spine_2", "spine_1")):  # a pitch joint lies between
        apart = np.linalg.norm(found[one] - found[two], axis=1)
        np.testing.assert_allclose(apart, 2 * caiman.spine.link, rtol=0.01)


def test_the_crawl_shows_the_joint_angles_that_it_had(caiman, crawl, clean):
    camera = Camera(rate=100.0, noise=0.0, lost=0.0, heading=0.0, scale=None, heights=False, seed=0)
    tracks = tracked(keypoints(caiman, crawl), crawl.time.values, camera, source="a crawl")
    found = bend_angles(tracks, driven_fraction(caiman))
    trunk = -sum(crawl.joint_angle.sel(joint=f"spine_yaw_{i}") for i in (1, 2, 3))
    tail = sum(crawl.joint_angle.sel(joint=f"tail_yaw_{i + 1}") for i in range(caiman.tail.joints))
    # roll and pitch of the body tilt the planes of the bends by a few degrees
    assert np.abs(found.spine_lateral - trunk).max() < 0.05
    assert np.abs(found.tail_lateral - tail).max() < 0.05
