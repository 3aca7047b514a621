# ruff: noqa: ARG002 - rigid and bending shapes share one interface, rigid ones ignore the time
"""A body in space that is defined by its midline and the elliptic sections along it: fish, robots, fins."""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.flow.markers import Markers
from suchus.flow.mass import Mass, of_trunk
from suchus.flow.midline import MidlineState, Spined
from suchus.flow.paint import ring
from suchus.flow.pose import Pose
from suchus.flow.sections import PAINTED_FIELDS, paint_sections, paint_turned_sections
from suchus.flow.shape import Axes, Field
from suchus.flow.solid import box_around, open_grid

_MIN_POINTS = 12
"""Fewest points around a section [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Trunk(Spined):
    """A body whose midline bends in the plane z = 0; its sections are ellipses, square to the midline.

    A fin is a stretch whose half-heights are large and whose half-widths are small.

    Raises:
        InvalidDesign: on creation or at its first use, for half-heights that are negative, not finite or other than
            the midline's stations, and for cuts that do not rise.
    """

    ndim: ClassVar[int] = 3
    mirror_symmetry: ClassVar[tuple[bool, ...]] = (False, False, True)

    half_height: np.ndarray
    """Half of the height across the plane at each station, shape (station,) [m]."""

    def __post_init__(self) -> None:
        """Check the half-heights and the cuts."""
        heights = self.half_height
        if heights.ndim != 1 or not np.isfinite(heights).all() or (heights < 0).any():
            raise InvalidDesign(
                f"the half-heights of a trunk have shape {heights.shape} and go from {heights.min():.4g} to "
                f"{heights.max():.4g} m; give one row of finite numbers, none negative."
            )
        Spined.__post_init__(self)

    def midline_and_frame(self, time: float, pose: Pose) -> tuple[MidlineState, Pose]:
        """Return the midline at a time in the plane z = 0 of a frame, and the pose of that frame in the world.

        The frame of a body that turns about z alone has the axes of the world.

        Args:
            time: time [s].
            pose: pose of the body's frame.

        Raises:
            InvalidDesign: the midline has another number of stations than the half-heights.
        """
        spine, pose_3d = self._spine(time), pose.in_dimensions(3)
        if not pose_3d.in_plane:
            return spine, pose_3d
        height, rate = pose_3d.position[2], pose_3d.velocity[2]
        return spine.in_world(pose), Pose(position=(0.0, 0.0, height), velocity=(0.0, 0.0, rate))

    def _spine(self, time: float) -> MidlineState:
        """Return the midline at a time [s].

        Raises:
            InvalidDesign: it has another number of stations than the half-heights.
        """
        spine = self.spine(time)
        if spine.x.size != self.half_height.size:
            raise InvalidDesign(
                f"the midline of a trunk has {spine.x.size} stations at t = {time:.4g} s and there are "
                f"{self.half_height.size} half-heights; give as many."
            )
        return spine

    def measure(self, points: Axes, time: float, pose: Pose, reach: float) -> Field:
        """Return distance, normal, velocity and part on the points of a window; see ``Shape``."""
        (x, y, z), (spine, frame) = points, self.midline_and_frame(time, pose)
        h = float(x[-1] - x[0]) / (x.size - 1)
        fields = np.zeros((PAINTED_FIELDS, z.size, y.size, x.size))
        fields[0], fields[6] = reach, np.inf
        rows = np.stack([*spine.rows, self.half_height, spine.half_width_rates, spine.arc])
        arguments = fields, rows, np.cos(spine.heading), np.sin(spine.heading), np.array(self.cuts)
        part_index = fields[7] if self.cuts else None
        if pose.in_plane:
            paint_sections(*arguments, float(x[0]), float(y[0]), float(z[0]) - frame.position[2], h, float(reach))
            lift = np.full(fields[0].shape, frame.velocity[2])
            normal, velocity = (fields[1], fields[2], fields[3]), (fields[4], fields[5], lift)
            return Field(fields[0], normal, velocity, fields[6], part_index)
        matrix = np.ascontiguousarray(frame.matrix)
        px, py, pz = (np.ascontiguousarray(line, float) for line in (x, y, z))
        paint_turned_sections(*arguments, px, py, pz, matrix, np.array(frame.position), float(reach))
        rigid, bending = frame.velocity_at(open_grid(points)), frame.rotate((fields[4], fields[5], 0 * fields[5]))
        velocity = tuple(a + b for a, b in zip(rigid, bending, strict=True))
        return Field(fields[0], frame.rotate(fields[1:4]), velocity, fields[6], part_index)

    def markers(self, time: float, pose: Pose, spacing: float) -> Markers:
        """Return markers at the centres of patches between the stations.

        The widest section determines the number of patches around the body.
        """
        spine, frame = self.midline_and_frame(time, pose)
        return in_world(self._skin(spine, spacing), frame)

    def _skin(self, spine: MidlineState, spacing: float) -> Markers:
        """Return the markers of ``markers`` in the frame of a midline.

        Args:
            spine: the midline.
            spacing: about the distance of the markers [m].
        """
        half_widths, half_heights = (
            np.concatenate([[0.0], half_axis, [0.0]]) for half_axis in (spine.half_width, self.half_height)
        )
        station = np.clip(np.arange(-1, spine.x.size + 1), 0, spine.x.size - 1)  # the ends' faces too
        max_radius = float(np.hypot(spine.half_width, self.half_height).max())
        angle = np.linspace(0.0, 2 * np.pi, max(_MIN_POINTS, int(np.ceil(2 * np.pi * max_radius / spacing))) + 1)
        lateral_offset = np.outer(half_widths, np.cos(angle))
        nx, ny = -np.sin(spine.heading)[station, None], np.cos(spine.heading)[station, None]
        corner = np.stack([
            spine.x[station, None] + lateral_offset * nx, spine.y[station, None] + lateral_offset * ny,
            np.outer(half_heights, np.sin(angle)),
        ])  # fmt: skip
        turn = spine.heading_rate[station, None]
        swell = np.outer(np.concatenate([[0.0], spine.half_width_rates, [0.0]]), np.cos(angle))
        rate = np.stack([
            spine.x_rate[station, None] + swell * nx - turn * lateral_offset * ny,
            spine.y_rate[station, None] + swell * ny + turn * lateral_offset * nx,
            np.zeros(lateral_offset.shape),
        ])  # fmt: skip
        first_diagonal = corner[:, 1:, 1:] - corner[:, :-1, :-1]
        second_diagonal = corner[:, 1:, :-1] - corner[:, :-1, 1:]
        square = np.cross(first_diagonal, second_diagonal, axis=0)
        size = np.sqrt((square**2).sum(axis=0))
        arc = np.broadcast_to(spine.arc[station, None], lateral_offset.shape)
        arc_centres = _patch_centres(arc[None])[0]
        part_index = np.searchsorted(self.cuts, arc_centres.ravel(), side="right") if self.cuts else None
        spins = np.zeros(square.shape)
        spins[2] = _patch_centres(np.broadcast_to(turn, lateral_offset.shape)[None])[0]
        return Markers(
            points=_patch_centres(corner).reshape(3, -1),
            weight=0.5 * size.ravel(),
            velocities=_patch_centres(rate).reshape(3, -1),
            normals=(square / np.maximum(size, 1e-300)).reshape(3, -1),
            spins=spins.reshape(3, -1),
            part_index=part_index,
        )

    def bounds(self, time: float, pose: Pose) -> tuple[float, ...]:
        """Return the smallest box around the body: x0, x1, y0, y1, z0, z1 [m]."""
        spine, frame = self.midline_and_frame(time, pose)
        if pose.in_plane:
            height, half_height = frame.position[2], float(self.half_height.max())
            return (*box_around(ring(spine.rows)), height - half_height, height + half_height)
        centres, matrix = np.array(frame.to_world((spine.x, spine.y, 0 * spine.x))), frame.matrix
        lateral = np.stack([-np.sin(spine.heading), np.cos(spine.heading)])
        lateral_extent = spine.half_width * (matrix[:, :2] @ lateral)
        vertical_extent = np.outer(matrix[:, 2], self.half_height)
        extent = np.hypot(lateral_extent, vertical_extent)  # how far each section reaches along the world's axes
        return box_around(np.concatenate([centres - extent, centres + extent], axis=1))

    def midsurface(self, time: float, pose: Pose) -> np.ndarray | None:
        """Return the longer axes of the sections, where a section is narrower than it is far from the ends of the body.

        Round sections have no such surface. See ``Shape``.
        """
        spine, frame = self.midline_and_frame(time, pose)
        half_width, half_height, arc = spine.half_width, self.half_height, spine.arc
        is_slim = np.minimum(half_width, half_height) < np.minimum(arc, arc[-1] - arc)
        square = np.maximum(half_width**2 + half_height**2, np.finfo(float).tiny)
        excess = np.where(is_slim, (half_height**2 - half_width**2) / square, 0.0)
        vertical, lateral = half_height * np.maximum(excess, 0.0), half_width * np.maximum(-excess, 0.0)
        rim_offset = np.stack([-lateral * np.sin(spine.heading), lateral * np.cos(spine.heading), vertical])
        centre_line = np.stack([spine.x, spine.y, 0 * spine.x])
        has_surface = ((vertical[1:] > 0) & (vertical[:-1] > 0)) | ((lateral[1:] > 0) & (lateral[:-1] > 0))
        if not has_surface.any():
            return None
        lower_rim, upper_rim = (np.array(frame.to_world(centre_line + sign * rim_offset)) for sign in (-1.0, 1.0))
        pairs = [
            (lower_rim[:, :-1], lower_rim[:, 1:], upper_rim[:, :-1]),
            (lower_rim[:, 1:], upper_rim[:, 1:], upper_rim[:, :-1]),
        ]
        return np.ascontiguousarray(np.concatenate([np.stack(pair)[:, :, has_surface] for pair in pairs], axis=2))

    def thickness(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return arc length and the smaller axis of the section at the stations."""
        spine = self._spine(time)
        return spine.arc, 2 * np.minimum(spine.half_width, self.half_height)

    def is_closed(self, time: float) -> bool:
        """Return False: water passes through the middle where the sections are nearly round."""
        return False

    def mass(self, time: float) -> Mass:
        """Return volume, centre and moments, section by section."""
        return of_trunk(self._spine(time).rows, self.half_height)

    def position_at(self, time: float, pose: Pose, arc: np.ndarray) -> np.ndarray:
        """Return where the midline is at arc lengths, in the world, shape (point, 3) [m]; see ``Spined``."""
        spine, frame = self.midline_and_frame(time, pose)
        x, y = (np.interp(arc, spine.arc, line) for line in (spine.x, spine.y))
        return np.column_stack(frame.to_world((x, y, 0 * x)))


def in_world(skin: Markers, frame: Pose) -> Markers:
    """Return markers in the world frame, with the velocity of the moving frame added.

    Args:
        skin: markers in a frame.
        frame: pose of that frame.
    """
    points = np.array(frame.to_world(skin.points))
    velocities = np.array(frame.rotate(skin.velocities)) + frame.velocity_at(points)
    return Markers(
        points=points, weight=skin.weight, velocities=velocities,
        normals=np.array(frame.rotate(skin.normals)),
        spins=np.array(frame.rotate(skin.spins)) + frame.spins[:, None], part_index=skin.part_index,
    )  # fmt: skip


def _patch_centres(corners: np.ndarray) -> np.ndarray:
    """Return the means over the four corners of each patch, shape (..., station - 1, angle - 1)."""
    pairs = corners[:, 1:] + corners[:, :-1]
    centres: np.ndarray = 0.25 * (pairs[:, :, 1:] + pairs[:, :, :-1])
    return centres
