"""Project folders and entry points: what the user's own files put on the shelves, in this process and in others."""

import importlib
import os
import pickle
import subprocess
import sys
from pathlib import Path

import pytest

import suchus
from suchus.apps.cli import main
from suchus.core import sources
from suchus.core.errors import AmbiguousName, BrokenFile, InvalidDesign, SuchusError, UnknownName, UnreadableFile
from suchus.core.jobs import processes
from suchus.experiments.study import MEASURES
from suchus.robot.blueprint import read_gait
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.faults import FAULTS, from_table

TIRED = '''"""A servo without its strength."""

from dataclasses import dataclass

from suchus.sim.fault import ServoFault


@dataclass(frozen=True, slots=True)
class Tired(ServoFault):
    """A servo without its strength."""

    joint: str
    at: float = 0.0


fault = Tired
'''
SHORT = 'base = "caiman"\n\n[hind_leg]\nfemur = 0.05\n'


@pytest.fixture(autouse=True)
def _no_project_stays(monkeypatch):
    monkeypatch.delenv(sources.VARIABLE, raising=False)
    monkeypatch.setattr(sources, "_AT_START", None)
    yield
    os.environ.pop(sources.VARIABLE, None)
    for name in [name for name in sys.modules if name in ("suchus.sim.faults.tired", "suchus.robot.robots.broken")]:
        del sys.modules[name]


@pytest.fixture
def lab(tmp_path):
    """A project with a fault, a robot as TOML, a gait, a measure, and a module that breaks."""
    for shelf in ("faults", "robots", "gaits", "measures"):
        (tmp_path / shelf).mkdir()
    (tmp_path / "suchus.toml").write_text("")
    (tmp_path / "faults/tired.py").write_text(TIRED)
    (tmp_path / "robots/short.toml").write_text(SHORT)
    (tmp_path / "gaits/slow_crawl.toml").write_text('base = "belly_crawl"\nperiod = 6.0\n')
    (tmp_path / "robots/broken.py").write_text('"""A robot."""\n\nrobot = None\nlength = 1 / 0\n')
    (tmp_path / "measures/rates.py").write_text(
        '"""Rates."""\n\n\ndef rate(record):\n    """Return how often [Hz]."""\n    return 1.0 / record.period\n\n\n'
        "measures = (rate,)\n"
    )
    return tmp_path


def test_the_shelves_hold_what_stands_in_the_project(lab):
    before = [*FAULTS]
    suchus.project(lab)
    assert [*FAULTS] == sorted([*before, "tired"])
    assert FAULTS["tired"].__module__ == "suchus.sim.faults.tired"
    assert from_table({"kind": "tired", "joint": "LF_yaw"}) == FAULTS["tired"]("LF_yaw")
    assert ROBOTS["short"].hind_leg.femur == 0.05
    assert ROBOTS["short"] is ROBOTS["short"]
    assert GAITS["slow_crawl"].period == 6.0
    assert MEASURES["rate"].__doc__ == "Return how often [Hz]."
    assert default_gait(ROBOTS["short"]) is GAITS["belly_crawl"]
    suchus.project(None)
    assert [*FAULTS] == before


def test_metres_of_a_gait_are_those_of_the_robot_that_its_base_is_made_for(lab):
    suchus.project(lab)
    (lab / "gaits/bent.toml").write_text('base = "belly_crawl"\ntrunk_bend = 0.5\nstroke = 0.02\n')
    assert GAITS["bent"] == read_gait(lab / "gaits/bent.toml", ROBOTS["caiman"], GAITS)
    (lab / "gaits/alone.toml").write_text((lab / "gaits/bent.toml").read_text().replace('base = "belly_crawl"\n', ""))
    with pytest.raises(BrokenFile, match="gives metres or places along the body, which are those of a robot"):
        GAITS["alone"]


