# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision)
"""Momentum on the staggered grid: limited QUICK advection and central diffusion, in cells and flow units.

``u[j, i]`` sits on the left face of cell (i, j), ``v[j, i]`` on its lower face; ``PAD`` rows and columns of
boundary values surround the domain. Lengths are in cells and velocities in m/s, so times are in cells per
(m/s) and the viscosity is divided by the cell size.

Sources: Leonard 1979, Comput. Methods Appl. Mech. Eng. 19, 59-98 (QUICK); Leonard 1991, ibid. 88, 17-74 (the
universal limiter).
"""

import numpy as np
from numba import prange

from suchus.flow.compiled import BLOCK, PAD, UNIT, part, signed, threaded, unsigned


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
def _fluxes(flux, o, w, side, row, start, stop, dj, di, ej, ei, viscosity):
    """Write the fluxes of ``w`` through the faces before the nodes of a row to row ``o`` of ``flux``.

    The next node is ``dj`` rows and ``di`` columns on. A face moves with the mean of ``side`` at the node and ``ej``
    rows and ``ei`` columns before it; ``viscosity`` in cells x m/s.
    """
    o, j, half = unsigned(o), unsigned(row), flux.dtype.type(0.5)
    for k in range(unsigned(start), unsigned(stop)):
        # loaded first: a choice of loads is a branch
        a, b, c, d = w[j - dj - dj, k - di - di], w[j - dj, k - di], w[j, k], w[j + dj, k + di]
        speed = half * (side[j - ej, k - ei] + side[j, k])
        forth = speed > 0
        face = limited_quick(a if forth else d, b if forth else c, c if forth else b)
        flux[o, k] = speed * face - viscosity * (c - b)


@part
def _update_row(out, blend, base, flux, low, high, p, row, start, stop, ej, ei, dt, push, keep):
    """Write ``keep * blend + (1 - keep) * (base + dt * (net flux + push - pressure gradient))``."""
    j, low, high, take = unsigned(row), unsigned(low), unsigned(high), out.dtype.type(1.0) - keep
    for k in range(unsigned(start), unsigned(stop)):
        net = flux[0, k] - flux[0, k + UNIT] + flux[low, k] - flux[high, k]
        rate = net + push - (p[j, k] - p[j - ej, k - ei])
        out[j, k] = keep * blend[j, k] + take * (base[j, k] + dt * rate)


@part
def _raw_row(raw, base, flux, low, high, row, start, stop, dt, push):
    """Write ``base + dt * (net flux + push)``: what the body is then immersed in."""
    j, low, high = unsigned(row), unsigned(low), unsigned(high)
    for k in range(unsigned(start), unsigned(stop)):
        raw[j, k] = base[j, k] + dt * (flux[0, k] - flux[0, k + UNIT] + flux[low, k] - flux[high, k] + push)


@part
def _advance(out, blend, base, w, u, v, p, raw, window, j0, j1, s, e, ej, ei, dt, nu, push, keep):
    """Advance rows ``j0`` to ``j1``, columns ``s`` to ``e`` of one component ``w``, whose axis is (``ej``, ``ei``)."""
    none = UNIT - UNIT
    flux = np.empty((3, u.shape[1]), u.dtype)
    low, high = 1, 2
    _fluxes(flux, high, w, v, j0, s, e, UNIT, none, ej, ei, nu)
    for j in range(j0, j1):
        low, high = high, low
        _fluxes(flux, 0, w, u, j, s, e + 1, none, UNIT, ej, ei, nu)
        _fluxes(flux, high, w, v, j + 1, s, e, UNIT, none, ej, ei, nu)
        _update_row(out, blend, base, flux, low, high, p, j, s, e, ej, ei, dt, push, keep)
        if window[0] <= j < window[1]:
            _raw_row(raw, base, flux, low, high, j, window[2], window[3], dt, push)


@threaded
def advance(
    out_u, out_v, blend_u, blend_v, base_u, base_v, u, v, p, raw_u, raw_v, window, periodic, dt, nu, push, keep
):
    """Advance both velocities by ``dt`` with the rates at (``u``, ``v``) and the pressure ``p``.

    ``out = keep * blend + (1 - keep) * (base + dt * rate)``. In the body's ``window`` (j0, j1, i0, i1) the bare
    ``base + dt * rate`` without the pressure goes to ``raw`` as well. ``periodic`` is (x, y), ``push`` a
    uniform acceleration (x, y).
    """
    none = UNIT - UNIT
    ny, end = u.shape[0] - 2 * PAD, u.shape[1] - PAD
    su = PAD if periodic[0] else PAD + 1
    sv = PAD if periodic[1] else PAD + 1
    for n in prange((ny + BLOCK - 1) // BLOCK):
        block = signed(n)
        j0 = PAD + block * BLOCK
        j1 = min(j0 + BLOCK, PAD + ny)
        _advance(out_u, blend_u, base_u, u, u, v, p, raw_u, window, j0, j1, su, end, none, UNIT, dt, nu, push[0], keep)
        _advance(
            out_v, blend_v, base_v, v, u, v, p, raw_v, window, max(j0, sv), j1, PAD, end, UNIT, none, dt, nu, push[1],
            keep,
        )  # fmt: skip
