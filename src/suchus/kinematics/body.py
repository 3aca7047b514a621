"""Where feet, snout and tail are, for a crocodile-like robot.

Everything is in the frame of the pelvis: origin on the midline at the hind girdle's axis, x forward, y left,
z up. Angles come in the order of ``suchus.design.joint_names``.
"""

import numpy as np
from jaxtyping import Float

from suchus.design import LEGS, Robot, cable_joints, fin_joints
from suchus.errors import UnknownName
from suchus.kinematics.given import rows
from suchus.kinematics.tree import Landmarks, landmarks

__all__ = ["Landmarks", "feet", "from_leg_frame", "landmarks", "tail_points", "to_leg_frame"]


def feet(robot: Robot, angles: Float[np.ndarray, "*batch joint"]) -> Float[np.ndarray, "*batch limb 3"]:
    """Return the centres of the feet in the order of the layout's limbs [m].

    Args:
        robot: the robot.
        angles: of every hinge [rad].
    """
    return landmarks(robot, angles).feet


def from_leg_frame(point: Float[np.ndarray, "*batch 3"], name: str) -> Float[np.ndarray, "*batch 3"]:
    """Return a point of a leg's D-H base frame in the frame of its girdle: x forward, y left, z up [m].

    A right leg is the mirror image of a left one.
    """
    left, point = _side(name), rows(point, 3, "the point")
    return np.stack([point[..., 1], left * point[..., 0], -point[..., 2]], axis=-1)


def to_leg_frame(point: Float[np.ndarray, "*batch 3"], name: str) -> Float[np.ndarray, "*batch 3"]:
    """Return a point of a girdle's frame in the D-H base frame of a leg [m]; see ``from_leg_frame``."""
    left, point = _side(name), rows(point, 3, "the point")
    return np.stack([left * point[..., 1], point[..., 0], -point[..., 2]], axis=-1)


def tail_points(robot: Robot, angles: Float[np.ndarray, "*batch joint"]) -> Float[np.ndarray, "*batch point 3"]:
    """Return the tail from its pitch joint to its tip: pitch joint, cable joints, joints of the end, tip [m].

    Args:
        robot: the robot.
        angles: the tail's pitch, its cable joints, the yaw and pitch of each segment of its end [rad].
    """
    tail = robot.tail
    cables, segments = len(cable_joints(robot)), len(fin_joints(robot)) // 2
    angles = rows(angles, 1 + cables + 2 * segments, f"the tail's angles of {robot.name}")
    x = np.broadcast_to(np.array([-1.0, 0.0, 0.0]), (*angles.shape[:-1], 3))  # along the straight tail
    points = [tail.offset * x]
    R = _pitched(angles[..., 0])
    reach = tail.root + tail.pitch / 2
    for i in range(cables):
        points.append(points[-1] + reach * -R[..., :, 0])
        R, reach = R @ _yawed(angles[..., 1 + i]), tail.pitch
    points.append(points[-1] + tail.pitch / 2 * -R[..., :, 0])
    for i in range(segments):
        bend = angles[..., 1 + cables + 2 * i : 3 + cables + 2 * i]
        R = R @ _yawed(bend[..., 0]) @ _pitched(bend[..., 1])
        points.append(points[-1] + tail.fin_length / segments * -R[..., :, 0])
    return np.stack(points, axis=-2)


def _side(name: str) -> float:
    if name not in LEGS:
        raise UnknownName("leg", name, LEGS)
    return 1.0 if name.startswith("L") else -1.0


def _yawed(angle: np.ndarray) -> np.ndarray:
    """Return the turn about +z: it takes the tail's tip to the right."""
    s, c, zero, one = np.sin(angle), np.cos(angle), np.zeros_like(angle), np.ones_like(angle)
    return np.stack([c, -s, zero, s, c, zero, zero, zero, one], axis=-1).reshape(*angle.shape, 3, 3)


def _pitched(angle: np.ndarray) -> np.ndarray:
    """Return the turn about -y: it takes the tail's tip down."""
    s, c, zero, one = np.sin(angle), np.cos(angle), np.zeros_like(angle), np.ones_like(angle)
    return np.stack([c, zero, -s, zero, one, zero, s, zero, c], axis=-1).reshape(*angle.shape, 3, 3)
