"""The death roll: lateral and vertical bends of trunk and tail, a quarter of a cycle apart."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.design import ARTICLE_BODY, Robot, check_needs, layout, servo_names
from suchus.design.checks import Checks
from suchus.errors import OutsideLimits
from suchus.kinematics import tail as tail_kinematics
from suchus.motion.limits import servo_range

_LEGS_BACK = -np.pi / 2


@dataclass(frozen=True, slots=True, kw_only=True)
class Roll:
    """A bend that goes around the body once in a cycle, legs folded back.

    With t in cycles the trunk's front end bends to the left by ``trunk_lateral cos(2 pi t)`` and down by
    ``trunk_vertical cos(2 pi (t - lag))``; the tail's tip the same with its own amplitudes, ``tail_lag`` cycles
    later. In the first cycle the amplitudes grow from zero.
    """

    frequency: float
    """Frequency of the bends [Hz], 0.02 to 10."""
    trunk_lateral: float
    """Amplitude of the sum of the trunk's yaw angles [rad]."""
    trunk_vertical: float
    """Amplitude of the sum of the trunk's pitch angles [rad]."""
    tail_lateral: float
    """Amplitude of the bend of the cable section [rad]."""
    tail_vertical: float
    """Amplitude of the tail's pitch joint [rad]."""
    lag: float
    """Phase lag of the vertical bend behind the lateral one [cycle], -1 to 1; 0.25 and -0.25 roll oppositely."""
    tail_lag: float
    """Phase lag of the tail behind the trunk [cycle], -1 to 1: 0 makes a C of the body, 0.5 an S."""

    def __post_init__(self) -> None:
        with Checks("roll", self) as check:
            check.number("frequency", 0.02, 10.0, "Hz")
            for field in ("trunk_lateral", "trunk_vertical", "tail_lateral", "tail_vertical"):
                check.number(field, 0.0, 3.1416, "rad")
            check.number("lag", -1.0, 1.0, "cycle")
            check.number("tail_lag", -1.0, 1.0, "cycle")


def roll_targets(robot: Robot, roll: Roll, time: Float[np.ndarray, "*b"]) -> Float[np.ndarray, "*b servo"]:
    """Return the servo angles of a roll, in the order of ``design.servo_names()`` [rad].

    Args:
        robot: the design.
        roll: the motion.
        time: since its beginning [s].
    """
    check_needs(robot, ARTICLE_BODY, "a death roll")
    cycles = roll.frequency * time
    grown = np.clip(cycles, 0.0, 1.0)
    grown = grown**2 * (3.0 - 2.0 * grown)
    place = layout(robot)
    targets = np.zeros((*np.shape(time), len(place.servos)))
    targets[..., [limb.servos.start for limb in place.limbs]] = _LEGS_BACK

    def bend(amplitude: float, lag: float) -> np.ndarray:
        return np.asarray(amplitude * grown * np.cos(2 * np.pi * (cycles - lag)))

    targets[..., place.trunk_yaw] = bend(roll.trunk_lateral, 0.0)[..., None] / len(place.trunk_yaw)
    targets[..., place.trunk_pitch] = bend(roll.trunk_vertical, roll.lag)[..., None] / len(place.trunk_pitch)
    targets[..., place.tail_pitch[0]] = bend(roll.tail_vertical, roll.lag + roll.tail_lag)
    to_the_right = -bend(roll.tail_lateral, roll.tail_lag)
    targets[..., place.cables[0]] = tail_kinematics.servo_angle(robot.tail, to_the_right)
    return targets


def check_roll(robot: Robot, roll: Roll) -> None:
    """Refuse a roll that a robot's joints or servos cannot follow.

    Raises:
        OutsideLimits: a joint would have to leave its range, or a servo to turn faster than it can; the message names
            it.
    """
    check_needs(robot, ARTICLE_BODY, "a death roll")
    if roll.tail_lateral > robot.tail.bend_limit:
        raise OutsideLimits(
            f"the roll bends the tail by {roll.tail_lateral:.3f} rad; robot {robot.name!r} allows up to "
            f"{robot.tail.bend_limit:.3f} rad: lower tail_lateral."
        )
    time = (1.0 + np.arange(257) / 256) / roll.frequency
    angles = roll_targets(robot, roll, time)
    speeds = np.abs(np.diff(angles, axis=0)).max(axis=0) / (time[1] - time[0])
    for i, name in enumerate(servo_names(robot)):
        low, high = servo_range(robot, name)
        least, most = float(angles[:, i].min()), float(angles[:, i].max())
        if least < low or most > high:
            raise OutsideLimits(
                f"the roll asks {name} of robot {robot.name!r} for {least:.3f} to {most:.3f} rad; {low:.3f} to "
                f"{high:.3f} rad is allowed: bend less."
            )
        limit = robot.servo(name).speed
        if speeds[i] > limit:
            raise OutsideLimits(
                f"the roll asks {name} of robot {robot.name!r} for {speeds[i]:.2f} rad/s; the servo turns at "
                f"{limit:.2f} rad/s at most: lower the frequency or the bend."
            )
