"""A rule: when a claim counts as reproduced, as data that can be read, tested and mutated.

What decided it is a sentence whose numbers know how to be written in the unit that a reader expects.
"""

import operator
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from hashlib import sha256
from math import degrees, isfinite, nan
from string import Formatter
from types import MappingProxyType
from typing import Any, Literal

MIN_REPEATS = 6
"""Least number of repeats with which a median has a 95 % interval [-]; ``core.intervals.min_median_count`` gives it."""
_UNITS = {"mm": 1e3, "g": 1e3, "ms": 1e3, "MPa": 1e-6}


class Reading(float):
    """A number whose format may begin with a unit: ``{:mm.1f}`` writes metres as millimetres, ``{:deg.0f}`` degrees.

    The unit itself is left to the sentence. ``mm``, ``g`` and ``ms`` take metres, kilogrammes and seconds.
    """

    def __format__(self, form: str) -> str:
        """Write the number; a form without a unit is Python's own."""
        if form.startswith("deg"):
            return format(degrees(self), form.removeprefix("deg"))
        for unit, factor in _UNITS.items():
            if form.startswith((f"{unit}.", f"{unit}+")):
                return format(factor * float(self), form.removeprefix(unit))
        return format(float(self), form)


def write(value: float, form: str) -> str:
    """Return a number as text in a form of ``Reading``, zero without a minus."""
    text = format(Reading(value), form)
    return text.removeprefix("-") if not re.search("[1-9a-z]", text) else text


def comparison_word(
    value: float,
    reference: float,
    *,
    smaller_word: str,
    larger_word: str,
    equal_word: str = "the same",
    tolerance: float = 0.0,
) -> str:
    """Return the word for the relation of a value to a reference, for sentences.

    Args:
        value: the one that is spoken of.
        reference: what it is compared with.
        smaller_word: the word where it is smaller.
        larger_word: the word where it is greater.
        equal_word: the word where both differ by at most ``within``.
        tolerance: greatest difference that counts as none, as a share of the larger size [-].
    """
    if abs(value - reference) <= tolerance * max(abs(value), abs(reference)):
        return equal_word
    return smaller_word if value < reference else larger_word


def listed(items: Sequence[str]) -> str:
    """Return words as a list in a sentence: ``a, b and c``."""
    if len(items) < 2:
        return "".join(items)
    return f"{', '.join(items[:-1])} and {items[-1]}"


Kind = Literal["measured", "construction", "fitted", "animals"]
"""What a claim's number or statement rests on.

``measured``: it came out of a run or a calculation and could have come out otherwise. ``construction``: an input, a
count or a commanded shape that is read back, an identity of formulas, or a consequence of symmetry. ``fitted``: a
free number was chosen so that it comes out. ``animals``: the article speaks of animals, which a robot can resemble but
neither confirm nor contradict.
"""
DEFAULT_SPREAD_OF = "robots built of the design, with the errors of their servos, masses and friction"
"""What the intervals of most rules are of, for people."""
Relation = Literal["<", "<=", ">", ">="]
_RELATIONS: Mapping[str, Callable[[float, float], bool]] = MappingProxyType(
    {"<": operator.lt, "<=": operator.le, ">": operator.gt, ">=": operator.ge}
)


@dataclass(frozen=True, slots=True, kw_only=True)
class SmallestEffect:
    """Smallest difference from a bound that matters; a smaller one counts as none, however surely it is there."""

    size: float
    """In the unit of the measure, above 0."""
    why: str
    """Reason for the size, one that does not come from the result."""


PRINTED_DISPLACEMENT = SmallestEffect(
    size=0.005, why="the article prints displacements in steps of 10 mm, and less than 5 mm prints as none"
)
"""Smallest displacement or difference of displacements that matters [m]."""


