# ruff: noqa: ARG002 - rigid and bending shapes share one interface, rigid ones ignore the time
"""Shapes of bodies in space: a signed distance, a normal and a velocity at points, and points spread over the skin.

Distances are negative inside; normals point into the water. What a plane shape says, ``shape`` has.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from suchus.flow.compiled import compiled
from suchus.flow.mass import SpaceMass
from suchus.flow.pose import Pose
from suchus.flow.shape import positive

_STEPS = 12
"""Newton steps to the foot point on an ellipsoid at most [-]: with 8 the distance is right to rounding on a 20:1."""

_STILL = 1e-12
"""Change of the foot point's parameter, over the square of the smallest half-axis, at which they end [-]."""

_TINY = 1e-9
"""Distance from a plane of symmetry, over the half-axis, below which a point counts as so far off it [-]."""

_FEWEST = 16
"""Rings of points on a skin, at least [-]."""


@compiled
def _measure_ellipsoid(points, a, distance, normal):  # type: ignore[no-untyped-def]
    """Write signed distances from an ellipsoid with half-axes ``a`` (3,), and normals, at points, shape (3, point).

    The foot point f of a point p has ``f_i = a_i^2 p_i / (t + a_i^2)``, where t makes it lie on the surface. Newton's
    method on ``1 / |s(t)|`` with ``s_i = a_i p_i / (t + a_i^2)``, which is nearly straight, rises to that t from every
    start below it and above minus the smallest ``a_i^2``.
    """
    p, least = np.empty(3), min(a[0], a[1], a[2]) ** 2
    for k in range(points.shape[1]):
        t = -np.inf
        for d in range(3):
            p[d] = max(abs(points[d, k]), _TINY * a[d])
            t = max(t, a[d] * p[d] - a[d] * a[d])  # one term of |s| is 1 here: at or below the root
        for _ in range(_STEPS):
            square, slope = 0.0, 0.0
            for d in range(3):
                below = 1.0 / (t + a[d] * a[d])
                s = a[d] * p[d] * below
                square += s * s
                slope += s * s * below
            change = (np.sqrt(square) - 1.0) * square / slope
            t += change
            if abs(change) <= _STILL * least:
                break
        size, off = 0.0, 0.0
        for d in range(3):
            normal[d, k] = p[d] / (t + a[d] * a[d])
            size += normal[d, k] * normal[d, k]
        size = np.sqrt(size)
        for d in range(3):
            foot = a[d] * a[d] * normal[d, k]
            normal[d, k] /= size
            off += (p[d] - foot) * normal[d, k]
            normal[d, k] = np.copysign(normal[d, k], points[d, k])
        distance[k] = off


@dataclass(slots=True)
class SpaceField:
    """What a body says about the points of a window in space, arrays of shape (z, y, x)."""

    distance: np.ndarray
    """Signed distance to the surface, negative inside [m]."""
    normal: tuple[np.ndarray, ...]
    """Outward normal, along each axis [-]."""
    velocity: tuple[np.ndarray, ...]
    """Velocity of the body, carried on smoothly a few cells into the water, along each axis [m/s]."""
    thickness: np.ndarray
    """Thickness of the body behind the nearest point of its surface, infinite where it is thick [m]."""
    part: np.ndarray | None = None
    """Which of the body's parts a point belongs to, counted from 0; None for a body of one part [-]."""


@dataclass(slots=True)
class Skin:
    """Points spread over the surface of a body in space."""

    points: np.ndarray
    """Where, shape (3, point) [m]."""
    share: np.ndarray
    """Area that each point stands for, shape (point,) [m^2]."""
    velocities: np.ndarray
    """Velocity of the surface, shape (3, point) [m/s]."""
    part: np.ndarray | None = None
    """Which of the body's parts a point belongs to, counted from 0, shape (point,); None for a body of one part [-]."""


class SpaceShape(ABC):
    """A body's shape in space in its own frame; it may change with time."""

    axes: ClassVar[int] = 3
    even: ClassVar[tuple[bool, bool, bool]] = (True, True, True)
    """Whether the planes through the origin across x, y and z cut it into halves that are images of each other."""

    @abstractmethod
    def measure(self, x: np.ndarray, y: np.ndarray, z: np.ndarray, time: float, pose: Pose, reach: float) -> SpaceField:
        """Return the field on the points of a window, axes ``x`` (nx,), ``y`` (ny,) and ``z`` (nz,) [m].

        Only distances below ``reach`` [m] need be exact.
        """

    @abstractmethod
    def markers(self, time: float, pose: Pose, spacing: float) -> Skin:
        """Return points over the skin, about ``spacing`` [m] apart."""

    @abstractmethod
    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the smallest box around the body: x0, x1, y0, y1, z0, z1 [m]."""

    @abstractmethod
    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return stations along the body and its thickness there, two arrays of one shape [m]."""

    @abstractmethod
    def volume(self, time: float) -> float:
        """Return the volume [m^3]."""

    @abstractmethod
    def mass(self, time: float) -> SpaceMass:
        """Return what a body of density 1 weighs, for motions in the plane z = 0."""

    @property
    def parts(self) -> int:
        """Parts that the record tells of one by one [-]."""
        return 1

    def centreline(self, time: float, pose: Pose) -> np.ndarray | None:
        """Return None: no body in three dimensions is taken for thin."""
        return None

    @property
    def rigid(self) -> bool:
        """Whether the shape never changes."""
        return True


