"""What a user wrote or mended by hand outlives every command, and what no file can hold is said before the work."""

import json
import os
import sys
from pathlib import Path

import pytest

from suchus.apps.cli import main
from suchus.apps.report.result import content_hash
from suchus.core.errors import InvalidDesign, UnreadableFile, Unwritable
from suchus.core.writing import write
from suchus.flow import checkpoint
from suchus.robot import blueprint
from suchus.robot.design import Robot
from suchus.robot.design.segment import Rod, Shell
from suchus.robot.robots import ROBOTS
from suchus.swimming.water.samples import Samples

sys.path.insert(0, str(Path(__file__).parents[1] / "model"))
from hinge_trees import quadruped


@pytest.fixture
def desk(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def own(path, words, capsys):
    """A command leaves a user's file alone; with --replace it leaves a backup."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("mine")
    assert main(words) == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert "--replace" in told
    assert path.read_text() == "mine"
    assert main([*words, "--replace"]) == 0
    capsys.readouterr()
    assert path.with_name(f"{path.name}.backup1").read_text() == "mine"
    assert path.read_text() != "mine"
    assert main(words) == 0  # it is suchus's own now
    capsys.readouterr()


def test_a_mended_robot_and_gait_and_a_calibrated_map_stay(desk, capsys):
    (desk / "it.urdf").write_text(quadruped())
    own(desk / "it.toml", ["import", "it.urdf"], capsys)
    own(desk / "it_walk.toml", ["import", "it.urdf"], capsys)
    own(desk / "map.toml", ["export-commands", "--write-map", "map.toml"], capsys)


@pytest.mark.usefixtures("fakes")
def test_notes_and_figures_in_a_folder_of_results_stay_and_pages_of_others_too(desk, capsys):
    assert main(["run", "wave"]) == 0
    notes = desk / "out" / "wave" / "notes.md"
    notes.write_text("mine")
    assert main(["run", "wave"]) == 0
    assert notes.read_text() == "mine"
    capsys.readouterr()
    (desk / "out" / "wave" / "wave.svg").write_text("touched up")
    assert main(["run", "wave"]) == 2
    assert "wave.svg was changed since suchus wrote it" in capsys.readouterr().err
    assert main(["run", "wave", "--replace"]) == 0
    assert (desk / "out" / "wave.backup1" / "wave.svg").read_text() == "touched up"
    assert (desk / "out" / "wave.backup1" / "notes.md").read_text() == "mine"
    own(desk / "compare.html", ["compare", "out/wave", "out/wave"], capsys)


def test_own_files_in_an_export_stay(desk, capsys):
    assert main(["export", "--format", "urdf", "--out", "it"]) == 0
    (desk / "it" / "mine.txt").write_text("mine")
    assert main(["export", "--format", "urdf", "--out", "it"]) == 0
    assert (desk / "it" / "mine.txt").read_text() == "mine"


@pytest.mark.usefixtures("fakes")
def test_a_name_that_is_no_text_is_refused_before_the_work(desk, capsys):
    assert main(["run", "wave", "--out", os.fsdecode(b"o\xff")]) == 2
    assert "UTF-8" in capsys.readouterr().err
    assert not list(desk.iterdir())


@pytest.mark.usefixtures("fakes")
def test_an_input_whose_name_is_no_text_is_refused_too(desk, capsys):
    """Captions, outcomes and pages name what they are of, and the command that made them."""
    blueprint.write(ROBOTS["caiman"], desk / "it.toml")
    (desk / "it.toml").rename(os.fsdecode(b"it\xff.toml"))
    for words in (["run", "wave", "--robot"], ["capture"], ["compare", "."]):
        assert main([*words, os.fsdecode(b"it\xff.toml")]) == 2
        told = capsys.readouterr().err
        assert "it\\udcff.toml' is no text in UTF-8" in told
        assert told.count("\n") == 1
    with pytest.raises(Unwritable, match=r"page\.html cannot be written: it would hold '.udcff'"):
        write(desk / "page.html", os.fsdecode(b"of it\xff"))
    assert not (desk / "page.html").exists()


@pytest.mark.usefixtures("fakes")
def test_compare_shows_no_codes_of_a_terminal(desk, capsys):
    for name in "ab":
        assert main(["run", "wave", "--out", name]) == 0
    for file in desk.glob("*/wave/outcome.json"):
        told = json.loads(file.read_text())
        told["measures"]["\x1b[2Jheight"] = told["measures"].pop("height")
        told["provenance"]["content_hash"] = content_hash(told)
        file.write_text(json.dumps(told))
    capsys.readouterr()
    assert main(["compare", "a/wave", "b/wave"]) == 0
    out = capsys.readouterr().out
    assert "\\x1b[2Jheight" in out
    assert "\x1b" not in out


def test_a_file_without_a_base_is_read_where_none_may_be_named(desk):
    file = blueprint.write(ROBOTS["strider"], desk / "mine.toml")
    assert blueprint.read_design(file, Robot | None, ROBOTS) == ROBOTS["strider"]


@pytest.mark.parametrize("odd", ["nan", "inf", "-inf"])
def test_a_shape_at_no_place_is_refused(desk, odd):
    file = blueprint.write(ROBOTS["strider"], desk / "mine.toml")
    before, start, after = file.read_text().partition("\nstart = [")
    file.write_text(f"{before}{start}{odd},{after.partition(',')[2]}")
    with pytest.raises((InvalidDesign, UnreadableFile), match="start"):
        blueprint.read_design(file, Robot, ROBOTS)
    place, number = (0.0, float(odd), 0.0), {"name": "x", "mass": 1.0}
    for kind, field, more in ((Rod, "end", {"start": (0, 0, 0), "radius": 1.0}), (Shell, "at", {"half": (1, 1, 1)})):
        with pytest.raises(InvalidDesign, match=field):
            kind(**number, **more, **{field: place})


def test_a_pipe_is_no_checkpoint(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(UnreadableFile, match="pipe"):
        checkpoint.load(None, tmp_path / "pipe")
    with pytest.raises(UnreadableFile, match="pipe"):
        Samples().load(tmp_path / "pipe", 0.0, "a swim")
