"""The angles and speeds that a gait demands of joints and servos, and whether a robot can follow it."""

from dataclasses import replace
from functools import lru_cache
from math import inf

import numpy as np

from suchus.core.errors import InvalidDesign, NotConverged, OutsideLimits, UnknownName, Unreachable
from suchus.robot.design import Robot, layout, servo_ranges
from suchus.robot.motion.axis import at_knot, yaw_hinges
from suchus.robot.motion.gait import Gait
from suchus.robot.motion.movement import Movement, cycle_targets, movement
from suchus.robot.motion.parts import MAX_ANGLES, AxisRegion, Bend, Curve, ServoPart

SAMPLES = 128
"""Looks over a cycle [-]."""
_SPEED_SAMPLES = 200  # of a cycle, for the servos' speeds
# greatest factor on strokes that is tried [-]; width of the bracket at which the bisection stops [-]
_MAX_STROKE_FACTOR, _STROKE_TOLERANCE = 8.0, 1e-3
_LENGTH, _ANGLE, _SPEED = 0.01, 0.1, 1.0  # [m], [rad], [rad/s]; an excess of this size counts as 1
_ROUNDING = 1e-9  # [rad]; tolerance of a bend beyond its limit


def check_limits(robot: Robot, gait: Gait) -> None:
    """Refuse a gait that a robot's joints cannot follow.

    Raises:
        OutsideLimits: the gait is for other limbs, asks a foot for a place out of reach, or a joint would have to leave
            its range; the message names it, the angle and the range.
        UnknownName: a curve is for a servo that the robot lacks.
    """
    gait_movement, clock = movement(robot, gait), np.arange(SAMPLES) / SAMPLES
    _check_cables(gait_movement)
    targets = cycle_targets(robot, gait, clock)
    direct = len(gait_movement.layout.servos) - len(gait_movement.layout.cables)
    targets = np.vstack([targets, _lateral_ends(gait_movement, targets[0])])
    for name, column, (lower_bound, upper_bound) in zip(
        gait_movement.layout.servos[:direct], targets.T[:direct], servo_ranges(robot)[:direct], strict=True
    ):
        worst_angle = column[np.argmax(np.maximum(lower_bound - column, column - upper_bound))]
        if not lower_bound <= worst_angle <= upper_bound:
            raise OutsideLimits(
                f"gait {gait.name!r} asks {name} of robot {robot.name!r} for {worst_angle:.3f} rad; "
                f"{lower_bound:.3f} to {upper_bound:.3f} rad is allowed."
            )


def _lateral_ends(gait_movement: Movement, posture: np.ndarray) -> np.ndarray:
    """Return a posture with the smallest and the greatest angles of the lateral wave, shape (2, servo) [rad].

    Args:
        gait_movement: the gait, worked out for the robot.
        posture: servo angles at any time, shape (servo,) [rad].
    """
    ends, follows = np.array([posture, posture]), float(np.abs(gait_movement.axis_of_clock(np.zeros(1)))[0])
    measured = {gait_movement.layout.servos.index(curve.servo) for curve in gait_movement.gaits[0].curves}
    hinges, hinge_counts = gait_movement.yaw.hinges, gait_movement.yaw.hinge_counts[0]
    for k, (servo, sign) in enumerate(zip(hinges.servos, hinges.signs, strict=True)):
        if servo not in gait_movement.layout.cables and servo not in measured:
            swing = max(follows * float(np.abs(gait_movement.yaw.swing[0, k])) / hinge_counts[k] - _ROUNDING, 0.0)
            ends[:, servo] = sign * gait_movement.yaw.offset[0, k] / hinge_counts[k] + np.array([-swing, swing])
    return ends


def _check_cables(gait_movement: Movement) -> None:
    """Refuse bends beyond the limits of cables; the clipped angles of the pulleys would not show them."""
    follows = float(np.abs(gait_movement.axis_of_clock(np.zeros(1)))[0])
    for servo in gait_movement.layout.cables:
        hinge_indices = [k for k, hinge_servo in enumerate(gait_movement.yaw.hinges.servos) if hinge_servo == servo]
        swing, steady = gait_movement.yaw.swing_and_offset(hinge_indices)
        max_bend = float(follows * np.abs(swing[0]) + np.abs(steady[0]))
        limit = gait_movement.layout.cable(servo).bend_limit
        if max_bend > limit + _ROUNDING:
            raise OutsideLimits(
                f"gait {gait_movement.gaits[0].name!r} asks the hinges of cable "
                f"{gait_movement.layout.servos[servo]} of robot {gait_movement.robot.name!r} for a bend of "
                f"{max_bend:.3f} rad together; up to {limit:.3f} rad is allowed: let its axis bend less."
            )


