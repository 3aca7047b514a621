"""The interface of a fault: a frozen value that says which parts it can affect, what it does and how it ends."""

import math
import re
from abc import ABC, abstractmethod
from collections.abc import MutableMapping, Sequence
from dataclasses import fields
from typing import Any, ClassVar, Protocol

import numpy as np

from suchus.core.errors import InvalidDesign, UnknownName
from suchus.core.kinds import misfits
from suchus.robot.design import Robot, layout, servo_names
from suchus.sim.persistence import PERMANENT, Persistence

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
"""Groups of sensors: the fields of ``control.Sensed``."""


class Plant(Protocol):
    """One robot of a running simulation as a fault reaches it, from when the fault begins until it is mended.

    Each spell of an intermittent fault is a beginning of its own.
    """

    @property
    def time(self) -> float:
        """Since the fault, or its present spell, began [s]."""

    @property
    def memory(self) -> dict[str, float]:
        """Numbers that the fault keeps for itself; empty when it begins."""

    @property
    def targets(self) -> MutableMapping[str, float]:
        """Angles that the servos are commanded in this control period, by name [rad]; only in ``Fault.command``."""

    def angle(self, servo: str) -> float:
        """Return the angle of a joint at its servo's shaft, as it is now [rad]."""

    def felt(self, group: str, part_name: str | None = None) -> np.ndarray:
        """Return readings of this control period for writing; only in ``Fault.sense``.

        Args:
            group: one of ``SENSORS``.
            part_name: servo, leg or body of the trunk whose reading is returned, shape (1,); None for the whole group.
        """

    def parameter(self, field: str, element: str) -> np.ndarray:
        """Return this robot's own row of a field of ``mujoco.MjModel`` for writing; ``restore`` undoes what is written.

        Args:
            field: such as ``actuator_forcerange``, ``geom_conaffinity``, ``dof_damping``; constants that MuJoCo
                derives from masses and lengths do not follow.
            element: name of the servo, geom, body or joint.
        """

    def speed_limit(self, servo: str) -> np.ndarray:
        """Return how fast the angle that a servo aims at may change, shape (1,), as ``parameter`` does [rad/s]."""

    def unpower(self, servo: str) -> None:
        """Take the torque from a servo until ``restore``; the friction of its gear stays."""

    def restore(self) -> None:
        """Undo all that this fault wrote with ``parameter``, ``speed_limit`` and ``unpower``."""


class Fault(ABC):
    """What breaks, and when. A fault is a frozen dataclass; its first field names the part that breaks.

    One robot can have several at once, but one for each part. In every control period ``command`` is called, and
    ``sense`` where a controller listens, in the order in which the faults began.
    """

    __slots__ = ()
    acts_on: ClassVar[str]
    """Kind of part that fails: ``servo``, ``limb`` or ``sensor``."""
    at: float
    """Time at which the fault begins [s], at least 0."""
    persistence: Persistence = PERMANENT
    """Whether it stays, recovers, or comes and goes; a kind without a field of this name stays."""

    def __repr__(self) -> str:
        """Return the fault as it is written in Python, without a persistence that says nothing."""
        declared: Any = fields(self)  # type: ignore[arg-type]  # every fault is a dataclass
        shown = [field.name for field in declared if (field.name, self.persistence) != ("persistence", PERMANENT)]
        return f"{type(self).__qualname__}({', '.join(f'{name}={getattr(self, name)!r}' for name in shown)})"

    @property
    @abstractmethod
    def part(self) -> str:
        """Name of the part that breaks."""

    @classmethod
    @abstractmethod
    def parts(cls, robot: Robot) -> tuple[str, ...]:
        """Return the names of the parts of a robot that this fault can affect."""

    @classmethod
    def kind(cls) -> str:
        """Return what it is called in files and tables: ``lost_foot`` for ``LostFoot``."""
        return re.sub(r"(?<!^)(?=[A-Z])", "_", cls.__name__).lower()

    @property
    def name(self) -> str:
        """What it is called in a table, as ``limp LF_yaw``."""
        return f"{self.kind()} {self.part}"

    def refuse(self, robot: Robot) -> None:
        """Say in a sentence why a robot cannot have this fault, if it cannot.

        Raises:
            UnknownName: it has no such part; faults with numbers of their own refuse those too.
        """
        if self.part not in self.parts(robot):
            raise UnknownName("joint" if self.acts_on == "servo" else self.acts_on, self.part, self.parts(robot))

    def apply(self, plant: Plant) -> None:  # noqa: B027 - many faults need nothing when they begin
        """Begin the fault."""

    def command(self, plant: Plant) -> None:  # noqa: B027 - many faults leave commands alone
        """Change what the servos are commanded in a control period, in ``plant.targets``.

        It may be called again within a period, with the angles as they were before.
        """

    def sense(self, plant: Plant) -> None:  # noqa: B027 - many faults leave readings alone
        """Change the sensor readings of a control period, with ``plant.felt``."""

    def mend(self, plant: Plant) -> None:
        """End the fault: the robot is as it was built."""
        plant.restore()


