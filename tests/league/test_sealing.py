import json
import sys
import warnings
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path

import pytest
from toys import failing, silent, stone

from evidence.league import Predictor, SingleContestant, every, find, sealing
from evidence.league.cases import CONTESTANTS, measured_file
from evidence.league.command import main
from evidence.league.page import FIGURE, OUTCOMES, PAGE, page, standing, standing_text, standings_of, write_page
from evidence.league.sealing import PREDICTION, SEAL, opened, read_prediction, sealed_prediction
from suchus.core.errors import InvalidDesign, NotConverged, UnreadableFile
from suchus.core.files import package_digest

_TRUTH = {"speed": {"value": 4.4, "low": 4.3, "high": 4.5, "unit": "m/s", "source": "a gun"}}
_OPENED: list[Path] = []


def _hook(event, args):
    if event == "open" and isinstance(args[0], (str, Path)):
        path = Path(args[0])
        if path.name == "measured.json" or path.parent.name == "measured":
            _OPENED.append(path)


@pytest.fixture(scope="module")
def opened_files():
    """Files of measurements that were opened; the hook stays in the process, so no other test waits for it before."""
    sys.addaudithook(_hook)
    return _OPENED


def _truth(folder, data=None):
    path = folder / "measured.json"
    path.write_text(json.dumps(_TRUTH if data is None else data))
    return path


def test_a_prediction_has_its_form_and_its_seal(tmp_path):
    seal = sealed_prediction(stone(), tmp_path, date=datetime(2026, 1, 2, 3, 4, 5, tzinfo=UTC))
    assert seal.date == "2026-01-02T03:04:05Z"
    assert seal.given["height"]["source"] == "a ruler"
    data = json.loads((tmp_path / "stone" / PREDICTION).read_text())
    assert set(data) == {"speed", "times"}
    assert set(data["speed"]) == {"formula", "film"}
    assert set(data["times"]) == {"formula"}  # the film does not say them
    one = data["speed"]["formula"]
    assert one["unit"] == "m/s"
    assert one["value"] == pytest.approx(4.429, abs=1e-3)
    assert one["low"] < one["value"] < one["high"]
    assert data["times"]["formula"]["value"] == [1.0, 2.0]
    again = sealed_prediction(stone(), tmp_path)
    assert again.date == seal.date


def test_nothing_that_was_measured_is_read_before_the_seal(tmp_path, opened_files):
    """By an audit hook, which sees every file that this process opens; digests of the code are made anew."""
    package_digest.cache_clear()
    sealing.code_state.cache_clear()
    sealing._own_digest.cache_clear()
    measured = _truth(tmp_path)
    for one in (stone(), *(_cheap(find(CONTESTANTS, name)) for name in ("catshark_2", "amphibot"))):
        there = measured if one.name == "stone" else measured_file(one.name)
        opened_files.clear()
        with pytest.raises(UnreadableFile):
            opened(tmp_path / one.name, one.predicts, there)
        sealed_prediction(one, tmp_path)
        assert opened_files == []
        standing(one, tmp_path, there)
        assert ([there] if there.is_file() else []) == opened_files


def _cheap(one):
    """Return a contestant with its resistive theory alone, asked with the most likely numbers and two others."""
    return replace(one, rungs={"resistive": replace(one.rungs["resistive"], draws=2)})


def test_a_prediction_that_was_changed_or_made_by_other_code_is_refused(tmp_path, monkeypatch):
    one, folder = stone(), tmp_path / "stone"
    sealed_prediction(one, tmp_path)
    text = (folder / PREDICTION).read_text()
    (folder / PREDICTION).write_text(text.replace("4.4", "4.5"))
    with pytest.raises(UnreadableFile, match="was changed since"):
        read_prediction(folder)
    (folder / PREDICTION).write_text(text)
    assert read_prediction(folder)["speed"]["film"].value == 3.0
    monkeypatch.setattr(sealing, "code_state", lambda: "another")
    with pytest.raises(InvalidDesign, match="never replaced"):
        sealed_prediction(one, tmp_path)
    assert (folder / PREDICTION).read_text() == text


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"unit": "km/h"}, "in km/h, and it is predicted in m/s"),
        ({"source": ""}, "says nothing of source"),
        ({"value": None}, "says nothing of value"),
    ],
)
def test_a_measurement_in_another_unit_or_without_a_source_is_refused(tmp_path, change, sentence):
    sealed_prediction(stone(), tmp_path)
    measured = _truth(tmp_path, {"speed": {**_TRUTH["speed"], **change}})
    with pytest.raises(UnreadableFile, match=sentence):
        standing(stone(), tmp_path, measured)
    measured = _truth(tmp_path, {"weight": _TRUTH["speed"]})
    with pytest.raises(UnreadableFile, match="'weight', which is not predicted"):
        standing(stone(), tmp_path, measured)


