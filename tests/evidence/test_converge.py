"""Convergence in the time step: measures of known order are found with their order and limit, exact ones are not."""

import json
from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import numpy as np
import pytest

from evidence import converge, store
from evidence.converge import (
    StepChange,
    Store,
    compare_experiment,
    design_outcome,
    experiment_outcome,
    main,
    run_divided,
)
from suchus.core.progress import silent
from suchus.experiments.catalog import EXPERIMENTS
from suchus.sim.land.step_division import divided_step

STEP = 0.004
"""Time step of the synthetic experiment [s]."""


@dataclass
class Synthetic:
    """An experiment whose measures are known functions of the time step, with 1 at a vanishing step."""

    divides: bool = True
    interrupt_at: float = 0.0
    steps: list = field(default_factory=list)

    def quick(self):
        """Return the same experiment."""
        return self

    def run(self, progress=silent):
        """Return the outcome at the present step."""
        step = divided_step(STEP) if self.divides else STEP
        if step == self.interrupt_at:
            raise KeyboardInterrupt
        self.steps.append(step)
        measures = {
            "linear": 1.0 + 20.0 * step,
            "quadratic": 1.0 + 5000.0 * step**2,
            "exact": 1.0 + step**2,
            "erratic": 1.0 + 0.5 * (-1.0) ** round(STEP / step / 2),
            "repeated": 1.0 + 20.0 * step,
            "repeated_low": 0.9,
            "repeated_high": 1.2,
            "cells": 12.0,
            "absent": np.nan,
        }
        word = "holds" if step > 0.6 * STEP else "does not hold"
        return SimpleNamespace(
            measures={name: SimpleNamespace(value=value, unit="m") for name, value in measures.items()},
            verdicts=[SimpleNamespace(claim=SimpleNamespace(key="claim"), verdict=word)],
        )


def outcome_of(experiment):
    """Return what is kept of an experiment at the three steps."""
    return experiment_outcome([run_divided(experiment, divisor) for divisor in converge.DIVISORS])


def test_each_run_has_the_divided_step():
    experiment = Synthetic()
    outcome_of(experiment)
    assert experiment.steps == [STEP, STEP / 2, STEP / 4]


def test_measures_that_move_are_found_with_order_and_limit_and_others_are_not():
    outcome = outcome_of(Synthetic())
    moved = outcome["moved"]
    assert set(moved) == {"linear", "quadratic", "erratic"}  # "repeated" stays within its own interval
    assert moved["linear"]["order"] == pytest.approx(1.0)
    assert moved["quadratic"]["order"] == pytest.approx(2.0)
    assert moved["linear"]["limit"] == pytest.approx(1.0)
    assert moved["quadratic"]["limit"] == pytest.approx(1.0)
    assert {name: row["trend"] for name, row in moved.items()} == {
        "linear": "converges", "quadratic": "converges", "erratic": "does not converge",
    }  # fmt: skip
    assert outcome["verdicts"] == {"claim": ["holds", "does not hold", "does not hold"]}


def test_a_measure_that_is_missing_at_a_smaller_step_is_found():
    parts = [run_divided(Synthetic(), divisor) for divisor in converge.DIVISORS]
    del parts[2].measures["exact"]
    assert "exact" in experiment_outcome(parts)["moved"]


def test_an_experiment_without_a_simulation_runs_once(tmp_path, monkeypatch):
    experiment = Synthetic(divides=False)
    monkeypatch.setattr(converge, "EXPERIMENTS", {"synthetic": experiment})
    assert compare_experiment("synthetic", "quick", Store(tmp_path, "code"))["simulations"] == 0
    assert experiment.steps == [STEP]


def test_finished_parts_are_taken_if_the_same_code_made_them(tmp_path):
    calls = []

    def compute():
        calls.append(1)
        return {"value": len(calls)}

    assert Store(tmp_path, "a").part("x/y", compute) == {"value": 1}
    assert Store(tmp_path, "a").part("x/y", compute) == {"value": 1}
    assert Store(tmp_path, "b").part("x/y", compute) == {"value": 2}
    (tmp_path / "x" / "y.json").write_text("{")
    assert Store(tmp_path, "b").part("x/y", compute) == {"value": 3}


def test_a_stopped_program_goes_on_where_it_stopped(tmp_path, monkeypatch, capsys):
    kept = []
    monkeypatch.setattr(converge, "PARTS", tmp_path)
    code = SimpleNamespace(reached=lambda modules: modules, digest=lambda modules: "code")  # in place of all sources
    monkeypatch.setattr(converge, "source", code)
    monkeypatch.setattr(converge, "_stored", lambda: {"quick": {}, "full": {}, "designs": {}})
    monkeypatch.setattr(converge, "_keep", lambda outcome, seconds: kept.append(json.loads(json.dumps(outcome))))
    stopped, resumed = Synthetic(interrupt_at=STEP / 4), Synthetic()
    for experiment, status in ((stopped, 130), (resumed, 0)):
        monkeypatch.setattr(converge, "EXPERIMENTS", {"synthetic": experiment})
        assert main(["synthetic"]) == status
    assert (stopped.steps, resumed.steps) == ([STEP, STEP / 2], [STEP / 4])
    assert [list(outcome["quick"]) for outcome in kept] == [["synthetic"]]
    assert "linear" in capsys.readouterr().out


