"""A URDF or an MJCF is taken by ``--robot`` of any command, with its notes, or refused with the line to type."""

import json
import shutil
from importlib import import_module
from pathlib import Path

import pytest

import suchus
from suchus.apps.cli import main, options
from suchus.apps.cli.entry import COMMANDS
from suchus.apps.cli.foreign_robot import resolve_robot
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
    names = {command.function.partition(":")[0] for command in TAKES_ROBOT.values()} | {options.__name__}
    modules = [import_module(name) for name in names]  # all before the first change, which a later import would keep
    for module in modules:
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


@pytest.mark.usefixtures("desk")
def test_what_was_guessed_for_a_refused_command_is_not_said_later(capsys):
    resolve_robot("walker.urdf")
    assert main(["optimise", "no_such_search.toml"]) == 2
    assert "note:" not in capsys.readouterr().err


@pytest.mark.parametrize("name", ["walker.urdf", "minnow.xml"])
def test_export_takes_it_and_says_once_what_was_guessed(name, desk, capsys):
    assert main(["export", "--robot", name, "--format", "urdf", "--out", "out"]) == 0
    told = capsys.readouterr()
    assert told.err.count("note: Front: along the file's x axis") == 1
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


NOT_READ = {  # files of other programs: what they hold, and what the sentence must say
    "dog.sdf": (b'<?xml version="1.0"?>\n<sdf version="1.6"><model name="dog"/></sdf>', "sdf2mjcf dog.sdf dog.xml"),
    "dog.world": (b"<sdf/>", "is an SDF"),
    "dog.urdf": (b"<!-- made by hand -->\n<sdf version='1.9'/>", "is an SDF"),
    "dog.urdf.xacro": (b"<robot><link name='a'/></robot>", "xacro dog.urdf.xacro > dog.urdf"),
    "dog.usda": (b"#usda 1.0", "scene in USD"),
    "dog.proto": (b"PROTO dog [] {}", "getUrdf()"),
    "dog.STL": (b"solid", "give the URDF or MJCF that names it"),
    "dog.step": (b"ISO-10303-21;", "export a URDF from that program"),
    "dog.zip": (b"PK\x03\x04\xff", "unpack it"),
    "dog.yaml": (b"name: dog", "a robot is a TOML, a URDF or an MJCF"),
}


@pytest.mark.parametrize("name", NOT_READ)
@pytest.mark.parametrize("words", [["import"], ["parts"]])
def test_what_is_not_read_is_named_with_its_remedy(words, name, tmp_path, monkeypatch, capsys):
    """An SDF was called invalid TOML, an archive no text in UTF-8."""
    monkeypatch.chdir(tmp_path)
    content, remedy = NOT_READ[name]
    Path(name).write_bytes(content)
    assert main([*words, name]) == 2
    told = capsys.readouterr().err
    assert remedy in told
    assert "TOML:" not in told
    assert "needs options" not in told
    assert told.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == [name]


def test_a_robot_by_another_ending_is_known_by_its_content(desk, capsys):
    shutil.copy("walker.urdf", "walker.txt")
    shutil.copy("fourleg.xml", "fourleg.model")
    Path("page.html").write_text("<!DOCTYPE html><html/>")
    for name, words in (
        ("walker.txt", "walker.txt is a URDF and no TOML: name it walker.urdf"),
        ("fourleg.model", "fourleg.model is an MJCF and no TOML: name it fourleg.xml"),
        ("page.html", "page.html is XML that begins with <html>"),
    ):
        assert main(["parts", name]) == 2
        assert words in capsys.readouterr().err


def test_our_own_robot_is_not_imported(desk, capsys):
    Path("mine.toml").write_text('base = "caiman"\n')
    assert main(["import", "mine.toml"]) == 2
    assert "mine.toml is a robot of suchus already: give it as --robot mine.toml" in capsys.readouterr().err


def test_a_file_that_no_option_mends_is_not_sent_to_the_options(desk, capsys):
    Path("broken.urdf").write_text("<robot><link/>")
    assert main(["parts", "broken.urdf"]) == 2
    told = capsys.readouterr().err
    assert "is no XML" in told
    assert "needs options" not in told


@pytest.mark.parametrize(("name", "experiment"), [("walker.urdf", "speed_range"), ("minnow.xml", "swim_free")])
def test_a_body_that_does_not_suit_is_referred_to_an_experiment_that_it_suits(name, experiment, desk, capsys):
    assert main(["run", "displacement", "--robot", name, "--quick"]) == 2
    assert f"or ask suchus run {experiment}, whose needs it meets" in capsys.readouterr().err
