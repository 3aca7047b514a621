"""The bones under the skin: the moving bodies of the model, by name, and where they are in a posture.

A bone's frame is that of the MuJoCo body of the same name. At zero posture all bones are parallel to the root:
x forward, y left, z up.
"""

from typing import NamedTuple

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.core.rotation import from_axis_angle, multiply, rotate
from suchus.robot.design import Robot, joint_names, layout


class Poses(NamedTuple):
    """Pose of every bone."""

    positions: np.ndarray
    """Origins, (..., bone, 3) [m]."""
    quaternions: np.ndarray
    """Orientations as unit quaternions wxyz, (..., bone, 4) [-]."""


def bone_names(robot: Robot) -> tuple[str, ...]:
    """Return the names of the bones, which are those of the model's bodies."""
    return tuple(body.name for body in layout(robot).bodies)


def bone_rest(robot: Robot) -> np.ndarray:
    """Return the origins of the bones at zero posture in the frame of the root, (bone, 3) [m]."""
    origins: list[np.ndarray] = []
    for body in layout(robot).bodies:
        origins.append((origins[body.parent] if body.parent >= 0 else np.zeros(3)) + np.array(body.offset))
    return np.array(origins)


def poses(robot: Robot, position: np.ndarray, orientation: np.ndarray, angles: np.ndarray) -> Poses:
    """Return where every bone is in the world.

    Args:
        robot: the robot.
        position: position of the root, (..., 3) [m].
        orientation: orientation of the root, (..., 4), unit quaternions wxyz.
        angles: angles of every hinge in the order of ``joint_names(robot)``, (..., joint) [rad].

    Raises:
        InvalidDesign: the number of angles is not the robot's number of hinges.
    """
    names = joint_names(robot)
    if angles.shape[-1] != len(names):
        raise InvalidDesign(
            f"{angles.shape[-1]} angles were given; {robot.name} has {len(names)} hinges: give one for each."
        )
    joint_index = {name: i for i, name in enumerate(names)}
    positions: list[np.ndarray] = []
    quaternions: list[np.ndarray] = []
    for bone in layout(robot).bodies:
        origin, turn = (
            (position, orientation) if bone.parent < 0 else (positions[bone.parent], quaternions[bone.parent])
        )
        positions.append(origin + rotate(turn, np.array(bone.offset)))
        for _, hinge, axis in bone.hinges:
            turn = multiply(turn, from_axis_angle(np.array(axis), angles[..., joint_index[hinge]]))
        quaternions.append(turn)
    return Poses(np.stack(positions, axis=-2), np.stack(quaternions, axis=-2))
