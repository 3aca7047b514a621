"""Bodies in the water: a shape with a motion, and the field of several bodies on the grid."""

from dataclasses import dataclass, field
from itertools import accumulate, pairwise
from typing import NamedTuple

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.core.kinds import show
from suchus.flow.compiled import PAD, Window
from suchus.flow.free import FreeBody
from suchus.flow.grid import Grid
from suchus.flow.immerse import MIN_CLOSED_THICKNESS, MIN_THICKNESS, REACH, WINDOW_MARGIN
from suchus.flow.pose import Motion, Pose
from suchus.flow.shape import Axes, Field, Shape


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """A shape whose motion is given."""

    shape: Shape
    """Shape of the body in its own frame."""
    motion: Pose | Motion = field(default_factory=Pose)
    """Position and angle of its frame: a fixed pose, or a pose for every time [s]."""
    name: str = "body"
    """Its name in records and messages."""

    def pose(self, time: float) -> Pose:
        """Return the pose at a time [s].

        Raises:
            InvalidDesign: the motion gives something else than a pose.
        """
        if isinstance(self.motion, Pose):
            return self.motion
        pose = self.motion(time)
        if not isinstance(pose, Pose):
            raise InvalidDesign(
                f"the motion of {self.name} gives {show(pose)} at t = {time:.4g} s; a motion returns a Pose, with "
                f"position, angle, velocity and spin."
            )
        return pose

    @property
    def is_static(self) -> bool:
        """Whether neither shape nor pose ever change."""
        moving = not isinstance(self.motion, Pose) or any(self.motion.velocity) or self.motion.spins.any()
        return self.shape.rigid and not moving


AnyBody = Body | FreeBody


MAX_ROWS = 127
"""Largest number of parts of all bodies together: the parts are counted in one byte [-]."""

_REACHES = {2: REACH + 1, 3: REACH}
"""Distance from a body up to which its field is exact, in the plane and in space [cells]."""

SYMMETRY_TOLERANCE = 1e-6
"""Distance of a body's middle from a mirror, over a cell, up to which the body is symmetric about it [-]."""


def window_of(
    body: AnyBody, pose: Pose, grid: Grid, time: float, mirrors: tuple[bool, ...] = (), solids: tuple[bool, ...] = ()
) -> Window:
    """Return the cells around a body that it acts on.

    A cell beyond a mirror that cuts the body is one of them, and so is a cell beyond a wall that the body comes near.

    Args:
        body: the body.
        pose: its pose.
        grid: the grid.
        time: time [s].
        mirrors: whether there is a mirror at the low and at the high end of each axis; see ``Sides.has_mirror``. Empty:
            there are none.
        solids: whether there is a wall at these ends; see ``Sides.is_solid``. Empty: there are none.

    Raises:
        InvalidDesign: the body comes near to an open side of the domain, lies beyond a wall, or a mirror does not cut
            it in half.
    """
    bounds = body.shape.bounds(time, pose)
    ends, h, margin = list(zip(bounds[::2], bounds[1::2], strict=True)), grid.cell, WINDOW_MARGIN * grid.cell
    mirrors, solids = (kinds or (False,) * (2 * grid.ndim) for kinds in (mirrors, solids))
    window = []
    for d in reversed(range(grid.ndim)):
        (lower_bound, upper_bound), start, end = ends[d], grid.origin[d], grid.origin[d] + grid.size[d]
        end_cuts = (
            mirrors[2 * d] and lower_bound < start < upper_bound,
            mirrors[2 * d + 1] and lower_bound < end < upper_bound,
        )
        is_far = lower_bound - margin > start, upper_bound + margin < end
        is_beside = (
            not is_far[0] and solids[2 * d] and upper_bound > start,
            not is_far[1] and solids[2 * d + 1] and lower_bound < end,
        )
        if not all(cut or far or beside for cut, far, beside in zip(end_cuts, is_far, is_beside, strict=True)):
            raise _out_of_grid_error(body, grid, ends, time)
        for plane in [plane for plane, is_cut in zip((start, end), end_cuts, strict=True) if is_cut]:
            check_cut(body, pose, d, plane, h, time)
        end_cell = min(int((upper_bound + margin - start) / h) + 2, grid.cells[d])
        window += [
            PAD - 1 if end_cuts[0] or is_beside[0] else int((lower_bound - margin - start) / h) + PAD,
            PAD + (grid.cells[d] + 1 if end_cuts[1] or is_beside[1] else end_cell),
        ]
    return tuple(window)


