# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision and number of dimensions)
"""Momentum on the staggered grid: limited QUICK advection and central diffusion, in cells and flow units.

``velocity[d]`` sits on the faces before the cells along axis d; ``PAD`` cells of boundary values surround the domain.
Lengths are in cells and velocities in m/s, so times are in cells per (m/s) and the viscosity is divided by the cell
size. How fields lie in memory: ``slab``.

Sources: Leonard 1979, Comput. Methods Appl. Mech. Eng. 19, 59-98 (QUICK); Leonard 1991, ibid. 88, 17-74 (the
universal limiter).
"""

import numpy as np
from numba import prange

from suchus.flow.compiled import PAD, UNIT, part, signed, threaded, unsigned
from suchus.flow.slab import NONE, block_of, meets, near_shift, row_length, run_of, window_columns, window_rows


@part
def median(a, b, c):
    """Return the middle one of three numbers."""
    low = a if a < b else b
    high = a if a > b else b
    capped = high if high < c else c
    return low if low > capped else capped


@part
def limited_quick(upstream, centre, downstream):
    """Return the face value: QUICK, kept monotone between its neighbours."""
    real = type(centre)
    quick = real(0.75) * centre + real(0.375) * downstream - real(0.125) * upstream
    steepest = real(10.0) * centre - real(9.0) * upstream
    return median(quick, centre, median(steepest, centre, downstream))


@part
def _fluxes(flux, o, w, side, slab, start, stop, dj, di, ej, ei, viscosity):
    """Write the fluxes of ``w`` through the faces before the nodes of a slab to slab ``o`` of ``flux``.

    The next node is ``dj`` slabs and ``di`` cells on. A face moves with the mean of ``side`` at the node and ``ej``
    slabs and ``ei`` cells before it; ``viscosity`` in cells x m/s.
    """
    o, j, half = unsigned(o), unsigned(slab), flux.dtype.type(0.5)
    for k in range(unsigned(start), unsigned(stop)):
        # loaded first: a choice of loads is a branch
        a, b, c, d = w[j - dj - dj, k - di - di], w[j - dj, k - di], w[j, k], w[j + dj, k + di]
        speed = half * (side[j - ej, k - ei] + side[j, k])
        forth = speed > 0
        face = limited_quick(a if forth else d, b if forth else c, c if forth else b)
        flux[o, k] = speed * face - viscosity * (c - b)


@part
def _net(flux, low, high, k, inner):
    """Return what flows into a cell: ``flux[d]`` before it and a stride on, ``low`` and ``high`` below and above."""
    net = flux.dtype.type(0)
    for d in range(len(inner)):
        net += flux[d, k] - flux[d, k + inner[d]]
    return net + flux[low, k] - flux[high, k]


@part
def _update_slab(out, blend, base, flux, low, high, p, slab, start, stop, inner, ej, ei, dt, push, keep):
    """Write ``keep * blend + (1 - keep) * (base + dt * (net flux + push - pressure gradient))``."""
    j, low, high, take = unsigned(slab), unsigned(low), unsigned(high), out.dtype.type(1.0) - keep
    for k in range(unsigned(start), unsigned(stop)):
        rate = _net(flux, low, high, k, inner) + push - (p[j, k] - p[j - ej, k - ei])
        out[j, k] = keep * blend[j, k] + take * (base[j, k] + dt * rate)


@part
def _raw_slab(raw, base, flux, low, high, slab, place, near, inner, dt, push):
    """Write ``base + dt * (net flux + push)`` in the window: what the body is then immersed in."""
    j, low, high = unsigned(slab), unsigned(low), unsigned(high)
    wide, (r0, r1), (s, e) = row_length(inner, base.shape[1]), window_rows(place, inner), window_columns(place, inner)
    o = j - unsigned(near[len(inner) + 2])
    for row in range(r0, r1):
        shift = near_shift(near, inner, row, wide)
        for k in range(row * wide + s, row * wide + e):
            raw[o, k - shift] = base[j, k] + dt * (_net(flux, low, high, k, inner) + push)


@part
def _advance(out, blend, base, w, rate, p, raw, place, near, inner, j0, j1, s, e, ej, ei, dt, nu, push, keep):
    """Advance slabs ``j0`` to ``j1``, cells ``s`` to ``e`` of one component ``w``, whose axis is (``ej``, ``ei``)."""
    up = len(inner)
    flux = np.empty((up + 2, w.shape[1]), w.dtype)
    low, high = up, up + 1
    _fluxes(flux, high, w, rate[up], j0, s, e, UNIT, NONE, ej, ei, nu)
    for j in range(j0, j1):
        low, high = high, low
        for d in range(up):
            _fluxes(flux, d, w, rate[d], j, s, e + inner[d], NONE, inner[d], ej, ei, nu)
        _fluxes(flux, high, w, rate[up], j + 1, s, e, UNIT, NONE, ej, ei, nu)
        _update_slab(out, blend, base, flux, low, high, p, j, s, e, inner, ej, ei, dt, push, keep)
        if meets(place, inner, j):
            _raw_slab(raw, base, flux, low, high, j, place, near, inner, dt, push)


@threaded
def advance(out, blend, base, rate, p, raw, place, near, inner, repeats, dt, nu, push, keep):
    """Advance all components of the velocity by ``dt`` with the rates at ``rate`` and the pressure ``p``.

    ``out = keep * blend + (1 - keep) * (base + dt * rate)``. In the bodies' window the bare ``base + dt * rate``
    without the pressure goes to ``raw`` as well, an array of the window ``near``. ``repeats`` says which axes are
    periodic, ``push`` is a uniform acceleration, one number for each axis. Faces on the sides and beyond them are for
    the caller to fill.
    """
    size, block = out.shape[1] - 2 * PAD, block_of(inner)
    for n in prange((size + block - 1) // block):
        first = PAD + signed(n) * block
        j1 = min(first + block, PAD + size)
        for c in range(len(inner) + 1):
            s, e = run_of(inner, out.shape[2])
            j0, ej, ei = first, NONE, NONE
            if c == len(inner):
                ej = UNIT
                j0 = first if repeats[c] else max(first, PAD + 1)
            else:
                ei = inner[c]
                s = s if repeats[c] else s + inner[c]
            _advance(
                out[c], blend[c], base[c], rate[c], rate, p, raw[c], place, near, inner, j0, j1, s, e, ej, ei, dt, nu,
                push[c], keep,
            )  # fmt: skip
