"""Register tables of servos and sensor boards, with the same names of registers for all makers.

The tables of servos stand in the modules of ``suchus.hardware.protocols``. Boards for sensors are nobody's product:
their tables here say what a board of one's own must do.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise
from math import pi
from types import MappingProxyType
from typing import Literal

from suchus.core.errors import InvalidDesign, UnknownName
from suchus.robot.design import Motor

Sign = Literal["none", "two", "bit"]
Mode = Literal["position", "multi-turn", "velocity", "current", "voltage", "step"]
"""What a servo controls in an operating mode; ``position`` within one turn and its limits, ``multi-turn`` beyond."""

STEPS = 4096
"""Steps of a turn of the servos of Dynamixel X, Feetech STS and of boards of one's own [-]."""
STEP = 2 * pi / STEPS
"""Angle of such a step [rad]."""
SERVO_REGISTERS = (
    "model_number", "id", "baud_rate", "temperature_limit", "voltage_low", "position_low", "position_high",
    "torque_enable", "torque_limit", "goal_position", "present_position", "present_velocity", "hardware_error",
)  # fmt: skip
"""Registers that the table of a servo must have; with ``bus_watchdog`` it needs ``firmware`` too, and it needs
``present_current`` or ``present_load``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Register:
    """One value in a control table."""

    name: str
    """As ``present_position``."""
    address: int
    """Address of its first byte."""
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
    protocol: str
    """What it speaks: a name of ``suchus.hardware.protocols``."""
    registers: tuple[Register, ...]
    """Registers in the order of their addresses."""
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
    modes: Mapping[int, Mode] = field(default_factory=dict)
    """What it controls by the value of ``operating_mode``; empty: positions in any."""
    offset_sign: int = 1
    """1 where its position is that of its encoder plus ``homing_offset``, -1 where it is minus [-]."""
    max_position_offset: int = 2**20
    """Greatest ``homing_offset`` that acts in the mode ``position``, in steps [-]."""
    centering: int | None = None
    """Value of ``torque_enable`` that makes the present position the middle of a turn; None where none does [-]."""
    extent: int = 0
    """End of the addresses that it answers for, registers that are not in ``registers`` included; 0 for their end."""
    other_registers: tuple[tuple[int, int, str], ...] = ()
    """First address, end and name of registers that its maker gives it and that are not in ``registers``."""

    def __post_init__(self) -> None:
        """Refuse a table with registers that overlap or, for a servo, without those that a drive needs.

        Raises:
            InvalidDesign: the table cannot be used.
        """
        problems = [
            f"{register.name} begins before {previous.name} ends"
            for previous, register in pairwise(self.registers)
            if register.address < previous.address + previous.size
        ]
        missing = [name for name in SERVO_REGISTERS if self.motor is not None and name not in self.by_name]
        if self.motor is not None and not {"present_current", "present_load"} & set(self.by_name):
            missing.append("present_current or present_load")
        if "bus_watchdog" in self and "firmware" not in self:
            missing.append("firmware")
        if missing:
            problems.append(f"it has no {', '.join(missing)}, which a drive needs")
        elif self.motor is not None:
            problems += self._block_problems()
        if problems:
            raise InvalidDesign(f"the register table of {self.model} cannot be used: {'; '.join(problems)}.")

    def _block_problems(self) -> list[str]:
        """Return what is wrong with the block that is read at every tick, and with the goal's step."""
        problems = []
        values = self.unpack(self.felt, bytes(self.block(self.felt)[1]))
        absent_registers = [name for name in ("present_position", "present_velocity") if name not in values]
        if not {"present_current", "present_load"} & set(values):
            absent_registers.append("present_current or present_load")
        if absent_registers:
            problems.append(
                f"the block {' to '.join(self.felt)}, read at every tick, holds no {', '.join(absent_registers)}"
            )
        if self["goal_position"].unit != self["present_position"].unit or not 0.0 < self.step < pi:
            problems.append("goal_position and present_position need the same unit, the angle of a step [rad]")
        return problems

    @property
    def step(self) -> float:
        """Angle of a step of its goal and of its position [rad]."""
        return self["goal_position"].unit

    @property
    def center(self) -> int:
        """Goal with which it comes from the maker, in steps [-]."""
        return self["goal_position"].initial

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


def register_label(table: Table, address: int) -> str:
    """Return the name of what a table has at an address, for a message; empty where it has nothing.

    Args:
        table: of a servo or a board.
        address: of a byte.
    """
    names = [r.name for r in table.registers if r.address <= address < r.address + r.size]
    names += [name for start, end, name in table.other_registers if start <= address < end]
    return names[0] if names else ""


def _board(model: str, number: int, protocol: str, registers: tuple[Register, ...]) -> Table:
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


def imu_board(protocol: str) -> Table:
    """Return the table of an inertial measurement unit on a board that speaks a protocol."""
    return _board("imu", 60001, protocol, IMU)


def load_board(protocol: str, kind: str, places: int, unit: float) -> Table:
    """Return the table of a board that measures the normal force at several positions.

    Args:
        protocol: protocol that it speaks.
        kind: ``feet``, ``belly`` or ``tail``.
        places: how many.
        unit: force of a step [N].
    """
    names = tuple(f"load_{i}" for i in range(places))
    return _board(kind, 60002, protocol, _row(names, 128, unit))
