"""A body given by its midline and the half-width along it: fish, robots, foils."""

from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import cached_property
from math import isfinite

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.core.kinds import show
from suchus.flow.markers import Markers
from suchus.flow.mass import Mass, of_midline
from suchus.flow.paint import paint, ring, section_motions
from suchus.flow.pose import Pose
from suchus.flow.shape import Axes, Field, Shape, check_positive
from suchus.flow.solid import box_around, pieces_of_line


@dataclass(frozen=True, kw_only=True)
class MidlineState:
    """A midline at one time, in the body's own frame; arrays of shape (station,), from one end to the other.

    What follows from the arrays is computed once, so they are to be read only.

    Raises:
        InvalidDesign: on creation, for arrays that do not fit each other or are not finite.
    """

    x: np.ndarray
    """Position [m]."""
    y: np.ndarray
    """Position [m]."""
    heading: np.ndarray
    """Angle of the midline's direction, continuous along it [rad]."""
    half_width: np.ndarray
    """Half of the thickness across the midline [m]."""
    x_rate: np.ndarray
    """Velocity [m/s]."""
    y_rate: np.ndarray
    """Velocity [m/s]."""
    heading_rate: np.ndarray
    """Rate of the heading [rad/s]."""
    half_width_rate: np.ndarray | None = None
    """Rate of the half-width, or None if it is constant [m/s]."""

    def __post_init__(self) -> None:
        """Refuse arrays that do not fit each other, are not finite, or have a negative half-width."""
        for name in _STATE_NAMES:
            values = getattr(self, name)
            if not isinstance(values, np.ndarray) and (values is not None or name != "half_width_rate"):
                raise InvalidDesign(f"{name} of the midline is {show(values)}; give an array of numbers.")
        if self.x.ndim != 1 or self.x.size < 3:
            raise InvalidDesign(f"the midline has shape {self.x.shape}; give at least 3 stations in one row.")
        total, shape = 0.0, self.x.shape
        for name in _STATE_NAMES:
            values = getattr(self, name)
            if values is None:
                continue
            if values.shape != shape:
                raise InvalidDesign(f"{name} of the midline has shape {values.shape}; x has {shape}.")
            total += np.add.reduce(values)
        if not isfinite(total):
            self._refuse_non_finite()
        if (self.half_width < 0).any():
            raise InvalidDesign(
                f"half_width of the midline goes down to {self.half_width.min():.4g} m; it is never negative."
            )

    def _refuse_non_finite(self) -> None:
        """Refuse numbers that are not finite.

        Raises:
            InvalidDesign: naming the first of them.
        """
        for name in _STATE_NAMES:
            values = getattr(self, name)
            if values is not None and not np.isfinite(values).all():
                raise InvalidDesign(f"{name} of the midline is not finite at station {np.argmin(np.isfinite(values))}.")

    @cached_property
    def rows(self) -> np.ndarray:
        """The stations for the kernels, shape (7, station)."""
        rows = [self.x, self.y, self.heading, self.half_width, self.x_rate, self.y_rate, self.heading_rate]
        return np.array(rows, np.float64)  # np.stack takes four times as long

    @property
    def half_width_rates(self) -> np.ndarray:
        """Rate of the half-width, zero if it is constant [m/s]."""
        return np.zeros(self.x.size) if self.half_width_rate is None else self.half_width_rate.astype(np.float64)

    @cached_property
    def mass(self) -> Mass:
        """Area, centre and moments of the body in the plane, section by section."""
        return of_midline(self.rows)

    @cached_property
    def arc(self) -> np.ndarray:
        """Arc length from the first station, shape (station,) [m]."""
        return np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(self.x), np.diff(self.y)))])

    def thickened(self, min_half_width: float) -> "MidlineState":
        """Return the midline with half-widths of at least ``least`` and round ends.

        A tail that tapers to nothing is thinner than any grid, and its force is noisy. The solver never thickens a
        body by itself. With 1.75 cells the smoothing kernel fits between the two surfaces.

        Args:
            min_half_width: smallest half-width [m].
        """
        inward = np.minimum(self.arc, self.arc[-1] - self.arc)
        cap = np.sqrt(np.maximum(min_half_width**2 - np.maximum(min_half_width - inward, 0.0) ** 2, 0.0))
        return replace(self, half_width=np.maximum(self.half_width, cap))

    def in_world(self, pose: Pose) -> "MidlineState":
        """Return the midline in the world."""
        x, y = pose.to_world((self.x, self.y))
        vx, vy = pose.rotate((self.x_rate, self.y_rate))
        cx, cy = pose.velocity_at((x, y))
        return _with(
            self, x=x, y=y, heading=self.heading + pose.angle, x_rate=vx + cx, y_rate=vy + cy,
            heading_rate=self.heading_rate + pose.spin,
        )  # fmt: skip


