"""A URDF or an MJCF is taken by ``--robot`` of any command, with its notes, or refused with the line to type."""

import json
import shutil
from importlib import import_module
from pathlib import Path

import pytest

import suchus
from suchus.apps.cli import main, options
from suchus.apps.cli.entry import COMMANDS
from suchus.core.errors import UnreadableFile
from suchus.robot.robots import ROBOTS

FILES = Path(__file__).parent.parent / "data" / "imports"


@pytest.fixture
def desk(tmp_path, monkeypatch):
    for name in ("walker.urdf", "fourleg.xml", "minnow.xml"):
        shutil.copy(FILES / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


WITH_ROBOT = {  # first words of each command that takes a robot
    "run": ["run", "gait_diagram"],
    "capture": ["capture", "tracks.csv"],
    "view": ["view"],
    "page": ["page"],
    "replay": ["replay", "record.nc"],
    "optimise": ["optimise", "crawl"],
    "train": ["train", "velocity"],
    "export": ["export"],
    "size": ["size"],
    "parts": ["parts"],
    "export-commands": ["export-commands", "belly_crawl"],
    "emulate": ["emulate"],
    "drive": ["drive", "belly_crawl"],
    "calibrate": ["calibrate", "zero"],
}
TAKES_ROBOT = {command.name: command for command in COMMANDS if "robot" in (command.first_word, *command.shelf_options)}


class ReadOptionsError(Exception):
    """Takes the options of a command out of it before its work begins."""


@pytest.fixture
def read_options(monkeypatch):
    """Return a function that reads a command line as its command does, and returns the options."""

    def parse(*args, **named):
        raise ReadOptionsError(true_parse(*args, **named))

    true_parse = options.parse
    modules = {command.function.partition(":")[0] for command in TAKES_ROBOT.values()} | {options.__name__}
    for module in map(import_module, modules):
        if hasattr(module, "parse"):
            monkeypatch.setattr(module, "parse", parse)

    def read(words):
        with pytest.raises(ReadOptionsError) as caught:
            main(words)
        return caught.value.args[0]

    return read


def test_every_command_that_takes_a_robot_is_tried():
    assert WITH_ROBOT.keys() == TAKES_ROBOT.keys()


@pytest.mark.parametrize("file", ["walker.urdf", "fourleg.xml"])
@pytest.mark.parametrize("name", WITH_ROBOT)
def test_every_command_takes_a_file_of_another_tool(name, file, desk, read_options):
    Path("tracks.csv").write_text("time [s],hip_x [mm],hip_y [mm]\n0,1,2\n")
    Path("record.nc").write_bytes(b"")
    ways = [["--robot", file], [f"--robot={file}"], ["--robot", f"./{file}"], ["--robot", str(desk / file)]]
    if TAKES_ROBOT[name].first_word == "robot":
        ways = [[file], *(ways if "robot" in TAKES_ROBOT[name].shelf_options and name != "emulate" else ())]
    for words in ways:
        settings = read_options([*WITH_ROBOT[name], *words])
        robot = settings.experiment.robot if name == "run" else settings.robot
        assert robot.name == Path(file).stem


@pytest.mark.parametrize("name", WITH_ROBOT)
def test_no_command_takes_a_file_that_is_none(name, desk, capsys):
    Path("tracks.csv").write_text("time [s],hip_x [mm],hip_y [mm]\n0,1,2\n")
    Path("record.nc").write_bytes(b"")
    Path("broken.urdf").write_text("<robot name='it'><link name='a'/></robot>")
    before = sorted(desk.rglob("*"))
    positional = TAKES_ROBOT[name].first_word == "robot"
    for file in ("none.urdf", "broken.urdf"):
        assert main([*WITH_ROBOT[name], *([file] if positional else ["--robot", file])]) == 2
        out, err = capsys.readouterr()
        assert (out, err.count("\n")) == ("", 1)
        assert file in err
    assert sorted(desk.rglob("*")) == before


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


@pytest.mark.parametrize("command", ["page", "parts", "size", "view"])
def test_a_robot_that_is_named_twice_is_refused(command, desk, capsys):
    before = sorted(desk.rglob("*"))
    for words in (["caiman", "--robot", "strider"], ["caiman", "--robot=strider"]):
        assert main([command, *words]) == 2
        assert "caiman and --robot strider both name the robot: give one of the two" in capsys.readouterr().err
    assert sorted(desk.rglob("*")) == before


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
