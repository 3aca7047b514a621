# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision)
"""Distance, normal and velocity of a body in the plane, computed at the points of a window.

The body is given by its midline or by its outline. Each edge of the outline updates the points near it. Winding
numbers along the rows distinguish inside from outside. Each point moves with the cross-section of the midline that it
lies on: this velocity is continuous across the middle of the body. The velocity of the nearest outline point is not
continuous there, and the force would jump from step to step.
"""

import numpy as np
from numba import prange

from suchus.flow.compiled import compiled, kernel_part, signed, threaded

ROWS = 16
"""Rows of points that one thread paints at a time [-]."""


@compiled
def distance_to_edge(px, py, start_x, start_y, end_x, end_y):
    """Return the squared distance from a point to an edge, and the position of the nearest point on the edge, 0 to 1.

    Args:
        px: point.
        py: point.
        start_x: start of the edge.
        start_y: start of the edge.
        end_x: end of the edge.
        end_y: end of the edge.
    """
    ex, ey = end_x - start_x, end_y - start_y
    dx, dy = px - start_x, py - start_y
    size = ex * ex + ey * ey
    fraction = (dx * ex + dy * ey) / size if size > 0.0 else 0.0
    fraction = min(max(fraction, 0.0), 1.0)
    dx -= fraction * ex
    dy -= fraction * ey
    return dx * dx + dy * dy, fraction


@kernel_part
def _paint_edge(square, edge, fraction, rows, k, start_x, start_y, end_x, end_y, x0, y0, h, reach):
    """Store edge ``k`` at all points of some rows to which no earlier edge is nearer.

    Args:
        square: squared distance to the nearest edge so far, shape (y, x).
        edge: index of that edge, shape (y, x).
        fraction: position of the nearest point on it, 0 to 1, shape (y, x).
        rows: first row and end.
        k: index of the edge.
        start_x: start of the edge.
        start_y: start of the edge.
        end_x: end of the edge.
        end_y: end of the edge.
        x0: first point of the window.
        y0: first point of the window.
        h: distance of the points.
        reach: distance up to which points are updated.
    """
    j0 = max(int(np.ceil((min(start_y, end_y) - reach - y0) / h)), rows[0])
    j1 = min(int(np.floor((max(start_y, end_y) + reach - y0) / h)), rows[1] - 1)
    if j1 < j0:
        return
    i0 = max(int(np.ceil((min(start_x, end_x) - reach - x0) / h)), 0)
    i1 = min(int(np.floor((max(start_x, end_x) + reach - x0) / h)), square.shape[1] - 1)
    for j in range(j0, j1 + 1):
        for i in range(i0, i1 + 1):
            d2, f = distance_to_edge(x0 + i * h, y0 + j * h, start_x, start_y, end_x, end_y)
            if d2 < square[j, i]:
                square[j, i] = d2
                edge[j, i] = k
                fraction[j, i] = f


@kernel_part
def _wind_edge(winding, start_x, start_y, end_x, end_y, x0, y0, h):
    """Add the crossings of an edge with the rows to ``winding``, each at the first point right of the crossing.

    Args:
        winding: change of the winding number from the point on the left to this one, shape (y, x).
        start_x: start of the edge.
        start_y: start of the edge.
        end_x: end of the edge.
        end_y: end of the edge.
        x0: first point of the window.
        y0: first point of the window.
        h: distance of the points.
    """
    ny, nx = winding.shape
    lower_end, upper_end, direction = (start_y, end_y, 1) if start_y < end_y else (end_y, start_y, -1)
    j0 = max(int(np.ceil((lower_end - y0) / h)), 0)
    j1 = min(int(np.ceil((upper_end - y0) / h)), ny)  # rounded as j0 is, or a vertex on a row counts twice or never
    for j in range(j0, j1):
        y = y0 + j * h
        x = start_x + (end_x - start_x) * (y - start_y) / (end_y - start_y)
        i = max(int(np.ceil((x - x0) / h)), 0)
        if i < nx:
            winding[j, i] += direction


@kernel_part
def find_section(px, py, start, sx, sy, tx, ty):
    """Return the segment of the midline whose cross-section holds a point, and the position along the segment, 0 to 1.

    Args:
        px: point.
        py: point.
        start: segment at which the search begins.
        sx: stations of the midline.
        sy: stations of the midline.
        tx: tangent at the stations.
        ty: tangent at the stations.
    """
    last_segment = sx.size - 2
    k = min(start, last_segment)
    offset = (px - sx[k]) * tx[k] + (py - sy[k]) * ty[k]
    while offset < 0.0 and k > 0:
        k -= 1
        offset = (px - sx[k]) * tx[k] + (py - sy[k]) * ty[k]
    next_offset = (px - sx[k + 1]) * tx[k + 1] + (py - sy[k + 1]) * ty[k + 1]
    while next_offset >= 0.0 and k < last_segment:
        k += 1
        offset = next_offset
        next_offset = (px - sx[k + 1]) * tx[k + 1] + (py - sy[k + 1]) * ty[k + 1]
    span = offset - next_offset
    fraction = offset / span if span > 0.0 else 0.0
    return k, min(max(fraction, 0.0), 1.0)


