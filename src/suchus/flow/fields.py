"""What there is to see of a flow: velocity, pressure and vorticity on plain grids."""

import numpy as np

from suchus.flow.compiled import PAD
from suchus.flow.force import edge_mean
from suchus.flow.setup import Setup
from suchus.flow.water import Water


class Fields:
    """Views of the water of a simulation, without the cells around the domain."""

    setup: Setup
    water: Water

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
    def fluid_share(self) -> np.ndarray:
        """Share of the fluid at the cell centres, 0 inside the bodies and 1 outside, shape (ny, nx) [-]."""
        mu0_u, mu0_v = self.water.mu0
        a, b = PAD, -PAD
        return 0.25 * (
            mu0_u[a:b, a:b] + mu0_u[a:b, a + 1 : mu0_u.shape[1] + b + 1]
            + mu0_v[a:b, a:b] + mu0_v[a + 1 : mu0_v.shape[0] + b + 1, a:b]
        )  # fmt: skip
