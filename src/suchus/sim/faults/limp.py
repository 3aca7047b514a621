"""A servo without torque."""

from dataclasses import dataclass

from suchus.sim.fault import Plant, ServoFault
from suchus.sim.persistence import PERMANENT, Persistence


@dataclass(frozen=True, slots=True, repr=False)
class Limp(ServoFault):
    """A servo without torque; the friction of its gear stays."""

    joint: str
    """Name of the servo, as ``LF_yaw``."""
    at: float = 0.0
    """Time at which the fault begins [s], at least 0."""
    persistence: Persistence = PERMANENT
    """Whether it stays, recovers, or comes and goes."""

    def apply(self, plant: Plant) -> None:
        """Take the torque away."""
        plant.unpower(self.joint)


fault = Limp
