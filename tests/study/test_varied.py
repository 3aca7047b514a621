"""An experiment that is asked again with other designs and settings."""

import json
from dataclasses import dataclass, field, replace
from math import isfinite
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr
from tests.rule_examples import examples_of

from suchus.article.verdict import SparseShare, Variation
from suchus.article.verdict.judging import digest
from suchus.core.errors import IncompatibleRecord, InvalidDesign, OutsideLimits
from suchus.core.files import read_json
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.claims import RULES, design_sweep_of
from suchus.experiments.study.answers import share_interval
from suchus.experiments.study.claim_measures import claims_varied, judge_samples, swept_rules, words
from suchus.experiments.study.claims_table import claim_row, renewed_table, shares
from suchus.experiments.study.study import Vary
from suchus.experiments.study.varied import (
    MIN_POINTS,
    VariedStudy,
    answer_varied,
    conduct_varied,
    varied_finished,
    varied_study,
)
from suchus.robot.design import Robot, value_at
from suchus.robot.robots import ROBOTS

CLAIM = "tail_quadratic_small"
OF_A_PART = {
    "crawl_stability": "com_height_pp_change_low",
    "feedback": "kick_kept_open",
    "joint_faults": "loss_front_yaw_limp_one_coordinated",
    "pattern_generator": "lag_walk",
    "speed_range": "unknown",
    "swimming": "speed_free",
    "terrain": "falls_switching",
}
"""Questions that are asked in part for their claims, and a measure that takes the whole."""
DECLARED = {name: design_sweep_of(name) for name in EXPERIMENTS if design_sweep_of(name) is not None}


@dataclass(frozen=True)
class Gap:
    """A question whose answer is known: the error of (17) is three times the gap of the tail, in metres."""

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    steps: int = 10
    refused: float = 1.0

    @staticmethod
    def name():
        return "gap"

    def simulate_measures(self, wanted, progress=None):
        if self.robot.tables.tail.gap > self.refused:
            raise OutsideLimits("too wide a gap")
        error = 3.0 * self.robot.tables.tail.gap
        return {"error_of_eq_17_max": SimpleNamespace(value=error), "beside": SimpleNamespace(value=0.0)}


def study(**other):
    vary = (Vary(field="robot.tail.gap", low=0.01, high=0.02), Vary(field="steps", low=10, high=19))
    return VariedStudy(
        **({"name": "gap", "experiment": Gap(), "vary": vary, "claims": (CLAIM,), "samples": 32} | other)
    )


def test_a_claim_holds_in_the_share_of_designs_that_is_known(tmp_path):
    record = conduct_varied(study(), tmp_path)
    row = claim_row(record, CLAIM)
    true = int((record.value.sel(parameter="robot.tail.gap") < 0.05 / 3).sum())  # below 5 % the error counts as small
    assert 20 <= true <= 22  # two thirds of the range, evenly filled
    assert row["samples"] == 32
    assert row["true"] == true / 32
    assert row["interval"] == share_interval(true, 32)
    assert row["border"]["parameter"] == "robot.tail.gap"
    assert row["border"]["true"] == "below"
    assert row["border"]["at"] == pytest.approx(0.05 / 3, abs=5e-4)
    assert record.parameter_unit.values.tolist() == ["m", "-"]


def test_points_are_whole_where_a_field_is_whole_and_stay_the_same_in_a_larger_study():
    few, many = study(samples=8), study(samples=32)
    assert all(few.point(i) == many.point(i) for i in range(8))
    steps = [many.point(i)["steps"] for i in range(32)]
    assert all(isinstance(step, int) for step in steps)
    assert set(steps) == set(range(10, 20))


def test_what_is_refused_is_counted_apart_and_judges_nothing(tmp_path):
    record = conduct_varied(study(experiment=Gap(refused=0.015)), tmp_path)
    refused = (record.status == "outside limits").values
    assert 15 <= refused.sum() <= 17
    assert np.isnan(record.number.sel(claim=CLAIM).values[refused]).all()
    assert claim_row(record, CLAIM)["samples"] == 32 - refused.sum()
    assert claim_row(record, CLAIM)["true"] == 1.0


