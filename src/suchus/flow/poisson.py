# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision)
"""The pressure equation: conjugate gradients, preconditioned by one multigrid cycle.

Solves ``-div(c grad x) = b`` from nothing; the caller has already applied the last pressure, which is the warm
start. Stops when both the mean and the largest residual are small. The multigrid cycle is not symmetric, so each
new direction is made orthogonal to the last one explicitly (flexible conjugate gradients, Notay 2000, SIAM J.
Sci. Comput. 22, 1444-1460).
"""

from dataclasses import dataclass

import numpy as np
from numba import prange

from suchus.flow.compiled import BLOCK, PAD, compiled, part, signed, threaded_part, unsigned
from suchus.flow.multigrid import CX, CY, DINV, B, X, cycle, level
from suchus.flow.stencil import LANES, apply_rows, copy_row, largest_size, seal_row

PARALLEL = 1e-3
"""Share of (z, A z) that must be left once z is orthogonal to the last direction: with less it stays as it is [-]."""

WORSE = 3.0
"""Growth of the residual over the smallest so far at which a solve that is ``NEARLY`` done drops the iteration [-]."""

STALLED = 3
"""Cycles without progress after which rounding, not the residual, is what is left [-]."""

NEARLY = 10.0
"""Residual over its limit below which that many cycles count [-]; farther off, a body hinders the cycles, and ..."""

PATIENCE = 15
"""... so many may pass [-]."""


@part
def _dots(z, az, r, d, row):
    """Return (z, A z), (d, A z), (r, z) and (r, d) of a row; the last is nearly nothing, so r's sums are double."""
    zero, j = z.dtype.type(0.0), unsigned(row)
    own, old, gain, left = zero, zero, 0.0, 0.0
    for k in range(unsigned(PAD), unsigned(z.shape[1] - PAD)):
        own += z[j, k] * az[0, k]
        old += d[j, k] * az[0, k]
        gain += np.float64(r[j, k]) * np.float64(z[j, k])
        left += np.float64(r[j, k]) * np.float64(d[j, k])
    return own, old, gain, left


