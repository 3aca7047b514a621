# ruff: noqa: ARG002 - bodies that bend are asked as all others are, and ask their map for the time
"""Bodies that bend as a map says: any shape of the plane, any closed mesh in space.

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
from suchus.flow.mesh import TriangleMesh, mass_of_mesh, middles_of, paint_mesh, pseudo_normals
from suchus.flow.paint import paint_outline
from suchus.flow.pose import Pose, turned
from suchus.flow.shape import Field, Shape, Solid
from suchus.flow.solid import SpaceField, SpaceShape

CORNERS = 512
"""Corners that stand for the outline of a plane shape, at least [-]."""

TICK = 1e-4
"""Time over which a map is differentiated, unless it is told [s]: short for all that takes a hundredth of a second."""

SMOOTH = 1e-2
"""Change of the fastest velocity, over itself, with half that time, from which the map is too fast for it [-]."""

_STEP = 1e-5  # of the shape's size, over which a map is differentiated in space
_NEAR = 1e-9  # of the shape's size, by which a corner may miss its place
_ROUNDS = 40  # of Newton's method
_LONGEST = 0.25  # of the shape's size; how far a corner goes in one of them

Back = Callable[..., Sequence[np.ndarray]]
"""Of arrays of coordinates in the body's frame [m] and of a time [s]: the coordinates of the still shape there [m]."""


@dataclass(frozen=True, slots=True)
class BendingMap:
    """A map that bends a shape, and what follows from it."""

    back: Back
    """The map."""
    axes: int
    """Of the space, 2 or 3."""
    size: float
    """Greatest extent of the still shape [m]."""
    tick: float
    """Time over which the map is differentiated [s]."""

    def __call__(self, places: np.ndarray, time: float) -> np.ndarray:
        """Return where in the still shape places are, both of shape (axis, ...) [m].

        Raises:
            InvalidDesign: the map gives something that is no place.
        """
        found = self.back(*places, time)
        if len(found) != self.axes:
            raise InvalidDesign(f"the map that bends the body gives {len(found)} coordinates; {self.axes} are needed.")
        there: np.ndarray = np.stack([np.broadcast_to(np.asarray(row, float), places[0].shape) for row in found])
        if not np.isfinite(there).all():
            at = places[:, ~np.isfinite(there).all(axis=0)][:, 0]
            raise InvalidDesign(
                f"at t = {time:.4g} s the map that bends the body gives no finite place for "
                f"({', '.join(f'{x:.4g}' for x in at)}) m; it must, in and around the body."
            )
        return there

    def gradient(self, places: np.ndarray, time: float) -> np.ndarray:
        """Return the gradient of the map, shape (..., coordinate of the still shape, coordinate) [-]."""
        step, columns = _STEP * self.size, []
        for d in range(self.axes):
            off = np.zeros((self.axes, *(1,) * (places.ndim - 1)))
            off[d] = step
            columns.append((self(places + off, time) - self(places - off, time)) / (2 * step))
        return np.moveaxis(np.stack(columns, axis=1), (0, 1), (-2, -1))

    def velocity(self, places: np.ndarray, time: float, tick: float | None = None) -> np.ndarray:
        """Return the velocity of what is at places, shape (axis, ...) [m/s]."""
        half = 0.5 * (tick or self.tick)
        goes = (self(places, time + half) - self(places, time - half)) / (2 * half)
        rates = np.linalg.solve(self.gradient(places, time), np.moveaxis(goes, 0, -1)[..., None])[..., 0]
        return -np.moveaxis(rates, -1, 0)

    def forth(self, still: np.ndarray, time: float) -> np.ndarray:
        """Return where places of the still shape are, both of shape (axis, place) [m].

        Raises:
            InvalidDesign: the map folds the body, or it is not found where a place has gone.
        """
        places = still.copy()
        for _ in range(_ROUNDS):
            off = self(places, time) - still
            slope = self.gradient(places, time)
            turned_over = np.linalg.det(slope) <= 0
            if np.abs(off).max() < _NEAR * self.size:
                if turned_over.any():
                    raise InvalidDesign(
                        f"at t = {time:.4g} s the map folds the body or turns it inside out, at "
                        f"{_row(places[:, turned_over][:, 0])} m; bend it less."
                    )
                return places
            slope[turned_over] = np.eye(self.axes)
            step = np.linalg.solve(slope, off.T[..., None])[..., 0].T
            size = np.sqrt((step**2).sum(axis=0))
            places -= step * np.minimum(1.0, _LONGEST * self.size / np.maximum(size, 1e-300))
        worst = int(np.abs(off).max(axis=0).argmax())
        raise InvalidDesign(
            f"at t = {time:.4g} s no place was found that the map takes to {_row(still[:, worst])} m of the still "
            f"shape; it says of each place in the body's frame where that is in the still shape. Bend it less."
        )

    def check(self, places: np.ndarray, time: float) -> np.ndarray:
        """Return the velocities of places, if the map can be differentiated there.

        Raises:
            InvalidDesign: the velocity is another one over half the time.
        """
        whole, half = self.velocity(places, time), self.velocity(places, time, 0.5 * self.tick)
        fastest = float(np.abs(half).max())
        if np.abs(whole - half).max() > SMOOTH * fastest and fastest * self.tick > _NEAR * self.size:
            raise InvalidDesign(
                f"at t = {time:.4g} s the map that bends the body gives {np.abs(whole).max():.4g} m/s over a tick of "
                f"{self.tick:.3g} s and {fastest:.4g} m/s over half of it: it leaps, or is too fast for it. Give a "
                f"smooth map, or a shorter tick."
            )
        return whole