def test_too_few_designs_make_no_share_but_their_words_are_told():
    def of(asked):
        error = ["" if i < asked else "OutsideLimits: too wide a gap" for i in range(12)]
        numbers = np.where(np.arange(12) < asked, 0.03, np.nan)
        columns = {"error_of_eq_17_max": ("sample", numbers), "error": ("sample", error)}
        return answer_varied(study(samples=12), xr.Dataset(columns, coords={"sample": range(12)}))

    record = of(MIN_POINTS - 1)
    assert set(record.word.sel(claim=CLAIM).values[MIN_POINTS - 1 :]) == {""}
    few, enough = (shares([claim_row(one, CLAIM)], {"gap": one})[CLAIM] for one in (record, of(MIN_POINTS)))
    assert few == {"words": {"reproduced": MIN_POINTS - 1}, "of": "gap", "rule": RULES[CLAIM].asked}
    assert enough["designs"] == MIN_POINTS
    told = SparseShare(claim=CLAIM, words={"contradicted": 2, "reproduced": 1}, of="gap", rule="")
    assert str(told).endswith("too few of which could judge it to know a share: 1 reproduced and 2 contradicted.")


def test_a_word_of_a_design_is_that_of_the_verdict():
    for claim, rows in examples_of("tail_bending").items():
        for measures, word in rows:
            if measures.keys() >= RULES[claim].needs:
                assert words(RULES[claim], {name: np.array([value]) for name, value in measures.items()}) == [word]


def test_a_study_goes_on_where_it_was_stopped_and_answers_from_what_is_there(tmp_path):
    asked = study(samples=16)

    def stopped(stage, share):
        if share > 0.6:
            raise KeyboardInterrupt

    assert varied_finished(asked, tmp_path) is None
    with pytest.raises(KeyboardInterrupt):
        conduct_varied(asked, tmp_path, progress=stopped)
    there = varied_finished(asked, tmp_path)
    assert MIN_POINTS <= there.sizes["sample"] < 16
    whole = conduct_varied(asked, tmp_path)
    xr.testing.assert_identical(
        there.drop_attrs().number, whole.drop_attrs().number.isel(sample=slice(0, there.sizes["sample"]))
    )
    assert json.loads(whole.attrs["made_by"]) == read_json(tmp_path / "gap" / "study.json")["versions"]


def test_rows_of_one_experiment_are_put_into_the_table_and_those_of_another_rule_leave_it(tmp_path):
    record = conduct_varied(study(), tmp_path)
    row = {"share": 0.5, "low": 0.4, "high": 0.6, "designs": 9, "turned_by": "", "at": None, "above": False, "of": ""}
    rows = {"tail_swing": row | {"rule": RULES["tail_swing"].asked}, "spine_swing": row | {"rule": "another"},
            CLAIM: row | {"rule": RULES[CLAIM].asked}}  # fmt: skip
    before = json.dumps({"claims": rows, "samples": 2048, "varied": {"terrain": {"samples": 8}}})
    table = json.loads(renewed_table(before, [claim_row(record, CLAIM)], {"gap": record}))
    assert set(table["claims"]) == {"tail_swing", CLAIM}
    assert table["claims"]["tail_swing"] == rows["tail_swing"]
    assert table["claims"][CLAIM]["designs"] == 32
    assert (table["claims"][CLAIM]["of"], table["claims"][CLAIM]["rule"]) == ("gap", RULES[CLAIM].asked)
    assert table["digest"] == digest(table["claims"])
    assert table["samples"] == 2048
    assert set(table["varied"]) == {"terrain", "gap"}
    assert table["varied"]["gap"]["samples"] == 32


