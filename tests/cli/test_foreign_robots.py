"""A URDF or an MJCF is taken by ``--robot`` of any command, with its notes, or refused with the line to type."""

import json
import shutil
from pathlib import Path

import pytest

import suchus
from suchus.apps.cli import main
from suchus.core.errors import UnreadableFile
from suchus.robot.robots import ROBOTS

FILES = Path(__file__).parent.parent / "data" / "imports"


@pytest.fixture
def desk(tmp_path, monkeypatch):
    for name in ("walker.urdf", "fourleg.xml", "minnow.xml"):
        shutil.copy(FILES / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("name", ["walker.urdf", "minnow.xml"])
def test_export_takes_it_and_says_once_what_was_guessed(name, desk, capsys):
    assert main(["export", "--robot", name, "--format", "urdf", "--out", "out"]) == 0
    told = capsys.readouterr()
    assert told.err.count("note: Front: the file's x axis") == 1
    assert (desk / "out" / f"{Path(name).stem}.urdf").is_file()
    assert not (desk / "walker.toml").exists()


def test_an_experiment_answers_and_its_json_stays_clean(desk, capsys):
    words = ["run", "gait_diagram", "--robot", "walker.urdf", "--quick", "--json"]
    assert main(words) == 0
    told = capsys.readouterr()
    assert json.loads(told.out)
    assert told.err.count("note: Front:") == 1


def test_a_first_word_that_names_a_robot_may_be_such_a_file(desk, capsys):
    assert main(["parts", "walker.urdf", "--out", "sheet"]) == 0
    assert "note: Front:" in capsys.readouterr().err


def test_a_file_that_needs_options_is_refused_with_the_line(desk, capsys):
    text = (desk / "walker.urdf").read_text()
    mesh = '<mesh filename="package://dog/trunk.stl"/>'
    (desk / "dog.urdf").write_text(text.replace('<box size="0.34 0.12 0.05"/>', mesh))
    assert main(["run", "gait_diagram", "--robot", "dog.urdf", "--quick"]) == 2
    told = capsys.readouterr().err
    assert "suchus import dog.urdf --help names them; then say --robot dog.toml" in told
    assert told.count("\n") == 1
    assert main(["run", "gait_diagram", "--robot", "none.urdf", "--quick"]) == 2
    assert "none.urdf" in capsys.readouterr().err


def test_python_says_the_command(desk):
    with pytest.raises(
        UnreadableFile, match=r"import it first with: suchus import walker\.urdf; then give walker\.toml"
    ):
        ROBOTS.resolve("walker.urdf")
    with pytest.raises(UnreadableFile, match="suchus import"):
        suchus.crawl("fourleg.xml", "belly_crawl")
