"""How many threads suchus uses: the one place that decides.

Set ``SUCHUS_THREADS`` to choose another number than the cores this process may run on.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from suchus.core.errors import OutsideLimits

os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # threads that spin on and on starve their neighbours
# ... but to fall asleep and be woken costs 40 to 80 us at every parallel loop, as much as a small loop's own work. So a
# thread spins for about a millisecond first, which bridges what the flow solver does alone between its loops: two
# threads are 1.4 to 1.7 times one at 1024 x 512 cells, and 1.0 to 1.4 with 1000. Where more threads want to run than
# there are cores that spin is waste: set SUCHUS_THREADS=1 there.
os.environ.setdefault("GOMP_SPINCOUNT", "20000")

_SHARED_BY: ContextVar[int] = ContextVar("shared_by", default=1)


@contextmanager
def shared(sharers: int) -> Iterator[None]:
    """Let what the block computes use an equal share of the threads, at least one.

    Args:
        sharers: number of such blocks, which run at the same time in threads of their own [-].
    """
    token = _SHARED_BY.set(sharers)
    try:
        yield
    finally:
        _SHARED_BY.reset(token)


def count() -> int:
    """Return the number of threads to use.

    Raises:
        OutsideLimits: ``SUCHUS_THREADS`` is not a positive whole number.
    """
    return max(_thread_limit() // _SHARED_BY.get(), 1)


def _thread_limit() -> int:
    """Return the number of threads that all of this process may use."""
    setting = os.environ.get("SUCHUS_THREADS")
    if setting is None:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if not setting.isdecimal() or int(setting) < 1:
        raise OutsideLimits(f"SUCHUS_THREADS is {setting!r}; a whole number of at least 1 is needed.")
    return int(setting)