@kernel_part
def section_velocity(px, py, k, f, spine, width_rate):
    """Return the velocity (x, y) with which a cross-section moves a point.

    Args:
        px: point.
        py: point.
        k: segment of the midline.
        f: position along the segment, 0 to 1.
        spine: stations, rows x, y, heading, half-width, and the rates of x, y and heading.
        width_rate: rate of the half-width at the stations.
    """
    g = 1.0 - f
    dx = px - (g * spine[0, k] + f * spine[0, k + 1])
    dy = py - (g * spine[1, k] + f * spine[1, k + 1])
    heading = g * spine[2, k] + f * spine[2, k + 1]
    half = g * spine[3, k] + f * spine[3, k + 1]
    turn = g * spine[6, k] + f * spine[6, k + 1]
    swell = g * width_rate[k] + f * width_rate[k + 1]
    nx, ny = -np.sin(heading), np.cos(heading)
    swell_velocity = min(max((dx * nx + dy * ny) / half, -1.0), 1.0) * swell if half > 0.0 else 0.0
    vx = g * spine[4, k] + f * spine[4, k + 1] - turn * dy + swell_velocity * nx
    vy = g * spine[5, k] + f * spine[5, k + 1] + turn * dx + swell_velocity * ny
    return vx, vy


@compiled
def ring(spine):
    """Return the outline of a midline counter-clockwise: along the right side, then back along the left.

    The shape is (2, 2 n) for n stations.

    Args:
        spine: stations, rows x, y, heading and half-width (and more), shape (row, n).
    """
    n = spine.shape[1]
    outline = np.empty((2, 2 * n))
    for k in range(n):
        ox, oy = -spine[3, k] * np.sin(spine[2, k]), spine[3, k] * np.cos(spine[2, k])
        outline[0, k], outline[1, k] = spine[0, k] - ox, spine[1, k] - oy
        outline[0, 2 * n - 1 - k], outline[1, 2 * n - 1 - k] = spine[0, k] + ox, spine[1, k] + oy
    return outline


@kernel_part
def _wind(winding, outline, x0, y0, h):
    """Add the crossings of all edges of an outline with the rows to ``winding``; see ``_wind_edge``."""
    count = outline.shape[1]
    for k in range(count):
        m = (k + 1) % count
        if outline[1, k] != outline[1, m]:
            _wind_edge(winding, outline[0, k], outline[1, k], outline[0, m], outline[1, m], x0, y0, h)


@kernel_part
def _paint_edges(square, edge, fraction, rows, outline, x0, y0, h, reach):
    """Store the nearest edge of an outline at each point of some rows; see ``_paint_edge`` for the arguments."""
    count = outline.shape[1]
    for k in range(count):
        m = (k + 1) % count
        start_x, start_y, end_x, end_y = outline[0, k], outline[1, k], outline[0, m], outline[1, m]
        if start_x != end_x or start_y != end_y:
            _paint_edge(square, edge, fraction, rows, k, start_x, start_y, end_x, end_y, x0, y0, h, reach)


@kernel_part
def _normal_to_edge(outline, k, fraction, px, py, distance, sign, flat):
    """Return the outward normal (x, y) at a point whose nearest edge is ``k``.

    Args:
        outline: corners, shape (2, corner).
        k: index of the edge.
        fraction: position of the nearest point on the edge, 0 to 1.
        px: point.
        py: point.
        distance: unsigned distance to the edge.
        sign: -1 inside and 1 outside.
        flat: distance below which the normal of the edge itself is taken.
    """
    m = (k + 1) % outline.shape[1]
    ex, ey = outline[0, m] - outline[0, k], outline[1, m] - outline[1, k]
    if distance > flat:
        nx = sign * (px - outline[0, k] - fraction * ex) / distance
        ny = sign * (py - outline[1, k] - fraction * ey) / distance
        return nx, ny
    size = np.sqrt(ex * ex + ey * ey)
    return ey / size, -ex / size


