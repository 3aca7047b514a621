"""The spine: yaw, pitch, yaw, pitch, yaw, from the pelvis forward.

Points are in frame 0, the pelvis: x forward, y left, z up. Positive yaw bends the front end left, positive
pitch bends it down. Frame 5 stands at the fifth joint, its x along the head, its z up when the spine is
straight.
"""

from collections.abc import Callable

import numpy as np
from jaxtyping import Float

from suchus.article.paper.tables import SPINE_CHAIN, Chain
from suchus.core.errors import Unreachable
from suchus.robot.kinematics import dh
from suchus.robot.kinematics.given import broadcast_to_shape, check_broadcast, check_sign, number, numbers, rows
from suchus.robot.kinematics.links import Numbers, SpineLinks

ROUNDING = 1e-12
"""How far a cosine may exceed one by rounding alone [-]."""
CHUNK = 1000
"""Points that ``least_bending`` solves at a time, to spare memory [-]."""
TRIALS = 48
"""First yaw angles that ``least_bending`` tries on each branch before it refines the best [-]."""
MIN_LEVELNESS, STEEP_COST = 0.05, 1e3
"""A head less level than this [-] has no azimuth to speak of; ``least_bending`` makes it cost much [rad2]."""
REFINEMENTS = 60
"""Golden-section steps of ``least_bending`` [-]: enough to exhaust double precision."""


def chain(spine: SpineLinks) -> Chain:
    """Return the D-H chain of a spine. Paper: Table II."""
    return Chain(a=(spine.base, *4 * (spine.link,)), alpha=SPINE_CHAIN.alpha, d=SPINE_CHAIN.d)


def forward(spine: SpineLinks, angles: Float[np.ndarray, "*batch 5"]) -> Float[np.ndarray, "*batch 4 4"]:
    """Return frame 5 in frame 0; its last column is joint 5 [m], its first the direction of the head.

    It is the product of Table II written out: each joint turns two of the axes before it.

    Args:
        spine: the lengths.
        angles: yaw, pitch, yaw, pitch, yaw [rad].

    Paper: Eq. (15).
    """
    angles = rows(angles, 5, "the spine's angles")
    c, s = np.cos(angles), np.sin(angles)
    c1, c2, c3, c4, c5 = (c[..., i, None] for i in range(5))
    s1, s2, s3, s4, s5 = (s[..., i, None] for i in range(5))
    vertical = np.array([0.0, 0.0, 1.0])
    x1 = np.concatenate([c1, s1, 0.0 * c1], axis=-1)
    lateral = np.concatenate(
        [-s1, c1, 0.0 * c1], axis=-1
    )  # the first pitch joint's axis; the others follow the body: x along, y left, z up
    x2, z2 = c2 * x1 - s2 * vertical, s2 * x1 + c2 * vertical
    x3, y3 = c3 * x2 + s3 * lateral, c3 * lateral - s3 * x2
    x4, z4 = c4 * x3 - s4 * z2, s4 * x3 + c4 * z2
    T = np.zeros((*angles.shape[:-1], 4, 4))
    T[..., :3, 0], T[..., :3, 1], T[..., :3, 2] = c5 * x4 + s5 * y3, c5 * y3 - s5 * x4, z4
    T[..., :3, 3] = spine.link * (x1 + x2 + x3 + x4)
    T[..., 0, 3] += spine.base
    T[..., 3, 3] = 1.0
    return T


def joints(spine: SpineLinks, angles: Float[np.ndarray, "*batch 5"]) -> Float[np.ndarray, "*batch 5 3"]:
    """Return where the five joints are [m]; ``angles`` as for ``forward``."""
    return dh.frames(chain(spine), angles)[..., :3, 3]


