"""Limbs: chains of hinges and links that end in a foot, a mirrored pair on each girdle."""

from dataclasses import dataclass
from math import fsum, hypot

from suchus.core.checks import Checks
from suchus.robot.design.hinge import Hinge
from suchus.robot.design.segment import Inertia, Point


@dataclass(frozen=True, slots=True, kw_only=True)
class Link:
    """A piece of a limb and the hinges at its beginning."""

    name: str
    """As ``femur``; the body is called after limb and link, as ``LF_femur``."""
    hinges: tuple[Hinge, ...]
    """At its beginning, in the order in which they turn it."""
    end: Point
    """Where it ends on a left limb at zero posture, from its beginning: forward, outward, up [m]."""
    radius: float
    """[m]."""
    mass: float
    """[kg]."""
    inertia: Inertia | None = None
    """Where its mass lies, and that of the foot on the last link; None: as in a rod and a ball, each of one density."""

    def __post_init__(self) -> None:
        with Checks(f"link {self.name}", self) as check:
            check.number("radius", 1e-5, 10.0, "m")
            check.number("mass", 1e-8, 1e5, "kg")
            check.that(self.length > 1e-6, f"link {self.name} has no length; move its end")

    @property
    def length(self) -> float:
        """Length from its beginning to its end [m]."""
        return hypot(*self.end)


@dataclass(frozen=True, slots=True, kw_only=True)
class Foot:
    """A ball at the end of a limb."""

    radius: float
    """[m]."""
    mass: float
    """[kg]."""

    def __post_init__(self) -> None:
        with Checks("foot", self) as check:
            check.number("radius", 1e-5, 10.0, "m")
            check.number("mass", 1e-8, 1e5, "kg")


_RADIUS_ROUNDING = 1e-9
"""Relative rounding error of radii that are equal in a design of another size [-]."""


def is_thick_enough(foot_radius: float, link_radius: float) -> bool:
    """Return whether a foot is no thinner than the link that it ends [m], so that the foot meets the ground first."""
    return foot_radius >= (1.0 - _RADIUS_ROUNDING) * link_radius


@dataclass(frozen=True, slots=True, kw_only=True)
class Limb:
    """The left limb of a girdle; the right one is its mirror image."""

    links: tuple[Link, ...]
    """Links, from the hip to the foot."""
    foot: Foot
    """Foot at the end of the last link."""

    def __post_init__(self) -> None:
        with Checks("limb", self) as check:
            names = [hinge.name for hinge in self.hinges]
            check.that(bool(self.links), "a limb has no link; give it one")
            check.that(bool(names), "a limb has no hinge; give it one")
            check.that(len(set(names)) == len(names), f"a limb has hinges {', '.join(names)}; each needs its own name")
            last_link = self.links[-1] if self.links else None
            check.that(
                last_link is None or is_thick_enough(self.foot.radius, last_link.radius),
                f"foot.radius is {self.foot.radius:.4g} m, thinner than the {last_link.radius:.4g} m of its link "
                f"{last_link.name}, which would carry the load in its place; make the foot thicker or the link thinner"
                if last_link
                else "",
            )

    @property
    def hinges(self) -> tuple[Hinge, ...]:
        """All of them, from the hip to the foot."""
        return tuple(hinge for link in self.links for hinge in link.hinges)

    @property
    def reach(self) -> float:
        """Farthest distance of the foot from the hip, its joint limits aside [m]."""
        return sum(link.length for link in self.links)

    @property
    def mass(self) -> float:
        """Mass of one limb [kg]."""
        return fsum(self.masses)

    @property
    def masses(self) -> tuple[float, ...]:
        """Mass of each link from the hip, then of the foot [kg]."""
        return (*(link.mass for link in self.links), self.foot.mass)


@dataclass(frozen=True, slots=True, kw_only=True)
class Girdle:
    """The place along the axis at which a pair of limbs is attached."""

    name: str
    """Ending of the limbs' names: ``F`` makes ``LF`` and ``RF``."""
    segment: str
    """Name of the segment of the axis to which it is attached."""
    at: float
    """Distance from the segment's origin forward to the hips [m]."""
    aside: float
    """Distance from the midline to the hip [m]."""
    above: float
    """Distance from the axis up to the hips [m]."""
    limb: Limb
    """The left limb."""

    def __post_init__(self) -> None:
        with Checks(f"girdle {self.name}", self) as check:
            check.number("at", -10.0, 10.0, "m")
            check.number("aside", 1e-5, 10.0, "m")
            check.number("above", -10.0, 10.0, "m")
            check.that(bool(self.name), "a girdle needs a name")
