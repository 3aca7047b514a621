# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""The pressure equation: conjugate gradients, preconditioned by one multigrid cycle.

Solves ``-div(c grad x) = b`` from a zero initial value; the caller has already applied the last pressure, which is the
warm start. The iteration stops when both the mean and the largest residual are small. The multigrid cycle is not
symmetric. Each new direction is therefore made orthogonal to the last one explicitly (flexible conjugate gradients,
Notay 2000, SIAM J. Sci. Comput. 22, 1444-1460).
"""

from dataclasses import dataclass

import numpy as np
from numba import prange

from suchus.flow.compiled import PAD, Window, compiled, kernel_part, signed, threaded_part, unsigned
from suchus.flow.multigrid import DINV, FACES, B, X, cycle, faces_of, level
from suchus.flow.project import max_of_column, summed_column
from suchus.flow.slab import EDGE, MIN_SLABS, row_count, row_length, slabs_per_block
from suchus.flow.stencil import LANES, apply_slabs, copy_slab, largest_size, seal_slab

MIN_ENERGY_RATIO = 1e-3
"""Ratio of (z, A z) after to before z is made orthogonal to the last direction, below which z is not changed [-]."""

MAX_RESIDUAL_GROWTH = 3.0
"""Ratio of the residual to the smallest so far above which a nearly converged solve drops the iteration [-]; see
``NEAR_CONVERGENCE_RATIO``."""

MAX_STALLED_CYCLES = 3
"""Cycles without progress after which a nearly converged solve stops, because rounding prevents a smaller residual
[-]."""

NEAR_CONVERGENCE_RATIO = 10.0
"""Ratio of the residual to its limit below which a solve is nearly converged [-]."""

MAX_STALLED_CYCLES_FAR = 15
"""Cycles without progress after which a solve stops that is not nearly converged [-]: a body slows down the cycles."""


@kernel_part
def _dots(z, az, r, d, slab, inner):
    """Return the products (z, A z), (d, A z), (r, z) and (r, d) of one slab.

    (r, d) nearly cancels, so the sums with r are in double precision.

    Args:
        z: preconditioned residual, shape (slab, cell).
        az: A z of this slab, shape (1, cell).
        r: residual, shape (slab, cell).
        d: last direction, shape (slab, cell).
        slab: the slab.
        inner: strides within a slab.
    """
    j, row_cells = unsigned(slab), row_length(inner, z.shape[1])
    z_az, d_az, r_z, r_d = 0.0, 0.0, 0.0, 0.0
    for n in range(row_count(inner, z.shape[1])):
        s = EDGE + (EDGE + n) * row_cells if len(inner) > 1 else EDGE
        row_z_az, row_d_az = z.dtype.type(0.0), z.dtype.type(0.0)
        for k in range(s, s + row_cells - EDGE - EDGE):
            row_z_az += z[j, k] * az[0, k]
            row_d_az += d[j, k] * az[0, k]
            r_z += np.float64(r[j, k]) * np.float64(z[j, k])
            r_d += np.float64(r[j, k]) * np.float64(d[j, k])
        z_az += row_z_az
        d_az += row_d_az
    return z_az, d_az, r_z, r_d


@threaded_part
def _write_slab_products(z, r, d, faces, level_layout, inner, sums):
    """Write the products (z, A z), (d, A z), (r, z) and (r, d) of each slab to ``sums``; see ``_dots``.

    Args:
        z: preconditioned residual, shape (slab, cell).
        r: residual, shape (slab, cell).
        d: last direction, shape (slab, cell).
        faces: face coefficients of the finest level along each axis.
        level_layout: row of the layout for that level; see ``slab``.
        inner: strides within a slab.
        sums: array that the four products of each slab are written to, shape (slab, 4).
    """
    end = z.shape[0] - PAD
    block_size = slabs_per_block(inner, end - PAD, MIN_SLABS)
    for n in prange((end - PAD + block_size - 1) // block_size):
        block_start = PAD + signed(n) * block_size
        az = np.empty((1, z.shape[1]), z.dtype)
        for j in range(block_start, min(block_start + block_size, end)):
            apply_slabs(az, 0, z, j - 1, j, j + 1, faces, level_layout, j, inner)
            sums[j, 0], sums[j, 1], sums[j, 2], sums[j, 3] = _dots(z, az, r, d, j, inner)


@kernel_part
def _mix(output, o, z, d, slab, a, b):
    o, j = unsigned(o), unsigned(slab)
    for k in range(unsigned(z.shape[1])):
        output[o, k] = a * z[j, k] + b * d[j, k]


@kernel_part
def _rise(x, e, slab, alpha):
    j = unsigned(slab)
    for k in range(unsigned(x.shape[1])):
        x[j, k] += alpha * e[j, k]


@kernel_part
def _subtract_scaled(r, slab, q, alpha, inner):
    """Subtract ``alpha q`` from a slab of ``r`` and return the sum of its absolute values.

    Args:
        r: residual, shape (slab, cell).
        slab: the slab.
        q: values to subtract, shape (1, cell).
        alpha: step length.
        inner: strides within a slab.
    """
    slab_sum, j, row_cells = 0.0, unsigned(slab), row_length(inner, r.shape[1])
    for n in range(row_count(inner, r.shape[1])):
        s = EDGE + (EDGE + n) * row_cells if len(inner) > 1 else EDGE
        row_sum = r.dtype.type(0.0)
        for k in range(s, s + row_cells - EDGE - EDGE):
            r[j, k] -= alpha * q[0, k]
            row_sum += abs(r[j, k])
        slab_sum += row_sum
    return slab_sum


@threaded_part
def _first_step(r, z, faces, level_layout, alpha, inner, repeats, sums):
    """Write ``r -= alpha A z``, and the sum and the maximum of |r| of each slab.

    Args:
        r: residual, shape (slab, cell).
        z: direction, shape (slab, cell).
        faces: face coefficients of the finest level along each axis.
        level_layout: row of the layout for that level; see ``slab``.
        alpha: step length.
        inner: strides within a slab.
        repeats: which axes are periodic.
        sums: sum and maximum of each slab, shape (slab, 4).
    """
    end = z.shape[0] - PAD
    block_size = slabs_per_block(inner, end - PAD, MIN_SLABS)
    for n in prange((end - PAD + block_size - 1) // block_size):
        block_start = PAD + signed(n) * block_size
        q, top = np.empty((1, z.shape[1]), z.dtype), np.empty(LANES, z.dtype)
        for j in range(block_start, min(block_start + block_size, end)):
            apply_slabs(q, 0, z, j - 1, j, j + 1, faces, level_layout, j, inner)
            sums[j, 0] = _subtract_scaled(r, j, q, alpha, inner)
            sums[j, 1] = largest_size(r, j, inner, top)
            seal_slab(r, j, inner, repeats)


@threaded_part
def _step(r, z, d, faces, level_layout, alpha, beta, inner, repeats, sums):
    """Write ``r -= alpha A (z + beta d)``, and the sum and the maximum of |r| of each slab.

    Args:
        r: residual, shape (slab, cell).
        z: preconditioned residual, shape (slab, cell).
        d: last direction, shape (slab, cell).
        faces: face coefficients of the finest level along each axis.
        level_layout: row of the layout for that level; see ``slab``.
        alpha: step length.
        beta: share of the last direction in the new one.
        inner: strides within a slab.
        repeats: which axes are periodic.
        sums: sum and maximum of each slab, shape (slab, 4).
    """
    end, unity = z.shape[0] - PAD, z.dtype.type(1.0)
    block_size = slabs_per_block(inner, end - PAD, MIN_SLABS)
    for n in prange((end - PAD + block_size - 1) // block_size):
        q, top = np.empty((1, z.shape[1]), z.dtype), np.empty(LANES, z.dtype)
        rows = np.empty((3, z.shape[1]), z.dtype)
        lower_slab, mid, upper_slab = 0, 1, 2
        block_start = PAD + signed(n) * block_size
        for j in range(block_start - 1, min(block_start + block_size, end) + 1):
            lower_slab, mid, upper_slab = mid, upper_slab, lower_slab
            _mix(rows, upper_slab, z, d, j, unity, beta)
            if j > block_start:
                c = j - 1
                apply_slabs(q, 0, rows, lower_slab, mid, upper_slab, faces, level_layout, c, inner)
                sums[c, 0] = _subtract_scaled(r, c, q, alpha, inner)
                sums[c, 1] = largest_size(r, c, inner, top)
                seal_slab(r, c, inner, repeats)


@threaded_part
def _keep(x, e, z, d, alpha, beta, previous_alpha, inner):
    """Write the new direction ``e = z + beta d`` and the solution ``x = alpha e + previous_alpha d``.

    If ``previous_alpha`` is 0, the solution is ``x += alpha e``.

    Args:
        x: solution, shape (slab, cell).
        e: new direction, shape (slab, cell).
        z: preconditioned residual, shape (slab, cell).
        d: last direction, shape (slab, cell).
        alpha: step length along ``e``.
        beta: share of the last direction in the new one.
        previous_alpha: step length along ``d`` that is not yet in ``x``.
        inner: strides within a slab.
    """
    unity, block_size = z.dtype.type(1.0), slabs_per_block(inner, x.shape[0], MIN_SLABS)
    for n in prange((x.shape[0] + block_size - 1) // block_size):
        block_start = signed(n) * block_size
        for j in range(block_start, min(block_start + block_size, x.shape[0])):
            _mix(e, j, z, d, j, unity, beta)
            if previous_alpha != 0:
                _mix(x, j, z, d, j, alpha, alpha * beta + previous_alpha)
            else:
                _rise(x, e, j, alpha)


@compiled
def solve(x, d, q, store, layout, buffer, rects, inner, repeats, sums, mean_limit, max_limit, min_cycles, max_cycles):
    """Solve for the right side ``B`` of level 0; on return ``B`` is the residual.

    A step of the flow takes one or two iterations, so the caller adds up their directions.

    Args:
        x: work array, shape (slab, cell).
        d: direction, shape (slab, cell).
        q: work array, shape (slab, cell).
        store: values of all multigrid levels.
        layout: layout of the levels; see ``slab``.
        buffer: values of the patches; see ``patch``.
        rects: the patches; see ``patch``.
        inner: strides within a slab.
        repeats: which axes are periodic.
        sums: work array, shape (slab, 4).
        mean_limit: mean residual at which the iteration stops.
        max_limit: largest residual at which the iteration stops.
        min_cycles: fewest iterations.
        max_cycles: most iterations.

    Returns:
        iterations, mean residual, largest residual, and the factors ``a`` and ``b`` with which the solution is
        ``a d + b X``, where ``X`` is that of level 0.
    """
    r, z = level(store, layout, inner, B, 0), level(store, layout, inner, X, 0)
    faces, level_layout, real = faces_of(store, layout, inner, 0), layout[0], store.dtype.type
    cells = 1
    for axis in range(len(inner) + 1):
        cells *= level_layout[1 + axis]
    d_ad, alpha, beta, previous_alpha = 1.0, 0.0, 0.0, 0.0
    initial_d, is_pending, is_stored = d, False, False
    mean, maximum, min_excess, stalled_cycles = 0.0, 0.0, np.inf, 0
    k = 0
    while k < max_cycles and stalled_cycles < (
        MAX_STALLED_CYCLES if min_excess <= NEAR_CONVERGENCE_RATIO else MAX_STALLED_CYCLES_FAR
    ):
        if k >= 2:
            _keep(x, q, z, d, real(alpha), real(beta), real(previous_alpha), inner)
            d, q, previous_alpha, is_pending, is_stored = q, d, 0.0, False, True
        cycle(d if k == 0 else z, store, layout, buffer, rects, inner, repeats)
        _write_slab_products(d if k == 0 else z, r, d, faces, level_layout, inner, sums)
        z_az, d_az, r_z = summed_column(sums, 0), summed_column(sums, 1), summed_column(sums, 2)
        turn = 0.0 if k == 0 else -d_az / d_ad
        d_ad = z_az + turn * d_az
        if d_ad < MIN_ENERGY_RATIO * z_az:
            turn, d_ad = 0.0, z_az
        if not d_ad > 0:
            break
        alpha, beta = (r_z + turn * summed_column(sums, 3)) / d_ad, turn
        if k == 0:
            _first_step(r, d, faces, level_layout, real(alpha), inner, repeats, sums)
            previous_alpha = alpha
        else:
            _step(r, z, d, faces, level_layout, real(alpha), real(beta), inner, repeats, sums)
            is_pending = True
        k += 1
        previous_residuals = mean, maximum
        mean, maximum = summed_column(sums, 0) / cells, max_of_column(sums, 1)
        if k >= min_cycles and mean <= mean_limit and maximum <= max_limit:
            break
        excess = max(mean / mean_limit, maximum / max_limit)
        if k > 2 and excess > MAX_RESIDUAL_GROWTH * min_excess and min_excess <= NEAR_CONVERGENCE_RATIO:
            mean, maximum = previous_residuals
            is_pending = False
            break
        stalled_cycles = 0 if excess < 0.8 * min_excess else stalled_cycles + 1
        min_excess = min(min_excess, excess)
    if not is_stored:
        return k, mean, maximum, previous_alpha + is_pending * alpha * beta, is_pending * alpha
    if is_pending:
        _keep(x, q, z, d, real(alpha), real(beta), real(previous_alpha), inner)
    for j in range(x.shape[0]):
        copy_slab(initial_d, j, x, j)
    return k, mean, maximum, 1.0, 0.0


@dataclass(slots=True)
class Solve:
    """Statistics of one pressure solve."""

    cycles: int
    """Iterations [-]."""
    mean_divergence: float
    """Mean of the remaining divergence [m/s per cell]."""
    max_divergence: float
    """Largest remaining divergence [m/s per cell]."""


def levels(cells: tuple[int, ...]) -> np.ndarray:
    """Return the layout of the levels of a grid, shape (level, 1 + 3 axes), with empty windows; see ``slab``.

    Halving goes on while all sizes are even and the smallest one is above 4.

    Args:
        cells: number of cells along x, y (and z).
    """
    rows, offset, ndim = [], 0, len(cells)
    sizes = np.array(cells[::-1], dtype=np.int64)
    while True:
        rows.append([offset, *sizes, *[PAD] * (2 * ndim)])
        offset += (FACES + ndim) * int(np.prod(sizes + 2 * PAD))
        if (sizes % 2).any() or sizes.min() <= 4:
            return np.array(rows, dtype=np.int64)
        sizes //= 2


def make_store(layout: np.ndarray, dtype: type) -> np.ndarray:
    """Return the store of a layout, in which all coefficients are 1 as in water without bodies.

    Args:
        layout: layout of the levels; see ``levels``.
        dtype: precision of the fields.
    """
    ndim = layout.shape[1] // 3
    sizes = (layout[:, 1 : 1 + ndim] + 2 * PAD).prod(axis=1)
    store = np.zeros(layout[-1, 0] + (FACES + ndim) * sizes[-1], dtype)
    for start, size in zip(layout[:, 0], sizes, strict=True):
        store[start + DINV * size : start + (DINV + 1) * size] = 0.5 / ndim
        store[start + FACES * size : start + (FACES + ndim) * size] = 1
    return store


def place_window(layout: np.ndarray, window: Window) -> None:
    """Write a window and its coarser images to the layout of all levels.

    Args:
        layout: layout of the levels; see ``slab``.
        window: padded indices, first and end along each axis, the last axis first.
    """
    ndim = layout.shape[1] // 3
    start, end = ([value - PAD for value in window[k::2]] for k in (0, 1))
    for row in layout:
        cells = row[1 : 1 + ndim].tolist()
        bounds = [(max(a, 0) + PAD, min(b, n) + PAD) for a, b, n in zip(start, end, cells, strict=True)]
        row[1 + ndim :] = [value for pair in bounds for value in pair]
        if end[0] > start[0]:
            start, end = [a // 2 - 1 for a in start], [(b + 1) // 2 + 1 for b in end]
