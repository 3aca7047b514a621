"""The intended posture at a phase: feet by inverse kinematics, trunk and tail by their bends."""

from functools import lru_cache

import numpy as np
from jaxtyping import Float

from suchus.design import LEGS, AnyRobot, layout, servo_ranges
from suchus.design.measures import LegMeasures
from suchus.errors import OutsideLimits, Unreachable
from suchus.kinematics import leg as leg_kinematics
from suchus.kinematics import tail as tail_kinematics
from suchus.kinematics.limb import PlainLeg, kind, plain
from suchus.motion.gait import Gait
from suchus.motion.phase import tail_bend, trunk_bend

_INSIDE = 1e-6  # [m]; how far inside its reach a clipped leg stays


def foot_targets(
    robot: AnyRobot,
    gait: Gait,
    phase: Float[np.ndarray, "*b 4"],
    *,
    stroke: Float[np.ndarray, "*b 4"] | None = None,
    lower: Float[np.ndarray, "*b 4"] | None = None,
) -> Float[np.ndarray, "*b 4 3"]:
    """Return the intended foot centres, each in the D-H base frame of its leg (outward, forward, down) [m].

    Stance goes straight back at constant speed. Swing goes forward as half a cosine and is lifted as a squared
    sine, so that a foot leaves and meets the ground without vertical speed.

    Args:
        robot: the design.
        gait: the gait.
        phase: of the limbs [cycle].
        stroke: half of the distance that each foot moves [m]; the gait's own if None.
        lower: how much lower than the gait says each foot is [m]; no lower if None.
    """
    cycle = np.mod(phase, 1.0)
    swing = 1.0 - gait.duty_factor
    s = np.clip(cycle / swing, 0.0, 1.0)
    back = (cycle - swing) / gait.duty_factor
    forward = np.where(cycle < swing, -np.cos(np.pi * s), 1.0 - 2.0 * back)
    feet = np.empty((*phase.shape, 3))
    for i, (name, leg) in enumerate(zip(LEGS, legs_for(robot, gait), strict=True)):
        front = name.endswith("F")
        feet[..., i, 0] = leg.hip_offset + (gait.front_reach if front else gait.hind_reach)
        feet[..., i, 1] = gait.front_ahead if front else gait.hind_ahead
        feet[..., i, 2] = gait.hip_height + leg.above - leg.foot_radius
    feet[..., 1] += (gait.stroke if stroke is None else stroke) * forward
    if lower is not None:
        feet[..., 2] += lower
    feet[..., 2] -= gait.lift * np.where(cycle < swing, np.sin(np.pi * s) ** 2, 0.0)
    return feet


def servo_targets(
    robot: AnyRobot,
    gait: Gait,
    phase: Float[np.ndarray, "*b 4"],
    *,
    trunk: Float[np.ndarray, "*b"] | None = None,
    tail: Float[np.ndarray, "*b"] | None = None,
    stroke: Float[np.ndarray, "*b 4"] | None = None,
    lower: Float[np.ndarray, "*b 4"] | None = None,
    clip: bool = False,
) -> Float[np.ndarray, "*b servo"]:
    """Return the servo angles of the intended posture, in the order of ``design.servo_names(robot)`` [rad].

    Args:
        robot: the design.
        gait: the gait.
        phase: of the limbs [cycle].
        trunk: lateral bend of the trunk [rad]; the gait's own law if None.
        tail: lateral bend of the tail [rad]; the gait's own law if None.
        stroke: half of the distance that each foot moves [m]; the gait's own if None.
        lower: how much lower than the gait says each foot is [m]; no lower if None.
        clip: let a leg that is too short point to its foot.

    Raises:
        OutsideLimits: the legs cannot reach their feet's paths, and ``clip`` is false.
    """
    place = layout(robot)
    feet = foot_targets(robot, gait, phase, stroke=stroke, lower=lower)
    targets = np.zeros((*phase.shape[:-1], len(place.servos)))
    for i, (limb, leg) in enumerate(zip(place.limbs, legs_for(robot, gait), strict=True)):
        try:
            targets[..., limb.servos] = _leg_angles(leg, limb.name, gait, feet[..., i, :], clip=clip)
        except Unreachable as error:
            raise OutsideLimits(
                f"gait {gait.name!r} asks {limb.name} for a foot path outside its reach: {error} "
                "Lower stroke, reach or hip_height."
            ) from error
    bend = trunk_bend(gait, phase) if trunk is None else trunk
    for servo in place.trunk_yaw:
        targets[..., servo] = bend / len(place.trunk_yaw)
    for servo in place.tail_pitch[:1]:
        targets[..., servo] = gait.tail_pitch
    swing = tail_bend(gait, phase) if tail is None else tail
    for servo in place.tail_yaw:
        targets[..., servo] = swing / len(place.tail_yaw)
    for servo in place.cables:
        targets[..., servo] = tail_kinematics.servo_angle(place.cable(servo), swing)
    return targets