def _out_of_grid_error(body: AnyBody, grid: Grid, ends: list[tuple[float, float]], time: float) -> InvalidDesign:
    """Return the error for a body that reaches beyond the grid.

    Args:
        body: the body.
        grid: the grid.
        ends: smallest and largest coordinate of the body along each axis [m].
        time: time [s].
    """
    reach = ", ".join(
        f"{axis} = {lower_bound:.4g} to {upper_bound:.4g} m"
        for axis, (lower_bound, upper_bound) in zip("xyz", ends, strict=False)
    )
    domain = ", ".join(
        f"{axis} = {start:.4g} to {start + size:.4g} m"
        for axis, start, size in zip("xyz", grid.origin, grid.size, strict=False)
    )
    return InvalidDesign(
        f"at t = {time:.4g} s, {body.name} reaches over {reach}, outside the grid {domain} "
        f"(less {WINDOW_MARGIN * grid.cell:.2g} m on each open side); enlarge the grid, let it follow the body, or "
        f"make the side a Wall() or a Slip(), to which a body may come near."
    )


def check_cut(body: AnyBody, pose: Pose, axis: int, plane: float, h: float, time: float) -> None:
    """Refuse a body that a mirror cuts anywhere but in its middle.

    Args:
        body: the body.
        pose: its pose.
        axis: axis across which the mirror lies: 0 is x, 1 is y, 2 is z.
        plane: coordinate of the mirror along that axis [m].
        h: side of a cell [m].
        time: time [s].

    Raises:
        InvalidDesign: its halves differ, its middle lies off the plane, it moves through the plane, or its axes are
            oblique to it.
    """
    frame, name = pose.in_dimensions(3), "xyz"[axis]
    alignment = np.abs(frame.matrix[axis])  # cosines between the body's axes and the mirror's normal
    upright = float(alignment.max()) > 1 - SYMMETRY_TOLERANCE**2
    if upright and not body.shape.mirror_symmetry[int(alignment.argmax())]:
        raise InvalidDesign(
            f"the Mirror at {name} = {plane:.4g} m cuts {body.name}, whose two halves there are no images of each "
            f"other; move the body or the grid, or take another side. A Trunk may be cut across z."
        )
    if abs(frame.position[axis] - plane) > SYMMETRY_TOLERANCE * h or frame.velocity[axis] != 0:
        raise InvalidDesign(
            f"at t = {time:.4g} s the middle of {body.name} is at {name} = {frame.position[axis]:.4g} m and moves with "
            f"{frame.velocity[axis]:.4g} m/s along {name}; the Mirror that cuts it, at {name} = {plane:.4g} m, needs "
            f"it to stay there. Move the body or the grid, or take another side."
        )
    if not upright or np.delete(frame.spins, axis).any():
        tilt = [round(angle, 9) + 0.0 for angle in (frame.pitch, frame.roll)]
        tilt_text = f", pitch {tilt[0]:.4g} and roll {tilt[1]:.4g} rad," if any(tilt) else ""
        spins = ", ".join(f"{spin:.4g}" for spin in frame.spins)
        raise InvalidDesign(
            f"at t = {time:.4g} s {body.name} stands at an angle of {frame.angle:.4g} rad{tilt_text} and turns with "
            f"({spins}) rad/s; the Mirror that cuts it across {name} needs one of its axes along {name} and lets it "
            f"turn about {name} alone. Take another side there."
        )


def reaches_beyond(window: Window, grid: Grid) -> tuple[bool, ...]:
    """Return whether a window reaches beyond the grid, at the low and at the high end of each axis.

    It does where a mirror cuts a body, and where a body is near to a wall.
    """
    ends = list(zip(window[::2], window[1::2], strict=True))[::-1]
    pairs = [(start < PAD, stop > n + PAD) for (start, stop), n in zip(ends, grid.cells, strict=True)]
    return tuple(end for pair in pairs for end in pair)


def cuts(window: Window, grid: Grid, mirrors: tuple[bool, ...]) -> tuple[bool, ...]:
    """Return whether a mirror cuts the bodies of a window at the low and at the high end of each axis.

    Args:
        window: the window.
        grid: the grid.
        mirrors: whether there is a mirror at these ends; see ``Sides.has_mirror``.
    """
    if not any(mirrors):
        return (False,) * len(mirrors)
    return tuple(beyond and mirror for beyond, mirror in zip(reaches_beyond(window, grid), mirrors, strict=True))


