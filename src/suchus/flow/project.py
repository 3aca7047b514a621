# mypy: disable-error-code="no-untyped-def, var-annotated, assignment"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""Divergence before the pressure solve, and the correction after it, in cells and flow units; see ``slab``."""

import numpy as np
from numba import prange

from suchus.flow.compiled import PAD, UNIT, compiled, kernel_part, signed, threaded_part, unsigned
from suchus.flow.slab import (
    EDGE,
    MIN_SLABS,
    meets,
    near_shift,
    row_count,
    row_length,
    run_of,
    slabs_per_block,
    window_columns,
    window_rows,
)
from suchus.flow.stencil import LANES, largest_size, seal_ends, seal_slab, summed_size


@kernel_part
def _divergence_slab(r, velocity, slab, mean, inner):
    """Write ``-div u - mean`` to a slab of ``r``.

    Args:
        r: residual, shape (slab, cell).
        velocity: shape (axis, slab, cell).
        slab: the slab.
        mean: mean over the domain, which is subtracted; see ``_mean_residual``.
        inner: strides within a slab.
    """
    j, slab_axis = unsigned(slab), unsigned(len(inner))
    run_start, run_end = run_of(inner, r.shape[1])
    for k in range(run_start, run_end):
        net = r.dtype.type(0)
        for d in range(len(inner)):
            net += velocity[d, j, k] - velocity[d, j, k + inner[d]]
        r[j, k] = net + (velocity[slab_axis, j, k] - velocity[slab_axis, j + UNIT, k]) - mean


