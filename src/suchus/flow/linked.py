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
from suchus.flow.mass import SpaceMass, tensor
from suchus.flow.pose import Pose, turned
from suchus.flow.shape import positive
from suchus.flow.solid import INSIDE, Ellipsoid, SpaceField, SpaceShape, is_blunt

_ACROSS = 16
"""Points across a piece, at least, over which its volume is summed [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Spherocylinder(SpaceShape):
    """A rod with round ends along the body's x, its middle at the origin; a ball if it has no length."""

    length: float
    """Length between the middles of its round ends [m]."""
    radius: float
    """Radius [m]."""

    def __post_init__(self) -> None:
        positive("radius", self.radius)
        if self.length != 0.0:
            positive("length", self.length)

    @property
    def half(self) -> Float[np.ndarray, "3"]:
        """Half of the box around it [m]."""
        return np.array([0.5 * self.length + self.radius, self.radius, self.radius])

    def holds(self, points: np.ndarray) -> np.ndarray:
        """Return which points of its own frame lie inside, shape (3, ...) [m]."""
        x, y, z = points
        beyond = np.maximum(np.abs(x) - 0.5 * self.length, 0.0)
        return np.asarray(beyond * beyond + y * y + z * z < (1 - INSIDE) * self.radius**2)

    def measure(self, x: np.ndarray, y: np.ndarray, z: np.ndarray, time: float, pose: Pose, reach: float) -> SpaceField:  # noqa: ARG002
        """Return the field on the points of a window."""
        place = pose.along(3)
        world = x, y[:, None], z[:, None, None]
        px, py, pz = place.seen(world)
        dx = px - np.clip(px, -0.5 * self.length, 0.5 * self.length)
        size = np.sqrt(dx * dx + py * py + pz * pz)
        safe = np.maximum(size, 1e-12 * self.radius)
        normal = turned(place.matrix, (dx / safe, py / safe, pz / safe))
        u, v, w = (np.broadcast_to(part, size.shape) for part in place.rates(world))
        return SpaceField(size - self.radius, normal, (u, v, w), np.full(size.shape, 2 * self.radius))

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:  # noqa: ARG002
        """Return points on rings along it and over its round ends."""
        place = pose.along(3)
        local, facing, share = around_rod(self.length, self.radius, spacing)
        points = np.stack(place.place(local - np.array([[0.5 * self.length], [0.0], [0.0]])))
        spins = np.broadcast_to(place.spins[:, None], points.shape)
        return Markers(
            points=points, share=share, velocities=np.stack(place.rates(points)),
            normals=np.stack(turned(place.matrix, facing)), spins=spins,
        )  # fmt: skip

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:  # noqa: ARG002
        """Return the box around it."""
        place = pose.along(3)
        reach = (0.5 * self.length * np.abs(place.matrix[:, 0]) + self.radius).tolist()
        return tuple(p + way * r for p, r in zip(place.position, reach, strict=True) for way in (-1.0, 1.0))

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:  # noqa: ARG002
        """Return the diameter."""
        return np.zeros(1), np.full(1, 2 * self.radius)

    @property
    def blunt(self) -> bool:
        """Whether it is about as long as thick."""
        return is_blunt(self.half)

    def volume(self, time: float) -> float:  # noqa: ARG002
        """Return the volume."""
        return np.pi * self.radius**2 * (self.length + 4 / 3 * self.radius)

    def mass(self, time: float) -> SpaceMass:
        """Return volume and moments; the centre is the origin."""
        r, long, none = self.radius, self.length, (0.0, 0.0, 0.0)
        rod, ball = np.pi * r * r * long, 4 / 3 * np.pi * r**3
        along = rod * long**2 / 12 + ball * (r * r / 5 + long**2 / 4 + 3 * long * r / 8)
        across = rod * r * r / 4 + ball * r * r / 5
        return SpaceMass(
            volume=self.volume(time), centre=none, centre_rate=none,
            moments=tensor(np.diag([along, across, across])), swirl=none,
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
    at: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Origin of that frame in the link's [m]."""
    turn: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    """Quaternion that turns that frame into the link's, scalar first [-]."""


@dataclass(frozen=True, kw_only=True)
class Linked(SpaceShape):
    """The union of rigid pieces on links, each of which has its own position, attitude, velocity and spin.

    Each link is a part of its own in ``Simulation.last``. Links that turn against each other at a joint should overlap
    there, as the round ends of rods do: to the water they are one body.

    Raises:
        InvalidDesign: on creation, without pieces, or where the links that they name are not those of ``motion``.
    """

    even: ClassVar[tuple[bool, bool, bool]] = (False, False, False)
    jointed: ClassVar[bool] = True

    pieces: tuple[LinkPiece, ...]
    """The pieces; each link has at least one."""
    motion: Callable[[float], LinkStates]
    """The links at every time, in the frame of the body [s]."""

    def __post_init__(self) -> None:
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
        frame, links = pose.along(3), self.motion(time)
        return [_placed(piece, links, frame) for piece in self.pieces]

    def measure(self, x: np.ndarray, y: np.ndarray, z: np.ndarray, time: float, pose: Pose, reach: float) -> SpaceField:
        """Return the field on the points of a window, that of the nearest piece at each."""
        size = (z.size, y.size, x.size)
        found = SpaceField(
            np.full(size, reach), tuple(np.zeros((3, *size))), tuple(np.zeros((3, *size))), np.full(size, np.inf),
            np.zeros(size, np.int8),
        )  # fmt: skip
        assert found.part is not None
        for piece, place in zip(self.pieces, self.poses(time, pose), strict=True):
            low, high = (np.array(ends)[::-1] for ends in _corners(piece.shape.bounds(time, place)))
            box = tuple(
                slice(*np.searchsorted(axis, (a - reach, b + reach)))
                for axis, a, b in zip((z, y, x), low, high, strict=True)
            )  # fmt: skip
            if any(part.start == part.stop for part in box):
                continue
            own = piece.shape.measure(x[box[2]], y[box[1]], z[box[0]], time, place, reach)
            there = found.distance[box]
            nearer = own.distance < there
            facing = sum(part * one[box] for part, one in zip(own.normal, found.normal, strict=True))
            through = np.where(np.isfinite(own.thickness), own.thickness, 0.0)
            sunk = there < facing * (own.distance + through)  # its far side lies in what is there already
            values = [
                (found.distance, own.distance), (found.thickness, np.where(sunk, np.inf, own.thickness)),
                *zip(found.normal, own.normal, strict=True), *zip(found.velocity, own.velocity, strict=True),
            ]  # fmt: skip
            for one, value in values:
                one[box] = np.where(nearer, value, one[box])
            found.part[box] = np.where(nearer, piece.link, found.part[box])
        return found

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return points over what is outside of all pieces: those inside another one stand for no area."""
        places, skins = self.poses(time, pose), []
        for k, (piece, place) in enumerate(zip(self.pieces, places, strict=True)):
            skin = piece.shape.markers(time, place, spacing)
            share = np.where(self._covered(skin.points, places, k, time), 0.0, skin.share)
            skins.append(replace(skin, share=share, part=np.full(share.shape, piece.link)))
        both = ("points", "velocities", "normals", "spins")
        return Markers(
            **{name: np.concatenate([getattr(skin, name) for skin in skins], axis=1) for name in both},
            share=np.concatenate([skin.share for skin in skins]),
            part=np.concatenate([skin.part for skin in skins if skin.part is not None]),
        )

    def _covered(
        self, points: np.ndarray, places: Sequence[Pose], own: int, time: float, *, before: bool = False
    ) -> np.ndarray:
        """Return which points lie inside another piece than their own, or inside one before it."""
        inside = np.zeros(points.shape[1], bool)
        low, high = points.min(axis=1), points.max(axis=1)
        for k, (piece, place) in enumerate(zip(self.pieces, places, strict=True)):
            a, b = _corners(piece.shape.bounds(time, place))
            if k == own or (before and k > own) or (low > b).any() or (high < a).any():
                continue
            inside |= piece.shape.holds(np.array(place.seen(points)))
        return inside

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the box around all pieces."""
        boxes = np.array([
            piece.shape.bounds(time, place) for piece, place in zip(self.pieces, self.poses(time, pose), strict=True)
        ])  # fmt: skip
        ends = zip(boxes[:, ::2].min(axis=0).tolist(), boxes[:, 1::2].max(axis=0).tolist(), strict=True)
        return tuple(end for pair in ends for end in pair)

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the pieces' lengths one after the other, and the thickness of each."""
        long = np.array([2 * float(piece.shape.half.max()) for piece in self.pieces])
        thick = np.array([float(piece.shape.thickness(time)[1][0]) for piece in self.pieces])
        ends = np.concatenate([[0.0], long.cumsum()])
        return np.column_stack([ends[:-1], ends[1:]]).ravel(), np.repeat(thick, 2)

    def volume(self, time: float) -> float:
        """Return the volume of the union."""
        return self.mass(time).volume

    def mass(self, time: float) -> SpaceMass:
        """Return volume, centre and moments of the union, and what its deformation carries, by points inside it."""
        places, points, rates, each = self.poses(time, Pose()), [], [], []
        for k, (piece, place) in enumerate(zip(self.pieces, places, strict=True)):
            inner, share = _filled(piece.shape)
            world = np.array(place.place(inner))
            kept = ~self._covered(world, places, k, time, before=True)
            points.append(world[:, kept])
            rates.append(np.array(place.rates(world))[:, kept])
            each.append(np.full(int(kept.sum()), share))
        at, moving, v = np.concatenate(points, axis=1), np.concatenate(rates, axis=1), np.concatenate(each)
        centre, drift = at @ v / v.sum(), moving @ v / v.sum()
        off, past = at - centre[:, None], moving - drift[:, None]
        swirl = np.cross(off.T, past.T).T @ v
        x, y, z = (tuple(part.tolist()) for part in (centre, drift, swirl))
        return SpaceMass(volume=float(v.sum()), centre=x, centre_rate=y, moments=tensor((v * off) @ off.T), swirl=z)

    @cached_property
    def reach(self) -> Float[np.ndarray, " link"]:
        """Distance of each link's surface from its origin [m]."""
        far = np.zeros(self.parts)
        for piece in self.pieces:
            far[piece.link] = max(far[piece.link], float(np.linalg.norm(piece.at) + np.linalg.norm(piece.shape.half)))
        return far


def _corners(bounds: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Return the low and the high corner of a box."""
    return np.array(bounds[::2]), np.array(bounds[1::2])


@lru_cache(maxsize=128)
def _filled(shape: Spherocylinder | Ellipsoid) -> tuple[np.ndarray, float]:
    """Return points spread evenly inside a shape, in its own frame, and the volume that each stands for [m], [m3]."""
    half = shape.half
    step = 2 * float(half.min()) / _ACROSS
    lines = [(np.arange(n) + 0.5) * 2 * a / n - a for a, n in ((a, int(np.ceil(2 * a / step))) for a in half)]
    points = np.stack(np.meshgrid(*lines, indexing="ij")).reshape(3, -1)
    points = points[:, shape.holds(points)]
    return points, shape.volume(0.0) / points.shape[1]


def _placed(piece: LinkPiece, links: LinkStates, frame: Pose) -> Pose:
    """Return the pose of a piece in the world, its link being in a frame."""
    k, outer = piece.link, frame.matrix
    own = links.matrix[k]
    off = own @ np.array(piece.at)
    spin, rate = links.spin[k], links.velocity[k] + np.cross(links.spin[k], off)
    position = np.array(frame.place(links.position[k] + off))
    velocity = outer @ rate + np.array(frame.rates(position))
    yaw, pitch, roll = rotation.attitude(outer @ own @ rotation.matrix(np.array(piece.turn)))
    p, q, r = (outer @ spin + frame.spins).tolist()
    (x, y, z), (u, v, w) = position.tolist(), velocity.tolist()
    return Pose(position=(x, y, z), angle=yaw, pitch=pitch, roll=roll, velocity=(u, v, w), spin_x=p, spin_y=q, spin=r)


def onward(states: LinkStates, time: float) -> LinkStates:
    """Return links that have gone on at their rates for a time [s]."""
    matrix = rotation.turns(time * states.spin) @ states.matrix if time else states.matrix
    return states._replace(position=states.position + time * states.velocity, matrix=matrix)


def between(start: LinkStates, end: LinkStates, span: float, share: float) -> LinkStates:
    """Return links on their way from one state to another: cubics with the places and rates of both ends.

    Turns are rotation vectors from the start. Before and after, the links go on at the rates of the nearer end.

    Args:
        start: where the way begins.
        end: where it ends.
        span: time from the one to the other [s].
        share: of the way; 0 at the start, 1 at the end [-].
    """
    if not 0.0 < share < 1.0:
        return onward(start, share * span) if share <= 0.0 else onward(end, (share - 1.0) * span)
    t, h = share, span
    basis = (1 + 2 * t) * (1 - t) ** 2, h * t * (1 - t) ** 2, t * t * (3 - 2 * t), h * t * t * (t - 1)
    slope = 6 * t * (t - 1) / h, (1 - t) * (1 - 3 * t), 6 * t * (1 - t) / h, t * (3 * t - 2)
    ends = start.position, start.velocity, end.position, end.velocity
    position, velocity = (
        np.sum([a * b for a, b in zip(one, ends, strict=True)], axis=0) for one in (basis, slope)
    )  # fmt: skip
    turn = rotation.vectors(end.matrix @ np.swapaxes(start.matrix, 1, 2))
    last = _unrolled(turn, end.spin)
    vector, rate = (one[1] * start.spin + one[2] * turn + one[3] * last for one in (basis, slope))
    return LinkStates(position, rotation.turns(vector) @ start.matrix, velocity, _rolled(vector, rate))


def _rolled(vector: Float[np.ndarray, "link 3"], rate: Float[np.ndarray, "link 3"]) -> Float[np.ndarray, "link 3"]:
    """Return the angular velocities of rotations whose vectors change at a rate [rad/s].

    Source: the left Jacobian of rotations, Sola, Deray, Atchuthan 2018, arXiv:1812.01537, Eq. (145).
    """
    angle = np.linalg.norm(vector, axis=1, keepdims=True)
    safe = np.maximum(angle, 1e-4)
    one = np.where(angle < 1e-4, 0.5, (1 - np.cos(safe)) / safe**2)
    two = np.where(angle < 1e-4, 1 / 6, (safe - np.sin(safe)) / safe**3)
    twist = np.cross(vector, rate)
    return np.asarray(rate + one * twist + two * np.cross(vector, twist))


def _unrolled(vector: Float[np.ndarray, "link 3"], spin: Float[np.ndarray, "link 3"]) -> Float[np.ndarray, "link 3"]:
    """Return the rates of rotation vectors at angular velocities: the inverse of ``_rolled`` [rad/s]."""
    angle = np.linalg.norm(vector, axis=1, keepdims=True)
    safe = np.maximum(angle, 1e-3)
    two = np.where(angle < 1e-3, 1 / 12, (1 - 0.5 * safe / np.tan(0.5 * safe)) / safe**2)
    twist = np.cross(vector, spin)
    return np.asarray(spin - 0.5 * twist + two * np.cross(vector, twist))
