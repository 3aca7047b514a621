"""The parts of a gait: what the limbs of a girdle do, how a part of the axis bends, and a servo's measured curve.

Lengths are shares of a limb's reach and bends are those of a whole part of the body.
"""

from dataclasses import dataclass, replace
from math import pi
from typing import Literal

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks

MAX_ANGLES = 1000
"""Samples of a curve at most."""
MAX_KNOTS = 100
"""Numbers along a part of the axis at most."""

AxisRegion = Literal["neck", "trunk", "tail", "axis"]
"""A part of the axis: ahead of the foremost limbs, from there to the root, behind the root, or all of it.

A body without limbs has no neck: what lies ahead of its root is trunk.
"""
ServoPart = Literal["limb", "neck", "trunk", "tail"]
"""A part of the body that a servo moves."""
Turn = Literal["yaw", "pitch"]
"""Sideways, or up and down."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FootPath:
    """The path of a girdle's feet in the girdle's frame, so that a swing of the trunk adds to the stride of the limbs.

    In stance a foot goes straight back at constant speed; in swing it goes forward as half a cosine and is lifted as a
    squared sine, so that it leaves and meets the ground without vertical speed. Lengths are shares of the limb's reach.
    """

    stroke: float
    """Half of the distance that a foot moves back in stance [limb reach]."""
    lift: float
    """Height to which it is lifted in swing [limb reach]."""
    outward: float
    """Distance by which it stands outside its hip [limb reach]."""
    ahead: float = 0.0
    """Distance by which the middle of its path lies ahead of its hip [limb reach]."""
    swivel: float = 0.0
    """How far knee or elbow is turned forward about the line from hip to foot, 0 where it points up [rad].

    A limb of yaw, pitch and knee takes the nearest of three: 0, the sprawl of the article's Fig. 3a; pi/2 with the knee
    ahead and -pi/2 with the elbow behind, the erect legs of its Fig. 3b, whose feet stand below their hips.
    """

    def __post_init__(self) -> None:
        with Checks("foot_path", self) as check:
            for field in ("stroke", "outward", "ahead"):
                check.number(field, -1.0, 1.0, "limb reach")
            check.number("lift", 0.0, 1.0, "limb reach")
            check.number("swivel", -pi, pi, "rad")


@dataclass(frozen=True, slots=True, kw_only=True)
class Sweep:
    """How limbs of a single crank turn: slowly while they stand, fast while they return over the top."""

    stance: float
    """Angle that the crank turns through in stance, half before and half behind straight down [rad]."""
    down: float = 0.0
    """Angle of the crank at which the foot points straight down [rad]."""

    def __post_init__(self) -> None:
        with Checks("sweep", self) as check:
            check.number("stance", 0.01, 2 * pi - 0.01, "rad")
            check.number("down", -pi, pi, "rad")


@dataclass(frozen=True, slots=True, kw_only=True)
class FixedLimbs:
    """Limbs that are held still, as when a salamander swims."""

    angles: tuple[float, ...]
    """One for each servo of a limb, or those of its first servos; the others are held at 0 [rad]."""


Limbs = FootPath | Sweep | FixedLimbs
"""The movement of a pair of limbs."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Bend:
    """How a part of the axis bends, evenly shared by its hinges.

    The part bends by ``offset - amplitude cos 2 pi (phase - lag)``, concave to the left (yaw) or below (pitch) where
    that is positive. The phase is that of the limbs together, 0 a quarter of a cycle before the middle of the first
    limb's stance: with no lag each girdle of a diagonal gait carries its new stance foot ahead. Several numbers are
    knots from the part's first to its last hinge from head to tail; of n hinges each takes an nth of the value at its
    place, so that the part bends alike on every body.
    """

    part: AxisRegion
    """Part of the axis that bends."""
    turn: Turn = "yaw"
    """Sideways or up and down."""
    amplitude: tuple[float, ...] = (0.0,)
    """Amplitude of the whole part, all its hinges together [rad]."""
    lag: tuple[float, ...] = (0.0,)
    """Phase lag behind the limbs [cycle]; where it grows toward the tail a wave travels backward."""
    offset: float = 0.0
    """Steady bend of the whole part [rad]."""

    def __post_init__(self) -> None:
        with Checks("bend", self) as check:
            check.number("offset", -10 * pi, 10 * pi, "rad")
            for name, limit, unit in (("amplitude", 100 * pi, "rad"), ("lag", 100.0, "cycle")):
                row = getattr(self, name)
                check.that(
                    1 <= len(row) <= MAX_KNOTS and all(-limit <= value <= limit for value in row),
                    f"bend.{name} is {str(row)[:80]}; 1 to {MAX_KNOTS} numbers of {-limit:g} to {limit:g} {unit} are "
                    "needed",
                )


@dataclass(frozen=True, slots=True, kw_only=True)
class Curve:
    """The measured angle of one servo over one cycle; it replaces the angles from limbs and axis."""

    servo: str
    """Name of the servo, as ``suchus.robot.design.layout(robot).servos`` has it."""
    part: ServoPart
    """Part of the body that it moves: a limb's curve follows the phase of its limb, any other one that of the axis."""
    angles: tuple[float, ...]
    """Angles at equal steps of the cycle; after the last one the first follows again [rad]."""

    def __post_init__(self) -> None:
        with Checks(f"curve {self.servo}", self) as check:
            check.that(
                1 <= len(self.angles) <= MAX_ANGLES,
                f"curve {self.servo} has {len(self.angles)} angles; 1 to {MAX_ANGLES} are allowed",
            )
            invalid_angle = next((angle for angle in self.angles if not abs(angle) <= 2 * pi), None)
            check.that(
                invalid_angle is None,
                f"curve {self.servo} has an angle of {invalid_angle} rad; -6.28 to 6.28 rad is allowed",
            )

    @property
    def harmonics(self) -> Float[np.ndarray, " harmonic"]:
        """Complex amplitudes of the smoothest periodic curve through the samples, from the mean on [rad].

        It is the trigonometric interpolation, which has the fewest harmonics: 13 samples give six of them exactly.
        """
        count = len(self.angles)
        amplitudes = np.fft.rfft(self.angles) / count
        amplitudes[1 : (count + 1) // 2] *= 2.0
        return np.asarray(amplitudes)

    def angle_at(self, clock: Float[np.ndarray, "*batch"]) -> Float[np.ndarray, "*batch"]:
        """Return the angle at times in cycles [rad]."""
        turns = np.multiply.outer(np.asarray(clock, dtype=float), np.arange(len(self.harmonics)))
        return np.asarray((np.exp(2j * np.pi * turns) @ self.harmonics).real)

    def lagged(self, lag: float) -> "Curve":
        """Return the curve delayed in the cycle [cycle]."""
        count = len(self.angles)
        return replace(self, angles=tuple(float(angle) for angle in self.angle_at(np.arange(count) / count - lag)))
