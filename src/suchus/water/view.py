"""What is kept of the fields around a body: the part around it and its wake."""

from typing import Any

import numpy as np
import xarray as xr

from suchus import flow

SPINE = (("x", "m"), ("y", "m"), ("heading", "rad"), ("half_width", "m"))
"""Quantities of a midline that are stored, with units."""


class View:
    """A window of the grid, in its corners, and what is seen through it."""

    def __init__(self, grid: flow.Grid, length: float, behind: float, beside: float) -> None:
        """Open a window from a third of a length ahead of the snout.

        Args:
            grid: the cells.
            length: of the body [m].
            behind: end of the window, from the snout [body length].
            beside: half of its width [body length].
        """
        x, y = grid.x[:-1] + 0.5 * grid.cell, grid.y[:-1] + 0.5 * grid.cell
        columns = np.flatnonzero((x > -0.35 * length) & (x < behind * length))
        rows = np.flatnonzero(np.abs(y) < beside * length)
        self._window = np.s_[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
        self.x, self.y = x[self._window[1]], y[self._window[0]]

    def fields(self, sim: flow.Simulation) -> dict[str, np.ndarray]:
        """Return vorticity, pressure and velocity in the window, all at the corners of the cells.

        The velocity is that of the water in the world, whatever the grid does.
        """
        u, v = sim.velocity
        return {
            "vorticity": sim.vorticity[self._window].astype(np.float32),
            "pressure": self._between(sim.pressure),
            "u": self._between(u + sim.frame[1, 0]),
            "v": self._between(v + sim.frame[1, 1]),
        }

    def _between(self, values: np.ndarray) -> np.ndarray:
        corners = 0.25 * (values[1:, 1:] + values[1:, :-1] + values[:-1, 1:] + values[:-1, :-1])
        return np.asarray(corners[self._window], np.float32)

    def dataset(self, page: dict[str, np.ndarray], axis: str) -> xr.Dataset:
        """Return noted fields and midlines along an axis, with units."""
        units = {"vorticity": "1/s", "pressure": "Pa", "u": "m/s", "v": "m/s"}
        found: dict[str, Any] = {
            name: ((axis, "y", "x"), page[name], {"units": unit}) for name, unit in units.items() if name in page
        }
        for name, unit in SPINE:
            found[f"midline_{name}"] = ((axis, "station"), page[f"midline_{name}"], {"units": unit})
        return xr.Dataset(found, coords={"x": ("x", self.x, {"units": "m"}), "y": ("y", self.y, {"units": "m"})})


def midline(sim: flow.Simulation) -> flow.Spine:
    """Return the midline of the only body, in the frame of the grid."""
    body, (position, _) = sim.setup.bodies[0], sim.frame
    placed = body.shape.spine(sim.time).placed(sim.pose(body.name))  # type: ignore[union-attr]
    return flow.Spine(
        x=placed.x - position[0],
        y=placed.y - position[1],
        heading=placed.heading,
        half_width=placed.half_width,
        x_rate=placed.x_rate,
        y_rate=placed.y_rate,
        heading_rate=placed.heading_rate,
    )


def kept(spine: flow.Spine) -> dict[str, np.ndarray]:
    """Return what a diary keeps of a midline."""
    return {f"midline_{name}": getattr(spine, name) for name, _ in SPINE}
