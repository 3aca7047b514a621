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
from typing import Literal, NamedTuple

from suchus.article.verdict.rule import Clause, Rule, Rung, listed, write

NO_REASONS: Mapping[str, str] = MappingProxyType({})


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
        lower_text, value, upper_text = (write(number, form) for number in (self.low, self.value, self.high))
        return value if lower_text == upper_text else f"{value} ({lower_text} to {upper_text})"


def voices(rule: Rule, measures: Mapping[str, float], unable: Mapping[str, str] = NO_REASONS) -> tuple[Voice, ...]:
    """Return what each rung of a rule says.

    Args:
        rule: the claim's.
        measures: measures of its experiment.
        unable: why rungs could not be run, in a sentence, by name.
    """
    return tuple(_voice(rule, rung, measures, unable.get(rung.name, "")) for rung in rule.rungs)


def _voice(rule: Rule, rung: Rung, measures: Mapping[str, float], unable: str) -> Voice:
    """Return the answer of one model to a claim, with its number and interval."""
    value, lower_bound, upper_bound = (
        measures.get(f"{rule.measure}_{rung.name}{end}", nan) for end in ("", "_low", "_high")
    )
    silent = unable if rung.carries else rung.why
    answer: tuple[Says, bool | None, str] = ("no word", None, silent) if silent else _answer(rule, rung, measures)
    return Voice(
        rung=rung, value=value, low=lower_bound, high=upper_bound, says=answer[0], leans=answer[1], why=answer[2]
    )


def _answer(rule: Rule, rung: Rung, measures: Mapping[str, float]) -> tuple[Says, bool | None, str]:
    """Return the answer of a model, whether the statement holds in it, and the reason."""
    measure_names = [
        f"{name}_{rung.name}" for name in dict.fromkeys((rule.measure, *(clause.measure for clause in rule.holds)))
    ]
    if not all(isfinite(measures[name + end]) for name in measure_names for end in ("", "_low", "_high", "_apart")):
        return "no word", None, "It has not swum enough cycles, or not at all, to show that it is settled."
    difference = max(measures[f"{name}_apart"] for name in measure_names)
    clauses = tuple(_clause_for_rung(clause, rung) for clause in rule.holds)
    is_held = replace(rule, holds=clauses, spread=tuple(measure_names)).held(measures)
    if difference > rule.settled:
        reason = f"Not settled: halves and starting sides are {difference:.2g} apart; {rule.settled:g} is allowed."
        return "no word", is_held, reason
    if is_held is None:
        return "undecided", is_held, "It holds in a part of its halves, starting sides and grids only."
    return ("holds" if is_held else "does not hold"), is_held, rung.why


def _clause_for_rung(clause: Clause, rung: Rung) -> Clause:
    """Return a clause with the measures of one model."""
    bound = f"{clause.bound}_{rung.name}" if isinstance(clause.bound, str) else clause.bound
    return replace(clause, measure=f"{clause.measure}_{rung.name}", bound=bound)


def _answers(model_voices: Sequence[Voice]) -> set[Says]:
    return {voice.says for voice in model_voices} - {"no word", "undecided"}


def disagree(model_voices: Sequence[Voice]) -> bool:
    """Return whether the statement holds in one model and fails in another."""
    return len(_answers(model_voices)) > 1


def contested(model_voices: Sequence[Voice]) -> bool:
    """Return whether one model alone has an answer, and an unsettled model contradicts it in all of its spread.

    One model alone does not decide if another one contradicts it. This rule was added after a first result had been
    seen; it can only take a word away.
    """
    answering_voices = [voice for voice in model_voices if voice.says in ("holds", "does not hold")]
    unsettled_leanings = {voice.leans for voice in model_voices if voice.says == "no word"}
    return len(answering_voices) == 1 and (not answering_voices[0].leans) in unsettled_leanings


def agreed(model_voices: Sequence[Voice]) -> bool | None:
    """Return the common answer of the models that have one; None if none has one, they disagree or one is contested."""
    answers = _answers(model_voices)
    if contested(model_voices):
        return None
    return answers == {"holds"} if len(answers) == 1 else None


class ModelInterval(NamedTuple):
    """Number of a claim by the models that have a word, in the unit of its measure."""

    median: float
    """Median of the models' numbers; NaN if no model has a word."""
    low: float
    """Least number of their halves, starting sides and grids; NaN if no model has a word."""
    high: float
    """Greatest of these numbers; NaN if no model has a word."""


def value_and_interval(model_voices: Sequence[Voice]) -> ModelInterval:
    """Return the median number of the models that have a word, and the least and greatest of all; NaN without one."""
    voices_with_word = [voice for voice in model_voices if voice.says != "no word"]
    if not voices_with_word:
        return ModelInterval(nan, nan, nan)
    values = sorted(voice.value for voice in voices_with_word)
    return ModelInterval(
        median=0.5 * (values[(len(values) - 1) // 2] + values[len(values) // 2]),
        low=min(voice.low for voice in voices_with_word),
        high=max(voice.high for voice in voices_with_word),
    )


_SENTENCES: Mapping[Says, str] = MappingProxyType(
    {"holds": "It holds in", "does not hold": "It does not hold in", "undecided": "Undecided is", "no word": "No word:"}
)


def sentence(model_voices: Sequence[Voice], form: str) -> str:
    """Return sentences that name the models in which a claim holds, those in which it fails, and the rest."""
    parts = []
    for says, words in _SENTENCES.items():
        number = {voice.rung.name: f" ({voice.written(form)})" * (says != "no word") for voice in model_voices}
        model_texts = [voice.rung.model + number[voice.rung.name] for voice in model_voices if voice.says == says]
        parts += [f"{words} {listed(model_texts)}."] if model_texts else []
    if contested(model_voices):
        parts.append("That is one model alone, and one that is not settled says otherwise in all of its spread.")
    return " ".join(parts)


def rows(model_voices: Sequence[Voice], form: str) -> list[dict[str, str]]:
    """Return the ladder as rows of a table: model, number with spread, what it says, and why."""
    return [{"model": v.rung.model, "number": v.written(form), "says": v.says, "why": v.why} for v in model_voices]
