"""A first walk for a body that has none: foot paths that its limbs reach, at a height at which its belly is clear."""

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from math import cos, pi, radians

import numpy as np
from scipy.spatial import cKDTree

from suchus.core.errors import NotConverged, OutsideLimits, Unreachable
from suchus.robot.design import Crank, Girdle, Limb, Robot, layout, servo_ranges
from suchus.robot.design.scale import gravity_time
from suchus.robot.kinematics import limb as limb_kinematics
from suchus.robot.motion.axis import yaw_hinges
from suchus.robot.motion.draft_table import is_upright, table_walk
from suchus.robot.motion.gait import Gait
from suchus.robot.motion.limbs import foot_path
from suchus.robot.motion.limits import check_limits, min_gait_period
from suchus.robot.motion.parts import Bend, FootPath, Sweep

_HALF_STROKES = (0.2, 0.15, 0.1, 0.06)  # [limb reach]; the longest one that all girdles can follow is chosen
_HEIGHTS = (
    0.5,
    0.55,
    0.6,
    0.45,
    0.65,
    0.7,
    0.4,
    0.75,
    0.8,
    0.85,
    0.35,
    0.3,
    0.9,
)  # [limb reach]; the first feasible one is chosen
_LIFT = 0.7  # of the stroke
_MIN_OUTWARD = 0.3  # [limb reach]; limbs that hang down stand at least so far outside their hips, or the body rolls
_OUTWARD = (0.55, 0.45, 0.35, 0.25, 0.15, 0.05, 0.65, 0.75, 0.0)
_FORWARD_OFFSETS = (0.0, 0.1, -0.1, 0.2, -0.2)
_DUTY = 0.6
_PERIOD = 6.0  # in gravity times; the built-in walks take 4 to 10
_STANCE = radians(80)  # angle that a crank turns through in stance
_BEND, _SHARE = radians(10), 0.3  # amplitude of a trunk joint [rad]; its greatest fraction of the joint's range [-]
# random postures that sample a limb's reach [-]; greatest distance of a path from them [limb reach]
_CLOUD, _CLOUD_TOLERANCE = 16000, 0.05
_SAMPLES, _JUMP, _MARGIN = (
    24,
    0.7,
    0.02,
)  # samples of a path [-]; greatest jump between two of them [rad]; distance from a joint's stop [rad]
_TRIES, _MAX_SOLVES = 2, 80  # starts of a limb without a closed form; paths that are solved before the search ends
_SPEED = 0.6  # greatest speed of a joint over that of its servo [-]
_PLANAR = 2  # hinges of a limb whose foot moves on a surface only


def draft_gait(robot: Robot, name: str) -> Gait:
    """Return a walk that a robot's limbs can follow, in lengths of its own; of a body without limbs, an undulation.

    Diagonal limbs go together; trunk joints bend a little with them. It is a beginning, not the best. Limbs of
    two hinges and upright ones, whose feet move on a surface only, get a curve for each servo.

    Args:
        robot: any robot.
        name: name of the gait.

    Raises:
        OutsideLimits: no path was found that all limbs reach within their ranges.
    """
    girdles = robot.girdles
    phases = tuple(0.5 * ((i + right) % 2) for i in range(len(girdles)) for right in (0, 1))
    period = _PERIOD * gravity_time(robot.length)
    if not girdles:
        gait = _undulation(robot, name, period)
    elif all(_is_crank(girdle.limb) or _walks_by_paths(girdle.limb) for girdle in girdles):
        gait = _first_feasible_walk(robot, name, phases, period)
    else:
        gait = table_walk(
            robot, name=name, period=period, duty_factor=_DUTY, phases=phases, axis=_axis(robot), path=_unit_path()
        )
    try:
        gait = _with_feasible_period(robot, gait)
        check_limits(robot, gait)
    except NotConverged as error:
        raise OutsideLimits(f"no walk was found for robot {robot.name!r}: {error}") from error
    return gait


