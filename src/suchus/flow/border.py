"""Boundary values: fills the cells around the domain from what its sides say, in flow units.

Each side is seen with its normal first: ``normal[k]`` and ``tangent[k]`` are lines parallel to the side, so every
kind of side is written once.
"""

from dataclasses import dataclass, field

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.core.kinds import show
from suchus.flow.compiled import PAD, Window, compiled, part, unsigned
from suchus.flow.farfield import Fading, FarField, OpenWater
from suchus.flow.grid import Grid
from suchus.flow.pose import length
from suchus.flow.sides import NAMES, Periodic, Side, Sides, Stream

LOST = 1e-6
"""Share of the water that enters which may find no way out [-]: what rounding leaves in single precision."""

_MIRRORED, _GIVEN, _FREE_OF_VORTICITY, _AS_INSIDE = range(4)
"""What the velocity along a side is beyond it: mirrored about a value, that value, and so on."""


@compiled
def _fill_side(n, t, face, inner, step, prescribed, straight, how, value):  # type: ignore[no-untyped-def]
    """Write the velocity on a side and in the two lines beyond it; ``step`` is 1 at the low end and -1 at the high one.

    ``n`` is the velocity along the normal and ``t`` that along the side, normal index first; ``face`` and ``inner`` are
    the lines of the side's faces and of the cells inside it.
    """
    two, sign, wide = n.dtype.type(2), n.dtype.type(step), n.shape[1]
    for i in range(PAD, wide - PAD):
        n[face, i] = sign * prescribed[i - PAD]
    for k in range(1, 3 if step > 0 else 2):
        for i in range(wide):
            n[face - k * step, i] = two * n[face, i] - n[face + step, i] if straight else n[face, i]
    for k in range(1, 3):
        to, source = inner - k * step, inner - (k - 1) * step
        for i in range(wide):
            if how == _MIRRORED:
                t[to, i] = two * value - t[source, i]
            elif how == _GIVEN:
                t[to, i] = value
            elif how == _FREE_OF_VORTICITY and PAD < i < wide - PAD:
                t[to, i] = t[source, i] - sign * (n[face, i] - n[face, i - 1])
            else:
                t[to, i] = t[source, i]


@part
def _mirror_row(a, to, on, source, by, count, straight):  # type: ignore[no-untyped-def]
    """Write a row beyond a side from that on it and, where the normal velocity goes on straight, from its image."""
    two, to, on, source, by = a.dtype.type(2), unsigned(to), unsigned(on), unsigned(source), unsigned(by)
    for i in range(unsigned(count)):
        a[to + i * by] = two * a[on + i * by] - a[source + i * by] if straight else a[on + i * by]


@part
def _fill_row(a, to, source, by, count, how, value):  # type: ignore[no-untyped-def]
    """Write a row of a velocity along a side beyond it from that inside it."""
    times, plus = a.dtype.type(-1 if how == _MIRRORED else how != _GIVEN), value
    plus = plus + plus if how == _MIRRORED else plus if how == _GIVEN else a.dtype.type(0)
    to, source, by = unsigned(to), unsigned(source), unsigned(by)
    for i in range(unsigned(count)):
        a[to + i * by] = plus + times * a[source + i * by]


@part
def _free_of_vorticity(a, to, n, on, before, by, first, last, sign):  # type: ignore[no-untyped-def]
    """Add to a row beyond a side what the normal velocity, whose row on the side is ``on``, rises along the side."""
    to, on, before, by = unsigned(to), unsigned(on), unsigned(before), unsigned(by)
    for i in range(unsigned(first), unsigned(last)):
        a[to + i * by] -= sign * (n[on + i * by] - n[before + i * by])


@compiled
def _fill_planes(velocity, axis, strides, face, inner, step, prescribed, straight, how, values):  # type: ignore[no-untyped-def]
    """Do in space what ``_fill_side`` does in the plane, with both velocities along the side and planes for lines.

    ``velocity`` has the cells of a component end to end, ``strides`` apart along the normal and along the side's axes,
    the last one first; ``values`` are those of the velocities along the side in the order of the axes.
    """
    n, (across, down, by), sign = velocity[axis], strides, velocity.dtype.type(step)
    high, count = prescribed.shape[0] + 2 * PAD, prescribed.shape[1] + 2 * PAD
    for j in range(high):
        on = face * across + j * down
        if PAD <= j < high - PAD:
            for i in range(count - 2 * PAD):
                n[on + (i + PAD) * by] = sign * prescribed[j - PAD, i]
        for k in range(1, 3 if step > 0 else 2):
            away = k * step * across
            _mirror_row(n, on - away, on, on + away, by, count, straight)
        for k in range(1, 3):
            to, beyond = (inner - k * step) * across + j * down, how == _FREE_OF_VORTICITY
            source = to + step * across if beyond else (inner + (k - 1) * step) * across + j * down
            for c in range(2):
                t, at = velocity[c + (c >= axis)], on - (k - 1) * step * across
                _fill_row(t, to, source, by, count, how, values[c])
                if beyond and PAD + c <= j < high - PAD:
                    _free_of_vorticity(t, to, n, at, at - (down if c else by), by, PAD + 1 - c, count - PAD, sign)


