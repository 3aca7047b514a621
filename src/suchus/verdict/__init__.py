"""Verdicts on the article's claims: rules as data, what they say of measures, and how many designs agree."""

from suchus.verdict.judging import SHARES, Examples, Share, Verdict, Word, judge
from suchus.verdict.rule import Clause, Kind, Reading, Rule, Rung, Varied, between, compared, interval, listed
from suchus.verdict.table import RULES, examples_of, rules_of, varied_of

__all__ = [
    "RULES",
    "SHARES",
    "Clause",
    "Examples",
    "Kind",
    "Reading",
    "Rule",
    "Rung",
    "Share",
    "Varied",
    "Verdict",
    "Word",
    "between",
    "compared",
    "examples_of",
    "interval",
    "judge",
    "listed",
    "rules_of",
    "varied_of",
]
