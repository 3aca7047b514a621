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
    centre_height: Float[np.ndarray, " station"]
    """Centre of the area above the axis [m]."""


class _Section(NamedTuple):
    """An ellipse for each shape at each station; its half axes are 0 where the shape is not."""

    y: np.ndarray
    z: np.ndarray
    half_width: np.ndarray
    half_height: np.ndarray


def profile(robot: Robot, station: Float[np.ndarray, " station"]) -> Profile:
    """Return the sections of a straight robot.

    Args:
        robot: the robot; its rods lie along the axis.
        station: distances of the sections from the tip of the snout [m].
    """
    shape_sections, start = [], 0.0
    for segment in robot.axis:
        origin = start + segment.front
        shape_sections += [_section(shape, origin - station) for shape in segment.shapes]
        start += segment.front + segment.rear
    section = _Section(*(np.stack(columns, axis=-1) for columns in zip(*shape_sections, strict=True)))
    half_width = (np.abs(section.y) + section.half_width).max(axis=-1, where=section.half_width > 0, initial=0.0)
    top = (section.z + section.half_height).max(axis=-1, where=section.half_width > 0, initial=-np.inf)
    bottom = (section.z - section.half_height).min(axis=-1, where=section.half_width > 0, initial=np.inf)
    top, bottom = np.where(half_width > 0, top, 0.0), np.where(half_width > 0, bottom, 0.0)
    # Gauss-Chebyshev: exact for an ellipse that fills the section
    angle = (np.arange(_LEVELS) + 0.5) * np.pi / _LEVELS
    z = (0.5 * (top + bottom))[:, None] + (0.5 * (top - bottom))[:, None] * np.cos(angle)
    weighted_width = _union_width(section, z) * np.sin(angle) * (np.pi / _LEVELS) * (0.5 * (top - bottom))[:, None]
    area = weighted_width.sum(axis=-1)
    center = np.divide((weighted_width * z).sum(axis=-1), area, out=np.zeros_like(area), where=area > 0)
    return Profile(half_width, 0.5 * (top - bottom), area, center)


def _section(shape: Rod | Shell, x: np.ndarray) -> _Section:
    """Return where planes at x, in the frame of its segment, cut a shape."""
    if isinstance(shape, Shell):
        round_ = np.sqrt(np.clip(1.0 - ((x - shape.at[0]) / shape.half[0]) ** 2, 0.0, None))
        unit_array = np.ones_like(x)
        return _Section(
            shape.at[1] * unit_array, shape.at[2] * unit_array, shape.half[1] * round_, shape.half[2] * round_
        )
    (x0, y0, z0), (x1, y1, z1) = sorted((shape.start, shape.end))
    fraction = np.clip((x - x0) / (x1 - x0), 0.0, 1.0) if x1 > x0 else np.full_like(x, 0.5)
    overshoot = np.maximum(np.maximum(x0 - x, x - x1), 0.0)
    reach = np.sqrt(np.clip(shape.radius**2 - overshoot**2, 0.0, None))
    return _Section(y0 + fraction * (y1 - y0), z0 + fraction * (z1 - z0), reach, reach)


def _union_width(section: _Section, height: np.ndarray) -> np.ndarray:
    """Return the width that the ellipses of a station cover together, gaps left out, shape (station, level) [m].

    Args:
        section: the ellipses, shape (station, ellipse).
        height: heights at which the width is measured, shape (station, level) [m].
    """
    half_height = np.where(section.half_height > 0, section.half_height, 1.0)[:, None, :]
    relative_half_chord_squared = 1.0 - ((height[:, :, None] - section.z[:, None, :]) / half_height) ** 2
    half_chord = np.where(
        section.half_height[:, None, :] > 0,
        section.half_width[:, None, :] * np.sqrt(np.clip(relative_half_chord_squared, 0.0, None)),
        0.0,
    )
    lower_edge, upper_edge = section.y[:, None, :] - half_chord, section.y[:, None, :] + half_chord
    order = np.argsort(lower_edge, axis=-1)
    lower_edge, upper_edge = np.take_along_axis(lower_edge, order, -1), np.take_along_axis(upper_edge, order, -1)
    covered_edge = np.maximum.accumulate(upper_edge, axis=-1)
    previous_edge = np.concatenate([np.full_like(lower_edge[..., :1], -np.inf), covered_edge[..., :-1]], axis=-1)
    return np.asarray(np.clip(upper_edge - np.maximum(lower_edge, previous_edge), 0.0, None).sum(axis=-1))


def stations(robot: Robot) -> Sequence[tuple[float, float]]:
    """Return where each segment of the axis begins and ends, from the tip of the snout [m]."""
    intervals, start = [], 0.0
    for segment in robot.axis:
        intervals.append((start, start + segment.front + segment.rear))
        start = intervals[-1][1]
    return intervals
