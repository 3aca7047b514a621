"""Devices on an emulated bus: servos with their control tables, and sensor boards."""

import numpy as np

from suchus.hardware.bus import Refusal, Register, ServoPlace, Table
from suchus.robot.control import Sensed

AMBIENT = 25.0
"""Temperature of the air, at which servos begin [degrees Celsius]."""
SWITCHES_OFF = {"input voltage": False, "overheated": True, "encoder": False, "electrical shock": True,
                "current": True, "overload": True}  # fmt: skip
"""Which alerts take the torque away, as the makers set them."""


class Device:
    """A device with a control table.

    Args:
        table: its registers.
    """

    def __init__(self, table: Table) -> None:
        self.table = table
        self.memory = bytearray(table.length)
        for register in table.registers:
            self.put(register.name, register.initial)

    def get(self, name: str) -> int:
        """Return the value of a register."""
        register = self.table[name]
        return register.decode(bytes(self.memory[register.address : register.address + register.size]))

    def put(self, name: str, value: int) -> None:
        """Set a register, also one that is read-only for the host."""
        register = self.table[name]
        self.memory[register.address : register.address + register.size] = register.encode(value)

    def read(self, address: int, length: int) -> bytes:
        """Return bytes as they are."""
        return bytes(self.memory[address : address + length]).ljust(length, b"\0")

    def write(self, address: int, data: bytes) -> Refusal:
        """Take bytes, and return why they are refused; ``NONE`` if all of them were taken."""
        del address, data
        return Refusal.ACCESS

    @property
    def alerts(self) -> int:
        """Bits of its alerts."""
        return 0


