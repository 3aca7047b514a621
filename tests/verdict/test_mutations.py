"""A test of the tests: each rule is broken in every way, and the examples must notice each time."""

from dataclasses import replace

import pytest

from suchus.paper import CLAIMS
from suchus.verdict import RULES, judging

from .examples import ALL
from .mutations import mutated


@pytest.mark.parametrize("claim", RULES)
def test_every_way_to_break_a_rule_changes_a_word(claim, monkeypatch):
    survived = []
    rows, rule, printed = ALL[claim], RULES[claim], CLAIMS[claim]
    for what, broken, rounding in mutated(rule, numeric=printed.value is not None):
        if rounding != 1.0 and printed.rounding == 0.0:
            continue  # a count has no rounding
        monkeypatch.setattr(judging, "CLAIMS", {claim: replace(printed, rounding=rounding * printed.rounding)})
        if all(judging.judge(broken, measures, {}).verdict == word for measures, word in rows):
            survived.append(what)
    assert survived == []
