"""What happens on the sides of the domain, four in the plane and six in space: stream, walls, inflow, periodic."""

from collections.abc import Callable
from dataclasses import dataclass
from math import hypot

import numpy as np

from suchus.errors import InvalidDesign
from suchus.flow.compiled import PAD
from suchus.flow.grid import Grid, check_kinds


@dataclass(frozen=True, slots=True, kw_only=True)
class Stream:
    """Open water that moves with the far stream; where the stream leaves, the wake is carried out."""

    unbounded: bool = True
    """Whether, if all four sides are such, they also move as the flow moves there in an unbounded domain
    (``openwater``, in space ``farfield``); False prescribes the far stream itself, which the body's displacement then
    cannot widen. In space some of the six may be a Mirror."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Slip:
    """A wall without friction."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Wall:
    """A wall that the water sticks to."""

    speed: float | tuple[float, float] = 0.0
    """Speed of the wall along itself, toward +x or +y; in space a pair along the other two axes, in the order x, y, z
    [m/s]."""

    def along(self, axes: int) -> tuple[float, ...]:
        """Return the speed along the axes that lie in the wall, of so many in all [m/s]."""
        return self.speed if isinstance(self.speed, tuple) else (self.speed, *(0.0,) * (axes - 2))


@dataclass(frozen=True, slots=True, kw_only=True)
class Inflow:
    """Water that enters with a given profile."""

    profile: Callable[..., np.ndarray]
    """Velocity into the domain [m/s] over the coordinate along the side [m]; in space over both, in the order x, y, z,
    given as two arrays of the same shape."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Outflow:
    """Where the water leaves; what it carries goes out with the mean speed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Periodic:
    """What leaves here enters on the opposite side, which is periodic too."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Mirror:
    """A plane of symmetry, in space: beyond it lies the image of what is inside.

    A body may be cut by it, if its middle lies on it and stays there; what the record says is then of the whole body.
    """


Side = Stream | Slip | Wall | Inflow | Outflow | Periodic | Mirror

NAMES = ("left", "right", "bottom", "top", "low", "high")
"""Names of the sides: at the smallest and the largest x, y and z."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Sides:
    """The sides of the domain; ``low`` and ``high`` count in space only.

    Raises:
        InvalidDesign: on creation, if a periodic side faces one that is not, or water enters that cannot leave.
    """

    left: Side = Stream()
    """Side at the smallest x."""
    right: Side = Stream()
    """Side at the largest x."""
    bottom: Side = Stream()
    """Side at the smallest y."""
    top: Side = Stream()
    """Side at the largest y."""
    low: Side = Stream()
    """Side at the smallest z, of a grid in space."""
    high: Side = Stream()
    """Side at the largest z, of a grid in space."""

    def __post_init__(self) -> None:
        check_kinds(self)
        for first, second in zip(NAMES[::2], NAMES[1::2], strict=True):
            if isinstance(getattr(self, first), Periodic) != isinstance(getattr(self, second), Periodic):
                raise InvalidDesign(
                    f"of {first} and {second}, one side is periodic and the other is not; make both Periodic()."
                )
        plane, ends = self.around(2), (self.low, self.high)
        enters = any(isinstance(side, Inflow) for side in (*plane, *ends))
        if enters and not any(isinstance(s, Outflow | Stream) for s in plane) and Outflow not in map(type, ends):
            raise InvalidDesign("water enters through an Inflow and cannot leave; make another side an Outflow().")

    def check(self, axes: int) -> None:
        """Refuse sides that cannot be those of a domain with so many axes.

        Raises:
            InvalidDesign: a mirror in the plane, or a wall's speed of another dimension.
        """
        for name, side in zip(NAMES, self.around(axes), strict=False):
            if isinstance(side, Mirror) and axes == 2:
                raise InvalidDesign(f"the {name} side of a plane grid is a Mirror; in the plane take a Slip().")
            if isinstance(side, Wall) and len(side.along(axes)) != axes - 1:
                raise InvalidDesign(
                    f"the speed of the wall at the {name} side is {side.speed} m/s; a plane grid needs one number."
                )

    def check_travel(self, axes: int, travels: tuple[bool, bool, bool], body: str) -> None:
        """Refuse sides that stand still in the world, if the grid travels and would take them along.

        A side without friction may travel along itself, and open and periodic ones anywhere.

        Args:
            axes: of the domain.
            travels: whether the grid travels along x, y and z.
            body: name of the body that it travels with.

        Raises:
            InvalidDesign: a wall, an inflow or a mirror would travel.
        """
        for number, name in enumerate(NAMES[: 2 * axes]):
            side = getattr(self, name)
            sticks = isinstance(side, Wall | Inflow) and any(travels)
            if sticks or (isinstance(side, Slip | Mirror) and travels[number // 2]):
                raise InvalidDesign(
                    f"the grid is to follow {body!r} and would take its {name} side along; the place of a side of the "
                    f"kind {type(side).__name__} is fixed: make it a Stream(), or leave follow None in a domain that "
                    f"is long enough."
                )

    @classmethod
    def box(cls) -> "Sides":
        """Return walls all around that the water sticks to."""
        return cls(**dict.fromkeys(NAMES, Wall()))

    @classmethod
    def periodic(cls) -> "Sides":
        """Return a domain that repeats itself along all axes."""
        return cls(**dict.fromkeys(NAMES, Periodic()))

    def around(self, axes: int) -> tuple[Side, ...]:
        """Return the sides of a domain with so many axes, in the order of ``NAMES``."""
        return tuple(getattr(self, name) for name in NAMES[: 2 * axes])

    def unbounded(self, axes: int) -> bool:
        """Return whether the domain is unbounded, so that its sides move with the flow."""
        every = self.around(axes)
        open_sides = [isinstance(s, Stream) and s.unbounded for s in every]
        return any(open_sides) and all(o or isinstance(s, Mirror) for o, s in zip(open_sides, every, strict=True))

    def repeats(self, axes: int) -> tuple[bool, ...]:
        """Return whether the domain is periodic, along each axis."""
        return tuple(isinstance(side, Periodic) for side in self.around(axes)[::2])

    def mirrors(self, axes: int) -> tuple[bool, ...]:
        """Return whether there is a mirror at the low and at the high end, along each axis: ``NAMES``."""
        return tuple(isinstance(side, Mirror) for side in self.around(axes))

    def held(self, axes: int) -> tuple[tuple[bool, bool], ...]:
        """Return whether the place of the low and of the high side counts, along each axis: of all but open ones."""
        fixed = [not isinstance(side, Stream | Outflow) for side in self.around(axes)]
        return tuple(zip(fixed[::2], fixed[1::2], strict=True))

    def fastest(self, grid: Grid) -> float:
        """Return the fastest speed that a wall or an inflow imposes [m/s]."""
        speeds = [0.0]
        for k, side in enumerate(self.around(grid.axes)):
            if isinstance(side, Wall):
                speeds.append(hypot(*side.along(grid.axes)))
            elif isinstance(side, Inflow):
                speeds.append(float(np.abs(inflow(side, grid, k // 2)).max()))
        return max(speeds)


def inflow(side: Inflow, grid: Grid, axis: int) -> np.ndarray:
    """Return the velocity into the domain on the faces of a side across an axis, the last axis first [m/s]."""
    along = [grid.centres(PAD, PAD + n, d) for d, n in enumerate(grid.cells) if d != axis]
    return np.asarray(side.profile(*np.meshgrid(*along)))
