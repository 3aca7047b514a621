"""How fast a robot swims in real water: one sentence, with a range over the models that apply."""

from math import isnan, nan

import pytest

from evidence import store
from suchus.core.errors import InvalidDesign
from suchus.experiments.catalog import EXPERIMENTS
from suchus.swimming.water import SpeedEstimate, real_water_speed
from suchus.swimming.water.speed_range import MIN_DRAG_REYNOLDS, WATER_MODELS

REAL = 1e6


def estimate(model, speed, reynolds=REAL, low=None, high=None):
    return SpeedEstimate(
        model=model, speed=speed, low=speed if low is None else low, high=speed if high is None else high,
        reynolds=reynolds,
    )  # fmt: skip


def test_sections_are_the_answer_and_the_range_is_over_all_that_apply():
    answer = real_water_speed(
        [estimate("reactive", 0.23), estimate("sections", 0.2, low=0.17, high=0.22), estimate("space", 0.024, 7e3)],
        REAL,
    )
    assert (answer.speed, answer.low, answer.high) == (0.2, 0.17, 0.23)
    assert "it swims at 0.200 m/s by sections, 0.170 to 0.230 m/s over the models that apply" in answer.sentence
    for model in ("sections", "reactive"):
        assert f"out {WATER_MODELS[model].omission}" in answer.sentence
    assert "0.024" not in answer.sentence
    assert "0.024 m/s by the flow in space at 7000" in answer.other_waters_sentence
    assert answer.sentence.count(". ") == 0
    assert answer.sentence == f"{answer.answer[:-1]} ({answer.omissions})."
    assert "leave" not in answer.answer


def test_where_models_agree_there_is_one_number():
    answer = real_water_speed([estimate("sections", 0.2)], REAL)
    assert "it swims at 0.200 m/s by sections (sections leave out" in answer.sentence
    assert answer.low == answer.high == 0.2
    assert answer.other_waters_sentence == ""


def test_without_the_default_model_there_is_a_range_alone():
    answer = real_water_speed([estimate("resistive", 0.2), estimate("reactive", 0.23)], REAL)
    assert isnan(answer.speed)
    assert "it swims at 0.200 to 0.230 m/s over the models that apply (resistive theory leaves out" in answer.sentence


@pytest.mark.parametrize(
    ("given", "number"),
    [
        (estimate("sections", 0.2, 0.9 * MIN_DRAG_REYNOLDS), 0.9 * MIN_DRAG_REYNOLDS),
        (estimate("reactive", -0.2), REAL),
        (estimate("sections", nan), REAL),
        (estimate("space", 0.02, 0.4 * REAL), REAL),
    ],
    ids=["slow flow", "tail first", "no number", "other water"],
)
def test_models_that_do_not_apply_are_left_out(given, number):
    answer = real_water_speed([given], number)
    assert answer.estimates == ()
    assert isnan(answer.low)
    assert "is not answered: no model of the water applies" in answer.sentence


def test_a_flow_of_the_robots_own_water_applies():
    assert real_water_speed([estimate("space", 0.02, 0.6 * REAL)], REAL).high == 0.02


def test_a_speed_outside_its_range_and_an_unknown_model_are_refused():
    with pytest.raises(InvalidDesign, match=r"is 0\.3 m/s, and its range is 0\.1 to 0\.2 m/s"):
        estimate("sections", 0.3, low=0.1, high=0.2)
    with pytest.raises(InvalidDesign, match="is 'panels'; there is sections, resistive, reactive, slice, space"):
        estimate("panels", 0.3)


def test_the_kept_swims_say_it_the_same_way():
    """Nothing says a speed in thick water beside one in real water without a word."""
    for name in ("swim_free", "swimming", "swim_3d"):
        text = EXPERIMENTS[name].explain(store.load(name).values)
        assert text.count("In real water, at f L²/ν = 1.0e+06, it swims at ") == 1, name
    for name in ("swimming", "swim_3d"):
        text = EXPERIMENTS[name].explain(store.load(name).values)
        assert " m/s by the flow in space at 7000: this explains mechanisms" in text
