"""Boundary values: fills the cells around the domain from the conditions on its sides, in flow units.

Each side is seen with its normal first: ``normal[k]`` and ``tangent[k]`` are lines parallel to the side, so every
kind of side is written once.
"""

from dataclasses import dataclass, field
from math import prod

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.core.kinds import show
from suchus.flow.compiled import PAD, Window, compiled, kernel_part, unsigned
from suchus.flow.farfield import Fading, FarField, OpenWater, fade_length
from suchus.flow.grid import Grid
from suchus.flow.pose import length
from suchus.flow.sides import NAMES, Periodic, Side, Sides, Stream

BALANCE_TOLERANCE = 1e-6
"""Largest net inflow, over the flow through all sides: the rounding error of single precision [-]."""

NEAR_SIDE_RATIO = 0.2
"""Distance of an unbounded side from the window around the bodies, over the window's size along the side, below which
corrections of the side are relaxed [-]."""

MIN_SIDE_RELAXATION = 0.5
"""Fraction of each correction that a side beside the window takes at once [-]; at ``NEAR_SIDE_RATIO`` it is 1."""

MIN_FADE_CHANGE = 0.05
"""Smallest change in a step, as long as any is needed, of the length over which a wake is faded [cells].

What fades acts on the bodies at once. A length that jumps with the cells that a body covers gives their force peaks."""

FADE_CHANGE_RATIO = 1 / 16
"""The change in a step over the change that is needed, where that is more [-]."""

_CHANGING = {"prescribed": "prescribed", "induced": "induced", "seen": "previous_induced"}
"""Arrays of an edge that change, by their key in a checkpoint."""

_MIRRORED, _PRESCRIBED, _FREE_OF_VORTICITY, _ZERO_GRADIENT, _REPEATED = range(5)
"""Conditions for the velocity along a side beyond it: mirrored about a value, that value, no vorticity, no gradient,
and the values at the other end of a periodic axis, which the velocity across the side has too."""


@kernel_part
def _fill_side(n, t, face, inner, step, prescribed, straight, condition, value):  # type: ignore[no-untyped-def]
    """Write the velocity on a side and in the two lines of cells beyond it.

    Args:
        n: velocity along the normal, normal index first.
        t: velocity along the side, normal index first.
        face: line of the side's faces.
        inner: line of the cells inside the side.
        step: 1 at the low end of the axis and -1 at the high end.
        prescribed: velocity into the domain on the side's faces [m/s].
        straight: whether the normal velocity continues linearly beyond the side; else it stays the same.
        condition: ``_MIRRORED``, ``_PRESCRIBED``, ``_FREE_OF_VORTICITY`` or ``_ZERO_GRADIENT``.
        value: velocity along the side that the first two conditions take [m/s].
    """
    two, sign, width = n.dtype.type(2), n.dtype.type(step), n.shape[1]
    for i in range(PAD, width - PAD):
        n[face, i] = sign * prescribed[i - PAD]
    for k in range(1, 3 if step > 0 else 2):
        for i in range(width):
            n[face - k * step, i] = two * n[face, i] - n[face + step, i] if straight else n[face, i]
    for k in range(1, 3):
        ghost, source = inner - k * step, inner - (k - 1) * step
        for i in range(width):
            if condition == _MIRRORED:
                t[ghost, i] = two * value - t[source, i]
            elif condition == _PRESCRIBED:
                t[ghost, i] = value
            elif condition == _FREE_OF_VORTICITY and PAD < i < width - PAD:
                t[ghost, i] = t[source, i] - sign * (n[face, i] - n[face, i - 1])
            else:
                t[ghost, i] = t[source, i]


@kernel_part
def _repeat_lines(n, t, face, step, cells):  # type: ignore[no-untyped-def]
    """Write the lines beyond a periodic side, which are those at the other end of the axis.

    Args:
        n: velocity along the normal, normal index first.
        t: velocity along the side, normal index first.
        face: line of the side's faces.
        step: 1 at the low end of the axis and -1 at the high end.
        cells: cells along the normal.
    """
    for k in range(1, PAD + 1):
        ghost = face - k if step > 0 else face + k - 1
        source = ghost + step * cells
        for i in range(n.shape[1]):
            n[ghost, i] = n[source, i]
            t[ghost, i] = t[source, i]


