"""Verdicts on the article's claims: rules as data, their application to measures, and the fraction of designs."""

from suchus.article.verdict.judging import (
    SHARES,
    SPARSE_SHARES,
    Examples,
    Share,
    SparseShare,
    Verdict,
    Word,
    judge,
    word_of,
)
from suchus.article.verdict.rule import (
    Clause,
    ControlGroup,
    Kind,
    Reading,
    Rule,
    Rung,
    Variation,
    comparison_word,
    interval,
    listed,
    measure_with_interval,
)

__all__ = [
    "SHARES",
    "SPARSE_SHARES",
    "Clause",
    "ControlGroup",
    "Examples",
    "Kind",
    "Reading",
    "Rule",
    "Rung",
    "Share",
    "SparseShare",
    "Variation",
    "Verdict",
    "Word",
    "comparison_word",
    "interval",
    "judge",
    "listed",
    "measure_with_interval",
    "word_of",
]
