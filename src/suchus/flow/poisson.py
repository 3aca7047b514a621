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

from suchus.flow.compiled import BLOCK, PAD, compiled, threaded
from suchus.flow.multigrid import CX, CY, DINV, B, X, cycle, level
from suchus.flow.stencil import apply_row, seal_ends, seal_row

STALLED = 3
"""Cycles without progress after which rounding, not the residual, is what is left [-]."""

NEARLY = 10.0
"""Residual over its limit below which that many cycles count [-]; farther off, a body hinders the cycles, and ..."""

PATIENCE = 15
"""... so many may pass [-]."""


@compiled
def _dot(a, b):
    total = 0.0
    for k in range(a.size):
        total += np.float64(a[k]) * np.float64(b[k])
    return total


@compiled
def _aim(d, z, beta):
    for k in range(d.size):
        d[k] = z[k] + beta * d[k]


@threaded
def _direct(d, z, beta, periodic):
    """Write ``d = z + beta d``."""
    nx = d.shape[1] - 2 * PAD
    end = d.shape[0] - PAD
    for block in prange((end - PAD + BLOCK - 1) // BLOCK):
        for j in range(PAD + block * BLOCK, min(PAD + (block + 1) * BLOCK, end)):
            if beta == 0:
                d[j, PAD : PAD + nx] = z[j, PAD : PAD + nx]
            else:
                _aim(d[j, PAD : PAD + nx], z[j, PAD : PAD + nx], beta)
            seal_row(d[j], periodic)


@threaded
def _measure(q, d, r, cx, cy, place, sums):
    """Write ``q = A d`` and the row sums of (d, q) and (r, d)."""
    nx = d.shape[1] - 2 * PAD
    end = d.shape[0] - PAD
    for block in prange((end - PAD + BLOCK - 1) // BLOCK):
        for j in range(PAD + block * BLOCK, min(PAD + (block + 1) * BLOCK, end)):
            row = q[j, PAD : PAD + nx]
            apply_row(row, d, cx, cy, place, j)
            sums[j, 0] = _dot(d[j, PAD : PAD + nx], row)
            sums[j, 1] = _dot(r[j, PAD : PAD + nx], d[j, PAD : PAD + nx])


@compiled
def _norms(r):
    total = 0.0
    largest = r.dtype.type(0)
    for k in range(r.size):
        size = abs(r[k])
        total += np.float64(size)
        largest = size if size > largest else largest
    return total, largest


@compiled
def _step_row(x, r, d, q, alpha):
    for k in range(x.size):
        x[k] += alpha * d[k]
        r[k] -= alpha * q[k]


@threaded
def _step(x, r, d, q, alpha, fresh, periodic, sums):
    """Write ``x += alpha d``, ``r -= alpha q`` and the row sums of |r| and largest |r|."""
    nx = d.shape[1] - 2 * PAD
    end = d.shape[0] - PAD
    for block in prange((end - PAD + BLOCK - 1) // BLOCK):
        for j in range(PAD + block * BLOCK, min(PAD + (block + 1) * BLOCK, end)):
            if fresh:
                x[j] = 0
            _step_row(x[j, PAD : PAD + nx], r[j, PAD : PAD + nx], d[j, PAD : PAD + nx], q[j, PAD : PAD + nx], alpha)
            seal_row(x[j], periodic)
            seal_row(r[j], periodic)
            total, largest = _norms(r[j, PAD : PAD + nx])
            sums[j, 0] = total
            sums[j, 1] = largest


@threaded
def _project_dot(z, q, sums):
    nx = z.shape[1] - 2 * PAD
    end = z.shape[0] - PAD
    for block in prange((end - PAD + BLOCK - 1) // BLOCK):
        for j in range(PAD + block * BLOCK, min(PAD + (block + 1) * BLOCK, end)):
            sums[j, 0] = _dot(z[j, PAD : PAD + nx], q[j, PAD : PAD + nx])


@compiled
def solve(x, d, q, store, layout, periodic, sums, mean_limit, max_limit, most):
    """Write the solution for the right side ``B`` of level 0 to ``x``.

    On return ``B`` holds the residual.

    Returns:
        iterations, mean residual, largest residual.
    """
    r, z = level(store, layout, B, 0), level(store, layout, X, 0)
    cx, cy = level(store, layout, CX, 0), level(store, layout, CY, 0)
    real = store.dtype.type
    place = layout[0]
    cells = layout[0, 1] * layout[0, 2]
    s, e = PAD, x.shape[0] - PAD
    last = 1.0
    mean, largest, best, since = 0.0, 0.0, np.inf, 0
    for k in range(most):
        cycle(store, layout, periodic)
        beta = 0.0
        if k > 0:
            _project_dot(z, q, sums)
            beta = -sums[s:e, 0].sum() / last
        _direct(d, z, real(beta), periodic[0])
        seal_ends(d, periodic[1])
        _measure(q, d, r, cx, cy, place, sums)
        last = sums[s:e, 0].sum()
        if not last > 0:
            if k == 0:
                x[:] = 0
            return k, mean, largest
        alpha = sums[s:e, 1].sum() / last
        _step(x, r, d, q, real(alpha), k == 0, periodic[0], sums)
        mean, largest = sums[s:e, 0].sum() / cells, sums[s:e, 1].max()
        if mean <= mean_limit and largest <= max_limit:
            seal_ends(x, periodic[1])
            return k + 1, mean, largest
        worst = max(mean / mean_limit, largest / max_limit)
        since = 0 if worst < 0.8 * best else since + 1
        best = min(best, worst)
        if since >= (STALLED if worst <= NEARLY else PATIENCE):
            break
    seal_ends(x, periodic[1])
    return k + 1, mean, largest


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
    store = np.zeros((6, end), dtype)
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
