# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision)
"""Rows of the pressure equation: the five-point operator and its smoothing steps.

The coefficients differ from 1 only inside a window; everywhere else the plain stencil needs none from memory. A
``place`` is a row of the multigrid's layout, whose last four numbers are that window. A row is named by an array and
its number in it; ``low``, ``mid`` and ``high`` are the numbers of the row below, the row itself and the row above.
"""

from suchus.flow.compiled import PAD, UNIT, compiled, part, unsigned

FIRST, SECOND = 0.5617, 1.3896
"""Jacobi weights: Chebyshev roots for the eigenvalues 0.5 to 2 of the scaled operator [-]."""

LANES = 16
"""Numbers that a largest is kept of side by side: one alone is not vectorised, as it could hide a NaN [-]."""


@part
def seal_row(a, row, periodic):
    """Fill the two cells beside a row's ends that the stencil reads."""
    j, n = unsigned(row), a.shape[1]
    if periodic:
        a[j, PAD - 1] = a[j, n - PAD - 1]
        a[j, n - PAD] = a[j, PAD]
    else:
        a[j, PAD - 1] = a[j, PAD]
        a[j, n - PAD] = a[j, n - PAD - 1]


@part
def copy_row(to, o, x, row):
    """Copy row ``row`` of ``x`` to row ``o`` of ``to``.

    Written out: an assignment of slices brings along numba's message for slices that do not fit, which takes longer to
    compile than the kernels.
    """
    o, j = unsigned(o), unsigned(row)
    for k in range(unsigned(x.shape[1])):
        to[o, k] = x[j, k]


@compiled
def seal_ends(x, periodic):
    """Fill the row below the first and the row above the last."""
    n = x.shape[0]
    copy_row(x, PAD - 1, x, n - PAD - 1 if periodic else PAD)
    copy_row(x, n - PAD, x, PAD if periodic else n - PAD - 1)


@part
def largest_size(a, row, top):
    """Return the largest absolute value of a row inside the domain; ``top`` is room for ``LANES`` numbers."""
    j, s, e = unsigned(row), unsigned(PAD), unsigned(a.shape[1] - PAD)
    lanes = unsigned(LANES)
    for k in range(lanes):
        top[k] = 0
    whole = s + (e - s) // lanes * lanes
    for i in range(s, whole, lanes):
        for k in range(lanes):
            size = abs(a[j, i + k])
            top[k] = size if size > top[k] else top[k]
    for i in range(whole, e):
        size = abs(a[j, i])
        top[0] = size if size > top[0] else top[0]
    largest = top[0]
    for k in range(UNIT, lanes):
        largest = top[k] if top[k] > largest else largest
    return largest


@part
def _apply_body(x, low, mid, high, cx, cy, j, k):
    m = x[mid, k]
    return (cx[j, k] * (m - x[mid, k - UNIT]) + cx[j, k + UNIT] * (m - x[mid, k + UNIT])) + (
        cy[j, k] * (m - x[low, k]) + cy[j + UNIT, k] * (m - x[high, k])
    )


@part
def apply_rows(out, o, x, low, mid, high, cx, cy, place, row):
    """Write the operator times row ``row`` of the level, which is ``mid`` in ``x``, to row ``o`` of ``out``."""
    o, low, mid, high, j = unsigned(o), unsigned(low), unsigned(mid), unsigned(high), unsigned(row)
    four = out.dtype.type(4.0)
    for k in range(unsigned(PAD), unsigned(x.shape[1] - PAD)):
        out[o, k] = four * x[mid, k] - ((x[mid, k - UNIT] + x[mid, k + UNIT]) + (x[low, k] + x[high, k]))
    if place[3] <= row < place[4]:
        for k in range(unsigned(place[5]), unsigned(place[6])):
            out[o, k] = _apply_body(x, low, mid, high, cx, cy, j, k)


@part
def first_row(out, o, shift, b, row, start, stop):
    """Write two smoothing steps that start from nothing, where all coefficients are 1; ``b`` is the right side.

    Columns ``start`` to ``stop`` of row ``row`` go to row ``o`` of ``out``, ``shift`` columns further left.
    """
    o, shift, j = unsigned(o), unsigned(shift), unsigned(row)
    w1, w2 = out.dtype.type(FIRST), out.dtype.type(SECOND)
    once = out.dtype.type(0.25) * w1
    own = once + w2 * out.dtype.type(0.25) - w2 * once
    near = w2 * out.dtype.type(0.25) * once
    for k in range(unsigned(start), unsigned(stop)):
        around = (b[j, k - UNIT] + b[j, k + UNIT]) + (b[j - UNIT, k] + b[j + UNIT, k])
        out[o, k - shift] = own * b[j, k] + near * around


@part
def relax_rows(out, o, x, low, mid, high, b, cx, cy, dinv, place, row, weight, periodic):
    """Write one Jacobi step of row ``row`` of the level, which is ``mid`` in ``x``, to row ``o`` of ``out``."""
    o, low, mid, high, j = unsigned(o), unsigned(low), unsigned(mid), unsigned(high), unsigned(row)
    quarter = weight * out.dtype.type(0.25)
    stay = out.dtype.type(1.0) - weight
    for k in range(unsigned(PAD), unsigned(x.shape[1] - PAD)):
        around = (x[mid, k - UNIT] + x[mid, k + UNIT]) + (x[low, k] + x[high, k])
        out[o, k] = stay * x[mid, k] + quarter * (b[j, k] + around)
    if place[3] <= row < place[4]:
        for k in range(unsigned(place[5]), unsigned(place[6])):
            rest = b[j, k] - _apply_body(x, low, mid, high, cx, cy, j, k)
            out[o, k] = x[mid, k] + weight * dinv[j, k] * rest
    seal_row(out, o, periodic)


@part
def smooth(out, x, b, cx, cy, dinv, place, weight, periodic):
    """Write one Jacobi step from ``x`` to ``out``."""
    for j in range(PAD, x.shape[0] - PAD):
        relax_rows(out, j, x, j - 1, j, j + 1, b, cx, cy, dinv, place, j, weight, periodic)


@part
def relax_patch(out, x, b, cx, cy, dinv, width, weight):
    """Write one Jacobi step from ``x`` to ``out`` on a small array whose rows of ``width`` cells lie end to end.

    The first and the last row stay as they are, and so does each cell whose ``dinv`` is 0.
    """
    wide = unsigned(width)
    for k in range(wide, unsigned(x.size) - wide):
        m = x[k]
        ax = (cx[k] * (m - x[k - UNIT]) + cx[k + UNIT] * (m - x[k + UNIT])) + (
            cy[k] * (m - x[k - wide]) + cy[k + wide] * (m - x[k + wide])
        )
        out[k] = m + weight * dinv[k] * (b[k] - ax)
