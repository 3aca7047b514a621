"""One place says the version and the ranges; whatever repeats them says the same."""

import re
import subprocess
import sys
import tomllib
from importlib.metadata import version
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.version import Version

import suchus

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def releases(changelog):
    """The versions of a changelog, the latest first, and what stands before the first."""
    return re.findall(r"^## (\d\S*) \(\d{4}-\d\d-\d\d\)$", changelog, re.M)


def test_the_latest_release_in_the_changelog_is_the_version():
    found = releases((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))
    assert found[0] == PROJECT["version"]
    assert found == sorted(found, key=Version, reverse=True)


def test_the_package_says_what_is_installed():
    assert suchus.__version__ == version("suchus")
    with pytest.raises(AttributeError, match="suchus has no '__versoin__'"):
        _ = suchus.__versoin__


def test_the_version_costs_no_start_up_time():
    code = "import sys, suchus; print('importlib.metadata' in sys.modules)"
    done = subprocess.run([sys.executable, "-I", "-S", "-c", f"import sys; sys.path[:0] = {sys.path!r}; {code}"],
                          capture_output=True, text=True, check=True)  # fmt: skip
    assert done.stdout.strip() == "False"


def test_every_tested_python_has_its_classifier():
    named = {text.rpartition(" ")[2] for text in PROJECT["classifiers"] if re.search(r":: 3\.\d+$", text)}
    lowest = PROJECT["requires-python"].removeprefix(">=")
    assert min(named, key=Version) == lowest


def test_constraints_lie_in_the_ranges():
    pinned = dict(
        line.split("==") for line in (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines() if "==" in line
    )
    for text in PROJECT["dependencies"]:
        need = Requirement(text)
        assert need.specifier.contains(pinned[{"jinja2": "Jinja2"}.get(need.name, need.name)]), need
