# ruff: noqa: ARG002 - rigid and bending shapes share one interface, rigid ones ignore the time
"""Rigid shapes of any outline: polygons, and whatever a signed distance says."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import overload

import numpy as np

from suchus.core.errors import InvalidDesign, UnreadableFile
from suchus.flow.mesh import TriangleMesh, mesh_of_sdf
from suchus.flow.paint import measure_outline, paint_outline
from suchus.flow.pose import Pose
from suchus.flow.shape import Field, Solid, positive

_STEPS = 200  # steps over a body's size in which the outline of a distance is walked along
_MOST, _OFF = 0.9, 0.02  # share of an outline on which a distance has the gradient 1, but for corners, and how nearly
_FLATTEST = 0.01  # share of it whose gradient is no measure: at corners it is a mean
_BETWEEN = 8  # points that are then put in each step


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Polygon(Solid):
    """A polygon whose edges do not cross.

    Raises:
        InvalidDesign: on creation, for fewer than three corners, corners that are not finite, or crossing edges.
    """

    corners: np.ndarray
    """Corners in order around it, either way, the first not repeated, shape (corner, 2) [m]."""

    def __post_init__(self) -> None:
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

    def distance(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return signed distance and outward normal."""
        px, py = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        out = np.empty((3, px.size))
        measure_outline(out, px.ravel(), py.ravel(), self._around, self._flat)
        d, nx, ny = out.reshape(3, *px.shape)
        return d, nx, ny

    def measure(self, x: np.ndarray, y: np.ndarray, time: float, pose: Pose, reach: float) -> Field:
        """Return the field on the points of a window, as far as ``reach``."""
        h = float(x[-1] - x[0]) / (x.size - 1)
        outline = np.stack(pose.to_world(*self._around))
        d, nx, ny = paint_outline(outline, float(x[0]), float(y[0]), h, x.size, y.size, float(reach), self._flat)
        vx, vy = (np.broadcast_to(v, d.shape) for v in pose.carry(*np.meshgrid(x, y)))
        return Field(d, nx, ny, vx, vy, np.full(d.shape, np.inf))

    @property
    def _around(self) -> np.ndarray:
        return np.ascontiguousarray(self.corners.T)

    @property
    def _flat(self) -> float:
        return 1e-9 * float(np.ptp(self.corners))

    def outline(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the corners, and points between them about evenly spaced."""
        edges = np.roll(self.corners, -1, axis=0) - self.corners
        length = np.hypot(*edges.T)
        parts = np.maximum(1, np.round(count * length / length.sum())).astype(int)
        within = np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)
        share = within / np.repeat(parts, parts)
        points = np.repeat(self.corners, parts, axis=0) + share[:, None] * np.repeat(edges, parts, axis=0)
        return points[:, 0], points[:, 1]

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the diameter of the largest circle inside, to a hundredth of the outline's size."""
        return np.zeros(1), np.full(1, _widest(self))


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
        lines = [line.split("#")[0].replace(",", " ").split() for line in path.read_text(encoding="utf-8").splitlines()]
    except (OSError, UnicodeDecodeError) as error:
        raise UnreadableFile(f"the outline {path} cannot be read: {error}.") from error
    rows = [line for line in lines if line]
    numbers = _numbers(rows[_is_heading(rows) :], path)
    return Polygon(corners=np.array(_uncounted(numbers, path)).reshape(-1, 2))


def _numbers(rows: list[list[str]], path: Path) -> list[list[float]]:
    """Return the numbers of an outline's rows.

    Raises:
        UnreadableFile: there are none, or words that are no numbers.
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
    """Return the corners of an outline that may begin with how many there are, or how many above and below a chord.

    Raises:
        UnreadableFile: a row is not two numbers, or the count is another.
    """
    first, corners = rows[0], rows[1:]
    whole = all(count == int(count) and count > 1 for count in first if abs(count) < 1e9) and bool(first)
    if whole and len(first) in (1, 2) and sum(first) == len(corners) and all(len(row) == 2 for row in corners):
        above = int(first[0])
        # two surfaces, both from the nose on, which they share
        return corners if len(first) == 1 else corners[:above][::-1] + corners[above + (corners[0] == corners[above]) :]
    for row in rows:
        if len(row) != 2:
            shown = " ".join(f"{number:g}" for number in row[:6])
            counted = f"; a single number at the beginning is the count of rows after it, here {len(corners)}"
            raise UnreadableFile(
                f"the outline {path} is not two columns of numbers, x and y: it has the row {shown!r}"
                f"{counted if row is first and len(row) == 1 else ''}."
            )
    return rows


def _is_heading(rows: list[list[str]]) -> bool:
    try:
        [float(word) for word in (rows or [[]])[0]]
    except ValueError:
        return True
    return False


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Implicit(Solid):
    """The body where a function is negative; see ``from_sdf``.

    Raises:
        InvalidDesign: on creation, if the function is nowhere negative in the box, or negative on its rim.
    """

    sdf: Callable[[np.ndarray, np.ndarray], np.ndarray]
    """Signed distance to the surface at points (x, y) [m], negative inside; or, of another gradient than 1 on the
    surface, anything that is 0 there and rises outward, which is divided by its gradient."""
    box: tuple[float, float, float, float]
    """A rectangle around the body: x0, x1, y0, y1 [m]."""
    _ring: np.ndarray = field(init=False, repr=False)
    _least: float | None = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_ring", _around(self.sdf, self.box))
        sizes = np.hypot(*self._rises(*self._ring.T)) / (2 * self._step)
        exact = np.quantile(np.abs(sizes - 1), _MOST) < _OFF
        object.__setattr__(self, "_least", None if exact else float(np.quantile(sizes, _FLATTEST)))

    @property
    def _step(self) -> float:
        return 1e-6 * _size(self.box)

    def _rises(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return by how much the function rises over two steps along x and along y."""
        step = self._step
        return self.sdf(x + step, y) - self.sdf(x - step, y), self.sdf(x, y + step) - self.sdf(x, y - step)

    def distance(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return signed distance and outward normal, the normal by differences."""
        x, y = np.broadcast_arrays(np.asarray(x, float), np.asarray(y, float))
        (gx, gy), value = self._rises(x, y), np.asarray(self.sdf(x, y), float)
        size = np.hypot(gx, gy)
        flat = size < 1e-3 * self._step * (self._least or 1.0)  # in the very middle: any direction will do
        safe = np.where(flat, 1.0, size)
        if self._least is not None:
            value = value / np.maximum(size / (2 * self._step), self._least)
        return value, np.where(flat, 1.0, gx / safe), np.where(flat, 0.0, gy / safe)

    def outline(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Return points around the body, evenly spaced."""
        closed = np.concatenate([self._ring, self._ring[:1]])
        arc = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))])
        at = np.linspace(0, arc[-1], count, endpoint=False)
        return np.interp(at, arc, closed[:, 0]), np.interp(at, arc, closed[:, 1])

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the diameter of the largest circle inside, to a hundredth of the outline's size."""
        return np.zeros(1), np.full(1, _widest(self))