MAX_PARTS = 64
"""Parts that a body may be divided into [-]; those of all bodies are counted in one byte."""


def check_cuts(cuts: tuple[float, ...]) -> None:
    """Refuse cuts that divide nothing.

    Args:
        cuts: arc lengths along a midline at which a body is divided [m].

    Raises:
        InvalidDesign: they do not rise from 0, or are too many.
    """
    if not all(isfinite(arc) for arc in cuts) or (np.diff((0.0, *cuts)) <= 0).any():
        raise InvalidDesign(f"the cuts of a midline are at {cuts} m; give rising arc lengths above 0.")
    if len(cuts) >= MAX_PARTS:
        raise InvalidDesign(f"a midline has {len(cuts)} cuts; up to {MAX_PARTS - 1} are allowed.")


_STATE_NAMES = tuple(field.name for field in fields(MidlineState))


def check_state(state: object, time: float) -> MidlineState:
    """Return what a body's spine gave at a time [s].

    Raises:
        InvalidDesign: it is no ``MidlineState``.
    """
    if not isinstance(state, MidlineState):
        raise InvalidDesign(
            f"the spine of a midline gives {show(state)} at t = {time:.4g} s; it returns a MidlineState, with "
            f"position, heading, half-width and their rates."
        )
    return state


def _with(state: MidlineState, **arrays: np.ndarray) -> MidlineState:
    """Return a state with other arrays; it is not checked again, which takes longer than to make it."""
    result = object.__new__(type(state))  # copy.copy takes four times as long
    for name in _STATE_NAMES:
        object.__setattr__(result, name, arrays.get(name, getattr(state, name)))
    return result


def _copy_of(state: MidlineState) -> MidlineState:
    """Return a copy of a state, with arrays of its own."""
    named = {name: getattr(state, name) for name in _STATE_NAMES}
    return _with(state, **{name: values.copy() for name, values in named.items() if values is not None})


