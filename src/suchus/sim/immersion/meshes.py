"""Closed surfaces of triangles: whether they are closed, their volume, centre and principal axes."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import ConvexHull, QhullError

from suchus.core.errors import InvalidDesign

_SAME = 1e-7
"""Distance over the size of a mesh within which two vertices are one [-]."""
_BOX_CORNERS = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
_BOX_FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
"""Corners of each face of a box, counterclockwise seen from outside."""


class SolidMesh(NamedTuple):
    """A closed surface, in the frame of its principal axes."""

    triangles: Float[np.ndarray, "triangle 9"]
    """Corners, counterclockwise seen from outside [m]."""
    volume: float
    """[m3]."""
    centre: Float[np.ndarray, "3"]
    """Centre of the volume in the mesh's own frame [m]."""
    axes: Float[np.ndarray, "3 3"]
    """Principal axes as columns, in the mesh's own frame."""
    half: Float[np.ndarray, "3"]
    """Half axes of the ellipsoid with the second moments of the volume, scaled to its volume [m]."""


def box_triangles(half: Float[np.ndarray, "3"]) -> Float[np.ndarray, "12 9"]:
    """Return the surface of a box as triangles [m].

    Args:
        half: half extents [m].
    """
    corners = _BOX_CORNERS * half
    rows = [[corners[p], corners[q], corners[r]] for p, q, r, _ in _BOX_FACES]
    rows += [[corners[p], corners[r], corners[s]] for p, _, r, s in _BOX_FACES]
    return np.array(rows).reshape(-1, 9)


def solid(
    vertices: Float[np.ndarray, "vertex 3"], faces: Int[np.ndarray, "face 3"], name: str, *, is_convex: bool = False
) -> SolidMesh:
    """Return a mesh as a closed surface.

    Args:
        vertices: [m].
        faces: indices of the corners of each triangle.
        name: name of the geom, for messages.
        is_convex: whether the convex hull stands for it.

    Raises:
        InvalidDesign: the mesh is open, flat or not a surface that has an inside.
    """
    vertices = np.asarray(vertices, float)
    size = float(np.ptp(vertices, axis=0).max())
    if is_convex:
        faces = _hull_faces(vertices, name)
    else:
        vertices, faces = _merged(vertices, np.asarray(faces, int), _SAME * max(size, 1e-12))
        _check_closed(faces, name)
    corners = vertices[faces]
    volume = _volume(corners)
    if volume < 0.0:
        corners, volume = corners[:, ::-1], -volume
    if volume <= 1e-9 * size**3:
        raise InvalidDesign(
            f"geom {name!r} is a mesh without an inside: its volume is {volume:.3g} m3 at a size of {size:.3g} m; give "
            "it thickness, or name it in dry."
        )
    determinants = np.linalg.det(corners)
    centre = (determinants[:, None] * corners.sum(axis=1)).sum(axis=0) / 24.0 / volume
    corners = corners - centre
    determinants = np.linalg.det(corners)
    sums = corners.sum(axis=1)
    second = np.einsum("n,ni,nj->ij", determinants, sums, sums) + np.einsum(
        "n,nki,nkj->ij", determinants, corners, corners
    )
    moments, axes = np.linalg.eigh(second / 120.0)
    if np.linalg.det(axes) < 0.0:
        axes[:, 0] *= -1.0
    half = np.sqrt(5.0 * moments / volume)
    half *= (volume / (4.0 / 3.0 * np.pi * np.prod(half))) ** (1.0 / 3.0)
    return SolidMesh((corners @ axes).reshape(-1, 9), volume, centre, axes, half)


def _volume(corners: Float[np.ndarray, "triangle 3 3"]) -> float:
    """Return the volume inside a closed surface, positive where it is counterclockwise seen from outside [m3]."""
    return float(np.linalg.det(corners - corners.reshape(-1, 3).mean(axis=0)).sum() / 6.0)


def _merged(vertices: np.ndarray, faces: np.ndarray, distance: float) -> tuple[np.ndarray, np.ndarray]:
    """Return vertices and faces with vertices at the same position made one, without faces that have no area."""
    _, first, inverse = np.unique(np.round(vertices / distance), axis=0, return_index=True, return_inverse=True)
    faces = inverse.reshape(-1)[faces]
    proper = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    return vertices[first], faces[proper]


def _check_closed(faces: np.ndarray, name: str) -> None:
    """Refuse a surface some of whose edges do not join two triangles that are turned the same way."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    directed, counts = np.unique(edges, axis=0, return_counts=True)
    pairs = {tuple(edge): int(count) for edge, count in zip(directed.tolist(), counts, strict=True)}
    unmatched = sum(pairs.get((q, p), 0) != count for (p, q), count in pairs.items())
    if unmatched:
        raise InvalidDesign(
            f"geom {name!r} is an open mesh: {unmatched} of its {len(pairs)} edges do not join two triangles that are "
            "turned alike, so that it has no volume; close the mesh, take its convex hull by "
            f"coefficients={{{name!r}: GeomCoefficients(is_convex=True)}}, or name it in dry."
        )


def _hull_faces(vertices: np.ndarray, name: str) -> np.ndarray:
    """Return the triangles of the convex hull, counterclockwise seen from outside."""
    try:
        hull = ConvexHull(vertices)
    except QhullError as error:
        raise InvalidDesign(f"geom {name!r} is a flat mesh: its convex hull has no volume; name it in dry.") from error
    faces = hull.simplices.copy()
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    is_inward = np.einsum("ij,ij->i", normals, hull.equations[:, :3]) < 0.0
    faces[is_inward] = faces[is_inward][:, ::-1]
    return faces
