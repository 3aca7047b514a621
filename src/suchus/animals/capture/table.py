"""Tracks as a plain CSV table: one row per frame, a header that names every column and its unit.

``time [s], hip_x [mm], hip_y [mm], ...``: the first column is the time, beside which a column ``frame`` may stand; the
others are a keypoint, an axis (x and y,
or x, y and z) and a unit (m, cm, mm or px, the same for all). An empty cell is a lost point. A column
``hip_confidence [-]`` may follow. Where the first column is ``frame``, its numbers are divided by the frame rate.
Metres have y to the left of x, seen from above; pixels, as in images, to the right.

A table of joint angles over one cycle is a CSV file too; it is closed where its end meets its beginning.
"""

import csv
import re
from collections.abc import Mapping
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Complex, Float

from suchus.animals.capture.poses import csv_rows, software_of
from suchus.animals.capture.tracks import UNITS, Tracks, UnusableTracks, map_keypoint_names
from suchus.core.checks import require
from suchus.core.errors import UnreadableFile
from suchus.core.files import write

_HEADING = re.compile(r"\s*(?P<point>.+)_(?P<axis>x|y|z|confidence)\s*\[(?P<unit>[^\]]*)\]\s*")
_FRAME = re.compile(r"frames?|frame[ _](number|index)|frame \[-\]|fnum")
_EXAMPLE = "time [s], hip_x [mm], hip_y [mm], ..."


class _Column(NamedTuple):
    point: str
    axis: str


def is_table(path: Path) -> bool:
    """Return whether a file is a CSV table that no pose estimator wrote."""
    return path.suffix.lower() in (".csv", ".txt") and software_of(path) is None


def read_table(
    path: Path, *, names: Mapping[str, str], confidence: float, y_down: bool | None, rate: float | None = None
) -> Tracks:
    """Read a CSV table.

    Args:
        path: the file.
        names: our name of a keypoint by the file's, where they differ.
        confidence: points with less are lost.
        y_down: whether y points to the right of x, seen from above; None: in pixels only.
        rate: frames per second, where the first column counts frames [1/s].

    Raises:
        UnreadableFile: it is missing or empty, or a heading or a cell makes no sense.
        UnusableTracks: it counts frames, and no frame rate was given.
    """
    rows = _with_time_first(_rows(path))
    columns, unit = _columns(rows[0], path.name)
    values = _numbers(rows, path.name)
    if _FRAME.fullmatch(rows[0][0].strip().lower()):
        if rate is None:
            raise UnusableTracks(f"{path.name} counts frames and does not give their rate; give it, as in --fps 50.")
        values[:, 0] /= rate
    points = tuple(dict.fromkeys(c.point for c in columns))
    axes = "xyz" if any(c.axis == "z" for c in columns) else "xy"
    position = np.full((len(values), len(points), len(axes)), np.nan)
    trusted = np.ones((len(values), len(points)), dtype=bool)
    for column, series in zip(columns, values[:, 1:].T, strict=True):
        i = points.index(column.point)
        if column.axis == "confidence":
            trusted[:, i] = series >= confidence
        else:
            position[:, i, axes.index(column.axis)] = series
    position[~trusted | np.isnan(position).any(axis=-1)] = np.nan
    if unit == "px" if y_down is None else y_down:
        position[..., 1] *= -1
    scale = 1.0 if unit == "px" else UNITS[unit]
    return Tracks(
        time=values[:, 0],
        points=map_keypoint_names(points, names, path.name),
        position=scale * position,
        unit="px" if unit == "px" else "m",
        source=path.name,
    )


