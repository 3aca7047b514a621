"""Closed surfaces of which the skin is made: lofts, ellipsoids, scutes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True, slots=True)
class Mesh:
    """A closed triangle mesh, its faces counterclockwise as seen from outside."""

    vertices: np.ndarray
    """(n, 3) [m]."""
    faces: np.ndarray
    """(m, 3), places among the vertices."""
    colours: np.ndarray
    """(n, 3), red, green, blue from 0 to 1."""

    def mirrored(self) -> "Mesh":
        """Return the mesh with left and right exchanged."""
        return replace(self, vertices=self.vertices * np.array([1.0, -1.0, 1.0]), faces=self.faces[:, ::-1])

    def painted(self, colour: np.ndarray | Callable[[np.ndarray], np.ndarray]) -> "Mesh":
        """Return the mesh in a colour, or in one for each vertex."""
        painted = colour(self.vertices) if callable(colour) else colour
        return replace(self, colours=np.broadcast_to(painted, self.vertices.shape).copy())


def curve(knots: Sequence[tuple[float, float]]) -> Callable[[np.ndarray], np.ndarray]:
    """Return the smooth curve through points that overshoots nowhere, constant beyond the ends.

    Monotone cubic pieces after Fritsch and Carlson (1980), with the harmonic mean of neighbouring slopes.

    Args:
        knots: points (x, y), x increasing.
    """
    x, y = np.array(knots, dtype=float).T
    slopes = np.diff(y) / np.diff(x)
    slope_products = slopes[:-1] * slopes[1:]
    total = np.where(slope_products > 0, slopes[:-1] + slopes[1:], 1.0)
    inner = np.where(slope_products > 0, 2 * slope_products / total, 0.0)
    tangents = np.concatenate([[0.0], inner, [0.0]])

    def value(positions: np.ndarray) -> np.ndarray:
        """Return the curve at positions along x."""
        positions = np.clip(positions, x[0], x[-1])
        i = np.clip(np.searchsorted(x, positions, side="right") - 1, 0, len(x) - 2)
        h = x[i + 1] - x[i]
        t = (positions - x[i]) / h
        rise = y[i] * (1 + 2 * t) * (1 - t) ** 2 + y[i + 1] * t**2 * (3 - 2 * t)
        return rise + h * (tangents[i] * t * (1 - t) ** 2 - tangents[i + 1] * t**2 * (1 - t))

    return value


def loft(rings: np.ndarray) -> Mesh:
    """Return the surface over closed rings, with a point in the middle of either end ring.

    Args:
        rings: (ring, point, 3); the points run counterclockwise as seen from the side of the last ring.
    """
    count, point_count = rings.shape[:2]
    ends = rings[[0, -1]].mean(axis=1)
    vertices = np.concatenate([rings.reshape(-1, 3), ends])
    i, j = np.meshgrid(np.arange(count - 1), np.arange(point_count), indexing="ij")
    a, b = i * point_count + j, i * point_count + (j + 1) % point_count
    side = np.stack([a, b, b + point_count, a, b + point_count, a + point_count], axis=-1).reshape(-1, 3)
    k = np.arange(point_count)
    start_cap = np.stack([(k + 1) % point_count, k, np.full(point_count, count * point_count)], axis=-1)
    top = (count - 1) * point_count
    end_cap = np.stack([top + k, top + (k + 1) % point_count, np.full(point_count, count * point_count + 1)], axis=-1)
    faces = np.concatenate([side, start_cap, end_cap])
    return Mesh(vertices, faces.astype(np.int32), np.ones_like(vertices))


def ring(point_count: int, roundness: float = 2.0) -> tuple[np.ndarray, np.ndarray]:
    """Return the points (cosine-like, sine-like) of a superellipse, left and right exactly alike.

    Args:
        point_count: number of points, a multiple of four.
        roundness: exponent: 2 an ellipse, more a rounded box.
    """
    quarter = np.pi / 2 * np.arange(point_count // 4) / (point_count // 4)
    c, s = np.cos(quarter) ** (2 / roundness), np.sin(quarter) ** (2 / roundness)
    s[0] = 0.0
    cosine, sine = np.concatenate([c, -s, -c, s]), np.concatenate([s, c, -s, -c])
    return cosine + 0.0, sine + 0.0


def ellipsoid(centre: Sequence[float], half: Sequence[float], *, point_count: int = 8, rings: int = 6) -> Mesh:
    """Return an ellipsoid.

    Args:
        centre: (x, y, z) [m].
        half: its half axes [m].
        point_count: number of points around its x axis, a multiple of four.
        rings: number of rings along it.
    """
    axial = -np.cos(np.pi * (np.arange(rings) + 0.7) / (rings + 0.4))
    radius, (c, s) = np.sqrt(1 - axial**2), ring(point_count)
    points = np.stack(
        [np.broadcast_to(axial[:, None], (rings, point_count)), radius[:, None] * c, radius[:, None] * s], axis=-1
    )
    return loft(np.array(centre) + points * np.array(half))


def spike(base: np.ndarray, apex: np.ndarray) -> Mesh:
    """Return a cone over a ring of points.

    Args:
        base: (point, 3), counterclockwise as seen from the apex.
        apex: (3,) [m].
    """
    point_count = len(base)
    k = np.arange(point_count)
    side_faces = np.stack([k, (k + 1) % point_count, np.full(point_count, point_count)], axis=-1)
    base_faces = np.stack([(k + 1) % point_count, k, np.full(point_count, point_count + 1)], axis=-1)
    vertices = np.concatenate([base, [apex], [base.mean(axis=0)]])
    return Mesh(vertices, np.concatenate([side_faces, base_faces]).astype(np.int32), np.ones_like(vertices))


def join_meshes(meshes: Sequence[Mesh]) -> Mesh:
    """Return meshes as one."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.faces + start for mesh, start in zip(meshes, starts, strict=False)]),
        np.concatenate([mesh.colours for mesh in meshes]),
    )


def normals(mesh: Mesh) -> np.ndarray:
    """Return the unit normal at each vertex, the mean of its faces' weighted by their areas, (n, 3)."""
    corners = mesh.vertices[mesh.faces]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    vertex_normals = np.zeros_like(mesh.vertices)
    for i in range(3):
        np.add.at(vertex_normals, mesh.faces[:, i], areas)
    return vertex_normals / np.maximum(np.linalg.norm(vertex_normals, axis=1, keepdims=True), 1e-30)
