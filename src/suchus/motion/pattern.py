"""A movement of any body: feet on paths, limbs that crank or are held, and a wave along the axis.

All lengths are shares of a limb's reach or of the body, so that a movement fits a body of another size; only its
period is in seconds (``suchus.design.scaled`` changes it too).
"""

from dataclasses import dataclass
from itertools import pairwise
from math import pi

from suchus.design.checks import Checks


@dataclass(frozen=True, slots=True, kw_only=True)
class FootPath:
    """The path of a girdle's feet in the girdle's frame; lengths are shares of the limb's reach.

    In stance a foot goes straight back at constant speed, in swing forward as half a cosine, lifted as a squared sine.
    """

    stroke: float
    """Half of the distance that a foot moves back in stance [limb reach]."""
    lift: float
    """Height to which it is lifted in swing [limb reach]."""
    outward: float
    """Distance by which it stands outside its hip [limb reach]."""
    ahead: float
    """Distance by which the middle of its path lies ahead of its hip [limb reach]."""
    plane: float = 0.0
    """Of a limb of four hinges: how far the elbow is turned forward about the line from hip to foot [rad]."""

    def __post_init__(self) -> None:
        with Checks("foot_path", self) as check:
            for field in ("stroke", "outward", "ahead"):
                check.number(field, -1.0, 1.0, "limb reach")
            check.number("lift", 0.0, 1.0, "limb reach")
            check.number("plane", -pi, pi, "rad")


@dataclass(frozen=True, slots=True, kw_only=True)
class Sweep:
    """How limbs of a single crank turn: slowly while they stand, fast while they return over the top."""

    stance: float
    """Angle that the crank turns through in stance, half before and half behind straight down [rad]."""
    down: float
    """Angle of the crank at which the foot points straight down [rad]."""

    def __post_init__(self) -> None:
        with Checks("sweep", self) as check:
            check.number("stance", 0.01, 2 * pi - 0.01, "rad")
            check.number("down", -pi, pi, "rad")


@dataclass(frozen=True, slots=True, kw_only=True)
class Held:
    """Limbs that are held still, as when a salamander swims."""

    angles: tuple[float, ...]
    """One for each servo of a limb [rad]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AxialWave:
    """How the axis bends sideways.

    A hinge at the place s bends by amplitude(s) cos 2 pi (clock - phase - waves s), with its concave side to the right
    where the value is positive. With ``waves`` 0 it is a standing wave.
    """

    amplitude: tuple[tuple[float, float], ...]
    """Place along the body, 0 at the snout and 1 at the tip of the tail [-], and amplitude of a hinge there [rad]."""
    waves: float
    """Wavelengths along the body; the wave runs from head to tail where positive [-]."""
    phase: float
    """Phase lag [cycle]; 0: concave on the right a quarter of a cycle before the first limb's mid-stance."""
    offset: float = 0.0
    """Steady bend of every hinge, concave on the left where positive, to turn left [rad]."""

    def __post_init__(self) -> None:
        with Checks("wave", self) as check:
            check.number("waves", -10.0, 10.0, "")
            check.number("phase", -1.0, 1.0, "cycle")
            check.number("offset", -pi, pi, "rad")
            knots = self.amplitude
            shaped = bool(knots) and all(len(knot) == 2 for knot in knots)
            check.that(
                shaped
                and all(0.0 <= s <= 1.0 and abs(a) <= pi for s, a in knots)
                and all(one[0] < two[0] for one, two in pairwise(knots)),
                f"wave.amplitude is {str(knots)[:80]}; pairs of a place that increases from 0 to 1 and an angle of "
                "-3.14 to 3.14 rad are needed",
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Pattern:
    """A periodic movement of any body. Phases run from 0 to 1 [cycle]; each limb swings first, then stands."""

    name: str
    """Name, as messages, tables and files show it."""
    period: float
    """Period of one cycle [s]."""
    duty_factor: float
    """Share of the cycle in which a foot stands [-]."""
    limb_phases: tuple[float, ...]
    """Phase of each limb when the movement begins, in the order of the robot's limbs [cycle]."""
    girdles: tuple[FootPath | Sweep | Held, ...]
    """Movement of the limbs of each girdle, from the front one."""
    height: float
    """Height of the hindmost girdle's hips above the ground [reach of its limb]; 0 for a body on its belly."""
    wave: AxialWave
    """Wave by which the axis bends."""

    def __post_init__(self) -> None:
        with Checks("pattern", self) as check:
            check.number("period", 1e-3, 3600.0, "s")
            check.number("duty_factor", 0.05, 0.95, "")
            check.number("height", 0.0, 2.0, "limb reach")
            check.that(
                len(self.limb_phases) == 2 * len(self.girdles),
                f"pattern {self.name} has {len(self.limb_phases)} limb phases for {len(self.girdles)} girdles; each "
                "limb needs one, left before right",
            )
            check.that(
                all(-1.0 <= phase <= 1.0 for phase in self.limb_phases),
                f"pattern.limb_phases is {self.limb_phases}; -1 to 1 cycle is allowed",
            )