class ServoFault(Fault):
    """A fault of one servo, named by a field ``joint``."""

    __slots__ = ()
    acts_on = "servo"
    joint: str
    """Name of the servo."""

    @property
    def part(self) -> str:
        """Name of the servo."""
        return self.joint

    @classmethod
    def parts(cls, robot: Robot) -> tuple[str, ...]:
        """Return the names of the servos."""
        return servo_names(robot)


class SensorFault(Fault):
    """A fault of a group of sensors, or of one reading of it, named by a field ``sensor``."""

    __slots__ = ()
    acts_on = "sensor"
    sensor: str
    """Name of the group, as ``foot_pressure``, or of one reading, as ``servo_position.LF_yaw``."""

    @property
    def part(self) -> str:
        """Name of the group or reading."""
        return self.sensor

    @classmethod
    def parts(cls, robot: Robot) -> tuple[str, ...]:
        """Return the names of the groups and of their readings."""
        elements = sensor_elements(robot)
        return (*SENSORS, *(f"{group}.{name}" for group, names in elements.items() for name in names))

    def refuse(self, robot: Robot) -> None:
        """Refuse a group or a reading that the robot does not have."""
        group, dot, element = self.sensor.partition(".")
        if group not in SENSORS:
            raise UnknownName("sensor", self.sensor, SENSORS)
        names = sensor_elements(robot).get(group, ())
        if dot and element not in names:
            raise UnknownName(f"reading of {group}", element, names)

    def readings(self, plant: Plant) -> np.ndarray:
        """Return the readings that fail, for writing."""
        group, _, element = self.sensor.partition(".")
        return plant.felt(group, element or None)


def sensor_elements(robot: Robot) -> dict[str, tuple[str, ...]]:
    """Return the names of the readings of each group of sensors that has a reading for each servo, leg or body."""
    robot_layout = layout(robot)
    servo_groups = ("servo_position", "servo_velocity", "servo_torque")
    return {
        **dict.fromkeys(servo_groups, robot_layout.servos),
        "foot_pressure": robot_layout.limb_names,
        "belly_pressure": robot_layout.trunk,
    }


def check_faults(faults: Sequence[Fault], robot: Robot, duration: float) -> None:
    """Refuse faults that cannot happen.

    Args:
        faults: faults of one run.
        robot: robot that they happen to.
        duration: duration of the run [s].

    Raises:
        UnknownName: the robot has no such part.
        InvalidDesign: a time outside the run, a number outside its range, two faults of one part, no fault at all.
        OutsideLimits: a joint held at an angle that it cannot reach.
    """
    for fault in faults:
        if not isinstance(fault, Fault):
            raise InvalidDesign(f"{str(fault)[:60]!r} is no fault; give values such as Limp('LF_yaw').")
        misfit_texts = [f"{field} {text}" for field, text in misfits(fault)]
        if misfit_texts:
            raise InvalidDesign(f"a fault of the kind {fault.kind()} has {'; '.join(misfit_texts)}.")
        fault.refuse(robot)
        if not (math.isfinite(fault.at) and 0.0 <= fault.at < duration):
            raise InvalidDesign(f"{fault} happens at {fault.at} s; the run lasts from 0 to {duration} s.")
    for i, fault in enumerate(faults):
        for earlier_fault in faults[:i]:
            if fault.part == earlier_fault.part:
                raise InvalidDesign(
                    f"{earlier_fault} and {fault} contradict each other; one fault per part is allowed."
                )


def refuse_number(fault: Fault, value: Any, lower_bound: float, upper_bound: float, verb: str, unit: str = "") -> None:
    """Refuse a number of a fault outside its range.

    Args:
        fault: whose.
        value: the number, in its unit.
        lower_bound: least allowed.
        upper_bound: greatest allowed.
        verb: verb phrase before the number, as "moves at" in "moves at 9 rad/s".
        unit: unit of the number.

    Raises:
        InvalidDesign: it is outside, or no finite number.
    """
    if not (isinstance(value, (int, float)) and lower_bound <= value <= upper_bound):
        text = f"{value:g}" if isinstance(value, (int, float)) else f"{value!r:.40}"
        raise InvalidDesign(f"{fault} {verb} {text}{unit}; {lower_bound:g} to {upper_bound:g}{unit} is allowed.")