def _row(place: np.ndarray) -> str:
    return f"({', '.join(f'{x:.4g}' for x in place)})"


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BentOutline(Shape):
    """A plane shape that a map bends; see ``bent``."""

    still: Solid
    """The shape that it bends."""
    bend: BendingMap
    """The map."""
    _corners: np.ndarray = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_corners", np.stack([np.array(row, float) for row in self.still.outline(CORNERS)]))

    @property
    def rigid(self) -> bool:
        """It bends."""
        return False

    def measure(self, x: np.ndarray, y: np.ndarray, time: float, pose: Pose, reach: float) -> Field:
        """Return the field on the points of a window, as far as ``reach``."""
        h = float(x[-1] - x[0]) / (x.size - 1)
        corners = np.stack(pose.to_world(*_gone(self, time)))
        flat = 1e-9 * self.bend.size
        d, nx, ny = paint_outline(corners, float(x[0]), float(y[0]), h, x.size, y.size, float(reach), flat)
        wx, wy = np.meshgrid(x, y)
        vx, vy = (np.array(np.broadcast_to(v, d.shape)) for v in pose.carry(wx, wy))
        near = d < reach
        own = pose.turn(*self.bend.velocity(np.stack(pose.to_body(wx[near], wy[near])), time))
        vx[near] += own[0]
        vy[near] += own[1]
        return Field(d, nx, ny, vx, vy, np.full(d.shape, np.inf))

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return the middles of the outline's edges."""
        corners = _gone(self, time)
        around = float(np.hypot(*(np.roll(corners, -1, axis=1) - corners)).sum())
        still = np.stack([np.array(row, float) for row in self.still.outline(max(32, int(np.ceil(around / spacing))))])
        here = self.bend.forth(still, time)
        rates = self.bend.check(here, time)
        ahead, after = np.roll(here, -1, axis=1), np.roll(rates, -1, axis=1)
        along, more = ahead - here, after - rates
        long = np.hypot(*along)
        points = np.stack(pose.to_world(*(0.5 * (here + ahead))))
        velocities = np.stack(pose.carry(*points)) + np.stack(pose.turn(*(0.5 * (rates + after))))
        return Markers(
            points=points, share=long, velocities=velocities,
            normals=np.stack(pose.turn(*(np.stack([along[1], -along[0]]) / long))),
            spins=(pose.spin + (along[0] * more[1] - along[1] * more[0]) / long**2)[None],
            station=np.cumsum(long) - long / 2, side=np.zeros(long.size),
        )  # fmt: skip

    def bounds(self, time: float, pose: Pose) -> tuple[float, float, float, float]:
        """Return the rectangle around the corners."""
        x, y = pose.to_world(*_gone(self, time))
        return float(x.min()), float(x.max()), float(y.min()), float(y.max())

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return that of the still shape."""
        return self.still.thickness(0.0)

    def mass(self, time: float) -> Mass:
        """Return area, centre and moments of the corners' polygon, and the momentum of what bends in it."""
        corners = _gone(self, time)
        whole = of_outline(*corners)
        centre = np.array(whole.centre)[:, None]
        ahead = np.roll(corners, -1, axis=1)
        first, second = corners - centre, ahead - centre
        share = (first[0] * second[1] - first[1] * second[0]) / 6  # a third of each triangle from the centre
        at = np.concatenate([0.5 * (corners + centre), 0.5 * (ahead + centre), 0.5 * (corners + ahead)], axis=1)
        weights, rates = np.tile(share, 3), self.bend.velocity(at, time)
        rate = (rates * weights).sum(axis=1) / whole.area
        (dx, dy), (u, v) = at - centre, rates - rate[:, None]
        return Mass(
            area=whole.area, centre=whole.centre, centre_rate=(float(rate[0]), float(rate[1])), moment=whole.moment,
            swirl=float(((dx * v - dy * u) * weights).sum()),
        )  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class BentMesh(SpaceShape):
    """A closed mesh that a map bends; see ``bent``."""

    still: TriangleMesh
    """The mesh that it bends."""
    bend: BendingMap
    """The map."""

    even = (False, False, False)

    @property
    def rigid(self) -> bool:
        """It bends."""
        return False

    def _now(self, time: float) -> np.ndarray:
        """Return the corners in the body's frame, shape (3, vertex) [m]."""
        return _gone(self, time)

    def measure(self, x: np.ndarray, y: np.ndarray, z: np.ndarray, time: float, pose: Pose, reach: float) -> SpaceField:
        """Return the field on the points of a window, as far as ``reach``."""
        place, faces = pose.along(3), self.still.faces
        px, py, pz = (np.ascontiguousarray(line, float) for line in (x, y, z))
        out = np.zeros((4, z.size, y.size, x.size))
        h = float(x[1] - x[0]) if x.size > 1 else float(reach)
        corners = np.stack(place.place(self._now(time)), axis=1)
        normals = np.ascontiguousarray(pseudo_normals(corners, faces))
        paint_mesh(out, px, py, pz, np.ascontiguousarray(corners[faces]), normals, float(reach), h)
        wz, wy, wx = np.meshgrid(pz, py, px, indexing="ij")
        rates = [np.array(np.broadcast_to(rate, out[0].shape)) for rate in place.rates((wx, wy, wz))]
        near = out[0] < reach
        own = self._velocity(np.stack([wx[near], wy[near], wz[near]]), time, place)
        for rate, part in zip(rates, own, strict=True):
            rate[near] += part
        u, v, w = rates
        return SpaceField(out[0], (out[1], out[2], out[3]), (u, v, w), np.full(out[0].shape, np.inf))

    def _velocity(self, points: np.ndarray, time: float, place: Pose) -> np.ndarray:
        """Return what bending adds to the velocity at points of the world, shape (3, point) [m/s]."""
        body = place.matrix.T @ (points - np.array(place.position)[:, None])
        return np.stack(turned(place.matrix, self.bend.velocity(body, time)))

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return the middles of the triangles, of large ones those of equal parts."""
        place, now = pose.along(3), self._now(time)
        self.bend.check(now, time)
        at, share, normals = middles_of(np.stack(place.place(now), axis=1)[self.still.faces], spacing)
        velocities = np.stack(place.rates(at)) + self._velocity(at, time, place)
        spins = np.broadcast_to(place.spins[:, None], at.shape)
        return Markers(points=at, share=share, velocities=velocities, normals=normals, spins=spins)

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the box around the corners."""
        at = np.stack(pose.along(3).place(self._now(time)))
        return tuple(np.stack([at.min(axis=1), at.max(axis=1)], axis=1).ravel().tolist())

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return that of the still mesh."""
        return self.still.thickness(0.0)

    @property
    def blunt(self) -> bool:
        """Whether the still mesh is about as long along each axis."""
        return self.still.blunt

    def volume(self, time: float) -> float:
        """Return the volume."""
        return self.mass(time).volume

    def mass(self, time: float) -> SpaceMass:
        """Return volume, centre and moments of the bent mesh, and the momentum of what bends in it."""
        faces = self._now(time).T[self.still.faces]
        whole = mass_of_mesh(faces)
        centre = np.array(whole.centre)[:, None]
        corners = faces.transpose(1, 2, 0) - centre  # of tetrahedra from the centre
        share = np.einsum("df,df->f", corners[0], np.cross(corners[1], corners[2], axis=0)) / 24
        far, near = _TETRAHEDRON
        total = corners.sum(axis=0)
        at = np.concatenate([near * total, *(near * total + (far - near) * one for one in corners)], axis=1)
        weights, rates = np.tile(share, 4), self.bend.velocity(at + centre, time)
        rate = (rates * weights).sum(axis=1) / whole.volume
        swirl = (np.cross(at, rates - rate[:, None], axis=0) * weights).sum(axis=1)
        u, v, w = rate.tolist()
        a, b, c = swirl.tolist()
        return SpaceMass(
            volume=whole.volume, centre=whole.centre, centre_rate=(u, v, w), moments=whole.moments, swirl=(a, b, c)
        )


@lru_cache(maxsize=16)
def _gone(shape: BentOutline | BentMesh, time: float) -> np.ndarray:
    """Return where the corners of a shape are, in the body's frame, shape (axis, corner) [m]; asked again and again."""
    still = shape._corners if isinstance(shape, BentOutline) else shape.still.vertices.T
    gone = shape.bend.forth(still, time)
    gone.flags.writeable = False
    return gone


_TETRAHEDRON = (5 + 3 * 5**0.5) / 20, (5 - 5**0.5) / 20
"""Weights of the corners in the four points by which second-order functions on a tetrahedron are summed exactly [-]."""


@overload
def bent(shape: Solid, back: Back, *, tick: float = TICK) -> BentOutline: ...
@overload
def bent(shape: TriangleMesh, back: Back, *, tick: float = TICK) -> BentMesh: ...
def bent(shape: Any, back: Back, *, tick: float = TICK) -> BentOutline | BentMesh:
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
        mesh = BentMesh(still=shape, bend=BendingMap(back, 3, size, tick))
        mesh.bounds(0.0, Pose())
        return mesh
    if not isinstance(shape, Solid):
        raise InvalidDesign(
            f"a {type(shape).__name__} cannot be bent by a map; give a plane Solid, such as from_outline or an "
            f"Ellipse, or a closed mesh."
        )
    size = float(np.ptp(np.stack(shape.outline(CORNERS)), axis=1).max())
    outline = BentOutline(still=shape, bend=BendingMap(back, 2, size, tick))
    outline.bounds(0.0, Pose())
    return outline
