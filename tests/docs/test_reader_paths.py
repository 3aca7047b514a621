"""The start page has a path for each kind of reader: short, without dead ends, of commands that there are."""

import re
import shlex
from pathlib import Path

import pytest

from pages import gallery, links, reference
from suchus.apps.cli.entry import COMMANDS
from suchus.experiments.catalog import EXPERIMENTS
from suchus.robot.gaits import GAITS

ROOT = Path(__file__).parents[2]
READERS = ("Start", "Students", "Builders", "Biomechanists", "Learning", "Fluids", "Extending")
MOST = 10
MADE = {"questions.md", "verdicts.md", "paper_map.md", "misprints.md", "api/index.md", "examples/index.md"}
"""Pages that the site makes of the code."""


def paths(page):
    """The steps of each reader, by heading."""
    parts = re.split(r"^### (.+)\n", page, flags=re.M)
    return {
        title: re.findall(r"^(\d+)\. (.*?)(?=^\d+\. |\Z)", text, re.M | re.S)
        for title, text in zip(parts[1::2], parts[2::2], strict=True)
    }


def pages():
    """All pages of the site."""
    written = {path.relative_to(ROOT / "docs").as_posix() for path in (ROOT / "docs").rglob("*.md")}
    return written | MADE | set(reference.pages()) | set(gallery.pages())


def wrong_command(words):
    """What is wrong with a command, empty if nothing."""
    known = {command.name for command in COMMANDS}
    if words[1] not in known:
        return f"no command {words[1]}"
    if words[1] == "run" and words[2] not in EXPERIMENTS:
        return f"no experiment {words[2]}"
    if words[1] == "export-commands" and words[2] not in GAITS:
        return f"no gait {words[2]}"
    return ""


PAGE = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")


def test_each_kind_of_reader_has_a_path_of_at_most_ten_steps():
    found = paths(PAGE)
    assert tuple(found) == READERS
    for title, steps in found.items():
        assert [int(number) for number, _ in steps] == list(range(1, len(steps) + 1)), title
        assert 3 <= len(steps) <= MOST, title


@pytest.mark.parametrize("reader", READERS)
def test_every_step_leads_to_a_page_or_a_command_that_is_there(reader):
    there = pages()
    for _, step in paths(PAGE)[reader]:
        led = [link.partition("#")[0] for link in links.found(links.built(step))]
        commands = [shlex.split(text) for text in re.findall(r"`(suchus [^`]+)`", step)]
        assert led or commands or "`" in step, step
        assert [link for link in led if link not in there] == []
        assert [wrong for command in commands if (wrong := wrong_command(command))] == []


def test_a_dead_end_is_noticed():
    assert wrong_command(["suchus", "fly"]) == "no command fly"
    assert wrong_command(["suchus", "run", "flying"]) == "no experiment flying"
    assert wrong_command(["suchus", "export-commands", "flying"]) == "no gait flying"
    assert "own_wing.md" not in pages()
    assert len(paths("### Start\n\n1. one\n2. two\n   more\n")["Start"]) == 2


def test_every_page_to_follow_stands_among_the_extension_points():
    text = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")
    own = {path.name for path in (ROOT / "docs").glob("own_*.md")}
    assert own - set(re.findall(r"\]\((own_\w+\.md)", text)) == set()
    for point in ("robot", "gait", "experiment", "controller", "fault", "shape", "measure"):
        assert re.search(rf"^\| an? {point}", text, re.M), point