def write_table(tracks: Tracks, path: str | Path) -> Path:
    """Write tracks as a CSV table, lengths in millimetres or pixels, and return the path.

    Raises:
        Unwritable: the place cannot be written to.
    """
    path = Path(path)
    unit, scale, sign = ("px", 1.0, -1.0) if tracks.unit == "px" else ("mm", 1000.0, 1.0)
    axes = "xyz"[: tracks.position.shape[-1]]
    headings = [f"{point}_{axis} [{unit}]" for point in tracks.points for axis in axes]
    position = scale * tracks.position
    position[..., 1] *= sign
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["time [s]", *headings])
    for time, row in zip(tracks.time, position.reshape(len(tracks.time), -1), strict=True):
        writer.writerow([f"{time:.4f}", *("" if np.isnan(x) else f"{x:.1f}" for x in row)])
    return write(path, text.getvalue())


def _rows(path: Path) -> list[list[str]]:
    """Return the non-empty rows of a table of keypoints, header included; refuse one without a frame."""
    rows = csv_rows(path)
    if not rows:
        raise UnreadableFile(f"{path} is empty; a header ({_EXAMPLE}) and one row per frame are needed.")
    if len(rows) == 1:
        raise UnusableTracks(f"{path.name} holds a header and no frame; at least one cycle is needed.")
    return rows


def _with_time_first(rows: list[list[str]]) -> list[list[str]]:
    """Return rows with the time first, and without a column of frame numbers beside it."""
    labels = [cell.strip().lower() for cell in rows[0][:2]]
    if "time [s]" in labels and any(_FRAME.fullmatch(label) for label in labels):
        frame = 1 - labels.index("time [s]")
        return [row[:frame] + row[frame + 1 :] for row in rows]
    return rows


def _columns(header: list[str], name: str) -> tuple[list[_Column], str]:
    """Return the columns of a table by its header, and the unit of length that all of them share."""
    first_heading = header[0].strip().lower()
    if first_heading != "time [s]" and not _FRAME.fullmatch(first_heading):
        raise UnreadableFile(
            f"the first column of {name} is {header[0].strip()[:40]!r}; 'time [s]' is needed, or 'frame' and --fps, as "
            f"in: {_EXAMPLE}"
        )
    columns, units = [], set()
    for heading in header[1:]:
        match = _HEADING.fullmatch(heading)
        if match is None:
            raise UnreadableFile(
                f"{name} has a column {heading.strip()!r}; a keypoint, an axis and a unit are needed, as in: {_EXAMPLE}"
            )
        columns.append(_Column(match["point"], match["axis"]))
        if match["axis"] != "confidence":
            units.add(match["unit"].strip())
    strange = sorted(units - set(UNITS))
    if strange:
        raise UnreadableFile(f"{name} has lengths in {strange[0]!r}; {', '.join(UNITS)} are known.")
    if len(units) > 1:
        raise UnreadableFile(f"{name} has lengths in {' and in '.join(sorted(units))}; one unit for all is needed.")
    if len(set(columns)) < len(columns):
        duplicate = next(c for c in columns if columns.count(c) > 1)
        raise UnreadableFile(f"{name} has the column {duplicate.point}_{duplicate.axis} twice.")
    if not units:
        raise UnreadableFile(f"{name} has no column with a position; they look like this: {_EXAMPLE}")
    return columns, units.pop()


def _numbers(rows: list[list[str]], name: str) -> np.ndarray:
    """Return every cell below the header as a number, NaN where it is empty, shape (frame, column)."""
    values = np.full((len(rows) - 1, len(rows[0])), np.nan)
    for i, row in enumerate(rows[1:]):
        if len(row) != len(rows[0]):
            raise UnreadableFile(
                f"frame {i + 1} of {name} has {len(row)} cells, the header {len(rows[0])}; they must agree."
            )
        try:
            values[i] = [float(cell) if cell.strip() else np.nan for cell in row]
        except ValueError:
            j = next(j for j, cell in enumerate(row) if not _is_number(cell))
            raise UnreadableFile(
                f"frame {i + 1} of {name} has {row[j]!r} in the column {rows[0][j].strip()!r}; a number is needed, "
                "or nothing where the point was lost."
            ) from None
    values[np.isinf(values)] = np.nan
    return values


