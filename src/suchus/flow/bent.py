# ruff: noqa: ARG002 - bodies that bend share the interface of all bodies and pass the time to their map
"""Bodies that a map bends: any shape of the plane, any closed mesh in space.

The map says of every place in the body's frame and of every time which place of the still shape is there. Corners of
the outline or mesh go where it says that they are, by Newton's method, and compiled code places what they enclose. The
velocity follows by differentiation: a place of the still shape stays what it is, so ``J V + d(back)/dt = 0`` with the
map's gradient J. So no rate can be given that is not that of the places.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from math import isfinite
from typing import Any, overload

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.flow.markers import Markers
from suchus.flow.mass import Mass, SpaceMass, of_outline
from suchus.flow.mesh import TriangleMesh, face_centres, mass_of_mesh, paint_mesh, point_text, pseudo_normals
from suchus.flow.paint import paint_outline
from suchus.flow.pose import Pose, rotate_vectors
from suchus.flow.shape import Field, Shape, Solid
from suchus.flow.solid import SpaceField, SpaceShape

CORNERS = 512
"""Least number of corners of the polygon that approximates the outline of a plane shape [-]."""

DEFAULT_DIFFERENCE_TIME = 1e-4
"""Default time over which a map is differentiated [s]: short for any motion that takes a hundredth of a second."""

MAX_VELOCITY_CHANGE = 1e-2
"""Largest relative change of the fastest velocity when that time is halved; beyond it the map is refused [-]."""

_STEP = 1e-5  # distance over which a map is differentiated, over the shape's size
_POSITION_TOLERANCE = 1e-9  # largest error of a corner's position, over the shape's size
_MAX_ITERATIONS = 40  # of Newton's method
_MAX_STEP = 0.25  # largest displacement of a corner in one iteration, over the shape's size

Back = Callable[..., Sequence[np.ndarray]]
"""Map from coordinates in the body's frame [m] and a time [s] to coordinates in the still shape [m]; arrays."""


