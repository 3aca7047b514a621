"""Many calculations of any kind, each from its own settings: kept, resumed and put on a cluster as a study is."""

from collections.abc import Callable, Generator, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import xarray as xr

from suchus import workers
from suchus.design.checks import Checks
from suchus.errors import SuchusError, plain_warnings
from suchus.fingerprint import fingerprint
from suchus.study.cluster import here, spread
from suchus.study.makers import deciding
from suchus.study.store import Store

Item = TypeVar("Item")
Progress = Callable[[float], None]
KIND = "sweep"
FLOW = ("blueprint", "catalog.py", "design", "fingerprint.py", "flow", "hydro", "isosurface.py", "kinds.py",
        "kinematics", "motion", "paper", "reading.py", "record", "robots", "rotation.py", "sources.py",
        "water")  # fmt: skip
"""Rooms whose code decides the numbers of a swim by CFD."""


class ProcessDied(SuchusError, ChildProcessError):
    """A process that calculated ended before it was done."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Asked:
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
    folder: Path,
    *,
    rooms: Sequence[str] = FLOW,
    progress: Progress | None = None,
    client: Any = None,
    jobs: int = 1,
    local: Callable[[Item, Progress], xr.Dataset] | None = None,
) -> list[xr.Dataset]:
    """Do one calculation for each item, what is not in the store yet, and return all results in order.

    Results are stored as they come: whatever stops the program, only what was being calculated is lost. Started again
    it goes on, here or on a cluster, and ends with the same bytes as if nothing had happened.

    Args:
        name: how the sweep is called.
        work: calculates from an item alone, and reports the share that is done to a function. Its code and
            what it was made with belong to the store, as the items do: rewritten it is another sweep's. For a cluster
            it stands in a module that the workers can import, or in the script that is run.
        items: settings: numbers, arrays, frozen values, tuples of them.
        folder: the store.
        rooms: of suchus whose source decides the results, see ``record.code_digest``.
        progress: called with the share that is done.
        client: a ``distributed.Client``, whose workers then calculate; this machine if None. The bytes are the same.
        jobs: processes of this machine that calculate side by side and share its threads; 1 is this one [-].
        local: calculates the same on this machine, where it may keep what is unfinished; ``work`` if None.

    Raises:
        Unwritable: the store cannot be written to.
        IncompatibleRecord: the store is another sweep's or another version's, or a worker has another version.
        NoCluster: the cluster was lost.
        ProcessDied: one of several processes did, twice at the same item; what was finished is kept.
    """
    asked = _Asked(name=name, work=fingerprint(work), items=tuple(fingerprint(item) for item in items))
    versions = partial(deciding, ("numba",), tuple(rooms))
    tell = progress or _silent
    with Store(folder, asked, kind=KIND, versions=versions).opened() as store, here(client):
        missing = [number for number in range(len(items)) if not store.has(number)]
        left, done = [items[number] for number in missing], len(items) - len(missing)

        def under_way(share: float) -> None:
            tell((done + share) / len(items))

        if client is not None:
            results = spread(partial(_quietly, work), left, client, name=name, versions=versions)
        elif jobs > 1:
            results = _in_processes(name, local or work, left, jobs, under_way)
        else:
            results = ((i, (local or work)(item, under_way)) for i, item in enumerate(left))
        with closing(results):
            for i, result in results:
                store.put(missing[i], result)
                done += 1
                tell(done / len(items))
        return [_as_made(store.table(number)) for number in range(len(items))]


def _in_processes(
    name: str, work: Callable[[Item, Progress], xr.Dataset], items: Sequence[Item], jobs: int, tell: Progress
) -> Generator[tuple[int, xr.Dataset], None, None]:
    """Yield the results of items, calculated side by side, with their numbers; tell the sum of the shares under way."""
    shares: dict[int, float] = {}
    with closing(workers.side_by_side(partial(_telling, name, work), items, jobs, tries=2)) as heard:
        for number, said in heard:
            if isinstance(said, workers.Far):
                shares[number] = said.share
                tell(sum(shares.values()))
            elif isinstance(said, workers.Done):
                shares.pop(number, None)
                yield number, said.value
            elif isinstance(said, workers.Died):
                raise ProcessDied(
                    f"a process of sweep {name!r} ended with exit code {said.exit_code}, twice at item {number}; what "
                    "was finished is kept. Where memory was short, fewer processes take less of it."
                )


def _telling(
    name: str, work: Callable[[Item, Progress], xr.Dataset], item: Item, tell: workers.Tell
) -> xr.Dataset:  # fmt: skip
    with plain_warnings(name):
        return work(item, partial(tell, ""))


def _quietly(work: Callable[[Item, Progress], xr.Dataset], item: Item) -> xr.Dataset:
    return work(item, _silent)


def _as_made(table: xr.Dataset) -> xr.Dataset:
    """Return a part without what the store notes on it."""
    table.attrs = {name: value for name, value in table.attrs.items() if name not in ("part", "study")}
    return table


def _silent(share: float) -> None:
    del share