@kernel_part
def _paint_row(fields, j, square, edge, fraction, winding, outline, spine, width_rate, tx, ty, x0, y0, h):
    """Write the fields of ``paint`` for row ``j``, whose nearest edges are known.

    Args:
        fields: distance, normal (x, y), velocity (x, y) and thickness, shape (6, y, x).
        j: the row.
        square: squared distance to the nearest edge, shape (y, x).
        edge: index of that edge, -1 beyond the reach, shape (y, x).
        fraction: position of the nearest point on it, 0 to 1, shape (y, x).
        winding: change of the winding number at each point, shape (y, x).
        outline: corners, shape (2, corner).
        spine: stations of the midline; see ``section_velocity``.
        width_rate: rate of the half-width at the stations.
        tx: tangent at the stations.
        ty: tangent at the stations.
        x0: first point of the window.
        y0: first point of the window.
        h: distance of the points.
    """
    count, n = outline.shape[1], spine.shape[1]
    winding_number, k = 0, 0
    for i in range(square.shape[1]):
        winding_number += winding[j, i]
        e = edge[j, i]
        sign = -1.0 if winding_number != 0 else 1.0
        d = np.sqrt(square[j, i])
        fields[0, j, i] = sign * d
        if e < 0 and winding_number == 0:
            continue
        px, py = x0 + i * h, y0 + j * h
        if e >= 0:
            m = (e + 1) % count
            ex, ey = outline[0, m] - outline[0, e], outline[1, m] - outline[1, e]
            if d > 1e-6 * h:
                fields[1, j, i] = sign * (px - outline[0, e] - fraction[j, i] * ex) / d
                fields[2, j, i] = sign * (py - outline[1, e] - fraction[j, i] * ey) / d
            else:
                size = np.sqrt(ex * ex + ey * ey)
                fields[1, j, i], fields[2, j, i] = ey / size, -ex / size
            k = e if e < n else 2 * n - 1 - e
            qx = px - fields[1, j, i] * (fields[0, j, i] + h)
            qy = py - fields[2, j, i] * (fields[0, j, i] + h)
            m, f = find_section(qx, qy, min(k, n - 2), spine[0], spine[1], tx, ty)
            fields[5, j, i] = 2.0 * ((1.0 - f) * spine[3, m] + f * spine[3, m + 1])
        k, f = find_section(px, py, min(k, n - 2), spine[0], spine[1], tx, ty)
        fields[3, j, i], fields[4, j, i] = section_velocity(px, py, k, f, spine, width_rate)


