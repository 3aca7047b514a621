# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision)
"""Values of the staggered fields at points between the nodes."""

from suchus.flow.compiled import compiled, part


@part
def at(a, x, y):
    """Return the bilinear interpolation of ``a`` at padded indices (x, y), which may lie between nodes."""
    i, j = int(x), int(y)
    f, g = x - i, y - j
    return (1 - g) * ((1 - f) * a[j, i] + f * a[j, i + 1]) + g * ((1 - f) * a[j + 1, i] + f * a[j + 1, i + 1])


@compiled
def wall_pressure(p, x, y, nx, ny, gap, out):
    """Write the pressure at the markers from a parabola through three points off the wall.

    The points lie 1, 2 and 3 times ``gap`` cells off the wall; marker positions in padded indices of the cells.
    Read on the wall itself, the pressures of both sides of a thin tail mix and the force is ten times as noisy.
    """
    for m in range(x.size):
        a = at(p, x[m] + gap * nx[m], y[m] + gap * ny[m])
        b = at(p, x[m] + 2 * gap * nx[m], y[m] + 2 * gap * ny[m])
        c = at(p, x[m] + 3 * gap * nx[m], y[m] + 3 * gap * ny[m])
        out[m] = 3 * (a - b) + c


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
