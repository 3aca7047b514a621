"""What holds for every experiment on the shelf."""

import inspect
import json
import math
import os
import re
import sys
from dataclasses import fields, replace
from math import isfinite
from pathlib import Path

import numpy as np
import pytest

from suchus import machine
from suchus.experiment import Measures
from suchus.experiments import EXPERIMENTS
from suchus.figures import caption
from suchus.figures.data import field_of
from suchus.figures.uncover import covering
from suchus.paper import CLAIMS
from suchus.sources import current
from suchus.verdict import judge

GOLDEN = Path(__file__).parent.parent / "golden"
MADE_WITH = GOLDEN / "made_with.json"
"""By experiment the arithmetic of the machine that wrote its golden numbers."""
ARITHMETIC = " ".join(machine.arithmetic().values())
STATED = Path(__file__).parent.parent / "docs" / "stated"


def golden(name):
    """Return the file of an experiment's numbers of last time; those of the user's stand in the project."""
    told, project = os.environ.get("SUCHUS_GOLDEN", ""), current()
    if (GOLDEN / f"{name}.json").exists() or told == "write":
        return GOLDEN / f"{name}.json"
    return (project.folder / "golden" if project else Path(told or GOLDEN)) / f"{name}.json"


@pytest.fixture(scope="module", params=list(EXPERIMENTS))
def quick(request, quick_outcome):
    return EXPERIMENTS[request.param].quick(), quick_outcome(request.param)


def test_it_says_what_it_asks_and_what_decides(quick):
    experiment, outcome = quick
    assert experiment.title.endswith("?")
    assert experiment.shows
    assert len(outcome.decides) > 60
    assert all(field.name for field in fields(experiment))


def test_its_measures_are_numbers_with_units(quick):
    experiment, outcome = quick
    assert outcome.experiment == experiment.name()
    assert outcome.measures
    for name, measure in outcome.measures.items():
        assert name.isidentifier(), name
        assert isinstance(measure.value, (int, float)), name
        assert measure.unit, name


def test_no_measure_overwrites_another(quick):
    """``Measures`` refuse a second number of a name; mypy holds whoever says that it returns them to it."""
    experiment, outcome = quick
    if not type(experiment).__module__.startswith("suchus."):
        return  # others may return any mapping
    assert isinstance(outcome.measures, Measures)
    for file in Path(inspect.getfile(type(experiment))).parent.glob("*.py"):
        assert not re.findall(r"-> (?:dict|Mapping)\[str, Measure\]", file.read_text(encoding="utf-8")), file


def test_a_published_number_lies_in_its_own_interval(quick):
    _, outcome = quick
    assert outside({name: measure.value for name, measure in outcome.measures.items()}) == []


@pytest.mark.parametrize("file", [*sorted(GOLDEN.glob("*.json")), *sorted(STATED.glob("*.json"))], ids=lambda f: f.stem)
def test_a_number_that_is_kept_lies_in_its_own_interval(file):
    kept = json.loads(file.read_text(encoding="utf-8"))
    if isinstance(kept, dict):
        assert outside({name: value for name, value in kept.items() if isinstance(value, float)}) == []


def outside(measures):
    """Return the numbers that lie outside of the interval that is published with them."""
    found = []
    for name, value in measures.items():
        low, high = measures.get(f"{name}_low"), measures.get(f"{name}_high")
        if low is not None and high is not None and isfinite(value) and not low - 1e-12 <= value <= high + 1e-12:
            found.append(f"{name}: {value} is not from {low} to {high}")
    return found


def test_a_number_outside_its_interval_is_found():
    assert outside({"x": 2.0, "x_low": 1.0, "x_high": 3.0, "y_low": 4.0}) == []
    assert len(outside({"x": 0.9, "x_low": 1.0, "x_high": 3.0})) == 1


def test_a_rule_decides_by_the_intervals_that_there_are(quick):
    experiment, outcome = quick
    for rule in experiment.rules():
        read = {rule.measure, *(clause.measure for clause in rule.holds), *(str(one.bound) for one in rule.holds)}
        ranged = {name for name in read if {f"{name}_low", f"{name}_high"} <= outcome.measures.keys()}
        assert ranged <= set(rule.spread), rule.claim
        bases = {name.removesuffix("_low").removesuffix("_high") for name in read} - read
        assert not [base for base in bases if {f"{base}_low", f"{base}_high"} <= outcome.measures.keys()], rule.claim


def test_every_claim_can_be_judged_by_its_measures_and_a_run_cut_short_is_not(quick):
    experiment, outcome = quick
    measures = {name: float(measure.value) for name, measure in outcome.measures.items()}
    for rule in experiment.rules():
        verdict = judge(rule, measures)  # each measure that the rule and its sentence name is there
        assert verdict.claim == CLAIMS[rule.claim]
        assert len(verdict.why) > 10
        assert verdict.measured is None or isfinite(verdict.measured)
    if experiment == type(experiment)():
        assert [verdict.rule for verdict in outcome.verdicts] == list(experiment.rules())
        assert outcome.unjudged == ""
    elif experiment.rules():
        assert outcome.verdicts == ()
        assert outcome.unjudged.startswith("Not judged: ")


@pytest.mark.parametrize("name", [name for name, one in EXPERIMENTS.items() if hasattr(one, "robot") and one.claims])
def test_another_robot_is_not_judged_by_the_articles_metres(name):
    other = replace(EXPERIMENTS[name], robot=replace(EXPERIMENTS[name].robot, name="another"))
    assert other.unjudged().startswith("Not judged: ")
    assert EXPERIMENTS[name].unjudged() == ""


