"""``suchus compare A B``: numbers with their difference, verdicts, figures and replays; bad input in one sentence."""

import json
from pathlib import Path

import pytest

from suchus.apps.cli import main
from suchus.apps.report import compare, load_result, render_comparison
from suchus.apps.report.result import content_hash
from suchus.apps.report.saving import describe
from suchus.core.errors import IncompatibleRecord
from suchus.experiments.catalog import EXPERIMENTS

SVG = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1 1"></svg>'


def verdict(word, claim="displacement_ratio"):
    return {"claim": claim, "quantity": f"quantity of {claim}", "statement": "s", "where": "IV.B", "printed": None,
            "measured": 1.0, "unit": "-", "verdict": word, "why": "because"}  # fmt: skip


def write(folder, measures, verdicts=(), settings=None, experiment="displacement", figures=(), replays=()):
    """An outcome as ``suchus run`` leaves it, with what matters here."""
    folder.mkdir(parents=True)
    for name in figures:
        (folder / f"{name}.svg").write_text(SVG)
    for name in replays:
        (folder / name).write_text("<p>it walks")
    told = {
        "experiment": experiment, "title": f"How is {experiment}?", "shows": "Fig. 16", "decides": "",
        "command": "suchus",
        "measures": {name: {"value": value, "unit": unit} for name, (value, unit) in measures.items()},
        "verdicts": list(verdicts), "settings": settings or {},
        "figures": [{"name": name, "caption": f"The {name}."} for name in figures], "tables": [],
        "replays": [{"name": name, "caption": "A walk."} for name in replays],
        "provenance": {"config_hash": "a", "seed": 0, "seconds": 1.0},
    }  # fmt: skip
    (folder / "outcome.json").write_text(json.dumps(told))
    return folder


def seal(folder, **altered):
    """Give an outcome the hash that suchus writes, and alter measures of it afterwards."""
    told = json.loads((folder / "outcome.json").read_text())
    told["provenance"]["content_hash"] = content_hash(told)
    for name, value in altered.items():
        told["measures"][name]["value"] = value
    (folder / "outcome.json").write_text(json.dumps(told))
    return folder


@pytest.fixture
def two(tmp_path):
    one = write(
        tmp_path / "a", {"far": (2.0, "m"), "same": (1.0, "-"), "gone": (3.0, "N"), "load": (0.0, "N")},
        [verdict("reproduced"), verdict("same sense", "tail_share")], {"robot": {"mass": 3.5}, "seed": 1},
        figures=("course", "parts"), replays=("walk.html",),
    )  # fmt: skip
    other = write(
        tmp_path / "b", {"far": (1.5, "m"), "same": (1.0, "-"), "load": (0.5, "N"), "none": (None, "m")},
        [verdict("contradicted"), verdict("same sense", "tail_share")], {"robot": {"mass": 4.0}, "seed": 1},
        figures=("course",), replays=("walk.html",),
    )  # fmt: skip
    return one, other


def test_measures_have_their_difference_and_those_that_differ_most_come_first(two):
    found = compare(load_result(two[0]), load_result(two[1]), ("a", "b"))
    told = {one.name: (one.difference, one.relative_difference) for one in found.measures}
    assert told == {"load": (0.5, None), "far": (-0.5, -0.25), "same": (0.0, 0.0), "gone": (None, None),
                    "none": (None, None)}  # fmt: skip
    assert [one.name for one in found.measures][:3] == ["load", "far", "same"]


def test_both_answers_and_the_numbers_that_carry_them_come_first(two, tmp_path, capsys):
    for folder, sentence in zip(two, ("It gets 2 m far. More.", "It gets 1.5 m far."), strict=True):
        file = folder / "outcome.json"
        told = json.loads(file.read_text()) | {"decides": f"{sentence} And why.", "answers": ["far", "gone"]}
        file.write_text(json.dumps(told))
    found = compare(load_result(two[0]), load_result(two[1]), ("a", "b"))
    assert [one.name for one in found.measures][:3] == ["far", "load", "same"]
    assert found.sentences == ("It gets 2 m far. More.", "It gets 1.5 m far. And why.")
    page = tmp_path / "page.html"
    assert main(["compare", str(two[0]), str(two[1]), "--out", str(page)]) == 0
    out = " ".join(capsys.readouterr().out.split())
    assert "A answers: It gets 2 m far. More. B answers: It gets 1.5 m far. And why." in out
    assert out.index("far 2") < out.index("load 0")
    assert "It gets 1.5 m far." in page.read_text()


def test_measures_that_only_one_outcome_has_are_folded_away(two, tmp_path):
    found = compare(load_result(two[0]), load_result(two[1]), ("a", "b"))
    assert [one.name for one in found.common_measures] == ["load", "far", "same"]
    assert [one.name for one in found.unmatched_measures] == ["gone", "none"]
    text = render_comparison(found, tmp_path)
    assert text.index("<code>same</code>") < text.index("2 measures without a number") < text.index("<code>gone</code>")
    same = compare(load_result(two[0]), load_result(two[0]), ("a", "a"))
    assert "without a number on both sides" not in render_comparison(same, tmp_path)


def test_no_difference_is_told_of_other_units(tmp_path):
    one, other = (
        write(tmp_path / "a", {"x": (1.0, "m"), "y": (1.0, "m")}),
        write(tmp_path / "b", {"x": (1.0, "N"), "y": (2.0, "m")}),
    )
    found = {one.name: one for one in compare(load_result(one), load_result(other), ("a", "b")).measures}
    assert (found["x"].difference, found["x"].unit) == (None, "m / N")
    assert found["y"].difference == 1.0


