"""Boundary conditions on the sides of the domain, four in the plane and six in space: stream, walls, inflow, periodic.

A kind of side is a subclass of ``Side`` that defines the motion of the water there. You can write your own.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.core.kinds import show
from suchus.flow.grid import check_kinds


class Side:
    """A kind of side of the domain; this base class is a wall without friction.

    A subclass overrides what differs. Its methods are called in every step, for the time at the end of the step.
    """

    __slots__ = ()

    is_permeable: ClassVar[bool] = False
    """Whether water can go through the side; water that enters must leave by a side that ``is_open``."""
    is_open: ClassVar[bool] = False
    """Whether the flow through the side balances that through the others; the position of such a side is arbitrary."""
    is_domain_end: ClassVar[bool] = True
    """Whether the domain ends here; beyond the side of a patch it may continue in coarser cells."""
    travels: ClassVar[tuple[bool, bool]] = False, True
    """Whether the side may travel with the grid: across itself, and along itself."""

    def inflow_velocity(self, time: float, *places: np.ndarray) -> np.ndarray | float:
        """Return the velocity into the domain, a number or one for each point [m/s].

        It is called only if the side ``is_permeable``.

        Args:
            time: time [s].
            places: coordinates along the side, of one axis in the plane and of two in space, in the order x, y, z [m].
        """
        del time, places
        return 0.0

    def wall_velocity(self, time: float, ndim: int) -> tuple[float, ...] | None:
        """Return the velocity of the wall along the other axes [m/s]; None without friction.

        Args:
            time: time [s].
            ndim: number of axes of the domain, 2 or 3.
        """
        del time, ndim
        return None

    def outflow_fraction(self, outward: float) -> float:
        """Return the fraction of a step in which the arriving water is carried out [-].

        Args:
            outward: outward velocity of the far stream across the side, over its speed [-].
        """
        del outward
        return 0.0


_LEAVES = 0.2, 0.4
"""Outward velocity of the far stream, over its speed, at which a Stream side begins to carry the wake out, and at which
it does so fully [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stream(Side):
    """Open water that moves with the far stream; where the stream leaves, it carries the wake out."""

    unbounded: bool = True
    """Whether the sides, if all are such, move with the flow in an unbounded domain (``openwater``, in space
    ``farfield``). False prescribes the far stream itself, so that the displacement of a body cannot widen it. In space
    some of the six may be a Mirror."""

    is_permeable: ClassVar[bool] = True
    is_open: ClassVar[bool] = True
    travels: ClassVar[tuple[bool, bool]] = True, True

    def outflow_fraction(self, outward: float) -> float:
        """Return the fraction, which rises with the outward velocity of the far stream; see ``Side``."""
        return min(max((outward - _LEAVES[0]) / (_LEAVES[1] - _LEAVES[0]), 0.0), 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Slip(Side):
    """A wall without friction."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Wall(Side):
    """A wall with friction."""

    speed: float | tuple[float, float] = 0.0
    """Speed of the wall along itself, toward +x or +y; in space a pair along the other two axes, in the order x, y, z
    [m/s]."""

    travels: ClassVar[tuple[bool, bool]] = False, False

    def wall_velocity(self, time: float, ndim: int) -> tuple[float, ...]:
        """Return the wall's speed; see ``Side``."""
        del time
        return self.speed if isinstance(self.speed, tuple) else (self.speed, *(0.0,) * (ndim - 2))


@dataclass(frozen=True, slots=True, kw_only=True)
class Inflow(Side):
    """Water that enters with a given profile."""

    profile: Callable[..., np.ndarray]
    """Velocity into the domain [m/s] as a function of the coordinate along the side [m]; in space of both, two arrays
    of one shape in the order x, y, z."""

    is_permeable: ClassVar[bool] = True
    travels: ClassVar[tuple[bool, bool]] = False, False

    def inflow_velocity(self, time: float, *places: np.ndarray) -> np.ndarray:
        """Return the profile; see ``Side``."""
        del time
        return np.asarray(self.profile(*places))

    def wall_velocity(self, time: float, ndim: int) -> tuple[float, ...]:
        """Return zero: the water enters at a right angle; see ``Side``."""
        del time
        return (0.0,) * (ndim - 1)


@dataclass(frozen=True, slots=True, kw_only=True)
class Outflow(Side):
    """A side at which water leaves, carried out with the mean speed."""

    is_permeable: ClassVar[bool] = True
    is_open: ClassVar[bool] = True
    travels: ClassVar[tuple[bool, bool]] = True, True

    def outflow_fraction(self, outward: float) -> float:
        """Return 1: the water is always carried out; see ``Side``."""
        del outward
        return 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Periodic(Side):
    """What leaves here enters on the opposite side, which is periodic too."""

    travels: ClassVar[tuple[bool, bool]] = True, True


@dataclass(frozen=True, slots=True, kw_only=True)
class Mirror(Side):
    """A plane of symmetry in space, beyond which the flow is mirrored.

    It may cut a body whose centre lies on it and stays there; the record is then that of the whole body.
    """


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
        """Check that periodic sides face each other and that water that enters can leave."""
        check_kinds(self)
        for low_name, high_name in zip(NAMES[::2], NAMES[1::2], strict=True):
            if isinstance(getattr(self, low_name), Periodic) != isinstance(getattr(self, high_name), Periodic):
                raise InvalidDesign(
                    f"of {low_name} and {high_name}, one side is periodic and the other is not; make both Periodic()."
                )
        plane, ends = self.of_axes(2), (self.low, self.high)
        enters = any(isinstance(side, Inflow) for side in (*plane, *ends))
        if enters and not any(s.is_open for s in plane) and Outflow not in map(type, ends):
            raise InvalidDesign("water enters through an Inflow and cannot leave; make another side an Outflow().")

    def check(self, ndim: int) -> None:
        """Refuse sides that do not fit the number of axes of the domain.

        Args:
            ndim: number of axes, 2 or 3.

        Raises:
            InvalidDesign: a mirror in the plane, or a side's speed of another dimension.
        """
        for name, side in zip(NAMES, self.of_axes(ndim), strict=False):
            if isinstance(side, Mirror) and ndim == 2:
                raise InvalidDesign(f"the {name} side of a plane grid is a Mirror; in the plane take a Slip().")
            speed, needs = (
                side.wall_velocity(0.0, ndim),
                ("a plane grid needs one number", "in space it has two")[ndim - 2],
            )
            if speed is not None and len(speed) != ndim - 1:
                raise InvalidDesign(f"the speed of the {name} side along itself is {show(speed)} m/s; {needs}.")

    def check_travel(self, ndim: int, travels: tuple[bool, bool, bool], body: str) -> None:
        """Refuse sides with a fixed position in the world if the grid travels and would move them.

        A side without friction may travel along itself. Open and periodic sides may travel in any direction.

        Args:
            ndim: number of axes of the domain.
            travels: whether the grid travels along x, y and z.
            body: name of the body that it travels with.

        Raises:
            InvalidDesign: a wall, an inflow or a mirror would travel.
        """
        for number, name in enumerate(NAMES[: 2 * ndim]):
            side, travels_across = getattr(self, name), travels[number // 2]
            may_across, may_along = side.travels
            if (travels_across and not may_across) or (any(travels) and not may_along):
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

    def of_axes(self, ndim: int) -> tuple[Side, ...]:
        """Return the sides of a domain with so many axes, in the order of ``NAMES``."""
        return tuple(getattr(self, name) for name in NAMES[: 2 * ndim])

    def unbounded(self, ndim: int) -> bool:
        """Return whether the domain is unbounded, so that its sides move with the flow."""
        sides = self.of_axes(ndim)
        open_sides = [isinstance(s, Stream) and s.unbounded for s in sides]
        return any(open_sides) and all(o or isinstance(s, Mirror) for o, s in zip(open_sides, sides, strict=True))

    def is_periodic(self, ndim: int) -> tuple[bool, ...]:
        """Return whether the domain is periodic, along each axis."""
        return tuple(isinstance(side, Periodic) for side in self.of_axes(ndim)[::2])

    def has_mirror(self, ndim: int) -> tuple[bool, ...]:
        """Return whether there is a mirror at the low and at the high end, along each axis: ``NAMES``."""
        return tuple(isinstance(side, Mirror) for side in self.of_axes(ndim))

    def is_solid(self, ndim: int) -> tuple[bool, ...]:
        """Return whether a body may come near to a side, along each axis: ``NAMES``.

        It may to walls with and without friction, beyond which the water's velocity is known. A mirror is none, because
        it may cut bodies.
        """
        return tuple(
            side.is_domain_end and not side.is_permeable and not isinstance(side, Periodic | Mirror)
            for side in self.of_axes(ndim)
        )

    def is_fixed(self, ndim: int) -> tuple[tuple[bool, bool], ...]:
        """Return whether the positions of the low and the high side are fixed, along each axis.

        They are fixed for all but open sides.
        """
        fixed = [not side.is_open for side in self.of_axes(ndim)]
        return tuple(zip(fixed[::2], fixed[1::2], strict=True))
