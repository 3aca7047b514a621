"""Area, centre and moments of a body's shape, and the momentum that its deformation alone would carry."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True, kw_only=True)
class Mass:
    """What a body of density 1 weighs, in its own frame and per metre of depth."""

    area: float
    """Area of the cross-section [m^2]."""
    centre: tuple[float, float]
    """Centre of the area [m]."""
    centre_rate: tuple[float, float]
    """Velocity that the deformation gives to the centre [m/s]."""
    moment: float
    """Polar second moment of area about the centre [m^4]."""
    swirl: float
    """Angular momentum of the deformation about the centre [m^4/s]."""


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
    ds = np.hypot(np.diff(spine[0]), np.diff(spine[1]))
    bend = np.diff(spine[2])
    x, y, heading, w, u, v, turn = (spine[:, 1:] + spine[:, :-1]) / 2
    nx, ny = -np.sin(heading), np.cos(heading)
    slice_area, slice_moment = 2 * w * ds, 2 * w**3 / 3 * ds
    lean = -2 * w**3 / 3 * bend  # first moment across the section: the area element is (1 - curvature r) dr ds
    area = slice_area.sum()
    cx = ((x * slice_area).sum() + (nx * lean).sum()) / area
    cy = ((y * slice_area).sum() + (ny * lean).sum()) / area
    px = (u * slice_area).sum() - (ny * turn * lean).sum()
    py = (v * slice_area).sum() + (nx * turn * lean).sum()
    ux, uy = px / area, py / area
    dx, dy, du, dv = x - cx, y - cy, u - ux, v - uy
    moment = ((dx**2 + dy**2) * slice_area).sum() + slice_moment.sum() + 2 * ((dx * nx + dy * ny) * lean).sum()
    swirl = ((dx * dv - dy * du) * slice_area).sum() + (turn * slice_moment).sum()
    swirl += ((nx * dv - ny * du + turn * (dx * nx + dy * ny)) * lean).sum()
    return Mass(
        area=float(area), centre=(float(cx), float(cy)), centre_rate=(float(ux), float(uy)), moment=float(moment),
        swirl=float(swirl),
    )  # fmt: skip
