"""Pressure and vorticity along the skin of a cylinder, read better than from the nearest nodes alone.

Where the solver's own ``Surface`` fits a curve through three points off the wall, this one also knows the equation of
motion at the wall, which gives the curvature of the velocity there:

    viscosity (d2u/dn2 + du/dn / R) = dp/ds / density + a

with the velocity ``u`` along the wall in the wall's frame, ``n`` off the wall, ``s`` along it, and ``a`` the wall's own
acceleration along itself. Of the vorticity ``w = du/dn`` at the wall, the curvature and two further unknown terms

    u(n) = w n + (dp/ds / density + a - viscosity w / R) n^2 / (2 viscosity) + c n^3 + d n^4

three points give ``w``. They lie 1.5 to 3.5 cells off the wall, outside the kernel that blends body and water.
"""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline, RectBivariateSpline

from suchus import flow

PLACES = (1.5, 2.5, 3.5)
"""Where the velocity is read, in cells off the wall [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class WallValues:
    """Values along the skin of a cylinder of diameter 1 in a stream of 1 with density 1, each of shape (marker,)."""

    angle: np.ndarray
    """Angle from the front, over the upper side [deg]."""
    pressure: np.ndarray
    """Pressure coefficient [-]."""
    vorticity: np.ndarray
    """Vorticity over speed per diameter, positive counter-clockwise [-]."""

    def friction(self, viscosity: float) -> float:
        """Return the friction part of the drag coefficient: the shear viscosity times vorticity along x [-]."""
        order = np.argsort(self.angle)
        turn, along = np.radians(self.angle[order]), -self.vorticity[order] * np.sin(np.radians(self.angle[order]))
        turn, along = np.append(turn, turn[0] + 2 * np.pi), np.append(along, along[0])
        return float(viscosity * np.trapezoid(along, turn))

    def curve(self, name: str) -> np.ndarray:
        """Return ``pressure`` or ``vorticity`` over the angle, shape (2, marker)."""
        order = np.argsort(self.angle)
        return np.stack([self.angle[order], getattr(self, name)[order]])


def read_skin(sim: flow.Simulation, acceleration: tuple[float, float] = (0.0, 0.0)) -> WallValues:
    """Return pressure and vorticity along a cylinder's surface at the present time.

    Args:
        sim: a simulation of a single cylinder of diameter 1 in a stream of 1 with density 1, in a grid that rests.
        acceleration: that of the cylinder [m/s^2].
    """
    surface, (body,) = sim.surface(), sim.setup.bodies
    marks, pose = surface.markers, sim.pose(body.name)
    theta = np.arctan2(marks.y - pose.position[1], marks.x - pose.position[0])
    return WallValues(
        angle=np.degrees(np.pi - theta) % 360, pressure=2 * (surface.pressure - far_pressure(sim)),
        vorticity=_vorticity(sim, theta, surface.pressure, np.array(acceleration)),
    )  # fmt: skip


def far_pressure(sim: flow.Simulation) -> float:
    """Return the pressure far away, by Bernoulli's equation from the side where the stream enters [Pa].

    The water there is free of vorticity; the mean along the side leaves out what the lift does to it.
    """
    whole = sim.domain
    u, v = (field[:, 1] for field in whole.velocity)
    stream = float(np.linalg.norm(sim.setup.far_velocity(sim.time)))
    return float(np.mean(whole.pressure[:, 1] + 0.5 * sim.setup.density * (u**2 + v**2 - stream**2)))


def _vorticity(sim: flow.Simulation, theta: np.ndarray, pressure: np.ndarray, acceleration: np.ndarray) -> np.ndarray:
    setup, radius = sim.setup, 0.5
    pose = sim.pose(setup.bodies[0].name)
    normal, along = np.stack([np.cos(theta), np.sin(theta)]), np.stack([-np.sin(theta), np.cos(theta)])
    slope = periodic_slope(theta, pressure) / radius
    nu = setup.viscosity
    known = (slope / setup.density + acceleration @ along) / nu
    velocity = _velocity(sim)
    off = np.array(PLACES) * setup.grid.cell
    rows = []
    for n in off:
        point = np.array(pose.position)[:, None] + (radius + n) * normal
        tangential = along[0] * (velocity[0](point) - pose.velocity[0]) + along[1] * (
            velocity[1](point) - pose.velocity[1]
        )
        rows.append(tangential - known * n**2 / 2)
    return wall_slope(off, np.stack(rows), radius)


def wall_slope(off: np.ndarray, rest: np.ndarray, radius: float) -> np.ndarray:
    """Return the slope at the wall of ``w (n - n^2 / (2 R)) + c n^3 + d n^4`` through three points of each column.

    Args:
        off: distances from the wall, shape (3,) [m].
        rest: the values there, shape (3, marker) [m/s].
        radius: R of the wall [m].
    """
    terms = np.stack([off - off**2 / (2 * radius), off**3, off**4], axis=1)
    slope: np.ndarray = np.linalg.solve(terms, rest)[0]
    return slope


def periodic_slope(theta: np.ndarray, value: np.ndarray) -> np.ndarray:
    """Return the derivative over the angle of values around a circle, shape (marker,) [1/rad]."""
    order = np.argsort(theta)
    turn, once = theta[order], value[order]
    spline = CubicSpline(np.append(turn, turn[0] + 2 * np.pi), np.append(once, once[0]), bc_type="periodic")
    slope = np.empty_like(value)
    slope[order] = spline(turn, 1)
    return slope


class _Component:
    """One component of the velocity at any point near the body, by a cubic spline between its faces."""

    def __init__(self, x: np.ndarray, y: np.ndarray, field: np.ndarray) -> None:
        self._spline = RectBivariateSpline(y, x, field)

    def __call__(self, point: np.ndarray) -> np.ndarray:
        values: np.ndarray = self._spline.ev(point[1], point[0])
        return values


def _velocity(sim: flow.Simulation) -> tuple[_Component, _Component]:
    grid, water = sim.setup.grid, sim.water
    x, y = sim.pose(sim.setup.bodies[0].name).position
    reach = 0.5 + (PLACES[-1] + 4) * grid.cell
    ny, nx = water.u.shape
    faces, mids = (
        (grid.faces(0, nx, 0), grid.faces(0, ny, 1)), (grid.centres(0, nx, 0), grid.centres(0, ny, 1))
    )  # fmt: skip
    components = []
    for field, along, up in ((water.u, faces[0], mids[1]), (water.v, mids[0], faces[1])):
        i, j = np.abs(along - x) < reach, np.abs(up - y) < reach
        components.append(_Component(along[i], up[j], np.asarray(field[np.ix_(j, i)], float)))
    return components[0], components[1]
