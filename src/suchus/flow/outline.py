# ruff: noqa: ARG002 - rigid and bending shapes share one interface, rigid ones ignore the time
"""Rigid shapes of any outline: polygons, and shapes defined by a signed distance."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import overload

import numpy as np

from suchus.core.errors import InvalidDesign, UnreadableFile
from suchus.core.reading import read_text
from suchus.flow.mesh import TriangleMesh, mesh_of_sdf
from suchus.flow.paint import measure_outline, paint_outline
from suchus.flow.pose import Pose
from suchus.flow.shape import Axes, Field, check_positive
from suchus.flow.solid import PlaneSolid, Solid, rigid_velocity

_STEPS = 200  # steps per size of a body with which its outline is traced
_MIN_EXACT_FRACTION = 0.9  # fraction of an outline on which the gradient of a true distance is 1; corners are the rest
_GRADIENT_TOLERANCE = 0.02  # deviation of such a gradient from 1
_MIN_GRADIENT_QUANTILE = 0.01  # quantile of the gradient that bounds it from below: at corners it is a mean
_SUBDIVISIONS = 8  # points per step after the refinement


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Polygon(PlaneSolid):
    """A polygon whose edges do not cross.

    Raises:
        InvalidDesign: on creation, for fewer than three corners, corners that are not finite, or crossing edges.
    """

    corners: np.ndarray
    """Corners in order around it, either way, the first not repeated, shape (corner, 2) [m]."""

    def __post_init__(self) -> None:
        """Check the corners and store them counter-clockwise, without repetitions."""
        corners = np.array(self.corners, dtype=np.float64)
        if corners.ndim != 2 or corners.shape[1] != 2 or not np.isfinite(corners).all():
            raise InvalidDesign(f"the corners have shape {corners.shape}; give rows of two finite numbers, x and y.")
        corners = corners[(corners != np.roll(corners, -1, axis=0)).any(axis=1)]
        if len(corners) < 3:
            raise InvalidDesign(f"the outline has {len(corners)} different corners; at least 3 are needed.")
        crossing = _crossing(corners)
        if crossing is not None:
            raise InvalidDesign(
                f"the outline crosses itself: edge {crossing[0]} from {corners[crossing[0]].tolist()} m and edge "
                f"{crossing[1]} from {corners[crossing[1]].tolist()} m; give the corners in order around the body."
            )
        object.__setattr__(self, "corners", corners if _area(corners) > 0 else corners[::-1].copy())

    def distance(self, *points: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return signed distance [m] and outward normal (x, y) [-] at points of the body's frame [m]."""
        px, py = np.broadcast_arrays(*(np.asarray(line, float) for line in points))
        fields = np.empty((3, px.size))
        measure_outline(fields, px.ravel(), py.ravel(), self._outline_points, self._flat)
        d, nx, ny = fields.reshape(3, *px.shape)
        return d, nx, ny

    def measure(self, points: Axes, time: float, pose: Pose, reach: float) -> Field:
        """Return distance, normal and velocity on the points of a window; see ``Shape.measure``."""
        d, nx, ny = paint_polygon(np.stack(pose.to_world(self._outline_points)), points, reach, self._flat)
        return Field(d, (nx, ny), rigid_velocity(points, pose), np.full(d.shape, np.inf))

    @property
    def _outline_points(self) -> np.ndarray:
        return np.ascontiguousarray(self.corners.T)

    @property
    def _flat(self) -> float:
        return 1e-9 * float(np.ptp(self.corners))

    def outline(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the corners and points between them, about ``count`` in all and about evenly spaced [m]."""
        edges = np.roll(self.corners, -1, axis=0) - self.corners
        length = np.hypot(*edges.T)
        parts = np.maximum(1, np.round(count * length / length.sum())).astype(int)
        edge_index = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
        fraction = edge_index / np.repeat(parts, parts)
        points = np.repeat(self.corners, parts, axis=0) + fraction[:, None] * np.repeat(edges, parts, axis=0)
        return points[:, 0], points[:, 1]

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the diameter of the largest circle inside, to a hundredth of the outline's size."""
        return np.zeros(1), np.full(1, _widest(self))


def paint_polygon(corners: np.ndarray, points: Axes, reach: float, flat: float) -> np.ndarray:
    """Return signed distance [m] and normal [-] of a polygon on a window, shape (3, y, x); see ``paint_outline``.

    Args:
        corners: its corners, counter-clockwise, shape (2, corner) [m].
        points: coordinates of the window along each axis [m].
        reach: distance up to which both are exact [m].
        flat: distance below which a point has the normal of its edge [m].
    """
    x, y = points
    h = float(x[-1] - x[0]) / (x.size - 1)
    return paint_outline(corners, float(x[0]), float(y[0]), h, x.size, y.size, float(reach), flat)


def from_outline(points: np.ndarray | Path | str) -> Polygon:
    """Return the body inside an outline.

    Args:
        points: corners in order, shape (corner, 2) [m], or a text file of two columns x and y, split by blanks or
            commas; what follows a ``#`` and a first line of names are passed over, a repeated first point is dropped. A
            count of the rows may come first, or two counts, of those of the upper and of the lower surface, each
            from the nose on.

    Raises:
        InvalidDesign: fewer than three corners, or edges that cross.
        UnreadableFile: a file that is not there or does not hold two columns of numbers.
    """
    if not isinstance(points, Path | str):
        return Polygon(corners=points)
    path = Path(points)
    try:
        lines = [line.split("#")[0].replace(",", " ").split() for line in read_text(path).splitlines()]
    except UnreadableFile as error:
        raise UnreadableFile(f"the outline cannot be read: {error}") from error
    rows = [line for line in lines if line]
    numbers = _numbers(rows[_is_heading(rows) :], path)
    return Polygon(corners=np.array(_uncounted(numbers, path)).reshape(-1, 2))


def _numbers(rows: list[list[str]], path: Path) -> list[list[float]]:
    """Return the numbers in the rows of an outline file.

    Args:
        rows: words of each row.
        path: name of the file, for the error message.

    Raises:
        UnreadableFile: there is no row, or a word is not a number.
    """
    if not rows:
        raise UnreadableFile(f"the outline {path} is not two columns of numbers, x and y: it holds no row.")
    for row in rows:
        for word in row:
            if not _is_heading([[word]]):
                continue
            raise UnreadableFile(
                f"the outline {path} is not two columns of numbers, x and y: its row {' '.join(row)!r} holds {word!r}."
            )
    return [[float(word) for word in row] for row in rows]


def _uncounted(rows: list[list[float]], path: Path) -> list[list[float]]:
    """Return the corners of an outline, without the counts that its first row may hold.

    One count is the number of corners. Two counts are the numbers of corners on the upper and on the lower surface; the
    two surfaces are then joined to one outline.

    Args:
        rows: numbers of each row.
        path: name of the file, for the error message.

    Raises:
        UnreadableFile: a row does not hold two numbers, or the counts do not match the rows.
    """
    counts, corners = rows[0], rows[1:]
    is_count = all(count == int(count) and count > 1 for count in counts if abs(count) < 1e9) and bool(counts)
    if is_count and len(counts) in (1, 2) and sum(counts) == len(corners) and all(len(row) == 2 for row in corners):
        if len(counts) == 1:
            return corners
        # two surfaces, both from the nose on, which may be in both
        upper_count = int(counts[0])
        return corners[:upper_count][::-1] + corners[upper_count + (corners[0] == corners[upper_count]) :]
    for row in rows:
        if len(row) != 2:
            row_text = " ".join(f"{number:g}" for number in row[:6])
            hint = f"; a single number at the beginning is the count of rows after it, here {len(corners)}"
            raise UnreadableFile(
                f"the outline {path} is not two columns of numbers, x and y: it has the row {row_text!r}"
                f"{hint if row is counts and len(row) == 1 else ''}."
            )
    return rows


def _is_heading(rows: list[list[str]]) -> bool:
    """Return whether the first row holds words that are not numbers."""
    try:
        [float(word) for word in (rows or [[]])[0]]
    except ValueError:
        return True
    return False


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Implicit(PlaneSolid):
    """The body where a function is negative; see ``from_sdf``.

    Raises:
        InvalidDesign: on creation, if the function is nowhere negative in the box, or negative on its rim.
    """

    sdf: Callable[[np.ndarray, np.ndarray], np.ndarray]
    """Signed distance to the surface at points (x, y) [m], negative inside. A function with another gradient is divided
    by its gradient: it must be 0 on the surface and rise outward."""
    box: tuple[float, float, float, float]
    """A rectangle around the body: x0, x1, y0, y1 [m]."""
    _ring: np.ndarray = field(init=False, repr=False)
    _min_gradient: float | None = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_ring", _trace_outline(self.sdf, self.box))
        sizes = np.hypot(*self._rises(*self._ring.T)) / (2 * self._step)
        exact = np.quantile(np.abs(sizes - 1), _MIN_EXACT_FRACTION) < _GRADIENT_TOLERANCE
        object.__setattr__(self, "_min_gradient", None if exact else float(np.quantile(sizes, _MIN_GRADIENT_QUANTILE)))

    @property
    def _step(self) -> float:
        return 1e-6 * _size(self.box)

    def _rises(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the differences of the function over two steps along x and along y."""
        step = self._step
        return self.sdf(x + step, y) - self.sdf(x - step, y), self.sdf(x, y + step) - self.sdf(x, y - step)

    def distance(self, *points: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return signed distance [m] and outward normal (x, y) [-] at points of the body's frame [m].

        The normal is a central difference.
        """
        x, y = np.broadcast_arrays(*(np.asarray(line, float) for line in points))
        (gx, gy), value = self._rises(x, y), np.asarray(self.sdf(x, y), float)
        size = np.hypot(gx, gy)
        flat = size < 1e-3 * self._step * (self._min_gradient or 1.0)  # at the centre any direction is right
        safe = np.where(flat, 1.0, size)
        if self._min_gradient is not None:
            value = value / np.maximum(size / (2 * self._step), self._min_gradient)
        return value, np.where(flat, 1.0, gx / safe), np.where(flat, 0.0, gy / safe)

    def outline(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return ``count`` points around the body, evenly spaced [m]."""
        closed = np.concatenate([self._ring, self._ring[:1]])
        arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))])
        arc_positions = np.linspace(0, arc[-1], count, endpoint=False)
        return np.interp(arc_positions, arc, closed[:, 0]), np.interp(arc_positions, arc, closed[:, 1])

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the diameter of the largest circle inside, to a hundredth of the outline's size."""
        return np.zeros(1), np.full(1, _widest(self))


@overload
def from_sdf(function: Callable[..., np.ndarray], box: tuple[float, float, float, float]) -> Implicit: ...
@overload
def from_sdf(
    function: Callable[..., np.ndarray], box: tuple[float, float, float, float, float, float]
) -> TriangleMesh: ...
@overload
def from_sdf(function: Callable[..., np.ndarray], box: tuple[float, ...]) -> Implicit | TriangleMesh: ...
def from_sdf(function: Callable[..., np.ndarray], box: tuple[float, ...]) -> Implicit | TriangleMesh:
    """Return the body where ``function(x, y)`` is negative, in one piece without holes; in space ``function(x, y, z)``.

    In space it becomes a mesh, see ``mesh.mesh_of_sdf``.

    Args:
        function: signed distance to the surface [m], for arrays of points [m]; its size counts within three cells of
            the surface only. If its gradient there is not 1, it is divided by its gradient.
        box: a rectangle or a box around the body: x0, x1, y0, y1, and z0, z1 in space [m].

    Raises:
        InvalidDesign: the function is nowhere negative in the box, or negative on its rim, or the box has neither four
            nor six numbers.
    """
    if len(box) == 6:
        return mesh_of_sdf(function, box)
    if len(box) != 4:
        raise InvalidDesign(f"the box has {len(box)} numbers; give x0, x1, y0, y1, and z0, z1 in space.")
    x0, x1, y0, y1 = box
    return Implicit(sdf=function, box=(x0, x1, y0, y1))


def union(shape: Solid, other_shape: Solid) -> Implicit | TriangleMesh:
    """Return the body that is inside either of two, which must overlap; in space it becomes a mesh.

    Raises:
        InvalidDesign: a shape that is no ``Solid``, or one in the plane and one in space.
    """
    return _joined(shape, other_shape, np.minimum)


def difference(shape: Solid, other_shape: Solid) -> Implicit | TriangleMesh:
    """Return the body inside the first and not inside the second, which must leave it in one piece without a hole.

    In space it becomes a mesh.

    Raises:
        InvalidDesign: a shape that is no ``Solid``, or one in the plane and one in space.
    """
    return _joined(shape, other_shape, lambda a, b: np.maximum(a, -b))


def scaled(shape: Solid, factor: float) -> Implicit | TriangleMesh:
    """Return a shape enlarged about the origin of its frame; in space it becomes a mesh.

    Args:
        shape: the shape.
        factor: ratio of the new size to the old one [-].

    Raises:
        InvalidDesign: the factor is not positive, or the shape is no ``Solid``.
    """
    check_positive("factor", factor)
    _check_solids(shape)
    return from_sdf(lambda *places: factor * shape.distance(*(p / factor for p in places))[0], _box([shape], factor))


def _joined(
    shape: Solid, other_shape: Solid, combine: Callable[[np.ndarray, np.ndarray], np.ndarray]
) -> Implicit | TriangleMesh:
    _check_solids(shape, other_shape)
    return from_sdf(
        lambda *places: combine(shape.distance(*places)[0], other_shape.distance(*places)[0]),
        _box([shape, other_shape], 1.0),
    )


def _check_solids(*shapes: Solid) -> None:
    """Refuse shapes without a distance at every point, and plane ones together with ones in space.

    Raises:
        InvalidDesign: naming what there is.
    """
    kinds = [type(shape).__name__ for shape in shapes]
    if not all(isinstance(shape, Solid) for shape in shapes):
        raise InvalidDesign(
            f"the shapes to be joined or scaled are {' and '.join(kinds)}; give a Solid, which has a distance at every "
            f"point, such as an Ellipse, a Polygon, a Sphere or a Spherocylinder."
        )
    if len({shape.ndim for shape in shapes}) > 1:
        raise InvalidDesign(
            f"{' and '.join(kinds)} cannot be joined: one is plane and one is in space. Give two alike."
        )


def _box(shapes: list[Solid], factor: float) -> tuple[float, ...]:
    """Return a rectangle or a box around scaled solids in their frame with a margin: x0, x1, y0, y1, and z0, z1 [m]."""
    boxes = factor * np.array([shape.extents() for shape in shapes])
    low_corner, high_corner = boxes[:, ::2].min(axis=0), boxes[:, 1::2].max(axis=0)
    margin = 0.05 * float((high_corner - low_corner).max())
    ends = zip((low_corner - margin).tolist(), (high_corner + margin).tolist(), strict=True)
    return tuple(end for pair in ends for end in pair)


def _size(box: tuple[float, float, float, float]) -> float:
    return max(box[1] - box[0], box[3] - box[2])


def _area(corners: np.ndarray) -> float:
    x, y = corners.T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2)


def _crossing(corners: np.ndarray) -> tuple[int, int] | None:
    """Return the indices of two edges that cross or touch and are not neighbours; None if there are none.

    Args:
        corners: corners of a polygon, shape (corner, 2) [m].
    """
    a, b = corners, np.roll(corners, -1, axis=0)

    def side(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> np.ndarray:
        return np.sign((q - p)[..., 0] * (r - p)[..., 1] - (q - p)[..., 1] * (r - p)[..., 0])

    for k in range(len(corners)):
        candidates = np.arange(k + 2, len(corners) - (k == 0))
        if not candidates.size:
            continue
        p, q = a[candidates], b[candidates]
        is_on_one_side = side(a[k], b[k], p) * side(a[k], b[k], q) > 0
        has_edge_on_one_side = side(p, q, a[k]) * side(p, q, b[k]) > 0
        is_box_disjoint = (np.maximum(p, q) < np.minimum(a[k], b[k])).any(axis=1) | (
            np.minimum(p, q) > np.maximum(a[k], b[k])
        ).any(axis=1)
        hit = np.flatnonzero(~(is_on_one_side | has_edge_on_one_side | is_box_disjoint))
        if hit.size:
            return k, int(candidates[hit[0]])
    return None


def _widest(shape: PlaneSolid) -> float:
    """Return the diameter of the largest circle inside the outline of a shape [m]."""
    x, y = shape.outline(512)
    gx, gy = np.meshgrid(np.linspace(x.min(), x.max(), 101), np.linspace(y.min(), y.max(), 101))
    fields = np.empty((3, gx.size))
    measure_outline(fields, gx.ravel(), gy.ravel(), np.stack([x, y]), 0.0)
    return max(-2 * float(fields[0].min()), 0.0)


def _trace_outline(
    sdf: Callable[[np.ndarray, np.ndarray], np.ndarray], box: tuple[float, float, float, float]
) -> np.ndarray:
    """Return the outline of the region in which a function is negative, counter-clockwise, shape (point, 2) [m].

    The outline is traced point by point: each step goes at right angles to the gradient, and Newton's method then
    returns the point to the zero of the function.

    Args:
        sdf: signed distance at points (x, y) [m].
        box: rectangle around the body, x0, x1, y0, y1 [m].

    Raises:
        InvalidDesign: the function is nowhere negative in the box, or the region reaches the edge of the box.
    """
    x0, x1, y0, y1 = box
    gx, gy = np.meshgrid(np.linspace(x0, x1, 257), np.linspace(y0, y1, 257))
    values = np.asarray(sdf(gx, gy), float)
    if values.shape != gx.shape or not np.isfinite(values).all():
        raise InvalidDesign("the signed distance is not a finite number at every point of the box; mend the function.")
    if values.min() >= 0:
        raise InvalidDesign(f"the signed distance is nowhere negative in x = {x0:.4g} to {x1:.4g} m, y = {y0:.4g} to "
                            f"{y1:.4g} m; it is negative inside the body. Give a box around the body.")  # fmt: skip
    if min(values[0].min(), values[-1].min(), values[:, 0].min(), values[:, -1].min()) <= 0:
        raise InvalidDesign(f"the body reaches the rim of its box x = {x0:.4g} to {x1:.4g} m, y = {y0:.4g} to "
                            f"{y1:.4g} m; give a larger box.")  # fmt: skip
    step, eps = _size(box) / _STEPS, 1e-6 * _size(box)

    def gradient(p: np.ndarray) -> np.ndarray:
        x, y = p
        return np.stack([sdf(x + eps, y) - sdf(x - eps, y), sdf(x, y + eps) - sdf(x, y - eps)]) / (2 * eps)

    def project(p: np.ndarray, times: int) -> np.ndarray:
        for _ in range(times):
            g = gradient(p)
            p = p - sdf(*p) * g / np.maximum((g * g).sum(axis=0), 1e-12)
        return p

    deepest = np.unravel_index(int(values.argmin()), values.shape)
    row = values[deepest[0], deepest[1] :]
    start = np.array([[gx[0, deepest[1] + int(np.flatnonzero(row > 0)[0])]], [gy[deepest[0], 0]]])
    point = first_point = project(start, 8)
    points = [first_point]
    for _ in range(64 * _STEPS):
        g = gradient(point)
        point = project(point + step * np.stack([-g[1], g[0]]) / np.maximum(np.hypot(*g), 1e-12), 2)
        if len(points) > 3 and np.hypot(*(point - first_point)) < 0.75 * step:
            return _refine_ring(np.concatenate(points, axis=1), lambda p: project(p, 3)).T
        points.append(point)
    raise InvalidDesign("the outline of the signed distance does not close; its gradient should be about 1 near it.")


def _refine_ring(ring: np.ndarray, project: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Return a ring with ``_SUBDIVISIONS`` times as many points, shape (2, point) [m].

    Args:
        ring: points around the body, shape (2, point) [m].
        project: function that moves points onto the outline.
    """
    fraction = np.arange(_SUBDIVISIONS) / _SUBDIVISIONS
    next_points = np.roll(ring, -1, axis=1)
    return project((ring[:, :, None] * (1 - fraction) + next_points[:, :, None] * fraction).reshape(2, -1))