@threaded_part
def _measure(z, r, d, cx, cy, place, sums):
    """Write the row sums of (z, A z), (d, A z), (r, z) and (r, d)."""
    end = z.shape[0] - PAD
    for n in prange((end - PAD + BLOCK - 1) // BLOCK):
        block = signed(n)
        az = np.empty((1, z.shape[1]), z.dtype)
        for j in range(PAD + block * BLOCK, min(PAD + (block + 1) * BLOCK, end)):
            apply_rows(az, 0, z, j - 1, j, j + 1, cx, cy, place, j)
            sums[j, 0], sums[j, 1], sums[j, 2], sums[j, 3] = _dots(z, az, r, d, j)


@part
def _mix(out, o, z, d, row, a, b):
    o, j = unsigned(o), unsigned(row)
    for k in range(unsigned(z.shape[1])):
        out[o, k] = a * z[j, k] + b * d[j, k]


@part
def _rise(x, e, row, alpha):
    j = unsigned(row)
    for k in range(unsigned(x.shape[1])):
        x[j, k] += alpha * e[j, k]


@part
def _lower(r, row, q, alpha):
    """Subtract ``alpha`` times the one row of ``q`` from a row of ``r``; return its summed size."""
    total, j = r.dtype.type(0.0), unsigned(row)
    for k in range(unsigned(PAD), unsigned(r.shape[1] - PAD)):
        r[j, k] -= alpha * q[0, k]
        total += abs(r[j, k])
    return total


@threaded_part
def _first_step(r, z, cx, cy, place, alpha, periodic, sums):
    """Write ``r -= alpha A z`` and the row sums of |r| and largest |r|."""
    end = z.shape[0] - PAD
    for n in prange((end - PAD + BLOCK - 1) // BLOCK):
        block = signed(n)
        q, top = np.empty((1, z.shape[1]), z.dtype), np.empty(LANES, z.dtype)
        for j in range(PAD + block * BLOCK, min(PAD + (block + 1) * BLOCK, end)):
            apply_rows(q, 0, z, j - 1, j, j + 1, cx, cy, place, j)
            sums[j, 0] = _lower(r, j, q, alpha)
            sums[j, 1] = largest_size(r, j, top)
            seal_row(r, j, periodic)


@threaded_part
def _step(r, z, d, cx, cy, place, alpha, beta, periodic, sums):
    """Write ``r -= alpha A (z + beta d)`` and the row sums of |r| and largest |r|."""
    end, one = z.shape[0] - PAD, z.dtype.type(1.0)
    for n in prange((end - PAD + BLOCK - 1) // BLOCK):
        block = signed(n)
        q, top = np.empty((1, z.shape[1]), z.dtype), np.empty(LANES, z.dtype)
        rows = np.empty((3, z.shape[1]), z.dtype)
        low, mid, high = 0, 1, 2
        first, last = PAD + block * BLOCK, min(PAD + (block + 1) * BLOCK, end)
        for j in range(first - 1, last + 1):
            low, mid, high = mid, high, low
            _mix(rows, high, z, d, j, one, beta)
            if j > first:
                c = j - 1
                apply_rows(q, 0, rows, low, mid, high, cx, cy, place, c)
                sums[c, 0] = _lower(r, c, q, alpha)
                sums[c, 1] = largest_size(r, c, top)
                seal_row(r, c, periodic)


@threaded_part
def _keep(x, e, z, d, alpha, beta, before):
    """Write ``e = z + beta d`` and ``x = alpha e + before d``, or ``x += alpha e`` if ``before`` is 0."""
    one = z.dtype.type(1.0)
    for n in prange((x.shape[0] + BLOCK - 1) // BLOCK):
        block = signed(n)
        for j in range(block * BLOCK, min((block + 1) * BLOCK, x.shape[0])):
            _mix(e, j, z, d, j, one, beta)
            if before != 0:
                _mix(x, j, z, d, j, alpha, alpha * beta + before)
            else:
                _rise(x, e, j, alpha)


@part
def _total(sums, column):
    total, k = 0.0, unsigned(column)
    for j in range(unsigned(PAD), unsigned(sums.shape[0] - PAD)):
        total += sums[j, k]
    return total


@part
def _most(sums, column):
    most, k = 0.0, unsigned(column)
    for j in range(unsigned(PAD), unsigned(sums.shape[0] - PAD)):
        most = sums[j, k] if sums[j, k] > most else most
    return most


@compiled
def solve(x, d, q, store, layout, room, rects, periodic, sums, mean_limit, max_limit, most):
    """Solve for the right side ``B`` of level 0, in which the residual is left; ``x``, ``d`` and ``q`` are room.

    One iteration or two are what a step of the flow takes, so what they add up to is left to who reads it.

    Returns:
        iterations, mean residual, largest residual, and the numbers ``a`` and ``b`` with which the solution is
        ``a d + b X``, where ``X`` is that of level 0.
    """
    r, z = level(store, layout, B, 0), level(store, layout, X, 0)
    cx, cy = level(store, layout, CX, 0), level(store, layout, CY, 0)
    real = store.dtype.type
    place = layout[0]
    cells = layout[0, 1] * layout[0, 2]
    last, alpha, beta, before = 1.0, 0.0, 0.0, 0.0
    begun, due, kept = d, False, False
    mean, largest, best, since = 0.0, 0.0, np.inf, 0
    k = 0
    while k < most and since < (STALLED if best <= NEARLY else PATIENCE):
        if k >= 2:
            _keep(x, q, z, d, real(alpha), real(beta), real(before))
            d, q, before, due, kept = q, d, 0.0, False, True
        cycle(d if k == 0 else z, store, layout, room, rects, periodic)
        _measure(d if k == 0 else z, r, d, cx, cy, place, sums)
        own, old, gain = _total(sums, 0), _total(sums, 1), _total(sums, 2)
        turn = 0.0 if k == 0 else -old / last
        last = own + turn * old
        if last < PARALLEL * own:
            turn, last = 0.0, own
        if not last > 0:
            break
        alpha, beta = (gain + turn * _total(sums, 3)) / last, turn
        if k == 0:
            _first_step(r, d, cx, cy, place, real(alpha), periodic[0], sums)
            before = alpha
        else:
            _step(r, z, d, cx, cy, place, real(alpha), real(beta), periodic[0], sums)
            due = True
        k += 1
        told = mean, largest
        mean, largest = _total(sums, 0) / cells, _most(sums, 1)
        if mean <= mean_limit and largest <= max_limit:
            break
        worst = max(mean / mean_limit, largest / max_limit)
        if k > 2 and worst > WORSE * best and best <= NEARLY:
            mean, largest = told
            due = False
            break
        since = 0 if worst < 0.8 * best else since + 1
        best = min(best, worst)
    if not kept:
        return k, mean, largest, before + due * alpha * beta, due * alpha
    if due:
        _keep(x, q, z, d, real(alpha), real(beta), real(before))
    for j in range(x.shape[0]):
        copy_row(begun, j, x, j)
    return k, mean, largest, 1.0, 0.0


@dataclass(slots=True)
class Solve:
    """How one pressure solve went."""

    cycles: int
    """Iterations [-]."""
    mean: float
    """Mean divergence left over [m/s per cell]."""
    largest: float
    """Largest divergence left over [m/s per cell]."""


def levels(ny: int, nx: int) -> np.ndarray:
    """Return the layout of the levels of a grid, shape (level, 7): offset, ny, nx and an empty window.

    Halving goes on while both sizes are even and the smaller one is above 4.
    """
    rows, offset = [], 0
    while True:
        rows.append([offset, ny, nx, PAD, PAD, PAD, PAD])
        offset += (ny + 2 * PAD) * (nx + 2 * PAD)
        if ny % 2 or nx % 2 or min(ny, nx) <= 4:
            return np.array(rows, dtype=np.int64)
        ny, nx = ny // 2, nx // 2


def make_store(layout: np.ndarray, dtype: type) -> np.ndarray:
    """Return the store of a layout with all coefficients 1."""
    end = layout[-1, 0] + (layout[-1, 1] + 2 * PAD) * (layout[-1, 2] + 2 * PAD)
    store = np.zeros((5, end), dtype)
    store[CX] = store[CY] = 1
    store[DINV] = 0.25
    return store


def place_window(layout: np.ndarray, window: tuple[int, int, int, int]) -> None:
    """Write the window (j0, j1, i0, i1, in padded indices) and its coarser images to the layout."""
    j0, j1, i0, i1 = (w - PAD for w in window)
    for row in layout:
        row[3:] = np.array([max(j0, 0), min(j1, row[1]), max(i0, 0), min(i1, row[2])]) + PAD
        if j1 > j0:
            j0, j1, i0, i1 = j0 // 2 - 1, (j1 + 1) // 2 + 1, i0 // 2 - 1, (i1 + 1) // 2 + 1
