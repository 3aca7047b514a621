"""Motion of the ground in the picture: a camera that follows the animal, or a belt under it.

A foot that stands rests on the ground, so that its velocity in the picture is the ground's. All feet that stand show
the same one; a foot that slips shows another than its neighbours.
"""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.animals.capture.feet import forward_path
from suchus.animals.capture.swings import stance_intervals
from suchus.animals.capture.tracks import Tracks

_MIN_FRAMES = 5  # least frames of a stance with a velocity
_MIN_STANCES = 6  # least stances of all feet together
_MIN_FEET = 3  # least feet
_MIN_SPEED = 0.06  # velocity of the ground over that of the animal on it, from which on the camera moves
_MAX_SPREAD = 0.35  # greatest difference between feet over the velocity of the ground: else feet slip
_MIN_Z_SCORE = 5.0  # velocity of the ground that is significant [standard error]
_Z_95 = 1.96  # standard errors in half a 95 % interval


class GroundMotion(NamedTuple):
    """Tracks over ground at rest."""

    tracks: Tracks
    """The keypoints, less the motion of the ground in the picture."""
    error: float
    """Half width of the 95 % interval of the ground's velocity, 0 for a camera at rest [m/s or px/s]."""
    notes: tuple[str, ...]
    """That the ground moves in the picture, and how fast; empty for a camera at rest."""


def rest_ground(tracks: Tracks, period: float) -> GroundMotion:
    """Return tracks over ground at rest: corrected if standing feet show that the ground moves in the picture.

    Args:
        tracks: without faults.
        period: of the cycle, roughly [s].
    """
    times, velocities, weights, legs = _stance_velocities(tracks, period)
    if len(times) < _MIN_STANCES or len(set(legs)) < _MIN_FEET:
        return GroundMotion(tracks, 0.0, ())
    mean = np.average(velocities, axis=0, weights=weights)
    speed = float(np.linalg.norm(mean))
    foot_means = np.array([np.median(velocities[np.array(legs) == leg], axis=0) for leg in sorted(set(legs))])
    spread = float(np.linalg.norm(np.ptp(foot_means, axis=0))) / 2
    deviation = velocities - mean
    error = float(np.sqrt(np.sum(weights[:, None] * deviation**2) / np.sum(weights) / (len(times) - 1)))
    trunk = tracks.at(tracks.line[1])[:, :2]
    seen_frames = np.flatnonzero(np.isfinite(trunk).all(axis=1))
    body_velocity = (trunk[seen_frames[-1]] - trunk[seen_frames[0]]) / (
        tracks.time[seen_frames[-1]] - tracks.time[seen_frames[0]]
    )
    animal_speed = float(np.linalg.norm(body_velocity - mean))
    if speed < _MIN_SPEED * animal_speed or speed < _MIN_Z_SCORE * error or spread > _MAX_SPREAD * speed:
        return GroundMotion(tracks, 0.0, ())
    course = _ground_course(tracks.time, times, velocities, period)
    position = tracks.position.copy()
    position[..., :2] -= course[:, None]
    corrected_tracks = Tracks(
        time=tracks.time,
        points=tracks.points,
        position=position,
        unit=tracks.unit,
        source=tracks.source,
        view=tracks.view,
    )
    note = (
        f"standing feet move in the picture by {speed:.3g} {tracks.unit}/s, {100 * speed / animal_speed:.0f} % of the "
        "animal's speed: the camera follows it, or it walks on a belt; positions are corrected by that, and intervals "
        "hold its uncertainty"
    )
    return GroundMotion(corrected_tracks, _Z_95 * error, (note,))


def _stance_velocities(
    tracks: Tracks, period: float
) -> tuple[Float[np.ndarray, " stance"], Float[np.ndarray, "stance 2"], Float[np.ndarray, " stance"], list[str]]:
    """Return the middle of each stance [s], the foot's velocity in it [m/s or px/s], a weight, and the leg."""
    times, velocities, weights, legs = [], [], [], []
    for leg in tracks.legs:
        place = tracks.at(leg)[:, :2]
        is_seen = np.isfinite(place).all(axis=1)
        for start, end in stance_intervals(tracks.time, forward_path(tracks, leg), period):
            use = is_seen & (tracks.time >= start) & (tracks.time <= end)
            if use.sum() < _MIN_FRAMES:
                continue
            t = tracks.time[use] - tracks.time[use].mean()
            velocities.append(t @ place[use] / (t @ t))
            times.append(float(tracks.time[use].mean()))
            weights.append(float(t @ t))
            legs.append(leg)
    return np.array(times), np.array(velocities).reshape(-1, 2), np.array(weights), legs


def _ground_course(
    time: Float[np.ndarray, " frame"], times: np.ndarray, velocities: np.ndarray, period: float
) -> Float[np.ndarray, "frame 2"]:
    """Return how far the ground has moved in each frame, from the velocities in stances, smoothed over a cycle."""
    weight = np.exp(-0.5 * ((time[:, None] - times) / (period / 2)) ** 2) + 1e-6
    velocity = weight @ velocities / weight.sum(axis=1, keepdims=True)
    steps = (velocity[1:] + velocity[:-1]) / 2 * np.diff(time)[:, None]
    return np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)])