def test_designs_have_quantiles_of_those_that_walk():
    reference = {"displacement_x": [1.0, -0.5, 0.01, np.nan], "cost_of_transport": [1.0, 2.0, 9.0, np.nan]}
    coarse = {"displacement_x": [1.2, -0.5, 0.05, np.nan], "cost_of_transport": [0.9, 2.0, 1.0, np.nan]}
    outcome = design_outcome({0.005: coarse, 0.001: reference})
    assert (outcome["samples"], outcome["walked"], outcome["measured"]) == (4, 3, 2)
    displacement, cost = outcome["rows"]
    assert (displacement["q100"], displacement["bias"]) == (pytest.approx(0.2), pytest.approx(0.1))
    assert (cost["q100"], cost["beyond"]) == (pytest.approx(0.1), 1)


@pytest.mark.parametrize(
    ("name", "unit", "values", "small"),
    [
        ("loss_knee", "-", (-0.9, -0.88, -0.879), True),  # 2 % of 1 + 0.1
        ("loss_knee", "-", (-0.9, -0.87, -0.87), False),
        ("loss_knee", "-", (0.0, 0.03, 0.03), True),  # 2 % of 1 + 1
        ("loss_knee", "-", (0.0, 0.05, 0.05), False),
        ("heading_open", "rad", (-0.002, 0.01, 0.01), True),
        ("heading_open", "rad", (-0.002, 0.03, 0.03), False),
        ("lean", "rad", (-0.002, 0.0, 0.001), False),  # no difference of headings
        ("gain_leg", "m", (0.0, 0.001, 0.001), False),  # metres, no relative change
        ("slip", "-", (0.0, 0.001, 0.001), False),
    ],
)
def test_a_difference_is_small_by_what_is_subtracted(name, unit, values, small):
    change = StepChange(values=values, tolerance=1e-3, reason="rounding")
    assert converge.is_small_difference(name, unit, change) == small


def test_the_greatest_change_includes_the_limit_and_is_infinite_without_a_number():
    values = {"first order": (1.4, 1.2, 1.1), "back and forth": (1.0, 1.5, 1.1), "none": (np.nan, 1.0, 1.0)}
    greatest = {
        name: StepChange(values=found, tolerance=0.01, reason="rounding").greatest for name, found in values.items()
    }
    assert greatest == pytest.approx({"first order": 0.4, "back and forth": 0.5, "none": np.inf})


@pytest.mark.parametrize(("change", "rounded"), [(0.0123, 0.013), (0.012, 0.012), (9.91, 10.0), (0.0, 0.0)])
def test_a_change_is_rounded_up(change, rounded):
    assert converge.rounded_up(change) == pytest.approx(rounded, rel=1e-12)


def test_what_changes_by_more_than_is_said_is_listed(tmp_path):
    outcomes = {
        "synthetic": outcome_of(Synthetic()),
        "still": outcome_of(Synthetic(divides=False)) | {"simulations": 0},
    }
    said = json.loads(converge.write_said(outcomes, tmp_path / "said.json").read_text())
    moved = outcomes["synthetic"]["moved"]
    assert list(said) == ["synthetic"]
    assert said["synthetic"]["changes"]["linear"] == 0.08
    assert converge.beyond_said("synthetic", moved, said) == []
    said["synthetic"]["changes"]["linear"] = 0.079
    assert converge.beyond_said("synthetic", moved, said) == ["linear"]
    assert converge.beyond_said("synthetic", moved, {}) == list(moved)
    assert "linear" not in _text(converge.table_of_measures(outcomes, converge.said_of(outcomes)))
    assert "linear" in _text(converge.table_of_measures(outcomes, said))


def _text(table):
    return "".join(str(cell) for column in table.columns for cell in column.cells)


def test_a_quick_form_takes_the_time_step_of_the_full_form():
    experiment = EXPERIMENTS["joint_faults"]
    assert experiment.quick().timestep > experiment.timestep
    assert converge.at_full_step(experiment) == replace(experiment.quick(), timestep=experiment.timestep)


def test_what_is_not_said_is_listed():
    outcomes = store.load("converge").values["quick"]
    assert {
        (name, measure)
        for name, outcome in outcomes.items()
        for measure in converge.beyond_said(name, outcome["moved"], converge.said())
    } == set(converge.UNSAID)


def test_outcomes_say_what_the_stored_result_holds():
    assert converge.said() == converge.said_of(store.load("converge").values["quick"])


def test_an_unknown_name_and_a_bad_number_are_refused(capsys):
    assert main(["nonesuch"]) == 2
    assert "nonesuch" in capsys.readouterr().err
    assert main(["designs", "--designs", "0"]) == 2
