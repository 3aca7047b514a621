"""What of the verdicts is evidence: each kind of claim is counted as what it is, whatever became of it."""

from dataclasses import replace

import pytest

from suchus.article.paper import CLAIMS
from suchus.article.verdict import Clause, Rule
from suchus.article.verdict.judging import WORDS
from suchus.experiments.claims import RULES, count_evidence, standings

MEASURED = Rule(claim="a", experiment="e", measure="x", holds=(Clause("x", ">", 0.0, "more is more"),), why="why")
OTHER = replace(MEASURED, claim="b", holds=(Clause("x", ">", 1.0, "more is more"),))


@pytest.mark.parametrize(
    ("kind", "word", "standing"),
    [
        *(("measured", word, "not testable" if word == "not testable" else "evidence") for word in WORDS),
        ("construction", "by construction", "by construction"),
        ("construction", "contradicted", "by construction"),
        ("fitted", "fitted", "fitted"),
        ("fitted", "same sense", "fitted"),
        ("fitted", "contradicted", "fitted"),
        ("animals", "same sense", "animals"),
        ("animals", "not testable", "animals"),
    ],
)
def test_what_a_verdict_is_worth_follows_from_what_its_claim_rests_on(kind, word, standing):
    assert standings({"a": word}, {"a": replace(MEASURED, kind=kind)}) == {"a": standing}


def test_the_same_comparison_of_the_same_number_counts_once():
    words = {"a": "reproduced", "b": "reproduced"}
    twice = replace(MEASURED, claim="b", holds=(Clause("x", ">", 0.0, "another reason"),))
    for rule, standing in (
        (twice, "said twice"),
        (OTHER, "evidence"),
        (replace(twice, measure="y"), "evidence"),
        (replace(twice, experiment="f"), "evidence"),
        (replace(twice, holds=(Clause("x", ">=", 0.0, ""),)), "evidence"),
    ):
        assert standings(words, {"a": MEASURED, "b": rule}) == {"a": "evidence", "b": standing}
    bare = replace(MEASURED, holds=(), kind="construction")
    assert set(standings(words, {"a": bare, "b": replace(bare, claim="b")}).values()) == {"by construction"}


def test_a_fit_and_an_identity_that_fail_are_no_evidence_either():
    rules = {name: replace(OTHER, claim=name, measure=name) for name in "abcdefgh"}
    rules |= {name: replace(rules[name], kind="fitted") for name in "cd"}
    rules |= {name: replace(rules[name], kind="construction") for name in "ef"}
    rules["g"] = replace(rules["g"], kind="animals")
    words = dict(zip("abcdefgh", ["reproduced", "contradicted", "fitted", "same sense", "by construction",
                                  "contradicted", "same sense", "not testable"], strict=True))  # fmt: skip
    count = count_evidence(words, ["b", "d"], rules)
    assert count.claims == sum(count.standing.values()) == 8
    assert count.words == {"reproduced": 1, "contradicted": 1}
    assert count.fragile == 1
    assert str(count) == (
        "Of 8 claims of the article 2 could come out either way: 1 reproduced, 1 contradicted; 1 of these is fragile, "
        "since more than one in ten plausible designs say otherwise. The others could not: 2 read back, or "
        "consequences of formulas or symmetry (1 do not hold), 2 fitted (1 came out), 1 said of animals (the robot "
        "does the same in "
        "1) and 1 not testable."
    )


def test_nothing_is_counted_of_no_verdicts_and_a_claim_without_a_rule_counts_as_measured():
    assert str(count_evidence({})) == ""
    assert str(count_evidence({"a": "reproduced"}, (), {"a": MEASURED})).startswith("Of 1 claim of the article 1 could")
    (published,) = [name for name, claim in CLAIMS.items() if claim.of][:1]
    assert str(count_evidence({published: "reproduced"})) == (
        "Of 1 statement of other publications on salamanders: 1 reproduced."
    )
    assert count_evidence({"of nobody": "contradicted"}).words == {"contradicted": 1}


def test_of_the_article_s_claims_the_algebra_is_named_and_one_is_said_twice():
    worth = standings(dict.fromkeys(RULES, "contradicted"))
    algebra = {"leg_inverse", "spine_forward", "tail_cords_inextensible", "tail_joint_positions"}
    assert {worth[claim] for claim in algebra} == {"by construction"}
    assert [claim for claim, standing in worth.items() if standing == "said twice"] == ["bending_lengthens_stride"]
    assert worth["spine_swing"] == "evidence"