def jacobian(
    spine: SpineLinks, angles: Float[np.ndarray, "*batch 5"], *, forward_offset: float = 0.0
) -> Float[np.ndarray, "*batch 6 5"]:
    """Return how a point on the head moves with the joints: three rows [m/rad], then three of rotation [-].

    A straight spine is singular: no joint moves its end forward or backward.

    Args:
        spine: the lengths.
        angles: yaw, pitch, yaw, pitch, yaw [rad].
        forward_offset: how far the point lies ahead of joint 5 along the head [m].
    """
    T = dh.frames(chain(spine), angles)
    tip = T[..., -1, :3, 3] + number(forward_offset, "ahead") * T[..., -1, :3, 0]
    axes = T[..., :3, 2]  # (*batch, joint, 3)
    moves = np.cross(axes, tip[..., None, :] - T[..., :3, 3])
    return np.swapaxes(np.concatenate([moves, axes], axis=-1), -1, -2)


def inverse(
    spine: SpineLinks,
    point: Float[np.ndarray, "*point 3"],
    azimuth: Numbers,
    *,
    first_yaw: Numbers,
    branch: int = 1,
) -> Float[np.ndarray, "*batch 5"]:
    """Return the angles that bring joint 5 to a point and turn the head to an azimuth, for a given first yaw.

    Position and azimuth are four equations for five joints: the first yaw angle is free, and ``least_bending``
    chooses it. Point, azimuth and first yaw broadcast.

    Args:
        spine: the lengths.
        point: where joint 5 shall be, in frame 0 [m].
        azimuth: direction of the head seen from above, from x towards y [rad].
        first_yaw: the first angle [rad].
        branch: sign of the second pitch angle, 1 or -1.

    Returns:
        Yaw, pitch, yaw, pitch, yaw in -pi to pi [rad].

    Raises:
        Unreachable: a point cannot be reached with this first yaw angle, or is not a number.
        InvalidDesign: ``branch`` is neither 1 nor -1, an angle is no finite number, or shapes do not go together.
    """
    check_sign(branch, "branch")
    angles = candidates(spine, point, azimuth, first_yaw=first_yaw, branch=branch)
    is_unreachable = np.isnan(angles).any(axis=-1)
    if is_unreachable.any():
        raise _unreachable(
            spine, np.broadcast_to(point, (*is_unreachable.shape, 3))[is_unreachable], "with this first yaw angle"
        )
    return angles


def candidates(
    spine: SpineLinks,
    point: Float[np.ndarray, "*point 3"],
    azimuth: Numbers,
    *,
    first_yaw: Numbers,
    branch: Numbers,
) -> Float[np.ndarray, "*batch 5"]:
    """Return the angles of ``inverse``, with NaN for points that cannot be reached; the branch may be an array."""
    point = rows(point, 3, "the point")
    azimuth, first_yaw = numbers(azimuth, "the azimuth"), numbers(first_yaw, "the first yaw angle")
    branch = numbers(branch, "the branch")
    check_broadcast(point[..., 0], azimuth, first_yaw, branch, label="point, azimuth, first yaw angle and branch")
    return _closed_form(spine, point, azimuth, first_yaw, branch)[0]


def least_bending(
    spine: SpineLinks, point: Float[np.ndarray, "*batch 3"], azimuth: Numbers
) -> Float[np.ndarray, "*batch 5"]:
    """Return the angles of ``inverse`` whose squares have the least sum.

    The first yaw angle and the branch are free. The feasible first yaw angles are known in closed form; they
    are sampled, and the best sample is refined.

    Args:
        spine: the lengths.
        point: where joint 5 shall be, in frame 0 [m].
        azimuth: direction of the head seen from above, from x towards y [rad].

    Raises:
        Unreachable: a point cannot be reached with any first yaw angle, or is not a number.
    """
    point = rows(point, 3, "the point")
    points = point.reshape(-1, 3)
    heading = broadcast_to_shape(azimuth, point.shape[:-1], "the azimuth").reshape(-1, 1)
    starts = range(0, max(len(points), 1), CHUNK)
    solutions = [_minimise_bending(spine, points[i : i + CHUNK], heading[i : i + CHUNK]) for i in starts]
    return np.concatenate(solutions).reshape(*point.shape[:-1], 5)


