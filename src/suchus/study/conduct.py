"""Conducting a study: every batch that is not there yet, then all results together."""

import time
from collections.abc import Callable, Generator
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import xarray as xr

from suchus.errors import OutsideLimits, SuchusError, UnreadableFile
from suchus.study.chunk import run_chunk
from suchus.study.cluster import here, spread
from suchus.study.plan import Plan
from suchus.study.store import Store, together
from suchus.study.study import Study
from suchus.workers import Begun, Died, Done, Tell, side_by_side


class StudyProgress(NamedTuple):
    """Progress of a study."""

    done: float
    """Runs that are done, parts of a batch included."""
    total: int
    """Runs in all."""
    failed: int
    """Runs that failed so far."""
    rate: float
    """Runs per second since it was started; 0 before the first."""

    @property
    def left(self) -> float:
        """Time that is left [s]; infinite before the first run."""
        return (self.total - self.done) / self.rate if self.rate > 0 else float("inf")

    def __str__(self) -> str:
        failures = f", {self.failed} failed" if self.failed else ""
        left = f", {_duration(self.left)} left" if self.rate > 0 else ""
        return f"{int(self.done)} of {self.total} runs, {self.rate:.1f}/s{left}{failures}"


Progress = Callable[[StudyProgress], None]

_TRIES = 3  # how often a batch is begun whose process dies


class ProcessesDied(SuchusError, RuntimeError):
    """A batch whose processes died again and again."""


def conduct(
    study: Study, folder: Path, *, progress: Progress | None = None, client: Any = None, jobs: int = 1
) -> xr.Dataset:
    """Run what of a study is not in its store yet, and return all results.

    Batches are stored as they are finished: whatever stops the program, at most the running batch is lost. Started
    again it goes on, and ends with the same bytes as if nothing had happened.

    Args:
        study: the study.
        folder: its store.
        progress: called with how far it is, after each piece of work.
        client: a ``distributed.Client``, whose workers then run the batches; this process if None. The bytes are the
            same.
        jobs: number of processes of this machine that run the batches, and share the threads; with 1 this process
            does. The bytes are the same. Each imports the module that was started, as all of Python's own processes
            do: a script that asks for more than one needs its ``if __name__ == "__main__":``.

    Returns:
        A table along ``sample``, as ``run_chunk`` describes it; also in the store as NetCDF and CSV.

    Raises:
        Unwritable: the store cannot be written to.
        IncompatibleRecord: the store is another study's or another version's, or a worker has another version.
        NoCluster: the cluster was lost.
        ProcessesDied: the processes at a batch died again and again.
        OutsideLimits: less than one process is asked for, or several beside a cluster.
    """
    if jobs < 1:
        raise OutsideLimits(f"a study in {jobs} processes cannot be; at least 1 is needed.")
    if jobs > 1 and client is not None:
        raise OutsideLimits(f"a study takes a cluster or {jobs} processes of this machine, not both; choose one.")
    plan = Plan(study)
    with Store(folder, study).opened() as store, here(client):
        missing = [number for number in range(plan.chunks) if not store.has(number)]
        counter = _Counter(store, plan, missing, progress or _silent)
        if client is not None:
            tables = spread(partial(run_chunk, study), missing, client, name=study.name)
        elif min(jobs, len(missing)) > 1:
            tables = _in_processes(study, missing, jobs, counter)
        else:
            tables = ((i, run_chunk(study, number, counter.within(number))) for i, number in enumerate(missing))
        with closing(tables):
            for i, table in tables:
                store.put(missing[i], table)
                counter.finished(missing[i], table)
        return store.gather(plan.chunks)


def _in_processes(
    study: Study, numbers: list[int], jobs: int, counter: "_Counter"
) -> Generator[tuple[int, xr.Dataset], None, None]:
    """Run batches in processes of this machine, and yield them as they are finished, in any order."""
    with closing(side_by_side(partial(_batch, study), numbers, jobs, tries=_TRIES)) as heard:
        for i, said in heard:
            if isinstance(said, Done):
                yield i, said.value
            elif isinstance(said, Died):
                raise ProcessesDied(
                    f"the process at batch {numbers[i]} of study {study.name!r} ended with exit code {said.exit_code}, "
                    f"{_TRIES} times; what was finished is kept: where memory was short, ask for fewer --jobs or a "
                    "smaller chunk."
                )
            elif not isinstance(said, Begun):
                counter.within(numbers[i])(said.share)


def _batch(study: Study, number: int, tell: Tell) -> xr.Dataset:
    return run_chunk(study, number, lambda share: tell("", share))


def conducted(study: Study, progress: Callable[[float], None]) -> xr.Dataset:
    """Run a study in this process and keep nothing on disk: for small ones.

    Args:
        study: the study.
        progress: called with the share that is done.

    Returns:
        As of ``conduct``.
    """
    chunks = Plan(study).chunks
    tables = []
    for number in range(chunks):
        tables.append(run_chunk(study, number, lambda share, n=number: progress((n + share) / chunks)))  # type: ignore[misc]
        progress((number + 1) / chunks)
    return together(tables)


def finished(study: Study, folder: Path) -> xr.Dataset:
    """Return the results of the first batches of a store, up to the first that is not finished; nothing is checked.

    Args:
        study: whose batches they are.
        folder: its store.

    Raises:
        UnreadableFile: not even the first is finished.
    """
    store, tables = Store(folder, study), []
    for number in range(Plan(study).chunks):
        if not store.has(number):
            break
        tables.append(store.table(number))
    if not tables:
        raise UnreadableFile(f"{folder} holds no finished batch; start the study, or let it go on.")
    return together(tables)


class _Counter:
    """Counts runs and failures, those of an earlier start included, and the time of this one."""

    def __init__(self, store: Store, plan: Plan, missing: list[int], progress: Progress) -> None:
        self._plan = plan
        self._progress = progress
        self._before = len(plan) - sum(len(plan.chunk(number)) for number in missing)
        self._done = self._before
        self._failed = store.failures(set(range(plan.chunks)) - set(missing))
        self._start = time.perf_counter()
        self._shares: dict[int, float] = {}

    def within(self, number: int) -> Callable[[float], None]:
        """Return what tells of the share of a batch; several may be run at once."""

        def tell(share: float) -> None:
            self._shares[number] = share
            self._tell()

        return tell

    def finished(self, number: int, table: xr.Dataset) -> None:
        """Count a batch."""
        self._shares.pop(number, None)
        self._done += len(self._plan.chunk(number))
        self._failed += int((table.error != "").sum())
        self._tell()

    def _tell(self) -> None:
        done = self._done + sum(share * len(self._plan.chunk(number)) for number, share in self._shares.items())
        seconds = time.perf_counter() - self._start
        rate = (done - self._before) / seconds if seconds > 0 else 0.0
        self._progress(StudyProgress(done, len(self._plan), self._failed, rate))


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def _silent(progress: StudyProgress) -> None:
    del progress
