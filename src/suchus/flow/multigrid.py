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

X, Y, B, CX, CY, DINV = range(6)
"""What ``store[kind]`` holds: solution, its second copy, right side, face coefficients, inverse diagonal."""

FIRST, SECOND = 0.5617, 1.3896
"""Jacobi weights: Chebyshev roots for the eigenvalues 0.5 to 2 of the scaled operator [-]."""

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
def seal_row(row, periodic):
    """Fill the two cells beside a row's ends that the stencil reads."""
    n = row.size
    if periodic:
        row[PAD - 1] = row[n - PAD - 1]
        row[n - PAD] = row[PAD]
    else:
        row[PAD - 1] = row[PAD]
        row[n - PAD] = row[n - PAD - 1]


@compiled
def seal_ends(x, periodic):
    """Fill the row below the first and the row above the last."""
    n = x.shape[0]
    if periodic:
        x[PAD - 1] = x[n - PAD - 1]
        x[n - PAD] = x[PAD]
    else:
        x[PAD - 1] = x[PAD]
        x[n - PAD] = x[n - PAD - 1]


@compiled
def _apply_plain(out, mid, left, right, low, high):
    """Write the operator times x along a row where all coefficients are 1."""
    four = out.dtype.type(4.0)
    for k in range(out.size):
        out[k] = four * mid[k] - ((left[k] + right[k]) + (low[k] + high[k]))


@compiled
def _apply_body(out, mid, left, right, low, high, c_left, c_right, c_low, c_high):
    """Write the operator times x along a row with coefficients."""
    for k in range(out.size):
        m = mid[k]
        out[k] = (c_left[k] * (m - left[k]) + c_right[k] * (m - right[k])) + (
            c_low[k] * (m - low[k]) + c_high[k] * (m - high[k])
        )


@compiled
def apply_row(out, x, cx, cy, place, j):
    """Write the operator times ``x`` along row ``j`` to ``out``, which has the width of the domain."""
    s, e = PAD, PAD + out.size
    m, a, b = x[j], x[j - 1], x[j + 1]
    _apply_plain(out, m[s:e], m[s - 1 : e - 1], m[s + 1 : e + 1], a[s:e], b[s:e])
    if place[3] <= j < place[4]:
        s, e = place[5], place[6]
        _apply_body(
            out[s - PAD : e - PAD],
            m[s:e],
            m[s - 1 : e - 1],
            m[s + 1 : e + 1],
            a[s:e],
            b[s:e],
            cx[j, s:e],
            cx[j, s + 1 : e + 1],
            cy[j, s:e],
            cy[j + 1, s:e],
        )


@compiled
def _first_row(out, b, left, right, low, high, w1, w2):
    """Write two smoothing steps that start from nothing, where all coefficients are 1."""
    once = b.dtype.type(0.25) * w1
    own = once + w2 * b.dtype.type(0.25) - w2 * once
    near = w2 * b.dtype.type(0.25) * once
    for k in range(out.size):
        out[k] = own * b[k] + near * ((left[k] + right[k]) + (low[k] + high[k]))


@compiled
def _presmooth(x, b, cx, cy, dinv, place, j0, j1, periodic):
    w1, w2 = x.dtype.type(FIRST), x.dtype.type(SECOND)
    s, e = PAD, x.shape[1] - PAD
    for j in range(j0, j1):
        m = b[j]
        _first_row(x[j, s:e], m[s:e], m[s - 1 : e - 1], m[s + 1 : e + 1], b[j - 1, s:e], b[j + 1, s:e], w1, w2)
        if place[3] <= j < place[4]:
            for i in range(place[5], place[6]):
                y = w1 * dinv[j, i] * b[j, i]
                a = (
                    cx[j, i] * (y - w1 * dinv[j, i - 1] * b[j, i - 1])
                    + cx[j, i + 1] * (y - w1 * dinv[j, i + 1] * b[j, i + 1])
                    + cy[j, i] * (y - w1 * dinv[j - 1, i] * b[j - 1, i])
                    + cy[j + 1, i] * (y - w1 * dinv[j + 1, i] * b[j + 1, i])
                )
                x[j, i] = y + w2 * dinv[j, i] * (b[j, i] - a)
        seal_row(x[j], periodic)


