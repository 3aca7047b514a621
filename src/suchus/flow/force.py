# mypy: disable-error-code="no-untyped-def, var-annotated"
# (the kernels get their types from numba, once per precision)
"""Forces on bodies: pressure and shear along the outline, and the momentum through a box around them."""

from dataclasses import dataclass

import numpy as np

from suchus.flow.compiled import PAD, compiled, part
from suchus.flow.grid import Grid
from suchus.flow.shape import Markers
from suchus.flow.water import Fluid

GAP = 1.0
"""Spacing of the points off the wall from which wall pressure and wall shear are fitted [cells]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """What the water does to a body, per metre of depth."""

    pressure: tuple[float, float]
    """Force by pressure (x, y) [N/m]."""
    shear: tuple[float, float]
    """Force by friction (x, y) [N/m]."""
    torque: float
    """Torque about the body's reference point, counter-clockwise [N]."""
    power: float
    """Power that the body's surface gives to the water [W/m]."""

    @property
    def force(self) -> tuple[float, float]:
        """Pressure and friction together (x, y) [N/m]."""
        return self.pressure[0] + self.shear[0], self.pressure[1] + self.shear[1]


@dataclass(frozen=True, slots=True, kw_only=True)
class Surface:
    """Pressure and friction along a body's outline: where the load sits.

    ``resolution.ALONG_THE_SKIN`` says how far off they are. For the sum take ``Record.force``.
    """

    markers: Markers
    """Points on the skin, where the values are given [m]."""
    pressure: np.ndarray
    """Pressure, zero on the average along the sides of the domain, shape (marker,) [Pa]."""
    shear: np.ndarray
    """Friction per area (x, y), shape (2, marker) [Pa]."""

    @property
    def traction(self) -> np.ndarray:
        """Force per area (x, y), shape (2, marker) [Pa]."""
        return self.shear - self.pressure * np.stack([self.markers.normal_x, self.markers.normal_y])

    def load(self, about: tuple[float, ...]) -> Load:
        """Return the integral over the outline, torque about a point [m]."""
        m = self.markers
        push_x, push_y = -self.pressure * m.normal_x * m.length, -self.pressure * m.normal_y * m.length
        rub_x, rub_y = self.shear * m.length
        fx, fy = push_x + rub_x, push_y + rub_y
        return Load(
            pressure=(float(push_x.sum()), float(push_y.sum())),
            shear=(float(rub_x.sum()), float(rub_y.sum())),
            torque=float(((m.x - about[0]) * fy - (m.y - about[1]) * fx).sum()),
            power=float(-(fx * m.velocity_x + fy * m.velocity_y).sum()),
        )


def padded(markers: Markers, grid: Grid) -> tuple[np.ndarray, np.ndarray]:
    """Return the markers' positions in padded indices of the cell centres."""
    return (
        (markers.x - grid.origin[0]) / grid.cell + PAD - 0.5, (markers.y - grid.origin[1]) / grid.cell + PAD - 0.5
    )  # fmt: skip


def sample(water: Fluid, markers: Markers, density: float) -> Surface:
    """Return pressure and friction at the markers; densities in [kg/m^3]."""
    h = water.grid.cell
    x, y = padded(markers, water.grid)
    pressure, shear = np.empty(x.size), np.empty((2, x.size))
    nx, ny = markers.normal_x, markers.normal_y
    wall_pressure(water.p, x, y, nx, ny, GAP, pressure)
    wall_shear(water.u, water.v, x, y, nx, ny, markers.velocity_x, markers.velocity_y, markers.spin * h, GAP, shear)
    level = float(edge_mean(water.p))
    return Surface(
        markers=markers, pressure=density * (pressure - level), shear=density * float(water.nu) * shear
    )  # fmt: skip


