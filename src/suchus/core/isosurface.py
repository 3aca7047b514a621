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
        values: values at the nodes of a cubic grid, shape (z, y, x).
        level: the value.
        origin: x, y and z of the first node [m].
        cell: distance of neighbouring nodes [m].
    """
    is_above = values > level
    cubes = tuple(n - 1 for n in values.shape)
    crossed = [_crossings(values, is_above, level, axis) for axis in range(3)]
    cube_numbers = [_cubes_around(lower_nodes, axis, cubes) for axis, (lower_nodes, _, _) in enumerate(crossed)]
    flat_cubes = np.concatenate([numbers.ravel() for numbers in cube_numbers])
    edge_points = np.concatenate([np.repeat(crossing_points, 4, axis=0) for _, crossing_points, _ in crossed])
    surface_cubes, cube_indices = np.unique(flat_cubes[flat_cubes >= 0], return_inverse=True)
    count = np.bincount(cube_indices, minlength=surface_cubes.size)
    sums = [
        np.bincount(cube_indices, coordinates, surface_cubes.size) for coordinates in edge_points[flat_cubes >= 0].T
    ]
    grid_positions = (
        np.stack([coordinate_sums / count for coordinate_sums in sums], axis=1)
        if surface_cubes.size
        else np.zeros((0, 3))
    )
    faces = []
    for numbers, (_, _, falling) in zip(cube_numbers, crossed, strict=True):
        is_interior = (numbers >= 0).all(axis=1)
        a, b, c, d = np.searchsorted(surface_cubes, numbers[is_interior]).T
        down = falling[is_interior]
        b, d = np.where(down, b, d), np.where(down, d, b)
        faces += [np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]
    points = np.array(origin) + cell * grid_positions[:, ::-1]
    return IsoSurface(points, np.concatenate(faces).astype(np.int32), grid_positions)


def _crossings(
    values: np.ndarray, is_above: np.ndarray, level: float, axis: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:  # fmt: skip
    """Return for each grid edge that the surface crosses: lower node, crossing point, whether the field falls.

    The arrays have the shapes (edge, 3), (edge, 3) and (edge,).

    Args:
        values: values at the nodes of the grid, shape (z, y, x).
        is_above: whether each value is above the level, same shape.
        level: value of the field on the surface.
        axis: axis of the values, along which the edges run [-].
    """
    lower_slice, upper_slice = [slice(None)] * 3, [slice(None)] * 3
    lower_slice[axis], upper_slice[axis] = slice(None, -1), slice(1, None)
    lower_nodes = np.argwhere(is_above[tuple(lower_slice)] != is_above[tuple(upper_slice)])
    upper_nodes = lower_nodes + np.eye(3, dtype=int)[axis]
    a, b = (values[tuple(nodes.T)].astype(float) for nodes in (lower_nodes, upper_nodes))
    crossing_points = lower_nodes.astype(float)
    crossing_points[:, axis] += (level - a) / (b - a)
    return lower_nodes, crossing_points, is_above[tuple(lower_nodes.T)]


def _cubes_around(lower_nodes: np.ndarray, axis: int, cubes: tuple[int, ...]) -> np.ndarray:
    """Return the flat indices of the four cubes around each edge, shape (edge, 4).

    They run counterclockwise as seen from the upper end of an edge. A cube beyond the sides has the index -1.

    Args:
        lower_nodes: indices (z, y, x) of the lower node of each edge, shape (edge, 3).
        axis: along which the edges run [-].
        cubes: number of cubes along z, y and x [-].
    """
    # indices run along z, y, x: the turn from the one to the other of these is counterclockwise about the axis
    first_axis, second_axis = {0: (2, 1), 1: (0, 2), 2: (1, 0)}[axis]
    numbers = []
    for first_shift, second_shift in ((1, 1), (0, 1), (0, 0), (1, 0)):
        cube = lower_nodes.copy()
        cube[:, first_axis] -= first_shift
        cube[:, second_axis] -= second_shift
        is_in_grid = ((cube >= 0) & (cube < cubes)).all(axis=1)
        flat = (cube[:, 0] * cubes[1] + cube[:, 1]) * cubes[2] + cube[:, 2]
        numbers.append(np.where(is_in_grid, flat, -1))
    return np.stack(numbers, axis=1)
