"""Cases in processes of their own: each gets a limit of memory and time, and what kills one kills nothing else.

``python tests/fuzz/farm.py NUMBER|FROM-TO ...`` runs cases of the long form again. The parent imports everything once
and makes the sound files; each child is a fork of it, warm at once, and carries out a batch of cases. It says on a pipe
which case begins and how each ended, so that a child that dies has a name to die by, and the next one goes on behind.
"""

import json
import os
import resource
import select
import signal
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

from doors import WEIGHTS, Doors
from hostile import KINDS, Hang, Range

BATCH = 100
"""Cases of a child [-]."""
MEMORY = 2 * 2**30
"""Address space that a child may take beyond what it begins with [byte]."""
FILE = 64 * 2**20
"""Size of a file that a case may write [byte]."""
STUCK = 30.0
"""Processor time of a case after which the system ends its child, where Python itself no longer hears [s]."""
WAITS = 240.0
"""Time without a word of a child after which it is killed [s]; others may be at this machine too."""
_SCALE = 10  # slots for each hundredth of the cases
_OTHERS = [kind for kind in KINDS if kind not in WEIGHTS]
_SLOTS = [kind for kind, weight in WEIGHTS.items() for _ in range(round(_SCALE * weight))]
_SLOTS += [_OTHERS[i % len(_OTHERS)] for i in range(100 * _SCALE - len(_SLOTS))]
Random(0).shuffle(_SLOTS)


class Came(NamedTuple):
    """What came of a case."""

    number: int
    """Of the case."""
    count: int
    """How many cases it was: of some kinds a number stands for a batch, of which each is judged."""
    refused: bool
    """Whether it ended in a sentence, at the door or later."""
    kind: str
    """Of which kind it was."""
    seconds: float
    """Processor time that it took [s]."""
    error: str
    """What was wrong; empty if nothing."""


def kind_of(number: int) -> Any:
    """Return the kind of a case of the farm."""
    return _SLOTS[number % len(_SLOTS)]


def carried_out(place: Range, numbers: Sequence[int]) -> Iterator[Came]:
    """Carry cases out, each batch in a child of its own, and yield what came of each.

    Args:
        place: where they happen; every child has it as it is now.
        numbers: of the cases.
    """
    left = list(numbers)
    while left:
        done = 0
        for came in _child(place, left[:BATCH]):
            done += 1
            yield came
        left = left[max(done, 1) :]


def _child(place: Range, numbers: Sequence[int]) -> Iterator[Came]:
    reading, writing = os.pipe()
    sys.stdout.flush()
    sys.stderr.flush()
    child = os.fork()
    if child == 0:
        os.close(reading)
        _carry_out(place, numbers, writing)
    os.close(writing)
    running, waited = None, False
    try:
        for word in _lines(reading, child):
            if isinstance(word, int):
                running, began = word, time.monotonic()
            else:
                running = None
                yield Came(*word)
        _, status, used = os.wait4(child, 0)
        waited = True
        if running is not None:
            took = min(used.ru_utime + used.ru_stime, time.monotonic() - began)
            yield Came(running, 1, False, kind_of(running).__name__, took, _ended(status))
    finally:
        os.close(reading)
        if not waited:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)


def _lines(reading: int, child: int) -> Iterator[Any]:
    """Yield what a child says until it ends; one that says nothing for too long is killed."""
    rest = b""
    while True:
        if not select.select([reading], [], [], WAITS)[0]:
            os.kill(child, signal.SIGKILL)
        data = os.read(reading, 2**16)
        if not data:
            return
        *lines, rest = (rest + data).split(b"\n")
        yield from map(json.loads, lines)


def _ended(status: int) -> str:
    if os.WIFSIGNALED(status):
        return f"the process was ended by {signal.Signals(os.WTERMSIG(status)).name}"
    return f"the process ended with {os.WEXITSTATUS(status)}"


def _carry_out(place: Range, numbers: Sequence[int], writing: int) -> None:
    """Do what a child does, and end it."""
    size = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (size + MEMORY, size + MEMORY))
    resource.setrlimit(resource.RLIMIT_FSIZE, (FILE, FILE))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # so that a file that grows too large is an error like a full disk
    hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
    for number in numbers:
        os.write(writing, f"{number}\n".encode())
        kind, began, wrong, count = kind_of(number), time.process_time(), "", 1
        resource.setrlimit(resource.RLIMIT_CPU, (int(began + STUCK) + 1, hard))
        try:
            count = place.carry_out(kind, number)
        except (Exception, Hang) as error:
            wrong = f"{type(error).__name__}: {error}"[:300]
        came = Came(number, max(count, 1), not count, kind.__name__, round(time.process_time() - began, 4), wrong)
        os.write(writing, (json.dumps(came) + "\n").encode())
    os._exit(0)


def alone() -> None:
    """Begin this process anew if libraries may start threads in it: a process of several threads cannot be forked."""
    names = ("SUCHUS_THREADS", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")
    single = dict.fromkeys(names, "1")
    if not single.items() <= os.environ.items():
        os.execve(sys.executable, [sys.executable, *sys.orig_argv[1:]], os.environ | single)


def main(words: Sequence[str]) -> int:
    """Run the cases that are named, say which failed and how many there were, and return 1 if one failed."""
    failed, count = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        doors = Doors(Path(folder))
        for word in words:
            first, _, last = word.partition("-")
            for came in carried_out(doors, range(int(first), int(last or first) + 1)):
                count += came.count
                if came.error:
                    failed += 1
                    print(f"{came.number} {came.kind}: {came.error}")
    print(f"{count} cases, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    alone()
    sys.exit(main(sys.argv[1:]))
