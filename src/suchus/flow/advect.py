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

from suchus.flow.compiled import PAD, UNIT, part, part_with, signed, threaded, threaded_with, unsigned
from suchus.flow.scheme import QUICK, Scheme, limited_quick
from suchus.flow.slab import (
    EDGE,
    LEAST,
    NONE,
    block_of,
    meets,
    near_shift,
    row_count,
    row_length,
    window_columns,
    window_rows,
)

ROWS = 16
"""Rows of a slab in space that are advanced together: they and those around them stay in the nearest caches [-]."""


@part
def _fluxes(flux, o, shift, rate, c, d, slab, start, stop, dj, di, ej, ei, viscosity):
    """Write the fluxes of component ``c`` along axis ``d`` through the faces before nodes of a slab to ``flux[o]``.

    They come ``shift`` earlier there. The next node is ``dj`` slabs and ``di`` cells on. A face moves with the mean of
    component ``d`` at the node and ``ej`` slabs and ``ei`` cells before it; ``viscosity`` in cells x m/s.
    """
    o, c, d, j, half = unsigned(o), unsigned(c), unsigned(d), unsigned(slab), flux.dtype.type(0.5)
    for k in range(unsigned(start), unsigned(stop)):
        # loaded first: a choice of loads is a branch
        value_m1, value_0 = rate[c, j - dj, k - di], rate[c, j, k]
        value_m2, value_p1 = rate[c, j - dj - dj, k - di - di], rate[c, j + dj, k + di]
        speed = half * (rate[d, j - ej, k - ei] + rate[d, j, k])
        forth = speed > 0
        face = limited_quick(
            value_m2 if forth else value_p1, value_m1 if forth else value_0, value_0 if forth else value_m1
        )
        flux[o, k - shift] = speed * face - viscosity * (value_0 - value_m1)


@part
def _net(flux, lower_slot, upper_slot, k, inner):
    """Return what flows into a cell: ``flux[d]`` before it and a stride on, ``low`` and ``high`` below and above."""
    net = flux.dtype.type(0)
    for d in range(len(inner)):
        net += flux[d, k] - flux[d, k + inner[d]]
    return net + flux[lower_slot, k] - flux[upper_slot, k]


@part
def _update(
    velocity, blend, base, c, flux, lower_slot, upper_slot, shift, p, slab, start, stop, inner, ej, ei, dt, push, keep
):
    """Write ``keep * blend + (1 - keep) * (base + dt * (net flux + push - pressure gradient))``."""
    c, j, lower_slot, upper_slot = unsigned(c), unsigned(slab), unsigned(lower_slot), unsigned(upper_slot)
    take = velocity.dtype.type(1.0) - keep
    for k in range(unsigned(start), unsigned(stop)):
        rate = _net(flux, lower_slot, upper_slot, k - shift, inner) + push - (p[j, k] - p[j - ej, k - ei])
        velocity[c, j, k] = keep * blend[c, j, k] + take * (base[c, j, k] + dt * rate)


@part
def _pressure_free_update(
    raw, base, c, flux, lower_slot, upper_slot, shift, slab, rows, layout, window_layout, inner, dt, push
):
    """Write ``base + dt * (net flux + push)`` in the window: what the body is then immersed in."""
    c, j, lower_slot, upper_slot = unsigned(c), unsigned(slab), unsigned(lower_slot), unsigned(upper_slot)
    width, (r0, r1), (s, e) = (
        row_length(inner, base.shape[2]),
        window_rows(layout, inner),
        window_columns(layout, inner),
    )
    o = j - unsigned(window_layout[len(inner) + 2])
    for row in range(max(r0, rows[0]), min(r1, rows[1])):
        window_shift = near_shift(window_layout, inner, row, width)
        for k in range(row * width + s, row * width + e):
            raw[c, o, k - window_shift] = base[c, j, k] + dt * (
                _net(flux, lower_slot, upper_slot, k - shift, inner) + push
            )


