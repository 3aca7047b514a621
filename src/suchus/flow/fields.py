"""Fields of a flow for the user: velocity, pressure and vorticity without the padding."""

from collections.abc import Iterator

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.flow.compiled import PAD
from suchus.flow.log import Log
from suchus.flow.rake import Sample, sample_water
from suchus.flow.record import Record
from suchus.flow.setup import Setup
from suchus.flow.water import Fluid


class Fields:
    """Views of the water of a simulation, without the cells around the domain."""

    setup: Setup
    water: Fluid
    time: float
    """Time that the run has reached [s]."""
    frame: np.ndarray
    """Position and velocity of the grid, shape (2, 2) [m, m/s]."""
    _log: Log

    @property
    def record(self) -> Record:
        """The time series so far."""
        return self._log.record

    @property
    def domain(self) -> "Fields":
        """The fields of the whole domain on the coarser cells, if there is a patch; else these fields."""
        return self if len(self.water.layers) == 1 else _Domain(self)

    def probe(self, points: np.ndarray | tuple[float, ...]) -> Sample:
        """Return velocity and pressure at points of the world, shape (point, axis) or one (x, y) or (x, y, z) [m].

        Raises:
            InvalidDesign: a point that is not in the domain.
        """
        return sample_water(self.water, np.asarray(points, float), self.frame, self.setup.density)

    @property
    def velocity(self) -> tuple[np.ndarray, ...]:
        """Velocity relative to the grid at the cell centres, along each axis, shape (ny, nx) or (nz, ny, nx) [m/s]."""
        return tuple(0.5 * (lower_faces + upper_faces) for lower_faces, upper_faces in self._faces(self.water.velocity))

    @staticmethod
    def _faces(a: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
        """Yield, axis by axis, the values on the faces before and behind the cells of a field on faces.

        Args:
            a: field on the faces before the cells, padded, shape (axis, ...).
        """
        ndim, cells = len(a), slice(PAD, -PAD)
        for d, component in enumerate(a):
            upper_slices = tuple(slice(PAD + 1, 1 - PAD) if ndim - 1 - n == d else cells for n in range(ndim))
            yield component[(cells,) * ndim], component[upper_slices]

    @property
    def pressure(self) -> np.ndarray:
        """Pressure at the cell centres, zero on the average along the sides, shape (ny, nx) or (nz, ny, nx) [Pa]."""
        p = self.water.p
        return self.setup.density * (p[(slice(PAD, -PAD),) * p.ndim] - self.water.dtype(self.water.level))

    @property
    def vorticity(self) -> np.ndarray:
        """Vorticity of a plane flow at the inner corners of the cells, shape (ny - 1, nx - 1) [1/s].

        Raises:
            InvalidDesign: in space, where ``vorticity_at_centres`` has it.
        """
        if self.water.ndim == 3:
            raise InvalidDesign(
                "the vorticity at corners is for plane grids, and this one has three axes; take vorticity_at_centres."
            )
        u, v = self.water.u, self.water.v
        a, b = PAD + 1, -PAD
        return ((v[a:b, a:b] - v[a:b, a - 1 : b - 1]) - (u[a:b, a:b] - u[a - 1 : b - 1, a:b])) / self.water.grid.cell

    @property
    def vorticity_at_centres(self) -> np.ndarray:
        """Vorticity at the cell centres, mean of the four corners or edges around them [1/s].

        Shape (ny, nx) in the plane; in space the component comes first, (3, nz, ny, nx).
        """
        if self.water.ndim == 2:
            return self._vorticity_about(0, 1)
        return np.stack([self._vorticity_about(d, e) for d, e in ((1, 2), (2, 0), (0, 1))])

    def _vorticity_about(self, d: int, e: int) -> np.ndarray:
        """Return the vorticity at the cell centres about the axis of the turn from axis ``d`` to axis ``e`` [1/s]."""
        velocity = self.water.velocity
        ndim = len(velocity)
        cells = [slice(PAD, 1 - PAD) if ndim - 1 - n in (d, e) else slice(PAD, -PAD) for n in range(ndim)]

        def corners(a: np.ndarray, back: int) -> np.ndarray:
            """Return the values at the low corners, or one cell before them along an axis."""
            return a[tuple(slice(PAD - 1, -PAD) if ndim - 1 - n == back else s for n, s in enumerate(cells))]

        u, v = velocity[d], velocity[e]
        spin = (corners(v, -1) - corners(v, d)) - (corners(u, -1) - corners(u, e))
        spin = np.moveaxis(spin, (ndim - 1 - e, ndim - 1 - d), (0, 1))
        sums = (spin[1:, 1:] + spin[1:, :-1]) + (spin[:-1, 1:] + spin[:-1, :-1])
        values: np.ndarray = np.moveaxis(sums, (0, 1), (ndim - 1 - e, ndim - 1 - d)) / (4 * self.water.grid.cell)
        return values

    @property
    def fluid_fraction(self) -> np.ndarray:
        """Volume fraction of the fluid in the cells, 0 inside the bodies and 1 outside, shape as the pressure's [-]."""
        faces = list(self._faces(self.water.mu0))
        total: np.ndarray = faces[0][0] + faces[0][1]
        for lower_faces, upper_faces in faces[1:]:
            total = total + lower_faces + upper_faces
        return 0.5 / self.water.ndim * total


class _Domain(Fields):
    """Fields on the coarser cells around and in a patch."""

    def __init__(self, patch: Fields) -> None:
        self.setup, self.water, self.time, self.frame = patch.setup, patch.water.layers[-1], patch.time, patch.frame
        self._log = patch._log
