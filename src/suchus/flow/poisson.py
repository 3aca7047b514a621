# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""The pressure equation: conjugate gradients, preconditioned by one multigrid cycle.

Solves ``-div(c grad x) = b`` from nothing; the caller has already applied the last pressure, which is the warm
start. Stops when both the mean and the largest residual are small. The multigrid cycle is not symmetric, so each
new direction is made orthogonal to the last one explicitly (flexible conjugate gradients, Notay 2000, SIAM J.
Sci. Comput. 22, 1444-1460).
"""

from dataclasses import dataclass

import numpy as np
from numba import prange

from suchus.flow.compiled import PAD, Window, compiled, part, signed, threaded_part, unsigned
from suchus.flow.multigrid import DINV, FACES, B, X, cycle, faces_of, level
from suchus.flow.slab import EDGE, LEAST, block_of, row_count, row_length
from suchus.flow.stencil import LANES, apply_slabs, copy_slab, largest_size, seal_slab

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
def _dots(z, az, r, d, slab, inner):
    """Return (z, A z), (d, A z), (r, z) and (r, d) of a slab; the last is nearly nothing, so r's sums are double."""
    j, wide = unsigned(slab), row_length(inner, z.shape[1])
    all_own, all_old, gain, left = 0.0, 0.0, 0.0, 0.0
    for n in range(row_count(inner, z.shape[1])):
        s = EDGE + (EDGE + n) * wide if len(inner) > 1 else EDGE
        own, old = z.dtype.type(0.0), z.dtype.type(0.0)
        for k in range(s, s + wide - EDGE - EDGE):
            own += z[j, k] * az[0, k]
            old += d[j, k] * az[0, k]
            gain += np.float64(r[j, k]) * np.float64(z[j, k])
            left += np.float64(r[j, k]) * np.float64(d[j, k])
        all_own += own
        all_old += old
    return all_own, all_old, gain, left


