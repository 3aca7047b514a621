# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba)
"""Distance, normal and velocity of a trunk, painted onto a window in space.

A trunk is a bent midline with elliptic sections. The midline lies in a plane, so that one section holds a whole column
of points. The nearest point on the ellipse of that section is the foot of a point. The feet at the same angle of the
neighbouring sections form a line along the body, and the distance is measured to this line. This is accurate at round
and at flat ends, and exact for a straight body with round sections.
"""

import numpy as np
from numba import prange

from suchus.flow.compiled import kernel_part, signed, threaded
from suchus.flow.ellipsoid import TINY, foot_parameter
from suchus.flow.paint import find_section, section_velocity

X, Y, HEADING, HALF_WIDTH, X_RATE, Y_RATE, TURN, HALF_HEIGHT, SWELL, ARC = range(10)
"""Rows of the stations: those of ``MidlineState.rows``, then half-height, rate of the half-width, and arc length."""

PAINTED_FIELDS = 8
"""Fields at each point: distance, normal (3), velocity (2), thickness, index of the body's part [-]."""

_STRIDE = 4
"""Stride of the first, coarse search for the nearest station [-]."""

_MIN_HALF_AXIS = 1e-9
"""Half-axis, over the cell, below which a section counts as a point [-]."""


@kernel_part
def ellipse_foot(y, z, half_width, half_height):
    """Return the nearest point on an ellipse to (y, z), as cosine and sine of its angle.

    Args:
        y: point, along the width.
        z: point, along the height.
        half_width: half-axis along y.
        half_height: half-axis along z.
    """
    p = max(abs(y), TINY * half_width), max(abs(z), TINY * half_height)
    t = foot_parameter(p, (half_width, half_height))
    c, s = half_width * p[0] / (t + half_width * half_width), half_height * p[1] / (t + half_height * half_height)
    size = np.sqrt(c * c + s * s)
    return np.copysign(c / size, y), np.copysign(s / size, z)


@kernel_part
def _nearest_station(px, py, rows, start, end, stride):
    """Return the station that is nearest to a column, and the square of its distance.

    Args:
        px: position of the column.
        py: position of the column.
        rows: the stations; see ``ARC``.
        start: first station that is compared.
        end: end of the stations.
        stride: distance of consecutive stations that are compared.
    """
    station, square = start, np.inf
    for m in range(start, end, stride):
        d2 = (px - rows[X, m]) ** 2 + (py - rows[Y, m]) ** 2
        if d2 < square:
            station, square = m, d2
    return station, square


@kernel_part
def _column(px, py, rows, tx, ty):
    """Return the section that holds a column of points.

    Args:
        px: position of the column.
        py: position of the column.
        rows: the stations; see ``ARC``.
        tx: cosine of their heading.
        ty: sine of it.

    Returns:
        segment of the midline, position along it (0 to 1), lateral offset of the column, axial offset beyond an end of
        the midline (else 0), and cosine and sine of the heading.
    """
    coarse_station, _ = _nearest_station(px, py, rows, 0, rows.shape[1], _STRIDE)
    start, end = max(coarse_station - _STRIDE, 0), min(coarse_station + _STRIDE + 1, rows.shape[1])
    station, _ = _nearest_station(px, py, rows, start, end, 1)
    k, f = find_section(px, py, min(station, rows.shape[1] - 2), rows[X], rows[Y], tx, ty)
    g = 1.0 - f
    dx, dy = px - g * rows[X, k] - f * rows[X, k + 1], py - g * rows[Y, k] - f * rows[Y, k + 1]
    cos, sin = g * tx[k] + f * tx[k + 1], g * ty[k] + f * ty[k + 1]
    size = np.sqrt(cos * cos + sin * sin)
    cos, sin = cos / size, sin / size
    end_offset = dx * cos + dy * sin
    end_offset = min(end_offset, 0.0) if k == 0 and f == 0.0 else max(end_offset, 0.0) if f == 1.0 else 0.0
    return k, f, -dx * sin + dy * cos, end_offset, cos, sin