def test_points_of_another_plan_are_refused_with_what_renews_them(tmp_path):
    conduct_varied(study(samples=8), tmp_path)
    assert varied_finished(study(samples=8), tmp_path) is not None
    wider = (Vary(field="robot.tail.gap", low=0.01, high=0.03), study().vary[1])
    for other in ({"vary": wider}, {"seed": 1}):
        with pytest.raises(IncompatibleRecord, match=r"another plan.*suchus study claims --only gap"):
            varied_finished(study(samples=8, **other), tmp_path)


def test_a_study_that_varies_nothing_is_refused():
    with pytest.raises(InvalidDesign, match="gap varies nothing"):
        study(vary=())


@pytest.mark.parametrize("name", OF_A_PART)
def test_what_is_measured_of_a_part_is_what_the_whole_measures(name, quick_outcome):
    wanted = set().union(*(RULES[claim].needs for claim in DECLARED[name].claims))
    part, whole = EXPERIMENTS[name].quick().simulate_measures(wanted), quick_outcome(name).measures
    assert wanted <= part.keys() <= whole.keys()
    asked = sorted(wanted) if name != "swimming" else [one for one in sorted(wanted) if isfinite(part[one].value)]
    np.testing.assert_array_equal([part[one].value for one in asked], [whole[one].value for one in asked])
    for claim in DECLARED[name].claims:  # what no word of swimming needs does not swim
        said = [judge_samples(RULES[claim], {key: np.array([of[key].value]) for key in wanted}) for of in (part, whole)]
        np.testing.assert_array_equal(*said)


@pytest.mark.parametrize(("name", "measure"), OF_A_PART.items())
def test_what_is_not_of_the_part_is_measured_of_the_whole(name, measure, monkeypatch):
    question = EXPERIMENTS[name].quick()
    monkeypatch.setattr(type(question), "simulate", lambda self, progress: SimpleNamespace(record=self))
    monkeypatch.setattr(type(question), "measure", lambda self, record: {measure: record})
    assert question.simulate_measures({measure})[measure] == question


def test_no_other_gait_is_walked_than_those_that_are_asked_for(monkeypatch):
    """And every question that is asked in part is among those that are tried above."""
    question = EXPERIMENTS["speed_range"]
    monkeypatch.setattr(type(question), "simulate", lambda self, progress: SimpleNamespace(record=self))
    monkeypatch.setattr(type(question), "measure", lambda self, record: dict.fromkeys(g.name for g in record.gaits))
    assert question.simulate_measures({"speed_high_walk_slowest_low", "tail_on_ground_high_walk"}).keys() == {
        "high_walk"
    }
    assert question.simulate_measures({"cost_semi_erect", "speed_high_walk"}).keys() == {"semi_erect", "high_walk"}
    assert {name for name in DECLARED if "simulate_measures" in vars(type(EXPERIMENTS[name]))} == set(OF_A_PART)


@pytest.mark.parametrize("name", DECLARED)
def test_what_is_declared_can_be_asked_and_meets_what_is_judged(name):
    declared, shelf = DECLARED[name], EXPERIMENTS[name]
    assert isinstance(declared, Variation)
    assert replace(shelf, **declared.settings).unjudged() == ""
    assert set(declared.claims) <= {rule.claim for rule in shelf.rules()}
    asked = varied_study(shelf)
    assert asked.samples & (asked.samples - 1) == 0
    for one in asked.vary:
        assert "range[" not in one.field  # a limit of a joint only forbids
        assert one.low <= value_at(asked.experiment, one.field) <= one.high, one.field
    assert all(len(why) > 20 for _, _, why in declared.over.values())


def test_a_claim_is_answered_once_or_says_why_nothing_can_vary():
    walked, again = {rule.claim for rule in swept_rules()}, claims_varied()
    excused = {claim for claim, rule in RULES.items() if rule.unswept}
    assert walked | again | excused == set(RULES)
    assert not walked & again
    assert not again & excused
