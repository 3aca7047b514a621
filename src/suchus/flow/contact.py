"""A short-range force between bodies that nearly touch, and between a body and a wall.

The force is numerical. Water in a gap keeps bodies apart, but the grid does not resolve it once the gap is below some
two cells. Fluid solvers usually add a force for this that grows with the square of the depth of one body in the
other's range. Here it is spread over the outlines instead of acting between two centres, so that it serves any shape.

Source of the law: Glowinski, Pan, Hesla, Joseph and Periaux 2001, J. Comput. Phys. 169, 363-426.
"""

from dataclasses import dataclass
from math import isfinite
from typing import NamedTuple

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.flow.grid import Grid, check_kinds
from suchus.flow.markers import Markers
from suchus.flow.pose import ROTATION_PLANES
from suchus.flow.sides import NAMES, Sides

MAX_WALL_DEPTH = 0.25
"""Depth in a wall above which a body has gone through it [cells]. With twice as much, the film of water threw a heavy
body back with three times its speed."""

MIN_WALL_CLEARANCE = 1.0
"""Distance of a body from a wall below which the grid does not resolve the water between them [cells]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyContact:
    """A pressure ``pressure (1 - d / gap)^2`` between surfaces whose distance d is below ``gap``.

    It acts between bodies, and between a body and the walls of the domain. It pushes both bodies with the same force,
    takes almost no energy, and has no friction. It does not move a body whose motion is given.
    """

    gap: float
    """Distance below which it acts; two to three cells are right [m]."""
    pressure: float
    """Pressure where the surfaces touch; ten times ``density speed^2`` of the bodies' approach is right, and four times
    the weight in water over the area on which a body rests [Pa]."""

    def __post_init__(self) -> None:
        """Refuse a gap or a pressure that is not positive."""
        check_kinds(self)
        for name, unit in (("gap", "m"), ("pressure", "Pa")):
            value = getattr(self, name)
            if not (isfinite(value) and value > 0):
                raise InvalidDesign(f"the contact's {name} is {value} {unit}; a positive number is needed.")


class WallPlane(NamedTuple):
    """A wall of the domain that bodies may come near."""

    name: str
    """Name of the side."""
    axis: int
    """Axis across which the wall lies: 0 is x, 1 is y, 2 is z."""
    position: float
    """Coordinate of the wall along that axis [m]."""
    inward: float
    """Direction from the wall into the water along that axis, 1 or -1."""

    def distances(self, points: np.ndarray) -> np.ndarray:
        """Return the distances of points from the wall, negative beyond it, shape (point,) [m].

        Args:
            points: shape (axis, point) [m].
        """
        return np.asarray(self.inward * (points[self.axis] - self.position))


def wall_planes(sides: Sides, grid: Grid) -> list[WallPlane]:
    """Return the walls of a domain that bodies may come near; see ``Sides.is_solid``.

    Args:
        sides: sides of the domain.
        grid: cells of the whole domain.
    """
    planes = []
    for k, (name, is_solid) in enumerate(zip(NAMES, sides.is_solid(grid.ndim), strict=False)):
        axis, is_low = k // 2, k % 2 == 0
        if is_solid:
            position = grid.origin[axis] + (0.0 if is_low else grid.size[axis])
            planes.append(WallPlane(name, axis, position, 1.0 if is_low else -1.0))
    return planes


def forces(
    contact: BodyContact, outlines: list[Markers], centres: list[np.ndarray], walls: list[WallPlane] | None = None
) -> np.ndarray:
    """Return force and torque about its centre on each body, shape (body, degree) [N/m, N; in space N, N m].

    The degrees are x, y and the turn about z; in space x, y, z and the turns about them.

    Args:
        contact: the law.
        outlines: outlines or skins of the bodies, in one frame.
        centres: point that each body's torque is about, each of shape (axis,) [m].
        walls: walls of the domain, in the same frame; None is none.
    """
    ndim = len(centres[0])
    total = np.zeros((len(outlines), ndim + len(ROTATION_PLANES[ndim])))
    boxes = np.array([[outline.points.min(axis=1), outline.points.max(axis=1)] for outline in outlines])
    for a, outline in enumerate(outlines):
        is_near = ((boxes[a, 0] - contact.gap < boxes[:, 1]) & (boxes[:, 0] - contact.gap < boxes[a, 1])).all(axis=1)
        for b in np.flatnonzero(is_near).tolist():
            if a == b:
                continue
            push = _pushes if ndim == 2 else _pushes_in_space
            points, force = push(contact, outline, outlines[b])
            for body, sense in ((a, 0.5), (b, -0.5)):  # half of the force from the markers of each outline
                total[body] += sense * _load(points, force, centres[body])
        for wall in walls or []:
            distance = wall.distances(outline.points)
            is_pushed = distance < contact.gap
            if is_pushed.any():
                points, force = outline.points[:, is_pushed], np.zeros((ndim, int(is_pushed.sum())))
                push_size = contact.pressure * (1 - distance[is_pushed] / contact.gap) ** 2
                force[wall.axis] = wall.inward * push_size * outline.weight[is_pushed]
                total[a] += _load(points, force, centres[a])
    return total


def _load(points: np.ndarray, force: np.ndarray, centre: np.ndarray) -> np.ndarray:
    """Return the sum of forces at points and their torque about a centre, shape (degree,).

    Args:
        points: shape (axis, point) [m].
        force: shape (axis, point) [N/m, N].
        centre: shape (axis,) [m].
    """
    arms = points - centre[:, None]
    torque = [(arms[a] * force[b] - arms[b] * force[a]).sum() for a, b in ROTATION_PLANES[len(centre)]]
    return np.array([*force.sum(axis=1), *torque])


def _pushes(contact: BodyContact, outline: Markers, other_outline: Markers) -> tuple[np.ndarray, np.ndarray]:
    """Return positions of the markers of one outline and the contact forces on them, each (2, marker) [m, N/m].

    Only markers in reach of the other outline count. An edge of the other outline is the interval of its length around
    its marker.

    Args:
        contact: the law.
        outline: the outline that is pushed.
        other_outline: the outline that pushes it.
    """
    k = (outline.x > other_outline.x.min() - contact.gap) & (outline.x < other_outline.x.max() + contact.gap)
    k &= (outline.y > other_outline.y.min() - contact.gap) & (outline.y < other_outline.y.max() + contact.gap)
    dx, dy = outline.x[k, None] - other_outline.x, outline.y[k, None] - other_outline.y
    half = other_outline.weight / 2
    normal_x, normal_y = other_outline.normals
    edge_offset = np.clip(dy * normal_x - dx * normal_y, -half, half)
    rx, ry = dx + edge_offset * normal_y, dy - edge_offset * normal_x
    nearest_edge = np.argmin(rx**2 + ry**2, axis=1)
    nearest_pair = (np.arange(nearest_edge.size), nearest_edge)
    nx, ny = normal_x[nearest_edge], normal_y[nearest_edge]
    distance = np.copysign(np.hypot(rx[nearest_pair], ry[nearest_pair]), rx[nearest_pair] * nx + ry[nearest_pair] * ny)
    push = contact.pressure * np.maximum(1 - distance / contact.gap, 0.0) ** 2 * outline.weight[k]
    return outline.points[:, k], np.stack([push * nx, push * ny])


def _pushes_in_space(contact: BodyContact, skin: Markers, other_skin: Markers) -> tuple[np.ndarray, np.ndarray]:
    """Return positions of the markers of one skin and the contact forces on them, each (3, marker) [m, N].

    The other skin is flat around each of its markers.

    Args:
        contact: the law.
        skin: the skin that is pushed.
        other_skin: the skin that pushes it.
    """
    reach = [_within(markers, other, contact.gap) for markers, other in ((skin, other_skin), (other_skin, skin))]
    near, other_near = skin.select(reach[0]), other_skin.select(reach[1])
    if not near.weight.size or not other_near.weight.size:
        return np.zeros((3, 0)), np.zeros((3, 0))
    square = sum((p[:, None] - q) ** 2 for p, q in zip(near.points, other_near.points, strict=True))
    nearest = np.argmin(square, axis=1)
    normal = other_near.normals[:, nearest]
    distance = ((near.points - other_near.points[:, nearest]) * normal).sum(axis=0)
    push = contact.pressure * np.maximum(1 - distance / contact.gap, 0.0) ** 2 * near.weight
    return near.points, push * normal


def _within(markers: Markers, other_markers: Markers, gap: float) -> np.ndarray:
    """Return which markers lie in the box around other markers, enlarged by a gap [m]."""
    low, high = other_markers.points.min(axis=1) - gap, other_markers.points.max(axis=1) + gap
    return np.asarray(((markers.points > low[:, None]) & (markers.points < high[:, None])).all(axis=0))
