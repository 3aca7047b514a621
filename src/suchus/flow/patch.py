# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""Multigrid smoothing on the windows alone: small arrays on which extra smoothing steps cost almost nothing.

The patch of a level is its window and ``RIM`` cells around it, as far as they lie in the domain. The cells of a patch
lie contiguously in memory, so that a smoothing step is one long loop. Cells at the edge of a patch keep their value,
because their inverse diagonal is 0. A row of ``patch_layouts`` describes a patch: its offset in the buffer, its
padded cell
indices (first and end along each axis, the last axis first), and the number of pairs of smoothing steps before and
after the coarse-grid correction.
"""

from math import prod

import numpy as np

from suchus.flow.compiled import PAD, UNIT, kernel_part, unsigned
from suchus.flow.slab import ZERO, row_length, strides_like
from suchus.flow.stencil import copy_slab, first_steps, relax_patch, weights

SOLUTION, SOLUTION_COPY, RIGHT_SIDE, INVERSE, FACES = range(5)
"""Kinds of values in the buffer: solution, its second copy, right side, inverse diagonal, and the face coefficients of
each axis."""

RIM = 8, 2
"""Cells around a window that its patch includes, in the plane and in space [-]. The solution jumps at the edge of the
patch, which must not be near the end of a thin tail. In space, 8 cells would make the patches of the coarser levels as
large as the levels."""

SMOOTHING_PAIRS = (6,), (6, 3, 1, 0)
"""Pairs of smoothing steps in the patches, before and after the coarse-grid correction, in the plane and in space, from
the finest level on [-]. The last number holds for all further levels."""


def patch_layouts(layout: np.ndarray, repeats: tuple[bool, ...]) -> np.ndarray:
    """Return the patches of a layout whose windows are placed, shape (level, 2 + 2 axes).

    In space a patch takes in the cells beyond a side that its window comes near, but for periodic sides: there its rim
    must not lie where a mirror cuts a body.

    Args:
        layout: layout of the levels.
        repeats: which axes are periodic.
    """
    rows, offset, ndim = [], 0, layout.shape[1] // 3
    rim, pairs = RIM[ndim - 2], SMOOTHING_PAIRS[ndim - 2]
    includes_mirror = [ndim == 3 and not is_periodic for is_periodic in reversed(repeats)]
    for k, level_layout in enumerate(layout.tolist()):
        begin, end = level_layout[1 + ndim :: 2], level_layout[2 + ndim :: 2]
        if end[0] > begin[0]:
            begin = [max(a - rim, PAD - extra_cell) for a, extra_cell in zip(begin, includes_mirror, strict=True)]
            ends = zip(end, level_layout[1 : 1 + ndim], includes_mirror, strict=True)
            end = [min(b + rim, n + PAD + extra_cell) for b, n, extra_cell in ends]
        window = list(zip(begin, end, strict=True))
        rows.append([offset, *(value for pair in window for value in pair), pairs[min(k, len(pairs) - 1)]])
        offset += prod(b - a for a, b in window)
    return np.array(rows, dtype=np.int64)


def allocate_buffer(buffer: np.ndarray, patches: np.ndarray) -> np.ndarray:
    """Return a buffer that holds all patches: the old one if it is large enough, else a new one.

    Args:
        buffer: the old buffer, shape (kind, cell).
        patches: see ``patch_layouts``.
    """
    ends = patches[-1, 1:-1].reshape(-1, 2)
    size = int(patches[-1, 0] + np.prod(ends[:, 1] - ends[:, 0]))
    return buffer if size <= buffer.shape[1] else np.zeros((FACES + len(ends), size + size // 4), buffer.dtype)


@kernel_part
def _sizes(patch_layout, inner):
    """Return the number of slabs of a patch, the cells of one of its slabs, and the cells of one of its rows."""
    slab_count, column_index = patch_layout[2] - patch_layout[1], 2 * len(inner) + 1
    row_cells = patch_layout[column_index + 1] - patch_layout[column_index]
    return slab_count, row_cells * (patch_layout[4] - patch_layout[3]) if len(inner) > 1 else row_cells, row_cells


@kernel_part
def patch(buffer, patch_layout, inner, kind):
    """Return the values of one kind and one patch, a view of the buffer, shape (slab, cell)."""
    slab_count, length, _ = _sizes(patch_layout, inner)
    return buffer[kind, patch_layout[0] : patch_layout[0] + slab_count * length].reshape(slab_count, length)


@kernel_part
def _rows(patch_layout, inner):
    """Return the first row of a patch in its level's slabs, its end, and first and end of the cells of a row."""
    column_index = 2 * len(inner) + 1
    first_row, end_row = (unsigned(patch_layout[3]), unsigned(patch_layout[4])) if len(inner) > 1 else (ZERO, UNIT)
    return first_row, end_row, unsigned(patch_layout[column_index]), unsigned(patch_layout[column_index + 1])