@overload
def from_sdf(function: Callable[..., np.ndarray], box: tuple[float, float, float, float]) -> Implicit: ...
@overload
def from_sdf(
    function: Callable[..., np.ndarray], box: tuple[float, float, float, float, float, float]
) -> TriangleMesh: ...
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


def union(one: Solid, other: Solid) -> Implicit:
    """Return the body that is inside either of two, which must overlap."""
    return _joined(one, other, np.minimum)


def difference(one: Solid, other: Solid) -> Implicit:
    """Return the body inside the first and not inside the second, which must leave it in one piece without a hole."""
    return _joined(one, other, lambda a, b: np.maximum(a, -b))


def scaled(shape: Solid, factor: float) -> Implicit:
    """Return a shape ``factor`` times as large about the origin of its frame.

    Raises:
        InvalidDesign: the factor is not positive.
    """
    positive("factor", factor)
    return from_sdf(lambda x, y: factor * shape.distance(x / factor, y / factor)[0], _box([shape], factor))


def _joined(one: Solid, other: Solid, both: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> Implicit:
    return from_sdf(lambda x, y: both(one.distance(x, y)[0], other.distance(x, y)[0]), _box([one, other], 1.0))


def _box(shapes: list[Solid], factor: float) -> tuple[float, float, float, float]:
    x, y = np.concatenate([np.stack(shape.outline(512)) for shape in shapes], axis=1) * factor
    room = 0.05 * max(float(np.ptp(x)), float(np.ptp(y)))
    return float(x.min()) - room, float(x.max()) + room, float(y.min()) - room, float(y.max()) + room


def _size(box: tuple[float, float, float, float]) -> float:
    return max(box[1] - box[0], box[3] - box[2])


def _area(corners: np.ndarray) -> float:
    x, y = corners.T
    return float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2)


