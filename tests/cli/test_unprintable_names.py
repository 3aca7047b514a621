"""Names that steer a terminal are refused at every door, and files that nest too deeply in a sentence."""

from pathlib import Path

import pytest

from suchus.apps.cli import main
from suchus.core.errors import InvalidDesign, UnreadableFile
from suchus.core.printable import MAX_NESTING, check_content, name_complaint, unprintable
from suchus.core.reading import read_json, read_toml
from suchus.robot import blueprint
from suchus.robot.design import with_values
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS

ESCAPE, OVERRIDE = "\x1b[31m", "\u202e"
DEEP = ".".join("a" * 3000) + " = 1\n"
READERS = {
    "robot": ["run", "displacement", "--quick", "--robot", "FILE"],
    "gait": ["export", "--home", "FILE"],
    "study": ["study", "FILE"],
    "servo map": ["export-commands", "belly_crawl", "--map", "FILE"],
    "hardware": ["drive", "--hardware", "FILE"],
    "search": ["optimise", "FILE"],
}


def refused(words, capsys):
    assert main(words) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert ESCAPE not in err
    assert OVERRIDE not in err
    return err


@pytest.fixture
def desk(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("reader", READERS)
def test_a_deep_table_is_a_sentence_of_every_reader(reader, desk, capsys):
    Path("deep.toml").write_text(DEEP)
    err = refused([word.replace("FILE", "deep.toml") for word in READERS[reader]], capsys)
    assert f"nests tables or lists more than {MAX_NESTING} levels deep" in err
    assert [path.name for path in desk.iterdir()] == ["deep.toml"]


def test_nesting_is_counted_in_tables_and_lists(desk):
    for levels, fits in ((MAX_NESTING - 1, True), (MAX_NESTING + 5, False)):
        Path("it.json").write_text("[" * levels + "]" * levels)
        Path("it.toml").write_text(".".join("a" * levels) + " = 1\n")
        for read, name in ((read_json, "it.json"), (read_toml, "it.toml")):
            if fits:
                read(name)
            else:
                with pytest.raises(UnreadableFile, match="levels deep"):
                    read(name)


@pytest.mark.parametrize("bad", [ESCAPE, OVERRIDE, "\x00", "\u2028", "\x9b31m", "a\nb"], ids=repr)
def test_a_name_that_steers_a_terminal_is_none(bad, desk):
    assert name_complaint(f"it{bad}")
    for robot_field in ("name", "root"):
        with pytest.raises(InvalidDesign):
            with_values(ROBOTS["strider"], {robot_field: f"it{bad}"})
    with pytest.raises(InvalidDesign, match="steers a terminal"):
        with_values(ROBOTS["strider"], {"name": f"it{bad}"})
    with pytest.raises(InvalidDesign, match="steers a terminal"):
        with_values(GAITS["belly_crawl"], {"name": f"it{bad}"})


@pytest.mark.parametrize("good", ["it", "Käfer 2", "鱷魚", "a-b_c.d", "тритон", "e\u0301"])
def test_letters_of_any_language_are_a_name(good):
    assert name_complaint(good) is None
    assert unprintable(f"two lines\n{good}\t", allow_lines=True) is None
    assert with_values(ROBOTS["strider"], {"name": good}).name == good


@pytest.mark.parametrize("bad", [ESCAPE, OVERRIDE], ids=["control", "bidirectional"])
def test_every_door_refuses_it_and_prints_it_safely(bad, desk, capsys):
    text = blueprint.render(ROBOTS["strider"])
    escaped = bad.encode("unicode_escape").decode().replace("\\x", "\\u00")
    Path("it.toml").write_text(text.replace('name = "strider"', f'name = "{escaped}x"', 1))
    for words in (["export", "--robot", "it.toml", "--out", "o"], ["run", "gait_diagram", "--robot", "it.toml"]):
        assert "which steers a terminal" in refused(words, capsys)
    assert not Path("o").exists()
    for words in (["export", "--out", f"o{bad}"], ["import", f"{bad}.urdf"], ["view", bad]):
        assert "steers a terminal" in refused(words, capsys)
    Path("lab/robots").mkdir(parents=True)
    Path("lab/suchus.toml").touch()
    Path(f"lab/robots/{bad}.toml").write_text(text)
    assert "rename it" in refused(["list", "--project", "lab"], capsys)


def test_names_in_files_of_other_tools_are_refused(desk, capsys):
    walker = (Path(__file__).parent.parent / "data" / "imports" / "walker.urdf").read_text()
    Path("it.urdf").write_text(walker.replace("trunk", f"tr{OVERRIDE}unk"))
    assert "\\u202e" in refused(["import", "it.urdf"], capsys)
    assert [path.name for path in desk.iterdir()] == ["it.urdf"]


def test_content_is_checked_whatever_it_is():
    check_content("it", {"a": [1, 2.0, None, True, "text\n"]})
    for bad in ({"a": [ESCAPE]}, {OVERRIDE: 1}, [{"b": {"c": ESCAPE}}]):
        with pytest.raises(UnreadableFile, match="it holds the text"):
            check_content("it", bad)
        check_content("it", bad, check_texts=False)