def test_the_working_folder_is_the_project_where_it_has_the_file(lab, monkeypatch):
    assert "short" not in ROBOTS
    monkeypatch.chdir(lab)
    assert "short" in ROBOTS
    (lab / "suchus.toml").unlink()
    assert "short" not in ROBOTS
    monkeypatch.setenv(sources.VARIABLE, str(lab))  # a folder that is named needs no file
    assert "short" in ROBOTS
    monkeypatch.setenv(sources.VARIABLE, "")
    (lab / "suchus.toml").write_text("")
    assert "short" not in ROBOTS


def test_the_settings_name_files_beside_them(lab):
    (lab / "long.toml").write_text('base = "short"\n\n[tail]\njoints = 8\n')
    (lab / "suchus.toml").write_text('robots = ["long.toml"]\n')
    suchus.project(lab)
    assert ROBOTS["long"].tail.joints == 8
    assert ROBOTS["long"].hind_leg.femur == 0.05


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ('robot = ["a.toml"]', "has 'robot', which is not known; .* Did you mean 'robots'?"),
        ("robot = []\nx = 1\ngait = []", "has 'robot', 'x', 'gait', which are not known; .* mean 'robots', 'gaits'?"),
        ('robots = "a.toml"', "has robots = 'a.toml'; a list of files is needed"),
        ('robots = ["none.toml"]', "names 'none.toml' among robots; there is no such .py or .toml file"),
        ('faults = ["robots/short.toml"]', "there is no such .py file"),
        ('robots = ["../a.toml"]', "which is not in its folder"),
        ("robots = [", "is not valid TOML"),
    ],
)
def test_settings_that_cannot_be_are_refused_in_a_sentence(lab, settings, words):
    (lab / "suchus.toml").write_text(settings)
    with pytest.raises(UnreadableFile, match=words) as caught:
        suchus.project(lab)
    assert "\n" not in str(caught.value)


def test_a_folder_that_is_not_there_is_refused(lab):
    with pytest.raises(UnreadableFile, match=r"^there is no folder"):
        suchus.project(lab / "none")
    with pytest.raises(UnreadableFile, match=r"^there is no folder"):
        suchus.project("a\0b")


def test_what_is_broken_is_named_with_file_and_line_and_the_rest_works(lab, capsys):
    suchus.project(lab)
    (lab / "gaits/bad.toml").write_text('base = "belly_crawl"\nperiodd = 3.0\n')
    (lab / "faults/half.py").write_text("def (\n")
    with pytest.raises(
        BrokenFile, match=r"^robots/broken.py, line 4, cannot be loaded: ZeroDivisionError: division by z"
    ):
        ROBOTS["broken"]
    with pytest.raises(BrokenFile, match=r"^faults/half.py, line 1, cannot be loaded: SyntaxError: invalid syntax.$"):
        FAULTS["half"]
    with pytest.raises(BrokenFile, match=r"^gaits/bad.toml cannot be loaded: .*periodd is not known"):
        GAITS["bad"]
    assert {"broken"} == {*ROBOTS} - {name for name, _ in ROBOTS.items()}
    assert default_gait(ROBOTS["caiman"]) is GAITS["belly_crawl"]
    assert main(["list"]) == 0
    listed = " ".join(capsys.readouterr().out.split())
    assert "[broken: robots/broken.py, line 4, cannot be loaded: ZeroDivisionError" in listed
    assert "tired A servo without its strength. [faults/tired.py]" in listed
    assert main(["run", "gait_diagram", "--robot", "broken"]) == 2
    assert "line 4" in capsys.readouterr().err


def test_our_own_errors_in_a_file_of_the_user_are_told_with_its_line(lab):
    suchus.project(lab)
    (lab / "robots/broken.py").write_text(
        "from dataclasses import replace\n\nfrom suchus.robot.robots import caiman\n\n"
        "robot = replace(caiman.tables.tail, joints=0)\n"
    )
    with pytest.raises(BrokenFile, match=r"^robots/broken.py, line 5, cannot be loaded: tail.joints is 0"):
        ROBOTS["broken"]