class EmulatedServo(Device):
    """One servo.

    Args:
        place: how it is wired, ``id`` and ``baud`` as they are set in it.
        baud: bit rate that it listens at [1/s].
        number: its place in the robot's layout.
    """

    def __init__(self, place: ServoPlace, baud: int, number: int) -> None:
        """Set the registers of a servo that is wired at a place."""
        super().__init__(place.table)
        self.place, self.number = place, number
        codes = {rate: code for code, rate in self.table.bauds.items()}
        self.put("id", place.id)
        self.put("baud_rate", codes.get(baud, 0))
        self._tell("return_delay", 0.0)
        self.supply = place.table.motor.volts if place.table.motor is not None else 0.0
        """Voltage of the battery at the beginning [V]."""
        self.temperature, self.voltage, self.torque = AMBIENT, self.supply, 0.0
        self.heard_at = 0.0
        self.off = False
        """Whether it has switched itself off; a reboot ends that."""

    @property
    def baud(self) -> int:
        """Bit rate that it listens at [1/s]."""
        return self.table.bauds[self.get("baud_rate")]

    @property
    def share(self) -> float:
        """Share of its torque that it may use, 0 to 1 [-]."""
        if self.off or not self.get("torque_enable"):
            return 0.0
        return min(max(self.get("torque_limit") / self.table.full, 0.0), 1.0)

    @property
    def goal(self) -> float:
        """Angle of the joint that it aims at [rad]."""
        return self.place.sign * (self.get("goal_position") - self.place.zero) * self.table.step

    @property
    def alerts(self) -> int:
        """Bits of its alerts."""
        return self.get("hardware_error")

    def write(self, address: int, data: bytes) -> Refusal:
        """Write bytes by the rules of the servo, and return why they are refused."""
        registers = [
            r for r in self.table.registers if address < r.address + r.size and r.address < address + len(data)
        ]
        if not registers or any(self._partly(r, address, data) for r in registers):
            return Refusal.ACCESS
        for register in registers:
            refusal = self._refusal(register, register.decode(data[register.address - address :][: register.size]))
            if refusal:
                return refusal
        self.memory[address : address + len(data)] = data
        if any(register.name == "bus_watchdog" for register in registers):
            self.put("bus_watchdog", max(self.get("bus_watchdog"), 0))
        return Refusal.NONE

    @staticmethod
    def _partly(register: Register, address: int, data: bytes) -> bool:
        return register.address < address or register.address + register.size > address + len(data)

    def _refusal(self, register: Register, value: int) -> Refusal:
        """Return why a value cannot be written to a register; ``NONE`` if it can."""
        if not register.writable:
            return Refusal.ACCESS
        if register.address < self.table.persistent and (
            self.get("torque_enable") if "lock" not in self.table else self.get("lock")
        ):
            return Refusal.ACCESS
        if register.name == "bus_watchdog" and self.get("firmware") < self.table.watches_from:
            return Refusal.ACCESS
        if register.name.startswith("goal_") and "bus_watchdog" in self.table and self.get("bus_watchdog") < 0:
            return Refusal.ACCESS
        if register.span is not None and not register.span[0] <= value <= register.span[1]:
            return Refusal.RANGE
        if register.name == "goal_position" and not self.get("position_low") <= value <= self.get("position_high"):
            return Refusal.LIMIT
        return Refusal.NONE

    def feel(self, angle: float, speed: float, torque: float) -> None:
        """Write angle, speed and torque of the joint to the registers that report them.

        Args:
            angle: angle of the joint [rad].
            speed: speed of the joint [rad/s].
            torque: torque of the servo on it [N m].
        """
        sign, table = self.place.sign, self.table
        self.put("present_position", self.place.zero + round(sign * angle / table.step))
        self.put("present_velocity", round(sign * speed / table["present_velocity"].unit))
        self.torque = abs(torque)
        self._tell("present_current", sign * torque / table.torque_per_ampere)
        self._tell("present_load", sign * torque / table.stall_torque)
        self._tell("present_voltage", self.voltage)
        self._tell("present_temperature", self.temperature)

    def age(self, seconds: float, heating: float, voltage: float, time: float) -> None:
        """Let time pass: the servo warms up, and checks its limits and its watchdog.

        Args:
            seconds: how much [s].
            heating: beside what its load does [K/s].
            voltage: voltage at its plug [V].
            time: by the emulator's clock [s].
        """
        motor = self.place.table.motor
        if motor is not None:
            load = min(self.torque / motor.stall_torque, 1.0)
            loss = motor.volts * motor.stall_current * load**2  # all of it heat: a servo that holds does no work
            heat = motor.heat
            cooling = (self.temperature - AMBIENT) / heat.resistance
            self.temperature += seconds * ((loss - cooling) / heat.capacity + heating)
        self.voltage = voltage
        if self.temperature >= self.get("temperature_limit"):
            self.fail("overheated")
        if voltage < self.table["voltage_low"].unit * self.get("voltage_low"):
            self.fail("input voltage")
        if "bus_watchdog" in self.table:
            patience = self.get("bus_watchdog") * self.table["bus_watchdog"].unit
            if patience > 0.0 and time - self.heard_at > patience + 1e-9:
                self.put("bus_watchdog", -1)
                self.put("goal_position", self.get("present_position"))

    @property
    def reply_delay(self) -> float:
        """How long it waits before it answers [s]."""
        return self.get("return_delay") * self.table["return_delay"].unit if "return_delay" in self.table else 0.0

    def soak(self) -> None:
        """Raise the alert of a servo in water: a shock where the servo knows one, else an overload."""
        alert_names = [name for _, name in self.table.alerts]
        self.fail("electrical shock" if "electrical shock" in alert_names else "overload")

    def fail(self, alert: str) -> None:
        """Raise an alert, and switch the servo off if its maker has it so."""
        bits = {text: bit for bit, text in self.table.alerts}
        if alert in bits:
            self.put("hardware_error", self.get("hardware_error") | 1 << bits[alert])
        self.off = self.off or SWITCHES_OFF[alert]

    def reboot(self) -> None:
        """Reboot the servo: torque and alerts are off."""
        self.off = False
        self.put("hardware_error", 0)
        self.put("torque_enable", 0)
        for name in ("torque_limit", "bus_watchdog"):
            if name in self.table:
                self.put(name, self.table[name].initial)

    def _tell(self, name: str, value: float) -> None:
        if name in self.table:
            self.put(name, round(value / self.table[name].unit))


class Board(Device):
    """One board for sensors."""

    def feel(self, kind: str, sensed: Sensed) -> None:
        """Write the readings of the first robot of a batch to the registers of the board's sensor."""
        values: dict[str, np.ndarray] = {
            "feet": sensed.foot_pressure,
            "belly": sensed.belly_pressure,
            "tail": sensed.tail_pressure,
            "imu": np.concatenate([sensed.orientation[0], sensed.angular_velocity[0], sensed.acceleration[0]]),
        }
        readings = np.atleast_1d(np.squeeze(values[kind]))
        for register, value in zip(self.table.registers[1:], readings, strict=True):
            self.put(register.name, round(float(value) / register.unit))
