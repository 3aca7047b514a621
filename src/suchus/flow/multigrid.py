# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision)
"""Geometric multigrid for ``-div(c grad x) = b`` on the cells: one cycle, used as a preconditioner.

All levels live in one array ``store[kind, ...]``, level after level, each with ``PAD`` cells around it. The
coefficient ``c`` differs from 1 only inside a window of each level; everywhere else the kernels use the
plain five-point stencil, which needs no coefficients from memory. Outer walls: no flux (mirrored) or periodic.

Smoothing: two steps of Chebyshev-weighted Jacobi before and after, prolongation bilinear, restriction by sums.
Source: Briggs, Henson and McCormick 2000, A Multigrid Tutorial, SIAM.
"""

import numpy as np
from numba import prange

from suchus.flow.compiled import BLOCK, PAD, SERIAL_BELOW, compiled, threaded
from suchus.flow.stencil import FIRST, SECOND, apply_row, presmooth, seal_ends, seal_row, smooth, smooth_window

X, Y, B, CX, CY, DINV = range(6)
"""What ``store[kind]`` holds: solution, its second copy, right side, face coefficients, inverse diagonal."""

EXTRA = 3
"""Pairs of extra smoothing steps in the body's window, where the coefficients vary [-]."""

COARSEST = 32
"""Most cells along a side of the last level, which is solved by smoothing alone [-]."""


@compiled
def level(store, layout, kind, k):
    """Return the array of one kind on level ``k``; layout rows are (offset, ny, nx, window j0, j1, i0, i1)."""
    start, ny, nx = layout[k, 0], layout[k, 1] + 2 * PAD, layout[k, 2] + 2 * PAD
    return store[kind, start : start + ny * nx].reshape(ny, nx)


@compiled
def _subtract_rows(rest, b_low, b_high, a_low, a_high):
    for k in range(rest.size):
        rest[k] = (b_low[k] + b_high[k]) - (a_low[k] + a_high[k])


