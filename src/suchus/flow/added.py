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
    share_u, share_v = ((1 - m[here].astype(np.float64)) * mine for m, mine in zip(water.passage, own, strict=True))
    rx, ry, skin = markers.x - about[0], markers.y - about[1], water.offset * h * markers.length
    rims = np.array([[skin, 0 * skin, -ry * skin], [0 * skin, skin, rx * skin]])  # component, mode, marker
    rim = np.array([*rims.sum(axis=2), (rx * rims[1] - ry * rims[0]).sum(axis=1)])
    rises, shores, inward = [], [], []
    for au, av in modes:
        scale = max(float(np.abs(au).max()), float(np.abs(av).max()))
        potential = water.potential(np.stack([share_u * au, share_v * av]) / scale, _LIMIT)
        shores.append([scale * line.astype(np.float64) for line in water.along_sides(potential)])
        near = potential[j0 - 1 : j1 + 1, i0 - 1 : i1 + 1].astype(np.float64)
        rises.append((scale * (near[1:, 1:] - near[1:, :-1]), scale * (near[1:, 1:] - near[:-1, 1:])))
        inward.append([scale * side for side in water.answer(np.stack([share_u * au, share_v * av]) / scale)])
    held, own_mass = (
        h * h * np.array([[(a * share_u * p).sum() + (b * share_v * q).sum() for p, q in what] for a, b in modes])
        for what in (rises, modes)
    )
    return density * (_in_open_water(held, own_mass, shores, inward, h) + rim)


def _in_open_water(
    held: np.ndarray, own: np.ndarray, shores: list[list[np.ndarray]], inward: list[list[np.ndarray]], h: float
) -> np.ndarray:
    """Return the added mass in open water from that with the sides held.

    The sides move as the water and the body together, ``held + own``, make them. What that does to the body needs no
    further solve: by Green's theorem it is the potential along the sides times their velocity.

    Args:
        held: added mass with the sides held, over the density, shape (3, 3).
        own: mass of the body's region, over the density, shape (3, 3).
        shores: potential along each side, per mode [m/s^2 cells].
        inward: velocity that each mode induces on each side, per mode; empty in other water [m/s^2].
        h: cell [m].
    """
    if not inward[0]:
        return held
    gain = np.array([[sum(float((p * q).sum()) for p, q in zip(a, b, strict=True)) for b in inward] for a in shores])
    answer = np.linalg.solve((held + own).T, h * h * gain.T).T  # per momentum of the mode
    open_water: np.ndarray = np.linalg.solve(np.eye(3) - answer, held + answer @ own)
    return open_water
