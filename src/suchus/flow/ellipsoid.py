# mypy: disable-error-code="no-untyped-def"
# (the kernels get their types from numba)
"""Distance and normal of an ellipse, and of an ellipsoid in any attitude, painted onto a window in space."""

import numpy as np
from numba import prange

from suchus.flow.compiled import compiled, kernel_part, signed, threaded

_MAX_STEPS = 12
"""Largest number of Newton steps [-]: with 8 the distance is exact to rounding on an ellipsoid of aspect ratio 20."""

_STEP_TOLERANCE = 1e-12
"""Change of the foot point's parameter, over the square of the smallest half-axis, at which the steps end [-]."""

TINY = 1e-9
"""Least distance of a point from a plane of symmetry, over the half-axis; smaller ones are set to it [-]."""


@kernel_part
def foot_parameter(p, a):
    """Return the parameter t of the point of an ellipse or an ellipsoid nearest to a point p in its first quadrant.

    The foot point f of a point p has ``f_i = a_i^2 p_i / (t + a_i^2)``, where t makes it lie on the surface. Newton's
    method on ``1 / |s(t)|`` with ``s_i = a_i p_i / (t + a_i^2)``, which is nearly straight, rises to that t from every
    start below it and above minus the smallest ``a_i^2``.

    Args:
        p: coordinates of the point along the half-axes, none negative.
        a: half-axes.
    """
    min_square, t = np.inf, -np.inf
    for d in range(len(a)):
        min_square = min(min_square, a[d] * a[d])
        t = max(t, a[d] * p[d] - a[d] * a[d])  # one term of |s| is 1 here: at or below the root
    for _ in range(_MAX_STEPS):
        square, slope = 0.0, 0.0
        for d in range(len(a)):
            inverse = 1.0 / (t + a[d] * a[d])
            s = a[d] * p[d] * inverse
            square += s * s
            slope += s * s * inverse
        change = (np.sqrt(square) - 1.0) * square / slope
        t += change
        if abs(change) <= _STEP_TOLERANCE * min_square:
            break
    return t


@kernel_part
def _foot(p, a):
    """Return the distance of a point in the first octant from an ellipsoid, and the normal there.

    Args:
        p: coordinates of the point along the half-axes, none negative.
        a: half-axes.
    """
    t = foot_parameter(p, a)
    nx, ny, nz = p[0] / (t + a[0] * a[0]), p[1] / (t + a[1] * a[1]), p[2] / (t + a[2] * a[2])
    size = 1.0 / np.sqrt(nx * nx + ny * ny + nz * nz)
    distance = (p[0] - a[0] * a[0] * nx) * nx + (p[1] - a[1] * a[1] * ny) * ny + (p[2] - a[2] * a[2] * nz) * nz
    return distance * size, nx * size, ny * size, nz * size


@kernel_part
def _chord(p, distance, n, a, depth):
    """Return the thickness at a point: the shortest chord along the three axes, ``depth`` inside the surface.

    Args:
        p: coordinates of the point along the half-axes, none negative.
        distance: signed distance of the point from the surface.
        n: normal at the nearest point of the surface.
        a: half-axes.
        depth: how far inside the surface the chords are taken.
    """
    offset = distance + min(depth, a[0], a[1], a[2])
    x, y, z = (p[0] - offset * n[0]) / a[0], (p[1] - offset * n[1]) / a[1], (p[2] - offset * n[2]) / a[2]
    remainder = 1.0 - x * x - y * y - z * z
    half_chord = a[0] * np.sqrt(max(remainder + x * x, 0.0))
    half_chord = min(half_chord, a[1] * np.sqrt(max(remainder + y * y, 0.0)))
    return 2.0 * min(half_chord, a[2] * np.sqrt(max(remainder + z * z, 0.0)))