@dataclass(frozen=True, slots=True)
class BendingMap:
    """A map that bends a shape, and what follows from it."""

    map_to_rest: Back
    """The map."""
    ndim: int
    """Number of axes, 2 or 3."""
    size: float
    """Greatest extent of the still shape [m]."""
    difference_time: float
    """Time over which the map is differentiated [s]."""

    def __call__(self, places: np.ndarray, time: float) -> np.ndarray:
        """Return where in the still shape places are, both of shape (axis, ...) [m].

        Args:
            places: coordinates in the body's frame, shape (axis, ...) [m].
            time: time [s].

        Raises:
            InvalidDesign: the map gives something that is no place.
        """
        coordinates = self.map_to_rest(*places, time)
        if len(coordinates) != self.ndim:
            raise InvalidDesign(
                f"the map that bends the body gives {len(coordinates)} coordinates; {self.ndim} are needed."
            )
        still_points: np.ndarray = np.stack(
            [np.broadcast_to(np.asarray(row, float), places[0].shape) for row in coordinates]
        )
        if not np.isfinite(still_points).all():
            failing_point = places[:, ~np.isfinite(still_points).all(axis=0)][:, 0]
            raise InvalidDesign(
                f"at t = {time:.4g} s the map that bends the body gives no finite place for "
                f"({', '.join(f'{x:.4g}' for x in failing_point)}) m; it must, in and around the body."
            )
        return still_points

    def gradient(self, places: np.ndarray, time: float) -> np.ndarray:
        """Return the gradient of the map, shape (..., coordinate of the still shape, coordinate) [-].

        Args:
            places: coordinates in the body's frame, shape (axis, ...) [m].
            time: time [s].
        """
        step, columns = _STEP * self.size, []
        for d in range(self.ndim):
            offset = np.zeros((self.ndim, *(1,) * (places.ndim - 1)))
            offset[d] = step
            columns.append((self(places + offset, time) - self(places - offset, time)) / (2 * step))
        return np.moveaxis(np.stack(columns, axis=1), (0, 1), (-2, -1))

    def velocity(self, places: np.ndarray, time: float, tick: float | None = None) -> np.ndarray:
        """Return the velocity of the body's material at places, shape (axis, ...) [m/s].

        Args:
            places: coordinates in the body's frame, shape (axis, ...) [m].
            time: time [s].
            tick: time over which the map is differentiated; None is that of the map [s].
        """
        half = 0.5 * (tick or self.difference_time)
        goes = (self(places, time + half) - self(places, time - half)) / (2 * half)
        rates = np.linalg.solve(self.gradient(places, time), np.moveaxis(goes, 0, -1)[..., None])[..., 0]
        return -np.moveaxis(rates, -1, 0)

    def map_to_bent(self, still_points: np.ndarray, time: float) -> np.ndarray:
        """Return the positions of points of the still shape in the body's frame, shape (axis, point) [m].

        Args:
            still_points: points of the still shape, shape (axis, point) [m].
            time: time [s].

        Raises:
            InvalidDesign: the map folds the body, or no position was found.
        """
        places = still_points.copy()
        for _ in range(_MAX_ITERATIONS):
            residual = self(places, time) - still_points
            slope = self.gradient(places, time)
            is_inverted = np.linalg.det(slope) <= 0
            if np.abs(residual).max() < _POSITION_TOLERANCE * self.size:
                if is_inverted.any():
                    raise InvalidDesign(
                        f"at t = {time:.4g} s the map folds the body or turns it inside out, at "
                        f"{point_text(places[:, is_inverted][:, 0])} m; bend it less."
                    )
                return places
            slope[is_inverted] = np.eye(self.ndim)
            step = np.linalg.solve(slope, residual.T[..., None])[..., 0].T
            size = np.sqrt((step**2).sum(axis=0))
            places -= step * np.minimum(1.0, _MAX_STEP * self.size / np.maximum(size, 1e-300))
        worst_index = int(np.abs(residual).max(axis=0).argmax())
        raise InvalidDesign(
            f"at t = {time:.4g} s no place was found that the map takes to "
            f"{point_text(still_points[:, worst_index])} m of the still shape; it says of each place in the body's "
            "frame where that is in the still shape. Bend it less."
        )

    def check(self, places: np.ndarray, time: float) -> np.ndarray:
        """Return the velocities at places, if the map can be differentiated there, shape (axis, ...) [m/s].

        Args:
            places: coordinates in the body's frame, shape (axis, ...) [m].
            time: time [s].

        Raises:
            InvalidDesign: the velocity changes by more than ``MAX_VELOCITY_CHANGE`` when it is taken over half the
                time.
        """
        full_tick_velocity = self.velocity(places, time)
        half_tick_velocity = self.velocity(places, time, 0.5 * self.difference_time)
        fastest = float(np.abs(half_tick_velocity).max())
        if (
            np.abs(full_tick_velocity - half_tick_velocity).max() > MAX_VELOCITY_CHANGE * fastest
            and fastest * self.difference_time > _POSITION_TOLERANCE * self.size
        ):
            raise InvalidDesign(
                f"at t = {time:.4g} s the map that bends the body gives {np.abs(full_tick_velocity).max():.4g} m/s "
                f"over a tick of {self.difference_time:.3g} s and {fastest:.4g} m/s over half of it: it leaps, or is "
                f"too fast for it. Give a smooth map, or a shorter tick."
            )
        return full_tick_velocity


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BentOutline(Shape):
    """A plane shape that a map bends; see ``bend_shape``."""

    rest_shape: Solid
    """The shape that it bends."""
    bend: BendingMap
    """The map."""
    _corners: np.ndarray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(
            self, "_corners", np.stack([np.array(row, float) for row in self.rest_shape.outline(CORNERS)])
        )

    @property
    def rigid(self) -> bool:
        """It bends."""
        return False

    def measure(self, x: np.ndarray, y: np.ndarray, time: float, pose: Pose, reach: float) -> Field:
        """Return the field on the points of a window, as far as ``reach``."""
        h = float(x[-1] - x[0]) / (x.size - 1)
        corners = np.stack(pose.to_world(*_bent_corners(self, time)))
        flat = 1e-9 * self.bend.size
        d, nx, ny = paint_outline(corners, float(x[0]), float(y[0]), h, x.size, y.size, float(reach), flat)
        wx, wy = np.meshgrid(x, y)
        vx, vy = (np.array(np.broadcast_to(v, d.shape)) for v in pose.velocity_in_plane(wx, wy))
        is_near = d < reach
        bend_velocity = pose.rotate_in_plane(
            *self.bend.velocity(np.stack(pose.to_body(wx[is_near], wy[is_near])), time)
        )
        vx[is_near] += bend_velocity[0]
        vy[is_near] += bend_velocity[1]
        return Field(d, nx, ny, vx, vy, np.full(d.shape, np.inf))

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return the middles of the outline's edges."""
        corners = _bent_corners(self, time)
        perimeter = float(np.hypot(*(np.roll(corners, -1, axis=1) - corners)).sum())
        still_points = np.stack(
            [np.array(row, float) for row in self.rest_shape.outline(max(32, int(np.ceil(perimeter / spacing))))]
        )
        vertices = self.bend.map_to_bent(still_points, time)
        rates = self.bend.check(vertices, time)
        next_vertices, next_rates = np.roll(vertices, -1, axis=1), np.roll(rates, -1, axis=1)
        edges, rate_change = next_vertices - vertices, next_rates - rates
        edge_lengths = np.hypot(*edges)
        points = np.stack(pose.to_world(*(0.5 * (vertices + next_vertices))))
        velocities = np.stack(pose.velocity_in_plane(*points)) + np.stack(
            pose.rotate_in_plane(*(0.5 * (rates + next_rates)))
        )
        return Markers(
            points=points, weight=edge_lengths, velocities=velocities,
            normals=np.stack(pose.rotate_in_plane(*(np.stack([edges[1], -edges[0]]) / edge_lengths))),
            spins=(pose.spin + (edges[0] * rate_change[1] - edges[1] * rate_change[0]) / edge_lengths**2)[None],
            station=np.cumsum(edge_lengths) - edge_lengths / 2, side=np.zeros(edge_lengths.size),
        )  # fmt: skip

    def bounds(self, time: float, pose: Pose) -> tuple[float, float, float, float]:
        """Return the rectangle around the corners."""
        x, y = pose.to_world(*_bent_corners(self, time))
        return float(x.min()), float(x.max()), float(y.min()), float(y.max())

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return that of the still shape."""
        return self.rest_shape.thickness(0.0)

    def mass(self, time: float) -> Mass:
        """Return area, centre and moments of the corners' polygon, and the momentum of what bends in it."""
        corners = _bent_corners(self, time)
        polygon = of_outline(*corners)
        centre = np.array(polygon.centre)[:, None]
        next_corners = np.roll(corners, -1, axis=1)
        arms, next_arms = corners - centre, next_corners - centre
        share = (arms[0] * next_arms[1] - arms[1] * next_arms[0]) / 6  # a third of each triangle from the centre
        quadrature_points = np.concatenate(
            [0.5 * (corners + centre), 0.5 * (next_corners + centre), 0.5 * (corners + next_corners)], axis=1
        )
        weights, rates = np.tile(share, 3), self.bend.velocity(quadrature_points, time)
        rate = (rates * weights).sum(axis=1) / polygon.area
        (dx, dy), (u, v) = quadrature_points - centre, rates - rate[:, None]
        return Mass(
            area=polygon.area, centre=polygon.centre, centre_rate=(float(rate[0]), float(rate[1])),
            moment=polygon.moment, swirl=float(((dx * v - dy * u) * weights).sum()),
        )  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BentMesh(SpaceShape):
    """A closed mesh that a map bends; see ``bend_shape``."""

    rest_shape: TriangleMesh
    """The mesh that it bends."""
    bend: BendingMap
    """The map."""

    mirror_symmetry = (False, False, False)

    @property
    def rigid(self) -> bool:
        """It bends."""
        return False

    def _corners_at(self, time: float) -> np.ndarray:
        """Return the corners in the body's frame, shape (3, vertex) [m]."""
        return _bent_corners(self, time)

    def measure(self, x: np.ndarray, y: np.ndarray, z: np.ndarray, time: float, pose: Pose, reach: float) -> SpaceField:
        """Return the field on the points of a window, as far as ``reach``."""
        frame, faces = pose.in_dimensions(3), self.rest_shape.faces
        px, py, pz = (np.ascontiguousarray(line, float) for line in (x, y, z))
        window_field = np.zeros((4, z.size, y.size, x.size))
        h = float(x[1] - x[0]) if x.size > 1 else float(reach)
        corners = np.stack(frame.to_world_3d(self._corners_at(time)), axis=1)
        normals = np.ascontiguousarray(pseudo_normals(corners, faces))
        paint_mesh(window_field, px, py, pz, np.ascontiguousarray(corners[faces]), normals, float(reach), h)
        wz, wy, wx = np.meshgrid(pz, py, px, indexing="ij")
        rates = [np.array(np.broadcast_to(rate, window_field[0].shape)) for rate in frame.velocity_at((wx, wy, wz))]
        is_near = window_field[0] < reach
        bend_velocity = self._velocity(np.stack([wx[is_near], wy[is_near], wz[is_near]]), time, frame)
        for rate, component in zip(rates, bend_velocity, strict=True):
            rate[is_near] += component
        u, v, w = rates
        return SpaceField(
            window_field[0],
            (window_field[1], window_field[2], window_field[3]),
            (u, v, w),
            np.full(window_field[0].shape, np.inf),
        )

    def _velocity(self, points: np.ndarray, time: float, frame: Pose) -> np.ndarray:
        """Return what bending adds to the velocity at points of the world, shape (3, point) [m/s]."""
        body = frame.matrix.T @ (points - np.array(frame.position)[:, None])
        return np.stack(rotate_vectors(frame.matrix, self.bend.velocity(body, time)))

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return the middles of the triangles, of large ones those of equal parts."""
        frame, corners = pose.in_dimensions(3), self._corners_at(time)
        self.bend.check(corners, time)
        points, share, normals = face_centres(
            np.stack(frame.to_world_3d(corners), axis=1)[self.rest_shape.faces], spacing
        )
        velocities = np.stack(frame.velocity_at(points)) + self._velocity(points, time, frame)
        spins = np.broadcast_to(frame.spins[:, None], points.shape)
        return Markers(points=points, weight=share, velocities=velocities, normals=normals, spins=spins)

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the box around the corners."""
        corners = np.stack(pose.in_dimensions(3).to_world_3d(self._corners_at(time)))
        return tuple(np.stack([corners.min(axis=1), corners.max(axis=1)], axis=1).ravel().tolist())

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return that of the still mesh."""
        return self.rest_shape.thickness(0.0)

    @property
    def is_compact(self) -> bool:
        """Whether the still mesh is about as long along each axis."""
        return self.rest_shape.is_compact

    def volume(self, time: float) -> float:
        """Return the volume."""
        return self.mass(time).volume

    def mass(self, time: float) -> SpaceMass:
        """Return volume, centre and moments of the bent mesh, and the momentum of what bends in it."""
        faces = self._corners_at(time).T[self.rest_shape.faces]
        mesh_mass = mass_of_mesh(faces)
        centre = np.array(mesh_mass.centre)[:, None]
        corners = faces.transpose(1, 2, 0) - centre  # of tetrahedra from the centre
        share = np.einsum("df,df->f", corners[0], np.cross(corners[1], corners[2], axis=0)) / 24
        corner_weight, other_weight = _TETRAHEDRON
        total = corners.sum(axis=0)
        quadrature_points = np.concatenate(
            [
                other_weight * total,
                *(other_weight * total + (corner_weight - other_weight) * corner for corner in corners),
            ],
            axis=1,
        )
        weights, rates = np.tile(share, 4), self.bend.velocity(quadrature_points + centre, time)
        rate = (rates * weights).sum(axis=1) / mesh_mass.volume
        swirl = (np.cross(quadrature_points, rates - rate[:, None], axis=0) * weights).sum(axis=1)
        u, v, w = rate.tolist()
        a, b, c = swirl.tolist()
        return SpaceMass(
            volume=mesh_mass.volume,
            centre=mesh_mass.centre,
            centre_rate=(u, v, w),
            moments=mesh_mass.moments,
            swirl=(a, b, c),
        )


@lru_cache(maxsize=16)
def _bent_corners(shape: BentOutline | BentMesh, time: float) -> np.ndarray:
    """Return the corners of a bent shape in the body's frame, shape (axis, corner) [m]; the last results are cached."""
    still_corners = shape._corners if isinstance(shape, BentOutline) else shape.rest_shape.vertices.T
    corners = shape.bend.map_to_bent(still_corners, time)
    corners.flags.writeable = False
    return corners


