# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision)
"""The body in the equations: second-order boundary data immersion, in cells and flow units.

Near the body the velocity is ``mu0 f + (1 - mu0) V + mu1 d(f - V)/dn``, where f is the fluid's own update, V the
body's velocity and mu0, mu1 the moments of a kernel one cell wide on either side of the surface. The pressure in f
acts on the share mu0 of a face, and on none of a face that lies between two cells on either side of a body.

Source: Maertens and Weymouth 2015, Comput. Methods Appl. Mech. Eng. 283, 106-129.
"""

import numpy as np
from numba import prange

from suchus.flow.compiled import BLOCK, UNIT, compiled, part, signed, threaded, unsigned

REACH = 3.0
"""Distance from the surface up to which normals and velocities are needed [cells]."""

LEAST_SHARE = 1e-3
"""Share of the fluid kept inside the bodies, so that the pressure equation has no pockets cut off from the rest [-]."""

THINNEST = 2.0 + 2.0**0.5
"""Thickness below which no cell is wholly inside [cells]."""

THINNEST_SHEET = 1.0
"""Thickness that a body with a line in its middle needs somewhere [cells]: from there on the added mass and work of a
plate that heaves agree within 1 % with those on three times as fine a grid; at half of it they are 7 % off."""


def wall_offset(spread: float) -> float:
    """Return how far outside the surface the immersion must act for the water to stick to the surface [cells].

    Applied step after step, the immersion lets friction pull the resting point of a linear profile into the body,
    the farther the larger the step. The fit is to the exact steady state of the discrete one-dimensional profile,
    averaged over the wall's position between the nodes: 0.03 cells at a spread of 0.001, 0.10 at 0.01, 0.27 at 0.1,
    0.35 at 0.2. Without it a cylinder has too little drag by 2 % at 32 cells a diameter. It has to follow the step
    that is taken: with the offset of another one, the force jumps by 27 % of the drag of a cylinder at Re 40 when the
    step is halved at once, and with its own by 2.3 %.

    Args:
        spread: viscosity times the step over the cell squared [-].
    """
    return float(0.66 * spread**0.4)


@part
def moment0(distance):
    """Return the share of the fluid at a signed distance [cells] from the surface, 0 inside to 1 outside."""
    if distance <= -1.0:
        return 0.0
    if distance >= 1.0:
        return 1.0
    return 0.5 * (1.0 + distance + np.sin(np.pi * distance) / np.pi)


@part
def moment1(distance):
    """Return the first moment of the kernel at a signed distance [cells] from the surface [cells]."""
    if abs(distance) >= 1.0:
        return 0.0
    turn = np.pi * distance
    return 0.25 - 0.25 * distance**2 - (distance * np.sin(turn) + (1.0 + np.cos(turn)) / np.pi) / (2.0 * np.pi)


@threaded
def fill(d, nx, ny, thickness, mu0, mu1_x, mu1_y):
    """Fill the moments of a window from signed distances, thicknesses [cells] and normals; mu1 is halved.

    The kernel sees both surfaces of a thin body. So the share that a tail of any thickness takes from the cells
    around it does not depend on how it lies between the nodes; with the nearer surface alone it does, and the force
    shakes as the tail sweeps over the grid (12 % of its rms, against 1 %).
    """
    for j in prange(d.shape[0]):
        for i in range(d.shape[1]):
            near = d[j, i]
            far = -thickness[j, i] - near
            mu0[j, i] = min(max(moment0(near) + moment0(far), LEAST_SHARE), 1.0)
            first = 0.5 * (moment1(near) - moment1(far))
            mu1_x[j, i] = first * nx[j, i]
            mu1_y[j, i] = first * ny[j, i]


@compiled
def close(passage, x, y, x0, y0, h):
    """Let the pressure not act on the faces of one direction whose two cells lie on either side of a line.

    What the kernel of a body thinner than its own width leaves to the fluid is driven through it by the pressure,
    step after step: half a cell thick, a plate that heaves has a twentieth of its added mass. No path from cell to
    cell crosses the line when these faces are closed, however it lies.

    Args:
        passage: share of the pressure's gradient that acts on the faces of a window, shape (row, face); changed.
        x: the line, across the faces; shape (point,).
        y: the line, along the rows.
        x0: the cell before the first face.
        y0: the first row.
        h: cell.
    """
    rows, faces = passage.shape
    for k in range(x.size - 1):
        ax, ay, bx, by = x[k], y[k], x[k + 1], y[k + 1]
        low, high = (ay, by) if ay < by else (by, ay)
        for j in range(max(int(np.ceil((low - y0) / h)), 0), min(int(np.ceil((high - y0) / h)), rows)):
            at = ax + (bx - ax) * (y0 + j * h - ay) / (by - ay)
            i = int(np.floor((at - x0) / h))
            if 0 <= i < faces:
                passage[j, i] = min(passage[j, i], LEAST_SHARE)


@compiled
def fill_source(source, bu, bv, cx, cy, window):
    """Write ``(1 - mu0) div V``: the divergence of the body's own motion, which the pressure leaves alone."""
    quarter = source.dtype.type(0.25)
    one = source.dtype.type(1.0)
    for j in range(window[0], window[1]):
        for i in range(window[2], window[3]):
            share = quarter * ((cx[j, i] + cx[j, i + 1]) + (cy[j, i] + cy[j + 1, i]))
            source[j, i] = (one - share) * ((bu[j, i + 1] - bu[j, i]) + (bv[j + 1, i] - bv[j, i]))


@part
def _immerse_row(out, blend, raw, b, mu0, passage, mu1_x, mu1_y, p, row, start, stop, ej, ei, dt, keep):
    j, take = unsigned(row), out.dtype.type(1.0) - keep
    low, high = j - UNIT, j + UNIT
    for k in range(unsigned(start), unsigned(stop)):
        f = raw[j, k] - b[j, k]
        slope_x = (raw[j, k + UNIT] - b[j, k + UNIT]) - (raw[j, k - UNIT] - b[j, k - UNIT])
        slope_y = (raw[high, k] - b[high, k]) - (raw[low, k] - b[low, k])
        rise = p[j, k] - p[j - ej, k - ei]
        moved = b[j, k] + mu0[j, k] * f - dt * passage[j, k] * rise + mu1_x[j, k] * slope_x + mu1_y[j, k] * slope_y
        out[j, k] = keep * blend[j, k] + take * moved


@threaded
def immerse(out, blend, raw, b, mu0, passage, mu1_x, mu1_y, p, along, window, dt, keep):
    """Write the immersed velocity of one component to the inner cells of the window.

    ``raw`` is the fluid's own update without the pressure, ``b`` the body's velocity, ``along`` 0 for u and 1 for v;
    ``out = keep * blend + (1 - keep) * (immersed - dt passage grad p)``.
    """
    none = UNIT - UNIT
    ej, ei = (none, UNIT) if along == 0 else (UNIT, none)
    rows, s, e = window[1] - window[0], window[2] + 1, window[3] - 1
    for n in prange((rows + BLOCK - 1) // BLOCK):
        block = signed(n)
        first = window[0] + block * BLOCK
        for j in range(max(first, window[0] + 1), min(first + BLOCK, window[1] - 1)):
            _immerse_row(out, blend, raw, b, mu0, passage, mu1_x, mu1_y, p, j, s, e, ej, ei, dt, keep)
