"""A swim is the filmed one in trim, or there is no word; the page says what to trust before it counts misses."""

import json
import re
from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from tests.league.toys import stone

import league_page
from evidence.league import find, swims
from evidence.league.cases import CONTESTANTS
from evidence.league.cases._films import FilmedEnvelope
from evidence.league.causes import UNKNOWN, cause_of
from evidence.league.contestant import Interval
from evidence.league.judging import Judgement
from evidence.league.page import LeagueEntry, _gap, _is_narrow, all_standings, page
from evidence.league.sealing import sealed_prediction
from evidence.league.swims import MAX_HEEL, MAX_PITCH, MAX_SWING_ERROR, SwimPrediction, free_swims, held_swim
from suchus.core.errors import InvalidDesign, NotConverged, OutsideLimits
from suchus.swimming.water import resistive

WAVE = FilmedEnvelope(
    length=0.2, frequency=2.0, wavelength=0.7, positions=(0.0, 0.3, 1.0), amplitudes=(0.02, 0.03, 0.1)
)
SWIM = SwimPrediction(frequency=2.0, speed=0.1, power=0.0, periods=(), swing=0.03, coast=np.nan, pitch=0.0, heel=0.0)


def task_of(name, model="resistive"):
    return find(CONTESTANTS, name).rungs[model].work.args[-1]


def test_the_slope_of_a_filmed_envelope_is_its_derivative():
    x, step = np.linspace(0.004, 0.196, 41), 1e-6
    numeric = (WAVE.displacement(x + step, 0.13) - WAVE.displacement(x - step, 0.13)) / (2.0 * step)
    np.testing.assert_allclose(WAVE.slope(x, 0.13), numeric, atol=1e-5)
    times = np.linspace(0.0, WAVE.period, 400)
    ends = np.ptp([WAVE.displacement(np.array([0.0, 0.2]), time) for time in times], axis=0)
    np.testing.assert_allclose(ends, [2 * 0.02 * 0.2, 2 * 0.1 * 0.2], rtol=1e-3)


@pytest.mark.parametrize(
    "change", [{"positions": (0.0, 0.5, 0.9)}, {"positions": (0.0, 0.5, 0.4)}, {"amplitudes": (0.02, 0.1)}]
)
def test_an_envelope_reaches_from_snout_to_tail(change):
    with pytest.raises(InvalidDesign, match="positions rise from 0 to 1"):
        replace(WAVE, **change)


@pytest.mark.parametrize("name", ["filmed_lamprey", "prickleback", "american_eel", "salamander", "catshark_2"])
def test_a_free_body_swings_its_tail_as_filmed(name):
    """The salamander's joints alone swing it a tenth too far and more: the head of a free body yaws."""
    one, task = find(CONTESTANTS, name), task_of(name, "slice")
    swimmer, swum = held_swim(task, one.likely, partial(swims.theory, resistive, starts=False))
    wanted = task.filmed_swing(one.likely)
    assert swum.swing == pytest.approx(wanted, rel=0.05)
    if name == "salamander":
        free = swims.theory(resistive, replace(swimmer, gait=swimmer.gait.bent(1.0 / swimmer.bend)), starts=False)
        assert free.swing > 1.1 * wanted


def test_a_tail_that_cannot_swing_as_filmed_is_no_filmed_swim():
    one, task = find(CONTESTANTS, "filmed_lamprey"), task_of("filmed_lamprey")
    far = replace(task, filmed_swing=lambda numbers: 5.0 * task.filmed_swing(numbers))
    with pytest.raises(NotConverged, match="not a steady swim as filmed: its tail swings"):
        held_swim(far, one.likely, lambda swimmer: SWIM)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({}, ""),
        ({"pitch": 0.9 * MAX_PITCH, "heel": 0.9 * MAX_HEEL}, ""),
        ({"pitch": -1.1 * MAX_PITCH}, "not a steady swim: it pitches by -22 degrees"),
        ({"heel": 1.1 * MAX_HEEL}, "not a steady swim: it heels by 50 degrees"),
        ({"pitch": np.nan, "heel": np.nan}, ""),
    ],
)
def test_a_swim_out_of_trim_is_no_steady_swim(change, reason):
    assert swims.out_of_trim(SWIM._replace(**change)).startswith(reason)
    assert bool(swims.out_of_trim(SWIM._replace(**change))) == bool(reason)


