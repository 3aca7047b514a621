"""Bus and number of each servo of a robot, and the conversion between steps of the servo and joint angles."""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import Literal, TypeVar

import numpy as np

from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign, UnsuitedRobot
from suchus.core.files import digest
from suchus.hardware.bus.packets import LAST_ID
from suchus.hardware.bus.tables import STEPS, Table, imu_board, load_board
from suchus.hardware.protocols import PROTOCOLS, bus_protocol, servo_table, servo_tables
from suchus.robot.design import Crank, Robot, layout, servo_ranges

T = TypeVar("T")
CLOCK = 250
"""Identifier of the emulator's clock, which no real bus has: written with an absolute tick it lets the robot move until
then; asked with the servos it answers last, so that the end of the answers is known [-]."""
Kind = Literal["imu", "feet", "belly", "tail"]
FORCE_STEPS = 20000
"""Steps in which a board tells the weight of the robot, so that a tenth of a per mille is seen [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BusPlace:
    """One bus."""

    port: str
    """Path of a serial port, as /dev/serial/by-id/..., or ``socket://127.0.0.1:PORT`` of an emulator."""
    protocol: str = "dynamixel"
    """What its servos speak, as ``dynamixel``, ``feetech`` or ``line``: a name of ``suchus.hardware.protocols``."""
    baud: int = 1_000_000
    """Bit rate [1/s]."""

    def __post_init__(self) -> None:
        """Refuse rates out of range, and protocols that are unknown or have no packets."""
        with Checks("bus", self) as check:
            check.whole("baud", 9600, 4_500_000)
            check.that(bool(self.port.strip()), "port is empty; name a serial port or a socket")
            check.choice("protocol", PROTOCOLS)
        bus_protocol(self.protocol)


@dataclass(frozen=True, kw_only=True)
class ServoPlace:
    """One servo: at ``steps`` of its own the joint's angle is ``sign (steps - zero)`` steps of its model.

    A step is ``2 pi / 4096`` for all models that suchus ships.
    """

    name: str
    """Name of the servo, as ``LF_yaw``; the angle of ``tail_cable`` is that of its pulley."""
    id: int
    """Its number on the bus [-]."""
    model: str
    """Its model, as ``XM430-W350``: its control table."""
    bus: int = 0
    """Which bus of the file, from 0 [-]."""
    sign: int = 1
    """1 if more steps turn the joint in its positive sense, -1 if the other way [-]."""
    zero: int = STEPS // 2
    """Steps of the servo when the joint is at zero: how the horn is mounted [-]."""
    low: float = -pi
    """Least angle of the joint that it may be sent to [rad]."""
    high: float = pi
    """Greatest angle of the joint that it may be sent to [rad]."""

    def __post_init__(self) -> None:
        """Refuse ids, models and ranges that no servo has."""
        with Checks(f"servo {self.name!r}", self) as check:
            check.whole("id", 0, LAST_ID)
            check.that(self.id != CLOCK, f"id is {CLOCK}, which stands for the emulator's clock; take another one")
            check.whole("bus", 0, 15)
            check.that(self.sign in (-1, 1), f"sign is {self.sign!r}; 1 or -1 is allowed")
            models = servo_tables()
            check.that(self.model in models, f"model is {self.model!r}; there is {', '.join(models)}")
            turn = round(2 * pi / self.table.step) if self.model in models else STEPS
            check.whole("zero", -turn, 2 * turn)
            check.number("low", -2 * pi, 2 * pi, "rad")
            check.number("high", -2 * pi, 2 * pi, "rad")
            check.that(self.low < self.high, f"low is {self.low:g} rad and high {self.high:g} rad; they must increase")

    @cached_property
    def table(self) -> Table:
        """Its register table."""
        return servo_table(self.model)


@dataclass(frozen=True, slots=True, kw_only=True)
class BoardPlace:
    """One board for sensors, which speaks the protocol of its bus; see ``bus.tables`` for what it must do."""

    kind: Kind
    """``imu``, ``feet``, ``belly`` or ``tail``."""
    id: int
    """Its number on the bus [-]."""
    bus: int = 0
    """Which bus of the file, from 0 [-]."""
    unit: float = 0.001
    """Force of a step, where it feels forces [N]."""

    def __post_init__(self) -> None:
        """Refuse ids and units out of range."""
        with Checks(f"board {self.kind!r}", self) as check:
            check.whole("id", 0, LAST_ID)
            check.that(self.id != CLOCK, f"id is {CLOCK}, which stands for the emulator's clock; take another one")
            check.whole("bus", 0, 15)
            check.number("unit", 1e-9, 1e3, "N")


