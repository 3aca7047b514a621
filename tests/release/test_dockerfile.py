"""The Dockerfile without Docker: what it copies is there, and its steps do what they say."""

import fnmatch
import re
import sys
from pathlib import Path

import pytest

from release import dockerfile
from release.environment import Environment, Failed

ROOT = Path(__file__).parents[2]
STEPS = dockerfile.steps((ROOT / "Dockerfile").read_text(encoding="utf-8"))


def kept(name, ignore):
    """Whether a file of the checkout reaches the builder."""
    told = False
    for line in ignore.splitlines():
        if fnmatch.fnmatch(name, line.removeprefix("!")):
            told = not line.startswith("!")
    return not told


def test_everything_that_is_copied_is_there_and_is_sent():
    ignore = (ROOT / ".dockerignore").read_text(encoding="utf-8")
    names = dockerfile.copied(STEPS)
    assert len(names) == 6
    assert all((ROOT / name).exists() and kept(name, ignore) for name in names)
    assert not kept(".git", ignore)
    assert not kept("tools/pins.py", ignore)


def test_its_python_is_one_that_suchus_runs_on_and_named_by_its_digest():
    (image,) = [step.rest for step in STEPS if step.word == "FROM"]
    assert re.fullmatch(r"python:3\.1[1-9]-slim@sha256:[0-9a-f]{64}", image)


def test_it_begins_with_a_command_of_suchus_and_not_as_root():
    assert dockerfile.begins(STEPS) == ["suchus", "demo", "--no-browser"]
    (user,) = [step.rest for step in STEPS if step.word == "USER"]
    assert int(user) > 0


def test_lines_that_go_on_are_one_step_and_comments_none():
    text = '# a\nFROM x\n# b\nRUN one \\\n && two \\\n # c\n && three\nCMD ["a b", "c"]\n'
    assert [step.rest for step in dockerfile.steps(text)] == ["x", "one && two && three", '["a b", "c"]']
    with pytest.raises(ValueError, match="no instruction"):
        dockerfile.steps("FROM x\nrun y\n")


@pytest.fixture
def small(tmp_path):
    """A context with a command, and an environment whose folder has a space."""
    context = tmp_path / "a context"
    (context / "src").mkdir(parents=True)
    (context / "src" / "said.txt").write_text("said")
    environment = Environment(tmp_path / "an environment")
    environment.bin.mkdir(parents=True)
    (environment.bin / "python").symlink_to(sys.executable)
    return context, environment


def test_steps_are_done_in_their_folders_but_for_those_of_root(small, tmp_path):
    context, environment = small
    text = (
        "FROM x\nRUN apt-get update\nWORKDIR /source\nCOPY src src\nRUN cat src/said.txt > ../heard.txt\n"
        'WORKDIR /work\nENTRYPOINT ["cp", "../heard.txt"]\nCMD ["here.txt"]\n'
    )
    left = dockerfile.follow(dockerfile.steps(text), context, tmp_path / "root", environment)
    assert left == ["apt-get update"]
    assert (tmp_path / "root" / "work" / "here.txt").read_text() == "said"


def test_a_step_that_fails_is_told(small, tmp_path):
    context, environment = small
    with pytest.raises(Failed, match="ended with 3"):
        dockerfile.follow(dockerfile.steps("WORKDIR /w\nRUN exit 3\n"), context, tmp_path / "root", environment)
