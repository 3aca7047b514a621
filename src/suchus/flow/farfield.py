"""Sides that move as they would in an unbounded domain.

**In the plane.** By Biot and Savart the velocity anywhere is the far stream's plus what all vorticity, and all
divergence of the bodies' own motion, induces. Both are gathered to square blocks with their first moments and summed up
at every eighth face of the sides, with cubics between. In complex form, with strengths ``c = source - i vortex`` and
moments ``m`` about the middle of a block, ``u - i v = (c / z + m / z^2) / (2 pi)``.

**The wake that has left.** A wake goes on behind the domain. In front of a side that carries it out its vorticity is
faded to nothing, over most of the way from the bodies; what is missing from there on acts far away like a source with
the strength of the wake's defect, ``integral of (U - u) dy``, and is put in as that. It is the source of strength ``D /
(rho U)`` that a body with drag D is from afar. A street of vortices is so replaced by its mean.

**In space.** All that moves the water is inside a closed surface, which lies a little inside the sides. Beyond it the
velocity, less the far stream's, is that of sources of strength ``n . u`` and of vortex sheets of strength ``n x u`` on
the surface: ``integral of [(n . u) r + (n x u) x r] / (4 pi r^3)`` over it, where n is its outward normal, u the
velocity on it less the far stream's, and r leads from it to where the velocity is asked for. A flow that comes from
beyond the surface adds nothing to this integral, so what the sides do does not act back on them. The surface is divided
into panels; one matrix, made once, turns the mean velocities on them into those on the sides.

**The wake that has left, in space.** A wake that goes on unchanged behind the domain is a tube of flux, ``1/2 integral
of (x cross vorticity) . n`` over a plane across it, and from afar a source of that strength where it begins. It begins
on the surface, whose own sources there have the same strength and the opposite sign; both are left out. What remains is
the source of strength ``D / (density U)`` that a body with drag D is from afar, if the wake's flux no longer changes;
it is too strong where the wake is still young.

Sources: Batchelor 1967, An Introduction to Fluid Dynamics, sections 2.4 (velocity of sources and vorticity), 5.12
(wakes, source of a wake) and 7.2 (flux and impulse of vorticity); Weymouth and Lauber 2024, arXiv:2404.09034 (induced
velocities as boundary values on a grid).
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import product
from math import ceil

import numpy as np
from numba import prange

from suchus.flow.compiled import PAD, UNIT, Window, compiled, kernel_part, signed, threaded_part, unsigned
from suchus.flow.grid import Grid
from suchus.flow.immerse import MEAN_WINDOW_MARGIN

SIDE = 8
"""Cells along a block, and faces between two points of a side where the induced velocity is summed up [-]."""

MIN_STRENGTH_RATIO = 1e-6
"""Strength, over the largest one, below which a block is left out: the limit of single precision [-]."""

FADE_FRACTION = 0.85
"""Part of the distance from the bodies to a side over which the wake is faded before it leaves there [-].

It has to be much longer than the wavelength of a street: with a quarter of the domain, the lift of a cylinder at
Re 100 is 0.25, 0.35 and 0.29 with 12, 16 and 20 diameters behind it, on 8 cells a diameter; with
this one it is 0.34."""

MIN_UNFADED_WIDTHS = 1.8
"""Length of the wake behind the bodies that is not faded, over their width [-].

