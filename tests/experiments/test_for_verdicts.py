"""The forms that `suchus reproduce` runs: judged as the full ones are, and complete without what they leave out."""

from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from suchus.article.verdict import judge
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.feedback.experiment import _TOLD_LAWS, DISTURBANCES
from suchus.visual.figures import styled

NAMES = [name for name in EXPERIMENTS if EXPERIMENTS[name].for_verdicts() != EXPERIMENTS[name]]


def told_walks(record: xr.Dataset) -> xr.Dataset:
    """Return the record without the disturbances, single rules and laws of which no verdict tells."""
    short = EXPERIMENTS["feedback"].for_verdicts()
    cells = [[n in short.disturbances and short._has_cell(n, a) for a in record.arm.values] for n in DISTURBANCES]
    is_told = {
        "disturbance": xr.DataArray(cells, coords={"disturbance": [*DISTURBANCES], "arm": record.arm}),
        "law": record.law.isin(_TOLD_LAWS),
    }
    kept = {
        name: record[name].where(mask)
        for dim, mask in is_told.items()
        for name in record.data_vars
        if dim in record[name].dims
    }
    return record.assign(kept)


def needed_swims(record: xr.Dataset) -> xr.Dataset:
    printed = [name for name in record.variables if str(name).startswith("printed_") and name != "printed_model_speed"]
    kept = record.drop_vars([*printed, "towed_drag"])
    speeds = kept.ladder_speed.where(kept.ladder_motion == "trunk and tail")
    is_theory = kept.rung.isin(["resistive", "reactive", "sections"])
    return kept.isel(arm=[0], reading=[]).assign(ladder_speed=kept.ladder_speed.where(is_theory, speeds))


def judged_swims(record: xr.Dataset) -> xr.Dataset:
    """Return the record without stiffer joints, the reversed wave, half the time step and swims below the surface."""
    is_judged = [not str(label).endswith("_stiff") and label != "reversed" for label in record.label.values]
    return record.isel(run=is_judged).drop_vars("fine_centre_of_mass").drop_dims(["dive", "dive_time"])


def told_stands(record: xr.Dataset) -> xr.Dataset:
    """Return the record without pushes, robots without feedback, the map and the greatest reach of any posture."""
    return record.sel(feedback=["on"]).drop_dims(["direction", "torque", "forebody", "behind"])


def without_costs(record: xr.Dataset) -> xr.Dataset:
    """Return the record without what the servos' work costs."""
    return record.drop_vars(["repeated_cost_of_transport", "repeated_electrical_cost_of_transport"])


def walked_faults(record: xr.Dataset) -> xr.Dataset:
    """Return the record without knees, steering and places of locking."""
    return record.isel(joint=slice(0, 4)).drop_vars(["steered_forward", "steered_turn"]).drop_dims("hold")


def judged_walks(record: xr.Dataset) -> xr.Dataset:
    """Return the record with a range of cycle times and servos of the high walk alone."""
    is_usual = (record.slower == 1.0) & (record.servo_model == "own")
    return record.where((record.gait == "high_walk") | is_usual)


SHORTENED: Mapping[str, Callable[[xr.Dataset], xr.Dataset]] = {
    "bipedal_reach": told_stands,
    "displacement": without_costs,
    "feedback": told_walks,
    "joint_faults": walked_faults,
    "pattern_generator": lambda record: record.drop_dims(["ramp_time", "shore_time"]),
    "salamander": lambda record: record.isel(run=slice(2)),
    "salamander_swim": lambda record: record.drop_dims("animal"),
    "speed_range": judged_walks,
    "swim_free": judged_swims,
    "swimming": needed_swims,
    "terrain": lambda record: record.drop_sel(arm="switching").drop_vars("shown_height"),
}
"""What is left of a quick form's record, by experiment."""


@pytest.mark.parametrize("name", NAMES)
def test_a_form_for_verdicts_answers_and_is_judged(name):
    short = EXPERIMENTS[name].for_verdicts()
    assert (short.unjudged(), short.too_short()) == ("", "")
    assert short.claims == EXPERIMENTS[name].claims
    assert short.for_verdicts() == short


@pytest.mark.parametrize("name", SHORTENED)
def test_what_is_left_out_changes_no_verdict_and_is_missed_nowhere(name, quick_outcome):
    outcome, short = quick_outcome(name), EXPERIMENTS[name].quick().for_verdicts()
    record = SHORTENED[name](outcome.record)
    measures = short.measure(record)
    numbers, full = ({key: m.value for key, m in group.items()} for group in (measures, outcome.measures))
    assert sum(np.isfinite([*numbers.values()])) < sum(np.isfinite([*full.values()]))
    for rule in short.rules():
        judged, fully_judged = (judge(rule, given, unable=short.unable(record)) for given in (numbers, full))
        assert judged.verdict == fully_judged.verdict
        assert rule.rungs or judged.why == fully_judged.why
    assert "nan" not in short.explain(numbers).split()
    with styled():
        assert short.draw(replace(outcome, record=record, measures=measures))


def test_maps_keep_their_ends():
    whole = EXPERIMENTS["displacement"]
    short = whole.for_verdicts()
    for name in ("strokes", "bends", "pitches", "phases"):
        values = getattr(short, name)
        assert {values[0], values[-1]} == {getattr(whole, name)[0], getattr(whole, name)[-1]}
        assert set(values) <= {*getattr(whole, name)}
        assert len(values) == 3
