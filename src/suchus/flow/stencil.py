# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""Slabs of the pressure equation: the operator of the cells and its smoothing steps.

The coefficients differ from 1 only inside a window. Outside it, the plain stencil reads no coefficients from memory. A
slab is given by an array and its index in it: ``lower_slab``, ``mid`` and ``upper_slab`` are the indices of the slab
below, of the slab itself, and of the slab above. ``faces[d]`` are the coefficients of the faces before the cells along
axis d. See ``slab``.
"""

from suchus.flow.compiled import PAD, UNIT, kernel_part, ordered_part, unsigned
from suchus.flow.slab import EDGE, meets, row_count, row_length, run_of, window_columns, window_rows

WEIGHTS = (0.5617, 1.3896), (0.5695, 1.7319)
"""Jacobi weights in two and in three dimensions: Chebyshev roots for the eigenvalues of the scaled operator, 0.5 to 2
and 1/3 to 2 [-]."""

LANES = 16
"""Partial maxima that are kept side by side, so that the loop is vectorised; a single maximum is not, because it could
hide a NaN [-]."""


@kernel_part
def weights(inner, real):
    """Return the two Jacobi weights in the precision ``real``."""
    return (
        real(WEIGHTS[0][0] if len(inner) == 1 else WEIGHTS[1][0]),
        real(WEIGHTS[0][1] if len(inner) == 1 else WEIGHTS[1][1]),
    )


@kernel_part
def seal_slab(a, slab, inner, repeats):
    """Fill the cells beside the domain, along the axes of a slab, with mirrored or periodic values.

    Args:
        a: the field, shape (slab, cell).
        slab: the slab.
        inner: strides within a slab.
        repeats: which axes are periodic.
    """
    j, row_cells = unsigned(slab), row_length(inner, a.shape[1])
    for row in range(row_count(inner, a.shape[1])):
        first_cell = EDGE + (EDGE + row) * row_cells if len(inner) > 1 else EDGE
        last_cell = first_cell + row_cells - EDGE - EDGE - UNIT
        if repeats[0]:
            a[j, first_cell - UNIT] = a[j, last_cell]
            a[j, last_cell + UNIT] = a[j, first_cell]
        else:
            a[j, first_cell - UNIT] = a[j, first_cell]
            a[j, last_cell + UNIT] = a[j, last_cell]
    if len(inner) > 1:
        first_cell, last_cell = EDGE * row_cells, unsigned(a.shape[1]) - (EDGE + UNIT) * row_cells
        for k in range(row_cells):
            a[j, first_cell - row_cells + k] = a[j, last_cell + k] if repeats[1] else a[j, first_cell + k]
            a[j, last_cell + row_cells + k] = a[j, first_cell + k] if repeats[1] else a[j, last_cell + k]


@kernel_part
def copy_slab(target, target_slab, source, source_slab):
    """Copy slab ``source_slab`` of ``source`` to slab ``target_slab`` of ``target``.

    The loop replaces an assignment of slices: numba's message for slices of different lengths takes longer to compile
    than the kernels.
    """
    o, j = unsigned(target_slab), unsigned(source_slab)
    for k in range(unsigned(source.shape[1])):
        target[o, k] = source[j, k]


@kernel_part
def seal_ends(x, periodic):
    """Fill the slab below the first and the slab above the last."""
    n = x.shape[0]
    copy_slab(x, PAD - 1, x, n - PAD - 1 if periodic else PAD)
    copy_slab(x, n - PAD, x, PAD if periodic else n - PAD - 1)


@kernel_part
def largest_size(a, slab, inner, top):
    """Return the largest absolute value of a slab inside the domain.

    Args:
        a: the field, shape (slab, cell).
        slab: the slab.
        inner: strides within a slab.
        top: work array for ``LANES`` numbers.
    """
    j, row_cells, lanes = unsigned(slab), row_length(inner, a.shape[1]), unsigned(LANES)
    for k in range(lanes):
        top[k] = 0
    for row in range(row_count(inner, a.shape[1])):
        s = EDGE + (EDGE + row) * row_cells if len(inner) > 1 else EDGE
        e = s + row_cells - EDGE - EDGE
        lane_end = s + (e - s) // lanes * lanes
        for i in range(s, lane_end, lanes):
            for k in range(lanes):
                size = abs(a[j, i + k])
                top[k] = size if size > top[k] else top[k]
        for i in range(lane_end, e):
            size = abs(a[j, i])
            top[0] = size if size > top[0] else top[0]
    maximum = top[0]
    for k in range(UNIT, lanes):
        maximum = top[k] if top[k] > maximum else maximum
    return maximum


@kernel_part
def summed_size(a, slab, inner):
    """Return the sum of the absolute values of a slab inside the domain."""
    j, row_cells, slab_sum = unsigned(slab), row_length(inner, a.shape[1]), 0.0
    for row in range(row_count(inner, a.shape[1])):
        s = EDGE + (EDGE + row) * row_cells if len(inner) > 1 else EDGE
        row_sum = a.dtype.type(0)
        for k in range(s, s + row_cells - EDGE - EDGE):
            row_sum += abs(a[j, k])
        slab_sum += row_sum
    return slab_sum


@kernel_part
def _apply_body(x, lower_slab, mid, upper_slab, faces, j, k, inner):
    """Return the operator at cell ``k`` with the coefficients ``faces``; see ``apply_slabs``."""
    m, slab_axis, total = x[mid, k], unsigned(len(inner)), x.dtype.type(0)
    for d in range(len(inner)):
        s = inner[d]
        total += faces[d, j, k] * (m - x[mid, k - s]) + faces[d, j, k + s] * (m - x[mid, k + s])
    lower_face, upper_face = faces[slab_axis, j, k], faces[slab_axis, j + UNIT, k]
    return total + (lower_face * (m - x[lower_slab, k]) + upper_face * (m - x[upper_slab, k]))


@kernel_part
def apply_slabs(output, o, x, lower_slab, mid, upper_slab, faces, level_layout, slab, inner):
    """Write the pressure operator applied to one slab of a level.

    Args:
        output: the result.
        o: slab of ``output``.
        x: the field; it holds the slab and its neighbours.
        lower_slab: index in ``x`` of the slab below.
        mid: index in ``x`` of the slab itself.
        upper_slab: index in ``x`` of the slab above.
        faces: face coefficients of the level along each axis.
        level_layout: row of the layout for the level; see ``slab``.
        slab: index of the slab in the level.
        inner: strides within a slab.
    """
    o, j = unsigned(o), unsigned(slab)
    lower_slab, mid, upper_slab = unsigned(lower_slab), unsigned(mid), unsigned(upper_slab)
    diagonal = output.dtype.type(2 * len(inner) + 2)
    run_start, run_end = run_of(inner, x.shape[1])
    for k in range(run_start, run_end):
        neighbour_sum = x.dtype.type(0)
        for d in range(len(inner)):
            neighbour_sum += x[mid, k - inner[d]] + x[mid, k + inner[d]]
        output[o, k] = diagonal * x[mid, k] - (neighbour_sum + (x[lower_slab, k] + x[upper_slab, k]))
    if meets(level_layout, inner, slab):
        row_cells = row_length(inner, x.shape[1])
        (r0, r1), (s, e) = window_rows(level_layout, inner), window_columns(level_layout, inner)
        for row in range(r0, r1):
            for k in range(row * row_cells + s, row * row_cells + e):
                output[o, k] = _apply_body(x, lower_slab, mid, upper_slab, faces, j, k, inner)


@ordered_part
def first_steps(output, o, shift, b, slab, inner, start, stop):
    """Write the first two smoothing steps from a zero solution, where all coefficients are 1.

    Args:
        output: the solution.
        o: slab of ``output``.
        shift: index of a cell in ``b`` minus its index in ``output``.
        b: right side of the level.
        slab: slab of ``b``.
        inner: strides within a slab.
        start: first cell of ``b``.
        stop: end of the cells.
    """
    o, j, real = unsigned(o), unsigned(slab), output.dtype.type
    w1, w2 = weights(inner, real)
    inverse_diagonal = real(0.5 / (len(inner) + 1))
    first_weight = inverse_diagonal * w1
    centre_weight = first_weight + w2 * inverse_diagonal - w2 * first_weight
    neighbour_weight = w2 * inverse_diagonal * first_weight
    for k in range(start, stop):
        neighbour_sum = real(0)
        for d in range(len(inner)):
            neighbour_sum = neighbour_sum + b[j, k - inner[d]] + b[j, k + inner[d]]
        neighbour_sum = neighbour_sum + b[j - UNIT, k] + b[j + UNIT, k]
        output[o, k - shift] = centre_weight * b[j, k] + neighbour_weight * neighbour_sum


@ordered_part
def _relax_plain(output, o, x, lower_slab, mid, upper_slab, b, j, weight, inner):
    """Write one Jacobi step of a slab with all coefficients 1; see ``relax_slabs``."""
    neighbour_weight = weight * output.dtype.type(0.5 / (len(inner) + 1))
    centre_weight = output.dtype.type(1.0) - weight
    run_start, run_end = run_of(inner, x.shape[1])
    for k in range(run_start, run_end):
        neighbour_sum = x.dtype.type(0)
        for d in range(len(inner)):
            neighbour_sum = neighbour_sum + x[mid, k - inner[d]] + x[mid, k + inner[d]]
        neighbour_sum = neighbour_sum + x[lower_slab, k] + x[upper_slab, k]
        output[o, k] = neighbour_weight * (neighbour_sum + b[j, k]) + centre_weight * x[mid, k]


@kernel_part
def relax_slabs(output, o, x, lower_slab, mid, upper_slab, b, faces, dinv, level_layout, slab, weight, inner, repeats):
    """Write one Jacobi step of one slab of a level.

    Args:
        output: the new solution.
        o: slab of ``output``.
        x: the old solution; it holds the slab and its neighbours.
        lower_slab: index in ``x`` of the slab below.
        mid: index in ``x`` of the slab itself.
        upper_slab: index in ``x`` of the slab above.
        b: right side of the level.
        faces: face coefficients of the level along each axis.
        dinv: inverse diagonal of the level.
        level_layout: row of the layout for the level; see ``slab``.
        slab: index of the slab in the level.
        weight: Jacobi weight [-].
        inner: strides within a slab.
        repeats: which axes are periodic.
    """
    o, j = unsigned(o), unsigned(slab)
    lower_slab, mid, upper_slab = unsigned(lower_slab), unsigned(mid), unsigned(upper_slab)
    _relax_plain(output, o, x, lower_slab, mid, upper_slab, b, j, weight, inner)
    if meets(level_layout, inner, slab):
        row_cells = row_length(inner, x.shape[1])
        (r0, r1), (s, e) = window_rows(level_layout, inner), window_columns(level_layout, inner)
        for row in range(r0, r1):
            for k in range(row * row_cells + s, row * row_cells + e):
                residual = b[j, k] - _apply_body(x, lower_slab, mid, upper_slab, faces, j, k, inner)
                output[o, k] = x[mid, k] + weight * dinv[j, k] * residual
    seal_slab(output, o, inner, repeats)


@kernel_part
def smooth(output, x, b, faces, dinv, level_layout, weight, inner, repeats):
    """Write one Jacobi step of a whole level from ``x`` to ``output``; see ``relax_slabs``."""
    for j in range(PAD, x.shape[0] - PAD):
        relax_slabs(output, j, x, j - 1, j, j + 1, b, faces, dinv, level_layout, j, weight, inner, repeats)


@kernel_part
def relax_patch(output, x, b, faces, offset, dinv, strides, weight):
    """Write one Jacobi step on a small array whose cells are contiguous.

    The first and the last slab are not changed, nor are cells whose ``dinv`` is 0.

    Args:
        output: the new solution, shape (cell,).
        x: the old solution, shape (cell,).
        b: right side, shape (cell,).
        faces: face coefficients of all patches along each axis.
        offset: first cell of the patch in ``faces``.
        dinv: inverse diagonal, shape (cell,).
        strides: along all axes.
        weight: Jacobi weight [-].
    """
    margin = strides[-1]
    for k in range(margin, unsigned(x.size) - margin):
        m, ax = x[k], x.dtype.type(0)
        for d in range(len(strides)):
            s = strides[d]
            ax += faces[d, offset + k] * (m - x[k - s]) + faces[d, offset + k + s] * (m - x[k + s])
        output[k] = m + weight * dinv[k] * (b[k] - ax)