@compiled
def _fill_plane(velocity, sides, values, prescribed):  # type: ignore[no-untyped-def]
    """Write the velocity on all sides of a plane domain and in the two lines of cells beyond each.

    Args:
        velocity: velocity on the faces before the cells, padded, shape (2, y, x) [m/s].
        sides: rows of ``Border.side_table``, shape (side, 8).
        values: velocity along each side that its condition takes, shape (side,) [m/s].
        prescribed: velocity into the domain on the faces of all sides, end to end [m/s].
    """
    for k in range(sides.shape[0]):
        axis, face, inner, step, cells, start, straight, condition = (
            sides[k, 0], sides[k, 1], sides[k, 2], sides[k, 3], sides[k, 4], sides[k, 5], sides[k, 6] > 0, sides[k, 7]
        )  # fmt: skip
        stop = start + velocity.shape[1 + axis] - 2 * PAD
        if condition == _REPEATED:
            if axis == 0:
                _repeat_lines(velocity[0].T, velocity[1].T, face, step, cells)
            else:
                _repeat_lines(velocity[1], velocity[0], face, step, cells)
        elif axis == 0:
            _fill_side(
                velocity[0].T, velocity[1].T, face, inner, step, prescribed[start:stop], straight, condition, values[k]
            )
        else:
            _fill_side(
                velocity[1], velocity[0], face, inner, step, prescribed[start:stop], straight, condition, values[k]
            )


@kernel_part
def _mirror_row(a, ghost, boundary, source, stride, count, straight):  # type: ignore[no-untyped-def]
    """Write a row of the normal velocity beyond a side: its linear continuation, or the values on the side.

    Args:
        a: the component, its cells end to end.
        ghost: index of the row's first cell.
        boundary: the same of the row on the side.
        source: the same of the mirror image inside.
        stride: distance of neighbours in the row.
        count: cells of the row.
        straight: whether the velocity continues linearly.
    """
    two = a.dtype.type(2)
    ghost = unsigned(ghost)
    boundary = unsigned(boundary)
    source = unsigned(source)
    stride = unsigned(stride)
    for i in range(unsigned(count)):
        a[ghost + i * stride] = (
            two * a[boundary + i * stride] - a[source + i * stride] if straight else a[boundary + i * stride]
        )


@kernel_part
def _fill_row(a, ghost, source, stride, count, condition, value):  # type: ignore[no-untyped-def]
    """Write a row of a velocity along a side beyond it from that inside it.

    Args:
        a: the component, its cells end to end.
        ghost: index of the row's first cell.
        source: the same of the row inside.
        stride: distance of neighbours in the row.
        count: cells of the row.
        condition: see ``_fill_side``.
        value: see ``_fill_side`` [m/s].
    """
    times, plus = a.dtype.type(-1 if condition == _MIRRORED else condition != _PRESCRIBED), value
    plus = plus + plus if condition == _MIRRORED else plus if condition == _PRESCRIBED else a.dtype.type(0)
    ghost, source, stride = unsigned(ghost), unsigned(source), unsigned(stride)
    for i in range(unsigned(count)):
        a[ghost + i * stride] = plus + times * a[source + i * stride]


@kernel_part
def _free_of_vorticity(a, ghost, n, boundary, previous, stride, start, stop, sign):  # type: ignore[no-untyped-def]
    """Add to a row beyond a side the difference of the normal velocity along the side, so that there is no vorticity.

    Args:
        a: component along the side, its cells end to end.
        ghost: index of the row's first cell.
        n: normal component, its cells end to end.
        boundary: index of the first normal velocity on the side.
        previous: index of its neighbour along the side.
        stride: distance of neighbours in the row.
        start: first cell of the row that is written.
        stop: the cell after the last.
        sign: 1 at the low end of the normal's axis and -1 at the high end.
    """
    ghost, boundary, previous, stride = unsigned(ghost), unsigned(boundary), unsigned(previous), unsigned(stride)
    for i in range(unsigned(start), unsigned(stop)):
        a[ghost + i * stride] -= sign * (n[boundary + i * stride] - n[previous + i * stride])


