"""Places that compute the pieces of a job: this process, processes of this machine, or a Dask cluster."""

import sys
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import count
from queue import SimpleQueue
from threading import Event, Thread
from typing import Any, NamedTuple, Protocol

from suchus.core import threads
from suchus.core.errors import OutsideLimits
from suchus.core.jobs import cluster, processes
from suchus.core.jobs.job import AnyJob, PieceCrash
from suchus.core.progress import Progress, silent

StartPiece = Callable[[int], Progress]
"""Called with the number of a piece when it starts; returns the callback for its progress."""
Results = Generator[tuple[int, Any], None, None]
"""Numbers of pieces and their results, ``PieceCrash`` where there is none, as they are finished, in any order."""
_SWITCH = 5e-4  # [s]; Python's own 5 ms are two physics steps of a batch, for which another thread would wait each time


class Place(Protocol):
    """Computes pieces of work, some at once; the place and the number at once change no result."""

    @property
    def at_once(self) -> int:
        """Pieces that are done at once [-]."""

    def results(self, job: AnyJob, items: Sequence[Any], start_piece: StartPiece) -> Results:
        """Do the work of a job for each item, and yield each result when it is finished.

        If the iteration ends early, by an error, Ctrl-C or ``close``, pieces in progress are stopped.

        Args:
            job: the work and its settings.
            items: item of each piece.
            start_piece: called with the index of an item when its piece starts.

        Raises:
            SuchusError: what the work of a piece raised, or that the place is lost.
        """


@dataclass(frozen=True, slots=True)
class ThisProcess:
    """Pieces in this process, side by side in threads that share those of the physics.

    Two of a study at once keep both cores of a machine busy: one is built, measured and packed by Python, which runs
    in one thread at a time, while MuJoCo steps the other.
    """

    at_once: int = 1
    """Pieces that are done at once [-]; with one all is done in the thread that asks."""

    def results(self, job: AnyJob, items: Sequence[Any], start_piece: StartPiece) -> Results:
        """Yield the results, with one piece at once in the order of the items; see ``Place``."""
        side_by_side = min(self.at_once, len(items), threads.count())
        if side_by_side > 1:
            yield from _in_threads(job, items, start_piece, side_by_side)
        else:
            yield from ((i, job.work(item, start_piece(i))) for i, item in enumerate(items))


@dataclass(frozen=True, slots=True)
class Processes:
    """Pieces in processes of this machine, which take one piece after the other.

    Each imports the module that was started, as all of Python's own processes do: a script that asks for them needs
    its ``if __name__ == "__main__":``.
    """

    at_once: int
    """Number of processes [-]."""
    each: int | None = None
    """Threads that each of them takes [-]; an equal share of all if None."""

    def results(self, job: AnyJob, items: Sequence[Any], start_piece: StartPiece) -> Results:
        """Yield the results; a process that dies takes its piece with it and nothing else, see ``Place``."""
        reports: dict[int, Progress] = {}
        with closing(
            processes.side_by_side(job.work, items, self.at_once, tries=job.tries, threads_per_process=self.each)
        ) as messages:
            for number, message in messages:
                if isinstance(message, processes.PieceStarted):
                    reports[number] = start_piece(number)
                elif isinstance(message, processes.PieceProgress):
                    reports[number](*message)
                else:
                    yield number, message if isinstance(message, PieceCrash) else message.value


@dataclass(frozen=True, slots=True)
class Cluster:
    """Pieces on the workers of a Dask cluster, which are told of when they are finished and not before."""

    client: Any
    """A ``distributed.Client``."""

    @property
    def at_once(self) -> int:
        """Pieces that the workers do at once [-]."""
        return cluster.cores(self.client)

    def results(self, job: AnyJob, items: Sequence[Any], start_piece: StartPiece) -> Results:
        """Yield the results; a worker that is lost loses its piece, which another one begins again, see ``Place``."""
        del start_piece
        work = partial(_silently, job.work)
        yield from cluster.spread(work, items, self.client, name=job.name, versions=job.versions, retries=job.tries)


IN_PROCESS = ThisProcess()
"""One piece after the other, in this process."""


