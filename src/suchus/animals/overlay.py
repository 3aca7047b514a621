"""Skeleton and foot contacts, drawn on the frames of the film that the keypoints are from."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.animals.capture import Tracks, UnusableTracks
from suchus.animals.pictures import frames
from suchus.visual.figures.film import film
from suchus.visual.figures.style import COLOURS

_MAX_FRAMES = 120  # frames that are drawn
_FILM_WIDTH = 720  # [px]; of the film that is drawn


def overlay(tracks: Tracks, strides: xr.Dataset, faulty_keypoints: Sequence[str], video: Path) -> bytes:
    """Return the film with what was tracked drawn on it, as the bytes of a GIF.

    The midline is a line through its keypoints. A foot is full while it stands, hollow while it swings, and grey where
    that is not known. A keypoint that is not to be trusted is a red cross.

    Args:
        tracks: tracks as they were read, in pixels.
        strides: strides of the walk, with ``lift_off`` and ``touch_down``.
        faulty_keypoints: keypoints that are not to be trusted.
        video: a video, a GIF, or a folder of pictures in the order of their names; a frame for every row of the tracks.

    Raises:
        UnusableTracks: the tracks are not in pixels, or have another number of frames than the video.
        UnreadableFile: the video cannot be read.
    """
    if tracks.unit != "px":
        raise UnusableTracks(
            f"{tracks.source} is in metres, so that it is not known where in the picture its points are; --video needs "
            "keypoints in pixels."
        )
    count, source_pictures = len(tracks.time), []
    step = -(-count // _MAX_FRAMES)
    frame_count = 0
    for i, frame in enumerate(frames(video)):
        frame_count = i + 1
        if i < count and i % step == 0:
            source_pictures.append(frame.picture.convert("RGB"))
    if frame_count != count:
        raise UnusableTracks(
            f"{video} has {frame_count} frames and {tracks.source} {count}; they must be of the same film, frame by "
            "frame."
        )
    scale = min(1.0, _FILM_WIDTH / source_pictures[0].width)
    size = (round(scale * source_pictures[0].width), round(scale * source_pictures[0].height))
    pictures = [np.asarray(picture.resize(size)) for picture in source_pictures]
    place = tracks.position[::step, :, :2] * np.array([1.0, -1.0]) * scale
    figure, show = _drawing(
        tracks, pictures, place, _stands(tracks.time[::step], tracks.legs, strides), faulty_keypoints
    )
    seconds = float(tracks.time[-1] - tracks.time[0])
    caption = f"{tracks.source} on {video.name}: full feet stand, hollow feet swing, crosses are not to be trusted"
    return film(figure, show, len(pictures), seconds=seconds, caption=caption)


def _drawing(
    tracks: Tracks,
    pictures: list[np.ndarray],
    place: np.ndarray,
    stands: dict[str, np.ndarray],
    faulty_keypoints: Sequence[str],
) -> tuple[Figure, Any]:
    """Return a figure of the first frame, and the function that draws frame i into it.

    Args:
        tracks: the keypoints.
        pictures: frames of the video, shape (height, width, 3) each.
        place: positions of the keypoints, shape (frame, point, 2) [px].
        stands: stance by foot, 1 in stance, 0 in swing, NaN where it is not known.
        faulty_keypoints: keypoints that are drawn as crosses.
    """
    height, width = pictures[0].shape[:2]
    figure = Figure(figsize=(width / 100, height / 100), dpi=100)
    ax = figure.add_axes((0, 0, 1, 1))
    ax.axis("off")
    ax.set_autoscale_on(False)
    ax.set_xlim(-0.5, width - 0.5)
    ax.set_ylim(height - 0.5, -0.5)
    background = ax.imshow(pictures[0], aspect="auto")
    chain = [tracks.points.index(name) for name in tracks.midline if name not in faulty_keypoints]
    bad = [tracks.points.index(name) for name in tracks.points if name in faulty_keypoints]
    key: dict[str, Any]
    edge: dict[str, Any] = {"markeredgewidth": 1.2, "markersize": 4}
    (spine,) = ax.plot([], [], color="white", linewidth=3.2)
    (line,) = ax.plot([], [], color=COLOURS["spine"], linewidth=1.8, marker="o", markeredgecolor="white", **edge)
    (crosses,) = ax.plot([], [], color=COLOURS["alarm"], linestyle="none", marker="x", markersize=8, markeredgewidth=2)
    feet = {
        leg: ax.plot([], [], linestyle="none", marker="o", markersize=10, markeredgewidth=2.2)[0]
        for leg in tracks.legs
        if leg not in faulty_keypoints
    }

    key = {"transform": ax.transAxes, "marker": "o", "markersize": 8, "markeredgewidth": 2.2, "clip_on": False}
    for j, leg in enumerate(feet):  # also puts their colours into the palette, which the first frame makes
        ax.plot(0.03 + 0.08 * j, 0.04, color=COLOURS[leg], **key)
        ax.text(0.045 + 0.08 * j, 0.04, leg, transform=ax.transAxes, va="center", color=COLOURS[leg], weight="bold")
    if bad:
        ax.plot(0.03 + 0.08 * len(feet), 0.04, color=COLOURS["alarm"], **(key | {"marker": "x"}))

    def show(i: int) -> None:
        """Draw the picture, the midline and the feet of frame i."""
        background.set_data(pictures[i])
        for artist in (spine, line):
            artist.set_data(place[i, chain, 0], place[i, chain, 1])
        crosses.set_data(place[i, bad, 0], place[i, bad, 1])
        for leg, mark in feet.items():
            index = tracks.points.index(leg)
            mark.set_data([place[i, index, 0]], [place[i, index, 1]])
            stance = stands[leg][i]
            colour = COLOURS[leg] if np.isfinite(stance) else COLOURS["neutral"]
            mark.set_markeredgecolor(colour)
            mark.set_markerfacecolor(colour if stance == 1 else "none")

    return figure, show


def _stands(time: np.ndarray, legs: Sequence[str], strides: xr.Dataset) -> dict[str, np.ndarray]:
    """Return whether each foot stands in each frame: 1, 0, or NaN where it is not known."""
    stances = {leg: np.full(len(time), np.nan) for leg in legs}
    for leg in legs:
        if "lift_off" not in strides or leg not in strides.leg.values:
            continue
        lift_off, touch_down = (strides[name].sel(leg=leg).values for name in ("lift_off", "touch_down"))
        is_complete = np.isfinite(lift_off) & np.isfinite(touch_down)
        lift_off, touch_down = lift_off[is_complete], touch_down[is_complete]
        if len(lift_off):
            stances[leg][(time >= lift_off[0]) & (time <= touch_down[-1])] = 1.0
            for start, end in zip(lift_off, touch_down, strict=True):
                stances[leg][(time >= start) & (time < end)] = 0.0
    return stances
