"""A gait: how feet, trunk and tail move over one cycle."""

from dataclasses import dataclass, replace
from typing import Literal

from suchus.design import LEGS
from suchus.design.checks import Checks

Legs = Literal["sprawled", "erect"]
"""How legs stand.

``sprawled``: the plane of a leg turns with its foot, as in the article's Fig. 3a. ``erect``: it stays upright along the
body, the foot below the hip, the elbow behind and the knee ahead, and the stride comes from pitch and knee alone, as
in Fig. 3b.
"""

_ALLOWED = {
    "period": (1e-3, 3600.0, "s"),
    "duty_factor": (0.05, 0.95, ""),
    "stroke": (-10.0, 10.0, "m"),
    "lift": (0.0, 10.0, "m"),
    "front_reach": (-10.0, 10.0, "m"),
    "hind_reach": (-10.0, 10.0, "m"),
    "front_ahead": (-10.0, 10.0, "m"),
    "hind_ahead": (-10.0, 10.0, "m"),
    "hip_height": (1e-4, 10.0, "m"),
    "trunk_bend": (0.0, 3.1416, "rad"),
    "spine_phase": (-1.0, 1.0, "cycle"),
    "tail_bend": (0.0, 3.1416, "rad"),
    "tail_phase": (-1.0, 1.0, "cycle"),
    "tail_pitch": (-3.1416, 3.1416, "rad"),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Gait:
    """A periodic gait. Phases run from 0 to 1 [cycle]; each limb swings first, then stands.

    Feet follow paths fixed to their girdle, so that a swing of the trunk adds to the stride of the legs.
    """

    name: str
    """Name, as messages, tables and files show it."""
    period: float
    """Period of one cycle [s]."""
    duty_factor: float
    """Share of the cycle in which a foot stands [-]."""
    limb_phases: tuple[float, float, float, float]
    """Phase of LF, RF, LH, RH when the walk begins [cycle]."""
    stroke: float
    """Half of the distance that a foot moves back in stance, in its girdle's frame [m]."""
    lift: float
    """Height to which a foot is lifted in swing [m]."""
    front_reach: float
    """Distance by which a front foot stands outside its hip [m]."""
    hind_reach: float
    """Distance by which a hind foot stands outside its hip [m]."""
    front_ahead: float
    """Distance by which the middle of a front foot's path lies ahead of its hip [m]."""
    hind_ahead: float
    """Distance by which the middle of a hind foot's path lies ahead of its hip [m]."""
    legs: Legs
    """``sprawled`` or ``erect``; erect feet stand below their hips, so that both reaches are zero."""
    hip_height: float
    """Height of both girdles' hip axes above the ground [m]."""
    trunk_bend: float
    """Amplitude of the lateral bend of the whole trunk, the sum of its yaw angles [rad]."""
    spine_phase: float
    """Phase lag of the trunk's bend behind the legs [cycle]; 0: each girdle carries its swing foot forward."""
    tail_bend: float
    """Amplitude of the lateral bend of the tail [rad]."""
    tail_phase: float
    """Phase lag of the tail's bend behind the trunk's [cycle]; 0: head and tail swing to opposite sides."""
    tail_pitch: float
    """Steady angle of the tail's pitch joint, down positive [rad]: the ground carries the tail, or it is lifted."""

    def __post_init__(self) -> None:
        with Checks("gait", self) as checks:
            for field, (low, high, unit) in _ALLOWED.items():
                checks.number(field, low, high, unit)
            checks.each("limb_phases", LEGS, -1.0, 1.0, "cycle")
            checks.that(
                self.legs != "erect" or (self.front_reach, self.hind_reach) == (0.0, 0.0),
                f"gait.front_reach is {self.front_reach:g} m and gait.hind_reach {self.hind_reach:g} m; erect legs "
                "stand below their hips, so that both must be 0 m",
            )

    def mirrored(self) -> "Gait":
        """Return the gait with left and right swapped."""
        lf, rf, lh, rh = self.limb_phases
        return replace(self, limb_phases=(rf, lf, rh, lh))
