"""A gait as servo angles and pulses over time."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.design import AnyRobot, crocodile
from suchus.design.checks import require
from suchus.errors import OutsideLimits
from suchus.hardware.servo_map import ServoMap
from suchus.motion import START, Gait, check_limits, limb_phase, servo_targets


class Commands(NamedTuple):
    """What the servos are told, in the order of ``design.servo_names()``; the last sample equals the first."""

    time: Float[np.ndarray, " sample"]
    """From the beginning of the first cycle [s]."""
    angles: Float[np.ndarray, "sample 19"]
    """Of the joints; of the pulley for the cable [rad]."""
    speeds: Float[np.ndarray, "sample 19"]
    """How fast the angles change: central differences over the periodic gait [rad/s]."""
    pulses: Float[np.ndarray, "sample 19"]
    """What the map makes of the angles [us]."""


def commands(robot: AnyRobot, gait: Gait, servo_map: ServoMap, cycles: int = 1) -> Commands:
    """Return the commands of some cycles, so that they can be repeated without a jump.

    A cycle is divided into the whole number of intervals that is nearest to the map's rate.

    Args:
        robot: who walks.
        gait: how.
        servo_map: how its servos are mounted.
        cycles: how many.

    Raises:
        OutsideLimits: the joints cannot follow the gait, or the rate gives a cycle fewer than 8 samples.

    Paper: Eq. (18) for the cable.
    """
    robot = crocodile(robot, "the file of servo commands")
    require("commands", "cycles", cycles, 1, 1000, "")
    check_limits(robot, gait)
    samples = round(gait.period * servo_map.rate)
    if samples < 8:
        raise OutsideLimits(
            f"gait {gait.name!r} has a cycle of {gait.period:g} s, {samples} samples at {servo_map.rate:g} Hz; "
            f"8 are needed: raise the rate to {8 / gait.period:.3g} Hz."
        )
    phase = limb_phase(gait, START + np.arange(samples) * gait.period / samples)
    one = servo_targets(robot, gait, phase)
    step = gait.period / samples
    speed = (np.roll(one, -1, axis=0) - np.roll(one, 1, axis=0)) / (2 * step)
    along = np.arange(cycles * samples + 1)
    angles = one[along % samples]
    return Commands(along * step, angles, speed[along % samples], _pulses(servo_map, angles))


def _pulses(servo_map: ServoMap, angles: np.ndarray) -> np.ndarray:
    lines = servo_map.ordered()
    direction = np.array([line.direction for line in lines])
    offset = np.array([line.offset for line in lines])
    centre = np.array([line.pulse_centre for line in lines])
    per_radian = np.array([line.pulse_per_radian for line in lines])
    return np.asarray(centre + per_radian * (direction * angles + offset))
