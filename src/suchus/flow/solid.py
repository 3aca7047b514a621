# ruff: noqa: ARG002 - rigid and bending shapes share one interface, rigid ones ignore the time
"""Shapes of bodies in space: a signed distance, a normal and a velocity at points, and markers over the skin.

Distances are negative inside; normals point into the water. See ``shape`` for shapes in the plane.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from suchus.flow.ellipsoid import paint_ellipsoid
from suchus.flow.markers import Markers
from suchus.flow.mass import SpaceMass, tensor
from suchus.flow.pose import Pose, rotate_vectors
from suchus.flow.shape import check_positive

_MIN_RINGS = 16
"""Fewest rings of markers on a skin [-]."""

_RIM = 96
"""Corners of the midsurface ellipse of a thin ellipsoid [-]."""

_MAX_BLUNT_RATIO = 2.0
"""Ratio of the longest to the shortest axis up to which the error of a body's drag is that of a sphere [-]."""

_ROUND = 1e-3
"""Length of the midsurface ellipse, over the smallest half-axis, below which the ellipsoid counts as round there
[-]."""


MIN_INSIDE_DEPTH = 1e-9
"""Depth, over a shape's size, from which a point of its skin counts as inside another shape [-]."""


@dataclass(slots=True)
class SpaceField:
    """Distance, normal and velocity of a body at the points of a window in space, arrays of shape (z, y, x)."""

    distance: np.ndarray
    """Signed distance to the surface, negative inside [m]."""
    normal: tuple[np.ndarray, ...]
    """Outward normal, along each axis [-]."""
    velocity: tuple[np.ndarray, ...]
    """Velocity of the body along each axis, extended smoothly a few cells into the water [m/s]."""
    thickness: np.ndarray
    """Thickness of the body behind the nearest point of its surface, infinite where it is thick [m]."""
    part_index: np.ndarray | None = None
    """Index of the body's part to which a point belongs; None for a body of one part [-]."""


class SpaceShape(ABC):
    """A body's shape in space in its own frame; it may change with time."""

    ndim: ClassVar[int] = 3
    mirror_symmetry: ClassVar[tuple[bool, bool, bool]] = (True, True, True)
    """Whether the planes through the origin across x, y and z are planes of symmetry."""

    jointed: ClassVar[bool] = False
    """Whether its parts are rigid and connected by joints."""

    @abstractmethod
    def measure(self, x: np.ndarray, y: np.ndarray, z: np.ndarray, time: float, pose: Pose, reach: float) -> SpaceField:
        """Return the field on the points of a window, axes ``x`` (nx,), ``y`` (ny,) and ``z`` (nz,) [m].

        Only distances below ``reach`` [m] need be exact.
        """

    @abstractmethod
    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
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
        """Return volume, centre and moments of inertia of a body of density 1."""

    @property
    def parts(self) -> int:
        """Parts that the record tells of one by one [-]."""
        return 1

    def midsurface(self, time: float, pose: Pose) -> np.ndarray | None:
        """Return the surface in the middle of a thin body, through which no water passes, as triangles.

        The shape is (corner, axis, triangle) [m]. The surface is None for a body that is never thin.

        Args:
            time: time [s].
            pose: pose of the body's frame.
        """
        return None

    @property
    def rigid(self) -> bool:
        """Whether the shape never changes."""
        return True

    @property
    def is_compact(self) -> bool:
        """Whether it is about as long along each axis, for ``resolution``."""
        return False


def is_blunt(axes: np.ndarray) -> bool:
    """Return whether the longest of a body's axes is at most ``_MAX_BLUNT_RATIO`` times the shortest.

    Args:
        axes: lengths or half-axes, shape (3,) [m].
    """
    return float(axes.max()) <= _MAX_BLUNT_RATIO * float(axes.min())


