"""The surface on which an animal walks: ground, slope, wall or ceiling, turned so that it lies level.

All feet step on one surface, so that their positions lie in a plane (in a line, seen from the side). The trunk is on
the animal's side of it. Strides, sides and heights are those over that surface, whichever way it lies.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.animals.capture.tracks import Tracks

MAX_LEVEL_SLOPE = np.radians(10.0)
"""Slope up to which a surface counts as level: there cos is 0.985, and what is over the ground is as long [rad]."""
_MIN_POSITIONS = 30  # least positions of feet, of two legs at least
_MIN_FLATNESS = 2.5  # least ratio of the feet's spread in the surface to that across it
_ROUNDS, _OUTLIER = 3, 4.0  # rounds of leaving out outliers; distance from the surface over the usual one
_MIN_FRACTION = 0.7  # least fraction of the feet's positions that lie in the surface
_MAX_REPEATED = 0.5  # greatest fraction of frames in which a foot is exactly where it was: a keypoint that is stuck
_MIN_HEIGHT = 0.03  # [extent of the feet]; a trunk that is nearer to the surface does not show its side


class ClimbedSurface(NamedTuple):
    """Tracks over a level surface."""

    tracks: Tracks
    """The keypoints, turned so that the surface lies level; as they are where it does, or where it cannot be seen."""
    slope: float
    """Angle of the surface against level, 0 to pi: pi/2 for a wall, pi for a ceiling [rad]."""
    notes: tuple[str, ...]
    """How the animal walks, and what lengths and heights count from; empty on level ground."""


def level_surface(tracks: Tracks) -> ClimbedSurface:
    """Return tracks over a level surface: turned if feet and trunk show that it slopes, stands or hangs.

    Args:
        tracks: with heights, or seen from the side; those from above show no slope and are returned as they are.
    """
    if tracks.view == "top" and not tracks.has_heights:
        return ClimbedSurface(tracks, 0.0, ())
    normal = _surface_normal(tracks)
    if normal is None:
        return ClimbedSurface(tracks, 0.0, ())
    slope = float(np.arccos(np.clip(normal[-1], -1.0, 1.0)))
    if slope <= MAX_LEVEL_SLOPE:
        return ClimbedSurface(tracks, 0.0, ())
    position = tracks.position @ _turn_to_last_axis(normal).T
    degrees = round(np.degrees(slope))
    axis = "y" if tracks.view == "side" else "z"
    posture = (
        f"hangs from a surface at {degrees} degrees against level, or {axis} points down in the file"
        if slope > np.radians(100.0)
        else f"climbs on a surface at {degrees} degrees against level"
    )
    note = (
        f"the feet show that the animal {posture}: lengths, heights and sides are those over that surface; weight does "
        "not act across it as on the ground"
    )
    return ClimbedSurface(replace(tracks, position=position), slope, (note,))


def _surface_normal(tracks: Tracks) -> Float[np.ndarray, " axis"] | None:
    """Return the direction across the surface on the animal's side; None where feet and trunk do not show it."""
    feet = [tracks.at(leg) for leg in tracks.legs if _steps(tracks.at(leg))]
    if len(feet) < 2:
        return None
    positions = np.concatenate(feet)
    positions = positions[np.isfinite(positions).all(axis=1)]
    seen_count = len(positions)
    for _ in range(_ROUNDS):
        if len(positions) < _MIN_POSITIONS:
            return None
        offsets = positions - np.median(positions, axis=0)
        _, spreads, axes = np.linalg.svd(offsets - offsets.mean(axis=0), full_matrices=False)
        normal = axes[-1]
        distance = np.abs(offsets @ normal - np.median(offsets @ normal))
        positions = positions[distance <= _OUTLIER * (1.4826 * np.median(distance)) + 1e-9 * spreads[0]]
    if spreads[-2] < _MIN_FLATNESS * spreads[-1] or len(positions) < _MIN_FRACTION * seen_count:
        return None
    height = _trunk_offset(tracks, feet) @ normal
    if not np.isfinite(height):
        return None
    if abs(height) < _MIN_HEIGHT * spreads[0] / np.sqrt(len(offsets)):
        up = 1.0 if normal[-1] >= 0.0 else -1.0  # nothing says that it hangs
        return np.asarray(up * normal) if abs(normal[-1]) > np.cos(MAX_LEVEL_SLOPE) else None
    return np.asarray(np.sign(height) * normal)


def _steps(place: Float[np.ndarray, "frame axis"]) -> bool:
    """Return whether a foot is seen to move; one that is stuck at a place shows no surface."""
    place = place[np.isfinite(place).all(axis=1)]
    return len(place) > 2 and float(np.mean((np.diff(place, axis=0) == 0.0).all(axis=1))) < _MAX_REPEATED


def _trunk_offset(tracks: Tracks, feet: list[np.ndarray]) -> Float[np.ndarray, " axis"]:
    """Return the median offset of the trunk's middle from the middle of the feet, frame by frame [m or px]."""
    trunk = np.stack([tracks.at(name) for name in tracks.line])
    offsets = _seen_mean(trunk) - _seen_mean(np.stack(feet))
    is_seen = np.isfinite(offsets).all(axis=1)
    return np.median(offsets[is_seen], axis=0) if is_seen.any() else np.full(offsets.shape[1], np.nan)


def _seen_mean(positions: Float[np.ndarray, "point frame axis"]) -> Float[np.ndarray, "frame axis"]:
    """Return the mean of the points that were seen in each frame; NaN where none was."""
    is_seen = np.isfinite(positions).all(axis=-1)
    total = np.where(is_seen[..., None], positions, 0.0).sum(axis=0)
    count = is_seen.sum(axis=0)[:, None]
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def _turn_to_last_axis(normal: Float[np.ndarray, " axis"]) -> Float[np.ndarray, "axis axis"]:
    """Return the rotation by the least angle that turns a direction to the last axis; a half turn is about the first.

    Left stays left, since it is no reflection.
    """
    if len(normal) == 2:  # from (x, y) to (0, 1)
        x, y = normal
        return np.array([[y, -x], [x, y]])
    up = np.array([0.0, 0.0, 1.0])
    cosine = float(normal @ up)
    if cosine < -1.0 + 1e-12:
        return np.diag([1.0, -1.0, -1.0])
    vx, vy, vz = np.cross(normal, up)
    skew = np.array([[0.0, -vz, vy], [vz, 0.0, -vx], [-vy, vx, 0.0]])
    return np.eye(3) + skew + skew @ skew / (1.0 + cosine)
