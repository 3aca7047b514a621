"""A contestant: a real machine or animal, what is known of it, and what is predicted of it before anyone looks."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite
from typing import NamedTuple

from suchus.core.errors import InvalidDesign, UnknownName
from suchus.core.progress import Progress

Numbers = Mapping[str, float]
"""One choice of all the numbers that a prediction rests on, by their names in ``Contestant.inputs``."""
Value = float | tuple[float, ...]
"""What is predicted of a quantity: a number, or several in a row, as speeds in the first periods."""
Found = Mapping[str, Value]
"""By quantity; a rung leaves out what it cannot say."""
Work = Callable[[Sequence[Numbers], Progress], Sequence[Found]]
"""Predicts for each of several choices of the numbers."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Given:
    """A number that a prediction rests on: from a drawing, a log or a publication, or unknown within a range."""

    value: float
    """What is taken as the most likely."""
    low: float
    """Least plausible value."""
    high: float
    """Greatest plausible value; that of ``low`` where it is known."""
    unit: str
    """SI unit, ``-`` for none."""
    source: str
    """Source of value and range: a publication, a file, or the reason for the range where nothing is published."""


def known(value: float, unit: str, source: str) -> Given:
    """Return a number without a range."""
    return Given(value=value, low=value, high=value, unit=unit, source=source)


