# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision)
"""Divergence before the pressure solve, and the correction after it, in cells and flow units."""

import numpy as np
from numba import prange

from suchus.flow.compiled import BLOCK, PAD, compiled, threaded
from suchus.flow.stencil import seal_row


@compiled
def _divergence_row(r, u_left, u_right, v_low, v_high):
    for k in range(r.size):
        r[k] = (u_left[k] - u_right[k]) + (v_low[k] - v_high[k])


@compiled
def _norms(r):
    total, size = 0.0, 0.0
    largest = r.dtype.type(0)
    for k in range(r.size):
        total += np.float64(r[k])
        size += np.float64(abs(r[k]))
        largest = abs(r[k]) if abs(r[k]) > largest else largest
    return total, size, largest


@threaded
def residual(r, u, v, source, dinv, window, periodic, sums):
    """Write ``source - div u`` to ``r``; ``sums`` (row, 3) gets its sum, summed size and largest size.

    Cells that lie wholly inside the body get 0: no pressure acts there.
    """
    s, e = PAD, u.shape[1] - PAD
    end = u.shape[0] - PAD
    for block in prange((end - PAD + BLOCK - 1) // BLOCK):
        for j in range(PAD + block * BLOCK, min(PAD + (block + 1) * BLOCK, end)):
            _divergence_row(r[j, s:e], u[j, s:e], u[j, s + 1 : e + 1], v[j, s:e], v[j + 1, s:e])
            if window[0] <= j < window[1]:
                for i in range(window[2], window[3]):
                    r[j, i] = r[j, i] + source[j, i] if dinv[j, i] > 0 else 0
            seal_row(r[j], periodic[0])
            total, size, largest = _norms(r[j, s:e])
            sums[j, 0] = total
            sums[j, 1] = size
            sums[j, 2] = largest


@threaded
def level_out(r, mean, periodic):
    """Subtract ``mean`` from every cell: what the bodies swallow or push out, the domain takes up evenly."""
    s, e = PAD, r.shape[1] - PAD
    end = r.shape[0] - PAD
    for block in prange((end - PAD + BLOCK - 1) // BLOCK):
        for j in range(PAD + block * BLOCK, min(PAD + (block + 1) * BLOCK, end)):
            r[j, s:e] -= mean
            seal_row(r[j], periodic[0])


@compiled
def _correct_plain(u, v, p, x, x_left, x_low, gain):
    for k in range(u.size):
        u[k] -= x[k] - x_left[k]
        v[k] -= x[k] - x_low[k]
        p[k] += gain * x[k]


@compiled
def _correct_body(u, v, p, x, x_left, x_low, cx, cy, gain):
    for k in range(u.size):
        u[k] -= cx[k] * (x[k] - x_left[k])
        v[k] -= cy[k] * (x[k] - x_low[k])
        p[k] += gain * x[k]


@compiled
def _fastest(u, u_next, v, v_next):
    top = u.dtype.type(0)
    for k in range(u.size):
        a, b = abs(u[k]), abs(u_next[k])
        c, d = abs(v[k]), abs(v_next[k])
        speed = (a if a > b else b) + (c if c > d else d)
        top = speed if speed > top else top
    return top


@threaded
def correct(u, v, p, x, cx, cy, window, gain):
    """Subtract ``passage grad x`` from the velocity and add ``gain x`` to the pressure.

    Values on the domain's edges are corrected with a mirrored ``x``, that is, left as they are.
    """
    s, e = PAD, u.shape[1] - PAD
    end = u.shape[0] - PAD
    for block in prange((end - PAD + BLOCK - 1) // BLOCK):
        for j in range(PAD + block * BLOCK, min(PAD + (block + 1) * BLOCK, end)):
            if window[0] <= j < window[1]:
                a, b = window[2], window[3]
                _correct_plain(u[j, s:a], v[j, s:a], p[j, s:a], x[j, s:a], x[j, s - 1 : a - 1], x[j - 1, s:a], gain)
                _correct_body(
                    u[j, a:b], v[j, a:b], p[j, a:b], x[j, a:b], x[j, a - 1 : b - 1], x[j - 1, a:b],
                    cx[j, a:b], cy[j, a:b], gain,
                )  # fmt: skip
                s_rest = b
            else:
                s_rest = s
            a = s_rest
            _correct_plain(u[j, a:e], v[j, a:e], p[j, a:e], x[j, a:e], x[j, a - 1 : e - 1], x[j - 1, a:e], gain)


@threaded
def fastest(u, v, sums):
    """Write the largest |u| + |v| of every row to ``sums[:, 0]``."""
    s, e = PAD, u.shape[1] - PAD
    end = u.shape[0] - PAD
    for block in prange((end - PAD + BLOCK - 1) // BLOCK):
        for j in range(PAD + block * BLOCK, min(PAD + (block + 1) * BLOCK, end)):
            sums[j, 0] = _fastest(u[j, s:e], u[j, s + 1 : e + 1], v[j, s:e], v[j + 1, s:e])
