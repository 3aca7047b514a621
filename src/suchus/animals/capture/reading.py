"""A file of tracks in, whatever wrote it; a gait as a file out.

CSV tables of DeepLabCut, LightningPose, SLEAP and Anipose need no further library. Other files of DeepLabCut and SLEAP,
and NWB, are read by the ``movement`` library, an optional extra.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import degrees
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from suchus.animals.capture.markers import SUFFIXES, read_markers, upright
from suchus.animals.capture.poses import PoseTracks, check_width, read_pose_table, software_of
from suchus.animals.capture.retarget import Captured
from suchus.animals.capture.table import is_table, read_table
from suchus.animals.capture.tracks import UNITS, Tracks, UnusableTracks, View, map_keypoint_names
from suchus.animals.capture.walk import Walk
from suchus.core.errors import UnknownName, UnreadableFile
from suchus.core.files import check_file, write
from suchus.robot import blueprint
from suchus.robot.design import LEGS

SOFTWARE = ("DeepLabCut", "SLEAP", "LightningPose", "Anipose", "NWB")
"""Software whose files can be read."""

_TABLE_SOFTWARE = ("DeepLabCut", "LightningPose", "SLEAP", "Anipose")  # whose CSV tables need no library
_TEXT = (".csv", ".txt")
_NO_RATE = "{} does not give its frame rate; give it, as in --fps 50."
_CONTENTS = {
    "DeepLabCut": "a table of scorer, bodyparts and coords",
    "LightningPose": "a table of scorer, bodyparts and coords",
    "SLEAP": "frames of instances, or an analysis with tracks and node_names",
    "Anipose": "columns of points, fnum and NAME_ncams",
    "NWB": "a PoseEstimation in its behavior module",
}
_AS_TABLE = "write it as a CSV table, with the columns time [s], hip_x [px], hip_y [px] and so on"
_TABLE_REMEDIES = {
    **dict.fromkeys((".xlsx", ".xls", ".ods", ".numbers"), "save the sheet as CSV"),
    **dict.fromkeys((".mat", ".npy", ".npz", ".pkl", ".pickle", ".parquet", ".feather", ".json", ".rds"), _AS_TABLE),
    **dict.fromkeys((".zip", ".gz", ".tar", ".7z", ".rar"), "unpack it, and give the file of keypoints in it"),
}
"""What to do with files of kinds that are not read, by their ending."""
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
        individual: individual whose tracks are read, where the file holds several.
        names: our name of a keypoint by the file's, where they differ.
        confidence: points with less are lost.
        y_down: whether y points to the right of x, seen from above; None: it does, unless there are three axes.

    Raises:
        MissingExtra: the ``movement`` library is not installed.
        UnreadableFile: the file is broken or of another kind.
        UnusableTracks: no frame rate, or several individuals to choose from.
    """
    software = software or _guess(path)
    if path.suffix.lower() in _TEXT and software in _TABLE_SOFTWARE:
        frame, poses = read_pose_table(path, software, individual)
        if rate is None:
            raise UnusableTracks(_NO_RATE.format(path.name))
        time = frame / rate
    else:
        time, poses = _movement_poses(_load(path, software, rate), path, individual, rate)
    position = poses.position.copy()
    position[poses.confidence < confidence] = np.nan
    position[np.isnan(position).any(axis=-1)] = np.nan
    if position.shape[-1] == 2 if y_down is None else y_down:
        position[..., 1] *= -1
    points = map_keypoint_names(poses.points, names, path.name)
    return Tracks(
        time=time,
        points=points,
        position=upright(position, points) if position.shape[-1] == 3 else position,
        unit="px",
        source=path.name,
    )


