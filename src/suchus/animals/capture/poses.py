"""CSV tables of pose estimators: DeepLabCut, LightningPose, SLEAP's analysis table and Anipose.

All of them number their frames. Frames that the table leaves out are gaps: the time of a frame is its number over the
frame rate.
"""

import csv
import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from suchus.animals.capture.tracks import UnusableTracks
from suchus.core.errors import UnreadableFile
from suchus.core.reading import no_text, read_bytes

UNIQUE = "single"
"""Name of DeepLabCut for the body parts that belong to no individual."""
MAX_COLUMNS = 5000
"""Greatest number of columns of a table [-]."""
_DECIMAL_COMMA = re.compile(r"\s*[+-]?\d*,\d+(?:[eE][+-]?\d+)?\s*")
_MAX_LINE = 2**20  # bytes of the first line that are looked at
_SLEAP_FRAME, _SLEAP_TRACK = "frame_idx", "track"


class PoseTracks(NamedTuple):
    """Keypoints of one individual, as a pose estimator wrote them."""

    points: tuple[str, ...]
    """Names of the keypoints."""
    position: np.ndarray
    """Shape (frame, point, axis), NaN where a point was lost [px, or the unit of a calibration]."""
    confidence: np.ndarray
    """Confidence of each point, shape (frame, point), NaN where none is given [-]."""


def software_of(path: Path) -> str | None:
    """Return the software that wrote a CSV table, by its first line; None if it is none of these."""
    with path.open("rb") as file:
        line = file.readline(_MAX_LINE).lstrip(b"\xef\xbb\xbf").decode(errors="replace")
    cells = [cell.strip().strip('"') for cell in line.split(delimiter_of(line))]
    if cells[0].lower() == "scorer":
        return "DeepLabCut"
    if _SLEAP_FRAME in cells and any(cell.endswith(".x") for cell in cells):
        return "SLEAP"
    if "fnum" in cells and any(cell.endswith("_ncams") for cell in cells):
        return "Anipose"
    return None


def read_pose_table(path: Path, software: str, individual: str | None) -> tuple[np.ndarray, PoseTracks]:
    """Return the numbers of the frames in a CSV table of a pose estimator, and the keypoints of one individual.

    Args:
        path: the file.
        software: DeepLabCut, LightningPose, SLEAP or Anipose.
        individual: individual whose keypoints are read, where the table holds several.

    Raises:
        UnreadableFile: the table is broken, or not of this software.
        UnusableTracks: it holds no frame, or several individuals to choose from.
    """
    rows = csv_rows(path)
    if software == "SLEAP":
        return _sleap(rows, individual, path.name)
    if software == "Anipose":
        return _anipose(rows, path.name)
    return _deeplabcut(rows, individual, path.name)


def delimiter_of(header: str) -> str:
    """Return what separates the cells of a table: a comma, or the semicolon or tab that its header has more of."""
    return max((",", ";", "\t"), key=header.count)


def check_width(count: int, name: str) -> None:
    """Refuse a table with more columns than an animal can have keypoints."""
    if count > MAX_COLUMNS:
        raise UnreadableFile(
            f"{name} has {count} columns; at most {MAX_COLUMNS} are read: one row per frame is needed, and the columns "
            "of one animal."
        )


def csv_rows(path: Path) -> list[list[str]]:
    """Return the rows of a CSV table that are not empty, header included.

    Raises:
        UnreadableFile: it is no CSV table in UTF-8, or has too many columns.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            header = file.readline()
            delimiter = delimiter_of(header)
            check_width(header.count(delimiter) + 1, path.name)
            file.seek(0)
            rows = [row for row in csv.reader(file, delimiter=delimiter) if any(cell.strip() for cell in row)]
            if delimiter == ";":  # as spreadsheets write where the decimal sign is a comma
                rows = [[_with_decimal_point(cell) for cell in row] for row in rows]
            return rows
    except UnicodeDecodeError as error:
        raise no_text(path, read_bytes(path)) from error
    except OSError as error:
        raise UnreadableFile(f"{path} cannot be read: {(error.strerror or str(error)).lower()}.") from error
    except csv.Error as error:
        raise UnreadableFile(f"{path} is no CSV table: {error}.") from error


def _with_decimal_point(cell: str) -> str:
    """Return a number with a decimal comma with a point instead; other cells as they are."""
    return cell.replace(",", ".") if _DECIMAL_COMMA.fullmatch(cell) else cell


def _deeplabcut(rows: list[list[str]], individual: str | None, name: str) -> tuple[np.ndarray, PoseTracks]:
    """Return the frames and the keypoints of one individual in a table of DeepLabCut or LightningPose."""
    header: dict[str, list[str]] = {}
    for row in rows[:4]:
        if row[0].strip().lower() in ("scorer", "individuals", "bodyparts", "coords"):
            header[row[0].strip().lower()] = [cell.strip() for cell in row]
    if not {"scorer", "bodyparts", "coords"} <= set(header):
        raise UnreadableFile(
            f"{name} is no table of DeepLabCut: its first lines are to begin with scorer, bodyparts and coords, in a "
            "project of several animals with individuals too."
        )
    body = rows[len(header) :]
    width = len(header["coords"])
    _check_rows(body, width, name)
    first_column = next(i for i, cell in enumerate(header["coords"]) if cell in ("x", "y", "z", "likelihood"))
    owners = header.get("individuals", [""] * width)
    owner = _choice(list(dict.fromkeys(owners[first_column:])), individual, name)
    columns = {
        (header["bodyparts"][j], header["coords"][j]): j for j in range(first_column, width) if owners[j] == owner
    }
    frame = np.array([_frame_number(row[first_column - 1], i, name) for i, row in enumerate(body, 1)])
    return frame, _poses(body, columns, "likelihood", name)


def _sleap(rows: list[list[str]], individual: str | None, name: str) -> tuple[np.ndarray, PoseTracks]:
    """Return the frames and the keypoints of one track in SLEAP's analysis table."""
    header = [cell.strip() for cell in rows[0]]
    if _SLEAP_FRAME not in header:
        raise UnreadableFile(f"{name} is no analysis table of SLEAP: it has no column {_SLEAP_FRAME!r}.")
    body = rows[1:]
    _check_rows(body, len(header), name)
    track_index = header.index(_SLEAP_TRACK) if _SLEAP_TRACK in header else None
    tracks = ["" if track_index is None else row[track_index].strip() for row in body]
    track = _choice(list(dict.fromkeys(tracks)), individual, name)
    body = [row for row, owner in zip(body, tracks, strict=True) if owner == track]
    frame = np.array([_number(row[header.index(_SLEAP_FRAME)], _SLEAP_FRAME, i, name) for i, row in enumerate(body, 1)])
    order = np.argsort(frame, kind="stable")
    frame = frame[order]
    repeated_rows = np.flatnonzero(np.diff(frame) == 0)
    if len(repeated_rows):
        raise UnusableTracks(
            f"{name} holds two instances{f' of {track}' if track else ' without a track'} in frame "
            f"{frame[repeated_rows[0]]:.0f}; one is needed: track the animals in SLEAP, and export the analysis again."
        )
    columns = {}
    for j, cell in enumerate(header):
        point, dot, axis = cell.rpartition(".")
        if dot and axis in ("x", "y", "z", "score") and point != "instance":
            columns[point, axis] = j
    return frame, _poses([body[i] for i in order], columns, "score", name)


