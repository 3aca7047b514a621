"""What broke once has a test, and the page names it."""

import ast
import json
import re
from pathlib import Path

import pytest

import batteries
import reliability
from pages.passages import put

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


CASES = {"cases": 100, "kinds": {"walks": 90, "runs": 10}, "failures": [{"case": 1}], "date": "2031-01-02"}


def test_the_page_counts_what_the_batteries_did():
    """Renew with ``make reliability``, or with ``python tools/reliability.py --table`` what is kept."""
    kept, cases = (json.loads(file.read_text("utf-8")) for file in (reliability.KEPT, reliability.CASES))
    assert put(PAGE, {"batteries": reliability.table(kept, cases)}) == PAGE
    assert {one["battery"] for one in kept.values()} <= reliability.BATTERIES.keys()
    files = {test.partition("::")[0] for test in kept}
    assert files <= {str(Path(file).relative_to(ROOT)) for file in reliability.tests()}


def test_a_battery_is_the_sum_of_its_tests_and_one_that_failed_is_told(tmp_path):
    kept = tmp_path / "batteries.json"
    batteries.keep("a.py::test_a", {"kills": 3}, failed=False, kept=kept)
    batteries.keep("a.py::test_b", {"kills": 4}, failed=True, kept=kept)
    batteries.keep("a.py::test_a", {"kills": 5}, failed=False, kept=kept)
    rows = [line.split(" | ") for line in reliability.table(json.loads(kept.read_text()), CASES).splitlines()]
    counts = {row[0].removeprefix("| "): row[2:4] for row in rows[2:]}
    assert counts["kills"] == ["9", "1"]
    assert counts["failed writes"] == ["0", "0"]
    assert counts["fuzzer"] == ["100", "1"]


def test_the_fixture_counts_only_where_it_is_asked_to(monkeypatch, tmp_path, request):
    kept = []
    monkeypatch.setattr(batteries, "keep", lambda test, numbers, failed: kept.append((numbers, failed)))
    for asked in ("", "write"):
        monkeypatch.setenv("SUCHUS_BATTERIES", asked)
        steps = batteries.counted.__wrapped__(request)
        count = next(steps)
        count("kills")
        count("kills", 2)
        assert next(steps, None) is None
    assert kept == [({"kills": 3}, False)]
