"""What makes a robot float: closed-cell foam around its bodies, and air in the trunk that can be let out."""

from dataclasses import dataclass

from suchus.core.checks import Checks

_SLACK = 1e-9  # of a sum of shares [-]


@dataclass(frozen=True, slots=True, kw_only=True)
class Foam:
    """Foam around one body, spread over it like a skin."""

    body: str
    """Name of the body, as ``pelvis`` or ``LF_femur``."""
    volume: float
    """[m3]."""
    raised: float = 0.0
    """Distance by which its centre lies above that of the body, all joints at zero [m]."""

    def __post_init__(self) -> None:
        with Checks(f"foam on {self.body}", self) as check:
            check.number("volume", 0.0, 1e3, "m3")
            check.number("raised", -1.0, 1.0, "m")


@dataclass(frozen=True, slots=True, kw_only=True)
class Chamber:
    """A part of the hull's air, in the foam around a body of the axis or in the hollow of that body."""

    body: str
    """Name of the body, as ``thorax``."""
    share: float
    """Share of the hull's air [-]."""

    def __post_init__(self) -> None:
        with Checks(f"chamber in {self.body}", self) as check:
            check.number("share", 0.0, 1.0, "")


@dataclass(frozen=True, slots=True, kw_only=True)
class Hull:
    """Foam on a robot, and its air. Water feels it and so does the weight; on the ground the robot's own skin touches.

    ``design.flotation.float_hull`` makes the one that lets a robot float with a share above the surface, and
    ``kinematics.trim.level_chambers`` the chambers with which it is level under it.
    """

    foam: tuple[Foam, ...]
    """Foam of every body that has some."""
    density: float = 40.0
    """Density of the foam [kg/m3]; extruded polystyrene and closed-cell polyethylene have 25 to 60."""
    air: float = 0.0
    """Air that can be let out [m3]; water takes its place."""
    chambers: tuple[Chamber, ...] = ()
    """Where that air is. Those ahead of the root are front chambers, the others rear ones, and each kind is emptied and
    filled by itself. If none is given, the air lies in the foam of the axis, in proportion to it."""

    def __post_init__(self) -> None:
        with Checks("hull", self) as check:
            check.number("density", 0.0, 1e3, "kg/m3")
            check.number("air", 0.0, 1e3, "m3")
            names = [foam.body for foam in self.foam]
            duplicates = sorted({name for name in names if names.count(name) > 1})
            check.that(
                not duplicates, f"hull.foam names {', '.join(duplicates)} more than once; give each body one foam"
            )
            bodies, total = [chamber.body for chamber in self.chambers], sum(chamber.share for chamber in self.chambers)
            check.that(
                len(set(bodies)) == len(bodies), "hull.chambers names a body more than once; give each body one chamber"
            )
            check.that(
                not bodies or abs(total - 1.0) < _SLACK,
                f"hull.chambers have shares that add up to {total:g}; they must be all of the air, 1",
            )

    @property
    def volume(self) -> float:
        """Volume of the foam [m3]."""
        return sum(foam.volume for foam in self.foam)

    @property
    def mass(self) -> float:
        """Mass of the foam [kg]."""
        return self.density * self.volume
