"""A robot that does not move is said not to, and has no cost of transport."""

from dataclasses import replace
from math import isnan

import pytest

from suchus.experiments.catalog.displacement.experiment import Displacement
from suchus.experiments.catalog.speed_range.experiment import SpeedRange
from suchus.robot.gaits import GAITS
from suchus.visual.pages import UNKNOWN, number, quantity

STANDING = replace(GAITS["belly_crawl"].strode(0.0).bent(0.0), name="standing")


def test_speed_range_says_that_it_does_not_move_beside_a_gait_that_does():
    walking = replace(GAITS["belly_crawl"], name="walking")
    question = SpeedRange(gaits=(STANDING, walking), slower=(1.0,), cycles=1)
    outcome = question.run()
    assert isnan(outcome.measures["cost_standing"].value)
    assert outcome.measures["cost_walking"].value > 0
    assert "In the gait standing it does not move" in outcome.decides
    assert (
        "In the gait walking it walks at 0.09 m/s at its own cycle time, with a cost of transport of" in outcome.decides
    )
    assert "nan" not in outcome.decides
    question.draw(outcome)


def test_speed_range_of_nothing_but_standing_answers():
    question = SpeedRange(gaits=(STANDING,), slower=(1.0,), cycles=1)
    outcome = question.run()
    assert outcome.decides.startswith("In the gait standing it does not move")
    assert "nan" not in outcome.decides
    assert "by at most" not in outcome.decides
    question.draw(outcome)


def test_displacement_says_that_it_does_not_move():
    question = replace(Displacement().quick(), gait=STANDING, phases=(0.0,), pitches=(0.1,))
    outcome = question.run()
    assert outcome.decides.startswith("It does not move: in 1 cycle it gets")
    assert "times as far" not in outcome.decides
    assert isnan(outcome.measures["cost_of_transport_coordinated"].value)


def test_displacement_of_a_crawl_has_its_ratio():
    outcome = replace(Displacement().quick(), phases=(0.0,), pitches=(0.1,)).run()
    assert "times as far as with the same legs alone" in outcome.decides
    assert not isnan(outcome.measures["cost_of_transport_coordinated"].value)


@pytest.mark.parametrize("unit", ["-", "m/s", "rad"])
def test_a_number_that_is_none_is_called_unknown(unit):
    assert number(float("nan")) == UNKNOWN
    assert quantity(float("nan"), unit) == UNKNOWN
    assert quantity(0.5, "m/s") == "0.5 m/s"