@dataclass(frozen=True, slots=True, kw_only=True)
class Wiring:
    """All that hangs on the buses of a robot: what ``hardware.toml`` says."""

    robot: str
    """Name of the robot that it was made for."""
    fingerprint: str
    """Fingerprint of that robot's servos and their ranges: another robot is refused."""
    bus: tuple[BusPlace, ...]
    """The buses."""
    servo: tuple[ServoPlace, ...]
    """One for each servo of the robot, in any order."""
    board: tuple[BoardPlace, ...] = ()
    """Boards for sensors; none where the robot feels nothing but its servos."""

    def __post_init__(self) -> None:
        """Refuse ids that occur twice on a bus, buses that do not exist, and mixed protocols on one bus."""
        with Checks("hardware", self) as check:
            check.that(len(self.bus) > 0, "bus is empty; one at least is needed")
            devices: list[ServoPlace | BoardPlace] = [*self.servo, *self.board]
            places = [(device.bus, device.id) for device in devices]
            for place in sorted(duplicates(places)):
                sharing = [_label(device) for device in devices if (device.bus, device.id) == place]
                check.that(
                    False, f"{' and '.join(sharing)} are all number {place[1]} on bus {place[0]}; one is allowed"
                )
            for device in devices:
                check.that(
                    device.bus < len(self.bus),
                    f"{_label(device)} is on bus {device.bus}; there are {len(self.bus)}, from 0",
                )
            for kind in sorted(duplicates([board.kind for board in self.board])):
                check.that(False, f"there are two boards {kind!r}; one is allowed")
            for servo in self.servo:
                bus_protocol = self.bus[servo.bus].protocol if servo.bus < len(self.bus) else servo.table.protocol
                check.that(
                    servo.table.protocol == bus_protocol,
                    f"{servo.name} is a {servo.model}, which speaks {servo.table.protocol}, on a bus that speaks "
                    f"{bus_protocol}",
                )

    def ordered(self, robot: Robot) -> tuple[ServoPlace, ...]:
        """Return the servos in the order of a robot's layout.

        Raises:
            InvalidDesign: it is for another robot, or a servo is missing, stands there twice, or is none of its.
        """
        check_names("hardware", [servo.name for servo in self.servo], robot)
        _refuse_linear(robot)
        if self.fingerprint != fingerprint(robot):
            raise InvalidDesign(
                f"the hardware is wired for robot {self.robot!r} with other servo ranges than {robot.name!r} has: name "
                "the robot that it was made for, or write the file anew for this one."
            )
        by_name = {servo.name: servo for servo in self.servo}
        return tuple(by_name[name] for name in layout(robot).servos)

    def tables(self, board: BoardPlace, robot: Robot) -> Table:
        """Return the table of a board."""
        return board_table(board, self.bus[board.bus].protocol, robot)


def board_table(board: BoardPlace, protocol: str, robot: Robot) -> Table:
    """Return the table of a board of a robot that speaks a protocol."""
    if board.kind == "imu":
        return imu_board(protocol)
    place = layout(robot)
    count = {"feet": len(place.limbs), "belly": len(place.trunk), "tail": 1}[board.kind]
    return load_board(protocol, board.kind, count, board.unit)


def fingerprint(robot: Robot) -> str:
    """Return a hash of a robot's servos and their ranges."""
    ranges = [[round(end, 6) if np.isfinite(end) else None for end in row] for row in servo_ranges(robot).tolist()]
    return digest({"servos": list(layout(robot).servos), "ranges": ranges})[:16]


def own_models(robot: Robot) -> dict[str, str]:
    """Return the models of a robot's servos by name, as its file says; those that no bus speaks with are left out."""
    models = {}
    for name in layout(robot).servos:
        winding = robot.servo(name).winding
        if winding is not None and winding.motor in servo_tables():
            models[name] = winding.motor
    return models


def straight(robot: Robot, bus: Sequence[BusPlace], model: str | Mapping[str, str], *, boards: bool = False) -> Wiring:
    """Return a wiring to start from: servos numbered from 1 in the order of the layout, mounted in the middle.

    Several buses get equal shares of the servos, one after the other; each servo hangs on a bus that it speaks.

    Args:
        robot: robot that is wired.
        bus: the buses; at least one for each protocol of the servos.
        model: model of all servos, or of each by its name.
        boards: whether it has a board for each kind of sensor, on the first bus.

    Raises:
        UnknownName: no protocol has a register table of the model.
        UnsuitedRobot: a servo turns all round, which these do not follow, or a linear actuator moves a cable.
        InvalidDesign: more servos than one bus can number.
    """
    place = layout(robot)
    _refuse_cranks(robot)
    _refuse_linear(robot)
    models = dict.fromkeys(place.servos, model) if isinstance(model, str) else model
    tables = {name: servo_table(models[name]) for name in place.servos}
    slots = _bus_slots(robot, bus, {name: table.protocol for name, table in tables.items()})
    ranges = servo_ranges(robot)
    servo = tuple(
        ServoPlace(
            name=name,
            id=slots[name][1],
            model=models[name],
            bus=slots[name][0],
            zero=tables[name].center,
            low=float(max(ranges[i, 0], _limit_angle(tables[name], "position_low"))),
            high=float(min(ranges[i, 1], _limit_angle(tables[name], "position_high"))),
        )
        for i, name in enumerate(place.servos)
    )
    unit = float(f"{robot.mass * 9.81 / FORCE_STEPS:.1e}")
    kinds: tuple[Kind, ...] = ("imu", *(("feet",) if place.limbs else ()), "belly", "tail")
    board = tuple(BoardPlace(kind=kind, id=200 + i, unit=unit) for i, kind in enumerate(kinds)) if boards else ()
    return Wiring(robot=robot.name, fingerprint=fingerprint(robot), bus=tuple(bus), servo=servo, board=board)