In a box that ends 4.5 diameters behind a started cylinder at Re 40, the largest difference of its drag from the
solution in polar coordinates is 1.5 % with 1.1 widths and 0.3 % with 1.8. With 5 the fade is too short for the street
in a box that ends 11.5 diameters behind the cylinder: its lift is 6 % larger than in a longer one."""

PANELS = 16
"""Panels along the side of a cube with as many cells as the domain and its images; the surface lies as far inside the
sides as a panel is long [-]."""

MIN_PANEL_CELLS = 2
"""Smallest number of cells along a panel [-]."""

KNOT = 1.5
"""Panels between two knots of a side, where the velocity is summed up; between them it is cubic [-]."""

IMAGES = 3
"""Images that count to each side where two mirrors face each other and have infinitely many [-]."""


@kernel_part
def _spin_row(total, moment, u, v, row, arm):  # type: ignore[no-untyped-def]
    """Add the circulation of one row of corners, and its moment along y, to the sums of each column.

    Args:
        total: circulation of each column so far [m/s cells].
        moment: its moment so far.
        u: velocity along x, padded [m/s].
        v: velocity along y, padded [m/s].
        row: padded row of the corners.
        arm: distance of the row from the middle of its blocks [cells].
    """
    j, pad = unsigned(row), unsigned(PAD)
    for k in range(UNIT, unsigned(total.size)):
        w = (v[j, k + pad] - v[j, k + pad - UNIT]) - (u[j, k + pad] - u[j - UNIT, k + pad])
        total[k] += w
        moment[k] += arm * w


@kernel_part
def _spread_row(block, u, v, j, arm, b, window):  # type: ignore[no-untyped-def]
    """Add the divergence of row ``j`` of cells in the window to the blocks of row ``b``.

    Args:
        block: strengths of the blocks, shape (4, row, column).
        u: velocity along x, padded [m/s].
        v: velocity along y, padded [m/s].
        j: padded row of cells.
        arm: distance of the row from the middle of its blocks [cells].
        b: row of blocks.
        window: padded cell indices around the bodies.
    """
    for i in range(window[2], window[3]):
        spread = np.float64((u[j, i + 1] - u[j, i]) + (v[j + 1, i] - v[j, i]))
        k = (i - PAD) // SIDE
        arm_x = (i - PAD) + 0.5 - (SIDE * k + 0.5 * (SIDE - 1))
        block[0, b, k] += spread
        block[2, b, k] += spread * arm_x
        block[3, b, k] += spread * arm


@threaded_part
def _gather(u, v, window, block):  # type: ignore[no-untyped-def]
    """Write the strengths of the blocks (4, row, column): source, vortex, and the moment's two parts.

    Corners belong to a block by their number, so its middle lies at ``SIDE b + (SIDE - 1) / 2`` cells. Strengths are
    in m/s per cell times cells squared. Divergence is counted in the bodies' window only.

    Args:
        u: velocity along x, padded [m/s].
        v: velocity along y, padded [m/s].
        window: padded cell indices around the bodies.
        block: strengths to write, shape (4, row, column).
    """
    ny, nx = u.shape[0] - 2 * PAD, u.shape[1] - 2 * PAD
    for n in prange(block.shape[1]):
        b = signed(n)
        middle = SIDE * b + 0.5 * (SIDE - 1)
        total, moment = np.empty(nx, u.dtype), np.empty(nx, u.dtype)
        for k in range(nx):
            total[k], moment[k] = 0, 0
        for c in range(max(SIDE * b, 1), min(SIDE * b + SIDE, ny)):  # type: ignore[call-overload]
            j, arm = c + PAD, u.dtype.type(c - middle)
            _spin_row(total, moment, u, v, j, arm)
        for k in range(block.shape[2]):
            vortex, moment_y, moment_x = 0.0, 0.0, 0.0
            for i in range(SIDE * k, min(SIDE * k + SIDE, nx)):
                vortex += total[i]
                moment_y += moment[i]
                moment_x += (i - (SIDE * k + 0.5 * (SIDE - 1))) * total[i]
            block[0, b, k], block[1, b, k], block[2, b, k], block[3, b, k] = 0.0, vortex, moment_y, -moment_x
        for j in range(max(SIDE * b + PAD, window[0]), min(SIDE * b + SIDE + PAD, window[1])):
            _spread_row(block, u, v, j, j - PAD + 0.5 - middle, b, window)


@kernel_part
def _fade(block, x, y, turn, keep, fading_fraction, axis, positions, strengths, count):  # type: ignore[no-untyped-def]
    """Fade the vorticity of the blocks towards one side, and add the sources that stand for the wake that has left.

    Args:
        block: strengths of the blocks, shape (4, row, column), changed.
        x: middles of the columns of blocks [cells].
        y: middles of the rows of blocks [cells].
        turn: sign of the sources: 1 or -1.
        keep: fraction of the strength that stays, at each block along the axis [-].
        fading_fraction: fraction of the wake that is faded there [-].
        axis: axis of the side's normal: 0 is x, 1 is y.
        positions: positions of the sources, shape (2, source), to write to [cells].
        strengths: their strengths as those of a block, shape (4, source), to write to.
        count: number of the sources before.

    Returns:
        The number of the sources with the new ones.
    """
    rows, columns = block.shape[1], block.shape[2]
    total, moment = 0.0, 0.0
    for b in range(rows):
        for k in range(columns):
            size = abs(block[1, b, k]) * fading_fraction[k if axis == 0 else b]
            total += size
            moment += size * (y[b] if axis == 0 else x[k])
    centre = moment / total if total > 0.0 else 0.0
    for n in range(columns if axis == 0 else rows):
        defect = 0.0
        for m in range(rows if axis == 0 else columns):
            b, k = (m, n) if axis == 0 else (n, m)
            arm_moment = block[2, b, k] if axis == 0 else -block[3, b, k]
            defect -= block[1, b, k] * ((y[b] if axis == 0 else x[k]) - centre) + arm_moment
        source = turn * fading_fraction[n] * defect / SIDE
        if source != 0.0:
            positions[axis, count], positions[1 - axis, count] = (x[n] if axis == 0 else y[n]), centre
            strengths[0, count] = source
            strengths[1, count], strengths[2, count], strengths[3, count] = 0.0, 0.0, 0.0
            count += 1
    for d in range(4):
        for b in range(rows):
            for k in range(columns):
                block[d, b, k] *= keep[k if axis == 0 else b]
    return count


@kernel_part
def _strong_blocks(block, x, y, positions, strengths, count):  # type: ignore[no-untyped-def]
    """Add the blocks whose strength counts to the sources; return their number. For the arguments see ``_fade``."""
    max_size = 0.0
    for d in range(4):
        for b in range(block.shape[1]):
            for k in range(block.shape[2]):
                max_size = max(max_size, abs(block[d, b, k]))
    for b in range(block.shape[1]):
        for k in range(block.shape[2]):
            size = 0.0
            for d in range(4):
                size = max(size, abs(block[d, b, k]))
            if size > MIN_STRENGTH_RATIO * max_size:
                positions[0, count], positions[1, count] = x[k], y[b]
                for d in range(4):
                    strengths[d, count] = block[d, b, k]
                count += 1
    return count


@kernel_part
def _induced_at(x, y, positions, strengths, count, min_square):  # type: ignore[no-untyped-def]
    """Return the velocity that the first ``count`` sources induce at a point; see ``_fade`` for their arrays."""
    u, v = 0.0, 0.0
    for k in range(unsigned(count)):
        dx, dy = x - positions[0, k], y - positions[1, k]
        square = dx * dx + dy * dy
        inverse_square = 1.0 / (square if square > min_square else min_square)
        a, b = dx * inverse_square, -dy * inverse_square
        c, d = a * a - b * b, 2.0 * a * b
        u += strengths[0, k] * a + strengths[1, k] * b + strengths[2, k] * c - strengths[3, k] * d
        v -= strengths[0, k] * b - strengths[1, k] * a + strengths[2, k] * d + strengths[3, k] * c
    return u / (2.0 * np.pi), v / (2.0 * np.pi)


@threaded_part
def _induce(points, positions, strengths, count, velocity):  # type: ignore[no-untyped-def]
    """Write the velocity at ``points`` (2, point) to ``velocity``; all lengths in cells."""
    min_square = 0.25 * SIDE**2
    for n in prange(points.shape[1]):
        t = signed(n)
        velocity[0, t], velocity[1, t] = _induced_at(
            points[0, t], points[1, t], positions, strengths, count, min_square
        )


@compiled
def induce(u, v, window, block, x, y, fadings, keep, fading_fractions, points, face_points, weights, signs, inflow):  # type: ignore[no-untyped-def]
    """Write the velocity into the domain that the fields induce on the faces of all sides.

    Args:
        u: velocity along x, padded [m/s].
        v: velocity along y, padded [m/s].
        window: padded cell indices around the bodies.
        block: work array for the strengths of the blocks, shape (4, row, column).
        x: middles of the columns of blocks [cells].
        y: middles of the rows of blocks [cells].
        fadings: axis and sign of each fading, shape (fading, 2).
        keep: fraction of the strength that stays, shape (fading, block along the axis) [-].
        fading_fractions: fraction of the wake that is faded there, of the same shape [-].
        points: points where the velocity is summed up, shape (2, point) [cells].
        face_points: indices of the points of each face in the flattened velocities, shape (4, face).
        weights: weights of these points, shape (4, face) [-].
        signs: 1 on the faces of a side at a low end, -1 at a high end, shape (face,) [-].
        inflow: velocity into the domain, shape (face,), to write to [m/s].
    """
    _gather(u, v, window, block)
    max_count = block.shape[1] * block.shape[2] + fadings.shape[0] * max(block.shape[1], block.shape[2])
    positions, strengths, count = np.empty((2, max_count)), np.empty((4, max_count)), 0
    for n in range(fadings.shape[0]):
        count = _fade(
            block, x, y, fadings[n, 1], keep[n], fading_fractions[n], fadings[n, 0], positions, strengths, count
        )  # fmt: skip
    count = _strong_blocks(block, x, y, positions, strengths, count)
    velocity = np.zeros((2, points.shape[1]))
    _induce(points, positions, strengths, count, velocity)
    flat = velocity.reshape(-1)
    for k in range(inflow.size):
        total = 0.0
        for n in range(4):
            total += weights[n, k] * flat[face_points[n, k]]
        inflow[k] = signs[k] * total


def cubic(knots: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the indices and weights of the four knots for cubic interpolation at each ``x``, both of shape (4, x)."""
    step = knots[1] - knots[0]
    first_knot = np.clip(((x - knots[0]) / step).astype(int) - 1, 0, knots.size - 4)
    t = (x - knots[first_knot]) / step
    nodes = np.arange(4)
    weights = [np.prod([(t - m) / (k - m) for m in nodes if m != k], axis=0) for k in nodes]
    return first_knot + nodes[:, None], np.array(weights)


