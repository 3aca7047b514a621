"""Servos and sensors of a robot over its buses: readings, goals and checks of the settings."""

from collections.abc import Collection, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from time import monotonic

import numpy as np

from suchus.core.errors import BusFailure, InvalidDesign, SuchusError
from suchus.hardware.bus import (
    STEPS,
    WAIT,
    BoardPlace,
    Bus,
    NoAnswer,
    Packet,
    Port,
    Steps,
    Table,
    Wiring,
    latency_timer,
    open_port,
)
from suchus.hardware.protocols import bus_protocol
from suchus.hardware.wiring import wiring_text
from suchus.robot.control import Sensed
from suchus.robot.design import Robot, layout
from suchus.robot.design.scale import control_period

BITS = 10
"""Bits that a byte takes on the wire, start and stop bit included [-]."""
FULLEST = 0.9
"""Share of a tick that the bytes of a bus may take [-]; what is left is for the adapter and the computer."""
PATIENT = 0.1
"""How long a reply is waited for before anything moves [s]: long enough for a computer that does other things too."""
_MAX_ATTEMPTS = 8  # attempts of a request before the robot moves: a tenth of all packets may be lost
_MIN_TICK_FRACTION = 0.25  # least fraction of the wait for requests after those to the servos
_WATCHDOG = 5  # steps of 20 ms
_SENSES = {
    "imu": ("orientation", "angular_velocity", "acceleration"),
    "feet": ("foot_pressure",),
    "belly": ("belly_pressure",),
    "tail": ("tail_pressure",),
}
_OF_SERVOS = ("servo_position", "servo_velocity", "servo_torque")


@dataclass(slots=True)
class RigReading:
    """Last readings of servos and boards."""

    angle: np.ndarray
    """Angles of the joints, shape (servo,) [rad]."""
    velocity: np.ndarray
    """Speeds of the joints, shape (servo,) [rad/s]."""
    torque: np.ndarray
    """Torques by current or load, shape (servo,) [N m]."""
    current: np.ndarray
    """Currents, in the sense of the torque; NaN where a servo tells none, shape (servo,) [A]."""
    voltage: np.ndarray
    """Voltages, NaN before they were read, shape (servo,) [V]."""
    temperature: np.ndarray
    """Temperatures, NaN before they were read, shape (servo,) [degC]."""
    error: np.ndarray
    """Alerts: the bits of ``hardware_error``, shape (servo,) [-]."""
    heard: np.ndarray
    """Whether a servo answered in this tick, shape (servo,)."""
    age: np.ndarray
    """Ticks since a servo answered, shape (servo,) [-]."""
    felt: dict[str, np.ndarray] = field(default_factory=dict)
    """What boards feel, by the fields of ``control.Sensed``, without the run."""


def senses(robot: Robot, boards: Sequence[BoardPlace]) -> tuple[str, ...]:
    """Return the quantities that a robot with some boards senses: fields of ``control.Sensed``."""
    place = layout(robot)
    quantities = [*_OF_SERVOS, *(name for board in boards for name in _SENSES[board.kind])]
    if not place.limbs:  # there is nothing to measure, so that it counts as sensed
        quantities.append("foot_pressure")
    if not place.tail:
        quantities.append("tail_pressure")
    return tuple(quantities)


