# mypy: disable-error-code="no-untyped-def, var-annotated, call-overload"
# (the kernels get their types from numba, once per precision)
"""Sides that move as they would in an unbounded domain: what the vorticity in the domain induces there.

By Biot and Savart the velocity anywhere is the far stream's plus what all vorticity, and all divergence of the bodies'
own motion, induces. Both are gathered to square blocks with their first moments and summed up at every eighth face of
the sides, with cubics between. In complex form, with strengths ``c = source - i vortex`` and moments ``m``
about the middle of a block, ``u - i v = (c / z + m / z^2) / (2 pi)``.

**The wake that has left.** A wake goes on behind the domain. In front of a side that carries it out its vorticity is
faded to nothing, over a quarter of the domain; what is missing from there on acts far away like a source with the
strength of the wake's defect, ``integral of (U - u) dy``, and is put in as that. It is the source of strength
``D / (rho U)`` that a body with drag D is from afar. A street of vortices is so replaced by its mean.

Sources: Batchelor 1967, An Introduction to Fluid Dynamics, sections 2.4 and 5.12 (induced velocity, source of a wake);
Weymouth and Lauber 2024, arXiv:2404.09034 (induced velocities as boundary values on a grid).
"""

from dataclasses import dataclass, field

import numpy as np
from numba import prange

from suchus.flow.compiled import PAD, UNIT, Window, part, signed, threaded, unsigned
from suchus.flow.grid import Grid

SIDE = 8
"""Cells along a block, and faces between two points of a side where the induced velocity is summed up [-]."""

FAINT = 1e-6
"""Strength over the largest one below which a block is left out: single precision has no more [-]."""

FADE = 0.25
"""Share of the domain's length over which a wake is faded before it leaves: about a wavelength of a street [-]."""


@part
def _spin_row(total, moment, u, v, row, arm):
    j, pad = unsigned(row), unsigned(PAD)
    for k in range(UNIT, unsigned(total.size)):
        w = (v[j, k + pad] - v[j, k + pad - UNIT]) - (u[j, k + pad] - u[j - UNIT, k + pad])
        total[k] += w
        moment[k] += arm * w


@part
def _spread_row(block, u, v, j, arm, b, window):
    """Add the divergence of row ``j`` of cells in the window to the blocks of row ``b``."""
    for i in range(window[2], window[3]):
        spread = np.float64((u[j, i + 1] - u[j, i]) + (v[j + 1, i] - v[j, i]))
        k = (i - PAD) // SIDE
        across = (i - PAD) + 0.5 - (SIDE * k + 0.5 * (SIDE - 1))
        block[0, b, k] += spread
        block[2, b, k] += spread * across
        block[3, b, k] += spread * arm


@threaded
def gather(u, v, window, block):
    """Write the strengths of the blocks (4, row, column): source, vortex, and the moment's two parts.

    Corners belong to a block by their number, so its middle lies at ``SIDE b + (SIDE - 1) / 2`` cells. Strengths are
    in m/s per cell times cells squared. Divergence is counted in the bodies' window only.
    """
    ny, nx = u.shape[0] - 2 * PAD, u.shape[1] - 2 * PAD
    for n in prange(block.shape[1]):
        b = signed(n)
        middle = SIDE * b + 0.5 * (SIDE - 1)
        total, moment = np.empty(nx, u.dtype), np.empty(nx, u.dtype)
        for k in range(nx):
            total[k], moment[k] = 0, 0
        for c in range(max(SIDE * b, 1), min(SIDE * b + SIDE, ny)):
            j, arm = c + PAD, u.dtype.type(c - middle)
            _spin_row(total, moment, u, v, j, arm)
        for k in range(block.shape[2]):
            vortex, up, along = 0.0, 0.0, 0.0
            for i in range(SIDE * k, min(SIDE * k + SIDE, nx)):
                vortex += total[i]
                up += moment[i]
                along += (i - (SIDE * k + 0.5 * (SIDE - 1))) * total[i]
            block[0, b, k], block[1, b, k], block[2, b, k], block[3, b, k] = 0.0, vortex, up, -along
        for j in range(max(SIDE * b + PAD, window[0]), min(SIDE * b + SIDE + PAD, window[1])):
            _spread_row(block, u, v, j, j - PAD + 0.5 - middle, b, window)


@part
def _induced_at(x, y, place, strength, least):
    """Return the velocity that blocks at ``place`` (2, block) with ``strength`` (4, block) induce at a point."""
    u, v = 0.0, 0.0
    cx, cy = place[0], place[1]
    source, vortex, m_real, m_imag = strength[0], strength[1], strength[2], strength[3]
    for k in range(cx.size):
        dx, dy = x - cx[k], y - cy[k]
        square = dx * dx + dy * dy
        near = 1.0 / (square if square > least else least)
        a, b = dx * near, -dy * near
        c, d = a * a - b * b, 2.0 * a * b
        u += source[k] * a + vortex[k] * b + m_real[k] * c - m_imag[k] * d
        v -= source[k] * b - vortex[k] * a + m_real[k] * d + m_imag[k] * c
    return u / (2.0 * np.pi), v / (2.0 * np.pi)


@threaded
def induce(points, place, strength, out):
    """Write the velocity at ``points`` (2, point) to ``out``; all lengths in cells."""
    least = 0.25 * SIDE**2
    for t in prange(points.shape[1]):
        out[0, t], out[1, t] = _induced_at(points[0, t], points[1, t], place, strength, least)


