"""``suchus size`` and ``suchus parts`` from the command line."""

import csv
from dataclasses import replace
from math import inf, nan
from pathlib import Path

import pytest

from pages.blocks import blocks
from suchus.apps.cli import main
from suchus.apps.report.size_page import answer
from suchus.hardware import cases
from suchus.hardware.loads import ServoLoad
from suchus.hardware.sizing import Sizing
from suchus.robot.blueprint import read_design
from suchus.robot.design import Robot, layout
from suchus.robot.gaits import GAITS
from suchus.robot.motors import motors
from suchus.robot.robots import ROBOTS


@pytest.fixture(autouse=True)
def _here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("size caiman belly_crawl --fault limp", "--fault limp is no fault; say KIND:PART"),
        ("size caiman belly_crawl --fault limp:XX_yaw", "XX_yaw"),
        ("size caiman no_gait", "no_gait"),
        ("size strider --standing", "strider"),
        ("size caiman --slope 80", "size.slope is 80 degrees"),
        ("size caiman --motors none.toml", "none.toml"),
        ("size caiman belly_crawl --family nobodys", "there is no family of servos named 'nobodys'; there is"),
        ("parts no_robot", "no_robot"),
        ("parts caiman --no-outlines --wall 0", "parts.wall is 0 m"),
    ],
)
def test_what_makes_no_sense_is_refused_in_a_sentence_and_nothing_is_written(words, said, tmp_path, capsys):
    assert main(words.split()) == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "export").exists()


@pytest.mark.parametrize(
    ("warm", "said"),
    [
        ({}, None),
        ({"spine_yaw_1": (1380.0, 78.4)}, "spine_yaw_1 gets too warm: in spine_only it passes the 70 °C that are "
         "allowed after 23 min and would reach 78 °C"),
        ({"spine_yaw_1": (1380.0, 78.4), "LF_yaw": (60.0, inf)}, "2 servos get too warm, LF_yaw first: in spine_only "
         "it passes the 70 °C that are allowed after 1 min and would never stop warming"),
        ({"spine_yaw_1": (1380.0, 70.2)}, "spine_yaw_1 gets too warm: in spine_only it passes the 70 °C that are "
         "allowed after 23 min and would reach 70.2 °C"),
    ],
)  # fmt: skip
def test_a_servo_of_the_design_that_gets_too_warm_is_told_in_a_sentence(warm, said):
    robot = ROBOTS["caiman"]
    calm = ServoLoad(torque=1.0, limit=2.0, at_limit=0.0, first=nan, off=0.0, needed=1.0, steady=60.0, warm_after=inf)
    loads = {name: replace(calm, warm_after=after, steady=steady) for name, (after, steady) in warm.items()}
    own = {"spine_only": dict.fromkeys(layout(robot).servos, calm) | loads}
    sizing = Sizing(robot=robot, cases=cases(robot, (GAITS["spine_only"],)), designed_loads=own, families=())
    told = answer(sizing)[1:]
    assert told == ([] if said is None else [f"As it is designed, {said} if the movement went on for ever."])


def test_sizing_writes_the_servos_that_are_enough_and_a_robot_that_has_them(tmp_path, capsys):
    family = "Feetech STS 12 V"
    assert main(["size", "caiman", "belly_crawl", "--family", family]) == 0
    out, folder = capsys.readouterr().out, tmp_path / "export" / "caiman_size"
    page = (Path(__file__).parents[2] / "docs" / "build_one.md").read_text(encoding="utf-8")
    answers = [block.text for block in blocks(page) if block.language == "text"]
    assert answers[0] == out  # renew it by hand: it is what the page's first command prints
    assert family in out
    assert "EUR" in out
    with (folder / "families.csv").open() as file:
        assert [row["family"] for row in csv.DictReader(file)] == [family]
    with (folder / "servos.csv").open() as file:
        assert {row["servo"] for row in csv.DictReader(file)} == set(layout(ROBOTS["caiman"]).servos)
    assert "<h1>" in (folder / "size.html").read_text()
    built = read_design(folder / "robot.toml", Robot, ROBOTS)
    sold = {name for name, motor in motors().items() if motor.family == family}
    assert {built.servo(name).winding.motor for name in layout(built).servos} <= sold
    assert main(["size", "caiman", "belly_crawl", "--family", family]) == 0  # its own files may be written anew


def test_a_building_sheet_of_a_foreign_body_is_written_with_its_tables_and_what_ros_needs(tmp_path, capsys):
    assert main(["parts", "strider", "--no-outlines"]) == 0
    out = capsys.readouterr().out
    folder = tmp_path / "export" / "strider_parts"
    assert "suchus size chooses some" in out
    assert str(folder.relative_to(tmp_path)) in out
    assert not (folder / "outlines").exists()
    with (folder / "wiring.csv").open() as file:
        assert len(list(csv.DictReader(file))) == 20
    assert (folder / "ros2" / "strider.urdf").read_text().startswith("<?xml")
    assert "<h1>What is it built of?</h1>" in (folder / "index.html").read_text()
    assert 'id="cord-' not in (folder / "index.html").read_text()
