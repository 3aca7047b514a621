"""The intended posture at a phase: feet by inverse kinematics, trunk and tail by their bends."""

import numpy as np
from jaxtyping import Float

from suchus.design import LEGS, Crocodile, Leg, servo_names
from suchus.errors import OutsideLimits, Unreachable
from suchus.kinematics import leg as leg_kinematics
from suchus.kinematics import tail as tail_kinematics
from suchus.motion.gait import Gait
from suchus.motion.phase import tail_bend, trunk_bend

_INSIDE = 1e-6  # [m]; how far inside its reach a clipped leg stays


def foot_targets(
    robot: Crocodile,
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
        stroke: half of the way of each foot [m]; the gait's own if None.
        lower: how much lower than the gait says each foot is [m]; no lower if None.
    """
    cycle = np.mod(phase, 1.0)
    swing = 1.0 - gait.duty_factor
    s = np.clip(cycle / swing, 0.0, 1.0)
    back = (cycle - swing) / gait.duty_factor
    forward = np.where(cycle < swing, -np.cos(np.pi * s), 1.0 - 2.0 * back)
    feet = np.empty((*phase.shape, 3))
    for i, name in enumerate(LEGS):
        leg = robot.leg(name)
        front = name.endswith("F")
        feet[..., i, 0] = leg.hip_offset + (gait.front_reach if front else gait.hind_reach)
        feet[..., i, 1] = gait.front_ahead if front else gait.hind_ahead
        feet[..., i, 2] = gait.hip_height - leg.foot_radius
    feet[..., 1] += (gait.stroke if stroke is None else stroke) * forward
    if lower is not None:
        feet[..., 2] += lower
    feet[..., 2] -= gait.lift * np.where(cycle < swing, np.sin(np.pi * s) ** 2, 0.0)
    return feet


def servo_targets(
    robot: Crocodile,
    gait: Gait,
    phase: Float[np.ndarray, "*b 4"],
    *,
    trunk: Float[np.ndarray, "*b"] | None = None,
    tail: Float[np.ndarray, "*b"] | None = None,
    stroke: Float[np.ndarray, "*b 4"] | None = None,
    lower: Float[np.ndarray, "*b 4"] | None = None,
    clip: bool = False,
) -> Float[np.ndarray, "*b 19"]:
    """Return the servo angles of the intended posture, in the order of ``design.servo_names()`` [rad].

    Args:
        robot: the design.
        gait: the gait.
        phase: of the limbs [cycle].
        trunk: lateral bend of the trunk [rad]; the gait's own law if None.
        tail: lateral bend of the tail [rad]; the gait's own law if None.
        stroke: half of the way of each foot [m]; the gait's own if None.
        lower: how much lower than the gait says each foot is [m]; no lower if None.
        clip: let a leg that is too short point to its foot.

    Raises:
        OutsideLimits: the legs cannot reach their feet's paths, and ``clip`` is false.
    """
    feet = foot_targets(robot, gait, phase, stroke=stroke, lower=lower)
    targets = np.zeros((*phase.shape[:-1], 19))
    for i, name in enumerate(LEGS):
        try:
            targets[..., 3 * i : 3 * i + 3] = _leg_angles(robot.leg(name), name, gait, feet[..., i, :], clip=clip)
        except Unreachable as error:
            raise OutsideLimits(
                f"gait {gait.name!r} asks {name} for a foot path outside its reach: {error} "
                "Lower stroke, reach or hip_height."
            ) from error
    bend = trunk_bend(gait, phase) if trunk is None else trunk
    targets[..., 12] = targets[..., 14] = targets[..., 16] = bend / 3
    targets[..., 17] = gait.tail_pitch
    targets[..., 18] = tail_kinematics.servo_angle(robot.tail, tail_bend(gait, phase) if tail is None else tail)
    return targets


def _leg_angles(leg: Leg, name: str, gait: Gait, foot: np.ndarray, *, clip: bool) -> np.ndarray:
    """Return yaw, pitch and knee that bring a foot to its place the way that the gait's legs stand [rad]."""
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


def within_reach(leg: Leg, foot: Float[np.ndarray, "*b 3"]) -> Float[np.ndarray, "*b 3"]:
    """Return foot points drawn along the line to the hip into what the leg reaches [m]."""
    hip = np.array([leg.hip_offset, 0.0, 0.0])
    away = foot - hip
    far = np.linalg.norm(away, axis=-1, keepdims=True)
    near, most = leg.reach
    return np.asarray(hip + away * np.clip(far, near + _INSIDE, most - _INSIDE) / np.maximum(far, _INSIDE))


def longest_stroke(robot: Crocodile, gait: Gait) -> float:
    """Return the longest half stroke that all four legs can reach, less 2 % [m]."""
    longest = []
    for leg, reach, ahead in (
        (robot.front_leg, gait.front_reach, gait.front_ahead),
        (robot.hind_leg, gait.hind_reach, gait.hind_ahead),
    ):
        aside2 = reach**2 + (gait.hip_height - leg.foot_radius) ** 2
        longest.append(0.98 * max(leg.reach[1] ** 2 - aside2, 0.0) ** 0.5 - abs(ahead))
    return max(min(longest), 0.0)


def check_limits(robot: Crocodile, gait: Gait) -> None:
    """Refuse a gait that a robot's joints cannot follow.

    Raises:
        OutsideLimits: a joint would have to leave its range; the message names the joint, the angle and the range.
    """
    if gait.tail_bend > robot.tail.bend_limit:
        raise OutsideLimits(
            f"gait {gait.name!r} bends the tail by {gait.tail_bend:.3f} rad; robot {robot.name!r} allows up to "
            f"{robot.tail.bend_limit:.3f} rad: lower tail_bend."
        )
    phase = np.arange(128)[:, None] / 128 + np.array(gait.limb_phases)
    targets = servo_targets(robot, gait, phase)
    for i, name in enumerate(servo_names()[:-1]):
        low, high = servo_range(robot, name)
        worst = targets[np.argmax(np.maximum(low - targets[:, i], targets[:, i] - high)), i]
        if not low <= worst <= high:
            raise OutsideLimits(
                f"gait {gait.name!r} asks {name} of robot {robot.name!r} for {worst:.3f} rad; "
                f"{low:.3f} to {high:.3f} rad is allowed."
            )


def servo_range(robot: Crocodile, name: str) -> tuple[float, float]:
    """Return the range of the joint that a servo turns [rad]; for the cable, of the pulley."""
    if name == "tail_cable":
        most = float(tail_kinematics.servo_angle(robot.tail, np.float64(robot.tail.bend_limit)))
        return -most, most
    if name == "tail_pitch":
        return robot.tail.pitch_range
    if name.startswith("spine"):
        return robot.spine.yaw_range if "yaw" in name else robot.spine.pitch_range
    joint: tuple[float, float] = getattr(robot.leg(name[:2]), f"{name[3:]}_range")
    return joint
