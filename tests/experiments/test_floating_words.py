"""``floating`` speaks truly of robots that float, sink, capsize and are indifferent to heel."""

import json
from dataclasses import replace
from math import isnan
from pathlib import Path

import pytest

from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot.robots import ROBOTS
from suchus.sim.land.afloat import INDIFFERENT

GOLDEN = Path(__file__).parents[1] / "golden" / "floating.json"
FLOATING = EXPERIMENTS["floating"]
NEXT_TO_ZERO = INDIFFERENT * FLOATING.robot.length


def words(robot="floating_caiman", **changes):
    kept = {name: entry["value"] for name, entry in json.loads(GOLDEN.read_text(encoding="utf-8")).items()}
    return replace(FLOATING, robot=ROBOTS[robot]).explain(kept | changes)


def test_what_floats_upright_is_stable_and_says_when_it_is_upright():
    text = words(righting_time=6.3)
    assert "is stable upright (metacentric height 20.6 mm); its righting lever vanishes at 180 degrees" in text
    assert "comes to rest at 18.5 degrees, upright after 6.3 s. The forces" in text


@pytest.mark.parametrize(
    ("height", "word"),
    [
        (1.01 * NEXT_TO_ZERO, "stable"), (0.99 * NEXT_TO_ZERO, "indifferent"), (0.0, "indifferent"),
        (-0.99 * NEXT_TO_ZERO, "indifferent"), (-1.01 * NEXT_TO_ZERO, "unstable"),
    ],
)  # fmt: skip
def test_next_to_zero_it_is_indifferent_on_both_sides(height, word):
    text = words(metacentric_height_floating=height)
    assert f"is {word} upright" in text
    assert ("vanishes at" in text) == (word == "stable")
    assert ("nothing rights it" in text) == (word != "stable")


@pytest.mark.parametrize(("surplus", "sinks"), [(1e-6, True), (-1e-6, False)])
def test_who_sinks_is_not_said_to_float_or_to_right_itself(surplus, sinks):
    text = words(surplus_floating=surplus, righting_time=0.0)
    assert ("how it floats and rights itself is not answered" in text) == sinks
    assert any(word in text for word in ("stable upright", "upright after", "vanishes", "metacentric")) != sinks


@pytest.mark.parametrize(
    ("height", "words_of_it"),
    [
        (0.0039, "3.9 mm above its centre of mass, so that it sinks upright"),
        (-0.0039, "3.9 mm below its centre of mass, so that it turns over while it sinks"),
        (0.0, "at the height of its centre of mass, so that it is indifferent to heel"),
    ],
)
def test_who_sinks_hears_how_it_turns_under_water(height, words_of_it):
    assert words_of_it in words("caiman", surplus_floating=1.0, metacentric_height_floating=height)


def test_a_sinker_that_was_never_heeled_has_no_time_of_righting():
    question = FLOATING.for_robot(ROBOTS["caiman"]).quick()
    with pytest.warns(UserWarning, match="sinks"):
        outcome = replace(question, energy_time=0.2, periods=2, points=2**8, poses=1, duration=0.2).run()
    assert isnan(outcome.measures["righting_time"].value)
    assert "upright after" not in outcome.decides
    assert "not answered" in outcome.decides
