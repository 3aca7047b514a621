"""Colours: dark above, pale below, bands across flanks and tail."""

from collections.abc import Callable

import numpy as np

BACK = np.array([0.300, 0.325, 0.195])
FLANK = np.array([0.510, 0.505, 0.300])
BELLY = np.array([0.865, 0.820, 0.650])
BAND = np.array([0.205, 0.220, 0.135])
SCUTE = np.array([0.235, 0.255, 0.155])
MOUTH = np.array([0.780, 0.520, 0.430])
TOOTH = np.array([0.960, 0.940, 0.860])
EYE = np.array([0.830, 0.640, 0.160])
PUPIL = np.array([0.045, 0.045, 0.035])
CLAW = np.array([0.130, 0.120, 0.095])
SOLE = np.array([0.370, 0.365, 0.250])


def smooth(value: np.ndarray, lower_bound: float, upper_bound: float) -> np.ndarray:
    """Return a smooth step from 0 at ``low`` to 1 at ``high``."""
    t = np.clip((value - lower_bound) / (upper_bound - lower_bound), 0.0, 1.0)
    return t * t * (3 - 2 * t)


def mix_colours(a: np.ndarray, b: np.ndarray, fraction: np.ndarray) -> np.ndarray:
    """Return colours between two, (n, 3)."""
    return a + fraction[:, None] * (b - a)


def hide_colours(level: np.ndarray, axial_position: np.ndarray, lateral_distance: np.ndarray) -> np.ndarray:
    """Return the hide's colours.

    Args:
        level: height on the body's section, from -1 at the belly to 1 on the back.
        axial_position: place along the body over its length.
        lateral_distance: distance from the midline over the length; left and right are alike.
    """
    colour = mix_colours(BELLY, FLANK, smooth(level, -0.55, -0.05))
    colour = mix_colours(colour, BACK, smooth(level, 0.10, 0.85))
    wave = np.sin(2 * np.pi * 19 * axial_position + 0.8 * np.sin(41 * axial_position) + 3.0 * level)
    colour = mix_colours(colour, BAND, 0.62 * smooth(wave, 0.15, 0.75) * smooth(level, -0.35, 0.15))
    spots = np.sin(173 * axial_position) * np.cos(191 * lateral_distance) + 0.6 * np.sin(
        117 * axial_position + 143 * lateral_distance
    )
    return np.clip(colour * (1 + 0.055 * spots[:, None]), 0.0, 1.0)


def hide(level: np.ndarray, length: float) -> Callable[[np.ndarray], np.ndarray]:
    """Return the paint of the body, by each vertex's height on its section."""
    return lambda points: hide_colours(level, points[:, 0] / length, np.abs(points[:, 1]) / length)


def jaw_paint(level: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Return the paint of the lower jaw: mouth inside, hide at the rim, pale below."""

    def paint(points: np.ndarray) -> np.ndarray:
        hide_colour = mix_colours(BELLY, FLANK, smooth(level, -0.5, 0.35))
        del points
        return mix_colours(hide_colour, MOUTH, smooth(level, 0.55, 0.8))

    return paint


def brow(points: np.ndarray) -> np.ndarray:
    """Return the paint of the brows."""
    return np.broadcast_to(BACK, points.shape)
