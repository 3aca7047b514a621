"""What a page states of an experiment is what the experiment measured."""

import json
import os
from pathlib import Path

import pytest
from pages.stated import PASSAGES, filled, passages

from suchus.experiments import EXPERIMENTS

HERE = Path(__file__).parent
STATED = HERE / "stated" / "joint_faults.json"
PAGE = HERE.parents[1] / "docs" / "faults.md"


def test_the_page_states_what_was_measured():
    """Renew with SUCHUS_GOLDEN=write, after the measures themselves."""
    page, measures = PAGE.read_text(encoding="utf-8"), json.loads(STATED.read_text(encoding="utf-8"))
    assert sorted(passages(page)) == sorted(PASSAGES)
    if os.environ.get("SUCHUS_GOLDEN") == "write":
        PAGE.write_text(filled(page, measures), encoding="utf-8")
    assert filled(page, measures) == PAGE.read_text(encoding="utf-8")


def test_another_number_makes_another_page():
    page, measures = PAGE.read_text(encoding="utf-8"), json.loads(STATED.read_text(encoding="utf-8"))
    for name in (
        "loss_hind_knee_limp_one_coordinated",
        "loss_intact_limbs_only",
        "turn_front_yaw_limp_one_steered",
        "chance_spine_and_tail_bear_better",
        "com_rise_limp",
    ):
        assert filled(page, measures | {name: measures[name] + 0.3}) != page, name


@pytest.mark.validate
def test_a_new_run_measures_what_is_kept():
    """Renew with SUCHUS_GOLDEN=write."""
    found = {name: measure.value for name, measure in sorted(EXPERIMENTS["joint_faults"].run().measures.items())}
    if os.environ.get("SUCHUS_GOLDEN") == "write":
        STATED.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    assert found == pytest.approx(json.loads(STATED.read_text(encoding="utf-8")), rel=0.02, abs=0.01)
