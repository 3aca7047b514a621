"""Silhouettes cover the skin, and mirror with it."""

import numpy as np
import pytest
from matplotlib.path import Path
from tests.bodies import eight

from suchus.robot.design import joint_names
from suchus.robot.robots import ROBOTS
from suchus.visual.figures.silhouette import silhouette
from suchus.visual.skin import poses, skin

STILL = np.array([1.0, 0.0, 0.0, 0.0])


def bent(robot, sign=1.0):
    """The skin of a robot whose trunk and tail bend, its shanks down."""
    angles = np.zeros(len(joint_names(robot)))
    for i, name in enumerate(joint_names(robot)):
        if name.startswith(("spine_yaw", "tail_yaw")):
            angles[i] = 0.12 * sign
        if name.endswith("knee"):
            angles[i] = 1.4
    return skin(robot).posed(*poses(robot, np.array([0.0, 0.0, 0.1]), STILL, angles))


@pytest.mark.parametrize("axes", [(0, 1), (0, 2)], ids=["above", "side"])
@pytest.mark.parametrize("robot", [ROBOTS["caiman"], ROBOTS["salamander"], eight()], ids=lambda robot: robot.name)
def test_the_outline_covers_the_skin(robot, axes):
    vertices = bent(robot)
    seen = silhouette(robot, vertices, axes)
    pieces = [seen.body, seen.jaw, *seen.scutes, *seen.eyes, *(piece for leg in seen.legs for piece in leg)]
    flat = vertices[:, list(axes)]
    covered = np.zeros(len(flat), dtype=bool)
    for piece in pieces:
        for radius in (0.002, -0.002):  # which side is out depends on how the piece runs
            covered |= Path(piece).contains_points(flat, radius=radius)
    assert covered.mean() > 0.97


def test_the_outline_is_no_larger_than_the_skin(robot, long_tail):
    for one in (robot, long_tail):
        vertices = bent(one)
        seen = silhouette(one, vertices, (0, 1))
        every = np.concatenate([seen.body, *seen.scutes, *(piece for leg in seen.legs for piece in leg)])
        assert (every >= vertices[:, :2].min(axis=0) - 1e-9).all()
        assert (every <= vertices[:, :2].max(axis=0) + 1e-9).all()


def test_each_leg_is_the_leg_of_its_name(robot):
    seen = silhouette(robot, bent(robot), (0, 1))
    middles = [np.concatenate(leg).mean(axis=0) for leg in seen.legs]
    assert middles[0][1] > middles[1][1] + 0.1
    assert middles[2][1] > middles[3][1] + 0.1
    assert min(middles[0][0], middles[1][0]) > max(middles[2][0], middles[3][0])
    assert [len(leg) for leg in seen.legs] == [21, 21, 19, 19]
    assert [len(leg) for leg in silhouette(eight(), bent(eight()), (0, 1)).legs] == 8 * [3]  # two links and a foot
    assert len(seen.eyes) == 2


def test_a_mirrored_posture_mirrors_the_outline(robot):
    left, right = (silhouette(robot, bent(robot, sign), (0, 1)) for sign in (1.0, -1.0))
    assert np.allclose(left.body[:, 0].min(), right.body[:, 0].min())
    assert np.allclose(left.body[:, 1].max(), -right.body[:, 1].min(), atol=1e-6)