def test_a_rung_that_cannot_answer_says_why_and_the_others_speak(tmp_path):
    seal = sealed_prediction(failing(NotConverged("it does not fall.")), tmp_path)
    assert seal.refused == {"other": "it does not fall."}
    assert set(read_prediction(tmp_path / "stone")["speed"]) == {"formula"}
    assert "No word from other: it does not fall." in page([standing(failing(None), tmp_path, tmp_path / "none")], "x")


def test_a_rung_without_an_answer_to_the_most_likely_numbers_says_so(tmp_path):
    seal = sealed_prediction(stone(rungs={"none": Predictor(words="says nothing", work=silent, draws=3)}), tmp_path)
    assert seal.refused == {"none": "it gave no answer with the most likely numbers."}


def test_the_page_lists_misses_before_contestants_and_keeps_what_it_is_made_of(tmp_path):
    one = stone()
    sealed_prediction(one, tmp_path)
    low = _truth(tmp_path, {"speed": {**_TRUTH["speed"], "value": 40.0, "low": 39.0, "high": 41.0}})
    made = standing(one, tmp_path, low)
    write_page([made], tmp_path)
    text = (tmp_path / PAGE).read_text()
    assert text.index("## Misses") < text.index("| stone | speed at the ground") < text.index("## A stone falls")
    assert "Of 2 predictions that could be judged here 2 missed" in text
    assert (tmp_path / FIGURE).stat().st_size > 5000
    (kept,) = standings_of(tmp_path / OUTCOMES)
    assert standing_text([kept]) == standing_text([made])
    assert page([kept], FIGURE) == text
    near = standing(one, tmp_path, _truth(tmp_path))
    text = page([near], "x")
    assert "Of 2 predictions that could be judged here 1 missed." in text
    assert "| formula | 1 | 1 | 1 | 0 | 0 |" in text
    assert "| film | 1 | 0 | 0 | 0 | 1 |" in text


def test_a_page_of_whom_nothing_was_measured_warns_of_nothing(tmp_path):
    sealed_prediction(stone(), tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        write_page([standing(stone(), tmp_path, tmp_path / "none")], tmp_path)
    assert "kept back or not published" in (tmp_path / PAGE).read_text()


def test_the_command_predicts_seals_and_judges(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("evidence.league.command.CONTESTANTS", {"stone": SingleContestant(stone())})
    measured = _truth(tmp_path)
    assert main(["stone", "--out", str(tmp_path / "l"), "--jobs", "1", "--measured", str(measured)]) == 0
    said = capsys.readouterr().out
    assert "A stone falls" in said
    assert "within, 1" in said
    assert said.splitlines()[-1].endswith("league.md")
    assert (tmp_path / "l" / "stone" / SEAL).is_file()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["pebble"], "pebble"),
        (["catshark_9"], "0.5 to 6 can be asked"),
        (["amphibot", "--jobs", "0"], "at least 1 model"),
        (["amphibot", "catshark_2", "--measured", "x.json"], "name one"),
        (["amphibot", "--measured", "none.json"], "is not there"),
    ],
)
def test_bad_words_end_in_a_sentence(tmp_path, monkeypatch, capsys, words, sentence):
    monkeypatch.chdir(tmp_path)
    assert main(words) == 2
    assert sentence in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_everyone_on_the_shelf_says_what_it_rests_on():
    names = every(CONTESTANTS)
    assert {"amphibot", "catshark_1.25", "catshark_5", "salamander", "tunabot", "swimming_law"} <= set(names)
    for name in names:
        one = find(CONTESTANTS, name)
        assert one.name == name
        assert one.rungs
        if measured_file(name).is_file():
            assert set(json.loads(measured_file(name).read_text())) <= set(one.predicts)
