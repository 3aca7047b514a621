"""A group of sensors that reads zero."""

from dataclasses import dataclass

from suchus.robot.design import Robot
from suchus.sim.fault import SENSORS, Fault, Plant


@dataclass(frozen=True, slots=True)
class Deaf(Fault):
    """A group of sensors that reads zero from now on; a robot that does not listen to them walks on as before.

    An orientation of zero is that of a robot that stands level and faces forward.
    """

    sensor: str
    """Name of the group, as ``foot_pressure``."""
    at: float = 0.0
    """Time at which the fault begins [s], at least 0."""
    acts_on = "sensor"

    @property
    def part(self) -> str:
        """Name of the group."""
        return self.sensor

    @classmethod
    def parts(cls, robot: Robot) -> tuple[str, ...]:
        """Return the names of the groups."""
        del robot
        return SENSORS

    def sense(self, plant: Plant) -> None:
        """Read zero."""
        plant.felt(self.sensor)[...] = (1.0, 0.0, 0.0, 0.0) if self.sensor == "orientation" else 0.0


fault = Deaf
