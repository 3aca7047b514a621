"""The ready-made search for the best legs of both groups takes any body whose feet follow paths."""

import pytest

from suchus.apps.cli import main
from suchus.core.errors import UnsuitedRobot
from suchus.experiments.catalog.displacement.experiment import Displacement
from suchus.experiments.optimise.ready import READY, crawl
from suchus.robot import blueprint
from suchus.robot.design import value_at
from suchus.robot.design.scale import rescale
from suchus.robot.gaits import default_gait
from suchus.robot.robots import ROBOTS

BODIES = ("salamander", "strider", "pleurobot", "long_tail")


@pytest.mark.parametrize("name", BODIES)
def test_it_starts_from_the_robots_own_gait_within_its_ranges(name):
    robot = ROBOTS[name]
    search = crawl(robot)
    assert search.run.robot == robot
    assert search.run.gait == default_gait(robot)
    ranges = {vary.field.removeprefix("gait."): (vary.low, vary.high) for vary in search.vary}
    assert {f"limbs[{i}].outward" for i in range(len(search.run.gait.limbs))} <= set(ranges)
    for field, (low, high) in ranges.items():
        assert low <= value_at(search.run.gait, field) <= high
    assert [arm.name for arm in search.arms] == ["coordinated", "limbs_only"]
    assert search.arms[1].values["gait.trunk_bend"] == 0.0


def test_the_articles_robot_has_its_own_search_and_a_hatchling_limits_of_its_size():
    assert crawl(ROBOTS["caiman"]) == READY["crawl"]()
    half = rescale(ROBOTS["caiman"], length_factor=0.5)
    limits = {limit.name: limit.value for limit in crawl(half).limits}
    article = {limit.name: limit.value for limit in crawl().limits}
    assert limits["sideways"] == pytest.approx(0.5 * article["sideways"])
    assert limits["torque"] == article["torque"]


@pytest.mark.parametrize("name", ["salamandra", "swimmer"])
def test_a_body_without_foot_paths_is_refused(name):
    with pytest.raises(UnsuitedRobot, match="the search crawl needs"):
        crawl(ROBOTS[name])


def test_the_command_searches_a_file_and_refuses_the_option_elsewhere(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    blueprint.write(rescale(ROBOTS["strider"], length_factor=0.5), "half.toml")
    assert main(["optimise", "crawl", "--robot", "half.toml", "--evaluations", "4"]) == 0
    assert "limbs_only: displacement" in capsys.readouterr().out
    assert main(["optimise", "turn", "--robot", "half.toml"]) == 2
    assert "--robot is for the search crawl or fault; turn is of the robot that it names" in capsys.readouterr().err


def test_displacement_names_the_search_in_its_second_sentence():
    names = {"caiman": "suchus optimise crawl finds.", "strider": "suchus optimise crawl --robot strider finds."}
    for name, ending in names.items():
        question = Displacement().quick().for_robot(ROBOTS[name])
        sentence = question.run().decides.split(". ")[1]
        assert sentence.startswith("Both groups have the same legs; each with its best legs is what")
        assert f"{sentence}.".endswith(ending)
