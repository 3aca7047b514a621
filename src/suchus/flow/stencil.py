# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""Slabs of the pressure equation: the operator of the cells and its smoothing steps.

The coefficients differ from 1 only inside a window; everywhere else the plain stencil needs none from memory. A slab is
named by an array and its number in it; ``low``, ``mid`` and ``high`` are the numbers of the slab below, the slab itself
and the slab above. ``faces[d]`` are the coefficients of the faces before the cells along axis d. See ``slab``.
"""

from suchus.flow.compiled import PAD, UNIT, ordered_part, part, unsigned
from suchus.flow.slab import EDGE, meets, row_count, row_length, run_of, window_columns, window_rows

WEIGHTS = (0.5617, 1.3896), (0.5695, 1.7319)
"""Jacobi weights in two and in three dimensions: Chebyshev roots for the eigenvalues of the scaled operator, 0.5 to 2
and 1/3 to 2 [-]."""

LANES = 16
"""Numbers that a largest is kept of side by side: one alone is not vectorised, as it could hide a NaN [-]."""


@part
def weights(inner, real):
    """Return the two Jacobi weights."""
    return (
        real(WEIGHTS[0][0] if len(inner) == 1 else WEIGHTS[1][0]),
        real(WEIGHTS[0][1] if len(inner) == 1 else WEIGHTS[1][1]),
    )


@part
def seal_slab(a, slab, inner, repeats):
    """Fill the cells beside the domain that the stencil reads along the axes of a slab."""
    j, wide = unsigned(slab), row_length(inner, a.shape[1])
    for row in range(row_count(inner, a.shape[1])):
        first = EDGE + (EDGE + row) * wide if len(inner) > 1 else EDGE
        last = first + wide - EDGE - EDGE - UNIT
        if repeats[0]:
            a[j, first - UNIT] = a[j, last]
            a[j, last + UNIT] = a[j, first]
        else:
            a[j, first - UNIT] = a[j, first]
            a[j, last + UNIT] = a[j, last]
    if len(inner) > 1:
        first, last = EDGE * wide, unsigned(a.shape[1]) - (EDGE + UNIT) * wide
        for k in range(wide):
            a[j, first - wide + k] = a[j, last + k] if repeats[1] else a[j, first + k]
            a[j, last + wide + k] = a[j, first + k] if repeats[1] else a[j, last + k]


@part
def copy_slab(to, o, x, slab):
    """Copy slab ``slab`` of ``x`` to slab ``o`` of ``to``.

    Written out: an assignment of slices brings along numba's message for slices that do not fit, which takes longer to
    compile than the kernels.
    """
    o, j = unsigned(o), unsigned(slab)
    for k in range(unsigned(x.shape[1])):
        to[o, k] = x[j, k]


@part
def seal_ends(x, periodic):
    """Fill the slab below the first and the slab above the last."""
    n = x.shape[0]
    copy_slab(x, PAD - 1, x, n - PAD - 1 if periodic else PAD)
    copy_slab(x, n - PAD, x, PAD if periodic else n - PAD - 1)


@part
def largest_size(a, slab, inner, top):
    """Return the largest absolute value of a slab inside the domain; ``top`` is room for ``LANES`` numbers."""
    j, wide, lanes = unsigned(slab), row_length(inner, a.shape[1]), unsigned(LANES)
    for k in range(lanes):
        top[k] = 0
    for row in range(row_count(inner, a.shape[1])):
        s = EDGE + (EDGE + row) * wide if len(inner) > 1 else EDGE
        e = s + wide - EDGE - EDGE
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
def summed_size(a, slab, inner):
    """Return the summed absolute values of a slab inside the domain."""
    j, wide, whole = unsigned(slab), row_length(inner, a.shape[1]), 0.0
    for row in range(row_count(inner, a.shape[1])):
        s = EDGE + (EDGE + row) * wide if len(inner) > 1 else EDGE
        total = a.dtype.type(0)
        for k in range(s, s + wide - EDGE - EDGE):
            total += abs(a[j, k])
        whole += total
    return whole


@part
def _apply_body(x, low, mid, high, faces, j, k, inner):
    m, up, total = x[mid, k], unsigned(len(inner)), x.dtype.type(0)
    for d in range(len(inner)):
        s = inner[d]
        total += faces[d, j, k] * (m - x[mid, k - s]) + faces[d, j, k + s] * (m - x[mid, k + s])
    return total + (faces[up, j, k] * (m - x[low, k]) + faces[up, j + UNIT, k] * (m - x[high, k]))


@part
def apply_slabs(out, o, x, low, mid, high, faces, place, slab, inner):
    """Write the operator times slab ``slab`` of the level, which is ``mid`` in ``x``, to slab ``o`` of ``out``."""
    o, low, mid, high, j = unsigned(o), unsigned(low), unsigned(mid), unsigned(high), unsigned(slab)
    all_around = out.dtype.type(2 * len(inner) + 2)
    first, end = run_of(inner, x.shape[1])
    for k in range(first, end):
        around = x.dtype.type(0)
        for d in range(len(inner)):
            around += x[mid, k - inner[d]] + x[mid, k + inner[d]]
        out[o, k] = all_around * x[mid, k] - (around + (x[low, k] + x[high, k]))
    if meets(place, inner, slab):
        wide, (r0, r1), (s, e) = row_length(inner, x.shape[1]), window_rows(place, inner), window_columns(place, inner)
        for row in range(r0, r1):
            for k in range(row * wide + s, row * wide + e):
                out[o, k] = _apply_body(x, low, mid, high, faces, j, k, inner)


@ordered_part
def first_steps(out, o, shift, b, slab, inner, start, stop):
    """Write two smoothing steps that start from nothing, where all coefficients are 1; ``b`` is the right side.

    Cells ``start`` to ``stop`` of slab ``slab`` go to slab ``o`` of ``out``, ``shift`` cells further left.
    """
    o, j, real = unsigned(o), unsigned(slab), out.dtype.type
    w1, w2 = weights(inner, real)
    share = real(0.5 / (len(inner) + 1))
    once = share * w1
    own = once + w2 * share - w2 * once
    near = w2 * share * once
    for k in range(start, stop):
        around = real(0)
        for d in range(len(inner)):
            around = around + b[j, k - inner[d]] + b[j, k + inner[d]]
        out[o, k - shift] = own * b[j, k] + near * (around + b[j - UNIT, k] + b[j + UNIT, k])


@ordered_part
def _relax_plain(out, o, x, low, mid, high, b, j, weight, inner):
    share = weight * out.dtype.type(0.5 / (len(inner) + 1))
    stay = out.dtype.type(1.0) - weight
    first, end = run_of(inner, x.shape[1])
    for k in range(first, end):
        around = x.dtype.type(0)
        for d in range(len(inner)):
            around = around + x[mid, k - inner[d]] + x[mid, k + inner[d]]
        out[o, k] = share * (around + x[low, k] + x[high, k] + b[j, k]) + stay * x[mid, k]


@part
def relax_slabs(out, o, x, low, mid, high, b, faces, dinv, place, slab, weight, inner, repeats):
    """Write one Jacobi step of slab ``slab`` of the level, which is ``mid`` in ``x``, to slab ``o`` of ``out``."""
    o, low, mid, high, j = unsigned(o), unsigned(low), unsigned(mid), unsigned(high), unsigned(slab)
    _relax_plain(out, o, x, low, mid, high, b, j, weight, inner)
    if meets(place, inner, slab):
        wide, (r0, r1), (s, e) = row_length(inner, x.shape[1]), window_rows(place, inner), window_columns(place, inner)
        for row in range(r0, r1):
            for k in range(row * wide + s, row * wide + e):
                rest = b[j, k] - _apply_body(x, low, mid, high, faces, j, k, inner)
                out[o, k] = x[mid, k] + weight * dinv[j, k] * rest
    seal_slab(out, o, inner, repeats)


@part
def smooth(out, x, b, faces, dinv, place, weight, inner, repeats):
    """Write one Jacobi step from ``x`` to ``out``."""
    for j in range(PAD, x.shape[0] - PAD):
        relax_slabs(out, j, x, j - 1, j, j + 1, b, faces, dinv, place, j, weight, inner, repeats)


@part
def relax_patch(out, x, b, faces, at, dinv, strides, weight):
    """Write one Jacobi step from ``x`` to ``out`` on a small array whose cells lie end to end.

    ``strides`` are those along all axes; the patch begins at cell ``at`` of ``faces``. The first and the last slab stay
    as they are, and so does each cell whose ``dinv`` is 0.
    """
    margin = strides[-1]
    for k in range(margin, unsigned(x.size) - margin):
        m, ax = x[k], x.dtype.type(0)
        for d in range(len(strides)):
            s = strides[d]
            ax += faces[d, at + k] * (m - x[k - s]) + faces[d, at + k + s] * (m - x[k + s])
        out[k] = m + weight * dinv[k] * (b[k] - ax)
