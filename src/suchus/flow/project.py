# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""Divergence before the pressure solve, and the correction after it, in cells and flow units; see ``slab``."""

import numpy as np
from numba import prange

from suchus.flow.compiled import PAD, UNIT, compiled, part, signed, threaded, unsigned
from suchus.flow.slab import EDGE, block_of, meets, row_count, row_length, run_of, window_columns, window_rows
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
def residual(r, velocity, source, dinv, place, mean, inner, repeats, sums):
    """Write ``source - div u - mean`` to ``r``; ``sums`` gets its summed size and largest size, slab by slab.

    Cells that lie wholly inside the body get 0: no pressure acts there.
    """
    end, block = r.shape[0] - PAD, block_of(inner)
    for n in prange((end - PAD + block - 1) // block):
        start = PAD + signed(n) * block
        top = np.empty(LANES, r.dtype)
        for j in range(start, min(start + block, end)):
            _divergence_slab(r, velocity, j, mean, inner)
            if meets(place, inner, j):
                c, wide, (r0, r1) = unsigned(j), row_length(inner, r.shape[1]), window_rows(place, inner)
                s, e = window_columns(place, inner)
                for row in range(r0, r1):
                    for i in range(row * wide + s, row * wide + e):
                        r[c, i] = r[c, i] + source[c, i] if dinv[c, i] > 0 else 0
            seal_slab(r, j, inner, repeats)
            sums[j, 0] = summed_size(r, j, inner)
            sums[j, 1] = largest_size(r, j, inner, top)


@part
def _through_sides(velocity, inner):
    """Return what flows in through the sides."""
    total, up, n, length = 0.0, len(inner), velocity.shape[1], velocity.shape[2]
    wide = signed(row_length(inner, length))
    rows, columns = signed(row_count(inner, length)), wide - 2 * PAD
    for d in range(len(inner)):
        # cells before a side along axis d, and the rows (d = 0) or cells (d = 1) along it
        far = columns if d == 0 else rows * wide
        for j in range(PAD, n - PAD):
            for m in range(rows if d == 0 else columns):
                k = PAD + (PAD + m) * wide if d == 0 else PAD * wide + PAD + m
                k = k if len(inner) > 1 else PAD
                total += np.float64(velocity[d, j, k]) - np.float64(velocity[d, j, k + far])
    for m in range(rows):
        s = PAD + (PAD + m) * wide if len(inner) > 1 else PAD
        for i in range(s, s + columns):
            total += np.float64(velocity[up, PAD, i]) - np.float64(velocity[up, n - PAD, i])
    return total, (n - 2 * PAD) * rows * columns


@compiled
def mean_residual(velocity, source, place, inner):
    """Return the mean of ``source - div u``: what flows in through the sides, and what the bodies push out."""
    total, cells = _through_sides(velocity, inner)
    wide, (r0, r1), (s, e) = row_length(inner, source.shape[1]), window_rows(place, inner), window_columns(place, inner)
    for j in range(source.shape[0]):
        if meets(place, inner, j):
            for row in range(r0, r1):
                for i in range(row * wide + s, row * wide + e):
                    total += source[unsigned(j), i]
    return total / cells


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
    last, wide = x.shape[0] - PAD - 1, signed(row_length(inner, x.shape[1]))
    rows, columns, count, total = signed(row_count(inner, x.shape[1])), wide - 2 * PAD, 0, 0.0
    for j in range(PAD, last + 1):
        for d in range(len(inner)):
            far = columns - 1 if d == 0 else (rows - 1) * wide
            for m in range(rows if d == 0 else columns):
                k = PAD + (PAD + m) * wide if d == 0 else PAD * wide + PAD + m
                k = k if len(inner) > 1 else PAD
                total += np.float64(x[j, k]) + np.float64(x[j, k + far])
                count += 2
    for m in range(rows):
        s = PAD + (PAD + m) * wide if len(inner) > 1 else PAD
        for i in range(s, s + columns):
            total += np.float64(x[PAD, i]) + np.float64(x[last, i])
            count += 2
    return total / count


@threaded
def correct(velocity, p, d, z, a, b, passage, place, inner, gain):
    """Subtract ``passage grad x`` from the velocity and add ``gain x`` to the pressure, where ``x = a d + b z``.

    The pressure is pinned: the mean of what is added is zero along the sides. Without that it drifts, and single
    precision has less and less room for what matters. Values on the domain's edges are corrected with a mirrored ``x``,
    that is, left as they are.
    """
    end, block = p.shape[0] - PAD, block_of(inner)
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
    end, block = velocity.shape[1] - PAD, block_of(inner)
    for n in prange((end - PAD + block - 1) // block):
        start = PAD + signed(n) * block
        speed, top = np.empty((1, velocity.shape[2]), velocity.dtype), np.empty(LANES, velocity.dtype)
        for j in range(start, min(start + block, end)):
            _speeds(speed, velocity, j, inner)
            sums[j, 0] = largest_size(speed, 0, inner, top)
