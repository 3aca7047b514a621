"""One experiment from question to folder."""

import time
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path

import xarray as xr

from suchus.errors import plain_warnings
from suchus.experiment import Experiment, Outcome
from suchus.figures import styled
from suchus.progress import Progress
from suchus.report import check_place, save_outcome


@dataclass(frozen=True, slots=True, kw_only=True)
class Performed:
    """An experiment that was run and saved."""

    outcome: Outcome
    """Its outcome."""
    folder: Path
    """Folder of its files."""
    seconds: float
    """Duration of running and drawing [s]."""


def perform(experiment: Experiment, name: str, out: Path, progress: Progress, command: str) -> Performed:
    """Run an experiment, draw its figures and save all of it in ``out / name``.

    Args:
        experiment: the question.
        name: its name on the shelf.
        out: the folder for results.
        progress: called with the share that is done, 0 to 1.
        command: what makes the same result again.

    Raises:
        Unwritable: the results cannot be saved; reported before the run where it can be known.
    """
    start = time.perf_counter()
    check_place(out / name)
    with _plain_sums(), plain_warnings(name):
        outcome = experiment.run(progress)
        progress("drawing", 1.0)
        with styled():
            figures = experiment.draw(outcome)
        progress("saving", 1.0)
        folder = save_outcome(outcome, figures, experiment, out / name, command=command)
    return Performed(outcome=outcome, folder=folder, seconds=time.perf_counter() - start)


def _plain_sums() -> AbstractContextManager[object]:
    """Let xarray take NumPy's sums and medians, whatever else is installed beside it.

    Those of ``numbagg``, which comes with the extra ``capture``, round otherwise, so that equal runs would not give
    equal bytes everywhere; and they compile for up to half a minute in every process.
    """
    return xr.set_options(use_numbagg=False, use_bottleneck=False)  # type: ignore[no-untyped-call]
