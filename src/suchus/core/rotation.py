"""Rotations as unit quaternions wxyz, over ``scipy.spatial.transform.Rotation``, with one sign for every angle.

A quaternion turns vectors of a body's frame (x forward, y left, z up) into the world's. Angles follow the right-hand
rule about the body's axes: **yaw** is positive to the left, **pitch** with the nose down, **roll** with the left side
up; as intrinsic rotations they follow each other in this order, yaw, pitch, roll.

Where scipy is slower, the closed form stands here, once: scipy normalises each quaternion anew, which changes the last
bit of angles on which records hang, and its product of two takes 138 us, the closed form 56 (of a hundred: 261
and 72; but 20 000 vectors turned by one quaternion 0.9 ms, without scipy 2.1 ms; on a busy core). Tests hold each to
scipy's.
Zeros and NaN, as of sensors that are lost, go through all but ``matrix``.
"""

from functools import cache
from math import atan2, pi, sqrt
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation

Quaternion = Float[np.ndarray, "*b 4"]
Vector = Float[np.ndarray, "*c 3"]


@cache
def _rotation_type() -> "type[Rotation]":
    """Return scipy's class of rotations; its import takes a quarter of that of ``flow``, and the plane needs none."""
    from scipy.spatial.transform import Rotation  # noqa: PLC0415  see above

    return Rotation


def roll(q: Quaternion) -> Float[np.ndarray, "*b"]:
    """Return the roll, left side up positive [rad]."""
    w, x, y, z = _parts(q)
    return np.asarray(np.arctan2(2 * (w * x + y * z), 1 - 2 * (x**2 + y**2)))


def pitch(q: Quaternion) -> Float[np.ndarray, "*b"]:
    """Return the pitch, nose down positive, -pi/2 to pi/2 [rad]; near the ends see ``steep_pitch``."""
    w, x, y, z = _parts(q)
    return np.asarray(np.arcsin(np.clip(2 * (w * y - z * x), -1.0, 1.0)))


def steep_pitch(q: Quaternion) -> Float[np.ndarray, "*b"]:
    """Return the pitch, nose down positive, as exact for a body that stands upright as for one that lies [rad]."""
    w, x, y, z = _parts(q)
    return np.asarray(np.arctan2(2 * (w * y - x * z), np.hypot(1 - 2 * (y * y + z * z), 2 * (x * y + w * z))))


def yaw(q: Quaternion) -> Float[np.ndarray, "*b"]:
    """Return the yaw of the forward axis seen from above, left positive, -pi to pi [rad]."""
    w, x, y, z = _parts(q)
    return np.asarray(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y**2 + z**2)))


def upward(q: Quaternion) -> Float[np.ndarray, "*b 3"]:
    """Return the world's upward direction in the frame of the body: the last row of the rotation matrix."""
    w, x, y, z = _parts(q)
    direction = np.empty((*w.shape, 3), w.dtype)
    direction[..., 0], direction[..., 1] = 2 * (x * z - w * y), 2 * (y * z + w * x)
    direction[..., 2] = 1 - 2 * (x * x + y * y)
    return direction


def world_x(q: Quaternion) -> Float[np.ndarray, "*b 3"]:
    """Return the world's x direction in the frame of the body: the first row of the rotation matrix."""
    w, x, y, z = _parts(q)
    direction = np.empty((*w.shape, 3), w.dtype)
    direction[..., 0] = 1 - 2 * (y * y + z * z)
    direction[..., 1], direction[..., 2] = 2 * (x * y - w * z), 2 * (x * z + w * y)
    return direction


def from_axis_angle(axis: Vector, angle: Float[np.ndarray, "*b"] | float) -> Quaternion:
    """Return the quaternions of turns about unit vectors, w positive for turns of less than half a turn.

    Args:
        axis: one, or one for each angle.
        angle: [rad].
    """
    half = np.asarray(angle)[..., None] / 2
    return np.concatenate([np.cos(half), np.sin(half) * axis + 0.0], axis=-1)  # no negative zeros in records


def from_angles(yaw: float, pitch: float, roll: float) -> Float[np.ndarray, "4"]:
    """Return the quaternion of three angles that follow each other as intrinsic rotations [rad]."""
    return np.asarray(_rotation_type().from_euler("ZYX", [yaw, pitch, roll]).as_quat(scalar_first=True))


