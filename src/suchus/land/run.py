"""A run: which robot walks how, on what, with what broken, pushed when."""

from dataclasses import dataclass, field

from suchus.control import Control, OpenLoop
from suchus.design import WATER_DENSITY, WATER_VISCOSITY, AnyRobot
from suchus.design.checks import Checks, require
from suchus.design.ground import Ground
from suchus.fault import Fault
from suchus.gaits import GAITS
from suchus.land.lake import Lake
from suchus.land.push import Push
from suchus.motion import Gait
from suchus.robots import ROBOTS


@dataclass(frozen=True, slots=True, kw_only=True)
class Afloat:
    """No ground and no gravity: in vacuum, or neutrally buoyant in a fluid at rest.

    The fluid acts by MuJoCo's ellipsoid model, a drag and lift of each piece of the body by its own motion alone; it
    knows no wake, and of the added mass only what turns with a piece, not what resists its acceleration. Contacts are
    off; the physics is integrated by Runge-Kutta steps of fourth order, since those keep angular momentum.
    """

    density: float
    """Density of the fluid [kg/m3]; 0 in vacuum."""
    viscosity: float
    """Dynamic viscosity of the fluid [Pa s]; 0 in vacuum."""

    def __post_init__(self) -> None:
        require("afloat", "density", self.density, 0.0, 2e4, "kg/m3")
        require("afloat", "viscosity", self.viscosity, 0.0, 1e3, "Pa s")


VACUUM = Afloat(density=0.0, viscosity=0.0)
"""Surroundings that exert no force."""
WATER = Afloat(density=WATER_DENSITY, viscosity=WATER_VISCOSITY)
"""Fresh water of 20 degrees Celsius."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """One run of a batch; robot and gait may be given by their names on the shelves."""

    robot: AnyRobot
    """The robot that walks: a body of any kind, as ``suchus.ROBOTS`` names them."""
    gait: Gait
    """Its periodic movement, as ``suchus.GAITS`` names them."""
    ground: Ground = field(default_factory=Ground)
    """Ground: its friction scale, slopes and relief."""
    afloat: Afloat | None = None
    """Fluid in which it floats, far from any surface; None where it stands on the ground."""
    lake: Lake | None = None
    """The water that it walks and swims in; None on dry land."""
    faults: tuple[Fault, ...] = ()
    """Faults, each with the time at which it begins; none by default."""
    pushes: tuple[Push, ...] = ()
    """Forces from outside; their sum acts where they overlap."""
    control: Control = field(default_factory=OpenLoop)
    """Controller that turns the gait and what the robot senses into servo angles."""
    noise: float = 0.0
    """Standard deviation of noise on every servo angle commanded [rad]."""
    seed: int = 0
    """Seed of the noise [-]."""
    label: str = ""
    """Name in tables and legends."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "robot", ROBOTS.resolve(self.robot))
        object.__setattr__(self, "gait", GAITS.resolve(self.gait))
        with Checks("run", self) as check:
            check.number("noise", 0.0, 1.0, "rad")
            check.whole("seed", 0, 2**32 - 1)
            check.that(
                self.lake is None or self.afloat is None,
                "a run floats in a lake or in a vacuum without gravity, not in both: leave out lake or afloat",
            )
