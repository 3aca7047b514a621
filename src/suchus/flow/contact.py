"""A short-range force between bodies that nearly touch, so that they do not overlap.

The force is numerical. Water between two bodies would keep them apart, but the grid does not resolve it once the gap
is below some two cells. Fluid solvers usually add a force for this that grows with the square of the depth of one body
in the other's range. Here it is spread over the outlines instead of acting between two centres, so that it serves any
shape.
"""

from dataclasses import dataclass
from math import isfinite

import numpy as np

from suchus.core.errors import InvalidDesign
from suchus.flow.grid import check_kinds
from suchus.flow.markers import Markers


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyContact:
    """A pressure ``pressure (1 - d / gap)^2`` between outlines whose distance d is below ``gap``.

    It pushes both bodies with the same force, takes almost no energy, and has no friction. It does not move a body
    whose motion is given.
    """

    gap: float
    """Distance below which it acts; two to three cells are right [m]."""
    pressure: float
    """Pressure where the outlines touch; ten times ``density speed^2`` of the bodies' approach is right [Pa]."""

    def __post_init__(self) -> None:
        """Refuse a gap or a pressure that is not positive."""
        check_kinds(self)
        for name, unit in (("gap", "m"), ("pressure", "Pa")):
            value = getattr(self, name)
            if not (isfinite(value) and value > 0):
                raise InvalidDesign(f"the contact's {name} is {value} {unit}; a positive number is needed.")


def forces(contact: BodyContact, outlines: list[Markers], centres: list[np.ndarray]) -> np.ndarray:
    """Return the force (x, y) and the torque about its centre on each body, shape (body, 3) [N/m, N].

    Args:
        contact: the law.
        outlines: outlines of the bodies, in one frame.
        centres: point that each body's torque is about, each of shape (2,) [m].
    """
    total = np.zeros((len(outlines), 3))
    for a, outline in enumerate(outlines):
        for b, other_outline in enumerate(outlines):
            if a == b or not _is_within_gap(outline, other_outline, contact.gap):
                continue
            x, y, fx, fy = _pushes(contact, outline, other_outline)
            for body, sense in ((a, 0.5), (b, -0.5)):  # half of the force from the markers of each outline
                rx, ry = x - centres[body][0], y - centres[body][1]
                total[body] += sense * np.array([fx.sum(), fy.sum(), (rx * fy - ry * fx).sum()])
    return total


def _is_within_gap(outline: Markers, other_outline: Markers, gap: float) -> bool:
    pairs = (outline.x, other_outline.x), (outline.y, other_outline.y)
    return all(p.min() - gap < q.max() and q.min() - gap < p.max() for p, q in pairs)


def _pushes(contact: BodyContact, outline: Markers, other_outline: Markers) -> np.ndarray:
    """Return positions and contact forces of the markers of one outline, shape (4, marker).

    Rows: x and y of the marker [m], and the force along x and y [N/m].

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
    return np.stack([outline.x[k], outline.y[k], push * nx, push * ny])
