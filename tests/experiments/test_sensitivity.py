"""Whether the statements survive other designs, in small: the same engine as the study of the claims."""

import csv
import io
from dataclasses import replace

import numpy as np
import pytest

from suchus.article.verdict.judging import Share
from suchus.core.errors import InvalidDesign
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.sensitivity import experiment as sensitivity
from suchus.experiments.study import Claims, Plan
from suchus.experiments.study.claim_measures import RUNS, swept_rules
from suchus.robot.gaits import GAITS

FULL = EXPERIMENTS["sensitivity"]


@pytest.fixture(scope="module")
def outcome(quick_outcome):
    return quick_outcome("sensitivity")


def share(**changes):
    row = {"share": 1.0, "low": 0.9, "high": 1.0, "designs": 1500, "turned_by": "", "at": None, "above": False}
    return Share(claim="", **row | changes)


def test_it_asks_what_the_study_of_the_claims_asks(outcome):
    record = outcome.record
    assert record.claim.values.tolist() == [rule.claim for rule in swept_rules()]
    assert record.run.values.tolist() == list(RUNS)
    plan = Plan(Claims().study(2048, FULL.timestep))
    for i in range(record.sizes["sample"]):
        assert record.value.values[i].tolist() == list(plan[i * len(RUNS)].values.values())


def test_what_cannot_walk_is_counted_and_not_judged(outcome):
    count = {name: m.value for name, m in outcome.measures.items() if name.startswith("samples_")}
    assert count == {"samples_walked": 3, "samples_outside_limits": 1, "samples_impossible": 0, "samples_came_apart": 0}
    assert outcome.measures["judged_displacement_coordinated"].value == 3
    assert np.isnan(outcome.record.number.sel(sample=outcome.record.status == "outside limits")).all()


def test_shares_in_the_table_are_those_of_the_measures(outcome):
    rows = {row["claim"]: row for row in csv.DictReader(io.StringIO(outcome.tables["sensitivity.csv"]))}
    assert list(rows) == list(outcome.record.claim.values)
    for key, row in rows.items():
        judged = outcome.measures[f"judged_{key}"].value > 0
        assert np.isfinite(outcome.measures[f"share_{key}"].value) == judged
        assert float(row["true"]) == pytest.approx(outcome.measures[f"share_{key}"].value, abs=6e-4, nan_ok=True)
        assert float(row["true_low"]) == pytest.approx(
            outcome.measures[f"share_{key}_low"].value, abs=6e-4, nan_ok=True
        )
        assert int(row["samples"]) == outcome.measures[f"judged_{key}"].value


def test_two_samples_of_one_population_differ_by_chance_and_of_two_do_not():
    assert sensitivity._chance(25, 25, share()) == 1.0
    assert sensitivity._chance(22, 25, share(share=0.9)) > 0.5
    assert sensitivity._chance(20, 25, share()) < 1e-6
    assert sensitivity._chance(5, 25, share(share=0.5)) < 0.01
    assert sensitivity._chance(0, 0, share(share=0.5)) == 1.0


def test_a_changed_simulator_is_noticed(outcome, monkeypatch):
    record = outcome.record.isel(sample=[0]).assign_attrs(shipped=1)
    true = {key: float(record.holds.sel(claim=key).any()) for key in record.claim.values}
    monkeypatch.setattr(sensitivity, "SHARES", {key: share(share=value) for key, value in true.items()})
    same = FULL.measure(record)
    assert same["compared_with_shipped"].value == len(true)
    assert same["shipped_agreement_chance"].value == 1.0
    assert "of the shipped table agree" in FULL.explain({name: m.value for name, m in same.items()})
    monkeypatch.setattr(sensitivity, "SHARES", {key: share(share=1 - value) for key, value in true.items()})
    other = FULL.measure(record)
    assert other["shipped_agreement_chance"].value == pytest.approx(len(true) / 1501)
    certain = {name: m.value for name, m in other.items()} | {"shipped_agreement_chance": 0.009}
    assert "of the shipped table do not agree" in FULL.explain(certain)


@pytest.mark.parametrize("change", [{"cycles": 1}, {"timestep": 0.01}, {"gait": GAITS["spine_only"]}])
def test_another_question_is_not_compared_with_the_shipped_table(change):
    assert replace(FULL, samples=64, seed=3).comparable()
    assert not replace(FULL, **change).comparable()


def test_what_depends_on_the_design_is_said():
    rows = {"judged_tail_swing": 20, "judged_spine_swing": 20, "judged_com_fluctuation": 20, "judged_diagonal_gait": 0}
    shares = {"share_tail_swing": 0.5, "share_spine_swing": 0.9, "share_com_fluctuation": 0.1}
    counts = {"samples_walked": 20, "samples_outside_limits": 4, "samples_impossible": 0, "samples_came_apart": 0}
    words = FULL.explain(rows | shares | counts | {"compared_with_shipped": 0, "shipped_agreement_chance": np.nan})
    assert words == (
        "Of 24 designs 20 walk. Of the 3 claims 1 hold in at least nine of ten, 1 hold in one of ten at most and 1 "
        "depend on the design. These hold in at least nine of ten (spine swing: 18 of 20). These hold in one of ten at "
        "most (com fluctuation: 2 of 20). These depend on the design (tail swing: 10 of 20)."
    )


def test_one_picture_says_it(outcome):
    assert set(FULL.draw(outcome)) == {"sensitivity_shares"}


@pytest.mark.parametrize(
    ("field", "value", "words"),
    [
        ("samples", 500, ["power of two", "512"]),
        ("samples", 0, ["samples", "2 to"]),
        ("cycles", 0, ["cycles"]),
        ("timestep", 0.02, ["timestep"]),
    ],
)
def test_bad_numbers_are_refused_in_a_sentence(field, value, words):
    with pytest.raises(InvalidDesign) as caught:
        replace(FULL, **{field: value})
    assert all(word in str(caught.value) for word in words)
