# ruff: noqa: ARG002 - rigid and bending shapes share one interface, rigid ones ignore the time
"""A body of rigid pieces, each with its own pose: limbs that paddle, an axis that leaves its plane."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import ClassVar, NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.core import rotation
from suchus.core.errors import InvalidDesign
from suchus.flow.limbed import around_rod
from suchus.flow.markers import Markers
from suchus.flow.mass import Mass, tensor
from suchus.flow.pose import Pose
from suchus.flow.shape import Axes, Field, Shape, box_slices, check_positive, write_nearer
from suchus.flow.solid import MIN_INSIDE_DEPTH, Ellipsoid, Solid, SurfacePoints, box_around, is_blunt

_MIN_POINTS_ACROSS = 16
"""Points across a piece, at least, over which its volume is summed [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Spherocylinder(Solid):
    """A rod with round ends along the body's x, its middle at the origin; a ball if it has no length."""

    ndim: ClassVar[int] = 3

    length: float
    """Length between the middles of its round ends [m]."""
    radius: float
    """Radius [m]."""

    def __post_init__(self) -> None:
        check_positive("radius", self.radius)
        if self.length != 0.0:
            check_positive("length", self.length)

    @property
    def half_extents(self) -> Float[np.ndarray, "3"]:
        """Half of the box around it [m]."""
        return np.array([0.5 * self.length + self.radius, self.radius, self.radius])

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Return which points of its own frame lie inside, shape (3, ...) [m]."""
        x, y, z = points
        axial_excess = np.maximum(np.abs(x) - 0.5 * self.length, 0.0)
        return np.asarray(axial_excess * axial_excess + y * y + z * z < (1 - MIN_INSIDE_DEPTH) * self.radius**2)

    def distance(self, *points: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return signed distance [m] and outward normal [-] at points of its own frame."""
        x, y, z = points
        dx = x - np.clip(x, -0.5 * self.length, 0.5 * self.length)
        size = np.sqrt(dx * dx + y * y + z * z)
        safe = np.maximum(size, 1e-12 * self.radius)
        return size - self.radius, dx / safe, y / safe, z / safe

    def skin(self, spacing: float) -> SurfacePoints:
        """Return points on rings along it and over its round ends."""
        points, normals, areas = around_rod(self.length, self.radius, spacing)
        return SurfacePoints(points - np.array([[0.5 * self.length], [0.0], [0.0]]), normals, areas)

    def extents(self) -> tuple[float, ...]:
        """Return the box around it in its own frame."""
        return box_around(np.stack([-self.half_extents, self.half_extents], axis=1))

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the box around it."""
        frame = pose.in_dimensions(3)
        reach = (0.5 * self.length * np.abs(frame.matrix[:, 0]) + self.radius).tolist()
        return tuple(p + direction * r for p, r in zip(frame.position, reach, strict=True) for direction in (-1.0, 1.0))

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the diameter."""
        return np.zeros(1), np.full(1, 2 * self.radius)

    @property
    def is_compact(self) -> bool:
        """Whether it is about as long as thick."""
        return is_blunt(self.half_extents)

    def mass(self, time: float) -> Mass:
        """Return volume and moments; the centre is the origin."""
        r, length, zero = self.radius, self.length, (0.0, 0.0, 0.0)
        rod, ball = np.pi * r * r * length, 4 / 3 * np.pi * r**3
        axial_moment = rod * length**2 / 12 + ball * (r * r / 5 + length**2 / 4 + 3 * length * r / 8)
        transverse_moment = rod * r * r / 4 + ball * r * r / 5
        volume = np.pi * r**2 * (length + 4 / 3 * r)
        return Mass(
            volume=volume, centre=zero, centre_rate=zero,
            moments=tensor(np.diag([axial_moment, transverse_moment, transverse_moment])), swirl=zero,
        )  # fmt: skip


class LinkStates(NamedTuple):
    """Where the links of a body are and how they move."""

    position: Float[np.ndarray, "link 3"]
    """Origins of their frames [m]."""
    matrix: Float[np.ndarray, "link 3 3"]
    """Rotation matrices: their columns are the links' axes [-]."""
    velocity: Float[np.ndarray, "link 3"]
    """Velocities of the origins [m/s]."""
    spin: Float[np.ndarray, "link 3"]
    """Angular velocities about the axes that the positions are along [rad/s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LinkPiece:
    """A rigid shape that a link carries."""

    link: int
    """Which link, counted from 0 [-]."""
    shape: Spherocylinder | Ellipsoid
    """The shape in its own frame."""
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Origin of that frame in the link's [m]."""
    quaternion: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    """Quaternion that turns that frame into the link's, scalar first [-]."""


@dataclass(frozen=True, kw_only=True)
class Linked(Shape):
    """The union of rigid pieces on links, each of which has its own position, attitude, velocity and spin.

    Each link is a part of its own in ``Simulation.last_loads``. Links that turn against each other at a joint should
    overlap there, as the round ends of rods do: to the water they are one body.

    Raises:
        InvalidDesign: on creation, without pieces, or where the links that they name are not those of ``motion``.
    """

    ndim: ClassVar[int] = 3
    mirror_symmetry: ClassVar[tuple[bool, ...]] = (False, False, False)
    jointed: ClassVar[bool] = True

    pieces: tuple[LinkPiece, ...]
    """The pieces; each link has at least one."""
    motion: Callable[[float], LinkStates]
    """The links at every time, in the frame of the body [s]."""

    def __post_init__(self) -> None:
        """Refuse pieces whose links are not those of the motion."""
        links = sorted({piece.link for piece in self.pieces})
        count = len(self.motion(0.0).position)
        if links != list(range(count)) or not count:
            raise InvalidDesign(
                f"the pieces of a linked body are on the links {links}, and its motion tells of {count}; give each of "
                "them, counted from 0, at least one piece."
            )

    @property
    def rigid(self) -> bool:
        """Whether the shape never changes."""
        return False

    @property
    def parts(self) -> int:
        """The links [-]."""
        return 1 + max(piece.link for piece in self.pieces)

    def poses(self, time: float, pose: Pose) -> list[Pose]:
        """Return the pose of each piece in the world."""
        frame, links = pose.in_dimensions(3), self.motion(time)
        return [_piece_pose(piece, links, frame) for piece in self.pieces]

    def measure(self, points: Axes, time: float, pose: Pose, reach: float) -> Field:
        """Return the field on the points of a window, that of the nearest piece at each."""
        size = tuple(line.size for line in reversed(points))
        window_field = Field(
            np.full(size, reach), tuple(np.zeros((3, *size))), tuple(np.zeros((3, *size))), np.full(size, np.inf),
            np.zeros(size, np.int8),
        )  # fmt: skip
        for piece, piece_pose in zip(self.pieces, self.poses(time, pose), strict=True):
            box = box_slices(points, *_corners(piece.shape.bounds(time, piece_pose)), reach)
            if any(extent.start == extent.stop for extent in box):
                continue
            window = tuple(line[extent] for line, extent in zip(points, reversed(box), strict=True))
            write_nearer(window_field, box, piece.shape.measure(window, time, piece_pose, reach), piece.link)
        return window_field

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return points over all pieces; points inside another piece have no area."""
        piece_poses, skins = self.poses(time, pose), []
        for k, (piece, piece_pose) in enumerate(zip(self.pieces, piece_poses, strict=True)):
            skin = piece.shape.markers(time, piece_pose, spacing)
            areas = np.where(self._is_covered(skin.points, piece_poses, k, time), 0.0, skin.weight)
            skins.append(replace(skin, weight=areas, part_index=np.full(areas.shape, piece.link)))
        array_names = ("points", "velocities", "normals", "spins")
        return Markers(
            **{name: np.concatenate([getattr(skin, name) for skin in skins], axis=1) for name in array_names},
            weight=np.concatenate([skin.weight for skin in skins]),
            part_index=np.concatenate([skin.part_index for skin in skins if skin.part_index is not None]),
        )

    def _is_covered(
        self,
        points: np.ndarray,
        piece_poses: Sequence[Pose],
        piece_index: int,
        time: float,
        *,
        earlier_only: bool = False,
    ) -> np.ndarray:
        """Return which points on one piece lie inside another piece.

        Args:
            points: points in the world, shape (3, point) [m].
            piece_poses: pose of each piece.
            piece_index: the piece that the points are on.
            time: time [s].
            earlier_only: whether only the pieces before it count.
        """
        is_inside = np.zeros(points.shape[1], bool)
        lower_bound, upper_bound = points.min(axis=1), points.max(axis=1)
        for k, (piece, piece_pose) in enumerate(zip(self.pieces, piece_poses, strict=True)):
            a, b = _corners(piece.shape.bounds(time, piece_pose))
            if (
                k == piece_index
                or (earlier_only and k > piece_index)
                or (lower_bound > b).any()
                or (upper_bound < a).any()
            ):
                continue
            is_inside |= piece.shape.contains(np.array(piece_pose.to_body(points)))
        return is_inside

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the box around all pieces."""
        poses = self.poses(time, pose)
        boxes = [np.reshape(piece.shape.bounds(time, p), (3, 2)) for piece, p in zip(self.pieces, poses, strict=True)]
        return box_around(np.concatenate(boxes, axis=1))

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the pieces' lengths one after the other, and the thickness of each."""
        lengths = np.array([2 * float(piece.shape.half_extents.max()) for piece in self.pieces])
        thicknesses = np.array([float(piece.shape.thickness(time)[1][0]) for piece in self.pieces])
        ends = np.concatenate([[0.0], lengths.cumsum()])
        return np.column_stack([ends[:-1], ends[1:]]).ravel(), np.repeat(thicknesses, 2)

    def mass(self, time: float) -> Mass:
        """Return volume, centre and moments of the union and the momentum of its deformation.

        They are sums over points inside the pieces.
        """
        piece_poses, points, rates, volumes = self.poses(time, Pose()), [], [], []
        for k, (piece, piece_pose) in enumerate(zip(self.pieces, piece_poses, strict=True)):
            inner, point_volume = _volume_samples(piece.shape)
            world = np.array(piece_pose.to_world(inner))
            is_outside = ~self._is_covered(world, piece_poses, k, time, earlier_only=True)
            points.append(world[:, is_outside])
            rates.append(np.array(piece_pose.velocity_at(world))[:, is_outside])
            volumes.append(np.full(int(is_outside.sum()), point_volume))
        positions = np.concatenate(points, axis=1)
        velocities = np.concatenate(rates, axis=1)
        v = np.concatenate(volumes)
        centre, drift = positions @ v / v.sum(), velocities @ v / v.sum()
        arms, relative_velocities = positions - centre[:, None], velocities - drift[:, None]
        swirl = np.cross(arms.T, relative_velocities.T).T @ v
        x, y, z = (tuple(vector.tolist()) for vector in (centre, drift, swirl))
        return Mass(volume=float(v.sum()), centre=x, centre_rate=y, moments=tensor((v * arms) @ arms.T), swirl=z)

    @cached_property
    def bounding_radii(self) -> Float[np.ndarray, " link"]:
        """Distance of each link's surface from its origin [m]."""
        distances = np.zeros(self.parts)
        for piece in self.pieces:
            distances[piece.link] = max(
                distances[piece.link], float(np.linalg.norm(piece.position) + np.linalg.norm(piece.shape.half_extents))
            )
        return distances


def _corners(bounds: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Return the low and the high corner of a box."""
    return np.array(bounds[::2]), np.array(bounds[1::2])


@lru_cache(maxsize=128)
def _volume_samples(shape: Spherocylinder | Ellipsoid) -> tuple[np.ndarray, float]:
    """Return points of a regular lattice inside a shape, in its own frame [m], and the volume per point [m^3]."""
    half = shape.half_extents
    step = 2 * float(half.min()) / _MIN_POINTS_ACROSS
    lines = [(np.arange(n) + 0.5) * 2 * a / n - a for a, n in ((a, int(np.ceil(2 * a / step))) for a in half)]
    points = np.stack(np.meshgrid(*lines, indexing="ij")).reshape(3, -1)
    points = points[:, shape.contains(points)]
    return points, shape.volume(0.0) / points.shape[1]


def _piece_pose(piece: LinkPiece, links: LinkStates, frame: Pose) -> Pose:
    """Return the pose of a piece in the world.

    Args:
        piece: the piece.
        links: states of the links in the body's frame.
        frame: pose of that frame in the world.
    """
    k, outer = piece.link, frame.matrix
    link_matrix = links.matrix[k]
    arm = link_matrix @ np.array(piece.position)
    spin, rate = links.spin[k], links.velocity[k] + np.cross(links.spin[k], arm)
    position = np.array(frame.to_world(links.position[k] + arm))
    velocity = outer @ rate + np.array(frame.velocity_at(position))
    yaw, pitch, roll = rotation.attitude(outer @ link_matrix @ rotation.matrix(np.array(piece.quaternion)))
    p, q, r = (outer @ spin + frame.spins).tolist()
    (x, y, z), (u, v, w) = position.tolist(), velocity.tolist()
    return Pose(position=(x, y, z), angle=yaw, pitch=pitch, roll=roll, velocity=(u, v, w), spin_x=p, spin_y=q, spin=r)


def extrapolate_links(states: LinkStates, time: float) -> LinkStates:
    """Return the links after they have moved at constant rates for a time [s]."""
    matrix = rotation.turns(time * states.spin) @ states.matrix if time else states.matrix
    return states._replace(position=states.position + time * states.velocity, matrix=matrix)


def interpolate_links(start: LinkStates, end: LinkStates, span: float, fraction: float) -> LinkStates:
    """Return links between two states: cubics with the positions and rates of both ends.

    Rotations are interpolated as rotation vectors from the start. Before the start and after the end the rates are
    constant, those of the nearer end.

    Args:
        start: state at fraction 0.
        end: state at fraction 1.
        span: time from the start to the end [s].
        fraction: fraction of the time; 0 at the start, 1 at the end [-].
    """
    if not 0.0 < fraction < 1.0:
        return (
            extrapolate_links(start, fraction * span)
            if fraction <= 0.0
            else extrapolate_links(end, (fraction - 1.0) * span)
        )
    t, h = fraction, span
    basis = (1 + 2 * t) * (1 - t) ** 2, h * t * (1 - t) ** 2, t * t * (3 - 2 * t), h * t * t * (t - 1)
    slope = 6 * t * (t - 1) / h, (1 - t) * (1 - 3 * t), 6 * t * (1 - t) / h, t * (3 * t - 2)
    ends = start.position, start.velocity, end.position, end.velocity
    position, velocity = (
        np.sum([a * b for a, b in zip(weights, ends, strict=True)], axis=0) for weights in (basis, slope)
    )  # fmt: skip
    turn = rotation.vectors(end.matrix @ np.swapaxes(start.matrix, 1, 2))
    end_rate = _unrolled(turn, end.spin)
    vector, rate = (weights[1] * start.spin + weights[2] * turn + weights[3] * end_rate for weights in (basis, slope))
    return LinkStates(position, rotation.turns(vector) @ start.matrix, velocity, _rolled(vector, rate))


def _rolled(vector: Float[np.ndarray, "link 3"], rate: Float[np.ndarray, "link 3"]) -> Float[np.ndarray, "link 3"]:
    """Return the angular velocities of rotations whose vectors change at a rate [rad/s].

    Args:
        vector: rotation vectors [rad].
        rate: their rates [rad/s].

    Source: the left Jacobian of rotations, Sola, Deray, Atchuthan 2018, arXiv:1812.01537, Eq. (145).
    """
    angle = np.linalg.norm(vector, axis=1, keepdims=True)
    safe = np.maximum(angle, 1e-4)
    first_factor = np.where(angle < 1e-4, 0.5, (1 - np.cos(safe)) / safe**2)
    second_factor = np.where(angle < 1e-4, 1 / 6, (safe - np.sin(safe)) / safe**3)
    twist = np.cross(vector, rate)
    return np.asarray(rate + first_factor * twist + second_factor * np.cross(vector, twist))


def _unrolled(vector: Float[np.ndarray, "link 3"], spin: Float[np.ndarray, "link 3"]) -> Float[np.ndarray, "link 3"]:
    """Return the rates of rotation vectors at angular velocities: the inverse of ``_rolled`` [rad/s].

    Args:
        vector: rotation vectors [rad].
        spin: angular velocities [rad/s].
    """
    angle = np.linalg.norm(vector, axis=1, keepdims=True)
    safe = np.maximum(angle, 1e-3)
    two = np.where(angle < 1e-3, 1 / 12, (1 - 0.5 * safe / np.tan(0.5 * safe)) / safe**2)
    twist = np.cross(vector, spin)
    return np.asarray(spin - 0.5 * twist + two * np.cross(vector, twist))
