"""Any limb: where its foot is, and the angles that bring it to a point.

Points are those of a left limb in the frame of its girdle, from the hip: forward, outward, up; right limbs are mirror
images with the same angles. Closed forms are chosen where they apply: yaw and pitch at the hip and a knee (the
article's leg), or yaw, pitch and roll at the hip and an elbow, whose redundant rotation is given by the swivel angle.
Any other chain takes damped Gauss-Newton steps with an analytic Jacobian.
"""

from typing import Literal, NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.core.errors import NotConverged, Unreachable
from suchus.robot.design import Girdle, Limb
from suchus.robot.design.layout import LIMB_AXES
from suchus.robot.kinematics import leg as closed
from suchus.robot.kinematics.given import broadcast_to_shape, rows
from suchus.robot.kinematics.tree import rotation

STEPS = 60
"""Gauss-Newton steps at most [-]; along a gait 2 to 5 are needed."""
_STEP, _DAMPING, _ERROR_TOLERANCE = (
    0.6,
    0.01,
    1e-10,
)  # greatest step [rad]; greatest damping [-]; error at which a point is done [limb reach]
SEEDS = 40
"""Starts for those that get stuck, most of them on a joint limit near the hip [-]."""


class PlainLeg(NamedTuple):
    """A limb of yaw, pitch and knee, its links straight out, as ``suchus.robot.kinematics.leg`` takes it."""

    hip_offset: float
    """Distance from the midline to the yaw axis [m]."""
    femur: float
    """Length from hip to knee [m]."""
    tibia: float
    """Length from knee to the foot's centre [m]."""
    foot_radius: float
    """Radius of the foot's ball [m]."""
    hip_height: float
    """Height of the hip over the axis of the body [m]."""

    @property
    def reach(self) -> tuple[float, float]:
        """Nearest and farthest distance of the foot from the hip [m]."""
        return abs(self.femur - self.tibia), self.femur + self.tibia


Kind = Literal["leg", "arm", "other"]
"""``leg``: yaw, pitch, knee. ``arm``: yaw, pitch, roll, elbow. ``other``: any other chain."""


def kind(limb: Limb) -> Kind:
    """Return the method by which a limb is solved."""
    turns = [[hinge.turn for hinge in link.hinges] for link in limb.links]
    straight = all(link.end[0] == link.end[2] == 0.0 and link.end[1] > 0.0 for link in limb.links)
    if straight and turns == [["yaw", "pitch"], ["pitch"]]:
        return "leg"
    return "arm" if straight and turns == [["yaw", "pitch", "roll"], ["pitch"]] else "other"


def plain(girdle: Girdle) -> PlainLeg:
    """Return the lengths of a limb of the kind ``leg``."""
    femur, tibia = girdle.limb.links
    return PlainLeg(girdle.aside, femur.length, tibia.length, girdle.limb.foot.radius, girdle.above)


def forward(limb: Limb, angles: Float[np.ndarray, "*batch hinge"]) -> Float[np.ndarray, "*batch 3"]:
    """Return the centre of the foot, from the hip [m]."""
    return _chain(limb, rows(angles, len(limb.hinges), "the limb's angles"))[0]


def reach(limb: Limb) -> tuple[float, float]:
    """Return the nearest and the farthest distance of the foot from the hip, joint limits aside [m].

    For a limb of more than two links the nearest is taken as zero, unless one link is longer than all others together.
    """
    lengths = sorted(link.length for link in limb.links)
    return max(lengths[-1] - sum(lengths[:-1]), 0.0) if len(lengths) > 1 else lengths[0], sum(lengths)


def inverse(
    limb: Limb,
    foot: Float[np.ndarray, "*batch 3"],
    *,
    swivel: float | Float[np.ndarray, "*batch"] = 0.0,
    start: Float[np.ndarray, "*batch hinge"] | None = None,
    tries: int = SEEDS,
) -> Float[np.ndarray, "*batch hinge"]:
    """Return the angles that bring a foot to points.

    Args:
        limb: the limb.
        foot: position of the foot from the hip: forward, outward, up [m].
        swivel: for a limb of the kind ``arm``: rotation of the elbow forward about the line from hip to foot, 0 where
            it stands up [rad].
        start: angles near the answer, for chains without a closed form [rad]; the middle of the ranges if None.
        tries: how often such a chain begins again elsewhere before it gives up [-].

    Raises:
        Unreachable: a point is nearer or farther than the limb can reach, or is not a number.
        NotConverged: no answer was found within the joints' limits, for chains without a closed form.
    """
    points = rows(foot, 3, "the foot's place")
    _refuse_far(limb, points)
    method = kind(limb)
    if method == "leg":
        links = limb.links
        base = np.stack([points[..., 1], points[..., 0], -points[..., 2]], axis=-1)
        return closed.inverse(PlainLeg(0.0, links[0].length, links[1].length, 0.0, 0.0), base)
    if method == "arm":
        return _arm(limb, points, broadcast_to_shape(swivel, points.shape[:-1], "the swivel angle of the limb"))
    return _numeric(limb, points, start, tries)


