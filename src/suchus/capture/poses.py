"""Tracks from DeepLabCut, SLEAP and LightningPose, read by the ``movement`` library: an optional extra."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from suchus.capture.tracks import Tracks, UnusableTracks, renamed
from suchus.errors import UnreadableFile

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
    there = [str(one) for one in data[dim].values]
    if individual is None and len(there) > 1:
        raise UnusableTracks(
            f"{name} holds {len(there)} individuals; choose one with --individual: {', '.join(there)}."
        )
    if individual is not None and individual not in there:
        raise UnusableTracks(f"{name} holds no individual {individual!r}; it holds {', '.join(there)}.")
    return data.isel({dim: there.index(individual) if individual else 0})
