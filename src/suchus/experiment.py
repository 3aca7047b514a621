"""The contract of an experiment: a frozen question, its outcome, and verdicts on the article's claims."""

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field
from typing import Any, ClassVar, Literal

import xarray as xr

from suchus.errors import UnknownName
from suchus.paper import CLAIMS, Claim

Word = Literal["reproduced", "same sense", "contradicted", "not testable"]
Progress = Callable[[str, float], None]
"""Called with what is being done and the share of it that is done, 0 to 1."""


def silent(stage: str, share: float) -> None:
    """Show no progress."""
    del stage, share


def staged(progress: Progress, stage: str, start: float, end: float) -> Callable[[float], None]:
    """Return a progress of one stage that fills the part from ``start`` to ``end`` of the whole."""
    return lambda share: progress(stage, start + share * (end - start))


@dataclass(frozen=True, slots=True)
class Measure:
    """A number with its unit."""

    value: float
    unit: str
    """SI unit, ``-`` for none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """What became of one claim of the article."""

    claim: Claim
    """What the article says."""
    measured: float | None
    """What was measured, in the claim's unit; None where nothing can be measured."""
    verdict: Word
    """The verdict in a word or two."""
    why: str
    """One or two sentences: what decided it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Replay:
    """A run to look at: a page of its own that plays in a browser."""

    caption: str
    """What there is to see."""
    make: Callable[[], str]
    """Makes the page, when it is wanted. See ``suchus.replay``."""

    @property
    def html(self) -> str:
        """The page; it needs nothing else."""
        return self.make()


@dataclass(frozen=True, slots=True, kw_only=True)
class Outcome:
    """What came out: numbers, verdicts, and the record they were read from."""

    experiment: str
    """Name on the shelf."""
    measures: Mapping[str, Measure]
    """Every number, by name."""
    verdicts: tuple[Verdict, ...]
    """One for each claim that the experiment touches."""
    record: xr.Dataset
    """What happened; figures are drawn from this alone."""
    settings: Mapping[str, Any]
    """The experiment's own fields, as plain values."""
    tables: Mapping[str, str] = field(default_factory=dict)
    """Further text files to stand beside the figures, by file name."""
    films: Mapping[str, bytes] = field(default_factory=dict)
    """Moving pictures to stand beside the figures: a GIF by file name; see ``figures.film``."""
    replays: Mapping[str, Replay] = field(default_factory=dict)
    """Runs to look at, to stand beside the figures, by file name ending in .html."""
    seconds: float = 0.0
    """How long the run took [s]."""


class Experiment(ABC):
    """A question with parameters. Subclasses are frozen dataclasses; their fields are the parameters."""

    __slots__ = ()

    title: ClassVar[str]
    """The question in one line, as a person would ask it."""
    shows: ClassVar[str]
    """Which sections, figures or equations of the article it answers."""
    claims: ClassVar[tuple[str, ...]] = ()
    """Keys of the article's claims that get a verdict."""
    in_reproduce: ClassVar[bool] = True
    """Whether ``suchus reproduce`` runs it in full (else in its quick form)."""
    decides: ClassVar[str] = ""
    """What decides the outcome: one paragraph for the report."""

    @abstractmethod
    def run(self, progress: Progress = silent) -> Outcome:
        """Answer the question."""

    @abstractmethod
    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Return matplotlib figures by name, drawn from ``outcome.record`` and nothing else.

        The first line of each figure's ``suchus_caption`` attribute is its caption; see ``figures.captioned``.
        """

    @abstractmethod
    def quick(self) -> "Experiment":
        """Return the same question, small enough for a test."""

    def settings(self) -> dict[str, Any]:
        """Return the fields as plain values."""
        return asdict(self)  # type: ignore[call-overload]

    @classmethod
    def name(cls) -> str:
        """Return the name on the shelf: the name of the module."""
        return cls.__module__.rpartition(".")[2]


def judge(
    key: str, measured: float | None, why: str, *, tolerance: float | None = None, holds: bool | None = None
) -> Verdict:
    """Return the verdict on one claim.

    ``reproduced``: the measured value lies within ``tolerance`` (in the claim's unit; the claim's own if None) of
    the printed one. ``same sense``: it does not, but the statement still holds (``holds``, or, if that is None, the
    measured value has the sign of the printed one). ``contradicted``: the statement does not hold. ``not testable``:
    nothing was measured.

    Args:
        key: key of the claim.
        measured: what was measured, or None.
        why: what decided it.
        tolerance: half-width of the band that counts as reproduced.
        holds: whether the statement, apart from its number, holds.

    Raises:
        UnknownName: no claim has this key.
    """
    if key not in CLAIMS:
        raise UnknownName("claim", key, CLAIMS)
    claim = CLAIMS[key]
    word: Word
    if measured is None:
        word = "not testable"
    elif claim.value is None:
        word = "reproduced" if holds else "contradicted"
    else:
        band = claim.tolerance if tolerance is None else tolerance
        agrees = measured * claim.value > 0 if holds is None else holds
        if abs(measured - claim.value) <= band and holds is not False:
            word = "reproduced"
        else:
            word = "same sense" if agrees else "contradicted"
    return Verdict(claim=claim, measured=measured, verdict=word, why=why)


@contextmanager
def stopwatch() -> Iterator[Callable[[], float]]:
    """Yield a function that tells the seconds since the block was entered."""
    start = time.perf_counter()
    yield lambda: time.perf_counter() - start
