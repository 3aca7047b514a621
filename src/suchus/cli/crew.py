"""Experiments side by side, in a few processes that take one after the other."""

import os
import signal
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import get_context, resource_tracker
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess

import suchus.experiments
from suchus import threads
from suchus.cli.attempt import Came, Task, attempt, failed
from suchus.cli.terminal import Bars
from suchus.experiment import Progress, silent
from suchus.record import sweep

_EVERY = 0.1  # [s]; between two reports of one stage
_PATIENCE = 10.0  # [s]; for a process that was told to stop
_GONE = (EOFError, ConnectionError)  # what a pipe says when the other end has died


@dataclass(slots=True, kw_only=True)
class _Worker:
    """A process, and what it is doing."""

    process: BaseProcess
    pipe: Connection
    task: Task | None = None
    move: Progress = silent


def side_by_side(tasks: Sequence[Task], jobs: int, bars: Bars) -> dict[str, Came]:
    """Run experiments in ``jobs`` processes, which share the threads, and return what came of each by name.

    They are begun in the order given. A process that dies takes its experiment with it and nothing else. When this
    one is stopped, by Ctrl-C or an error, the others end too, and leave nothing half-written.

    Args:
        tasks: the experiments.
        jobs: number of processes.
        bars: where progress is shown.
    """
    left, came = list(tasks), dict[str, Came]()
    each = max(threads.count() // jobs, 1)
    crew = [_hire(each) for _ in range(min(jobs, len(left)))]
    try:
        for worker in crew:
            _give(worker, left.pop(0), bars)
        while busy := {worker.pipe: worker for worker in crew if worker.task}:
            for pipe in wait(list(busy)):
                worker = busy[pipe]  # type: ignore[index]  # only connections are waited for
                said = _heard(worker)
                if not isinstance(said, Came):
                    worker.move(*said)
                    continue
                came[said.result.name] = said
                bars.say(said.told)
                worker.task = None
                if left and not worker.process.is_alive():
                    crew.remove(worker)
                    crew.append(worker := _hire(each))
                if left:
                    _give(worker, left.pop(0), bars)
    finally:
        _dismiss(crew)
    return came


def _hire(each: int) -> _Worker:
    """Start a process that takes ``each`` threads and knows the same shelf."""
    spawning = get_context("spawn")
    here, there = spawning.Pipe()
    shelf = list(suchus.experiments.__path__)
    work = spawning.Process(target=_work, args=(there, shelf, each), daemon=True)
    with _deaf():
        work.start()
    there.close()
    return _Worker(process=work, pipe=here)


def _give(worker: _Worker, task: Task, bars: Bars) -> None:
    worker.task, worker.move = task, bars.task(task.name)
    with suppress(*_GONE):  # it is heard of then
        worker.pipe.send(task)


def _heard(worker: _Worker) -> Came | tuple[str, float]:
    """Return what a busy worker says: what came of its experiment, or how far it is."""
    assert worker.task is not None
    try:
        said: Came | tuple[str, float] = worker.pipe.recv()
    except _GONE:
        worker.process.join(_PATIENCE)
        sweep(worker.task.out / worker.task.name)
        code = worker.process.exitcode
        return failed(
            worker.task.name,
            f"its process ended with exit code {code}; where memory was short, --jobs 1 takes less of it.",
        )
    return said


def _dismiss(crew: Sequence[_Worker]) -> None:
    """Let all processes end: the idle by themselves, the busy at once."""
    for worker in crew:
        worker.pipe.close()
        if worker.task is not None:
            worker.process.kill()
    for worker in crew:
        worker.process.join(_PATIENCE)
        if worker.task is not None:
            sweep(worker.task.out / worker.task.name)


@contextmanager
def _deaf() -> Iterator[None]:
    """Let processes that are started inside never hear Ctrl-C, which a terminal tells to all of them at once."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # which would let them hear it again, were it started with the first of them
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


# --- in the process of its own ---------------------------------------------------------------------------------


def _work(pipe: Connection, shelf: list[str], each: int) -> None:
    """Take one experiment after the other until the other end of the pipe is closed."""
    os.environ["SUCHUS_THREADS"] = str(each)
    suchus.experiments.__path__[:] = shelf
    with suppress(*_GONE):
        while True:
            pipe.send(attempt(pipe.recv(), _told(pipe)))


def _told(pipe: Connection) -> Progress:
    """Return a progress that is told to the other process now and then."""
    stage, last = "", -_EVERY

    def tell(what: str, share: float) -> None:
        nonlocal stage, last
        now = time.monotonic()
        if what != stage or now - last > _EVERY:
            stage, last = what, now
            pipe.send((what, share))

    return tell