def _crossing(corners: np.ndarray) -> tuple[int, int] | None:
    """Return two edges that cross or touch and are not neighbours, if there are any."""
    a, b = corners, np.roll(corners, -1, axis=0)

    def side(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> np.ndarray:
        return np.sign((q - p)[..., 0] * (r - p)[..., 1] - (q - p)[..., 1] * (r - p)[..., 0])

    for k in range(len(corners)):
        others = np.arange(k + 2, len(corners) - (k == 0))
        if not others.size:
            continue
        p, q = a[others], b[others]
        apart = side(a[k], b[k], p) * side(a[k], b[k], q) > 0
        far = side(p, q, a[k]) * side(p, q, b[k]) > 0
        beside = (np.maximum(p, q) < np.minimum(a[k], b[k])).any(axis=1) | (
            np.minimum(p, q) > np.maximum(a[k], b[k])
        ).any(axis=1)
        hit = np.flatnonzero(~(apart | far | beside))
        if hit.size:
            return k, int(others[hit[0]])
    return None


def _widest(shape: Solid) -> float:
    """Return the diameter of the largest circle inside the outline of a shape."""
    x, y = shape.outline(512)
    gx, gy = np.meshgrid(np.linspace(x.min(), x.max(), 101), np.linspace(y.min(), y.max(), 101))
    out = np.empty((3, gx.size))
    measure_outline(out, gx.ravel(), gy.ravel(), np.stack([x, y]), 0.0)
    return max(-2 * float(out[0].min()), 0.0)


def _around(sdf: Callable[[np.ndarray, np.ndarray], np.ndarray], box: tuple[float, float, float, float]) -> np.ndarray:
    """Return the outline of where a function is negative, counter-clockwise, shape (point, 2) [m].

    It is walked along: a step ahead at right angles to the gradient, then back to zero by Newton's method.

    Raises:
        InvalidDesign: there is no such place in the box, or it reaches the box's rim.
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

    def onto(p: np.ndarray, times: int) -> np.ndarray:
        for _ in range(times):
            g = gradient(p)
            p = p - sdf(*p) * g / np.maximum((g * g).sum(axis=0), 1e-12)
        return p

    inside = np.unravel_index(int(values.argmin()), values.shape)
    row = values[inside[0], inside[1] :]
    start = np.array([[gx[0, inside[1] + int(np.flatnonzero(row > 0)[0])]], [gy[inside[0], 0]]])
    here = first = onto(start, 8)
    points = [first]
    for _ in range(64 * _STEPS):
        g = gradient(here)
        here = onto(here + step * np.stack([-g[1], g[0]]) / np.maximum(np.hypot(*g), 1e-12), 2)
        if len(points) > 3 and np.hypot(*(here - first)) < 0.75 * step:
            return _finer(np.concatenate(points, axis=1), lambda p: onto(p, 3)).T
        points.append(here)
    raise InvalidDesign("the outline of the signed distance does not close; its gradient should be about 1 near it.")


def _finer(ring: np.ndarray, onto: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """Return a ring of points, shape (2, point), with ``_BETWEEN`` times as many, all put onto the outline."""
    share = np.arange(_BETWEEN) / _BETWEEN
    ahead = np.roll(ring, -1, axis=1)
    return onto((ring[:, :, None] * (1 - share) + ahead[:, :, None] * share).reshape(2, -1))
