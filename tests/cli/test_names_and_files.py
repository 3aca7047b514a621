"""A robot or a gait is its name, its file or itself, wherever one is asked for."""

from dataclasses import replace
from math import isclose
from pathlib import Path

import pytest

from suchus.apps.cli import main, view
from suchus.apps.cli.options import choose
from suchus.core.errors import UnknownName, UnreadableFile
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.optimise.spec import read_optimisation
from suchus.experiments.study.page import read_study
from suchus.robot import blueprint
from suchus.robot.gaits import GAITS, default_gait, gait_of
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run

STRIDER, TRIPOD = ROBOTS["strider"], GAITS["tripod"]
STUDY = """
name = "small"
measure = ["displacement"]
[[vary]]
field = "gait.period"
low = 1.0
high = 1.2
steps = 2
"""
SEARCH = """
name = "small"
[[vary]]
field = "gait.period"
low = 0.9
high = 5.0
[[aims]]
name = "displacement"
"""


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A folder with a robot and a gait in files."""
    monkeypatch.chdir(tmp_path)
    blueprint.write(replace(STRIDER, name="mine"), "mine.toml")
    blueprint.write(replace(TRIPOD, name="mine_walk", period=1.1), "mine_walk.toml")
    return tmp_path


def test_what_is_given_is_itself_a_name_or_a_file(here):
    mine = replace(STRIDER, name="mine")
    for given in (mine, "mine.toml", Path("mine.toml"), here / "mine.toml"):
        assert ROBOTS.resolve(given) == mine
    assert ROBOTS.resolve("mine.toml", here) == mine
    walk = replace(TRIPOD, name="mine_walk", period=1.1)
    for given in (walk, "mine_walk.toml", Path("mine_walk.toml")):
        assert gait_of(mine, given) == walk
        assert Run(robot="mine.toml", gait=given) == Run(robot=mine, gait=walk)
    assert gait_of(mine, None) == default_gait(mine) == TRIPOD
    with pytest.raises(UnknownName, match="no robot named 'mini'"):
        ROBOTS.resolve("mini")
    with pytest.raises(UnreadableFile, match=r"mini\.toml"):
        ROBOTS.resolve("mini.toml")


def test_a_name_on_the_shelf_goes_before_a_file_of_that_name(here):
    Path("caiman").write_text("no robot")
    assert ROBOTS.resolve("caiman").length == pytest.approx(1.01)


@pytest.mark.parametrize(("read", "text"), [(read_study, STUDY), (read_optimisation, SEARCH)])
def test_studies_and_searches_take_files_and_else_the_robots_own_gait(here, read, text):
    file = here / "work.toml"
    for robot in ("strider", "mine.toml"):
        file.write_text(f'robot = "{robot}"\n{text}')
        assert read(file).run.gait == TRIPOD
        assert read(file).run.robot == replace(STRIDER, name=robot.removesuffix(".toml"))
    file.write_text(f'robot = "mine.toml"\ngait = "mine_walk.toml"\n{text}')
    assert isclose(read(file).run.gait.period, 1.1)
    file.write_text(text)
    assert read(file).run.gait == GAITS["belly_crawl"]


def test_tasks_take_files(here):
    pytest.importorskip("gymnasium", reason="gymnasium is not installed: pip install suchus[gym]")
    from suchus.apps.envs.shelf import TASKS, resolve_task  # noqa: PLC0415

    task = resolve_task("Crawl", {"robot": "mine.toml", "gait": "mine_walk.toml"})
    assert task == TASKS["Crawl"].for_robot(
        replace(STRIDER, name="mine"), replace(TRIPOD, name="mine_walk", period=1.1)
    )
    assert resolve_task("Crawl", {"robot": Path("mine.toml")}).gait == TRIPOD


def test_the_viewer_takes_files(here, monkeypatch):
    pytest.importorskip("viser", reason="viser is not installed: pip install suchus[viewer]")
    shown = []
    monkeypatch.setattr(view, "_serve", lambda page, where, title, *_, **__: shown.append(title) or 0)
    assert main(["view", "mine.toml", "mine_walk.toml"]) == 0
    assert main(["view", "strider"]) == 0
    assert shown == ["mine, mine_walk", "strider, tripod"]


def test_an_experiment_answers_a_file_as_the_name(here):
    words = ["--quick", "--cycles", "2", "--robot"]
    named, read = (
        choose(EXPERIMENTS["gait_diagram"], "gait_diagram", [*words, robot]).experiment
        for robot in ("strider", "mine.toml")
    )
    assert (named.robot.name, read.robot.name) == ("strider", "mine")
    assert named.run().measures == read.run().measures
