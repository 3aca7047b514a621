"""A group of sensors, or one of them, that reads zero."""

from dataclasses import dataclass

from suchus.sim.fault import Plant, SensorFault
from suchus.sim.persistence import PERMANENT, Persistence


@dataclass(frozen=True, slots=True, repr=False)
class Deaf(SensorFault):
    """A group of sensors, or one, that reads zero; a robot that does not listen to it walks on as before.

    An orientation of zero is that of a robot that stands level and faces forward.
    """

    sensor: str
    """Name of the group, as ``foot_pressure``, or of one reading, as ``servo_position.LF_yaw``."""
    at: float = 0.0
    """Time at which the fault begins [s], at least 0."""
    persistence: Persistence = PERMANENT
    """Whether it stays, recovers, or comes and goes."""

    def sense(self, plant: Plant) -> None:
        """Read zero."""
        self.readings(plant)[...] = (1.0, 0.0, 0.0, 0.0) if self.sensor == "orientation" else 0.0


fault = Deaf
