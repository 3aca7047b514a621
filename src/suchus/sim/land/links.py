"""The links of a robot's model: which shapes they carry, where they are in a posture, and how they move."""

from typing import Any, NamedTuple

import mujoco
import numpy as np
from jaxtyping import Float

SHAPES = {
    int(mujoco.mjtGeom.mjGEOM_SPHERE): "ball",
    int(mujoco.mjtGeom.mjGEOM_CAPSULE): "rod",
    int(mujoco.mjtGeom.mjGEOM_ELLIPSOID): "ellipsoid",
}
"""Kinds of the shapes that robots are made of."""


class LinkShape(NamedTuple):
    """A shape that a link carries."""

    link: int
    """Which link, in the order of ``RobotLinks.names`` [-]."""
    kind: str
    """Value of ``SHAPES``."""
    size: tuple[float, float, float]
    """Radius of a ball; radius and half the length between the middles of a rod's round ends; half-axes of an ellipsoid
    [m]."""
    centre: tuple[float, float, float]
    """Its middle in the link's frame [m]."""
    turn: tuple[float, float, float, float]
    """Quaternion that turns its frame into the link's, scalar first; a rod lies along its frame's z [-]."""


class LinkMotion(NamedTuple):
    """Where links are in the world and how they move."""

    position: Float[np.ndarray, "link 3"]
    """Origins of their frames [m]."""
    matrix: Float[np.ndarray, "link 3 3"]
    """Rotation matrices: their columns are the links' axes [-]."""
    velocity: Float[np.ndarray, "link 3"]
    """Velocities of the origins [m/s]."""
    spin: Float[np.ndarray, "link 3"]
    """Angular velocities about the world's axes [rad/s]."""


class RobotLinks:
    """The bodies of a compiled robot that carry solid shapes; what only displaces water, as foam, is not solid.

    Args:
        model: the ``mujoco.MjModel``.
    """

    def __init__(self, model: Any) -> None:
        """Collect bodies with solid shapes, those shapes, and the hinges of the model."""
        self._model, self._data = model, mujoco.MjData(model)
        solid = [g for g in range(model.ngeom) if model.geom_bodyid[g] > 0 and model.geom_conaffinity[g]]
        self._bodies = sorted({int(model.geom_bodyid[g]) for g in solid})
        self.names = tuple(model.body(body).name for body in self._bodies)
        """Names of the links."""
        self.shapes = tuple(
            LinkShape(
                self._bodies.index(int(model.geom_bodyid[g])), SHAPES[int(model.geom_type[g])],
                tuple(model.geom_size[g].tolist()), tuple(model.geom_pos[g].tolist()),
                tuple(model.geom_quat[g].tolist()),
            )
            for g in solid
        )  # fmt: skip
        """What they carry."""
        hinges = [j for j in range(model.njnt) if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE]
        self.joints = tuple(model.joint(j).name for j in hinges)
        """Names of all hinges, in the order of their coordinates, which come after the root's six."""

    def motion(self, qpos: Float[np.ndarray, " place"], qvel: Float[np.ndarray, " coordinate"]) -> LinkMotion:
        """Return the links of a posture that moves so."""
        jacobian = self.jacobian(qpos)
        data, rate = self._data, jacobian @ qvel
        return LinkMotion(
            data.xpos[self._bodies].copy(), data.xmat[self._bodies].reshape(-1, 3, 3).copy(), rate[:, :3], rate[:, 3:]
        )  # fmt: skip

    def jacobian(self, qpos: Float[np.ndarray, " place"]) -> Float[np.ndarray, "link 6 coordinate"]:
        """Return how the links' origins move and how they turn for unit rates of the coordinates, in the world."""
        model, data = self._model, self._data
        data.qpos[:] = qpos
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        jacobians = np.zeros((len(self._bodies), 6, model.nv))
        for link_jacobian, body in zip(jacobians, self._bodies, strict=True):
            mujoco.mj_jacBody(model, data, link_jacobian[:3], link_jacobian[3:], body)
        return jacobians
