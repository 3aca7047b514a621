"""A page on which a person clicks the points of a film frame by frame: a film in, the table of ``capture`` out."""

from base64 import b64encode
from collections.abc import Iterator
from hashlib import sha256
from io import BytesIO
from pathlib import Path
from typing import NamedTuple

from PIL import Image

from suchus.animals.capture import UnusableTracks
from suchus.animals.capture.tracks import GAIT_KEYPOINTS
from suchus.animals.pictures import MOVING, VIDEOS, FilmFrame, frames, is_film
from suchus.robot.design import LEGS
from suchus.visual.pages import embed_json, render

POINTS = ("snout", "neck", "shoulder", "hip", "tail_base", "tail_tip", *LEGS)
"""Points that a page offers at first; more are added on it."""
MIN_FRAMES = 2
"""Number of frames that make a film [-]."""
MAX_FRAMES = 1500
"""Number of frames on one page [-]."""
MAX_SIZE = 80_000_000
"""Size of a page at most [byte]; browsers open larger ones slowly."""
KEY_DIGITS = 16
"""Digits of the digest by which a browser knows a film again [-]."""
_MAX_WIDTH = 1280  # of a frame on the page [px]; a click on a smaller picture is as exact as a hand
_QUALITY = 85  # of the compressed frames [%]


class _Shot(NamedTuple):
    """A frame on the page."""

    time: float  # [s]
    picture: Image.Image


def digitising_page(
    film: Path, *, rate: float | None = None, start: float | None = None, end: float | None = None, every: int = 1
) -> str:
    """Return one HTML page on which points are clicked on the frames of a film; it saves a plain table in pixels.

    Args:
        film: a video, a GIF, or a folder of pictures in the order of their names.
        rate: frames per second [Hz]; None: as the film says.
        start: time before which frames are left out [s].
        end: time after which frames are left out [s].
        every: the page has every so many-th frame of the film, 1 or more [-].

    Raises:
        UnreadableFile: the film cannot be read.
        UnusableTracks: it does not say its times and no rate is given, or has too few or too many frames.
    """
    if film.exists() and not is_film(film):
        raise UnusableTracks(
            f"{film} is no film; a video ({', '.join(VIDEOS)}), a file of several pictures ({', '.join(MOVING)}) or a "
            "folder of pictures is needed."
        )
    if every < 1:
        raise UnusableTracks(f"every is {every}; 1 (every frame) or more is needed.")
    if rate is not None and not rate > 0.0:
        raise UnusableTracks(f"the frame rate is {rate:g} frames per second; it must be above 0.")
    shots, scale = list[tuple[float, str]](), 1.0
    size, digest, total = (0, 0), sha256(), 0
    for time, picture in _chosen(film, rate, start, end, every):
        if size == (0, 0):
            size = picture.size
            scale = min(1.0, _MAX_WIDTH / size[0])
        elif picture.size != size:
            raise UnusableTracks(
                f"{film} has frames of {_shape(size)} and of {_shape(picture.size)} pixels; all must be of one size."
            )
        data = _compressed(picture, scale)
        digest.update(data)
        total += len(data) * 4 // 3
        if len(shots) == MAX_FRAMES or total > MAX_SIZE:
            raise UnusableTracks(
                f"{film} has more frames than one page holds ({MAX_FRAMES}, or {MAX_SIZE / 1e6:g} MB); say --every 2, "
                "or --start and --end."
            )
        shots.append((round(time, 6), b64encode(data).decode("ascii")))
    if len(shots) < MIN_FRAMES:
        raise UnusableTracks(f"{film} has {len(shots)} frame to click on; at least {MIN_FRAMES} are needed.")
    facts = {
        "film": film.name,
        "key": f"suchus {digest.hexdigest()[:KEY_DIGITS]}",
        "size": size,
        "times": [time for time, _ in shots],
        "points": POINTS,
        "needed": GAIT_KEYPOINTS,
    }
    title, pictures = f"{film.name}: click the points", embed_json([picture for _, picture in shots])
    return render("digitise.html", title=title, film=film.name, facts=embed_json(facts), pictures=pictures)


def _chosen(film: Path, rate: float | None, start: float | None, end: float | None, every: int) -> Iterator[_Shot]:
    """Yield every so many-th frame between two times, with its time."""
    for i, frame in enumerate(frames(film)):
        time = _time(film, frame, i, rate)
        if end is not None and time > end + 1e-9:
            return
        if i % every == 0 and (start is None or time >= start - 1e-9):
            yield _Shot(time, frame.picture)


def _time(film: Path, frame: FilmFrame, index: int, rate: float | None) -> float:
    """Return the time of a frame since the first [s]: by the rate if it is given, else as the film says."""
    if rate is not None:
        return index / rate
    if frame.time is None:
        raise UnusableTracks(
            f"{film} does not say the times of its frames; give their rate, as in --fps 25."
        )  # fmt: skip
    return frame.time


def _compressed(picture: Image.Image, scale: float) -> bytes:
    """Return a picture as the bytes of a JPEG."""
    shown = picture.convert("RGB")
    if scale < 1.0:
        shown = shown.resize((round(scale * shown.width), round(scale * shown.height)))
    data = BytesIO()
    shown.save(data, "jpeg", quality=_QUALITY)
    return data.getvalue()


def _shape(size: tuple[int, int]) -> str:
    """Return width and height [px] as a text."""
    width, height = size
    return f"{width} x {height}"