def _is_number(cell: str) -> bool:
    """Return whether a cell holds a number or is empty."""
    try:
        float(cell or "nan")
    except ValueError:
        return not cell.strip()
    return True


MIN_HARMONICS, MAX_HARMONICS = 4, 6
"""How many close the seam of a mean cycle: fewer lose the joints' movement, more follow the jump."""


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class AngleCycle:
    """The angles of some joints over one cycle that closes; nothing in it knows of a robot."""

    joints: tuple[str, ...]
    """Their names, as the table has them."""
    harmonics: Complex[np.ndarray, "joint k"]
    """Steady part and complex amplitudes of ``exp(2 pi i k phase)``, k = 0 upward [rad]."""
    residual: Float[np.ndarray, " joint"]
    """Root mean square of what the harmonics leave of the table [rad]."""
    source: str
    """File or publication that they are from."""

    def at(self, phase: Float[np.ndarray, "*batch"]) -> Float[np.ndarray, "*batch joint"]:
        """Return the angles at phases [cycle]; any whole number of cycles further they are the same [rad]."""
        k = np.arange(self.harmonics.shape[1])
        turn = np.exp(2j * np.pi * np.multiply.outer(np.asarray(phase, dtype=float), k))
        return np.asarray((turn @ self.harmonics.T).real)


def is_angle_table(path: str | Path) -> bool:
    """Return whether a file is a CSV table of joint angles: its first column is ``time``, a share, without a unit."""
    path = Path(path)
    if path.suffix.lower() != ".csv" or not path.is_file():
        return False
    with path.open("rb") as file:
        return file.read(16).removeprefix(b"\xef\xbb\xbf").partition(b",")[0].strip() == b"time"


def read_angles(path: str | Path, *, harmonics: int = MAX_HARMONICS) -> AngleCycle:
    """Read a table of one cycle: ``time`` as a share of it, then an angle in degrees for every joint.

    Args:
        path: path of the CSV file.
        harmonics: how many are kept, 4 to 6.

    Raises:
        InvalidDesign: the number of harmonics is out of range.
        UnreadableFile: there is no such table, or it does not hold one whole cycle.
    """
    path = Path(path)
    require("angles", "harmonics", harmonics, MIN_HARMONICS, MAX_HARMONICS, "")
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = [row for row in csv.reader(file) if row]
        names, values = tuple(rows[0][1:]), np.array(rows[1:], dtype=float)
    except (OSError, UnicodeDecodeError, csv.Error, ValueError, IndexError) as error:
        raise UnreadableFile(f"{path} is no table of joint angles: a header and rows of numbers are needed.") from error
    if values.ndim != 2 or not names or rows[0][0].strip() != "time" or not np.isfinite(values).all():
        raise UnreadableFile(f"{path} is no table of joint angles: 'time' and finite angles of joints are needed.")
    phase, max_step = values[:, 0], 1.0 / (2 * harmonics + 1)
    steps = np.diff(np.append(phase, phase[0] + 1.0))
    if steps.min() <= 0.0 or steps.max() > max_step:
        raise UnreadableFile(
            f"in {path} the time does not go through one cycle, 0 to 1, in steps of at most {max_step:.2f} for "
            f"{harmonics} harmonics."
        )
    k = 2 * np.pi * np.multiply.outer(phase, np.arange(1, harmonics + 1))
    X = np.hstack([np.ones((len(phase), 1)), np.cos(k), np.sin(k)])
    angles = np.radians(values[:, 1:])
    solution = np.linalg.lstsq(X, angles, rcond=None)[0]
    cos, sin = solution[1 : harmonics + 1], solution[harmonics + 1 :]
    return AngleCycle(
        joints=names,
        harmonics=np.vstack([solution[:1], cos - 1j * sin]).T,
        residual=np.sqrt(np.mean((angles - X @ solution) ** 2, axis=0)),
        source=path.name,
    )