@threaded_part
def _residual_slabs(r, velocity, source, dinv, level_layout, near_layout, mean, inner, repeats, sums):
    """Write the residual ``source - div u - mean``, and its sum and maximum slab by slab; see ``residual``.

    Args:
        r: residual, shape (slab, cell).
        velocity: shape (axis, slab, cell).
        source: divergence of the bodies' own motion, an array of the window ``near_layout``.
        dinv: inverse diagonal of the pressure equation, 0 inside the body.
        level_layout: row of the layout for the finest level; see ``slab``.
        near_layout: the window around the bodies; see ``slab``.
        mean: see ``_mean_residual``.
        inner: strides within a slab.
        repeats: which axes are periodic.
        sums: summed and largest absolute value, shape (slab, 4).
    """
    end = r.shape[0] - PAD
    block_size = slabs_per_block(inner, end - PAD, MIN_SLABS)
    for n in prange((end - PAD + block_size - 1) // block_size):
        start = PAD + signed(n) * block_size
        top = np.empty(LANES, r.dtype)
        for j in range(start, min(start + block_size, end)):
            _divergence_slab(r, velocity, j, mean, inner)
            if meets(level_layout, inner, j):
                c, row_cells, (r0, r1) = unsigned(j), row_length(inner, r.shape[1]), window_rows(level_layout, inner)
                (s, e), o = window_columns(level_layout, inner), c - unsigned(near_layout[len(inner) + 2])
                for row in range(r0, r1):
                    shift = near_shift(near_layout, inner, row, row_cells)
                    for i in range(row * row_cells + s, row * row_cells + e):
                        r[c, i] = r[c, i] + source[o, i - shift] if dinv[c, i] > 0 else 0
            seal_slab(r, j, inner, repeats)
            sums[j, 0] = summed_size(r, j, inner)
            sums[j, 1] = largest_size(r, j, inner, top)


@kernel_part
def _mean_of_plane(u, v, source, level_layout, near_layout):
    """Return the mean of ``source - div u`` in the plane; see ``_mean_residual``."""
    s, t, b = PAD, u.shape[0] - PAD, u.shape[1] - PAD
    total = 0.0
    for j in range(s, t):
        total += np.float64(u[j, s]) - np.float64(u[j, b])
    for i in range(s, b):
        total += np.float64(v[s, i]) - np.float64(v[t, i])
    for j in range(level_layout[3], level_layout[4]):
        for i in range(level_layout[5], level_layout[6]):
            total += source[j - near_layout[3], i - near_layout[5]]
    return total / ((t - s) * (b - s))


@kernel_part
def _mean_in_space(velocity, source, level_layout, near_layout, inner):
    """Return the mean of ``source - div u`` in space; see ``_mean_residual``."""
    end, row_cells, total = velocity.shape[1] - PAD, signed(row_length(inner, velocity.shape[2])), 0.0
    rows, columns = signed(row_count(inner, velocity.shape[2])), row_cells - 2 * PAD
    for row in range(PAD, rows + PAD):
        for j in range(PAD, end):
            k = row * row_cells + PAD
            total += np.float64(velocity[0, j, k]) - np.float64(velocity[0, j, k + columns])
        for i in range(row * row_cells + PAD, row * row_cells + PAD + columns):
            total += np.float64(velocity[2, PAD, i]) - np.float64(velocity[2, end, i])
    for j in range(PAD, end):
        for i in range(PAD * row_cells + PAD, PAD * row_cells + PAD + columns):
            total += np.float64(velocity[1, j, i]) - np.float64(velocity[1, j, i + rows * row_cells])
    for j in range(level_layout[4], level_layout[5]):
        for row in range(level_layout[6], level_layout[7]):
            for i in range(level_layout[8], level_layout[9]):
                k = (row - near_layout[6]) * (near_layout[9] - near_layout[8] + 1) + i - near_layout[8]
                total += source[j - near_layout[4], k]
    return total / ((end - PAD) * rows * columns)


@kernel_part
def _mean_residual(velocity, source, level_layout, near_layout, inner):
    """Return the mean of ``source - div u``: the inflow through the sides and the volume that the bodies displace.

    Args:
        velocity: shape (axis, slab, cell).
        source: divergence of the bodies' own motion, an array of the window ``near_layout``.
        level_layout: row of the layout for the finest level; see ``slab``.
        near_layout: the window around the bodies; see ``slab``.
        inner: strides within a slab.
    """
    if len(inner) == 1:
        return _mean_of_plane(velocity[0], velocity[1], source, level_layout, near_layout)
    return _mean_in_space(velocity, source, level_layout, near_layout, inner)


@kernel_part
def summed_column(sums, column):
    """Return the sum of a column over the slabs of the domain."""
    total, k = 0.0, unsigned(column)
    for j in range(unsigned(PAD), unsigned(sums.shape[0] - PAD)):
        total += sums[j, k]
    return total


@kernel_part
def max_of_column(sums, column):
    """Return the largest number of a column over the slabs of the domain; a NaN stays one."""
    maximum, k = 0.0, unsigned(column)
    for j in range(unsigned(PAD), unsigned(sums.shape[0] - PAD)):
        maximum = maximum if sums[j, k] <= maximum or maximum != maximum else sums[j, k]
    return maximum


@compiled
def residual(r, velocity, source, dinv, level_layout, near_layout, inner, repeats, sums):
    """Write the residual ``source - div u`` of the pressure equation, less its mean; return its size.

    Cells that lie wholly inside the body get 0: no pressure acts there.

    Args:
        r: residual, shape (slab, cell).
        velocity: shape (axis, slab, cell).
        source: divergence of the bodies' own motion, an array of the window ``near_layout``.
        dinv: inverse diagonal of the pressure equation, 0 inside the body.
        level_layout: row of the layout for the finest level; see ``slab``.
        near_layout: the window around the bodies; see ``slab``.
        inner: strides within a slab.
        repeats: which axes are periodic.
        sums: work array, shape (slab, 4).

    Returns:
        Mean and maximum of its absolute value.
    """
    mean = r.dtype.type(_mean_residual(velocity, source, level_layout, near_layout, inner))
    _residual_slabs(r, velocity, source, dinv, level_layout, near_layout, mean, inner, repeats, sums)
    cells = 1
    for axis in range(len(inner) + 1):
        cells *= level_layout[1 + axis]
    return summed_column(sums, 0) / cells, max_of_column(sums, 1)


@kernel_part
def _add(output, o, d, z, slab, a, b):
    """Write ``a d + b z`` of one slab to slab ``o`` of ``output``."""
    o, j = unsigned(o), unsigned(slab)
    if b == 0:
        for k in range(unsigned(d.shape[1])):
            output[o, k] = a * d[j, k]
    else:
        for k in range(unsigned(d.shape[1])):
            output[o, k] = a * d[j, k] + b * z[j, k]


@kernel_part
def _correct_plain(velocity, p, slab, x, lower_slab, mid, level, gain, start, stop, inner):
    """Correct velocity and pressure of cells ``start`` to ``stop`` of a slab, outside the window.

    Args:
        velocity: shape (axis, slab, cell).
        p: pressure, shape (slab, cell).
        slab: the slab.
        x: pressure change of two slabs, shape (2, cell).
        lower_slab: row of ``x`` for the slab below.
        mid: row of ``x`` for the slab itself.
        level: mean of ``x`` along the sides of the domain.
        gain: factor from ``x`` to the pressure.
        start: first cell.
        stop: end of the cells.
        inner: strides within a slab.
    """
    j, lower_slab, mid, slab_axis = unsigned(slab), unsigned(lower_slab), unsigned(mid), unsigned(len(inner))
    for k in range(start, stop):
        m = x[mid, k]
        for d in range(len(inner)):
            velocity[d, j, k] -= m - x[mid, k - inner[d]]
        velocity[slab_axis, j, k] -= m - x[lower_slab, k]
        p[j, k] += gain * (m - level)


@kernel_part
def _correct_body(velocity, p, slab, x, lower_slab, mid, passage, level, gain, start, stop, inner):
    """Correct cells inside the window, where ``passage`` is the share of each face on which the pressure acts.

    The other arguments are those of ``_correct_plain``.
    """
    j, lower_slab, mid, slab_axis = unsigned(slab), unsigned(lower_slab), unsigned(mid), unsigned(len(inner))
    for k in range(start, stop):
        m = x[mid, k]
        for d in range(len(inner)):
            velocity[d, j, k] -= passage[d, j, k] * (m - x[mid, k - inner[d]])
        velocity[slab_axis, j, k] -= passage[slab_axis, j, k] * (m - x[lower_slab, k])
        p[j, k] += gain * (m - level)


@kernel_part
def _correct_slab(velocity, p, slab, x, lower_slab, mid, passage, level_layout, level, gain, inner):
    """Correct velocity and pressure of one slab, inside and outside the window; see ``correct``."""
    row_cells = row_length(inner, p.shape[1])
    (r0, r1), (w0, w1) = window_rows(level_layout, inner), window_columns(level_layout, inner)
    meets_window = meets(level_layout, inner, slab)
    for n in range(row_count(inner, p.shape[1])):
        row = n + EDGE if len(inner) > 1 else n
        f, e = row * row_cells + EDGE, row * row_cells + row_cells - EDGE
        if meets_window and r0 <= row < r1:
            _correct_plain(velocity, p, slab, x, lower_slab, mid, level, gain, f, row * row_cells + w0, inner)
            _correct_body(
                velocity, p, slab, x, lower_slab, mid, passage, level, gain, row * row_cells + w0, row * row_cells + w1,
                inner,
            )  # fmt: skip
            f = row * row_cells + w1
        _correct_plain(velocity, p, slab, x, lower_slab, mid, level, gain, f, e, inner)


@kernel_part
def _along_sides(x, inner):
    """Return the mean of ``x`` over the outermost cells of the domain.

    A corner cell counts once for each of its sides.
    """
    n, row_cells, total = x.shape[0] - PAD - 1, signed(row_length(inner, x.shape[1])), 0.0
    m = row_cells - PAD - 1
    if len(inner) == 1:
        for j in range(PAD, n + 1):
            total += np.float64(x[j, PAD]) + np.float64(x[j, m])
        for i in range(PAD, m + 1):
            total += np.float64(x[PAD, i]) + np.float64(x[n, i])
        return total / (2 * (n + m + 2 - 2 * PAD))
    last_row, count = PAD + signed(row_count(inner, x.shape[1])) - 1, 0
    for j in range(PAD, n + 1):
        for row in range(PAD, last_row + 1):
            total += np.float64(x[j, row * row_cells + PAD]) + np.float64(x[j, row * row_cells + m])
        for i in range(PAD, m + 1):
            total += np.float64(x[j, PAD * row_cells + i]) + np.float64(x[j, last_row * row_cells + i])
        count += 2 * (last_row + m + 2 - 2 * PAD)
    for row in range(PAD, last_row + 1):
        for i in range(row * row_cells + PAD, row * row_cells + m + 1):
            total += np.float64(x[PAD, i]) + np.float64(x[n, i])
        count += 2 * (m + 1 - PAD)
    return total / count


@compiled
def side_mean(x, inner):
    """Return the mean of a field over the outermost cells of the domain, a corner cell counting for each of its sides.

    Args:
        x: the field, shape (slab, cell).
        inner: strides within a slab.
    """
    return _along_sides(x, inner)


@threaded_part
def _correct_slabs(velocity, p, d, z, a, b, passage, level_layout, level, inner, repeats, gain):
    """Correct velocity and pressure slab by slab, and fill the pressure beside the domain; see ``correct``."""
    end = p.shape[0] - PAD
    block_size = slabs_per_block(inner, end - PAD, MIN_SLABS)
    for n in prange((end - PAD + block_size - 1) // block_size):
        block_start = PAD + signed(n) * block_size
        x = np.empty((2, p.shape[1]), p.dtype)
        lower_slab, mid = 0, 1
        _add(x, mid, d, z, block_start - 1, a, b)
        for j in range(block_start, min(block_start + block_size, end)):
            lower_slab, mid = mid, lower_slab
            _add(x, mid, d, z, j, a, b)
            _correct_slab(velocity, p, j, x, lower_slab, mid, passage, level_layout, level, gain, inner)
            seal_slab(p, j, inner, repeats)


@compiled
def correct(velocity, p, d, z, a, b, passage, level_layout, inner, repeats, gain):
    """Subtract ``passage grad x`` from the velocity and add ``gain x`` to the pressure, where ``x = a d + b z``.

    The mean of the added pressure along the sides is zero. Without this condition the pressure drifts and single
    precision resolves its differences less and less. Values on the edges of the domain are corrected with a mirrored
    ``x``, which leaves them unchanged. The pressure beside the domain is mirrored, or periodic.

    Args:
        velocity: shape (axis, slab, cell).
        p: pressure, shape (slab, cell).
        d: first part of the pressure change, shape (slab, cell).
        z: second part of it, shape (slab, cell).
        a: factor of ``d``.
        b: factor of ``z``.
        passage: share of the pressure gradient that acts on each face, shape (axis, slab, cell).
        level_layout: row of the layout for the finest level; see ``slab``.
        inner: strides within a slab.
        repeats: which axes are periodic.
        gain: factor from ``x`` to the pressure.
    """
    level = p.dtype.type(a * _along_sides(d, inner) + b * _along_sides(z, inner))
    _correct_slabs(velocity, p, d, z, a, b, passage, level_layout, level, inner, repeats, gain)
    seal_ends(p, repeats[len(inner)])


@kernel_part
def _speeds(output, velocity, slab, inner):
    """Write the sum of the absolute velocity components of each cell of a slab to ``output``, shape (1, cell)."""
    j, slab_axis = unsigned(slab), unsigned(len(inner))
    run_start, run_end = run_of(inner, velocity.shape[2])
    for k in range(run_start, run_end):
        speed = output.dtype.type(0)
        for d in range(len(inner)):
            a, b = abs(velocity[d, j, k]), abs(velocity[d, j, k + inner[d]])
            speed += a if a > b else b
        a, b = abs(velocity[slab_axis, j, k]), abs(velocity[slab_axis, j + UNIT, k])
        output[0, k] = speed + (a if a > b else b)


@threaded_part
def _fastest_slabs(velocity, inner, sums):
    """Write the largest sum of absolute velocity components in each slab to ``sums[:, 0]``."""
    end = velocity.shape[1] - PAD
    block_size = slabs_per_block(inner, end - PAD, MIN_SLABS)
    for n in prange((end - PAD + block_size - 1) // block_size):
        start = PAD + signed(n) * block_size
        speed, top = np.empty((1, velocity.shape[2]), velocity.dtype), np.empty(LANES, velocity.dtype)
        for j in range(start, min(start + block_size, end)):
            _speeds(speed, velocity, j, inner)
            sums[j, 0] = largest_size(speed, 0, inner, top)


@compiled
def fastest(velocity, inner, sums):
    """Return the largest sum of absolute velocity components in a cell [m/s]; ``sums`` is a work array (slab, 4)."""
    _fastest_slabs(velocity, inner, sums)
    return max_of_column(sums, 0)