@threaded
def _paint(fields, square, edge, fraction, winding, outline, spine, width_rate, tx, ty, x0, y0, h, reach):
    """Write all rows of ``fields``; see ``_paint_row`` for the arguments."""
    ny = square.shape[0]
    _wind(winding, outline, x0, y0, h)
    for n in prange((ny + ROWS - 1) // ROWS):
        block = signed(n)
        rows = block * ROWS, min((block + 1) * ROWS, ny)
        _paint_edges(square, edge, fraction, rows, outline, x0, y0, h, reach)
        for j in range(rows[0], rows[1]):
            _paint_row(fields, j, square, edge, fraction, winding, outline, spine, width_rate, tx, ty, x0, y0, h)


def paint(
    spine: np.ndarray, width_rate: np.ndarray, x0: float, y0: float, h: float, nx: int, ny: int, reach: float
) -> np.ndarray:
    """Return distance, normal (x, y), velocity (x, y) and thickness on a window, shape (6, ny, nx).

    The thickness is that of the cross-section one cell inside the nearest point of the outline. It is large near a
    blunt nose, and small along a tail.

    Args:
        spine: stations of the midline; see ``section_velocity`` [m, rad, m/s, rad/s].
        width_rate: rate of the half-width at the stations [m/s].
        x0: first point of the window [m].
        y0: first point of the window [m].
        h: distance of the points [m].
        nx: points along x [-].
        ny: points along y [-].
        reach: distance up to which the fields are computed [m].
    """
    outline, headings = ring(spine), spine[2]
    square, edge = np.full((ny, nx), reach * reach), np.full((ny, nx), -1, np.int32)
    fraction, winding = np.zeros((ny, nx)), np.zeros((ny, nx), np.int32)
    fields = np.zeros((6, ny, nx))
    fields[5] = np.inf
    _paint(fields, square, edge, fraction, winding, outline, spine, width_rate, np.cos(headings), np.sin(headings), x0,
           y0, h, reach)  # fmt: skip
    return fields


@threaded
def _paint_outline(fields, square, edge, fraction, winding, outline, x0, y0, h, reach, flat):
    """Write distance and normal of a polygon to ``fields``, shape (3, y, x); see ``_paint_row`` for the arguments.

    ``flat`` is the distance below which a point has the normal of its edge.
    """
    ny = square.shape[0]
    _wind(winding, outline, x0, y0, h)
    for n in prange((ny + ROWS - 1) // ROWS):
        block = signed(n)
        rows = block * ROWS, min((block + 1) * ROWS, ny)
        _paint_edges(square, edge, fraction, rows, outline, x0, y0, h, reach)
        for j in range(rows[0], rows[1]):
            winding_number = 0
            for i in range(square.shape[1]):
                winding_number += winding[j, i]
                sign, d = -1.0 if winding_number != 0 else 1.0, np.sqrt(square[j, i])
                fields[0, j, i] = sign * d
                if edge[j, i] >= 0:
                    px, py = x0 + i * h, y0 + j * h
                    fields[1, j, i], fields[2, j, i] = _normal_to_edge(
                        outline, edge[j, i], fraction[j, i], px, py, d, sign, flat
                    )


def paint_outline(
    outline: np.ndarray, x0: float, y0: float, h: float, nx: int, ny: int, reach: float, flat: float
) -> np.ndarray:
    """Return distance and normal (x, y) of a polygon on a window, shape (3, ny, nx).

    Args:
        outline: its corners, counter-clockwise, shape (2, corner) [m].
        x0: first point of the window [m].
        y0: first point of the window [m].
        h: distance of its points [m].
        nx: points along x [-].
        ny: points along y [-].
        reach: distance beyond which points are taken to be just so far off, without a normal [m].
        flat: distance below which a point has the normal of its edge [m].
    """
    fields, square, edge = np.zeros((3, ny, nx)), np.full((ny, nx), reach * reach), np.full((ny, nx), -1, np.int32)
    fraction, winding = np.zeros((ny, nx)), np.zeros((ny, nx), np.int32)
    _paint_outline(fields, square, edge, fraction, winding, outline, x0, y0, h, reach, flat)
    return fields


@threaded
def measure_outline(fields, px, py, outline, flat):
    """Write distance and normal of a polygon at any points, however far.

    Args:
        fields: distance and normal (x, y), shape (3, point).
        px: points, shape (point,).
        py: points, shape (point,).
        outline: corners, counter-clockwise, shape (2, corner).
        flat: distance below which a point has the normal of its edge.
    """
    count = outline.shape[1]
    for n in prange(px.size):
        i = signed(n)
        min_square, edge, nearest_fraction, is_inside = np.inf, 0, 0.0, False
        for k in range(count):
            m = (k + 1) % count
            start_x, start_y, end_x, end_y = outline[0, k], outline[1, k], outline[0, m], outline[1, m]
            d2, fraction = distance_to_edge(px[i], py[i], start_x, start_y, end_x, end_y)
            if d2 < min_square:
                min_square, edge, nearest_fraction = d2, k, fraction
            if (start_y <= py[i]) != (end_y <= py[i]):
                crossing_x = start_x + (py[i] - start_y) / (end_y - start_y) * (end_x - start_x)
                if px[i] < crossing_x:
                    is_inside = not is_inside
        sign, d = -1.0 if is_inside else 1.0, np.sqrt(min_square)
        fields[0, i] = sign * d
        fields[1, i], fields[2, i] = _normal_to_edge(outline, edge, nearest_fraction, px[i], py[i], d, sign, flat)


@compiled
def section_motions(points, segment_guess, stations, half_width_rate):
    """Return the motion of the cross-section that holds each point, at that point, shape (3, point).

    The rows are the velocity along x and y, in the frame of the midline [m/s], and the turning rate [rad/s].

    Args:
        points: x and y in the frame of the midline, shape (2, point) [m].
        segment_guess: segment of the midline at which the search of each point begins, shape (point,).
        stations: rows x, y, heading, half-width, and the rates of x, y and heading, shape (7, station).
        half_width_rate: rate of the half-width at the stations, shape (station,) [m/s].
    """
    station_count = stations.shape[1]
    tx, ty = np.empty(station_count), np.empty(station_count)
    for k in range(station_count):
        tx[k], ty[k] = np.cos(stations[2, k]), np.sin(stations[2, k])
    motions = np.empty((3, points.shape[1]))
    for i in range(points.shape[1]):
        px, py = points[0, i], points[1, i]
        k, fraction = find_section(
            px, py, min(segment_guess[i], stations.shape[1] - 2), stations[0], stations[1], tx, ty
        )
        motions[0, i], motions[1, i] = section_velocity(px, py, k, fraction, stations, half_width_rate)
        motions[2, i] = (1.0 - fraction) * stations[6, k] + fraction * stations[6, k + 1]
    return motions
