"""A servo's horn on the wrong tooth."""

from dataclasses import dataclass
from math import pi

from suchus.robot.design import Robot
from suchus.sim.fault import Plant, ServoFault, refuse_number
from suchus.sim.persistence import PERMANENT, Persistence

TOOTH = 2 * pi / 25
"""One tooth of a horn with 25 teeth, the commonest spline of hobby servos [rad]."""


@dataclass(frozen=True, slots=True, repr=False)
class Offset(ServoFault):
    """A horn on the wrong tooth: the joint is off the servo's angle by a constant.

    The servo does not know: it drives the joint to the commanded angle plus the offset, and what it feels of its
    position is the joint's angle minus the offset. Where that leaves the joint's range, it presses on the stop.
    """

    joint: str
    """Name of the servo."""
    angle: float = TOOTH
    """Angle of the joint beyond the servo [rad]; -pi to pi."""
    at: float = 0.0
    """Time at which the fault begins [s], at least 0."""
    persistence: Persistence = PERMANENT
    """Whether it stays, recovers, or comes and goes."""

    def refuse(self, robot: Robot) -> None:
        """Refuse an angle beyond half a turn, too."""
        ServoFault.refuse(self, robot)
        refuse_number(self, self.angle, -pi, pi, "is off by", " rad")

    def command(self, plant: Plant) -> None:
        """Turn the joint farther."""
        plant.targets[self.joint] += self.angle

    def sense(self, plant: Plant) -> None:
        """Feel the servo's angle, not the joint's."""
        plant.felt("servo_position", self.joint)[...] -= self.angle


fault = Offset
harmless = (Offset("LF_yaw", 0.0),)
