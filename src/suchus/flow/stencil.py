# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision)
"""Rows of the pressure equation: the five-point operator and its smoothing steps.

The coefficients differ from 1 only inside a window; everywhere else the plain stencil needs none from memory. A
``place`` is a row of the multigrid's layout, whose last four numbers are that window.
"""

import numpy as np

from suchus.flow.compiled import PAD, compiled

FIRST, SECOND = 0.5617, 1.3896
"""Jacobi weights: Chebyshev roots for the eigenvalues 0.5 to 2 of the scaled operator [-]."""


@compiled
def seal_row(row, periodic):
    """Fill the two cells beside a row's ends that the stencil reads."""
    n = row.size
    if periodic:
        row[PAD - 1] = row[n - PAD - 1]
        row[n - PAD] = row[PAD]
    else:
        row[PAD - 1] = row[PAD]
        row[n - PAD] = row[n - PAD - 1]


@compiled
def seal_ends(x, periodic):
    """Fill the row below the first and the row above the last."""
    n = x.shape[0]
    if periodic:
        x[PAD - 1] = x[n - PAD - 1]
        x[n - PAD] = x[PAD]
    else:
        x[PAD - 1] = x[PAD]
        x[n - PAD] = x[n - PAD - 1]


@compiled
def _apply_plain(out, mid, left, right, low, high):
    """Write the operator times x along a row where all coefficients are 1."""
    four = out.dtype.type(4.0)
    for k in range(out.size):
        out[k] = four * mid[k] - ((left[k] + right[k]) + (low[k] + high[k]))


@compiled
def _apply_body(out, mid, left, right, low, high, c_left, c_right, c_low, c_high):
    """Write the operator times x along a row with coefficients."""
    for k in range(out.size):
        m = mid[k]
        out[k] = (c_left[k] * (m - left[k]) + c_right[k] * (m - right[k])) + (
            c_low[k] * (m - low[k]) + c_high[k] * (m - high[k])
        )


@compiled
def apply_row(out, x, cx, cy, place, j):
    """Write the operator times ``x`` along row ``j`` to ``out``, which has the width of the domain."""
    s, e = PAD, PAD + out.size
    m, a, b = x[j], x[j - 1], x[j + 1]
    _apply_plain(out, m[s:e], m[s - 1 : e - 1], m[s + 1 : e + 1], a[s:e], b[s:e])
    if place[3] <= j < place[4]:
        s, e = place[5], place[6]
        _apply_body(
            out[s - PAD : e - PAD],
            m[s:e],
            m[s - 1 : e - 1],
            m[s + 1 : e + 1],
            a[s:e],
            b[s:e],
            cx[j, s:e],
            cx[j, s + 1 : e + 1],
            cy[j, s:e],
            cy[j + 1, s:e],
        )


@compiled
def _first_row(out, b, left, right, low, high, w1, w2):
    """Write two smoothing steps that start from nothing, where all coefficients are 1."""
    once = b.dtype.type(0.25) * w1
    own = once + w2 * b.dtype.type(0.25) - w2 * once
    near = w2 * b.dtype.type(0.25) * once
    for k in range(out.size):
        out[k] = own * b[k] + near * ((left[k] + right[k]) + (low[k] + high[k]))


@compiled
def presmooth(x, b, cx, cy, dinv, place, j0, j1, periodic):
    """Write two smoothing steps that start from nothing to rows ``j0`` to ``j1`` of ``x``."""
    w1, w2 = x.dtype.type(FIRST), x.dtype.type(SECOND)
    s, e = PAD, x.shape[1] - PAD
    for j in range(j0, j1):
        m = b[j]
        _first_row(x[j, s:e], m[s:e], m[s - 1 : e - 1], m[s + 1 : e + 1], b[j - 1, s:e], b[j + 1, s:e], w1, w2)
        if place[3] <= j < place[4]:
            for i in range(place[5], place[6]):
                y = w1 * dinv[j, i] * b[j, i]
                a = (
                    cx[j, i] * (y - w1 * dinv[j, i - 1] * b[j, i - 1])
                    + cx[j, i + 1] * (y - w1 * dinv[j, i + 1] * b[j, i + 1])
                    + cy[j, i] * (y - w1 * dinv[j - 1, i] * b[j - 1, i])
                    + cy[j + 1, i] * (y - w1 * dinv[j + 1, i] * b[j + 1, i])
                )
                x[j, i] = y + w2 * dinv[j, i] * (b[j, i] - a)
        seal_row(x[j], periodic)


@compiled
def _relax_plain(out, b, mid, left, right, low, high, weight):
    """Write one Jacobi step along a row where all coefficients are 1."""
    quarter = weight * out.dtype.type(0.25)
    stay = out.dtype.type(1.0) - weight
    for k in range(out.size):
        out[k] = stay * mid[k] + quarter * (b[k] + ((left[k] + right[k]) + (low[k] + high[k])))


@compiled
def _relax_body(out, b, dinv, mid, ax, weight):
    for k in range(out.size):
        out[k] = mid[k] + weight * dinv[k] * (b[k] - ax[k])


@compiled
def smooth(out, x, b, cx, cy, dinv, place, j0, j1, weight, periodic):
    """Write one Jacobi step from ``x`` to rows ``j0`` to ``j1`` of ``out``."""
    s, e = PAD, x.shape[1] - PAD
    ax = np.empty(place[6] - place[5], x.dtype)
    for j in range(j0, j1):
        m = x[j]
        _relax_plain(
            out[j, s:e], b[j, s:e], m[s:e], m[s - 1 : e - 1], m[s + 1 : e + 1], x[j - 1, s:e], x[j + 1, s:e], weight
        )
        if place[3] <= j < place[4]:
            f, t = place[5], place[6]
            _apply_body(
                ax,
                m[f:t],
                m[f - 1 : t - 1],
                m[f + 1 : t + 1],
                x[j - 1, f:t],
                x[j + 1, f:t],
                cx[j, f:t],
                cx[j, f + 1 : t + 1],
                cy[j, f:t],
                cy[j + 1, f:t],
            )
            _relax_body(out[j, f:t], b[j, f:t], dinv[j, f:t], m[f:t], ax, weight)
        seal_row(out[j], periodic)


@compiled
def smooth_window(out, x, b, cx, cy, dinv, place, weight):
    """Write one Jacobi step from ``x`` to ``out``, in the window only."""
    f, t = place[5], place[6]
    ax = np.empty(t - f, x.dtype)
    for j in range(place[3], place[4]):
        m = x[j]
        _apply_body(
            ax, m[f:t], m[f - 1 : t - 1], m[f + 1 : t + 1], x[j - 1, f:t], x[j + 1, f:t],
            cx[j, f:t], cx[j, f + 1 : t + 1], cy[j, f:t], cy[j + 1, f:t],
        )  # fmt: skip
        _relax_body(out[j, f:t], b[j, f:t], dinv[j, f:t], m[f:t], ax, weight)
