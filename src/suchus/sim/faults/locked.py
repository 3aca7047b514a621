"""A servo that holds one angle."""

from dataclasses import dataclass

from suchus.core.errors import OutsideLimits
from suchus.robot.design import Robot
from suchus.robot.motion import servo_range
from suchus.sim.fault import Plant, ServoFault
from suchus.sim.persistence import PERMANENT, Persistence


@dataclass(frozen=True, slots=True, repr=False)
class Locked(ServoFault):
    """A servo that holds one angle, within its torque, whatever it is commanded."""

    joint: str
    """Name of the servo, as ``LH_pitch``."""
    at: float = 0.0
    """Time at which the fault begins [s], at least 0."""
    angle: float | None = None
    """The angle it holds [rad]; None: the one it has at that time."""
    persistence: Persistence = PERMANENT
    """Whether it stays, recovers, or comes and goes."""

    def refuse(self, robot: Robot) -> None:
        """Refuse an angle that the joint cannot reach, too."""
        ServoFault.refuse(self, robot)
        if self.angle is not None:
            lower_angle, upper_angle = servo_range(robot, self.joint)
            if not lower_angle <= self.angle <= upper_angle:
                raise OutsideLimits(
                    f"{self} holds {self.angle:g} rad; {lower_angle:.3f} to {upper_angle:.3f} rad is allowed."
                )

    def apply(self, plant: Plant) -> None:
        """Note the angle."""
        plant.memory["held"] = plant.angle(self.joint) if self.angle is None else self.angle

    def command(self, plant: Plant) -> None:
        """Hold it."""
        plant.targets[self.joint] = plant.memory["held"]


fault = Locked