@kernel_part
def _growth(k, arc, half_width, half_height, rows, reach):
    """Return by how much sections within a reach are wider and higher than the one at an arc length, in sum.

    Args:
        k: segment of the midline.
        arc: arc length in it.
        half_width: half-width of the section there.
        half_height: half-height of the section there.
        rows: the stations; see ``ARC``.
        reach: distance along the midline.
    """
    max_half_width, max_half_height, last_station = half_width, half_height, rows.shape[1] - 1
    m = k
    while m >= 0 and arc - rows[ARC, m] <= reach:
        max_half_width, max_half_height = (
            max(max_half_width, rows[HALF_WIDTH, m]),
            max(max_half_height, rows[HALF_HEIGHT, m]),
        )
        m -= 1
    m = k + 1
    while m <= last_station and rows[ARC, m] - arc <= reach:
        max_half_width, max_half_height = (
            max(max_half_width, rows[HALF_WIDTH, m]),
            max(max_half_height, rows[HALF_HEIGHT, m]),
        )
        m += 1
    return max_half_width - half_width + max_half_height - half_height


@kernel_part
def _to_edge(normal_offset, best, a0, r0, a1, r1):
    """Return the shortest vector from an outline to a point after one more edge.

    Coordinates are axial and radial; the point is at (0, ``normal_offset``).

    Args:
        normal_offset: radial coordinate of the point.
        best: shortest vector so far: axial and radial component, squared length, and axial and radial extent of its
            edge.
        a0: axial start of the edge.
        r0: radial start of the edge.
        a1: axial end of the edge.
        r1: radial end of the edge.
    """
    ea, er = a1 - a0, r1 - r0
    square = ea * ea + er * er
    if square == 0.0:
        return best
    fraction = min(max((-a0 * ea + (normal_offset - r0) * er) / square, 0.0), 1.0)
    da, dr = -a0 - fraction * ea, normal_offset - r0 - fraction * er
    d2 = da * da + dr * dr
    return (da, dr, d2, ea, er) if d2 < best[2] else best


@kernel_part
def _outline_of(m, rows, c, s, ny, nz, fy, fz):
    """Return the radial offset of the point at an angle of section ``m`` from the foot in the point's own section.

    Args:
        m: station.
        rows: the stations; see ``ARC``.
        c: cosine of the angle.
        s: sine of the angle.
        ny: normal at the foot, along the width.
        nz: normal at the foot, along the height.
        fy: foot, along the width.
        fz: foot, along the height.
    """
    return ny * (rows[HALF_WIDTH, m] * c - fy) + nz * (rows[HALF_HEIGHT, m] * s - fz)


@kernel_part
def _nearest_outline(k, arc, normal_offset, stretch, rows, c, s, ny, nz, fy, fz, reach):
    """Return the shortest vector from the outline through the sections to a point; see ``_to_edge`` for its components.

    Args:
        k: segment of the midline.
        arc: arc length of the point.
        normal_offset: signed distance of the point from its own section.
        stretch: length along the body at the foot over that along the midline [-].
        rows: the stations; see ``ARC``.
        c: cosine of the angle of the foot.
        s: sine of it.
        ny: normal at the foot, along the width.
        nz: normal at the foot, along the height.
        fy: foot, along the width.
        fz: foot, along the height.
        reach: distance up to which it is exact.
    """
    last_station = rows.shape[1] - 1
    best, farthest = (0.0, 0.0, np.inf, 1.0, 0.0), reach * reach
    for direction in (1, -1):
        m = k
        a, r = (rows[ARC, m] - arc) * stretch, _outline_of(m, rows, c, s, ny, nz, fy, fz)
        while True:
            if (m == last_station and direction > 0) or (m == 0 and direction < 0):  # the end's own face
                axis = -ny * fy - nz * fz
                start_r, end_r = (r, axis) if direction > 0 else (axis, r)
                best = _to_edge(normal_offset, best, a, start_r, a, end_r)
                break
            if a * a > min(best[2], farthest) and not (direction > 0 and m == k):
                break
            b, t = (rows[ARC, m + direction] - arc) * stretch, _outline_of(m + direction, rows, c, s, ny, nz, fy, fz)
            a0, r0, a1, r1 = (a, r, b, t) if direction > 0 else (b, t, a, r)
            best = _to_edge(normal_offset, best, a0, r0, a1, r1)
            m, a, r = m + direction, b, t
    return best