def edge_mean(p: np.ndarray) -> float:
    """Return the mean along the outermost cells of the domain: the level from which pressures count."""
    cells = p[(slice(PAD, -PAD),) * p.ndim]
    edges = [np.moveaxis(cells, axis, 0)[end] for axis in range(p.ndim) for end in (0, -1)]
    return float(sum(e.sum(dtype=np.float64) for e in edges) / sum(e.size for e in edges))


@compiled
def momentum(u, v, j0, j1, i0, i1):
    """Return the momentum (x, y) of the faces of a box of cells, half of those on its sides [m/s cells]."""
    mx, my = 0.0, 0.0
    for j in range(j0, j1):
        for i in range(i0, i1 + 1):
            mx += (0.5 if i in (i0, i1) else 1.0) * u[j, i]
    for j in range(j0, j1 + 1):
        for i in range(i0, i1):
            my += (0.5 if j in (j0, j1) else 1.0) * v[j, i]
    return mx, my


@compiled
def through(u, v, p, nu, j0, j1, i0, i1):
    """Return what enters a box through its sides: momentum, pressure and friction (x, y) [(m/s)^2 cells]."""
    fx, fy = 0.0, 0.0
    for side in range(2):
        i, out = (i0, -1.0) if side == 0 else (i1, 1.0)
        for j in range(j0, j1):
            un = u[j, i]
            dudx = 0.5 * (u[j, i + 1] - u[j, i - 1])
            fx += out * (2.0 * nu * dudx - un * un - 0.5 * (p[j, i - 1] + p[j, i]))
            vm = 0.25 * (v[j, i - 1] + v[j, i] + v[j + 1, i - 1] + v[j + 1, i])
            shear = 0.5 * (v[j, i] + v[j + 1, i] - v[j, i - 1] - v[j + 1, i - 1]) + 0.5 * (u[j + 1, i] - u[j - 1, i])
            fy += out * (nu * shear - un * vm)
        j, out = (j0, -1.0) if side == 0 else (j1, 1.0)
        for i in range(i0, i1):
            vn = v[j, i]
            dvdy = 0.5 * (v[j + 1, i] - v[j - 1, i])
            fy += out * (2.0 * nu * dvdy - vn * vn - 0.5 * (p[j - 1, i] + p[j, i]))
            um = 0.25 * (u[j - 1, i] + u[j, i] + u[j - 1, i + 1] + u[j, i + 1])
            shear = 0.5 * (u[j, i] + u[j, i + 1] - u[j - 1, i] - u[j - 1, i + 1]) + 0.5 * (v[j, i + 1] - v[j, i - 1])
            fx += out * (nu * shear - vn * um)
    return fx, fy


@dataclass(slots=True)
class ControlVolume:
    """A box of cells whose momentum is followed from step to step."""

    box: tuple[int, int, int, int]
    """Padded cell indices j0, j1, i0, i1."""
    before: np.ndarray | None = None
    """Momentum of water and bodies, and flow through the sides, at the last step, shape (3, 2)."""

    def force(self, water: Fluid, dt: float, push: tuple[float, ...], density: float) -> tuple[float, float]:
        """Return the mean force on the bodies in the box over the step that just ended [N/m].

        Not a number in the first step.
        """
        h = water.grid.cell
        mu0_u = water.mu0[0]
        inner_u, inner_v = water.carried
        nu = float(water.nu)
        now = np.array(
            [
                momentum(water.u, water.v, *self.box), momentum(inner_u, inner_v, *self.box),
                through(water.u, water.v, water.p, nu, *self.box),
            ]
        )  # fmt: skip
        old, self.before = self.before, now
        if old is None:
            return float("nan"), float("nan")
        cells = (self.box[1] - self.box[0]) * (self.box[3] - self.box[2])
        inside = (1 - mu0_u).sum(dtype=np.float64)
        rate = (now[0] - now[1] - old[0] + old[1]) * h * h / dt
        body = (cells - inside) * h * h * np.array(push)
        total = density * (h * 0.5 * (now[2] + old[2]) - rate + body)
        return float(total[0]), float(total[1])


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
