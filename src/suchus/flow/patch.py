# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision)
"""The windows of all levels by themselves: small arrays on which extra smoothing steps cost next to nothing.

A level's patch is its window and ``RIM`` cells around it, as far as they lie in the domain. Rows lie end to end, so
that a smoothing step is one long loop; the cells at the rim keep their value, because their inverse diagonal counts as
0. A row of ``rects`` is a patch: where it starts in the room, and its padded cell indices j0, j1, i0, i1.
"""

import numpy as np

from suchus.flow.compiled import PAD, UNIT, part, unsigned
from suchus.flow.stencil import FIRST, SECOND, copy_row, first_row, relax_patch

ONE, TWO, RIGHT, FACE_X, FACE_Y, INVERSE = range(6)
"""What ``room[kind]`` holds: solution, its second copy, right side, face coefficients, inverse diagonal."""

RIM = 8
"""Cells around a window that its patch takes in: its rim jumps, and near a tail's end that must not be seen [-]."""

EXTRA = 6
"""Pairs of smoothing steps in the patches, before and after: there the coefficients vary [-]."""


def rects(layout: np.ndarray) -> np.ndarray:
    """Return the patches of a layout whose windows are placed, shape (level, 5)."""
    rows, offset = [], 0
    for _, ny, nx, *window in layout:
        j0, j1, i0, i1 = (int(w) for w in window)
        if j1 > j0:
            j0, j1 = max(j0 - RIM, PAD), min(j1 + RIM, ny + PAD)
            i0, i1 = max(i0 - RIM, PAD), min(i1 + RIM, nx + PAD)
        rows.append([offset, j0, j1, i0, i1])
        offset += (j1 - j0) * (i1 - i0)
    return np.array(rows, dtype=np.int64)


def room_for(room: np.ndarray, patches: np.ndarray) -> np.ndarray:
    """Return a room in which the patches have place, the old one if it will do."""
    offset, j0, j1, i0, i1 = patches[-1]
    size = int(offset + (j1 - j0) * (i1 - i0))
    return room if size <= room.shape[1] else np.zeros((6, size + size // 4), room.dtype)


@part
def patch(room, rect, kind):
    """Return what the room holds of one kind for one patch, shape (row, column)."""
    high, wide = rect[2] - rect[1], rect[4] - rect[3]
    return room[kind, rect[0] : rect[0] + high * wide].reshape(high, wide)


@part
def _take(to, rect, a):
    """Copy a patch from an array of its level to the room."""
    for j in range(unsigned(to.shape[0])):
        for i in range(unsigned(to.shape[1])):
            to[j, i] = a[j + unsigned(rect[1]), i + unsigned(rect[3])]


@part
def take_coefficients(room, rect, cx, cy, dinv):
    """Copy the coefficients of a patch from its level to the room."""
    _take(patch(room, rect, FACE_X), rect, cx)
    _take(patch(room, rect, FACE_Y), rect, cy)
    inverse = patch(room, rect, INVERSE)
    _take(inverse, rect, dinv)
    for j in range(inverse.shape[0]):
        inverse[j, 0] = 0
        inverse[j, inverse.shape[1] - 1] = 0


@part
def _relax(room, rect, first, second):
    x, y = patch(room, rect, ONE), patch(room, rect, TWO)
    wide = x.shape[1]
    copy_row(y, 0, x, 0)
    copy_row(y, y.shape[0] - 1, x, x.shape[0] - 1)
    x, y, b = x.reshape(-1), y.reshape(-1), patch(room, rect, RIGHT).reshape(-1)
    cx, cy = patch(room, rect, FACE_X).reshape(-1), patch(room, rect, FACE_Y).reshape(-1)
    dinv = patch(room, rect, INVERSE).reshape(-1)
    for _ in range(EXTRA):
        relax_patch(y, x, b, cx, cy, dinv, wide, first)
        relax_patch(x, y, b, cx, cy, dinv, wide, second)


@part
def start(room, rect, b):
    """Write the first smoothing steps on a patch to the room; at its rim they are those without a body."""
    _take(patch(room, rect, RIGHT), rect, b)
    x = patch(room, rect, ONE)
    for j in range(rect[1], rect[2]):
        first_row(x, j - rect[1], rect[3], b, j, rect[3], rect[4])
    _relax(room, rect, room.dtype.type(FIRST), room.dtype.type(SECOND))


@part
def end(room, rect, x):
    """Smooth ``x`` on a patch."""
    own = patch(room, rect, ONE)
    _take(own, rect, x)
    _relax(room, rect, room.dtype.type(SECOND), room.dtype.type(FIRST))
    for j in range(rect[1] + 1, rect[2] - 1):
        give_row(x, j, own, rect, j)


@part
def give_row(out, o, own, rect, row):
    """Copy row ``row`` of a patch's solution, but for its rim, to row ``o`` of ``out``; it may not have that row."""
    if rect[1] < row < rect[2] - 1:
        o, j, left = unsigned(o), unsigned(row - rect[1]), unsigned(rect[3])
        for i in range(UNIT, unsigned(own.shape[1]) - UNIT):
            out[o, i + left] = own[j, i]