@kernel_part
def _copy_from_level(patch_values, patch_layout, level_values, inner):
    """Copy the values of a patch out of an array of its level.

    Args:
        patch_values: array of the patch that is written, shape (slab, cell of the patch).
        patch_layout: row of ``patch_layouts``: offset, first and end index along each axis, smoothing pairs.
        level_values: array of the level, shape (slab, cell of the level).
        inner: strides within a slab.
    """
    row_cells, (first_row, end_row, start, end) = row_length(inner, level_values.shape[1]), _rows(patch_layout, inner)
    for j in range(unsigned(patch_values.shape[0])):
        for row in range(first_row, end_row):
            level_start = row * row_cells + start
            patch_start = (row - first_row) * (end - start)
            for i in range(end - start):
                patch_values[j, patch_start + i] = level_values[j + unsigned(patch_layout[1]), level_start + i]


@kernel_part
def _close_sides(buffer, patch_layout, level_layout, inner):
    """Set the coefficients to 0 on the faces where a patch in space extends beyond a side of the domain.

    Args:
        buffer: values of all patches.
        patch_layout: row of ``patch_layouts``.
        level_layout: row of the layout for the level; see ``slab``.
        inner: strides within a slab.
    """
    _, length, row_cells = _sizes(patch_layout, inner)
    for d in range(len(inner) + 1):
        face, r = patch(buffer, patch_layout, inner, FACES + d), 5 - 2 * d
        step = 1 if d == 0 else row_cells
        for is_low in range(2):
            if patch_layout[r] >= PAD if is_low else patch_layout[r + 1] <= level_layout[3 - d] + PAD:
                continue
            line = 1 if is_low else patch_layout[r + 1] - patch_layout[r] - 1
            for j in range(face.shape[0]):
                for i in range(length):
                    index = j if d == len(inner) else i // step % row_cells if d == 0 else i // step
                    if index == line:
                        face[j, i] = 0


@kernel_part
def take_coefficients(buffer, patch_layout, level_layout, faces, dinv, inner):
    """Copy the coefficients of a patch from its level to the buffer.

    Args:
        buffer: values of all patches.
        patch_layout: row of ``patch_layouts``.
        level_layout: row of the layout for the level; see ``slab``.
        faces: face coefficients of the level along each axis.
        dinv: inverse diagonal of the level.
        inner: strides within a slab.
    """
    for d in range(len(inner) + 1):
        _copy_from_level(patch(buffer, patch_layout, inner, FACES + d), patch_layout, faces[d], inner)
    if len(inner) > 1:
        _close_sides(buffer, patch_layout, level_layout, inner)
    inverse = patch(buffer, patch_layout, inner, INVERSE)
    _copy_from_level(inverse, patch_layout, dinv, inner)
    _, length, row_cells = _sizes(patch_layout, inner)
    for j in range(inverse.shape[0]):
        for k in range(0, length, row_cells):
            inverse[j, k] = 0
            inverse[j, k + row_cells - 1] = 0
        if len(inner) > 1:
            for i in range(row_cells):
                inverse[j, i] = 0
                inverse[j, length - row_cells + i] = 0


