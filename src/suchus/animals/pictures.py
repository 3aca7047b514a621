"""The frames of a film with their times: a video, a GIF, or a folder of pictures."""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from PIL import Image, ImageSequence, UnidentifiedImageError

from suchus.core.errors import UnreadableFile
from suchus.core.reading import check_file

PICTURES = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".webp")
"""Endings of the pictures that a folder may hold."""
MOVING = (".gif", ".webp", ".tif", ".tiff", ".png")
"""Endings of files of several pictures, which need no further library."""
VIDEOS = (".mp4", ".mov", ".avi", ".mkv", ".webm", ".m4v", ".mpg", ".mpeg", ".wmv")
"""Endings of videos, which the av library reads."""
_INSTALL = 'pip install "suchus[capture]"'


class FilmFrame(NamedTuple):
    """One frame of a film."""

    picture: Image.Image
    time: float | None
    """Time since the first frame [s]; None where the film does not say it."""


def is_film(path: Path) -> bool:
    """Return whether a path is a film by its ending, or a folder."""
    return path.is_dir() or path.suffix.lower() in (*MOVING, *VIDEOS)


def frames(film: Path) -> Iterator[FilmFrame]:
    """Yield the frames of a film.

    Args:
        film: a video, a GIF, or a folder of pictures in the order of their names.

    Raises:
        UnreadableFile: it is missing, damaged or of an unknown format, or the library for videos is not installed.
    """
    if film.is_dir():
        files = sorted(file for file in film.iterdir() if file.suffix.lower() in PICTURES)
        if not files:
            raise UnreadableFile(f"{film} holds no pictures ({', '.join(PICTURES)}).")
        for file in files:
            with _opened(file) as picture:
                yield FilmFrame(picture.copy(), None)
        return
    check_file(film)
    yield from _moving_frames(film) if film.suffix.lower() in MOVING else _video_frames(film)


def _moving_frames(film: Path) -> Iterator[FilmFrame]:
    """Yield the frames of a GIF or another file of several pictures; each says how long it is shown."""
    time: float | None = 0.0
    with _opened(film) as pictures:
        for frame in ImageSequence.Iterator(pictures):
            duration = frame.info.get("duration") or None  # [ms]; of the frame that is shown now
            yield FilmFrame(frame.copy(), time)
            time = time + duration / 1000.0 if time is not None and duration else None


def _video_frames(film: Path) -> Iterator[FilmFrame]:
    """Yield the frames of a video, by the av library."""
    try:
        import av  # noqa: PLC0415  an optional extra
    except ImportError as error:
        raise UnreadableFile(
            f"{film.name} is a video, which the av library reads; install it: {_INSTALL}; or give a folder of pictures."
        ) from error
    first: float | None = None
    try:
        with av.open(str(film)) as container:
            for frame in container.decode(video=0):
                if frame.time is not None and first is None:
                    first = frame.time
                time = None if frame.time is None or first is None else frame.time - first
                yield FilmFrame(frame.to_image(), time)
    except (OSError, ValueError, IndexError) as error:
        raise UnreadableFile(
            f"{film} cannot be read as a video: it is missing, damaged, or of a format that the av library does not "
            "know; convert it, or give a folder of pictures."
        ) from error


def _opened(file: Path) -> Image.Image:
    try:
        return Image.open(file)
    except (UnidentifiedImageError, OSError) as error:
        raise UnreadableFile(f"{file} cannot be read as a picture.") from error
