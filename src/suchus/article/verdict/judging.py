"""From a rule and measures to a verdict, and the fraction of plausible designs in which the claim holds.

The fractions are those of the table that ``suchus study claims`` wrote.
"""

import hashlib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from importlib import resources
from math import isfinite
from types import MappingProxyType
from typing import Any, Literal, TypeVar, get_args

from suchus.article.paper import CLAIMS, Claim
from suchus.article.verdict import ladder
from suchus.article.verdict.rule import Rule, interval, listed
from suchus.core.errors import IncompatibleRecord, UnknownName

ROBUST = 0.9
"""A verdict is fragile if fewer plausible designs than this share agree with it [-].

Nine in ten, set before the study was run: one design in ten drawn from our own ranges may disagree before a reader
should be warned.
"""
_FILE = "claims.json"


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """Fraction of plausible designs in which the statement of a claim holds."""

    claim: str
    """Its key."""
    share: float
    """Share of the designs that could be judged in which it holds [-]."""
    low: float
    """Lower end of the 95 % interval, after Wilson [-]."""
    high: float
    """Upper end [-]."""
    designs: int
    """Number of designs that could be judged [-]."""
    turned_by: str
    """The free number whose value best predicts where it holds; empty where none does beyond chance."""
    at: float | None
    """Its value there, in its own unit."""
    above: bool
    """Whether the statement rather holds above that value."""
    of: str = ""
    """The experiment that was asked again for it; empty where the walks of the study answer."""
    rule: str = ""
    """Digest of the rule that judged the designs, ``Rule.asked``."""

    def robust(self, is_held: bool) -> bool:
        """Return whether enough designs agree with a verdict.

        Args:
            is_held: whether the statement held in the run that was judged.
        """
        return (self.share if is_held else 1.0 - self.share) >= ROBUST


@dataclass(frozen=True, slots=True, kw_only=True)
class SparseShare:
    """Answers of plausible designs to a claim that too few of them can judge to give a fraction."""

    claim: str
    """Its key."""
    words: Mapping[str, int]
    """Number of designs by the word that each says [-]."""
    of: str
    """The experiment that was asked again for it; empty where the walks of the study were."""
    rule: str
    """Digest of the rule that judged the designs, ``Rule.asked``."""

    def robust(self, is_held: bool) -> bool:
        """Return whether enough of the designs that can judge the claim agree with a verdict.

        Args:
            is_held: whether the statement held in the run that was judged.
        """
        answers = [
            (_HOLDS_BY_WORD[word] is is_held, count) for word, count in self.words.items() if word in _HOLDS_BY_WORD
        ]
        return sum(count for agrees, count in answers if agrees) >= ROBUST * sum(count for _, count in answers)

    def __str__(self) -> str:
        """Return the counts of the answers as a sentence."""
        counts_text = listed([f"{self.words[word]} {word}" for word in WORDS if word in self.words])
        number = sum(self.words.values())
        return f"Asked of {number} plausible designs, too few of which could judge it to know a share: {counts_text}."


_Row = TypeVar("_Row", Share, SparseShare)


def _shipped() -> Mapping[str, Mapping[str, Any]]:
    """Return the rows of the table beside this module; none if it does not exist yet."""
    file = resources.files("suchus.article.verdict") / _FILE
    if not file.is_file():
        return MappingProxyType({})
    rows: Mapping[str, Mapping[str, Any]] = json.loads(file.read_text(encoding="utf-8"))["claims"]
    return rows


def digest(claims: Mapping[str, Mapping[str, object]]) -> str:
    """Return the SHA-256 of a table's rows, which the table also contains."""
    return hashlib.sha256(json.dumps(claims, sort_keys=True).encode()).hexdigest()


SHARES: Mapping[str, Share] = MappingProxyType(
    {key: Share(claim=key, **row) for key, row in _shipped().items() if "share" in row}
)
"""Fractions of plausible designs by claim."""
SPARSE_SHARES: Mapping[str, SparseShare] = MappingProxyType(
    {key: SparseShare(claim=key, **row) for key, row in _shipped().items() if "share" not in row}
)
"""By claim, of those that too few designs could judge."""