class CachedMidline:
    """A midline over time that caches its last states: a step needs the midline at the same times often."""

    MAX_CACHED_TIMES = 4
    """Number of times that are cached [-]."""

    def __init__(self, spine: Callable[[float], MidlineState]) -> None:
        self._spine, self._states = spine, dict[float, MidlineState]()
        self._world_state: tuple[float, Pose, MidlineState] | None = None

    def __call__(self, time: float) -> MidlineState:
        """Return the midline at a time [s]; its arrays are copies."""
        if time not in self._states:
            state = _copy_of(check_state(self._spine(time), time))
            if len(self._states) == self.MAX_CACHED_TIMES:
                del self._states[next(iter(self._states))]
            self._states[time] = state
        return self._states[time]

    def in_world(self, time: float, pose: Pose) -> MidlineState:
        """Return the midline at a time [s] in the world; its arrays are to be read only."""
        if self._world_state is None or self._world_state[:2] != (time, pose):
            self._world_state = time, pose, self(time).in_world(pose)
        return self._world_state[2]

    def clear(self) -> None:
        """Clear the cache, because the body has changed."""
        self._states.clear()
        self._world_state = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Spined(Shape):
    """A body along a midline, in the plane or in space: its cross-sections stay straight and square to the midline."""

    spine: Callable[[float], MidlineState]
    """The midline at every time [s]."""
    deforms: bool = True
    """Whether the midline changes with time; False saves work."""
    cuts: tuple[float, ...] = ()
    """Arc lengths, from the first station, at which the body is divided into the parts of ``Record.part_series``
    [m]."""

    def __post_init__(self) -> None:
        """Refuse cuts that divide nothing."""
        check_cuts(self.cuts)

    @property
    def rigid(self) -> bool:
        """Whether the shape never changes."""
        return not self.deforms

    @property
    def parts(self) -> int:
        """Parts that the cuts leave [-]."""
        return len(self.cuts) + 1

    @abstractmethod
    def position_at(self, time: float, pose: Pose, arc: np.ndarray) -> np.ndarray:
        """Return where the midline is at arc lengths, in the world, shape (point, axis) [m].

        Args:
            time: time [s].
            pose: pose of the body's frame.
            arc: arc lengths of the points [m].
        """


@dataclass(frozen=True, slots=True, kw_only=True)
class Midline(Spined):
    """A body in the plane that bends."""

    def _world_midline(self, time: float, pose: Pose) -> MidlineState:
        """Return the midline at a time in the world."""
        spine = self.spine
        return spine.in_world(time, pose) if isinstance(spine, CachedMidline) else spine(time).in_world(pose)

    def measure(self, points: Axes, time: float, pose: Pose, reach: float) -> Field:
        """Return the field on the points of a window."""
        (x, y), midline = points, self._world_midline(time, pose)
        h = (x[-1] - x[0]) / (x.size - 1)
        fields = paint(midline.rows, midline.half_width_rates, x[0], y[0], h, x.size, y.size, float(reach))
        field = Field(fields[0], (fields[1], fields[2]), (fields[3], fields[4]), fields[5])
        if self.cuts:
            field.part_index = self._nearest_parts(midline, x, y, field.distance < reach)
        return field

    def _nearest_parts(self, midline: MidlineState, x: np.ndarray, y: np.ndarray, is_near: np.ndarray) -> np.ndarray:
        """Return the part whose section passes through each point of a window near the body; 0 elsewhere.

        Args:
            midline: midline in the world.
            x: coordinates of the window's columns [m].
            y: coordinates of the window's rows [m].
            is_near: which points are in or near the body, shape (y, x).
        """
        rows, columns = np.nonzero(is_near)
        px, py = x[columns], y[rows]
        from scipy.spatial import KDTree  # noqa: PLC0415  a fifth of the time of an import of flow

        k = KDTree(np.column_stack([midline.x, midline.y])).query(np.column_stack([px, py]))[1]
        heading = midline.heading[k]
        axial_offset = (px - midline.x[k]) * np.cos(heading) + (py - midline.y[k]) * np.sin(heading)
        part_index = np.zeros(is_near.shape)
        part_index[rows, columns] = np.searchsorted(self.cuts, midline.arc[k] + axial_offset, side="right")
        return part_index

    def position_at(self, time: float, pose: Pose, arc: np.ndarray) -> np.ndarray:
        """Return where the midline is at arc lengths, in the world, shape (point, 2) [m]; see ``Spined``."""
        midline = self._world_midline(time, pose)
        return np.column_stack([np.interp(arc, midline.arc, line) for line in (midline.x, midline.y)])

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return the middles of the outline's edges, long edges split."""
        midline = self._world_midline(time, pose)
        outline = ring(midline.rows)
        n, arc = midline.x.size, midline.arc
        station = np.concatenate([arc, arc[::-1]])
        nxt = np.roll(outline, -1, axis=1)
        length = np.hypot(*(nxt - outline))
        edge = np.flatnonzero(length > 1e-9 * arc[-1])
        parts = np.maximum(1, np.round(length[edge] / spacing)).astype(int)
        edge = np.repeat(edge, parts)
        count = np.repeat(parts, parts)
        fraction = (np.arange(count.size) - np.repeat(np.cumsum(parts) - parts, parts) + 0.5) / count
        point = outline[:, edge] * (1 - fraction) + nxt[:, edge] * fraction
        edge_vector = nxt[:, edge] - outline[:, edge]
        normal = np.array([edge_vector[1], -edge_vector[0]]) / length[edge]
        s = station[edge] * (1 - fraction) + np.roll(station, -1)[edge] * fraction
        side = np.where(edge < n - 1, -1.0, np.where((edge >= n) & (edge < 2 * n - 1), 1.0, 0.0))
        guess = np.where(edge < n, edge, 2 * n - 1 - edge)
        vx, vy, spin = section_motions(point, guess, midline.rows, midline.half_width_rates)
        part_index = np.searchsorted(self.cuts, s, side="right") if self.cuts else None
        return Markers(
            points=point, weight=length[edge] / count, velocities=np.array([vx, vy]), normals=normal, spins=spin[None],
            part_index=part_index, station=s, side=side,
        )  # fmt: skip

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the rectangle around the outline."""
        return box_around(ring(self._world_midline(time, pose).rows))

    def midsurface(self, time: float, pose: Pose) -> np.ndarray | None:
        """Return the midline without its round ends, where the half-width is larger than the distance to the tip."""
        midline = self._world_midline(time, pose)
        to_tip = np.minimum(midline.arc, midline.arc[-1] - midline.arc)
        slender_stations = np.flatnonzero(midline.half_width < to_tip)
        if slender_stations.size < 2:
            return None
        return pieces_of_line(np.array([midline.x, midline.y])[:, slender_stations[0] : slender_stations[-1] + 1])

    def mass(self, time: float) -> Mass:
        """Return area, centre and moments, section by section."""
        return self.spine(time).mass

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return arc length and thickness at the stations."""
        spine = self.spine(time)
        return spine.arc, 2 * spine.half_width


