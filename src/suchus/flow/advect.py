# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""Momentum on the staggered grid: advection by any scheme and central diffusion, in cells and flow units.

``velocity[d]`` sits on the faces before the cells along axis d; ``PAD`` cells of boundary values surround the domain.
Lengths are in cells and velocities in m/s, so times are in cells per (m/s) and the viscosity is divided by the cell
size. How fields lie in memory: ``slab``.
"""

import sys
from functools import cache

import numpy as np
from numba import prange

from suchus.flow.compiled import (
    PAD,
    UNIT,
    kernel_part,
    replace_kernel_parts,
    replace_threaded_parts,
    signed,
    threaded,
    unsigned,
)
from suchus.flow.scheme import QUICK, Scheme, limited_quick
from suchus.flow.slab import (
    EDGE,
    MIN_SLABS,
    ZERO,
    meets,
    near_shift,
    row_count,
    row_length,
    slabs_per_block,
    window_columns,
    window_rows,
)

ROWS = 16
"""Rows of a slab in space that are advanced together: they and their neighbours fit in the nearest caches [-]."""


@kernel_part
def _fluxes(flux, o, shift, rate, c, d, slab, start, stop, dj, di, ej, ei, viscosity):
    """Write the fluxes of component ``c`` along axis ``d`` through the faces before the nodes of a slab.

    Args:
        flux: fluxes of some rows, shape (slot, cell), to write to.
        o: slot to write to.
        shift: index of a cell in the slab minus its index in ``flux``.
        rate: velocity that the rates are taken at, shape (axis, slab, cell) [m/s].
        c: component that is carried.
        d: axis that the faces lie across.
        slab: slab of the nodes.
        start: first cell in the slab.
        stop: the cell after the last.
        dj: slabs from a node to the next one along axis ``d``.
        di: cells from a node to the next one along axis ``d``.
        ej: slabs from a node to the next one along axis ``c``.
        ei: cells from a node to the next one along axis ``c``.
        viscosity: [cells m/s].
    """
    o, c, d, j, half = unsigned(o), unsigned(c), unsigned(d), unsigned(slab), flux.dtype.type(0.5)
    for k in range(unsigned(start), unsigned(stop)):
        # all values are loaded first, because a conditional load would be a branch
        value_m1, value_0 = rate[c, j - dj, k - di], rate[c, j, k]
        value_m2, value_p1 = rate[c, j - dj - dj, k - di - di], rate[c, j + dj, k + di]
        speed = half * (rate[d, j - ej, k - ei] + rate[d, j, k])
        forth = speed > 0
        face = limited_quick(
            value_m2 if forth else value_p1, value_m1 if forth else value_0, value_0 if forth else value_m1
        )
        flux[o, k - shift] = speed * face - viscosity * (value_0 - value_m1)


@kernel_part
def _net(flux, lower_slot, upper_slot, k, inner):
    """Return the net flux into a cell: through the faces within the slab, and through those below and above it.

    Args:
        flux: fluxes, shape (slot, cell); slot d has those along axis d within the slab.
        lower_slot: slot of the fluxes from the slab before.
        upper_slot: slot of the fluxes to the next slab.
        k: cell.
        inner: strides within a slab.
    """
    net = flux.dtype.type(0)
    for d in range(len(inner)):
        net += flux[d, k] - flux[d, k + inner[d]]
    return net + flux[lower_slot, k] - flux[upper_slot, k]


@kernel_part
def _update(
    velocity, blend, base, c, flux, lower_slot, upper_slot, shift, p, slab, start, stop, inner, ej, ei, dt, push, keep
):
    """Write ``keep * blend + (1 - keep) * (base + dt * (net flux + push - pressure gradient))``.

    Args:
        velocity: to write, shape (axis, slab, cell) [m/s].
        blend: velocity at the last stage [m/s].
        base: velocity at the start of the step [m/s].
        c: component.
        flux: see ``_net``.
        lower_slot: see ``_net``.
        upper_slot: see ``_net``.
        shift: index of a cell in the slab minus its index in ``flux``.
        p: pressure over density.
        slab: slab to write.
        start: first cell in the slab.
        stop: the cell after the last.
        inner: strides within a slab.
        ej: slabs from a node to the one before it along axis ``c``.
        ei: cells from a node to the one before it along axis ``c``.
        dt: length of the stage [cells per (m/s)].
        push: acceleration along axis ``c``.
        keep: fraction of ``blend`` that stays [-].
    """
    c, j, lower_slot, upper_slot = unsigned(c), unsigned(slab), unsigned(lower_slot), unsigned(upper_slot)
    take = velocity.dtype.type(1.0) - keep
    for k in range(unsigned(start), unsigned(stop)):
        rate = _net(flux, lower_slot, upper_slot, k - shift, inner) + push - (p[j, k] - p[j - ej, k - ei])
        velocity[c, j, k] = keep * blend[c, j, k] + take * (base[c, j, k] + dt * rate)


@kernel_part
def _pressure_free_update(
    raw, base, c, flux, lower_slot, upper_slot, shift, slab, rows, layout, near_layout, inner, dt, push
):
    """Write ``base + dt * (net flux + push)`` in the window: the fluid's own update, before the body is immersed.

    Args:
        raw: near array to write, shape (axis, slab, cell) [m/s].
        base: velocity at the start of the step [m/s].
        c: component.
        flux: see ``_net``.
        lower_slot: see ``_net``.
        upper_slot: see ``_net``.
        shift: index of a cell in the slab minus its index in ``flux``.
        slab: slab of the grid.
        rows: first row, and the row after the last.
        layout: row of the multigrid's layout for the grid; see ``slab``.
        near_layout: the same with the window of the near arrays.
        inner: strides within a slab.
        dt: length of the stage [cells per (m/s)].
        push: acceleration along axis ``c``.
    """
    c, j, lower_slot, upper_slot = unsigned(c), unsigned(slab), unsigned(lower_slot), unsigned(upper_slot)
    row_cells = row_length(inner, base.shape[2])
    r0, r1 = window_rows(layout, inner)
    s, e = window_columns(layout, inner)
    o = j - unsigned(near_layout[len(inner) + 2])
    for row in range(max(r0, rows[0]), min(r1, rows[1])):
        window_shift = near_shift(near_layout, inner, row, row_cells)
        for k in range(row * row_cells + s, row * row_cells + e):
            raw[c, o, k - window_shift] = base[c, j, k] + dt * (
                _net(flux, lower_slot, upper_slot, k - shift, inner) + push
            )


@kernel_part
def _advance(
    velocity, blend, base, rate, p, raw, layout, near_layout, inner, repeats, flux, slabs, rows, dt, nu, push, keep
):  # fmt: skip
    """Advance some rows of some slabs; see ``advance``.

    ``slabs`` and ``rows`` have the first and the one after the last; ``flux`` is a work array, shape (slot, cell).
    """
    slab_axis = len(inner)
    row_cells = row_length(inner, velocity.shape[2])
    shift = rows[0] * row_length(inner, velocity.shape[2])
    s, e, first_slab = shift + EDGE, rows[1] * row_cells - EDGE, slabs[0]
    margin = EDGE if slab_axis > 1 else ZERO
    for j in range(first_slab - 1, slabs[1]):
        for c in range(slab_axis + 1):
            # the first face of component c along axis c lies on a side
            start, j0, ej, ei = s, first_slab, ZERO, ZERO
            if c == slab_axis:
                ej = UNIT
                j0 = first_slab if repeats[c] else max(first_slab, PAD + 1)
            else:
                ei = inner[c]
                start = s if repeats[c] else max(s, margin * row_cells + EDGE + inner[c])
            if j < j0 - 1:
                continue
            lower_slot, upper_slot = slab_axis + c + c + j % 2, slab_axis + c + c + 1 - j % 2
            _fluxes(flux, upper_slot, shift, rate, c, slab_axis, j + 1, start, e, UNIT, ZERO, ej, ei, nu)
            if j < j0:
                continue
            for d in range(slab_axis):
                _fluxes(flux, d, shift, rate, c, d, j, start, e + inner[d], ZERO, inner[d], ej, ei, nu)
            _update(
                velocity, blend, base, c, flux, lower_slot, upper_slot, shift, p, j, start, e, inner, ej, ei, dt,
                push[c], keep,
            )  # fmt: skip
            if meets(layout, inner, j):
                _pressure_free_update(
                    raw, base, c, flux, lower_slot, upper_slot, shift, j, rows, layout, near_layout, inner, dt, push[c]
                )  # fmt: skip


@threaded
def advance(velocity, blend, base, rate, p, raw, layout, near_layout, inner, repeats, dt, nu, push, keep):
    """Advance all components of the velocity by ``dt`` with the rates at ``rate`` and the pressure ``p``.

    ``velocity = keep * blend + (1 - keep) * (base + dt * rate)``. The caller fills the faces on the sides and
    beyond them.

    Args:
        velocity: to write, shape (axis, slab, cell) [m/s].
        blend: velocity at the last stage [m/s].
        base: velocity at the start of the step [m/s].
        rate: velocity that the rates are taken at [m/s].
        p: pressure over density.
        raw: near array for ``base + dt * rate`` without the pressure in the bodies' window [m/s].
        layout: row of the multigrid's layout for the grid; see ``slab``.
        near_layout: the same with the window of the near arrays.
        inner: strides within a slab.
        repeats: whether each axis is periodic.
        dt: length of the stage [cells per (m/s)].
        nu: viscosity [cells m/s].
        push: uniform acceleration, one number for each axis.
        keep: fraction of ``blend`` that stays [-].
    """
    size = velocity.shape[1] - 2 * PAD
    block_size = slabs_per_block(inner, size, MIN_SLABS)
    for n in prange((size + block_size - 1) // block_size):
        first_slab = PAD + signed(n) * block_size
        slabs = first_slab, min(first_slab + block_size, PAD + size)
        row_cells, rows = row_length(inner, velocity.shape[2]), row_count(inner, velocity.shape[2])
        margin, rows_per_block = (EDGE, unsigned(ROWS)) if len(inner) > 1 else (ZERO, UNIT)
        flux = np.empty((3 * len(inner) + 2, (rows_per_block + UNIT) * row_cells), velocity.dtype)
        for row in range(ZERO, rows, rows_per_block):
            row_range = row + margin, min(row + rows_per_block, rows) + margin
            _advance(
                velocity, blend, base, rate, p, raw, layout, near_layout, inner, repeats, flux, slabs, row_range,
                dt, nu, push, keep,
            )  # fmt: skip


@cache
def advance_by(scheme: Scheme):
    """Return ``advance`` with an advection scheme. Any scheme but limited QUICK is compiled anew in each process."""
    if scheme == QUICK:
        return advance
    name = scheme.name
    print(f"Compiling the flow solver with the advection scheme {name} ...", file=sys.stderr, flush=True)
    fluxes = replace_kernel_parts(_fluxes, limited_quick=kernel_part(scheme.face))
    return replace_threaded_parts(advance, _advance=replace_kernel_parts(_advance, _fluxes=fluxes))