class Rig:
    """The servos and boards of a robot, over open buses.

    Args:
        robot: the robot.
        wiring: what hangs where.
        ports: to its buses, in their order; by default those that it names are opened.
        has_clock: whether an emulator's clock is told the time.
        rate: rate of ticks [Hz]; that of the robot's control period if None.
        limp_servos: names of servos that do without: they are not asked, and stay limp.
        required_senses: fields of ``control.Sensed`` that must be known at every tick; all if None. Boards that feel
            nothing of them are asked by turns, one in a tick.

    Raises:
        BusFailure: a port cannot be opened.
        InvalidDesign: the wiring is not for this robot, or the bytes of a tick take longer than a tick.
    """

    def __init__(
        self,
        robot: Robot,
        wiring: Wiring,
        ports: Sequence[Port] = (),
        *,
        has_clock: bool = False,
        rate: float | None = None,
        limp_servos: Sequence[str] = (),
        required_senses: Collection[str] | None = None,
    ) -> None:
        """Open the buses of a robot; nothing moves."""
        self.robot, self.wiring, self.clocked = robot, wiring, has_clock
        self.servos = wiring.ordered(robot)
        self.names = layout(robot).servos
        unknown = [name for name in limp_servos if name not in self.names]
        if unknown:
            raise InvalidDesign(
                f"{', '.join(unknown)} is no servo of {robot.name!r}; there is {', '.join(self.names)}."
            )
        self.without = tuple(limp_servos)
        self.period = control_period(robot) if rate is None else 1.0 / rate
        self.asked = np.array([name not in self.without for name in self.names])
        self.steps = Steps(self.servos)
        self.low = np.array([servo.low for servo in self.servos])
        self.high = np.array([servo.high for servo in self.servos])
        self.speed = np.array([robot.servo(name).speed for name in self.names])
        self._members = [
            [i for i, servo in enumerate(self.servos) if servo.bus == number and self.asked[i]]
            for number in range(len(wiring.bus))
        ]
        self._always: list[list[BoardPlace]] = []
        self._turns: list[list[int | BoardPlace]] = []
        for number in range(len(wiring.bus)):
            boards = [board for board in wiring.board if board.bus == number]
            prompt_boards = [
                b for b in boards if required_senses is None or not set(_SENSES[b.kind]).isdisjoint(required_senses)
            ]
            self._always.append(prompt_boards)
            seldom: list[int | BoardPlace] = [b for b in boards if b not in prompt_boards]
            members = self._members[number]
            if members and self.servos[members[0]].table.health is not None:
                seldom = [device for i in members for device in (i, *seldom)]  # a board as often as all servos together
            self._turns.append(seldom)
        self._check_time()
        self._wait = min(WAIT, 0.8 * self.period)
        self.buses: list[Bus] = []
        try:
            for number, place in enumerate(wiring.bus):
                port = ports[number] if ports else open_port(place.port, place.baud)
                self.buses.append(Bus(port, bus_protocol(place.protocol), wait=self._wait, has_clock=has_clock))
        except BaseException:
            self.close()
            raise
        self._turn = 0
        count = len(self.servos)
        angle, velocity, torque, current, voltage, temperature = np.full((6, count), np.nan)
        self.now = RigReading(
            angle=angle,
            velocity=velocity,
            torque=torque,
            current=current,
            voltage=voltage,
            temperature=temperature,
            error=np.zeros(count, dtype=int),
            heard=np.zeros(count, dtype=bool),
            age=np.zeros(count, dtype=int),
        )
        self._has_watchdog = np.array(["bus_watchdog" in servo.table for servo in self.servos])
        self.jumps = np.zeros(count, dtype=int)
        """How often in a row a servo said that it is where it cannot be, shape (servo,) [-]."""

    @property
    def senses(self) -> tuple[str, ...]:
        """What the robot senses: fields of ``control.Sensed``."""
        return senses(self.robot, self.wiring.board)

    @property
    def bounds(self) -> Sequence[tuple[str, float, float]]:
        """Name of each servo, and the least and greatest angle that it may be sent to [rad]."""
        return [(servo.name, servo.low, servo.high) for servo in self.servos]

    @property
    def step(self) -> float:
        """Greatest step of its servos' angles [rad]."""
        return float(self.steps.unit.max(initial=0.0))

    @property
    def text(self) -> str:
        """How it is wired, as its file says."""
        return wiring_text(self.wiring)

    # --- before it moves ----------------------------------------------------------------------------------------------

    def bytes_per_tick(self, number: int) -> tuple[int, int]:
        """Return the bytes and the number of replies on a bus in a tick."""
        protocol, members = bus_protocol(self.wiring.bus[number].protocol), self._members[number]
        total = answers = 0
        if members:
            table = self.servos[members[0]].table
            length = table.block(table.felt)[1]
            goal = table["goal_position"]
            ids = [self.servos[i].id for i in members]
            total += len(protocol.sync_read(ids, 0, length)) + len(members) * len(protocol.reply(_typical(length)))
            total += len(protocol.sync_write(goal.address, {servo_id: _typical(goal.size).data for servo_id in ids}))
            answers += len(members)
        extra = [self._bytes_of(number, device) for device in self._turns[number]]
        request_bytes = [self._bytes_of(number, device) for device in self._always[number]] + (
            [max(extra)] if extra else []
        )
        return total + sum(request_bytes), answers + len(request_bytes)

    def _bytes_of(self, number: int, device: int | BoardPlace) -> int:
        """Return the bytes for reading the state of a servo, or the sensors of a board."""
        protocol = bus_protocol(self.wiring.bus[number].protocol)
        if isinstance(device, BoardPlace):
            table = self.wiring.tables(device, self.robot)
            reply = protocol.reply(_typical(table.block(table.felt)[1]))
            return len(protocol.sync_read((device.id,), 0, 2)) + len(reply)
        health = self.servos[device].table.health
        assert health is not None
        return len(protocol.read(1, 0, 2)) + len(protocol.reply(_typical(self.servos[device].table.block(health)[1])))

    def _check_time(self) -> None:
        """Refuse buses that carry more bytes in a tick than their bit rate allows."""
        for number, place in enumerate(self.wiring.bus):
            total, _ = self.bytes_per_tick(number)
            seconds = total * BITS / place.baud
            if not self.clocked and seconds > FULLEST * self.period:
                raise InvalidDesign(
                    f"bus {number} carries {total} bytes a tick, {1e3 * seconds:.1f} ms at {place.baud} baud, and a "
                    "tick "
                    f"lasts {1e3 * self.period:g} ms: set its servos to a faster rate, share them among two buses, or "
                    f"drive at --rate {FULLEST / seconds:.0f}."
                )

    def check(self) -> list[str]:
        """Check that all servos answer and are set as needed; return warnings that do not forbid a drive.

        Raises:
            BusFailure: a servo does not answer, or cannot be driven as it is set; nothing has moved.
        """
        if self.clocked and self.buses[0].clock() is None:
            raise BusFailure(
                f"no clock answers on {self.buses[0].port.name}: only an emulator has one, started with --clock bus; a "
                "robot is driven with --clock wall."
            )
        remarks: list[str] = []
        for bus in self.buses:
            bus.wait = PATIENT
        for number, bus in enumerate(self.buses):
            self._find(number, bus)
            remarks += self._settings(number, bus)
            keeps = latency_timer(bus.port.name)
            if keeps is not None and keeps > 1:
                raise BusFailure(
                    f"the adapter of {bus.port.name} keeps bytes back for {keeps} ms, longer than a tick bears: as "
                    "root, "
                    "write into /etc/udev/rules.d/99-servos.rules the line "
                    'ACTION=="add", SUBSYSTEM=="usb-serial", DRIVER=="ftdi_sio", ATTR{latency_timer}="1" and plug it '
                    "in "
                    "anew."
                )
        for bus in self.buses:
            bus.settle()
            bus.wait = self._wait
        return remarks

    def _find(self, number: int, bus: Bus) -> None:
        """Refuse a bus on which a servo or board does not answer, or two have one number."""
        members = self._members[number]
        names_by_id = {self.servos[i].id: self.servos[i].name for i in members}
        names_by_id |= {board.id: f"the board {board.kind!r}" for board in self.wiring.board if board.bus == number}
        garbled = {}
        answering_ids: set[int] = set()
        for servo in names_by_id:
            broken = bus.broken + bus.dropped
            for _ in range(_MAX_ATTEMPTS):
                if bus.ping(servo) is not None:
                    answering_ids.add(servo)
                    break
            garbled[servo] = bus.broken + bus.dropped > broken and servo not in answering_ids
        missing = [servo for servo in names_by_id if servo not in answering_ids]
        if names_by_id and not answering_ids and not any(garbled.values()):
            raise BusFailure(self._nobody(number, bus, next(iter(names_by_id))))
        twins = [servo for servo in missing if garbled[servo]]
        if twins:
            raise BusFailure(
                f"{_listed(names_by_id, twins)} on {bus.port.name} answers with replies that cannot be read, and "
                "nobody else "
                "does so: two servos have that number. Unplug one and give it another."
            )
        if missing:
            other_ids = ", ".join(str(servo_id) for servo_id in sorted(answering_ids)) or "none"
            raise BusFailure(
                f"{_listed(names_by_id, missing)} on {bus.port.name} does not answer; there answer {other_ids}. Look "
                "at its plug "
                "and its number, or go on with it limp by --without NAME."
            )

    def _nobody(self, number: int, bus: Bus, servo: int) -> str:
        """Return the sentence for a bus on which nobody answers, with the bit rate at which one does."""
        place = self.wiring.bus[number]
        if not place.port.startswith("socket://") and not self.clocked:
            bus.close()
            for baud in sorted(set(bus.protocol.bauds.values())):
                if baud == place.baud:
                    continue
                with suppress(SuchusError):
                    trial_bus = Bus(open_port(place.port, baud), bus.protocol)
                    reply = trial_bus.ping(servo)
                    trial_bus.close()
                    if reply is not None:
                        return (
                            f"nobody answers on {place.port} at {place.baud} baud, but at {baud} baud number {servo} "
                            "does: "
                            f"write baud = {baud}, or set the servos to {place.baud} with their maker's program."
                        )
        return (
            f"nobody answers on {place.port} at {place.baud} baud: look at the power of the servos, the plug of the "
            "bus "
            f"and whether they speak {place.protocol}. For an emulated robot start suchus emulate first."
        )

    def _settings(self, number: int, bus: Bus) -> list[str]:
        """Refuse servos whose settings do not fit, and return warnings about servos without a watchdog."""
        unwatched_names = []
        delay = 0.0
        for i in self._members[number]:
            servo = self.servos[i]
            model = self._read_register(bus, i, "model_number")
            if model != servo.table.number:
                raise BusFailure(
                    f"{servo.name}, number {servo.id}, says that it is model {model}; {servo.model} is "
                    f"{servo.table.number}: its "
                    "registers may stand elsewhere. Correct the model in the file."
                )
            if "return_delay" in servo.table:
                delay += self._read_register(bus, i, "return_delay") * servo.table["return_delay"].unit
            if "operating_mode" in servo.table and (
                self._read_register(bus, i, "operating_mode") != servo.table["operating_mode"].initial
            ):
                raise BusFailure(
                    f"{servo.name}, number {servo.id}, is not in its mode for positions: set its operating mode to "
                    f"{servo.table['operating_mode'].initial} with its maker's program."
                )
            self._check_range(bus, i)
            self._has_watchdog[i] = "bus_watchdog" in servo.table and (
                self._read_register(bus, i, "firmware") >= servo.table.watches_from
            )
            if not self._has_watchdog[i]:
                unwatched_names.append(servo.name)
        total, answers = self.bytes_per_tick(number)
        seconds = total * BITS / self.wiring.bus[number].baud + delay
        if not self.clocked and seconds > FULLEST * self.period:
            delay_per_servo = delay / max(len(self._members[number]), 1)
            raise BusFailure(
                f"the servos on {bus.port.name} wait {1e6 * delay_per_servo:.0f} us each before they answer, which "
                "makes a tick of "
                f"{answers} replies {1e3 * seconds:.1f} ms long, and it may last {1e3 * self.period:g} ms: set their "
                f"return_delay to 0 (address {self._delay_address(number)}), or "
                f"drive at --rate {FULLEST / seconds:.0f}."
            )
        if unwatched_names:
            return [
                f"{unwatched_names[0] if len(unwatched_names) == 1 else f'{len(unwatched_names)} servos'} on "
                f"{bus.port.name} would hold the last goal with "
                "full torque if this computer died: they have no watchdog, or too old a firmware for it (Dynamixel X: "
                "from 38). Renew the firmware, or put a relay into their supply."
            ]
        return []

    def _delay_address(self, number: int) -> int:
        """Return the address at which the servos of a bus keep how long they wait before they answer."""
        tables = [self.servos[i].table for i in self._members[number]]
        return next(table["return_delay"].address for table in tables if "return_delay" in table)

    def _check_range(self, bus: Bus, i: int) -> None:
        """Refuse a servo whose own limits are narrower than those of the file."""
        servo = self.servos[i]
        lower_bound, upper_bound = (self._read_register(bus, i, name) for name in ("position_low", "position_high"))
        if lower_bound == upper_bound == 0:  # how Feetech says that there are none
            return
        step = servo.table.step
        ends = sorted(servo.zero + servo.sign * round(angle / step) for angle in (servo.low, servo.high))
        if ends[0] < lower_bound or ends[1] > upper_bound:
            raise BusFailure(
                f"{servo.name}, number {servo.id}, takes goals from {lower_bound} to {upper_bound} steps, and the "
                f"file sends it from {ends[0]} to {ends[1]}: its zero is wrong, or set its position limits "
                f"({servo.table['position_low'].address} and {servo.table['position_high'].address}) anew."
            )

    def _read_register(self, bus: Bus, i: int, register: str) -> int:
        """Return the value of a register of servo i, which is asked for several times."""
        servo = self.servos[i]
        for _ in range(_MAX_ATTEMPTS - 1):
            with suppress(NoAnswer):
                return bus.read(servo.id, servo.table[register])
        return bus.read(servo.id, servo.table[register])

    # --- while it moves -----------------------------------------------------------------------------------------------

    def read(self) -> RigReading:
        """Read all servos and boards; a servo that is silent keeps its last reading, which becomes older."""
        end = monotonic() + self._wait
        for number, bus in enumerate(self.buses):
            if self._members[number]:
                bus.begin([self.servos[i].id for i in self._members[number]], *self._block(number))
        reading = self.now
        reading.heard = np.zeros(len(self.servos), dtype=bool)
        reading.age = reading.age + 1
        for number, bus in enumerate(self.buses):
            members = self._members[number]
            if members:
                ids = [self.servos[i].id for i in members]
                replies = bus.end(ids, self._block(number)[1], max(end - monotonic(), 0.0))
                for i in members:
                    if self.servos[i].id in replies:
                        reply = replies[self.servos[i].id]
                        self._take(i, self.servos[i].table, reply.data, alert=bus.protocol.alert(reply.code))
                        reading.age[i] += int(self.servos[i].id in bus.late)
        for number, bus in enumerate(self.buses):
            for board in self._always[number]:
                self._feel(bus, board, max(end - monotonic(), _MIN_TICK_FRACTION * self._wait))
            if bus.settled and (self.clocked or end - monotonic() > _MIN_TICK_FRACTION * self._wait):
                self._poll_health(number, bus)
        self._turn += 1
        return reading

    def _block(self, number: int) -> tuple[int, int]:
        table = self.servos[self._members[number][0]].table
        return table.block(table.felt)

    def _take(self, i: int, table: Table, data: bytes, *, alert: bool) -> None:
        """Store position, speed and torque of servo i from a reply; an impossible position counts as a jump."""
        reading, servo = self.now, self.servos[i]
        values = table.unpack(table.felt, data)
        angle = servo.sign * (values["present_position"] - servo.zero) * table.step
        max_step = 3.0 * self.speed[i] * self.period * reading.age[i] + table.step
        if np.isfinite(reading.angle[i]) and abs(angle - reading.angle[i]) > max_step and self.jumps[i] < JUMPS:
            self.jumps[i] += 1
            return
        self.jumps[i] = 0
        reading.angle[i], reading.heard[i], reading.age[i] = angle, True, 0
        reading.velocity[i] = servo.sign * values["present_velocity"] * table["present_velocity"].unit
        if "present_current" in values:
            reading.current[i] = servo.sign * values["present_current"] * table["present_current"].unit
            reading.torque[i] = reading.current[i] * table.torque_per_ampere
        else:
            reading.torque[i] = servo.sign * values["present_load"] * table["present_load"].unit * table.stall_torque
        self._health(i, table, values)
        if not alert:
            reading.error[i] = 0
        elif not reading.error[i]:
            reading.error[i] = -1  # which alert, is asked when the bus has time for it

    def _health(self, i: int, table: Table, values: dict[str, int]) -> None:
        """Store voltage, temperature and alerts of servo i, as far as a block of registers holds them."""
        reading = self.now
        if "present_voltage" in values:
            reading.voltage[i] = values["present_voltage"] * table["present_voltage"].unit
        if "present_temperature" in values:
            reading.temperature[i] = values["present_temperature"]
        if "hardware_error" in values:
            reading.error[i] = values["hardware_error"]

    def _poll_health(self, number: int, bus: Bus) -> None:
        """Read the state of one servo, one with an alert first, or a board, if the bus has time for it."""
        alarmed = [i for i in self._members[number] if self.now.error[i] == -1]
        turns = self._turns[number]
        if alarmed:
            servo = self.servos[alarmed[0]]
            with suppress(NoAnswer):
                self.now.error[alarmed[0]] = bus.read(servo.id, servo.table["hardware_error"])
        elif turns:
            device = turns[self._turn % len(turns)]
            if isinstance(device, BoardPlace):
                self._feel(bus, device, self._wait)
                return
            table = self.servos[device].table
            assert table.health is not None
            address, length = table.block(table.health)
            with suppress(NoAnswer):
                reply = bus.ask(
                    bus.protocol.read(self.servos[device].id, address, length), self.servos[device].id, length
                )
                self._health(device, table, table.unpack(table.health, reply.data))

    def _feel(self, bus: Bus, board: BoardPlace, wait: float) -> None:
        """Read a board, and store what its sensors measure."""
        table = self.wiring.tables(board, self.robot)
        address, length = table.block(table.felt)
        bus.begin((board.id,), address, length)
        replies = bus.end((board.id,), length, wait)
        if board.id not in replies:
            return
        values = table.unpack(table.felt, replies[board.id].data)
        row = np.array([values[register.name] * register.unit for register in table.registers[1:]])
        if board.kind == "imu":
            orientation = row[:4] / max(float(np.linalg.norm(row[:4])), 1e-9)
            self.now.felt |= {"orientation": orientation, "angular_velocity": row[4:7], "acceleration": row[7:10]}
        else:
            self.now.felt[_SENSES[board.kind][0]] = row if board.kind != "tail" else row[0]

    def sensed(self, time: float) -> Sensed:
        """Return the readings for a controller: NaN for quantities without a sensor.

        Args:
            time: time since the beginning [s].
        """
        reading, place = self.now, layout(self.robot)
        shapes = {
            "foot_pressure": (len(place.limbs),), "belly_pressure": (len(place.trunk),), "tail_pressure": (),
            "orientation": (4,), "angular_velocity": (3,), "acceleration": (3,),
        }  # fmt: skip
        sensor_values = {
            name: np.array(reading.felt.get(name, np.full(shape, np.nan)))[None] for name, shape in shapes.items()
        }
        if not place.tail:
            sensor_values["tail_pressure"] = np.zeros(1)
        return Sensed(
            time=time,
            servo_position=reading.angle[None].copy(),
            servo_velocity=reading.velocity[None].copy(),
            servo_torque=reading.torque[None].copy(),
            **sensor_values,
        )

    def aim(self, angles: np.ndarray) -> np.ndarray:
        """Send all servos to angles, and return the rounded angles, shape (servo,) [rad]."""
        steps = self.steps.of(angles)
        self.write("goal_position", dict(enumerate(steps.tolist())))
        return self.steps.angles(steps)

    def torque(self, enable: bool) -> None:
        """Switch the torque of all servos on or off."""
        self.write("torque_enable", dict.fromkeys(range(len(self.servos)), int(enable)))

    def limit(self, fraction: float) -> None:
        """Limit all servos to a fraction of their torque, 0 to 1 [-]."""
        self.write("torque_limit", {i: round(fraction * servo.table.full) for i, servo in enumerate(self.servos)})

    def ready(self, goals: np.ndarray) -> np.ndarray:
        """Switch the torque of all servos on at goals, verify it, and return the rounded goals [rad]."""
        everybody = range(len(self.servos))
        steps = self.steps.of(goals)
        self.surely(
            "bus_watchdog", dict.fromkeys(np.flatnonzero(self._has_watchdog).tolist(), 0)
        )  # ends an older one, which would keep goals away
        self.surely("goal_position", dict(enumerate(steps.tolist())))
        self.surely("torque_limit", {i: servo.table.full for i, servo in enumerate(self.servos)})
        self.surely("torque_enable", dict.fromkeys(everybody, 1))
        return self.steps.angles(steps)

    @property
    def patience(self) -> float:
        """Time without a word from us after which a servo that watches stands still and takes no goals [s]."""
        units = (self.servos[i].table["bus_watchdog"].unit for i in np.flatnonzero(self._has_watchdog))
        return _WATCHDOG * min(units, default=np.inf)

    def watch(self, enable: bool) -> None:
        """Switch the watchdogs of the servos on or off."""
        self.write(
            "bus_watchdog", dict.fromkeys(np.flatnonzero(self._has_watchdog).tolist(), _WATCHDOG if enable else 0)
        )

    def surely(self, register: str, values: dict[int, int]) -> None:
        """Write a register of servos one after another, and verify each by its reply.

        Raises:
            BusFailure: one does not say so, or refuses.
        """
        for i, value in values.items():
            servo = self.servos[i]
            if not self.asked[i] or register not in servo.table:
                continue
            for attempts_left in reversed(range(_MAX_ATTEMPTS)):
                try:
                    self.buses[servo.bus].write(servo.id, servo.table[register], value)
                    break
                except NoAnswer:
                    if not attempts_left:
                        raise

    def write(self, register: str, values: dict[int, int]) -> None:
        """Write a register of some servos at once, by their places in the layout."""
        for number, bus in enumerate(self.buses):
            members = [i for i in self._members[number] if i in values]
            if members:
                bus.write_all(self.servos[members[0]].table[register], {self.servos[i].id: values[i] for i in members})

    def close(self) -> None:
        """Let go of the buses."""
        for bus in self.buses:
            bus.close()


JUMPS = 3
"""How often in a row a reading may be refused since nothing moves so fast, before it is believed and the robot stopped
[-]."""


def _typical(length: int) -> Packet:
    """Return a reply with a number of bytes of data, as long as a usual one."""
    return Packet(200, 0, STEPS.to_bytes(2, "little") * (length // 2) + bytes(length % 2))


def _listed(names_by_id: dict[int, str], servo_ids: Sequence[int]) -> str:
    """Return the numbers of up to six servos with their names."""
    return " and ".join(f"number {servo_id} ({names_by_id[servo_id]})" for servo_id in servo_ids[:6])