def _refuse_far(limb: Limb, points: np.ndarray) -> None:
    """Refuse points that are nearer to the hip or farther from it than the limb can reach."""
    min_reach, max_reach = reach(limb)
    distance = np.linalg.norm(points, axis=-1)
    bad = ~((distance >= min_reach * (1 - 1e-9) - 1e-12 * max_reach) & (distance <= max_reach * (1 + 1e-9)))
    if bad.any():
        unreachable = points[bad]
        first_point = ", ".join(f"{c:.4g}" for c in unreachable[0])
        raise Unreachable(
            f"{len(unreachable)} of {distance.size} foot points are out of reach; the first, ({first_point}) m "
            "from the hip, is "
            f"{np.linalg.norm(unreachable[0]):.4g} m away, and {min_reach:.4g} to {max_reach:.4g} m can be "
            "reached: move it there.",
            points=unreachable,
            reach=(min_reach, max_reach),
        )


def _arm(limb: Limb, foot: np.ndarray, swivel: np.ndarray) -> np.ndarray:
    """Return yaw, pitch, roll and elbow of a limb of the kind ``arm``, shape (*batch, 4) [rad].

    The cosine law gives the elbow's angle. Its position on a circle about the line from hip to foot follows from the
    swivel angle. Feet out of reach are not refused: the elbow's cosine is clipped.

    Args:
        limb: the design; its first two links are the upper and the lower one.
        foot: centre of the foot from the hip: forward, outward, up, shape (*batch, 3) [m].
        swivel: rotation of the elbow forward about the line from hip to foot, 0 where it stands up, shape (*batch,)
            [rad].
    """
    upper_length, lower_length = limb.links[0].length, limb.links[1].length
    x, y, z = np.moveaxis(foot, -1, 0)
    distance_squared = x * x + y * y + z * z
    distance = np.sqrt(distance_squared)
    elbow = np.arccos(
        np.clip((distance_squared - upper_length**2 - lower_length**2) / (2.0 * upper_length * lower_length), -1.0, 1.0)
    )
    horizontal_distance = np.hypot(x, y)
    safe_horizontal_distance = np.maximum(horizontal_distance, 1e-300)
    # position of the elbow along the line from hip to foot
    axial_offset = (upper_length**2 - lower_length**2 + distance_squared) / (2.0 * distance)
    radial_offset = np.sqrt(np.maximum(upper_length**2 - axial_offset**2, 0.0))
    ux, uy, uz = x / distance, y / distance, z / distance
    upward, sideways = radial_offset * np.cos(swivel), radial_offset * np.sin(swivel)
    # the elbow is off the line by two offsets normal to it: one in the line's vertical plane, upward, and one level and
    # forward; for a foot straight below the hip these two directions are outward and forward
    azimuth_cos = np.where(horizontal_distance > 0, y / safe_horizontal_distance, 1.0)
    ex = axial_offset * ux - upward * uz * x / safe_horizontal_distance + sideways * azimuth_cos
    ey = axial_offset * uy - upward * uz * azimuth_cos - sideways * x / safe_horizontal_distance
    ez = axial_offset * uz + upward * horizontal_distance / distance
    yaw, pitch = np.arctan2(ex, ey), np.arctan2(-ez, np.hypot(ex, ey))
    sin_yaw, cos_yaw, sin_pitch, cos_pitch = np.sin(yaw), np.cos(yaw), np.sin(pitch), np.cos(pitch)
    lx, ly, lz = x - ex, y - ey, z - ez
    forward_part = cos_yaw * lx - sin_yaw * ly
    down_part = -(sin_yaw * sin_pitch * lx + cos_yaw * sin_pitch * ly + cos_pitch * lz)
    return np.stack([yaw, pitch, np.arctan2(forward_part, down_part), elbow], axis=-1)