@lru_cache(maxsize=256)
def legs_for(robot: AnyRobot, gait: Gait) -> tuple[PlainLeg, ...]:
    """Return the legs that a gait of the article's kind moves, in the order of ``LEGS``.

    Raises:
        OutsideLimits: the robot has other limbs.
    """
    place = layout(robot)
    if place.limb_names != LEGS or any(kind(limb.girdle.limb) != "leg" for limb in place.limbs):
        raise OutsideLimits(
            f"gait {gait.name!r} is for four legs of yaw, pitch and knee; robot {robot.name!r} has "
            f"{', '.join(place.limb_names) or 'no limbs'}"
            f"{' with other joints' if place.limb_names == LEGS else ''}: choose a gait made for it."
        )
    return tuple(plain(limb.girdle) for limb in place.limbs)


def _leg_angles(leg: PlainLeg, name: str, gait: Gait, foot: np.ndarray, *, clip: bool) -> np.ndarray:
    """Return yaw, pitch and knee that bring a foot to its place as the gait's legs stand [rad]."""
    if clip:
        foot = within_reach(leg, foot)
    if gait.legs == "sprawled":
        return leg_kinematics.inverse(leg, foot)
    # the plane of an erect leg faces back in front and forward behind; in it the foot may lie to either side of the hip
    facing = -1.0 if name.endswith("F") else 1.0
    along = facing * foot[..., 1]
    flat = np.stack([leg.hip_offset + along, np.zeros_like(along), foot[..., 2]], axis=-1)
    angles = np.where(
        along[..., None] < 0.0, leg_kinematics.inverse(leg, flat, side=-1), leg_kinematics.inverse(leg, flat)
    )
    angles[..., 0] = facing * np.pi / 2
    return angles


def within_reach(leg: LegMeasures | PlainLeg, foot: Float[np.ndarray, "*b 3"]) -> Float[np.ndarray, "*b 3"]:
    """Return foot points drawn along the line to the hip into what the leg reaches [m]."""
    hip = np.array([leg.hip_offset, 0.0, 0.0])
    away = foot - hip
    far = np.linalg.norm(away, axis=-1, keepdims=True)
    near, most = leg.reach
    return np.asarray(hip + away * np.clip(far, near + _INSIDE, most - _INSIDE) / np.maximum(far, _INSIDE))


def longest_stroke(robot: AnyRobot, gait: Gait) -> float:
    """Return the longest half stroke that all four legs can reach, less 2 % [m]."""
    longest = []
    legs = legs_for(robot, gait)
    for leg, reach, ahead in (
        (legs[0], gait.front_reach, gait.front_ahead),
        (legs[2], gait.hind_reach, gait.hind_ahead),
    ):
        aside2 = reach**2 + (gait.hip_height - leg.foot_radius) ** 2
        longest.append(0.98 * max(leg.reach[1] ** 2 - aside2, 0.0) ** 0.5 - abs(ahead))
    return max(min(longest), 0.0)


def check_limits(robot: AnyRobot, gait: Gait) -> None:
    """Refuse a gait that a robot's joints cannot follow.

    Raises:
        OutsideLimits: a joint would have to leave its range; the message names the joint, the angle and the range.
    """
    place = layout(robot)
    for cable in place.robot.cables:
        if gait.tail_bend > cable.bend_limit:
            raise OutsideLimits(
                f"gait {gait.name!r} bends the tail by {gait.tail_bend:.3f} rad; robot {robot.name!r} allows up to "
                f"{cable.bend_limit:.3f} rad: lower tail_bend."
            )
    phase = np.arange(128)[:, None] / 128 + np.array(gait.limb_phases)
    targets = servo_targets(robot, gait, phase)
    direct = len(place.servos) - len(place.cables)
    for i, (name, (low, high)) in enumerate(zip(place.servos[:direct], servo_ranges(robot), strict=False)):
        worst = targets[np.argmax(np.maximum(low - targets[:, i], targets[:, i] - high)), i]
        if not low <= worst <= high:
            raise OutsideLimits(
                f"gait {gait.name!r} asks {name} of robot {robot.name!r} for {worst:.3f} rad; "
                f"{low:.3f} to {high:.3f} rad is allowed."
            )


def servo_range(robot: AnyRobot, name: str) -> tuple[float, float]:
    """Return the range of the joint that a servo turns [rad]; for a cable, of the pulley."""
    low, high = servo_ranges(robot)[layout(robot).servos.index(name)]
    return float(low), float(high)
