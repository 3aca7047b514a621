"""The table of experiments and bodies says what the command line says: an answer, or a sentence and exit code 2."""

import re
from dataclasses import replace

import pytest

import body_table as tool
from body_files import FILES, write_files
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot.design import lacking
from suchus.robot.robots import ROBOTS

REFUSED = [(row, name) for row in EXPERIMENTS for name in ROBOTS if lacking(ROBOTS[name], EXPERIMENTS[row].needs)]
FOUND = tool.store.load(tool.NAME).values


def test_the_page_holds_the_table_of_what_was_found():
    begin, end = tool.MARKS
    page = tool.PAGE.read_text()
    assert page.count(begin) == page.count(end) == 1
    assert page.split(begin)[1].split(end)[0] == tool.tables(FOUND)


def test_nothing_that_was_tried_failed_and_who_lacks_something_was_refused():
    assert [told for cells in FOUND.values() for told in cells.values() if told.startswith("exit ")] == []
    assert set(FOUND) <= {*EXPERIMENTS, *tool.TOOLS}
    for row, name in REFUSED:
        if name in FOUND.get(row, {}):
            assert f"{row} needs " in FOUND[row][name]
            assert tool.mark(FOUND[row][name]) == "refuses"
    for row, cells in FOUND.items():
        for name, told in cells.items():
            if row in EXPERIMENTS and told:
                assert re.search(rf"\b{name.removesuffix('.toml')}\b", told)


def test_a_cell_tells_answers_refusals_and_failures_apart():
    assert [tool.mark(told) for told in ("", "suchus: it needs limbs.", "exit 1: it diverged", None)] == [
        "answers",
        "refuses",
        "failed",
        "not tried",
    ]
    found = {"terrain": {"caiman": "", "swimmer": "suchus: no."}, "export": {"giant.toml": ""}}
    assert tool.table(found, ("caiman", "swimmer")).splitlines()[2:] == ["| `terrain` | answers | refuses |"]
    assert tool.table(found, ("snake.toml", "giant.toml")).splitlines()[2:] == [
        "| `suchus export` | not tried | answers |"
    ]


def test_cells_rows_and_columns_are_renewed_by_themselves(tmp_path, monkeypatch, capsys):
    page = tmp_path / "page.md"
    page.write_text("before\n" + "old\n".join(tool.MARKS) + "after\n")
    monkeypatch.setattr(tool.store, "RESULTS", tmp_path / "results")
    tool.store.save_part("bodies", {"turning": {"caiman": "exit 1: it fell", "swimmer": ""}, "view": {"caiman": "x"}})
    asked = []
    monkeypatch.setattr(tool, "PAGE", page)
    monkeypatch.setattr(tool, "tried", lambda row, body: asked.append((row, body)) or "")

    def tried_by(words):
        asked.clear()
        return tool.main(words.split()), sorted(asked)

    assert tried_by("--only turning --bodies caiman swimmer") == (1, [])
    assert tried_by("--only turning --bodies caiman eight.toml") == (1, [("turning", "eight.toml")])
    assert tried_by("--only turning --bodies caiman --anew") == (0, [("turning", "caiman")])
    assert tried_by("--table") == (0, [])
    _, column = tried_by("--bodies caiman --anew")
    assert {body for _, body in column} == {"caiman"}
    assert len(column) == len(EXPERIMENTS) + len(tool.TOOLS)
    assert tool.store.load("bodies").values["turning"] == {"caiman": "", "swimmer": "", "eight.toml": ""}
    assert page.read_text().startswith("before\n<!-- bodies")
    assert "old" not in page.read_text()
    with pytest.raises(SystemExit):
        tool.main(["--only", "turnings"])


def test_the_files_hold_what_they_are_called_and_a_name_and_its_file_are_one_robot(tmp_path):
    robots = {name: ROBOTS.resolve(path) for name, path in write_files(tmp_path).items()}
    assert tuple(robots) == FILES
    assert (round(robots["hatchling.toml"].length, 3), round(robots["hatchling.toml"].mass, 3)) == (0.3, 0.06)
    assert round(robots["giant.toml"].length, 3) == 3.0
    assert [len(robots[f"{name}.toml"].girdles) for name in ("eight", "rigid", "quadruped", "snake")] == [4, 3, 2, 0]
    assert [lacking(robots[f"{name}.toml"], ["axis"]) for name in ("rigid", "snake")] == [["axis"], []]
    assert robots["general.toml"] == replace(ROBOTS["caiman"], name="general")
    assert "[[axis]]" in (tmp_path / "general.toml").read_text()  # part by part, not by tables


def test_every_pair_that_cannot_be_is_refused_at_the_command_line_in_one_sentence(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for row, name in REFUSED:
        told = tool.tried(row, name)
        assert f"{row} needs " in told, (row, name, told)
        assert repr(name) in told
        assert told.count(". ") == 0
    assert not list(tmp_path.iterdir())


@pytest.mark.validate
@pytest.mark.parametrize("name", tool.BODIES)
@pytest.mark.parametrize("row", [*EXPERIMENTS, *tool.TOOLS])
def test_every_pair_answers_or_is_refused_in_a_sentence(row, name, tmp_path, monkeypatch):
    if (row, name) in REFUSED:
        return
    monkeypatch.chdir(tmp_path)
    assert not tool.tried(row, name).startswith("exit ")
