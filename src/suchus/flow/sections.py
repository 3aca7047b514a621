# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba)
"""Distance, normal and velocity of a trunk, a bent midline with elliptic sections, painted onto a window in space.

The midline lies in a plane, so the section that holds a point is the same for a whole column of points. In it lies the
foot of the point on the ellipse. Along the body the outline that belongs to the foot's place on the ellipse is a line
through the same place of the neighbouring sections, and the distance is that to this line: right at round and at flat
ends, and exact for a straight body of round sections.
"""

import numpy as np
from numba import prange

from suchus.flow.compiled import part, signed, threaded
from suchus.flow.ellipsoid import TINY, foot_parameter
from suchus.flow.paint import find_section, section_velocity

X, Y, HEADING, WIDE, X_RATE, Y_RATE, TURN, HIGH, SWELL, ARC = range(10)
"""Rows of the stations: those of ``MidlineState.rows``, then half-height, rate of the half-width, and arc length."""

PAINTED = 8
"""Values painted at each point: distance, normal (3), velocity (2), thickness, which part of the body [-]."""

_STRIDE = 4
"""Stations from one to the next of those that the nearest one is looked for among first [-]."""

_LEAST = 1e-9
"""Half-axis, over the cell, below which a section is taken for a point [-]."""


@part
def ellipse_foot(y, z, wide, high):
    """Return where on an ellipse the point nearest to (y, z) is, as cosine and sine of its angle."""
    p = max(abs(y), TINY * wide), max(abs(z), TINY * high)
    t = foot_parameter(p, (wide, high))
    c, s = wide * p[0] / (t + wide * wide), high * p[1] / (t + high * high)
    size = np.sqrt(c * c + s * s)
    return np.copysign(c / size, y), np.copysign(s / size, z)


@part
def _nearest_station(px, py, rows, first, end, stride):
    """Return which of some stations is nearest to a column, and the square of its distance."""
    nearest, square = first, np.inf
    for m in range(first, end, stride):
        d2 = (px - rows[X, m]) ** 2 + (py - rows[Y, m]) ** 2
        if d2 < square:
            nearest, square = m, d2
    return nearest, square


@part
def _column(px, py, rows, tx, ty):
    """Return segment and share of the section that holds a column, its offset to the side, and what it lies beyond."""
    about, _ = _nearest_station(px, py, rows, 0, rows.shape[1], _STRIDE)
    first, end = max(about - _STRIDE, 0), min(about + _STRIDE + 1, rows.shape[1])
    nearest, _ = _nearest_station(px, py, rows, first, end, 1)
    k, f = find_section(px, py, min(nearest, rows.shape[1] - 2), rows[X], rows[Y], tx, ty)
    g = 1.0 - f
    dx, dy = px - g * rows[X, k] - f * rows[X, k + 1], py - g * rows[Y, k] - f * rows[Y, k + 1]
    cos, sin = g * tx[k] + f * tx[k + 1], g * ty[k] + f * ty[k + 1]
    size = np.sqrt(cos * cos + sin * sin)
    cos, sin = cos / size, sin / size
    beyond = dx * cos + dy * sin
    beyond = min(beyond, 0.0) if k == 0 and f == 0.0 else max(beyond, 0.0) if f == 1.0 else 0.0
    return k, f, -dx * sin + dy * cos, beyond, cos, sin


@part
def _growth(k, at, wide, high, rows, reach):
    """Return by how much a section within reach is wider and higher than the one at an arc length, together."""
    grown_wide, grown_high, last = wide, high, rows.shape[1] - 1
    m = k
    while m >= 0 and at - rows[ARC, m] <= reach:
        grown_wide, grown_high = max(grown_wide, rows[WIDE, m]), max(grown_high, rows[HIGH, m])
        m -= 1
    m = k + 1
    while m <= last and rows[ARC, m] - at <= reach:
        grown_wide, grown_high = max(grown_wide, rows[WIDE, m]), max(grown_high, rows[HIGH, m])
        m += 1
    return grown_wide - wide + grown_high - high


