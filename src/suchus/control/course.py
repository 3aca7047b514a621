"""Numbers that may change over time, for a whole batch."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from jaxtyping import Float

Course = float | tuple[tuple[float, float], ...]
"""A number, or a table of time since the beginning of the run [s] and number; straight between, steady beyond."""


class Courses:
    """What changes over time, for a batch; most of it is constant."""

    def __init__(self, values: Sequence[Course]) -> None:
        self._steady = np.array([0.0 if isinstance(one, tuple) else one for one in values], dtype=float)
        tables = members([one if isinstance(one, tuple) else None for one in values])
        self._tables = [(np.array(table).T, runs) for table, runs in tables if table is not None]

    def at(self, time: float) -> Float[np.ndarray, " run"]:
        """Return the values at a time [s]."""
        found = self._steady.copy()
        for (times, values), runs in self._tables:
            found[runs] = np.interp(time, times, values)
        return found


def members(keys: Sequence[Any]) -> list[tuple[Any, np.ndarray]]:
    """Return each different key with the numbers of those that have it."""
    found: dict[Any, list[int]] = {}
    for i, key in enumerate(keys):
        found.setdefault(key, []).append(i)
    return [(key, np.array(runs)) for key, runs in found.items()]


def number(value: Any, low: float, high: float) -> bool:
    """Return whether something is a finite number within bounds."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and low <= value <= high


def mistake(value: Any, low: float, high: float) -> str:
    """Return what is wrong with a number or a table of them; empty if nothing."""
    if number(value, low, high):
        return ""
    rows = value if isinstance(value, tuple) else ()
    pairs = bool(rows) and all(isinstance(row, tuple) and len(row) == 2 for row in rows)
    within = pairs and all(number(time, 0.0, 1e6) and number(one, low, high) for time, one in rows)
    if within and all(one[0] < other[0] for one, other in pairwise(rows)):
        return ""
    return (
        f"is {str(value)[:80]}; a number of {low:g} to {high:g} is allowed, or pairs of a first number that increases "
        "from 0 and such a number"
    )