def _movement_poses(data: Any, path: Path, individual: str | None, rate: float | None) -> tuple[np.ndarray, PoseTracks]:
    """Return times [s] and keypoints of one individual in a data set of the ``movement`` library.

    The library counts the rows of DeepLabCut's files from 0; their index has the numbers of the frames.
    """
    if "time_unit" not in data.attrs or data.attrs["time_unit"] != "seconds":
        raise UnusableTracks(_NO_RATE.format(path.name))
    data = _select_individual(data, individual, path.name)
    dims = [d for d in data.position.dims if d not in ("time", "space")]
    check_width(int(np.prod([data.sizes[d] for d in (*dims, "space")])), path.name)
    position = data.position.transpose("time", *dims, "space").values.astype(float)
    confidence = np.full(position.shape[:2], np.nan)
    if "confidence" in data:
        confidence = data.confidence.transpose("time", *dims).values.astype(float)
    time, frame = data.time.values.astype(float), _frame_index(path)
    if frame is not None and rate is not None and len(frame) == len(time):
        time = frame / rate
    return time, PoseTracks(tuple(str(name) for name in data[dims[0]].values), position, confidence)


def _frame_index(path: Path) -> np.ndarray | None:
    """Return the numbers of the frames in an HDF5 file of DeepLabCut, which pandas wrote; None in other files."""
    if path.suffix.lower() not in (".h5", ".hdf5") or not h5py.is_hdf5(path):
        return None
    with h5py.File(path) as file:
        for group in file.values():
            if not isinstance(group, h5py.Group):
                continue
            index = group["table"]["index"] if "table" in group else group["axis1"][()] if "axis1" in group else None
            if index is not None and np.issubdtype(index.dtype, np.number) and np.all(np.diff(index) > 0):
                return np.asarray(index, dtype=float)
    return None


def _load(path: Path, software: str, rate: float | None) -> Any:
    """Return the data set that the ``movement`` library reads from a file of a pose estimator."""
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
        if software == "DeepLabCut" and "reshape" in text:
            raise UnreadableFile(
                f"{path} holds body parts that belong to no individual, as 'single' ones do, which movement "
                "does not read; give the CSV table instead: deeplabcut.analyze_videos_converth5_to_csv writes it."
            ) from error
        raise UnreadableFile(
            f"{path} cannot be read as a file of {software}: it is damaged, or lacks what such files hold "
            f"({_CONTENTS[software]}); say with --software what wrote it, or give a CSV table."
        ) from error


def _guess(path: Path) -> str:
    """Return the software that wrote a file, by the ending of its name and its content."""
    suffix = path.suffix.lower()
    if suffix == ".slp":
        return "SLEAP"
    if suffix == ".nwb":
        return "NWB"
    if suffix in (".h5", ".hdf5") and h5py.is_hdf5(path):
        try:
            with h5py.File(path) as file:
                return "SLEAP" if "tracks" in file else "DeepLabCut"
        except OSError as error:
            raise UnreadableFile(f"{path} is damaged or cut: HDF5 does not open it; export it again.") from error
    if suffix in _TEXT:
        return software_of(path) or "DeepLabCut"
    if suffix in _TABLE_REMEDIES:
        raise UnreadableFile(f"{path} is not read: {_TABLE_REMEDIES[suffix]}.")
    raise UnreadableFile(
        f"{path} is neither a CSV table nor a file that a pose estimator is known by; say whose it is with --software "
        f"({', '.join(SOFTWARE)})."
    )


def _select_individual(data: Any, individual: str | None, name: str) -> Any:
    """Return the data of one individual; without a name, of the only one."""
    dim = next((d for d in data.position.dims if str(d).startswith("individual")), None)
    if dim is None:
        return data
    names = [str(label) for label in data[dim].values]
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
    """Individual whose tracks are read, where the file holds several."""
    confidence: float = 0.6
    """Points with less are lost [-]; what DeepLabCut and movement use."""
    y_down: bool | None = None
    """Whether y points to the right of x, seen from above; None: as the file's kind has it."""
    view: View = "top"
    """Where the camera stood; from the side, y is up."""
    unit: str | None = None
    """Unit of lengths in files that do not say it, as those of pose estimators: m, cm or mm; px is of unknown size."""


