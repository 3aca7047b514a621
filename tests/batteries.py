"""What the batteries of ``make test-all`` have done: failed writes, kills, flipped caches, imitated processors.

Each test that belongs to one counts with the fixture ``counted``. With ``SUCHUS_BATTERIES=write`` the counts are kept
in ``batteries.json``, of which ``tools/reliability.py`` makes the table of docs/reliability.md.
"""

import json
import os
from collections.abc import Callable, Iterator
from datetime import date
from pathlib import Path

import pytest

KEPT = Path(__file__).with_name("batteries.json")
"""Of each test: its battery, how much it did of it, whether it failed, and when."""


@pytest.fixture
def counted(request: pytest.FixtureRequest) -> Iterator[Callable[[str, int], None]]:
    """Return a function that counts: the battery, and how many of its kind were done."""
    before, numbers = request.session.testsfailed, dict[str, int]()

    def count(battery: str, number: int = 1) -> None:
        numbers[battery] = numbers.get(battery, 0) + number

    yield count
    if os.environ.get("SUCHUS_BATTERIES") == "write":
        keep(request.node.nodeid, numbers, failed=request.session.testsfailed > before)


def keep(test: str, numbers: dict[str, int], *, failed: bool, kept: Path = KEPT) -> None:
    """Put what a test did into the file, in the place of what it did before."""
    every = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
    for battery, number in numbers.items():
        every[test] = {"battery": battery, "number": number, "failed": failed, "date": date.today().isoformat()}
    kept.write_text(json.dumps(dict(sorted(every.items())), indent=1) + "\n", encoding="utf-8")