def _limit_angle(table: Table, register: str) -> float:
    """Return the angle of the limit with which a servo comes from its maker [rad]."""
    return (table[register].initial - table.center) * table.step


def _bus_slots(robot: Robot, bus: Sequence[BusPlace], protocols: Mapping[str, str]) -> dict[str, tuple[int, int]]:
    """Return the bus and the number on it of each servo, from 1 in the order of the layout.

    Args:
        robot: whose servos they are.
        bus: the buses.
        protocols: of the servos, by name; one that no bus speaks hangs on the first bus, and is refused later.
    """
    slots: dict[str, tuple[int, int]] = {}
    for protocol in dict.fromkeys(protocols.values()):
        names = [name for name, servo_protocol in protocols.items() if servo_protocol == protocol]
        numbers = [i for i, place in enumerate(bus) if place.protocol == protocol] or list(range(len(bus)))
        share = -(-len(names) // len(numbers))
        if share > 199:
            raise InvalidDesign(
                f"robot {robot.name!r} has {share} servos for each bus; up to 199 are allowed: use more buses."
            )
        slots |= {name: (numbers[i // share], 1 + i % share) for i, name in enumerate(names)}
    return slots


def _refuse_cranks(robot: Robot) -> None:
    """Refuse robots with joints without limits."""
    cranks = [
        f"{limb.name}_{hinge.name}"
        for limb in layout(robot).limbs
        for hinge in limb.girdle.limb.hinges
        if isinstance(hinge.drive, Crank)
    ]
    if cranks:
        raise UnsuitedRobot(
            f"robot {robot.name!r} turns {', '.join(cranks)} all round; servos that hold an angle within one turn "
            "cannot drive it, and no others are spoken with."
        )


def _refuse_linear(robot: Robot) -> None:
    """Refuse robots with linear actuators."""
    linear_cables = [cable.name for cable in robot.cables if cable.linear is not None]
    if linear_cables:
        raise UnsuitedRobot(
            f"robot {robot.name!r} moves {', '.join(linear_cables)} by a linear actuator, and the servos that are "
            "spoken to on "
            "a bus turn: drive it by pulses (suchus export-commands), or let a servo pull the cords by a pulley "
            "(tail.drive = 'cable')."
        )


def check_names(owner: str, names: Sequence[str], robot: Robot) -> None:
    """Refuse names that are not exactly the robot's servos, each once.

    Args:
        owner: what names them, for the message.
        names: names in any order.
        robot: robot whose servos they are to be.

    Raises:
        InvalidDesign: one is missing, stands there twice, or is none of the robot's.
    """
    servo_names = layout(robot).servos
    missing = [name for name in servo_names if name not in names]
    unknown = [name for name in names if name not in servo_names]
    if missing or unknown or duplicates(names):
        problems = (("lacks", missing), ("has unknown", unknown), ("has more than once", sorted(duplicates(names))))
        text = "; it ".join(f"{verb} {', '.join(problem_names)}" for verb, problem_names in problems if problem_names)
        raise InvalidDesign(
            f"{owner} {text}; every servo of robot {robot.name!r} is needed once: {', '.join(servo_names)}."
        )


def duplicates(values: Iterable[T]) -> list[T]:
    """Return the values that occur more than once, each once."""
    return [value for value, count in Counter(values).items() if count > 1]


def _label(device: ServoPlace | BoardPlace) -> str:
    return device.name if isinstance(device, ServoPlace) else f"the board {device.kind!r}"


class Steps:
    """Turns angles of a robot's joints into steps of its servos and back, for all of them at once.

    Args:
        servos: servos in the order of the robot's layout.
    """

    def __init__(self, servos: Sequence[ServoPlace]) -> None:
        self._sign = np.array([servo.sign for servo in servos])
        self._zero = np.array([servo.zero for servo in servos])
        self.unit = np.array([servo.table.step for servo in servos])
        """Angle of a step of each servo, shape (servo,) [rad]."""

    def of(self, angles: np.ndarray) -> np.ndarray:
        """Return the nearest steps of angles, shape (servo,)."""
        steps: np.ndarray = self._zero + np.rint(self._sign * angles / self.unit).astype(int)
        return steps

    def angles(self, steps: np.ndarray) -> np.ndarray:
        """Return the angles of the joints at steps, shape (servo,) [rad]."""
        angles: np.ndarray = self._sign * (steps - self._zero) * self.unit
        return angles

    def rates(self, rates: np.ndarray) -> np.ndarray:
        """Return speeds or torques of the joints from those of the servos, or the other way, shape (servo,)."""
        signed: np.ndarray = self._sign * rates
        return signed