@compiled
def _relax_plain(out, b, mid, left, right, low, high, weight):
    """Write one Jacobi step along a row where all coefficients are 1."""
    quarter = weight * out.dtype.type(0.25)
    stay = out.dtype.type(1.0) - weight
    for k in range(out.size):
        out[k] = stay * mid[k] + quarter * (b[k] + ((left[k] + right[k]) + (low[k] + high[k])))


@compiled
def _relax_body(out, b, dinv, mid, ax, weight):
    for k in range(out.size):
        out[k] = mid[k] + weight * dinv[k] * (b[k] - ax[k])


@compiled
def _smooth(out, x, b, cx, cy, dinv, place, j0, j1, weight, periodic):
    s, e = PAD, x.shape[1] - PAD
    ax = np.empty(place[6] - place[5], x.dtype)
    for j in range(j0, j1):
        m = x[j]
        _relax_plain(
            out[j, s:e], b[j, s:e], m[s:e], m[s - 1 : e - 1], m[s + 1 : e + 1], x[j - 1, s:e], x[j + 1, s:e], weight
        )
        if place[3] <= j < place[4]:
            f, t = place[5], place[6]
            _apply_body(
                ax,
                m[f:t],
                m[f - 1 : t - 1],
                m[f + 1 : t + 1],
                x[j - 1, f:t],
                x[j + 1, f:t],
                cx[j, f:t],
                cx[j, f + 1 : t + 1],
                cy[j, f:t],
                cy[j + 1, f:t],
            )
            _relax_body(out[j, f:t], b[j, f:t], dinv[j, f:t], m[f:t], ax, weight)
        seal_row(out[j], periodic)


@compiled
def _smooth_window(out, x, b, cx, cy, dinv, place, weight):
    f, t = place[5], place[6]
    ax = np.empty(t - f, x.dtype)
    for j in range(place[3], place[4]):
        m = x[j]
        _apply_body(
            ax, m[f:t], m[f - 1 : t - 1], m[f + 1 : t + 1], x[j - 1, f:t], x[j + 1, f:t],
            cx[j, f:t], cx[j, f + 1 : t + 1], cy[j, f:t], cy[j + 1, f:t],
        )  # fmt: skip
        _relax_body(out[j, f:t], b[j, f:t], dinv[j, f:t], m[f:t], ax, weight)


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
        _presmooth(x, b, cx, cy, dinv, place, j0, min(j0 + BLOCK, end), periodic)


@threaded
def _smooth_threaded(out, x, b, cx, cy, dinv, place, weight, periodic):
    end = x.shape[0] - PAD
    for k in prange((end - PAD + BLOCK - 1) // BLOCK):
        j0 = PAD + k * BLOCK
        _smooth(out, x, b, cx, cy, dinv, place, j0, min(j0 + BLOCK, end), weight, periodic)


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
        _smooth(y, x, b, cx, cy, dinv, place, PAD, end, weight, periodic[0])
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
            _presmooth(x, b, cx, cy, dinv, place, PAD, x.shape[0] - PAD, px)
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
            _smooth(y, x, b, cx, cy, dinv, place, PAD, x.shape[0] - PAD, real(SECOND), px)
            seal_ends(y, py)
            _smooth(x, y, b, cx, cy, dinv, place, PAD, x.shape[0] - PAD, real(FIRST), px)
        else:
            _prolong_threaded(x, coarse, px)
            seal_ends(x, py)
            _smooth_threaded(y, x, b, cx, cy, dinv, place, real(SECOND), px)
            seal_ends(y, py)
            _smooth_threaded(x, y, b, cx, cy, dinv, place, real(FIRST), px)
        seal_ends(x, py)
        for _ in range(EXTRA):
            _smooth_window(y, x, b, cx, cy, dinv, place, real(SECOND))
            _smooth_window(x, y, b, cx, cy, dinv, place, real(FIRST))


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
