"""A quick form answers with numbers of the full form, or says that it is too short to answer and what would do."""

import json
import re
from dataclasses import replace

import pytest
from tests.bodies import hatchling

from evidence import store
from suchus.apps.cli.entry import main
from suchus.experiments.catalog import EXPERIMENTS

RELATIVE = 0.02
"""Relative difference from the full form that a measure without an interval may have [-]."""
SMALL = 1e-9
"""Absolute difference that is rounding [SI unit]."""
SEEDS = (0, 1, 2)
SHORT = [name for name, question in EXPERIMENTS.items() if question.quick().too_short()]
ANSWERING = [name for name in EXPERIMENTS if name not in SHORT]


def misses(names, quick, full):
    """Return the names of those measures of a quick form that do not hold the value of the full form."""
    found = []
    for name in names:
        value = quick.get(name, float("nan"))
        low, high = quick.get(f"{name}_low", float("nan")), quick.get(f"{name}_high", float("nan"))
        if name not in full or value != value or full[name] != full[name]:
            continue
        is_held = low - SMALL <= full[name] <= high + SMALL if low < high else False
        if not is_held and abs(value - full[name]) > max(RELATIVE * abs(full[name]), SMALL):
            found.append(name)
    return found


def full_measures(name):
    """Return the measures of the full form: those that are kept, or those of a run where none are."""
    if name in store.names():
        return store.load(name).values
    return {key: float(measure.value) for key, measure in EXPERIMENTS[name].run().measures.items()}


@pytest.mark.parametrize("name", SHORT)
def test_a_form_that_is_too_short_says_so_and_what_would_do(name):
    sentence = EXPERIMENTS[name].quick().too_short()
    assert re.match(
        r"Too short to answer: \w+ (is|has) [\d.e+]+( values| s)?, and [\d.e+]+( s)? at least are needed\. ", sentence
    )
    assert f"`suchus run {name}`" in sentence
    assert EXPERIMENTS[name].too_short() == ""


def test_most_short_forms_are_named():
    assert {"swim_free", "shore", "swimming", "salamander_swim", "death_roll", "displacement"} <= {*SHORT}
    assert {"salamander", "leg_kinematics", "spine_kinematics", "gait_diagram"} <= {*ANSWERING}


@pytest.mark.parametrize("name", ANSWERING)
@pytest.mark.parametrize("seed", SEEDS)
def test_a_form_that_answers_holds_what_the_full_form_says(name, seed, quick_outcome):
    """Of what is said: the measures that carry the answer."""
    question = EXPERIMENTS[name].quick()
    if seed and not hasattr(question, "seed"):
        pytest.skip("it draws nothing")
    if question == EXPERIMENTS[name]:
        return  # the quick form is the full one
    outcome = replace(question, seed=seed).run() if seed else quick_outcome(name)
    assert outcome.too_short == ""
    said = {key: float(measure.value) for key, measure in outcome.measures.items()}
    assert misses(question.answers, said, full_measures(name)) == []


def test_a_miss_is_found():
    full = {"speed": 0.2, "turn": 1.0, "share": 0.5, "never": float("nan")}
    quick = {"speed": 0.002, "turn": 0.99, "share": 0.3, "share_low": 0.2, "share_high": 0.6, "never": 1.0}
    assert misses(full, quick, full) == ["speed"]
    assert misses(full, quick | {"speed": float("nan"), "share_high": 0.4}, full) == ["share"]


def test_what_is_too_short_shows_no_number_no_figure_and_no_sentence(tmp_path, capsys):
    assert main(["run", "shore", "--quick", "--out", str(tmp_path)]) == 0
    said = " ".join(capsys.readouterr().out.split())
    folder = tmp_path / "shore"
    outcome = json.loads((folder / "outcome.json").read_text())
    assert outcome["decides"] == outcome["too_short"]
    assert "Too short to answer: duration is 2 s, and 30 s at least are needed." in said
    assert "came ashore" not in said
    assert "ashore share" not in said
    assert not [*folder.glob("*.png"), *folder.glob("*.svg")]
    page = (folder / "index.html").read_text()
    assert "Too short to answer" in page
    assert "The numbers that carry the answer" not in page


def test_settings_that_are_long_enough_answer():
    quick = EXPERIMENTS["swim_free"].quick()
    assert quick.too_short().startswith("Too short to answer: settle is 0, and 24 at least are needed.")
    assert replace(quick, settle=24).too_short().startswith("Too short to answer: dive is 0")
    assert replace(quick, settle=24, dive=24).too_short() == ""


def test_a_smaller_robot_needs_less_time():
    small = EXPERIMENTS["floating"].for_robot(hatchling())
    assert small.too_short() == ""
    assert replace(small, duration=6.0).too_short() == ""
    assert "duration is 5 s, and 5.46 s at least are needed" in replace(small, duration=5.0).too_short()
    assert replace(small, duration=5.46).too_short() == ""
    assert "10 s at least are needed" in replace(EXPERIMENTS["floating"], duration=6.0).too_short()
