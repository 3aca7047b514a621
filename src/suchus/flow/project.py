# mypy: disable-error-code="no-untyped-def, var-annotated, assignment"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""Divergence before the pressure solve, and the correction after it, in cells and flow units; see ``slab``."""

import numpy as np
from numba import prange

from suchus.flow.compiled import PAD, UNIT, compiled, part, signed, threaded, unsigned
from suchus.flow.slab import (
    EDGE,
    LEAST,
    block_of,
    meets,
    near_shift,
    row_count,
    row_length,
    run_of,
    window_columns,
    window_rows,
)
from suchus.flow.stencil import LANES, largest_size, seal_slab, summed_size


@part
def _divergence_slab(r, velocity, slab, mean, inner):
    """Write ``-div u - mean`` along a slab."""
    j, up = unsigned(slab), unsigned(len(inner))
    first, end = run_of(inner, r.shape[1])
    for k in range(first, end):
        net = r.dtype.type(0)
        for d in range(len(inner)):
            net += velocity[d, j, k] - velocity[d, j, k + inner[d]]
        r[j, k] = net + (velocity[up, j, k] - velocity[up, j + UNIT, k]) - mean


@threaded
def residual(r, velocity, source, dinv, place, near, mean, inner, repeats, sums):
    """Write ``source - div u - mean`` to ``r``; ``sums`` gets its summed size and largest size, slab by slab.

    Cells that lie wholly inside the body get 0: no pressure acts there. ``source`` is an array of the window ``near``.
    """
    end = r.shape[0] - PAD
    block = block_of(inner, end - PAD, LEAST)
    for n in prange((end - PAD + block - 1) // block):
        start = PAD + signed(n) * block
        top = np.empty(LANES, r.dtype)
        for j in range(start, min(start + block, end)):
            _divergence_slab(r, velocity, j, mean, inner)
            if meets(place, inner, j):
                c, wide, (r0, r1) = unsigned(j), row_length(inner, r.shape[1]), window_rows(place, inner)
                (s, e), o = window_columns(place, inner), c - unsigned(near[len(inner) + 2])
                for row in range(r0, r1):
                    shift = near_shift(near, inner, row, wide)
                    for i in range(row * wide + s, row * wide + e):
                        r[c, i] = r[c, i] + source[o, i - shift] if dinv[c, i] > 0 else 0
            seal_slab(r, j, inner, repeats)
            sums[j, 0] = summed_size(r, j, inner)
            sums[j, 1] = largest_size(r, j, inner, top)


@part
def _mean_of_plane(u, v, source, place, near):
    s, t, b = PAD, u.shape[0] - PAD, u.shape[1] - PAD
    total = 0.0
    for j in range(s, t):
        total += np.float64(u[j, s]) - np.float64(u[j, b])
    for i in range(s, b):
        total += np.float64(v[s, i]) - np.float64(v[t, i])
    for j in range(place[3], place[4]):
        for i in range(place[5], place[6]):
            total += source[j - near[3], i - near[5]]
    return total / ((t - s) * (b - s))


@part
def _mean_in_space(velocity, source, place, near, inner):
    end, wide, total = velocity.shape[1] - PAD, signed(row_length(inner, velocity.shape[2])), 0.0
    rows, columns = signed(row_count(inner, velocity.shape[2])), wide - 2 * PAD
    for row in range(PAD, rows + PAD):
        for j in range(PAD, end):
            k = row * wide + PAD
            total += np.float64(velocity[0, j, k]) - np.float64(velocity[0, j, k + columns])
        for i in range(row * wide + PAD, row * wide + PAD + columns):
            total += np.float64(velocity[2, PAD, i]) - np.float64(velocity[2, end, i])
    for j in range(PAD, end):
        for i in range(PAD * wide + PAD, PAD * wide + PAD + columns):
            total += np.float64(velocity[1, j, i]) - np.float64(velocity[1, j, i + rows * wide])
    for j in range(place[4], place[5]):
        for row in range(place[6], place[7]):
            for i in range(place[8], place[9]):
                total += source[j - near[4], (row - near[6]) * (near[9] - near[8] + 1) + i - near[8]]
    return total / ((end - PAD) * rows * columns)


@compiled
def mean_residual(velocity, source, place, near, inner):
    """Return the mean of ``source - div u``: what flows in through the sides, and what the bodies push out."""
    if len(inner) == 1:
        return _mean_of_plane(velocity[0], velocity[1], source, place, near)
    return _mean_in_space(velocity, source, place, near, inner)


@part
def _add(out, o, d, z, slab, a, b):
    o, j = unsigned(o), unsigned(slab)
    if b == 0:
        for k in range(unsigned(d.shape[1])):
            out[o, k] = a * d[j, k]
    else:
        for k in range(unsigned(d.shape[1])):
            out[o, k] = a * d[j, k] + b * z[j, k]


@part
def _correct_plain(velocity, p, slab, x, low, mid, level, gain, start, stop, inner):
    j, low, mid, up = unsigned(slab), unsigned(low), unsigned(mid), unsigned(len(inner))
    for k in range(start, stop):
        m = x[mid, k]
        for d in range(len(inner)):
            velocity[d, j, k] -= m - x[mid, k - inner[d]]
        velocity[up, j, k] -= m - x[low, k]
        p[j, k] += gain * (m - level)


@part
def _correct_body(velocity, p, slab, x, low, mid, passage, level, gain, start, stop, inner):
    j, low, mid, up = unsigned(slab), unsigned(low), unsigned(mid), unsigned(len(inner))
    for k in range(start, stop):
        m = x[mid, k]
        for d in range(len(inner)):
            velocity[d, j, k] -= passage[d, j, k] * (m - x[mid, k - inner[d]])
        velocity[up, j, k] -= passage[up, j, k] * (m - x[low, k])
        p[j, k] += gain * (m - level)


@part
def _correct_slab(velocity, p, slab, x, low, mid, passage, place, level, gain, inner):
    wide, (r0, r1), (w0, w1) = row_length(inner, p.shape[1]), window_rows(place, inner), window_columns(place, inner)
    inside = meets(place, inner, slab)
    for n in range(row_count(inner, p.shape[1])):
        row = n + EDGE if len(inner) > 1 else n
        f, e = row * wide + EDGE, row * wide + wide - EDGE
        if inside and r0 <= row < r1:
            _correct_plain(velocity, p, slab, x, low, mid, level, gain, f, row * wide + w0, inner)
            _correct_body(
                velocity, p, slab, x, low, mid, passage, level, gain, row * wide + w0, row * wide + w1, inner
            )  # fmt: skip
            f = row * wide + w1
        _correct_plain(velocity, p, slab, x, low, mid, level, gain, f, e, inner)


@part
def _along_sides(x, inner):
    """Return the mean of the outermost cells of the domain; one in a corner counts for each of its sides."""
    n, wide, total = x.shape[0] - PAD - 1, signed(row_length(inner, x.shape[1])), 0.0
    m = wide - PAD - 1
    if len(inner) == 1:
        for j in range(PAD, n + 1):
            total += np.float64(x[j, PAD]) + np.float64(x[j, m])
        for i in range(PAD, m + 1):
            total += np.float64(x[PAD, i]) + np.float64(x[n, i])
        return total / (2 * (n + m + 2 - 2 * PAD))
    last, count = PAD + signed(row_count(inner, x.shape[1])) - 1, 0
    for j in range(PAD, n + 1):
        for row in range(PAD, last + 1):
            total += np.float64(x[j, row * wide + PAD]) + np.float64(x[j, row * wide + m])
        for i in range(PAD, m + 1):
            total += np.float64(x[j, PAD * wide + i]) + np.float64(x[j, last * wide + i])
        count += 2 * (last + m + 2 - 2 * PAD)
    for row in range(PAD, last + 1):
        for i in range(row * wide + PAD, row * wide + m + 1):
            total += np.float64(x[PAD, i]) + np.float64(x[n, i])
        count += 2 * (m + 1 - PAD)
    return total / count


@threaded
def correct(velocity, p, d, z, a, b, passage, place, inner, gain):
    """Subtract ``passage grad x`` from the velocity and add ``gain x`` to the pressure, where ``x = a d + b z``.

    The pressure is pinned: the mean of what is added is zero along the sides. Without that it drifts, and single
    precision has less and less room for what matters. Values on the domain's edges are corrected with a mirrored ``x``,
    that is, left as they are.
    """
    end = p.shape[0] - PAD
    block = block_of(inner, end - PAD, LEAST)
    level = p.dtype.type(a * _along_sides(d, inner) + b * _along_sides(z, inner))
    for n in prange((end - PAD + block - 1) // block):
        first = PAD + signed(n) * block
        x = np.empty((2, p.shape[1]), p.dtype)
        low, mid = 0, 1
        _add(x, mid, d, z, first - 1, a, b)
        for j in range(first, min(first + block, end)):
            low, mid = mid, low
            _add(x, mid, d, z, j, a, b)
            _correct_slab(velocity, p, j, x, low, mid, passage, place, level, gain, inner)


@part
def _speeds(out, velocity, slab, inner):
    j, up = unsigned(slab), unsigned(len(inner))
    first, end = run_of(inner, velocity.shape[2])
    for k in range(first, end):
        speed = out.dtype.type(0)
        for d in range(len(inner)):
            a, b = abs(velocity[d, j, k]), abs(velocity[d, j, k + inner[d]])
            speed += a if a > b else b
        a, b = abs(velocity[up, j, k]), abs(velocity[up, j + UNIT, k])
        out[0, k] = speed + (a if a > b else b)


@threaded
def fastest(velocity, inner, sums):
    """Write the largest sum of the components' sizes of every slab to ``sums[:, 0]``."""
    end = velocity.shape[1] - PAD
    block = block_of(inner, end - PAD, LEAST)
    for n in prange((end - PAD + block - 1) // block):
        start = PAD + signed(n) * block
        speed, top = np.empty((1, velocity.shape[2]), velocity.dtype), np.empty(LANES, velocity.dtype)
        for j in range(start, min(start + block, end)):
            _speeds(speed, velocity, j, inner)
            sums[j, 0] = largest_size(speed, 0, inner, top)