@compiled
def _fill_planes(velocity, axis, strides, face, inner, step, prescribed, straight, condition, values):  # type: ignore[no-untyped-def]
    """Write the velocity on a side in space and in the two planes beyond it, as ``_fill_side`` does in the plane.

    Args:
        velocity: components, each with its cells end to end.
        axis: axis of the normal.
        strides: distance of neighbours along the normal and along the side's axes, the last axis of the side first.
        face: plane of the side's faces.
        inner: plane of the cells inside the side.
        step: 1 at the low end of the axis and -1 at the high end.
        prescribed: velocity into the domain on the side's faces [m/s].
        straight: see ``_fill_side``.
        condition: see ``_fill_side``.
        values: see ``_fill_side``; one for each velocity along the side, in the order of the axes [m/s].
    """
    n, (normal_stride, row_stride, stride), sign = velocity[axis], strides, velocity.dtype.type(step)
    height, count = prescribed.shape[0] + 2 * PAD, prescribed.shape[1] + 2 * PAD
    for j in range(height):
        boundary = face * normal_stride + j * row_stride
        if PAD <= j < height - PAD:
            for i in range(count - 2 * PAD):
                n[boundary + (i + PAD) * stride] = sign * prescribed[j - PAD, i]
        for k in range(1, 3 if step > 0 else 2):
            ghost_offset = k * step * normal_stride
            _mirror_row(n, boundary - ghost_offset, boundary, boundary + ghost_offset, stride, count, straight)
        for k in range(1, 3):
            ghost = (inner - k * step) * normal_stride + j * row_stride
            is_vorticity_free = condition == _FREE_OF_VORTICITY
            source = (
                ghost + step * normal_stride
                if is_vorticity_free
                else (inner + (k - 1) * step) * normal_stride + j * row_stride
            )
            for c in range(2):
                t, face_row = velocity[c + (c >= axis)], boundary - (k - 1) * step * normal_stride
                _fill_row(t, ghost, source, stride, count, condition, values[c])
                if is_vorticity_free and PAD + c <= j < height - PAD:
                    _free_of_vorticity(
                        t, ghost, n, face_row, face_row - (row_stride if c else stride), stride, PAD + 1 - c,
                        count - PAD, sign,
                    )  # fmt: skip


@kernel_part
def _balance(prescribed, places, fractions):  # type: ignore[no-untyped-def]
    """Change the velocities on the open sides so that as much water leaves as enters.

    Args:
        prescribed: velocity into the domain on the faces of all sides, end to end, changed [m/s].
        places: rows of ``Border.places``; of a periodic side nothing counts.
        fractions: fraction of the difference that each face of a side takes [-].
    """
    net, open_area = 0.0, 0.0
    for e in range(places.shape[0]):
        if places[e, 2]:
            for k in range(places[e, 0], places[e, 1]):
                net += np.float64(prescribed[k])
            open_area += (places[e, 1] - places[e, 0]) * fractions[e]
    if open_area > 0.0:
        for e in range(places.shape[0]):
            loss = prescribed.dtype.type(fractions[e] * net / open_area)
            if fractions[e] > 0.0:
                for k in range(places[e, 0], places[e, 1]):
                    prescribed[k] -= loss