@pytest.mark.parametrize(("change", "word"), [({"heel": 1.0}, "it heels"), ({"swing": 0.005}, "its tail swings")])
def test_sections_say_why_the_likely_swim_is_not_steady(change, word, monkeypatch):
    one, task = find(CONTESTANTS, "filmed_lamprey"), task_of("filmed_lamprey", "sections")
    swim = SWIM._replace(swing=task.filmed_swing(one.likely))
    monkeypatch.setattr(swims, "sections", lambda swimmers, **_: [swim._replace(**change)] * len(swimmers))
    with pytest.raises(OutsideLimits, match=word):
        swims._by_sections(task, [one.likely], lambda *_: None)
    monkeypatch.setattr(swims, "sections", lambda swimmers, **_: [swim] * len(swimmers))
    (found,) = swims._by_sections(task, [one.likely], lambda *_: None)
    assert found["stride"] == pytest.approx(0.1 / 2.0 / one.likely["length"], rel=1e-6)


def test_sections_scale_the_bends_until_the_tail_swings_as_filmed(monkeypatch):
    """Of a body whose tail swings in proportion to its bends the second pass is exact."""
    one, task = find(CONTESTANTS, "prickleback"), task_of("prickleback", "sections")
    wanted = task.filmed_swing(one.likely)
    monkeypatch.setattr(
        swims, "sections", lambda swimmers, **_: [SWIM._replace(swing=0.8 * wanted * each.bend) for each in swimmers]
    )
    (swimmer,), (swum,) = free_swims(task, [one.likely], lambda *_: None)
    assert swimmer.bend == pytest.approx(1.25, rel=1e-9)
    assert swum.swing == pytest.approx(wanted, rel=1e-9)
    assert MAX_SWING_ERROR < 0.25


@pytest.mark.parametrize(
    ("low", "high", "narrow"),
    [(1.0, 1.9, True), (1.0, 2.1, False), (-1.0, 1.0, False), ((1.0, 1.0), (1.5, 3.0), False)],
)
def test_a_narrow_interval_has_ends_within_a_factor_of_two(low, high, narrow):
    assert _is_narrow(Interval(high, low, high)) is narrow


def test_the_page_opens_with_what_to_trust_then_hits_then_misses(tmp_path):
    one = stone()
    sealed_prediction(one, tmp_path)
    file = tmp_path / "measured.json"
    file.write_text(json.dumps({"speed": {"value": 4.4, "low": 4.3, "high": 4.5, "unit": "m/s", "source": "a gun"}}))
    (entry,) = all_standings(tmp_path, [one], {one.name: file})
    text = page([entry], "league.png")
    places = [text.index(heading) for heading in ("## What to trust", "## Hits", "## Misses and their causes")]
    assert places == sorted(places)
    assert text.index("| formula |") < places[1]
    assert "| stone | speed at the ground [m/s] | formula |" in text[places[1] : places[2]]


def test_every_miss_on_the_page_has_a_cause():
    kept = league_page.kept()
    missed = {(one.name, row[1]) for one in kept for row in one.judgements() if row[-1].word == "missed"}
    assert missed
    assert [pair for pair in sorted(missed) if cause_of(*pair) == UNKNOWN] == []
    assert cause_of("stone", "formula") == UNKNOWN


def test_the_number_behind_a_miss_is_that_of_its_cause():
    text = league_page.text(league_page.kept())
    part = text.partition("## Misses and their causes")[2].partition("\n## ")[0]
    table, _, list_of_causes = part.partition("The causes, as far as they are known:")
    causes = [" ".join(item.split()) for item in re.split(r"\n\d+\. ", list_of_causes)[1:]]
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in table.splitlines() if line.startswith("| ")]
    assert len(rows) - 1 == table.count(" | ") // 6 - 1 > len(causes) == len(set(causes))
    for contestant, _, model, *_, number in rows[1:]:
        assert causes[int(number) - 1] == f"{cause_of(contestant, model)}."


