"""Added mass of a body, from the pressure equation that the solver itself uses."""

import numpy as np

from suchus.flow.shape import Markers
from suchus.flow.water import Water

_LIMIT = 1e-5
"""Divergence left over, relative to the accelerations [-]."""


def added_mass(water: Water, markers: Markers, about: tuple[float, float], density: float, body: int = 0) -> np.ndarray:
    """Return the added mass for accelerations along x, along y and about a point, shape (3, 3).

    The bodies must have been placed; ``body`` counts them. The force of mode k is ``-Ma[:, k]`` per unit
    acceleration; other bodies stay still. It is what ``exchange`` would find: the momentum that the immersion gives
    to the water. Units: kg/m for the first two rows and columns, kg between them and the turning, kg m for the last.

    Raises:
        NotConverged: the pressure solver got stuck.
    """
    grid, h = water.grid, water.grid.cell
    j0, j1, i0, i1 = water.window
    here, own = np.s_[j0 : j1 + 1, i0 : i1 + 1], [owner == body for owner in water.owners]
    x_mid, y_mid = grid.centres(i0, i1 + 1, 0) - about[0], grid.centres(j0, j1 + 1, 1) - about[1]
    shape = (j1 + 1 - j0, i1 + 1 - i0)
    arm_u, arm_v = np.broadcast_to(-y_mid[:, None], shape), np.broadcast_to(x_mid[None, :], shape)
    modes = ((np.ones(shape), np.zeros(shape)), (np.zeros(shape), np.ones(shape)), (arm_u, arm_v))
    share_u, share_v = ((1 - m[here].astype(np.float64)) * mine for m, mine in zip(water.mu0, own, strict=True))
    rx, ry, skin = markers.x - about[0], markers.y - about[1], water.offset * h * markers.length
    rims = np.array([[skin, 0 * skin, -ry * skin], [0 * skin, skin, rx * skin]])  # component, mode, marker
    out = np.empty((3, 3))
    for k, (au, av) in enumerate(modes):
        scale = max(float(np.abs(au).max()), float(np.abs(av).max()))
        potential = water.potential(share_u * au / scale, share_v * av / scale, _LIMIT).astype(np.float64)
        rise_u = share_u * scale * (potential[here] - potential[j0 : j1 + 1, i0 - 1 : i1])
        rise_v = share_v * scale * (potential[here] - potential[j0 - 1 : j1, i0 : i1 + 1])
        out[0, k] = h * h * rise_u.sum() + rims[0, k].sum()
        out[1, k] = h * h * rise_v.sum() + rims[1, k].sum()
        turning = (arm_u * rise_u).sum() + (arm_v * rise_v).sum()
        out[2, k] = h * h * turning + (rx * rims[1, k] - ry * rims[0, k]).sum()
    return density * out
