"""Kept results: whole files, sentences for those that are not, and each on record with what made it."""

import json
from dataclasses import replace

import pytest

from evidence import renew, store
from evidence.registry import RESULTS
from evidence.store import Origin, StoredResult, load, save, save_part
from evidence.tolerance import bounded
from suchus.core.errors import IncompatibleRecord, UnreadableFile

RESULT = StoredResult(
    name="strokes",
    values={"speed": 0.1, "rows": [{"é": None}]},
    origin=Origin(version="0.2.0", commit="0123456789", seconds=3.0, processor="a processor"),
    source="abc",
    probe=bounded({"speed": 0.1}),
)


def test_a_result_reads_back(tmp_path):
    save(RESULT, tmp_path)
    assert load("strokes", tmp_path) == RESULT


def test_a_part_that_was_computed_again_leaves_what_made_the_rest(tmp_path):
    save(RESULT, tmp_path)
    save_part("strokes", {"speed": 0.2}, tmp_path)
    assert load("strokes", tmp_path) == replace(RESULT, values={"speed": 0.2})


@pytest.mark.parametrize(
    ("text", "error", "sentence"),
    [
        ("{", UnreadableFile, r"strokes\.json is damaged .*; restore it with git, or compute it again"),
        ("[]", UnreadableFile, "holds no result: it has no whole number named 'format'"),
        ('{"format": "1"}', UnreadableFile, "holds no result"),
        ('{"format": 1, "values": {}}', UnreadableFile, "holds no whole result"),
        ('{"format": 99}', IncompatibleRecord, "has format 99, which a newer version of suchus wrote; .* up to 1"),
    ],
)
def test_a_damaged_or_newer_file_is_refused_in_a_sentence(tmp_path, text, error, sentence):
    (tmp_path / "strokes.json").write_text(text)
    with pytest.raises(error, match=sentence):
        load("strokes", tmp_path)


def test_a_result_that_is_missing_is_named(tmp_path):
    with pytest.raises(UnreadableFile, match=r"there is no result named 'strokes': .* `make renew NAME=strokes`"):
        load("strokes", tmp_path)


@pytest.mark.parametrize("name", store.names())
def test_every_file_is_whole_and_on_the_list(name):
    kept = load(name)
    assert name in RESULTS
    assert kept.origin.version
    assert all(entry.holds(entry.value) for entry in kept.probe.values())
    assert json.loads(store.path_of(name).read_text(encoding="utf-8"))["format"] == store.FORMAT


def test_every_result_names_what_it_is_made_of():
    for kept in RESULTS.values():
        assert set(kept.sources) <= set(RESULTS), kept.name
        assert all(module.startswith(("suchus.", "evidence.")) for module in kept.modules), kept.name


@pytest.mark.parametrize("word", ["strokes", "turning strokes"])
def test_a_name_that_is_unknown_is_refused_before_anything_runs(word, capsys, monkeypatch):
    monkeypatch.setattr(renew, "store", lambda *_: pytest.fail("it ran"))
    assert renew.main(word.split()) == 2
    assert "There is no result named 'strokes'; choose among " in capsys.readouterr().err