@dataclass(frozen=True, slots=True)
class Clause:
    """One comparison of a measure with a bound; a rule holds if all of its clauses do."""

    measure: str
    """Name of the measure."""
    relation: Relation
    """Relation of the measure to the bound that is required."""
    bound: float | str
    """A number in the measure's unit, or the name of another measure."""
    why: str
    """Reason for the bound, one that was there before the result."""
    smallest_effect: SmallestEffect | None = None
    """By how much the measure must be beyond the bound; None: by anything."""

    def holds(self, measures: Mapping[str, float], spread: Collection[str] = ()) -> bool | None:
        """Return whether the comparison is true; None where intervals cover both answers.

        A number that is not finite makes it false. An end of an interval that is not finite is unknown, and then the
        comparison is undecided.

        Args:
            measures: measures by name; those of ``spread`` with their intervals.
            spread: names of the measures that have an interval.
        """
        names = [self.measure, *([self.bound] if isinstance(self.bound, str) else [])]
        if not all(isfinite(measures[name]) for name in names):
            return False
        value = interval(self.measure, measures, spread)
        bound = interval(self.bound, measures, spread) if isinstance(self.bound, str) else (self.bound, self.bound)
        if not all(map(isfinite, (*value, *bound))):
            return None
        relation, excess = _RELATIONS[self.relation], self._signed_effect
        answers = {relation(value_end, bound_end + excess) for value_end in value for bound_end in bound}
        return answers.pop() if len(answers) == 1 else None

    @property
    def comparison(self) -> str:
        """The comparison as text, with the smallest effect: ``gain > 0 by at least 0.005``."""
        bound = self.bound if isinstance(self.bound, str) else f"{self.bound:g}"
        effect = f" by at least {self.smallest_effect.size:g}" if self.smallest_effect else ""
        return f"{self.measure} {self.relation} {bound}{effect}"

    @property
    def _signed_effect(self) -> float:
        """Smallest effect, positive where the measure must be above the bound."""
        size = self.smallest_effect.size if self.smallest_effect else 0.0
        return size if self.relation.startswith(">") else -size

    def __str__(self) -> str:
        effect_reason = f" (the least that matters: {self.smallest_effect.why})" if self.smallest_effect else ""
        return f"{self.comparison}: {self.why}{effect_reason}"


def interval(name: str, measures: Mapping[str, float], spread: Collection[str]) -> tuple[float, float]:
    """Return the ends of a measure's interval, ``NAME_low`` and ``NAME_high``; twice its value where it has none."""
    lower_name, upper_name = (f"{name}_low", f"{name}_high") if name in spread else (name, name)
    return measures[lower_name], measures[upper_name]


def measure_with_interval(name: str, lower_bound: float, upper_bound: float) -> dict[str, float]:
    """Return a measure with its interval, for the examples of a rule: middle, lower and upper end."""
    return {name: 0.5 * (lower_bound + upper_bound), f"{name}_low": lower_bound, f"{name}_high": upper_bound}


@dataclass(frozen=True, slots=True, kw_only=True)
class ControlGroup:
    """The control group of a claim: the designs with which the claim compares, or which alone show the effect."""

    group: str
    """Name of its runs, as in the record."""
    why: str
    """Where the article says so, or why another group than its own stands for it."""
    needs: tuple[Clause, ...] = ()
    """What the group must do for the claim to be testable; none where it need only be there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Rung:
    """One of several models that a claim is asked of, see ``Rule.rungs``."""

    name: str
    """Its short name: the measures that it gave are those of the rule with ``_NAME`` behind them."""
    model: str
    """Its name in words."""
    why: str
    """Reason why it can carry the claim, or why it cannot; one that was there before the result."""
    carries: bool = True
    """Whether it can carry the claim at all."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Interpretation:
    """One of several meanings of the article's words, by which the same clauses are asked of other measures."""

    name: str
    """Its name, for people: ``locked, in one leg``."""
    measures: tuple[str, str]
    """Part of the names of the rule's measures, and what stands in its place in the names of those that are asked."""

    def measure(self, name: str) -> str:
        """Return the name of the measure that is asked in the place of one of the rule's."""
        return name.replace(*self.measures)


