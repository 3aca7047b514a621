"""Every example of the how-to pages, put where the page says, goes through the whole battery of its shelf.

In a project, in the package itself, and in a package with entry points; nothing else is added or changed.
"""

import os
import re
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

import pytest

from pages.blocks import blocks
from suchus.core.sources import SHELVES

ROOT = Path(__file__).parents[2]
PAGES = ("own_robot", "own_experiment", "extending")
BATTERIES = {
    "robots": ("tests/shelves/test_robots.py",),
    "gaits": ("tests/shelves/test_gaits.py",),
    "faults": ("tests/faults/test_shelf.py",),
    "experiments": ("tests/shelves/test_experiments.py", "tests/shelves/test_every_rule.py"),
    "controllers": ("tests/shelves/test_controllers.py",),
    "measures": ("tests/shelves/test_measures.py",),
    "commands": ("tests/shelves/test_commands.py",),
    "protocols": ("tests/shelves/test_protocols.py",),
}
KINDS = {"robots": "robot", "gaits": "gait", "experiments": "experiment", "protocols": "protocol"}
LEAST = {
    "robots": 8, "gaits": 4, "faults": 8, "experiments": 12, "controllers": 3, "measures": 4, "commands": 5,
    "protocols": 7,
}  # fmt: skip
"""Tests of a battery in `make test` that name an entry, at least."""


def examples():
    """Return the modules that the pages put on shelves: shelf, name, text."""
    for page in PAGES:
        for block in blocks((ROOT / "docs" / f"{page}.md").read_text()):
            shelf, _, file = block.title.partition("/")
            if shelf in SHELVES and file.endswith(".py"):
                yield shelf, file.removesuffix(".py"), block.text


EXAMPLES = list(examples())
NAMES = {shelf: name for shelf, name, _ in EXAMPLES}


def test_each_shelf_has_an_example_on_its_page():
    assert sorted(shelf for shelf, _, _ in EXAMPLES) == sorted(BATTERIES)


@pytest.fixture
def failed_batteries(programs, tmp_path):
    """Return what runs the batteries of all shelves, each over the example of its shelf, in a process of its own."""

    def run(paths=(), left_out="not validate", **surroundings):
        """Return how many tests of each battery passed where they are fewer than it has; none may fail.

        Args:
            paths: where Python looks for modules first.
            left_out: which tests are run, by their marks.
            **surroundings: environment variables.
        """
        told = tmp_path / "told.xml"
        options = ["-n0", "-p", "no:cacheprovider", "--basetemp", tmp_path / "t", f"--junitxml={told}", "-m", left_out]
        chosen = " or ".join(f"[{name}] or [{name}-" for name in NAMES.values())
        plain = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST_")}
        path = os.pathsep.join([*map(str, paths), plain.get("PYTHONPATH", str(ROOT / "src"))])
        files = [file for battery in BATTERIES.values() for file in battery]
        done = programs.run(
            ["-m", "pytest", *options, *files, "-k", chosen],
            cwd=ROOT, environment={**plain, "PYTHONPATH": path, **surroundings},
        )  # fmt: skip
        assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-500:]
        passed = Counter(
            (case.get("classname"), re.split(r"[\]-]", case.get("name").partition("[")[2])[0])
            for case in ElementTree.parse(told).iter("testcase")
            if case.find("skipped") is None
        )
        counts = {shelf: sum(passed[_module(file), name] for file in BATTERIES[shelf]) for shelf, name in NAMES.items()}
        return {shelf: count for shelf, count in counts.items() if count < LEAST[shelf]}

    return run


def _module(file):
    """Return a file of a battery as the report of its tests names it."""
    return file.removesuffix(".py").replace("/", ".")


def test_in_a_project(failed_batteries, tmp_path):
    """All examples stand in one project, as a user's would; each goes through the battery of its own shelf."""
    lab = tmp_path / "lab"
    for shelf, name, text in EXAMPLES:
        (lab / shelf).mkdir(parents=True)
        (lab / shelf / f"{name}.py").write_text(text)
    (lab / "suchus.toml").write_text("")
    assert failed_batteries(left_out="not validate and not slow", SUCHUS_PROJECT=str(lab)) == {}


def test_in_the_package(failed_batteries, tmp_path):
    """All examples stand beside the package's own things, as if they were a part of it."""
    copy = tmp_path / "src/suchus"
    for file in (ROOT / "src/suchus").rglob("*"):
        if file.is_file() and "__pycache__" not in file.parts:
            there = copy / file.relative_to(ROOT / "src/suchus")
            there.parent.mkdir(parents=True, exist_ok=True)
            there.symlink_to(file)
    for shelf, name, text in EXAMPLES:
        package = copy / Path(*SHELVES[shelf].split(".")[1:])
        (package / f"{name}.py").write_text(text)
    assert failed_batteries([tmp_path / "src"], SUCHUS_GOLDEN=str(tmp_path / "golden")) == {}


def test_in_a_package_with_entry_points(failed_batteries, tmp_path):
    """All examples stand in one package of somebody else's, which names each of them."""
    site = tmp_path / "site"
    (site / "my_lab-1.0.dist-info").mkdir(parents=True)
    (site / "my_lab").mkdir()
    (site / "my_lab/__init__.py").write_text("")
    named = []
    for shelf, name, text in EXAMPLES:
        (site / "my_lab" / f"{name}.py").write_text(text)
        named.append(f"[suchus.{shelf}]\n{name} = my_lab.{name}:{_object(shelf, name, text)}\n")
    (site / "my_lab-1.0.dist-info/METADATA").write_text("Metadata-Version: 2.1\nName: my-lab\nVersion: 1.0\n")
    (site / "my_lab-1.0.dist-info/entry_points.txt").write_text("".join(named))
    assert failed_batteries([site], SUCHUS_GOLDEN=str(tmp_path / "golden")) == {}


def _object(shelf, name, text):
    """Return the name in the module of what an entry point names."""
    declared = [line.split(" = ")[1] for line in text.splitlines() if line.startswith(f"{shelf[:-1]} = ")]
    return declared[0] if declared[0].isidentifier() else KINDS.get(shelf, name)
