"""What the terminal says after a run: the answer, and the numbers that carry it."""

import json
import math
from pathlib import Path

import numpy as np
import pytest

from suchus.apps.cli.entry import main
from suchus.apps.cli.run import SavedRun, show_outcome
from suchus.apps.report import answer, answer_rows, quantity
from suchus.apps.report.outcome_page import MAX_ANSWER_MEASURES
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.experiment import Measure, estimated


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_the_numbers_that_carry_the_answer_are_measured(name, quick_outcome):
    """Three to six of them; where the quick form measures less, at least one."""
    question = EXPERIMENTS[name]
    assert len(question.answers) >= 2
    assert len(set(question.answers)) == len(question.answers)
    measures = quick_outcome(name).measures
    rows = answer_rows(question.answers, measures)
    assert rows
    assert len([answer for answer in question.answers if answer in measures]) <= MAX_ANSWER_MEASURES
    said = rows[0][0].replace("centre of mass", "com").replace("peak to peak", "pp")
    assert said.replace(" ", "_") in question.answers


def test_of_too_few_repeats_no_interval_is_shown():
    for repeats, shown in (([0.4], ""), ([0.4] * 4 + [0.5], ""), ([0.4] * 5 + [0.5], "0.4 to 0.5 m")):
        row = answer_rows(("forward",), estimated("forward", np.array(repeats), "m"))
        assert row == [("forward", "0.4 m", shown, "")]


def test_an_interval_stands_beside_its_number_and_what_is_not_finite_is_left_out():
    question = EXPERIMENTS["displacement"]
    measures = {
        "forward_coordinated": Measure(0.7, "m"),
        "forward_coordinated_low": Measure(0.6, "m"),
        "forward_coordinated_high": Measure(0.75, "m"),
        "forward_ratio": Measure(math.nan, "-"),
        "gain_spine_swing": Measure(0.2, "m"),
    }
    assert answer_rows(question.answers, measures) == [
        ("forward coordinated", "0.7 m", "0.6 to 0.75 m", ""),
        ("gain spine swing", "0.2 m", "", ""),
    ]


def test_six_numbers_carry_an_answer_at_most_the_first_that_a_run_has():
    """The speed in real water goes before that in a solved flow."""
    answers = EXPERIMENTS["swim_free"].answers
    measures = {name: Measure(1.0, "m/s") for name in answers}
    in_space = [row[0] for row in answer_rows(answers, {k: v for k, v in measures.items() if k != "speed_slice"})]
    assert in_space[:3] == ["speed real water", "speed space", "speed whole"]
    assert len(in_space) == MAX_ANSWER_MEASURES < len(answers)


def test_what_is_short_in_names_is_written_out():
    measures = {name: Measure(1.0, "-") for name in ("com_height_pp", "late_p99", "compared")}
    assert [row[0] for row in answer_rows((), measures)] == [
        "centre of mass height peak to peak",
        "late 99th percentile",
        "compared",
    ]


def test_an_experiment_that_names_no_numbers_shows_its_first_ones():
    measures = {f"number_{i}": Measure(float(i), "-") for i in range(9)} | {"number_0_low": Measure(-1.0, "-")}
    found = answer_rows((), measures)
    assert [row[0] for row in found] == [f"number {i}" for i in range(6)]


def test_the_answer_is_two_sentences_whatever_numbers_stand_in_them():
    text = "It walks 0.7 m, by eq. (20) and Fig. 3 too. The tail adds 0.1 m. More follows."
    assert answer(text) == "It walks 0.7 m, by eq. (20) and Fig. 3 too. The tail adds 0.1 m."
    assert answer("One.") == "One."
    assert answer("") == ""


def test_a_run_says_its_answer_and_for_programs_its_outcome(tmp_path, capsys):
    assert main(["run", "leg_kinematics", "--quick", "--out", str(tmp_path)]) == 0
    said = " ".join(capsys.readouterr().out.split())
    outcome = json.loads((tmp_path / "leg_kinematics" / "outcome.json").read_text())
    assert answer(outcome["decides"]) in said
    assert "round trip error" in said
    assert main(["run", "leg_kinematics", "--quick", "--json", "--out", str(tmp_path)]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["measures"] == outcome["measures"]
    assert told["decides"] == outcome["decides"]


def test_statements_show_what_was_measured_as_printed_numbers_do(quick_outcome, capsys):
    outcome = quick_outcome("gait_diagram")
    show_outcome(EXPERIMENTS["gait_diagram"], SavedRun(outcome=outcome, folder=Path("out"), seconds=1.0))
    said = capsys.readouterr().out
    statements = [one for one in outcome.verdicts if one.claim.value is None and one.measured is not None]
    assert statements
    for one in statements:
        assert quantity(one.measured, outcome.measures[one.rule.measure].unit, 3) in said