def read_tracks(path: str | Path, options: ReadingOptions | None = None) -> Tracks:
    """Read tracks from a CSV table, a TRC or C3D file, or one of DeepLabCut, SLEAP, LightningPose or Anipose.

    Args:
        path: the file.
        options: how to read it.

    Raises:
        UnreadableFile: there is no such file, it is empty or broken, or the library that reads it is not installed.
        UnusableTracks: it holds not what is needed.
    """
    options, path = options or ReadingOptions(), Path(path)
    if options.software is not None and options.software not in SOFTWARE:
        raise UnknownName("software", options.software, SOFTWARE)
    check_file(path)
    if path.stat().st_size == 0:
        raise UnreadableFile(f"{path} is empty; a header and one row per frame are needed.")
    if options.unit is not None and options.unit not in UNITS:
        raise UnknownName("unit", options.unit, tuple(UNITS))
    if options.rate is not None and not 0.0 < options.rate < np.inf:
        raise UnusableTracks(f"the frame rate is {options.rate:g}; a number above 0 is needed, in frames per second.")
    tracks = _read_by_format(path, options)
    if options.view == "side" and tracks.has_heights:
        raise UnusableTracks(f"{path.name} holds heights, so that it needs no view from the side; leave --view out.")
    return replace(tracks, view=options.view)


def _read_by_format(path: Path, options: ReadingOptions) -> Tracks:
    """Read tracks with the reader for the file's format."""
    if options.software is None and path.suffix.lower() in SUFFIXES:
        return read_markers(path, names=options.names)
    if options.software is None and is_table(path):
        return read_table(
            path, names=options.names, confidence=options.confidence, y_down=options.y_down, rate=options.rate
        )
    tracks = read_poses(
        path,
        software=options.software,
        rate=options.rate,
        individual=options.individual,
        names=options.names,
        confidence=options.confidence,
        y_down=options.y_down,
    )
    if options.unit in (None, "px"):
        return tracks
    return replace(tracks, unit="m", position=UNITS[str(options.unit)] * tracks.position)


def write_gait(captured: Captured, walk: Walk, path: str | Path) -> Path:
    """Write a captured gait as TOML, with what was seen and what got lost as comments, and return the path.

    Raises:
        Unwritable: the place cannot be written to.
    """
    head = [f"A gait read from {walk.source}.", *summary(walk), *(f"Note: {note}." for note in captured.notes)]
    text = "".join(f"# {' '.join(line.split())}\n" for line in head) + "\n" + blueprint.render(captured.gait)
    return write(path, text)


def summary(walk: Walk) -> list[str]:
    """Return what was seen, in lines that people read."""

    def format_number(name: str, digits: int = 2, scale: float = 1.0) -> str:
        """Return a number of the walk with half of its interval, or why it has none."""
        if name not in walk.numbers:
            return "(it does not bend)" if name.startswith(("spine", "tail")) and not walk.lacks else "(not seen)"
        value, _, error, _ = walk.numbers[name]
        if value != value:  # a standing index of a chain with fewer than two joints that bend
            return "(not known)"
        error_text = f" ± {scale * error:.{digits}f}" if error == error and error > 0.0 else ""
        return f"{scale * value:.{digits}f}{error_text}"

    turn = degrees(1.0)
    legs = [leg for leg in LEGS if f"duty_{leg}" in walk.numbers]
    feet = [
        "stance share: " + ", ".join(f"{leg} {format_number(f'duty_{leg}')}" for leg in legs),
        "limb phase [cycle]: " + ", ".join(f"{leg} {format_number(f'phase_{leg}', 3)}" for leg in legs),
    ]
    stride_text = f"{format_number('stride')} trunk lengths"
    if "stride" not in walk.numbers and "stride_length" in walk.numbers:
        stride_text = f"{format_number('stride_length', 3)} {walk.numbers['stride_length'].unit}"
    return [
        f"{walk.cycles:.1f} cycles of {walk.value('period'):.3f} s; {stride_text} per cycle",
        *(feet if legs else ()),
        f"spine: {format_number('spine_lateral', 1, turn)} degrees to either side, farthest right at phase "
        f"{format_number('spine_rightmost', 3)}",
        f"tail: {format_number('tail_lateral', 1, turn)} degrees to either side at {walk.tail_share:.2f} of its "
        f"length, {format_number('tail_lag', 3)} cycles behind the spine",
        f"standing index (1 standing, 0 travelling): trunk {format_number('standing_trunk')}, tail "
        f"{format_number('standing_tail')}, body {format_number('standing_body')}",
    ]
