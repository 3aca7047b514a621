# mypy: disable-error-code="no-untyped-def"
# (the kernels get their types from numba)
"""Points along the outline or over the skin of a body, where loads are sampled."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from suchus.flow.compiled import compiled


@dataclass(frozen=True, slots=True, kw_only=True)
class Markers:
    """Points along an outline, counter-clockwise, or spread over a skin in space."""

    points: np.ndarray
    """Where, shape (axis, marker) [m]."""
    weight: np.ndarray
    """Length of outline or area of skin per marker, shape (marker,) [m, m^2]."""
    velocities: np.ndarray
    """Velocity of the surface, shape (axis, marker) [m/s]."""
    normals: np.ndarray
    """Outward normal, shape (axis, marker) [-]."""
    spins: np.ndarray
    """Angular velocity of the surface there, about z in the plane, shape (1, marker), else (3, marker) [rad/s]."""
    part_index: np.ndarray | None = None
    """Index of the body's part that each belongs to, shape (marker,); None for a body of one part [-]."""
    station: np.ndarray = field(default_factory=lambda: np.zeros(0))
    """Where along a plane body: arc length of the midline, or of the outline where there is no midline; empty in
    space [m]."""
    side: np.ndarray = field(default_factory=lambda: np.zeros(0))
    """+1 on the left of a plane body's midline, -1 on the right, 0 where there is no midline; empty in space [-]."""

    @property
    def x(self) -> np.ndarray:
        """Position along x [m]."""
        x: np.ndarray = self.points[0]
        return x

    @property
    def y(self) -> np.ndarray:
        """Position along y [m]."""
        y: np.ndarray = self.points[1]
        return y

    def select(self, mask: np.ndarray) -> "Markers":
        """Return the markers that a mask of shape (marker,) selects."""
        station, side = (array[mask] if array.size else array for array in (self.station, self.side))
        return Markers(
            points=self.points[:, mask], weight=self.weight[mask], velocities=self.velocities[:, mask],
            normals=self.normals[:, mask], spins=self.spins[:, mask],
            part_index=None if self.part_index is None else self.part_index[mask], station=station, side=side,
        )  # fmt: skip


def kernel_array(values: ArrayLike) -> np.ndarray:
    """Return a copy for the kernels, of one type: they are compiled anew for strided and for read-only arrays."""
    return np.array(values, float, order="C")


@compiled
def max_speed(velocities, stream):
    """Return the fastest speed of markers past a stream [m/s]; a NaN stays one.

    Args:
        velocities: shape (axis, marker) [m/s].
        stream: velocity of the stream, shape (axis,) [m/s].
    """
    max_square = 0.0
    for k in range(velocities.shape[1]):
        square = 0.0
        for d in range(velocities.shape[0]):
            square += (velocities[d, k] - stream[d]) ** 2
        max_square = max_square if square <= max_square or max_square != max_square else square
    return np.sqrt(max_square)


@compiled
def extent(points):
    """Return the largest extent of points along an axis, shape (axis, marker) [m]."""
    max_extent = 0.0
    for d in range(points.shape[0]):
        min_coordinate, max_coordinate = points[d, 0], points[d, 0]
        for k in range(points.shape[1]):
            min_coordinate, max_coordinate = min(min_coordinate, points[d, k]), max(max_coordinate, points[d, k])
        max_extent = max(max_extent, max_coordinate - min_coordinate)
    return max_extent
