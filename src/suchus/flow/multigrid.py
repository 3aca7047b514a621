# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision)
"""Geometric multigrid for ``-div(c grad x) = b`` on the cells: one cycle, used as a preconditioner.

All levels live in one array ``store[kind, ...]``, level after level, each with ``PAD`` cells around it. The
coefficient ``c`` differs from 1 only inside a window of each level; everywhere else the kernels use the
plain five-point stencil, which needs no coefficients from memory. Outer walls: no flux (mirrored) or periodic.

Smoothing: two steps of Chebyshev-weighted Jacobi before and after, and more in the window; prolongation bilinear,
restriction by sums. What happens to a level on the way down, and what on the way up, is one sweep each over blocks of
rows: a row is smoothed as soon as its neighbours are there, and what lies between is kept in rows that stay in the
processor's nearest cache. The first steps, which start from nothing, are done again on the way up, not stored.
Source: Briggs, Henson and McCormick 2000, A Multigrid Tutorial, SIAM.
"""

import numpy as np
from numba import prange

from suchus.flow.compiled import BLOCK, PAD, SERIAL_BELOW, UNIT, compiled, part, signed, threaded_part, unsigned
from suchus.flow.patch import ONE, end, give_row, patch, start, take_coefficients
from suchus.flow.stencil import FIRST, SECOND, apply_rows, copy_row, first_row, relax_rows, seal_ends, seal_row, smooth

X, B, CX, CY, DINV = range(5)
"""What ``store[kind]`` holds: solution, right side, face coefficients, inverse diagonal."""

COARSEST = 32
"""Most cells along a side of the last level, which is solved by smoothing alone [-]."""


@part
def level(store, layout, kind, k):
    """Return the array of one kind on level ``k``; layout rows are (offset, ny, nx, window j0, j1, i0, i1)."""
    start, ny, nx = layout[k, 0], layout[k, 1] + 2 * PAD, layout[k, 2] + 2 * PAD
    return store[kind, start : start + ny * nx].reshape(ny, nx)


@part
def _fold(j, ny, periodic):
    """Return the row of the domain that row ``j``, which may lie beyond a wall, is a copy of."""
    if periodic:
        return (j - PAD + ny) % ny + PAD
    return min(max(j, PAD), PAD + ny - 1)


@part
def _first(out, o, b, own, rect, row, periodic):
    """Write row ``row`` after the first smoothing steps to row ``o`` of ``out``."""
    first_row(out, o, 0, b, row, PAD, b.shape[1] - PAD)
    give_row(out, o, own, rect, row)
    seal_row(out, o, periodic)


@part
def _sum_rest(coarse, coarse_row, rest, b, row):
    """Write to a coarse row what two rows of the right side have more than rows 0 and 1 of ``rest``."""
    c, j, pad = unsigned(coarse_row), unsigned(row), unsigned(PAD)
    for k in range(pad, unsigned(b.shape[1]) - pad):
        rest[0, k] = (b[j, k] + b[j + UNIT, k]) - (rest[0, k] + rest[1, k])
    for k in range(pad, unsigned(coarse.shape[1]) - pad):
        i = k + k - pad
        coarse[c, k] = rest[0, i] + rest[0, i + UNIT]


@part
def _down(coarse, b, cx, cy, place, room, rect, j0, j1, periodic):
    """Write the summed residual after the first smoothing steps to rows ``j0`` to ``j1`` of ``coarse``."""
    ny, own = place[1], patch(room, rect, ONE)
    rest, rows = np.empty((2, b.shape[1]), b.dtype), np.empty((4, b.shape[1]), b.dtype)
    low, mid, high, top = 0, 1, 2, 3
    j = 2 * (j0 - PAD) + PAD
    _first(rows, low, b, own, rect, _fold(j - 1, ny, periodic[1]), periodic[0])
    _first(rows, mid, b, own, rect, j, periodic[0])
    for cj in range(j0, j1):
        j = 2 * (cj - PAD) + PAD
        _first(rows, high, b, own, rect, j + 1, periodic[0])
        _first(rows, top, b, own, rect, _fold(j + 2, ny, periodic[1]), periodic[0])
        apply_rows(rest, 0, rows, low, mid, high, cx, cy, place, j)
        apply_rows(rest, 1, rows, mid, high, top, cx, cy, place, j + 1)
        _sum_rest(coarse, cj, rest, b, j)
        seal_row(coarse, cj, periodic[0])
        low, mid, high, top = high, top, low, mid