def _numeric(limb: Limb, points: np.ndarray, start: np.ndarray | None, tries: int = SEEDS) -> np.ndarray:
    """Solve by damped Gauss-Newton steps within the joints' ranges; points without a solution start again elsewhere.

    Args:
        limb: the design.
        points: points of the foot from the hip, shape (*batch, 3) [m].
        start: angles near the answer [rad]; the middle of the ranges if None.
        tries: how often a point may start again [-].
    """
    count = len(limb.hinges)
    lower_bound, upper_bound = np.array([hinge.range or (-np.inf, np.inf) for hinge in limb.hinges]).T
    flat = points.reshape(-1, 3)
    center = np.where(np.isfinite(lower_bound), (lower_bound + upper_bound) / 2.0, 0.0)
    start_angles = broadcast_to_shape(
        center if start is None else start, (*points.shape[:-1], count), "the start"
    ).reshape(-1, count)
    angles, error = _descend(limb, flat, np.clip(start_angles, lower_bound, upper_bound), lower_bound, upper_bound)
    rng = np.random.default_rng(0)
    for _ in range(tries):
        stuck = np.flatnonzero(error > 1e-7)
        if not stuck.size:
            break
        ends = (
            np.where(np.isfinite(lower_bound), lower_bound, -np.pi),
            np.where(np.isfinite(upper_bound), upper_bound, np.pi),
        )
        new_angles, new_error = _descend(
            limb, flat[stuck], rng.uniform(*ends, (stuck.size, count)), lower_bound, upper_bound
        )
        better = new_error < error[stuck]
        angles[stuck[better]], error[stuck[better]] = new_angles[better], new_error[better]
    if (error > 1e-7).any():
        worst_index = int(np.argmax(error))
        coordinates = ", ".join(f"{c:.4g}" for c in flat[worst_index])
        raise NotConverged(
            f"{int((error > 1e-7).sum())} of {len(flat)} foot points were not reached within the joints' ranges; the "
            f"worst, ({coordinates}) m from the hip, is missed by {error[worst_index] * limb.reach:.3g} m: move "
            "it, or widen a range."
        )
    return angles.reshape(*points.shape[:-1], count)


def _descend(
    limb: Limb, points: np.ndarray, angles: np.ndarray, lower_bound: np.ndarray, upper_bound: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return angles and remaining errors after damped Gauss-Newton steps from a start.

    Args:
        limb: the design.
        points: points of the foot from the hip, shape (point, 3) [m].
        angles: angles at the start, shape (point, hinge) [rad].
        lower_bound: lower bound of each hinge [rad].
        upper_bound: upper bound of each hinge [rad].
    """
    size, angles = limb.reach, angles.copy()
    error = np.full(len(points), np.inf)
    active = np.arange(len(points))
    for _ in range(STEPS):
        foot, jacobian = _chain(limb, angles[active])
        miss = (points[active] - foot) / size
        error[active] = np.linalg.norm(miss, axis=-1)
        is_unfinished = error[active] > _ERROR_TOLERANCE
        active, miss, jacobian = active[is_unfinished], miss[is_unfinished], jacobian[is_unfinished] / size
        if not active.size:
            break
        damping = np.minimum(_DAMPING, error[active] ** 2)  # it falls with the error; a constant one slows convergence
        normal = jacobian.transpose(0, 2, 1) @ jacobian + damping[:, None, None] * np.eye(angles.shape[1])
        normal += 1e-12 * np.eye(angles.shape[1])
        step = np.linalg.solve(normal, np.einsum("bij,bi->bj", jacobian, miss)[..., None])[..., 0]
        angles[active] = np.clip(angles[active] + np.clip(step, -_STEP, _STEP), lower_bound, upper_bound)
    return angles, error


def _chain(limb: Limb, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the foot's position [m] and its Jacobian over the hinges [m/rad].

    Args:
        limb: the design.
        angles: angles of the hinges, shape (*batch, hinge) [rad].
    """
    batch = angles.shape[:-1]
    turn = np.broadcast_to(np.eye(3), (*batch, 3, 3))
    place, pivots, axes, i = np.zeros((*batch, 3)), [], [], 0
    for link in limb.links:
        for hinge in link.hinges:
            axis = LIMB_AXES[hinge.turn]
            pivots.append(place)
            axes.append(turn @ np.array(axis))
            turn = turn @ rotation(axis, angles[..., i])
            i += 1
        place = place + turn @ np.array(link.end)
    columns = [np.cross(axis, place - pivot) for axis, pivot in zip(axes, pivots, strict=True)]
    return place, np.stack(columns, axis=-1)
