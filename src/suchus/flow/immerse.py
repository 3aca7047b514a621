# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""The body in the equations: second-order boundary data immersion, in cells and flow units.

Near the body the velocity is ``mu0 f + (1 - mu0) V + mu1 d(f - V)/dn``, where f is the fluid's own update, V the
body's velocity and mu0, mu1 the moments of a kernel one cell wide on either side of the surface. The pressure in f
acts on the share mu0 of a face, and on none of a face that lies between two cells on either side of a body.

Source: Maertens and Weymouth 2015, Comput. Methods Appl. Mech. Eng. 283, 106-129.
"""

import numpy as np
from numba import prange

from suchus.flow.compiled import (
    UNIT,
    compiled,
    kernel_part,
    ordered_part,
    signed,
    threaded,
    threaded_part,
    unsigned,
)
from suchus.flow.slab import (
    MIN_SLABS,
    ZERO,
    meets,
    near_shift,
    near_strides,
    row_length,
    slabs_per_block,
    window_columns,
    window_rows,
)

REACH = 3.0
"""Distance from the surface up to which normals and velocities are needed [cells]."""

WINDOW_MARGIN = REACH + 2
"""Least distance of the window's sides from the bodies [cells]."""

MEAN_WINDOW_MARGIN = WINDOW_MARGIN + 1
"""The same with the cell that the window takes on, so that it ends between cells [cells]."""

POINTS = 4096
"""Points whose moments one thread fills at a time [-]."""

DEGENERACY_TOLERANCE = 1e-9
"""Largest distance, over a cell or a triangle, at which a line of cells that misses it still counts as a hit [-]."""

MIN_FLUID_FRACTION = 1e-3
"""Fluid fraction kept inside the bodies, so that the pressure equation has no isolated regions [-]."""

MIN_THICKNESS = 2.0 + 2.0**0.5
"""Thickness below which no cell lies completely inside the body [cells]."""

MIN_CLOSED_THICKNESS = 1.0
"""Smallest maximum thickness of a body whose middle surface is closed to the pressure [cells]. At this thickness the
added mass and work of a plate that heaves agree within 1 % with those on three times as fine a grid; at half of it they
differ by 7 %. In space the added mass of a disc of this thickness, across itself, is within 4 % of potential theory."""


def wall_offset(spread: float) -> float:
    """Return the offset of the immersion outside the surface at which the water sticks to the surface [cells].

    Applied step after step, the immersion lets friction pull the resting point of a linear profile into the body,
    the farther the larger the step. The fit is to the exact steady state of the discrete one-dimensional profile,
    averaged over the wall's position between the nodes: 0.03 cells at a spread of 0.001, 0.10 at 0.01, 0.27 at 0.1,
    0.35 at 0.2. Without it a cylinder has too little drag by 2 % at 32 cells a diameter. The offset has to follow
    the step: when the step is halved at once, the force on a cylinder at Re 40 jumps by 27 % of the drag with the old
    offset, and by 2.3 % with the new one.

    Args:
        spread: viscosity times the step over the cell squared [-].
    """
    return float(0.66 * spread**0.4)


@kernel_part
def moment0(distance):
    """Return the fluid fraction at a signed distance [cells] from the surface, 0 inside to 1 outside."""
    if distance <= -1.0:
        return 0.0
    if distance >= 1.0:
        return 1.0
    return 0.5 * (1.0 + distance + np.sin(np.pi * distance) / np.pi)


@kernel_part
def moment1(distance):
    """Return the first moment of the kernel at a signed distance [cells] from the surface [cells]."""
    if abs(distance) >= 1.0:
        return 0.0
    turn = np.pi * distance
    return 0.25 - 0.25 * distance**2 - (distance * np.sin(turn) + (1.0 + np.cos(turn)) / np.pi) / (2.0 * np.pi)


