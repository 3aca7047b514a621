# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""Geometric multigrid for ``-div(c grad x) = b`` on the cells: one cycle, used as a preconditioner.

All levels live in one array ``store``, level after level, each with ``PAD`` cells around it; within a level one kind of
value after the other. The coefficient ``c`` differs from 1 only inside a window of each level; everywhere else the
kernels use the plain stencil, which needs no coefficients from memory. Outer walls: no flux (mirrored) or periodic.

Smoothing: two steps of Chebyshev-weighted Jacobi before and after, and more in the window; prolongation linear along
each axis, restriction by sums. What happens to a level on the way down, and what on the way up, is one sweep each over
blocks of slabs: a slab is smoothed as soon as its neighbours are there, and what lies between is kept in slabs that
stay in the processor's nearest caches. The first steps, which start from nothing, are done again on the way up, not
stored. In D dimensions the summed residual counts 2^(2 - D) times: coefficients are those of a face, in coarse cells.
Sources: Briggs, Henson and McCormick 2000, A Multigrid Tutorial, SIAM; for the coarsest level Golub and Varga 1961,
Numer. Math. 3, 147-168.
"""

import numpy as np
from numba import prange

from suchus.flow.compiled import PAD, SERIAL_BELOW, UNIT, compiled, kernel_part, signed, threaded_part, unsigned
from suchus.flow.patch import SOLUTION, end, give_slab, patch, start, take_coefficients
from suchus.flow.slab import (
    EDGE,
    MIN_SLABS,
    ZERO,
    row_count,
    row_length,
    run_of,
    slabs_per_block,
    strides_like,
)  # fmt: skip
from suchus.flow.stencil import (
    apply_slabs,
    copy_slab,
    first_steps,
    relax_slabs,
    seal_ends,
    seal_slab,
    smooth,
    weights,
)  # fmt: skip

X, B, DINV, FACES = range(4)
"""Kinds of values of a level: solution, right side, inverse diagonal, then face coefficients, axis by axis."""

MAX_COARSEST_CELLS = 32
"""Largest number of cells along a side of the coarsest level, which is solved by Jacobi steps alone [-]."""

MAX_CHANNEL_CELLS = 16 * MAX_COARSEST_CELLS
"""Largest number of cells along a side of the coarsest level of a long channel, which takes more steps there [-]."""

MAX_RESIDUAL_RATIO = 0.02
"""Fraction of each error that the solve of the coarsest level leaves [-]. With half of the smoothest error left and one
cycle a stage, the drag of an impulsively started cylinder in a patch, at Re 1000, oscillated by up to 6 %."""


@kernel_part
def _shape(layout, k, inner):
    """Return the number of slabs of a level, and of cells in a slab, both with the padding."""
    rows = layout[k, 2] + 2 * PAD if len(inner) > 1 else 1
    return layout[k, 1] + 2 * PAD, rows * (layout[k, len(inner) + 1] + 2 * PAD)


@kernel_part
def level(store, layout, inner, kind, k):
    """Return the array of one kind on level ``k``; see ``slab`` for the rows of the layout.

    Args:
        store: arrays of all levels, end to end.
        layout: one row for each level; see ``slab``.
        inner: strides within a slab of level 0.
        kind: ``X``, ``B`` or ``DINV``.
        k: level; 0 is the finest.
    """
    slab_count, length = _shape(layout, k, inner)
    start = layout[k, 0] + kind * slab_count * length
    return store[start : start + slab_count * length].reshape(slab_count, length)


@kernel_part
def faces_of(store, layout, inner, k):
    """Return the coefficients of the faces on level ``k``, shape (axis, slab, cell)."""
    (slab_count, length), ndim = _shape(layout, k, inner), len(inner) + 1
    start = layout[k, 0] + FACES * slab_count * length
    return store[start : start + ndim * slab_count * length].reshape(ndim, slab_count, length)


@kernel_part
def _strides(layout, inner, k):
    """Return the strides within a slab of level ``k``."""
    return strides_like(inner, unsigned(layout[k, len(inner) + 1] + 2 * PAD))


@kernel_part
def _fold(j, n, periodic):
    """Return the slab of the domain whose values slab ``j`` has; ``j`` may lie beyond a wall."""
    if periodic:
        return (j - PAD + n) % n + PAD
    return min(max(j, PAD), PAD + n - 1)


@kernel_part
def _first_smoothing(slabs, o, b, patch_values, patch_layout, slab, inner, repeats):
    """Write the solution in one slab after the first smoothing steps, which start from nothing.

    Args:
        slabs: work array of slabs, to write to.
        o: which of its slabs is written.
        b: right side of the level.
        patch_values: solution in the patch where more steps are taken; see ``patch``.
        patch_layout: where the patch lies.
        slab: slab of the level.
        inner: strides within a slab.
        repeats: whether each axis is periodic.
    """
    first_cell, end = run_of(inner, b.shape[1])
    first_steps(slabs, o, ZERO, b, slab, inner, first_cell, end)
    give_slab(slabs, o, patch_values, patch_layout, slab, inner)
    seal_slab(slabs, o, inner, repeats)


@kernel_part
def _restrict_residual(coarse, coarse_slab, residual, b, slab, inner, coarse_inner):
    """Write the summed residual of two slabs to a slab of the coarse level's right side.

    Args:
        coarse: right side of the coarse level, to write to.
        coarse_slab: which of its slabs.
        residual: the residual; on entry the operator applied to the solution in both slabs, shape (2, cell); then a
            work array.
        b: right side of the level.
        slab: first of the two slabs.
        inner: strides within a slab.
        coarse_inner: the same on the coarse level.
    """
    c, j = unsigned(coarse_slab), unsigned(slab)
    first_cell, end = run_of(inner, b.shape[1])
    for k in range(first_cell, end):
        residual[0, k] = (b[j, k] + b[j + UNIT, k]) - (residual[0, k] + residual[1, k])
    row_cells, coarse_row_cells = row_length(inner, b.shape[1]), row_length(coarse_inner, coarse.shape[1])
    half = residual.dtype.type(0.5)
    for n in range(row_count(coarse_inner, coarse.shape[1])):
        fine = (n + n + EDGE) * row_cells if len(inner) > 1 else ZERO
        row = (n + EDGE) * coarse_row_cells if len(inner) > 1 else ZERO
        if len(inner) > 1:
            for k in range(fine + EDGE, fine + row_cells - EDGE):
                residual[0, k] = half * (residual[0, k] + residual[0, k + row_cells])
        for k in range(EDGE, coarse_row_cells - EDGE):
            i = fine + k + k - EDGE
            coarse[c, row + k] = residual[0, i] + residual[0, i + UNIT]


@kernel_part
def _descend(coarse, b, faces, level_layout, buffer, patch_layout, j0, j1, inner, coarse_inner, repeats):
    """Write the summed residual after the first smoothing steps to some slabs of the coarse level.

    Args:
        coarse: right side of the coarse level, to write to.
        b: right side of the level.
        faces: coefficients of the level's faces.
        level_layout: the level's row of the layout; see ``slab``.
        buffer: values in the patches; see ``patch``.
        patch_layout: where the level's patch lies.
        j0: first coarse slab.
        j1: the coarse slab after the last.
        inner: strides within a slab.
        coarse_inner: the same on the coarse level.
        repeats: whether each axis is periodic.
    """
    size, patch_values, is_periodic = level_layout[1], patch(buffer, patch_layout, inner, SOLUTION), repeats[len(inner)]
    residual, rows = np.empty((2, b.shape[1]), b.dtype), np.empty((4, b.shape[1]), b.dtype)
    lower_slot, middle_slot, upper_slot, top_slot = 0, 1, 2, 3
    j = 2 * (j0 - PAD) + PAD
    _first_smoothing(rows, lower_slot, b, patch_values, patch_layout, _fold(j - 1, size, is_periodic), inner, repeats)
    _first_smoothing(rows, middle_slot, b, patch_values, patch_layout, j, inner, repeats)
    for cj in range(j0, j1):
        j = 2 * (cj - PAD) + PAD
        _first_smoothing(rows, upper_slot, b, patch_values, patch_layout, j + 1, inner, repeats)
        _first_smoothing(rows, top_slot, b, patch_values, patch_layout, _fold(j + 2, size, is_periodic), inner, repeats)
        apply_slabs(residual, 0, rows, lower_slot, middle_slot, upper_slot, faces, level_layout, j, inner)
        apply_slabs(residual, 1, rows, middle_slot, upper_slot, top_slot, faces, level_layout, j + 1, inner)
        _restrict_residual(coarse, cj, residual, b, j, inner, coarse_inner)
        seal_slab(coarse, cj, coarse_inner, repeats)
        lower_slot, middle_slot, upper_slot, top_slot = upper_slot, top_slot, lower_slot, middle_slot


@kernel_part
def _add_coarse(slabs, o, coarse, mix, slab, inner, coarse_inner):
    """Add to a slab the solution of the coarse level, linear between its cells.

    Args:
        slabs: work array of slabs, to add to.
        o: which of its slabs.
        coarse: solution of the coarse level.
        mix: work array for a slab and a row of coarse cells.
        slab: slab of the level.
        inner: strides within a slab.
        coarse_inner: the same on the coarse level.
    """
    near_slab = unsigned((slab - PAD) // 2 + PAD)
    far_slab = near_slab - UNIT if (slab - PAD) % 2 == 0 else near_slab + UNIT
    o, near_weight, far_weight = unsigned(o), slabs.dtype.type(0.75), slabs.dtype.type(0.25)
    for k in range(EDGE - UNIT, unsigned(coarse.shape[1]) - EDGE + UNIT):
        mix[k] = near_weight * coarse[near_slab, k] + far_weight * coarse[far_slab, k]
    if len(inner) == 1:  # separate loop: a row that is too short to be vectorised would be rounded in another way
        for k in range(EDGE, unsigned(coarse.shape[1]) - EDGE):
            i = k + k - EDGE
            slabs[o, i] += near_weight * mix[k] + far_weight * mix[k - UNIT]
            slabs[o, i + UNIT] += near_weight * mix[k] + far_weight * mix[k + UNIT]
        return
    row_cells, coarse_row_cells = row_length(inner, slabs.shape[1]), row_length(coarse_inner, coarse.shape[1])
    line = unsigned(coarse.shape[1])
    for n in range(row_count(inner, slabs.shape[1])):
        row, near_row = (n + EDGE) * row_cells, (n // (UNIT + UNIT) + EDGE) * coarse_row_cells
        far_row = near_row - coarse_row_cells if n % (UNIT + UNIT) == ZERO else near_row + coarse_row_cells
        for k in range(EDGE - UNIT, coarse_row_cells - EDGE + UNIT):
            mix[line + k] = near_weight * mix[near_row + k] + far_weight * mix[far_row + k]
        for k in range(EDGE, coarse_row_cells - EDGE):
            i = row + k + k - EDGE
            slabs[o, i] += near_weight * mix[line + k] + far_weight * mix[line + k - UNIT]
            slabs[o, i + UNIT] += near_weight * mix[line + k] + far_weight * mix[line + k + UNIT]


@kernel_part
def _ascend(x, b, coarse, faces, dinv, level_layout, buffer, patch_layout, j0, j1, inner, coarse_inner, repeats):
    """Write the first smoothing steps, the coarse correction and the last two steps to some slabs.

    Args:
        x: solution to write.
        b: right side of the level.
        coarse: solution of the coarse level.
        faces: coefficients of the level's faces.
        dinv: inverse diagonal of the level.
        level_layout: the level's row of the layout; see ``slab``.
        buffer: values in the patches; see ``patch``.
        patch_layout: where the level's patch lies.
        j0: first slab.
        j1: the slab after the last.
        inner: strides within a slab.
        coarse_inner: the same on the coarse level.
        repeats: whether each axis is periodic.
    """
    is_periodic, size, patch_values = repeats[len(inner)], level_layout[1], patch(buffer, patch_layout, inner, SOLUTION)
    rows = np.empty((6, b.shape[1]), b.dtype)
    mix = np.empty(coarse.shape[1] + signed(row_length(coarse_inner, coarse.shape[1])), b.dtype)
    second_weights, first_weights = weights(inner, b.dtype.type)
    a, m, z = 0, 1, 2  # slabs that the last step but one reads
    lower_slot, middle_slot, upper_slot = 3, 4, 5  # slabs that the last step reads
    for j in range(j0 - 2, j1 + 2):
        a, m, z = m, z, a
        source_slab = _fold(j, size, is_periodic)
        _first_smoothing(rows, z, b, patch_values, patch_layout, source_slab, inner, repeats)
        _add_coarse(rows, z, coarse, mix, source_slab, inner, coarse_inner)
        seal_slab(rows, z, inner, repeats)
        if j < j0:
            continue
        lower_slot, middle_slot, upper_slot = middle_slot, upper_slot, lower_slot
        if j > PAD + size and not is_periodic:
            copy_slab(rows, upper_slot, rows, middle_slot)
        else:
            source_slab = _fold(j - 1, size, is_periodic)
            relax_slabs(
                rows, upper_slot, rows, a, m, z, b, faces, dinv, level_layout, source_slab, first_weights, inner,
                repeats,
            )  # fmt: skip
        if j == PAD + 1 and not is_periodic:
            copy_slab(rows, middle_slot, rows, upper_slot)
        if j >= j0 + 2:
            relax_slabs(
                x, j - 2, rows, lower_slot, middle_slot, upper_slot, b, faces, dinv, level_layout, j - 2,
                second_weights, inner, repeats,
            )  # fmt: skip


@threaded_part
def _descend_threaded(coarse, b, faces, level_layout, buffer, patch_layout, inner, coarse_inner, repeats):
    """Do what ``_descend`` does for all slabs, on several threads."""
    end = coarse.shape[0] - PAD
    block_size = slabs_per_block(inner, end - PAD, MIN_SLABS // 2)
    for n in prange((end - PAD + block_size - 1) // block_size):
        j0 = PAD + signed(n) * block_size
        _descend(
            coarse,
            b,
            faces,
            level_layout,
            buffer,
            patch_layout,
            j0,
            min(j0 + block_size, end),
            inner,
            coarse_inner,
            repeats,
        )


@threaded_part
def _ascend_threaded(x, b, coarse, faces, dinv, level_layout, buffer, patch_layout, inner, coarse_inner, repeats):
    """Do what ``_ascend`` does for all slabs, on several threads."""
    end = x.shape[0] - PAD
    block_size = slabs_per_block(inner, end - PAD, MIN_SLABS)
    for n in prange((end - PAD + block_size - 1) // block_size):
        j0 = PAD + signed(n) * block_size
        _ascend(
            x, b, coarse, faces, dinv, level_layout, buffer, patch_layout, j0, min(j0 + block_size, end), inner,
            coarse_inner, repeats,
        )  # fmt: skip


@kernel_part
def _live_mean(b, dinv, inner):
    """Return the mean over the cells that have an open face: without walls that fix it, the pressure has no level.

    Args:
        b: right side of the level.
        dinv: inverse diagonal; 0 in a cell without an open face.
        inner: strides within a slab.
    """
    end, row_cells, total, live = b.shape[0] - PAD, signed(row_length(inner, b.shape[1])), 0.0, 0
    if len(inner) == 1:
        for j in range(PAD, end):
            for i in range(PAD, row_cells - PAD):
                if dinv[j, i] > 0:
                    total += b[j, i]
                    live += 1
    else:
        for j in range(PAD, end):
            for row in range(PAD, signed(b.shape[1]) // row_cells - PAD):
                for k in range(row * row_cells + PAD, row * row_cells + row_cells - PAD):
                    if dinv[j, k] > 0:
                        total += b[j, k]
                        live += 1
    return b.dtype.type(total / max(live, 1))


@kernel_part
def _relaxation_factors(cells, ndim):
    """Return the relaxation factor of each step on the coarsest level, and the weight of its Jacobi steps.

    Chebyshev's semi-iteration for eigenvalues from that of the smoothest error along the longest side up to 2. It takes
    as many steps, an even number, as leave the fraction ``MAX_RESIDUAL_RATIO`` of each error.

    Args:
        cells: number of cells along the longest side.
        ndim: number of axes of the grid.
    """
    min_eigenvalue = (1.0 - np.cos(np.pi / cells)) / ndim
    middle = 1.0 + 0.5 * min_eigenvalue
    ratio = (1.0 - 0.5 * min_eigenvalue) / middle
    steps = int(np.ceil(np.arccosh(1.0 / MAX_RESIDUAL_RATIO) / np.arccosh(1.0 / ratio)))
    factors = np.ones(steps + steps % 2)
    for k in range(1, factors.size):
        factors[k] = 1.0 / (1.0 - (0.5 if k == 1 else 0.25) * ratio**2 * factors[k - 1])
    return factors, 1.0 / middle


@kernel_part
def _relax(y, step, slab, factor):
    """Write ``y + factor (step - y)`` to a slab of ``y``."""
    j = unsigned(slab)
    for k in range(unsigned(y.shape[1])):
        y[j, k] += factor * (step[j, k] - y[j, k])


@kernel_part
def _solve_coarsest(x, b, faces, dinv, level_layout, inner, repeats):
    """Solve the coarsest level by Chebyshev's semi-iteration on Jacobi steps, from nothing; ``b`` loses its mean.

    Args:
        x: solution to write; the steps are an even number, so that it has the last one.
        b: right side of the level, changed.
        faces: coefficients of the level's faces.
        dinv: inverse diagonal of the level.
        level_layout: the level's row of the layout; see ``slab``.
        inner: strides within a slab.
        repeats: whether each axis is periodic.
    """
    y, step = np.zeros_like(x), np.zeros_like(x)
    x[:] = 0
    mean, row_cells, real = _live_mean(b, dinv, inner), row_length(inner, x.shape[1]), x.dtype.type
    for j in range(PAD, x.shape[0] - PAD):
        for n in range(row_count(inner, x.shape[1])):
            s = EDGE + (EDGE + n) * row_cells if len(inner) > 1 else EDGE
            for k in range(s, s + row_cells - EDGE - EDGE):
                b[unsigned(j), k] -= mean
    max_cells = 1
    for axis in range(len(inner) + 1):
        max_cells = max(max_cells, level_layout[1 + axis])
    factors, weight = _relaxation_factors(max_cells, len(inner) + 1)
    for factor in factors:
        smooth(step, x, b, faces, dinv, level_layout, real(weight), inner, repeats)
        for j in range(PAD, x.shape[0] - PAD):
            _relax(y, step, j, real(factor))
        seal_ends(y, repeats[len(inner)])
        x, y = y, x


@kernel_part
def cycle(x, store, layout, buffer, rects, inner, repeats):
    """Write one V-cycle for the right side ``B`` of level 0, started from nothing, to ``x``.

    Args:
        x: solution to write.
        store: arrays of all levels; see ``level``.
        layout: one row for each level; see ``slab``.
        buffer: values in the patches; see ``patch``.
        rects: where each level's patch lies.
        inner: strides within a slab of level 0.
        repeats: whether each axis is periodic.
    """
    last_level = layout.shape[0] - 1
    for k in range(last_level):
        level_inner, coarse_inner = _strides(layout, inner, k), _strides(layout, inner, k + 1)
        b, coarse = level(store, layout, inner, B, k), level(store, layout, inner, B, k + 1)
        faces, level_layout, patch_layout = faces_of(store, layout, inner, k), layout[k], rects[k]
        seal_ends(b, repeats[len(inner)])
        if patch_layout[1] < patch_layout[2]:
            start(buffer, patch_layout, b, level_inner)
        if b.size < SERIAL_BELOW:
            _descend(
                coarse, b, faces, level_layout, buffer, patch_layout, PAD, coarse.shape[0] - PAD, level_inner,
                coarse_inner, repeats,
            )  # fmt: skip
        else:
            _descend_threaded(coarse, b, faces, level_layout, buffer, patch_layout, level_inner, coarse_inner, repeats)
    _solve_coarsest(
        x if last_level == 0 else level(store, layout, inner, X, last_level),
        level(store, layout, inner, B, last_level),
        faces_of(store, layout, inner, last_level),
        level(store, layout, inner, DINV, last_level),
        layout[last_level],
        _strides(layout, inner, last_level),
        repeats,
    )
    for k in range(last_level - 1, -1, -1):
        level_inner, coarse_inner = _strides(layout, inner, k), _strides(layout, inner, k + 1)
        b, coarse = level(store, layout, inner, B, k), level(store, layout, inner, X, k + 1)
        faces, dinv = faces_of(store, layout, inner, k), level(store, layout, inner, DINV, k)
        level_layout, patch_layout, solution = layout[k], rects[k], x if k == 0 else level(store, layout, inner, X, k)
        if b.size < SERIAL_BELOW:
            _ascend(
                solution, b, coarse, faces, dinv, level_layout, buffer, patch_layout, PAD, solution.shape[0] - PAD,
                level_inner, coarse_inner, repeats,
            )  # fmt: skip
        else:
            _ascend_threaded(
                solution, b, coarse, faces, dinv, level_layout, buffer, patch_layout, level_inner, coarse_inner, repeats
            )
        if patch_layout[1] < patch_layout[2]:
            end(buffer, patch_layout, solution, level_inner)
            if len(inner) > 1:  # the patch has changed cells next to the sides
                for j in range(max(patch_layout[1], PAD), min(patch_layout[2], solution.shape[0] - PAD)):
                    seal_slab(solution, j, level_inner, repeats)
        seal_ends(solution, repeats[len(inner)])


@kernel_part
def _coefficients(cx, cy, dinv, level_layout):
    """Fill the inverse diagonal of a plane level in the window; a cell with no open face gets 0.

    It is not written like the one for space below: vectorised division there rounds the last digit in another way.

    Args:
        cx: coefficients of the faces across x.
        cy: coefficients of the faces across y.
        dinv: inverse diagonal to write.
        level_layout: the level's row of the layout; see ``slab``.
    """
    small = cx.dtype.type(1e-6)
    for j in range(level_layout[3], level_layout[4]):
        for i in range(level_layout[5], level_layout[6]):
            total = (cx[j, i] + cx[j, i + 1]) + (cy[j, i] + cy[j + 1, i])
            dinv[j, i] = 1 / total if total > small else 0


@kernel_part
def _coefficients_in_space(faces, dinv, level_layout, inner):
    """Fill the inverse diagonal of a level in space in the window; a cell with no open face gets 0.

    Args:
        faces: coefficients of the faces, shape (axis, slab, cell).
        dinv: inverse diagonal to write.
        level_layout: the level's row of the layout; see ``slab``.
        inner: strides within a slab.
    """
    small, slab_axis, row_cells = dinv.dtype.type(1e-6), len(inner), signed(row_length(inner, dinv.shape[1]))
    for j in range(level_layout[4], level_layout[5]):
        for row in range(level_layout[6], level_layout[7]):
            for k in range(row * row_cells + level_layout[8], row * row_cells + level_layout[9]):
                total = faces[slab_axis, j, k] + faces[slab_axis, j + 1, k]
                for d in range(slab_axis):
                    total += faces[d, j, k] + faces[d, j, k + signed(inner[d])]
                dinv[j, k] = 1 / total if total > small else 0


@kernel_part
def _in_line(c0, c1, c2):
    """Return the coefficient of three faces in line between the middles of two coarse cells, the outer ones halved.

    Args:
        c0: coefficient of the face before.
        c1: of the middle face.
        c2: of the face behind.
    """
    resistance = c1 * c2 + 2 * c0 * c2 + c0 * c1
    return 4 * c0 * c1 * c2 / resistance if resistance > 0 else c0


@kernel_part
def _joined(face, j, k, axis, inner):
    """Return a coarse face's coefficient from those of its fine faces and of the faces before and behind them.

    Faces in parallel let water through bodies thinner than a coarse cell; faces in series block it beside the bodies'
    ends too. With the geometric mean of both a solve needs half the cycles that it needs with the first.

    Args:
        face: coefficients of the fine level's faces across one axis.
        j: slab of the first fine face.
        k: cell in the slab of the first fine face.
        axis: which axis.
        inner: strides within a slab.
    """
    ndim = len(inner) + 1
    dj, dk = (1, 0) if axis == len(inner) else (0, signed(inner[axis]))
    parallel_sum, series_sum = face.dtype.type(0), face.dtype.type(0)
    for m in range(2 ** len(inner)):
        fj, fk = j, k
        for n in range(len(inner)):
            side_axis = (axis + 1 + n) % ndim
            if m >> n & 1:
                fj += 1 if side_axis == len(inner) else 0
                fk += 0 if side_axis == len(inner) else signed(inner[side_axis])
        coefficient = face[fj, fk]
        parallel_sum += coefficient
        series_sum += _in_line(face[fj - dj, fk - dk], coefficient, face[fj + dj, fk + dk])
    fraction = face.dtype.type(1 / 2 ** len(inner))
    return np.sqrt(fraction * parallel_sum * (fraction * series_sum))


@kernel_part
def _coarse_faces(coarse, fine, level_layout, coarse_row_cells, inner, axis):
    """Fill the coefficients of a coarse level's faces across one axis in its window.

    Args:
        coarse: coefficients of the coarse faces, shape (slab, cell), to write to.
        fine: those of the fine level.
        level_layout: the coarse level's row of the layout; see ``slab``.
        coarse_row_cells: cells along a row of the coarse level.
        inner: strides within a slab of the fine level.
        axis: axis that the faces lie across.
    """
    slab_axis, row_cells = len(inner), signed(row_length(inner, fine.shape[1]))
    r0, r1 = (level_layout[slab_axis + 4], level_layout[slab_axis + 5] + 1) if slab_axis > 1 else (0, 1)
    for cj in range(level_layout[slab_axis + 2], level_layout[slab_axis + 3] + 1):
        j = 2 * (cj - PAD) + PAD
        for row in range(r0, r1):
            base = (2 * (row - PAD) + PAD) * row_cells if slab_axis > 1 else 0
            for ci in range(level_layout[3 * slab_axis + 2], level_layout[3 * slab_axis + 3] + 1):
                k = base + 2 * (ci - PAD) + PAD
                coarse[cj, row * coarse_row_cells + ci] = _joined(fine, j, k, axis, inner)


@compiled
def coarsen(store, layout, inner):
    """Fill the inverse diagonals and every coarser level's coefficients inside the windows.

    Args:
        store: arrays of all levels; see ``level``.
        layout: one row for each level; see ``slab``.
        inner: strides within a slab of level 0.
    """
    for k in range(layout.shape[0]):
        faces, level_inner = faces_of(store, layout, inner, k), _strides(layout, inner, k)
        if len(inner) == 1:
            _coefficients(faces[0], faces[1], level(store, layout, inner, DINV, k), layout[k])
        else:
            _coefficients_in_space(faces, level(store, layout, inner, DINV, k), layout[k], level_inner)
        if k + 1 == layout.shape[0]:
            return
        coarse = faces_of(store, layout, inner, k + 1)
        coarse_row_cells = layout[k + 1, len(inner) + 1] + 2 * PAD
        for d in range(len(inner) + 1):
            _coarse_faces(coarse[d], faces[d], layout[k + 1], coarse_row_cells, level_inner, d)


@compiled
def copy_coefficients(store, layout, buffer, rects, inner):
    """Copy the coefficients of all levels to the patches; see ``patch``.

    Args:
        store: arrays of all levels; see ``level``.
        layout: one row for each level; see ``slab``.
        buffer: values in the patches.
        rects: where each level's patch lies.
        inner: strides within a slab of level 0.
    """
    for k in range(layout.shape[0] - 1):
        if rects[k, 1] < rects[k, 2]:
            dinv = level(store, layout, inner, DINV, k)
            faces = faces_of(store, layout, inner, k)
            take_coefficients(buffer, rects[k], layout[k], faces, dinv, _strides(layout, inner, k))
