"""Velocity and pressure at chosen points: at one instant, or during a run along a line or rake."""

from collections.abc import Callable
from dataclasses import dataclass, field
from math import isfinite
from typing import Protocol

import numpy as np

from suchus.core.errors import InvalidDesign, OutsideLimits
from suchus.core.kinds import is_number, show
from suchus.flow.force import interpolate, padded, steps_of
from suchus.flow.grid import Grid
from suchus.flow.water import Fluid


@dataclass(frozen=True, slots=True, kw_only=True)
class Sample:
    """The water at some points, in the world's frame."""

    points: np.ndarray
    """Positions of the points, shape (point, axis) [m]."""
    velocity: np.ndarray
    """Velocity along each axis, shape (point, axis) [m/s]."""
    pressure: np.ndarray
    """Pressure, whose mean along the sides of the domain is zero, shape (point,) [Pa]."""


def line(start: tuple[float, ...], end: tuple[float, ...], count: int) -> np.ndarray:
    """Return ``count`` points evenly spaced from ``start`` to ``end``, both included, shape (count, axis) [m].

    Raises:
        InvalidDesign: fewer than two points.
    """
    if count < 2:
        raise InvalidDesign(f"a line of {count} points; at least 2 are needed.")
    return np.linspace(np.asarray(start, float), np.asarray(end, float), count)


def sample_water(water: Fluid, points: np.ndarray, frame: np.ndarray, density: float) -> Sample:
    """Return velocity and pressure at points by linear interpolation between the nodes.

    Inside a body and within a cell of its surface, they are a mixture of the body's and the water's values.

    Args:
        water: the fields.
        points: positions, shape (point, axis), or one point (axis,) [m].
        frame: position and velocity of the grid, shape (2, axis) [m, m/s].
        density: density of the water [kg/m^3].

    Raises:
        InvalidDesign: a point that is not in the domain.
    """
    positions, ndim = np.atleast_2d(np.asarray(points, float)), water.ndim
    if positions.ndim != 2 or positions.shape[1] != ndim:
        raise InvalidDesign(
            f"the points have the shape {np.shape(points)}; give one row ({', '.join('xyz'[:ndim])}) for each point."
        )
    local = positions - frame[0]
    _check(water.layers[-1].grid, positions, local, frame[0])
    pressure, velocity = np.empty(len(positions)), np.empty((ndim, len(positions)))
    for layer in reversed(water.layers):  # the finest layer that holds a point counts
        indices = np.flatnonzero(_is_inside(layer.grid, local))
        places, steps = padded(local[indices].T, layer.grid), steps_of(layer.p)
        values = np.empty(len(indices))
        interpolate(layer.p.reshape(-1), steps, places, values)
        pressure[indices] = values
        for d, component in enumerate(layer.velocity):
            on_faces = places.copy()
            on_faces[d] += 0.5
            interpolate(component.reshape(-1), steps, on_faces, values)
            velocity[d, indices] = values
    return Sample(points=positions, velocity=velocity.T + frame[1], pressure=density * (pressure - water.level))


def _is_inside(grid: Grid, local: np.ndarray) -> np.ndarray:
    """Return which points, shape (point, axis), lie in a grid."""
    low_corner = np.array(grid.origin)
    return np.asarray(((local >= low_corner) & (local <= low_corner + grid.size)).all(axis=1))


def _check(grid: Grid, positions: np.ndarray, local: np.ndarray, frame: np.ndarray) -> None:
    """Refuse points outside the domain.

    Args:
        grid: cells of the whole domain.
        positions: points in the world frame, shape (point, axis) [m].
        local: the same points in the frame of the grid, shape (point, axis) [m].
        frame: position of the grid in the world frame, shape (axis,) [m].

    Raises:
        InvalidDesign: naming a point and the bounds of the domain.
    """
    outside_indices = np.flatnonzero(~_is_inside(grid, local))
    if outside_indices.size:
        low_corner, high_corner = np.array(grid.origin), np.array(grid.origin) + grid.size
        point = ", ".join(f"{coordinate:.4g}" for coordinate in positions[outside_indices[0]])
        ends = ", ".join(
            f"{axis} = {lower_bound:.4g} to {upper_bound:.4g} m"
            for axis, lower_bound, upper_bound in zip("xyz", low_corner + frame, high_corner + frame, strict=False)
        )
        raise InvalidDesign(f"the point ({point}) m is outside the domain {ends}; give points in it.")


class _Probed(Protocol):
    @property
    def time(self) -> float: ...

    def probe(self, points: np.ndarray) -> Sample: ...


RakePoints = np.ndarray | Callable[[float], np.ndarray]
"""Points of shape (point, axis) [m], or a function of the time [s] that returns them."""


@dataclass(slots=True)
class Rake:
    """Samples velocity and pressure at points during a run: ``simulation.run(..., watch=rake)``.

    Raises:
        InvalidDesign: in the run, if a point leaves the domain.
    """

    points: RakePoints
    """Positions of the points; a function of time for a rake that travels [m]."""
    interval: float | None = None
    """Interval of the samples [s]; None samples after every step."""
    _times: list[float] = field(default_factory=list)
    _samples: list[Sample] = field(default_factory=list)
    _due: float = 0.0

    def __call__(self, sim: _Probed) -> None:
        """Record the water at the points if the interval has passed."""
        if sim.time < self._due:
            return
        self._due = due_after(sim.time, self.interval)
        self._samples.append(sim.probe(self.points(sim.time) if callable(self.points) else self.points))
        self._times.append(sim.time)

    @property
    def time(self) -> np.ndarray:
        """Times of the notes, shape (time,) [s]."""
        return np.array(self._times)

    @property
    def velocity(self) -> np.ndarray:
        """Velocity in the world's frame, shape (time, point, axis) [m/s]."""
        return np.array([sample.velocity for sample in self._samples])

    @property
    def pressure(self) -> np.ndarray:
        """Pressure, zero on the average along the sides of the domain, shape (time, point) [Pa]."""
        return np.array([sample.pressure for sample in self._samples])


def due_after(time: float, interval: float | None) -> float:
    """Return the next multiple of an interval after a time [s]; 0, which has always passed, if the interval is None.

    Raises:
        OutsideLimits: the interval is not a positive number.
    """
    if interval is not None and not (is_number(interval) and isfinite(interval) and interval > 0):
        raise OutsideLimits(
            f"the interval of watch is {show(interval)} s; give a positive number, or None to watch every step."
        )
    return 0.0 if interval is None else float((np.floor(time / interval * (1 + 1e-12)) + 1) * interval * (1 - 1e-12))
