"""How rules judge; what holds for those of every experiment is in ``tests/shelves/test_every_rule.py``."""

import subprocess
import sys
from dataclasses import replace
from math import nan

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.rule_examples import examples_of

import suchus.experiments.catalog
from suchus.article.paper import CLAIMS
from suchus.article.verdict import Clause, Share, SmallestEffect, SparseShare, judge, measure_with_interval
from suchus.article.verdict.judging import ROBUST, fragile
from suchus.article.verdict.rule import MIN_REPEATS
from suchus.core.errors import IncompatibleRecord, InvalidDesign
from suchus.core.intervals import min_median_count
from suchus.experiments.claims import RULES, UNRULED, rules_of
from suchus.experiments.experiment import estimated, estimated_fraction

SWINGS = examples_of("displacement")["tail_swing"]
SHARE = Share(claim="tail_swing", share=0.95, low=0.9, high=0.97, designs=100, turned_by="", at=None, above=False)


def test_a_measure_that_is_missing_is_named():
    with pytest.raises(IncompatibleRecord, match="needs gain_tail_swing_low, which displacement did not measure"):
        judge(RULES["tail_swing"], {"gain_tail_swing": 0.1, "gain_tail_swing_high": 0.2, "gain_tail_contact": 0.1})


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


@pytest.mark.parametrize(
    ("relation", "words"),
    [
        ("<", [True, None, None, False, False]),
        ("<=", [True, True, None, None, False]),
        (">", [False, False, None, None, True]),
        (">=", [False, None, None, True, True]),
    ],
)
def test_a_clause_is_undecided_where_the_interval_covers_both_sides(relation, words):
    ends = [(1.8, 1.9), (1.9, 2.0), (1.9, 2.1), (2.0, 2.1), (2.1, 2.2)]
    clause, other = Clause("x", relation, 2.0, "why"), Clause("x", relation, "y", "why")
    for (low, high), word in zip(ends, words, strict=True):
        assert clause.holds(measure_with_interval("x", low, high), ("x",)) is word
        assert other.holds(measure_with_interval("x", low, high) | {"y": 2.0}, ("x",)) is word
    assert clause.holds(measure_with_interval("x", 1.0, 3.0)) is clause.holds({"x": 2.0})
    apart = measure_with_interval("x", 1.0, 2.0) | measure_with_interval("y", 3.0, 4.0)
    assert other.holds(apart, ("x", "y")) is (relation in ("<", "<="))
    assert other.holds(apart | measure_with_interval("y", 1.5, 4.0), ("x", "y")) is None
    assert clause.holds(measure_with_interval("x", nan, 3.0), ("x",)) is False


def test_one_clause_that_fails_for_sure_contradicts_whatever_is_undecided():
    rule = replace(RULES["tail_supports"], holds=(Clause("a", ">", 0.0, "why"), Clause("b", ">", 0.0, "why")),
                   spread=("a", "b"))  # fmt: skip
    sure, open_, not_so = (-1.0, -0.5), (-0.5, 0.5), (0.5, 1.0)
    for a, b, held in (
        (open_, sure, False), (sure, open_, False), (sure, not_so, False), (open_, not_so, None), (open_, open_, None),
        (not_so, not_so, True),
    ):  # fmt: skip
        assert rule.held(measure_with_interval("a", *a) | measure_with_interval("b", *b)) is held


@given(
    middle=st.floats(-1.0, 2.0),
    wide=st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0)),
    shares=st.tuples(st.floats(0.0, 1.0), st.floats(0.0, 1.0)),
    claim=st.sampled_from(["displacement_coordinated", "tail_swing", "wagging_balances", "fault_hind_yaw_limbs_only"]),
)
def test_a_narrower_interval_decides_and_changes_no_word_that_was_decided(middle, wide, shares, claim):
    """So that neither more repeats nor more spread make a word kinder."""
    rule = RULES[claim]
    measures = examples_of(rule.experiment)[claim][0][0]
    words = [
        judge(rule, measures | {rule.measure: middle, f"{rule.measure}_low": middle - below,
                                f"{rule.measure}_high": middle + above}).verdict
        for below, above in (wide, (shares[0] * wide[0], shares[1] * wide[1]))
    ]  # fmt: skip
    assert words[0] in (words[1], "undecided")


def test_an_interval_that_reaches_the_printed_number_does_not_make_it_that_number():
    rule, said = RULES["fault_front_yaw_coordinated"], examples_of("joint_faults")["fault_front_yaw_coordinated"][0][0]
    for middle, word in ((-0.22, "reproduced"), (-0.2, "same sense")):
        for half in (0.0, 0.01, 0.1):
            ends = measure_with_interval(rule.measure, middle - half, middle + half)
            assert judge(rule, said | ends | {rule.measure: middle}).verdict == word


