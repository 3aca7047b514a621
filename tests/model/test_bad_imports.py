"""What `suchus import` cannot take ends in one sentence and exit code 2, with nothing written."""

import os
import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hinge_trees import joint, link, pendulum, quadruped, shape, skewed, urdf

from suchus.apps.cli import main
from suchus.robot import blueprint
from suchus.robot.design import Robot, layout
from suchus.robot.gaits import GAITS
from suchus.robot.motion.movement import cycle_targets
from suchus.robot.robots import ROBOTS

BALL = shape('<sphere radius="0.02"/>')
ARM = joint("ab", "a", "b", (0.1, 0.0, 0.0), "0 0 1")
MESH = '<visual><geometry><mesh filename="package://it/meshes/x.dae"/></geometry></visual>'
BODY = '<body name="b" pos="0.1 0 0"><joint name="ab" axis="0 0 1"/><geom size="0.02"/></body>'


def zigzag():
    before, name, after = pendulum().partition('<joint name="hinge_2"')
    return before + name + after.replace("-0.2 0.0 0.0", "-0.2 0.07 0.0", 1)


def mjcf(inner="", beside=""):
    return f'<mujoco><worldbody><body name="a"><geom size="0.02"/>{BODY}{inner}</body></worldbody>{beside}</mujoco>'