Word = Literal[
    "reproduced", "same sense", "contradicted", "undecided", "models disagree", "depends on the reading",
    "not testable", "by construction", "fitted",
]  # fmt: skip
"""``reproduced``: it came out, and the middle of ours is the printed number as rounded. ``same sense``: another number,
but the statement holds; or the robot does what is said of animals. ``contradicted``: the statement does not hold.
``undecided``: an interval covers both sides of a bound or is unknown, and nothing else fails. ``models disagree``:
models that can carry the claim say different words. ``depends on the reading``: the article's words have several
meanings, and the statement holds by one of them and not by another. ``not testable``: nothing was measured that could
decide, or the control group does not do what the claim needs. ``by construction``: an input, a count or a commanded
shape that is read back, an identity of formulas, or a consequence of symmetry. ``fitted``: a free number was chosen so
that it comes out.
"""
WORDS: tuple[Word, ...] = get_args(Word)
_HOLDS_BY_WORD: Mapping[str, bool] = MappingProxyType({"reproduced": True, "same sense": True, "contradicted": False})
_HOLDS_BY_READING: Mapping[str, bool] = MappingProxyType({**_HOLDS_BY_WORD, "fitted": True})
"""Whether the statement held, by the words that say so of a run."""
Examples = Mapping[str, Sequence[tuple[Mapping[str, float], Word]]]
"""By claim: measures, and the word that its rule must say of them, on both sides of everything that it looks at."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """Result of one claim of the article."""

    claim: Claim
    """The article's statement."""
    rule: Rule
    """The rule that was applied."""
    measured: float | None
    """What was measured, in the unit of ``unit``; None where nothing can be measured."""
    low: float | None
    """Lower end of its interval; None where it has none."""
    high: float | None
    """Upper end of its interval."""
    verdict: Word
    """The verdict in a word or two."""
    why: str
    """One or two sentences: what decided it."""
    share: Share | None
    """Fraction of plausible designs for which the statement holds; None where that is not known."""
    voices: tuple[ladder.Voice, ...] = ()
    """What each model says; none where one measure decides."""
    too_few: SparseShare | None = None
    """What designs say that are too few to know a share; None where a share is known, or no design was asked."""
    time_step: str = ""
    """Other words within the changes of the measures with the time step, in a sentence; empty where there are none."""

    @property
    def unit(self) -> str:
        """Unit of what was measured: that of the printed number, or of the rule's measure where none is printed."""
        return shown_unit(self.rule, self.claim)

    @property
    def fragile(self) -> bool:
        """Whether too many other plausible designs give another answer than this verdict.

        Values that were chosen for one design, or follow from its construction, are not fragile.
        """
        return fragile(self.rule, self.verdict, self.share or self.too_few)


def shown_unit(rule: Rule, claim: Claim) -> str:
    """Return the unit of what is measured: that of the printed number, or of the rule's measure where none is printed.

    Args:
        rule: the claim's.
        claim: the statement.
    """
    return claim.unit if claim.value is not None else rule.unit or claim.unit


def fragile(rule: Rule, word: str, designs: Share | SparseShare | None) -> bool:
    """Return whether too many other plausible designs give another answer than a verdict.

    Args:
        rule: the claim's.
        word: word of its verdict.
        designs: in how many the statement holds, or what few of them say; None where that is not known.
    """
    if rule.kind not in ("measured", "animals") or designs is None or designs.rule not in ("", rule.asked):
        return False
    is_held = _HOLDS_BY_WORD.get(word)
    return is_held is not None and not designs.robust(is_held)


def judge(
    rule: Rule,
    measures: Mapping[str, float],
    shares: Mapping[str, Share] = SHARES,
    unable: Mapping[str, str] = ladder.NO_REASONS,
    claims: Mapping[str, Claim] = CLAIMS,
) -> Verdict:
    """Return the verdict of a rule on measures.

    Args:
        rule: the claim's.
        measures: measures of its experiment, by name, in SI units.
        shares: fraction of plausible designs for which each claim holds, by claim.
        unable: why models of the rule could not be run, in a sentence, by the names of its rungs.
        claims: those that rules may judge, by key: the article's, or with them an experiment's own, see
            ``suchus.experiments.claims.known_claims``.

    Raises:
        UnknownName: the rule judges a claim that is not among ``claims``.
        IncompatibleRecord: a measure that the rule or its sentence names is not there.
    """
    if rule.claim not in claims:
        raise UnknownName("claim", rule.claim, claims)
    claim = claims[rule.claim]
    needed = rule.needs.union(rule.named_in_reason, *(other.needs for other in rule.interpreted_rules))
    missing = sorted(needed - set(measures))
    if missing:
        raise IncompatibleRecord(
            f"the verdict on {rule.claim} needs {', '.join(missing)}, which {rule.experiment} did not measure."
        )
    model_voices = ladder.voices(rule, measures, unable)
    value, lower_bound, upper_bound = _value(rule, measures, model_voices), None, None
    deciding = "" if model_voices else rule.deciding(measures)
    words = _words_by_reading(rule, claim, measures, model_voices)
    reason_parts = (
        rule.reason(measures),
        deciding,
        rule.unable(measures),
        rule.unknown_intervals_sentence(measures),
        _reading_sentence(words, measures),
    )
    reason = " ".join(text for text in reason_parts if text)
    if model_voices:
        model_interval = ladder.value_and_interval(model_voices)
        lower_bound, upper_bound = (model_interval.low, model_interval.high) if isfinite(value) else (None, None)
        reason = f"{reason} {ladder.sentence(model_voices, rule.form)}"
    elif rule.measure in rule.spread and isfinite(value):
        lower_bound, upper_bound = (
            end if isfinite(end) else None for end in interval(rule.measure, measures, rule.spread)
        )
    return Verdict(
        claim=claim,
        rule=rule,
        measured=value if isfinite(value) else None,
        low=lower_bound,
        high=upper_bound,
        verdict=_common_word([word for _, word in words]),
        why=reason,
        share=_of_rule(rule, shares.get(rule.claim)),
        voices=model_voices,
        too_few=_of_rule(rule, SPARSE_SHARES.get(rule.claim)),
    )


