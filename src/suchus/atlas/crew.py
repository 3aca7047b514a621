"""Flows side by side, each in a process of its own. What is finished is kept, whatever happens to the others."""

import os
import signal
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from pathlib import Path

from suchus.atlas.case import Case, Tell
from suchus.atlas.outcome import Outcome, compute, digest_of, load_outcome, save_outcome
from suchus.errors import UnreadableFile

_EVERY = 0.2  # [s]; between two reports of one flow
_PATIENCE = 10.0  # [s]; for a process that was told to stop
_GONE = (EOFError, ConnectionError)  # what a pipe says when the other end has died


@dataclass(frozen=True, slots=True, kw_only=True)
class Told:
    """What is said of a flow while it is computed."""

    case: str
    """Its name."""
    share: float
    """How much of it is done [-]."""
    outcome: Outcome | None = None
    """What came of it, at its end."""


def compute_all(
    cases: Iterable[Case], folder: Path, *, jobs: int, quick: bool, tell: Callable[[Told], None]
) -> dict[str, Outcome]:
    """Compute flows that are not there yet, ``jobs`` at a time, and return the outcomes of all by name.

    An outcome is written as soon as it is there. One of the same set-up by the same code is kept.

    Args:
        cases: the flows; the longest should come first.
        folder: of the outcomes.
        jobs: processes at a time, each of which takes one thread; with 1 all is done here, on all threads.
        quick: whether only a trial is wanted.
        tell: takes what is to be said.

    Raises:
        Unwritable: an outcome cannot be written.
    """
    done, left = dict[str, Outcome](), list[Case]()
    for case in cases:
        old = finished(case, folder, quick=quick)
        if old is None:
            left.append(case)
        else:
            done[case.name] = old
            tell(Told(case=case.name, share=1.0, outcome=old))
    for outcome in _computed(left, jobs, quick, tell):
        done[outcome.case] = outcome
        if outcome.digest:  # that of a process that died says nothing of the flow
            save_outcome(outcome, folder)
        tell(Told(case=outcome.case, share=1.0, outcome=outcome))
    return done


def finished(case: Case, folder: Path, *, quick: bool) -> Outcome | None:
    """Return the outcome of a flow if it is there and of this set-up and code; one that is broken does not count."""
    with suppress(UnreadableFile):
        old = load_outcome(folder, case.name)
        if old is not None and old.digest == digest_of(case, quick=quick):
            return old
    return None


def _computed(
    cases: Sequence[Case], jobs: int, quick: bool, tell: Callable[[Told], None]
) -> Iterator[Outcome]:  # fmt: skip
    """Yield outcomes as they come; when the caller stops, by Ctrl-C or an error, the processes end."""
    if jobs == 1:
        yield from (compute(case, quick=quick, tell=_telling(case.name, tell)) for case in cases)
        return
    left, busy = list(cases), dict[Connection, tuple[BaseProcess, Case]]()
    try:
        while left or busy:
            while left and len(busy) < jobs:
                process, pipe = _begin(left[0], quick)
                busy[pipe] = (process, left.pop(0))
            ready = wait(list(busy))
            for pipe in [pipe for pipe in busy if pipe in ready]:
                process, case = busy[pipe]
                try:
                    said: float | Outcome = pipe.recv()
                except _GONE:
                    process.join(_PATIENCE)
                    said = _died(case, quick, process.exitcode)
                if isinstance(said, Outcome):
                    busy.pop(pipe)
                    pipe.close()
                    process.join(_PATIENCE)
                    yield said
                else:
                    tell(Told(case=case.name, share=said))
    finally:
        for process, _ in busy.values():
            process.kill()


def _telling(name: str, tell: Callable[[Told], None]) -> Tell:
    return lambda share: tell(Told(case=name, share=share))


def _died(case: Case, quick: bool, code: int | None) -> Outcome:
    effort = case.quick if quick else case.full
    return Outcome(
        case=case.name, digest="", quick=quick, cells=effort.cells, seconds=0.0,
        failed=f"its process ended with exit code {code}; where memory was short, --jobs 1 takes less of it.",
    )  # fmt: skip


def _begin(case: Case, quick: bool) -> tuple[BaseProcess, Connection]:
    spawning = get_context("spawn")
    here, there = spawning.Pipe()
    process = spawning.Process(target=_work, args=(there, case, quick), daemon=True)
    with _one_thread(), _deaf():
        process.start()
    there.close()
    return process, here


@contextmanager
def _one_thread() -> Iterator[None]:
    """Let processes that are started inside take one thread each."""
    before = os.environ.get("SUCHUS_THREADS")
    os.environ["SUCHUS_THREADS"] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ["SUCHUS_THREADS"]
        else:
            os.environ["SUCHUS_THREADS"] = before


@contextmanager
def _deaf() -> Iterator[None]:
    """Let processes that are started inside never hear Ctrl-C, which a terminal tells to all of them at once."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _work(pipe: Connection, case: Case, quick: bool) -> None:
    """Compute one flow and send its outcome; before that, now and then, how much of it is done."""
    last = -_EVERY

    def tell(share: float) -> None:
        nonlocal last
        if time.monotonic() - last > _EVERY:
            last = time.monotonic()
            pipe.send(share)

    with suppress(*_GONE):
        pipe.send(compute(case, quick=quick, tell=tell))