@compiled
def _restrict(coarse, x, b, cx, cy, place, j0, j1, periodic):
    """Write the summed residual of rows ``j0`` to ``j1`` (coarse) to ``coarse``."""
    nx = x.shape[1] - 2 * PAD
    a_low, a_high, rest = np.empty(nx, x.dtype), np.empty(nx, x.dtype), np.empty(nx, x.dtype)
    for cj in range(j0, j1):
        j = 2 * (cj - PAD) + PAD
        apply_row(a_low, x, cx, cy, place, j)
        apply_row(a_high, x, cx, cy, place, j + 1)
        _subtract_rows(rest, b[j, PAD : PAD + nx], b[j + 1, PAD : PAD + nx], a_low, a_high)
        row = coarse[cj]
        for k in range(nx // 2):
            row[PAD + k] = rest[2 * k] + rest[2 * k + 1]
        seal_row(row, periodic)


@compiled
def _prolong(x, coarse, j0, j1, periodic):
    """Add the bilinear interpolation of ``coarse`` to rows ``j0`` to ``j1`` of ``x``."""
    nc = coarse.shape[1] - 2 * PAD
    mix = np.empty(nc + 2, x.dtype)
    most, some = x.dtype.type(0.75), x.dtype.type(0.25)
    for j in range(j0, j1):
        cj = (j - PAD) // 2 + PAD
        near = coarse[cj]
        far = coarse[cj - 1] if (j - PAD) % 2 == 0 else coarse[cj + 1]
        a, b = near[PAD - 1 : PAD + nc + 1], far[PAD - 1 : PAD + nc + 1]
        for k in range(nc + 2):
            mix[k] = most * a[k] + some * b[k]
        row = x[j]
        for k in range(nc):
            row[PAD + 2 * k] += most * mix[k + 1] + some * mix[k]
            row[PAD + 2 * k + 1] += most * mix[k + 1] + some * mix[k + 2]
        seal_row(row, periodic)


@threaded
def _presmooth_threaded(x, b, cx, cy, dinv, place, periodic):
    end = x.shape[0] - PAD
    for k in prange((end - PAD + BLOCK - 1) // BLOCK):
        j0 = PAD + k * BLOCK
        presmooth(x, b, cx, cy, dinv, place, j0, min(j0 + BLOCK, end), periodic)


@threaded
def _smooth_threaded(out, x, b, cx, cy, dinv, place, weight, periodic):
    end = x.shape[0] - PAD
    for k in prange((end - PAD + BLOCK - 1) // BLOCK):
        j0 = PAD + k * BLOCK
        smooth(out, x, b, cx, cy, dinv, place, j0, min(j0 + BLOCK, end), weight, periodic)


@threaded
def _restrict_threaded(coarse, x, b, cx, cy, place, periodic):
    end = coarse.shape[0] - PAD
    for k in prange((end - PAD + BLOCK - 1) // BLOCK):
        j0 = PAD + k * BLOCK
        _restrict(coarse, x, b, cx, cy, place, j0, min(j0 + BLOCK, end), periodic)


@threaded
def _prolong_threaded(x, coarse, periodic):
    end = x.shape[0] - PAD
    for k in prange((end - PAD + BLOCK - 1) // BLOCK):
        j0 = PAD + k * BLOCK
        _prolong(x, coarse, j0, min(j0 + BLOCK, end), periodic)


@compiled
def _solve_coarsest(x, y, b, cx, cy, dinv, place, periodic):
    end, wide = x.shape[0] - PAD, x.shape[1] - PAD
    x[:] = 0
    total, live = 0.0, 0
    for j in range(PAD, end):
        for i in range(PAD, wide):
            if dinv[j, i] > 0:
                total += b[j, i]
                live += 1
    mean = b.dtype.type(total / max(live, 1))  # without walls that fix it, the pressure has no level of its own
    for j in range(PAD, end):
        for i in range(PAD, wide):
            b[j, i] -= mean
    for k in range(2 * max(end, wide)):
        weight = x.dtype.type(FIRST if k % 2 == 0 else SECOND)
        smooth(y, x, b, cx, cy, dinv, place, PAD, end, weight, periodic[0])
        seal_ends(y, periodic[1])
        x, y = y, x


@compiled
def cycle(store, layout, periodic):
    """Write one V-cycle for the right side ``B`` of level 0, started from nothing, to its ``X``."""
    last = layout.shape[0] - 1
    px, py = periodic[0], periodic[1]
    real = store.dtype.type
    for k in range(last):
        x, b = level(store, layout, X, k), level(store, layout, B, k)
        cx, cy, dinv = level(store, layout, CX, k), level(store, layout, CY, k), level(store, layout, DINV, k)
        coarse = level(store, layout, B, k + 1)
        place = layout[k]
        seal_ends(b, py)
        if place[1] * place[2] < SERIAL_BELOW:
            presmooth(x, b, cx, cy, dinv, place, PAD, x.shape[0] - PAD, px)
            seal_ends(x, py)
            _restrict(coarse, x, b, cx, cy, place, PAD, coarse.shape[0] - PAD, px)
        else:
            _presmooth_threaded(x, b, cx, cy, dinv, place, px)
            seal_ends(x, py)
            _restrict_threaded(coarse, x, b, cx, cy, place, px)
    _solve_coarsest(
        level(store, layout, X, last),
        level(store, layout, Y, last),
        level(store, layout, B, last),
        level(store, layout, CX, last),
        level(store, layout, CY, last),
        level(store, layout, DINV, last),
        layout[last],
        periodic,
    )
    for k in range(last - 1, -1, -1):
        x, y, b = level(store, layout, X, k), level(store, layout, Y, k), level(store, layout, B, k)
        cx, cy, dinv = level(store, layout, CX, k), level(store, layout, CY, k), level(store, layout, DINV, k)
        coarse = level(store, layout, X, k + 1)
        place = layout[k]
        if place[1] * place[2] < SERIAL_BELOW:
            _prolong(x, coarse, PAD, x.shape[0] - PAD, px)
            seal_ends(x, py)
            smooth(y, x, b, cx, cy, dinv, place, PAD, x.shape[0] - PAD, real(SECOND), px)
            seal_ends(y, py)
            smooth(x, y, b, cx, cy, dinv, place, PAD, x.shape[0] - PAD, real(FIRST), px)
        else:
            _prolong_threaded(x, coarse, px)
            seal_ends(x, py)
            _smooth_threaded(y, x, b, cx, cy, dinv, place, real(SECOND), px)
            seal_ends(y, py)
            _smooth_threaded(x, y, b, cx, cy, dinv, place, real(FIRST), px)
        seal_ends(x, py)
        for _ in range(EXTRA):
            smooth_window(y, x, b, cx, cy, dinv, place, real(SECOND))
            smooth_window(x, y, b, cx, cy, dinv, place, real(FIRST))


@compiled
def _coefficients(cx, cy, dinv, place):
    """Fill the inverse diagonal in the window; a cell with no open face gets 0."""
    small = cx.dtype.type(1e-6)
    for j in range(place[3], place[4]):
        for i in range(place[5], place[6]):
            total = (cx[j, i] + cx[j, i + 1]) + (cy[j, i] + cy[j + 1, i])
            dinv[j, i] = 1 / total if total > small else 0


@compiled
def coarsen(store, layout):
    """Fill the inverse diagonals and every coarser level's coefficients inside the windows.

    A coarse face carries what its two fine faces carry, over twice the distance.
    """
    half = store.dtype.type(0.5)
    for k in range(layout.shape[0]):
        cx, cy = level(store, layout, CX, k), level(store, layout, CY, k)
        _coefficients(cx, cy, level(store, layout, DINV, k), layout[k])
        if k + 1 == layout.shape[0]:
            return
        fx, fy = level(store, layout, CX, k + 1), level(store, layout, CY, k + 1)
        place = layout[k + 1]
        for cj in range(place[3], place[4] + 1):
            j = 2 * (cj - PAD) + PAD
            for ci in range(place[5], place[6] + 1):
                i = 2 * (ci - PAD) + PAD
                fx[cj, ci] = half * (cx[j, i] + cx[j + 1, i])
                fy[cj, ci] = half * (cy[j, i] + cy[j, i + 1])