def word_of(rule: Rule, measures: Mapping[str, float]) -> Word:
    """Return the verdict's word for measures, without any others than the rule needs.

    Args:
        rule: the claim's.
        measures: those of ``Rule.needs``.
    """
    model_voices = ladder.voices(rule, measures)
    return _word(rule, CLAIMS[rule.claim], _value(rule, measures, model_voices), measures, model_voices)


def _is_printed_value(printed_value: float, rounding: float, value: float) -> bool:
    """Return whether a measured number equals the printed one within its rounding.

    Only the middle of an ensemble or of several models counts, not its interval. With the interval, less knowledge
    would agree with more printed numbers.
    """
    slack = 1e-9 * max(1.0, abs(printed_value))  # a value on the edge of its own rounding is inside
    return abs(value - printed_value) <= rounding + slack


def _value(rule: Rule, measures: Mapping[str, float], model_voices: Sequence[ladder.Voice]) -> float:
    return ladder.value_and_interval(model_voices).median if model_voices else float(measures[rule.measure])


def _of_rule(rule: Rule, row: _Row | None) -> _Row | None:
    """Return a row if it was made with this rule, otherwise None."""
    return None if row is None or row.rule not in ("", rule.asked) else row


def _words_by_reading(
    rule: Rule, claim: Claim, measures: Mapping[str, float], model_voices: Sequence[ladder.Voice]
) -> list[tuple[Rule, Word]]:
    """Return the rule in each meaning of the article's words with its verdict's word, that of the rule itself first."""
    own_word = _word(rule, claim, _value(rule, measures, model_voices), measures, model_voices)
    return [(rule, own_word)] + [
        (other, _word(other, claim, float(measures[other.measure]), measures, ())) for other in rule.interpreted_rules
    ]


def _common_word(words: Sequence[Word]) -> Word:
    """Return the first word, or ``depends on the reading`` where the statement holds by one word and not by another."""
    answers = {_HOLDS_BY_READING[word] for word in words if word in _HOLDS_BY_READING}
    return "depends on the reading" if len(answers) > 1 else words[0]


def _reading_sentence(words: Sequence[tuple[Rule, Word]], measures: Mapping[str, float]) -> str:
    """Return a sentence with the word and the number of each meaning of the article's words; empty if there is one."""
    if len(words) < 2:
        return ""
    texts = []
    for rule, word in words:
        ends = interval(rule.measure, measures, rule.spread)
        range_text = f", {ends[0]:.2g} to {ends[1]:.2g}" if rule.measure in rule.spread else ""
        texts.append(f"{rule.interpretation}: {word} ({measures[rule.measure]:.2g}{range_text})")
    return f"By reading: {'; '.join(texts)}."


def _word(
    rule: Rule, claim: Claim, value: float, measures: Mapping[str, float], model_voices: Sequence[ladder.Voice]
) -> Word:
    """Return the word of a verdict, such as ``reproduced``, ``contradicted`` or ``undecided``."""
    testable = rule.testable(measures)
    if not isfinite(value) or testable is False:
        return "not testable"
    if ladder.disagree(model_voices):
        return "models disagree"
    is_held = ladder.agreed(model_voices) if model_voices else rule.held(measures)
    if is_held is None or testable is None:
        return "undecided"
    if rule.kind == "animals":  # a robot resembles an animal or not; it says nothing of the animal itself
        return "same sense" if is_held else "not testable"
    if not is_held:
        return "contradicted"
    is_printed = claim.value is None or _is_printed_value(claim.value, claim.rounding, value)
    if rule.kind == "construction":
        return "by construction" if is_printed else "contradicted"
    if not is_printed:
        return "same sense"
    return "fitted" if rule.kind == "fitted" else "reproduced"