@part
def _to_edge(away, best, a0, r0, a1, r1):
    """Return the nearest vector so far from an outline to the point (0, away), after one more edge of it.

    ``best`` is the vector before: along, across, the square of its length, and the edge along and across.
    """
    ea, er = a1 - a0, r1 - r0
    square = ea * ea + er * er
    if square == 0.0:
        return best
    share = min(max((-a0 * ea + (away - r0) * er) / square, 0.0), 1.0)
    da, dr = -a0 - share * ea, away - r0 - share * er
    d2 = da * da + dr * dr
    return (da, dr, d2, ea, er) if d2 < best[2] else best


@part
def _outline_of(m, rows, c, s, ny, nz, fy, fz):
    """Return how far out the place of an angle lies in a section, from its place in the point's own section."""
    return ny * (rows[WIDE, m] * c - fy) + nz * (rows[HIGH, m] * s - fz)


@part
def _nearest(k, at, away, stretch, rows, c, s, ny, nz, fy, fz, reach):
    """Return the vector from the outline through the sections to the point, as ``_to_edge`` does."""
    last = rows.shape[1] - 1
    best, farthest = (0.0, 0.0, np.inf, 1.0, 0.0), reach * reach
    for way in (1, -1):
        m = k
        a, r = (rows[ARC, m] - at) * stretch, _outline_of(m, rows, c, s, ny, nz, fy, fz)
        while True:
            if (m == last and way > 0) or (m == 0 and way < 0):  # the end's own face
                axis = -ny * fy - nz * fz
                best = _to_edge(away, best, a, r, a, axis) if way > 0 else _to_edge(away, best, a, axis, a, r)
                break
            if a * a > min(best[2], farthest) and not (way > 0 and m == k):
                break
            b, t = (rows[ARC, m + way] - at) * stretch, _outline_of(m + way, rows, c, s, ny, nz, fy, fz)
            best = _to_edge(away, best, a, r, b, t) if way > 0 else _to_edge(away, best, b, t, a, r)
            m, a, r = m + way, b, t
    return best


@part
def _chord(at, k, rows, c, s, ny, nz, depth):
    """Return the smaller chord through the point so far inside a place of the section at an arc length."""
    last = rows.shape[1] - 2
    while k > 0 and rows[ARC, k] > at:
        k -= 1
    while k < last and rows[ARC, k + 1] < at:
        k += 1
    span = rows[ARC, k + 1] - rows[ARC, k]
    f = min(max((at - rows[ARC, k]) / span, 0.0), 1.0) if span > 0.0 else 0.0
    wide = (1.0 - f) * rows[WIDE, k] + f * rows[WIDE, k + 1]
    high = (1.0 - f) * rows[HIGH, k] + f * rows[HIGH, k + 1]
    if wide <= 0.0 or high <= 0.0:
        return 0.0
    inside = min(depth, wide, high)
    y, z = c - ny * inside / wide, s - nz * inside / high
    return 2.0 * min(wide * np.sqrt(max(1.0 - z * z, 0.0)), high * np.sqrt(max(1.0 - y * y, 0.0)))


@part
def _paint_point(out, place, px, py, z, column, section, rows, h):
    """Write what ``paint_sections`` paints for one point whose column and section are known."""
    (q, j, i), (k, f, y, beyond, cos, sin), (at, part_of, wide, high, reach) = place, column, section
    if np.sqrt(y * y + z * z) >= max(wide, high) + reach:  # the ellipse lies in the circle around it
        return
    wide, high = max(wide, _LEAST * h), max(high, _LEAST * h)
    c, s = ellipse_foot(y, z, wide, high)
    fy, fz, ny, nz = wide * c, high * s, c / wide, s / high
    size = np.sqrt(ny * ny + nz * nz)
    ny, nz = ny / size, nz / size
    away = (y - fy) * ny + (z - fz) * nz
    out[7, q, j, i] = part_of
    if away >= reach:
        return
    out[4, q, j, i], out[5, q, j, i] = section_velocity(px, py, k, f, rows, rows[SWELL])
    if away <= -reach and beyond == 0.0 and rows[ARC, 0] + reach < at < rows[ARC, -1] - reach:
        out[0, q, j, i] = away
        return
    bend = (rows[HEADING, k + 1] - rows[HEADING, k]) / (rows[ARC, k + 1] - rows[ARC, k])
    stretch = max(1.0 - bend * fy, 0.1)
    along, across, square, edge_a, edge_r = _nearest(k, at, away, stretch, rows, c, s, ny, nz, fy, fz, reach)
    sign, distance = -1.0 if away < 0.0 and beyond == 0.0 else 1.0, np.sqrt(square)
    if distance > 1e-6 * h:
        ea, er = sign * along / distance, sign * across / distance
    else:
        size = np.sqrt(edge_a * edge_a + edge_r * edge_r)
        ea, er = -edge_r / size, edge_a / size
    out[0, q, j, i] = sign * distance
    out[1, q, j, i], out[2, q, j, i] = ea * cos - er * ny * sin, ea * sin + er * ny * cos
    out[3, q, j, i] = er * nz
    out[6, q, j, i] = _chord(at - (along + ea * h) / stretch, k, rows, c, s, ny, nz, h)