@dataclass(frozen=True, slots=True)
class Fading:
    """How a wake is faded towards one side."""

    axis: int
    """Axis of the side's normal: 0 is x, 1 is y."""
    is_lower_side: bool
    """Whether the side is at the smallest coordinate."""
    fraction: float
    """Share of the vorticity that is faded out [-]."""
    length: float
    """Length over which it is faded [cells]."""


def fade_length(window: Window, axis: int, *, is_lower_side: bool, cells: int) -> float:
    """Return the length over which the wake of bodies in the plane is faded before it leaves through a side [cells].

    Args:
        window: padded cell indices around the bodies.
        axis: axis of the side's normal: 0 is x, 1 is y.
        is_lower_side: whether the side is at the smallest coordinate.
        cells: cells of the domain along the axis.
    """
    (start, stop), (lateral_start, lateral_stop) = (window[2:], window[:2]) if axis == 0 else (window[:2], window[2:])
    if stop <= start:
        return FADE_FRACTION * cells
    clearance = (start if is_lower_side else cells + 2 * PAD - stop) - PAD + MEAN_WINDOW_MARGIN
    body_width = max(lateral_stop - lateral_start - 2 * MEAN_WINDOW_MARGIN, 0.0)
    return float(max(min(FADE_FRACTION * clearance, clearance - MIN_UNFADED_WIDTHS * body_width), SIDE))