@threaded_part
def _measure(z, r, d, faces, place, inner, sums):
    """Write each slab's sums of (z, A z), (d, A z), (r, z) and (r, d)."""
    end = z.shape[0] - PAD
    block = block_of(inner, end - PAD, LEAST)
    for n in prange((end - PAD + block - 1) // block):
        first = PAD + signed(n) * block
        az = np.empty((1, z.shape[1]), z.dtype)
        for j in range(first, min(first + block, end)):
            apply_slabs(az, 0, z, j - 1, j, j + 1, faces, place, j, inner)
            sums[j, 0], sums[j, 1], sums[j, 2], sums[j, 3] = _dots(z, az, r, d, j, inner)


@part
def _mix(out, o, z, d, slab, a, b):
    o, j = unsigned(o), unsigned(slab)
    for k in range(unsigned(z.shape[1])):
        out[o, k] = a * z[j, k] + b * d[j, k]


@part
def _rise(x, e, slab, alpha):
    j = unsigned(slab)
    for k in range(unsigned(x.shape[1])):
        x[j, k] += alpha * e[j, k]


@part
def _lower(r, slab, q, alpha, inner):
    """Subtract ``alpha`` times the one slab of ``q`` from a slab of ``r``; return its summed size."""
    whole, j, wide = 0.0, unsigned(slab), row_length(inner, r.shape[1])
    for n in range(row_count(inner, r.shape[1])):
        s = EDGE + (EDGE + n) * wide if len(inner) > 1 else EDGE
        total = r.dtype.type(0.0)
        for k in range(s, s + wide - EDGE - EDGE):
            r[j, k] -= alpha * q[0, k]
            total += abs(r[j, k])
        whole += total
    return whole


@threaded_part
def _first_step(r, z, faces, place, alpha, inner, repeats, sums):
    """Write ``r -= alpha A z`` and each slab's sum of |r| and largest |r|."""
    end = z.shape[0] - PAD
    block = block_of(inner, end - PAD, LEAST)
    for n in prange((end - PAD + block - 1) // block):
        first = PAD + signed(n) * block
        q, top = np.empty((1, z.shape[1]), z.dtype), np.empty(LANES, z.dtype)
        for j in range(first, min(first + block, end)):
            apply_slabs(q, 0, z, j - 1, j, j + 1, faces, place, j, inner)
            sums[j, 0] = _lower(r, j, q, alpha, inner)
            sums[j, 1] = largest_size(r, j, inner, top)
            seal_slab(r, j, inner, repeats)


@threaded_part
def _step(r, z, d, faces, place, alpha, beta, inner, repeats, sums):
    """Write ``r -= alpha A (z + beta d)`` and each slab's sum of |r| and largest |r|."""
    end, one = z.shape[0] - PAD, z.dtype.type(1.0)
    block = block_of(inner, end - PAD, LEAST)
    for n in prange((end - PAD + block - 1) // block):
        q, top = np.empty((1, z.shape[1]), z.dtype), np.empty(LANES, z.dtype)
        rows = np.empty((3, z.shape[1]), z.dtype)
        low, mid, high = 0, 1, 2
        first = PAD + signed(n) * block
        for j in range(first - 1, min(first + block, end) + 1):
            low, mid, high = mid, high, low
            _mix(rows, high, z, d, j, one, beta)
            if j > first:
                c = j - 1
                apply_slabs(q, 0, rows, low, mid, high, faces, place, c, inner)
                sums[c, 0] = _lower(r, c, q, alpha, inner)
                sums[c, 1] = largest_size(r, c, inner, top)
                seal_slab(r, c, inner, repeats)


@threaded_part
def _keep(x, e, z, d, alpha, beta, before, inner):
    """Write ``e = z + beta d`` and ``x = alpha e + before d``, or ``x += alpha e`` if ``before`` is 0."""
    one, block = z.dtype.type(1.0), block_of(inner, x.shape[0], LEAST)
    for n in prange((x.shape[0] + block - 1) // block):
        first = signed(n) * block
        for j in range(first, min(first + block, x.shape[0])):
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
def solve(x, d, q, store, layout, room, rects, inner, repeats, sums, mean_limit, max_limit, least, most):
    """Solve for the right side ``B`` of level 0, in which the residual is left; ``x``, ``d`` and ``q`` are room.

    One iteration or two are what a step of the flow takes, so what they add up to is left to who reads it. It takes at
    least ``least`` of them and at most ``most``.

    Returns:
        iterations, mean residual, largest residual, and the numbers ``a`` and ``b`` with which the solution is
        ``a d + b X``, where ``X`` is that of level 0.
    """
    r, z = level(store, layout, inner, B, 0), level(store, layout, inner, X, 0)
    faces, place, real = faces_of(store, layout, inner, 0), layout[0], store.dtype.type
    cells = 1
    for axis in range(len(inner) + 1):
        cells *= place[1 + axis]
    last, alpha, beta, before = 1.0, 0.0, 0.0, 0.0
    begun, due, kept = d, False, False
    mean, largest, best, since = 0.0, 0.0, np.inf, 0
    k = 0
    while k < most and since < (STALLED if best <= NEARLY else PATIENCE):
        if k >= 2:
            _keep(x, q, z, d, real(alpha), real(beta), real(before), inner)
            d, q, before, due, kept = q, d, 0.0, False, True
        cycle(d if k == 0 else z, store, layout, room, rects, inner, repeats)
        _measure(d if k == 0 else z, r, d, faces, place, inner, sums)
        own, old, gain = _total(sums, 0), _total(sums, 1), _total(sums, 2)
        turn = 0.0 if k == 0 else -old / last
        last = own + turn * old
        if last < PARALLEL * own:
            turn, last = 0.0, own
        if not last > 0:
            break
        alpha, beta = (gain + turn * _total(sums, 3)) / last, turn
        if k == 0:
            _first_step(r, d, faces, place, real(alpha), inner, repeats, sums)
            before = alpha
        else:
            _step(r, z, d, faces, place, real(alpha), real(beta), inner, repeats, sums)
            due = True
        k += 1
        before_last = mean, largest
        mean, largest = _total(sums, 0) / cells, _most(sums, 1)
        if k >= least and mean <= mean_limit and largest <= max_limit:
            break
        worst = max(mean / mean_limit, largest / max_limit)
        if k > 2 and worst > WORSE * best and best <= NEARLY:
            mean, largest = before_last
            due = False
            break
        since = 0 if worst < 0.8 * best else since + 1
        best = min(best, worst)
    if not kept:
        return k, mean, largest, before + due * alpha * beta, due * alpha
    if due:
        _keep(x, q, z, d, real(alpha), real(beta), real(before), inner)
    for j in range(x.shape[0]):
        copy_slab(begun, j, x, j)
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


def levels(cells: tuple[int, ...]) -> np.ndarray:
    """Return the layout of the levels of a grid, shape (level, 1 + 3 axes), with empty windows; see ``slab``.

    Halving goes on while all sizes are even and the smallest one is above 4.

    Args:
        cells: number of cells along x, y (and z).
    """
    rows, offset, axes = [], 0, len(cells)
    sizes = np.array(cells[::-1], dtype=np.int64)
    while True:
        rows.append([offset, *sizes, *[PAD] * (2 * axes)])
        offset += (FACES + axes) * int(np.prod(sizes + 2 * PAD))
        if (sizes % 2).any() or sizes.min() <= 4:
            return np.array(rows, dtype=np.int64)
        sizes //= 2


def make_store(layout: np.ndarray, dtype: type) -> np.ndarray:
    """Return the store of a layout with all coefficients 1."""
    axes = layout.shape[1] // 3
    sizes = (layout[:, 1 : 1 + axes] + 2 * PAD).prod(axis=1)
    store = np.zeros(layout[-1, 0] + (FACES + axes) * sizes[-1], dtype)
    for start, size in zip(layout[:, 0], sizes, strict=True):
        store[start + DINV * size : start + (DINV + 1) * size] = 0.5 / axes
        store[start + FACES * size : start + (FACES + axes) * size] = 1
    return store


def place_window(layout: np.ndarray, window: Window) -> None:
    """Write the window (first and end along each axis, the last axis first, padded) and its coarser images."""
    axes = layout.shape[1] // 3
    first, end = ([value - PAD for value in window[k::2]] for k in (0, 1))
    for row in layout:
        cells = row[1 : 1 + axes].tolist()
        inside = [(max(a, 0) + PAD, min(b, n) + PAD) for a, b, n in zip(first, end, cells, strict=True)]
        row[1 + axes :] = [value for pair in inside for value in pair]
        if end[0] > first[0]:
            first, end = [a // 2 - 1 for a in first], [(b + 1) // 2 + 1 for b in end]
