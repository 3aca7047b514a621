"""Exact volumes under a plane of cylinders, capsules and polyhedra, with the plane's cut through them.

Each function returns ``Immersion`` in the frame of the shape, whose origin is the shape's centre. The plane is the set
of points r with n . r = h. Volume V and its first moment give buoyancy; the area S of the cut is dV/dh, and its first
moment gives the change of V when the shape turns.
"""

from math import acos, asin, pi, sqrt
from typing import NamedTuple

import numpy as np

from suchus.sim.hydro.vectors import Vector, compile_inline

_FLAT = 1e-9
"""Least sine between a shape's axis and the plane's normal; below, the axis counts as slanted by as much [-]."""
_NARROW = 1e-3
"""Range of relative depths along a cylinder below which its slices are summed by Gauss's rule [-]."""
_GAUSS = 0.7745966692414834
"""Outer nodes of Gauss's rule of three points [-]."""


class Immersion(NamedTuple):
    """What of a shape is under a plane, and the plane's cut through the shape, in the frame of the shape."""

    volume: float
    """[m3]."""
    moment: Vector
    """First moment of that volume about the centre of the shape [m4]."""
    area: float
    """Area of the cut [m2]."""
    area_moment: Vector
    """First moment of the cut about the centre of the shape [m3]."""


@compile_inline
def _segment(s: float) -> tuple[float, float, float]:
    """Return area, first moment and chord of a unit disc's segment below the ordinate s, clamped to -1 to 1."""
    s = min(max(s, -1.0), 1.0)
    half_chord = sqrt(1.0 - s * s)
    return 0.5 * pi + asin(s) + s * half_chord, -2.0 / 3.0 * half_chord**3, 2.0 * half_chord


@compile_inline
def _segment_integrals(s: float) -> tuple[float, float, float, float, float]:
    """Return integrals over s, from -1 on, of a unit disc's segment below the ordinate s.

    They are those of the area, of the ordinate times the area, of the first moment, of the chord, and of the ordinate
    times the chord. Beyond 1 the area stays that of the disc.
    """
    c = min(max(s, -1.0), 1.0)
    half_chord = sqrt(1.0 - c * c)
    cube, angle = half_chord**3, asin(c) + 0.5 * pi
    area = angle + c * half_chord
    beyond = max(s - 1.0, 0.0)
    of_area = c * area + 2.0 / 3.0 * cube + pi * beyond
    of_weighted = 0.5 * c * c * area - 0.125 * (angle - c * half_chord * (1.0 - 2.0 * c * c))
    of_weighted += 0.5 * pi * beyond * (beyond + 2.0)
    of_moment = -2.0 / 3.0 * (0.25 * c * cube + 0.375 * (c * half_chord + angle))
    return of_area, of_weighted, of_moment, area, -2.0 / 3.0 * cube


@compile_inline
def cylinder(radius: float, half: float, normal: Vector, height: float) -> Immersion:
    """Return what of a round cylinder along t is under a plane.

    Args:
        radius: [m].
        half: half its length [m].
        normal: unit normal of the plane, along a, b, t.
        height: distance of the plane from the centre along the normal [m].
    """
    axial, slant = normal[2], max(sqrt(normal[0] * normal[0] + normal[1] * normal[1]), _FLAT)
    scale = radius * slant
    low, high = (height + axial * half) / scale, (height - axial * half) / scale
    # the slice at t has the relative depth s = (height - axial t) / scale: low at the rear end, high at the front end
    volume, moment_y, moment_t, area, area_y, area_t = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if abs(high - low) < _NARROW:
        for i in range(-1, 2):
            t = i * _GAUSS * half
            weight = half * (8.0 / 9.0 if i == 0 else 5.0 / 9.0)
            s = min(max((height - axial * t) / scale, -1.0), 1.0)
            part, part_moment, chord = _segment(s)
            volume += weight * part
            moment_y += weight * part_moment
            moment_t += weight * part * t
            area += weight * chord
            area_y += weight * chord * s
            area_t += weight * chord * t
    else:
        first, last = _segment_integrals(low), _segment_integrals(high)
        step = -scale / axial  # dt = step ds
        of_area, of_weighted, of_moment = last[0] - first[0], last[1] - first[1], last[2] - first[2]
        of_chord, of_weighted_chord = last[3] - first[3], last[4] - first[4]
        volume, moment_y = step * of_area, step * of_moment
        moment_t = step * (height * of_area - scale * of_weighted) / axial
        area, area_y = step * of_chord, step * of_weighted_chord
        area_t = step * (height * of_chord - scale * of_weighted_chord) / axial
    square, width = radius * radius, radius / slant
    across = (normal[0] / slant, normal[1] / slant)
    y, cut_y = square * radius * moment_y, width * radius * area_y
    return Immersion(
        square * volume, (across[0] * y, across[1] * y, square * moment_t),
        width * area, (across[0] * cut_y, across[1] * cut_y, width * area_t),
    )  # fmt: skip


