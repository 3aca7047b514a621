"""A file of tracks in, whatever wrote it; a gait as a file out.

Files of DeepLabCut, SLEAP and LightningPose are read by the ``movement`` library, an optional extra.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import degrees
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from suchus import blueprint
from suchus.capture.retarget import Captured
from suchus.capture.table import is_table, read_table
from suchus.capture.tracks import Tracks, UnusableTracks, renamed
from suchus.capture.walk import Walk
from suchus.design import LEGS
from suchus.errors import UnknownName, UnreadableFile
from suchus.record import check_file, write

SOFTWARE = ("DeepLabCut", "SLEAP", "LightningPose", "Anipose", "NWB")
"""Software whose files can be read."""

_INSTALL = 'pip install "suchus[capture]"'


class MissingExtra(UnreadableFile):
    """A file that only an optional library can read."""


def read_poses(
    path: Path,
    *,
    software: str | None,
    rate: float | None,
    individual: str | None,
    names: Mapping[str, str],
    confidence: float,
    y_down: bool | None,
) -> Tracks:
    """Read the file of a pose estimator; positions are in pixels with y to the right of x, as in images.

    Args:
        path: the file.
        software: one of ``SOFTWARE``; guessed from the file if None.
        rate: frames per second, which most of these files do not hold [1/s].
        individual: whose tracks, where the file holds several.
        names: our name of a keypoint by the file's, where they differ.
        confidence: points with less are lost.
        y_down: whether y points to the right of x, seen from above; None: it does, unless there are three axes.

    Raises:
        MissingExtra: the ``movement`` library is not installed.
        UnreadableFile: the file is broken or of another kind.
        UnusableTracks: no frame rate, or several individuals to choose from.
    """
    data = _load(path, software or _guess(path), rate)
    if "time_unit" not in data.attrs or data.attrs["time_unit"] != "seconds":
        raise UnusableTracks(f"{path.name} does not give its frame rate; give it, as in --fps 50.")
    data = _one(data, individual, path.name)
    dims = [d for d in data.position.dims if d not in ("time", "space")]
    position = data.position.transpose("time", *dims, "space").values.astype(float)
    if "confidence" in data:
        sure = data.confidence.transpose("time", *dims).values
        position[~(np.isnan(sure) | (sure >= confidence))] = np.nan
    position[np.isnan(position).any(axis=-1)] = np.nan
    if position.shape[-1] == 2 if y_down is None else y_down:
        position[..., 1] *= -1
    points = tuple(str(name) for name in data[dims[0]].values)
    return Tracks(
        time=data.time.values.astype(float),
        points=renamed(points, names, path.name),
        position=position,
        unit="px",
        source=path.name,
    )


def _load(path: Path, software: str, rate: float | None) -> Any:
    try:
        from movement.io import load_dataset  # noqa: PLC0415  an optional extra
    except ImportError as error:
        raise MissingExtra(
            f"{path.name} is a file of {software}, which the movement library reads; install it: {_INSTALL}."
        ) from error
    try:
        return load_dataset(path, source_software=software, fps=rate)
    except (
        OSError,
        ValueError,
        KeyError,
        TypeError,
        IndexError,
        AttributeError,
    ) as error:  # what it raises on bad files
        text = " ".join(str(error).split()).rstrip(".")
        raise UnreadableFile(f"{path} cannot be read as a file of {software}: {text}.") from error


def _guess(path: Path) -> str:
    suffix = path.suffix.lower()
    if suffix == ".slp":
        return "SLEAP"
    if suffix == ".nwb":
        return "NWB"
    if suffix in (".h5", ".hdf5") and h5py.is_hdf5(path):
        with h5py.File(path) as file:
            return "SLEAP" if "tracks" in file else "DeepLabCut"
    if suffix == ".csv":
        return "DeepLabCut"
    raise UnreadableFile(
        f"{path} is neither a CSV table nor a file that a pose estimator is known by; say whose it is with --software "
        f"({', '.join(SOFTWARE)})."
    )


def _one(data: Any, individual: str | None, name: str) -> Any:
    dim = next((d for d in data.position.dims if str(d).startswith("individual")), None)
    if dim is None:
        return data
    names = [str(one) for one in data[dim].values]
    if individual is None and len(names) > 1:
        raise UnusableTracks(
            f"{name} holds {len(names)} individuals; choose one with --individual: {', '.join(names)}."
        )
    if individual is not None and individual not in names:
        raise UnusableTracks(f"{name} holds no individual {individual!r}; it holds {', '.join(names)}.")
    return data.isel({dim: names.index(individual) if individual else 0})


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadingOptions:
    """Options with which a file of tracks is read."""

    names: Mapping[str, str] = field(default_factory=dict)
    """Our name of a keypoint by the file's, where they differ."""
    rate: float | None = None
    """Frames per second, for files that do not hold it [1/s]."""
    software: str | None = None
    """What wrote the file, of ``SOFTWARE``; guessed if None."""
    individual: str | None = None
    """Whose tracks, where the file holds several."""
    confidence: float = 0.6
    """Points with less are lost [-]; what DeepLabCut and movement use."""
    y_down: bool | None = None
    """Whether y points to the right of x, seen from above; None: as the file's kind has it."""