def _first_feasible_walk(robot: Robot, name: str, phases: tuple[float, ...], period: float) -> Gait:
    """Return the first walk whose foot paths all limbs can follow; longer strokes are tried first, then heights.

    Args:
        robot: the design.
        name: name of the gait.
        phases: phases of the limbs [cycle].
        period: period of the gait [s].

    Raises:
        OutsideLimits: the limbs can follow none of the paths, or the numerical solutions were used up before.
    """
    girdles = robot.girdles
    clouds, solve_budget = [_cloud(girdle.limb) for girdle in girdles], iter(range(_MAX_SOLVES))
    axis_bends = _axis(robot)
    for half_stroke in _HALF_STROKES:
        for height in _heights(robot):
            limb_motions = []
            for girdle, cloud in zip(girdles, clouds, strict=True):
                limb_motion = _first_reachable_path(robot, girdle, cloud, height, half_stroke, solve_budget)
                if limb_motion is None:
                    break
                limb_motions.append(limb_motion)
            if len(limb_motions) == len(girdles):
                return Gait(
                    name=name,
                    period=period,
                    duty_factor=_DUTY,
                    limb_phases=phases,
                    limbs=tuple(limb_motions),
                    height=height,
                    axis=axis_bends,
                )
    if next(solve_budget, None) is None:
        raise OutsideLimits(
            f"no walk was found for robot {robot.name!r}: the search ended after {_MAX_SOLVES} numerical solutions of "
            "its limbs, before all paths were tried; write a gait of its own."
        )
    raise OutsideLimits(
        f"no walk was found for robot {robot.name!r}: its limbs reach no path of {_HALF_STROKES[-1]:g} of their reach "
        "within their ranges; widen the ranges, or write a gait of its own."
    )


def _undulation(robot: Robot, name: str, period: float) -> Gait:
    """Return a wave along the whole axis that grows toward the tail."""
    min_range, count = float(np.abs(servo_ranges(robot)).min()), len(yaw_hinges(robot).servos)
    amplitude = (count * min(radians(15), _SHARE * min_range), count * min(radians(35), 0.5 * min_range))
    wave = Bend(part="axis", amplitude=amplitude, lag=(0.0, 1.0))
    return Gait(name=name, period=period, duty_factor=_DUTY, axis=(wave,))


def _heights(robot: Robot) -> list[float]:
    """Return heights of the hindmost hips [limb reach]: those first at which the belly is clear, cranks' own alone."""
    hind = robot.girdles[-1]
    if _is_crank(hind.limb):
        _, depth = _lowest_foot(hind.limb)
        return [(depth * cos(_STANCE / 4) + hind.limb.foot.radius) / hind.limb.reach]
    belly = max(shape.bottom for segment in robot.axis for shape in segment.shapes) + hind.above
    clear = [h for h in _HEIGHTS if h * hind.limb.reach > belly + 0.05 * hind.limb.reach]
    return [*clear, *(h for h in sorted(_HEIGHTS, reverse=True) if h not in clear)]


