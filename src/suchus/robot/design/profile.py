"""The axis of a robot in cross-sections: how wide and high the union of its shapes is along the straight body."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.robot.design.body import Robot
from suchus.robot.design.segment import Rod, Shell

_LEVELS = 48
"""Levels at which the width of a section is measured [-]."""


class Profile(NamedTuple):
    """Sections of the axis, limbs left out."""

    half_width: Float[np.ndarray, " station"]
    """Farthest to a side [m]."""
    half_height: Float[np.ndarray, " station"]
    """Half from the lowest to the highest point [m]."""
    area: Float[np.ndarray, " station"]
    """Area of the union of the shapes [m2]."""
    middle: Float[np.ndarray, " station"]
    """Centre of the area above the axis [m]."""


class _Section(NamedTuple):
    """An ellipse for each shape at each station; its half axes are 0 where the shape is not."""

    y: np.ndarray
    z: np.ndarray
    wide: np.ndarray
    high: np.ndarray


def profile(robot: Robot, s: Float[np.ndarray, " station"]) -> Profile:
    """Return the sections of a straight robot.

    Args:
        robot: in the general form; its rods lie along the axis.
        s: from the tip of the snout [m].
    """
    placed, start = [], 0.0
    for segment in robot.axis:
        origin = start + segment.front
        placed += [_section(shape, origin - s) for shape in segment.shapes]
        start += segment.front + segment.rear
    part = _Section(*(np.stack(columns, axis=-1) for columns in zip(*placed, strict=True)))
    wide = (np.abs(part.y) + part.wide).max(axis=-1, where=part.wide > 0, initial=0.0)
    top = (part.z + part.high).max(axis=-1, where=part.wide > 0, initial=-np.inf)
    low = (part.z - part.high).min(axis=-1, where=part.wide > 0, initial=np.inf)
    top, low = np.where(wide > 0, top, 0.0), np.where(wide > 0, low, 0.0)
    # Gauss-Chebyshev: exact for an ellipse that fills the section
    angle = (np.arange(_LEVELS) + 0.5) * np.pi / _LEVELS
    z = (0.5 * (top + low))[:, None] + (0.5 * (top - low))[:, None] * np.cos(angle)
    length = _union(part, z) * np.sin(angle) * (np.pi / _LEVELS) * (0.5 * (top - low))[:, None]
    area = length.sum(axis=-1)
    middle = np.divide((length * z).sum(axis=-1), area, out=np.zeros_like(area), where=area > 0)
    return Profile(wide, 0.5 * (top - low), area, middle)


def _section(shape: Rod | Shell, x: np.ndarray) -> _Section:
    """Return where planes at x, in the frame of its segment, cut a shape."""
    if isinstance(shape, Shell):
        round_ = np.sqrt(np.clip(1.0 - ((x - shape.at[0]) / shape.half[0]) ** 2, 0.0, None))
        at = np.ones_like(x)
        return _Section(shape.at[1] * at, shape.at[2] * at, shape.half[1] * round_, shape.half[2] * round_)
    (x0, y0, z0), (x1, y1, z1) = sorted((shape.start, shape.end))
    along = np.clip((x - x0) / (x1 - x0), 0.0, 1.0) if x1 > x0 else np.full_like(x, 0.5)
    beyond = np.maximum(np.maximum(x0 - x, x - x1), 0.0)
    reach = np.sqrt(np.clip(shape.radius**2 - beyond**2, 0.0, None))
    return _Section(y0 + along * (y1 - y0), z0 + along * (z1 - z0), reach, reach)


def _union(part: _Section, z: np.ndarray) -> np.ndarray:
    """Return how wide the union of the ellipses is at heights z, shape (station, level)."""
    high = np.where(part.high > 0, part.high, 1.0)[:, None, :]
    inside = 1.0 - ((z[:, :, None] - part.z[:, None, :]) / high) ** 2
    half = np.where(part.high[:, None, :] > 0, part.wide[:, None, :] * np.sqrt(np.clip(inside, 0.0, None)), 0.0)
    left, right = part.y[:, None, :] - half, part.y[:, None, :] + half
    order = np.argsort(left, axis=-1)
    left, right = np.take_along_axis(left, order, -1), np.take_along_axis(right, order, -1)
    reached = np.maximum.accumulate(right, axis=-1)
    before = np.concatenate([np.full_like(left[..., :1], -np.inf), reached[..., :-1]], axis=-1)
    return np.asarray(np.clip(right - np.maximum(left, before), 0.0, None).sum(axis=-1))


def stations(robot: Robot) -> Sequence[tuple[float, float]]:
    """Return where each segment of the axis begins and ends, from the tip of the snout [m]."""
    found, start = [], 0.0
    for segment in robot.axis:
        found.append((start, start + segment.front + segment.rear))
        start = found[-1][1]
    return found
