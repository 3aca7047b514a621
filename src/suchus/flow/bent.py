# ruff: noqa: ARG002 - bodies that bend share the interface of all bodies and pass the time to their map
"""Bodies that a map bends: any shape of the plane, any closed mesh in space.

The map says of every place in the body's frame and of every time which place of the still shape is there. Corners of
the outline or mesh go where it says that they are, by Newton's method, and compiled code places what they enclose. The
velocity follows by differentiation: a place of the still shape stays what it is, so ``J V + d(back)/dt = 0`` with the
map's gradient J. So no rate can be given that is not that of the places.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import isfinite
from typing import ClassVar

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.flow.markers import Markers
from suchus.flow.mass import Mass, of_outline
from suchus.flow.mesh import TriangleMesh, face_centres, mass_of_mesh, paint_triangles, point_text, pseudo_normals
from suchus.flow.outline import paint_polygon
from suchus.flow.pose import ROTATION_PLANES, Pose
from suchus.flow.shape import Axes, Field, Shape
from suchus.flow.solid import PlaneSolid, box_around, rigid_velocity, skin_spins

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


class Facets(ABC):
    """The flat pieces that bound a still shape: edges of an outline, or triangles of a mesh.

    Corners are given in the body's frame, shape (axis, corner) [m], those of the still shape or where it has bent to.
    """

    shape: PlaneSolid | TriangleMesh
    """The still shape."""
    still_corners: np.ndarray
    """Corners of the still shape."""

    @abstractmethod
    def paint(self, corners: np.ndarray, points: Axes, reach: float) -> np.ndarray:
        """Return signed distance and normal on a window, shape (1 + axis, ...) [m, -].

        Args:
            corners: the corners, in the frame of the window.
            points: coordinates of the window along each axis [m].
            reach: distance up to which both are exact [m].
        """

    @abstractmethod
    def mass(self, corners: np.ndarray) -> Mass:
        """Return volume, centre and moments of what the pieces enclose, as if it were rigid."""

    @abstractmethod
    def quadrature(self, corners: np.ndarray, centre: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return points, shape (axis, point) [m], and weights with which linear functions times arms are integrated.

        Args:
            corners: the corners.
            centre: point from which each piece is seen, shape (axis, 1) [m].
        """

    @abstractmethod
    def markers(self, bend: BendingMap, time: float, pose: Pose, spacing: float) -> Markers:
        """Return markers over the bent pieces in the world, about ``spacing`` [m] apart."""


