# mypy: disable-error-code="no-untyped-def"
# ruff: noqa: ARG002 - rigid and bending shapes share one interface, rigid ones ignore the time
# (the kernels get their types from numba)
"""Rigid bodies in space inside a closed mesh of triangles, as an STL or OBJ file has it.

The sign of a distance is that of the pseudo-normal of the nearest face, edge or corner (Baerentzen and Aanaes 2005),
which is right everywhere around a closed mesh.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import ClassVar

import numpy as np
from numba import prange

from suchus.core.errors import InvalidDesign
from suchus.core.isosurface import isosurface
from suchus.core.reading import read_mesh
from suchus.flow.compiled import kernel_part, signed, threaded
from suchus.flow.markers import Markers
from suchus.flow.mass import Mass, tensor
from suchus.flow.pose import Pose
from suchus.flow.shape import Axes, Field, Shape, check_positive
from suchus.flow.solid import box_around, is_blunt, rigid_velocity, skin_spins

_SYMMETRY_TOLERANCE = 1e-6
"""Distance of corners from their mirror images, over the mesh's size, up to which it is symmetric [-]."""
_PROBES = 8
"""Points along the radius of the largest ball that fits in the mesh, in the search for its thickness [-]."""
_AMPLE = 1.05
"""Margin of that radius [-]."""
_CELLS_ALONG_BOX = 100
"""Cells along the longest side of the box in which the surface of a signed distance is searched [-]."""
_BALL_MARGIN = 1.0 + 1e-6
"""Radius of the ball around a triangle over the distance of its farthest corner from its centroid [-]."""
_NEWTON = 3
"""Newton steps that move the corners onto the surface [-]."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TriangleMesh(Shape):
    """A rigid body inside a closed mesh of triangles.

    Triangles of about a cell are enough; the time that it takes to place the body grows with their number.

    Raises:
        InvalidDesign: on creation, for a mesh that is open, wound unevenly or looks inwards.
    """

    ndim: ClassVar[int] = 3

    vertices: np.ndarray
    """Corners in the body's own frame, shape (vertex, 3) [m]."""
    faces: np.ndarray
    """Indices of the corners of each triangle, counter-clockwise seen from outside, shape (face, 3) [-]."""
    _normals: np.ndarray = field(init=False, repr=False)
    _max_thickness: float = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Refuse a mesh that is open, wound unevenly or looks inwards; compute its normals and its thickness."""
        vertices, faces = np.array(self.vertices, float), np.array(self.faces)
        if vertices.ndim != 2 or vertices.shape[1:] != (3,) or not np.isfinite(vertices).all():
            raise InvalidDesign(f"the vertices have shape {vertices.shape}; give rows of three finite numbers.")
        if faces.ndim != 2 or faces.shape[1:] != (3,) or faces.dtype.kind not in "iu" or len(faces) < 4:
            raise InvalidDesign(f"the faces have shape {faces.shape}; give at least four rows of three whole numbers.")
        if faces.min() < 0 or faces.max() >= len(vertices):
            raise InvalidDesign(f"a face names vertex {int(faces.max())}, and there are {len(vertices)} from 0 on.")
        _refuse_open(vertices, faces)
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)
        volume = self.volume(0.0)
        if volume <= 0:
            raise InvalidDesign(
                f"the faces of the mesh look inwards: its volume is {volume:.3g} m3. Turn them round, as "
                "mesh.invert() of trimesh does."
            )
        object.__setattr__(self, "_normals", pseudo_normals(vertices, faces))
        object.__setattr__(self, "_max_thickness", self._max_ball_diameter())

    @property
    def mirror_symmetry(self) -> tuple[bool, ...]:  # type: ignore[override]
        """Whether the planes through the origin across x, y and z cut it into halves that are images of each other."""
        from scipy.spatial import KDTree  # noqa: PLC0415  a fifth of the time of an import of flow

        tree, tolerance = KDTree(self.vertices), _SYMMETRY_TOLERANCE * float(np.ptp(self.vertices, axis=0).max())
        mirrored = [self.vertices * np.where(np.arange(3) == d, -1, 1) for d in range(3)]
        x, y, z = (float(np.max(tree.query(mirror_image)[0])) <= tolerance for mirror_image in mirrored)
        return x, y, z

    def measure(self, points: Axes, time: float, pose: Pose, reach: float) -> Field:
        """Return the field on the points of a window, as far as ``reach``."""
        vertices = np.stack(pose.to_world(self.vertices.T))
        normals = np.ascontiguousarray(self._normals @ pose.matrix.T)
        distance, *normal = paint_triangles(vertices, self.faces, normals, points, reach)
        return Field(distance, tuple(normal), rigid_velocity(points, pose), np.full(distance.shape, np.inf))

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return the middles of the triangles, of large ones those of equal parts."""
        vertices = np.stack(pose.to_world(self.vertices.T), axis=1)
        points, areas, normals = face_centres(vertices[self.faces], spacing)
        return Markers(
            points=points, weight=areas, velocities=np.stack(pose.velocity_at(points)), normals=normals,
            spins=skin_spins(pose, points),
        )  # fmt: skip

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the box around the corners."""
        return box_around(np.stack(pose.to_world(self.vertices.T)))

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the diameter of the largest ball inside, to a twentieth of it."""
        return np.zeros(1), np.full(1, self._max_thickness)

    def _max_ball_diameter(self) -> float:
        """Return the diameter of the largest ball inside [m], at most 6 volumes over the area of a convex body."""
        edges = self.vertices[self.faces[:, 1:]] - self.vertices[self.faces[:, :1]]
        area = 0.5 * float(np.sqrt((np.cross(edges[:, 0], edges[:, 1]) ** 2).sum(axis=1)).sum())
        reach = _AMPLE * 3 * self.volume(0.0) / area
        step, lower_bound, upper_bound = reach / _PROBES, self.vertices.min(axis=0), self.vertices.max(axis=0)
        for _ in range(2):
            x, y, z = (np.arange(a - step, b + 2 * step, step) for a, b in zip(lower_bound, upper_bound, strict=True))
            depth = -self.measure((x, y, z), 0.0, Pose(), reach).distance
            k, j, i = np.unravel_index(int(depth.argmax()), depth.shape)
            best = np.array([x[i], y[j], z[k]])
            lower_bound, upper_bound, step = best - step, best + step, step / 4
        return 2 * float(depth.max())

    @property
    def is_compact(self) -> bool:
        """Whether it is about as long along each axis."""
        return is_blunt(np.ptp(self.vertices, axis=0))

    def mass(self, time: float) -> Mass:
        """Return volume, centre and moments, exact for the mesh."""
        return mass_of_mesh(self.vertices[self.faces])