@dataclass(slots=True)
class Edge:
    """One side of the domain at work."""

    name: str
    """Which side it is."""
    side: Side
    """What the side is."""
    axis: int
    """Axis of the normal: 0 is x, 1 is y, 2 is z."""
    low: bool
    """Whether the side is at the smallest coordinate."""
    cells: int
    """Cells along the normal [-]."""
    places: list[np.ndarray]
    """Coordinates of the side's faces along it, in the order of the axes, shapes of ``prescribed`` [m]."""
    prescribed: np.ndarray
    """Velocity into the domain on the side's faces, the last axis first [m/s]."""
    unbounded: bool
    """Whether the side is one of an unbounded domain."""
    leaves: float = 0.0
    """Share of this step in which water is carried out here instead of held to the far water [-]."""
    slides: tuple[float, ...] | None = None
    """Velocity of what the water sticks to there, along the other axes; None without friction [m/s]."""
    induced: np.ndarray = field(init=False)
    """Velocity into the domain that the flow in it induces, at the end of the last step [m/s]."""
    seen: np.ndarray = field(init=False)
    """The same one step earlier [m/s]."""
    order: tuple[int, ...] = field(init=False)
    """Axes of an array of the padded grid, that across the side first [-]."""

    def __post_init__(self) -> None:
        self.induced, self.seen = np.zeros(self.prescribed.shape), np.zeros(self.prescribed.shape)
        at = self.prescribed.ndim - self.axis
        self.order = (at, *(k for k in range(1 + self.prescribed.ndim) if k != at))

    @property
    def sign(self) -> int:
        """+1 if the inward normal points along the axis, else -1."""
        return 1 if self.low else -1

    @property
    def face(self) -> int:
        """Index of the side's faces along the normal."""
        return PAD if self.low else PAD + self.cells

    @property
    def inside(self) -> tuple[slice, ...]:
        """The part of a plane or line parallel to the side that lies in the domain."""
        return (slice(PAD, -PAD),) * self.prescribed.ndim

    def normal(self, velocity: np.ndarray) -> np.ndarray:
        """Return the velocity along the normal, normal index first."""
        return self.across(velocity[self.axis])

    def across(self, a: np.ndarray) -> np.ndarray:
        """Return an array of the padded grid with the normal index first."""
        return a.transpose(self.order)  # np.moveaxis takes ten times as long

    def asked(self, time: float) -> tuple[tuple[float, ...] | None, np.ndarray | None]:
        """Return what the side says at a time [s]: the velocity of what the water sticks to, and that into the domain.

        None without friction, and None where the side gives no velocity through it [m/s].

        Raises:
            InvalidDesign: it says something that is no velocity.
        """
        slides, given = self.side.along(time, 1 + self.prescribed.ndim), None
        who = f"the {self.name} side, a {type(self.side).__name__},"
        if slides is not None and not (np.shape(slides) == (self.prescribed.ndim,) and np.isfinite(slides).all()):
            raise InvalidDesign(
                f"at t = {time:.4g} s {who} moves along itself at {show(slides)} m/s; along() gives one finite number "
                f"for each other axis, or None."
            )
        if self.side.passes and not self.side.opens:
            given = np.asarray(self.side.into(time, *self.places))
            if given.shape not in ((), self.prescribed.shape) or not np.isfinite(given).all():
                raise InvalidDesign(
                    f"at t = {time:.4g} s velocities into the domain through {who} are {show(given)}; into() gives one "
                    f"finite number [m/s], or as many as there are places, shape {self.prescribed.shape}."
                )
        return slides, given

    def impose(self, time: float, outward: float) -> None:
        """Take what the side says of the water at a time.

        Args:
            time: when [s].
            outward: what share of the far stream's speed is across the side, positive outward [-].
        """
        self.leaves = self.side.carries(outward)
        self.slides, given = self.asked(time)
        if given is not None:
            self.prescribed[:] = given

    def fastest(self, time: float) -> float:
        """Return the fastest speed that the side itself imposes at a time [m/s]."""
        slides, given = self.asked(time)
        return max(0.0 if slides is None else length(slides), 0.0 if given is None else float(np.abs(given).max()))

    def fill(self, velocity: np.ndarray, stream: tuple[float, ...]) -> None:
        """Write this side's values to the cells and faces around the domain."""
        n, f, step = self.normal(velocity), self.face, self.sign
        inner = PAD if self.low else PAD + self.cells - 1
        others = (1 - self.axis,) if len(velocity) == 2 else [d for d in range(3) if d != self.axis]
        if isinstance(self.side, Periodic):
            lines = [n, *(self.across(velocity[d]) for d in others)]
            for k in range(1, PAD + 1):
                to, source = (f - k, f - k + self.cells) if self.low else (f + k - 1, f + k - 1 - self.cells)
                for a in lines:
                    a[to] = a[source]
            return
        straight = not self.side.passes or (self.unbounded and not self.leaves)
        how, value = self._along(0, others[0], step, stream)
        if len(others) == 1:
            along = self.across(velocity[others[0]])
            _fill_side(n, along, f, inner, step, self.prescribed, straight, how, n.dtype.type(value))
        else:
            values = tuple(n.dtype.type(each) for each in (value, self._along(1, others[1], step, stream)[1]))
            line, plane = velocity.shape[3], velocity.shape[2] * velocity.shape[3]
            strides = ((1, plane, line), (line, plane, 1), (plane, line, 1))[self.axis]
            flat = velocity.reshape(3, -1)
            _fill_planes(flat, self.axis, strides, f, inner, step, self.prescribed, straight, how, values)

    def _along(self, k: int, axis: int, step: int, stream: tuple[float, ...]) -> tuple[int, float]:
        """Return what the velocity along an axis in the side, the one of number ``k``, is beyond it.

        What kind of value that is does not depend on the axis.
        """
        if self.slides is not None:
            return _MIRRORED, self.slides[k]
        if self.unbounded and not self.leaves:
            return _FREE_OF_VORTICITY, 0.0
        if isinstance(self.side, Stream) and step * stream[self.axis] > 0:
            return _GIVEN, stream[axis]
        return _AS_INSIDE, 0.0


