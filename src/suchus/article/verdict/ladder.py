"""What several models say of one claim: each rung for itself, and the word on which those that can carry it agree.

A rung has a word if it can carry the claim, could be run, and is settled: the means over two halves of its cycles,
started to either side, lie within a bound of each other. All of them and, where a study of grids was kept, those on its
grids must then answer alike. Rungs that answer differently make the word ``models disagree``. One rung alone does not
decide against another that says otherwise in all of its spread, though it is not settled: that is ``undecided``.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import isfinite, nan
from types import MappingProxyType
from typing import Literal

from suchus.article.verdict.rule import Clause, Reading, Rule, Rung, listed

NOTHING: Mapping[str, str] = MappingProxyType({})


Says = Literal["holds", "does not hold", "undecided", "no word"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Voice:
    """What one rung says of a claim."""

    rung: Rung
    """The rung that answers."""
    value: float
    """Its measure, the mean over halves and starting sides; NaN where it has none."""
    low: float
    """Least of the halves, starting sides and grids."""
    high: float
    """Greatest of them."""
    says: Says
    """Whether the statement holds there; ``undecided`` where it does in a part of its spread only."""
    leans: bool | None
    """What all of its spread says, settled or not; None where it says both, or nothing."""
    why: str
    """Why it can carry the claim, or why it has no word."""

    def written(self, form: str) -> str:
        """Return its number with its spread, in a form of ``Reading``; a dash where there is none."""
        if not isfinite(self.value):
            return "–"
        low, value, high = (format(Reading(one), form) for one in (self.low, self.value, self.high))
        return value if low == high else f"{value} ({low} to {high})"


def voices(rule: Rule, measures: Mapping[str, float], unable: Mapping[str, str] = NOTHING) -> tuple[Voice, ...]:
    """Return what each rung of a rule says.

    Args:
        rule: the claim's.
        measures: of its experiment.
        unable: why rungs could not be run, in a sentence, by name.
    """
    return tuple(_voice(rule, rung, measures, unable.get(rung.name, "")) for rung in rule.rungs)


def _voice(rule: Rule, rung: Rung, measures: Mapping[str, float], unable: str) -> Voice:
    value, low, high = (measures.get(f"{rule.measure}_{rung.name}{end}", nan) for end in ("", "_low", "_high"))
    silent = unable if rung.carries else rung.why
    told: tuple[Says, bool | None, str] = ("no word", None, silent) if silent else _answer(rule, rung, measures)
    return Voice(rung=rung, value=value, low=low, high=high, says=told[0], leans=told[1], why=told[2])


def _answer(rule: Rule, rung: Rung, measures: Mapping[str, float]) -> tuple[Says, bool | None, str]:
    asked = [f"{name}_{rung.name}" for name in dict.fromkeys((rule.measure, *(one.measure for one in rule.holds)))]
    if not all(isfinite(measures[name + end]) for name in asked for end in ("", "_low", "_high", "_apart")):
        return "no word", None, "It has not swum enough cycles, or not at all, to show that it is settled."
    apart = max(measures[f"{name}_apart"] for name in asked)
    clauses = tuple(_of(clause, rung) for clause in rule.holds)
    held = replace(rule, holds=clauses, spread=tuple(asked)).held(measures)
    if apart > rule.settled:
        why = f"Not settled: halves and starting sides are {apart:.2g} apart; {rule.settled:g} is allowed."
        return "no word", held, why
    if held is None:
        return "undecided", held, "It holds in a part of its halves, starting sides and grids only."
    return ("holds" if held else "does not hold"), held, rung.why


def _of(clause: Clause, rung: Rung) -> Clause:
    """Return a clause that asks a rung's measures."""
    bound = f"{clause.bound}_{rung.name}" if isinstance(clause.bound, str) else clause.bound
    return replace(clause, measure=f"{clause.measure}_{rung.name}", bound=bound)


def _answers(said: Sequence[Voice]) -> set[Says]:
    return {voice.says for voice in said} - {"no word", "undecided"}


def disagree(said: Sequence[Voice]) -> bool:
    """Return whether the statement holds in one rung and not in another."""
    return len(_answers(said)) > 1


def contested(said: Sequence[Voice]) -> bool:
    """Return whether one rung alone has an answer, and one that is not settled says otherwise in all of its spread.

    No word rests on one model where another stands beside it. This was added after a first result had been seen; it
    can only take a word away.
    """
    heard = [voice for voice in said if voice.says in ("holds", "does not hold")]
    others = {voice.leans for voice in said if voice.says == "no word"}
    return len(heard) == 1 and (not heard[0].leans) in others


def agreed(said: Sequence[Voice]) -> bool | None:
    """Return on what the rungs agree that have an answer; None if none has one, they disagree, or one is contested."""
    answers = _answers(said)
    if contested(said):
        return None
    return answers == {"holds"} if len(answers) == 1 else None


def spread(said: Sequence[Voice]) -> tuple[float, float, float]:
    """Return the middle value of the rungs that have a word, and the least and the greatest of all; NaN of none."""
    heard = [voice for voice in said if voice.says != "no word"]
    if not heard:
        return nan, nan, nan
    values = sorted(voice.value for voice in heard)
    middle = 0.5 * (values[(len(values) - 1) // 2] + values[len(values) // 2])
    return middle, min(voice.low for voice in heard), max(voice.high for voice in heard)


_SENTENCES: Mapping[Says, str] = MappingProxyType(
    {"holds": "It holds in", "does not hold": "It does not hold in", "undecided": "Undecided is", "no word": "No word:"}
)


def sentence(said: Sequence[Voice], form: str) -> str:
    """Return in a sentence or two on which rungs a claim holds, on which not, and which have no word."""
    parts = []
    for says, words in _SENTENCES.items():
        number = {voice.rung.name: f" ({voice.written(form)})" * (says != "no word") for voice in said}
        named = [voice.rung.model + number[voice.rung.name] for voice in said if voice.says == says]
        parts += [f"{words} {listed(named)}."] if named else []
    if contested(said):
        parts.append("That is one model alone, and one that is not settled says otherwise in all of its spread.")
    return " ".join(parts)


def rows(said: Sequence[Voice], form: str) -> list[dict[str, str]]:
    """Return the ladder as rows of a table: model, number with spread, what it says, and why."""
    return [{"model": v.rung.model, "number": v.written(form), "says": v.says, "why": v.why} for v in said]
