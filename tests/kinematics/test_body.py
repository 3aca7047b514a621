from dataclasses import replace

import mujoco
import numpy as np
import pytest

from suchus.core.errors import InvalidDesign
from suchus.robot.design import LEGS, crocodile, joint_names, layout
from suchus.robot.kinematics import landmarks
from suchus.robot.robots import ROBOTS
from suchus.sim.model import compile_model

CAIMAN = ROBOTS["caiman"]
VARIANTS = {
    **{name: ROBOTS[name] for name in ROBOTS},
    "other proportions": crocodile(
        replace(
            CAIMAN.tables,
            spine=replace(CAIMAN.tables.spine, base=0.08, link=0.05),
            tail=replace(CAIMAN.tables.tail, joints=4, fin_segments=5, fin_length=0.3),
        )
    ),
}


def posture(robot, seed: int = 0, count: int = 20, spread: float = 1.0) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-spread, spread, (count, len(joint_names(robot))))


def mirrored(robot, q: np.ndarray) -> np.ndarray:
    """Return the posture of the mirror image: legs swap sides, everything sideways changes sign."""
    names = joint_names(robot)
    other = q.copy()
    for i, name in enumerate(names):
        if name[:2] in LEGS:
            swapped = {"L": "R", "R": "L"}[name[0]] + name[1:]
            other[..., names.index(swapped)] = q[..., i]
        elif "yaw" in name:
            other[..., i] = -q[..., i]
    return other


@pytest.mark.parametrize("name", VARIANTS)
def test_dh_equals_mujoco(name):
    robot = VARIANTS[name]
    model = compile_model(robot)
    data = mujoco.MjData(model)
    names = joint_names(robot)
    address = [model.joint(joint).qposadr[0] for joint in names]
    q = posture(robot)
    ours = landmarks(robot, q)
    for i, angles in enumerate(q):
        data.qpos[address] = angles
        mujoco.mj_kinematics(model, data)
        R, origin = data.xmat[1].reshape(3, 3), data.xpos[1]
        sites = [data.site(s).xpos for s in (*(f"{leg}_foot" for leg in layout(robot).limb_names), "snout", "tail_tip")]
        theirs = (np.array(sites) - origin) @ R
        np.testing.assert_allclose(np.vstack([ours.feet[i], ours.snout[i], ours.tail[i]]), theirs, atol=1e-9)


def test_straight_robot_is_as_long_as_its_parts():
    found = landmarks(CAIMAN, np.zeros(len(joint_names(CAIMAN))))
    np.testing.assert_allclose(found.snout, [CAIMAN.spine.length + CAIMAN.head.snout, 0, 0], atol=1e-15)
    np.testing.assert_allclose(found.tail, [-CAIMAN.tail.length, 0, 0], atol=1e-15)
    assert found.snout[0] - found.tail[0] == pytest.approx(CAIMAN.length)
    np.testing.assert_allclose(found.feet[:, 1], np.array([0.9, -0.9, 1, -1]) * 0.245, atol=1e-15)


@pytest.mark.parametrize(
    ("joint", "part", "axis", "sign"),
    [
        *((f"{leg}_yaw", ("feet", i), 0, 1) for i, leg in enumerate(LEGS)),
        *((f"{leg}_{j}", ("feet", i), 2, -1) for i, leg in enumerate(LEGS) for j in ("pitch", "knee")),
        *((f"spine_yaw_{i}", ("snout", ...), 1, 1) for i in (1, 2, 3)),
        *((f"spine_pitch_{i}", ("snout", ...), 2, -1) for i in (1, 2)),
        ("tail_pitch", ("tail", ...), 2, -1),
        ("tail_yaw_3", ("tail", ...), 1, -1),
        ("fin_yaw_1", ("tail", ...), 1, -1),
        ("fin_pitch_2", ("tail", ...), 2, -1),
    ],
)
def test_positive_angles_do_what_design_says(joint, part, axis, sign):
    names = joint_names(CAIMAN)
    q = np.zeros(len(names))
    start = landmarks(CAIMAN, q)
    q[names.index(joint)] = 0.1
    moved = getattr(landmarks(CAIMAN, q), part[0])[part[1]] - getattr(start, part[0])[part[1]]
    assert sign * moved[axis] > 1e-3


def test_mirrored_posture_gives_mirrored_points():
    q = posture(CAIMAN, seed=2)
    here, there = landmarks(CAIMAN, q), landmarks(CAIMAN, mirrored(CAIMAN, q))
    flip = np.array([1, -1, 1])
    np.testing.assert_allclose(there.feet[:, [1, 0, 3, 2]], here.feet * flip, atol=1e-14)
    np.testing.assert_allclose(there.snout, here.snout * flip, atol=1e-14)
    np.testing.assert_allclose(there.tail, here.tail * flip, atol=1e-14)


def test_shapes_follow_the_batch_and_wrong_counts_are_refused():
    q = posture(CAIMAN, count=6).reshape(2, 3, -1)
    found = landmarks(CAIMAN, q)
    assert found.feet.shape == (2, 3, 4, 3)
    assert found.snout.shape == found.tail.shape == (2, 3, 3)
    with pytest.raises(InvalidDesign, match=r"the posture of caiman.* has the shape \(29,\); 30 numbers are needed"):
        landmarks(CAIMAN, np.zeros(29))
