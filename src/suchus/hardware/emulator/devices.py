"""Devices on an emulated bus: servos with their control tables, and sensor boards."""

from math import copysign, inf, pi, sqrt

import numpy as np

from suchus.hardware.bus import Mode, Refusal, Register, ServoPlace, Table
from suchus.robot.control import Sensed

AMBIENT = 25.0
"""Temperature of the air, at which servos begin [degrees Celsius]."""
SWITCHES_OFF = {"input voltage": False, "overheated": True, "encoder": False, "electrical shock": True,
                "current": True, "overload": True}  # fmt: skip
"""Which alerts take the torque away, as the makers set them."""
WITHOUT_EFFECT = (
    "angular_resolution", "clockwise_dead_zone", "counterclockwise_dead_zone", "drive_mode", "feedforward_1st_gain",
    "feedforward_2nd_gain", "goal_time", "min_startup_force", "overcurrent_time", "overload_torque", "phase",
    "position_d_gain", "position_i_gain", "position_p_gain", "protection_current", "protection_time",
    "protective_torque", "protocol_type", "secondary_id", "startup_configuration", "velocity_i_gain",
    "velocity_p_gain",
)  # fmt: skip
"""Registers that an emulated servo keeps, and that change nothing in how the simulated robot moves."""
_LIMITED = {"goal_velocity": "velocity_limit", "torque_limit": "voltage_limit", "goal_current": "current_limit"}
"""Registers whose size may not exceed the value of another one."""
_CURRENT_BASED = 5  # operating mode of positions with a limit of current
_MAX_MULTI_TURN = 2**20  # greatest goal beyond a turn [-]
_MOVING_SPEED = 10 * 0.229 * 2 * pi / 60  # speed above which a servo says that it moves [rad/s]
_TICKS = 32768  # milliseconds after which a servo's clock begins anew


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

    @property
    def extent(self) -> int:
        """End of the addresses that it answers for."""
        return max(self.table.extent, self.table.length)

    def holds(self, address: int, length: int) -> bool:
        """Return whether it can answer for bytes from an address on."""
        return length > 0 and address + length <= self.extent

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
        self.angle = 0.0
        """Angle of the joint [rad]."""
        self._setpoint, self._rate, self._has_goal = 0.0, 0.0, False
        self.off = False
        """Whether it has switched itself off; a reboot ends that."""

    @property
    def baud(self) -> int:
        """Bit rate that it listens at [1/s]."""
        return self.table.bauds[self.get("baud_rate")]

    @property
    def mode(self) -> Mode:
        """What it controls."""
        if not self.table.modes:
            return "position"
        return self.table.modes.get(self.get("operating_mode"), "position")

    @property
    def share(self) -> float:
        """Share of its torque that it may use, 0 to 1 [-]."""
        if self.off or not self.get("torque_enable") or self.mode in ("current", "voltage", "step"):
            return 0.0
        share = min(max(self.get("torque_limit") / self.table.full, 0.0), 1.0)
        if self.mode == "multi-turn" and self.get("operating_mode") == _CURRENT_BASED and "goal_current" in self.table:
            motor, register = self.table.motor, self.table["goal_current"]
            if motor is not None:
                share *= min(abs(self.get("goal_current")) * register.unit / motor.stall_current, 1.0)
        return share

    @property
    def offset(self) -> int:
        """What ``homing_offset`` adds to the position that it tells, in steps [-]."""
        if "homing_offset" not in self.table:
            return 0
        offset = self.get("homing_offset")
        if self.mode == "position" and abs(offset) > self.table.max_position_offset:
            return 0
        return self.table.offset_sign * offset

    @property
    def goal(self) -> float:
        """Angle of the joint that it aims at [rad]."""
        steps = self.get("goal_position") - self.offset - self.place.zero
        if self.offset and self.mode == "position":  # the way within a turn
            turn = round(2 * pi / self.table.step)
            steps = (steps + turn // 2) % turn - turn // 2
        return self.place.sign * steps * self.table.step

    @property
    def has_profile(self) -> bool:
        """Whether its goal acts little by little: by a profile, or since it turns at a speed."""
        return self.mode == "velocity" or self._max_speed < inf or self._max_acceleration < inf

    @property
    def _max_speed(self) -> float:
        """Speed of its profile [rad/s]; infinite for none."""
        name = "profile_velocity" if "profile_velocity" in self.table else "goal_velocity"
        if name not in self.table or self.mode == "velocity" or not self.get(name):
            return inf
        return abs(self.get(name)) * self.table[name].unit

    @property
    def _max_acceleration(self) -> float:
        """Acceleration of its profile [rad/s2]; infinite for none."""
        name = "profile_acceleration" if "profile_acceleration" in self.table else "acceleration"
        if name not in self.table or not self.get(name):
            return inf
        return self.get(name) * self.table[name].unit

    def advance(self, seconds: float) -> float | None:
        """Return the angle that the joint is sent to after some time [rad]; None where its goal acts at once.

        Args:
            seconds: how much time passes [s].
        """
        if not self.has_profile or self.share <= 0.0 or (not self._has_goal and self.mode != "velocity"):
            self._setpoint, self._rate = self.angle, 0.0
            return None
        distance = self.goal - self._setpoint
        if self.mode == "velocity":
            rate = self.place.sign * self.get("goal_velocity") * self.table["goal_velocity"].unit
        else:
            braking = _braking_speed(self._max_acceleration, abs(distance), seconds)
            rate = copysign(min(self._max_speed, braking, abs(distance) / seconds), distance)
        max_change = self._max_acceleration * seconds
        self._rate = min(max(rate, self._rate - max_change), self._rate + max_change)
        step = self._rate * seconds
        if self.mode != "velocity" and abs(step) >= abs(distance):
            step, self._rate = distance, 0.0
        self._setpoint += step
        return self._setpoint

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
        former_torque = self.get("torque_enable")
        self.memory[address : address + len(data)] = data
        names = [register.name for register in registers]
        if "bus_watchdog" in names:
            self.put("bus_watchdog", max(self.get("bus_watchdog"), 0))
        if "torque_enable" in names and self.get("torque_enable") == self.table.centering:
            self.put("torque_enable", former_torque)
            self._center()
        if "max_torque" in names:
            self.put("torque_limit", self.get("max_torque"))
        self._has_goal = self._has_goal or "goal_position" in names
        if {"homing_offset", "operating_mode", "torque_enable"} & set(names):
            self._tell_position()
        return Refusal.NONE

    def _center(self) -> None:
        """Let the present position be the middle of a turn, as the maker's command for that does."""
        actual = self.place.zero + round(self.place.sign * self.angle / self.table.step)
        self.put("homing_offset", self.table.offset_sign * (self.table.center - actual))

    def _tell_position(self) -> None:
        """Tell the position of the joint, with the offset that is set."""
        steps = self.place.zero + round(self.place.sign * self.angle / self.table.step) + self.offset
        if self.offset and self.table.offset_sign < 0 and self.mode == "position":
            steps %= round(2 * pi / self.table.step)
        self.put("present_position", steps)

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
        if register.name == "operating_mode" and self.table.modes and value not in self.table.modes:
            return Refusal.RANGE
        if register.name == "torque_enable" and value > 1 and value != self.table.centering:
            return Refusal.RANGE
        if register.name == "goal_position":
            return self._goal_refusal(value)
        bound = _LIMITED.get(register.name, "")
        if bound in self.table and abs(value) > self.get(bound):
            return Refusal.LIMIT
        return Refusal.NONE

    def _goal_refusal(self, value: int) -> Refusal:
        """Return why a goal is outside the limits that are set; in modes without limits those of the register."""
        low, high = self.get("position_low"), self.get("position_high")
        if self.mode == "multi-turn" or (self.table.offset_sign < 0 and low == high == 0):
            return Refusal.NONE if abs(value) < _MAX_MULTI_TURN else Refusal.LIMIT
        return Refusal.NONE if low <= value <= high else Refusal.LIMIT

    def feel(self, angle: float, speed: float, torque: float) -> None:
        """Write angle, speed and torque of the joint to the registers that report them.

        Args:
            angle: angle of the joint [rad].
            speed: speed of the joint [rad/s].
            torque: torque of the servo on it [N m].
        """
        sign, table = self.place.sign, self.table
        self.angle = angle
        self._tell_position()
        if "moving" in table:
            self.put("moving", int(abs(speed) > _MOVING_SPEED))
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
        if "realtime_tick" in self.table:
            self.put("realtime_tick", round(1e3 * time) % _TICKS)
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
        if "shutdown" in self.table and alert in bits:
            self.off = self.off or bool(self.get("shutdown") >> bits[alert] & 1)
        else:
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


def _braking_speed(acceleration: float, distance: float, period: float) -> float:
    """Return the greatest speed from which something that brakes once a period stops within a distance [m/s, rad/s].

    Args:
        acceleration: by which it brakes; infinite for at once.
        distance: to the stop.
        period: between two changes of the speed [s].
    """
    if acceleration == inf:
        return inf
    half_step = 0.5 * acceleration * period
    return sqrt(half_step**2 + 2.0 * acceleration * distance) - half_step


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