def test_every_variable_of_its_record_has_a_unit(quick):
    _, outcome = quick
    assert outcome.record.data_vars
    missing = [name for name, values in outcome.record.data_vars.items() if "units" not in values.attrs]
    assert missing == []


@pytest.fixture(scope="module")
def drawn(quick):
    experiment, outcome = quick
    return experiment.draw(outcome)


def test_its_figures_have_captions(drawn):
    assert drawn
    for name, figure in drawn.items():
        assert name.isidentifier()
        assert len(caption(figure)) > 20, name


def test_no_legend_covers_data_and_no_colour_bar_ends_below_the_greatest_value(drawn):
    for name, figure in drawn.items():
        if any(ax.get_legend() for ax in figure.axes):
            figure.get_layout_engine().execute(figure)
            assert [ax.get_title("left") for ax, _ in covering(figure)] == [], name
        assert all(getattr(legend, "_outside_loc", None) for legend in figure.legends), name
        coloured = (one for ax in figure.axes for one in (*ax.collections, *ax.images) if one.colorbar)
        for one in coloured:
            values, bar = field_of(one), one.colorbar
            if not np.isfinite(values).any():
                assert one.axes.texts, f"{name}: an empty map does not say why"
                continue
            rounding = 1e-9 * (bar.vmax - bar.vmin)
            assert bar.vmax >= np.nanmax(values) - rounding or bar.extend in ("max", "both"), name
            assert bar.vmin <= np.nanmin(values) + rounding or bar.extend in ("min", "both"), name


def some_page(name):
    """Return a case for an experiment: the pages of a few of suchus's own stand for the others in ``make test``."""
    others = EXPERIMENTS.sources()[name].shipped and name not in ("displacement", "floating", "swim_free")
    return pytest.param(name, marks=pytest.mark.slow("a page with its skin and picture") if others else ())


@pytest.mark.parametrize("quick", [some_page(name) for name in EXPERIMENTS], indirect=True)
def test_what_walked_can_be_seen_as_a_page_that_can_be_mailed(quick):
    experiment, outcome = quick
    if hasattr(sys.modules[type(experiment).__module__], "replayed"):  # it makes such pages
        assert outcome.replays
    for name, replay in outcome.replays.items():
        page = replay.html
        assert name.endswith("_replay.html")
        assert replay.caption in page
        assert "<canvas" in page
        assert len(page.encode()) < 5_000_000


@pytest.mark.slow("a second run of each quick form")
def test_it_answers_the_same_twice_to_the_byte(quick):
    _runs_the_same_again(*quick)


def _runs_the_same_again(experiment, outcome):
    again = experiment.run()
    assert _exact(again) == _exact(outcome)
    assert again.record.identical(outcome.record)


def _exact(outcome) -> dict[str, str]:
    return {name: repr(measure.value) for name, measure in outcome.measures.items()}


def test_its_numbers_are_those_of_last_time(quick, request):
    """Golden numbers: a change here is a change of behaviour. Renew with SUCHUS_GOLDEN=write after thinking."""
    experiment, outcome = quick
    file = golden(experiment.name())
    found = {name: measure.value for name, measure in sorted(outcome.measures.items())}
    if os.environ.get("SUCHUS_GOLDEN") == "write" or not (file.exists() or file.parent == GOLDEN):
        file.parent.mkdir(exist_ok=True)
        file.write_text(json.dumps(found, indent=1) + "\n")
        if file.parent == GOLDEN:
            told = (json.loads(MADE_WITH.read_text()) if MADE_WITH.exists() else {}) | {experiment.name(): ARITHMETIC}
            MADE_WITH.write_text(json.dumps(dict(sorted(told.items())), indent=1) + "\n")
    expected = json.loads(file.read_text())
    assert sorted(expected) == sorted(found)
    made_with = json.loads(MADE_WITH.read_text()).get(experiment.name()) if MADE_WITH.exists() else None
    assert other(expected, found, same_bytes=made_with == ARITHMETIC) == {}


def other(expected, found, *, same_bytes):
    """Return the numbers that are others than they were, with both: as allowed in the size of each.

    A machine that computes the same last bits has the same bytes, and is allowed a millionth. Another rounds
    differently, which contacts amplify: it is allowed two hundredths, the width of the number's own interval where it
    has one, or a fifth of a number that is as small as the last digit that was ever looked at.
    """
    names = {}
    for name, was in expected.items():
        ends = [expected.get(f"{name}{end}") for end in ("_low", "_high")]
        width = ends[1] - ends[0] if None not in ends else 0.0
        size = abs(was) * 1e-6 if same_bytes else max(0.02 * abs(was), width, min(2e-3, 0.2 * abs(was)), 1e-9)
        is_now = found[name]
        if not (abs(is_now - was) <= size or (math.isnan(was) and math.isnan(is_now)) or is_now == was):
            names[name] = (was, is_now)
    return names


def test_a_kept_number_notices_a_change_of_its_own_size():
    was = {"rise": 1e-3, "share": 0.9, "share_low": 0.8, "share_high": 1.0, "none": math.nan, "zero": 0.0}
    assert other(was, was, same_bytes=True) == other(was, was, same_bytes=False) == {}
    for name, moved, noticed in (
        ("rise", 1e-3 + 1e-10, (False, False)),
        ("rise", 1e-3 + 2e-9, (True, False)),
        ("rise", 1.3e-3, (True, True)),
        ("rise", -1e-3, (True, True)),  # a millimetre down instead of up, which two millimetres would have allowed
        ("share", 0.95, (True, False)),
        ("share", 0.65, (True, True)),
        ("zero", 1e-12, (True, False)),
        ("none", 0.0, (True, True)),
    ):
        now = was | {name: moved}
        assert tuple(name in other(was, now, same_bytes=same) for same in (True, False)) == noticed, (name, moved)
