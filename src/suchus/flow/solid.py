# ruff: noqa: ARG002 - rigid and bending shapes share one interface, rigid ones ignore the time
"""Rigid shapes in closed form, in the plane and in space, each defined in its own frame; the pose is applied here."""

from abc import abstractmethod
from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar, NamedTuple

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.flow.ellipsoid import measure_ellipsoid, paint_ellipsoid
from suchus.flow.markers import Markers
from suchus.flow.mass import Mass, of_outline, tensor
from suchus.flow.pose import ROTATION_PLANES, Pose
from suchus.flow.rigid import pose_row, ring_bounds, to_body_points, to_world_field, to_world_skin
from suchus.flow.shape import Axes, Field, Shape, check_positive

_MIN_RINGS = 16
"""Fewest rings of markers on a skin [-]."""

_RIM = 96
"""Corners of the midsurface ellipse of a thin ellipsoid [-]."""

_MAX_BLUNT_RATIO = 2.0
"""Ratio of the longest to the shortest axis up to which the error of a body's drag is that of a sphere [-]."""

_ROUND = 1e-3
"""Length of the midsurface ellipse, over the smallest half-axis, below which the ellipsoid counts as round there
[-]."""

MIN_INSIDE_DEPTH = 1e-9
"""Depth, over a shape's size, from which a point of its skin counts as inside another shape [-]."""

_COARSE_POINTS, _MIN_POINTS = 256, 32
"""Points with which the length of an outline is measured, and fewest points of the markers [-]."""

_BOX_POINTS = 512
"""Points of the outline within which the rectangle around a plane solid is taken [-]."""


class SurfacePoints(NamedTuple):
    """Points over the surface of a solid in its own frame."""

    points: np.ndarray
    """Where, shape (axis, point) [m]."""
    normals: np.ndarray
    """Outward normals, shape (axis, point) [-]."""
    weight: np.ndarray
    """Length of outline or area of skin per point, shape (point,) [m, m^2]."""


