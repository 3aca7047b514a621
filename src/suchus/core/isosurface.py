"""The surface on which a field on a grid in space has a value, as triangles.

Surface nets: one point in each cube of eight neighbouring cell centres through which the surface passes, at the mean of
where it crosses the cube's edges; around each edge that it crosses, two triangles between the points of the four cubes
there. The result is closed but for the sides of the grid, and has a third of the triangles of marching tetrahedra.

Source: Gibson 1998, Constrained elastic surface nets, MICCAI, LNCS 1496, 888.
"""

from typing import NamedTuple

import numpy as np


class IsoSurface(NamedTuple):
    """Triangles, counterclockwise as seen from where the field is lower."""

    points: np.ndarray
    """Corners (x, y, z), shape (point, 3) [m]."""
    faces: np.ndarray
    """Places of three corners among the points, shape (face, 3)."""
    places: np.ndarray
    """Where the points are among the values, as fractions of their indices along z, y, x, shape (point, 3) [cells]."""


def isosurface(values: np.ndarray, level: float, origin: tuple[float, float, float], cell: float) -> IsoSurface:
    """Return the surface on which a field has a value.

    Args:
        values: at the nodes of a cubic grid, shape (z, y, x).
        level: the value.
        origin: x, y and z of the first node [m].
        cell: distance of neighbouring nodes [m].
    """
    above = values > level
    cubes = tuple(n - 1 for n in values.shape)
    crossed = [_crossings(values, above, level, axis) for axis in range(3)]
    around = [_cubes_around(lower, axis, cubes) for axis, (lower, _, _) in enumerate(crossed)]
    inside = np.concatenate([numbers.ravel() for numbers in around])
    each = np.concatenate([np.repeat(place, 4, axis=0) for _, place, _ in crossed])
    used, at = np.unique(inside[inside >= 0], return_inverse=True)
    count = np.bincount(at, minlength=used.size)
    sums = [np.bincount(at, part, used.size) for part in each[inside >= 0].T]
    places = np.stack([part / count for part in sums], axis=1) if used.size else np.zeros((0, 3))
    faces = []
    for numbers, (_, _, falling) in zip(around, crossed, strict=True):
        whole = (numbers >= 0).all(axis=1)
        a, b, c, d = np.searchsorted(used, numbers[whole]).T
        down = falling[whole]
        b, d = np.where(down, b, d), np.where(down, d, b)
        faces += [np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]
    points = np.array(origin) + cell * places[:, ::-1]
    return IsoSurface(points, np.concatenate(faces).astype(np.int32), places)


def _crossings(
    values: np.ndarray, above: np.ndarray, level: float, axis: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:  # fmt: skip
    """Return of each edge along an axis that the surface crosses: its lower node, where, and whether the field falls.

    Each of shape (edge, 3), (edge, 3) and (edge,).
    """
    first, second = [slice(None)] * 3, [slice(None)] * 3
    first[axis], second[axis] = slice(None, -1), slice(1, None)
    lower = np.argwhere(above[tuple(first)] != above[tuple(second)])
    upper = lower + np.eye(3, dtype=int)[axis]
    a, b = (values[tuple(nodes.T)].astype(float) for nodes in (lower, upper))
    place = lower.astype(float)
    place[:, axis] += (level - a) / (b - a)
    return lower, place, above[tuple(lower.T)]


def _cubes_around(lower: np.ndarray, axis: int, cubes: tuple[int, ...]) -> np.ndarray:
    """Return the numbers of the four cubes around edges, shape (edge, 4).

    They run counterclockwise as seen from the upper end of an edge. A cube beyond the sides has the number -1.
    """
    # indices run along z, y, x: the turn from the one to the other of these is counterclockwise about the axis
    one, other = {0: (2, 1), 1: (0, 2), 2: (1, 0)}[axis]
    numbers = []
    for back, aside in ((1, 1), (0, 1), (0, 0), (1, 0)):
        cube = lower.copy()
        cube[:, one] -= back
        cube[:, other] -= aside
        there = ((cube >= 0) & (cube < cubes)).all(axis=1)
        flat = (cube[:, 0] * cubes[1] + cube[:, 1]) * cubes[2] + cube[:, 2]
        numbers.append(np.where(there, flat, -1))
    return np.stack(numbers, axis=1)