@dataclass(frozen=True, slots=True, eq=False)
class OutlineEdges(Facets):
    """The edges of an outline in the plane."""

    shape: PlaneSolid
    still_corners: np.ndarray

    @classmethod
    def of_outline(cls, shape: PlaneSolid) -> "OutlineEdges":
        """Return the edges of a shape's outline, at least ``CORNERS``."""
        return cls(shape, np.stack([np.array(line, float) for line in shape.outline(CORNERS)]))

    def paint(self, corners: np.ndarray, points: Axes, reach: float) -> np.ndarray:
        """Return signed distance and normal on a window; see ``Facets``."""
        return paint_polygon(corners, points, reach, 1e-9 * _extent(self.still_corners))

    def mass(self, corners: np.ndarray) -> Mass:
        """Return area, centre and moment of the polygon; see ``Facets``."""
        return of_outline(*corners)

    def quadrature(self, corners: np.ndarray, centre: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the middles of the sides of each edge's triangle from the centre; see ``Facets``."""
        next_corners = np.roll(corners, -1, axis=1)
        arms, next_arms = corners - centre, next_corners - centre
        share = (arms[0] * next_arms[1] - arms[1] * next_arms[0]) / 6  # a third of each triangle from the centre
        sides = [0.5 * (corners + centre), 0.5 * (next_corners + centre), 0.5 * (corners + next_corners)]
        return np.concatenate(sides, axis=1), np.tile(share, 3)

    def markers(self, bend: BendingMap, time: float, pose: Pose, spacing: float) -> Markers:
        """Return the middles of the outline's edges; see ``Facets``."""
        corners = bend.map_to_bent(self.still_corners, time)
        perimeter = float(np.hypot(*(np.roll(corners, -1, axis=1) - corners)).sum())
        outline = self.shape.outline(max(32, int(np.ceil(perimeter / spacing))))
        vertices = bend.map_to_bent(np.stack([np.array(line, float) for line in outline]), time)
        rates = bend.check(vertices, time)
        next_vertices, next_rates = np.roll(vertices, -1, axis=1), np.roll(rates, -1, axis=1)
        edges, rate_change = next_vertices - vertices, next_rates - rates
        edge_lengths = np.hypot(*edges)
        points = np.stack(pose.to_world(0.5 * (vertices + next_vertices)))
        velocities = np.stack(pose.velocity_at(points)) + np.stack(pose.rotate(0.5 * (rates + next_rates)))
        return Markers(
            points=points, weight=edge_lengths, velocities=velocities,
            normals=np.stack(pose.rotate(np.stack([edges[1], -edges[0]]) / edge_lengths)),
            spins=(pose.spin + (edges[0] * rate_change[1] - edges[1] * rate_change[0]) / edge_lengths**2)[None],
            station=np.cumsum(edge_lengths) - edge_lengths / 2, side=np.zeros(edge_lengths.size),
        )  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class MeshTriangles(Facets):
    """The triangles of a closed mesh in space."""

    shape: TriangleMesh
    still_corners: np.ndarray

    @classmethod
    def of_mesh(cls, mesh: TriangleMesh) -> "MeshTriangles":
        """Return the triangles of a mesh."""
        return cls(mesh, mesh.vertices.T)

    def paint(self, corners: np.ndarray, points: Axes, reach: float) -> np.ndarray:
        """Return signed distance and normal on a window; see ``Facets``."""
        faces = self.shape.faces
        normals = np.ascontiguousarray(pseudo_normals(corners.T, faces))
        return paint_triangles(corners, faces, normals, points, reach)

    def mass(self, corners: np.ndarray) -> Mass:
        """Return volume, centre and moments of the mesh; see ``Facets``."""
        return mass_of_mesh(corners.T[self.shape.faces])

    def quadrature(self, corners: np.ndarray, centre: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return four points in each triangle's tetrahedron from the centre; see ``Facets``."""
        arms = corners.T[self.shape.faces].transpose(1, 2, 0) - centre
        share = np.einsum("df,df->f", arms[0], np.cross(arms[1], arms[2], axis=0)) / 24
        corner_weight, other_weight = _TETRAHEDRON
        total = arms.sum(axis=0)
        points = [other_weight * total, *(other_weight * total + (corner_weight - other_weight) * arm for arm in arms)]
        return np.concatenate(points, axis=1) + centre, np.tile(share, 4)

    def markers(self, bend: BendingMap, time: float, pose: Pose, spacing: float) -> Markers:
        """Return the middles of the triangles, of large ones those of equal parts; see ``Facets``."""
        corners = bend.map_to_bent(self.still_corners, time)
        bend.check(corners, time)
        points, areas, normals = face_centres(np.stack(pose.to_world(corners), axis=1)[self.shape.faces], spacing)
        bending = pose.rotate(bend.velocity(np.stack(pose.to_body(points)), time))
        return Markers(
            points=points, weight=areas, velocities=np.stack(pose.velocity_at(points)) + np.stack(bending),
            normals=normals, spins=skin_spins(pose, points),
        )  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Bent(Shape):
    """A shape that a map bends, in the plane or in space; see ``bend_shape``."""

    mirror_symmetry: ClassVar[tuple[bool, ...]] = (False, False, False)

    facets: Facets
    """The flat pieces that bound the still shape."""
    bend: BendingMap
    """The map."""

    @property
    def ndim(self) -> int:  # type: ignore[override]
        """Number of axes of the still shape [-]."""
        return self.facets.shape.ndim

    @property
    def rigid(self) -> bool:
        """It bends."""
        return False

    def measure(self, points: Axes, time: float, pose: Pose, reach: float) -> Field:
        """Return the field on the points of a window, as far as ``reach``."""
        corners = np.stack(pose.to_world(_bent_corners(self, time)))
        distance, *normal = self.facets.paint(corners, points, reach)
        velocity, is_near = rigid_velocity(points, pose), distance < reach
        world = np.meshgrid(*reversed(points), indexing="ij")[::-1]
        places = np.stack(pose.to_body([line[is_near] for line in world]))
        for component, bending in zip(velocity, pose.rotate(self.bend.velocity(places, time)), strict=True):
            component[is_near] += bending
        return Field(distance, tuple(normal), velocity, np.full(distance.shape, np.inf))

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return markers over the bent outline or mesh."""
        return self.facets.markers(self.bend, time, pose, spacing)

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the rectangle or box around the corners."""
        return box_around(np.stack(pose.to_world(_bent_corners(self, time))))

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return that of the still shape."""
        return self.facets.shape.thickness(0.0)

    @property
    def is_compact(self) -> bool:
        """Whether the still shape is about as long along each axis."""
        return self.facets.shape.is_compact

    def mass(self, time: float) -> Mass:
        """Return volume, centre and moments of the bent shape, and the momentum of what bends in it."""
        corners = _bent_corners(self, time)
        still_mass = self.facets.mass(corners)
        centre = np.array(still_mass.centre)[:, None]
        points, weights = self.facets.quadrature(corners, centre)
        rates = self.bend.velocity(points, time)
        rate = (rates * weights).sum(axis=1) / still_mass.volume
        arms, relative_velocities = points - centre, rates - rate[:, None]
        turns = [
            arms[a] * relative_velocities[b] - arms[b] * relative_velocities[a] for a, b in ROTATION_PLANES[self.ndim]
        ]
        swirl = tuple(float((turn * weights).sum()) for turn in turns)
        return replace(still_mass, centre_rate=tuple(rate.tolist()), swirl=swirl)


@lru_cache(maxsize=16)
def _bent_corners(shape: Bent, time: float) -> np.ndarray:
    """Return the corners of a bent shape in the body's frame, shape (axis, corner) [m]; the last results are cached."""
    corners = shape.bend.map_to_bent(shape.facets.still_corners, time)
    corners.flags.writeable = False
    return corners


_TETRAHEDRON = (5 + 3 * 5**0.5) / 20, (5 - 5**0.5) / 20
"""Barycentric weights of the four-point quadrature on a tetrahedron, exact for polynomials of second order [-]."""


def _extent(corners: np.ndarray) -> float:
    """Return the greatest extent of corners along an axis [m]."""
    return float(np.ptp(corners, axis=1).max())


def bend_shape(shape: PlaneSolid | TriangleMesh, back: Back, *, tick: float = DEFAULT_DIFFERENCE_TIME) -> Bent:
    """Return a body that a map bends, swells, shears or moves, in the plane or in space.

    Args:
        shape: the still shape: any ``PlaneSolid``, such as an ``Ellipse`` or ``from_outline``, or a ``TriangleMesh``.
        back: ``back(x, y, time)``, in space ``back(x, y, z, time)``: which place of the still shape is at places of the
            body's frame, arrays of coordinates [m, s]; smooth, one to one, and defined a few cells around the body too.
        tick: time over which it is differentiated [s].

    Raises:
        InvalidDesign: the shape is of another kind, the tick is not positive, or the map folds the body at time 0.
    """
    if not (isfinite(tick) and tick > 0):
        raise InvalidDesign(f"tick is {tick} s; a positive time is needed, short for what the map does.")
    given: object = shape
    if isinstance(given, PlaneSolid):
        facets: Facets = OutlineEdges.of_outline(given)
    elif isinstance(given, TriangleMesh):
        facets = MeshTriangles.of_mesh(given)
    else:
        raise InvalidDesign(
            f"a {type(given).__name__} cannot be bent by a map; give a PlaneSolid, such as from_outline or an Ellipse, "
            f"or a closed mesh."
        )
    bent = Bent(facets=facets, bend=BendingMap(back, shape.ndim, _extent(facets.still_corners), tick))
    bent.bounds(0.0, Pose())
    return bent
