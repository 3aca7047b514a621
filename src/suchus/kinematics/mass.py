"""Where the mass of a robot is: the pieces of its body, and the centre of mass of a posture.

Everything is in the frame of the pelvis, as in ``suchus.kinematics.body``.
"""

from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.design import GRAVITY, LEGS, Robot, cable_joints, check_needs, joint_names, lacking, layout
from suchus.kinematics import body, leg, spine, tree
from suchus.kinematics.given import rows

__all__ = [
    "GRAVITY",
    "Pieces",
    "cantilever_torque",
    "centre_of_mass",
    "pieces",
]


class Pieces(NamedTuple):
    """The pieces of a robot: pelvis, four links of the trunk, thorax, head; three per leg; the tail's segments."""

    masses: Float[np.ndarray, " piece"]
    """[kg]."""
    centres: Float[np.ndarray, "*batch piece 3"]
    """Their centres of mass in the frame of the pelvis [m]."""


def pieces(robot: Robot, angles: Float[np.ndarray, "*batch joint"]) -> Pieces:
    """Return every piece of the body.

    Args:
        robot: the robot.
        angles: of every hinge, in the order of ``joint_names(robot)`` [rad].

    Raises:
        InvalidDesign: the number of angles is not the robot's number of hinges.
    """
    angles = rows(angles, len(joint_names(robot)), f"the posture of {robot.name}, an angle for each hinge,")
    check_needs(robot, ("legs", "shells", "article_spine", "tail"), "the mass of the trunk in closed form")
    masses = [robot.pelvis.mass, *robot.spine.link_masses, robot.thorax.mass, robot.head.mass]
    for limb in layout(robot).limbs:
        masses += limb.girdle.limb.masses
    masses += robot.tail.masses
    centres = (*_trunk(robot, angles), *_legs(robot, angles), *_tail(robot, angles))
    return Pieces(np.array(masses), np.stack(centres, axis=-2))


def centre_of_mass(robot: Robot, angles: Float[np.ndarray, "*batch joint"]) -> Float[np.ndarray, "*batch 3"]:
    """Return the centre of mass of a posture in the frame of the pelvis [m].

    Args:
        robot: the robot.
        angles: of every hinge, in the order of ``joint_names(robot)`` [rad].

    Raises:
        InvalidDesign: the number of angles is not the robot's number of hinges.
    """
    if not _closed(robot):
        return tree.centre_of_mass(robot, angles)
    found = pieces(robot, angles)
    return np.einsum("p,...pi->...i", found.masses / found.masses.sum(), found.centres)


@lru_cache(maxsize=256)
def _closed(robot: Robot) -> bool:
    """Return whether a robot has the chain of the closed form, and its pieces lie where that has them."""
    if lacking(robot, ("legs", "shells", "article_spine", "tail")):
        return False
    angles = 0.1 * np.arange(1.0, 1.0 + len(joint_names(robot)))
    found = pieces(robot, angles)
    centre = np.einsum("p,pi->i", found.masses / found.masses.sum(), found.centres)
    return bool(np.allclose(centre, tree.centre_of_mass(replace(robot, hull=None), angles), atol=1e-12 * robot.length))


def cantilever_torque(robot: Robot) -> float:
    """Return what the first pitch joint of a straight trunk must give to lift the level forebody off the ground [N m].

    The front legs hang out sideways, so that their weight acts at the shoulders.
    """
    found = pieces(robot, np.zeros(len(joint_names(robot))))
    joint = robot.spine.base + robot.spine.link
    ahead = found.centres[:, 0] - joint
    return float(GRAVITY * np.sum(found.masses[ahead > 0] * ahead[ahead > 0]))


def _trunk(robot: Robot, angles: np.ndarray) -> list[np.ndarray]:
    bends = angles[..., layout(robot).ahead]
    joints = spine.joints(robot.spine, bends)
    T = spine.forward(robot.spine, bends)
    shoulder, snout = robot.thorax.shoulder, robot.head.snout
    return [
        np.zeros((*angles.shape[:-1], 3)),
        *((joints[..., i, :] + joints[..., i + 1, :]) / 2 for i in range(4)),
        T[..., :3, 3] + shoulder / 2 * T[..., :3, 0],
        T[..., :3, 3] + (shoulder + snout) / 2 * T[..., :3, 0],
    ]


def _legs(robot: Robot, angles: np.ndarray) -> list[np.ndarray]:
    T = spine.forward(robot.spine, angles[..., layout(robot).ahead])
    shoulder = T[..., :3, 3] + robot.thorax.shoulder * T[..., :3, 0]
    found = []
    for i, name in enumerate(LEGS):
        links, bends = robot.leg(name), angles[..., layout(robot).limbs[i].hinges]
        knee, foot = leg.knee_point(links, bends), leg.forward(links, bends)
        hip = np.broadcast_to(np.array([links.hip_offset, 0.0, 0.0]), knee.shape)
        for point in ((hip + knee) / 2, (knee + foot) / 2, foot):
            at = body.from_leg_frame(point, name)
            if name.endswith("F"):
                at = shoulder + np.einsum("...ij,...j->...i", T[..., :3, :3], at)
            found.append(at)
    return found


def _tail(robot: Robot, angles: np.ndarray) -> list[np.ndarray]:
    points = body.tail_points(robot, angles[..., layout(robot).behind])
    cables = len(cable_joints(robot))
    # the middle of the last plate ends a segment, though no joint is there: the passive end begins
    assert points.shape[-2] == cables + 2 + robot.tail.fin_segments
    return [(points[..., i, :] + points[..., i + 1, :]) / 2 for i in range(points.shape[-2] - 1)]
