"""Channel, mounting and pulse widths of each servo."""

from dataclasses import dataclass, fields
from math import pi
from pathlib import Path

from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign
from suchus.core.files import write
from suchus.hardware.protocols import PROTOCOLS, channel_protocol
from suchus.robot import blueprint
from suchus.robot.design import Robot, layout
from suchus.robot.design.meaning import meanings

DEFAULT_PROTOCOL = "pca9685"
"""What the boards of a servo map speak that says nothing else."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoLine:
    """One servo: its pulse is ``pulse_centre + pulse_per_radian (direction angle + offset)``."""

    name: str
    """Name of the servo, as ``LF_yaw``; the angle of ``tail_cable`` is that of its pulley, or of a linear actuator its
    travel over the cable's ``pulley``."""
    channel: int
    """Channel of the servo board, from 0 [-]."""
    direction: int
    """1 if longer pulses turn the joint in its positive sense, -1 if they turn it the other way [-]."""
    offset: float
    """Angle of the servo's shaft, in its own sense, when the joint is at zero: how the horn is mounted [rad]."""
    pulse_centre: float
    """Width that turns the shaft to its own zero [us]."""
    pulse_per_radian: float
    """How much wider it is for each radian of the shaft [us/rad]."""
    pulse_min: float
    """Shortest allowed [us]."""
    pulse_max: float
    """Longest allowed [us]."""
    board: int = 0
    """Which servo board, from 0; the usual ones have 16 channels [-]."""

    def __post_init__(self) -> None:
        """Refuse channels, angles and pulse widths out of range."""
        with Checks(f"servo {self.name!r}", self) as check:
            check.whole("channel", 0, 1023)
            check.whole("board", 0, 61)
            check.that(self.direction in (-1, 1), f"direction is {self.direction!r}; 1 or -1 is allowed")
            check.number("offset", -2 * pi, 2 * pi, "rad")
            check.number("pulse_centre", 100.0, 10000.0, "us")
            check.number("pulse_per_radian", 1.0, 10000.0, "us/rad")
            check.number("pulse_min", 50.0, 10000.0, "us")
            check.number("pulse_max", 50.0, 10000.0, "us")
            check.that(
                self.pulse_min < self.pulse_max,
                f"pulse_min is {self.pulse_min:g} us and pulse_max {self.pulse_max:g} us; they must increase",
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoMap:
    """All servos of a robot."""

    name: str
    """Name, as messages, tables and files show it."""
    rate: float
    """Rate of commands [Hz]."""
    servos: tuple[ServoLine, ...]
    """One for each of the robot's servos, in any order."""
    protocol: str = DEFAULT_PROTOCOL
    """What its boards speak: a name of ``suchus.hardware.protocols``."""

    def __post_init__(self) -> None:
        """Refuse a rate out of range, boards without channels, and two servos on one channel."""
        with Checks("servo map", self) as check:
            check.number("rate", 1.0, 1000.0, "Hz")
            check.choice("protocol", PROTOCOLS)
        channel_protocol(self.protocol)
        places = [(line.board, line.channel) for line in self.servos]
        for line in self.servos:
            if places.count((line.board, line.channel)) > 1:
                slot = (line.board, line.channel)
                sharing = ", ".join(
                    neighbour.name for neighbour in self.servos if (neighbour.board, neighbour.channel) == slot
                )
                raise InvalidDesign(
                    f"servo map {self.name!r} has {sharing} on channel {line.channel} of board {line.board}; one each "
                    "is allowed."
                )

    def ordered(self, robot: Robot) -> tuple[ServoLine, ...]:
        """Return the servos in the order of a robot's layout.

        Raises:
            InvalidDesign: a servo of the robot is missing, stands there twice, or is none of the robot's.
        """
        servo_names, names = layout(robot).servos, [line.name for line in self.servos]
        missing = [name for name in servo_names if name not in names]
        unknown = [name for name in names if name not in servo_names]
        duplicates = sorted({name for name in names if names.count(name) > 1})
        if missing or unknown or duplicates:
            problems = (("lacks", missing), ("has unknown", unknown), ("has more than once", duplicates))
            text = "; it ".join(
                f"{verb} {', '.join(problem_names)}" for verb, problem_names in problems if problem_names
            )
            raise InvalidDesign(
                f"servo map {self.name!r} {text}; every servo of robot {robot.name!r} is needed once: "
                f"{', '.join(servo_names)}."
            )
        by_name = {line.name: line for line in self.servos}
        return tuple(by_name[name] for name in servo_names)


def straight(robot: Robot) -> ServoMap:
    """Return a map to start from: servos that turn 270 degrees over 500 to 2500 us, mounted in the middle.

    They hang on PCA9685 boards of 16 channels in the order of the robot's layout. A linear actuator goes through its
    stroke over 1000 to 2000 us, as Actuonix says of its L16-R.
    """
    channels = channel_protocol(DEFAULT_PROTOCOL).channels
    half, reach = (dict.fromkeys(layout(robot).servos, value) for value in (1000.0, 0.75 * pi))
    for cable in robot.cables:
        if cable.linear is not None:
            half[cable.name], reach[cable.name] = 500.0, cable.linear.travel / cable.pulley
    return ServoMap(
        name="straight",
        rate=50.0,
        servos=tuple(
            ServoLine(
                name=name,
                channel=place % channels,
                direction=1,
                offset=0.0,
                pulse_centre=1500.0,
                pulse_per_radian=round(half[name] / reach[name], 3),
                pulse_min=1500.0 - half[name],
                pulse_max=1500.0 + half[name],
                board=place // channels,
            )
            for place, name in enumerate(layout(robot).servos)
        ),
    )


def read_map(path: str | Path, robot: Robot) -> ServoMap:
    """Read a servo map of a robot from a TOML file.

    Raises:
        UnreadableFile: the file is missing or no TOML.
        MistakenFile: values are missing, unknown, of the wrong kind or impossible.
        InvalidDesign: it is not for the servos of this robot.
    """
    start = straight(robot)
    servo_map = blueprint.read_design(path, ServoMap, {start.name: start})
    servo_map.ordered(robot)
    return servo_map


def write_map(servo_map: ServoMap, path: str | Path) -> Path:
    """Write a servo map as a TOML file with one line for each servo, and return the path.

    Raises:
        Unwritable: the place cannot be written to.
    """
    descriptions = meanings(ServoLine)
    notes = [f"# {name}: {' '.join(descriptions[name].split())}" for name in descriptions]
    lines = [
        f"# A servo's pulse is pulse_centre + pulse_per_radian (direction angle + offset).\n{chr(10).join(notes)}\n",
        f"name = {_value(servo_map.name)}",
        f"rate = {servo_map.rate!r}  # {meanings(ServoMap)['rate']}",
        f"protocol = {_value(servo_map.protocol)}  # {meanings(ServoMap)['protocol']}",
        "servos = [",
    ]
    for line in servo_map.servos:
        items = ", ".join(f"{f.name} = {_value(getattr(line, f.name))}" for f in fields(line))
        lines.append(f"  {{{items}}},")
    return write(path, "\n".join([*lines, "]"]) + "\n")


def _value(value: object) -> str:
    return f'"{value}"' if isinstance(value, str) else repr(value)