def _first_reachable_path(
    robot: Robot, girdle: Girdle, cloud: cKDTree, height: float, half_stroke: float, solve_budget: Iterator[int]
) -> FootPath | Sweep | None:
    """Return the first foot path that a girdle's limbs can follow at a hip height; None if they can follow none.

    Paths differ in how far outward and forward of the hip they lie. A limb of one crank gets its sweep at once.

    Args:
        robot: the design.
        girdle: girdle of the limbs.
        cloud: points that the foot can reach, from the hip [m].
        height: height of the hindmost hips above the ground, over the reach of their limbs [-].
        half_stroke: half of the path's length, over the reach of the limb [-].
        solve_budget: iterator with one item for each numerical solution that is left; a limb with a closed form uses
            none.
    """
    limb = girdle.limb
    if _is_crank(limb):
        return Sweep(stance=_STANCE, down=_lowest_foot(limb)[0])
    hindmost = robot.girdles[-1]
    hip_to_foot_drop = height * hindmost.limb.reach - hindmost.above + girdle.above - limb.foot.radius
    lift = round(_LIFT * half_stroke, 4)
    has_closed_form = limb_kinematics.kind(limb) != "other"
    forward, upward = np.array([[half_stroke], [lift]]) * _unit_path() * limb.reach
    for outward, forward_offset in _foot_offsets(limb):
        path_points = np.stack(
            [forward + forward_offset * limb.reach, np.full(_SAMPLES, outward * limb.reach), upward - hip_to_foot_drop],
            axis=-1,
        )
        may_reach = (
            has_closed_form
            or float(np.max(cloud.query(path_points[:: _SAMPLES // 4])[0])) < _CLOUD_TOLERANCE * limb.reach
        )
        if may_reach and (has_closed_form or next(solve_budget, None) is not None) and _can_follow(limb, path_points):
            return FootPath(stroke=half_stroke, lift=lift, outward=outward, ahead=forward_offset)
    return None


def _foot_offsets(limb: Limb) -> Iterator[tuple[float, float]]:
    """Yield how far outside and ahead of the hip a foot may stand [limb reach]: as it is drawn first, if it stands."""
    resting_foot = limb_kinematics.forward(limb, np.zeros(len(limb.hinges))) / limb.reach
    if resting_foot[2] < -0.4:
        for forward_offset in (0.0, 0.1, -0.1):
            for outward in (max(resting_foot[1], _MIN_OUTWARD), resting_foot[1]):
                yield float(np.clip(outward, -1, 1)), float(np.clip(resting_foot[0] + forward_offset, -1, 1))
    for forward_offset in _FORWARD_OFFSETS:
        for outward in _OUTWARD:
            yield outward, forward_offset


@lru_cache(maxsize=1)
def _unit_path() -> np.ndarray:
    """Return a foot path of half stroke 1 and lift 1 about its middle: forward and up, shape (2, sample) [-]."""
    return np.stack(foot_path(np.arange(_SAMPLES) / _SAMPLES, _DUTY))


def _can_follow(limb: Limb, path_points: np.ndarray) -> bool:
    """Return whether a limb brings its foot along a path within its joint ranges and without a jump.

    Args:
        limb: the design of the limb.
        path_points: positions of one foot over the cycle, from the hip: forward, outward, up, shape (sample, 3) [m].
    """
    try:
        angles = limb_kinematics.inverse(limb, path_points, tries=_TRIES)
    except (Unreachable, NotConverged):
        return False
    lower_bound, upper_bound = np.array([hinge.range or (-np.inf, np.inf) for hinge in limb.hinges]).T
    is_within_range = (angles > lower_bound + _MARGIN).all() and (angles < upper_bound - _MARGIN).all()
    return bool(is_within_range and np.abs(np.diff(angles, axis=0, append=angles[:1])).max() < _JUMP)


def _cloud(limb: Limb) -> cKDTree:
    """Return a tree of points that a limb's foot can reach, from the hip [m]."""
    lower_bound, upper_bound = np.array([hinge.range or (-pi, pi) for hinge in limb.hinges]).T
    angles = np.random.default_rng(0).uniform(lower_bound, upper_bound, (_CLOUD, len(lower_bound)))
    return cKDTree(limb_kinematics.forward(limb, angles))


def _is_crank(limb: Limb) -> bool:
    return len(limb.hinges) == 1 and isinstance(limb.hinges[0].drive, Crank)


def _walks_by_paths(limb: Limb) -> bool:
    return len(limb.hinges) > _PLANAR and not is_upright(limb)


def _lowest_foot(limb: Limb) -> tuple[float, float]:
    """Return the angle at which the foot of a crank is lowest [rad], and how deep that is below the hip [m]."""
    angles = np.linspace(-pi, pi, 721)
    depth = -limb_kinematics.forward(limb, angles[:, None])[:, 2]
    return float(angles[np.argmax(depth)]), float(depth.max())


def _axis(robot: Robot) -> tuple[Bend, ...]:
    """Return a bend of the trunk with the limbs."""
    trunk = layout(robot).trunk_yaw
    limits = np.abs(servo_ranges(robot)).min(axis=1)
    amplitude = tuple(len(trunk) * min(_BEND, _SHARE * float(limits[i])) for i in reversed(trunk))
    return (Bend(part="trunk", amplitude=amplitude),) if amplitude else ()


def _with_feasible_period(robot: Robot, gait: Gait) -> Gait:
    """Return a gait whose period keeps every servo below a fraction of its speed."""
    return replace(gait, period=float(np.round(max(gait.period, min_gait_period(robot, gait)[0] / _SPEED), 4)))
