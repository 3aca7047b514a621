"""Verdicts on the article's claims: rules as data, what they say of measures, and how many designs agree."""

from suchus.verdict.counting import EvidenceCount, Standing, counted, standings
from suchus.verdict.judging import SHARES, TOO_FEW, Examples, Share, TooFew, Verdict, Word, judge, word_of
from suchus.verdict.rule import (
    Clause,
    ControlGroup,
    Kind,
    Reading,
    Rule,
    Rung,
    Varied,
    between,
    compared,
    interval,
    listed,
)
from suchus.verdict.table import RULES, UNRULED, examples_of, rules_of, varied_of

__all__ = [
    "RULES",
    "SHARES",
    "TOO_FEW",
    "UNRULED",
    "Clause",
    "ControlGroup",
    "EvidenceCount",
    "Examples",
    "Kind",
    "Reading",
    "Rule",
    "Rung",
    "Share",
    "Standing",
    "TooFew",
    "Varied",
    "Verdict",
    "Word",
    "between",
    "compared",
    "counted",
    "examples_of",
    "interval",
    "judge",
    "listed",
    "rules_of",
    "standings",
    "varied_of",
    "word_of",
]