def test_more_repeats_make_a_narrower_interval_around_the_middle():
    rng = np.random.default_rng(3)
    widths = []
    for count in (12, 48, 192):
        ends = [estimated("x", rng.normal(size=count), "-") for _ in range(40)]
        assert all(one["x_low"].value <= one["x"].value <= one["x_high"].value for one in ends)
        widths.append(float(np.mean([one["x_high"].value - one["x_low"].value for one in ends])))
    assert widths == sorted(widths, reverse=True)
    assert widths[0] / widths[2] == pytest.approx(4.0, rel=0.35)  # as the root of the number


def test_five_repeats_leave_the_interval_of_a_median_unknown_and_six_span_it():
    values = [3.0, 1.0, 2.0, 6.0, 5.0]
    five, six = estimated("x", values, "m"), estimated("x", [*values, 4.0], "m")
    assert five["x"].value == 3.0
    assert np.isnan([five["x_low"].value, five["x_high"].value]).all()
    assert [six[name].value for name in ("x", "x_low", "x_high")] == [3.5, 1.0, 6.0]
    assert all(np.isnan(one.value) for one in estimated("x", [1.0, nan], "m").values())


def test_a_fraction_is_estimated_with_the_exact_interval():
    all_of_them = estimated_fraction("x", np.ones(32, bool))
    assert all_of_them["x_low"].value == pytest.approx(0.8911, abs=1e-4)  # 0.025 ** (1 / 32), below a bound of 0.95
    assert all_of_them["x_high"].value == 1.0
    assert estimated_fraction("x", np.ones(72))["x_low"].value > 0.95
    quarter = estimated_fraction("x", [0.0, 0.0, 0.0, 1.0])
    assert [quarter[name].value for name in ("x", "x_low", "x_high")] == pytest.approx([0.25, 0.0063, 0.8059], abs=1e-4)
    assert all(np.isnan(one.value) for one in estimated_fraction("x", [1.0, nan]).values())


def test_a_measure_with_an_unknown_interval_decides_nothing_and_says_why():
    measures = SWINGS[0][0] | {"gain_tail_swing": 0.5, "gain_tail_swing_low": nan, "gain_tail_swing_high": nan}
    verdict = judge(RULES["tail_swing"], measures)
    assert verdict.verdict == "undecided"
    assert (verdict.measured, verdict.low, verdict.high) == (0.5, None, None)
    assert "interval of gain_tail_swing is unknown" in verdict.why
    assert f"{MIN_REPEATS} at least" in verdict.why
    assert min_median_count() == MIN_REPEATS
    assert "unknown" not in judge(RULES["tail_swing"], SWINGS[0][0]).why


def test_an_effect_that_is_surely_there_and_too_small_to_matter_is_none():
    effect = SmallestEffect(size=0.01, why="a reason")
    above, below = Clause("x", ">", 0.0, "gain", effect), Clause("x", "<", 0.0, "loss", effect)
    for low, high, holds in ((0.002, 0.009, False), (0.009, 0.02, None), (0.011, 0.02, True), (-0.02, -0.011, False)):
        measures = measure_with_interval("x", low, high)
        assert above.holds(measures, ["x"]) is holds
        mirrored = measure_with_interval("x", -high, -low)
        assert below.holds(mirrored, ["x"]) is holds
    assert str(above) == "x > 0 by at least 0.01: gain (the least that matters: a reason)"


def test_a_clause_of_another_measure_that_decides_is_shown_with_its_value():
    rule, rows = RULES["fault_support"], examples_of("joint_faults")["fault_support"]
    fails = rows[0][0] | measure_with_interval("com_rise_limp", -0.009, -0.007)
    fails |= measure_with_interval("com_rise_locked", -0.009, -0.007)
    assert judge(rule, fails).verdict == "contradicted"
    assert "What fails is com_rise_limp > 0 by at least 0.001 (com_rise_limp: -0.008, -0.009 to -0.007)." in (
        judge(rule, fails).why
    )
    undecided = rows[0][0] | measure_with_interval("com_rise_limp", 0.0005, 0.002)
    assert "Undecided is com_rise_limp > 0" in judge(rule, undecided).why
    shown = fails | measure_with_interval("support_share_limp", 0.1, 0.2)
    for measures in (rows[0][0], shown):  # it holds, or what is shown decides too
        assert "What fails" not in judge(rule, measures).why
    assert RULES["tail_swing"].deciding(SWINGS[2][0]) == ""


