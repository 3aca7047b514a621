"""A run: which robot walks how, on what, with what broken, pushed when."""

from dataclasses import dataclass, field

from suchus.control import Control, OpenLoop
from suchus.design import Crocodile
from suchus.design.checks import require
from suchus.land.faults import Fault
from suchus.land.push import Push
from suchus.motion import Gait


@dataclass(frozen=True, slots=True, kw_only=True)
class Ground:
    """Even ground, possibly tilted."""

    grip: float = 1.0
    """Factor on the friction of all the robot's surfaces [-]."""
    uphill: float = 0.0
    """Slope along the walk, up positive [rad]."""
    sideways: float = 0.0
    """Slope across the walk, left side up positive [rad]."""

    def __post_init__(self) -> None:
        require("ground", "grip", self.grip, 0.01, 10.0, "")
        require("ground", "uphill", self.uphill, -1.0, 1.0, "rad")
        require("ground", "sideways", self.sideways, -1.0, 1.0, "rad")


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """One run of a batch."""

    robot: Crocodile
    """Who walks."""
    gait: Gait
    """How."""
    ground: Ground = field(default_factory=Ground)
    """On what."""
    faults: tuple[Fault, ...] = ()
    """What breaks, and when."""
    pushes: tuple[Push, ...] = ()
    """Forces from outside; their sum acts where they overlap."""
    control: Control = field(default_factory=OpenLoop)
    """What turns the gait and the senses into servo angles."""
    noise: float = 0.0
    """Standard deviation of noise on every servo angle commanded [rad]."""
    seed: int = 0
    """Of the noise."""
    label: str = ""
    """For tables and legends."""

    def __post_init__(self) -> None:
        require("run", "noise", self.noise, 0.0, 1.0, "rad")
        require("run", "seed", self.seed, 0, 2**32 - 1, "")
