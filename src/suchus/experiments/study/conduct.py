"""Conducting a study: every batch that is not there yet, then all results together."""

from functools import partial
from pathlib import Path
from typing import Any

import xarray as xr

from suchus.core import large
from suchus.core.errors import UnreadableFile
from suchus.core.jobs import InMemory, Job, Store, ThisProcess, finish, place_for
from suchus.core.jobs.store import concatenate_tables
from suchus.core.progress import Progress, silent
from suchus.experiments.study.chunk import run_chunk
from suchus.experiments.study.plan import Plan
from suchus.experiments.study.study import Study
from suchus.sim.land.extent import processor_seconds

LOCAL_PLACE = ThisProcess(at_once=2)
"""How this process runs batches: while the physics steps one, the other is built, measured or packed."""


def conduct(
    study: Study, folder: str | Path, *, progress: Progress = silent, client: Any = None, jobs: int = 1
) -> xr.Dataset:
    """Run what of a study is not in its store yet, and return all results.

    Batches are stored as they are finished: whatever stops the program, at most the running batches are lost. Started
    again it goes on, and ends with the same bytes as if nothing had happened.

    Args:
        study: the study.
        folder: its store.
        progress: told how many runs are done, of parts of batches too.
        client: a ``distributed.Client``, whose workers then run the batches; this machine if None. The bytes are the
            same.
        jobs: number of processes of this machine that run the batches, and share the threads; with 1 this process
            does, two at a time. The bytes are the same. Each imports the module that was started, as all of Python's
            own processes do: a script that asks for more than one needs its ``if __name__ == "__main__":``.

    Returns:
        A table along ``sample``, as ``run_chunk`` describes it; also in the store as NetCDF and CSV.

    Raises:
        Unwritable: the store cannot be written to.
        IncompatibleRecord: the store is another study's or another version's, or a worker has another version.
        NoCluster: the cluster was lost.
        ProcessDied: the processes at a batch died again and again.
        OutsideLimits: less than one process is asked for, or several beside a cluster.
        InvalidDesign: it is larger than anybody asked for.
    """
    place, job = place_for("a study", client=client, jobs=jobs, local_place=LOCAL_PLACE), job_of(study)
    check_study(study)
    with Store(folder, study).opened() as store:
        finish(job, store, place=place, progress=progress)
        return store.gather(len(job.items))


def check_study(study: Study) -> None:
    """Refuse a study that computes for more than a day, unless that is asked for, see ``suchus.core.large``.

    Raises:
        InvalidDesign: with the estimate.
    """
    count = len(Plan(study))
    seconds = count * processor_seconds(study.run, study.duration, study.timestep)
    large.check_work(f"study {study.name!r} of {count} runs", seconds, "ask for fewer samples or shorter runs")


def job_of(study: Study) -> Job[int, xr.Dataset]:
    """Return what is to be done for a study: its batches, by their numbers."""
    plan = Plan(study)
    return Job(
        name=study.name,
        kind="study",
        piece="batch",
        unit="runs",
        work=partial(run_chunk, study),
        items=range(plan.chunks),
        sizes=[len(plan.chunk(number)) for number in range(plan.chunks)],
        failures=_failures,
    )


def conducted(study: Study, progress: Progress = silent) -> xr.Dataset:
    """Run a study in this process and keep nothing on disk: for small ones.

    Args:
        study: the study.
        progress: told how many runs are done.

    Returns:
        As of ``conduct``.
    """
    job, results = job_of(study), InMemory[xr.Dataset]()
    finish(job, results, place=LOCAL_PLACE, progress=progress)
    return concatenate_tables([results.get(number) for number in job.items])


def finished(study: Study, folder: Path) -> xr.Dataset:
    """Return the results of the first batches of a store, up to the first that is not finished; nothing is checked.

    Args:
        study: study whose batches they are.
        folder: its store.

    Raises:
        UnreadableFile: not even the first is finished.
    """
    store, tables = Store(folder, study), []
    for number in range(Plan(study).chunks):
        if not store.has(number):
            break
        tables.append(store.get(number))
    if not tables:
        raise UnreadableFile(f"{folder} holds no finished batch; start the study, or let it go on.")
    return concatenate_tables(tables)


def _failures(table: xr.Dataset) -> int:
    """Return how many runs of a batch failed."""
    return int((table.error != "").sum())