@threaded
def fill(distance, normal, thickness, h, offset, mu0, mu1):
    """Fill the moments of the kernel at points.

    The kernel sees both surfaces of a thin body. So the fraction that a tail of any thickness takes from the cells
    around it does not depend on how it lies between the nodes. With the nearer surface alone the fraction depends on
    it, and the force shakes as the tail sweeps over the grid (12 % of its rms, against 1 %).

    Args:
        distance: signed distance of each point from the surface [m].
        normal: outward normal, shape (axis, point).
        thickness: thickness of the body at the nearest point of the surface [m].
        h: side of a cell [m].
        offset: offset of the wall outside the surface [cells].
        mu0: fluid fraction to write, shape (point,).
        mu1: half of the first moment along the normal to write, shape (axis, point) [cells].
    """
    for n in prange((distance.size + POINTS - 1) // POINTS):
        block = signed(n)
        for k in range(block * POINTS, min((block + 1) * POINTS, distance.size)):
            near_distance = distance[k] / h - offset
            far_distance = -(thickness[k] / h + 2.0 * offset) - near_distance
            mu0[k] = min(max(moment0(near_distance) + moment0(far_distance), MIN_FLUID_FRACTION), 1.0)
            first_moment = 0.5 * (moment1(near_distance) - moment1(far_distance))
            for d in range(normal.shape[0]):
                mu1[d, k] = first_moment * normal[d, k]


@kernel_part
def _lines_within(p, q, r, origin, h, count):
    """Return the first line of cells that three coordinates span, and the one after the last."""
    lower_bound, upper_bound = min(p, q, r), max(p, q, r)
    start, stop = (
        np.ceil((lower_bound - origin) / h - DEGENERACY_TOLERANCE),
        np.floor((upper_bound - origin) / h + DEGENERACY_TOLERANCE) + 1.0,
    )
    return max(int(start), 0), min(int(stop), count)


@compiled
def close_faces(passage, c, pieces, origin, h):
    """Close the faces of one direction whose two cells lie on either side of a line to the pressure.

    The kernel of a body thinner than the kernel's width leaves some fluid inside, which the pressure drives through the
    body in every step: a plate that heaves and is half a cell thick has a twentieth of its added mass. When these faces
    are closed, no path from cell to cell crosses the line.

    Args:
        passage: share of the pressure's gradient that acts on the faces across axis ``c`` of a window, shape (y, x);
            changed.
        c: axis that the faces lie across.
        pieces: ends of the pieces of the line, shape (end, axis, piece).
        origin: middle of the window's first cell, x and y; the first face lies before it.
        h: cell.
    """
    a = 1 - c
    lines, faces = passage.shape[c], passage.shape[a]
    cell_index = np.zeros(2, np.int64)
    for k in range(pieces.shape[2]):
        start_x, start_y, end_x, end_y = pieces[0, c, k], pieces[0, a, k], pieces[1, c, k], pieces[1, a, k]
        lower_bound, upper_bound = (start_y, end_y) if start_y < end_y else (end_y, start_y)
        first_line = max(int(np.ceil((lower_bound - origin[a]) / h)), 0)
        for j in range(first_line, min(int(np.ceil((upper_bound - origin[a]) / h)), lines)):
            crossing = start_x + (end_x - start_x) * (origin[a] + j * h - start_y) / (end_y - start_y)
            i = int(np.floor((crossing - (origin[c] - h)) / h))
            if 0 <= i < faces:
                cell_index[c], cell_index[a] = i, j
                passage[cell_index[1], cell_index[0]] = min(passage[cell_index[1], cell_index[0]], MIN_FLUID_FRACTION)


@compiled
def close_surface(passage, c, triangles, origin, h):
    """Do in space what ``close_faces`` does in the plane, with triangles in place of the pieces of a line.

    Args:
        passage: share of the pressure's gradient that acts on the faces across axis ``c`` of a window, shape (z, y, x);
            changed.
        c: axis that the faces lie across.
        triangles: corners, shape (corner, axis, triangle).
        origin: middle of the window's first cell, x, y and z; the first face lies before it.
        h: cell.
    """
    a, b = (c + 1) % 3, (c + 2) % 3
    sizes = (passage.shape[2], passage.shape[1], passage.shape[0])
    cell_index = np.zeros(3, np.int64)
    for n in range(triangles.shape[2]):
        p, q, r = triangles[0, :, n], triangles[1, :, n], triangles[2, :, n]
        area = (q[a] - p[a]) * (r[b] - p[b]) - (r[a] - p[a]) * (q[b] - p[b])
        if abs(area) < DEGENERACY_TOLERANCE * h * h:
            continue
        start_a, stop_a = _lines_within(p[a], q[a], r[a], origin[a], h, sizes[a])
        start_b, stop_b = _lines_within(p[b], q[b], r[b], origin[b], h, sizes[b])
        for i in range(start_a, stop_a):
            for j in range(start_b, stop_b):
                u, v = origin[a] + i * h - p[a], origin[b] + j * h - p[b]
                weight_q = (u * (r[b] - p[b]) - (r[a] - p[a]) * v) / area
                weight_r = ((q[a] - p[a]) * v - u * (q[b] - p[b])) / area
                if min(weight_q, weight_r, 1.0 - weight_q - weight_r) < -DEGENERACY_TOLERANCE:
                    continue
                crossing = p[c] + weight_q * (q[c] - p[c]) + weight_r * (r[c] - p[c])
                cell_index[c], cell_index[a], cell_index[b] = int(np.floor((crossing - origin[c]) / h)) + 1, i, j
                if 0 <= cell_index[c] < sizes[c]:
                    passage[cell_index[2], cell_index[1], cell_index[0]] = min(
                        passage[cell_index[2], cell_index[1], cell_index[0]], MIN_FLUID_FRACTION
                    )


CLOSING_KERNELS = {2: close_faces, 3: close_surface}
"""Kernels that close the faces through the middle of a thin body, by the number of axes."""


@ordered_part
def _source_row(source, b, mu0, slab, o, start, stop, shift, inner, strides):
    """Write one row of ``(1 - mu0) div V``; see ``fill_source``.

    Args:
        source: array of the window to write to.
        b: the bodies' velocity, array of the window.
        mu0: fluid fraction of the faces.
        slab: slab of the grid.
        o: the same slab in the window.
        start: first cell of the row in the slab.
        stop: the cell after the last.
        shift: index of a cell in the slab minus its index in the window's slab.
        inner: strides within a slab of the grid.
        strides: strides within a slab of the window.
    """
    j, o, slab_axis = unsigned(slab), unsigned(o), unsigned(len(inner))
    unit, fraction = source.dtype.type(1.0), source.dtype.type(0.5 / (len(inner) + 1))
    for k in range(start, stop):
        mu0_sum, inflow, outflow = source.dtype.type(0), source.dtype.type(0), source.dtype.type(0)
        for d in range(len(inner)):
            mu0_sum = mu0_sum + mu0[d, j, k]
            inflow = inflow + b[d, o, k - shift]
            outflow = outflow + b[d, o, k - shift + strides[d]]
        mu0_sum = mu0_sum + mu0[slab_axis, j, k] + mu0[slab_axis, j + UNIT, k]
        for d in range(len(inner)):
            mu0_sum = mu0_sum + mu0[d, j, k + inner[d]]
        spread = (outflow + b[slab_axis, o + UNIT, k - shift]) - (inflow + b[slab_axis, o, k - shift])
        source[o, k - shift] = (unit - fraction * mu0_sum) * spread


@compiled
def fill_source(source, b, mu0, layout, near_layout, inner):
    """Write ``(1 - mu0) div V``: the divergence of the body's own motion, which the pressure leaves alone.

    ``source`` and ``b`` are arrays of the window ``near``.

    Args:
        source: array of the window to write to.
        b: the bodies' velocity, array of the window.
        mu0: fluid fraction of the faces.
        layout: row of the multigrid's layout for the grid; see ``slab``.
        near_layout: the same with the window of the near arrays.
        inner: strides within a slab of the grid.
    """
    row_cells = row_length(inner, mu0.shape[2])
    r0, r1 = window_rows(layout, inner)
    s, e = window_columns(layout, inner)
    strides, first_slab = near_strides(near_layout, inner), near_layout[len(inner) + 2]
    for j in range(mu0.shape[1]):
        if meets(layout, inner, j):
            for row in range(r0, r1):
                shift = near_shift(near_layout, inner, row, row_cells)
                _source_row(
                    source, b, mu0, j, j - first_slab, row * row_cells + s, row * row_cells + e, shift, inner, strides
                )


@ordered_part
def _immerse_slab(
    velocity, blend, raw, b, mu0, passage, mu1, p, slab, o, start, stop, shift, strides, ej, ei, dt, keep
):
    """Write the immersed velocity of one component in one row of a slab; see ``immerse``."""
    j, o, slab_axis = unsigned(slab), unsigned(o), unsigned(len(strides))
    lower_slab, upper_slab = o - UNIT, o + UNIT
    for k in range(start, stop):
        n = k - shift
        immersed_velocity = (
            mu0[j, k] * (raw[o, n] - b[o, n]) + b[o, n] - passage[j, k] * (dt * (p[j, k] - p[j - ej, k - ei]))
        )
        for d in range(len(strides)):
            s = strides[d]
            immersed_velocity = immersed_velocity + mu1[d, o, n] * (
                raw[o, n + s] - (b[o, n + s] + raw[o, n - s]) + b[o, n - s]
            )
        immersed_velocity = immersed_velocity + mu1[slab_axis, o, n] * (
            raw[upper_slab, n] - (b[upper_slab, n] + raw[lower_slab, n]) + b[lower_slab, n]
        )
        velocity[j, k] = keep * (blend[j, k] - immersed_velocity) + immersed_velocity


@threaded_part
def _immerse_component(velocity, blend, raw, b, mu0, passage, mu1, p, component, near_layout, inner, dt, keep):
    """Write the immersed velocity of one component to the inner cells of the window; see ``immerse``."""
    ej = UNIT if component == len(inner) else ZERO
    ei = ZERO
    for d in range(len(inner)):
        ei = inner[d] if d == component else ei
    w = len(inner) + 2
    block_size = slabs_per_block(inner, near_layout[w + 1] - near_layout[w], MIN_SLABS)
    row_cells = row_length(inner, p.shape[1])
    r0, r1 = window_rows(near_layout, inner)
    s, e = window_columns(near_layout, inner)
    strides = near_strides(near_layout, inner)
    r0, r1 = (r0 + UNIT, r1 - UNIT) if len(inner) > 1 else (r0, r1)
    for n in prange((near_layout[w + 1] - near_layout[w] + block_size - 1) // block_size):
        first_slab = near_layout[w] + signed(n) * block_size
        for j in range(max(first_slab, near_layout[w] + 1), min(first_slab + block_size, near_layout[w + 1] - 1)):
            for row in range(r0, r1):
                start = row * row_cells + s + UNIT
                stop = row * row_cells + e - UNIT
                shift = near_shift(near_layout, inner, row, row_cells)
                _immerse_slab(
                    velocity, blend, raw, b, mu0, passage, mu1, p, j, j - near_layout[w], start, stop, shift, strides,
                    ej, ei, dt, keep,
                )  # fmt: skip


@compiled
def immerse(velocity, blend, raw, b, mu0, passage, mu1, p, near_layout, inner, dt, keep):
    """Write the immersed velocity to the inner cells of the window.

    ``raw`` is the fluid's own update without the pressure, ``b`` the body's velocity, ``mu1[c, d]`` the kernel's moment
    along axis d on the faces of component c, all arrays of the window ``near``;
    ``velocity = keep * blend + (1 - keep) * (immersed - dt passage grad p)``.

    Args:
        velocity: to write, shape (axis, slab, cell) [m/s].
        blend: velocity at the last stage [m/s].
        raw: the fluid's own update without the pressure, array of the window [m/s].
        b: the bodies' velocity, array of the window [m/s].
        mu0: fluid fraction of the faces, shape (axis, slab, cell) [-].
        passage: fraction of the pressure's gradient that acts on the faces [-].
        mu1: first moments of the kernel, shape (component, axis, slab, cell), halved, array of the window.
        p: pressure over density.
        near_layout: row of the multigrid's layout with the window of the near arrays; see ``slab``.
        inner: strides within a slab of the grid.
        dt: length of the stage [cells per (m/s)].
        keep: fraction of ``blend`` that stays [-].
    """
    for c in range(len(inner) + 1):
        _immerse_component(
            velocity[c], blend[c], raw[c], b[c], mu0[c], passage[c], mu1[c], p, c, near_layout, inner, dt, keep
        )  # fmt: skip