def _minimise_bending(spine: SpineLinks, points: np.ndarray, heading: np.ndarray) -> np.ndarray:
    """Return the angles with the least sum of squares, shape (point, 5) [rad].

    Args:
        spine: the lengths.
        points: points of joint 5 in frame 0, shape (point, 3) [m].
        heading: azimuth of the head, shape (point, 1) [rad].
    """
    aim, lower_bound, upper_bound, is_unreachable = _feasible_yaw(spine, points)
    if is_unreachable.any():
        raise _unreachable(spine, points[is_unreachable], "by any posture")

    def posture(t: np.ndarray, case: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the closed form, (point, trial, 5), with the first yaw at ``sin(t)`` along an arc."""
        yaw_offset = (lower_bound + upper_bound) / 2 + (upper_bound - lower_bound) / 2 * np.sin(t)
        yaw = aim + np.where(case % 2, yaw_offset, -yaw_offset)
        return _closed_form(spine, points[:, None], heading, yaw, np.where(case < 2, 1, -1))

    def bending(t: np.ndarray, case: np.ndarray) -> np.ndarray:
        angles, level = posture(t, case)
        total = np.sum(angles**2, axis=-1) + STEEP_COST * (level < MIN_LEVELNESS)
        return np.where(np.isnan(total), np.inf, total)

    trials = np.tile(np.linspace(-np.pi / 2, np.pi / 2, TRIALS), 4)  # two arcs of the yaw times two branches
    cases = np.repeat(np.arange(4), TRIALS)
    best = np.argmin(bending(trials[None], cases[None]), axis=-1)
    case, center = cases[best][:, None], trials[best][:, None]
    step = np.pi / (TRIALS - 1)
    t = _golden_section(lambda trial: bending(trial, case), center - step, center + step)
    t = np.where(bending(t, case) <= bending(center, case), t, center)
    return posture(t, case)[0][:, 0]


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def _closed_form(
    spine: SpineLinks, point: np.ndarray, azimuth: np.ndarray, first_yaw: np.ndarray, branch: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the angles for a given first yaw, NaN where there are none, and the cosine of the head's tilt.

    Args:
        spine: the lengths.
        point: point of joint 5 in frame 0 [m].
        azimuth: azimuth of the head [rad].
        first_yaw: the first angle [rad].
        branch: sign of the second pitch angle.
    """
    s1, c1 = np.sin(first_yaw), np.cos(first_yaw)
    x, y = point[..., 0] - spine.base, point[..., 1]
    wx = (c1 * x + s1 * y) / spine.link - 1.0  # from joint 2 to joint 5, in links, seen from link 1
    wy = (c1 * y - s1 * x) / spine.link
    wz = point[..., 2] / spine.link
    K = (wx * wx + wy * wy + wz * wz - 1.0) / 2.0
    u = (K * K + wy * wy) / (2.0 * K)  # 1 + cos(second pitch)
    u = np.where((K > 0) & (u <= 2.0 + ROUNDING), np.minimum(u, 2.0), np.nan)
    s4, c4 = branch * np.sqrt(u * (2.0 - u)), u - 1.0
    third = np.arctan2(wy, K - u)
    second = _wrapped(np.arctan2(-s4, 1.0 + K - u) - np.arctan2(wz, wx))
    s2, c2, s3, c3 = np.sin(second), np.cos(second), np.sin(third), np.cos(third)
    forward4 = c2 * c3 * c4 - s2 * s4
    x4 = c1 * forward4 - s1 * s3 * c4, s1 * forward4 + c1 * s3 * c4  # seen from above
    z4 = -c1 * c2 * s3 - s1 * c3, c1 * c3 - s1 * c2 * s3
    sa, ca = np.sin(azimuth), np.cos(azimuth)
    fifth = np.arctan2(ca * x4[1] - sa * x4[0], sa * z4[0] - ca * z4[1])
    level = np.cos(fifth) * (ca * x4[0] + sa * x4[1]) + np.sin(fifth) * (ca * z4[0] + sa * z4[1])
    fifth = np.where(level < 0, _wrapped(fifth + np.pi), fifth)
    first_angle = np.where(np.isnan(u), np.nan, _wrapped(first_yaw))
    angles = np.broadcast_arrays(first_angle, second, third, np.arctan2(s4, c4), fifth)
    return np.stack(angles, axis=-1), np.asarray(np.abs(level))


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def _feasible_yaw(spine: SpineLinks, points: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return each point's azimuth, the bounds of the first yaw's distance from it [rad], and which points have none.

    Args:
        spine: the lengths.
        points: points of joint 5 in frame 0, shape (point, 3) [m].
    """
    x, y, z = ((points - [spine.base, 0.0, 0.0]) / spine.link).T[..., None]
    rho, M = np.hypot(x, y), (x * x + y * y + z * z) / 2.0
    bound = ((M - 2.0) ** 2 + rho * rho - 4.0) / (2.0 * (M - 2.0) * rho)
    nearest_cosine = np.where(M < 2.0, np.minimum(bound, M / rho), M / rho)
    farthest_cosine = np.where(M > 2.0, bound, -1.0)
    is_unreachable = (
        ~(farthest_cosine <= 1.0 + ROUNDING) | ~(nearest_cosine >= -1.0 - ROUNDING) | ((M == 2.0) & (rho > 2.0))
    )
    lower_bound = np.arccos(np.clip(nearest_cosine, -1.0, 1.0))
    upper_bound = np.arccos(np.clip(farthest_cosine, -1.0, 1.0))
    return np.arctan2(y, x), lower_bound, upper_bound, (is_unreachable | (lower_bound > upper_bound + ROUNDING))[:, 0]


def _golden_section(
    cost: Callable[[np.ndarray], np.ndarray], lower_bound: np.ndarray, upper_bound: np.ndarray
) -> np.ndarray:
    """Return where each cost is least between its bounds, by golden section, all elements at once.

    Args:
        cost: returns the cost at arguments of the shape of the bounds.
        lower_bound: lower bound of each interval.
        upper_bound: upper bound of each interval.
    """
    golden = (np.sqrt(5.0) - 1.0) / 2.0
    inner_lower = upper_bound - golden * (upper_bound - lower_bound)
    inner_upper = lower_bound + golden * (upper_bound - lower_bound)
    lower_cost, upper_cost = cost(inner_lower), cost(inner_upper)
    for _ in range(REFINEMENTS):
        falls = lower_cost > upper_cost
        lower_bound, upper_bound = np.where(falls, inner_lower, lower_bound), np.where(falls, upper_bound, inner_upper)
        probe = np.where(
            falls,
            lower_bound + golden * (upper_bound - lower_bound),
            upper_bound - golden * (upper_bound - lower_bound),
        )
        probe_cost = cost(probe)
        inner_lower, inner_upper = np.where(falls, inner_upper, probe), np.where(falls, probe, inner_lower)
        lower_cost, upper_cost = np.where(falls, upper_cost, probe_cost), np.where(falls, probe_cost, lower_cost)
    return np.asarray((lower_bound + upper_bound) / 2.0)


def _wrapped(angle: Numbers) -> np.ndarray:
    """Return the angle within -pi to pi."""
    return np.asarray(np.arctan2(np.sin(angle), np.cos(angle)))


def _unreachable(spine: SpineLinks, points: np.ndarray, condition: str) -> Unreachable:
    """Return the error that names the first of some points.

    Args:
        spine: the lengths.
        points: points that cannot be reached [m].
        condition: under which they cannot, as the end of a clause.
    """
    max_reach = 4.0 * spine.link
    with np.errstate(invalid="ignore", over="ignore"):
        distance = float(np.linalg.norm(points[0] - [spine.base, 0.0, 0.0]))
    first_point = ", ".join(f"{c:.4g}" for c in points[0])
    return Unreachable(
        f"{len(points)} points cannot be reached {condition}; the first, ({first_point}) m, is {distance:.4g} m from "
        f"joint 1, and {max_reach:.4g} m can be reached straight ahead, less up and down: move the point nearer "
        "or turn the first joint towards it.",
        points=points,
        reach=(0.0, max_reach),
    )