@kernel_part
def _paint_ellipsoid_point(window_field, index, offset, turn, a, reach, depth):
    """Write distance, normal and thickness at one point; see ``paint_ellipsoid``.

    Args:
        window_field: see ``paint_ellipsoid``.
        index: indices of the point along z, y and x.
        offset: coordinates of the point in the body's frame.
        turn: rotation matrix of the body's frame, shape (3, 3).
        a: half-axes.
        reach: see ``paint_ellipsoid``.
        depth: see ``paint_ellipsoid``.
    """
    q, j, i = index
    size, min_axis = 0.0, min(a[0], a[1], a[2])
    for d in range(3):
        size += (offset[d] / a[d]) ** 2
    bound = (np.sqrt(size) - 1.0) * min_axis
    if abs(bound) >= reach:  # no point of the surface is nearer than this
        window_field[0, q, j, i] = bound
        return
    p = (max(abs(offset[0]), TINY * a[0]), max(abs(offset[1]), TINY * a[1]), max(abs(offset[2]), TINY * a[2]))
    distance, nx, ny, nz = _foot(p, a)
    window_field[0, q, j, i] = distance
    window_field[7, q, j, i] = _chord(p, distance, (nx, ny, nz), a, depth)
    n = (np.copysign(nx, offset[0]), np.copysign(ny, offset[1]), np.copysign(nz, offset[2]))
    for d in range(3):
        window_field[1 + d, q, j, i] = turn[d, 0] * n[0] + turn[d, 1] * n[1] + turn[d, 2] * n[2]


@compiled
def measure_ellipsoid(point_field, points, a):
    """Write signed distance and outward normal of an ellipse or an ellipsoid at points.

    Args:
        point_field: array to write to, shape (1 + axis, point).
        points: coordinates along the half-axes, shape (axis, point).
        a: half-axes, shape (axis,).
    """
    p = np.empty(len(a))
    for k in range(points.shape[1]):
        for d in range(len(a)):
            p[d] = max(abs(points[d, k]), TINY * a[d])
        t = foot_parameter(p, a)
        square, distance = 0.0, 0.0
        for d in range(len(a)):
            normal = p[d] / (t + a[d] * a[d])
            square += normal * normal
            distance += (p[d] - a[d] * a[d] * normal) * normal
        size = 1.0 / np.sqrt(square)
        point_field[0, k] = distance * size
        for d in range(len(a)):
            point_field[1 + d, k] = np.copysign(p[d] / (t + a[d] * a[d]) * size, points[d, k])


@threaded
def paint_ellipsoid(window_field, x, y, z, turn, centre, velocity, spins, a, reach, depth):
    """Write distance, normal (3), velocity (3) and thickness of an ellipsoid to a window, shape (8, z, y, x).

    Args:
        window_field: array to write to; normals and thicknesses beyond ``reach`` stay as they are.
        x: coordinates of the points.
        y: coordinates of the points.
        z: coordinates of the points.
        turn: rotation matrix of the body's frame, shape (3, 3).
        centre: middle of the ellipsoid, shape (3,).
        velocity: velocity of the middle, shape (3,).
        spins: angular velocity, shape (3,).
        a: half-axes, shape (3,).
        reach: distance up to which distance and normal are exact; beyond, the distance is at least as far off.
        depth: how far inside the surface the thickness is taken.
    """
    for n in prange(window_field.shape[1]):
        q = signed(n)
        dz = z[q] - centre[2]
        for j in range(window_field.shape[2]):
            dy = y[j] - centre[1]
            for i in range(window_field.shape[3]):
                dx = x[i] - centre[0]
                window_field[4, q, j, i] = velocity[0] + (spins[1] * dz - spins[2] * dy)
                window_field[5, q, j, i] = velocity[1] + (spins[2] * dx - spins[0] * dz)
                window_field[6, q, j, i] = velocity[2] + (spins[0] * dy - spins[1] * dx)
                offset = (
                    turn[0, 0] * dx + turn[1, 0] * dy + turn[2, 0] * dz,
                    turn[0, 1] * dx + turn[1, 1] * dy + turn[2, 1] * dz,
                    turn[0, 2] * dx + turn[1, 2] * dy + turn[2, 2] * dz,
                )
                _paint_ellipsoid_point(window_field, (q, j, i), offset, turn, a, reach, depth)
