# ruff: noqa: ARG002 - rigid and bending shapes share one interface, rigid ones ignore the time
"""Shapes of bodies: a signed distance, a normal and a velocity at points, and markers along the outline.

Distances are negative inside; normals point into the water.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import lru_cache
from math import isfinite
from typing import ClassVar

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.core.kinds import is_number, show
from suchus.flow.ellipsoid import measure_ellipse
from suchus.flow.markers import Markers
from suchus.flow.mass import Mass, of_outline
from suchus.flow.pose import Pose
from suchus.flow.rigid import pose_row, ring_bounds, to_body_points, to_world_field, to_world_skin


@dataclass(slots=True)
class Field:
    """Distance, normal and velocity of a body at the points of a window, each array of shape (y, x)."""

    distance: np.ndarray
    """Signed distance to the surface, negative inside [m]."""
    normal_x: np.ndarray
    """Outward normal along x [-]."""
    normal_y: np.ndarray
    """Outward normal along y [-]."""
    velocity_x: np.ndarray
    """Velocity of the body along x, extended smoothly a few cells into the water [m/s]."""
    velocity_y: np.ndarray
    """Velocity of the body along y, extended likewise [m/s]."""
    thickness: np.ndarray
    """Thickness of the body behind the nearest point of its surface, infinite where it is thick [m]."""
    part_index: np.ndarray | None = None
    """Index of the body's part to which a point belongs; None for a body of one part [-]."""

    @property
    def normal(self) -> tuple[np.ndarray, ...]:
        """Outward normal, along each axis [-]."""
        return self.normal_x, self.normal_y

    @property
    def velocity(self) -> tuple[np.ndarray, ...]:
        """Velocity of the body, along each axis [m/s]."""
        return self.velocity_x, self.velocity_y


class Shape(ABC):
    """A body's shape in its own frame, in the plane; it may change with time."""

    ndim: ClassVar[int] = 2

    @abstractmethod
    def measure(self, x: np.ndarray, y: np.ndarray, time: float, pose: Pose, reach: float) -> Field:
        """Return the field on the points of a window, axes ``x`` (nx,) and ``y`` (ny,) [m].

        Only distances below ``reach`` [m] need be exact.
        """

    @abstractmethod
    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return markers along the outline, about ``spacing`` [m] apart."""

    @abstractmethod
    def bounds(self, time: float, pose: Pose) -> tuple[float, float, float, float]:
        """Return the smallest rectangle around the body: x0, x1, y0, y1 [m]."""

    @abstractmethod
    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return stations along the body and its thickness there, two arrays of one shape [m]."""

    @abstractmethod
    def mass(self, time: float) -> Mass:
        """Return area, centre and moments in the body's own frame."""

    def centreline(self, time: float, pose: Pose) -> np.ndarray | None:
        """Return the line in the middle of a thin body, through which no water passes, shape (2, point) [m].

        None for a body that is never thin.

        Args:
            time: time [s].
            pose: pose of the body's frame.
        """
        return None

    @property
    def rigid(self) -> bool:
        """Whether the shape never changes."""
        return True


