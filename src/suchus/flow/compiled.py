"""The one place that knows how the flow kernels are compiled.

Row kernels take whole arrays and the numbers of rows and columns, which they make ``unsigned``: an index such as
``i - 1`` of a signed ``i`` may be negative to the compiler, which then guards every access and does not vectorise (13
times slower). A row cut out of an array beforehand costs 15 ns for the counting of its references, which with ten of
them is as much as the work on 512 cells. Threads share rows in blocks of ``BLOCK``; a sum is kept per row and added up
in order, so that the same bytes come out on any number of threads.
"""

from collections.abc import Callable
from typing import ParamSpec, TypeVar

import numba
import numpy as np

P = ParamSpec("P")
R = TypeVar("R")

BLOCK = 32
"""Rows that one thread takes at a time [-]."""

SERIAL_BELOW = 4_096
"""Levels with fewer cells than this run on one thread: starting threads would take longer [-]."""

PAD = 2
"""Rows and columns around the domain, for the boundary values [-]."""

unsigned = np.uint64
"""What rows and columns are counted in by the kernels."""

UNIT = unsigned(1)
"""One, as they count: with a signed one, numbers of rows would become floats [-]."""

Window = tuple[int, int, int, int]
"""Padded cell indices j0, j1, i0, i1 around the bodies."""

# No "nnan" and no "ninf": a NaN must stay visible.
_FAST = {"contract", "reassoc", "nsz", "arcp"}


def _compile(function: Callable[P, R], parallel: bool) -> Callable[P, R]:
    options = {"fastmath": _FAST, "error_model": "numpy", "nogil": True, "parallel": parallel}
    try:
        made: Callable[P, R] = numba.njit(cache=True, **options)(function)
    except RuntimeError:  # neither this folder nor the user's cache can be written: compile anew every time
        made = numba.njit(**options)(function)
    return made


def compiled(function: Callable[P, R]) -> Callable[P, R]:
    """Compile ``function``; keep the code on disk (``NUMBA_CACHE_DIR`` moves it)."""
    return _compile(function, parallel=False)


def threaded(function: Callable[P, R]) -> Callable[P, R]:
    """Compile ``function``, whose ``prange`` loops run on several threads."""
    return _compile(function, parallel=True)