@part
def _add_coarse(out, o, coarse, mix, row):
    """Add to row ``o`` of ``out``, which is row ``row`` of its level, what lies bilinearly between the coarse cells."""
    near = unsigned((row - PAD) // 2 + PAD)
    far = near - UNIT if (row - PAD) % 2 == 0 else near + UNIT
    o, pad, most, some = unsigned(o), unsigned(PAD), out.dtype.type(0.75), out.dtype.type(0.25)
    for k in range(pad - UNIT, unsigned(coarse.shape[1]) - pad + UNIT):
        mix[k] = most * coarse[near, k] + some * coarse[far, k]
    for k in range(pad, unsigned(coarse.shape[1]) - pad):
        i = k + k - pad
        out[o, i] += most * mix[k] + some * mix[k - UNIT]
        out[o, i + UNIT] += most * mix[k] + some * mix[k + UNIT]


@part
def _up(x, b, coarse, cx, cy, dinv, place, room, rect, j0, j1, periodic):
    """Write the first smoothing steps, the coarse correction and the last two steps to rows ``j0`` to ``j1``."""
    px, py = periodic[0], periodic[1]
    ny, own = place[1], patch(room, rect, ONE)
    rows, mix = np.empty((6, b.shape[1]), b.dtype), np.empty(coarse.shape[1], b.dtype)
    one, two = b.dtype.type(SECOND), b.dtype.type(FIRST)
    a, m, z = 0, 1, 2  # rows that the last step but one reads
    low, mid, high = 3, 4, 5  # rows that the last step reads
    for j in range(j0 - 2, j1 + 2):
        a, m, z = m, z, a
        here = _fold(j, ny, py)
        _first(rows, z, b, own, rect, here, px)
        _add_coarse(rows, z, coarse, mix, here)
        seal_row(rows, z, px)
        if j < j0:
            continue
        low, mid, high = mid, high, low
        if j > PAD + ny and not py:
            copy_row(rows, high, rows, mid)
        else:
            here = _fold(j - 1, ny, py)
            relax_rows(rows, high, rows, a, m, z, b, cx, cy, dinv, place, here, one, px)
        if j == PAD + 1 and not py:
            copy_row(rows, mid, rows, high)
        if j >= j0 + 2:
            relax_rows(x, j - 2, rows, low, mid, high, b, cx, cy, dinv, place, j - 2, two, px)


@threaded_part
def _down_threaded(coarse, b, cx, cy, place, room, rect, periodic):
    end = coarse.shape[0] - PAD
    for n in prange((end - PAD + BLOCK - 1) // BLOCK):
        k = signed(n)
        j0 = PAD + k * BLOCK
        _down(coarse, b, cx, cy, place, room, rect, j0, min(j0 + BLOCK, end), periodic)


@threaded_part
def _up_threaded(x, b, coarse, cx, cy, dinv, place, room, rect, periodic):
    end = x.shape[0] - PAD
    for n in prange((end - PAD + BLOCK - 1) // BLOCK):
        k = signed(n)
        j0 = PAD + k * BLOCK
        _up(x, b, coarse, cx, cy, dinv, place, room, rect, j0, min(j0 + BLOCK, end), periodic)


@part
def _solve_coarsest(x, b, cx, cy, dinv, place, periodic):
    y = np.empty(x.shape, x.dtype)
    end, wide = x.shape[0] - PAD, x.shape[1] - PAD
    for j in range(x.shape[0]):
        for i in range(x.shape[1]):
            x[j, i] = 0
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
        smooth(y, x, b, cx, cy, dinv, place, weight, periodic[0])
        seal_ends(y, periodic[1])
        x, y = y, x


@part
def cycle(x, store, layout, room, rects, periodic):
    """Write one V-cycle for the right side ``B`` of level 0, started from nothing, to ``x``."""
    last = layout.shape[0] - 1
    for k in range(last):
        b, coarse = level(store, layout, B, k), level(store, layout, B, k + 1)
        cx, cy, place, rect = level(store, layout, CX, k), level(store, layout, CY, k), layout[k], rects[k]
        seal_ends(b, periodic[1])
        if rect[1] < rect[2]:
            start(room, rect, b)
        if place[1] * place[2] < SERIAL_BELOW:
            _down(coarse, b, cx, cy, place, room, rect, PAD, coarse.shape[0] - PAD, periodic)
        else:
            _down_threaded(coarse, b, cx, cy, place, room, rect, periodic)
    _solve_coarsest(
        x if last == 0 else level(store, layout, X, last),
        level(store, layout, B, last),
        level(store, layout, CX, last),
        level(store, layout, CY, last),
        level(store, layout, DINV, last),
        layout[last],
        periodic,
    )
    for k in range(last - 1, -1, -1):
        b, coarse = level(store, layout, B, k), level(store, layout, X, k + 1)
        cx, cy, dinv = level(store, layout, CX, k), level(store, layout, CY, k), level(store, layout, DINV, k)
        place, rect, out = layout[k], rects[k], x if k == 0 else level(store, layout, X, k)
        if place[1] * place[2] < SERIAL_BELOW:
            _up(out, b, coarse, cx, cy, dinv, place, room, rect, PAD, out.shape[0] - PAD, periodic)
        else:
            _up_threaded(out, b, coarse, cx, cy, dinv, place, room, rect, periodic)
        if rect[1] < rect[2]:
            end(room, rect, out)
        seal_ends(out, periodic[1])


@part
def _coefficients(cx, cy, dinv, place):
    """Fill the inverse diagonal in the window; a cell with no open face gets 0."""
    small = cx.dtype.type(1e-6)
    for j in range(place[3], place[4]):
        for i in range(place[5], place[6]):
            total = (cx[j, i] + cx[j, i + 1]) + (cy[j, i] + cy[j + 1, i])
            dinv[j, i] = 1 / total if total > small else 0


@part
def _in_line(before, here, after):
    """Return the coefficient of three faces in line between the middles of two coarse cells, the outer ones halved."""
    resistance = here * after + 2 * before * after + before * here
    return 4 * before * here * after / resistance if resistance > 0 else before


@part
def _joined(one, two):
    """Return a coarse face's coefficient from those of its two fine faces and of the faces before and behind them.

    What the two carry side by side lets the water through bodies thinner than a coarse cell; what the faces carry in
    line blocks it beside their ends too. With the geometric mean of both a solve needs half the cycles of the first.
    """
    half = one.dtype.type(0.5)
    beside = half * (one[1] + two[1])
    in_line = half * (_in_line(one[0], one[1], one[2]) + _in_line(two[0], two[1], two[2]))
    return np.sqrt(beside * in_line)


@compiled
def coarsen(store, layout):
    """Fill the inverse diagonals and every coarser level's coefficients inside the windows."""
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
                fx[cj, ci] = _joined(cx[j, i - 1 : i + 2], cx[j + 1, i - 1 : i + 2])
                fy[cj, ci] = _joined(cy[j - 1 : j + 2, i], cy[j - 1 : j + 2, i + 1])


@compiled
def spread(store, layout, room, rects):
    """Copy the coefficients of all levels to the room; see ``patch``."""
    for k in range(layout.shape[0] - 1):
        if rects[k, 1] < rects[k, 2]:
            cx, cy = level(store, layout, CX, k), level(store, layout, CY, k)
            take_coefficients(room, rects[k], cx, cy, level(store, layout, DINV, k))