def _six_volumes(corners: np.ndarray) -> np.ndarray:
    """Return six times the volumes of the tetrahedra between the origin and each face, (face, corner, axis) [m^3]."""
    volumes: np.ndarray = np.einsum("fd,fd->f", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    return volumes


def mass_of_mesh(corners: np.ndarray) -> Mass:
    """Return the mass inside a rigid closed mesh, from the corners of its faces (face, corner, axis) [m]."""
    six, total, zero = _six_volumes(corners), corners.sum(axis=1), (0.0, 0.0, 0.0)
    volume = float(six.sum()) / 6
    centre = (six[:, None] * total).sum(axis=0) / 24 / volume
    second = (np.einsum("f,fi,fj->ij", six, total, total) + np.einsum("f,fki,fkj->ij", six, corners, corners)) / 120
    cx, cy, cz = centre.tolist()
    moments = tensor(second - volume * np.outer(centre, centre))
    return Mass(volume=volume, centre=(cx, cy, cz), centre_rate=zero, moments=moments, swirl=zero)


def face_centres(corners: np.ndarray, spacing: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the middles of faces, of large ones those of equal parts, the area of each and its normal.

    Args:
        corners: corners of the faces, shape (face, corner, axis) [m].
        spacing: approximate distance of the middles [m].
    """
    edges = np.roll(corners, -1, axis=1) - corners
    parts = np.maximum(1, np.ceil(np.sqrt((edges**2).sum(axis=2)).max(axis=1) / spacing)).astype(int)
    normal_vectors = np.cross(edges[:, 0], edges[:, 1])
    area = 0.5 * np.sqrt((normal_vectors**2).sum(axis=1))
    points, areas, normals = [], [], []
    for count in np.unique(parts):
        is_selected, weights = parts == count, _middles(int(count))
        points.append(np.einsum("mk,fkd->dfm", weights, corners[is_selected]).reshape(3, -1))
        areas.append(np.repeat(area[is_selected] / count**2, count**2))
        normals.append(
            np.repeat(normal_vectors[is_selected] / np.maximum(2 * area[is_selected, None], 1e-300), count**2, axis=0).T
        )
    return np.concatenate(points, axis=1), np.concatenate(areas), np.concatenate(normals, axis=1)


def from_mesh(path: Path | str, *, scale: float = 1.0) -> TriangleMesh:
    """Return the body inside a mesh.

    Args:
        path: an STL, OBJ, PLY, OFF or GLB file; read by trimesh (extra ``meshes``).
        scale: metres in a unit of the file: 0.001 for one in millimetres [m].

    Raises:
        InvalidDesign: the mesh is open, wound unevenly or looks inwards.
        UnreadableFile: the file is no mesh, or trimesh is not installed.
    """
    check_positive("scale", scale)
    mesh = read_mesh(Path(path))
    faces = np.array(mesh.faces)
    is_proper = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return TriangleMesh(vertices=scale * np.array(mesh.vertices), faces=faces[is_proper])


def mesh_of_sdf(function: Callable[..., np.ndarray], box: tuple[float, ...]) -> TriangleMesh:
    """Return the body where ``function(x, y, z)`` is negative, as a mesh whose corners lie on its surface.

    Between the corners, a hundredth of the box's longest side apart, the faces are flat.

    Args:
        function: negative inside the body and positive outside [m]; its gradient must not vanish on the surface.
        box: around the body: x0, x1, y0, y1, z0, z1 [m].

    Raises:
        InvalidDesign: the function is nowhere negative in the box, or negative on its sides, or not finite.
    """
    lower_bound, upper_bound = np.array(box[::2], float), np.array(box[1::2], float)
    cell = float((upper_bound - lower_bound).max()) / _CELLS_ALONG_BOX
    x, y, z = (np.arange(a, b + cell, cell) for a, b in zip(lower_bound, upper_bound, strict=True))
    wz, wy, wx = np.meshgrid(z, y, x, indexing="ij")
    values = np.asarray(function(wx, wy, wz), float)
    box_text = ", ".join(
        f"{axis} = {a:.4g} to {b:.4g} m" for axis, a, b in zip("xyz", lower_bound, upper_bound, strict=True)
    )
    if values.shape != wx.shape or not np.isfinite(values).all():
        raise InvalidDesign("the signed distance is not a finite number at every point of the box; mend the function.")
    if values.min() >= 0:
        raise InvalidDesign(
            f"the signed distance is nowhere negative in {box_text}; it is negative inside the body. Give a box "
            f"around it."
        )
    if min(float(np.take(values, (0, -1), axis=d).min()) for d in range(3)) <= 0:
        raise InvalidDesign(f"the body reaches the sides of its box {box_text}; give a larger box.")
    surface = isosurface(-values, 0.0, (x[0], y[0], z[0]), cell)
    points, step = surface.points.T, 1e-4 * cell
    for _ in range(_NEWTON):
        slope = np.stack([function(*(points + d)) - function(*(points - d)) for d in step * np.eye(3)[:, :, None]])
        slope /= 2 * step
        points = points - function(*points) * slope / np.maximum((slope**2).sum(axis=0), 1e-12)
    return TriangleMesh(vertices=points.T, faces=surface.faces)


def _refuse_open(vertices: np.ndarray, faces: np.ndarray) -> None:
    """Refuse a surface that is not closed, or whose faces have different orientations.

    Args:
        vertices: corners of the mesh, shape (vertex, 3) [m].
        faces: indices of each triangle's corners, shape (face, 3).

    Raises:
        InvalidDesign: the message names an edge and the remedy.
    """
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    edge_keys, reverse_keys = start * len(vertices) + end, end * len(vertices) + start
    unique_keys, count = np.unique(edge_keys, return_counts=True)
    if (count > 1).any():
        start_vertex, end_vertex = divmod(int(unique_keys[count > 1][0]), len(vertices))
        raise InvalidDesign(
            f"two faces of the mesh go the same way along the edge from {point_text(vertices[start_vertex])} to "
            f"{point_text(vertices[end_vertex])} m: they look to different sides, or more than two meet there. "
            "Wind them evenly, as trimesh.repair.fix_winding does, and keep one surface."
        )
    open_edges = np.flatnonzero(~np.isin(reverse_keys, unique_keys))
    if open_edges.size:
        start_vertex, end_vertex = int(start[open_edges[0]]), int(end[open_edges[0]])
        raise InvalidDesign(
            f"the mesh is open: it has {open_edges.size} edges with one face, the first from "
            f"{point_text(vertices[start_vertex])} to {point_text(vertices[end_vertex])} m. Close it, as "
            "trimesh.repair.fill_holes or Blender does."
        )


def point_text(point: np.ndarray) -> str:
    """Return the coordinates of a point in brackets, to four digits."""
    return f"({', '.join(f'{coordinate:.4g}' for coordinate in point)})"


def pseudo_normals(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Return the pseudo-normals of each face, its three edges and its three corners, shape (face, 7, 3) [-].

    The pseudo-normal of an edge is the sum of the normals of its two faces. That of a corner is the sum of the normals
    of all faces around it, weighted by their angles at the corner.

    Args:
        vertices: corners of the mesh, shape (vertex, 3) [m].
        faces: indices of each triangle's corners, shape (face, 3).
    """
    corners = vertices[faces]
    edges = np.roll(corners, -1, axis=1) - corners
    length = np.maximum(np.sqrt((edges**2).sum(axis=2, keepdims=True)), 1e-300)
    flat = np.cross(edges[:, 0], edges[:, 1])
    flat = flat / np.maximum(np.sqrt((flat**2).sum(axis=1, keepdims=True)), 1e-300)
    cosine = -((edges / length) * np.roll(edges / length, 1, axis=1)).sum(axis=2)
    vertex_normals = np.zeros(vertices.shape)
    np.add.at(vertex_normals, faces, np.arccos(np.clip(cosine, -1, 1))[:, :, None] * flat[:, None])
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    edge_keys, reverse_keys = start * len(vertices) + end, end * len(vertices) + start
    order = np.argsort(edge_keys)
    neighbour_faces = order[np.searchsorted(edge_keys, reverse_keys, sorter=order)] // 3
    normals = np.empty((len(faces), 7, 3))
    normals[:, 0] = flat
    normals[:, 1:4] = flat[:, None] + flat[neighbour_faces].reshape(-1, 3, 3)
    normals[:, 4:] = vertex_normals[faces]
    return normals / np.maximum(np.sqrt((normals**2).sum(axis=2, keepdims=True)), 1e-300)


def _middles(count: int) -> np.ndarray:
    """Return the weights of a triangle's corners at the middles of ``count**2`` equal parts, shape (part, 3) [-]."""
    i, j = (a.ravel() for a in np.meshgrid(np.arange(count), np.arange(count), indexing="ij"))
    is_upright, is_inverted = i + j < count, i + j < count - 1
    weight_1 = np.concatenate([i[is_upright] + 1 / 3, i[is_inverted] + 2 / 3]) / count
    weight_2 = np.concatenate([j[is_upright] + 1 / 3, j[is_inverted] + 2 / 3]) / count
    return np.stack([1 - weight_1 - weight_2, weight_1, weight_2], axis=1)


def paint_triangles(
    vertices: np.ndarray, faces: np.ndarray, normals: np.ndarray, points: Axes, reach: float
) -> np.ndarray:
    """Return signed distance [m] and normal [-] of a mesh on a window, shape (4, z, y, x); see ``paint_mesh``.

    Args:
        vertices: corners, shape (3, vertex) [m].
        faces: indices of each triangle's corners, shape (face, 3).
        normals: pseudo-normals, shape (face, 7, 3).
        points: coordinates of the window along each axis [m].
        reach: distance up to which both are exact [m].
    """
    x, y, z = (np.ascontiguousarray(line, float) for line in points)
    window_field = np.zeros((4, z.size, y.size, x.size))
    h = float(x[1] - x[0]) if x.size > 1 else float(reach)
    paint_mesh(window_field, x, y, z, np.ascontiguousarray(vertices.T[faces]), normals, float(reach), h)
    return window_field


@kernel_part
def _dot(x1, y1, z1, x2, y2, z2):
    return x1 * x2 + y1 * y2 + z1 * z2


@kernel_part
def _nearest_point(px, py, pz, t):
    """Return two barycentric weights of a triangle's point nearest to a point, and the feature that it lies on.

    The weights are those of the second and third corner. Features: 0 is the face, 1 to 3 are the edges after its
    corners, 4 to 6 the corners. By the regions of Voronoi (Ericson 2005, section 5.1.5).

    Args:
        px: x of the point.
        py: y of the point.
        pz: z of the point.
        t: corners of the triangle, shape (corner, axis).
    """
    ux, uy, uz = t[1, 0] - t[0, 0], t[1, 1] - t[0, 1], t[1, 2] - t[0, 2]
    vx, vy, vz = t[2, 0] - t[0, 0], t[2, 1] - t[0, 1], t[2, 2] - t[0, 2]
    x, y, z = px - t[0, 0], py - t[0, 1], pz - t[0, 2]
    d1, d2 = _dot(ux, uy, uz, x, y, z), _dot(vx, vy, vz, x, y, z)
    if d1 <= 0.0 and d2 <= 0.0:
        return 0.0, 0.0, 4
    x, y, z = px - t[1, 0], py - t[1, 1], pz - t[1, 2]
    d3, d4 = _dot(ux, uy, uz, x, y, z), _dot(vx, vy, vz, x, y, z)
    if d3 >= 0.0 and d4 <= d3:
        return 1.0, 0.0, 5
    c = d1 * d4 - d3 * d2
    if c <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        return d1 / (d1 - d3), 0.0, 1
    x, y, z = px - t[2, 0], py - t[2, 1], pz - t[2, 2]
    d5, d6 = _dot(ux, uy, uz, x, y, z), _dot(vx, vy, vz, x, y, z)
    if d6 >= 0.0 and d5 <= d6:
        return 0.0, 1.0, 6
    b = d5 * d2 - d1 * d6
    if b <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        return 0.0, d2 / (d2 - d6), 3
    a = d3 * d6 - d5 * d4
    if a <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0:
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        return 1.0 - w, w, 2
    total = a + b + c
    return b / total, c / total, 0


@kernel_part
def _enclosing_ball(t):
    """Return centre and radius of a ball that holds a triangle, larger by far more than both are rounded.

    Args:
        t: corners of the triangle, shape (corner, axis).
    """
    cx, cy, cz = (t[0, 0] + t[1, 0] + t[2, 0]) / 3, (t[0, 1] + t[1, 1] + t[2, 1]) / 3, (t[0, 2] + t[1, 2] + t[2, 2]) / 3
    square = 0.0
    for k in range(3):
        x, y, z = t[k, 0] - cx, t[k, 1] - cy, t[k, 2] - cz
        square = max(square, _dot(x, y, z, x, y, z))
    return cx, cy, cz, _BALL_MARGIN * np.sqrt(square)


@kernel_part
def _span(lower_bound, upper_bound, reach, start, h, count):
    """Return the first point of a line that lies within a reach of an interval, and the point after the last.

    Args:
        lower_bound: lower bound of the interval.
        upper_bound: upper bound of the interval.
        reach: distance around it.
        start: coordinate of the line's first point.
        h: distance of the points.
        count: points of the line.
    """
    return max(int(np.ceil((lower_bound - reach - start) / h)), 0), min(
        int(np.floor((upper_bound + reach - start) / h)) + 1, count
    )


@threaded
def paint_mesh(window_field, x, y, z, corners, normals, reach, h):
    """Write signed distance and normal (3) of a mesh to a window, shape (4, z, y, x).

    Args:
        window_field: array to write to, zeros; beyond ``reach`` the normal stays zero, and the distance is plus or
            minus ``reach``.
        x: coordinates of the points, ``h`` apart.
        y: coordinates of the points, ``h`` apart.
        z: coordinates of the points.
        corners: corners of the triangles, shape (face, 3, 3).
        normals: pseudo-normals of faces, edges and corners, shape (face, 7, 3).
        reach: distance up to which both are exact.
        h: distance of the points.
    """
    for n in prange(window_field.shape[1]):
        q = signed(n)
        for j in range(window_field.shape[2]):
            for i in range(window_field.shape[3]):
                window_field[0, q, j, i] = reach
        for f in range(corners.shape[0]):
            t = corners[f]
            if z[q] < min(t[0, 2], t[1, 2], t[2, 2]) - reach or z[q] > max(t[0, 2], t[1, 2], t[2, 2]) + reach:
                continue
            j0, j1 = _span(min(t[0, 1], t[1, 1], t[2, 1]), max(t[0, 1], t[1, 1], t[2, 1]), reach, y[0], h, y.size)
            i0, i1 = _span(min(t[0, 0], t[1, 0], t[2, 0]), max(t[0, 0], t[1, 0], t[2, 0]), reach, x[0], h, x.size)
            cx, cy, cz, radius = _enclosing_ball(t)
            for j in range(j0, j1):
                square_beside = (y[j] - cy) ** 2 + (z[q] - cz) ** 2
                for i in range(i0, i1):
                    max_distance = abs(window_field[0, q, j, i]) + radius
                    if square_beside + (x[i] - cx) ** 2 > max_distance * max_distance:
                        continue  # another triangle is nearer
                    v, w, feature = _nearest_point(x[i], y[j], z[q], t)
                    u = 1.0 - v - w
                    dx = x[i] - (u * t[0, 0] + v * t[1, 0] + w * t[2, 0])
                    dy = y[j] - (u * t[0, 1] + v * t[1, 1] + w * t[2, 1])
                    dz = z[q] - (u * t[0, 2] + v * t[1, 2] + w * t[2, 2])
                    distance = np.sqrt(dx * dx + dy * dy + dz * dz)
                    if distance >= abs(window_field[0, q, j, i]):
                        continue
                    side = dx * normals[f, feature, 0] + dy * normals[f, feature, 1] + dz * normals[f, feature, 2]
                    signed_distance = distance if side >= 0.0 else -distance
                    window_field[0, q, j, i] = signed_distance
                    if distance > 1e-9 * h:
                        window_field[1, q, j, i] = dx / signed_distance
                        window_field[2, q, j, i] = dy / signed_distance
                        window_field[3, q, j, i] = dz / signed_distance
                    else:
                        for d in range(3):
                            window_field[1 + d, q, j, i] = normals[f, feature, d]
        for j in range(window_field.shape[2]):
            _fill_row(window_field, q, j, reach)


@kernel_part
def _fill_row(window_field, q, j, reach):
    """Give the points of a row that no triangle reached the sign of a neighbour that a triangle reached.

    Args:
        window_field: distance and normal, shape (4, z, y, x).
        q: index of the row along z.
        j: index of the row along y.
        reach: absolute distance of the points that no triangle reached.
    """
    is_inside, is_known = False, False
    for i in range(window_field.shape[3]):
        if abs(window_field[0, q, j, i]) < reach:
            if not is_known and window_field[0, q, j, i] < 0.0:
                for k in range(i):
                    window_field[0, q, j, k] = -reach
            is_inside, is_known = window_field[0, q, j, i] < 0.0, True
        elif is_inside:
            window_field[0, q, j, i] = -reach
