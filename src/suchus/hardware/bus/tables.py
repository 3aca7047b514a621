"""Control tables: the registers of each servo that we speak with, by the same names for all makers.

Sources: ROBOTIS e-manual and the tables of its SDK (Apache-2.0) for the X series; LeRobot's tables (Apache-2.0) and
Feetech's manual for STS. Boards for sensors are nobody's product: their tables say what a board of one's own must do.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import pi
from types import MappingProxyType
from typing import Literal

from suchus.core.errors import UnknownName
from suchus.robot.design import Motor
from suchus.robot.motors import motors

Sign = Literal["none", "two", "bit"]
BusProtocol = Literal["dynamixel", "feetech", "line"]
"""Protocols that are spoken, by name."""

STEPS = 4096
"""Steps of a turn, of every servo here [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Register:
    """One value in a control table."""

    name: str
    """As ``present_position``."""
    address: int
    """Of its first byte."""
    size: int
    """Width [byte]."""
    unit: float = 1.0
    """What a step of it is in SI units: rad, rad/s, A, V, K, s."""
    sign: Sign = "none"
    """How negative numbers are written: none are, as two's complement, or by a bit."""
    sign_bit: int = 15
    """Which bit says minus, where one does [-]."""
    writable: bool = False
    """Whether it can be written."""
    initial: int = 0
    """As it comes from the maker, in steps of the register [-]."""
    span: tuple[int, int] | None = None
    """Least and greatest value that it takes; None for all that fit."""

    def encode(self, value: int) -> bytes:
        """Return the bytes of a value, which is clipped to the range of the register."""
        if self.sign == "two":
            limit = 1 << (8 * self.size - 1)
            return min(max(value, -limit), limit - 1).to_bytes(self.size, "little", signed=True)
        if self.sign == "bit":
            limit = 1 << self.sign_bit
            value = min(abs(value), limit - 1) | (limit if value < 0 else 0)
        return min(max(value, 0), (1 << 8 * self.size) - 1).to_bytes(self.size, "little")

    def decode(self, data: bytes) -> int:
        """Return the value of bytes."""
        value = int.from_bytes(data, "little", signed=self.sign == "two")
        if self.sign == "bit" and value >> self.sign_bit & 1:
            return -(value & ((1 << self.sign_bit) - 1))
        return value


@dataclass(frozen=True, kw_only=True)
class Table:
    """The registers of one model, and how they are used."""

    model: str
    """As ``hardware.toml`` calls it."""
    number: int
    """What it answers when it is asked for its model [-]."""
    protocol: BusProtocol
    """``dynamixel``, ``feetech`` or ``line``."""
    registers: tuple[Register, ...]
    """In the order of their addresses."""
    motor: Motor | None = None
    """What is bought; None for a board."""
    felt: tuple[str, str]
    """First and last register of the block that is read at every tick."""
    health: tuple[str, str] | None = None
    """First and last register of the block that is read of one servo a tick by turns; None where the block at every
    tick holds voltage and temperature."""
    bauds: Mapping[int, int] = field(default_factory=dict)
    """Bit rates by the value of ``baud_rate`` [1/s]."""
    watches_from: int = 0
    """Firmware from which its watchdog does its work [-]."""
    persistent: int = 0
    """Addresses below this are kept without power, and refused while torque is on (``locks``) [-]."""
    full: int = 1000
    """Value of ``torque_limit`` that stands for all of the torque [-]."""
    alerts: tuple[tuple[int, str], ...] = ()
    """Bits of ``hardware_error``, and what they say."""

    @property
    def stall_torque(self) -> float:
        """Torque at rest [N m]; what its load is a share of."""
        return 1.0 if self.motor is None else self.motor.stall_torque

    @property
    def continuous_torque(self) -> float:
        """Torque that it can give for ever [N m]."""
        return 1.0 if self.motor is None else self.motor.continuous_torque

    @property
    def torque_per_ampere(self) -> float:
        """That over the current at rest [N m/A]: what a current is taken to be, which the gear's friction blurs."""
        return 1.0 if self.motor is None else self.motor.stall_torque / self.motor.stall_current

    @cached_property
    def by_name(self) -> Mapping[str, Register]:
        """The registers by name."""
        return MappingProxyType({register.name: register for register in self.registers})

    def __getitem__(self, name: str) -> Register:
        if name not in self.by_name:
            raise UnknownName(f"register of {self.model}", name, self.by_name)
        return self.by_name[name]

    def __contains__(self, name: object) -> bool:
        return name in self.by_name

    def block(self, ends: tuple[str, str]) -> tuple[int, int]:
        """Return address and length of the block from one register to another [byte]."""
        first_register, last_register = self[ends[0]], self[ends[1]]
        return first_register.address, last_register.address + last_register.size - first_register.address

    def unpack(self, ends: tuple[str, str], data: bytes) -> dict[str, int]:
        """Return the values of a block by register."""
        start, length = self.block(ends)
        return {
            register.name: register.decode(data[register.address - start : register.address - start + register.size])
            for register in self.registers
            if start <= register.address and register.address + register.size <= start + length
        }

    @cached_property
    def length(self) -> int:
        """Bytes of the whole table [byte]."""
        last_register = self.registers[-1]
        return last_register.address + last_register.size


_RPM = 2 * pi / 60
_STEP = 2 * pi / STEPS


_AMPERES = {"XM": 2.69e-3, "XW": 2.69e-3, "XC330": 1e-3}
"""What a step of ``present_current`` is, by how the name of a model begins [A]; others tell a load only."""


def _x_series(motor: Motor) -> Table:
    """Return the table of an X servo."""
    current = next((step for start, step in _AMPERES.items() if motor.name.startswith(start)), 0.0)
    min_voltage, max_voltage = (round(10 * end) for end in motor.volts_range)
    hottest = round(motor.temperature_limit)
    two: Sign = "two"
    return Table(
        model=motor.name,
        number=motor.model_number,
        protocol="dynamixel",
        motor=motor,
        registers=(
            Register(name="model_number", address=0, size=2, initial=motor.model_number),
            Register(name="firmware", address=6, size=1, initial=48),
            Register(name="id", address=7, size=1, writable=True, initial=1, span=(0, 252)),
            Register(name="baud_rate", address=8, size=1, writable=True, initial=1, span=(0, 7)),
            Register(name="return_delay", address=9, size=1, unit=2e-6, writable=True, initial=250, span=(0, 254)),
            Register(name="operating_mode", address=11, size=1, writable=True, initial=3, span=(0, 16)),
            Register(name="homing_offset", address=20, size=4, unit=_STEP, sign=two, writable=True),
            Register(name="temperature_limit", address=31, size=1, writable=True, initial=hottest, span=(0, 100)),
            Register(name="voltage_high", address=32, size=2, unit=0.1, writable=True, initial=max_voltage),
            Register(name="voltage_low", address=34, size=2, unit=0.1, writable=True, initial=min_voltage),
            Register(name="position_high", address=48, size=4, unit=_STEP, writable=True, initial=STEPS - 1,
                     span=(0, STEPS - 1)),
            Register(name="position_low", address=52, size=4, unit=_STEP, writable=True, span=(0, STEPS - 1)),
            Register(name="shutdown", address=63, size=1, writable=True, initial=52),
            Register(name="torque_enable", address=64, size=1, writable=True, span=(0, 1)),
            Register(name="status_level", address=68, size=1, writable=True, initial=2, span=(0, 2)),
            Register(name="hardware_error", address=70, size=1),
            Register(name="bus_watchdog", address=98, size=1, unit=0.02, sign=two, writable=True, span=(0, 127)),
            Register(name="torque_limit", address=100, size=2, sign=two, writable=True, initial=885,
                     span=(-885, 885)),
            Register(name="profile_velocity", address=112, size=4, unit=0.229 * _RPM, writable=True),
            Register(name="goal_position", address=116, size=4, unit=_STEP, sign=two, writable=True, initial=2048),
            Register(name="present_current" if current else "present_load", address=126, size=2,
                     unit=current or 1e-3, sign=two),
            Register(name="present_velocity", address=128, size=4, unit=0.229 * _RPM, sign=two),
            Register(name="present_position", address=132, size=4, unit=_STEP, sign=two, initial=2048),
            Register(name="present_voltage", address=144, size=2, unit=0.1, initial=120),
            Register(name="present_temperature", address=146, size=1, initial=25),
        ),
        felt=("present_current" if current else "present_load", "present_position"),
        health=("present_voltage", "present_temperature"),
        bauds=MappingProxyType(
            {0: 9600, 1: 57600, 2: 115200, 3: 1_000_000, 4: 2_000_000, 5: 3_000_000, 6: 4_000_000}
        ),
        watches_from=38,
        persistent=64,
        full=885,
        alerts=(
            (0, "input voltage"), (2, "overheated"), (3, "encoder"), (4, "electrical shock"), (5, "overload"),
        ),
    )  # fmt: skip


def _sts(motor: Motor) -> Table:
    """Return the table of an STS servo: without a watchdog, it holds its last goal when the host is gone."""
    hottest = round(motor.temperature_limit)
    min_voltage, max_voltage = (round(10 * end) for end in motor.volts_range)
    return Table(
        model=motor.name,
        number=motor.model_number,
        protocol="feetech",
        motor=motor,
        registers=(
            Register(name="firmware", address=0, size=1, initial=3),
            Register(name="model_number", address=3, size=2, initial=motor.model_number),
            Register(name="id", address=5, size=1, writable=True, initial=1, span=(0, 253)),
            Register(name="baud_rate", address=6, size=1, writable=True, span=(0, 7)),
            Register(name="return_delay", address=7, size=1, unit=2e-6, writable=True, span=(0, 254)),
            Register(name="status_level", address=8, size=1, writable=True, initial=1, span=(0, 1)),
            Register(name="position_low", address=9, size=2, unit=_STEP, writable=True, span=(0, STEPS - 1)),
            Register(name="position_high", address=11, size=2, unit=_STEP, writable=True, initial=STEPS - 1,
                     span=(0, STEPS - 1)),
            Register(name="temperature_limit", address=13, size=1, writable=True, initial=hottest, span=(0, 100)),
            Register(name="voltage_high", address=14, size=1, unit=0.1, writable=True, initial=max_voltage),
            Register(name="voltage_low", address=15, size=1, unit=0.1, writable=True, initial=min_voltage),
            Register(name="homing_offset", address=31, size=2, unit=_STEP, sign="bit", sign_bit=11, writable=True),
            Register(name="operating_mode", address=33, size=1, writable=True, span=(0, 3)),
            Register(name="torque_enable", address=40, size=1, writable=True, span=(0, 128)),
            Register(name="goal_position", address=42, size=2, unit=_STEP, sign="bit", writable=True, initial=2048),
            Register(name="goal_velocity", address=46, size=2, unit=_STEP, sign="bit", writable=True),
            Register(name="torque_limit", address=48, size=2, writable=True, initial=1000, span=(0, 1000)),
            Register(name="lock", address=55, size=1, writable=True, initial=1, span=(0, 1)),
            Register(name="present_position", address=56, size=2, unit=_STEP, sign="bit", initial=2048),
            Register(name="present_velocity", address=58, size=2, unit=_STEP, sign="bit"),
            Register(name="present_load", address=60, size=2, unit=1e-3, sign="bit", sign_bit=10),
            Register(name="present_voltage", address=62, size=1, unit=0.1, initial=120),
            Register(name="present_temperature", address=63, size=1, initial=25),
            Register(name="hardware_error", address=65, size=1),
            Register(name="present_current", address=69, size=2, unit=6.5e-3, sign="bit"),
        ),
        felt=("present_position", "present_current"),
        bauds=MappingProxyType(
            {0: 1_000_000, 1: 500_000, 2: 250_000, 3: 128_000, 4: 115_200, 5: 76_800, 6: 57_600, 7: 38_400}
        ),
        persistent=40,
        alerts=((0, "input voltage"), (1, "encoder"), (2, "overheated"), (3, "current"), (5, "overload")),
    )  # fmt: skip


def _own_board(motor: Motor) -> Table:
    """Return the table of a hobby servo behind a board of one's own, which speaks in lines; register n is at 2 n."""
    hottest = round(motor.temperature_limit)
    min_voltage = round(100 * motor.volts_range[0])
    two: Sign = "two"
    rows = (
        Register(name="model_number", address=0, size=2, initial=motor.model_number),
        Register(name="firmware", address=2, size=2, initial=1),
        Register(name="id", address=4, size=2, initial=1),
        Register(name="baud_rate", address=6, size=2),
        Register(name="return_delay", address=8, size=2, unit=1e-6, writable=True, span=(0, 10_000)),
        Register(name="operating_mode", address=10, size=2, writable=True, initial=3, span=(0, 16)),
        Register(name="temperature_limit", address=12, size=2, writable=True, initial=hottest, span=(0, 200)),
        Register(name="voltage_low", address=14, size=2, unit=0.01, writable=True, initial=min_voltage),
        Register(name="position_low", address=16, size=2, unit=_STEP, sign=two, writable=True),
        Register(name="position_high", address=18, size=2, unit=_STEP, sign=two, writable=True, initial=STEPS - 1),
        Register(name="bus_watchdog", address=20, size=2, unit=0.02, sign=two, writable=True, span=(0, 127)),
        Register(name="torque_enable", address=22, size=2, writable=True, span=(0, 1)),
        Register(name="torque_limit", address=24, size=2, sign=two, writable=True, initial=1000, span=(0, 1000)),
        Register(name="goal_position", address=28, size=2, unit=_STEP, sign=two, writable=True, initial=2048),
        Register(name="present_position", address=30, size=2, unit=_STEP, sign=two, initial=2048),
        Register(name="present_velocity", address=32, size=2, unit=1e-3, sign=two),
        Register(name="present_current", address=34, size=2, unit=1e-3, sign=two),
        Register(name="present_voltage", address=36, size=2, unit=0.01, initial=round(100 * motor.volts)),
        Register(name="present_temperature", address=38, size=2, sign=two, initial=25),
        Register(name="hardware_error", address=40, size=2),
    )
    return Table(
        model=motor.name,
        number=motor.model_number,
        protocol="line",
        registers=rows,
        motor=motor,
        felt=("present_position", "hardware_error"),
        bauds=MappingProxyType(dict(enumerate((1_000_000, 500_000, 250_000, 115_200, 57_600, 2_000_000, 3_000_000)))),
        alerts=((0, "input voltage"), (2, "overheated"), (3, "encoder"), (4, "electrical shock"), (5, "overload")),
    )


_SERIES: Mapping[str, Callable[[Motor], Table]] = {"dynamixel": _x_series, "feetech": _sts, "pwm": _own_board}
TABLES: Mapping[str, Table] = MappingProxyType(
    {name: _SERIES[motor.protocol](motor) for name, motor in motors().items() if motor.protocol in _SERIES}
)
"""The servos that we speak with, by the names of ``suchus.robot.motors``."""


def _board(model: str, number: int, protocol: BusProtocol, registers: tuple[Register, ...]) -> Table:
    """Return the table of a sensor board: its number, then its sensors in one block."""
    model_register = Register(name="model_number", address=0, size=2, initial=number)
    return Table(
        model=model,
        number=number,
        protocol=protocol,
        registers=(model_register, *registers),
        felt=(registers[0].name, registers[-1].name),
    )


def _row(names: tuple[str, ...], start: int, unit: float) -> tuple[Register, ...]:
    return tuple(
        Register(name=name, address=start + 2 * i, size=2, unit=unit, sign="two") for i, name in enumerate(names)
    )


IMU = (
    *_row(("orientation_w", "orientation_x", "orientation_y", "orientation_z"), 128, 2.0**-14),
    *_row(("angular_velocity_x", "angular_velocity_y", "angular_velocity_z"), 136, 1 / 900),
    *_row(("acceleration_x", "acceleration_y", "acceleration_z"), 142, 0.01),
)
"""Registers of an inertial measurement unit: its orientation in the world, its angular velocity [rad/s] and its
acceleration with gravity [m/s2], in the units of Bosch's BNO055, which does the same."""


def imu_board(protocol: BusProtocol) -> Table:
    """Return the table of an inertial measurement unit on a board that speaks a protocol."""
    return _board("imu", 60001, protocol, IMU)


def load_board(protocol: BusProtocol, kind: str, places: int, unit: float) -> Table:
    """Return the table of a board that measures the normal force at several positions.

    Args:
        protocol: that it speaks.
        kind: ``feet``, ``belly`` or ``tail``.
        places: how many.
        unit: force of a step [N].
    """
    names = tuple(f"load_{i}" for i in range(places))
    return _board(kind, 60002, protocol, _row(names, 128, unit))
