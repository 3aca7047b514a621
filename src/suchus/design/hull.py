"""What makes a robot float: closed-cell foam around its bodies, and air in the trunk that can be let out."""

from dataclasses import dataclass

from suchus.design.checks import Checks


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
class Hull:
    """Foam on a robot, and its air. Water feels it and so does the weight; on the ground the robot's own skin touches.

    ``suchus.model.float_hull`` makes the one that lets a robot float with a share above the surface.
    """

    foam: tuple[Foam, ...]
    """Foam of every body that has some."""
    density: float = 40.0
    """Density of the foam [kg/m3]; extruded polystyrene and closed-cell polyethylene have 25 to 60."""
    air: float = 0.0
    """So much of the foam on the axis is a bladder whose air can be let out [m3]; water takes its place."""

    def __post_init__(self) -> None:
        with Checks("hull", self) as check:
            check.number("density", 0.0, 1e3, "kg/m3")
            check.number("air", 0.0, 1e3, "m3")
            names = [one.body for one in self.foam]
            twice = sorted({name for name in names if names.count(name) > 1})
            check.that(not twice, f"hull.foam names {', '.join(twice)} more than once; give each body one foam")

    @property
    def volume(self) -> float:
        """Volume of the foam [m3]."""
        return sum(one.volume for one in self.foam)

    @property
    def mass(self) -> float:
        """Mass of the foam [kg]."""
        return self.density * self.volume