def cubic(knots: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return which four knots a cubic through them takes at each ``x``, and their weights, both of shape (4, x)."""
    step = knots[1] - knots[0]
    first = np.clip(((x - knots[0]) / step).astype(int) - 1, 0, knots.size - 4)
    t = (x - knots[first]) / step
    nodes = np.arange(4)
    weights = [np.prod([(t - m) / (k - m) for m in nodes if m != k], axis=0) for k in nodes]
    return first + nodes[:, None], np.array(weights)


@dataclass(frozen=True, slots=True)
class Fading:
    """How a wake is faded towards one side."""

    axis: int
    """Axis of the side's normal: 0 is x, 1 is y."""
    low: bool
    """Whether the side is at the smallest coordinate."""
    share: float
    """Share of the vorticity that is faded out [-]."""


@dataclass(slots=True)
class OpenWater:
    """Open water around a grid, all four sides of it."""

    cells: tuple[int, ...]
    """Cells along x and y."""
    points: np.ndarray = field(init=False)
    """Where the sides are summed up, side after side, shape (2, point) [cells]."""
    between: list[tuple[np.ndarray, np.ndarray]] = field(init=False)
    """Which points of a side each face takes, and their weights, per side, each of shape (4, face) [-]."""
    middles: tuple[np.ndarray, np.ndarray] = field(init=False)
    """Middles of the blocks (x, y), each of shape (row, column) [cells]."""
    blocks: np.ndarray = field(init=False)
    """Strengths of the blocks, shape (4, row, column)."""

    def __post_init__(self) -> None:
        nx, ny = self.cells
        rows, columns = -(-ny // SIDE), -(-nx // SIDE)
        self.blocks = np.zeros((4, rows, columns))
        x, y = np.meshgrid(*(SIDE * np.arange(n) + 0.5 * (SIDE - 1) for n in (columns, rows)))
        self.middles = x, y
        points, self.between = [], []
        for axis, at in ((0, 0), (0, nx), (1, 0), (1, ny)):
            along = self.cells[1 - axis]
            knots = np.linspace(0.5, along - 0.5, max(-(-along // SIDE), 3) + 1)
            self.between.append(cubic(knots, np.arange(along) + 0.5))
            pair = np.full(knots.size, float(at)), knots
            points.append(np.array(pair if axis == 0 else pair[::-1]))
        self.points = np.concatenate(points, axis=1)

    @classmethod
    def around(cls, grid: Grid) -> "OpenWater":
        """Return the open water around a grid."""
        return cls(grid.cells)

    def inward(self, velocity: np.ndarray, window: Window, fadings: list[Fading]) -> list[np.ndarray]:
        """Return the velocity into the domain that the fields induce on the faces of each side [m/s].

        Args:
            velocity: on the left and on the lower faces, padded, shape (axis, ...) [m/s].
            window: padded cell indices around the bodies.
            fadings: the sides that carry a wake out.

        The order is left, right, bottom, top. The sum over all faces is zero but for the sources of wakes.
        """
        gather(velocity[0], velocity[1], np.array(window), self.blocks)
        x, y = self.middles
        strength, extra = self.blocks, []
        for fading in fadings:
            strength, sources = self._fade(strength, fading, window)
            extra.append(sources)
        size = np.abs(strength).max(axis=0)
        kept = size > FAINT * size.max()
        place = np.concatenate([np.stack([x[kept], y[kept]]), *(e[:2] for e in extra)], axis=1)
        values = np.concatenate([strength[:, kept], *(e[2:] for e in extra)], axis=1)
        out = np.zeros(self.points.shape)
        induce(self.points, place, values, out)
        return self._on_faces(out)

    def _on_faces(self, out: np.ndarray) -> list[np.ndarray]:
        sides, start = [], 0
        for (index, weight), axis, sign in zip(self.between, (0, 0, 1, 1), (1, -1, 1, -1), strict=True):
            end = start + int(index[-1, -1]) + 1
            sides.append(sign * (weight * out[axis, start:end][index]).sum(axis=0))
            start = end
        return sides

    def _fade(self, strength: np.ndarray, fading: Fading, window: Window) -> tuple[np.ndarray, np.ndarray]:
        """Return faded strengths, and the sources in place of what they lack: x, y and strength, shape (6, source)."""
        axis, cells = fading.axis, self.cells[fading.axis]
        along, across = self.middles[axis], self.middles[1 - axis]
        middle = along[0] if axis == 0 else along[:, 0]
        first, last = (window[2], window[3]) if axis == 0 else (window[0], window[1])
        room = (first if fading.low else cells + 2 * PAD - last) - PAD if last > first else cells
        length = max(min(FADE * cells, room), SIDE)

        def weight(place: np.ndarray) -> np.ndarray:
            share = np.clip((place if fading.low else cells - place) / length, 0.0, 1.0)
            out: np.ndarray = 1 - fading.share * (1 - share**2 * (3 - 2 * share))
            return out

        lost = np.abs(weight(middle + SIDE / 2) - weight(middle - SIDE / 2))  # per column of blocks
        vortex, moment = strength[1], strength[2] if axis == 0 else -strength[3]
        size = np.abs(vortex) * (lost if axis == 0 else lost[:, None])
        centre = float((size * across).sum() / size.sum()) if size.sum() > 0 else 0.0
        defect = -(vortex * (across - centre) + moment).sum(axis=axis) / SIDE
        turn = 1 if (axis == 0) != fading.low else -1
        source = turn * lost * defect
        here = np.stack([middle, np.full(middle.size, centre)])[:: 1 if axis == 0 else -1]
        none = np.zeros(middle.size)
        sheds = source != 0
        keep = weight(middle)
        return strength * (keep if axis == 0 else keep[:, None]), np.stack([*here, source, none, none, none])[:, sheds]
