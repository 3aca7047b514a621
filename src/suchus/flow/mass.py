"""Area, centre and moments of a body's shape, and the momentum that its deformation alone would carry."""

from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True, slots=True, kw_only=True)
class _InPlane:
    """Centre and moments of a body of density 1, in its own frame, for motions along x and y and about z."""

    centre: tuple[float, float]
    """Centre of the area, in space of the volume, which lies in the plane z = 0 [m]."""
    centre_rate: tuple[float, float]
    """Velocity that the deformation gives to the centre [m/s]."""
    moment: float
    """Second moment about the axis along z through the centre, of the area [m^4], in space of the volume [m^5]."""
    swirl: float
    """Angular momentum of the deformation about that axis [m^4/s], in space [m^5/s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Mass(_InPlane):
    """Mass and moment of inertia of a body of density 1, per metre of depth."""

    area: float
    """Area of the cross-section [m^2]."""

    @property
    def size(self) -> float:
        """The area, by which the density is multiplied to give the mass [m^2]."""
        return self.area


@dataclass(frozen=True, slots=True, kw_only=True)
class SpaceMass(_InPlane):
    """Mass and moment of inertia of a body of density 1 in space."""

    volume: float
    """Volume [m^3]."""

    @property
    def size(self) -> float:
        """The volume, by which the density is multiplied to give the mass [m^3]."""
        return self.volume


def of_outline(x: np.ndarray, y: np.ndarray) -> Mass:
    """Return the mass of a rigid polygon, counter-clockwise [m]."""
    p, q = np.roll(x, -1), np.roll(y, -1)
    cross = x * q - p * y
    area = float(cross.sum() / 2)
    cx, cy = float(((x + p) * cross).sum() / (6 * area)), float(((y + q) * cross).sum() / (6 * area))
    polar = float((((x * x + x * p + p * p) + (y * y + y * q + q * q)) * cross).sum() / 12)
    moment = polar - area * (cx**2 + cy**2)
    return Mass(area=area, centre=(cx, cy), centre_rate=(0.0, 0.0), moment=moment, swirl=0.0)


def of_midline(spine: np.ndarray) -> Mass:
    """Return the mass of a body from the rows of its midline.

    Rows: x, y, heading, half-width and the rates of x, y and heading, at the stations [m, rad, s]. Each
    cross-section is a rod; where the midline bends, its outer half counts for more than its inner one.
    """
    w = (spine[3, 1:] + spine[3, :-1]) / 2
    area, *rest = _of_sections(spine, 2 * w, 2 * w**3 / 3)
    return Mass(area=area, **dict(zip(("centre", "centre_rate", "moment", "swirl"), rest, strict=True)))


def of_trunk(spine: np.ndarray, half_height: np.ndarray) -> SpaceMass:
    """Return the mass of a body with elliptic sections, from the rows of its midline and its half-heights [m]."""
    w, h = (spine[3, 1:] + spine[3, :-1]) / 2, (half_height[1:] + half_height[:-1]) / 2
    volume, *rest = _of_sections(spine, np.pi * w * h, np.pi * w**3 * h / 4)
    return SpaceMass(volume=volume, **dict(zip(("centre", "centre_rate", "moment", "swirl"), rest, strict=True)))


def _of_sections(spine: np.ndarray, size: np.ndarray, second: np.ndarray) -> tuple[Any, ...]:
    """Return size, centre, its rate, moment and swirl of sections between the stations.

    Args:
        spine: rows of the midline; see ``of_midline``.
        size: of each section: its length or area.
        second: its second moment about the midline, across the plane.
    """
    ds = np.hypot(np.diff(spine[0]), np.diff(spine[1]))
    bend = np.diff(spine[2])
    x, y, heading, _, u, v, turn = (spine[:, 1:] + spine[:, :-1]) / 2
    nx, ny = -np.sin(heading), np.cos(heading)
    slice_size, slice_moment = size * ds, second * ds
    lean = -second * bend  # first moment across the section: the element is (1 - curvature r) dr ds
    total = slice_size.sum()
    cx = ((x * slice_size).sum() + (nx * lean).sum()) / total
    cy = ((y * slice_size).sum() + (ny * lean).sum()) / total
    px = (u * slice_size).sum() - (ny * turn * lean).sum()
    py = (v * slice_size).sum() + (nx * turn * lean).sum()
    ux, uy = px / total, py / total
    dx, dy, du, dv = x - cx, y - cy, u - ux, v - uy
    moment = ((dx**2 + dy**2) * slice_size).sum() + slice_moment.sum() + 2 * ((dx * nx + dy * ny) * lean).sum()
    swirl = ((dx * dv - dy * du) * slice_size).sum() + (turn * slice_moment).sum()
    swirl += ((nx * dv - ny * du + turn * (dx * nx + dy * ny)) * lean).sum()
    return float(total), (float(cx), float(cy)), (float(ux), float(uy)), float(moment), float(swirl)