@compiled
def _predict(prescribed, induced, previous_induced, velocity, places, inflows, fractions, growth, dt):  # type: ignore[no-untyped-def]
    """Write the velocities on all open sides at the end of a step from the fields at its start; see ``Border.prepare``.

    Args:
        prescribed: velocity into the domain on the faces of all sides, end to end, to write to [m/s].
        induced: velocity that the flow induces there, changed to that of the step's end [m/s].
        previous_induced: the same one step earlier, changed to that of the step's start [m/s].
        velocity: components at the start of the step, each with its cells end to end [m/s].
        places: rows of ``Border.places``.
        inflows: velocity of the stream into the domain [m/s], weight of the convective condition [-], and rise of the
            stream through the side since the last step [m/s], shape (side, 3).
        fractions: see ``_balance``.
        growth: length of the step over that of the last one; 0 in the first step [-].
        dt: length of the step [cells per (m/s)].
    """
    for e in range(places.shape[0]):
        start, component, face, inner_face, row_stride, stride = (
            places[e, 0], places[e, 4], places[e, 6], places[e, 7], places[e, 8], places[e, 9]
        )  # fmt: skip
        columns, sign, stream, weight, rise = (
            places[e, 10], velocity.dtype.type(places[e, 5]), inflows[e, 0], inflows[e, 1], inflows[e, 2]
        )  # fmt: skip
        courant, count = velocity.dtype.type(0.0), places[e, 1] - start
        if places[e, 3] and weight > 0.0:
            total = 0.0
            for k in range(count):
                total += np.float64(sign * velocity[component, face + k // columns * row_stride + k % columns * stride])
            courant = velocity.dtype.type(min(max(-total / count, 0.0) * dt, 1.0))
        for k in range(count):
            change = growth * (induced[start + k] - previous_induced[start + k])
            if places[e, 3]:
                inflow = stream + induced[start + k] + change
                if weight > 0.0:
                    offset = k // columns * row_stride + k % columns * stride
                    side_velocity, inner_velocity = (
                        sign * velocity[component, face + offset],
                        sign * velocity[component, inner_face + offset],
                    )
                    outflow = side_velocity - courant * (side_velocity - inner_velocity)
                    inflow = weight * (outflow + (rise + change)) + (1.0 - weight) * inflow
                prescribed[start + k] = inflow
            previous_induced[start + k] = induced[start + k]
            induced[start + k] += change
    _balance(prescribed, places, fractions)


@compiled
def _correct(prescribed, induced, target, places, fractions, relaxation):  # type: ignore[no-untyped-def]
    """Move the induced velocities towards those of the fields; return the largest change [m/s].

    Args:
        prescribed: velocity into the domain on the faces of all sides, end to end, changed [m/s].
        induced: velocity that the flow induces there, changed [m/s].
        target: the same by the present fields [m/s].
        places: rows of ``Border.places``.
        fractions: see ``_balance``.
        relaxation: fraction of the difference that is corrected [-].
    """
    max_rise = 0.0
    for k in range(induced.size):
        rise = relaxation * (target[k] - induced[k])
        prescribed[k] += prescribed.dtype.type(rise)
        induced[k] += rise
        max_rise = max(max_rise, abs(rise))
    _balance(prescribed, places, fractions)
    return max_rise


def _are_numbers(values: np.ndarray, shape: tuple[int, ...]) -> bool:
    """Return whether an array is one finite number, or has a shape and holds finite numbers."""
    return values.shape in ((), shape) and values.dtype.kind in "iuf" and bool(np.isfinite(values).all())


@dataclass(slots=True)
class Edge:
    """One side of the domain during a run."""

    name: str
    """Name of the side; see ``sides.NAMES``."""
    side: Side
    """Kind of the side."""
    axis: int
    """Axis of the normal: 0 is x, 1 is y, 2 is z."""
    is_lower_side: bool
    """Whether the side is at the smallest coordinate."""
    cells: int
    """Cells along the normal [-]."""
    face_coordinates: list[np.ndarray]
    """Coordinates of the side's faces along it, in the order of the axes, shapes of ``prescribed`` [m]."""
    prescribed: np.ndarray
    """Velocity into the domain on the side's faces, the last axis first [m/s]."""
    unbounded: bool
    """Whether the side is one of an unbounded domain."""
    convective_weight: float = 0.0
    """Weight of the convective outflow condition in this step; the rest of the velocity follows the far water [-]."""
    wall_velocity: tuple[float, ...] | None = None
    """Velocity of the wall along the other axes, for a side with friction; else None [m/s]."""
    fade_length: float = 0.0
    """Length over which a wake is faded before it leaves here; 0 before one can leave [cells]."""
    induced: np.ndarray = field(init=False)
    """Velocity into the domain that the flow inside induces on the side, at the end of the last step [m/s]."""
    previous_induced: np.ndarray = field(init=False)
    """The same one step earlier [m/s]."""
    order: tuple[int, ...] = field(init=False)
    """Axes of an array of the padded grid, that across the side first [-]."""

    def __post_init__(self) -> None:
        self.induced, self.previous_induced = np.zeros(self.prescribed.shape), np.zeros(self.prescribed.shape)
        normal_axis = self.prescribed.ndim - self.axis
        self.order = (normal_axis, *(k for k in range(1 + self.prescribed.ndim) if k != normal_axis))

    @property
    def sign(self) -> int:
        """+1 if the inward normal points along the axis, else -1."""
        return 1 if self.is_lower_side else -1

    @property
    def face(self) -> int:
        """Index of the side's faces along the normal."""
        return PAD if self.is_lower_side else PAD + self.cells

    @property
    def domain_slices(self) -> tuple[slice, ...]:
        """The part of a plane or line parallel to the side that lies in the domain."""
        return (slice(PAD, -PAD),) * self.prescribed.ndim

    def normal(self, velocity: np.ndarray) -> np.ndarray:
        """Return the velocity along the normal, normal index first."""
        return self.with_normal_first(velocity[self.axis])

    def with_normal_first(self, a: np.ndarray) -> np.ndarray:
        """Return an array of the padded grid with the normal index first."""
        return a.transpose(self.order)  # np.moveaxis takes ten times as long

    def side_velocities(self, time: float) -> tuple[tuple[float, ...] | None, np.ndarray | None]:
        """Return the velocity of the wall along the side and the velocity of the water through it, at a time [s].

        The first is None without friction, the second is None where the side prescribes none [m/s].

        Raises:
            InvalidDesign: the side gives something that is no velocity.
        """
        slides, inflow = self.side.wall_velocity(time, 1 + self.prescribed.ndim), None
        side_text = f"the {self.name} side, a {type(self.side).__name__},"
        if slides is not None and not (np.shape(slides) == (self.prescribed.ndim,) and np.isfinite(slides).all()):
            raise InvalidDesign(
                f"at t = {time:.4g} s {side_text} moves along itself at {show(slides)} m/s; wall_velocity() gives "
                f"one finite number for each other axis, or None."
            )
        if self.side.is_permeable and not self.side.is_open:
            inflow = np.asarray(self.side.inflow_velocity(time, *self.face_coordinates))
            if not _are_numbers(inflow, self.prescribed.shape):
                raise InvalidDesign(
                    f"at t = {time:.4g} s velocities into the domain through {side_text} are {show(inflow)}; "
                    f"inflow_velocity() gives one finite number [m/s], or as many as there are places, shape "
                    f"{self.prescribed.shape}."
                )
        return slides, inflow

    def shorten_fade(self, window: Window) -> None:
        """Shorten the length over which a wake is faded, by little in a step, where the bodies ask for a shorter one.

        Args:
            window: padded cell indices around the bodies in the plane.
        """
        target = fade_length(window, self.axis, is_lower_side=self.is_lower_side, cells=self.cells)
        if self.fade_length == 0.0:
            self.fade_length = target
        elif target < self.fade_length:
            change = max(MIN_FADE_CHANGE, FADE_CHANGE_RATIO * (self.fade_length - target))
            self.fade_length = max(target, self.fade_length - change)

    def impose(self, time: float, outward: float) -> None:
        """Set the velocities that the side prescribes at a time.

        Args:
            time: time [s].
            outward: component of the far stream along the outward normal, over its speed [-].
        """
        self.convective_weight = self.side.outflow_fraction(outward)
        self.wall_velocity, inflow = self.side_velocities(time)
        if inflow is not None:
            self.prescribed[:] = inflow

    def fastest(self, time: float) -> float:
        """Return the fastest speed that the side itself imposes at a time [m/s]."""
        slides, inflow = self.side_velocities(time)
        return max(0.0 if slides is None else length(slides), 0.0 if inflow is None else float(np.abs(inflow).max()))

    @property
    def inner(self) -> int:
        """Index of the cells inside the side along the normal."""
        return PAD if self.is_lower_side else PAD + self.cells - 1

    @property
    def is_straight(self) -> bool:
        """Whether the velocity along the normal continues linearly beyond the side; else it stays the same."""
        return not self.side.is_permeable or (self.unbounded and not self.convective_weight)

    def table_row(self, start: int, stream: tuple[float, ...]) -> tuple[tuple[int, ...], float]:
        """Return the row of ``Border.side_table`` of a side in the plane, and the value of its condition [m/s].

        Args:
            start: index of its first face among those of all sides.
            stream: velocity of the far water [m/s].
        """
        condition, value = _REPEATED, 0.0
        if not isinstance(self.side, Periodic):
            condition, value = self._tangential_condition(0, 1 - self.axis, self.sign, stream)
        row = self.axis, self.face, self.inner, self.sign, self.cells, start, int(self.is_straight), condition
        return row, value

    def fill_in_space(self, velocity: np.ndarray, stream: tuple[float, ...]) -> None:
        """Write this side's values to the cells and faces around a domain in space.

        Args:
            velocity: velocity on the faces before the cells, padded, shape (3, z, y, x) [m/s].
            stream: velocity of the far water [m/s].
        """
        f, step = self.face, self.sign
        tangential_axes = [d for d in range(3) if d != self.axis]
        if isinstance(self.side, Periodic):
            lines = [self.with_normal_first(velocity[d]) for d in (self.axis, *tangential_axes)]
            for k in range(1, PAD + 1):
                ghost, source = (
                    (f - k, f - k + self.cells) if self.is_lower_side else (f + k - 1, f + k - 1 - self.cells)
                )
                for a in lines:
                    a[ghost] = a[source]
            return
        condition, value = self._tangential_condition(0, tangential_axes[0], step, stream)
        values = tuple(
            velocity.dtype.type(tangential_value)
            for tangential_value in (value, self._tangential_condition(1, tangential_axes[1], step, stream)[1])
        )
        line, plane = velocity.shape[3], velocity.shape[2] * velocity.shape[3]
        strides = ((1, plane, line), (line, plane, 1), (plane, line, 1))[self.axis]
        flat = velocity.reshape(3, -1)
        _fill_planes(
            flat, self.axis, strides, f, self.inner, step, self.prescribed, self.is_straight, condition, values
        )

    def _tangential_condition(self, k: int, axis: int, step: int, stream: tuple[float, ...]) -> tuple[int, float]:
        """Return the condition for the velocity along the side, and its value [m/s]; the condition holds for all axes.

        Args:
            k: which of the side's own axes, counted from 0.
            axis: the same axis, counted among all: 0 is x, 1 is y, 2 is z.
            step: 1 at the low end of the normal's axis and -1 at the high end.
            stream: velocity of the far water [m/s].
        """
        if self.wall_velocity is not None:
            return _MIRRORED, self.wall_velocity[k]
        if self.unbounded and not self.convective_weight:
            return _FREE_OF_VORTICITY, 0.0
        if isinstance(self.side, Stream) and step * stream[self.axis] > 0:
            return _PRESCRIBED, stream[axis]
        return _ZERO_GRADIENT, 0.0


@dataclass(slots=True)
class Border:
    """The sides during a run; call ``prepare`` once a step and ``fill`` whenever the velocity changed."""

    edges: list[Edge]
    """Left, right, bottom, top, and in space low and high; without those at which the domain does not end."""
    water: OpenWater | FarField | None
    """The water around the domain, if it has no end."""
    stream: tuple[float, ...] = (0.0, 0.0)
    """Velocity of the far water at the end of the step [m/s]."""
    steps: int = 0
    """Steps prepared so far [-]."""
    last_step: float = 0.0
    """Length of the last step [cells per (m/s)]."""
    prescribed: np.ndarray = field(init=False)
    """Velocity into the domain on the faces of all sides, end to end, of which each side has a view [m/s]."""
    induced: np.ndarray = field(init=False)
    """``Edge.induced`` of all sides, in the same way [m/s]."""
    previous_induced: np.ndarray = field(init=False)
    """``Edge.previous_induced`` of all sides, in the same way [m/s]."""
    side_table: tuple[tuple[object, ...], np.ndarray, np.ndarray] | None = field(init=False, default=None)
    """What the conditions depend on; what ``_fill_plane`` needs of each side: axis, face, inner cells, step, cells,
    index of its first face, whether the normal velocity continues linearly, and the condition, shape (side, 8); and
    the conditions' values, shape (side,) [m/s]. None before they are known."""
    _places: np.ndarray | None = field(init=False, default=None)
    """Result of ``places``; None before it is known."""
    _fractions: tuple[list[float], np.ndarray] | None = field(init=False, default=None)
    """Convective weights of the sides, and the result of ``_balance_fractions`` for them."""
    _relaxed_window: Window = field(init=False, default=())
    """Window for which ``_relaxation`` was computed last."""
    _relaxation_factor: float = field(init=False, default=1.0)
    """Its result [-]."""

    def __post_init__(self) -> None:
        """Lay the faces of all sides end to end."""
        dtype = self.edges[0].prescribed.dtype if self.edges else np.dtype(np.float64)
        size = sum(edge.prescribed.size for edge in self.edges)
        self.prescribed, self.induced, self.previous_induced = np.zeros(size, dtype), np.zeros(size), np.zeros(size)
        start = 0
        for edge in self.edges:
            shape, stop = edge.prescribed.shape, start + edge.prescribed.size
            self.prescribed[start:stop] = edge.prescribed.ravel()
            edge.prescribed, edge.induced, edge.previous_induced = (
                faces[start:stop].reshape(shape) for faces in (self.prescribed, self.induced, self.previous_induced)
            )
            start = stop

    @classmethod
    def for_grid(cls, sides: Sides, grid: Grid, dtype: type) -> "Border":
        """Return the border of a grid."""
        edges, unbounded = [], sides.unbounded(grid.ndim)
        for k, (name, side) in enumerate(zip(NAMES, sides.of_axes(grid.ndim), strict=False)):
            axis = k // 2
            if not side.is_domain_end:
                continue
            prescribed: np.ndarray = np.zeros([n for d, n in enumerate(grid.cells) if d != axis][::-1], dtype)
            places = np.meshgrid(*(grid.centres(PAD, PAD + n, d) for d, n in enumerate(grid.cells) if d != axis))
            moves = unbounded and isinstance(side, Stream)
            edge = Edge(name, side, axis, name in NAMES[::2], grid.cells[axis], list(places), prescribed, moves)
            edge.impose(0.0, 0.0)
            edges.append(edge)
        water: OpenWater | FarField | None = None
        if unbounded:
            water = OpenWater.for_grid(grid) if grid.ndim == 2 else FarField(grid, sides.has_mirror(3))
        return cls(edges=edges, water=water, stream=(0.0,) * grid.ndim)

    def state(self) -> dict[str, np.ndarray]:
        """Return all that changes, by name."""
        edges = {
            f"edge{k}.{key}": getattr(e, name) for k, e in enumerate(self.edges) for key, name in _CHANGING.items()
        }
        fades = {"fade_lengths": np.array([e.fade_length for e in self.edges])}
        return {**edges, **fades, "stream": np.array(self.stream), "prepared": np.array([self.steps, self.last_step])}

    def resume(self, state: dict[str, np.ndarray]) -> None:
        """Set all that changes."""
        for k, edge in enumerate(self.edges):
            for key, name in _CHANGING.items():
                getattr(edge, name)[:] = state[f"edge{k}.{key}"]
        for edge, fade in zip(self.edges, state["fade_lengths"].tolist(), strict=True):
            edge.fade_length = fade
        self.stream, self.side_table = tuple(state["stream"].tolist()), None
        self.steps, self.last_step = int(state["prepared"][0]), float(state["prepared"][1])

    def wall_velocity(self, axis: int, *, is_low: bool) -> tuple[float, ...] | None:
        """Return the velocity of a wall along every axis, 0 across itself [m/s]; None without friction.

        Args:
            axis: axis across which the wall lies.
            is_low: whether it is at the low end of the axis.
        """
        edge = next(e for e in self.edges if e.axis == axis and e.is_lower_side == is_low)
        if edge.wall_velocity is None:
            return None
        return (*edge.wall_velocity[:axis], 0.0, *edge.wall_velocity[axis:])

    def fastest(self, time: float) -> float:
        """Return the fastest speed that a side itself imposes at a time, a wall or an inflow [m/s]."""
        return max((edge.fastest(time) for edge in self.edges), default=0.0)

    def prepare(
        self, velocity: np.ndarray, window: Window, dt: float, stream: tuple[float, ...], time: float = 0.0
    ) -> None:
        """Fix the velocity on all sides at the end of the step from the fields at its start.

        On return as much water leaves as enters.

        Args:
            velocity: velocity on the faces before the cells, padded, shape (axis, ...) [m/s].
            window: padded cell indices around the bodies.
            dt: length of the step [cells per (m/s)].
            stream: velocity of the far water at the end of the step [m/s].
            time: end of the step [s].

        Raises:
            InvalidDesign: a side says something that is no velocity, or water enters that cannot leave.
        """
        previous_stream, self.stream = self.stream, stream
        size = max(length(stream), 1e-30)
        for edge in self.edges:
            edge.impose(time, -edge.sign * stream[edge.axis] / size)
            if edge.convective_weight and isinstance(self.water, OpenWater):
                edge.shorten_fade(window)
        if self.steps == 0:
            self.induced[:] = self.previous_induced[:] = self._induced(velocity, window)
        growth = dt / self.last_step if self.last_step else 0.0
        inflows = np.array(
            [
                (
                    edge.sign * stream[edge.axis],
                    edge.convective_weight,
                    edge.sign * (stream[edge.axis] - previous_stream[edge.axis])
                    if isinstance(edge.side, Stream)
                    else 0.0,
                )
                for edge in self.edges
            ]
        )
        if self.edges:
            _predict(
                self.prescribed, self.induced, self.previous_induced, velocity.reshape(len(velocity), -1),
                self.places(velocity.shape[1:]), inflows, self._balance_fractions(), growth, dt,
            )  # fmt: skip
        self.steps, self.last_step = self.steps + 1, dt
        self._refuse_gain(time)

    def places(self, shape: tuple[int, ...]) -> np.ndarray:
        """Return where the faces of each side lie, shape (side, 11).

        The columns are: first face among those of all sides, the face after the last, whether the side is no periodic
        one, whether it is open, axis of the normal, sign of the inward normal, index in memory of the first face and of
        the face behind it inside, strides along the two axes of the side, and faces along the second axis.

        Args:
            shape: padded shape of the grid.
        """
        if self._places is None:
            strides, rows, start = [prod(shape[k + 1 :]) for k in range(len(shape))], [], 0
            for edge in self.edges:
                normal = len(shape) - 1 - edge.axis
                tangential = [k for k in range(len(shape)) if k != normal]
                offset = sum(PAD * strides[k] for k in tangential)
                stop = start + edge.prescribed.size
                rows.append(
                    (
                        start, stop, not isinstance(edge.side, Periodic), edge.side.is_open, edge.axis, edge.sign,
                        edge.face * strides[normal] + offset, (edge.face + edge.sign) * strides[normal] + offset,
                        strides[tangential[0]] if len(tangential) > 1 else 0, strides[tangential[-1]],
                        edge.prescribed.shape[-1],
                    )
                )  # fmt: skip
                start = stop
            self._places = np.array(rows, np.int64)
        return self._places

    def _balance_fractions(self) -> np.ndarray:
        """Return the fraction of a net inflow that each face of a side takes, shape (side,) [-].

        Sides that carry water out take the difference; without them the unbounded sides take it.
        """
        weights = [edge.convective_weight for edge in self.edges]
        if self._fractions is None or self._fractions[0] != weights:
            fractions = weights if any(weights) else [float(edge.unbounded) for edge in self.edges]
            self._fractions = weights, np.array(fractions)
        return self._fractions[1]

    def _refuse_gain(self, time: float) -> None:
        """Refuse a net flow through the sides where no side can balance it."""
        if any(e.convective_weight or e.unbounded for e in self.edges):
            return
        side_inflows = [e.prescribed for e in self.edges if not isinstance(e.side, Periodic)]
        net = sum(float(p.sum(dtype=np.float64)) for p in side_inflows)
        gross_flow = sum(float(np.abs(p).sum(dtype=np.float64)) for p in side_inflows)
        if abs(net) > BALANCE_TOLERANCE * gross_flow:
            side_names = ", ".join(e.name for e in self.edges if e.side.is_permeable)
            imbalance_text = "enters and cannot leave" if net > 0 else "leaves and none enters"
            raise InvalidDesign(
                f"at t = {time:.4g} s {100 * abs(net) / gross_flow:.3g} % of the water that passes the domain's sides "
                f"({side_names}) {imbalance_text}; make another side an Outflow()."
            )

    def update_induced(self, velocity: np.ndarray, window: Window) -> float:
        """Set the induced velocities from the fields at the end of the step; return the largest change [m/s].

        ``prepare`` could only extrapolate from the last steps. Without this update a cylinder in a domain of 4
        diameters that shakes once in 20 steps has 5 % less drag, and 23 % less with the last step's value alone.

        Args:
            velocity: velocity on the faces before the cells, padded, shape (axis, ...) [m/s].
            window: padded cell indices around the bodies.
        """
        if self.water is None:
            return 0.0
        change: float = _correct(
            self.prescribed, self.induced, self._induced(velocity, window), self.places(velocity.shape[1:]),
            self._balance_fractions(), self._relaxation(window),
        )  # fmt: skip
        if self.steps == 1:
            self.previous_induced[:] = self.induced
        return change

    def _relaxation(self, window: Window) -> float:
        """Return the fraction of a correction of the induced velocities that is made at once [-].

        What the sides do acts back on a body beside them, and through it on the sides. Nearer to a blunt body than half
        of its size the error grows from step to step, unless part of each correction is left out.

        Args:
            window: padded cell indices around the bodies.
        """
        if window[1] <= window[0]:
            return 1.0
        if self._relaxed_window == window:
            return self._relaxation_factor
        ndim, ratio = len(window) // 2, NEAR_SIDE_RATIO
        spans = [(window[2 * d] - PAD, window[2 * d + 1] - PAD) for d in reversed(range(ndim))]
        for edge in self.edges:
            if edge.unbounded:
                start, stop = spans[edge.axis]
                lateral = max(b - a for d, (a, b) in enumerate(spans) if d != edge.axis)
                ratio = min(ratio, max(start if edge.is_lower_side else edge.cells - stop, 0) / lateral)
        self._relaxed_window = window
        self._relaxation_factor = MIN_SIDE_RELAXATION + (1 - MIN_SIDE_RELAXATION) * ratio / NEAR_SIDE_RATIO
        return self._relaxation_factor

    def _induced(self, velocity: np.ndarray, window: Window) -> np.ndarray:
        """Return the velocity into the domain that the flow induces on the faces of all sides, end to end [m/s].

        Args:
            velocity: velocity on the faces before the cells, padded, shape (axis, ...) [m/s].
            window: padded cell indices around the bodies.
        """
        if self.water is None:
            return np.zeros(self.induced.size)
        fadings = [
            Fading(e.axis, e.is_lower_side, e.convective_weight, e.fade_length)
            for e in self.edges
            if e.convective_weight
        ]
        if isinstance(self.water, OpenWater):
            return self.water.inward_faces(velocity, window, fadings)
        return np.concatenate([side.ravel() for side in self.water.inward(velocity, window, fadings)])

    def fill(self, velocity: np.ndarray) -> None:
        """Write all boundary values around the domain."""
        if len(velocity) == 3:
            for edge in self.edges:
                edge.fill_in_space(velocity, self.stream)
            return
        if not self.edges:
            return
        key = self.stream, *[(edge.convective_weight, edge.wall_velocity) for edge in self.edges]
        if self.side_table is None or self.side_table[0] != key:
            starts = np.cumsum([0, *(edge.prescribed.size for edge in self.edges)]).tolist()
            rows = [edge.table_row(start, self.stream) for edge, start in zip(self.edges, starts, strict=False)]
            table = np.array([row for row, _ in rows], np.int64).reshape(-1, 8)
            self.side_table = key, table, np.array([value for _, value in rows], velocity.dtype)
        _, table, values = self.side_table
        _fill_plane(velocity, table, values, self.prescribed)
