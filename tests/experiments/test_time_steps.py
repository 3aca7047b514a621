"""What outcomes say of the time step: for which runs, on which pages, and of which verdicts."""

from dataclasses import replace
from math import inf

import pytest

from suchus.apps.cli import main
from suchus.apps.report.outcome_page import answer_rows, step_change
from suchus.article.paper import CLAIMS
from suchus.article.verdict import measure_with_interval
from suchus.core.files import read_json
from suchus.experiments import time_steps
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.claims import RULES
from suchus.experiments.experiment import Measure
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS

SPEED = EXPERIMENTS["speed_range"]


def test_every_compared_experiment_and_measure_exists(quick_outcome):
    assert set(time_steps.COMPARED) <= set(EXPERIMENTS)
    for name in ("speed_range", "salamander"):
        assert set(time_steps.COMPARED[name].changes) <= set(quick_outcome(name).measures)


@pytest.mark.parametrize(
    ("question", "differs"),
    [
        (SPEED, ""),
        (SPEED.quick(), ""),
        (SPEED.for_verdicts(), ""),
        (replace(SPEED, timestep=0.001), ""),
        (replace(SPEED, timestep=0.01), "a time step of 10 ms"),
        (replace(SPEED, robot=replace(ROBOTS["caiman"], name="mine")), "another robot"),
        (EXPERIMENTS["displacement"], ""),
        (replace(EXPERIMENTS["displacement"], gait=GAITS["low_crawl"]), "another gait"),
        (EXPERIMENTS["joint_faults"].quick(), "a time step of 10 ms"),
        (EXPERIMENTS["leg_kinematics"], ""),
    ],
)
def test_the_changes_are_known_for_robot_gait_and_time_step_of_the_catalog(question, differs):
    assert time_steps.difference(question).startswith(differs)
    assert bool(time_steps.difference(question)) == bool(differs)
    known = not differs and question.name() in time_steps.COMPARED
    assert (time_steps.comparison_of(question) is not None) == known
    said = time_steps.sentence(question)
    assert ("not known" in said) == bool(differs)
    assert bool(said) == (question.name() in time_steps.COMPARED)


def test_a_change_is_written_with_its_unit():
    assert step_change(Measure(1.0, "m")) == ""
    assert step_change(Measure(1.0, "m", 0.0123)) == "±0.012 m"
    assert step_change(Measure(1.0, "m", inf)) == "no number at some"
    assert answer_rows(("a",), {"a": Measure(1.0, "m", 0.02)}) == [("a", "1 m", "", "±0.02 m")]


def test_page_and_outcome_say_the_change(tmp_path, capsys, monkeypatch):
    name, measure = "leg_kinematics", next(iter(EXPERIMENTS["leg_kinematics"].quick().run().measures))
    compared = time_steps.StepComparison(measures=17, timestep=None, changes={measure: 0.0123})
    monkeypatch.setattr(time_steps, "COMPARED", {name: compared})
    assert main(["run", name, "--quick", "--out", str(tmp_path)]) == 0
    capsys.readouterr()
    outcome = read_json(tmp_path / name / "outcome.json")
    assert [key for key, entry in outcome["measures"].items() if "time_step" in entry] == [measure]
    assert outcome["measures"][measure]["time_step"] == 0.0123
    page = (tmp_path / name / "index.html").read_text(encoding="utf-8")
    assert page.count("time step: ±0.012") == 1
    assert "found in short runs" in page
    monkeypatch.setattr(time_steps, "COMPARED", {})
    assert main(["run", name, "--quick", "--out", str(tmp_path)]) == 0
    page = (tmp_path / name / "index.html").read_text(encoding="utf-8")
    assert "time step: ±" not in page
    assert "found in short runs" not in page


@pytest.mark.parametrize(
    ("change", "said"),
    [(0.0, ""), (0.02, ""), (inf, ""), (0.03, "“contradicted” within 0.03 of `diagonal_phase_error`")],
)
def test_a_verdict_whose_margin_is_smaller_than_the_change_is_flagged(change, said):
    rule, measures = _rule_with_margin()
    text = time_steps.caution(rule, measures, {rule.measure: change}, CLAIMS)
    assert text == (f"Smaller time steps may give the word {said}." if said else "")


def _rule_with_margin():
    """Return a rule and measures by which it holds, 0.025 before its bound."""
    rule = RULES["diagonal_gait"]
    others = dict.fromkeys(rule.needs.union(rule.named_in_reason), 0.5)
    return rule, others | measure_with_interval(rule.measure, 0.1, 0.1)
