"""The leg: a yaw and a pitch axis that meet at the hip, and a knee.

All points are in the leg's D-H base frame on the midline of the body: x outward, y forward, z down; left and
right legs share the formulas (the right ones are mirrored). Positive angles move the
foot forward (yaw) and down (pitch) and bend the shank down (knee).
"""

import numpy as np
from jaxtyping import Bool, Float

from suchus.core.errors import Unreachable
from suchus.robot.kinematics.given import check_sign, rows
from suchus.robot.kinematics.leg_solution import ROUNDING, Lengths, solve
from suchus.robot.kinematics.links import LegLinks


def forward(leg: LegLinks, angles: Float[np.ndarray, "*batch 3"]) -> Float[np.ndarray, "*batch 3"]:
    """Return the position of the foot's centre.

    Args:
        leg: the lengths.
        angles: yaw, pitch, knee [rad].

    Returns:
        The foot in the leg's base frame [m].

    Paper: Eq. (7).
    """
    angles = rows(angles, 3, "the leg's angles")
    yaw, pitch, knee = np.moveaxis(angles, -1, 0)
    shank = pitch + knee
    reach = leg.femur * np.cos(pitch) + leg.tibia * np.cos(shank)
    foot = np.empty(angles.shape)
    foot[..., 0] = leg.hip_offset + np.cos(yaw) * reach
    foot[..., 1] = np.sin(yaw) * reach
    foot[..., 2] = leg.femur * np.sin(pitch) + leg.tibia * np.sin(shank)
    return foot


def knee_point(leg: LegLinks, angles: Float[np.ndarray, "*batch 3"]) -> Float[np.ndarray, "*batch 3"]:
    """Return where the knee is, in the leg's base frame [m]; ``angles`` as for ``forward``.

    Paper: Eqs (2), (3).
    """
    yaw, pitch, _ = np.moveaxis(rows(angles, 3, "the leg's angles"), -1, 0)
    reach = leg.femur * np.cos(pitch)
    return np.stack([leg.hip_offset + np.cos(yaw) * reach, np.sin(yaw) * reach, leg.femur * np.sin(pitch)], axis=-1)


def inverse(
    leg: LegLinks, foot: Float[np.ndarray, "*batch 3"], *, knee: int = 1, side: int = 1
) -> Float[np.ndarray, "*batch 3"]:
    """Return the joint angles that bring the foot to a point: (9) to (14) for every quadrant and branch.

    With ``side=-1`` the leg reaches over its own yaw axis; knee and foot then lie where they lie with
    ``side=1`` and the opposite ``knee``. For a foot on the yaw axis every yaw is a solution; 0, pi or -pi is
    returned.

    Args:
        leg: the lengths.
        foot: points in the leg's base frame [m].
        knee: sign of the knee angle, 1 (knee up) or -1.
        side: 1, or -1 for the solution with the yaw turned by half a turn.

    Returns:
        Yaw, pitch, knee in -pi to pi [rad].

    Raises:
        Unreachable: a point is nearer or farther than the leg can reach, or is not a number.
        InvalidDesign: ``knee`` or ``side`` is neither 1 nor -1.

    Paper: Eqs (8) to (14), Fig. 7.
    """
    for name, sign in (("knee", knee), ("side", side)):
        check_sign(sign, name)
    foot = rows(foot, 3, "the foot's place")
    points = np.ascontiguousarray(foot).reshape(-1, 3)
    angles, is_reachable = solve(Lengths.of([leg]), points, knee=knee, side=side)
    if not is_reachable:
        raise _unreachable(leg, points)
    return angles.reshape(foot.shape)


def jacobian(leg: LegLinks, angles: Float[np.ndarray, "*batch 3"]) -> Float[np.ndarray, "*batch 3 3"]:
    """Return how the foot moves with the joints [m/rad]; a foot force F needs the torques J^T F.

    Its determinant is ``-femur tibia r sin(knee)`` with r the foot's distance from the yaw axis: singular
    with a straight or folded knee, and with the foot on that axis.

    Args:
        leg: the lengths.
        angles: yaw, pitch, knee [rad].
    """
    yaw, pitch, knee = np.moveaxis(rows(angles, 3, "the leg's angles"), -1, 0)
    shank = pitch + knee
    s1, c1 = np.sin(yaw), np.cos(yaw)
    down, outward = leg.tibia * np.sin(shank), leg.tibia * np.cos(shank)
    z = leg.femur * np.sin(pitch) + down
    r = leg.femur * np.cos(pitch) + outward
    zero = np.zeros_like(r)
    partial = [[-s1 * r, -c1 * z, -c1 * down], [c1 * r, -s1 * z, -s1 * down], [zero, r, outward]]
    return np.stack([np.stack(row, axis=-1) for row in partial], axis=-2)


def reachable(leg: LegLinks, foot: Float[np.ndarray, "*batch 3"]) -> Bool[np.ndarray, "*batch"]:
    """Return which points the foot can reach, joint limits aside."""
    foot = rows(foot, 3, "the foot's place")
    with np.errstate(invalid="ignore", over="ignore"):
        squared = (foot[..., 0] - leg.hip_offset) ** 2 + foot[..., 1] ** 2 + foot[..., 2] ** 2
        cosine = (squared - (leg.femur**2 + leg.tibia**2)) / (2.0 * leg.femur * leg.tibia)
        return np.asarray(np.abs(cosine) <= 1.0 + ROUNDING)


def _unreachable(leg: LegLinks, points: np.ndarray) -> Unreachable:
    """Return the error that names the first of the points that the foot cannot reach."""
    bad = points[~reachable(leg, points)]
    min_reach, max_reach = abs(leg.femur - leg.tibia), leg.femur + leg.tibia
    hip = np.array([leg.hip_offset, 0.0, 0.0])
    with np.errstate(invalid="ignore", over="ignore"):
        distance = float(np.linalg.norm(bad[0] - hip))
    first_point = ", ".join(f"{c:.4g}" for c in bad[0])
    return Unreachable(
        f"{len(bad)} of {len(points)} foot points are out of reach; the first, ({first_point}) m, is {distance:.4g}"
        f" m from the hip, and {min_reach:.4g} to {max_reach:.4g} m can be reached: move it there.",
        points=bad,
        reach=(min_reach, max_reach),
    )
