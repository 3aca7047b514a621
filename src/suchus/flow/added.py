"""Added mass of a body, from the pressure equation that the solver itself uses."""

import numpy as np

from suchus.flow.force import GAP, Surface, padded
from suchus.flow.probe import wall_pressure
from suchus.flow.shape import Markers
from suchus.flow.water import Water

_LIMIT = 1e-5
"""Divergence left over, relative to the accelerations [-]."""


def added_mass(water: Water, markers: Markers, about: tuple[float, float], density: float) -> np.ndarray:
    """Return the added mass for accelerations along x, along y and about a point, shape (3, 3).

    The bodies must have been placed. The force of mode k is ``-Ma[:, k]`` per unit acceleration; other bodies
    stay still. Units: kg/m for the first two rows and columns, kg between them and the turning, kg m for the last.

    Raises:
        NotConverged: the pressure solver got stuck.
    """
    grid, h = water.grid, water.grid.cell
    j0, j1, i0, i1 = water.window
    here = np.s_[j0 : j1 + 1, i0 : i1 + 1]
    x_mid, y_mid = grid.centres(i0, i1 + 1, 0) - about[0], grid.centres(j0, j1 + 1, 1) - about[1]
    shape = (j1 + 1 - j0, i1 + 1 - i0)
    modes = (
        (np.ones(shape), np.zeros(shape)),
        (np.zeros(shape), np.ones(shape)),
        (np.broadcast_to(-y_mid[:, None], shape), np.broadcast_to(x_mid[None, :], shape)),
    )
    mu0_u, mu0_v = (m[here].astype(np.float64) for m in water.mu0)
    px, py = padded(markers, grid)
    out = np.empty((3, 3))
    for k, (au, av) in enumerate(modes):
        scale = max(float(np.abs(au).max()), float(np.abs(av).max()))
        u, v = (1 - mu0_u) * au / scale, (1 - mu0_v) * av / scale
        potential = water.potential(u, v, _LIMIT)
        pressure = np.empty(px.size)
        wall_pressure(potential, px, py, markers.normal_x, markers.normal_y, GAP, pressure)
        surface = Surface(markers=markers, pressure=density * h * scale * pressure, shear=np.zeros((2, px.size)))
        load = surface.load(about)
        out[:, k] = [-load.force[0], -load.force[1], -load.torque]
    return out