@pytest.mark.parametrize(
    ("file", "text", "words"),
    [
        (
            "robots/caiman.toml",
            SHORT,
            r"there are two robots named 'caiman': suchus/robot/robots/caiman.py and robots/caiman.toml",
        ),
        ("robots/caiman.py", "", "there are two modules named 'caiman'"),
        ("robots/_plans.py", "", "there are two modules named '_plans'"),
        ("robots/short.py", "", "there are two robots named 'short'"),
        ("measures/progress.py", "", "there are two modules named 'progress'"),
    ],
)
def test_two_things_of_one_name_are_refused(lab, capsys, file, text, words):
    (lab / file).write_text(text)
    assert main(["list", "--project", str(lab)]) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    with pytest.raises(AmbiguousName, match=words):
        raise _raised(lab, file)


def _raised(lab, file):
    suchus.project(lab)
    shelf = {"robots": ROBOTS, "faults": FAULTS, "measures": MEASURES}[Path(file).parent.name]
    try:
        return list(shelf)
    except SuchusError as error:
        return error


def test_a_thing_has_the_name_of_its_file(lab):
    suchus.project(lab)
    (lab / "faults/weary.py").write_text(TIRED)
    (lab / "robots/named.toml").write_text('name = "another"\n' + SHORT)
    with pytest.raises(InvalidDesign, match=r"faults/weary.py declares the fault 'tired', .* 'weary'"):
        FAULTS["weary"]
    with pytest.raises(InvalidDesign, match="declares the robot 'another'"):
        ROBOTS["named"]


def test_a_file_that_starts_from_itself_is_refused(lab):
    suchus.project(lab)
    (lab / "robots/a.toml").write_text('base = "b"\n')
    (lab / "robots/b.toml").write_text('base = "a"\n')
    with pytest.raises(BrokenFile, match="starts from itself"):
        ROBOTS["a"]


def test_nothing_runs_until_its_name_is_asked_for(lab):
    (lab / "faults/loud.py").write_text("from pathlib import Path\n\nPath(__file__).with_name('ran').touch()\n")
    (lab / "elsewhere.py").write_text("raise RuntimeError\n")
    suchus.project(lab)
    assert "loud" in FAULTS
    assert list(GAITS)
    assert not (lab / "faults/ran").exists()
    with pytest.raises(InvalidDesign, match="must declare `fault`"):
        FAULTS["loud"]
    assert (lab / "faults/ran").exists()


def test_another_project_s_module_of_the_same_name_gives_way(lab, tmp_path_factory):
    other = tmp_path_factory.mktemp("other")
    (other / "faults").mkdir()
    (other / "faults/tired.py").write_text(TIRED.replace("at: float = 0.0", "at: float = 2.0"))
    suchus.project(lab)
    assert FAULTS["tired"]("LF_yaw").at == 0.0
    suchus.project(other)
    assert FAULTS["tired"]("LF_yaw").at == 2.0


def test_a_folder_may_stand_for_a_file(lab):
    (lab / "faults/tired.py").unlink()
    (lab / "faults/tired").mkdir()
    (lab / "faults/tired/__init__.py").write_text('"""A folder."""\n')
    (lab / "faults/tired/numbers.py").write_text("AT = 3.0\n")
    (lab / "faults/tired/fault.py").write_text(
        TIRED.replace("at: float = 0.0", "at: float = AT").replace("\n\n@", "\nfrom .numbers import AT\n\n\n@", 1)
    )
    suchus.project(lab)
    try:
        assert FAULTS["tired"]("LF_yaw").at == 3.0
    finally:
        for name in [name for name in sys.modules if name.startswith("suchus.sim.faults.tired")]:
            del sys.modules[name]


def part_of(item, tell):
    """What a process of its own finds."""
    del tell
    return item.part, "tired" in FAULTS


def test_worker_processes_see_the_same_project(lab):
    suchus.project(lab)
    heard = list(processes.side_by_side(part_of, [FAULTS["tired"]("LF_knee")], 1))
    assert heard[-1] == (0, processes.PieceResult(("LF_knee", True)))