BOMB = '<!ENTITY a "aaaaaaaaaa">' + "".join(f'<!ENTITY {b} "{10 * f"&{a};"}">' for a, b in pairwise("abcdefghi"))
BAD = {
    "no file": (None, "there is no file"),
    "empty": ("", "is no XML"),
    "no XML": ("solid cube\n", "is no XML"),
    "cut off": (quadruped()[:-300], "is no XML"),
    "other XML": ("<html><body/></html>", "it begins with <html>"),
    "sdf": ('<sdf version="1.7"><model/></sdf>', "is an SDF, which is not read"),
    "xacro": ('<robot xmlns:xacro="x"><xacro:leg/></robot>', "expand it first"),
    "bomb": (f"<!DOCTYPE r [{BOMB}]><robot name='&i;'/>", "declares a document type"),
    "external entity": (
        '<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><robot name="&x;"/>', "declares a document type"
    ),
    "nested": ("<robot>" + "<a>" * 1_000_000 + "</a>" * 1_000_000 + "</robot>", "nests more than 200"),
    "many": ("<robot>" + "<a/>" * 300_000 + "</robot>", "more than 200000 elements"),
    "large": ("<robot>" + " " * 17 * 2**20 + "</robot>", "larger than 16 MiB"),
    "no links": ("<robot/>", "no <link>"),
    "no bodies": ("<mujoco/>", "no <body>"),
    "prismatic": (urdf(link("a"), link("b"), ARM.replace("revolute", "prismatic")), "joint 'ab' is prismatic"),
    "odd joint": (urdf(link("a"), link("b"), ARM.replace("revolute", "screw")), "of type 'screw'"),
    "slide": (mjcf().replace('axis="0 0 1"', 'type="slide" axis="0 0 1"'), "joint 'ab' slides"),
    "ball": (mjcf().replace('axis="0 0 1"', 'type="ball"'), "is a ball joint"),
    "two parents": (
        urdf(link("a"), link("b"), link("c"), ARM, joint("ac", "a", "c", (0, 0, 0), "0 0 1"),
             joint("cb", "c", "b", (0, 0, 0), "0 0 1")),
        "link 'b' hangs on 2 joints, which makes a loop",
    ),
    "carries itself": (
        urdf(link("r"), link("a"), link("b"), ARM, joint("ba", "b", "a", (0, 0, 0), "0 0 1")), "a loop of joints"
    ),
    "closed": (mjcf(beside='<equality><connect body1="a" body2="b" anchor="0 0 0"/></equality>'), "closes a loop"),
    "missing link": (urdf(link("a"), ARM), "names link 'b', which is not there"),
    "two roots": (urdf(link("a"), link("b"), link("c"), ARM), "2 links hang on no joint"),
    "meshes only": (
        urdf(link("a", 0, MESH), link("b", 0, MESH), ARM),
        "the shape of link a and of 1 more is a mesh that was not read: package://it/meshes/x.dae is in none of the",
    ),
    "no masses": (urdf(link("a", 0), link("b", 0), ARM), "no <inertial> and no shape that is read"),
    "lost mesh": (mjcf().replace('<geom size="0.02"/>', '<geom type="mesh" mesh="it"/>').replace(
        "<worldbody>", '<asset><mesh name="it" file="it.stl"/></asset><worldbody>'
    ), "the shape of body a and of 1 more is a mesh that was not read: there is no file it.stl"),
    "floats on": (
        urdf(link("r"), link("a"), link("b"), joint("ra", "r", "a", (0, 0, 0), "0 0 1"),
             ARM.replace("revolute", "floating")),
        "A floating joint may carry the whole robot, and nothing else",
    ),
    "feather": (urdf(link("a", 1e-8, BALL), link("b", 1e-8, BALL), ARM), "1e-06 to 100000 kg is allowed"),
    "mountain": (urdf(link("a", 1e9, BALL), link("b", 1.0, BALL), ARM), "1e-06 to 100000 kg is allowed"),
    "negative": (urdf(link("a", -1.0, BALL), link("b", 1.0, BALL), ARM), "<mass value='-1.0'> is not allowed"),
    "nan": (urdf(link("a", "nan", BALL), link("b", 1.0, BALL), ARM), "<mass value='nan'> is not allowed"),
    "no number": (urdf(link("a", "heavy", BALL), link("b", 1.0, BALL), ARM), "holds 'heavy', which is no number"),
    "far away": (urdf(link("a"), link("b"), ARM.replace("0.1", "inf")), "finite numbers are needed"),
    "stiff": (re.sub(r'range="[-.0-9]+ [.0-9]+"', 'range="-0.01 0.01"', skewed()), "nothing is left that could move"),
    "no plane": (zigzag(), "no vertical plane mirrors its hinges"),
    "light geom": (mjcf().replace('geom size', 'geom mass="-1" size'), "<geom mass='-1'> is not allowed"),
    "odd effort": (urdf(link("a"), link("b"), ARM.replace('"30.0"', '"strong"')), "is no number"),
    "giant": (urdf(link("a", 1.0, BALL), link("b", 1.0, shape('<sphere radius="900"/>')), ARM), "100 m is allowed"),
    "no hinge": (urdf(link("a"), link("b"), ARM.replace("revolute", "fixed")), "it has no hinge"),
    "lopsided": (
        quadruped(legs={"FL": (1, 1), "RR": (-1, -1)}), "FL_hip, RR_hip have no mirror image"
    ),
    "skew": (pendulum(axis="1 0 1.1"), "42 degrees off the robot's axes"),
    "replicated": (mjcf(inner=f'<replicate count="1000000" offset="0 0 1">{BODY}</replicate>'), "makes bodies with"),
    "composite": (mjcf(inner='<composite type="cable" count="9 1 1"/>'), "makes bodies with <composite>"),
    "outside": (mjcf(beside='<include file="../secret.xml"/>'), "lies outside its folder"),
    "absolute": (mjcf(beside='<include file="/etc/passwd"/>'), "lies outside its folder"),
    "itself": (mjcf(beside='<include file="robot.xml"/>'), "includes 'robot.xml' twice"),
    "folder": (mjcf(beside='<include file="."/>'), "is a folder"),
    "too many": (urdf(*(link(f"l{i}") for i in range(1500)),
                      *(joint(f"j{i}", f"l{i}", f"l{i + 1}", (-0.1, 0, 0), "0 0 1") for i in range(1499))),
                 "1000 bodies"),
}  # fmt: skip


@pytest.fixture
def desk(tmp_path, monkeypatch):
    desk = tmp_path / "desk"
    desk.mkdir()
    monkeypatch.chdir(desk)
    (tmp_path / "secret.xml").write_text("<mujocoinclude/>")
    return desk


def refused(capsys, words, says, left):
    assert main(["import", *words]) == 2
    out, err = capsys.readouterr()
    assert says in err
    assert (err.count("\n"), len(err) < 1000, out) == (1, True, "")
    assert {path.name for path in Path().iterdir()} == left


@pytest.mark.parametrize("name", BAD)
def test_a_bad_file_is_one_sentence_and_nothing_is_written(name, desk, capsys):
    text, says = BAD[name]
    if text is not None:
        Path("robot.xml").write_text(text)
    refused(capsys, ["robot.xml", "--out", "mine.toml"], says, {"robot.xml"} if text is not None else set())


