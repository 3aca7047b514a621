# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision)
"""Divergence before the pressure solve, and the correction after it, in cells and flow units."""

import numpy as np
from numba import prange

from suchus.flow.compiled import BLOCK, PAD, UNIT, compiled, part, signed, threaded, unsigned
from suchus.flow.stencil import LANES, largest_size, seal_row


@part
def _divergence_row(r, u, v, row, mean):
    """Write ``-div u - mean`` along a row."""
    j = unsigned(row)
    for k in range(unsigned(PAD), unsigned(r.shape[1] - PAD)):
        r[j, k] = (u[j, k] - u[j, k + UNIT]) + (v[j, k] - v[j + UNIT, k]) - mean


@part
def _size(r, row):
    total, j = r.dtype.type(0), unsigned(row)
    for k in range(unsigned(PAD), unsigned(r.shape[1] - PAD)):
        total += abs(r[j, k])
    return total


@threaded
def residual(r, u, v, source, dinv, window, mean, periodic, sums):
    """Write ``source - div u - mean`` to ``r``; ``sums`` gets its summed size and largest size, row by row.

    Cells that lie wholly inside the body get 0: no pressure acts there.
    """
    end = u.shape[0] - PAD
    for n in prange((end - PAD + BLOCK - 1) // BLOCK):
        block = signed(n)
        top = np.empty(LANES, u.dtype)
        for j in range(PAD + block * BLOCK, min(PAD + (block + 1) * BLOCK, end)):
            _divergence_row(r, u, v, j, mean)
            if window[0] <= j < window[1]:
                c = unsigned(j)
                for i in range(unsigned(window[2]), unsigned(window[3])):
                    r[c, i] = r[c, i] + source[c, i] if dinv[c, i] > 0 else 0
            seal_row(r, j, periodic)
            sums[j, 0] = _size(r, j)
            sums[j, 1] = largest_size(r, j, top)


@compiled
def mean_residual(u, v, source, window):
    """Return the mean of ``source - div u``: what flows in through the sides, and what the bodies push out."""
    s, t, b = PAD, u.shape[0] - PAD, u.shape[1] - PAD
    total = 0.0
    for j in range(s, t):
        total += np.float64(u[j, s]) - np.float64(u[j, b])
    for i in range(s, b):
        total += np.float64(v[s, i]) - np.float64(v[t, i])
    for j in range(window[0], window[1]):
        for i in range(window[2], window[3]):
            total += source[j, i]
    return total / ((t - s) * (b - s))


@part
def _add(out, o, d, z, row, a, b):
    o, j = unsigned(o), unsigned(row)
    if b == 0:
        for k in range(unsigned(d.shape[1])):
            out[o, k] = a * d[j, k]
    else:
        for k in range(unsigned(d.shape[1])):
            out[o, k] = a * d[j, k] + b * z[j, k]


@part
def _correct_plain(u, v, p, row, x, low, mid, level, gain, start, stop):
    j, low, mid = unsigned(row), unsigned(low), unsigned(mid)
    for k in range(unsigned(start), unsigned(stop)):
        m = x[mid, k]
        u[j, k] -= m - x[mid, k - UNIT]
        v[j, k] -= m - x[low, k]
        p[j, k] += gain * (m - level)


@part
def _correct_body(u, v, p, row, x, low, mid, cx, cy, level, gain, start, stop):
    j, low, mid = unsigned(row), unsigned(low), unsigned(mid)
    for k in range(unsigned(start), unsigned(stop)):
        m = x[mid, k]
        u[j, k] -= cx[j, k] * (m - x[mid, k - UNIT])
        v[j, k] -= cy[j, k] * (m - x[low, k])
        p[j, k] += gain * (m - level)


@part
def _along_sides(x):
    """Return the mean of the outermost cells of the domain."""
    n, m = x.shape[0] - PAD - 1, x.shape[1] - PAD - 1
    total = 0.0
    for j in range(PAD, n + 1):
        total += np.float64(x[j, PAD]) + np.float64(x[j, m])
    for i in range(PAD, m + 1):
        total += np.float64(x[PAD, i]) + np.float64(x[n, i])
    return total / (2 * (n + m + 2 - 2 * PAD))


@threaded
def correct(u, v, p, d, z, a, b, cx, cy, window, gain):
    """Subtract ``passage grad x`` from the velocity and add ``gain x`` to the pressure, where ``x = a d + b z``.

    The pressure is pinned: the mean of what is added is zero along the sides. Without that it drifts, and single
    precision has less and less room for what matters. Values on the domain's edges are corrected with a mirrored ``x``,
    that is, left as they are.
    """
    s, e = PAD, u.shape[1] - PAD
    end = u.shape[0] - PAD
    level = u.dtype.type(a * _along_sides(d) + b * _along_sides(z))
    for n in prange((end - PAD + BLOCK - 1) // BLOCK):
        block = signed(n)
        x = np.empty((2, u.shape[1]), u.dtype)
        low, mid = 0, 1
        first = PAD + block * BLOCK
        _add(x, mid, d, z, first - 1, a, b)
        for j in range(first, min(first + BLOCK, end)):
            low, mid = mid, low
            _add(x, mid, d, z, j, a, b)
            f = s
            if window[0] <= j < window[1]:
                _correct_plain(u, v, p, j, x, low, mid, level, gain, s, window[2])
                _correct_body(u, v, p, j, x, low, mid, cx, cy, level, gain, window[2], window[3])
                f = window[3]
            _correct_plain(u, v, p, j, x, low, mid, level, gain, f, e)


@part
def _speeds(out, u, v, row):
    j = unsigned(row)
    for k in range(unsigned(PAD), unsigned(u.shape[1] - PAD)):
        a, b = abs(u[j, k]), abs(u[j, k + UNIT])
        c, d = abs(v[j, k]), abs(v[j + UNIT, k])
        out[0, k] = (a if a > b else b) + (c if c > d else d)


@threaded
def fastest(u, v, sums):
    """Write the largest |u| + |v| of every row to ``sums[:, 0]``."""
    end = u.shape[0] - PAD
    for n in prange((end - PAD + BLOCK - 1) // BLOCK):
        block = signed(n)
        speed, top = np.empty((1, u.shape[1]), u.dtype), np.empty(LANES, u.dtype)
        for j in range(PAD + block * BLOCK, min(PAD + (block + 1) * BLOCK, end)):
            _speeds(speed, u, v, j)
            sums[j, 0] = largest_size(speed, 0, top)
