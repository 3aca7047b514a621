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
    both = slopes[:-1] * slopes[1:]
    total = np.where(both > 0, slopes[:-1] + slopes[1:], 1.0)
    inner = np.where(both > 0, 2 * both / total, 0.0)
    tangents = np.concatenate([[0.0], inner, [0.0]])

    def value(at: np.ndarray) -> np.ndarray:
        at = np.clip(at, x[0], x[-1])
        i = np.clip(np.searchsorted(x, at, side="right") - 1, 0, len(x) - 2)
        h = x[i + 1] - x[i]
        t = (at - x[i]) / h
        rise = y[i] * (1 + 2 * t) * (1 - t) ** 2 + y[i + 1] * t**2 * (3 - 2 * t)
        return rise + h * (tangents[i] * t * (1 - t) ** 2 - tangents[i + 1] * t**2 * (1 - t))

    return value


def loft(rings: np.ndarray) -> Mesh:
    """Return the surface over closed rings, with a point in the middle of either end ring.

    Args:
        rings: (ring, point, 3); the points run counterclockwise as seen from the side of the last ring.
    """
    count, around = rings.shape[:2]
    ends = rings[[0, -1]].mean(axis=1)
    vertices = np.concatenate([rings.reshape(-1, 3), ends])
    i, j = np.meshgrid(np.arange(count - 1), np.arange(around), indexing="ij")
    a, b = i * around + j, i * around + (j + 1) % around
    side = np.stack([a, b, b + around, a, b + around, a + around], axis=-1).reshape(-1, 3)
    k = np.arange(around)
    first = np.stack([(k + 1) % around, k, np.full(around, count * around)], axis=-1)
    top = (count - 1) * around
    last = np.stack([top + k, top + (k + 1) % around, np.full(around, count * around + 1)], axis=-1)
    faces = np.concatenate([side, first, last])
    return Mesh(vertices, faces.astype(np.int32), np.ones_like(vertices))


def ring(around: int, roundness: float = 2.0) -> tuple[np.ndarray, np.ndarray]:
    """Return the points (cosine-like, sine-like) of a superellipse, left and right exactly alike.

    Args:
        around: number of points, a multiple of four.
        roundness: exponent: 2 an ellipse, more a rounded box.
    """
    quarter = np.pi / 2 * np.arange(around // 4) / (around // 4)
    c, s = np.cos(quarter) ** (2 / roundness), np.sin(quarter) ** (2 / roundness)
    s[0] = 0.0
    cosine, sine = np.concatenate([c, -s, -c, s]), np.concatenate([s, c, -s, -c])
    return cosine + 0.0, sine + 0.0


def ellipsoid(centre: Sequence[float], half: Sequence[float], *, around: int = 8, rings: int = 6) -> Mesh:
    """Return an ellipsoid.

    Args:
        centre: (x, y, z) [m].
        half: its half axes [m].
        around: number of points around its x axis, a multiple of four.
        rings: number of rings along it.
    """
    along = -np.cos(np.pi * (np.arange(rings) + 0.7) / (rings + 0.4))
    radius, (c, s) = np.sqrt(1 - along**2), ring(around)
    points = np.stack(
        [np.broadcast_to(along[:, None], (rings, around)), radius[:, None] * c, radius[:, None] * s], axis=-1
    )
    return loft(np.array(centre) + points * np.array(half))


def spike(base: np.ndarray, apex: np.ndarray) -> Mesh:
    """Return a cone over a ring of points.

    Args:
        base: (point, 3), counterclockwise as seen from the apex.
        apex: (3,) [m].
    """
    around = len(base)
    k = np.arange(around)
    up = np.stack([k, (k + 1) % around, np.full(around, around)], axis=-1)
    under = np.stack([(k + 1) % around, k, np.full(around, around + 1)], axis=-1)
    vertices = np.concatenate([base, [apex], [base.mean(axis=0)]])
    return Mesh(vertices, np.concatenate([up, under]).astype(np.int32), np.ones_like(vertices))


def joined(meshes: Sequence[Mesh]) -> Mesh:
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
    found = np.zeros_like(mesh.vertices)
    for i in range(3):
        np.add.at(found, mesh.faces[:, i], areas)
    return found / np.maximum(np.linalg.norm(found, axis=1, keepdims=True), 1e-30)
