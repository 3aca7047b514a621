"""The intended posture at a phase: feet by inverse kinematics, trunk and tail by their bends."""

import numpy as np
from jaxtyping import Float

from suchus.design import LEGS, Crocodile, servo_names
from suchus.errors import OutsideLimits, Unreachable
from suchus.kinematics import leg as leg_kinematics
from suchus.kinematics import tail as tail_kinematics
from suchus.motion.gait import Gait
from suchus.motion.phase import tail_bend, trunk_bend


def foot_targets(
    robot: Crocodile,
    gait: Gait,
    phase: Float[np.ndarray, "*b 4"],
    *,
    stroke: Float[np.ndarray, "*b 4"] | None = None,
) -> Float[np.ndarray, "*b 4 3"]:
    """Return the intended foot centres, each in the D-H base frame of its leg (outward, forward, down) [m].

    Stance goes straight back at constant speed. Swing goes forward as half a cosine and is lifted as a squared
    sine, so that a foot leaves and meets the ground without vertical speed.

    Args:
        robot: the design.
        gait: the gait.
        phase: of the limbs [cycle].
        stroke: half of the way of each foot [m]; the gait's own if None.
    """
    cycle = np.mod(phase, 1.0)
    swing = 1.0 - gait.duty_factor
    s = np.clip(cycle / swing, 0.0, 1.0)
    back = (cycle - swing) / gait.duty_factor
    forward = np.where(cycle < swing, -np.cos(np.pi * s), 1.0 - 2.0 * back)
    feet = np.empty((*phase.shape, 3))
    for i, name in enumerate(LEGS):
        leg = robot.leg(name)
        reach = gait.front_reach if name.endswith("F") else gait.hind_reach
        feet[..., i, 0] = leg.hip_offset + reach
        feet[..., i, 2] = gait.hip_height - leg.foot_radius
    feet[..., 1] = (gait.stroke if stroke is None else stroke) * forward
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
) -> Float[np.ndarray, "*b 19"]:
    """Return the servo angles of the intended posture, in the order of ``design.servo_names()`` [rad].

    Args:
        robot: the design.
        gait: the gait.
        phase: of the limbs [cycle].
        trunk: lateral bend of the trunk [rad]; the gait's own law if None.
        tail: lateral bend of the tail [rad]; the gait's own law if None.
        stroke: half of the way of each foot [m]; the gait's own if None.

    Raises:
        OutsideLimits: the legs cannot reach their feet's paths.
    """
    feet = foot_targets(robot, gait, phase, stroke=stroke)
    targets = np.zeros((*phase.shape[:-1], 19))
    for i, name in enumerate(LEGS):
        try:
            targets[..., 3 * i : 3 * i + 3] = leg_kinematics.inverse(robot.leg(name), feet[..., i, :])
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


def longest_stroke(robot: Crocodile, gait: Gait) -> float:
    """Return the longest half stroke that all four legs can reach, less 2 % [m]."""
    longest = []
    for leg, reach in ((robot.front_leg, gait.front_reach), (robot.hind_leg, gait.hind_reach)):
        aside2 = reach**2 + (gait.hip_height - leg.foot_radius) ** 2
        longest.append(0.98 * max(leg.reach[1] ** 2 - aside2, 0.0) ** 0.5)
    return min(longest)


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
