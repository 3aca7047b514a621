"""The page docs/robots_from_files.md can be followed literally."""

import re
from pathlib import Path

import pytest

from suchus.apps.cli import main
from suchus.apps.cli.options import choose
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS

PAGE = (Path(__file__).parents[2] / "docs" / "robots_from_files.md").read_text()


def blocks(language):
    fenced = (block.partition("\n") for block in PAGE.split("```")[1::2])
    return [text for first, _, text in fenced if first.partition(" ")[0] == language]


def titled(name):
    """Return the text of the block with a file's name as its title."""
    return PAGE.partition(f'```toml title="{name}"\n')[2].partition("```")[0]


@pytest.fixture
def desk(tmp_path, monkeypatch):
    """A folder with the two files of the page."""
    monkeypatch.chdir(tmp_path)
    for name in ("my_robot.toml", "my_gait.toml"):
        Path(name).write_text(titled(name))


@pytest.mark.usefixtures("desk")
def test_the_commands_of_the_page_choose_its_robot_and_gait():
    lines = (line.partition("#")[0].strip() for block in blocks("sh") for line in block.splitlines())
    commands = {
        line for line in lines if line.startswith("suchus run") and line.endswith(("my_robot.toml", "my_gait.toml"))
    }
    assert len(commands) == 2
    for _, _, name, *words in map(str.split, commands):
        question = choose(EXPERIMENTS[name], name, words).experiment
        if "--robot" in words:
            assert question.robot.name == "my_robot"
            assert question.robot.tail.joints == 8
            assert question.robot.front_leg == ROBOTS["caiman"].front_leg
        else:
            assert (question.gait.name, question.gait.period) == ("my_gait", 3.0)
            assert question.gait.limbs == GAITS["belly_crawl"].limbs


@pytest.mark.usefixtures("desk")
def test_the_python_of_the_page_runs(capsys):
    exec("\n".join(blocks("python")), {})
    assert re.fullmatch(r"\d\.\d\d m, \d\.\d\d kg\nTrue\n", capsys.readouterr().out)
    assert Path("caiman.toml").is_file()


@pytest.mark.usefixtures("desk", "fakes")
def test_the_mistakes_of_the_page_are_told_in_its_words(capsys):
    Path("my_robot.toml").write_text('base = "caiman"\n[hind_leg]\nfemurr = 1\ntibia = -0.1\n')
    assert main(["run", "wave", "--robot", "my_robot.toml"]) == 2
    assert capsys.readouterr().err in PAGE


def test_the_import_of_the_page_prints_what_it_says(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    section = PAGE.partition("## From URDF or MJCF")[2]
    commands, said = (block.partition("\n")[2] for block in section.split("```")[1:4:2])
    words = [line.split()[1:] for line in commands.splitlines()]
    assert [one[0] for one in words] == ["export", "import"]
    assert main(words[0]) == 0
    capsys.readouterr()
    assert main(words[1]) == 0
    assert capsys.readouterr().out == said
    options = [f"`{word}" for word in ("--front", "--heading", "--neck", "--leave", "--foot-radius")]
    assert all(option in section for option in options)