@compile_inline
def _polar(s: float) -> float:
    """Return the polar second moment, about its centre, of a unit disc's segment below the ordinate s."""
    half_chord, angle = sqrt(1.0 - s * s), asin(s) + 0.5 * pi
    across = 0.25 * (angle - s * half_chord * (1.0 - 2.0 * s * s))
    return across + 2.0 / 3.0 * (0.25 * s * half_chord**3 + 0.375 * (s * half_chord + angle))


@compile_inline
def half_ball(axial: float, slant: float, height: float) -> tuple[float, float, float, float, float, float]:
    """Return what of a unit half ball is under a plane: volume, its moments, area of the cut, its moments.

    The half ball is that side of the plane through the ball's centre, the origin, to which the axis points. Moments are
    along the axis, and along the direction across it that is nearest to the plane's normal. The area of the spherical
    part follows from the theorem of Gauss and Bonnet; volume and moments from Gauss's theorem.

    Args:
        axial: cosine between the axis and the plane's normal.
        slant: sine between them, above 0.
        height: distance of the plane from the ball's centre along the normal.
    """
    h = min(max(height, -1.0), 1.0)
    radius_squared = 1.0 - h * h
    radius = sqrt(radius_squared)
    if radius > 0.0:
        s, tilt = h * axial / (slant * radius), axial / radius
    else:
        s, tilt = h * axial * 1e300, axial * 1e300
    s, tilt = min(max(s, -1.0), 1.0), min(max(tilt, -1.0), 1.0)
    cut, cut_moment, _ = _segment(s)
    cut, cut_moment = radius_squared * cut, -radius_squared * radius * cut_moment
    edge = min(max(h / slant, -1.0), 1.0)
    base = _segment(edge)[0]
    sphere = 2.0 * acos(tilt) + 2.0 * (asin(s) + 0.5 * pi) * h
    volume = (sphere + h * cut) / 3.0
    along_normal = 0.5 * ((h * h - 1.0) * cut + radius_squared * radius_squared * _polar(s))
    along_axis = 0.5 * (base - _polar(edge))
    return (
        volume, along_normal * axial + along_axis, along_normal * slant,
        cut, h * cut * axial + cut_moment * slant, h * cut * slant - cut_moment * axial,
    )  # fmt: skip


@compile_inline
def capsule(radius: float, half: float, normal: Vector, height: float) -> Immersion:
    """Return what of a capsule along t is under a plane.

    Args:
        radius: [m].
        half: half the length of its cylinder [m].
        normal: unit normal of the plane, along a, b, t.
        height: distance of the plane from the centre along the normal [m].
    """
    tube = cylinder(radius, half, normal, height)
    axial, slant = normal[2], max(sqrt(normal[0] * normal[0] + normal[1] * normal[1]), _FLAT)
    square, volume, area = radius * radius, tube.volume, tube.area
    moment_y, moment_t, area_y, area_t = 0.0, tube.moment[2], 0.0, tube.area_moment[2]
    for side in (-1.0, 1.0):
        v, vt, vy, s, st, sy = half_ball(side * axial, slant, (height - side * half * axial) / radius)
        v, s = v * square * radius, s * square
        volume += v
        area += s
        moment_t += side * (vt * square * square + half * v)
        moment_y += vy * square * square
        area_t += side * (st * square * radius + half * s)
        area_y += sy * square * radius
    a, b = normal[0] / slant, normal[1] / slant
    return Immersion(
        volume, (tube.moment[0] + a * moment_y, tube.moment[1] + b * moment_y, moment_t),
        area, (tube.area_moment[0] + a * area_y, tube.area_moment[1] + b * area_y, area_t),
    )  # fmt: skip


