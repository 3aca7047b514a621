"""Marker files of motion capture: TRC, a text, and C3D, which the ``c3d`` library reads, an optional extra.

Both hold places in three dimensions, a unit and a rate, and do not say which axis is up: it is that of y and z along
which the trunk lies farther from the feet. An animal that climbs or hangs is turned later, see ``surface``.
"""

import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from suchus.animals.capture.poses import check_width
from suchus.animals.capture.tracks import UNITS, Tracks, UnusableTracks, map_keypoint_names
from suchus.core.errors import UnreadableFile
from suchus.core.reading import read_text
from suchus.robot.design import LEGS

SUFFIXES = (".trc", ".c3d")
"""How the names of marker files end."""
_HEADER = 5  # lines of a TRC file before its frames
_RATE_TOLERANCE = 0.02  # relative difference of the rate in the header from that of the frames' times
_INSTALL = 'pip install "suchus[capture]"'
_TRUNK = ("shoulder", "hip", "neck", "tail_base")


def read_markers(path: Path, *, names: Mapping[str, str]) -> Tracks:
    """Read a TRC or C3D file.

    Args:
        path: the file.
        names: our name of a keypoint by the file's, where they differ.

    Raises:
        UnreadableFile: the file is broken, its unit is not known, or the library that reads it is not installed.
        UnusableTracks: it holds no frames.
    """
    points, place, rate, unit, frame = _trc(path) if path.suffix.lower() == ".trc" else _c3d(path)
    if unit not in UNITS or unit == "px":
        raise UnreadableFile(f"{path.name} has lengths in {unit!r}; m, cm and mm are known.")
    if not len(place):
        raise UnusableTracks(f"{path.name} holds no frame; at least one cycle is needed.")
    if not 0.0 < rate < np.inf:
        raise UnreadableFile(f"{path.name} says that it has {rate:g} frames a second; more than 0 are needed.")
    point_names = map_keypoint_names(points, names, path.name)
    return Tracks(
        time=(frame - frame[0]) / rate,
        points=point_names,
        position=UNITS[unit] * upright(place, point_names),
        unit="m",
        source=path.name,
    )


def upright(place: np.ndarray, points: tuple[str, ...]) -> np.ndarray:
    """Return the positions with the vertical axis last, right-handed: y or z, along which trunk and feet lie apart."""
    trunk = [points.index(point) for point in _TRUNK if point in points]
    feet = [points.index(leg) for leg in LEGS if leg in points]
    if not trunk or not feet:
        return place
    masked_positions = np.ma.masked_invalid(place)
    middles = masked_positions[:, trunk].mean(axis=1) - masked_positions[:, feet].mean(
        axis=1
    )  # frame by frame: the animal goes on
    trunk_offset = np.nanmedian(middles.filled(np.nan), axis=0)
    return place[..., [2, 0, 1]] if abs(trunk_offset[1]) > abs(trunk_offset[2]) else place


def _trc(path: Path) -> tuple[tuple[str, ...], np.ndarray, float, str, np.ndarray]:
    """Return keypoints, positions, frame rate, unit of length and numbers of the frames of a TRC file.

    Positions have the shape (frame, point, 3) and are NaN where a marker is missing.
    """
    lines = read_text(path).splitlines()
    if len(lines) < _HEADER or not lines[0].startswith("PathFileType"):
        raise UnreadableFile(f"{path} is no TRC file: its first line is not 'PathFileType 4 (X/Y/Z) ...'.")
    header = dict(zip(lines[1].split("\t"), lines[2].split("\t"), strict=False))
    points = tuple(cell.strip() for cell in lines[3].split("\t")[2:] if cell.strip())
    check_width(2 + 3 * len(points), path.name)
    try:
        rate, unit = float(header["DataRate"]), header["Units"].strip()
        rows = [line.split("\t") for line in lines[_HEADER:] if line.strip()]
        cells = [[float(cell) if cell.strip() else np.nan for cell in row[2 : 2 + 3 * len(points)]] for row in rows]
        padded_rows = [row + [np.nan] * (3 * len(points) - len(row)) for row in cells]
        place = np.array(padded_rows, dtype=float).reshape(len(padded_rows), len(points), 3)
    except (KeyError, ValueError) as error:
        raise UnreadableFile(
            f"{path} cannot be read as a TRC file: its second line is to name DataRate and Units, the line below is to "
            f"give both, and what stands from line {_HEADER + 1} on is to be numbers."
        ) from error
    if not points:
        raise UnreadableFile(f"{path} names no marker in its fourth line.")
    place[~np.isfinite(place).all(axis=-1)] = np.nan
    return points, place, rate, unit, _trc_frames([row[:2] for row in rows], rate, path.name)


def _trc_frames(cells: list[list[str]], rate: float, name: str) -> np.ndarray:
    """Return the numbers of a TRC file's frames by its first column, or by its times where that does not count.

    Raises:
        UnreadableFile: the times are those of another rate than the header's.
    """
    frame, time = (np.array([_value(row[i]) if len(row) > i else np.nan for row in cells]) for i in (0, 1))
    steps, counts = np.diff(time), np.diff(frame)
    has_frames, has_times = np.all(counts > 0), np.all(steps > 0)
    if has_frames and has_times and len(steps) > 1:
        implied_rate = float((frame[-1] - frame[0]) / (time[-1] - time[0]))
        if abs(implied_rate / rate - 1) > _RATE_TOLERANCE:
            raise UnreadableFile(
                f"the frames and times of {name} go on at {implied_rate:.4g} frames a second, and its DataRate is "
                f"{rate:g}; both must agree: mend the wrong one."
            )
    if has_frames:
        return frame
    return rate * time if has_times and len(time) > 1 else np.arange(float(len(cells)))


def _value(cell: str) -> float:
    """Return the number in a cell, NaN without one."""
    try:
        return float(cell)
    except ValueError:
        return float("nan")


def _c3d(path: Path) -> tuple[tuple[str, ...], np.ndarray, float, str, np.ndarray]:
    """Return keypoints, positions, frame rate, unit of length and numbers of the frames of a C3D file.

    Positions have the shape (frame, point, 3) and are NaN where a marker is missing.
    """
    try:
        import c3d  # noqa: PLC0415  an optional extra
    except ImportError as error:
        raise UnreadableFile(
            f"{path.name} is a C3D file, which the c3d library reads; install it: {_INSTALL}."
        ) from error
    try:
        with path.open("rb") as file, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # such as that there are no analog channels
            reader: Any = c3d.Reader(file)
            points = tuple(str(label).strip() for label in reader.point_labels)
            check_width(3 * len(points), path.name)
            numbered_frames = [(number, points_of) for number, points_of, _ in reader.read_frames(copy=True)]
            rate, unit = float(reader.point_rate), str(reader.get("POINT:UNITS").string_value).strip().lower()
    except UnreadableFile:
        raise
    except Exception as error:
        raise UnreadableFile(
            f"{path} cannot be read as a C3D file: it is damaged, cut, or of another kind; export it again, or give a "
            "TRC file."
        ) from error
    frames = [points_of for _, points_of in numbered_frames]
    samples = np.array(frames, dtype=float).reshape(len(frames), -1, 5)[:, : len(points)]
    place = samples[..., :3].copy()
    place[samples[..., 3] < 0.0] = np.nan
    return points, place, rate, unit, np.array([number for number, _ in numbered_frames], dtype=float)