def test_verdicts_and_settings_that_differ_are_told(two):
    found = compare(load_result(two[0]), load_result(two[1]), ("a", "b"))
    assert [(one.first_verdict, one.second_verdict) for one in found.changed_verdicts] == [
        ("reproduced", "contradicted")
    ]
    assert len(found.verdicts) == 2
    assert [(one.name, one.first_value, one.second_value) for one in found.settings] == [("robot.mass", "3.5", "4.0")]


def test_the_page_shows_figures_and_replays_of_both(two, tmp_path):
    text = render_comparison(compare(load_result(two[0]), load_result(two[1]), ("a", "<b>")), tmp_path)
    assert text.count("<img ") == 3
    assert "B has no such figure" in text
    assert all(f'src="{name}/walk.html"' in text for name in "ab")
    assert "<b>" not in text


def test_the_command_prints_the_numbers_and_names_the_page(two, tmp_path, capsys):
    page = tmp_path / "page.html"
    assert main(["compare", str(two[0]), str(two[1] / "outcome.json"), "--out", str(page)]) == 0
    out = capsys.readouterr().out
    assert "−25 %" in out
    assert "contradicted" in out
    assert str(page) in out.replace("\n", "")
    assert page.is_file()


def test_in_eighty_columns_names_are_whole_and_the_largest_relative_difference_comes_first(
    tmp_path, monkeypatch, capsys
):
    monkeypatch.setenv("COLUMNS", "80")
    names = [f"tail_contact_spine_only_lifted_{end}" for end in ("change", "share")]
    sizes = {names[0]: 1.1, names[1]: -2.0, "roll_pp_limbs_only": 1.5}
    axis = [{"hinges": [{"range": [-0.39269908169872414, 0.1]}], "mass": 0.1}]
    for folder, change in (("a", 0.0), ("b", 1.0)):
        robot = {"axis": [{**axis[0], "mass": 0.1 + change}, {**axis[0], "mass": 0.2 + change}], "name": folder}
        settings = {"robot": robot, "pitch": 0.39269908169872414 + change, "band": [-0.39269908169872414, change]}
        measures = {name: (1.0 + change * (size - 1.0), "rad") for name, size in sizes.items()}
        write(tmp_path / folder, measures, settings=settings)
    assert main(["compare", str(tmp_path / "a"), str(tmp_path / "b"), "--out", str(tmp_path / "page.html")]) == 0
    lines = [line.rstrip() for line in capsys.readouterr().out.partition("figures and replays")[0].splitlines()]
    assert max(map(len, lines[2:])) <= 80
    shown = [line.split() for line in lines if line.split() and line.split()[0] in sizes]
    assert [(row[0], row[-2], row[-1]) for row in shown] == [
        (names[1], "−300", "%"),
        ("roll_pp_limbs_only", "50", "%"),
        (names[0], "10", "%"),
    ]
    assert any(line.split() == ["pitch", "0.3927", "1.393"] for line in lines)
    assert any("[-0.3927, 1.0]" in line for line in lines)
    assert any("robot.axis[]" in line and "2 of its settings differ" in line for line in lines)


def test_an_outcome_is_equal_to_itself(two, tmp_path, capsys):
    assert main(["compare", str(two[0]), str(two[0]), "--out", str(tmp_path / "page.html")]) == 0
    assert "None: both were made with the same settings" in (tmp_path / "page.html").read_text()


BAD = {
    "a": "see suchus compare --help",
    "a b c": "one word too many",
    "a nowhere": "nowhere is not there",
    "a empty": "outcome.json",
    "a text.txt": "text.txt is no outcome",
    "a broken": "broken",
    "a other": "a answers displacement and other answers swimming; compare two outcomes of one experiment",
    "a unlike": "no measure in common",
    "a altered": "altered/outcome.json was changed after suchus wrote it",
    "a b --out page.png": "page.png",
    "a b --out /dev/null/page.html": "cannot be written",
    "a b --outt page.html": "--outt",
}


@pytest.mark.parametrize("words", BAD)
def test_bad_words_are_one_sentence_and_leave_no_page(words, two, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("empty").mkdir()
    Path("text.txt").write_text("text")
    Path("broken").mkdir()
    Path("broken/outcome.json").write_text('{"measures": {}}')
    write(Path("other"), {"far": (1.0, "m")}, experiment="swimming")
    write(Path("unlike"), {"speed": (1.0, "m/s")})
    seal(write(Path("altered"), {"far": (1.0, "m")}), far=2.0)
    before = sorted(tmp_path.rglob("*"))
    assert main(["compare", *words.split()]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.count("\n") == 1
    assert BAD[words] in err
    assert sorted(tmp_path.rglob("*")) == before


def test_an_outcome_that_was_changed_after_it_was_written_is_refused(tmp_path):
    """Its numbers, or its question by another name; one as it was written, or of an older version, is taken."""
    plain, written = tmp_path / "plain", tmp_path / "written"
    write(plain, {"far": (1.0, "m")})
    seal(write(written, {"far": (1.5, "m")}))
    assert compare(load_result(plain), load_result(written), ("a", "b")).measures[0].difference == 0.5
    text = (written / "outcome.json").read_text()
    for old, new in (("1.5", "1.25"), ('"displacement"', '"turning"')):
        assert old in text
        (written / "outcome.json").write_text(text.replace(old, new))
        with pytest.raises(IncompatibleRecord, match="was changed after suchus wrote it"):
            compare(load_result(plain), load_result(written), ("a", "b"))


def test_what_is_written_carries_the_hash_of_its_contents():
    question = EXPERIMENTS["leg_kinematics"]
    told = json.loads(json.dumps(describe(question.run(), question, {}, "suchus run leg_kinematics")))
    assert told["provenance"]["content_hash"] == content_hash(told)
