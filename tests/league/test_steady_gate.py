"""What contradicts itself as a steady swim judges no prediction, and a flow's answer holds no other model's."""

import json
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from tests.league.toys import stone

from evidence.league import find
from evidence.league import swims as swims_of_models
from evidence.league.cases import CONTESTANTS, measured_file
from evidence.league.cases.swimming_law import _fitted, resampled
from evidence.league.contestant import Interval
from evidence.league.judging import judged, unsteady_wave
from evidence.league.page import all_standings, page, standing, standing_of, standing_text
from evidence.league.sealing import Measured, sealed_prediction
from evidence.league.swims import SPACE_CELLS, SwimPrediction, SwimTask


@pytest.mark.parametrize(("speed", "is_steady"), [(0.99, True), (1.0, False), (1.01, False)])
def test_a_wave_drives_a_body_below_its_own_speed_only(speed, is_steady):
    reason = unsteady_wave(speed, 1.0)
    assert (reason == "") == is_steady
    assert is_steady or "a wave drives a body only below its own speed" in reason


@pytest.mark.parametrize("speed", [1.25, 2.0, 3.0, 5.0])
def test_the_filmed_catsharks_are_faster_than_their_printed_waves(speed):
    """U / c of the table: 1.01, 1.44, 1.75 and 2.15."""
    one = find(CONTESTANTS, f"catshark_{speed:g}")
    tailbeat = json.loads(measured_file(one.name).read_text())["tailbeat"]["value"]
    assert "body wave, frequency times wavelength as printed" in one.find_unsteadiness({"tailbeat": tailbeat})
    assert one.find_unsteadiness({"tailbeat": 2.5 * tailbeat}) == ""
    assert one.find_unsteadiness({"strouhal": 0.3}) == ""


def test_the_wavelength_of_the_catshark_is_the_printed_one():
    wavelength = find(CONTESTANTS, "catshark_2").inputs["wavelength"]
    assert wavelength.value == pytest.approx(0.5697)
    assert wavelength.low < 0.5697 < wavelength.high < 0.66


def test_the_word_takes_the_place_of_a_verdict():
    truth = Measured(value=1.0, low=0.9, high=1.1, unit="-", source="here")
    assert judged(Interval(5.0, 4.0, 6.0), truth).word == "missed"
    assert judged(Interval(5.0, 4.0, 6.0), truth, is_steady=False).word == "not a steady swim"
    assert judged(Interval(1.0, 0.9, 1.1), truth, is_steady=False).word == "not a steady swim"


def test_the_page_counts_no_swim_that_is_not_steady_and_says_why(tmp_path):
    unsteady = replace(stone(), find_unsteadiness=lambda measured: "it falls" if measured else "")
    sealed_prediction(unsteady, tmp_path)
    quantity = next(iter(unsteady.predicts))
    file = tmp_path / "measured.json"
    unit = unsteady.predicts[quantity].unit
    file.write_text(json.dumps({quantity: {"value": 1e3, "low": 9e2, "high": 2e3, "unit": unit, "source": "a film"}}))
    (entry,) = all_standings(tmp_path, [unsteady], {unsteady.name: file})
    assert {row[-1].word for row in entry.judgements()} == {"not a steady swim"}
    text = page([entry], "league.png")
    assert "Of 0 predictions that could be judged here 0 missed" in text
    assert f"* {unsteady.name}: it falls." in text
    assert "**missed**" not in text
    stored = json.loads(standing_text([entry]))[0]
    assert standing_of(stored) == entry
    stored.pop("unsteadiness")  # as older files have it
    assert standing_of(stored).unsteadiness == ""
    assert standing(replace(unsteady, find_unsteadiness=None), tmp_path, file).unsteadiness == ""


def test_the_flow_in_space_is_no_mean_with_theories(monkeypatch):
    """With theories that say 1 m/s in real water and 0.5 in thick water, a flow of 0.2 m/s is one of 0.4 m/s."""
    swim = SwimPrediction(frequency=1.0, speed=1.0, power=1.0, periods=(0.5, 1.0), swing=0.1, coast=float("nan"))
    monkeypatch.setattr(swims_of_models, "resolved", lambda *_, **__: swim._replace(speed=0.2, periods=(0.1, 0.2)))
    monkeypatch.setattr(swims_of_models, "_viscosity", lambda swimmer, cells: 1e-3)
    thick_or_real = lambda model, swimmer, **_: swim if swimmer.water.viscosity < 1e-4 else swim._replace(speed=0.5)  # noqa: E731
    monkeypatch.setattr(swims_of_models, "theory", thick_or_real)
    one = find(CONTESTANTS, "catshark_2")
    task = next(iter(one.rungs["space"].work.args), None)
    assert isinstance(task, SwimTask)
    plain = replace(
        task, target_speed=None, filmed_swing=None, read_quantities=lambda numbers, swimmer, swum: {"speed": swum.speed}
    )
    answers = swims_of_models._by_space(plain, [one.likely], partial(lambda *_: None))
    assert len(answers) == 1 + 2 * len(SPACE_CELLS)
    assert {round(answer["speed"], 9) for answer in answers} == {0.4}


def test_a_law_over_swimmers_is_as_uncertain_as_their_choice():
    """Where all swimmers follow one law each sample gives it; where they do not, samples differ."""
    x = np.array([2.0, 3.0, 4.0])
    alike = np.concatenate([np.column_stack([np.full(3, i), x + 0.1 * i, 1.5 * (x + 0.1 * i)]) for i in range(4)])
    unlike = alike + np.outer(alike[:, 0] * alike[:, 1], [0.0, 0.0, 0.2])
    samples = np.linspace(0.0, 1.0, 24)
    assert resampled(unlike, 0.0) is unlike
    for sample in samples:
        assert len(np.unique(resampled(alike, sample)[:, 0])) >= 2
    slopes = [[_fitted(resampled(points, sample))[0] for sample in samples] for points in (alike, unlike)]
    assert np.ptp(slopes[0]) < 1e-9
    assert np.ptp(slopes[1]) > 0.1
    assert np.array_equal(resampled(unlike, 0.3), resampled(unlike, 0.3))
