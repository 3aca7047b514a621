"""What each rule says of measures, on both sides of everything that it looks at."""

from dataclasses import replace
from math import nan

import pytest

from suchus.errors import IncompatibleRecord
from suchus.experiments import EXPERIMENTS
from suchus.paper import CLAIMS
from suchus.verdict import RULES, Clause, Share, judge
from suchus.verdict.shares import ROBUST

from .examples import ALL

SHARE = Share(claim="tail_swing", share=0.95, low=0.9, high=0.97, designs=100, turned_by="", at=None, above=False)


@pytest.mark.parametrize(("claim", "measures", "word"), [(c, m, w) for c, rows in ALL.items() for m, w in rows])
def test_a_rule_says_of_measures_what_they_mean(claim, measures, word):
    verdict = judge(RULES[claim], measures)
    assert verdict.verdict == word
    assert len(verdict.why) > 20


def test_every_rule_has_examples_of_two_words_at_least():
    assert set(ALL) == set(RULES)
    for claim, rows in ALL.items():
        assert len({word for _, word in rows}) > 1, claim


def test_every_rule_is_of_a_claim_and_of_an_experiment_that_measures():
    for claim, rule in RULES.items():
        assert claim in CLAIMS
        assert rule.experiment in EXPERIMENTS
        assert rule.holds or (rule.kind == "construction" and CLAIMS[claim].value is not None), claim
        assert all(clause.why for clause in rule.holds), claim


def test_a_measure_that_is_missing_is_named():
    with pytest.raises(IncompatibleRecord, match="needs gain_tail_swing_low, which displacement did not measure"):
        judge(RULES["tail_swing"], {"gain_tail_swing": 0.1, "gain_tail_swing_high": 0.2})


def test_a_number_that_is_none_holds_nothing():
    for relation in ("<", "<=", ">", ">="):
        assert not Clause("x", relation, 0.0, "why").holds({"x": nan})
        assert not Clause("x", relation, "y", "why").holds({"x": 1.0, "y": nan})


@pytest.mark.parametrize(
    ("relation", "below", "at", "above"),
    [("<", True, False, False), ("<=", True, True, False), (">", False, False, True), (">=", False, True, True)],
)
def test_a_clause_compares(relation, below, at, above):
    clause = Clause("x", relation, 2.0, "why")
    assert [clause.holds({"x": x}) for x in (1.9, 2.0, 2.1)] == [below, at, above]
    other = Clause("x", relation, "y", "why")
    assert [other.holds({"x": x, "y": 2.0}) for x in (1.9, 2.0, 2.1)] == [below, at, above]


def test_a_verdict_is_fragile_where_other_designs_say_otherwise():
    measures = ALL["tail_swing"][0][0]  # reproduced
    for share, held in ((ROBUST + 0.01, False), (ROBUST - 0.01, True)):
        verdict = judge(RULES["tail_swing"], measures, {"tail_swing": replace(SHARE, share=share)})
        assert verdict.fragile is held
    contradicted = ALL["tail_swing"][1][0]
    for share, held in ((1 - ROBUST - 0.01, False), (1 - ROBUST + 0.01, True)):
        verdict = judge(RULES["tail_swing"], contradicted, {"tail_swing": replace(SHARE, share=share)})
        assert verdict.fragile is held
    assert not judge(RULES["tail_swing"], measures, {}).fragile


def test_what_was_built_in_is_not_fragile():
    measures = ALL["spine_sinusoidal"][0][0]
    share = replace(SHARE, claim="spine_sinusoidal", share=0.1)
    assert not judge(RULES["spine_sinusoidal"], measures, {"spine_sinusoidal": share}).fragile
