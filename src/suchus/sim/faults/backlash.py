"""A worn gear with play."""

from dataclasses import dataclass

from suchus.robot.design import Robot
from suchus.sim.fault import Plant, ServoFault, refuse_number
from suchus.sim.persistence import PERMANENT, Persistence


@dataclass(frozen=True, slots=True, repr=False)
class Backlash(ServoFault):
    """A gear with play: the joint is free while it is within half of the gap from the commanded angle.

    Beyond, the servo turns it from the end of the gap on: the torque is that of a dead band, ``kp dz(target - angle)``
    with ``dz`` zero within ``gap / 2`` and its distance from there outside (dead-zone model of Nordin and Gutman 2002,
    Automatica 38, 1633). Where the joint is in the gap is looked at once in a control period.
    """

    joint: str
    """Name of the servo."""
    gap: float = 0.1
    """Play from one end to the other [rad]; 0 to 1."""
    at: float = 0.0
    """Time at which the fault begins [s], at least 0."""
    persistence: Persistence = PERMANENT
    """Whether it stays, recovers, or comes and goes."""

    def refuse(self, robot: Robot) -> None:
        """Refuse a gap that no gear has, too."""
        ServoFault.refuse(self, robot)
        refuse_number(self, self.gap, 0.0, 1.0, "has a gap of", " rad")

    def apply(self, plant: Plant) -> None:
        """Note the torque limits."""
        lower_torque, upper_torque = plant.parameter("actuator_forcerange", self.joint)
        plant.memory.update(low=float(lower_torque), high=float(upper_torque))

    def command(self, plant: Plant) -> None:
        """Aim at the near end of the gap, or let go within it."""
        target, angle, half = plant.targets[self.joint], plant.angle(self.joint), self.gap / 2
        free = abs(angle - target) < half
        plant.targets[self.joint] = min(max(angle, target - half), target + half)
        limits = (0.0, 0.0) if free else (plant.memory["low"], plant.memory["high"])
        plant.parameter("actuator_forcerange", self.joint)[:] = limits


fault = Backlash
harmless = (Backlash("LF_yaw", 0.0),)
