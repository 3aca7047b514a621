"""Work that is larger than the machine bears, or than somebody may have meant: estimated and refused before it begins.

An estimate is of the size of the thing, not exact. What cannot be held is refused; what takes more than half of the
memory, or more than a day of a processor, waits until somebody says ``--large``.
"""

import os
import resource
from collections.abc import Iterator
from contextlib import contextmanager

from suchus.core.errors import InvalidDesign

OPTION = "--large"
"""Option of every command that lets large work begin."""
LARGE_VARIABLE = "SUCHUS_LARGE"
"""Environment variable that says the same, to the processes that help too."""
MAX_MEMORY_FRACTION = 0.5
"""Share of the memory from which on it is asked for [-]."""
MAX_PROCESSOR_TIME = 86400.0
"""Processor time from which on it is asked for [s]."""


@contextmanager
def allowing(is_allowed: bool = True) -> Iterator[None]:
    """While the block runs, let large work begin, if asked."""
    environment_value = os.environ.get(LARGE_VARIABLE)
    if is_allowed:
        os.environ[LARGE_VARIABLE] = "1"
    try:
        yield
    finally:
        if is_allowed:
            os.environ.pop(LARGE_VARIABLE)
            os.environ.update({} if environment_value is None else {LARGE_VARIABLE: environment_value})


def allowed() -> bool:
    """Return whether large work may begin."""
    return os.environ.get(LARGE_VARIABLE, "") not in ("", "0")


def memory() -> int | None:
    """Return the memory of this process at most: the machine's, or less by ``ulimit``; None where none says [bytes]."""
    try:
        physical_memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        physical_memory = None
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    limits = [
        size for size in (physical_memory, None if limit == resource.RLIM_INFINITY else limit) if size is not None
    ]
    return min(limits, default=None)


def check_memory(subject: str, need: float, remedy: str) -> None:
    """Refuse what the memory cannot hold, or not beside much else unless it is allowed.

    Args:
        subject: what takes the memory, as the subject of a sentence in the singular.
        need: an estimate [bytes].
        remedy: what to do instead.

    Raises:
        InvalidDesign: with both numbers.
    """
    have = memory()
    if have is None or need <= MAX_MEMORY_FRACTION * have or (allowed() and need <= have):
        return
    size_text = f"{subject} takes some {need / 1e9:.3g} GB of memory, and this machine has {have / 1e9:.3g} GB"
    raise InvalidDesign(f"{size_text}; {remedy}{'' if need > have else f', or say {OPTION} to begin all the same'}.")


def check_work(subject: str, seconds: float, remedy: str) -> None:
    """Refuse what would compute for more than a day, unless it is allowed.

    Args:
        subject: what computes, as the subject of a sentence in the singular.
        seconds: an estimate of the processor time [s].
        remedy: what to do instead.

    Raises:
        InvalidDesign: with the estimate.
    """
    if seconds > MAX_PROCESSOR_TIME and not allowed():
        time_text = f"{subject} takes some {seconds / MAX_PROCESSOR_TIME:.3g} days of a processor"
        raise InvalidDesign(f"{time_text}; {remedy}, or say {OPTION} to begin all the same.")
