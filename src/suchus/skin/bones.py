"""The bones under the skin: the moving bodies of the model, by name, and where they are in a posture.

A bone's frame is that of the MuJoCo body of the same name. At zero posture all bones are parallel to the pelvis:
x forward, y left, z up.
"""

from typing import NamedTuple

import numpy as np

from suchus.design import LEGS, Crocodile, joint_names
from suchus.errors import InvalidDesign
from suchus.kinematics.mass import tail_segments
from suchus.rotation import about, multiply, rotate


class Bone(NamedTuple):
    """A body of the model, as far as it moves the skin."""

    name: str
    """Of the MuJoCo body."""
    parent: int
    """Its place among the bones; -1 for the pelvis."""
    offset: tuple[float, float, float]
    """Its origin in the frame of its parent [m]."""
    hinges: tuple[tuple[str, tuple[float, float, float]], ...]
    """Names and axes of its hinges, in the order in which they turn it."""


class Poses(NamedTuple):
    """Where every bone is."""

    positions: np.ndarray
    """Origins, (..., bone, 3) [m]."""
    quaternions: np.ndarray
    """Orientations as unit quaternions wxyz, (..., bone, 4) [-]."""


def bones(robot: Crocodile) -> tuple[Bone, ...]:
    """Return every bone; a parent stands before its children."""
    found = [Bone("pelvis", -1, (0.0, 0.0, 0.0), ())]
    for i in range(5):
        axis, word = ((0.0, 0.0, 1.0), "yaw") if i % 2 == 0 else ((0.0, 1.0, 0.0), "pitch")
        ahead = robot.spine.link if i else robot.spine.base
        name = "thorax" if i == 4 else f"spine_{i + 1}"
        found.append(Bone(name, i, (ahead, 0.0, 0.0), ((f"spine_{word}_{i // 2 + 1}", axis),)))
    for leg in LEGS:
        found += _leg(robot, leg, len(found))
    return (*found, *_tail(robot, len(found)))


def bone_names(robot: Crocodile) -> tuple[str, ...]:
    """Return the names of the bones, which are those of the model's bodies."""
    return tuple(bone.name for bone in bones(robot))


def bone_rest(robot: Crocodile) -> np.ndarray:
    """Return the origins of the bones at zero posture in the frame of the pelvis, (bone, 3) [m]."""
    rest: list[np.ndarray] = []
    for bone in bones(robot):
        rest.append((rest[bone.parent] if bone.parent >= 0 else np.zeros(3)) + np.array(bone.offset))
    return np.array(rest)


def poses(robot: Crocodile, position: np.ndarray, orientation: np.ndarray, angles: np.ndarray) -> Poses:
    """Return where every bone is in the world.

    Args:
        robot: the robot.
        position: of the pelvis, (..., 3) [m].
        orientation: of the pelvis, (..., 4), unit quaternions wxyz.
        angles: of every hinge in the order of ``joint_names(robot)``, (..., joint) [rad].

    Raises:
        InvalidDesign: the number of angles is not the robot's number of hinges.
    """
    names = joint_names(robot)
    if angles.shape[-1] != len(names):
        raise InvalidDesign(
            f"{angles.shape[-1]} angles were given; {robot.name} has {len(names)} hinges: give one for each."
        )
    where = {name: i for i, name in enumerate(names)}
    at: list[np.ndarray] = []
    turned: list[np.ndarray] = []
    for bone in bones(robot):
        here, turn = (position, orientation) if bone.parent < 0 else (at[bone.parent], turned[bone.parent])
        at.append(here + rotate(turn, np.array(bone.offset)))
        for hinge, axis in bone.hinges:
            turn = multiply(turn, about(np.array(axis), angles[..., where[hinge]]))
        turned.append(turn)
    return Poses(np.stack(at, axis=-2), np.stack(turned, axis=-2))


def _leg(robot: Crocodile, leg: str, at: int) -> list[Bone]:
    side = 1.0 if leg.startswith("L") else -1.0
    girdle, ahead = (5, robot.thorax.shoulder) if leg.endswith("F") else (0, 0.0)
    links, down = robot.leg(leg), (-side, 0.0, 0.0)
    hip = ((f"{leg}_yaw", (0.0, 0.0, -side)), (f"{leg}_pitch", down))
    return [
        Bone(f"{leg}_femur", girdle, (ahead, side * links.hip_offset, 0.0), hip),
        Bone(f"{leg}_tibia", at, (0.0, side * links.femur, 0.0), ((f"{leg}_knee", down),)),
    ]


def _tail(robot: Crocodile, at: int) -> list[Bone]:
    lengths, yaw, pitch = tail_segments(robot.tail).lengths, (0.0, 0.0, 1.0), (0.0, -1.0, 0.0)
    found = [Bone("tail_root", 0, (-robot.tail.offset, 0.0, 0.0), (("tail_pitch", pitch),))]
    for i in range(1, len(lengths)):
        fin = i - robot.tail.joints
        hinges = ((f"tail_yaw_{i}", yaw),) if fin <= 0 else ((f"fin_yaw_{fin}", yaw), (f"fin_pitch_{fin}", pitch))
        found.append(Bone(f"tail_{i}", at + i - 1, (-lengths[i - 1], 0.0, 0.0), hinges))
    return found