_TETRAHEDRON = (5 + 3 * 5**0.5) / 20, (5 - 5**0.5) / 20
"""Barycentric weights of the four-point quadrature on a tetrahedron, exact for polynomials of second order [-]."""


@overload
def bend_shape(shape: Solid, back: Back, *, tick: float = DEFAULT_DIFFERENCE_TIME) -> BentOutline: ...
@overload
def bend_shape(shape: TriangleMesh, back: Back, *, tick: float = DEFAULT_DIFFERENCE_TIME) -> BentMesh: ...
def bend_shape(shape: Any, back: Back, *, tick: float = DEFAULT_DIFFERENCE_TIME) -> BentOutline | BentMesh:
    """Return a body that a map bends, swells, shears or moves, in the plane or in space.

    Args:
        shape: the still shape: any ``Solid``, such as an ``Ellipse`` or ``from_outline``, or a ``TriangleMesh``.
        back: ``back(x, y, time)``, in space ``back(x, y, z, time)``: which place of the still shape is at places of the
            body's frame, arrays of coordinates [m, s]; smooth, one to one, and defined a few cells around the body too.
        tick: time over which it is differentiated [s].

    Raises:
        InvalidDesign: the shape is of another kind, the tick is not positive, or the map folds the body at time 0.
    """
    if not (isfinite(tick) and tick > 0):
        raise InvalidDesign(f"tick is {tick} s; a positive time is needed, short for what the map does.")
    if isinstance(shape, TriangleMesh):
        size = float(np.ptp(shape.vertices, axis=0).max())
        mesh = BentMesh(rest_shape=shape, bend=BendingMap(back, 3, size, tick))
        mesh.bounds(0.0, Pose())
        return mesh
    if not isinstance(shape, Solid):
        raise InvalidDesign(
            f"a {type(shape).__name__} cannot be bent by a map; give a plane Solid, such as from_outline or an "
            f"Ellipse, or a closed mesh."
        )
    size = float(np.ptp(np.stack(shape.outline(CORNERS)), axis=1).max())
    outline = BentOutline(rest_shape=shape, bend=BendingMap(back, 2, size, tick))
    outline.bounds(0.0, Pose())
    return outline