@dataclass(slots=True)
class Border:
    """The sides at work; ``prepare`` once a step, ``fill`` whenever the velocity changed."""

    edges: list[Edge]
    """Left, right, bottom, top, and in space low and high; without those at which the domain does not end."""
    water: OpenWater | FarField | None
    """The water around the domain, if it has no end."""
    stream: tuple[float, ...] = (0.0, 0.0)
    """Velocity of the far water at the end of the step [m/s]."""
    steps: int = 0
    """Steps prepared so far [-]."""
    span: float = 0.0
    """Length of the last step [cells per (m/s)]."""

    @classmethod
    def of(cls, sides: Sides, grid: Grid, dtype: type) -> "Border":
        """Return the border of a grid."""
        edges, unbounded = [], sides.unbounded(grid.axes)
        for k, (name, side) in enumerate(zip(NAMES, sides.around(grid.axes), strict=False)):
            axis = k // 2
            if not side.ends:
                continue
            prescribed: np.ndarray = np.zeros([n for d, n in enumerate(grid.cells) if d != axis][::-1], dtype)
            places = np.meshgrid(*(grid.centres(PAD, PAD + n, d) for d, n in enumerate(grid.cells) if d != axis))
            moves = unbounded and isinstance(side, Stream)
            edge = Edge(name, side, axis, name in NAMES[::2], grid.cells[axis], list(places), prescribed, moves)
            edge.impose(0.0, 0.0)
            edges.append(edge)
        water: OpenWater | FarField | None = None
        if unbounded:
            water = OpenWater.around(grid) if grid.axes == 2 else FarField(grid, sides.mirrors(3))
        return cls(edges=edges, water=water, stream=(0.0,) * grid.axes)

    def state(self) -> dict[str, np.ndarray]:
        """Return all that changes, by name."""
        edges = {
            f"edge{k}.{name}": getattr(e, name)
            for k, e in enumerate(self.edges)
            for name in ("prescribed", "induced", "seen")
        }
        return {**edges, "stream": np.array(self.stream), "prepared": np.array([self.steps, self.span])}

    def resume(self, state: dict[str, np.ndarray]) -> None:
        """Set all that changes."""
        for k, edge in enumerate(self.edges):
            for name in ("prescribed", "induced", "seen"):
                getattr(edge, name)[:] = state[f"edge{k}.{name}"]
        self.stream = tuple(state["stream"].tolist())
        self.steps, self.span = int(state["prepared"][0]), float(state["prepared"][1])

    def fastest(self, time: float) -> float:
        """Return the fastest speed that a side itself imposes at a time, a wall or an inflow [m/s]."""
        return max((edge.fastest(time) for edge in self.edges), default=0.0)

    def prepare(
        self, velocity: np.ndarray, window: Window, dt: float, stream: tuple[float, ...], time: float = 0.0
    ) -> None:
        """Fix the velocity on all sides at the end of the step, at ``time`` [s], from the fields at its start.

        On return as much water leaves as enters.

        Raises:
            InvalidDesign: a side says something that is no velocity, or water enters that cannot leave.
        """
        before, self.stream = self.stream, stream
        size = max(length(stream), 1e-30)
        for edge in self.edges:
            edge.impose(time, -edge.sign * stream[edge.axis] / size)
        if self.steps == 0:
            for edge, induced in zip(self.edges, self._induced(velocity, window), strict=True):
                edge.induced[:] = edge.seen[:] = induced
        grown = dt / self.span if self.span else 0.0
        for edge in self.edges:
            ahead = grown * (edge.induced - edge.seen)
            if edge.side.opens:
                held = edge.sign * stream[edge.axis] + edge.induced + ahead
                if edge.leaves:
                    rise = edge.sign * (stream[edge.axis] - before[edge.axis]) if isinstance(edge.side, Stream) else 0.0
                    carried = self._carried(edge, velocity, dt) + (rise + ahead)
                    held = edge.leaves * carried + (1 - edge.leaves) * held
                edge.prescribed[:] = held
            edge.seen[:] = edge.induced
            edge.induced += ahead
        self.steps, self.span = self.steps + 1, dt
        self._balance()
        self._refuse_gain(time)

    def _refuse_gain(self, time: float) -> None:
        """Refuse water that enters through sides and cannot leave, or the reverse."""
        if any(e.leaves or e.unbounded for e in self.edges):
            return
        through = [e.prescribed for e in self.edges if not isinstance(e.side, Periodic)]
        net = sum(float(p.sum(dtype=np.float64)) for p in through)
        most = sum(float(np.abs(p).sum(dtype=np.float64)) for p in through)
        if abs(net) > LOST * most:
            driven = ", ".join(e.name for e in self.edges if e.side.passes)
            way = "enters and cannot leave" if net > 0 else "leaves and none enters"
            raise InvalidDesign(
                f"at t = {time:.4g} s {100 * abs(net) / most:.3g} % of the water that passes the domain's sides "
                f"({driven}) {way}; make another side an Outflow()."
            )

    def update_induced(self, velocity: np.ndarray, window: Window) -> float:
        """Take what the fields, which are those of the step's end, induce; return the largest change [m/s].

        ``prepare`` could only carry on from the last steps. Without this a cylinder in a domain of 4 diameters that
        shakes once in 20 steps has 5 % less drag, and 23 % less with the last step's value alone.
        """
        change = 0.0
        if self.water is None:
            return change
        for edge, induced in zip(self.edges, self._induced(velocity, window), strict=True):
            rise = induced - edge.induced
            edge.prescribed += rise.astype(edge.prescribed.dtype)
            edge.induced[:] = induced
            if self.steps == 1:
                edge.seen[:] = induced
            change = max(change, float(np.abs(rise).max()))
        self._balance()
        return change

    def _induced(self, velocity: np.ndarray, window: Window) -> list[np.ndarray]:
        if self.water is None:
            return [np.zeros(e.prescribed.shape) for e in self.edges]
        return self.water.inward(velocity, window, [Fading(e.axis, e.low, e.leaves) for e in self.edges if e.leaves])

    @staticmethod
    def _carried(edge: Edge, velocity: np.ndarray, dt: float) -> np.ndarray:
        """Return the velocity on a side to which the water comes that moves out of the domain."""
        n = edge.normal(velocity)
        at = edge.sign * n[edge.face][edge.inside]
        inner = edge.sign * n[edge.face + edge.sign][edge.inside]
        speed = max(-float(at.mean(dtype=np.float64)), 0.0)
        carried: np.ndarray = at - min(speed * dt, 1.0) * (at - inner)
        return carried

    def _balance(self) -> None:
        net, room = 0.0, 0.0
        free = any(e.leaves for e in self.edges)
        for edge in self.edges:
            if not isinstance(edge.side, Periodic):
                net += float(edge.prescribed.sum(dtype=np.float64))
                room += edge.prescribed.size * (edge.leaves if free else float(edge.unbounded))
        if room:
            for edge in self.edges:
                share = edge.leaves if free else float(edge.unbounded)
                if share:
                    edge.prescribed -= share * net / room

    def fill(self, velocity: np.ndarray) -> None:
        """Write all boundary values around the domain."""
        for edge in self.edges:
            edge.fill(velocity, self.stream)