def test_what_is_no_file_is_not_waited_for(desk, capsys):
    os.mkfifo("pipe.urdf")
    refused(capsys, ["pipe.urdf"], "is a pipe", {"pipe.urdf"})
    refused(capsys, [".", "--out", "x.toml"], "is a folder", {"pipe.urdf"})
    Path("latin.urdf").write_bytes(b"<robot name='\xff'/>")
    refused(capsys, ["latin.urdf"], "not a text file in UTF-8", {"pipe.urdf", "latin.urdf"})
    Path("link.urdf").symlink_to("/etc/hostname")
    refused(capsys, ["link.urdf"], "is no XML", {"pipe.urdf", "latin.urdf", "link.urdf"})


def test_a_link_out_of_the_folder_is_not_followed(desk, capsys):
    Path("out.xml").symlink_to(desk.parent / "secret.xml")
    Path("robot.xml").write_text(mjcf(beside='<include file="out.xml"/>'))
    refused(capsys, ["robot.xml"], "lies outside its folder", {"out.xml", "robot.xml"})


def test_words_that_make_no_sense(desk, capsys):
    Path("it.urdf").write_text(quadruped())
    for words, says in (
        (["--out", "it.json"], ".toml file"),
        (["--front", "nose"], "no body named 'nose'"),
        (["--neck", "FL_hip"], "no body in the mirror plane named 'FL_hip'"),
        (["--leave", "nose"], "no body named 'nose'"),
        (["--leave", "base"], "which carries everything"),
        (["--heading", "20"], "no vertical plane"),
        (["--heading", "nan"], "-360 to 360 degree is allowed"),
        (["--foot-radius", "-1"], "is allowed"),
        (["--foot"], "--foot"),
    ):
        refused(capsys, ["it.urdf", *words], says, {"it.urdf"})


def test_the_command_writes_a_robot_and_a_gait_that_load(desk, capsys):
    Path("quad.urdf").write_text(quadruped())
    assert main(["import", "quad.urdf"]) == 0
    out = capsys.readouterr().out
    assert "limbs LF, RF on base: pitch, roll, roll" in out
    assert "note: Front:" in out
    assert sorted(path.name for path in Path().glob("[!.]*")) == ["quad.toml", "quad.urdf", "quad_walk.toml"]
    robot = blueprint.read_design(Path("quad.toml"), Robot, ROBOTS)
    assert (robot.name, len(robot.girdles)) == ("quad", 2)
    assert blueprint.read_gait(Path("quad_walk.toml"), robot, GAITS).period > 0
    assert Path("quad.toml").read_text().startswith("# A draft that suchus read from quad.urdf.")


def test_a_robot_whose_walk_is_not_found_is_written_all_the_same(desk, capsys):
    Path("it.xml").write_text(skewed().replace('range="-1.2 1.2"', 'range="-0.01 0.01"'))
    assert main(["import", "it.xml"]) == 0
    assert "note: no walk was found" in capsys.readouterr().out
    assert {path.name for path in Path().glob("[!.]*")} == {"it.xml", "it.toml"}


def test_an_include_of_its_own_folder_is_read(desk):
    Path("part.xml").write_text(f"<mujocoinclude>{BODY}</mujocoinclude>")
    Path("it.xml").write_text(mjcf().replace(BODY, '<include file="part.xml"/>'))
    assert main(["import", "it.xml"]) == 0
    assert [s.name for s in blueprint.read_design(Path("it.toml"), Robot, ROBOTS).axis] == ["b", "a"]


def test_files_that_include_each_other_in_a_chain_are_a_sentence(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    deep, count = 150, 30
    for i in range(count):
        inner = f'<include file="{i + 1}.xml"/>' if i < count - 1 else ""
        Path(f"{i}.xml").write_text(f"<mujoco>{'<worldbody>' * deep}{inner}{'</worldbody>' * deep}</mujoco>")
    assert main(["import", "0.xml"]) == 2
    told = capsys.readouterr().err
    assert "nest more than 200 elements" in told
    assert told.count("\n") == 1


def test_a_leg_with_a_joint_that_nothing_powers_is_imported_and_walks(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    before, knee, after = quadruped().partition('<joint name="FL_knee"')
    Path("one.urdf").write_text(before + knee + after.replace('effort="30.0"', 'effort="0.0"', 1))
    assert main(["import", "one.urdf"]) == 0
    assert "gait: one_walk.toml" in capsys.readouterr().out
    robot = blueprint.read_design(Path("one.toml"), Robot, ROBOTS)
    gait = blueprint.read_gait(Path("one_walk.toml"), robot, GAITS)
    targets = cycle_targets(robot, gait, np.linspace(0.0, 1.0, 9))
    assert targets.shape == (9, len(layout(robot).servos))
    assert np.ptp(targets, axis=0).max() > 0.05