def row_of(word, low, high, model="sections"):
    entry = LeagueEntry(
        name="body", title="", explanation="", words={"speed": "speed"}, units={"speed": "m/s"}, prediction={},
        seal=None, measured={},
    )  # fmt: skip
    return entry, "speed", model, Interval(low, low, high), None, Judgement(word, 1.0)


def test_the_page_says_what_keeps_the_recommended_model_from_the_aim():
    met, other = (
        [row_of("within", 1.0, 1.8)] * 5 + [row_of("within", 1.0, 1.95)] * 2,
        row_of("within", 1.0, 1.0, "reactive"),
    )
    assert _gap([*met, row_of("missed", 1.0, 1.5), *[row_of("within", 1.0, 2.1)] * 2, other]) == []
    text = "\n".join(_gap([*met[1:], row_of("missed", 1.0, 1.5), *[row_of("within", 1.0, 2.1)] * 3, other]))
    assert "6 of the 10 judged predictions by sections are within and narrow, and 70% would be 7." in text
    assert "The interval of 2 of them is wider than a factor of 1.9. The others:" in text
    assert text.count("* body, speed: within, its interval a factor of 2.1 wide.") == 3
    assert text.count("* body, speed: missed by a factor of 1, its interval a factor of 1.5 wide.") == 1
    assert _gap([row_of("not a steady swim", 1.0, 1.5)]) == []


def test_the_swing_of_the_lampreys_is_that_of_the_table_and_picture_of_their_films():
    """Twice the mode's amplitude at the tail's tip, over the length; the mean is less than the root mean square."""
    for viscosity, (mean, deviation, tip) in {1.0: (1745, 586, 0.3525), 20.0: (1341, 316, 0.3555)}.items():
        one = find(CONTESTANTS, f"lamprey_{viscosity:g}")
        tail, length = one.inputs["tail"], 1e3 * one.inputs["length"].value
        root = 2.0 * tip * mean**0.5 / length
        assert 0.98 * root < tail.value < root
        between = deviation / mean / 5**0.5
        assert between < 1.0 - tail.low / tail.value < between + 0.02
        assert tail.high - tail.value == pytest.approx(tail.value - tail.low)


def test_a_page_keeps_what_is_not_predicted_anew(tmp_path, monkeypatch):
    kept = league_page.kept()
    stored = []
    monkeypatch.setattr(league_page.renew, "store", lambda name, values: stored.extend(values))
    monkeypatch.setattr(league_page, "DOCS", tmp_path)
    (tmp_path / "pictures").mkdir()
    figure = tmp_path / "drawn.png"
    figure.write_bytes(b"png")
    monkeypatch.setattr(league_page, "draw", lambda standings, path: figure)
    monkeypatch.setattr(
        league_page, "all_standings", lambda out, contestants, measured: [replace(kept[0], title="Anew")]
    )
    league_page.main(tmp_path)
    assert [entry["title"] for entry in stored] == ["Anew", *(one.title for one in kept[1:])]
    assert (tmp_path / "league.md").read_text().count("## Anew") == 1


def test_kept_outcomes_have_the_word_of_the_gate_of_today():
    (old,) = [one for one in league_page.kept() if one.name == "catshark_5"]
    assert (
        "a wave drives a body only below its own speed" in league_page.gated(replace(old, unsteadiness="")).unsteadiness
    )
    assert league_page.gated(replace(old, unsteadiness="", measured={})).unsteadiness == ""


def test_bodies_of_very_different_size_swim_in_batches_of_their_own():
    """Their servos are commanded at different intervals, which one batch refuses; their order stays."""
    one, task = find(CONTESTANTS, "prickleback"), task_of("prickleback", "sections")
    swimmers = [task.build({**one.likely, "length": length, "frequency": 3.0}, None) for length in (0.12, 0.40, 0.12)]
    periods = [swims.control_period(swimmer.robot) for swimmer in swimmers]
    assert periods[0] == periods[2] < periods[1]
    small, large, again = swims.sections(swimmers, cycles=4)
    assert small.speed == pytest.approx(again.speed, rel=1e-6)
    assert large.speed > 1.5 * small.speed
