"""A servo that turns more slowly than it should."""

from dataclasses import dataclass

from suchus.robot.design import Robot
from suchus.sim.fault import Plant, ServoFault, refuse_number
from suchus.sim.persistence import PERMANENT, Persistence


@dataclass(frozen=True, slots=True, repr=False)
class Slow(ServoFault):
    """A servo whose angle follows the commanded one at a limited speed, as with a sagging supply.

    The limit is on the angle that the servo's own loop aims at, where the intact servo's limit is too; loads can turn
    the joint faster.
    """

    joint: str
    """Name of the servo."""
    speed: float = 1.0
    """The new speed limit [rad/s]; more than 0, at most the limit of the intact servo."""
    at: float = 0.0
    """Time at which the fault begins [s], at least 0."""
    persistence: Persistence = PERMANENT
    """Whether it stays, recovers, or comes and goes."""

    def refuse(self, robot: Robot) -> None:
        """Refuse a speed that is not a limit of this servo, too."""
        ServoFault.refuse(self, robot)
        refuse_number(self, self.speed, 1e-3, robot.servo(self.joint).speed, "turns at", " rad/s")

    def apply(self, plant: Plant) -> None:
        """Lower the limit."""
        plant.speed_limit(self.joint)[:] = self.speed


fault = Slow
harmless = (Slow("LF_yaw", 7.0),)  # as fast as the caiman's servos turn
