"""Continuation of a flow on a finer grid: the wake forms on a coarse grid, the results are those of the fine one."""

import numpy as np
from scipy.ndimage import map_coordinates

from suchus import flow
from suchus.errors import InvalidDesign
from suchus.flow.compiled import PAD


def refined(coarse: flow.Simulation, setup: flow.Setup) -> flow.Simulation:
    """Return a simulation that begins at time 0 with the velocity and pressure of another one, linear in between.

    Bodies begin where ``setup`` has them at time 0, so a periodic motion goes on if the other run ended with a whole
    period. Only for grids that rest.

    Raises:
        InvalidDesign: the two grids do not begin and end at the same places.
    """
    ours, theirs = setup.grid, coarse.setup.grid
    here, there = (np.array([grid.origin, np.add(grid.origin, grid.size)]) for grid in (ours, theirs))
    if np.abs(here - there).max() > 1e-6 * theirs.cell:
        raise InvalidDesign(
            f"a grid from {ours.origin} m of size {ours.size} m cannot go on from one from {theirs.origin} m of size "
            f"{theirs.size} m; give both the same corners."
        )
    fine = flow.Simulation(setup)
    ratio = ours.cell / theirs.cell
    for name, offsets in (("u", (0.5, 0.0)), ("v", (0.0, 0.5)), ("p", (0.5, 0.5))):
        field, old = getattr(fine.water, name), getattr(coarse.water, name)
        at = [(np.arange(n) - PAD + o) * ratio + PAD - o for n, o in zip(field.shape, offsets, strict=True)]
        field[:] = map_coordinates(
            np.asarray(old, float), np.meshgrid(*at, indexing="ij"), order=1, mode="nearest"
        )  # fmt: skip
    return fine
