"""Many calculations of any kind, each from its own settings: kept, resumed and put on a cluster as a study is."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import xarray as xr

from suchus.core.checks import Checks
from suchus.core.fingerprint import fingerprint
from suchus.core.jobs.engine import finish
from suchus.core.jobs.job import Job
from suchus.core.jobs.made_by import FLOW_SOURCES, source_versions
from suchus.core.jobs.places import place_for
from suchus.core.jobs.store import Store
from suchus.core.progress import Progress, silent

Item = TypeVar("Item")
KIND = "sweep"


@dataclass(frozen=True, slots=True, kw_only=True)
class _Sweep:
    """Identity of a sweep, as its store keeps it."""

    name: str
    """Name of the sweep."""
    work: str
    """Fingerprint of the calculation."""
    items: tuple[str, ...]
    """Fingerprints of the settings, in their order."""

    def __post_init__(self) -> None:
        with Checks("sweep", self) as check:
            check.that(len(self.items) > 0, "sweep.items is empty; give at least one")


def conduct_sweep(
    name: str,
    work: Callable[[Item, Progress], xr.Dataset],
    items: Sequence[Item],
    folder: str | Path,
    *,
    rooms: Sequence[str] = FLOW_SOURCES,
    progress: Progress = silent,
    client: Any = None,
    jobs: int = 1,
    local: Callable[[Item, Progress], xr.Dataset] | None = None,
) -> list[xr.Dataset]:
    """Do one calculation for each item, what is not in the store yet, and return all results in order.

    Results are stored as they come: whatever stops the program, only what was being calculated is lost. Started again
    it goes on, here or on a cluster, and ends with the same bytes as if nothing had happened.

    Args:
        name: how the sweep is called.
        work: calculates from an item alone, and tells how far it is. Its code and
            what it was made with belong to the store, as the items do: rewritten it is another sweep's. For a cluster
            it stands in a module that the workers can import, or in the script that is run.
        items: settings: numbers, arrays, frozen values, tuples of them.
        folder: the store.
        rooms: packages of suchus whose source decides the results, see ``record.code_digest``.
        progress: told how much of the sweep is done.
        client: a ``distributed.Client``, whose workers then calculate; this machine if None. The bytes are the same.
        jobs: processes of this machine that calculate side by side and share its threads; 1 is this one [-].
        local: calculates the same on this machine, where it may keep what is unfinished; ``work`` if None.

    Raises:
        Unwritable: the store cannot be written to.
        IncompatibleRecord: the store is another sweep's or another version's, or a worker has another version.
        NoCluster: the cluster was lost.
        ProcessDied: one of several processes did, as often as it was begun; what was finished is kept.
    """
    place = place_for("a sweep", client=client, jobs=jobs)
    identity = _Sweep(name=name, work=fingerprint(work), items=tuple(fingerprint(item) for item in items))
    versions = partial(source_versions, rooms, ("numba",))
    job = Job(
        name=name,
        kind=KIND,
        piece="item",
        unit="items",
        work=work if client is not None or local is None else local,
        items=items,
        versions=versions,
    )
    with Store(folder, identity, kind=KIND, versions=versions).opened() as store:
        finish(job, store, place=place, progress=progress)
        return [store.get(number) for number in range(len(items))]