@dataclass(frozen=True, slots=True, kw_only=True)
class Ellipsoid(SpaceShape):
    """An ellipsoid with its axes along the body's axes; it may turn about z."""

    length: float
    """Full axis along the body's x [m]."""
    width: float
    """Full axis along the body's y [m]."""
    height: float
    """Full axis along the body's z [m]."""

    def __post_init__(self) -> None:
        for name in ("length", "width", "height"):
            positive(name, getattr(self, name))

    @property
    def half(self) -> np.ndarray:
        """Half-axes, shape (3,) [m]."""
        return 0.5 * np.array([self.length, self.width, self.height])

    def distance(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return signed distance and outward normal at points (3, ...) of the body's frame [m]."""
        flat = np.ascontiguousarray(points.reshape(3, -1), dtype=np.float64)
        distance, normal = np.empty(flat.shape[1]), np.empty(flat.shape)
        _measure_ellipsoid(flat, self.half, distance, normal)
        return distance.reshape(points.shape[1:]), normal.reshape(points.shape)

    def measure(self, x: np.ndarray, y: np.ndarray, z: np.ndarray, time: float, pose: Pose, reach: float) -> SpaceField:
        """Return the field on the points of a window."""
        place = pose.along(3)
        wz, wy, wx = np.meshgrid(z, y, x, indexing="ij")
        distance, normal = self.distance(np.stack([*place.to_body(wx, wy), wz - place.position[2]]))
        velocity = (*place.carry(wx, wy), np.full(wx.shape, place.velocity[2]))
        return SpaceField(distance, (*place.turn(normal[0], normal[1]), normal[2]), velocity, np.full(wx.shape, np.inf))

    def markers(self, time: float, pose: Pose, spacing: float) -> Skin:
        """Return points on rings about the body's z axis, each of which stands for the same part of a unit sphere."""
        place, rings = pose.along(3), max(_FEWEST, int(np.ceil(np.pi * float(self.half.max()) / spacing)))
        cos = (np.arange(rings) + 0.5) * 2 / rings - 1
        turn = (np.arange(2 * rings) + 0.5) * np.pi / rings
        sin = np.sqrt(1 - cos * cos)[:, None]
        unit = np.stack([sin * np.cos(turn), sin * np.sin(turn), np.broadcast_to(cos[:, None], (rings, turn.size))])
        unit = unit.reshape(3, -1)
        a = self.half[:, None]
        share = float(np.prod(self.half)) * np.sqrt(((unit / a) ** 2).sum(axis=0)) * (4 * np.pi / unit.shape[1])
        x, y, z = a * unit
        wx, wy = place.to_world(x, y)
        velocities = np.stack([*place.carry(wx, wy), np.full(wx.shape, place.velocity[2])])
        return Skin(np.stack([wx, wy, z + place.position[2]]), share, velocities)

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the box around the ellipsoid."""
        place, (a, b, c) = pose.along(3), self.half.tolist()
        cos, sin = np.cos(pose.angle), np.sin(pose.angle)
        reach = float(np.hypot(a * cos, b * sin)), float(np.hypot(a * sin, b * cos)), c
        return tuple(p + way * r for p, r in zip(place.position, reach, strict=True) for way in (-1.0, 1.0))

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the smallest axis."""
        return np.zeros(1), np.full(1, 2 * float(self.half.min()))

    def volume(self, time: float) -> float:
        """Return the volume."""
        return 4 / 3 * np.pi * float(np.prod(self.half))

    def mass(self, time: float) -> SpaceMass:
        """Return volume and moment; the centre is the origin."""
        volume, (a, b, _) = self.volume(time), self.half.tolist()
        moment = volume * (a * a + b * b) / 5
        return SpaceMass(volume=volume, centre=(0.0, 0.0), centre_rate=(0.0, 0.0), moment=moment, swirl=0.0)


class Sphere(Ellipsoid):
    """A sphere."""

    __slots__ = ()

    def __init__(self, *, diameter: float) -> None:
        positive("diameter", diameter)
        super().__init__(length=diameter, width=diameter, height=diameter)
