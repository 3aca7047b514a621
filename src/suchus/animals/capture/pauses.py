"""Pauses of an animal that stops: the longest walk without one is measured."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float
from scipy.ndimage import median_filter

from suchus.animals.capture.tracks import Tracks

_WINDOW = 0.015  # [film]; time over which displacements are taken
_STEADY_FRAMES, _MAX_WINDOW = 8, 0.03  # the same in a short film: frames over which noise is small, at most [film]
_MOVING_POINTS = 85.0  # percentile of the keypoints' displacements: in a cycle some keypoint always moves
_WALK_PERCENTILE = 80.0  # of this over the film: the displacement of a walk
_MAX_REST, _MIN_WALK = 0.15, 0.5  # displacement over that of the walk: at rest, and at the ends of a walk
_MIN_PAUSE = 0.05  # [film]; shorter rests belong to the gait
_LONGER = 2.0  # length of a pause over that of the longest other rest: rests that recur belong to the gait
_ALWAYS = 0.3  # [film]; a longer rest is a pause in any case
_MIN_FRAMES = 8  # the same in frames
_MAX_INTERRUPTION = 3  # frames; a shorter movement within a rest is noise
_JUMP_WINDOW = 5  # frames of the median that leaves out jumps
_NOISE_FACTOR = 1.8  # greatest speed at rest over the one that noise makes
_MAX_NOISY_REST = 0.35  # greatest such speed over that of the walk
_MEDIAN_EFFICIENCY = 0.8  # variance of averaged noise over the same behind a median of five frames
_NOISE_LENGTH = {2: 1.95, 3: 2.31}  # length of a vector of noise that 85 % stay below, in standard deviations, by axes


class Bout(NamedTuple):
    """A stretch in which an animal walks."""

    tracks: Tracks
    """Frames of the stretch."""
    notes: tuple[str, ...]
    """Where the animal stands, and what is measured; empty if it walks throughout."""


def longest_bout(tracks: Tracks) -> Bout:
    """Return the longest stretch of tracks in which the animal does not pause; all of them if it never does."""
    activity, noise = _activity(tracks)
    if not len(activity):
        return Bout(tracks, ())
    usual_activity = float(np.nanpercentile(activity, _WALK_PERCENTILE))
    min_frames = max(_MIN_FRAMES, _MIN_PAUSE * len(activity))
    max_rest = max(_MAX_REST * usual_activity, min(_NOISE_FACTOR * noise, _MAX_NOISY_REST * usual_activity))
    rests = _joined_runs(_runs(activity < max_rest))
    lengths = np.array([end - start for start, end in rests])
    pauses = [
        run
        for i, run in enumerate(rests)
        if lengths[i] >= _ALWAYS * len(activity)
        or (lengths[i] >= min_frames and lengths[i] > _LONGER * np.max(np.delete(lengths, i), initial=0))
    ]
    if not pauses or usual_activity <= 0.0:
        return Bout(tracks, ())
    edges = [0, *(frame for pause in pauses for frame in pause), len(activity)]
    start, end = max(zip(edges[::2], edges[1::2], strict=True), key=lambda bout: bout[1] - bout[0])
    walking = np.flatnonzero(activity[start:end] > _MIN_WALK * usual_activity)
    if not len(walking):
        return Bout(tracks, ())
    first_frame, last_frame = (
        start + int(walking[0]) * (start > 0),
        (start + int(walking[-1]) if end < len(activity) else end - 1),
    )
    pause_text = ", ".join(f"{tracks.time[a]:.2f} to {tracks.time[b - 1]:.2f} s" for a, b in pauses)
    note = (
        f"the animal stands from {pause_text}: measured is its longest walk, from {tracks.time[first_frame]:.2f} to "
        f"{tracks.time[last_frame]:.2f} s; --start and --end choose another"
    )
    return Bout(tracks.between(float(tracks.time[first_frame]), float(tracks.time[last_frame])), (note,))


def _activity(tracks: Tracks) -> tuple[Float[np.ndarray, " frame"], float]:
    """Return the speed of the keypoints in a short time about each frame, and what noise makes of it [m/s or px/s].

    The first is empty in too short a film.
    """
    frames = len(tracks.time)
    half = max(2, round(max(_WINDOW * frames, min(_STEADY_FRAMES, _MAX_WINDOW * frames))))
    if frames < 20 * half:
        return np.zeros(0), 0.0
    place = np.full_like(tracks.position, np.nan)
    noises = []
    for index in np.ndindex(*place.shape[1:]):
        series = tracks.position[:, *index]
        is_seen = np.isfinite(series)
        if is_seen.mean() > 0.5:
            filled_series = np.interp(tracks.time, tracks.time[is_seen], series[is_seen])
            deviation = np.abs(filled_series[1:-1] - _neighbour_mean(filled_series))
            noises.append(1.4826 * float(np.median(deviation)) / np.sqrt(1.5))
            filled_series = median_filter(filled_series, _JUMP_WINDOW, mode="nearest")
            padded_series = np.pad(filled_series, half // 2, mode="edge")
            place[:, *index] = np.convolve(padded_series, np.ones(2 * (half // 2) + 1), mode="valid") / (
                2 * (half // 2) + 1
            )
    place = place[:, np.isfinite(place).all(axis=(0, 2))]
    if not place.shape[1]:
        return np.zeros(0), 0.0
    next_frames, previous_frames = (
        np.minimum(np.arange(frames) + half, frames - 1),
        np.maximum(np.arange(frames) - half, 0),
    )
    steps = float(np.median(np.diff(tracks.time)))
    speed = (
        np.linalg.norm(place[next_frames] - place[previous_frames], axis=-1)
        / (tracks.time[next_frames] - tracks.time[previous_frames])[:, None]
    )
    weights = np.convolve(np.ones(_JUMP_WINDOW) / _JUMP_WINDOW, np.ones(2 * (half // 2) + 1) / (2 * (half // 2) + 1))
    smoothed_noise = float(np.median(noises)) * np.sqrt(2.0 * np.sum(weights**2) / _MEDIAN_EFFICIENCY)
    noise_speed = _NOISE_LENGTH[place.shape[-1]] * smoothed_noise / (2 * half * steps)
    return np.asarray(np.percentile(speed, _MOVING_POINTS, axis=1)), noise_speed


def _neighbour_mean(series: Float[np.ndarray, " frame"]) -> Float[np.ndarray, " frame"]:
    """Return the mean of the frames before and behind each frame but the first and the last."""
    return (series[2:] + series[:-2]) / 2


def _joined_runs(runs: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Return runs of frames at rest, those joined that a few frames part which are shorter than both."""
    joined: list[tuple[int, int]] = []
    for start, end in runs:
        if joined:
            first_start, first_end = joined[-1]
            gap = start - first_end
            if gap <= min(_MAX_INTERRUPTION, first_end - first_start, end - start):
                joined[-1] = first_start, end
                continue
        joined.append((start, end))
    return joined


def _runs(mask: Bool[np.ndarray, " frame"]) -> list[tuple[int, int]]:
    """Return the first frame of each run of true values, and the frame after its last."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]])))
    return [(int(start), int(end)) for start, end in zip(edges[::2], edges[1::2], strict=True)]
