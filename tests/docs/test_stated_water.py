"""What the page on water and land states is what the experiments measured."""

import json
import os
from pathlib import Path

import pytest

from pages.stated import filled, passages
from pages.stated_water import MADE, PASSAGES
from suchus.experiments import EXPERIMENTS

HERE = Path(__file__).parent
STATED = {name: HERE / "stated" / f"{name}.json" for name in PASSAGES}
PAGE = HERE.parents[1] / "docs" / "amphibious.md"


def _page(measures):
    """Return the page with the passages of each experiment filled by its own measures."""
    page = PAGE.read_text(encoding="utf-8")
    by_experiment = {name: json.loads(file.read_text("utf-8")) for name, file in STATED.items()}
    made = {
        passage: (lambda _, make=make, name=name: make(by_experiment[name] | measures.get(name, {})))
        for name, some in PASSAGES.items()
        for passage, make in some.items()
    }
    return filled(page, {}, made)


def test_the_page_on_water_states_what_was_measured():
    """Renew with SUCHUS_GOLDEN=write, after the measures themselves."""
    assert sorted(passages(PAGE.read_text(encoding="utf-8"))) == sorted(MADE)
    if os.environ.get("SUCHUS_GOLDEN") == "write":
        PAGE.write_text(_page({}), encoding="utf-8")
    assert _page({}) == PAGE.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("experiment", "measure"),
    [("floating", "draft_error"), ("floating", "share_above"), ("swim_free", "speed_tail_only"), ("swim_free", "slip")],
)
def test_another_number_makes_another_page_on_water(experiment, measure):
    value = json.loads(STATED[experiment].read_text("utf-8"))[measure]
    assert _page({experiment: {measure: value + 0.3}}) != PAGE.read_text(encoding="utf-8")


@pytest.mark.validate
@pytest.mark.parametrize("name", list(PASSAGES))
def test_a_new_run_in_water_measures_what_is_kept(name):
    """Renew with SUCHUS_GOLDEN=write."""
    found = {key: measure.value for key, measure in sorted(EXPERIMENTS[name].run().measures.items())}
    if os.environ.get("SUCHUS_GOLDEN") == "write":
        STATED[name].write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    assert found == pytest.approx(json.loads(STATED[name].read_text("utf-8")), rel=0.02, abs=2e-3, nan_ok=True)