def place_for(
    job_text: str,
    *,
    client: Any = None,
    jobs: int = 1,
    threads_per_process: int | None = None,
    local_place: Place = IN_PROCESS,
) -> Place:
    """Return the place that computes a job.

    Args:
        job_text: name of the job in messages, as ``a study``.
        client: a ``distributed.Client``, whose workers then do it; None for this machine.
        jobs: number of processes of this machine; with 1 this process does it [-].
        threads_per_process: threads that each of several processes takes [-]; an equal share of all if None.
        local_place: how this process does it.

    Raises:
        OutsideLimits: less than one process is asked for, or several beside a cluster.
    """
    if jobs < 1:
        raise OutsideLimits(f"{job_text} in {jobs} processes cannot be; at least 1 is needed.")
    if jobs > 1 and client is not None:
        raise OutsideLimits(f"{job_text} takes a cluster or {jobs} processes of this machine, not both; choose one.")
    if client is not None:
        return Cluster(client)
    return Processes(jobs, threads_per_process) if jobs > 1 else local_place


def _silently(work: Callable[[Any, Progress], Any], item: Any) -> Any:
    return work(item, silent)


# --- threads of this process --------------------------------------------------------------------------------------


class _StopPiece(BaseException):
    """Stops a thread inside its piece; no piece catches it, since it is no ``Exception``."""


class _News(NamedTuple):
    """A message of a thread about its piece."""

    number: int
    """Number of the piece."""
    kind: str
    """``begun``, ``far``, ``done`` or ``raised``."""
    value: Any = None
    """Nothing, the stage and the share, the result, or the error."""


def _in_threads(job: AnyJob, items: Sequence[Any], start_piece: StartPiece, side_by_side: int) -> Results:
    """Compute pieces in threads; the calling thread reports progress and yields the results."""
    news, stop, numbers = SimpleQueue[_News](), Event(), count()
    workers = [
        Thread(target=_work, args=(job.work, items, numbers, news, stop, side_by_side), daemon=True)
        for _ in range(side_by_side)
    ]
    reports: dict[int, Progress] = {}
    finished = 0
    with _quick_switches():
        try:
            for worker in workers:
                worker.start()
            while finished < len(items):
                number, kind, value = news.get()
                if kind == "begun":
                    reports[number] = start_piece(number)
                elif kind == "far":
                    reports[number](*value)
                elif kind == "done":
                    finished += 1
                    yield number, value
                else:
                    raise value
        finally:
            stop.set()
            for worker in workers:
                worker.join()


def _work(
    work: Callable[[Any, Progress], Any],
    items: Sequence[Any],
    numbers: Iterator[int],
    news: "SimpleQueue[_News]",
    stop: Event,
    side_by_side: int,
) -> None:
    """Do one piece after the other until none is left; the threads of the physics are shared by all that do so.

    Args:
        work: computes the result of an item.
        items: items of all pieces.
        numbers: yields the number of the next piece; all threads share it.
        news: queue for messages to the calling thread.
        stop: set where the pieces shall stop.
        side_by_side: number of threads that compute pieces [-].
    """
    last_round_start = len(items) - len(items) % side_by_side  # of the pieces from here on there are fewer than threads

    def tell(number: int, stage: str, fraction: float) -> None:
        if stop.is_set():
            raise _StopPiece
        news.put(_News(number, "far", (stage, fraction)))

    while not stop.is_set() and (number := next(numbers)) < len(items):
        news.put(_News(number, "begun"))
        try:
            with threads.shared(side_by_side if number < last_round_start else len(items) - last_round_start):
                news.put(_News(number, "done", work(items[number], partial(tell, number))))
        except _StopPiece:
            return
        except BaseException as error:  # to be raised where the work was asked for
            news.put(_News(number, "raised", error))
            return


@contextmanager
def _quick_switches() -> Iterator[None]:
    """Let a thread that comes back from the physics go on soon, whatever Python the others are at."""
    switch_interval = sys.getswitchinterval()
    sys.setswitchinterval(min(switch_interval, _SWITCH))
    try:
        yield
    finally:
        sys.setswitchinterval(switch_interval)
