"""A trunk with rigid pieces that are attached to it: folded limbs, spread fins."""

from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.core.kinds import show
from suchus.flow.markers import Markers
from suchus.flow.mass import Mass, tensor
from suchus.flow.midline import MidlineState
from suchus.flow.pose import Pose
from suchus.flow.shape import Axes, Field, box_slices, check_positive, write_nearer
from suchus.flow.trunk import Trunk, in_world

_MIN_POINTS_ACROSS = 28
"""Points across a capsule and along it at least, over which its volume is summed [-]."""

_MIN_POINTS_AROUND = 8
"""Points around a capsule, at least [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Capsule:
    """A rod with round ends, rigid with the section of a trunk that it is attached to; a ball if it has no length.

    Points are along the midline there, towards its last station, and to the side, counter-clockwise of that.

    Raises:
        InvalidDesign: on creation, for a radius that is not positive or a point that is not two finite numbers.
    """

    arc_position: float
    """Arc length of the section, from the first station [m]."""
    start: tuple[float, float]
    """Middle of one end, from the midline in that section [m]."""
    end: tuple[float, float]
    """Middle of the other end [m]."""
    radius: float
    """Radius [m]."""

    def __post_init__(self) -> None:
        check_positive("radius", self.radius)
        for name in ("arc_position", "start", "end"):
            if not np.isfinite(getattr(self, name)).all():
                raise InvalidDesign(f"{name} of a capsule is {show(getattr(self, name))} m; give finite numbers.")

    def end_motion(self, spine: MidlineState) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
        """Return the capsule's ends, the velocity of the first end and the rate of turning, in the midline's frame.

        Shapes: (2,) [m], (2,) [m], (2,) [m/s] and a number [rad/s].

        Args:
            spine: midline of the trunk.
        """
        x, y, heading, u, v, turn = (
            float(np.interp(self.arc_position, spine.arc, profile))
            for profile in (spine.x, spine.y, spine.heading, spine.x_rate, spine.y_rate, spine.heading_rate)
        )
        tangent, normal = np.array([np.cos(heading), np.sin(heading)]), np.array([-np.sin(heading), np.cos(heading)])
        start, end = (np.array([x, y]) + p[0] * tangent + p[1] * normal for p in (self.start, self.end))
        rate = np.array([u - turn * (start[1] - y), v + turn * (start[0] - x)])
        return start, end, rate, turn

    def distance(self, px: np.ndarray, py: np.ndarray, pz: np.ndarray, spine: MidlineState) -> np.ndarray:
        """Return the signed distance from points, pz from the plane of the midline [m]."""
        return self.offsets_from_axis(px, py, pz, spine)[1] - self.radius

    def offsets_from_axis(
        self, px: np.ndarray, py: np.ndarray, pz: np.ndarray, spine: MidlineState
    ) -> tuple[tuple[np.ndarray, ...], np.ndarray]:
        """Return the vectors from the capsule's axis to points, and their lengths [m].

        Args:
            px: x of the points [m].
            py: y of the points [m].
            pz: distance of the points from the plane of the midline [m].
            spine: midline of the trunk.
        """
        start, end, *_ = self.end_motion(spine)
        axis = end - start
        square = float(axis @ axis)
        fraction = (
            np.clip(((px - start[0]) * axis[0] + (py - start[1]) * axis[1]) / square, 0.0, 1.0) if square else 0.0
        )
        dx, dy = px - start[0] - fraction * axis[0], py - start[1] - fraction * axis[1]
        return (dx, dy, pz), np.sqrt(dx * dx + dy * dy + pz * pz)


@dataclass(frozen=True, slots=True, kw_only=True)
class Lump:
    """Volume and moments that a capsule adds to a trunk: its part outside the straight trunk and earlier capsules."""

    volume: float
    """Volume [m^3]."""
    centre: tuple[float, float]
    """Its centre, from the section that it is attached to [m]."""
    second: np.ndarray
    """Integrals of the products of coordinates from the centre, which go along the section's axis, to the side and up,
    shape (3, 3) [m^5]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Limbed(Trunk):
    """The union of a trunk and capsules, whose axes lie in the plane of its midline.

    The overlap of capsule and trunk is computed for the straight trunk and kept when the trunk bends.

    Raises:
        InvalidDesign: see ``Trunk``; or a capsule that is attached beyond the trunk's ends.
    """

    limbs: tuple[Capsule, ...] = ()
    """The capsules."""
    lumps: tuple[Lump, ...] = field(init=False, repr=False, default=())
    """Volume and moments that each capsule adds."""

    def __post_init__(self) -> None:
        """Check where the capsules are attached and compute what each adds to the trunk."""
        Trunk.__post_init__(self)
        spine = self._spine(0.0)
        for limb in self.limbs:
            if not 0 <= limb.arc_position <= spine.arc[-1]:
                raise InvalidDesign(
                    f"a capsule is attached at {limb.arc_position:.4g} m of a trunk that is {spine.arc[-1]:.4g} m "
                    "long; attach it between its ends."
                )
        straight = _straight(spine)
        lumps = [self._lump(straight, limb, self.limbs[:i]) for i, limb in enumerate(self.limbs)]
        object.__setattr__(self, "lumps", tuple(lumps))

    def _lump(self, straight: MidlineState, limb: Capsule, earlier_limbs: tuple[Capsule, ...]) -> Lump:
        """Return what a capsule adds to the straight trunk and to the capsules before it, summed over points inside it.

        Args:
            straight: the trunk's midline, straight.
            limb: the capsule.
            earlier_limbs: the capsules before it.
        """
        lower_bound = np.minimum(limb.start, limb.end) - limb.radius
        upper_bound = np.maximum(limb.start, limb.end) + limb.radius
        step = 2 * limb.radius / _MIN_POINTS_ACROSS
        x, y, z = (a + (np.arange(n) + 0.5) * (b - a) / n for a, b, n in (
            (a, b, max(int(np.ceil((b - a) / step)), 1))
            for a, b in (*zip(lower_bound, upper_bound, strict=True), (0.0, limb.radius))
        ))  # fmt: skip
        z, y, x = (coordinate.ravel() for coordinate in np.meshgrid(z, y, x, indexing="ij"))
        cell_volume = float(np.prod((*(upper_bound - lower_bound), 2 * limb.radius))) / x.size  # both halves
        arc = limb.arc_position + x
        is_outside = limb.distance(arc, y, z, straight) < 0
        is_outside &= ~self._holds(arc, y, z, straight)
        for earlier_limb in earlier_limbs:
            is_outside &= earlier_limb.distance(arc, y, z, straight) >= 0
        if not is_outside.any():
            return Lump(volume=0.0, centre=(0.0, 0.0), second=np.zeros((3, 3)))
        x, y, z = x[is_outside], y[is_outside], z[is_outside]
        cx, cy = float(x.mean()), float(y.mean())
        dx, dy = x - cx, y - cy
        xx, xy, yy, zz = (cell_volume * float((a * b).sum()) for a, b in ((dx, dx), (dx, dy), (dy, dy), (z, z)))
        second = np.array([[xx, xy, 0.0], [xy, yy, 0.0], [0.0, 0.0, zz]])
        return Lump(volume=cell_volume * x.size, centre=(cx, cy), second=second)

    def _holds(self, px: np.ndarray, py: np.ndarray, pz: np.ndarray, spine: MidlineState) -> np.ndarray:
        """Return which points lie inside the trunk alone.

        Args:
            px: x of the points [m].
            py: y of the points [m].
            pz: distance of the points from the plane of the midline [m].
            spine: midline of the trunk.
        """
        nearest_station = ((px[:, None] - spine.x) ** 2 + (py[:, None] - spine.y) ** 2).argmin(axis=1)
        cos, sin = np.cos(spine.heading[nearest_station]), np.sin(spine.heading[nearest_station])
        dx, dy = px - spine.x[nearest_station], py - spine.y[nearest_station]
        axial, lateral = dx * cos + dy * sin, -dx * sin + dy * cos
        arc = spine.arc[nearest_station] + axial
        half_width, half_height = (
            np.interp(arc, spine.arc, profile) for profile in (spine.half_width, self.half_height)
        )
        is_inside: np.ndarray = (lateral * half_height) ** 2 + (pz * half_width) ** 2 < (half_width * half_height) ** 2
        return is_inside & (arc >= 0) & (arc <= spine.arc[-1])

    def measure(self, points: Axes, time: float, pose: Pose, reach: float) -> Field:
        """Return the field on the points of a window."""
        window_field = Trunk.measure(self, points, time, pose, reach)
        spine, frame = self.midline_and_frame(time, pose)
        for limb in self.limbs:
            start, end, *_ = limb.end_motion(spine)
            ends = [np.array(frame.to_world((*end_point, 0.0))) for end_point in (start, end)]
            box = box_slices(points, np.minimum(*ends), np.maximum(*ends), limb.radius + reach)
            window = tuple(line[extent] for line, extent in zip(points, reversed(box), strict=True))
            write_nearer(window_field, box, self._limb_field(limb, window, spine, frame), self._part_index(limb))
        return window_field

    def _limb_field(self, limb: Capsule, points: Axes, spine: MidlineState, frame: Pose) -> Field:
        """Return the field of a capsule on the points of a window.

        Args:
            limb: the capsule.
            points: coordinates of the window along each axis [m].
            spine: the trunk's midline in its own frame.
            frame: pose of that frame in the world.
        """
        start, _, rate, turn = limb.end_motion(spine)
        world = np.meshgrid(*reversed(points), indexing="ij")[::-1]
        px, py, pz = frame.to_body(world)
        offsets, size = limb.offsets_from_axis(px, py, pz, spine)
        normal = frame.rotate([component / np.maximum(size, 1e-12 * limb.radius) for component in offsets])
        limb_velocity = frame.rotate((rate[0] - turn * (py - start[1]), rate[1] + turn * (px - start[0]), 0 * px))
        velocity = tuple(a + b for a, b in zip(limb_velocity, frame.velocity_at(world), strict=True))
        return Field(size - limb.radius, normal, velocity, np.full(size.shape, 2 * limb.radius))

    def _part_index(self, limb: Capsule) -> int:
        return int(np.searchsorted(self.cuts, limb.arc_position, side="right"))

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return points over trunk and capsules; points inside the body have no area."""
        spine, frame = self.midline_and_frame(time, pose)
        skin = self._skin(spine, spacing)
        points, share, rates = [skin.points], [skin.weight.copy()], [skin.velocities]
        normals, spins = [skin.normals], [skin.spins]
        part_indices = [skin.part_index] if skin.part_index is not None else []
        for limb in self.limbs:
            start, end, rate, turn = limb.end_motion(spine)
            length = float(np.hypot(*np.subtract(limb.end, limb.start)))
            local, facing, area = around_rod(length, limb.radius, spacing)
            axis = end - start
            cos, sin = axis / np.linalg.norm(axis) if axis.any() else (1.0, 0.0)
            px, py = start[0] + cos * local[0] - sin * local[1], start[1] + sin * local[0] + cos * local[1]
            normals.append(np.stack([cos * facing[0] - sin * facing[1], sin * facing[0] + cos * facing[1], facing[2]]))
            spins.append(np.stack([0 * px, 0 * px, np.full(px.shape, turn)]))
            area = np.where(self._holds(px, py, local[2], spine), 0.0, area)
            points.append(np.stack([px, py, local[2]]))
            share.append(area)
            rates.append(np.stack([rate[0] - turn * (py - start[1]), rate[1] + turn * (px - start[0]), 0 * px]))
            part_indices += [np.full(px.shape, self._part_index(limb))] if part_indices else []
        for i, limb in enumerate(self.limbs):
            for k, (limb_points, area) in enumerate(zip(points, share, strict=True)):
                if k != i + 1:
                    is_inside = (
                        limb.distance(limb_points[0], limb_points[1], limb_points[2], spine) < -1e-9 * limb.radius
                    )
                    area[is_inside] = 0.0
        local_markers = Markers(
            points=np.concatenate(points, axis=1), weight=np.concatenate(share),
            velocities=np.concatenate(rates, axis=1), normals=np.concatenate(normals, axis=1),
            spins=np.concatenate(spins, axis=1), part_index=np.concatenate(part_indices) if part_indices else None,
        )  # fmt: skip
        return in_world(local_markers, frame)

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the box around the body."""
        box, (spine, frame) = list(Trunk.bounds(self, time, pose)), self.midline_and_frame(time, pose)
        for limb in self.limbs:
            end_points = (frame.to_world((*end, 0.0)) for end in limb.end_motion(spine)[:2])
            for d, ends in enumerate(zip(*end_points, strict=True)):
                box[2 * d] = min(box[2 * d], float(min(ends)) - limb.radius)
                box[2 * d + 1] = max(box[2 * d + 1], float(max(ends)) + limb.radius)
        return tuple(box)

    def mass(self, time: float) -> Mass:
        """Return volume, centre and moments of trunk and capsules together."""
        trunk, spine = Trunk.mass(self, time), self._spine(time)
        volume, centre, rate = [trunk.volume], [np.array(trunk.centre)], [np.array(trunk.centre_rate)]
        moments, swirl = trunk.moments, trunk.swirl[2]
        for limb, lump in zip(self.limbs, self.lumps, strict=True):
            ball = Capsule(arc_position=limb.arc_position, start=lump.centre, end=lump.centre, radius=limb.radius)
            place, _, speed, turn = ball.end_motion(spine)
            matrix = Pose(angle=float(np.interp(limb.arc_position, spine.arc, spine.heading))).matrix
            volume.append(lump.volume)
            centre.append(np.append(place, 0.0))
            rate.append(np.append(speed, 0.0))
            moments = moments + tensor(matrix @ lump.second @ matrix.T)
            swirl += (lump.second[0, 0] + lump.second[1, 1]) * turn
        v = np.array(volume)
        middle, drift = v @ np.array(centre) / v.sum(), v @ np.array(rate) / v.sum()
        arms, relative_velocities = np.array(centre) - middle, np.array(rate) - drift
        moments = moments + tensor((v * arms.T) @ arms)
        swirl += float(v @ (arms[:, 0] * relative_velocities[:, 1] - arms[:, 1] * relative_velocities[:, 0]))
        (cx, cy, _), (cu, cv, _) = middle.tolist(), drift.tolist()
        return Mass(
            volume=float(v.sum()), centre=(cx, cy, 0.0), centre_rate=(cu, cv, 0.0), moments=moments,
            swirl=(0.0, 0.0, float(swirl)),
        )  # fmt: skip


