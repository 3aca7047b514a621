"""The article's formulas as printed, misprints included, for comparison with the right ones.

Nothing else in suchus may compute with them. Where a printed formula has no value, NaN comes out.
"""

import numpy as np
from jaxtyping import Float

from suchus.article.paper.tables import LEG_CHAIN, Chain
from suchus.robot.kinematics import dh
from suchus.robot.kinematics.given import numbers, rows
from suchus.robot.kinematics.links import LegLinks, Numbers, SpineLinks, TailPlates

LOST_TERM = 0.0005
"""The 0.5 mm of (15) where 60.5 mm C4 belong [m]."""


def leg_table_by_label(angles: Float[np.ndarray, "*batch 4"]) -> Float[np.ndarray, "*batch 3"]:
    """Return the leg's end [m] if row i of Table I is fed to (1) under its printed labels a_i and alpha_i.

    Paper: Table I.
    """
    a, alpha = LEG_CHAIN.a, LEG_CHAIN.alpha
    T = dh.frames(Chain(a=(0.0, *a[:3]), alpha=(0.0, *alpha[:3]), d=LEG_CHAIN.d), angles)[..., -1, :, :]
    return T[..., :3, 3] + a[3] * T[..., :3, 0]


def leg_by_matrix_subscripts(angles: Float[np.ndarray, "*batch 3"]) -> Float[np.ndarray, "*batch 3"]:
    """Return (7) [m] with the subscripts of (2) to (5): a2 = 0 and a3 = 86 mm; a0, then undefined, is 70 mm.

    Paper: Eqs (2) to (7).
    """
    yaw, pitch, knee = np.moveaxis(rows(angles, 3, "the leg's angles"), -1, 0)
    a0, a2, a3 = LEG_CHAIN.a[0], LEG_CHAIN.a[1], LEG_CHAIN.a[2]
    r = a2 * np.cos(pitch) + a3 * np.cos(pitch + knee)
    z = a2 * np.sin(pitch) + a3 * np.sin(pitch + knee)
    return np.stack([a0 + np.cos(yaw) * r, np.sin(yaw) * r, z], axis=-1)


def leg_inverse(leg: LegLinks, foot: Float[np.ndarray, "*batch 3"]) -> Float[np.ndarray, "*batch 3"]:
    """Return the angles of the printed solution [rad], plain arctan, no branches.

    Paper: Eqs (9) to (14).
    """
    foot = rows(foot, 3, "the foot's place")
    u, v, w = foot[..., 0] - leg.hip_offset, foot[..., 1], foot[..., 2]
    rho = np.hypot(u, v)
    squared = rho**2 + w**2
    a2, a3 = leg.femur, leg.tibia
    with np.errstate(divide="ignore", invalid="ignore"):
        yaw = np.arctan(v / u)
        caz = np.arctan(rho / w)
        cab = np.arccos((a2**2 - a3**2 + squared) / (2 * a2 * np.sqrt(squared)))
        abc = np.arccos((a2**2 + a3**2 - squared) / (2 * a2 * a3))
    return np.stack([yaw, np.pi / 2 - caz - cab, np.pi - abc], axis=-1)


def knee_by_wrong_side(leg: LegLinks, foot: Float[np.ndarray, "*batch 3"]) -> Float[np.ndarray, "*batch"]:
    """Return the knee angle [rad] that the denominator 2 AB AC gives.

    Paper: Eq. (10).
    """
    foot = rows(foot, 3, "the foot's place")
    ac = np.linalg.norm(foot - np.array([leg.hip_offset, 0.0, 0.0]), axis=-1)
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = (leg.femur**2 + leg.tibia**2 - ac**2) / (2 * leg.femur * ac)
        return np.asarray(np.pi - np.arccos(cosine))


def spine_position(spine: SpineLinks, angles: Float[np.ndarray, "*batch 5"]) -> Float[np.ndarray, "*batch 3"]:
    """Return the spine's end [m] with the 0.5 mm that stand where 60.5 mm C4 belong.

    Paper: Eq. (15).
    """
    angles = rows(angles, 5, "the spine's angles")
    s1, s2, s3, s4, _ = np.moveaxis(np.sin(angles), -1, 0)
    c1, c2, c3, c4, _ = np.moveaxis(np.cos(angles), -1, 0)
    x = c1 + c1 * c2 - s1 * s3 - c4 * s1 * s3 - c1 * s2 * s4 + c1 * c2 * c3
    y = s1 + s1 * c2 + c1 * s3 + c1 * c4 * s3 - s1 * s2 * s4 + c2 * c3 * s1
    z = -s2 - s2 * c3 - c2 * s4 - c3 * c4 * s2
    return np.stack(
        [
            spine.link * x + LOST_TERM * c1 * c2 * c3 + spine.base,
            spine.link * y + LOST_TERM * c2 * c3 * s1,
            spine.link * z,
        ],
        axis=-1,
    )


def cable_changes(tail: TailPlates, bend: Numbers) -> tuple[np.ndarray, np.ndarray]:
    """Return (16) as printed, one joint's change given as the cord's: toward and away from the bend [m].

    Paper: Eq. (16).
    """
    theta, count = numbers(bend, "the bend", finite=False), tail.joints
    turn = tail.cord_spacing * np.sin(theta / (2 * count))
    sag = 2 * tail.gap * np.sin(theta / (4 * count)) ** 2
    return np.asarray(-(turn + sag)), np.asarray(turn - sag)


def cable_changes_shortened(tail: TailPlates, bend: Numbers) -> tuple[np.ndarray, np.ndarray]:
    """Return (17), one joint's change without its quadratic term: toward and away from the bend [m].

    Paper: Eq. (17).
    """
    turn = tail.cord_spacing * np.sin(numbers(bend, "the bend", finite=False) / (2 * tail.joints))
    return np.asarray(-turn), np.asarray(turn)


def servo_angle_deg(tail: TailPlates, bend: Numbers) -> np.ndarray:
    """Return the pulley's angle as printed, in degrees for a bend in radians.

    Paper: Eq. (18).
    """
    sine = np.sin(numbers(bend, "the bend", finite=False) / (2 * tail.joints))
    return np.asarray(180 / (np.pi * tail.pulley) * tail.joints * tail.cord_spacing * sine)


def joint_positions(tail: TailPlates, bend: Numbers) -> Float[np.ndarray, "*batch joint 2"]:
    """Return the tail's joints [m] with the index i under the sum, two cosines and the lost first half pitch.

    Paper: Eq. (19).
    """
    theta = numbers(bend, "the bend", finite=False)[..., None]
    i = np.arange(1, tail.joints + 1)
    pitch = tail.plate + tail.gap
    coordinate = (i - 1) * pitch * np.cos(i * theta / tail.joints)
    places = np.stack([coordinate, coordinate], axis=-1)
    places[..., 0, 0] = pitch / 2
    return places
