"""Conducting a search: generation after generation, each kept, the best so far always on disk."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from suchus import blueprint
from suchus.errors import IncompatibleRecord, NotConverged
from suchus.land import Run
from suchus.optimise.aims import AIMS
from suchus.optimise.checks import Evaluate, around, checked
from suchus.optimise.elsewhere import ROOMS, evaluate_on
from suchus.optimise.evaluate import evaluate
from suchus.optimise.score import allowed, losses, score, units
from suchus.optimise.search import search
from suchus.optimise.search_result import SearchResult, titled
from suchus.optimise.spec import Optimisation
from suchus.study.cluster import here
from suchus.study.makers import deciding
from suchus.study.store import Store

LIBRARIES = ("cma", "comocma", "moarchiving")
"""Packages whose versions decide which candidates are tried."""
_DECIDING = partial(deciding, LIBRARIES, ROOMS)
_CHECKED, _AROUND = 900_000, 950_000  # first numbers of the last parts; the budget's generations are added


class SearchProgress(NamedTuple):
    """Progress of a search."""

    arm: str
    """Name of the condition."""
    done: float
    """Candidates tried in this condition, parts of a generation included."""
    budget: int
    """Candidates that it may try."""
    best: float
    """First aim of the best so far, in its unit; NaN before there is one."""
    unit: str
    """Unit of that aim."""
    rate: float
    """Candidates per second of this start; 0 before the first."""

    def __str__(self) -> str:
        left = f", {max(self.budget - self.done, 0) / self.rate:.0f} s left" if self.rate > 0 else ""
        best = f", best {self.best:.3g} {self.unit}" if np.isfinite(self.best) else ""
        return f"{int(self.done)} of {self.budget} tried, {self.rate:.1f}/s{left}{best}"


Progress = Callable[[SearchProgress], None]


def optimise(
    spec: Optimisation, folder: Path, *, progress: Progress | None = None, client: Any = None
) -> tuple[SearchResult, ...]:
    """Search each condition, check what was found, and return it.

    Generations are stored as they are finished: whatever stops the program, at most the running one is lost. Started
    again it goes on, and ends with the same bytes as if nothing had happened. The best gait so far is always a file,
    ``ARM.toml``; a robot that changes too is ``ARM_robot.toml``.

    Args:
        spec: the search; with more evaluations than before, an earlier one is continued.
        folder: for its results and, below it, the store of each condition.
        progress: called with how far it is, after each piece of work.
        client: a ``distributed.Client``, among whose workers each generation is shared out; this process if None. The
            bytes are the same.

    Raises:
        Unwritable: the folder cannot be written to.
        IncompatibleRecord: a store below it is another search's or another version's.
        NoOptimiser: a library is missing.
        NotConverged: nothing that was tried keeps all limits.
        NoCluster: the cluster was lost.
    """
    with here(client):
        return tuple(_arm(spec.of(arm), folder, progress or _silent, client) for arm in spec.arms)


def _arm(spec: Optimisation, folder: Path, progress: Progress, client: Any) -> SearchResult:
    """Search one condition."""
    name = spec.arms[0].name
    with opened(spec, folder / name) as store:
        found = _searched(spec, store, folder, progress, client)
        if not found.chosen:
            raise NotConverged(
                f"nothing of {found.history.sizes['candidate']} candidates of {name} keeps all limits; widen ranges or "
                "limits, or raise evaluations."
            )
        write_runs(found.spec, found.runs, folder)
        generations = int(found.history.generation.max())
        check = _kept(store, _CHECKED + generations, lambda: checked(spec, found.runs))
        near = _kept(store, _AROUND + generations, lambda: around(spec, found.shares[0], _tried(client)))
        return found.with_checks(check, near)


@contextmanager
def opened(spec: Optimisation, folder: Path) -> Iterator[Store]:
    """Hold the store of one condition; the budget does not distinguish searches."""
    with Store(folder, replace(spec, evaluations=1), kind="optimisation", versions=_DECIDING).opened() as store:
        yield store


def _tried(client: Any) -> Evaluate:
    """Return what tries candidates: this process, or a cluster."""
    return evaluate if client is None else partial(evaluate_on, client)


def _searched(spec: Optimisation, store: Store, folder: Path, progress: Progress, client: Any) -> SearchResult:
    """Run what is not in the store yet; return all candidates."""
    tried = _tried(client)
    start = _generation(store, 0, np.array([spec.start]), lambda x: tried(spec, x))
    parts, driver, clock = units(spec, start), search(spec), _Clock(spec, progress)
    tables, best = [_numbered(start, 0)], np.inf
    while clock.done < spec.evaluations:
        asked, number = driver.ask(), len(tables)
        known = store.has(number)
        clock.begin(len(asked), fresh=not known)
        table = _generation(store, number, asked, lambda x: tried(spec, x, clock.within))
        driver.tell(losses(spec, table, parts) if spec.pareto else score(spec, table, parts))
        tables.append(_numbered(table, number))
        found = np.where(allowed(spec, table), score(spec, table, parts), np.inf)
        if found.min() < best:
            i, best = int(found.argmin()), float(found.min())
            clock.best = float(table[f"aim_{spec.aims[0].name}"][i])
            if not spec.pareto and not known:
                run = spec.candidate({v.field: float(s) for v, s in zip(spec.vary, asked[i], strict=True)})
                write_runs(spec, [titled(spec, run, spec.arms[0].name)], folder)
        clock.end()
    whole = xr.concat(tables, "candidate")
    return SearchResult(spec=spec, start=start, history=whole.assign(score=("candidate", score(spec, whole, parts))))


class _Clock:
    """Counts candidates, and the time of this start."""

    def __init__(self, spec: Optimisation, progress: Progress) -> None:
        self._spec, self._progress = spec, progress
        self._begun, self._fresh, self._now, self._new = time.perf_counter(), 0.0, 0, False
        self.done, self.best = 0, float("nan")

    def begin(self, count: int, *, fresh: bool) -> None:
        """A generation begins; one from the store takes no time that counts."""
        self._now, self._new = count, fresh

    def within(self, share: float) -> None:
        """Tell of the share of a generation."""
        self._tell(share * self._now)

    def end(self) -> None:
        """A generation is kept."""
        self.done += self._now
        self._fresh += self._now if self._new else 0
        self._now = 0
        self._tell(0.0)

    def _tell(self, more: float) -> None:
        tried = self._fresh + (more if self._new else 0.0)
        seconds = time.perf_counter() - self._begun
        rate = tried / seconds if tried and seconds > 0 else 0.0
        unit = AIMS[self._spec.aims[0].name].unit
        self._progress(
            SearchProgress(self._spec.arms[0].name, self.done + more, self._spec.evaluations, self.best, unit, rate)
        )


def _numbered(table: xr.Dataset, number: int) -> xr.Dataset:
    return table.assign(generation=("candidate", np.full(table.sizes["candidate"], number)))


def _generation(store: Store, number: int, asked: np.ndarray, make: Callable[[np.ndarray], xr.Dataset]) -> xr.Dataset:
    """Return one generation, from the store if it is there."""
    table = _kept(store, number, lambda: make(asked))
    if not np.array_equal(table.share.values, asked):
        raise IncompatibleRecord(
            f"{store.part(number)} holds other candidates than the search asks for; this machine or its libraries "
            "round differently: choose another place."
        )
    return table


def _kept(store: Store, number: int, make: Callable[[], xr.Dataset]) -> xr.Dataset:
    """Return a part, made and stored if it is not there yet."""
    if not store.has(number):
        store.put(number, make())
    return store.table(number).drop_attrs(deep=False)


def write_runs(spec: Optimisation, runs: Sequence[Run], folder: Path) -> None:
    """Write each run's gait as ``LABEL.toml``, and the robot where it varies as ``LABEL_robot.toml``."""
    for run in runs:
        blueprint.write(run.gait, folder / f"{run.label}.toml")
        if any(v.field.startswith("robot.") for v in spec.vary):
            blueprint.write(run.robot, folder / f"{run.label}_robot.toml")


def _silent(progress: SearchProgress) -> None:
    del progress
