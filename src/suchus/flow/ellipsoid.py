# mypy: disable-error-code="no-untyped-def"
# (the kernels get their types from numba)
"""Distance and normal of an ellipse, and of an ellipsoid in any attitude, painted onto a window in space."""

import numpy as np
from numba import prange

from suchus.flow.compiled import compiled, part, signed, threaded

_STEPS = 12
"""Newton steps to the foot point on an ellipsoid at most [-]: with 8 the distance is right to rounding on a 20:1."""

_STILL = 1e-12
"""Change of the foot point's parameter, over the square of the smallest half-axis, at which they end [-]."""

TINY = 1e-9
"""Distance from a plane of symmetry, over the half-axis, below which a point counts as so far off it [-]."""


@part
def foot_parameter(p, a):
    """Return the parameter t of the point of an ellipse or an ellipsoid nearest to a point p in its first quadrant.

    The foot point f of a point p has ``f_i = a_i^2 p_i / (t + a_i^2)``, where t makes it lie on the surface. Newton's
    method on ``1 / |s(t)|`` with ``s_i = a_i p_i / (t + a_i^2)``, which is nearly straight, rises to that t from every
    start below it and above minus the smallest ``a_i^2``.
    """
    least, t = np.inf, -np.inf
    for d in range(len(a)):
        least = min(least, a[d] * a[d])
        t = max(t, a[d] * p[d] - a[d] * a[d])  # one term of |s| is 1 here: at or below the root
    for _ in range(_STEPS):
        square, slope = 0.0, 0.0
        for d in range(len(a)):
            below = 1.0 / (t + a[d] * a[d])
            s = a[d] * p[d] * below
            square += s * s
            slope += s * s * below
        change = (np.sqrt(square) - 1.0) * square / slope
        t += change
        if abs(change) <= _STILL * least:
            break
    return t


@part
def _foot(p, a):
    """Return the distance of a point in the first octant from an ellipsoid, and the normal there."""
    t = foot_parameter(p, a)
    nx, ny, nz = p[0] / (t + a[0] * a[0]), p[1] / (t + a[1] * a[1]), p[2] / (t + a[2] * a[2])
    size = 1.0 / np.sqrt(nx * nx + ny * ny + nz * nz)
    off = (p[0] - a[0] * a[0] * nx) * nx + (p[1] - a[1] * a[1] * ny) * ny + (p[2] - a[2] * a[2] * nz) * nz
    return off * size, nx * size, ny * size, nz * size


@part
def _chord(p, off, n, a, depth):
    """Return the shortest of the chords along the axes through the point so far inside the foot of a point."""
    deep = off + min(depth, a[0], a[1], a[2])
    x, y, z = (p[0] - deep * n[0]) / a[0], (p[1] - deep * n[1]) / a[1], (p[2] - deep * n[2]) / a[2]
    left = 1.0 - x * x - y * y - z * z
    along = a[0] * np.sqrt(max(left + x * x, 0.0))
    along = min(along, a[1] * np.sqrt(max(left + y * y, 0.0)))
    return 2.0 * min(along, a[2] * np.sqrt(max(left + z * z, 0.0)))


@part
def _paint_ellipsoid_point(out, at, away, turn, a, reach, depth):
    """Write distance, normal and thickness at one point, of its place in the body's frame; see ``paint_ellipsoid``."""
    q, j, i = at
    size, least = 0.0, min(a[0], a[1], a[2])
    for d in range(3):
        size += (away[d] / a[d]) ** 2
    bound = (np.sqrt(size) - 1.0) * least
    if abs(bound) >= reach:  # no point of the surface is nearer than this
        out[0, q, j, i] = bound
        return
    p = (max(abs(away[0]), TINY * a[0]), max(abs(away[1]), TINY * a[1]), max(abs(away[2]), TINY * a[2]))
    off, nx, ny, nz = _foot(p, a)
    out[0, q, j, i] = off
    out[7, q, j, i] = _chord(p, off, (nx, ny, nz), a, depth)
    n = (np.copysign(nx, away[0]), np.copysign(ny, away[1]), np.copysign(nz, away[2]))
    for d in range(3):
        out[1 + d, q, j, i] = turn[d, 0] * n[0] + turn[d, 1] * n[1] + turn[d, 2] * n[2]


@compiled
def measure_ellipse(out, x, y, a):
    """Write signed distance and outward normal of an ellipse with half-axes ``a`` at points, shape (3, point)."""
    for k in range(x.size):
        px, py = max(abs(x[k]), TINY * a[0]), max(abs(y[k]), TINY * a[1])
        t = foot_parameter((px, py), a)
        nx, ny = px / (t + a[0] * a[0]), py / (t + a[1] * a[1])
        size = 1.0 / np.sqrt(nx * nx + ny * ny)
        off = (px - a[0] * a[0] * nx) * nx + (py - a[1] * a[1] * ny) * ny
        out[0, k], out[1, k], out[2, k] = off * size, np.copysign(nx * size, x[k]), np.copysign(ny * size, y[k])


@threaded
def paint_ellipsoid(out, x, y, z, turn, place, velocity, spins, a, reach, depth):
    """Write distance, normal (3), velocity (3) and thickness of an ellipsoid to a window, shape (8, z, y, x).

    Args:
        out: where to; normals and thicknesses that are not reached stay as they are.
        x: coordinates of the points.
        y: coordinates of the points.
        z: coordinates of the points.
        turn: rotation matrix of the body's frame, shape (3, 3).
        place: its middle, shape (3,).
        velocity: of the middle, shape (3,).
        spins: angular velocity, shape (3,).
        a: half-axes, shape (3,).
        reach: distance up to which distance and normal are exact; beyond, the distance is at least as far off.
        depth: how far inside the surface the thickness is taken.
    """
    for n in prange(out.shape[1]):
        q = signed(n)
        dz = z[q] - place[2]
        for j in range(out.shape[2]):
            dy = y[j] - place[1]
            for i in range(out.shape[3]):
                dx = x[i] - place[0]
                out[4, q, j, i] = velocity[0] + (spins[1] * dz - spins[2] * dy)
                out[5, q, j, i] = velocity[1] + (spins[2] * dx - spins[0] * dz)
                out[6, q, j, i] = velocity[2] + (spins[0] * dy - spins[1] * dx)
                away = (
                    turn[0, 0] * dx + turn[1, 0] * dy + turn[2, 0] * dz,
                    turn[0, 1] * dx + turn[1, 1] * dy + turn[2, 1] * dz,
                    turn[0, 2] * dx + turn[1, 2] * dy + turn[2, 2] * dz,
                )
                _paint_ellipsoid_point(out, (q, j, i), away, turn, a, reach, depth)