def test_what_is_sent_elsewhere_takes_its_project_along(lab):
    suchus.project(lab)
    sent = pickle.dumps(sources.ProjectPickle(FAULTS["tired"]("LF_yaw")))
    plain = {name: value for name, value in os.environ.items() if name != sources.VARIABLE}
    code = "import pickle, sys; print(pickle.loads(bytes.fromhex(sys.argv[1])))"
    command = [sys.executable, "-c", code, sent.hex()]
    done = subprocess.run(command, env=plain, capture_output=True, text=True, check=False, cwd=lab.parent)
    assert done.stdout == "Tired(joint='LF_yaw', at=0.0)\n", done.stderr[-500:]


def test_what_makes_the_bytes_includes_the_project(lab):
    from suchus.core.jobs.made_by import source_versions  # noqa: PLC0415

    without = source_versions()
    assert "project" not in without
    suchus.project(lab)
    first = source_versions()
    assert {name: value for name, value in first.items() if name != "project"} == without
    (lab / "faults/tired.py").write_text(TIRED + "\n")
    assert source_versions()["project"] != first["project"]


def test_a_package_puts_things_on_the_shelves_by_entry_points(tmp_path, monkeypatch):
    """In a process of its own, since the entry points of all packages are read once."""
    site = tmp_path / "site"
    (site / "my_lab-1.0.dist-info").mkdir(parents=True)
    (site / "my_lab").mkdir()
    (site / "my_lab/__init__.py").write_text("")
    (site / "my_lab/tired.py").write_text(TIRED)
    (site / "my_lab/bad.py").write_text("\n\nraise OSError('no disk')\n")
    (site / "my_lab-1.0.dist-info/METADATA").write_text("Metadata-Version: 2.1\nName: my-lab\nVersion: 1.0\n")
    (site / "my_lab-1.0.dist-info/entry_points.txt").write_text(
        "[suchus.faults]\ntired = my_lab.tired:Tired\n[suchus.gaits]\nbad = my_lab.bad:gait\n"
        "[suchus.robots]\nwhole = my_lab.tired\n"
    )
    code = (
        "from suchus import FAULTS, GAITS, ROBOTS, SuchusError\n"
        "print(FAULTS['tired']('LF_yaw'), *FAULTS)\n"
        "for shelf, name in ((GAITS, 'bad'), (ROBOTS, 'whole')):\n"
        "    try:\n"
        "        shelf[name]\n"
        "    except SuchusError as error:\n"
        "        print(error)\n"
        "print(len(list(GAITS.values())) == len(GAITS) - 1)\n"
    )
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(site), os.environ.get("PYTHONPATH", "")]))
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    said = done.stdout.splitlines()
    faults = "backlash deaf delayed frozen limp locked lost_foot offset slow tired weak"
    assert said[0] == f"Tired(joint='LF_yaw', at=0.0) {faults}"
    assert said[1] == f"{site / 'my_lab/bad.py'}, line 3, cannot be loaded: OSError: no disk."
    assert said[2].startswith("the entry point whole = 'my_lab.tired' of my-lab must declare `robot`")
    assert said[3] == "True"


@pytest.mark.parametrize(
    "words", [["list", "--project"], ["list", "--project="], ["list", "--project=a", "--project=b"]]
)
def test_the_option_needs_one_folder(words, capsys):
    assert main(words) == 2
    assert "--project needs one folder" in capsys.readouterr().err


def test_the_option_holds_for_its_command_only(lab, capsys):
    assert main(["list", "--project", str(lab)]) == 0
    assert "short" in capsys.readouterr().out
    assert sources.VARIABLE not in os.environ
    with pytest.raises(UnknownName):
        ROBOTS["short"]


def test_modules_of_the_project_can_import_each_other(lab):
    suchus.project(lab)
    assert importlib.import_module("suchus.sim.faults.tired").fault is FAULTS["tired"]