def unite(windows: list[Window], ndim: int) -> Window:
    """Return the smallest window around all; an empty one around none."""
    if not windows:
        return (PAD,) * (2 * ndim)
    return tuple((max if k % 2 else min)(w[k] for w in windows) for k in range(2 * ndim))


def rows_of(bodies: list[AnyBody]) -> list[range]:
    """Return the range of rows of each body in arrays that have one row for each part of every body.

    Raises:
        InvalidDesign: there are more than ``MAX_ROWS`` parts.
    """
    ends = list(accumulate([body.shape.parts for body in bodies], initial=0))
    if ends[-1] > MAX_ROWS:
        raise InvalidDesign(f"the bodies have {ends[-1]} parts together; up to {MAX_ROWS} are allowed. Cut them less.")
    return [range(start, end) for start, end in pairwise(ends)]


class Overlap(NamedTuple):
    """Deepest overlap of two bodies, if any overlap."""

    depth: float
    """Distance of the deepest point inside both bodies from the nearer of their surfaces [m]; 0 without overlap."""
    bodies: tuple[int, int]
    """Indices of the two bodies [-]."""


def measure_all(
    bodies: list[AnyBody], poses: list[Pose], points: Axes, time: float, h: float
) -> tuple[Field, np.ndarray, Overlap]:
    """Return the field of all bodies on a window, the part that each point belongs to, and the deepest overlap.

    At each point the field is that of the nearest body. The part is counted over all bodies, as ``rows_of`` does.

    Args:
        bodies: the bodies.
        poses: the pose of each body.
        points: coordinates of the window along each axis [m].
        time: time [s].
        h: side of a cell [m].
    """
    nearest_field, owner, overlap = None, np.zeros([p.size for p in reversed(points)], np.int8), Overlap(0.0, (0, 0))
    body_rows = rows_of(bodies)
    for number, (rows, body, pose) in enumerate(zip(body_rows, bodies, poses, strict=True)):
        body_field = body.shape.measure(points, time, pose, _REACHES[len(points)] * h)
        part_index = body_field.part_index
        if nearest_field is None:
            nearest_field = body_field
            owner = owner if part_index is None else part_index.astype(np.int8)
            continue
        shared = np.maximum(body_field.distance, nearest_field.distance)
        deepest = np.unravel_index(int(shared.argmin()), shared.shape)
        if -shared[deepest] > overlap.depth:
            other_body = next(k for k, candidate_rows in enumerate(body_rows) if owner[deepest] in candidate_rows)
            overlap = Overlap(-float(shared[deepest]), (other_body, number))
        is_nearer = body_field.distance < nearest_field.distance
        nearest_field = _merge_fields(is_nearer, body_field, nearest_field)
        owner[is_nearer] = rows.start if part_index is None else rows.start + part_index[is_nearer]
    assert nearest_field is not None  # a window exists only if there are bodies
    return nearest_field, owner, overlap


def _merge_fields(mask: np.ndarray, a: Field, b: Field) -> Field:
    """Return field ``a`` at the points of a mask and field ``b`` elsewhere."""

    def choose(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.where(mask, x, y)

    return Field(
        choose(a.distance, b.distance),
        tuple(map(choose, a.normal, b.normal)),
        tuple(map(choose, a.velocity, b.velocity)),
        choose(a.thickness, b.thickness),
    )


def thin_fraction(body: AnyBody, grid: Grid, time: float) -> float:
    """Return the fraction of the body's length that is thinner than ``MIN_THICKNESS`` cells [-].

    Args:
        body: the body.
        grid: the grid.
        time: time [s].

    Raises:
        InvalidDesign: the body is too thin everywhere.
    """
    station, thickness = body.shape.thickness(time)
    min_thickness, max_thickness = MIN_THICKNESS * grid.cell, float(thickness.max())
    min_cells = MIN_CLOSED_THICKNESS if body.shape.is_closed(time) else MIN_THICKNESS
    if max_thickness < min_cells * grid.cell:
        raise InvalidDesign(
            f"{body.name} is {max_thickness:.4g} m thick at most, {max_thickness / grid.cell:.2g} cells of "
            f"{grid.cell:.4g} m; at least {min_cells:.2f} cells are needed. Take cells of at most "
            f"{max_thickness / min_cells:.3g} m."
        )
    if station.size == 1:
        return float(max_thickness < min_thickness)
    thin_weight = 0.5 * ((thickness[1:] < min_thickness).astype(float) + (thickness[:-1] < min_thickness).astype(float))
    return float((thin_weight * np.diff(station)).sum() / (station[-1] - station[0]))
