"""A leg without its foot."""

from dataclasses import dataclass

from suchus.robot.design import Robot, layout
from suchus.sim.fault import Fault, Plant
from suchus.sim.persistence import PERMANENT, Persistence


@dataclass(frozen=True, slots=True, repr=False)
class LostFoot(Fault):
    """A leg without its foot: the sole no longer meets the ground, the end of the shank does.

    The shank ends round, where the foot's centre was, with the shank's radius and the friction of skin. The foot's
    pressure sensor reads zero. The foot's mass stays at the end of the shank (a twentieth of the leg's), and so does
    its drag in water.
    """

    limb: str
    """Name of the leg, as ``LF``."""
    at: float = 0.0
    """Time at which the fault begins [s], at least 0."""
    persistence: Persistence = PERMANENT
    """Whether it stays, recovers, or comes and goes."""
    acts_on = "limb"

    @property
    def part(self) -> str:
        """Name of the leg."""
        return self.limb

    @classmethod
    def parts(cls, robot: Robot) -> tuple[str, ...]:
        """Return the names of the legs."""
        return layout(robot).limb_names

    def apply(self, plant: Plant) -> None:
        """Let the sole pass through the ground."""
        plant.parameter("geom_conaffinity", f"{self.limb}_foot")[:] = 0

    def sense(self, plant: Plant) -> None:
        """Feel no pressure."""
        plant.felt("foot_pressure", self.limb)[...] = 0.0


fault = LostFoot