def _anipose(rows: list[list[str]], name: str) -> tuple[np.ndarray, PoseTracks]:
    """Return the frames and the keypoints of a table of Anipose."""
    header = [cell.strip() for cell in rows[0]]
    points = [cell.removesuffix("_ncams") for cell in header if cell.endswith("_ncams")]
    if not points or "fnum" not in header:
        raise UnreadableFile(f"{name} is no table of Anipose: it has no columns 'fnum' and 'NAME_ncams'.")
    body = rows[1:]
    _check_rows(body, len(header), name)
    columns = {
        (point, axis): header.index(f"{point}_{axis}")
        for point in points
        for axis in ("x", "y", "z", "score")
        if f"{point}_{axis}" in header
    }
    frame = np.array([_number(row[header.index("fnum")], "fnum", i, name) for i, row in enumerate(body, 1)])
    return frame, _poses(body, columns, "score", name)


def _check_rows(body: Sequence[Sequence[str]], width: int, name: str) -> None:
    """Refuse a table without frames, and rows that are longer or shorter than the header."""
    if not body:
        raise UnusableTracks(f"{name} holds a header and no frame; at least one cycle is needed.")
    for i, row in enumerate(body, 1):
        if len(row) != width:
            raise UnreadableFile(f"frame {i} of {name} has {len(row)} cells, the header {width}; they must agree.")


def _choice(individuals: list[str], individual: str | None, name: str) -> str:
    """Return the individual that is read: the one that was chosen, or the only one that is an animal."""
    animals = [label for label in individuals if label != UNIQUE] or individuals
    if individual is not None and any(individuals):
        if individual not in individuals:
            raise UnusableTracks(f"{name} holds no individual {individual!r}; it holds {', '.join(animals)}.")
        return individual
    if len(animals) > 1:
        labels = ", ".join(label or "(no track)" for label in animals)
        raise UnusableTracks(f"{name} holds {len(animals)} individuals; choose one with --individual: {labels}.")
    return animals[0]


def _frame_number(cell: str, row: int, name: str) -> float:
    """Return the number of a frame, or that in the name of its picture."""
    try:
        return float(cell)
    except ValueError:
        digits = re.findall(r"\d+", Path(cell.strip().replace("\\", "/")).stem)
        if digits:
            return float(digits[-1])
    raise UnreadableFile(
        f"row {row} of {name} begins with {cell.strip()!r}; the number of a frame is needed, or the name of a picture "
        "that holds it."
    )


def _number(cell: str, column: str, row: int, name: str) -> float:
    """Return the number in a cell, NaN in an empty one."""
    if not cell.strip():
        return float("nan")
    try:
        return float(cell)
    except ValueError:
        raise UnreadableFile(
            f"frame {row} of {name} has {cell!r} in the column {column!r}; a number is needed, or nothing where the "
            "point was lost."
        ) from None


def _poses(
    body: Sequence[Sequence[str]],
    columns: dict[tuple[str, str], int],
    confidence_axis: str,
    name: str,
) -> PoseTracks:
    """Return positions and confidence from the cells of a table.

    Args:
        body: the table without its header.
        columns: index of the column of each keypoint and axis.
        confidence_axis: how the column of the confidence is called.
        name: name of the file, for messages.
    """
    points = tuple(dict.fromkeys(point for point, axis in columns if axis in ("x", "y", "z")))
    if not points:
        raise UnreadableFile(f"{name} has no column with a position.")
    axes = "xyz" if any(axis == "z" for _, axis in columns) else "xy"
    position = np.full((len(body), len(points), len(axes)), np.nan)
    confidence = np.full((len(body), len(points)), np.nan)
    for (point, axis), j in columns.items():
        if point not in points:
            continue
        series = [_number(row[j], f"{point} {axis}", i, name) for i, row in enumerate(body, 1)]
        if axis in axes:
            position[:, points.index(point), axes.index(axis)] = series
        elif axis == confidence_axis:
            confidence[:, points.index(point)] = series
    position[~np.isfinite(position)] = np.nan
    return PoseTracks(points, position, confidence)