class Solid(Shape):
    """A rigid shape in closed form, in the plane or in space, defined by its distance and its skin in its own frame.

    In the plane take a ``PlaneSolid``, whose skin follows from its outline.
    """

    @abstractmethod
    def distance(self, *points: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return signed distance [m] and outward normal [-] at points of the body's frame.

        Args:
            points: coordinates along each axis, arrays of one shape [m].

        Returns:
            The distance and the normal's component along each axis, arrays of that shape.
        """

    @abstractmethod
    def skin(self, spacing: float) -> SurfacePoints:
        """Return points over the surface in the body's frame, about ``spacing`` [m] apart."""

    @abstractmethod
    def extents(self) -> tuple[float, ...]:
        """Return the smallest rectangle or box around it in the body's frame: x0, x1, y0, y1, and z0, z1 [m]."""

    def measure(self, points: Axes, time: float, pose: Pose, reach: float) -> Field:
        """Return the field on the points of a window; see ``Shape``."""
        world = open_grid(points)
        distance, *normal = self.distance(*pose.to_body(world))
        thickness = np.full(distance.shape, self.thickness(time)[1].max())
        return Field(distance, pose.rotate(normal), rigid_velocity(points, pose), thickness)

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return points over the skin, or the middles of the outline's edges; see ``Shape``."""
        skin = self.skin(spacing)
        points = np.stack(pose.to_world(skin.points))
        return Markers(
            points=points, weight=skin.weight, velocities=np.stack(pose.velocity_at(points)),
            normals=np.stack(pose.rotate(skin.normals)), spins=skin_spins(pose, points),
        )  # fmt: skip


def open_grid(points: Axes) -> tuple[np.ndarray, ...]:
    """Return the coordinates of a window along each axis, each of a shape that broadcasts to that of the window [m]."""
    return tuple(line.reshape(-1, *(1,) * d) for d, line in enumerate(points))


def rigid_velocity(points: Axes, pose: Pose) -> tuple[np.ndarray, ...]:
    """Return the velocity of a rigid motion on the points of a window, along each axis, arrays of its shape [m/s]."""
    shape = tuple(line.size for line in reversed(points))
    return tuple(np.array(np.broadcast_to(component, shape)) for component in pose.velocity_at(open_grid(points)))


def skin_spins(pose: Pose, points: np.ndarray) -> np.ndarray:
    """Return the angular velocity of a rigid body at its markers, shape (1, marker) or (3, marker) [rad/s].

    Args:
        pose: pose of the body's frame.
        points: the markers, shape (axis, marker) [m].
    """
    turns = len(ROTATION_PLANES[len(points)])
    return np.broadcast_to(pose.spins[-turns:, None], (turns, points.shape[1]))


class PlaneSolid(Solid):
    """A rigid shape in the plane, defined by its distance and its outline in its own frame."""

    @abstractmethod
    def outline(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return ``count`` points around the outline, counter-clockwise, about evenly spaced [m]."""

    def skin(self, spacing: float) -> SurfacePoints:
        """Return the middles of the outline's edges; see ``Solid``."""
        return SurfacePoints(*_edges(self, float(spacing))[:3])

    def extents(self) -> tuple[float, ...]:
        """Return the rectangle around the outline; see ``Solid``."""
        return box_around(np.stack(_ring(self, _BOX_POINTS)))

    def measure(self, points: Axes, time: float, pose: Pose, reach: float) -> Field:
        """Return distance, normal and velocity on the points of a window; see ``Shape``."""
        (x, y), row = points, pose_row(pose)
        shape = (y.size, x.size)
        body_points, field = np.empty((2, *shape)), np.empty((4, *shape))
        to_body_points(body_points, x, y, row)
        d, nx, ny = (_whole(a, shape) for a in self.distance(*body_points))
        to_world_field(field, nx, ny, x, y, row)
        return Field(d, (field[0], field[1]), (field[2], field[3]), np.full(shape, np.inf))

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

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the rectangle around the outline."""
        x0, x1, y0, y1 = ring_bounds(*_ring(self, _COARSE_POINTS), pose_row(pose))
        return x0, x1, y0, y1

    def mass(self, time: float) -> Mass:
        """Return area, centre and moments of the outline's polygon."""
        return of_outline(*self.outline(2048))


def box_around(points: np.ndarray) -> tuple[float, ...]:
    """Return the smallest rectangle or box around points, shape (axis, point): x0, x1, y0, y1, and z0, z1 [m]."""
    return tuple(np.stack([points.min(axis=1), points.max(axis=1)], axis=1).ravel().tolist())


def _whole(values: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Return values at the points of a window as an array of its shape, its numbers end to end."""
    return np.ascontiguousarray(np.broadcast_to(values, shape) if np.shape(values) != shape else values, float)


def _ring(shape: PlaneSolid, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return ``count`` points around the outline in the body's frame [m].

    The outline is rigid. The points are cached if the shape is hashable.
    """
    try:
        return _cached_ring(shape, count)
    except TypeError:
        return _measure_ring(shape, count)


@lru_cache(maxsize=64)
def _cached_ring(shape: PlaneSolid, count: int) -> tuple[np.ndarray, np.ndarray]:
    return _measure_ring(shape, count)


def _measure_ring(shape: PlaneSolid, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return what ``_ring`` does, without a cache; the arrays are to be read only."""
    x, y = (np.array(line, float) for line in shape.outline(count))
    x.flags.writeable = y.flags.writeable = False
    return x, y


Edges = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
"""Edges of an outline in the body's frame: centres and outward normals, shape (2, edge) [m, -], their lengths and the
arc lengths of their middles, shape (edge,) [m]."""


def _edges(shape: PlaneSolid, spacing: float) -> Edges:
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
def _cached_edges(shape: PlaneSolid, spacing: float) -> Edges:
    return _measure_edges(shape, spacing)


def _measure_edges(shape: PlaneSolid, spacing: float) -> Edges:
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
class Cylinder(PlaneSolid):
    """A circle."""

    diameter: float
    """Diameter [m]."""

    def __post_init__(self) -> None:
        check_positive("diameter", self.diameter)

    def distance(self, *points: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return signed distance and outward normal."""
        x, y = points
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
class Ellipse(PlaneSolid):
    """An ellipse with its axes along the body's axes."""

    length: float
    """Full axis along the body's x [m]."""
    width: float
    """Full axis along the body's y [m]."""

    def __post_init__(self) -> None:
        check_positive("length", self.length)
        check_positive("width", self.width)

    def distance(self, *points: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return signed distance [m] and outward normal [-], by Newton's method for the nearest point."""
        return _ellipsoid_distance(points, np.array([self.length / 2, self.width / 2]))

    def outline(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return ``count`` points around the ellipse, evenly spaced along it [m]."""
        fine = np.linspace(0, 2 * np.pi, 8 * count + 1)
        x, y = self.length / 2 * np.cos(fine), self.width / 2 * np.sin(fine)
        arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        turn = np.interp(np.linspace(0, arc[-1], count, endpoint=False), arc, fine)
        return self.length / 2 * np.cos(turn), self.width / 2 * np.sin(turn)

    def midsurface(self, time: float, pose: Pose) -> np.ndarray:
        """Return the part of the longer axis at which the ellipse is narrower than it is far from its tip."""
        a, b = self.length / 2, self.width / 2
        reach = (a if a > b else b) * abs(a * a - b * b) / (a * a + b * b)
        x, y, cosine, sine, *_ = pose_row(pose)
        dx, dy = (reach * cosine, reach * sine) if a > b else (-reach * sine, reach * cosine)
        return pieces_of_line(np.array([[x - dx, x + dx], [y - dy, y + dy]]))

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the smaller axis."""
        return np.zeros(1), np.full(1, min(self.length, self.width))


@dataclass(frozen=True, slots=True, kw_only=True)
class Plate(PlaneSolid):
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

    def distance(self, *points: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return signed distance [m] and outward normal [-] at points of the body's frame."""
        (x, y), half = points, (self.length - self.thick) / 2
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

    def midsurface(self, time: float, pose: Pose) -> np.ndarray:
        """Return the line between the middles of the round ends."""
        ends = (self.length - self.thick) / 2 * np.array([-1.0, 1.0])
        return pieces_of_line(np.stack(pose.to_world((ends, np.zeros(2)))))

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the thickness."""
        return np.zeros(1), np.full(1, self.thick)


def pieces_of_line(line: np.ndarray) -> np.ndarray:
    """Return the pieces of a line of points, shape (2, point), as ``Shape.midsurface`` has them."""
    return np.stack([line[:, :-1], line[:, 1:]])


def is_blunt(axes: np.ndarray) -> bool:
    """Return whether the longest of a body's axes is at most ``_MAX_BLUNT_RATIO`` times the shortest.

    Args:
        axes: lengths or half-axes, shape (3,) [m].
    """
    return float(axes.max()) <= _MAX_BLUNT_RATIO * float(axes.min())


def _ellipsoid_distance(points: tuple[np.ndarray, ...], half_axes: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return signed distance [m] and outward normal [-] of an ellipse or an ellipsoid at points of its frame.

    Args:
        points: coordinates along each axis [m].
        half_axes: half-axes, shape (axis,) [m].
    """
    coordinates = np.stack(np.broadcast_arrays(*points)).astype(float, copy=False)
    fields = np.empty((1 + len(coordinates), coordinates[0].size))
    measure_ellipsoid(fields, coordinates.reshape(len(coordinates), -1), half_axes)
    return tuple(fields.reshape(-1, *coordinates[0].shape))


@dataclass(frozen=True, slots=True, kw_only=True)
class Ellipsoid(Solid):
    """An ellipsoid with its axes along the body's axes."""

    ndim: ClassVar[int] = 3

    length: float
    """Full axis along the body's x [m]."""
    width: float
    """Full axis along the body's y [m]."""
    height: float
    """Full axis along the body's z [m]."""

    def __post_init__(self) -> None:
        for name in ("length", "width", "height"):
            check_positive(name, getattr(self, name))

    @property
    def half_extents(self) -> np.ndarray:
        """Half-axes, shape (3,) [m]."""
        return 0.5 * np.array([self.length, self.width, self.height])

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Return which points of the body's frame lie inside, for points of shape (3, ...) [m]."""
        x, y, z = (coordinate / half for coordinate, half in zip(points, self.half_extents, strict=True))
        return np.asarray(x * x + y * y + z * z < 1 - MIN_INSIDE_DEPTH)

    def distance(self, *points: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return signed distance [m] and outward normal [-], by Newton's method for the nearest point."""
        return _ellipsoid_distance(points, self.half_extents)

    def extents(self) -> tuple[float, ...]:
        """Return the box that touches the ends of its axes."""
        return box_around(np.stack([-self.half_extents, self.half_extents], axis=1))

    def measure(self, points: Axes, time: float, pose: Pose, reach: float) -> Field:
        """Return distance, normal and velocity on the points of a window; see ``Shape``."""
        pose_3d = pose.in_dimensions(3)
        x, y, z = (np.ascontiguousarray(line, float) for line in points)
        fields = np.zeros((8, z.size, y.size, x.size))
        fields[7] = np.inf
        cell = float(x[1] - x[0]) if x.size > 1 else float(reach)
        paint_ellipsoid(
            fields, x, y, z, np.ascontiguousarray(pose_3d.matrix), np.array(pose_3d.position),
            np.array(pose_3d.velocity), pose_3d.spins, self.half_extents, float(reach), cell,
        )  # fmt: skip
        return Field(fields[0], tuple(fields[1:4]), tuple(fields[4:7]), fields[7])

    def skin(self, spacing: float) -> SurfacePoints:
        """Return points on rings about the body's z axis; each represents the same area of a unit sphere."""
        rings = max(_MIN_RINGS, int(np.ceil(np.pi * float(self.half_extents.max()) / spacing)))
        cos = (np.arange(rings) + 0.5) * 2 / rings - 1
        turn = (np.arange(2 * rings) + 0.5) * np.pi / rings
        sin = np.sqrt(1 - cos * cos)[:, None]
        unit = np.stack([sin * np.cos(turn), sin * np.sin(turn), np.broadcast_to(cos[:, None], (rings, turn.size))])
        unit = unit.reshape(3, -1)
        a = self.half_extents[:, None]
        size = np.sqrt(((unit / a) ** 2).sum(axis=0))
        return SurfacePoints(
            a * unit, unit / a / size, float(np.prod(self.half_extents)) * size * (4 * np.pi / unit.shape[1])
        )

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the box around the ellipsoid."""
        pose_3d = pose.in_dimensions(3)
        reach = np.sqrt(((pose_3d.matrix * self.half_extents) ** 2).sum(axis=1)).tolist()
        return tuple(p + sign * r for p, r in zip(pose_3d.position, reach, strict=True) for sign in (-1.0, 1.0))

    def midsurface(self, time: float, pose: Pose) -> np.ndarray | None:
        """Return an ellipse across the smallest axis, in triangles; None if that axis is not the only small one.

        It is smaller than the ellipsoid's own cross-section and vanishes where the ellipsoid is round. See
        ``Shape``.
        """
        thin_axis, *long_axes = np.argsort(self.half_extents)
        excess = self.half_extents**2 - self.half_extents[thin_axis] ** 2
        rim_half_axes = self.half_extents * excess / (self.half_extents**2 + self.half_extents[thin_axis] ** 2)
        if rim_half_axes[long_axes].min() <= _ROUND * self.half_extents[thin_axis]:
            return None
        turn = np.linspace(0.0, 2 * np.pi, _RIM + 1)
        rim = np.zeros((3, turn.size))
        rim[long_axes] = rim_half_axes[long_axes, None] * np.stack([np.cos(turn), np.sin(turn)])
        rim, centre = np.array(pose.to_world(rim)), np.array(pose.in_dimensions(3).position)
        return np.stack([np.broadcast_to(centre[:, None], (3, _RIM)), rim[:, :-1], rim[:, 1:]])

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the smallest axis."""
        return np.zeros(1), np.full(1, 2 * float(self.half_extents.min()))

    @property
    def is_compact(self) -> bool:
        """Whether no axis is more than ``_MAX_BLUNT_RATIO`` times another."""
        return is_blunt(self.half_extents)

    def mass(self, time: float) -> Mass:
        """Return volume and moments; the centre is the origin."""
        volume, zero = 4 / 3 * np.pi * float(np.prod(self.half_extents)), (0.0, 0.0, 0.0)
        moments = tensor(np.diag(volume * self.half_extents**2 / 5))
        return Mass(volume=volume, centre=zero, centre_rate=zero, moments=moments, swirl=zero)


class Sphere(Ellipsoid):
    """A sphere."""

    __slots__ = ()

    def __init__(self, *, diameter: float) -> None:
        check_positive("diameter", diameter)
        super().__init__(length=diameter, width=diameter, height=diameter)
