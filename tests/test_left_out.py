"""The list of the tests that ``make test`` leaves out says all of them, and nothing that is gone."""

import os
import sys
from pathlib import Path

import pytest

from left_out import COLLECTED, COMMANDS, WHY, command, file_of, is_enough, reason, rows, table

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "tests" / "README.md"
sys.path.insert(0, str(ROOT / "tools"))

from pages import passages  # noqa: E402


def test_the_list_says_what_is_left_out_why_and_what_runs_it(request):
    """Renew it with SUCHUS_LISTS=write and all tests collected: ``make sizes`` does."""
    items = request.config.stash[COLLECTED]
    found, files = rows(items), {item.nodeid.partition("::")[0].removeprefix("tests/") for item in items}
    if os.environ.get("SUCHUS_LISTS") == "write":
        PAGE.write_text(passages.put(PAGE.read_text(encoding="utf-8"), {"left_out": table(found)}), encoding="utf-8")
    listed = [row for row in PAGE.read_text(encoding="utf-8").splitlines() if row.startswith("| `")]
    assert [row for row in listed if file_of(row) in files] == found
    assert [row for row in listed if not (ROOT / "tests" / file_of(row)).exists()] == []


def test_every_reason_names_a_purpose_or_a_cost_of_more_than_ten_seconds(request):
    """No test is ``slow`` because of a small cost; a file of published numbers says no more than that."""
    slow = [item for item in request.config.stash[COLLECTED] if command(item) == COMMANDS["slow"]]
    assert {item.nodeid: reason(item) for item in slow if not is_enough(reason(item))} == {}


@pytest.mark.parametrize(
    ("said", "enough"),
    [
        ("more than ten seconds: two swims in space", True),
        ("a process is killed, and the study run twice", True),
        ("the second precision", True),
        ("two minutes of processor", False),
        ("a third body", False),
        ("a killer whale swims", False),
        ("", False),
    ],
)
def test_a_reason_is_enough_if_it_holds_whole_words_of_a_purpose(said, enough):
    assert is_enough(said) == enough


def test_make_leaves_out_what_has_the_marks_and_runs_it_where_the_list_says():
    recipes = (ROOT / "Makefile").read_text(encoding="utf-8")
    assert '-m "not validate and not slow"' in recipes.partition("\ntests:")[2].partition("\n\n")[0]
    for mark, words in COMMANDS.items():
        recipe = recipes.partition(f"\n{words.removeprefix('make ')}:")[2].partition("\n\n")[0]
        assert f"-m {mark}" in recipe, words
    whole = recipes.partition("\ntest-all:")[2].partition("\n\n")[0]
    assert 'SUCHUS_EXAMPLES=100 $(PY) -m pytest -n auto --dist worksteal -m "hypothesis and not validate' in whole


class Item:
    def __init__(self, nodeid, *marks):
        self.nodeid, self.marks = nodeid, marks

    def iter_markers(self, name=None):
        return (mark.mark for mark in self.marks if name in (None, mark.name))


def test_whole_functions_and_single_cases_are_told_apart():
    slow = pytest.mark.slow("a process is killed")
    items = [
        Item("tests/test_b.py::test_all", pytest.mark.validate),
        Item("tests/a/test_a.py::test_part[1]"),
        Item("tests/a/test_a.py::test_part[2]", slow),
        Item("tests/a/test_a.py::test_whole", slow),
        Item("tests/a/test_a.py::test_quick"),
    ]
    told = rows(items)
    assert told == [
        "| `a/test_a.py::test_part` (some cases) | a process is killed | `make test-all` |",
        "| `a/test_a.py::test_whole` | a process is killed | `make test-all` |",
        f"| `test_b.py` | {WHY} | `make validate` |",
    ]
    assert [file_of(row) for row in told] == ["a/test_a.py"] * 2 + ["test_b.py"]
