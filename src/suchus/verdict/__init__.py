"""Verdicts on the article's claims: rules as data, what they say of measures, and how many designs agree."""

from suchus.verdict.judging import Verdict, Word, judge
from suchus.verdict.reading import Reading, compared, listed
from suchus.verdict.rule import Band, Clause, Kind, Rule
from suchus.verdict.shares import SHARES, Share
from suchus.verdict.table import RULES, rules_of

__all__ = [
    "RULES",
    "SHARES",
    "Band",
    "Clause",
    "Kind",
    "Reading",
    "Rule",
    "Share",
    "Verdict",
    "Word",
    "compared",
    "judge",
    "listed",
    "rules_of",
]
