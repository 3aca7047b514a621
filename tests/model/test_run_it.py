"""Every line `run it: ...` that the program prints is a command that answers."""

import shlex
from pathlib import Path

import pytest
from hinge_trees import quadruped, skewed

import suchus
from suchus.animals.capture import Camera, SyntheticAnimal, film_animal, write_table
from suchus.apps.cli import main, run
from suchus.robot import blueprint
from suchus.robot.design.scale import rescale
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.model.export import export

LIZARD = SyntheticAnimal(
    trunk=0.12, tail=0.2, period=0.8, duty_factor=0.7, limb_phases=(0.0, 0.5, 0.25, 0.75), stride=0.15, outward=0.06,
    lift=0.02, spine_bend=0.5, spine_rightmost=0.2, tail_bend=0.7, tail_lag=1 / 3, tail_wave=0.0,
)  # fmt: skip
CAMERA = Camera(rate=100.0, noise=0.0, lost=0.0, heading=0.0, scale=None, heights=True, seed=0)
IMPORTS = Path(__file__).parent.parent / "data" / "imports"
ANGLES = Path(__file__).parent.parent / "data" / "animals" / "salamander_walking.csv"


def imported_quadruped():
    Path("dog.urdf").write_text(quadruped())
    return ["import", "dog.urdf", "--out", "my dog.toml"]


def imported_two_hinges():
    return ["import", str(IMPORTS / "fourleg.xml"), "--out", "fourleg.toml"]


def imported_fish():
    return ["import", str(IMPORTS / "minnow.xml"), "--out", "minnow.toml"]


def imported_without_walk():
    Path("it.xml").write_text(skewed().replace('range="-1.2 1.2"', 'range="-0.01 0.01"'))
    return ["import", "it.xml"]


def imported_strider():
    export(ROBOTS["strider"], GAITS["tripod"], Path("strider_urdf"), "urdf")
    return ["import", "strider_urdf/strider.urdf"]


def captured(*robot):
    write_table(film_animal(LIZARD, CAMERA, cycles=3), Path("tracks.csv"))
    return ["capture", "tracks.csv", "--out", "walk.toml", *robot]


def captured_on_a_file():
    blueprint.write(rescale(ROBOTS["caiman"], length_factor=0.5), "hatchling.toml")
    return captured("--robot", "hatchling.toml")


def played():
    return ["capture", str(ANGLES), "--robot", "salamander", "--out", "walk.toml"]


PRINTED = {
    "import of a quadruped": (imported_quadruped, "speed_range"),
    "import of limbs of two hinges": (imported_two_hinges, "speed_range"),
    "import of a body without limbs": (imported_fish, "floating"),
    "import of a body without a walk": (imported_without_walk, "floating"),
    "import of a body that bends": (imported_strider, "displacement"),
    "capture": (captured, "displacement"),
    "capture on a file": (captured_on_a_file, "displacement"),
    "capture of angles": (played, "salamander"),
}


def printed(words, capsys):
    """Run a command of suchus and return the words of the line to run that it prints."""
    assert main(words) == 0
    line = capsys.readouterr().out.strip().splitlines()[-1]
    assert line.startswith("run it: suchus ")
    return shlex.split(line.removeprefix("run it: suchus "))


@pytest.mark.parametrize("name", PRINTED)
def test_the_line_is_understood_and_its_robot_and_gait_are_taken(name, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    words, question = PRINTED[name]
    command = printed(words(), capsys)
    assert command[:2] == ["run", question]
    asked = []
    monkeypatch.setattr(run, "perform", lambda experiment, *_: asked.append(experiment))
    monkeypatch.setattr(run, "show_outcome", lambda *_: None)
    assert main([*command, "--quick"]) == 0
    if question == "floating":
        assert asked[0].robot.name == Path(command[-1]).stem
        return
    gaits = getattr(asked[0], "gaits", None) or (asked[0].gait,)
    assert [gait.name for gait in gaits] == [Path(command[-1]).stem]


@pytest.mark.parametrize("name", PRINTED)
def test_the_line_answers_with_a_sentence(name, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main([*printed(PRINTED[name][0](), capsys), "--quick", "--out", "out"]) == 0
    said = capsys.readouterr().out
    assert Path(said.split("the page with all of it: ")[1].strip()).is_file()


def test_no_other_line_is_printed():
    sources = Path(suchus.__file__).parent.rglob("*.py")
    assert [path.name for path in sources if '"run it: ' in path.read_text()] == ["run.py"]