@dataclass(frozen=True, slots=True, kw_only=True)
class Quantity:
    """What is predicted."""

    unit: str
    """Unit, ``-`` for none."""
    words: str
    """What it is, for people, as a phrase."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Predictor:
    """A model that predicts, from formulas to the flow in space."""

    words: str
    """What it is, for people."""
    work: Work
    """Predicts; with ``draws`` of 0 it is asked for the most likely numbers alone and returns several answers, each of
    which is plausible, the best one first."""
    draws: int
    """Choices of the numbers drawn from their ranges, beside the most likely one [-]; 0 for an expensive model."""
    interval_source: str = ""
    """Of an expensive model: the one whose interval, over its value, it takes beside its own answers."""

    def __post_init__(self) -> None:
        if self.draws == 0 and not self.interval_source:
            raise InvalidDesign(
                "a rung without draws has no interval of its own: name in like the rung whose interval it takes."
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Contestant:
    """One machine or animal in one condition."""

    name: str
    """Name, also of its folder."""
    title: str
    """Title, for people."""
    description: str
    """What it is, how it moves and in which medium, in a few sentences."""
    inputs: Mapping[str, Given]
    """All numbers that the prediction rests on, by name. Nothing of them was fitted to what is predicted."""
    predicts: Mapping[str, Quantity]
    """What is predicted, by name."""
    rungs: Mapping[str, Predictor]
    """The models that can be asked, by name, the cheapest first."""
    excluded_models: Mapping[str, str] = field(default_factory=dict)
    """Why other models cannot be asked, in a phrase, by name."""
    find_unsteadiness: Callable[[Mapping[str, float]], str] | None = None
    """Returns why what was measured, by quantity, is no steady swim; empty if it can be one. None: no rule is known."""

    def __post_init__(self) -> None:
        for name, number in self.inputs.items():
            if not number.source.strip():
                raise InvalidDesign(
                    f"contestant {self.name!r} has the number {name} = {number.value:g} without a source; name a "
                    "publication or a file, or the reason for its range."
                )
            if not (isfinite(number.low) and isfinite(number.high) and number.low <= number.value <= number.high):
                raise InvalidDesign(
                    f"contestant {self.name!r}: {name} is {number.value:g} and its range {number.low:g} to "
                    f"{number.high:g}; the value must lie in the range."
                )
        for name, rung in self.rungs.items():
            if rung.interval_source and not self.rungs.get(rung.interval_source, rung).draws:
                raise InvalidDesign(
                    f"rung {name!r} of contestant {self.name!r} takes the interval of "
                    f"{rung.interval_source!r}, which draws none."
                )

    @property
    def likely(self) -> dict[str, float]:
        """The most likely value of each number."""
        return {name: number.value for name, number in self.inputs.items()}

    def asking(self, models: Sequence[str]) -> "Contestant":
        """Return the same with some of its models alone, of which the others say that they were not asked.

        Args:
            models: names of rungs; those that it has not are left to other contestants. None asks all.

        Raises:
            InvalidDesign: it has none of them, or one takes the interval of a model that is not asked.
        """
        if not models:
            return self
        asked = {name: rung for name, rung in self.rungs.items() if name in models}
        if not asked:
            raise InvalidDesign(
                f"contestant {self.name!r} has none of the models {', '.join(models)}; it has {', '.join(self.rungs)}."
            )
        for name, rung in asked.items():
            if rung.interval_source and rung.interval_source not in asked:
                raise InvalidDesign(
                    f"{name} of {self.name!r} takes the interval of {rung.interval_source}: ask that too."
                )
        silent = {name: "it was not asked" for name in self.rungs if name not in asked}
        return replace(self, rungs=asked, excluded_models={**self.excluded_models, **silent})


class Entrant(ABC):
    """What stands in the catalog of contestants: one, or a family of them as an animal at several speeds."""

    name: str
    """Name in the catalog."""

    @abstractmethod
    def names(self) -> tuple[str, ...]:
        """Return the names of those that ``python -m evidence.league`` predicts unless it is told otherwise."""

    @abstractmethod
    def contestant_named(self, name: str) -> Contestant:
        """Return the one of a name that begins with that of the catalog.

        Raises:
            UnknownName: there is none.
        """


@dataclass(frozen=True, slots=True)
class SingleContestant(Entrant):
    """One contestant."""

    contestant: Contestant
    """The contestant."""

    @property
    def name(self) -> str:  # type: ignore[override]
        """Its name."""
        return self.contestant.name

    def names(self) -> tuple[str, ...]:
        """Return its name."""
        return (self.contestant.name,)

    def contestant_named(self, name: str) -> Contestant:
        """Return it."""
        if name != self.contestant.name:
            raise UnknownName("contestant", name, self.names())
        return self.contestant


@dataclass(frozen=True, slots=True, kw_only=True)
class ContestantFamily(Entrant):
    """Contestants that differ in one number, which stands in their names: ``catshark_2.5``."""

    name: str
    """Name in the catalog, with which all of their names begin."""
    default_parameters: tuple[float, ...]
    """Numbers of those that are predicted unless others are asked for."""
    low: float
    """Least number that can be asked."""
    high: float
    """Greatest number that can be asked."""
    parameter_label: str
    """What the number is, with its unit, for messages."""
    create: Callable[[float], Contestant]
    """Makes one of them."""

    def names(self) -> tuple[str, ...]:
        """Return those that are predicted unless others are asked for."""
        return tuple(f"{self.name}_{number:g}" for number in self.default_parameters)

    def contestant_named(self, name: str) -> Contestant:
        """Return the one whose number stands in a name.

        Raises:
            UnknownName: the name says no number.
            InvalidDesign: the number is out of range.
        """
        try:
            number = float(name.removeprefix(f"{self.name}_"))
        except ValueError:
            raise UnknownName("contestant", name, self.names()) from None
        if not self.low <= number <= self.high:
            raise InvalidDesign(
                f"contestant {name!r} asks for {number:g} {self.parameter_label}; {self.low:g} to {self.high:g} "
                "can be asked."
            )
        return self.create(number)


def find(shelf: Mapping[str, Entrant], name: str) -> Contestant:
    """Return a contestant by its name; that of a family's member begins with the name in the catalog.

    Raises:
        UnknownName: there is none.
        InvalidDesign: a family has no such member.
    """
    for entry in sorted(shelf, key=len, reverse=True):
        if name == entry or name.startswith(f"{entry}_"):
            return shelf[entry].contestant_named(name)
    raise UnknownName("contestant", name, every(shelf))


def every(shelf: Mapping[str, Entrant]) -> tuple[str, ...]:
    """Return the names of all contestants that are predicted unless others are asked for."""
    return tuple(name for entry in shelf.values() for name in entry.names())


class Interval(NamedTuple):
    """A prediction with its interval."""

    value: Value
    """With the most likely numbers."""
    low: Value
    """Lower end of the interval."""
    high: Value
    """Upper end of the interval."""