def suits(robot: Robot, gait: Gait) -> bool:
    """Return whether a robot's joints can follow a gait."""
    try:
        check_limits(robot, gait)
    except (InvalidDesign, NotConverged, OutsideLimits, UnknownName, Unreachable):
        return False
    return True


def min_gait_period(robot: Robot, gait: Gait) -> tuple[float, str]:
    """Return the period below which a servo would have to turn faster than it can [s], and which servo that is.

    Args:
        robot: the design, whose limbs the gait is for.
        gait: the gait; its own period is not looked at.
    """
    targets = cycle_targets(robot, gait, np.arange(_SPEED_SAMPLES + 1) / _SPEED_SAMPLES)
    turns = np.abs(np.diff(targets, axis=0)).max(axis=0) * _SPEED_SAMPLES  # [rad/cycle]
    servos = layout(robot).servos
    min_periods = turns / np.array([robot.servo(servo).speed for servo in servos])
    slowest = int(np.argmax(min_periods))
    return float(min_periods[slowest]), servos[slowest]


def check_speeds(robot: Robot, gait: Gait) -> None:
    """Refuse a gait in which a servo would have to turn faster than it can.

    Raises:
        OutsideLimits: a servo is too slow; the message names it and the shortest period.
    """
    min_period, servo = min_gait_period(robot, gait)
    if min_period > gait.period:
        limit = robot.servo(servo).speed
        raise OutsideLimits(
            f"gait {gait.name!r} asks {servo} of robot {robot.name!r} for {limit * min_period / gait.period:.2f} "
            f"rad/s; the servo turns at {limit:.2f} rad/s at most: make the period {min_period:.3g} s, or bend less."
        )


@lru_cache(maxsize=256)
def max_stroke_factor(robot: Robot, gait: Gait, *, limit_speed: bool = False) -> float:
    """Return the greatest factor on a gait's strokes that a robot's limbs can follow, up to 8 [-].

    Args:
        robot: the design.
        gait: the gait.
        limit_speed: whether no servo may be asked for more than its speed, or for more than the gait itself asks.
    """
    if not gait.has("strokes"):
        return 1.0
    max_period = max(gait.period, min_gait_period(robot, gait)[0]) if limit_speed else inf
    lower_bound, upper_bound = 1.0, _MAX_STROKE_FACTOR
    while upper_bound - lower_bound > _STROKE_TOLERANCE:
        trial = 0.5 * (lower_bound + upper_bound)
        lower_bound, upper_bound = (
            (trial, upper_bound) if _strides(robot, gait, trial, max_period) else (lower_bound, trial)
        )
    return lower_bound


def _strides(robot: Robot, gait: Gait, fraction: float, max_period: float) -> bool:
    """Return whether a robot's limbs can follow a gait with scaled strokes.

    Args:
        robot: the design.
        gait: the gait.
        fraction: factor on the strokes [-].
        max_period: period that the speeds of the servos may need at most [s].
    """
    try:
        scaled_gait = gait.strode(fraction)
        if not suits(robot, scaled_gait):
            return False
        return max_period == inf or min_gait_period(robot, scaled_gait)[0] <= max_period
    except InvalidDesign:
        return False


