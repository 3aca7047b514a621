"""The cable section of the tail: plates that two cords bend sideways, every joint by the same angle.

The plane of the tail: origin in the middle of the first plate, x backward, y to the robot's right. A positive
bend turns the tip to the right. "Toward" is the cord on the side of a positive bend.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.core.errors import OutsideLimits
from suchus.robot.kinematics.given import numbers
from suchus.robot.kinematics.links import Cords, Numbers, TailPlates


def bend_limit(tail: TailPlates) -> float:
    """Return the bend at which the cords' holes meet on the inner side of every gap [rad]."""
    return float(2 * tail.joints * np.arctan2(tail.gap, tail.cord_spacing))


class CordChanges(NamedTuple):
    """Changes of the cords' lengths inside the tail, positive where a cord gets longer."""

    toward: Float[np.ndarray, "*batch"]
    """Change of the cord on the side of a positive bend [m]."""
    away: Float[np.ndarray, "*batch"]
    """Change of the other cord [m]."""


def cable_changes(tail: TailPlates, bend: Numbers) -> CordChanges:
    """Return by how much both cords get longer inside the tail, exactly, over all joints.

    Args:
        tail: the measures of the cable section.
        bend: total angle of the cable section [rad].

    Raises:
        OutsideLimits: a bend closes the gaps between the plates.

    Paper: Eq. (16), times N.
    """
    theta = numbers(bend, "the bend")
    limit = bend_limit(tail)
    if not np.all(np.abs(theta) <= limit):
        worst_bend = float(theta.flat[np.argmax(~(np.abs(theta.ravel()) <= limit))])
        raise OutsideLimits(
            f"a tail bend of {worst_bend:.4g} rad closes the gaps between the plates; -{limit:.4g} to {limit:.4g} "
            "rad is allowed: bend less, or choose wider gaps or a narrower cord spacing."
        )
    count = tail.joints
    turn = count * tail.cord_spacing * np.sin(theta / (2 * count))
    sag = 2 * count * tail.gap * np.sin(theta / (4 * count)) ** 2
    return CordChanges(toward=np.asarray(-turn - sag), away=np.asarray(turn - sag))


def slack(tail: TailPlates, bend: Numbers) -> Float[np.ndarray, "*batch"]:
    """Return the length by which both cords together get slack in a bend [m]: on one pulley they cannot stay taut.

    Args:
        tail: the measures of the cable section.
        bend: total angle of the cable section [rad].

    Raises:
        OutsideLimits: a bend closes the gaps between the plates.
    """
    changes = cable_changes(tail, bend)
    return np.asarray(-(changes.toward + changes.away))


def servo_angle(tail: Cords, bend: Numbers) -> Float[np.ndarray, "*batch"]:
    """Return how far the servo's pulley turns for a bend [rad].

    Args:
        tail: the measures of the cable section.
        bend: total angle of the cable section [rad].

    Paper: Eq. (18).
    """
    half = numbers(bend, "the bend") / (2 * tail.joints)
    return np.asarray(tail.joints * tail.cord_spacing * np.sin(half) / tail.pulley)


def bend_of_servo(tail: Cords, angle: Numbers) -> Float[np.ndarray, "*batch"]:
    """Return the bend that the servo's pulley makes [rad]: the inverse of ``servo_angle``.

    Args:
        tail: the measures of the cable section.
        angle: angle of the pulley [rad].

    Raises:
        OutsideLimits: the pulley would pull more cord than any bend of the tail takes up.
    """
    sine = numbers(angle, "the pulley's angle") * tail.pulley / (tail.joints * tail.cord_spacing)
    if not np.all(np.abs(sine) <= 1.0):
        limit = tail.joints * tail.cord_spacing / tail.pulley
        worst_angle = float(np.asarray(angle).flat[np.argmax(~(np.abs(sine.ravel()) <= 1.0))])
        raise OutsideLimits(
            f"a pulley angle of {worst_angle:.4g} rad pulls more cord than the tail takes up; -{limit:.4g} to "
            f"{limit:.4g} rad is allowed: turn it less or choose a smaller pulley."
        )
    return np.asarray(2 * tail.joints * np.arcsin(sine))


def joint_positions(tail: TailPlates, bend: Numbers) -> Float[np.ndarray, "*batch joint 2"]:
    """Return where the joints are in the plane of the tail [m].

    Args:
        tail: the measures of the cable section.
        bend: total angle of the cable section [rad].

    Paper: Eq. (19).
    """
    theta = numbers(bend, "the bend")[..., None]
    pitch = tail.plate + tail.gap
    plate_angles = np.arange(tail.joints) * theta / tail.joints  # angle of the plate ahead of each joint
    steps = np.stack([np.cos(plate_angles), np.sin(plate_angles)], axis=-1) * pitch
    steps[..., 0, :] /= 2  # the first joint is half a pitch from the middle of its plate
    return np.cumsum(steps, axis=-2)


def end_position(tail: TailPlates, bend: Numbers) -> Float[np.ndarray, "*batch 2"]:
    """Return the middle of the last plate in the plane of the tail [m]; the flexible end begins there."""
    theta = numbers(bend, "the bend")
    half = (tail.plate + tail.gap) / 2
    return joint_positions(tail, theta)[..., -1, :] + half * np.stack([np.cos(theta), np.sin(theta)], axis=-1)