@part
def _part_at(at, cuts):
    """Return which part of the body an arc length belongs to."""
    part_of = 0
    while part_of < cuts.size and cuts[part_of] <= at:
        part_of += 1
    return part_of


@part
def _section(column, rows, cuts, reach):
    """Return a column's section: arc length, part of the body, half-axes, and from how far it may be reached."""
    k, f = column[0], column[1]
    at = (1.0 - f) * rows[ARC, k] + f * rows[ARC, k + 1] + column[3]
    wide = (1.0 - f) * rows[WIDE, k] + f * rows[WIDE, k + 1]
    high = (1.0 - f) * rows[HIGH, k] + f * rows[HIGH, k + 1]
    return at, _part_at(at, cuts), wide, high, reach + _growth(k, at, wide, high, rows, reach)


@threaded
def paint_sections(out, rows, tx, ty, cuts, x0, y0, z0, h, reach):
    """Paint ``out``, shape (``PAINTED``, z, y, x), which is ``reach`` far from everything beforehand.

    Args:
        out: distance, normal, velocity, thickness, part.
        rows: the stations; see ``ARC``.
        tx: cosine of their heading.
        ty: sine of it.
        cuts: rising arc lengths that divide the body into parts.
        x0: first point.
        y0: first point.
        z0: first point, from the plane of the midline.
        h: distance of the points.
        reach: distance up to which it need be exact.
    """
    widest = np.max(rows[WIDE]) + reach
    for n in prange(out.shape[2]):
        j = signed(n)
        for i in range(out.shape[3]):
            px, py = x0 + i * h, y0 + j * h
            column = _column(px, py, rows, tx, ty)
            if abs(column[2]) <= widest and abs(column[3]) <= reach:
                section = _section(column, rows, cuts, reach)
                for q in range(out.shape[1]):
                    _paint_point(out, (q, j, i), px, py, z0 + q * h, column, section, rows, h)


@threaded
def paint_turned_sections(out, rows, tx, ty, cuts, x, y, z, turn, place, reach):
    """Paint ``out`` as ``paint_sections`` does, of a body in any attitude; vectors are those of the body's frame.

    Args:
        out: distance, normal, velocity, thickness, part.
        rows: the stations; see ``ARC``.
        tx: cosine of their heading.
        ty: sine of it.
        cuts: rising arc lengths that divide the body into parts.
        x: coordinates of the points, evenly spaced.
        y: coordinates of the points.
        z: coordinates of the points.
        turn: rotation matrix of the body's frame.
        place: its origin.
        reach: distance up to which it need be exact.
    """
    h, widest, highest = x[1] - x[0], np.max(rows[WIDE]) + reach, np.max(rows[HIGH]) + reach
    for n in prange(out.shape[2]):
        j = signed(n)
        dy = y[j] - place[1]
        for q in range(out.shape[1]):
            dz = z[q] - place[2]
            for i in range(out.shape[3]):
                dx = x[i] - place[0]
                up = turn[0, 2] * dx + turn[1, 2] * dy + turn[2, 2] * dz
                if abs(up) > highest:
                    continue
                px = turn[0, 0] * dx + turn[1, 0] * dy + turn[2, 0] * dz
                py = turn[0, 1] * dx + turn[1, 1] * dy + turn[2, 1] * dz
                column = _column(px, py, rows, tx, ty)
                if abs(column[2]) > widest or abs(column[3]) > reach:
                    continue
                section = _section(column, rows, cuts, reach)
                _paint_point(out, (q, j, i), px, py, up, column, section, rows, h)