def test_a_verdict_is_fragile_where_other_designs_say_otherwise():
    measures = SWINGS[0][0]  # reproduced
    for share, held in ((ROBUST + 0.01, False), (ROBUST - 0.01, True)):
        verdict = judge(RULES["tail_swing"], measures, {"tail_swing": replace(SHARE, share=share)})
        assert verdict.fragile is held
    contradicted = SWINGS[2][0]
    for share, held in ((1 - ROBUST - 0.01, False), (1 - ROBUST + 0.01, True)):
        verdict = judge(RULES["tail_swing"], contradicted, {"tail_swing": replace(SHARE, share=share)})
        assert verdict.fragile is held
    assert not judge(RULES["tail_swing"], measures, {}).fragile


@pytest.mark.parametrize(
    ("words", "reproduced", "contradicted"),
    [
        ({"reproduced": 3, "undecided": 9}, False, True),
        ({"reproduced": 3, "same sense": 3, "contradicted": 1}, True, True),
        ({"contradicted": 2, "not testable": 5}, True, False),
        ({"models disagree": 12}, False, False),  # none says otherwise
    ],
)
def test_few_designs_make_a_verdict_fragile_too(words, reproduced, contradicted):
    rule = RULES["tail_swing"]
    few = SparseShare(claim="tail_swing", words=words, of="", rule=rule.asked)
    assert fragile(rule, "reproduced", few) is reproduced
    assert fragile(rule, "contradicted", few) is contradicted
    assert not fragile(rule, "undecided", few)
    assert not fragile(rule, "reproduced", replace(few, rule="another"))


@pytest.mark.parametrize(
    ("claim", "fragile"),
    [("spine_sinusoidal", False), ("displacement_ratio", False), ("tail_swing", True), ("tail_swings_in_crawl", True)],
)
def test_what_was_built_in_or_fitted_is_not_fragile(claim, fragile):
    """Whatever word it gets: a number that was chosen for one design says nothing that others could shake."""
    share = replace(SHARE, claim=claim, share=0.5)
    for measures, word in examples_of(RULES[claim].experiment)[claim]:
        asked = word in ("reproduced", "same sense", "contradicted")
        assert judge(RULES[claim], measures, {claim: share}).fragile is (fragile and asked)


def test_rules_are_read_without_their_experiments():
    code = (
        "import sys; from suchus.experiments.claims import RULES; [*RULES]; print({'numpy', 'mujoco'} & {*sys.modules})"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"


def test_a_rule_beside_another_experiment_is_refused(tmp_path, monkeypatch):
    """And one file can hold a question, its rules and their examples."""
    text = "from suchus.article.verdict import Rule\nRULES = ({},)\n{}\n"
    rule = 'Rule(claim="joint_pid", experiment={!r}, measure="x", why="because")'
    examples = "EXAMPLES = {'joint_pid': [({'x': 1.0}, 'reproduced')]}"
    (tmp_path / "strange.py").write_text(text.format(rule.format("displacement"), examples))
    (tmp_path / "whole.py").write_text(text.format(rule.format("whole"), examples))
    monkeypatch.setattr(suchus.experiments.catalog, "__path__", [*suchus.experiments.catalog.__path__, str(tmp_path)])
    with pytest.raises(InvalidDesign, match=r"RULES of strange hold Rule.*no Rule of this experiment"):
        rules_of("strange")
    assert [rule.claim for rule in rules_of("whole")] == ["joint_pid"]
    assert examples_of("whole") == {"joint_pid": [({"x": 1.0}, "reproduced")]}
    for name in ("strange", "whole"):
        monkeypatch.delitem(sys.modules, f"suchus.experiments.catalog.{name}")


def test_every_statement_of_the_article_has_a_rule_or_a_reason_why_there_is_none():
    assert set(RULES) | set(UNRULED) == set(CLAIMS)
    assert not set(RULES) & set(UNRULED)
    assert all(len(why) > 40 for why in UNRULED.values())


def test_an_experiment_without_rules_has_none():
    assert rules_of("turning") == ()
    assert rules_of("of no shelf") == ()


def test_a_statement_that_holds_by_one_meaning_alone_depends_on_the_reading():
    rule, rows = RULES["fault_hind_pitch_coordinated"], examples_of("joint_faults")["fault_hind_pitch_coordinated"]
    limp, locked = "loss_hind_pitch_limp_one_coordinated", "loss_hind_pitch_locked_one_coordinated"
    measures = rows[0][0] | measure_with_interval(limp, -0.42, -0.38)
    verdict = judge(rule, measures | measure_with_interval(locked, -0.03, -0.01))
    assert verdict.verdict == "depends on the reading"
    assert "limp: contradicted (-0.4, -0.42 to -0.38); locked: same sense (-0.02, -0.03 to -0.01)" in verdict.why
    assert judge(rule, measures | measure_with_interval(locked, -0.3, -0.2)).verdict == "contradicted"
    undecided = judge(rule, measures | measure_with_interval(locked, -0.2, 0.0))
    assert undecided.verdict == "contradicted"
    assert "locked: undecided" in undecided.why
