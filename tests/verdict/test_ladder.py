"""What several models say of one claim: who has a word, and on which word they agree."""

from dataclasses import replace
from math import inf, nan

import pytest

from suchus.article.verdict import Clause, Rule, Rung, judge, ladder
from suchus.core.errors import IncompatibleRecord

RUNGS = (
    Rung(name="theory", model="theory", why="It has the force at hand."),
    Rung(name="slice", model="a slice", why="It resolves the wake."),
    Rung(name="means", model="means", why="It knows no instant.", carries=False),
)
RULE = Rule(
    claim="swim_spine_thrust", experiment="swimming", measure="gain", holds=(Clause("gain", ">", 0.0, "it gives"),),
    rungs=RUNGS, why="The gain.", form="+.0%",
)  # fmt: skip


def said(apart=0.0, **gains):
    """Return measures of rungs: a gain each, or its least and greatest."""
    found = {}
    for name, gain in gains.items():
        low, high = gain if isinstance(gain, tuple) else (gain, gain)
        found |= {f"gain_{name}": 0.5 * (low + high), f"gain_{name}_low": low, f"gain_{name}_high": high}
        found[f"gain_{name}_apart"] = apart
    return found


@pytest.mark.parametrize(
    ("theory", "plane", "word"),
    [
        (0.1, 0.2, "reproduced"),
        (-0.1, -0.2, "contradicted"),
        (0.1, -0.2, "models disagree"),
        (-0.1, 0.2, "models disagree"),
        ((0.01, 0.2), -0.2, "models disagree"),
        ((-0.01, 0.2), -0.2, "contradicted"),  # the theory says both, and so nothing
        ((-0.01, 0.2), 0.2, "reproduced"),
        ((-0.01, 0.2), (-0.2, 0.01), "undecided"),
        (nan, 0.2, "reproduced"),
        (nan, nan, "not testable"),
    ],
)
def test_the_word_is_the_one_on_which_the_rungs_agree(theory, plane, word):
    assert judge(RULE, said(theory=theory, slice=plane)).verdict == word


@pytest.mark.parametrize(("apart", "word"), [(0.099, "models disagree"), (0.101, "undecided"), (nan, "contradicted")])
def test_a_rung_that_is_not_settled_has_no_word(apart, word):
    measures = said(theory=-0.1, slice=0.2) | {"gain_slice_apart": apart}
    verdict = judge(RULE, measures)
    assert verdict.verdict == word
    silent = verdict.voices[1].why
    assert ("Not settled" in silent) == (apart == 0.101)
    assert verdict.voices[1].value == 0.2  # the table shows it nevertheless


@pytest.mark.parametrize(
    ("unsettled", "word"), [(0.2, "undecided"), (-0.2, "contradicted"), ((-0.2, 0.2), "contradicted")]
)
def test_one_rung_alone_does_not_decide_against_another_that_is_not_settled(unsettled, word):
    measures = said(theory=-0.1, slice=unsettled) | {"gain_slice_apart": 0.5}
    verdict = judge(RULE, measures)
    assert verdict.verdict == word
    assert ("one model alone" in verdict.why) == (word == "undecided")
    second = Rung(name="space", model="space", why="It has no symmetry.")
    two = judge(replace(RULE, rungs=(*RUNGS, second)), measures | said(space=-0.3))
    assert two.verdict == "contradicted"  # who is not settled has no word against two who agree


def test_a_rung_that_cannot_carry_the_claim_has_no_word_whatever_it_measured():
    verdict = judge(RULE, said(theory=0.1, slice=0.2, means=-5.0))
    assert verdict.verdict == "reproduced"
    assert (verdict.voices[2].says, verdict.voices[2].why) == ("no word", "It knows no instant.")
    carried = replace(RULE, rungs=(*RUNGS[:2], replace(RUNGS[2], carries=True)))
    assert judge(carried, said(theory=0.1, slice=0.2, means=-5.0)).verdict == "models disagree"


def test_a_rung_that_could_not_run_says_so_and_the_word_comes_from_the_rest():
    measures, reason = said(theory=0.1, slice=-0.2), {"slice": "The grid is too coarse."}
    verdict = judge(RULE, measures, unable=reason)
    assert verdict.verdict == "reproduced"
    assert verdict.voices[1].why == "The grid is too coarse."
    assert judge(RULE, measures, unable=reason | {"theory": "It found no speed."}).verdict == "not testable"


def test_a_bound_that_is_measured_is_each_rungs_own():
    rule = replace(RULE, holds=(Clause("gain", ">", "noise", "more than its noise"),))
    noise = {"noise_theory": 0.05, "noise_slice": 0.3}
    verdict = judge(rule, said(theory=0.1, slice=0.2) | noise)
    assert [voice.says for voice in verdict.voices] == ["holds", "does not hold", "no word"]


def test_its_number_is_the_middle_of_those_that_have_a_word():
    verdict = judge(RULE, said(theory=(0.1, 0.3), slice=0.6))
    assert (verdict.measured, verdict.low, verdict.high) == (pytest.approx(0.4), 0.1, 0.6)
    only = judge(RULE, said(theory=nan, slice=0.6))
    assert (only.measured, only.low, only.high) == (0.6, 0.6, 0.6)
    none = judge(RULE, said(theory=nan, slice=nan))
    assert (none.measured, none.low, none.high) == (None, None, None)


def test_what_became_of_an_animals_or_a_built_in_claim():
    measures = said(theory=0.1, slice=0.2)
    assert judge(replace(RULE, kind="animals"), measures).verdict == "same sense"
    assert judge(replace(RULE, kind="construction"), measures).verdict == "by construction"
    assert judge(replace(RULE, kind="animals"), said(theory=-0.1, slice=-0.2)).verdict == "not testable"


def test_models_that_disagree_confirm_nothing():
    verdict = judge(RULE, said(theory=0.1, slice=-0.2))
    assert verdict.verdict == "models disagree"
    assert not verdict.fragile


def test_the_reason_and_the_table_name_every_model():
    verdict = judge(RULE, said(theory=(0.1, 0.3), slice=-0.2))
    assert verdict.why == (
        "The gain. It holds in theory (+20% (+10% to +30%)). It does not hold in a slice (-20%). No word: means."
    )
    rows = ladder.rows(verdict.voices, "+.0%")
    assert [row["says"] for row in rows] == ["holds", "does not hold", "no word"]
    assert [row["number"] for row in rows] == ["+20% (+10% to +30%)", "-20%", "–"]


def test_what_a_rung_should_have_measured_is_named():
    with pytest.raises(IncompatibleRecord, match="needs gain_slice_high, which swimming did not measure"):
        judge(RULE, {name: one for name, one in said(theory=0.1, slice=inf).items() if name != "gain_slice_high"})


def test_a_number_that_rounds_to_zero_has_no_minus():
    rows = ladder.rows(ladder.voices(RULE, said(theory=-0.001, slice=(-1e-18, 0.1))), RULE.form)
    assert [row["number"] for row in rows[:2]] == ["0%", "+5% (0% to +10%)"]
