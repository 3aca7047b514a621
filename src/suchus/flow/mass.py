"""Volume, centre and moments of a body's shape, and the momentum of its deformation."""

from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True, slots=True, kw_only=True)
class Mass:
    """Mass and moments of inertia of a body of density 1, in its own frame; in the plane per metre of depth."""

    volume: float
    """Volume; in the plane the area of the cross-section [m^3, m^2]."""
    centre: tuple[float, ...]
    """Centre of the volume, along each axis [m]."""
    centre_rate: tuple[float, ...]
    """Velocity that the deformation gives to the centre, along each axis [m/s]."""
    moments: np.ndarray
    """Tensor of inertia of the volume about the centre: about z alone in the plane, shape (1, 1), else (3, 3) [m^4,
    m^5]."""
    swirl: tuple[float, ...]
    """Angular momentum of the deformation about the centre: about z in the plane, else about x, y and z [m^4/s,
    m^5/s]."""

    @property
    def _axes(self) -> int:
        return len(self.centre)

    def inertia(self, matrix: np.ndarray) -> np.ndarray:
        """Return the mass matrix over the density for motions along and about the world's axes.

        The shape is (3, 3) in the plane and (6, 6) in space.

        Args:
            matrix: rotation matrix from the body's frame to the world's, shape (3, 3).
        """
        ndim, turns = self._axes, len(self.swirl)
        turn = matrix[-turns:, -turns:]
        inertia_matrix = np.zeros((ndim + turns, ndim + turns))
        inertia_matrix[:ndim, :ndim], inertia_matrix[ndim:, ndim:] = (
            self.volume * np.eye(ndim),
            turn @ self.moments @ turn.T,
        )
        return inertia_matrix

    def recoil(self, matrix: np.ndarray) -> np.ndarray:
        """Return the velocity that the deformation takes from the frame: 0 along each axis, then the angular velocity.

        Args:
            matrix: rotation matrix from the body's frame to the world's, shape (3, 3).
        """
        turns = len(self.swirl)
        return np.concatenate(
            [np.zeros(self._axes), matrix[-turns:, -turns:] @ np.linalg.solve(self.moments, self.swirl)]
        )


def tensor(second: np.ndarray) -> np.ndarray:
    """Return the tensor of inertia from the integrals of the products of coordinates, each of shape (3, 3) [m^5]."""
    inertia_tensor: np.ndarray = np.trace(second) * np.eye(3) - second
    return inertia_tensor


def of_outline(x: np.ndarray, y: np.ndarray) -> Mass:
    """Return the mass of a rigid polygon, counter-clockwise [m].

    Args:
        x: coordinates of the corners [m].
        y: coordinates of the corners [m].
    """
    p, q = np.roll(x, -1), np.roll(y, -1)
    cross = x * q - p * y
    area = float(cross.sum() / 2)
    cx, cy = float(((x + p) * cross).sum() / (6 * area)), float(((y + q) * cross).sum() / (6 * area))
    polar = float((((x * x + x * p + p * p) + (y * y + y * q + q * q)) * cross).sum() / 12)
    moment = polar - area * (cx**2 + cy**2)
    return Mass(
        volume=area, centre=(cx, cy), centre_rate=(0.0, 0.0), moments=np.array([[moment]]), swirl=(0.0,)
    )  # fmt: skip


def of_midline(spine: np.ndarray) -> Mass:
    """Return the mass of a body from the rows of its midline.

    Each cross-section is a rod; where the midline bends, the outer half of the rod weighs more than the inner half.

    Args:
        spine: rows x, y, heading, half-width and the rates of x, y and heading, at the stations [m, rad, s].
    """
    w = (spine[3, 1:] + spine[3, :-1]) / 2
    area, centre, rate, (moment, *_), swirl = _of_sections(spine, 2 * w, 2 * w**3 / 3)
    return Mass(volume=area, centre=centre, centre_rate=rate, moments=np.array([[moment]]), swirl=(swirl,))


def of_trunk(spine: np.ndarray, half_height: np.ndarray) -> Mass:
    """Return the mass of a body with elliptic sections from the rows of its midline.

    Args:
        spine: rows of the midline; see ``of_midline``.
        half_height: half height of the sections at the stations [m].
    """
    w, h = (spine[3, 1:] + spine[3, :-1]) / 2, (half_height[1:] + half_height[:-1]) / 2
    volume, centre, rate, (moment, xx, xy), swirl = _of_sections(spine, np.pi * w * h, np.pi * w**3 * h / 4)
    zz = float((np.pi * w * h**3 / 4 * np.hypot(np.diff(spine[0]), np.diff(spine[1]))).sum())
    second = np.array([[xx, xy, 0.0], [xy, moment - xx, 0.0], [0.0, 0.0, zz]])
    return Mass(
        volume=volume, centre=(*centre, 0.0), centre_rate=(*rate, 0.0), moments=tensor(second), swirl=(0.0, 0.0, swirl)
    )


def _of_sections(spine: np.ndarray, size: np.ndarray, second: np.ndarray) -> tuple[Any, ...]:
    """Return size, centre, its rate, moments and swirl of sections between the stations.

    The moments are that about the centre, and the integrals of x^2 and x y from there.

    Args:
        spine: rows of the midline; see ``of_midline``.
        size: size of each section: its length or area.
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
    xx = (dx**2 * slice_size).sum() + (nx**2 * slice_moment).sum() + 2 * (dx * nx * lean).sum()
    xy = (dx * dy * slice_size).sum() + (nx * ny * slice_moment).sum() + ((dx * ny + dy * nx) * lean).sum()
    moments = float(moment), float(xx), float(xy)
    return float(total), (float(cx), float(cy)), (float(ux), float(uy)), moments, float(swirl)
