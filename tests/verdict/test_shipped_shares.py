"""The table of shares that ships: whole, of today's rules, and read by the verdicts."""

import json
from dataclasses import replace
from importlib import resources

import pytest
from tests.rule_examples import examples_of

from suchus.article.verdict import SHARES, SPARSE_SHARES, Share, judge
from suchus.article.verdict.judging import digest
from suchus.experiments.claims import RULES
from suchus.experiments.study.claim_measures import claims_varied
from suchus.experiments.study.varied import MIN_POINTS
from suchus.robot.design import value_at
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS

FILE = resources.files("suchus.article.verdict") / "claims.json"
TOLD = json.loads(FILE.read_text(encoding="utf-8")) if FILE.is_file() else {}
shipped = pytest.mark.skipif(not TOLD, reason="no table has been shipped yet")


def test_a_changed_row_has_another_digest():
    rows = {"tail_swing": {"share": 0.5}, "spine_swing": {"share": 1.0}}
    assert digest(rows) == digest(dict(reversed(rows.items())))
    assert digest(rows) != digest(rows | {"tail_swing": {"share": 0.51}})


@shipped
def test_its_digest_is_that_of_its_rows():
    assert TOLD["digest"] == digest(TOLD["claims"])
    assert {"samples", "seed", "timestep", "agreement", "versions", "source"} <= set(TOLD)
    assert TOLD["samples"] & (TOLD["samples"] - 1) == 0  # a power of two, as Sobol's sequence asks
    assert sum(TOLD["became"].values()) == TOLD["samples"]


@shipped
def test_every_rule_without_an_excuse_has_a_row_and_every_row_a_rule():
    assert not set(SHARES) & set(SPARSE_SHARES)
    assert set(SHARES) | set(SPARSE_SHARES) == {claim for claim, rule in RULES.items() if not rule.unswept}


@shipped
def test_a_row_says_what_was_asked_and_by_which_source():
    for claim, share in SHARES.items():
        assert share.of == (RULES[claim].experiment if claim in claims_varied() else "")
        made = TOLD["varied"][share.of] if share.of else TOLD
        assert set(made["source"]) == {"runs", "answers"}
        assert share.designs <= made["samples"] == sum(made["became"].values())


@shipped
def test_what_too_few_designs_could_judge_says_what_they_say():
    for claim, few in SPARSE_SHARES.items():
        assert few.of == (RULES[claim].experiment if claim in claims_varied() else "")
        asked = TOLD["varied"][few.of]["became"]["asked"] if few.of else TOLD["became"]["walked"]
        assert MIN_POINTS <= sum(few.words.values()) == asked
        judged = sum(few.words.get(word, 0) for word in ("reproduced", "same sense", "contradicted"))
        assert judged < MIN_POINTS


def test_a_share_of_another_rule_says_nothing_of_this_one():
    rule = RULES["tail_swing"]
    measures = examples_of(rule.experiment)["tail_swing"][0][0]
    share = Share(claim="tail_swing", share=0.5, low=0.4, high=0.6, designs=99, turned_by="", at=None, above=False)
    for of, known in ((rule.asked, True), (RULES["spine_swing"].asked, False)):
        verdict = judge(rule, measures, {"tail_swing": replace(share, rule=of)})
        assert (verdict.share is not None, verdict.fragile) == (known, known)
    assert len({one.asked for one in RULES.values()}) >= len(RULES) - 1  # one claim is said twice
    moved = replace(rule, holds=(replace(rule.holds[0], bound=1e-9),))
    assert moved.asked != rule.asked


@shipped
@pytest.mark.parametrize("share", SHARES.values(), ids=list(SHARES))
def test_a_row_says_a_share_with_its_interval_and_what_turns_it(share):
    assert 0.0 <= share.low <= share.share <= share.high <= 1.0
    assert MIN_POINTS <= share.designs <= TOLD["samples"]
    assert share.high - share.low < 4 / share.designs**0.5
    assert (share.turned_by == "") == (share.at is None)
    if share.turned_by:
        of, _, name = share.turned_by.partition(".")
        if share.claim in claims_varied():  # a field of its experiment, see tests/study/test_varied.py
            return
        rows = {"robot": ROBOTS.beside("caiman", "chosen", ()), "gait": GAITS.beside("belly_crawl", "chosen", ())}[of]
        (one,) = [row for row in rows if row.field == name]
        assert one.low <= share.at <= one.high
        value_at({"robot": ROBOTS["caiman"], "gait": GAITS["belly_crawl"]}[of], name)
