"""A servo with a part of its torque."""

from dataclasses import dataclass

from suchus.core.errors import InvalidDesign
from suchus.robot.design import Robot
from suchus.sim.fault import Plant, ServoFault
from suchus.sim.persistence import PERMANENT, Persistence


@dataclass(frozen=True, slots=True, repr=False)
class Weak(ServoFault):
    """A servo with a part of its torque."""

    joint: str
    """Name of the servo."""
    fraction: float = 0.5
    """Fraction of the torque limit that is left [-], 0 to 1."""
    at: float = 0.0
    """Time at which the fault begins [s], at least 0."""
    persistence: Persistence = PERMANENT
    """Whether it stays, recovers, or comes and goes."""

    def refuse(self, robot: Robot) -> None:
        """Refuse a fraction outside 0 to 1, too."""
        ServoFault.refuse(self, robot)
        if not 0.0 <= self.fraction <= 1.0:
            raise InvalidDesign(f"{self} leaves {self.fraction} of the torque; 0 to 1 is allowed.")

    def apply(self, plant: Plant) -> None:
        """Lower the limit."""
        plant.parameter("actuator_forcerange", self.joint)[:] *= self.fraction


fault = Weak
examples = (Weak("LF_pitch", 0.05),)  # half of the torque is enough for a crawl
harmless = (Weak("LF_yaw", 1.0),)
