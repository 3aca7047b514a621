"""Which tests ``make test`` leaves out, why, and what runs them: read from the marks of all that was collected."""

import re
from collections.abc import Iterable, Sequence

import pytest

COMMANDS = {"slow": "make test-all", "validate": "make validate"}
"""What runs the tests with a mark."""
WHY = "compared with published numbers, or a result that docs state made again"
"""Why a test has the mark ``validate``, which says no more."""
PURPOSES = (
    "killed", "die|dies", "stopped", "interrupted", "a signal", "a cluster", "a second run", "a second and a third run",
    "run twice", "run on twice", "compiled anew", "fresh environments", "browser", "the documentation is built",
    "the second precision", "every write that can fail", "imitated processors", "emulated processors",
    "more than ten seconds",
)  # fmt: skip
"""What the reason of a ``slow`` test names, as expressions of whole words: what it is for, or its great cost."""
COLLECTED = pytest.StashKey[tuple[pytest.Item, ...]]()
"""All tests that were collected, before any was deselected."""
_HEAD = "| test | why | what runs it |\n|---|---|---|\n"


def command(item: pytest.Item) -> str:
    """Return what runs a test that ``make test`` leaves out; empty for all others."""
    return next((COMMANDS[mark.name] for mark in item.iter_markers() if mark.name in COMMANDS), "")


def reason(item: pytest.Item) -> str:
    """Return why ``make test`` leaves a test out."""
    return next((mark.args[0] for mark in item.iter_markers("slow")), WHY)


def is_enough(said: str) -> bool:
    """Return whether a reason to be ``slow`` names a purpose or a great cost."""
    return re.search(rf"\b({'|'.join(PURPOSES)})\b", said) is not None


def rows(items: Iterable[pytest.Item]) -> list[str]:
    """Return a row of the table for each function of which cases are slow, and each file with published numbers."""
    functions: dict[str, list[pytest.Item]] = {}
    for item in items:
        functions.setdefault(item.nodeid.partition("[")[0].removeprefix("tests/"), []).append(item)
    told = set()
    for name, cases in functions.items():
        for case in cases:
            if runs := command(case):
                whole = all(command(other) == runs for other in cases)
                some = "" if whole else " (some cases)"
                what = f"{name}`{some}" if runs == COMMANDS["slow"] else f"{name.partition('::')[0]}`"
                told.add(f"| `{what} | {reason(case)} | `{runs}` |")
    return sorted(told)


def table(told: Sequence[str]) -> str:
    """Return rows as a table."""
    return _HEAD + "".join(f"{row}\n" for row in told)


def file_of(row: str) -> str:
    """Return the file that a row is about, from the folder of the tests."""
    return row.removeprefix("| `").partition("`")[0].partition("::")[0]
