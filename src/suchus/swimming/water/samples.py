"""Samples of a running flow, and checkpoints from which a stopped run continues.

At every pause the samples are written first, then the checkpoint of the flow. Each file is written atomically. An
interrupted run loses at most the time since the last pause. A run pauses at the same instants whether it saves or not;
thus a resumed run gives the same bytes.
"""

from collections.abc import Callable, Iterable, Mapping
from hashlib import sha256
from io import BytesIO
from math import prod
from pathlib import Path

import numpy as np

from suchus import flow
from suchus.core.errors import UnreadableFile
from suchus.core.files.store import holds, sealed
from suchus.core.progress import Progress
from suchus.core.reading import check_file
from suchus.core.writing import check_writable, keep
from suchus.flow import checkpoint as store
from suchus.flow.progress import Bar

_CHECKPOINT_SUFFIX, _SAMPLES_SUFFIX = ".kept-swim", ".samples"  # how the files of an unfinished swim end


class Samples:
    """Samples of a run in series; each has a time and named values."""

    def __init__(self) -> None:
        self._series: dict[str, list[dict[str, np.ndarray]]] = {}

    def add(self, series: str, time: float, **values: np.ndarray | float) -> None:
        """Add a sample to a series: the time [s], and values of constant shapes."""
        sample = {"time": np.asarray(time), **{name: np.asarray(value) for name, value in values.items()}}
        self._series.setdefault(series, []).append(sample)

    def count(self, series: str) -> int:
        """Return how many samples a series has."""
        return len(self._series.get(series, ()))

    def series(self, series: str) -> dict[str, np.ndarray]:
        """Return the values of a series by name, the samples along the first axis."""
        samples = self._series[series]
        return {name: np.stack([sample[name] for sample in samples]) for name in samples[0]}

    def state(self) -> dict[str, np.ndarray]:
        """Return the samples so far as arrays, by ``series/name``."""
        return {f"{series}/{name}": values for series in self._series for name, values in self.series(series).items()}

    @classmethod
    def from_state(cls, state: Mapping[str, np.ndarray]) -> "Samples":
        """Return the samples of a state that ``state`` returned."""
        samples = cls()
        for key, values in state.items():
            series, name = key.split("/")
            for sample, value in zip(samples._series.setdefault(series, [{} for _ in values]), values, strict=True):
                sample[name] = value
        return samples

    def save(self, path: Path, time: float, description: str) -> None:
        """Write the samples so far.

        Raises:
            Unwritable: naming the place.
        """
        content = BytesIO()
        np.savez(content, allow_pickle=False, until=np.array(time), about=np.array(_hash(description)), **self.state())
        keep(path, sealed(content.getvalue()))

    def load(self, path: Path, time: float, description: str) -> None:
        """Read the samples until a time [s].

        Raises:
            UnreadableFile: they are broken, end too soon or belong to another swim.
        """
        try:
            check_file(path)
            data = path.read_bytes()
        except UnreadableFile as error:
            raise UnreadableFile(f"{str(error).rstrip('.')}; delete its checkpoint to start anew.") from error
        except OSError as error:
            raise UnreadableFile(f"{path} cannot be read: {error}; delete its checkpoint to start anew.") from error
        if holds(data) is not True:
            raise UnreadableFile(f"{path} holds no samples of a swim, or is damaged; delete it and its checkpoint.")
        state = store.arrays(data, path)
        try:
            end_time, owner_hash = float(state.pop("until")), str(state.pop("about"))
            series_by_name = self.from_state(state)._series
            sound = all(f"{series}/time" in state for series in series_by_name)
        except (ValueError, TypeError, LookupError):
            sound = False
        if not sound:
            raise UnreadableFile(f"{path} holds no samples of a swim; delete it and its checkpoint.")
        if owner_hash != _hash(description):
            raise UnreadableFile(f"{path} belongs to another swim; give that one's settings, or another checkpoint.")
        if end_time < time * (1 - 1e-12):
            raise UnreadableFile(f"{path} ends before its checkpoint does; delete both to start anew.")
        for series, samples in series_by_name.items():
            self._series[series] = [sample for sample in samples if sample["time"] <= time * (1 + 1e-12)]


def _hash(description: str) -> str:
    return sha256(description.encode()).hexdigest()


def checkpoint_path(folder: str, name: str) -> Path | None:
    """Return the file of an unfinished swim in a folder; None if the folder is empty text."""
    return Path(folder) / f"{name.replace(' ', '_')}{_CHECKPOINT_SUFFIX}" if folder else None


def check_checkpoint_folder(folder: str) -> None:
    """Refuse a folder in which unfinished swims cannot be stored.

    Raises:
        Unwritable: it is no folder, or cannot be written to.
    """
    if folder:
        check_writable(Path(folder))


def checkpoint_paths(folder: str, names: Iterable[str]) -> tuple[Path, ...]:
    """Return the files of unfinished swims and of their samples in a folder; none if the folder is empty text."""
    files = [path for name in names if (path := checkpoint_path(folder, name)) is not None]
    return tuple(path.with_name(path.name + end) for path in files for end in ("", _SAMPLES_SUFFIX))


def run_on(
    sim: flow.Simulation,
    end: float,
    pause: float,
    sample: Callable[[flow.Simulation, Samples], None],
    *,
    description: str,
    checkpoint: Path | str | None,
    progress: Progress | None,
) -> Samples:
    """Run a flow to its end, from its checkpoint if there is one, and return its samples.

    Args:
        sim: simulation at its start.
        end: a whole number of pauses [s].
        pause: between two savings; a step ends exactly there [s].
        sample: called after every step to take samples.
        description: what this run is, so that it does not go on from another's checkpoint.
        checkpoint: the flow's state; the samples are kept beside it. None keeps nothing.
        progress: told the share that is done; None shows a progress bar.

    Raises:
        UnreadableFile: the checkpoint or the samples are broken or belong to another run.
        Unwritable: they cannot be written.
    """
    samples, path = Samples(), None if checkpoint is None else Path(checkpoint)
    samples_path = None if path is None else path.with_name(f"{path.name}{_SAMPLES_SUFFIX}")
    if path is not None and samples_path is not None and path.exists():
        store.load(sim, path)
        samples.load(samples_path, sim.time, description)
    cells = prod(sim.setup.grid.cells)
    with Bar(sim.time, end, cells, show=progress is None) as bar:

        def watch(sim: flow.Simulation) -> None:
            sample(sim, samples)
            bar.move(sim.time)
            if progress is not None:
                progress("swimming", sim.time / end)

        for i in range(round(sim.time / pause), round(end / pause)):
            sim.run((i + 1) * pause, watch=watch, progress=False)
            if path is not None and samples_path is not None:
                samples.save(samples_path, sim.time, description)
                store.save(sim, path)
    return samples