def _straight(spine: MidlineState) -> MidlineState:
    zero = np.zeros(spine.x.size)
    return MidlineState(x=spine.arc, y=zero, heading=zero, half_width=spine.half_width, x_rate=zero, y_rate=zero,
                 heading_rate=zero)  # fmt: skip


@lru_cache(maxsize=64)
def around_rod(length: float, radius: float, spacing: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return points over a rod with round ends, normals and areas.

    Coordinates are along the axis, from the middle of the first end, and along two axes across it. The arrays are
    cached.

    Args:
        length: between the middles of its ends [m].
        radius: radius of the rod [m].
        spacing: approximate distance of the points [m].
    """
    r = radius
    count = max(_MIN_POINTS_AROUND, int(np.ceil(2 * np.pi * r / spacing)))
    turn = 2 * np.pi * (np.arange(count) + 0.5) / count
    rings = max(1, int(np.ceil(length / spacing))) if length else 0
    axial = [(np.arange(rings) + 0.5) * length / max(rings, 1)]
    radii, area = [np.full(rings, r)], [np.full(rings, 2 * np.pi * r * length / max(rings, 1) / count)]
    caps = count // 2
    height = (np.arange(caps) + 0.5) / caps  # rings of equal area on a half ball
    for direction, base in ((-1.0, 0.0), (1.0, length)):
        axial.append(base + direction * r * height)
        radii.append(r * np.sqrt(1 - height**2))
        area.append(np.full(caps, 2 * np.pi * r * r / caps / count))
    a, o, areas = (np.concatenate(ring_values)[:, None] for ring_values in (axial, radii, area))
    points = np.stack([np.broadcast_to(a, (a.size, count)), o * np.cos(turn), o * np.sin(turn)]).reshape(3, -1)
    axis_points = np.zeros(points.shape)
    axis_points[0] = np.clip(points[0], 0.0, length)
    rod_samples = points, (points - axis_points) / r, np.broadcast_to(areas, (a.size, count)).ravel().copy()
    for array in rod_samples:
        array.flags.writeable = False
    return rod_samples