@dataclass(frozen=True, slots=True, kw_only=True)
class Rule:
    """When a claim counts as what; it is applied by ``judge``."""

    claim: str
    """Key of the claim in ``paper.CLAIMS``, or in the ``CLAIMS`` beside the rule; also the rule's name."""
    experiment: str
    """Name of the experiment whose measures it reads."""
    measure: str
    """Which measure stands beside the printed number, or says most about the statement."""
    definition: str = ""
    """What this measure is, for people: a noun phrase; empty in rules that say no more than the measure's name."""
    unit: str = ""
    """Unit of this measure; empty where it is that of the claim."""
    kind: Kind = "measured"
    """Kind of evidence for the claim."""
    holds: tuple[Clause, ...] = ()
    """The statement apart from its number: all of these. None only where a printed number alone is read back."""
    control: ControlGroup | None = None
    """The control group; None where the claim speaks of none."""
    spread: tuple[str, ...] = ()
    """Which of the measures it reads have an interval, ``NAME_low`` to ``NAME_high``."""
    of: str = ""
    """What the intervals are of, for people; empty where there are none."""
    why: str
    """What decided it, in a sentence or two with measures in braces: ``{forward_ratio:.2f}``, see ``reading``."""
    rungs: tuple[Rung, ...] = ()
    """Models that are asked one by one, all by the same clauses, see ``ladder``; none where one measure decides."""
    settled: float = 0.1
    """Greatest spread of a rung's halves and starting sides, over the size of what is measured, with which it has a
    word: ``MEASURE_NAME_apart`` [-]."""
    interpretation: str = ""
    """Name of the meaning of the article's words that the rule's own measures have; empty where there is one alone."""
    interpretations: tuple[Interpretation, ...] = ()
    """Other meanings; a statement that holds by one and not by another gets the word ``depends on the reading``."""
    form: str = ".3g"
    """How the rungs' numbers are written, see ``Reading``."""
    unswept: str = ""
    """Why no share of plausible designs is known; empty where ``suchus study claims`` answers the claim."""

    @property
    def asked(self) -> str:
        """Hash of the rule's inputs. A stored fraction of designs is valid only for the rule with the same hash."""
        clauses = [
            f"{clause.measure} {clause.relation} {clause.bound}"
            + (f" by {clause.smallest_effect.size}" if clause.smallest_effect else "")
            for clause in (*self.holds, *self._control_clauses)
        ]
        rungs = [f"{rung.name} {rung.carries}" for rung in self.rungs]
        text = "\n".join([self.experiment, self.measure, *clauses, *rungs, f"{self.settled}" * bool(rungs)])
        return sha256(text.encode()).hexdigest()[:12]

    @property
    def needs(self) -> set[str]:
        """Names of the measures that decide, those of the sentence not counted."""
        clauses = (*self.holds, *self._control_clauses)
        measures = {self.measure, *(clause.measure for clause in clauses)}
        bounds = {clause.bound for clause in clauses if isinstance(clause.bound, str)}
        if self.rungs:
            ends, carrying = ("", "_low", "_high", "_apart"), [rung.name for rung in self.rungs if rung.carries]
            spread = {f"{name}_{rung}{end}" for name in measures for rung in carrying for end in ends}
            return spread | {f"{name}_{rung}" for name in bounds for rung in carrying}
        return measures | bounds | {f"{name}{end}" for name in self.spread for end in ("_low", "_high")}

    @property
    def interpreted_rules(self) -> tuple["Rule", ...]:
        """The rule in each other meaning of the article's words, with the same clauses."""
        return tuple(self._interpreted(other) for other in self.interpretations)

    def _interpreted(self, other: Interpretation) -> "Rule":
        """Return the rule in another meaning of the article's words."""
        clauses = tuple(
            replace(
                clause,
                measure=other.measure(clause.measure),
                bound=other.measure(clause.bound) if isinstance(clause.bound, str) else clause.bound,
            )
            for clause in self.holds
        )
        return replace(
            self,
            measure=other.measure(self.measure),
            holds=clauses,
            spread=tuple(map(other.measure, self.spread)),
            interpretation=other.name,
            interpretations=(),
            why="",
        )

    @property
    def named_in_reason(self) -> set[str]:
        """Names of the measures whose values the sentence ``why`` states."""
        return {name for _, name, _, _ in Formatter().parse(self.why) if name}

    def reason(self, measures: Mapping[str, float]) -> str:
        """Return what decided it, with its numbers."""
        return " ".join(self.why.format_map({name: Reading(value) for name, value in measures.items()}).split())

    def held(self, measures: Mapping[str, float]) -> bool | None:
        """Return whether the statement holds, apart from its number.

        It fails if one clause fails surely. It is None if no clause fails surely and intervals leave some undecided.
        """
        return self._holds_all(self.holds, measures)

    def testable(self, measures: Mapping[str, float]) -> bool | None:
        """Return whether the control group does what the claim needs; None where intervals leave that undecided."""
        return self._holds_all(self._control_clauses, measures)

    def unable(self, measures: Mapping[str, float]) -> str:
        """Return a sentence that names the properties that the control group lacks; empty if it has all of them."""
        lacking = [str(clause) for clause in self._control_clauses if clause.holds(measures, self.spread) is not True]
        return f"The control group, {self.control.group}, lacks {listed(lacking)}." if self.control and lacking else ""

    def deciding(self, measures: Mapping[str, float]) -> str:
        """Return a sentence with the clauses that do not hold and are of another measure than the one that is shown.

        It is empty where the statement holds, or where the measure that is shown decides.
        """
        failing = [clause for clause in self.holds if clause.holds(measures, self.spread) is False]
        open_clauses = [clause for clause in self.holds if clause.holds(measures, self.spread) is None]
        decisive = failing or open_clauses
        if not decisive or self.measure in [clause.measure for clause in decisive]:
            return ""
        texts = [f"{clause.comparison} ({clause.measure}: {self._written(clause, measures)})" for clause in decisive]
        return f"{'What fails is' if failing else 'Undecided is'} {listed(texts)}."

    def _written(self, clause: Clause, measures: Mapping[str, float]) -> str:
        """Return the value of a clause's measure, with its interval in brackets where it has one."""
        ends = interval(clause.measure, measures, self.spread)
        text = f"{measures[clause.measure]:.3g}"
        return f"{text}, {ends[0]:.3g} to {ends[1]:.3g}" if clause.measure in self.spread else text

    def unknown_intervals_sentence(self, measures: Mapping[str, float]) -> str:
        """Return a sentence that names the measures whose intervals are unknown; empty if all are known."""
        names = [
            name
            for name in self.spread
            if isfinite(measures.get(name, nan)) and not all(map(isfinite, interval(name, measures, self.spread)))
        ]
        if not names:
            return ""
        return (
            f"The 95 % interval of {listed(names)} is unknown, since there are too few repeats; that of a median needs "
            f"{MIN_REPEATS} at least."
        )

    @property
    def _control_clauses(self) -> tuple[Clause, ...]:
        return self.control.needs if self.control else ()

    def _holds_all(self, clauses: Sequence[Clause], measures: Mapping[str, float]) -> bool | None:
        answers = [clause.holds(measures, self.spread) for clause in clauses]
        return False if False in answers else None if None in answers else True


@dataclass(frozen=True, slots=True, kw_only=True)
class Variation:
    """Variation of designs and settings of an experiment, which gives the fraction of designs in which a claim holds.

    It is declared as ``VARIED`` beside the rules of an experiment. It is for experiments that the walks of ``suchus
    study claims`` cannot replace: those walks have no rough ground, no feedback and no water.
    """

    claims: tuple[str, ...]
    """Keys of the claims that it answers."""
    over: Mapping[str, tuple[float, float, str]] = field(default_factory=dict)
    """Fields of the experiment that vary: the least and the greatest plausible value, and the reason for them."""
    designs: tuple[str, ...] = ("robot",)
    """Fields of the experiment that hold a robot or a gait, whose own numbers that the article does not give vary."""
    settings: Mapping[str, Any] = field(default_factory=dict)
    """Values of other fields with which one design is asked in affordable time; what is judged must still be met."""
    samples: int = 32
    """Number of designs, best a power of two, as Sobol's sequence asks [-]."""