def excess(robot: Robot, gait: Gait) -> float:
    """Return by how much a gait exceeds reach, ranges and speeds of a robot; zero for a feasible gait [-].

    Counted are the distance by which feet lie outside their limbs' reach, in centimetres, the angles by which joints
    leave their range, in tenths of a radian, and the speeds by which servos turn too fast, in radians a second.

    Raises:
        SuchusError: the gait is for other limbs.
    """
    gait_movement, clock = movement(robot, gait), np.arange(SAMPLES) / SAMPLES
    limbs = clock[:, None] + np.array(gait.limb_phases)
    targets = gait_movement.targets(limbs, gait_movement.axis_of_clock(clock), draw=True)
    foot_distance = gait_movement.out_of_reach(limbs)
    ranges = servo_ranges(robot)
    range_excess = np.maximum(np.maximum(ranges[:, 0] - targets, targets - ranges[:, 1]), 0.0).max(axis=0)
    turns = np.diff(targets, axis=0, append=targets[:1])
    endless = np.isinf(ranges).any(axis=1)
    turns[:, endless] = (turns[:, endless] + np.pi) % (2 * np.pi) - np.pi  # a crank's angle jumps once a turn
    servo_speed = np.abs(turns).max(axis=0) * SAMPLES / gait.period
    speed_limit = np.array([robot.servo(name).speed for name in gait_movement.layout.servos])
    reach_excess = float(foot_distance.max(axis=0).sum()) if limbs.shape[1] else 0.0
    return float(
        reach_excess / _LENGTH + range_excess.sum() / _ANGLE + np.maximum(servo_speed - speed_limit, 0.0).sum() / _SPEED
    )


def as_table(robot: Robot, gait: Gait, samples: int = 64) -> Gait:
    """Return a gait as curves of every servo over one cycle.

    Between the samples a curve is smooth where a gait may have a corner, at lift-off and touch-down of a foot; with
    64 samples the crawl's angles differ by less than 0.002 rad.

    Args:
        robot: the design.
        gait: the gait, which the robot can follow.
        samples: number of samples of one cycle, at most ``MAX_ANGLES`` are taken [-].

    Raises:
        OutsideLimits: the robot cannot follow it.
    """
    samples = min(samples, MAX_ANGLES)
    clock = np.arange(samples) / samples
    servo_curves = zip(layout(robot).servos, cycle_targets(robot, gait, clock).T, strict=True)
    short_curves = {name: curve[:1] if np.ptp(curve) < 1e-9 else curve for name, curve in servo_curves}
    parts = servo_parts(robot)
    return replace(
        gait,
        name=f"{gait.name}_table",
        limbs=(),
        axis=(),
        height=0.0,
        curves=tuple(
            Curve(servo=name, part=parts[name], angles=tuple(float(round(angle, 6)) for angle in curve))
            for name, curve in short_curves.items()
            if np.any(np.abs(curve) > 1e-12)
        ),
    )


def servo_parts(robot: Robot) -> dict[str, ServoPart]:
    """Return the part of the body that each servo moves: ``limb``, ``neck``, ``trunk`` or ``tail``."""
    place = layout(robot)
    trunk = {*place.trunk_yaw, *place.trunk_pitch}
    parts: dict[str, ServoPart] = {}
    for i, name in enumerate(place.servos):
        if any(i in range(limb.servos.start, limb.servos.stop) for limb in place.limbs):
            parts[name] = "limb"
        elif i in place.cables or place.servo_hinges[i] >= place.backward_hinges.start:
            parts[name] = "tail"
        else:
            parts[name] = "trunk" if i in trunk else "neck"
    return parts


def divide_axis(robot: Robot, gait: Gait) -> Gait:
    """Return a gait whose bends of the whole axis are split into neck, trunk and tail, with a knot for each hinge."""
    hinges, axis = yaw_hinges(robot), []
    parts: tuple[AxisRegion, ...] = ("neck", "trunk", "tail")
    for bend in gait.axis:
        if bend.part != "axis" or bend.turn != "yaw":
            axis.append(bend)
            continue
        count = len(hinges.servos)
        for region in parts:
            hinge_indices = hinges.indices_in(region)
            fraction = len(hinge_indices) / count
            if hinge_indices:
                axis.append(
                    Bend(
                        part=region,
                        amplitude=tuple(fraction * at_knot(bend.amplitude, k, count) for k in hinge_indices),
                        lag=tuple(at_knot(bend.lag, k, count) for k in hinge_indices),
                        offset=fraction * bend.offset,
                    )
                )
    return replace(gait, axis=tuple(axis))


def servo_range(robot: Robot, name: str) -> tuple[float, float]:
    """Return the range of the joint that a servo turns [rad]; for a cable, of the pulley."""
    lower_bound, upper_bound = servo_ranges(robot)[layout(robot).servos.index(name)]
    return float(lower_bound), float(upper_bound)
