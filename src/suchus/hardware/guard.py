"""Limits of a driven robot for heat, load, voltage and silence, and the reaction when one is exceeded."""

from dataclasses import dataclass

import numpy as np

from suchus.core.checks import Checks
from suchus.hardware.blind import BlindRig
from suchus.hardware.rig import JUMPS, Rig, RigReading


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveLimits:
    """Limits for warnings and for stopping the robot."""

    warm: float = 10.0
    """So far below the temperature at which a servo switches itself off people are warned [K]."""
    hot: float = 5.0
    """So far below it the robot is stopped [K]."""
    load: float = 1.0
    """Share of the torque that a servo can give continuously (``Motor.continuous_torque``), root mean square over
    ``memory``, from which people are warned [-]; it is heat that stops the robot."""
    memory: float = 10.0
    """Time over which the load is averaged [s]."""
    volts: float = 0.0
    """Voltage below which the robot is stopped [V]: 3.2 V for each lithium cell; 0 leaves it to the servos."""
    silent: int = 10
    """Ticks after which a silent servo stops the robot [-]."""
    holes: int = 3
    """Servos whose silence in one and the same tick counts as a hole of the bus [-]."""
    patience: float = 0.2
    """Time after which such holes in a row stop the robot [s]."""

    def __post_init__(self) -> None:
        """Refuse limits out of range."""
        with Checks("drive_limits", self) as check:
            check.number("warm", 0.0, 100.0, "K")
            check.number("hot", 0.0, 100.0, "K")
            check.number("load", 0.0, 100.0, "")
            check.number("memory", 0.1, 600.0, "s")
            check.number("volts", 0.0, 100.0, "V")
            check.whole("silent", 1, 10000)
            check.whole("holes", 1, 1000)
            check.number("patience", 0.0, 10.0, "s")


class Guard:
    """Checks the limits at every tick.

    Args:
        rig: what is driven.
        limits: when it says something.
    """

    def __init__(self, rig: Rig | BlindRig, limits: DriveLimits) -> None:
        """Take the limits of temperature and torque from the tables of the servos."""
        self._rig, self._limits = rig, limits
        self._square = np.zeros(len(rig.servos))
        self._deaf = 0.0
        self._warned: set[str] = set()
        self.warnings: list[str] = []
        """What people should know, each sentence once."""
        self._continuous = np.array([servo.table.continuous_torque for servo in rig.servos])
        self._limit = np.array([servo.table["temperature_limit"].initial for servo in rig.servos])

    def look(self, reading: RigReading) -> str:
        """Return the reason why the robot must be stopped, a sentence; empty if it may go on."""
        rig, limits, is_asked = self._rig, self._limits, self._rig.asked
        if not is_asked.any():  # nobody tells anything
            return ""
        silent = is_asked & (reading.age > limits.silent)
        if silent.any():
            return f"{self._names_text(silent)} has not answered for {limits.silent} ticks."
        deaf = int((is_asked & ~reading.heard).sum()) >= min(limits.holes, int(is_asked.sum()))
        self._deaf = self._deaf + rig.period if deaf else 0.0
        if self._deaf > limits.patience:
            return f"{limits.holes} servos or more were silent at once for {limits.patience:g} s: the bus is failing."
        jumped = is_asked & (rig.jumps >= JUMPS)
        if jumped.any():
            return (
                f"{self._names_text(jumped)} says that it is where it cannot have come to so fast, {JUMPS} times in a "
                "row: its "
                "horn is loose, or it lost count of its turns."
            )
        ill = is_asked & (reading.error > 0)
        if ill.any():
            i = int(np.argmax(ill))
            return f"{rig.names[i]} has switched itself off: {self._alert(i, int(reading.error[i]))}."
        hot = is_asked & (reading.temperature >= self._limit - limits.hot)
        if hot.any():
            i = int(np.argmax(hot))
            heat = f"{reading.temperature[i]:.0f} degrees Celsius"
            return f"{rig.names[i]} is at {heat}; it switches off at {self._limit[i]}."
        is_undervolted = is_asked & (reading.voltage < limits.volts)
        if is_undervolted.any():
            i = int(np.argmax(is_undervolted))
            return f"{rig.names[i]} gets {reading.voltage[i]:.1f} V; {limits.volts:g} V is the least that was allowed."
        self._warn(reading)
        return ""

    def _warn(self, reading: RigReading) -> None:
        """Note servos that become warm, or whose mean load exceeds their continuous torque."""
        limits, names = self._limits, self._rig.names
        keep = np.exp(-self._rig.period / limits.memory)
        square = np.nan_to_num(reading.torque) ** 2
        self._square += (1.0 - keep) * (square - self._square)
        for i in np.flatnonzero(np.sqrt(self._square) > limits.load * self._continuous):
            self.tell(
                f"load {names[i]}",
                f"{names[i]} gives for long more than {limits.load:.0%} of the {self._continuous[i]:g} N m that it can "
                "give continuously: it will get hot.",
            )
        for i in np.flatnonzero(reading.temperature >= self._limit - limits.warm):
            self.tell(
                f"warm {names[i]}",
                f"{names[i]} is at {reading.temperature[i]:.0f} degrees Celsius and is stopped at "
                f"{self._limit[i] - limits.hot:.0f}.",
            )

    def tell(self, key: str, sentence: str) -> None:
        """Add a warning, once for each key."""
        if key not in self._warned:
            self._warned.add(key)
            self.warnings.append(sentence)

    def _alert(self, i: int, error: int) -> str:
        texts = [text for bit, text in self._rig.servos[i].table.alerts if error >> bit & 1]
        return " and ".join(texts) or f"error {error}"

    def _names_text(self, is_affected: np.ndarray) -> str:
        names = [name for name, is_named in zip(self._rig.names, is_affected, strict=True) if is_named]
        return " and ".join(names[:4]) + (f" and {len(names) - 4} more" if len(names) > 4 else "")
