"""Files of impossible robots at the command line: one sentence with the remedy, exit code 2, nothing written."""

import re
from dataclasses import replace

import pytest

from suchus.apps.cli import main
from suchus.robot import blueprint
from suchus.robot.robots import ROBOTS

BODY = blueprint.render(replace(ROBOTS["caiman"]))  # part by part: a replaced robot is none of the tables
STRIDER = blueprint.render(ROBOTS["strider"])


def changed(text, pattern, to):
    """Return a file with the first line that a pattern finds replaced."""
    new, count = re.subn(pattern, to, text, count=1, flags=re.MULTILINE)
    assert count == 1
    return new


def short_limbs():
    """Return the strider with limbs a tenth as long."""
    return re.sub(r"^end = \[0\.0, 0\.(\d+), 0\.0\]", r"end = [0.0, 0.00\1, 0.0]", STRIDER, flags=re.MULTILINE)


def two_drives():
    """Return a body with a servo at the first hinge of the tail, which the cable bends already."""
    head, hinge, tail = BODY.partition('[[axis.hinges]]\nname = "tail_yaw_1"')
    servo = re.search(r"\[cables\.servo\]\n((?:\w+ = .*\n)+)", BODY)
    drive = tail.index("[axis.hinges.drive]")
    after = re.sub(r"\A\[axis\.hinges\.drive\]\n(?:\w+ = .*\n)+", f"[axis.hinges.drive]\n{servo[1]}", tail[drive:])
    return head + hinge + tail[:drive] + after


BAD = {
    "parts that do not join": (
        changed(STRIDER, r"^at = -0\.0999\S*", "at = 2.0"),
        "the parts do not join; move it there",
    ),
    "a girdle on nothing": (changed(STRIDER, '^segment = "front"', 'segment = "chest"'), "no segment of the axis"),
    "a limb that cannot reach the ground": (short_limbs(), "cannot reach the ground"),
    "a cable with a gap": (
        changed(BODY, r'^hinges = \["tail_yaw_1", "tail_yaw_2", ', 'hinges = ["tail_yaw_1", '),
        "which do not follow each other",
    ),
    "two drives": (two_drives(), "hinge tail_yaw_1 has two drives, cable tail_cable and a servo of its own"),
    "a mass of a mountain": (changed(STRIDER, r"^mass = 0\.69\S*", "mass = 1e9"), "kg; 1e-08 to 100000 kg is allowed"),
    "a length of an atom": (changed(STRIDER, r"^radius = 0\.035", "radius = 1e-10"), "radius is 1e-10 m; "),
    "a length of a street": ('base = "caiman"\n[hind_leg]\nfemur = 90\n', "femur is 90 m; 0.0001 to 10 m is allowed"),
    "no mass": ('base = "caiman"\n[head]\nmass = 0.0\n', "head.mass is 0 kg; "),
    "a field in another part": (
        'base = "caiman"\n[tail]\nfoot_friction = 0.5\n',
        "tail.foot_friction is not known there; it stands at contact.foot_friction: move it",
    ),
    "a field of two parts": (
        'base = "caiman"\nfemur = 0.1\n',
        "femur is not known there; it stands at hind_leg.femur and front_leg.femur: move it",
    ),
    "a field nearly right": ('base = "caiman"\n[tail]\njoint = 5\n', "(did you mean tail.joints?)"),
}
GAITS_OF_OTHERS = {
    "four legs for six": (
        ["--robot", "strider", "--gait", "belly_crawl"],
        "has phases for 4 limbs; robot 'strider' has 6",
    ),
    "six legs for four": (
        ["--robot", "salamander", "--gait", "tripod"],
        "has phases for 6 limbs; robot 'salamander' has 4",
    ),
    "paths for cranks": (
        ["--robot", "salamandra", "--gait", "salamander_walk"],
        "limbs LF and RF of robot 'salamandra' are cranks: choose a gait",
    ),
    "legs for none": (["--robot", "swimmer", "--gait", "belly_crawl"], "swimmer"),
}


@pytest.fixture
def desk(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def refused(words, says, capsys):
    assert main(words) == 2
    out, err = capsys.readouterr()
    assert says in err
    assert (out, err.count("\n")) == ("", 1)
    assert len(err) < 1000


@pytest.mark.parametrize("command", [["run", "displacement", "--quick"], ["export"]], ids=["run", "export"])
@pytest.mark.parametrize("name", BAD)
def test_a_robot_that_cannot_be_is_one_sentence_and_nothing_is_written(name, command, desk, capsys):
    text, says = BAD[name]
    (desk / "mine.toml").write_text(text)
    refused([*command, "--robot", "mine.toml"], says, capsys)
    assert [path.name for path in desk.iterdir()] == ["mine.toml"]


@pytest.mark.parametrize("name", GAITS_OF_OTHERS)
def test_a_gait_for_other_limbs_is_one_sentence_and_nothing_is_written(name, desk, capsys):
    words, says = GAITS_OF_OTHERS[name]
    refused(["run", "displacement", "--quick", *words], says, capsys)
    assert not list(desk.iterdir())


@pytest.mark.parametrize("text", [BODY, STRIDER], ids=["caiman", "strider"])
def test_the_same_files_unchanged_are_taken(text, desk):
    (desk / "mine.toml").write_text(text)
    assert main(["export", "--robot", "mine.toml", "--out", "there"]) == 0
    assert (desk / "there" / "scene.xml").is_file()