@dataclass(slots=True)
class OpenWater:
    """Open water around a grid, all four sides of it."""

    cells: tuple[int, ...]
    """Cells along x and y."""
    points: np.ndarray = field(init=False)
    """Points of the sides where the velocity is summed up, side after side, shape (2, point) [cells]."""
    face_points: tuple[np.ndarray, np.ndarray] = field(init=False)
    """Which points the faces of all sides, end to end, take, as indices in the flattened velocities of the points, and
    their weights, each of shape (4, face) [-]."""
    signs: np.ndarray = field(init=False)
    """1 on the faces of a side at a low end, -1 at a high end, end to end, shape (face,) [-]."""
    ends: list[int] = field(init=False)
    """Index of the first face behind each side but the last [-]."""
    fading_table: tuple[tuple[object, ...], tuple[np.ndarray, np.ndarray, np.ndarray]] | None = field(
        init=False, default=None
    )
    """Fadings of the last step, and the result of ``_fading_table`` for them."""
    middles: tuple[np.ndarray, np.ndarray] = field(init=False)
    """Middles of the columns of blocks along x, and of the rows along y [cells]."""
    blocks: np.ndarray = field(init=False)
    """Strengths of the blocks, shape (4, row, column)."""

    def __post_init__(self) -> None:
        """Lay out the blocks and the points of the sides where the velocity is summed up."""
        nx, ny = self.cells
        rows, columns = -(-ny // SIDE), -(-nx // SIDE)
        self.blocks = np.zeros((4, rows, columns))
        x, y = (SIDE * np.arange(n) + 0.5 * (SIDE - 1) for n in (columns, rows))
        self.middles = x, y
        points, interpolation = [], []
        for axis, coordinate in ((0, 0), (0, nx), (1, 0), (1, ny)):
            cell_count = self.cells[1 - axis]
            knots = np.linspace(0.5, cell_count - 0.5, max(-(-cell_count // SIDE), 3) + 1)
            interpolation.append(cubic(knots, np.arange(cell_count) + 0.5))
            pair = np.full(knots.size, float(coordinate)), knots
            points.append(np.array(pair if axis == 0 else pair[::-1]))
        self.points = np.concatenate(points, axis=1)
        count = self.points.shape[1]
        starts = np.cumsum([0, *(side_points.shape[1] for side_points in points)]).tolist()
        indices = [
            (k // 2) * count + start + index
            for k, (start, (index, _)) in enumerate(zip(starts, interpolation, strict=False))
        ]
        self.face_points = (
            np.concatenate(indices, axis=1), np.concatenate([weight for _, weight in interpolation], axis=1)
        )  # fmt: skip
        face_counts = [index.shape[1] for index in indices]
        self.signs = np.repeat([1.0, -1.0, 1.0, -1.0], face_counts)
        self.ends = np.cumsum(face_counts)[:-1].tolist()

    @classmethod
    def for_grid(cls, grid: Grid) -> "OpenWater":
        """Return the open water around a grid."""
        return cls(grid.cells)

    def inward(self, velocity: np.ndarray, window: Window, fadings: list[Fading]) -> list[np.ndarray]:
        """Return the velocity into the domain that the fields induce on the faces of each side [m/s].

        Args:
            velocity: velocity on the left and on the lower faces, padded, shape (axis, ...) [m/s].
            window: padded cell indices around the bodies.
            fadings: the sides that carry a wake out.

        The order is left, right, bottom, top. The sum over all faces is zero but for the sources of wakes.
        """
        return np.split(self.inward_faces(velocity, window, fadings), self.ends)

    def inward_faces(self, velocity: np.ndarray, window: Window, fadings: list[Fading]) -> np.ndarray:
        """Return ``inward`` of all sides end to end, shape (face,) [m/s]."""
        faces: np.ndarray = np.empty(self.signs.size)
        x, y = self.middles
        points, weights = self.face_points
        table, keep, fractions = self._fading_table(fadings)
        induce(
            velocity[0], velocity[1], np.array(window), self.blocks, x, y, table, keep, fractions, self.points, points,
            weights, self.signs, faces,
        )  # fmt: skip
        return faces

    def _fading_table(self, fadings: list[Fading]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return axis and sign of each fading, and what stays and what fades at each block; see ``induce``.

        Args:
            fadings: the sides that carry a wake out.
        """
        key = tuple(fadings)
        if self.fading_table is None or self.fading_table[0] != key:
            count = max(size for size in self.blocks.shape[1:])
            table = np.zeros((len(fadings), 2), np.int64)
            keep, fractions = np.zeros((2, len(fadings), count))
            for n, fading in enumerate(fadings):
                weights = self._weights(fading)
                table[n] = fading.axis, 1 if (fading.axis == 0) != fading.is_lower_side else -1
                keep[n, : weights[0].size], fractions[n, : weights[1].size] = weights
            self.fading_table = key, (table, keep, fractions)
        return self.fading_table[1]

    def _weights(self, fading: Fading) -> tuple[np.ndarray, np.ndarray]:
        """Return the fraction of the strength that stays in each column of blocks along an axis, and what fades there.

        Args:
            fading: the side towards which the wake is faded.
        """
        cells, middle = self.cells[fading.axis], self.middles[fading.axis]

        def weight(position: np.ndarray) -> np.ndarray:
            """Return the fraction of the strength that stays, at positions along the axis [cells]."""
            fraction = np.minimum(
                np.maximum((position if fading.is_lower_side else cells - position) / fading.length, 0.0), 1.0
            )  # clip is slow
            weights: np.ndarray = 1 - fading.fraction * (1 - fraction**2 * (3 - 2 * fraction))
            return weights

        fading_fraction = np.abs(weight(middle + SIDE / 2) - weight(middle - SIDE / 2))  # per column of blocks
        return weight(middle), fading_fraction


@dataclass(slots=True)
class Face:
    """One of the plane faces of the surface, with the side of the domain beyond it."""

    axis: int
    """Axis of its normal: 0 is x, 1 is y, 2 is z."""
    is_lower_side: bool
    """Whether the face is at the smaller coordinate."""
    tangential_axes: tuple[int, int]
    """The two axes in it, the later one first, as the arrays have them."""
    spans: tuple[tuple[int, int], ...]
    """First and last cell face of the surface along each axis [-]."""
    centre: tuple[float, ...]
    """Point that the moments of vorticity are about [cells]."""
    starts: tuple[np.ndarray, ...]
    """First cells of the panels along each axis, counted from the span's [-]."""
    sizes: tuple[np.ndarray, ...]
    """Cells of the panels along each axis [-]."""

    @property
    def cells(self) -> np.ndarray:
        """Cells of each panel, shape (panel along one axis, along the other) [-]."""
        return np.outer(*(self.sizes[d] for d in self.tangential_axes))

    @property
    def middles(self) -> np.ndarray:
        """Middles of the panels, shape (3, panel) [cells]."""
        panels = zip(self.spans, self.starts, self.sizes, strict=True)
        lines = [start + starts + 0.5 * sizes for (start, _), starts, sizes in panels]
        lines[self.axis] = np.array([float(self.spans[self.axis][0 if self.is_lower_side else 1])])
        return points_of(lines)

    def velocities(self, velocity: np.ndarray, leaving: float) -> np.ndarray:
        """Return the mean velocity over each panel, shape (3, panel) [m/s].

        Args:
            velocity: velocity on the faces before the cells, padded, shape (3, ...) [m/s].
            leaving: share of the wake's flux that is left out [-].
        """
        face_index = PAD + self.spans[self.axis][0 if self.is_lower_side else 1]
        components, rises = [np.empty(0)] * 3, {}
        for d in range(3):
            planes = np.moveaxis(velocity[d], 2 - self.axis, 0)[face_index - 1 : face_index + 1]
            face_planes = planes[:, *(self._padded_span(e, d) for e in self.tangential_axes)].astype(np.float64)
            if d == self.axis:
                components[d] = face_planes[1]
                continue
            n = 1 + self.tangential_axes.index(d)  # of cells from their two faces
            last_faces, first_faces = np.moveaxis(face_planes, n, 0)[1:], np.moveaxis(face_planes, n, 0)[:-1]
            face_planes = np.moveaxis(0.5 * (last_faces + first_faces), 0, n)
            components[d], rises[d] = 0.5 * (face_planes[0] + face_planes[1]), face_planes[1] - face_planes[0]
        if leaving:
            components[self.axis] = components[self.axis] - leaving * self._flux(components[self.axis], rises)
        first_starts, second_starts = (self.starts[d] for d in self.tangential_axes)
        sums = [
            np.add.reduceat(np.add.reduceat(component, first_starts, axis=0), second_starts, axis=1)
            for component in components
        ]
        means: np.ndarray = np.reshape(sums / self.cells, (3, -1))
        return means

    def _padded_span(self, axis: int, component: int) -> slice:
        """Return the padded cells of the surface along an axis; of the velocity along it their faces."""
        start, stop = self.spans[axis]
        return slice(PAD + start, PAD + stop + (axis == component))

    def _flux(self, normal: np.ndarray, rises: dict[int, np.ndarray]) -> np.ndarray:
        """Return the velocity along the axis whose integral is the flux of the wake.

        Args:
            normal: velocity along the axis on the faces [m/s].
            rises: of the two other velocities from the cells before the faces to those behind them, by their axis
                [m/s].
        """
        flux = np.zeros(normal.shape)
        for n, d in enumerate(self.tangential_axes):
            arm = np.arange(*self.spans[d]) + 0.5 - self.centre[d]
            flux += 0.5 * np.expand_dims(arm, 1 - n) * (rises[d] - np.gradient(normal, axis=n))
        return flux


def points_of(lines: Sequence[np.ndarray]) -> np.ndarray:
    """Return the points of a lattice from its coordinates along x, y and z, the first changing fastest."""
    return np.stack([coordinate.ravel() for coordinate in np.meshgrid(*reversed(lines), indexing="ij")[::-1]])


@dataclass(slots=True)
class FarField:
    """Open water around a grid in space, on all its sides but the mirrors."""

    grid: Grid
    """The grid inside the sides."""
    mirrors: tuple[bool, ...]
    """Whether a side is a mirror, in the order of ``sides.NAMES``."""
    faces: list[Face] = field(init=False)
    """The faces of the surface."""
    matrices: list[np.ndarray] = field(init=False)
    """Per face: velocity into the domain in the knots of its side per velocity on all panels, shape (knot, 3 panel)."""
    interpolation: list[tuple[np.ndarray, np.ndarray]] = field(init=False)
    """Which knots the middles of the cells along each axis take, and their weights, each of shape (4, cell) [-]."""

    def __post_init__(self) -> None:
        """Lay out the faces of the surface with their panels, and fill the matrices of all sides."""
        cells, ends = self.grid.cells, list(zip(self.mirrors[::2], self.mirrors[1::2], strict=True))
        cell_count = np.prod([n * (1 + any(pair)) for n, pair in zip(cells, ends, strict=True)], dtype=float)
        panel = max(MIN_PANEL_CELLS, round(cell_count ** (1 / 3) / PANELS))
        knots = [np.linspace(0.5, n - 0.5, max(ceil(n / (KNOT * panel)), 3) + 1) for n in cells]
        self.interpolation = [cubic(axis_knots, np.arange(n) + 0.5) for axis_knots, n in zip(knots, cells, strict=True)]
        spans = []
        for n, (has_low_mirror, has_high_mirror) in zip(cells, ends, strict=True):
            margin = min(
                panel, n // (2 if has_low_mirror or has_high_mirror else 4)
            )  # a flat domain is thinner than that
            spans.append((margin * (not has_low_mirror), n - margin * (not has_high_mirror)))
        centre = [
            0.0 if has_low_mirror else float(n) if has_high_mirror else n / 2
            for n, (has_low_mirror, has_high_mirror) in zip(cells, ends, strict=True)
        ]
        edges_by_axis = [
            np.linspace(0, b - a, max(round((b - a) / panel), 1) + 1).round().astype(int) for a, b in spans
        ]
        starts, sizes = tuple(edges[:-1] for edges in edges_by_axis), tuple(np.diff(edges) for edges in edges_by_axis)
        tangential_axes = ((2, 1), (2, 0), (1, 0))
        self.faces = [
            Face(k // 2, k % 2 == 0, tangential_axes[k // 2], tuple(spans), tuple(centre), starts, sizes)
            for k, mirror in enumerate(self.mirrors)
            if not mirror
        ]
        self.matrices = [self._matrix(face, knots) for face in self.faces]

    def _matrix(self, side: Face, knots: list[np.ndarray]) -> np.ndarray:
        """Return the velocity into the domain in the knots of the side beyond a face per velocity on the panels.

        Args:
            side: face of the surface; the side of the domain lies beyond it.
            knots: positions along each axis where the velocity is summed up [cells].
        """
        axis, lines = side.axis, list(knots)
        lines[axis] = np.array([0.0 if side.is_lower_side else float(self.grid.cells[axis])])
        points, parts = points_of(lines), []
        for face in self.faces:
            normal = np.zeros(3)
            normal[face.axis] = -1.0 if face.is_lower_side else 1.0
            induced = np.zeros((points.shape[1], 3, face.cells.size))
            for (
                signs,
                shifts,
            ) in self._images():  # the velocity of an image is that of its original at the image of the point
                r = (signs[:, None] * (points - shifts[:, None]))[:, :, None] - face.middles[:, None, :]
                weight = signs[axis] * face.cells.ravel() / (4 * np.pi * (r * r).sum(axis=0) ** 1.5)
                past = np.tensordot(normal, r, 1)
                for j in range(3):
                    induced[:, j] += weight * (normal[j] * r[axis] - normal[axis] * r[j] + (j == axis) * past)
            parts.append(induced)
        matrix = np.concatenate(parts, axis=2).reshape(points.shape[1], -1)
        return (matrix if side.is_lower_side else -matrix).astype(np.float32)

    def _images(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Return signs and shifts that map a point to its images, the point itself among them."""
        axis_images = []
        for n, has_low_mirror, has_high_mirror in zip(
            self.grid.cells, self.mirrors[::2], self.mirrors[1::2], strict=True
        ):
            facing = [(sign, 2.0 * k * n) for k in range(-IMAGES, IMAGES + 1) for sign in (1.0, -1.0)]
            axis_images.append(
                facing
                if has_low_mirror and has_high_mirror
                else [(1.0, 0.0), (-1.0, 2.0 * n * has_high_mirror)][: 1 + (has_low_mirror or has_high_mirror)]
            )
        return [(np.array([s for s, _ in image]), np.array([b for _, b in image])) for image in product(*axis_images)]

    def inward(self, velocity: np.ndarray, window: Window, fadings: list[Fading]) -> list[np.ndarray]:  # noqa: ARG002
        """Return the velocity into the domain that the flow induces on the faces of each side, 0 on mirrors [m/s].

        Args:
            velocity: velocity on the faces before the cells, padded, shape (3, ...) [m/s].
            window: not used; the bodies are inside the surface.
            fadings: the sides that carry a wake out.

        The order is that of ``sides.NAMES``, in each array the last axis first.
        """
        leaving = {(fading.axis, fading.is_lower_side): fading.fraction for fading in fadings}
        panel_velocities = [
            face.velocities(velocity, leaving.get((face.axis, face.is_lower_side), 0.0)) for face in self.faces
        ]
        strength = np.concatenate(panel_velocities, axis=1)
        cells = np.concatenate([face.cells.ravel() for face in self.faces])
        for d in range(3):  # a uniform stream adds nothing to the integral
            if not any(self.mirrors[2 * d : 2 * d + 2]):
                strength[d] -= np.average(strength[d], weights=cells)
        flat = strength.astype(np.float32).ravel()
        cells_along = self.grid.cells[::-1]
        sides = [np.zeros([n for d, n in enumerate(cells_along) if d != 2 - k // 2]) for k in range(6)]
        for face, matrix in zip(self.faces, self.matrices, strict=True):
            (a, weight_a), (b, weight_b) = (self.interpolation[d] for d in face.tangential_axes)
            knots = np.einsum("ps,s->p", matrix, flat).astype(np.float64).reshape(int(a[-1, -1]) + 1, -1)
            lines = (weight_a[:, :, None] * knots[a]).sum(axis=0)
            sides[2 * face.axis + (not face.is_lower_side)] = (weight_b * lines[:, b]).sum(axis=1)
        return sides
