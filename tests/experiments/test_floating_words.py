"""``floating`` speaks truly of robots that float, sink, capsize and are indifferent to heel."""

import json
import warnings
from dataclasses import replace
from math import isnan, nan
from pathlib import Path

import numpy as np
import pytest

from suchus.core.rotation import from_axis_angle
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.floating.experiment import _UPRIGHT as UPRIGHT
from suchus.robot.robots import ROBOTS
from suchus.sim.land.afloat import HEAVIER, INDIFFERENT

GOLDEN = Path(__file__).parents[1] / "golden" / "floating.json"
FLOATING = EXPERIMENTS["floating"]
NEXT_TO_ZERO = INDIFFERENT * FLOATING.robot.length


def words(robot="floating_caiman", **changes):
    kept = {name: entry["value"] for name, entry in json.loads(GOLDEN.read_text(encoding="utf-8")).items()}
    return replace(FLOATING, robot=ROBOTS[robot]).explain(kept | changes)


def test_what_floats_upright_is_stable_and_says_when_it_is_upright():
    text = words(righting_time=6.3, roll_at_rest=0.3226)
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


def test_who_still_rolls_is_not_said_to_have_come_to_rest():
    text = words()  # of the quick form, which ends before
    assert "let go at the greatest heel it still rolls after 20 s." in text
    assert "comes to rest" not in text


@pytest.mark.parametrize(
    ("share", "hull_words", "bare_words"),
    [
        (1.01 * HEAVIER, "With its hull it sinks too", "The robot sinks"),
        (0.99 * HEAVIER, "With its hull it neither floats nor sinks", "neither floats nor sinks by itself"),
        (0.0, "With its hull it neither floats nor sinks", "neither floats nor sinks by itself"),
        (-0.99 * HEAVIER, "With its hull it neither floats nor sinks", "neither floats nor sinks by itself"),
        (-1.01 * HEAVIER, "With its hull it floats with", "The robot floats"),
    ],
)  # fmt: skip
def test_who_is_as_heavy_as_its_water_neither_floats_nor_sinks(share, hull_words, bare_words):
    with_hull = words(surplus_floating=share * 2.0, mass_floating=2.0)
    bare = words("caiman", **dict.fromkeys(("surplus_floating", "surplus_bare"), share * 2.0),
                 **dict.fromkeys(("mass_floating", "mass_bare"), 2.0))  # fmt: skip
    floats = share < -HEAVIER
    assert hull_words in with_hull
    assert bare_words in bare
    for text in (with_hull, bare):
        assert ("how it lies at the surface is not answered" in text) != floats
        assert any(word in text for word in ("stable upright", "at the greatest heel", "vanishes")) == floats


def test_masses_and_volumes_of_a_small_body_are_in_grams_and_millilitres():
    text = words("caiman", surplus_bare=2.22e-3, mass_bare=0.03, missing_bare=2.22e-6, volume_bare=27.8e-6)
    assert "it weighs 30 g and displaces 27.8 ml; 2.22 ml more air or 2.22 g less mass would carry it" in text


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
    assert isnan(outcome.measures["roll_at_rest"].value)
    assert "upright after" not in outcome.decides
    assert "not answered" in outcome.decides
    figure = question.draw(outcome)["righting"]
    assert len(figure.axes) == 1
    assert "not drawn" in figure.suchus_caption
    assert figure.axes[0].lines[0].get_label() == "under water"


@pytest.mark.parametrize(
    ("final", "rest", "time"),
    [
        (np.full(25, 0.0), 0.0, 3.5),  # upright from before the last quarter on
        (np.where(np.arange(25) < 5, 0.05, 0.0), 0.01, nan),  # upright in the last quarter only
        (np.linspace(-1.01, 1.01, 25) * UPRIGHT, nan, nan),  # it still rolls
        (np.linspace(-0.99, 0.99, 25) * UPRIGHT, 0.0, 3.5),
        (np.pi + np.linspace(-0.01, 0.01, 25), np.pi, nan),  # on its back, through 180 degrees
    ],
)
def test_rest_and_righting_are_judged_by_the_last_quarter(final, rest, time, record):
    roll = np.concatenate([np.full(35, 2.0), np.zeros(40), final])
    orientation = np.array([[from_axis_angle(np.array([1.0, 0.0, 0.0]), float(angle)) for angle in roll]])
    measures = FLOATING.measure(record.assign(orientation=(("run", "time", "wxyz"), orientation)))
    assert measures["roll_at_rest"].value == pytest.approx(rest, abs=1e-9, nan_ok=True)
    assert measures["righting_time"].value == pytest.approx(time, nan_ok=True)


@pytest.fixture(scope="module")
def record():
    question = replace(FLOATING, heels=(2.0,), energy_time=0.2, periods=2, points=2**8, poses=1, duration=0.2, angles=3)
    simulated = question.simulate().record.isel(time=np.zeros(100, int))
    return simulated.assign_coords(time=np.arange(100) * 0.1).drop_vars("orientation")


def test_the_replay_says_what_was_done():
    for name, words_of_it in (("floating_caiman", "Let go at the surface"), ("caiman", "It lies on the ground")):
        question = replace(FLOATING, robot=ROBOTS[name], duration=0.2, heels=(1.0,))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            replay = question._replays(question._release_record(lambda *_: None))["righting_replay.html"]
        assert words_of_it in replay.caption
