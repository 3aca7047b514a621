# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""Memory layout of the fields: slabs, rows and strides, the same in two dimensions and in three.

A field is an array (slab, cell of the slab), a vector field has the component before that. A *slab* is all cells with
one index along the last axis: a row of a plane grid, a plane of a grid in space. ``inner`` are the strides along the
axes within a slab, ``(1,)`` or ``(1, cells along a row)``: a tuple of ``np.uint64``, whose length is a part of its
type. So ``for d in range(len(inner))`` inside a loop over cells is unrolled, and one kernel serves both.

A ``level_layout`` is a row of the multigrid's layout. It holds the offset of a level in memory, its cells along the
axes (the last axis first), and then the window around the bodies, first and end along each axis, the last axis first.

Quantities that matter only around the bodies are stored for the window alone, with the faces behind its last cells: a
slab of such a *near* array has one cell more along each axis than the window. ``near_layout`` describes this window.
It has the form of a ``level_layout``, but its window may reach beyond mirrors, where the window of a level ends.
"""

import numpy as np
from numba.cpython.unsafe.tuple import tuple_setitem

from suchus.flow.compiled import BLOCK, PAD, UNIT, kernel_part, unsigned

EDGE = unsigned(PAD)
"""``PAD`` as an unsigned integer, for the kernels [-]."""

ZERO = unsigned(0)
"""Zero as an unsigned integer, for the kernels [-]."""

MAX_SLABS, MIN_SLABS = 16, 8
"""Most slabs that one thread takes at a time in space, and least number in a thin domain [-]."""

Strides = tuple[np.uint64, ...]
"""Strides along the axes of a slab [-]."""


def inner_strides(cells: tuple[int, ...]) -> Strides:
    """Return the strides within a slab of a grid with so many cells along x, y (and z)."""
    return (UNIT,) if len(cells) == 2 else (UNIT, unsigned(cells[0] + 2 * PAD))


@kernel_part
def strides_like(inner, row_cells):
    """Return the strides within a slab whose rows have ``row_cells`` cells, with as many axes as ``inner``."""
    return tuple_setitem(inner, len(inner) - 1, row_cells if len(inner) > 1 else UNIT)


@kernel_part
def slabs_per_block(inner, count, min_slabs):
    """Return how many slabs a thread takes at a time; in space the number of blocks is even where possible.

    Args:
        inner: strides within a slab.
        count: number of slabs in the whole loop.
        min_slabs: least number of slabs of a block in space.
    """
    if len(inner) == 1:
        return BLOCK
    blocks = 2 * ((count + 2 * MAX_SLABS - 1) // (2 * MAX_SLABS))
    return max((count + blocks - 1) // blocks, min_slabs)


@kernel_part
def row_length(inner, length):
    """Return how many cells a row has, those around the domain with it."""
    return inner[-1] if len(inner) > 1 else unsigned(length)


@kernel_part
def row_count(inner, length):
    """Return how many rows of a slab lie in the domain."""
    return unsigned(length) // inner[-1] - EDGE - EDGE if len(inner) > 1 else UNIT


@kernel_part
def run_of(inner, length):
    """Return first and end of the shortest run of cells that holds all cells of a slab inside the domain.

    Args:
        inner: strides within a slab.
        length: cells of a slab.
    """
    margin = ZERO
    for d in range(len(inner)):
        margin += EDGE * inner[d]
    return margin, unsigned(length) - margin


@kernel_part
def meets(level_layout, inner, slab):
    """Return whether a slab meets the window."""
    w = len(inner) + 2
    return level_layout[w] <= slab < level_layout[w + 1]


@kernel_part
def window_rows(level_layout, inner):
    """Return first and end of the rows of a slab that meet the window."""
    w = len(inner) + 4
    return (unsigned(level_layout[w]), unsigned(level_layout[w + 1])) if len(inner) > 1 else (ZERO, UNIT)


@kernel_part
def window_columns(level_layout, inner):
    """Return first and end of the cells of a row that meet the window."""
    w = 3 * len(inner) + 2
    return unsigned(level_layout[w]), unsigned(level_layout[w + 1])


@kernel_part
def near_strides(near_layout, inner):
    """Return the strides within a slab of the arrays of a window."""
    w = 3 * len(inner) + 2
    return strides_like(inner, unsigned(near_layout[w + 1] - near_layout[w] + 1))


@kernel_part
def near_shift(near_layout, inner, row, row_cells):
    """Return the index of a cell in a slab minus its index in the slab of a near array, for the cells of a row.

    Args:
        near_layout: the window.
        inner: strides within a slab.
        row: the row.
        row_cells: cells of a row of the slab.
    """
    w, first_row = 3 * len(inner) + 2, unsigned(near_layout[len(inner) + 4]) if len(inner) > 1 else ZERO
    columns = unsigned(near_layout[w + 1] - near_layout[w] + 1)
    return row * row_cells + unsigned(near_layout[w]) - (row - first_row) * columns