@dataclass(frozen=True, slots=True, kw_only=True)
class Ellipsoid(SpaceShape):
    """An ellipsoid with its axes along the body's axes."""

    length: float
    """Full axis along the body's x [m]."""
    width: float
    """Full axis along the body's y [m]."""
    height: float
    """Full axis along the body's z [m]."""

    def __post_init__(self) -> None:
        for name in ("length", "width", "height"):
            check_positive(name, getattr(self, name))

    @property
    def half_extents(self) -> np.ndarray:
        """Half-axes, shape (3,) [m]."""
        return 0.5 * np.array([self.length, self.width, self.height])

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Return which points of the body's frame lie inside, for points of shape (3, ...) [m]."""
        x, y, z = (coordinate / half for coordinate, half in zip(points, self.half_extents, strict=True))
        return np.asarray(x * x + y * y + z * z < 1 - MIN_INSIDE_DEPTH)

    def measure(self, x: np.ndarray, y: np.ndarray, z: np.ndarray, time: float, pose: Pose, reach: float) -> SpaceField:
        """Return distance, normal and velocity on the points of a window; see ``SpaceShape``."""
        pose_3d = pose.in_dimensions(3)
        fields = np.zeros((8, z.size, y.size, x.size))
        fields[7] = np.inf
        cell = float(x[1] - x[0]) if x.size > 1 else float(reach)
        px, py, pz = (np.ascontiguousarray(line, float) for line in (x, y, z))
        paint_ellipsoid(
            fields, px, py, pz, np.ascontiguousarray(pose_3d.matrix), np.array(pose_3d.position),
            np.array(pose_3d.velocity), pose_3d.spins, self.half_extents, float(reach), cell,
        )  # fmt: skip
        return SpaceField(fields[0], (fields[1], fields[2], fields[3]), (fields[4], fields[5], fields[6]), fields[7])

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return points on rings about the body's z axis; each represents the same area of a unit sphere."""
        pose_3d, rings = (
            pose.in_dimensions(3),
            max(_MIN_RINGS, int(np.ceil(np.pi * float(self.half_extents.max()) / spacing))),
        )
        cos = (np.arange(rings) + 0.5) * 2 / rings - 1
        turn = (np.arange(2 * rings) + 0.5) * np.pi / rings
        sin = np.sqrt(1 - cos * cos)[:, None]
        unit = np.stack([sin * np.cos(turn), sin * np.sin(turn), np.broadcast_to(cos[:, None], (rings, turn.size))])
        unit = unit.reshape(3, -1)
        a = self.half_extents[:, None]
        areas = float(np.prod(self.half_extents)) * np.sqrt(((unit / a) ** 2).sum(axis=0)) * (4 * np.pi / unit.shape[1])
        points = np.stack(pose_3d.to_world_3d(a * unit))
        normals = np.stack(rotate_vectors(pose_3d.matrix, unit / a / np.sqrt(((unit / a) ** 2).sum(axis=0))))
        spins = np.broadcast_to(pose_3d.spins[:, None], points.shape)
        return Markers(
            points=points, weight=areas, velocities=np.stack(pose_3d.velocity_at(points)), normals=normals, spins=spins
        )

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the box around the ellipsoid."""
        pose_3d = pose.in_dimensions(3)
        reach = np.sqrt(((pose_3d.matrix * self.half_extents) ** 2).sum(axis=1)).tolist()
        return tuple(p + sign * r for p, r in zip(pose_3d.position, reach, strict=True) for sign in (-1.0, 1.0))

    def midsurface(self, time: float, pose: Pose) -> np.ndarray | None:
        """Return an ellipse across the smallest axis, in triangles; None if that axis is not the only small one.

        It is smaller than the ellipsoid's own cross-section and vanishes where the ellipsoid is round. See
        ``SpaceShape``.
        """
        thin_axis, *long_axes = np.argsort(self.half_extents)
        excess = self.half_extents**2 - self.half_extents[thin_axis] ** 2
        rim_half_axes = self.half_extents * excess / (self.half_extents**2 + self.half_extents[thin_axis] ** 2)
        if rim_half_axes[long_axes].min() <= _ROUND * self.half_extents[thin_axis]:
            return None
        turn = np.linspace(0.0, 2 * np.pi, _RIM + 1)
        rim = np.zeros((3, turn.size))
        rim[long_axes] = rim_half_axes[long_axes, None] * np.stack([np.cos(turn), np.sin(turn)])
        rim, centre = np.array(pose.in_dimensions(3).to_world_3d(rim)), np.array(pose.in_dimensions(3).position)
        return np.stack([np.broadcast_to(centre[:, None], (3, _RIM)), rim[:, :-1], rim[:, 1:]])

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the smallest axis."""
        return np.zeros(1), np.full(1, 2 * float(self.half_extents.min()))

    @property
    def is_compact(self) -> bool:
        """Whether no axis is more than ``_MAX_BLUNT_RATIO`` times another."""
        return is_blunt(self.half_extents)

    def volume(self, time: float) -> float:
        """Return the volume."""
        return 4 / 3 * np.pi * float(np.prod(self.half_extents))

    def mass(self, time: float) -> SpaceMass:
        """Return volume and moments; the centre is the origin."""
        volume, zero = self.volume(time), (0.0, 0.0, 0.0)
        moments = tensor(np.diag(volume * self.half_extents**2 / 5))
        return SpaceMass(volume=volume, centre=zero, centre_rate=zero, moments=moments, swirl=zero)


class Sphere(Ellipsoid):
    """A sphere."""

    __slots__ = ()

    def __init__(self, *, diameter: float) -> None:
        check_positive("diameter", diameter)
        super().__init__(length=diameter, width=diameter, height=diameter)