@part
def _advance(
    velocity, blend, base, rate, p, raw, layout, window_layout, inner, repeats, flux, slabs, rows, dt, nu, push, keep
):  # fmt: skip
    """Advance some rows of some slabs, of both first and end; ``flux`` is room."""
    slab_axis, width, shift = (
        len(inner),
        row_length(inner, velocity.shape[2]),
        rows[0] * row_length(inner, velocity.shape[2]),
    )
    s, e, first_slab = shift + EDGE, rows[1] * width - EDGE, slabs[0]
    margin = EDGE if slab_axis > 1 else NONE
    for j in range(first_slab - 1, slabs[1]):
        for c in range(slab_axis + 1):
            # the first face along its own axis lies on a side
            start, j0, ej, ei = s, first_slab, NONE, NONE
            if c == slab_axis:
                ej = UNIT
                j0 = first_slab if repeats[c] else max(first_slab, PAD + 1)
            else:
                ei = inner[c]
                start = s if repeats[c] else max(s, margin * width + EDGE + inner[c])
            if j < j0 - 1:
                continue
            lower_slot, upper_slot = slab_axis + c + c + j % 2, slab_axis + c + c + 1 - j % 2
            _fluxes(flux, upper_slot, shift, rate, c, slab_axis, j + 1, start, e, UNIT, NONE, ej, ei, nu)
            if j < j0:
                continue
            for d in range(slab_axis):
                _fluxes(flux, d, shift, rate, c, d, j, start, e + inner[d], NONE, inner[d], ej, ei, nu)
            _update(
                velocity,
                blend,
                base,
                c,
                flux,
                lower_slot,
                upper_slot,
                shift,
                p,
                j,
                start,
                e,
                inner,
                ej,
                ei,
                dt,
                push[c],
                keep,
            )
            if meets(layout, inner, j):
                _pressure_free_update(
                    raw,
                    base,
                    c,
                    flux,
                    lower_slot,
                    upper_slot,
                    shift,
                    j,
                    rows,
                    layout,
                    window_layout,
                    inner,
                    dt,
                    push[c],
                )


@threaded
def advance(velocity, blend, base, rate, p, raw, layout, window_layout, inner, repeats, dt, nu, push, keep):
    """Advance all components of the velocity by ``dt`` with the rates at ``rate`` and the pressure ``p``.

    ``velocity = keep * blend + (1 - keep) * (base + dt * rate)``. In the bodies' window the bare ``base + dt * rate``
    without the pressure goes to ``raw`` as well, an array of the window ``near``. ``repeats`` says which axes are
    periodic, ``push`` is a uniform acceleration, one number for each axis. Faces on the sides and beyond them are for
    the caller to fill.
    """
    size = velocity.shape[1] - 2 * PAD
    block = block_of(inner, size, LEAST)
    for n in prange((size + block - 1) // block):
        first_slab = PAD + signed(n) * block
        slabs = first_slab, min(first_slab + block, PAD + size)
        width, rows = row_length(inner, velocity.shape[2]), row_count(inner, velocity.shape[2])
        margin, rows_per_block = (EDGE, unsigned(ROWS)) if len(inner) > 1 else (NONE, UNIT)
        flux = np.empty((3 * len(inner) + 2, (rows_per_block + UNIT) * width), velocity.dtype)
        for row in range(NONE, rows, rows_per_block):
            row_range = row + margin, min(row + rows_per_block, rows) + margin
            _advance(
                velocity, blend, base, rate, p, raw, layout, window_layout, inner, repeats, flux, slabs, row_range,
                dt, nu, push, keep,
            )  # fmt: skip


@cache
def advance_by(scheme: Scheme):
    """Return ``advance`` with another advection scheme; but for limited QUICK it is compiled in each process anew."""
    if scheme == QUICK:
        return advance
    name = scheme.name
    print(f"Compiling the flow solver with the advection scheme {name} ...", file=sys.stderr, flush=True)
    fluxes = part_with(_fluxes, limited_quick=part(scheme.face))
    return threaded_with(advance, _advance=part_with(_advance, _fluxes=fluxes))
