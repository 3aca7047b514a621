"""What broke once has a test, and the page names it."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "reliability.md").read_text(encoding="utf-8")
TABLE = PAGE.partition("## What broke once")[2].partition("\n## ")[0]
NAMED = re.compile(r"`(tests/[\w/]+\.py)`: ((?:`\w+`(?:, )?)+)")


def rows(table):
    """Return what broke, with the tests that are named beside it."""
    cells = [line.strip("|").split("|") for line in table.splitlines() if line.startswith("|")][2:]
    held = {what.strip(): NAMED.findall(tests) for what, tests in cells if not what.strip().startswith("**")}
    return {what: [(file, re.findall(r"\w+", names)) for file, names in found] for what, found in held.items()}


def lacking(table):
    """Return what has no test, and the tests that are named and not there."""
    missing = []
    for what, found in rows(table).items():
        if not found:
            missing.append(what)
        for file, names in found:
            there = ROOT / file
            tree = ast.parse(there.read_text(encoding="utf-8")) if there.is_file() else ast.Module([], [])
            defined = {node.name for node in tree.body if isinstance(node, ast.FunctionDef)}
            missing += [f"{file}::{name}" for name in names if name not in defined]
    return missing


def test_every_test_that_the_page_names_is_there():
    assert lacking(TABLE) == []
    assert len(rows(TABLE)) >= 30
    assert [f"{number}. " in TABLE for number in (1, 2, 3)] == [True] * 3


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("| a hang | |", "a hang"),
        ("| a hang | soon |", "a hang"),
        ("| a hang | `tests/fuzz/test_nothing.py`: `test_it` |", "tests/fuzz/test_nothing.py::test_it"),
        ("| a hang | `tests/fuzz/test_fuzz.py`: `test_it` |", "tests/fuzz/test_fuzz.py::test_it"),
    ],
)
def test_a_row_without_a_test_is_seen(row, said):
    assert lacking(f"| what | tests |\n|---|---|\n{row}\n") == [said]