@compile_inline
def _add_triangle(sums: np.ndarray, p: Vector, q: Vector, r: Vector, zs: Vector, normal: Vector) -> None:
    """Add the integrals of a triangle under the plane: see ``polyhedron``."""
    ux, uy, uz = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    vx, vy, vz = r[0] - p[0], r[1] - p[1], r[2] - p[2]
    facing = normal[0] * (uy * vz - uz * vy) + normal[1] * (uz * vx - ux * vz) + normal[2] * (ux * vy - uy * vx)
    area = 0.5 * facing
    total = zs[0] + zs[1] + zs[2]
    sums[0] += area * total / 3.0
    sums[4] += area
    for i in range(3):
        points = p[i] + q[i] + r[i]
        sums[1 + i] += area / 12.0 * (points * total + p[i] * zs[0] + q[i] * zs[1] + r[i] * zs[2])
        sums[5 + i] += area * points / 3.0


@compile_inline
def _between(p: Vector, q: Vector, zp: float, zq: float) -> Vector:
    """Return the point between two points of depths of unlike signs that is on the plane."""
    f = zp / (zp - zq)
    return p[0] + f * (q[0] - p[0]), p[1] + f * (q[1] - p[1]), p[2] + f * (q[2] - p[2])


@compile_inline
def polyhedron(triangles: np.ndarray, normal: Vector, height: float) -> Immersion:
    """Return what of a closed surface of triangles is under a plane.

    With z = n . r - h the cut contributes nothing to the integrals of z n . dA over the surface under the plane, so
    that the cut need not be closed: they are the volume, and with r and z their first moments. The integral of n . dA
    alone is minus the area of the cut.

    Args:
        triangles: corners, counterclockwise seen from outside, shape (triangle, 9) [m].
        normal: unit normal of the plane, in the frame of the triangles.
        height: distance of the plane from the origin along the normal [m].
    """
    sums = np.zeros(8)
    for row in triangles:
        p, q, r = (row[0], row[1], row[2]), (row[3], row[4], row[5]), (row[6], row[7], row[8])
        zp = normal[0] * p[0] + normal[1] * p[1] + normal[2] * p[2] - height
        zq = normal[0] * q[0] + normal[1] * q[1] + normal[2] * q[2] - height
        zr = normal[0] * r[0] + normal[1] * r[1] + normal[2] * r[2] - height
        count = (zp < 0.0) + (zq < 0.0) + (zr < 0.0)
        if count == 0:
            continue
        if count == 3:
            _add_triangle(sums, p, q, r, (zp, zq, zr), normal)
            continue
        # turn the triangle so that its first corner is alone on its side
        if ((zq < 0.0) != (zp < 0.0)) and ((zq < 0.0) != (zr < 0.0)):
            p, q, r, zp, zq, zr = q, r, p, zq, zr, zp
        elif ((zr < 0.0) != (zp < 0.0)) and ((zr < 0.0) != (zq < 0.0)):
            p, q, r, zp, zq, zr = r, p, q, zr, zp, zq
        pq, pr = _between(p, q, zp, zq), _between(p, r, zp, zr)
        if count == 1:
            _add_triangle(sums, p, pq, pr, (zp, 0.0, 0.0), normal)
        else:
            _add_triangle(sums, pq, q, r, (0.0, zq, zr), normal)
            _add_triangle(sums, pq, r, pr, (0.0, zr, 0.0), normal)
    volume, area = sums[0], -sums[4]
    first = normal[0] * sums[1] + normal[1] * sums[2] + normal[2] * sums[3]
    excess = 0.5 * (first - height * volume)
    along = normal[0] * sums[5] + normal[1] * sums[6] + normal[2] * sums[7]
    shift = along + height * area
    return Immersion(
        volume,
        (sums[1] - excess * normal[0], sums[2] - excess * normal[1], sums[3] - excess * normal[2]),
        area,
        (-sums[5] + shift * normal[0], -sums[6] + shift * normal[1], -sums[7] + shift * normal[2]),
    )
