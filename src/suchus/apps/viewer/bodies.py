"""Where everything of a robot is in a posture, and the skin cut into pieces of one colour."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import mujoco
import numpy as np
from scipy.cluster.vq import kmeans2

from suchus.robot.design import Robot, layout
from suchus.robot.design.ground import Relief
from suchus.sim.model import compile_model, joint_addresses
from suchus.visual.skin import Poses, ankles, bone_names, skin_with_ankles

COLOURS = 7
"""Number of colours into which the skin is cut; more look smoother and move slower [-]."""


class BodyPoses:
    """The bodies of a robot, set by an instant of a record.

    Args:
        robot: robot whose bodies are shown.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self._layout = layout(robot)
        self.model = compile_model(robot)
        self._feet = np.zeros((len(self._layout.limbs), 3))
        self._data = mujoco.MjData(self.model)
        self._joints = joint_addresses(self.model, self._layout.hinges)

    def set_state(self, state: Mapping[str, np.ndarray]) -> None:
        """Take the posture of an instant, by the names of ``record.VARIABLES``."""
        self._data.qpos[:3], self._data.qpos[3:7] = state["position"], state["orientation"]
        self._data.qpos[self._joints] = state["joint_angle"]
        self._feet = np.asarray(state["foot_position"])
        mujoco.mj_kinematics(self.model, self._data)

    def bones(self, relief: Relief | None) -> dict[str, tuple[np.ndarray, np.ndarray]]:
        """Return position [m] and orientation wxyz of every bone of the skin, whose feet lie flat on the ground.

        Args:
            relief: what stands up from the ground; None where it is even.
        """
        positions, quaternions = zip(*map(self.body, bone_names(self.robot)), strict=True)
        feet_flat = ankles(self.robot, Poses(np.array([positions]), np.array([quaternions])), self._feet[None], relief)
        poses = zip(feet_flat.positions[0], feet_flat.quaternions[0], strict=True)
        return dict(zip(skin_with_ankles(self.robot).bones, poses, strict=True))

    def geoms(self) -> list[int]:
        """Return the numbers of the geoms that belong to the robot."""
        return [i for i in range(self.model.ngeom) if self.model.geom_bodyid[i] > 0]

    def geom(self, number: int) -> tuple[np.ndarray, np.ndarray]:
        """Return position [m] and orientation wxyz of a geom."""
        orientation = np.empty(4)
        mujoco.mju_mat2Quat(orientation, self._data.geom_xmat[number])
        return np.array(self._data.geom_xpos[number]), orientation

    def body(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Return position [m] and orientation wxyz of a body."""
        body: Any = self._data.body(name)
        return np.array(body.xpos), np.array(body.xquat)

    def part_position(self, name: str) -> np.ndarray:
        """Return where the joint of a servo, or the foot of a leg, is [m]; for the cable, where its first joint is."""
        robot_layout = self._layout
        if name in robot_layout.limb_names:
            return np.array(self._data.site(f"{name}_foot").xpos)
        servo = robot_layout.servos.index(name) if name in robot_layout.servos else -1
        hinge = robot_layout.cable(servo).hinges[0] if servo in robot_layout.cables else name
        return np.array(self._data.xanchor[self.model.joint(hinge).id])


@dataclass(frozen=True, slots=True)
class SkinPiece:
    """A part of the skin in one colour, with the bones that move it."""

    vertices: np.ndarray
    """(n, 3) [m]."""
    faces: np.ndarray
    """(m, 3)."""
    weights: np.ndarray
    """(n, bone) [-]."""
    bones: tuple[str, ...]
    """Names of the bones, which are bodies and ankles."""
    rest_origins: np.ndarray
    """Origins of the bones at rest, (bone, 3) [m]."""
    colour: tuple[int, int, int]
    """Red, green, blue of 255."""


@lru_cache(maxsize=8)
def pieces(robot: Robot, count: int = COLOURS) -> tuple[SkinPiece, ...]:
    """Return the skin of a robot cut by colour, since a browser's skinned mesh has but one.

    Args:
        robot: robot whose skin is meant.
        count: number of colours.
    """
    surface = skin_with_ankles(robot)
    face_colours = surface.colours[surface.faces].astype(float).mean(axis=1)
    centres, group = kmeans2(face_colours, count, minit="++", seed=0)
    dense = np.zeros((len(surface.vertices), len(surface.bones)))
    np.add.at(dense, (np.arange(len(dense))[:, None], surface.indices), surface.weights)
    skin_pieces = []
    for number, centre in enumerate(centres):
        faces_of_colour = surface.faces[group == number]
        if len(faces_of_colour) == 0:
            continue
        vertices, faces = np.unique(faces_of_colour, return_inverse=True)
        used_bones = np.flatnonzero(dense[vertices].any(axis=0))
        red, green, blue = (round(float(value)) for value in centre)
        skin_pieces.append(
            SkinPiece(
                vertices=surface.vertices[vertices],
                faces=faces.reshape(-1, 3),
                weights=dense[np.ix_(vertices, used_bones)],
                bones=tuple(surface.bones[bone] for bone in used_bones),
                rest_origins=surface.rest_origins[used_bones],
                colour=(red, green, blue),
            )
        )
    return tuple(skin_pieces)


def support(feet: np.ndarray, loaded: np.ndarray) -> np.ndarray:
    """Return the corners of the support of the loaded feet in order, (corner, 3) [m].

    Args:
        feet: places on the ground, one for each limb, (limb, 3) [m].
        loaded: which stand, (limb,).
    """
    corners = feet[loaded]
    if len(corners) < 3:
        return np.asarray(corners)
    center = corners.mean(axis=0)
    order = np.argsort(np.arctan2(corners[:, 1] - center[1], corners[:, 0] - center[0]))
    return np.asarray(corners[order])
