"""What there is to see of a flow: velocity, pressure and vorticity on plain grids."""

import numpy as np

from suchus.flow.compiled import PAD
from suchus.flow.force import edge_mean
from suchus.flow.log import Log
from suchus.flow.rake import Sample, read
from suchus.flow.record import Record
from suchus.flow.setup import Setup
from suchus.flow.water import Water


class Fields:
    """Views of the water of a simulation, without the cells around the domain."""

    setup: Setup
    water: Water
    time: float
    """How far the run has come [s]."""
    frame: np.ndarray
    """Position and velocity of the grid, shape (2, 2) [m, m/s]."""
    _log: Log

    @property
    def record(self) -> Record:
        """The time series so far."""
        return self._log.record

    def probe(self, points: np.ndarray | tuple[float, float]) -> Sample:
        """Return velocity and pressure at points of the world, shape (point, 2) or one (x, y) [m].

        Raises:
            InvalidDesign: a point that is not in the domain.
        """
        return read(self.water, np.asarray(points, float), self.frame, self.setup.density)

    @property
    def velocity(self) -> tuple[np.ndarray, np.ndarray]:
        """Velocity relative to the grid at the cell centres, two arrays of shape (ny, nx) [m/s]."""
        u, v = self.water.u, self.water.v
        inner = np.s_[PAD:-PAD, PAD:-PAD]
        return (
            0.5 * (u[inner] + u[PAD:-PAD, PAD + 1 : u.shape[1] - PAD + 1]),
            0.5 * (v[inner] + v[PAD + 1 : v.shape[0] - PAD + 1, PAD:-PAD]),
        )

    @property
    def pressure(self) -> np.ndarray:
        """Pressure at the cell centres, zero on the average along the sides, shape (ny, nx) [Pa]."""
        p = self.water.p
        return self.setup.density * (p[PAD:-PAD, PAD:-PAD] - self.water.dtype(edge_mean(p)))

    @property
    def vorticity(self) -> np.ndarray:
        """Vorticity at the inner corners of the cells, shape (ny - 1, nx - 1) [1/s]."""
        u, v = self.water.u, self.water.v
        a, b = PAD + 1, -PAD
        return ((v[a:b, a:b] - v[a:b, a - 1 : b - 1]) - (u[a:b, a:b] - u[a - 1 : b - 1, a:b])) / self.setup.grid.cell

    @property
    def vorticity_at_centres(self) -> np.ndarray:
        """Vorticity at the cell centres, mean of the four corners, shape (ny, nx) [1/s]."""
        u, v = self.water.u, self.water.v
        a, b = PAD, -PAD
        here, low = np.s_[a : b + 1], np.s_[a - 1 : b]
        corners = (v[here, here] - v[here, low]) - (u[here, here] - u[low, here])
        sums = (corners[1:, 1:] + corners[1:, :-1]) + (corners[:-1, 1:] + corners[:-1, :-1])
        values: np.ndarray = sums / (4 * self.setup.grid.cell)
        return values

    @property
    def fluid_share(self) -> np.ndarray:
        """Share of the fluid at the cell centres, 0 inside the bodies and 1 outside, shape (ny, nx) [-]."""
        mu0_u, mu0_v = self.water.mu0
        a, b = PAD, -PAD
        return 0.25 * (
            mu0_u[a:b, a:b] + mu0_u[a:b, a + 1 : mu0_u.shape[1] + b + 1]
            + mu0_v[a:b, a:b] + mu0_v[a + 1 : mu0_v.shape[0] + b + 1, a:b]
        )  # fmt: skip