def foil(
    chord: float, *, thickness: float, camber: float = 0.0, camber_at: float = 0.4, stations: int = 201
) -> Midline:
    """Return a NACA four-digit foil, its nose at the origin and its chord along +x.

    Args:
        chord: length of the chord [m].
        thickness: largest thickness over chord, 0.12 for NACA 0012 [-].
        camber: largest camber over chord [-].
        camber_at: where the camber is largest, over chord [-].
        stations: points along the midline [-].

    Raises:
        InvalidDesign: a length or share outside its range.

    Source: Jacobs, Ward and Pinkerton 1933, NACA Report 460 (closed trailing edge).
    """
    check_positive("chord", chord)
    if not (0 < thickness < 0.5 and 0 <= camber < 0.2 and 0 < camber_at < 1):
        raise InvalidDesign(
            f"a foil of thickness {thickness}, camber {camber} at {camber_at} is outside 0 to 0.5, 0 to 0.2, 0 to 1."
        )
    x = 0.5 * (1 - np.cos(np.linspace(0, np.pi, stations)))
    half = 5 * thickness * (0.2969 * np.sqrt(x) - 0.1260 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
    p = camber_at
    front = x < p
    y = camber * np.where(front, (2 * p * x - x**2) / p**2, (1 - 2 * p + 2 * p * x - x**2) / (1 - p) ** 2)
    slope = camber * np.where(front, 2 * (p - x) / p**2, 2 * (p - x) / (1 - p) ** 2)
    zero = np.zeros(stations)
    spine = MidlineState(
        x=chord * x, y=chord * y, heading=np.arctan(slope), half_width=chord * np.maximum(half, 0),
        x_rate=zero, y_rate=zero, heading_rate=zero,
    )  # fmt: skip
    return Midline(spine=lambda _: spine, deforms=False)