def angles(q: Float[np.ndarray, "4"]) -> tuple[float, float, float]:
    """Return yaw, pitch (-pi/2 to pi/2) and roll, from which ``from_angles`` makes the same rotation [rad]."""
    return attitude(matrix(q))


def attitude(rotation_matrix: Float[np.ndarray, "3 3"]) -> tuple[float, float, float]:
    """Return yaw, pitch and roll of a rotation matrix, from which ``from_angles`` makes the same rotation [rad].

    That holds for a body that stands upright as well, where yaw and roll are about one axis and any yaw will do.
    """
    (x, y, z), sides = rotation_matrix[:, 0].tolist(), rotation_matrix[:, 1:]
    yaw = np.arctan2(y, x)
    lateral = np.cos(yaw) * sides[1] - np.sin(yaw) * sides[0]  # across the yaw, where the body's y and z axes show
    return float(yaw), float(np.arctan2(-z, np.hypot(x, y))), float(np.arctan2(-lateral[1], lateral[0]))


def from_vector(vector: Float[np.ndarray, "3"]) -> Float[np.ndarray, "4"]:
    """Return the quaternion of a rotation vector: its axis times its angle [rad]."""
    return np.asarray(_rotation_type().from_rotvec(vector).as_quat(scalar_first=True))


def to_vector(q: Float[np.ndarray, "4"], reference: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3"]:
    """Return the rotation vector that is nearest to another one, among those that differ by whole turns [rad]."""
    w, x, y, z = q.tolist()
    half = sqrt(x * x + y * y + z * z)
    angle = 2 * atan2(half, w)
    axis = q[1:] / half if half > 0 else reference / max(sqrt(reference @ reference), 1e-300)
    turns = round((float(axis @ reference) - angle) / (2 * pi))
    return np.asarray((angle + 2 * pi * turns) * axis)


def vectors(matrices: Float[np.ndarray, "n 3 3"]) -> Float[np.ndarray, "n 3"]:
    """Return the rotation vectors of rotation matrices, of at most half a turn [rad]."""
    return np.asarray(_rotation_type().from_matrix(matrices).as_rotvec())


def turns(vectors: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3 3"]:
    """Return the rotation matrices of rotation vectors [rad]."""
    return np.asarray(_rotation_type().from_rotvec(vectors).as_matrix())


def turn(vector: Float[np.ndarray, "3"]) -> Float[np.ndarray, "3 3"]:
    """Return the rotation matrix of a rotation vector [rad]."""
    return np.asarray(_rotation_type().from_rotvec(vector).as_matrix())


def matrix(q: Quaternion) -> Float[np.ndarray, "*b 3 3"]:
    """Return the rotation matrices, whose columns are the body's axes in the world."""
    return np.asarray(
        _rotation_type().from_quat(q.reshape(-1, 4), scalar_first=True).as_matrix().reshape(*q.shape[:-1], 3, 3)
    )


def multiply(q1: Float[np.ndarray, "*c 4"], q2: Float[np.ndarray, "*d 4"]) -> Quaternion:
    """Return the products q1 q2 of quaternions: the rotation by q2, then by q1, both about the world's axes."""
    w, v, s, u = q1[..., :1], q1[..., 1:], q2[..., :1], q2[..., 1:]
    return np.concatenate([w * s - np.sum(v * u, -1, keepdims=True), w * u + s * v + np.cross(v, u)], axis=-1)


def rotate(q: Quaternion, vector: Vector) -> Float[np.ndarray, "*d 3"]:
    """Return vectors of the body's frame in the world's; one quaternion may turn many vectors, and the reverse."""
    if q.ndim == 1 and vector.ndim > 1:
        rotated = _rotation_type().from_quat(q, scalar_first=True).apply(vector.reshape(-1, 3))
        return np.asarray(rotated.reshape(vector.shape))
    w, v = q[..., :1], q[..., 1:]
    doubled_cross = 2 * np.cross(v, vector)
    return np.asarray(vector + w * doubled_cross + np.cross(v, doubled_cross))


def _parts(q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    return q[..., 0], q[..., 1], q[..., 2], q[..., 3]


def heel(orientation: np.ndarray) -> np.ndarray:
    """Return the heel of a body on a level surface, right side down positive, up to 180 degrees [rad]."""
    left_axis_z = rotate(orientation, np.array([0.0, 1.0, 0.0]))[..., 2]
    up_axis_z = rotate(orientation, np.array([0.0, 0.0, 1.0]))[..., 2]
    return np.asarray(np.arctan2(left_axis_z, up_axis_z))
