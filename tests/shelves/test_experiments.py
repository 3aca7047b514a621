"""What holds for every experiment on the shelf."""

import inspect
import json
import os
import re
import sys
from dataclasses import fields, replace
from math import isfinite
from pathlib import Path

import numpy as np
import pytest

from evidence import store, tolerance
from suchus.article.verdict import judge
from suchus.core.sources import current
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.claims import known_claims
from suchus.experiments.experiment import Measures
from suchus.visual.figures import caption
from suchus.visual.figures.data import field_of, table
from suchus.visual.figures.uncover import covering

GOLDEN = Path(__file__).parent.parent / "golden"


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


def test_its_rules_say_what_they_measure_in_the_unit_of_the_measure(quick):
    _, outcome = quick
    for verdict in outcome.verdicts:
        rule = verdict.rule
        assert len(rule.definition.split()) >= 3, rule.claim
        assert rule.definition[-1] not in ".]", rule.claim
        if rule.measure in outcome.measures:
            assert (rule.unit or verdict.claim.unit) == outcome.measures[rule.measure].unit, rule.claim


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


@pytest.mark.parametrize("name", [*store.names()])
def test_a_number_that_is_kept_lies_in_its_own_interval(name):
    kept = store.load(name).values
    if isinstance(kept, dict):
        assert outside({name: value for name, value in kept.items() if isinstance(value, float)}) == []


def outside(measures):
    """Return the numbers that lie outside of the interval that is published with them."""
    found = []
    for name, value in measures.items():
        low, high = measures.get(f"{name}_low"), measures.get(f"{name}_high")
        if low is None or high is None or np.isnan([low, high]).all():
            continue  # an interval that is unknown holds nothing
        if isfinite(value) and not low - 1e-12 <= value <= high + 1e-12:
            found.append(f"{name}: {value} is not from {low} to {high}")
    return found


def test_a_number_outside_its_interval_is_found():
    assert outside({"x": 2.0, "x_low": 1.0, "x_high": 3.0, "y_low": 4.0}) == []
    assert len(outside({"x": 0.9, "x_low": 1.0, "x_high": 3.0})) == 1
    assert outside({"x": 0.9, "x_low": np.nan, "x_high": np.nan}) == []
    assert len(outside({"x": 0.9, "x_low": 0.5, "x_high": np.nan})) == 1


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
    claims = known_claims(experiment.name())
    for rule in experiment.rules():
        verdict = judge(rule, measures, claims=claims)  # each measure that the rule and its sentence name is there
        assert verdict.claim == claims[rule.claim]
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


_VERTICAL_BENDS = ("commanded_spine_vertical", "commanded_tail_vertical")


def test_its_signs_are_said_as_they_are(quick):
    """A bend to the right and one down are positive in the article's signs."""
    _, outcome = quick
    for name in _VERTICAL_BENDS:
        if name in outcome.record:
            assert outcome.record[name].attrs["long_name"].endswith("down positive")


_DIMENSIONLESS_UNIT = "1"
_QUANTITIES_WITH_A_UNIT = re.compile(r"(^|_)(force|pressure|thrust|torque|speed|power|difference|load)$")


def test_a_force_a_pressure_or_a_speed_has_no_unit_of_a_ratio(quick):
    _, outcome = quick
    units = {str(name): values.attrs.get("units") for name, values in outcome.record.data_vars.items()}
    ratios = [name for name, unit in units.items() if unit == _DIMENSIONLESS_UNIT]
    assert [name for name in ratios if _QUANTITIES_WITH_A_UNIT.search(name)] == []


@pytest.fixture(scope="module")
def drawn(quick):
    experiment, outcome = quick
    return experiment.draw(outcome)


def test_its_figures_have_captions(drawn):
    assert drawn
    for name, figure in drawn.items():
        assert name.isidentifier()
        assert len(caption(figure)) > 20, name


def test_the_tables_of_its_figures_name_each_line(drawn):
    """A line is named by its label, by ``_label`` where no legend shows it, or by the only quantity of its panel."""
    series = {(name, row.split(",")[1]) for name, figure in drawn.items() for row in table(figure).splitlines()}
    assert [pair for pair in series if re.fullmatch(r"line \d+", pair[1])] == []


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


def test_its_numbers_mean_what_they_meant(quick):
    """Golden numbers: a change here is a change of behaviour. Renew with SUCHUS_GOLDEN=write after thinking."""
    experiment, outcome = quick
    file = golden(experiment.name())
    measured = {name: float(measure.value) for name, measure in sorted(outcome.measures.items())}
    if os.environ.get("SUCHUS_GOLDEN") == "write" or not (file.exists() or file.parent == GOLDEN):
        file.parent.mkdir(exist_ok=True)
        file.write_text(golden_text(measured), encoding="utf-8")
    expected = tolerance.read(json.loads(file.read_text(encoding="utf-8")))
    assert sorted(expected) == sorted(measured)
    assert tolerance.moved(expected, measured) == {}


def golden_text(measured):
    """Return numbers as a golden file: each with the range within which it means the same, and why."""
    entries = {name: entry.plain() for name, entry in tolerance.bounded(measured).items()}
    lines = [f"{json.dumps(name)}: {json.dumps(entry)}" for name, entry in entries.items()]
    return "{\n" + ",\n".join(lines) + "\n}\n"


@pytest.mark.parametrize("file", sorted(GOLDEN.glob("*.json")), ids=lambda file: file.stem)
def test_each_golden_number_has_its_range_and_a_reason(file):
    entries = json.loads(file.read_text(encoding="utf-8"))
    for name, entry in tolerance.read(entries).items():
        assert entry.holds(entry.value), name
        assert entry.reason in tolerance.REASONS or entry.reason.count(" ") > 4, name
    assert file.stem in EXPERIMENTS
