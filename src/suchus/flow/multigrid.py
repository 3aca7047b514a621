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

from suchus.flow.compiled import PAD, SERIAL_BELOW, UNIT, compiled, part, signed, threaded_part, unsigned
from suchus.flow.patch import ONE, end, give_slab, patch, start, take_coefficients
from suchus.flow.slab import (
    EDGE,
    LEAST,
    NONE,
    block_of,
    row_count,
    row_length,
    run_of,
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
"""What a level holds: solution, right side, inverse diagonal, and from there on face coefficients, axis by axis."""

COARSEST = 32
"""Most cells along a side of the last level, which is solved by Jacobi steps alone [-]."""

LONGEST = 16 * COARSEST
"""Largest number of cells along a side of the coarsest level of a long channel, which takes more steps there [-]."""

LEFT = 0.02
"""Share of each error that solving the coarsest level leaves [-]. Where it left half of the smoothest, a patch of the
started cylinder at Re 1000 that stopped after one cycle a stage shook by up to 6 % of its drag."""


@part
def _shape(layout, k, inner):
    """Return how many slabs a level has, and how many cells a slab of it, those around the domain with them."""
    rows = layout[k, 2] + 2 * PAD if len(inner) > 1 else 1
    return layout[k, 1] + 2 * PAD, rows * (layout[k, len(inner) + 1] + 2 * PAD)


@part
def level(store, layout, inner, kind, k):
    """Return the array of one kind on level ``k``; see ``slab`` for the rows of the layout."""
    high, length = _shape(layout, k, inner)
    start = layout[k, 0] + kind * high * length
    return store[start : start + high * length].reshape(high, length)


@part
def faces_of(store, layout, inner, k):
    """Return the coefficients of the faces on level ``k``, shape (axis, slab, cell)."""
    (high, length), axes = _shape(layout, k, inner), len(inner) + 1
    start = layout[k, 0] + FACES * high * length
    return store[start : start + axes * high * length].reshape(axes, high, length)


@part
def _strides(layout, inner, k):
    """Return the strides within a slab of level ``k``."""
    return strides_like(inner, unsigned(layout[k, len(inner) + 1] + 2 * PAD))


@part
def _fold(j, n, periodic):
    """Return the slab of the domain that slab ``j``, which may lie beyond a wall, is a copy of."""
    if periodic:
        return (j - PAD + n) % n + PAD
    return min(max(j, PAD), PAD + n - 1)


@part
def _first(out, o, b, own, rect, slab, inner, repeats):
    """Write slab ``slab`` after the first smoothing steps to slab ``o`` of ``out``."""
    first, end = run_of(inner, b.shape[1])
    first_steps(out, o, NONE, b, slab, inner, first, end)
    give_slab(out, o, own, rect, slab, inner)
    seal_slab(out, o, inner, repeats)


@part
def _sum_rest(coarse, coarse_slab, rest, b, slab, inner, below):
    """Write to a coarse slab what two slabs of the right side have more than slabs 0 and 1 of ``rest``, summed."""
    c, j = unsigned(coarse_slab), unsigned(slab)
    first, end = run_of(inner, b.shape[1])
    for k in range(first, end):
        rest[0, k] = (b[j, k] + b[j + UNIT, k]) - (rest[0, k] + rest[1, k])
    wide, narrow = row_length(inner, b.shape[1]), row_length(below, coarse.shape[1])
    half = rest.dtype.type(0.5)
    for n in range(row_count(below, coarse.shape[1])):
        fine = (n + n + EDGE) * wide if len(inner) > 1 else NONE
        row = (n + EDGE) * narrow if len(inner) > 1 else NONE
        if len(inner) > 1:
            for k in range(fine + EDGE, fine + wide - EDGE):
                rest[0, k] = half * (rest[0, k] + rest[0, k + wide])
        for k in range(EDGE, narrow - EDGE):
            i = fine + k + k - EDGE
            coarse[c, row + k] = rest[0, i] + rest[0, i + UNIT]


@part
def _down(coarse, b, faces, place, room, rect, j0, j1, inner, below, repeats):
    """Write the summed residual after the first smoothing steps to slabs ``j0`` to ``j1`` of ``coarse``."""
    size, own, again = place[1], patch(room, rect, inner, ONE), repeats[len(inner)]
    rest, rows = np.empty((2, b.shape[1]), b.dtype), np.empty((4, b.shape[1]), b.dtype)
    low, mid, high, top = 0, 1, 2, 3
    j = 2 * (j0 - PAD) + PAD
    _first(rows, low, b, own, rect, _fold(j - 1, size, again), inner, repeats)
    _first(rows, mid, b, own, rect, j, inner, repeats)
    for cj in range(j0, j1):
        j = 2 * (cj - PAD) + PAD
        _first(rows, high, b, own, rect, j + 1, inner, repeats)
        _first(rows, top, b, own, rect, _fold(j + 2, size, again), inner, repeats)
        apply_slabs(rest, 0, rows, low, mid, high, faces, place, j, inner)
        apply_slabs(rest, 1, rows, mid, high, top, faces, place, j + 1, inner)
        _sum_rest(coarse, cj, rest, b, j, inner, below)
        seal_slab(coarse, cj, below, repeats)
        low, mid, high, top = high, top, low, mid


@part
def _add_coarse(out, o, coarse, mix, slab, inner, below):
    """Add to slab ``o`` of ``out``, which is slab ``slab`` of its level, the coarse cells, linear between them."""
    near = unsigned((slab - PAD) // 2 + PAD)
    far = near - UNIT if (slab - PAD) % 2 == 0 else near + UNIT
    o, most, some = unsigned(o), out.dtype.type(0.75), out.dtype.type(0.25)
    for k in range(EDGE - UNIT, unsigned(coarse.shape[1]) - EDGE + UNIT):
        mix[k] = most * coarse[near, k] + some * coarse[far, k]
    if len(inner) == 1:  # apart: where a row is too short to be vectorised its sums are contracted in another way
        for k in range(EDGE, unsigned(coarse.shape[1]) - EDGE):
            i = k + k - EDGE
            out[o, i] += most * mix[k] + some * mix[k - UNIT]
            out[o, i + UNIT] += most * mix[k] + some * mix[k + UNIT]
        return
    wide, narrow = row_length(inner, out.shape[1]), row_length(below, coarse.shape[1])
    line = unsigned(coarse.shape[1])
    for n in range(row_count(inner, out.shape[1])):
        row, beside = (n + EDGE) * wide, (n // (UNIT + UNIT) + EDGE) * narrow
        behind = beside - narrow if n % (UNIT + UNIT) == NONE else beside + narrow
        for k in range(EDGE - UNIT, narrow - EDGE + UNIT):
            mix[line + k] = most * mix[beside + k] + some * mix[behind + k]
        for k in range(EDGE, narrow - EDGE):
            i = row + k + k - EDGE
            out[o, i] += most * mix[line + k] + some * mix[line + k - UNIT]
            out[o, i + UNIT] += most * mix[line + k] + some * mix[line + k + UNIT]


@part
def _up(x, b, coarse, faces, dinv, place, room, rect, j0, j1, inner, below, repeats):
    """Write the first smoothing steps, the coarse correction and the last two steps to slabs ``j0`` to ``j1``."""
    again, size, own = repeats[len(inner)], place[1], patch(room, rect, inner, ONE)
    rows = np.empty((6, b.shape[1]), b.dtype)
    mix = np.empty(coarse.shape[1] + signed(row_length(below, coarse.shape[1])), b.dtype)
    two, one = weights(inner, b.dtype.type)
    a, m, z = 0, 1, 2  # slabs that the last step but one reads
    low, mid, high = 3, 4, 5  # slabs that the last step reads
    for j in range(j0 - 2, j1 + 2):
        a, m, z = m, z, a
        here = _fold(j, size, again)
        _first(rows, z, b, own, rect, here, inner, repeats)
        _add_coarse(rows, z, coarse, mix, here, inner, below)
        seal_slab(rows, z, inner, repeats)
        if j < j0:
            continue
        low, mid, high = mid, high, low
        if j > PAD + size and not again:
            copy_slab(rows, high, rows, mid)
        else:
            here = _fold(j - 1, size, again)
            relax_slabs(rows, high, rows, a, m, z, b, faces, dinv, place, here, one, inner, repeats)
        if j == PAD + 1 and not again:
            copy_slab(rows, mid, rows, high)
        if j >= j0 + 2:
            relax_slabs(x, j - 2, rows, low, mid, high, b, faces, dinv, place, j - 2, two, inner, repeats)


@threaded_part
def _down_threaded(coarse, b, faces, place, room, rect, inner, below, repeats):
    end = coarse.shape[0] - PAD
    block = block_of(inner, end - PAD, LEAST // 2)
    for n in prange((end - PAD + block - 1) // block):
        j0 = PAD + signed(n) * block
        _down(coarse, b, faces, place, room, rect, j0, min(j0 + block, end), inner, below, repeats)


@threaded_part
def _up_threaded(x, b, coarse, faces, dinv, place, room, rect, inner, below, repeats):
    end = x.shape[0] - PAD
    block = block_of(inner, end - PAD, LEAST)
    for n in prange((end - PAD + block - 1) // block):
        j0 = PAD + signed(n) * block
        _up(x, b, coarse, faces, dinv, place, room, rect, j0, min(j0 + block, end), inner, below, repeats)


@part
def _live_mean(b, dinv, inner):
    """Return the mean over the cells that have an open face: without walls that fix it, the pressure has no level."""
    end, wide, total, live = b.shape[0] - PAD, signed(row_length(inner, b.shape[1])), 0.0, 0
    if len(inner) == 1:
        for j in range(PAD, end):
            for i in range(PAD, wide - PAD):
                if dinv[j, i] > 0:
                    total += b[j, i]
                    live += 1
    else:
        for j in range(PAD, end):
            for row in range(PAD, signed(b.shape[1]) // wide - PAD):
                for k in range(row * wide + PAD, row * wide + wide - PAD):
                    if dinv[j, k] > 0:
                        total += b[j, k]
                        live += 1
    return b.dtype.type(total / max(live, 1))


@part
def _reaches(cells, axes):
    """Return how far each step on the coarsest level goes, and the weight of the Jacobi steps that they are made of.

    Chebyshev's semi-iteration for eigenvalues from that of the smoothest error along the longest side up to 2, with as
    many steps, an even number, as leave the share ``LEFT`` of each.
    """
    least = (1.0 - np.cos(np.pi / cells)) / axes
    middle = 1.0 + 0.5 * least
    share = (1.0 - 0.5 * least) / middle
    steps = int(np.ceil(np.arccosh(1.0 / LEFT) / np.arccosh(1.0 / share)))
    reaches = np.ones(steps + steps % 2)
    for k in range(1, reaches.size):
        reaches[k] = 1.0 / (1.0 - (0.5 if k == 1 else 0.25) * share**2 * reaches[k - 1])
    return reaches, 1.0 / middle


@part
def _reach(y, step, slab, far):
    """Write ``y + far (step - y)`` to a slab of ``y``."""
    j = unsigned(slab)
    for k in range(unsigned(y.shape[1])):
        y[j, k] += far * (step[j, k] - y[j, k])


@part
def _solve_coarsest(x, b, faces, dinv, place, inner, repeats):
    y, step = np.zeros_like(x), np.zeros_like(x)
    x[:] = 0
    mean, wide, real = _live_mean(b, dinv, inner), row_length(inner, x.shape[1]), x.dtype.type
    for j in range(PAD, x.shape[0] - PAD):
        for n in range(row_count(inner, x.shape[1])):
            s = EDGE + (EDGE + n) * wide if len(inner) > 1 else EDGE
            for k in range(s, s + wide - EDGE - EDGE):
                b[unsigned(j), k] -= mean
    longest = 1
    for axis in range(len(inner) + 1):
        longest = max(longest, place[1 + axis])
    reaches, weight = _reaches(longest, len(inner) + 1)
    for far in reaches:
        smooth(step, x, b, faces, dinv, place, real(weight), inner, repeats)
        for j in range(PAD, x.shape[0] - PAD):
            _reach(y, step, j, real(far))
        seal_ends(y, repeats[len(inner)])
        x, y = y, x


@part
def cycle(x, store, layout, room, rects, inner, repeats):
    """Write one V-cycle for the right side ``B`` of level 0, started from nothing, to ``x``."""
    last = layout.shape[0] - 1
    for k in range(last):
        own, below = _strides(layout, inner, k), _strides(layout, inner, k + 1)
        b, coarse = level(store, layout, inner, B, k), level(store, layout, inner, B, k + 1)
        faces, place, rect = faces_of(store, layout, inner, k), layout[k], rects[k]
        seal_ends(b, repeats[len(inner)])
        if rect[1] < rect[2]:
            start(room, rect, b, own)
        if b.size < SERIAL_BELOW:
            _down(coarse, b, faces, place, room, rect, PAD, coarse.shape[0] - PAD, own, below, repeats)
        else:
            _down_threaded(coarse, b, faces, place, room, rect, own, below, repeats)
    _solve_coarsest(
        x if last == 0 else level(store, layout, inner, X, last),
        level(store, layout, inner, B, last),
        faces_of(store, layout, inner, last),
        level(store, layout, inner, DINV, last),
        layout[last],
        _strides(layout, inner, last),
        repeats,
    )
    for k in range(last - 1, -1, -1):
        own, below = _strides(layout, inner, k), _strides(layout, inner, k + 1)
        b, coarse = level(store, layout, inner, B, k), level(store, layout, inner, X, k + 1)
        faces, dinv = faces_of(store, layout, inner, k), level(store, layout, inner, DINV, k)
        place, rect, out = layout[k], rects[k], x if k == 0 else level(store, layout, inner, X, k)
        if b.size < SERIAL_BELOW:
            _up(out, b, coarse, faces, dinv, place, room, rect, PAD, out.shape[0] - PAD, own, below, repeats)
        else:
            _up_threaded(out, b, coarse, faces, dinv, place, room, rect, own, below, repeats)
        if rect[1] < rect[2]:
            end(room, rect, out, own)
            if len(inner) > 1:  # there a patch has changed cells beside the sides
                for j in range(max(rect[1], PAD), min(rect[2], out.shape[0] - PAD)):
                    seal_slab(out, j, own, repeats)
        seal_ends(out, repeats[len(inner)])


@part
def _coefficients(cx, cy, dinv, place):
    """Fill the inverse diagonal of a plane level in the window; a cell with no open face gets 0.

    The quotient is estimated and improved where it is vectorised: written like the one below it has another last digit.
    """
    small = cx.dtype.type(1e-6)
    for j in range(place[3], place[4]):
        for i in range(place[5], place[6]):
            total = (cx[j, i] + cx[j, i + 1]) + (cy[j, i] + cy[j + 1, i])
            dinv[j, i] = 1 / total if total > small else 0


@part
def _coefficients_in_space(faces, dinv, place, inner):
    """Fill the inverse diagonal of a level in space in the window; a cell with no open face gets 0."""
    small, up, wide = dinv.dtype.type(1e-6), len(inner), signed(row_length(inner, dinv.shape[1]))
    for j in range(place[4], place[5]):
        for row in range(place[6], place[7]):
            for k in range(row * wide + place[8], row * wide + place[9]):
                total = faces[up, j, k] + faces[up, j + 1, k]
                for d in range(up):
                    total += faces[d, j, k] + faces[d, j, k + signed(inner[d])]
                dinv[j, k] = 1 / total if total > small else 0


@part
def _in_line(before, here, after):
    """Return the coefficient of three faces in line between the middles of two coarse cells, the outer ones halved."""
    resistance = here * after + 2 * before * after + before * here
    return 4 * before * here * after / resistance if resistance > 0 else before


@part
def _joined(face, j, k, axis, inner):
    """Return a coarse face's coefficient from those of its fine faces and of the faces before and behind them.

    What they carry side by side lets the water through bodies thinner than a coarse cell; what the faces carry in
    line blocks it beside their ends too. With the geometric mean of both a solve needs half the cycles of the first.

    Args:
        face: coefficients of the fine level's faces across one axis.
        j: slab of the first fine face.
        k: cell in the slab of the first fine face.
        axis: which axis.
        inner: strides within a slab.
    """
    axes = len(inner) + 1
    dj, dk = (1, 0) if axis == len(inner) else (0, signed(inner[axis]))
    beside, in_line = face.dtype.type(0), face.dtype.type(0)
    for m in range(2 ** len(inner)):
        fj, fk = j, k
        for n in range(len(inner)):
            other = (axis + 1 + n) % axes
            if m >> n & 1:
                fj += 1 if other == len(inner) else 0
                fk += 0 if other == len(inner) else signed(inner[other])
        here = face[fj, fk]
        beside += here
        in_line += _in_line(face[fj - dj, fk - dk], here, face[fj + dj, fk + dk])
    share = face.dtype.type(1 / 2 ** len(inner))
    return np.sqrt(share * beside * (share * in_line))


@part
def _coarse_faces(coarse, fine, place, narrow, inner, axis):
    """Fill the coefficients of a coarse level's faces across one axis in its window; ``narrow``: its row's length."""
    up, wide = len(inner), signed(row_length(inner, fine.shape[1]))
    r0, r1 = (place[up + 4], place[up + 5] + 1) if up > 1 else (0, 1)
    for cj in range(place[up + 2], place[up + 3] + 1):
        j = 2 * (cj - PAD) + PAD
        for row in range(r0, r1):
            base = (2 * (row - PAD) + PAD) * wide if up > 1 else 0
            for ci in range(place[3 * up + 2], place[3 * up + 3] + 1):
                k = base + 2 * (ci - PAD) + PAD
                coarse[cj, row * narrow + ci] = _joined(fine, j, k, axis, inner)


@compiled
def coarsen(store, layout, inner):
    """Fill the inverse diagonals and every coarser level's coefficients inside the windows."""
    for k in range(layout.shape[0]):
        faces, own = faces_of(store, layout, inner, k), _strides(layout, inner, k)
        if len(inner) == 1:
            _coefficients(faces[0], faces[1], level(store, layout, inner, DINV, k), layout[k])
        else:
            _coefficients_in_space(faces, level(store, layout, inner, DINV, k), layout[k], own)
        if k + 1 == layout.shape[0]:
            return
        coarse = faces_of(store, layout, inner, k + 1)
        narrow = layout[k + 1, len(inner) + 1] + 2 * PAD
        for d in range(len(inner) + 1):
            _coarse_faces(coarse[d], faces[d], layout[k + 1], narrow, own, d)


@compiled
def spread(store, layout, room, rects, inner):
    """Copy the coefficients of all levels to the room; see ``patch``."""
    for k in range(layout.shape[0] - 1):
        if rects[k, 1] < rects[k, 2]:
            dinv = level(store, layout, inner, DINV, k)
            faces = faces_of(store, layout, inner, k)
            take_coefficients(room, rects[k], layout[k], faces, dinv, _strides(layout, inner, k))