@kernel_part
def _chord(arc, k, rows, c, s, ny, nz, depth):
    """Return the shorter chord of a section, along width or height, through a point at a depth below its outline.

    Args:
        arc: arc length of the section.
        k: segment of the midline at which the search for it begins.
        rows: the stations; see ``ARC``.
        c: cosine of the angle on the section.
        s: sine of it.
        ny: normal at that angle, along the width.
        nz: normal at that angle, along the height.
        depth: distance of the point from the outline.
    """
    last_segment = rows.shape[1] - 2
    while k > 0 and rows[ARC, k] > arc:
        k -= 1
    while k < last_segment and rows[ARC, k + 1] < arc:
        k += 1
    span = rows[ARC, k + 1] - rows[ARC, k]
    f = min(max((arc - rows[ARC, k]) / span, 0.0), 1.0) if span > 0.0 else 0.0
    half_width = (1.0 - f) * rows[HALF_WIDTH, k] + f * rows[HALF_WIDTH, k + 1]
    half_height = (1.0 - f) * rows[HALF_HEIGHT, k] + f * rows[HALF_HEIGHT, k + 1]
    if half_width <= 0.0 or half_height <= 0.0:
        return 0.0
    inset = min(depth, half_width, half_height)
    y, z = c - ny * inset / half_width, s - nz * inset / half_height
    return 2.0 * min(half_width * np.sqrt(max(1.0 - z * z, 0.0)), half_height * np.sqrt(max(1.0 - y * y, 0.0)))


@kernel_part
def _paint_point(fields, indices, px, py, z, column, section, rows, h):
    """Write the fields of ``paint_sections`` at one point.

    Args:
        fields: distance, normal, velocity, thickness, part, shape (``PAINTED_FIELDS``, z, y, x).
        indices: indices of the point, z, y, x.
        px: position of the column.
        py: position of the column.
        z: height of the point above the plane of the midline.
        column: see ``_column``.
        section: see ``_section``.
        rows: the stations; see ``ARC``.
        h: distance of the points.
    """
    (q, j, i), (k, f, y, end_offset, cos, sin) = indices, column
    arc, part_index, half_width, half_height, reach = section
    if np.sqrt(y * y + z * z) >= max(half_width, half_height) + reach:  # the ellipse lies in the circle around it
        return
    half_width, half_height = max(half_width, _MIN_HALF_AXIS * h), max(half_height, _MIN_HALF_AXIS * h)
    c, s = ellipse_foot(y, z, half_width, half_height)
    fy, fz, ny, nz = half_width * c, half_height * s, c / half_width, s / half_height
    size = np.sqrt(ny * ny + nz * nz)
    ny, nz = ny / size, nz / size
    normal_offset = (y - fy) * ny + (z - fz) * nz
    fields[7, q, j, i] = part_index
    if normal_offset >= reach:
        return
    fields[4, q, j, i], fields[5, q, j, i] = section_velocity(px, py, k, f, rows, rows[SWELL])
    if normal_offset <= -reach and end_offset == 0.0 and rows[ARC, 0] + reach < arc < rows[ARC, -1] - reach:
        fields[0, q, j, i] = normal_offset
        return
    bend = (rows[HEADING, k + 1] - rows[HEADING, k]) / (rows[ARC, k + 1] - rows[ARC, k])
    stretch = max(1.0 - bend * fy, 0.1)
    axial_offset, radial_offset, square, edge_a, edge_r = _nearest_outline(
        k, arc, normal_offset, stretch, rows, c, s, ny, nz, fy, fz, reach
    )
    sign, distance = -1.0 if normal_offset < 0.0 and end_offset == 0.0 else 1.0, np.sqrt(square)
    if distance > 1e-6 * h:
        ea, er = sign * axial_offset / distance, sign * radial_offset / distance
    else:
        size = np.sqrt(edge_a * edge_a + edge_r * edge_r)
        ea, er = -edge_r / size, edge_a / size
    fields[0, q, j, i] = sign * distance
    fields[1, q, j, i], fields[2, q, j, i] = ea * cos - er * ny * sin, ea * sin + er * ny * cos
    fields[3, q, j, i] = er * nz
    fields[6, q, j, i] = _chord(arc - (axial_offset + ea * h) / stretch, k, rows, c, s, ny, nz, h)