def read_tracks(path: str | Path, how: ReadingOptions | None = None) -> Tracks:
    """Read tracks from a CSV table, or from a file of DeepLabCut, SLEAP or LightningPose.

    Args:
        path: the file.
        how: how to read it.

    Raises:
        UnreadableFile: there is no such file, it is empty or broken, or the library that reads it is not installed.
        UnusableTracks: it holds not what is needed.
    """
    how, path = how or ReadingOptions(), Path(path)
    if how.software is not None and how.software not in SOFTWARE:
        raise UnknownName("software", how.software, SOFTWARE)
    check_file(path)
    if path.stat().st_size == 0:
        raise UnreadableFile(f"{path} is empty; a header and one row per frame are needed.")
    if how.software is None and is_table(path):
        return read_table(path, names=how.names, confidence=how.confidence, y_down=how.y_down)
    return read_poses(
        path,
        software=how.software,
        rate=how.rate,
        individual=how.individual,
        names=how.names,
        confidence=how.confidence,
        y_down=how.y_down,
    )


def write_gait(captured: Captured, walk: Walk, path: Path) -> Path:
    """Write a captured gait as TOML, with what was seen and what got lost as comments, and return the path.

    Raises:
        Unwritable: the place cannot be written to.
    """
    head = [f"A gait read from {walk.source}.", *summary(walk), *(f"Note: {note}." for note in captured.notes)]
    text = "".join(f"# {' '.join(line.split())}\n" for line in head) + "\n" + blueprint.render(captured.gait)
    return write(path, text)


def summary(walk: Walk) -> list[str]:
    """Return what was seen, in lines that people read."""

    def one(name: str, digits: int = 2, scale: float = 1.0) -> str:
        if name not in walk.numbers:
            return "(it does not bend)"
        value, _, error, _ = walk.numbers[name]
        apart = f" ± {scale * error:.{digits}f}" if error == error and error > 0.0 else ""
        return f"{scale * value:.{digits}f}{apart}"

    turn = degrees(1.0)
    return [
        f"{walk.cycles:.1f} cycles of {walk.value('period'):.3f} s; {one('stride')} trunk lengths per cycle",
        "stance share: " + ", ".join(f"{leg} {one(f'duty_{leg}')}" for leg in LEGS),
        "limb phase [cycle]: " + ", ".join(f"{leg} {one(f'phase_{leg}', 3)}" for leg in LEGS),
        f"spine: {one('spine_lateral', 1, turn)} degrees to either side, farthest right at phase "
        f"{one('spine_rightmost', 3)}",
        f"tail: {one('tail_lateral', 1, turn)} degrees to either side at {walk.tail_share:.2f} of its length, "
        f"{one('tail_lag', 3)} cycles behind the spine",
        f"standing index (1 standing, 0 travelling): trunk {one('standing_trunk')}, tail {one('standing_tail')}, "
        f"body {one('standing_body')}",
    ]