@kernel_part
def _relax(buffer, patch_layout, inner, first_weight, second_weight):
    """Smooth the solution of a patch by pairs of Jacobi steps with two weights.

    Args:
        buffer: values of all patches.
        patch_layout: row of ``patch_layouts``; its last number is the number of pairs.
        inner: strides within a slab.
        first_weight: Jacobi weight of the first step of a pair [-].
        second_weight: Jacobi weight of the second step [-].
    """
    x, y = patch(buffer, patch_layout, inner, SOLUTION), patch(buffer, patch_layout, inner, SOLUTION_COPY)
    _, length, row_cells = _sizes(patch_layout, inner)
    strides = strides_like(inner, unsigned(row_cells)) + (unsigned(length),)  # noqa: RUF005  numba unpacks no tuples
    copy_slab(y, 0, x, 0)
    copy_slab(y, y.shape[0] - 1, x, x.shape[0] - 1)
    x, y, b = x.reshape(-1), y.reshape(-1), patch(buffer, patch_layout, inner, RIGHT_SIDE).reshape(-1)
    faces, offset = buffer[FACES:], unsigned(patch_layout[0])
    dinv = patch(buffer, patch_layout, inner, INVERSE).reshape(-1)
    for _ in range(patch_layout[-1]):
        relax_patch(y, x, b, faces, offset, dinv, strides, first_weight)
        relax_patch(x, y, b, faces, offset, dinv, strides, second_weight)


@kernel_part
def start(buffer, patch_layout, b, inner):
    """Write the first smoothing steps on a patch to the buffer; at the edge of the patch they are those without a body.

    Args:
        buffer: values of all patches.
        patch_layout: row of ``patch_layouts``.
        b: right side of the level.
        inner: strides within a slab.
    """
    _copy_from_level(patch(buffer, patch_layout, inner, RIGHT_SIDE), patch_layout, b, inner)
    x = patch(buffer, patch_layout, inner, SOLUTION)
    row_cells, (r0, r1, s, e) = row_length(inner, b.shape[1]), _rows(patch_layout, inner)
    for j in range(patch_layout[1], patch_layout[2]):
        for row in range(r0, r1):
            row_start = row * row_cells
            first_steps(
                x, j - patch_layout[1], row_start + s - (row - r0) * (e - s), b, j, inner, row_start + s, row_start + e
            )
    first_weight, second_weight = weights(inner, buffer.dtype.type)
    _relax(buffer, patch_layout, inner, first_weight, second_weight)


@kernel_part
def end(buffer, patch_layout, x, inner):
    """Smooth the solution of a level on a patch.

    Args:
        buffer: values of all patches.
        patch_layout: row of ``patch_layouts``.
        x: solution of the level, which is changed.
        inner: strides within a slab.
    """
    solution = patch(buffer, patch_layout, inner, SOLUTION)
    _copy_from_level(solution, patch_layout, x, inner)
    first_weight, second_weight = weights(inner, buffer.dtype.type)
    _relax(buffer, patch_layout, inner, second_weight, first_weight)
    for j in range(patch_layout[1] + 1, patch_layout[2] - 1):
        give_slab(x, j, solution, patch_layout, j, inner)


@kernel_part
def give_slab(output, o, solution, patch_layout, slab, inner):
    """Copy one slab of a patch's solution, except the edge of the patch, to a slab of another array.

    Nothing happens if the patch does not contain the slab.

    Args:
        output: the other array.
        o: slab of ``output``.
        solution: solution of the patch, shape (slab, cell).
        patch_layout: row of ``patch_layouts``.
        slab: slab of the level.
        inner: strides within a slab.
    """
    if patch_layout[1] < slab < patch_layout[2] - 1:
        o, j = unsigned(o), unsigned(slab - patch_layout[1])
        row_cells, (r0, r1, s, e) = row_length(inner, output.shape[1]), _rows(patch_layout, inner)
        f0, f1 = (r0 + UNIT, r1 - UNIT) if len(inner) > 1 else (r0, r1)
        for row in range(f0, f1):
            level_start, patch_start = row * row_cells + s, (row - r0) * (e - s)
            for i in range(UNIT, (e - s) - UNIT):
                output[o, level_start + i] = solution[j, patch_start + i]