@kernel_part
def _part_index(arc, cuts):
    """Return the index of the body's part to which an arc length belongs.

    Args:
        arc: the arc length.
        cuts: rising arc lengths that divide the body into parts.
    """
    part_index = 0
    while part_index < cuts.size and cuts[part_index] <= arc:
        part_index += 1
    return part_index


@kernel_part
def _section(column, rows, cuts, reach):
    """Return the section of a column.

    Args:
        column: see ``_column``.
        rows: the stations; see ``ARC``.
        cuts: rising arc lengths that divide the body into parts.
        reach: distance up to which fields are computed.

    Returns:
        arc length, index of the part, half-width, half-height, and the distance from the section beyond which no point
        is within reach of the body.
    """
    k, f = column[0], column[1]
    arc = (1.0 - f) * rows[ARC, k] + f * rows[ARC, k + 1] + column[3]
    half_width = (1.0 - f) * rows[HALF_WIDTH, k] + f * rows[HALF_WIDTH, k + 1]
    half_height = (1.0 - f) * rows[HALF_HEIGHT, k] + f * rows[HALF_HEIGHT, k + 1]
    reach += _growth(k, arc, half_width, half_height, rows, reach)
    return arc, _part_index(arc, cuts), half_width, half_height, reach


@threaded
def paint_sections(fields, rows, tx, ty, cuts, x0, y0, z0, h, reach):
    """Write the fields of a trunk whose midline lies in a plane z = constant.

    Args:
        fields: distance, normal, velocity, thickness, part, shape (``PAINTED_FIELDS``, z, y, x); beforehand all
            distances are ``reach``.
        rows: the stations; see ``ARC``.
        tx: cosine of their heading.
        ty: sine of it.
        cuts: rising arc lengths that divide the body into parts.
        x0: first point.
        y0: first point.
        z0: first point, from the plane of the midline.
        h: distance of the points.
        reach: distance up to which the fields are exact.
    """
    max_width = np.max(rows[HALF_WIDTH]) + reach
    for n in prange(fields.shape[2]):
        j = signed(n)
        for i in range(fields.shape[3]):
            px, py = x0 + i * h, y0 + j * h
            column = _column(px, py, rows, tx, ty)
            if abs(column[2]) <= max_width and abs(column[3]) <= reach:
                section = _section(column, rows, cuts, reach)
                for q in range(fields.shape[1]):
                    _paint_point(fields, (q, j, i), px, py, z0 + q * h, column, section, rows, h)


@threaded
def paint_turned_sections(fields, rows, tx, ty, cuts, x, y, z, turn, origin, reach):
    """Write the fields of a trunk in any attitude, as ``paint_sections`` does; vectors are those of the body's frame.

    Args:
        fields: distance, normal, velocity, thickness, part, shape (``PAINTED_FIELDS``, z, y, x).
        rows: the stations; see ``ARC``.
        tx: cosine of their heading.
        ty: sine of it.
        cuts: rising arc lengths that divide the body into parts.
        x: coordinates of the points, evenly spaced.
        y: coordinates of the points.
        z: coordinates of the points.
        turn: rotation matrix of the body's frame.
        origin: position of the origin of that frame.
        reach: distance up to which the fields are exact.
    """
    h, max_width, max_height = x[1] - x[0], np.max(rows[HALF_WIDTH]) + reach, np.max(rows[HALF_HEIGHT]) + reach
    for n in prange(fields.shape[2]):
        j = signed(n)
        dy = y[j] - origin[1]
        for q in range(fields.shape[1]):
            dz = z[q] - origin[2]
            for i in range(fields.shape[3]):
                dx = x[i] - origin[0]
                pz = turn[0, 2] * dx + turn[1, 2] * dy + turn[2, 2] * dz
                if abs(pz) > max_height:
                    continue
                px = turn[0, 0] * dx + turn[1, 0] * dy + turn[2, 0] * dz
                py = turn[0, 1] * dx + turn[1, 1] * dy + turn[2, 1] * dz
                column = _column(px, py, rows, tx, ty)
                if abs(column[2]) > max_width or abs(column[3]) > reach:
                    continue
                section = _section(column, rows, cuts, reach)
                _paint_point(fields, (q, j, i), px, py, pz, column, section, rows, h)
