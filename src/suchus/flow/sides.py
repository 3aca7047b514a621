"""What happens on the four sides of the domain: stream, walls, inflow, outflow, periodic."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from suchus.errors import InvalidDesign
from suchus.flow.grid import Grid


@dataclass(frozen=True, slots=True, kw_only=True)
class Stream:
    """Open water that moves with the far stream; where the stream leaves, the wake is carried out."""

    endless: bool = True
    """Whether, if all four sides are such, they also move as the flow in the domain makes water without end move
    (``openwater``); False holds the stream itself, which the body's displacement then cannot widen."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Slip:
    """A wall without friction."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Wall:
    """A wall that the water sticks to."""

    speed: float = 0.0
    """Speed of the wall along itself, toward +x or +y [m/s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Inflow:
    """Water that enters with a given profile."""

    profile: Callable[[np.ndarray], np.ndarray]
    """Velocity into the domain [m/s] over the coordinate along the side [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outflow:
    """Where the water leaves; what it carries goes out with the mean speed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Periodic:
    """What leaves here enters on the opposite side, which is periodic too."""


Side = Stream | Slip | Wall | Inflow | Outflow | Periodic


@dataclass(frozen=True, slots=True, kw_only=True)
class Sides:
    """The four sides of the domain.

    Raises:
        InvalidDesign: on creation, if a periodic side faces one that is not.
    """

    left: Side = Stream()
    """Side at the smallest x."""
    right: Side = Stream()
    """Side at the largest x."""
    bottom: Side = Stream()
    """Side at the smallest y."""
    top: Side = Stream()
    """Side at the largest y."""

    def __post_init__(self) -> None:
        for name, a, b in (("left and right", self.left, self.right), ("bottom and top", self.bottom, self.top)):
            if isinstance(a, Periodic) != isinstance(b, Periodic):
                raise InvalidDesign(f"of {name}, one side is periodic and the other is not; make both Periodic().")
        every = (self.left, self.right, self.bottom, self.top)
        if any(isinstance(s, Inflow) for s in every) and not any(isinstance(s, Outflow | Stream) for s in every):
            raise InvalidDesign("water enters through an Inflow and cannot leave; make another side an Outflow().")

    @classmethod
    def box(cls) -> "Sides":
        """Return four walls that the water sticks to."""
        return cls(left=Wall(), right=Wall(), bottom=Wall(), top=Wall())

    @classmethod
    def periodic(cls) -> "Sides":
        """Return a domain that repeats itself along both axes."""
        return cls(left=Periodic(), right=Periodic(), bottom=Periodic(), top=Periodic())

    @property
    def endless(self) -> bool:
        """Whether water without end is all around."""
        return all(isinstance(s, Stream) and s.endless for s in (self.left, self.right, self.bottom, self.top))

    @property
    def repeats(self) -> tuple[bool, bool]:
        """Whether the domain is periodic along x and along y."""
        return isinstance(self.left, Periodic), isinstance(self.bottom, Periodic)

    def fastest(self, grid: Grid) -> float:
        """Return the fastest speed that a wall or an inflow imposes [m/s]."""
        speeds = [0.0]
        for side, axis in ((self.left, 1), (self.right, 1), (self.bottom, 0), (self.top, 0)):
            if isinstance(side, Wall):
                speeds.append(abs(side.speed))
            elif isinstance(side, Inflow):
                speeds.append(float(np.abs(side.profile((grid.x, grid.y)[axis])).max()))
        return max(speeds)
