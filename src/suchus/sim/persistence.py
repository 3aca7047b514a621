"""How long a fault stays: for ever, for a time, or in spells that come and go."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import ceil, inf, isfinite
from typing import Literal
from zlib import crc32

import numpy as np

from suchus.core.checks import Checks

_MAX_RATE = 1e4  # [1/s]
_TICK_TOLERANCE = 1e-9  # rounding tolerance of a time over the control period [-]


@dataclass(frozen=True, slots=True, kw_only=True)
class Persistence:
    """When a fault is present after its onset: permanent, transient or intermittent.

    A fault with a ``rate`` comes and goes by a two-state Markov process: the first spell begins at the onset, its
    length is exponential with the mean ``length``, and so is the time until the next one with the mean ``1 / rate``.
    The spells follow from ``seed`` and the name of the part: equal faults of two joints are independent, equal values
    repeat.

    Source: Avizienis et al. 2004 (IEEE Trans. Dependable Secur. Comput. 1, 11) for the terms, Gilbert 1960 (Bell Syst.
    Tech. J. 39, 1253) for the process.
    """

    duration: float = inf
    """Time from the onset to the recovery, after which the part is as it was built [s]; more than 0."""
    rate: float = 0.0
    """Spells that begin in a second without the fault [1/s]; 0: the fault is present all the time."""
    length: float = 0.0
    """Mean length of a spell [s]; more than 0 where there is a rate."""
    seed: int = 0
    """Seed of the spells [-]."""

    def __post_init__(self) -> None:
        """Refuse times and rates that cannot be, and a rate without a length."""
        with Checks("persistence", self) as check:
            if self.duration != inf:
                check.number("duration", 1e-6, 1e9, "s")
            check.number("rate", 0.0, _MAX_RATE, "1/s")
            check.number("length", 0.0, 1e9, "s")
            check.whole("seed", 0, 2**32 - 1)
            check.that(
                (self.rate > 0.0) == (self.length > 0.0),
                f"an intermittent fault needs a rate and a length of its spells, both above 0; rate is "
                f"{self.rate!r} and length {self.length!r}",
            )

    @property
    def kind(self) -> Literal["permanent", "transient", "intermittent"]:
        """What it is called."""
        if self.rate > 0.0:
            return "intermittent"
        return "transient" if self.duration < inf else "permanent"

    @property
    def presence(self) -> float:
        """Fraction of the time in which the fault is present in the long run, before its recovery [-]."""
        return self.length / (self.length + 1.0 / self.rate) if self.rate > 0.0 else 1.0

    def spells(self, part: str) -> Iterator[tuple[float, float]]:
        """Yield start and end of each spell since the onset, one after the other [s].

        Args:
            part: name of the part that breaks.
        """
        if self.rate <= 0.0:
            yield 0.0, self.duration
            return
        random = np.random.default_rng([self.seed, crc32(part.encode())])
        start = 0.0
        while start < self.duration:
            end = start + float(random.exponential(self.length))
            yield start, min(end, self.duration)
            start = end + float(random.exponential(1.0 / self.rate))

    def spell_ticks(self, part: str, onset: float, period: float) -> Iterator[tuple[int, int | None]]:
        """Yield the control periods in which each spell begins and ends; None for a spell that does not end.

        A spell is present in the control periods that begin within it. One without such a period is left out, and
        spells without a period between them are one.

        Args:
            part: name of the part that breaks.
            onset: time at which the fault begins [s].
            period: control period [s].
        """
        begin: int | None = None
        end = 0
        for start, stop in self.spells(part):
            first = ceil((onset + start) / period - _TICK_TOLERANCE)
            last = ceil((onset + stop) / period - _TICK_TOLERANCE) if isfinite(stop) else None
            if begin is not None and first > end:
                yield begin, end
                begin = None
            if last is None:
                yield (first if begin is None else begin), None
                return
            if last > first:
                begin, end = (first if begin is None else begin), last
        if begin is not None:
            yield begin, end


PERMANENT = Persistence()
"""A fault that stays."""
