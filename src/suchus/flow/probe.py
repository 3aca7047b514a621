"""Values of the staggered fields at points between the nodes."""

from suchus.flow.compiled import compiled


@compiled
def at(a, x, y):
    """Return the bilinear interpolation of ``a`` at padded indices (x, y), which may lie between nodes."""
    i, j = int(x), int(y)
    f, g = x - i, y - j
    return (1 - g) * ((1 - f) * a[j, i] + f * a[j, i + 1]) + g * ((1 - f) * a[j + 1, i] + f * a[j + 1, i + 1])


@compiled
def wall_pressure(p, x, y, nx, ny, first, gap, out):
    """Write the pressure at the markers, carried from two points in the water straight to the wall.

    Points lie ``first`` and ``first + gap`` cells from the wall; marker positions in padded indices of the cells.
    """
    for m in range(x.size):
        a = at(p, x[m] + first * nx[m], y[m] + first * ny[m])
        b = at(p, x[m] + (first + gap) * nx[m], y[m] + (first + gap) * ny[m])
        out[m] = a + (a - b) * first / gap


@compiled
def wall_shear(u, v, x, y, nx, ny, bu, bv, spin, gap, out):
    """Write the rate of shear (x, y) at the markers from a cubic through the wall and three points off it.

    ``u`` and ``v`` are the velocities, ``bu`` and ``bv`` the wall's [m/s], ``spin`` its turning rate in m/s per cell;
    the points lie 1, 2 and 3 times ``gap`` cells off the wall. The result is in m/s per cell.
    """
    for m in range(x.size):
        sx, sy = 0.0, 0.0
        for k in range(1, 4):
            weight = (3.0, -1.5, 1.0 / 3.0)[k - 1] / gap
            dx, dy = k * gap * nx[m], k * gap * ny[m]
            px, py = x[m] + dx, y[m] + dy
            sx += weight * (at(u, px + 0.5, py) - (bu[m] - spin[m] * dy))
            sy += weight * (at(v, px, py + 0.5) - (bv[m] + spin[m] * dx))
        across = sx * nx[m] + sy * ny[m]
        out[0, m] = sx - across * nx[m]
        out[1, m] = sy - across * ny[m]
