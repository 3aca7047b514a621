"""A group of sensors, or one of them, that repeats its last reading."""

from dataclasses import dataclass

from suchus.sim.fault import Plant, SensorFault
from suchus.sim.persistence import PERMANENT, Persistence


@dataclass(frozen=True, slots=True, repr=False)
class Frozen(SensorFault):
    """A group of sensors, or one, that repeats the reading that it had when the fault began: a dropout of messages."""

    sensor: str
    """Name of the group, as ``orientation``, or of one reading, as ``servo_position.LF_yaw``."""
    at: float = 0.0
    """Time at which the fault begins [s], at least 0."""
    persistence: Persistence = PERMANENT
    """Whether it stays, recovers, or comes and goes."""

    def sense(self, plant: Plant) -> None:
        """Note the first readings, and repeat them."""
        flat_readings = self.readings(plant).reshape(-1)
        for i, reading in enumerate(flat_readings):
            flat_readings[i] = plant.memory.setdefault(str(i), float(reading))


fault = Frozen
