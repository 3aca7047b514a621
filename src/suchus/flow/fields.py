"""What there is to see of a flow: velocity, pressure and vorticity on plain grids."""

from collections.abc import Iterator

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
    def velocity(self) -> tuple[np.ndarray, ...]:
        """Velocity relative to the grid at the cell centres, along each axis, shape (ny, nx) or (nz, ny, nx) [m/s]."""
        return tuple(0.5 * (low + high) for low, high in self._faces(self.water.velocity))

    @staticmethod
    def _faces(a: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Yield, axis by axis, the values on the faces before and behind the cells of a field on faces."""
        axes, cells = len(a), slice(PAD, -PAD)
        for d, part in enumerate(a):
            behind = tuple(slice(PAD + 1, 1 - PAD) if axes - 1 - n == d else cells for n in range(axes))
            yield part[(cells,) * axes], part[behind]

    @property
    def pressure(self) -> np.ndarray:
        """Pressure at the cell centres, zero on the average along the sides, shape (ny, nx) or (nz, ny, nx) [Pa]."""
        p = self.water.p
        return self.setup.density * (p[(slice(PAD, -PAD),) * p.ndim] - self.water.dtype(edge_mean(p)))

    @property
    def vorticity(self) -> np.ndarray:
        """Vorticity of a plane flow at the inner corners of the cells, shape (ny - 1, nx - 1) [1/s]."""
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
        """Share of the fluid at the cell centres, 0 inside the bodies and 1 outside, shape as the pressure's [-]."""
        faces = list(self._faces(self.water.mu0))
        total: np.ndarray = faces[0][0] + faces[0][1]
        for low, high in faces[1:]:
            total = total + low + high
        return 0.5 / self.water.axes * total
