"""A swimming motion: the trunk's yaw joints and the tail's cable as sines, limbs folded back."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.design import ARTICLE_BODY, Robot, check_needs, layout
from suchus.design.checks import Checks, require
from suchus.errors import InvalidDesign, OutsideLimits
from suchus.kinematics import tail as tail_kinematics

LIMBS_BACK = (-np.pi / 2, -0.15)
"""Yaw, forward positive, and pitch, down positive, of limbs that lie back along the body as it swims [rad]."""


def limbs_back(robot: Robot) -> Float[np.ndarray, " joint"]:
    """Return the angles of all hinges of a straight body whose limbs lie back along it [rad]."""
    place = layout(robot)
    angles = np.zeros(len(place.hinges))
    for limb in place.limbs:
        angles[limb.hinges.start : limb.hinges.start + 2] = LIMBS_BACK
    return angles


def trunk_yaws(robot: Robot) -> tuple[str, ...]:
    """Return the trunk's yaw servos from the root forward."""
    place = layout(robot)
    return tuple(place.servos[i] for i in place.trunk_yaw)


@dataclass(frozen=True, slots=True, kw_only=True)
class Swim:
    """A periodic swimming motion: every lateral angle is ``amplitude cos(2 pi (f t - lag))``."""

    name: str
    """Name, for messages and tables."""
    frequency: float
    """Frequency of the wave, f [Hz], 0.01 to 20."""
    yaw: tuple[float, float, float]
    """Amplitudes of the trunk's yaw joints from the pelvis forward, front end left [rad], 0 to pi."""
    yaw_lag: tuple[float, float, float]
    """Phase lag of each of them behind f t [cycle], -1 to 1."""
    tail: float
    """Amplitude of the bend of the tail's cable section, tip to the right [rad], 0 to pi."""
    tail_lag: float
    """Phase lag of the tail's bend behind f t [cycle], -1 to 1."""

    def __post_init__(self) -> None:
        with Checks("swim", self) as check:
            check.number("frequency", 0.01, 20.0, "Hz")
            check.number("tail", 0.0, 3.1416, "rad")
            check.number("tail_lag", -1.0, 1.0, "cycle")
        for field in ("yaw", "yaw_lag"):
            values = getattr(self, field)
            if len(values) != 3:
                raise InvalidDesign(f"swim.{field} has {len(values)} numbers; three yaw joints need one each.")
            for i, value in enumerate(values):
                low, high, unit = (0.0, 3.1416, "rad") if field == "yaw" else (-1.0, 1.0, "cycle")
                require("swim", f"{field}[{i}]", value, low, high, unit)

    def reversed(self) -> "Swim":
        """Return the motion played backwards: the wave runs in the other direction."""
        first, second, third = self.yaw_lag
        return replace(self, yaw_lag=(-first, -second, -third), tail_lag=-self.tail_lag)

    def trunk_only(self) -> "Swim":
        """Return the motion with the tail straight."""
        return replace(self, tail=0.0)

    def tail_only(self) -> "Swim":
        """Return the motion with the trunk straight."""
        return replace(self, yaw=(0.0, 0.0, 0.0))


class Bends(NamedTuple):
    """Lateral angles and their rates."""

    yaw: Float[np.ndarray, "*b 3"]
    """Trunk's yaw joints from the pelvis forward [rad]."""
    tail: Float[np.ndarray, "*b"]
    """Bend of the cable section [rad]."""
    yaw_rate: Float[np.ndarray, "*b 3"]
    """[rad/s]."""
    tail_rate: Float[np.ndarray, "*b"]
    """[rad/s]."""


def bends(swim: Swim, time: Float[np.ndarray, "*b"]) -> Bends:
    """Return the lateral angles of a swimming motion.

    Args:
        swim: the motion.
        time: [s].
    """
    rate = 2 * np.pi * swim.frequency
    yaw_phase = rate * time[..., None] - 2 * np.pi * np.array(swim.yaw_lag)
    tail_phase = rate * time - 2 * np.pi * swim.tail_lag
    amplitude = np.array(swim.yaw)
    return Bends(
        np.asarray(amplitude * np.cos(yaw_phase)),
        np.asarray(swim.tail * np.cos(tail_phase)),
        np.asarray(-rate * amplitude * np.sin(yaw_phase)),
        np.asarray(-rate * swim.tail * np.sin(tail_phase)),
    )


def swim_targets(robot: Robot, swim: Swim, time: Float[np.ndarray, "*b"]) -> Float[np.ndarray, "*b servo"]:
    """Return the servo angles of a swimming motion, in the order of ``design.servo_names()`` [rad].

    Args:
        robot: the design.
        swim: the motion.
        time: [s].
    """
    check_needs(robot, ARTICLE_BODY, "the swim by trunk and cable")
    place = layout(robot)
    now = bends(swim, time)
    targets = np.zeros((*np.shape(time), len(place.servos)))
    targets[..., [limb.servos.start for limb in place.limbs]] = -np.pi / 2
    targets[..., place.trunk_yaw] = now.yaw
    targets[..., place.cables[0]] = tail_kinematics.servo_angle(robot.tail, now.tail)
    return targets


def check_swim(robot: Robot, swim: Swim) -> None:
    """Refuse a swimming motion that a robot's joints or servos cannot follow.

    Raises:
        OutsideLimits: a joint would have to leave its range, or a servo to turn faster than it can; the message names
            it and by how much.
    """
    check_needs(robot, ARTICLE_BODY, "the swim by trunk and cable")
    low, high = robot.spine.yaw_range
    asked = [(name, amplitude, min(-low, high)) for name, amplitude in zip(trunk_yaws(robot), swim.yaw, strict=True)]
    place = layout(robot)
    cable = place.servos[place.cables[0]]
    asked.append((cable, swim.tail, robot.tail.bend_limit))
    for name, amplitude, limit in asked:
        if amplitude > limit:
            raise OutsideLimits(
                f"swim {swim.name!r} bends {name} by {amplitude:.3f} rad to either side, {amplitude - limit:.3f} rad "
                f"more than the {limit:.3f} rad that robot {robot.name!r} allows: lower the amplitude, or take a "
                "longer wave."
            )
        shaft = float(tail_kinematics.servo_angle(robot.tail, amplitude)) if name == cable else amplitude
        speed, most = 2 * np.pi * swim.frequency * shaft, robot.servo(name).speed
        if speed > most:
            raise OutsideLimits(
                f"swim {swim.name!r} turns {name} at {speed:.2f} rad/s; its servo turns at {most:.2f} rad/s at most: "
                f"lower the frequency to {swim.frequency * most / speed:.2f} Hz, or the amplitude."
            )
