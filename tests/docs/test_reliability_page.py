"""What broke once has a test, and the page names it."""

import ast
import json
import os
import re
import subprocess
import sys
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
    files = reliability.KEPT, reliability.CASES, reliability.GUIDED
    kept, cases, ways = (json.loads(file.read_text("utf-8")) for file in files)
    assert put(PAGE, {"batteries": reliability.table(kept, cases), "guided": reliability.guided(ways)}) == PAGE
    assert {one["battery"] for one in kept.values()} <= reliability.BATTERIES.keys()
    files = {test.partition("::")[0] for test in kept}
    assert files <= {str(Path(file).relative_to(ROOT)) for file in reliability.tests()}


def test_a_battery_is_the_sum_of_its_tests_and_one_that_failed_is_told(tmp_path):
    kept = tmp_path / "batteries.json"
    batteries.keep("a.py::test_a", "kills", 3, failed=False, kept=kept)
    batteries.keep("a.py::test_b", "kills", 4, failed=True, kept=kept)
    batteries.keep("a.py::test_a", "kills", 5, failed=False, kept=kept)
    rows = [line.split(" | ") for line in reliability.table(json.loads(kept.read_text()), CASES).splitlines()]
    counts = {row[0].removeprefix("| "): row[2:4] for row in rows[2:]}
    assert counts["kills"] == ["9", "1"]
    assert counts["failed writes"] == ["0", "0"]
    assert counts["fuzzer"] == ["100", "1"]


COUNTING = """
import pytest
from batteries import counted

pytestmark = pytest.mark.battery("kills")

def test_three(counted):
    counted()
    counted(2)

def test_none(counted):
    assert not counted
"""


def test_the_fixture_counts_and_tells_who_failed_before_counting(tmp_path):
    file, kept = tmp_path / "test_counting.py", tmp_path / "kept.json"
    file.write_text(COUNTING)
    words = [sys.executable, "-m", "pytest", "-c", "/dev/null", "--rootdir", str(tmp_path), str(file)]
    own = {"PYTHONPATH": str(ROOT / "tests"), "SUCHUS_BATTERIES": str(kept), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    done = subprocess.run(words, env=os.environ | own, capture_output=True, text=True, check=False)
    assert "1 failed, 1 passed" in done.stdout
    found = {
        test.partition("::")[2]: (one["number"], one["failed"]) for test, one in json.loads(kept.read_text()).items()
    }
    assert found == {"test_three": (3, False), "test_none": (0, True)}


def test_a_whole_run_takes_the_place_of_what_was_kept_and_a_part_is_added(tmp_path, monkeypatch):
    kept, code = tmp_path / "batteries.json", [0]

    def run(words, env, **_):
        batteries.keep("b.py::test_b", "kills", 2, failed=bool(code[0]), kept=Path(env["SUCHUS_BATTERIES"]))
        return subprocess.CompletedProcess(words, code[0])

    monkeypatch.setattr(reliability, "KEPT", kept)
    monkeypatch.setattr(reliability, "write", lambda: None)
    monkeypatch.setattr(reliability.subprocess, "run", run)
    batteries.keep("a.py::test_a", "kills", 1, failed=False, kept=kept)
    assert reliability.main(["b.py"]) == 0
    assert list(json.loads(kept.read_text())) == ["a.py::test_a", "b.py::test_b"]
    code[0] = 1
    assert reliability.main([]) == 1
    assert list(json.loads(kept.read_text())) == ["b.py::test_b"]
    assert json.loads(kept.read_text())["b.py::test_b"]["failed"]
    code[0] = 2  # interrupted
    batteries.keep("a.py::test_a", "kills", 1, failed=False, kept=kept)
    assert reliability.main([]) == 2
    assert list(json.loads(kept.read_text())) == ["a.py::test_a", "b.py::test_b"]


def reached(lines):
    return {"lines": lines, "robots": 125, "date": "2031-01-02"}


@pytest.mark.parametrize(
    ("lines", "said"),
    [(109, "at most 1.09 times as many as blind ones, where 1.1 would be worth it: so the cases are drawn blindly"),
     (110, "at most 1.10 times as many as blind ones, where 1.1 would be worth it: so they should be guided")],
)  # fmt: skip
def test_what_guidance_is_worth_follows_from_what_was_reached(lines, said):
    ways = {"blind": {"250": reached(100)}, "atheris": {"250": reached(lines), "500": reached(300)}}
    text = reliability.guided(ways)
    assert said in text
    assert "| cases | blindly | atheris |" in text
    assert f"| 250 | 100 lines, 50% robots | {lines} lines, 50% robots |" in text
    assert "| 500 |  | 300 lines, 25% robots |" in text


def test_the_days_of_a_battery_are_told():
    kept = {
        f"{day}.py::test": {"battery": "kills", "number": 1, "failed": False, "date": f"2031-01-0{day}"}
        for day in (2, 1, 3)
    }
    assert "| 3 | 0 | 2031-01-01 to 2031-01-03 |" in reliability.table(kept, CASES)
    assert "| 0 | 0 | never |" in reliability.table(kept, CASES)
