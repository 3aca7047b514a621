"""What is noted of a flow as it goes, and how a run that was stopped goes on from its last pause.

At every pause the notes are written first, then the flow's own checkpoint, each in one piece. A kill loses at most
what came after the last pause, Ctrl-C likewise; and since a run pauses at the same instants whether it saves or not,
one that was stopped ends with the same bytes as one that was not.
"""

from collections.abc import Callable
from hashlib import sha256
from io import BytesIO
from math import prod
from pathlib import Path

import numpy as np

from suchus import flow
from suchus.errors import UnreadableFile
from suchus.flow import checkpoint as store
from suchus.flow.progress import Bar
from suchus.record import new_file
from suchus.record.seal import holds, sealed

Progress = Callable[[float], None]
"""Called with the share that is done."""

_KEPT, _NOTES = ".kept-swim", ".notes"  # how the files of an unfinished swim end


def portion(progress: Progress, number: int, count: int) -> Progress:
    """Return the progress of one run of several, counted from 0."""
    return lambda share: progress((number + share) / count)


class Diary:
    """Notes of a run: on each page a time and named values, one line after the other."""

    def __init__(self) -> None:
        self._pages: dict[str, list[dict[str, np.ndarray]]] = {}

    def note(self, page: str, time: float, **values: np.ndarray | float) -> None:
        """Write a line: the time [s] and values of the same shapes as in the lines before."""
        line = {"time": np.asarray(time), **{name: np.asarray(value) for name, value in values.items()}}
        self._pages.setdefault(page, []).append(line)

    def count(self, page: str) -> int:
        """Return how many lines a page has."""
        return len(self._pages.get(page, ()))

    def page(self, page: str) -> dict[str, np.ndarray]:
        """Return the values of a page by name, the lines along the first axis."""
        lines = self._pages[page]
        return {name: np.stack([line[name] for line in lines]) for name in lines[0]}

    def save(self, path: Path, time: float, about: str) -> None:
        """Write the notes so far.

        Raises:
            Unwritable: naming the place.
        """
        state = {f"{page}/{name}": values for page in self._pages for name, values in self.page(page).items()}
        content = BytesIO()
        np.savez(content, allow_pickle=False, until=np.array(time), about=np.array(_short(about)), **state)
        with new_file(path) as draft:
            draft.write_bytes(sealed(content.getvalue()))

    def load(self, path: Path, time: float, about: str) -> None:
        """Take up the notes until a time [s].

        Raises:
            UnreadableFile: they are broken, end too soon or belong to another swim.
        """
        try:
            data = path.read_bytes()
        except OSError as error:
            reason = (error.strerror or str(error)).lower()
            raise UnreadableFile(f"{path} cannot be read: {reason}; delete its checkpoint to start anew.") from error
        if holds(data) is not True:
            raise UnreadableFile(f"{path} holds no notes of a swim, or is damaged; delete it and its checkpoint.")
        state = store.arrays(data, path)
        try:
            until, whose = float(state.pop("until")), str(state.pop("about"))
            pages = [(key.split("/")[0], key.split("/")[1], values) for key, values in state.items()]
            lengths = {page: len(values) for page, _, values in pages}
            sound = all(len(values) == lengths[page] for page, _, values in pages)
            sound &= all(f"{page}/time" in state for page in lengths)
        except (ValueError, TypeError, LookupError):
            sound = False
        if not sound:
            raise UnreadableFile(f"{path} holds no notes of a swim; delete it and its checkpoint.")
        if whose != _short(about):
            raise UnreadableFile(f"{path} belongs to another swim; give that one's settings, or another checkpoint.")
        if until < time * (1 - 1e-12):
            raise UnreadableFile(f"{path} ends before its checkpoint does; delete both to start anew.")
        for page, name, values in pages:
            lines = self._pages.setdefault(page, [{} for _ in values])
            for line, value in zip(lines, values, strict=True):
                line[name] = value
        for page, lines in self._pages.items():
            self._pages[page] = [line for line in lines if line["time"] <= time * (1 + 1e-12)]


def _short(about: str) -> str:
    return sha256(about.encode()).hexdigest()


def kept_in(folder: str, name: str) -> Path | None:
    """Return the file in which an experiment keeps an unfinished swim in a folder; None if that is empty."""
    return Path(folder) / f"{name.replace(' ', '_')}{_KEPT}" if folder else None


def forget_kept(folder: str) -> None:
    """Remove the files that ``kept_in`` names in a folder, and their notes; whatever else lies there stays."""
    for pattern in (f"*{_KEPT}", f"*{_KEPT}{_NOTES}") if folder else ():
        for path in Path(folder).glob(pattern):
            path.unlink()


def run_on(
    sim: flow.Simulation,
    end: float,
    pause: float,
    look: Callable[[flow.Simulation, Diary], None],
    *,
    about: str,
    checkpoint: Path | str | None,
    progress: Progress | None,
) -> Diary:
    """Run a flow to its end, from its checkpoint if there is one, and return what was noted.

    Args:
        sim: at its start.
        end: a whole number of pauses [s].
        pause: between two savings; a step ends exactly there [s].
        look: called after every step to take notes.
        about: what this run is, so that it does not go on from another's checkpoint.
        checkpoint: the flow's state; the notes are kept beside it. None keeps nothing.
        progress: called with the share that is done; None shows a progress bar.

    Raises:
        UnreadableFile: the checkpoint or the notes are broken or belong to another run.
        Unwritable: they cannot be written.
    """
    diary, path = Diary(), None if checkpoint is None else Path(checkpoint)
    notes = None if path is None else path.with_name(f"{path.name}{_NOTES}")
    if path is not None and notes is not None and path.exists():
        store.load(sim, path)
        diary.load(notes, sim.time, about)
    cells = prod(sim.setup.grid.cells)
    with Bar(sim.time, end, cells, show=progress is None) as bar:

        def watch(sim: flow.Simulation) -> None:
            look(sim, diary)
            bar.move(sim.time)
            if progress is not None:
                progress(sim.time / end)

        for i in range(round(sim.time / pause), round(end / pause)):
            sim.run((i + 1) * pause, watch=watch, progress=False)
            if path is not None and notes is not None:
                diary.save(notes, sim.time, about)
                store.save(sim, path)
    return diary