def _whole(values: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Return values at the points of a window as an array of its shape, its numbers end to end."""
    return np.ascontiguousarray(np.broadcast_to(values, shape) if np.shape(values) != shape else values, float)


_COARSE_POINTS, _MIN_POINTS = 256, 32
"""Points with which the length of an outline is measured, and fewest points of the markers [-]."""


def check_positive(name: str, value: float) -> None:
    """Refuse a length that is not a positive number.

    Args:
        name: name of the length, for the message.
        value: the length [m].

    Raises:
        InvalidDesign: naming the value.
    """
    if not (is_number(value) and isfinite(value) and value > 0):
        raise InvalidDesign(f"{name} is {show(value)} m; a positive length is needed.")


class Solid(Shape):
    """A rigid shape, defined by its distance and outline in its own frame; the pose is applied here."""

    @abstractmethod
    def distance(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return signed distance and outward normal at points of the body's frame [m]."""

    @abstractmethod
    def outline(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return ``count`` points around the outline, counter-clockwise, about evenly spaced [m]."""

    def measure(self, x: np.ndarray, y: np.ndarray, time: float, pose: Pose, reach: float) -> Field:
        """Return distance, normal and velocity on the points of a window; see ``Shape``."""
        row, shape = pose_row(pose), (y.size, x.size)
        body_points, field = np.empty((2, *shape)), np.empty((4, *shape))
        to_body_points(body_points, x, y, row)
        d, nx, ny = (_whole(a, shape) for a in self.distance(*body_points))
        to_world_field(field, nx, ny, x, y, row)
        return Field(d, field[0], field[1], field[2], field[3], np.full(shape, np.inf))

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return markers at the centres of the outline's edges; see ``Shape``."""
        centres, body_normals, length, station = _edges(self, float(spacing))
        points, normals, velocities = np.empty((3, *centres.shape))
        to_world_skin(points, normals, velocities, centres, body_normals, pose_row(pose))
        return Markers(
            points=points,
            weight=length,
            velocities=velocities,
            normals=normals,
            spins=np.full((1, length.size), pose.spin),
            station=station,
            side=np.zeros(length.size),
        )

    def bounds(self, time: float, pose: Pose) -> tuple[float, float, float, float]:
        """Return the rectangle around the outline."""
        x0, x1, y0, y1 = ring_bounds(*_ring(self, _COARSE_POINTS), pose_row(pose))
        return x0, x1, y0, y1

    def mass(self, time: float) -> Mass:
        """Return area, centre and moments of the outline's polygon."""
        return of_outline(*self.outline(2048))


def _ring(shape: Solid, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return ``count`` points around the outline in the body's frame [m].

    The outline is rigid. The points are cached if the shape is hashable.
    """
    try:
        return _cached_ring(shape, count)
    except TypeError:
        return _measure_ring(shape, count)


@lru_cache(maxsize=64)
def _cached_ring(shape: Solid, count: int) -> tuple[np.ndarray, np.ndarray]:
    return _measure_ring(shape, count)


def _measure_ring(shape: Solid, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return what ``_ring`` does, without a cache; the arrays are to be read only."""
    x, y = (np.array(line, float) for line in shape.outline(count))
    x.flags.writeable = y.flags.writeable = False
    return x, y


Edges = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
"""Edges of an outline in the body's frame: centres and outward normals, shape (2, edge) [m, -], their lengths and the
arc lengths of their middles, shape (edge,) [m]."""


def _edges(shape: Solid, spacing: float) -> Edges:
    """Return about evenly spaced edges of the outline.

    The outline is rigid. The edges are cached if the shape is hashable.

    Args:
        shape: the shape.
        spacing: length of an edge [m].
    """
    try:
        return _cached_edges(shape, spacing)
    except TypeError:
        return _measure_edges(shape, spacing)


@lru_cache(maxsize=64)
def _cached_edges(shape: Solid, spacing: float) -> Edges:
    return _measure_edges(shape, spacing)


def _measure_edges(shape: Solid, spacing: float) -> Edges:
    """Return what ``_edges`` does, without a cache; the arrays are to be read only."""
    coarse_ring = np.stack(_ring(shape, _COARSE_POINTS))
    perimeter = float(np.hypot(*(np.roll(coarse_ring, -1, axis=1) - coarse_ring)).sum())
    corners = np.stack(_ring(shape, max(_MIN_POINTS, int(np.ceil(perimeter / spacing)))))
    next_corners = np.roll(corners, -1, axis=1)
    edges = next_corners - corners
    length = np.hypot(*edges)
    normals = np.stack([edges[1], -edges[0]]) / length
    measured = (corners + next_corners) / 2, normals, length, np.cumsum(length) - length / 2
    for array in measured:
        array.flags.writeable = False
    return measured


@dataclass(frozen=True, slots=True, kw_only=True)
class Cylinder(Solid):
    """A circle."""

    diameter: float
    """Diameter [m]."""

    def __post_init__(self) -> None:
        check_positive("diameter", self.diameter)

    def distance(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return signed distance and outward normal."""
        r = np.maximum(np.hypot(x, y), 1e-12 * self.diameter)
        return r - self.diameter / 2, x / r, y / r

    def outline(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return points on the circle; their polygon has the circle's own area and length to second order."""
        turn = np.linspace(0, 2 * np.pi, count, endpoint=False)
        return self.diameter / 2 * np.cos(turn), self.diameter / 2 * np.sin(turn)

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the diameter."""
        return np.zeros(1), np.full(1, self.diameter)


@dataclass(frozen=True, slots=True, kw_only=True)
class Ellipse(Solid):
    """An ellipse with its axes along the body's axes."""

    length: float
    """Full axis along the body's x [m]."""
    width: float
    """Full axis along the body's y [m]."""

    def __post_init__(self) -> None:
        check_positive("length", self.length)
        check_positive("width", self.width)

    def distance(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return signed distance [m] and outward normal [-], by Newton's method for the nearest point."""
        px, py = x, y
        if x.shape != y.shape or not (x.flags.c_contiguous and y.flags.c_contiguous):
            px, py = (np.ascontiguousarray(coordinate, float) for coordinate in np.broadcast_arrays(x, y))
        fields = np.empty((3, px.size))
        measure_ellipse(fields, px.ravel(), py.ravel(), np.array([self.length / 2, self.width / 2]))
        d, nx, ny = fields.reshape(3, *px.shape)
        return d, nx, ny

    def outline(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return ``count`` points around the ellipse, evenly spaced along it [m]."""
        fine = np.linspace(0, 2 * np.pi, 8 * count + 1)
        x, y = self.length / 2 * np.cos(fine), self.width / 2 * np.sin(fine)
        arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        turn = np.interp(np.linspace(0, arc[-1], count, endpoint=False), arc, fine)
        return self.length / 2 * np.cos(turn), self.width / 2 * np.sin(turn)

    def centreline(self, time: float, pose: Pose) -> np.ndarray:
        """Return the part of the longer axis at which the ellipse is narrower than it is far from its tip [m].

        The shape is (2, 2).
        """
        a, b = self.length / 2, self.width / 2
        reach = (a if a > b else b) * abs(a * a - b * b) / (a * a + b * b)
        x, y, cosine, sine, *_ = pose_row(pose)
        dx, dy = (reach * cosine, reach * sine) if a > b else (-reach * sine, reach * cosine)
        return np.array([[x - dx, x + dx], [y - dy, y + dy]])

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the smaller axis."""
        return np.zeros(1), np.full(1, min(self.length, self.width))


@dataclass(frozen=True, slots=True, kw_only=True)
class Plate(Solid):
    """A flat plate along the body's x with round ends, its middle at the origin."""

    length: float
    """Length over all [m]."""
    thick: float
    """Thickness [m]."""

    def __post_init__(self) -> None:
        check_positive("length", self.length)
        check_positive("thick", self.thick)
        if self.thick > self.length:
            raise InvalidDesign(f"a plate {self.thick} m thick is longer than thick; give a length of at least that.")

    def distance(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return signed distance [m] and outward normal [-] at points of the body's frame."""
        half = (self.length - self.thick) / 2
        dx = x - np.clip(x, -half, half)
        r = np.hypot(dx, y)
        safe = np.maximum(r, 1e-12 * self.length)
        flat = r <= safe * 1e-6
        return r - self.thick / 2, dx / safe, np.where(flat, 1.0, y / safe)

    def outline(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return ``count`` points around the plate, evenly spaced [m]."""
        r, half = self.thick / 2, (self.length - self.thick) / 2
        turn, flat = np.pi * r, 2 * half
        s = np.linspace(0, 2 * (turn + flat), count, endpoint=False)
        lap, second = s % (turn + flat), np.where(s >= turn + flat, -1.0, 1.0)
        angle = np.minimum(lap / r, np.pi) - np.pi / 2
        flat_distance = np.maximum(lap - turn, 0.0)
        return second * (half + r * np.cos(angle) - flat_distance), second * r * np.sin(angle)

    def centreline(self, time: float, pose: Pose) -> np.ndarray:
        """Return the line between the middles of the round ends."""
        return np.stack(pose.to_world((self.length - self.thick) / 2 * np.array([-1.0, 1.0]), np.zeros(2)))

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the thickness."""
        return np.zeros(1), np.full(1, self.thick)
