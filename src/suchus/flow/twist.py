"""Rigid motions of bodies and of their parts, and the response of the water to a velocity change within a step.

A step of the flow takes an extrapolated motion of the bodies. If the forces then require another acceleration, the
step is not repeated: to first order in the step, the water gets the potential flow of the difference, which takes one
solve of the pressure equation. The immersion fixes the fraction ``1 - mu0`` of each face to the body in both stages of
a step. The result is therefore that of a step with the other acceleration.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from suchus.flow.body import reaches_beyond
from suchus.flow.markers import Markers
from suchus.flow.pose import ROTATION_PLANES
from suchus.flow.water import Fluid

DIVERGENCE_TOLERANCE = 1e-4
"""Limit of the mean divergence in ``accelerate``, over the largest change of a body's velocity [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Twists:
    """Rigid motions of parts, one a row: velocities, or changes of velocity.

    A body that is not divided is one part. A bending body is approximated by as many rigid pieces as it has parts.
    """

    reference_points: np.ndarray
    """Reference points of the parts, whose velocity is ``linear``, in the frame of the grid, shape (part, axis) [m]."""
    linear: np.ndarray
    """Velocities of these points, shape (part, axis) [m/s]."""
    angular: np.ndarray
    """Angular velocities, about z in the plane and about x, y and z in space, shape (part, 1) or (part, 3) [rad/s]."""

    def velocity_at(self, part_index: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Return the velocities of points, shape (axis, point) [m/s].

        Args:
            part_index: part that each point belongs to, shape (point,).
            points: the points, shape (axis, point) [m].
        """
        velocities = self.linear.T[:, part_index].astype(float)
        lever = points - self.reference_points.T[:, part_index]
        for turn, (a, b) in zip(self.angular.T, ROTATION_PLANES[len(points)], strict=True):
            velocities[a] -= lever[b] * turn[part_index]
            velocities[b] += lever[a] * turn[part_index]
        return velocities

    def at_origin(self) -> np.ndarray:
        """Return the velocities that the parts have at the origin of the frame, shape (part, axis) [m/s]."""
        return self.velocity_at(np.arange(len(self.reference_points)), np.zeros(self.reference_points.T.shape)).T

    def __mul__(self, factor: float) -> "Twists":
        """Return the twists multiplied by a factor."""
        return replace(self, linear=factor * self.linear, angular=factor * self.angular)


def resting_twists(rows: int, ndim: int) -> Twists:
    """Return zero twists of parts at rest.

    Args:
        rows: number of parts.
        ndim: number of axes of the domain, 2 or 3.
    """
    turns = len(ROTATION_PLANES[ndim])
    return Twists(
        reference_points=np.zeros((rows, ndim)), linear=np.zeros((rows, ndim)), angular=np.zeros((rows, turns))
    )  # fmt: skip


def join_twists(twists: Sequence[Twists]) -> Twists:
    """Return the twists of several bodies in one object, body after body."""
    return Twists(
        reference_points=np.concatenate([twist.reference_points for twist in twists]),
        linear=np.concatenate([twist.linear for twist in twists]),
        angular=np.concatenate([twist.angular for twist in twists]),
    )  # fmt: skip


class HeldFaces(NamedTuple):
    """Faces across one axis that belong to the bodies in part; arrays of shape (face,) except for the points."""

    face_indices: np.ndarray
    """Flat indices of the faces in an array of the window [-]."""
    row: np.ndarray
    """Part to which each face belongs [-]."""
    points: np.ndarray
    """Centres of the faces in the frame of the grid, shape (axis, face) [m]."""
    body_fraction: np.ndarray
    """Fraction of each face that moves with the body, ``1 - mu0`` [-]."""
    closed_fraction: np.ndarray
    """Fraction of each face on which the pressure does not act, ``1 - passage`` [-]."""


def held_faces(water: Fluid) -> list[HeldFaces]:
    """Return the faces that belong to the bodies at least in part, one entry for each axis.

    Faces beyond mirrors and walls are left out, and so are those on a wall, through which nothing moves.
    """
    window, ndim, grid, faces = water.window_slices, water.ndim, water.grid, []
    is_inside = np.ones([s.stop - s.start for s in window], bool)
    clear_images(is_inside, reaches_beyond(water.window, water.grid))
    walls = [
        is_beyond and is_solid
        for is_beyond, is_solid in zip(reaches_beyond(water.window, grid), water.sides.is_solid(ndim), strict=True)
    ]
    ends = [(s.start, s.stop) for s in reversed(window)]
    for c in range(ndim):
        body_fraction, closed = (1 - fraction[c][window].astype(np.float64) for fraction in (water.mu0, water.passage))
        is_counted = ((body_fraction > 0) | (closed > 0)) & is_inside
        if walls[2 * c]:
            np.moveaxis(is_counted, ndim - 1 - c, 0)[1] = False
        index = np.flatnonzero(is_counted)
        lines = [(grid.faces if c == d else grid.centres)(*ends[d], d) for d in range(ndim)]
        places = np.unravel_index(index, body_fraction.shape)
        points = np.stack([lines[d][places[ndim - 1 - d]] for d in range(ndim)])
        row = water.owners[c].ravel()[index].astype(np.intp)
        faces.append(HeldFaces(index, row, points, body_fraction.ravel()[index], closed.ravel()[index]))
    return faces


def clear_images(values: np.ndarray, mirror_cuts: tuple[bool, ...]) -> None:
    """Set values beyond the mirrors that cut a body to 0.

    Args:
        values: values on the faces of a window, the last axis first.
        mirror_cuts: whether the mirror at the low and the high end of each axis cuts the body.
    """
    for k, is_cut in enumerate(mirror_cuts):
        lines = np.moveaxis(values, values.ndim - 1 - k // 2, 0)
        if is_cut and k % 2 == 0:
            lines[0] = 0
        elif is_cut:
            lines[-2:] = 0


def face_differences(water: Fluid, x: np.ndarray, faces: HeldFaces, axis: int) -> np.ndarray:
    """Return the difference of a field across faces, the upper cell minus the lower one, shape (face,).

    Args:
        water: the water, for its window.
        x: field at the cells of the padded grid.
        faces: the faces across an axis.
        axis: that axis.
    """
    low_corner = [s.start for s in water.window_slices]
    cell_behind = [
        index + start
        for index, start in zip(np.unravel_index(faces.face_indices, _shape(water)), low_corner, strict=True)
    ]
    cell_before = [index - (n == water.ndim - 1 - axis) for n, index in enumerate(cell_behind)]
    return x[tuple(cell_behind)].astype(np.float64) - x[tuple(cell_before)]


def _shape(water: Fluid) -> tuple[int, ...]:
    return tuple(s.stop - s.start for s in water.window_slices)


def accelerate(water: Fluid, twists: Twists, dt: float) -> None:
    """Change the velocities of the bodies at the end of the last step, with the response of the water in that step.

    On return, the fields are those of a step in which the bodies reached the changed velocities: velocity and pressure,
    the bodies' velocity, and the sums of the immersion. The sides are not changed.

    Args:
        water: after a step.
        twists: change of the velocity of each part, for all parts of all bodies.
        dt: length of the step [s].

    Raises:
        NotConverged: the pressure solver did not converge.
    """
    ndim, h, faces = water.ndim, water.grid.cell, held_faces(water)
    changes = [twists.velocity_at(axis_faces.row, axis_faces.points)[c] for c, axis_faces in enumerate(faces)]
    max_change = max((float(np.abs(change).max(initial=0.0)) for change in changes), default=0.0)
    if max_change == 0.0:
        return
    shape, count = _shape(water), len(water.immersion_sums)
    velocity_change = np.zeros((ndim, *shape))
    for c, (axis_faces, change) in enumerate(zip(faces, changes, strict=True)):
        velocity_change[c].ravel()[axis_faces.face_indices] = axis_faces.body_fraction * change
    x = water.apply_velocity_change(velocity_change, dt, DIVERGENCE_TOLERANCE * max_change)
    energy, turns = ndim + len(ROTATION_PLANES[ndim]), ROTATION_PLANES[ndim]
    sums = np.zeros_like(water.immersion_sums)
    corner = np.array(water.grid.origin)
    lever = replace(twists, reference_points=twists.reference_points - corner)
    # the mean velocity of the step changes by half of the velocity change, which acts on the previous sums too
    previous_sums, spin = water.immersion_sums, h * twists.angular
    sums[:, energy] += 0.5 * (lever.at_origin() * previous_sums[:, :ndim]).sum(axis=1)
    sums[:, energy] += 0.5 * (spin * previous_sums[:, ndim:energy]).sum(axis=1)
    for c, (axis_faces, change) in enumerate(zip(faces, changes, strict=True)):
        gained = axis_faces.body_fraction * change + axis_faces.closed_fraction * face_differences(
            water, x, axis_faces, c
        )
        sums[:, c] += np.bincount(axis_faces.row, gained, count)
        for n, (a, b) in enumerate(turns):
            if c in (a, b):
                offset = (axis_faces.points[b if c == a else a] - corner[b if c == a else a]) / h
                sums[:, ndim + n] += np.bincount(axis_faces.row, (-offset if c == a else offset) * gained, count)
        mean = water.mean[c].ravel()[axis_faces.face_indices].astype(np.float64)
        sums[:, energy] += np.bincount(axis_faces.row, (mean + 0.5 * change) * gained, count)
        body_velocity = water.b[c].ravel()
        body_velocity[axis_faces.face_indices] += change.astype(water.dtype)
        water.mean[c].ravel()[axis_faces.face_indices] += (0.5 * change).astype(water.dtype)
    if len(water.immersion_sums) > len(water.rows):
        water.internal_pressure_sums += water.pressures(x, 1.0)
    water.subtract_dilatation_work(sums, x, 1.0)
    water.immersion_sums += sums + water.joint_pressure_sums(x, 1.0)


def part_indices(outline: Markers) -> np.ndarray:
    """Return which of its body's parts each point of a skin belongs to, shape (point,) [-]."""
    if outline.part_index is None:
        return np.zeros(outline.points.shape[1], np.intp)
    return outline.part_index.astype(np.intp)


def add_twists(outline: Markers, twists: Twists) -> Markers:
    """Return the markers of one body with the velocity change of its parts added.

    Args:
        outline: the markers.
        twists: change of the velocity of each part of this body.
    """
    row = part_indices(outline)
    velocities = outline.velocities + twists.velocity_at(row, outline.points)
    spins = outline.spins + twists.angular[row].T
    return replace(outline, velocities=velocities, spins=spins)
