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

from suchus.flow.compiled import BLOCK, PAD, compiled, threaded


@compiled
def median(a, b, c):
    """Return the middle one of three numbers."""
    low = a if a < b else b
    high = a if a > b else b
    capped = high if high < c else c
    return low if low > capped else capped


@compiled
def limited_quick(upstream, centre, downstream):
    """Return the face value: QUICK, kept monotone between its neighbours."""
    real = type(centre)
    quick = real(0.75) * centre + real(0.375) * downstream - real(0.125) * upstream
    steepest = real(10.0) * centre - real(9.0) * upstream
    return median(quick, centre, median(steepest, centre, downstream))


@compiled
def flux_row(flux, speed_a, speed_b, far_below, below, above, far_above, viscosity):
    """Write the flux through a row of faces that lie between ``below`` and ``above``.

    The face moves with the mean of ``speed_a`` and ``speed_b``; ``viscosity`` in cells x m/s.
    """
    half = flux.dtype.type(0.5)
    for k in range(flux.size):
        a, b, c, d = far_below[k], below[k], above[k], far_above[k]  # loaded first: a choice of loads is a branch
        speed = half * (speed_a[k] + speed_b[k])
        forth = limited_quick(a, b, c)
        back = limited_quick(d, c, b)
        flux[k] = speed * (forth if speed > 0 else back) - viscosity * (c - b)


@compiled
def _update_row(out, blend, base, left, right, low, high, p_here, p_before, dt, push, keep):
    """Write ``keep * blend + (1 - keep) * (base + dt * (net flux + push - pressure gradient))``."""
    take = out.dtype.type(1.0) - keep
    for k in range(out.size):
        rate = left[k] - right[k] + low[k] - high[k] + push - (p_here[k] - p_before[k])
        out[k] = keep * blend[k] + take * (base[k] + dt * rate)


@compiled
def _raw_row(raw, base, left, right, low, high, dt, push):
    """Write ``base + dt * (net flux + push)``: what the body is then immersed in."""
    for k in range(raw.size):
        raw[k] = base[k] + dt * (left[k] - right[k] + low[k] - high[k] + push)


@compiled
def _advance_u(out, blend, base, u, v, p, raw, window, j0, j1, s, e, dt, nu, push, keep):
    n = e - s
    across = np.empty(n + 1, u.dtype)
    low = np.empty(n, u.dtype)
    high = np.empty(n, u.dtype)
    wj0, wj1, wi0, wi1 = window[0], window[1], window[2], window[3]
    for j in range(j0, j1 + 1):
        low, high = high, low
        flux_row(high, v[j, s - 1 : e - 1], v[j, s:e], u[j - 2, s:e], u[j - 1, s:e], u[j, s:e], u[j + 1, s:e], nu)
        if j == j0:
            continue
        r = j - 1
        a, b = s - 1, e
        row = u[r]
        flux_row(
            across,
            row[a:b],
            row[a + 1 : b + 1],
            row[a - 1 : b - 1],
            row[a:b],
            row[a + 1 : b + 1],
            row[a + 2 : b + 2],
            nu,
        )
        _update_row(
            out[r, s:e],
            blend[r, s:e],
            base[r, s:e],
            across[:n],
            across[1:],
            low,
            high,
            p[r, s:e],
            p[r, s - 1 : e - 1],
            dt,
            push,
            keep,
        )
        if wj0 <= r < wj1:
            f, t = wi0 - s, wi1 - s
            _raw_row(
                raw[r, wi0:wi1], base[r, wi0:wi1], across[f:t], across[f + 1 : t + 1], low[f:t], high[f:t], dt, push
            )


@compiled
def _advance_v(out, blend, base, u, v, p, raw, window, j0, j1, s, e, dt, nu, push, keep):
    n = e - s
    across = np.empty(n + 1, u.dtype)
    low = np.empty(n, u.dtype)
    high = np.empty(n, u.dtype)
    wj0, wj1, wi0, wi1 = window[0], window[1], window[2], window[3]
    for c in range(j0 - 1, j1):
        low, high = high, low
        flux_row(high, v[c, s:e], v[c + 1, s:e], v[c - 1, s:e], v[c, s:e], v[c + 1, s:e], v[c + 2, s:e], nu)
        if c == j0 - 1:
            continue
        a, b = s, e + 1
        row = v[c]
        flux_row(
            across, u[c - 1, a:b], u[c, a:b], row[a - 2 : b - 2], row[a - 1 : b - 1], row[a:b], row[a + 1 : b + 1], nu
        )
        _update_row(
            out[c, s:e],
            blend[c, s:e],
            base[c, s:e],
            across[:n],
            across[1:],
            low,
            high,
            p[c, s:e],
            p[c - 1, s:e],
            dt,
            push,
            keep,
        )
        if wj0 <= c < wj1:
            f, t = wi0 - s, wi1 - s
            _raw_row(
                raw[c, wi0:wi1], base[c, wi0:wi1], across[f:t], across[f + 1 : t + 1], low[f:t], high[f:t], dt, push
            )


@threaded
def advance(
    out_u, out_v, blend_u, blend_v, base_u, base_v, u, v, p, raw_u, raw_v, window, periodic, dt, nu, push, keep
):
    """Advance both velocities by ``dt`` with the rates at (``u``, ``v``) and the pressure ``p``.

    ``out = keep * blend + (1 - keep) * (base + dt * rate)``. In the body's ``window`` (j0, j1, i0, i1) the bare
    ``base + dt * rate`` without the pressure goes to ``raw`` as well. ``periodic`` is (x, y), ``push`` a
    uniform acceleration (x, y).
    """
    ny, nx = u.shape[0] - 2 * PAD, u.shape[1] - 2 * PAD
    su = PAD if periodic[0] else PAD + 1
    sv = PAD if periodic[1] else PAD + 1
    end = PAD + ny
    for block in prange((ny + BLOCK - 1) // BLOCK):
        j0 = PAD + block * BLOCK
        j1 = min(j0 + BLOCK, end)
        _advance_u(out_u, blend_u, base_u, u, v, p, raw_u, window, j0, j1, su, PAD + nx, dt, nu, push[0], keep)
        _advance_v(
            out_v, blend_v, base_v, u, v, p, raw_v, window, max(j0, sv), j1, PAD, PAD + nx, dt, nu, push[1], keep
        )
