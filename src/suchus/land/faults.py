"""What can break: a fault is a value on a run."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from suchus.design import AnyRobot, servo_names
from suchus.errors import InvalidDesign, OutsideLimits, UnknownName
from suchus.motion.targets import servo_range

SENSORS = (
    "servo_position",
    "servo_velocity",
    "servo_torque",
    "foot_pressure",
    "belly_pressure",
    "tail_pressure",
    "orientation",
    "angular_velocity",
    "acceleration",
)
"""Groups of sensors that can go deaf: the fields of ``control.Sensed``."""


@dataclass(frozen=True, slots=True)
class Limp:
    """A servo without torque; the friction of its gear stays."""

    joint: str
    """Name of the servo, as ``LF_yaw``."""
    at: float = 0.0
    """When it happens [s]."""
    acts_on: ClassVar[str] = "servo"


@dataclass(frozen=True, slots=True)
class Locked:
    """A servo that holds one angle, within its torque, whatever it is told."""

    joint: str
    """Name of the servo, as ``LH_pitch``."""
    at: float = 0.0
    """When it happens [s]."""
    angle: float | None = None
    """The angle it holds [rad]; None: the one it has at that time."""
    acts_on: ClassVar[str] = "servo"


@dataclass(frozen=True, slots=True)
class Weak:
    """A servo with a part of its torque."""

    joint: str
    """Name of the servo."""
    fraction: float = 0.5
    """What is left of the torque limit [-]."""
    at: float = 0.0
    """When it happens [s]."""
    acts_on: ClassVar[str] = "servo"


@dataclass(frozen=True, slots=True)
class Deaf:
    """A group of sensors that reads zero from now on; a robot that does not listen to them walks on as before.

    An orientation of zero is that of a robot that stands level and faces forward.
    """

    sensor: str
    """Name of the group, as ``foot_pressure``."""
    at: float = 0.0
    """When it happens [s]."""
    acts_on: ClassVar[str] = "sensor"

    @property
    def joint(self) -> str:
        """What it acts on."""
        return self.sensor


Fault = Limp | Locked | Weak | Deaf


def check_faults(faults: Sequence[Fault], robot: AnyRobot, duration: float) -> None:
    """Refuse faults that cannot happen.

    Args:
        faults: of one run.
        robot: that they happen to.
        duration: of the run [s].

    Raises:
        UnknownName: no such joint or sensor.
        InvalidDesign: a time outside the run, a fraction outside 0 to 1, two faults of one joint.
        OutsideLimits: a joint held at an angle that it cannot reach.
    """
    for fault in faults:
        names = servo_names(robot) if fault.acts_on == "servo" else SENSORS
        if fault.joint not in names:
            raise UnknownName("joint" if fault.acts_on == "servo" else "sensor", fault.joint, names)
        if not (math.isfinite(fault.at) and 0.0 <= fault.at < duration):
            raise InvalidDesign(f"{fault} happens at {fault.at} s; the run lasts from 0 to {duration} s.")
        if isinstance(fault, Weak) and not 0.0 <= fault.fraction <= 1.0:
            raise InvalidDesign(f"{fault} leaves {fault.fraction} of the torque; 0 to 1 is allowed.")
        if isinstance(fault, Locked) and fault.angle is not None:
            low, high = servo_range(robot, fault.joint)
            if not low <= fault.angle <= high:
                raise OutsideLimits(f"{fault} holds {fault.angle:g} rad; {low:.3f} to {high:.3f} rad is allowed.")
    for i, fault in enumerate(faults):
        for other in faults[:i]:
            if fault.joint == other.joint:
                raise InvalidDesign(f"{other} and {fault} contradict each other; one fault per joint is allowed.")
