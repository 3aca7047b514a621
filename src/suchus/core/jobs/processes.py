"""Pieces of work side by side, in a few processes of this machine that take one after the other."""

import os
import signal
import time
import warnings
from collections import Counter
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import get_context, resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Any, NamedTuple

from suchus.core import threads
from suchus.core.errors import Doubtful, NoMemory, SuchusError
from suchus.core.jobs.job import PieceCrash
from suchus.core.progress import Progress
from suchus.core.stopping import end_with_parent

_REPORT_INTERVAL = 0.1  # [s]; between two reports of one stage
_STOP_TIMEOUT = 10.0  # [s]; for a process that was told to stop
_PIPE_ERRORS = (EOFError, ConnectionError)  # what a pipe says when the other end has died


class PieceStarted(NamedTuple):
    """A process has taken a piece."""


class PieceProgress(NamedTuple):
    """How far a piece is."""

    stage: str
    """What it is at."""
    share: float
    """Finished fraction of the stage [-]."""


class PieceResult(NamedTuple):
    """A piece is finished."""

    value: Any
    """The result of the piece."""


class _PieceError(NamedTuple):
    """A piece ended with one of our own errors."""

    error: SuchusError
    """The refusal, to be raised where the work was asked for."""


class _PieceWarning(NamedTuple):
    """A piece warns."""

    warning: Warning
    """Of what; it is said where the work was asked for, so that what many pieces say is said once."""


@dataclass(slots=True, kw_only=True)
class Worker:
    """A process, and what it is doing."""

    process: BaseProcess
    """The process."""
    pipe: Connection
    """Pipe to the process."""
    piece: int | None = None
    """The number of the piece that it is at; None: it waits for one."""


def side_by_side(
    work: Callable[[Any, Progress], Any],
    items: Sequence[Any],
    jobs: int,
    *,
    tries: int = 1,
    threads_per_process: int | None = None,
) -> Generator[tuple[int, PieceStarted | PieceProgress | PieceResult | PieceCrash], None, None]:
    """Do one piece of work for each item in a few processes, and yield each message about the pieces.

    Pieces are begun in the order given. A process that dies takes its piece with it and nothing else. When the
    iteration ends early, by Ctrl-C, an error or ``close``, busy processes are killed; those of a process that was
    killed itself end with their piece, whose result is lost.

    Args:
        work: makes the result of an item, and tells how far it is; it, items and results travel as pickles.
        items: what differs between the pieces.
        jobs: number of processes.
        tries: how often a piece is started at most if its process dies [-].
        threads_per_process: threads that each process takes [-]; an equal share of all if None.

    Yields:
        The number of a piece, and what is heard of it: each ends with ``PieceResult`` or ``PieceCrash``.

    Raises:
        SuchusError: what the work of a piece raised.
    """
    pending, start_counts = list(range(len(items))), Counter[int]()
    jobs = min(jobs, len(pending))
    thread_count = max(threads.count() // max(jobs, 1), 1) if threads_per_process is None else threads_per_process
    workers = [hire(work, thread_count) for _ in range(jobs)]

    def give(worker: Worker) -> int:
        """Send the next pending item to an idle worker and return the number of its piece."""
        worker.piece = pending.pop(0)
        start_counts[worker.piece] += 1
        with suppress(*_PIPE_ERRORS):  # it is heard of then
            worker.pipe.send(items[worker.piece])
        return worker.piece

    try:
        for worker in workers:
            yield give(worker), PieceStarted()
        while busy := {worker.pipe: worker for worker in workers if worker.piece is not None}:
            for pipe in wait(list(busy)):
                worker = busy[pipe]  # type: ignore[index]  # only connections are waited for
                piece, message = worker.piece, _receive(worker)
                assert piece is not None
                if isinstance(message, _PieceError):
                    raise message.error
                if isinstance(message, _PieceWarning):
                    warnings.warn(message.warning, stacklevel=2)
                    continue
                if isinstance(message, PieceCrash) and start_counts[piece] < tries:
                    pending.insert(0, piece)
                else:
                    yield piece, message
                if isinstance(message, PieceProgress):
                    continue
                worker.piece = None
                if pending and isinstance(message, PieceCrash):
                    workers.remove(worker)
                    workers.append(worker := hire(work, thread_count))
                if pending:
                    yield give(worker), PieceStarted()
    finally:
        dismiss(workers)


def hire(work: Callable[[Any, Progress], Any], thread_count: int) -> Worker:
    """Start a process that takes ``thread_count`` threads."""
    spawning = get_context("spawn")
    parent_end, child_end = spawning.Pipe()
    process = spawning.Process(target=_work, args=(child_end, work, thread_count), daemon=True)
    with without_interrupts():
        process.start()
    child_end.close()
    return Worker(process=process, pipe=parent_end)


def dismiss(workers: Sequence[Worker]) -> None:
    """Let all processes end: the idle by themselves, the busy at once."""
    for worker in workers:
        worker.pipe.close()
        if worker.piece is not None:
            worker.process.kill()
    for worker in workers:
        worker.process.join(_STOP_TIMEOUT)


def _receive(worker: Worker) -> PieceProgress | PieceResult | PieceCrash | _PieceError | _PieceWarning:
    """Return the next message of a busy worker; ``PieceCrash`` where its process has ended."""
    try:
        message: PieceProgress | PieceResult | _PieceError | _PieceWarning = worker.pipe.recv()
    except _PIPE_ERRORS:
        worker.process.join(_STOP_TIMEOUT)
        return PieceCrash(worker.process.exitcode)
    return message


@contextmanager
def without_interrupts() -> Iterator[None]:
    """Block Ctrl-C in processes that are started inside, since a terminal sends it to all processes."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # which would let them hear it again, were it started with the first of them
    signal_mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, signal_mask)


# --- in the process of its own ---------------------------------------------------------------------------------


def _work(pipe: Connection, work: Callable[[Any, Progress], Any], thread_count: int) -> None:
    """Take one piece after the other until the other end of the pipe is closed."""
    os.environ["SUCHUS_THREADS"] = str(thread_count)
    end_with_parent()
    with suppress(*_PIPE_ERRORS), warnings.catch_warnings():
        warnings.showwarning = lambda message, *_, **__: pipe.send(_PieceWarning(_as_warning(message)))
        while True:
            item = pipe.recv()
            try:
                outcome: PieceResult | _PieceError = PieceResult(work(item, _sender(pipe)))
            except SuchusError as error:
                outcome = _PieceError(error)
            except MemoryError:
                outcome = _PieceError(NoMemory())
            pipe.send(outcome)


def _as_warning(message: Warning | str) -> Warning:
    """Return a warning that the other process can read, whatever class of the user's it is."""
    return message if isinstance(message, Doubtful) else UserWarning(str(message))


def _sender(pipe: Connection) -> Progress:
    """Return what tells the other process now and then."""
    last_stage, last_time = "", -_REPORT_INTERVAL

    def tell(stage: str, fraction: float) -> None:
        """Send a stage and its fraction, at most once in ``_REPORT_INTERVAL`` while the stage stays the same."""
        nonlocal last_stage, last_time
        clock_time = time.monotonic()
        if stage != last_stage or clock_time - last_time > _REPORT_INTERVAL:
            last_stage, last_time = stage, clock_time
            pipe.send(PieceProgress(stage, fraction))

    return tell
