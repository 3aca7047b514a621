"""A servo without torque."""

from dataclasses import dataclass

from suchus.sim.fault import Plant, ServoFault


@dataclass(frozen=True, slots=True)
class Limp(ServoFault):
    """A servo without torque; the friction of its gear stays."""

    joint: str
    """Name of the servo, as ``LF_yaw``."""
    at: float = 0.0
    """Time at which the fault begins [s], at least 0."""

    def apply(self, plant: Plant) -> None:
        """Take the torque away."""
        plant.unpower(self.joint)


fault = Limp
