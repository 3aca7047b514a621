"""Verdicts on the article's claims: rules as data, their application to measures, and the fraction of designs."""

from suchus.article.verdict.judging import SHARES, TOO_FEW, Examples, Share, TooFew, Verdict, Word, judge, word_of
from suchus.article.verdict.rule import (
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

__all__ = [
    "SHARES",
    "TOO_FEW",
    "Clause",
    "ControlGroup",
    "Examples",
    "Kind",
    "Reading",
    "Rule",
    "Rung",
    "Share",
    "TooFew",
    "Varied",
    "Verdict",
    "Word",
    "between",
    "compared",
    "interval",
    "judge",
    "listed",
    "word_of",
]
