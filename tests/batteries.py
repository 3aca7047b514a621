"""What the batteries of ``make test-all`` have done: failed writes, kills, flipped caches, imitated processors.

Each test that belongs to one says so with the mark ``battery`` and counts with the fixture ``counted``. Where
``SUCHUS_BATTERIES`` names a file the counts are kept there, of which ``tools/reliability.py`` makes the table of
docs/reliability.md. A test that fails before it counts anything is a failure all the same.
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
def counted(request: pytest.FixtureRequest) -> Iterator[Callable[[int], None]]:
    """Return a function that counts how many of the kind of the test's battery were done."""
    before, numbers = request.session.testsfailed, list[int]()

    def count(number: int = 1) -> None:
        numbers.append(number)

    yield count
    if kept := os.environ.get("SUCHUS_BATTERIES"):
        battery = request.node.get_closest_marker("battery").args[0]
        failed = request.session.testsfailed > before
        keep(request.node.nodeid, battery, sum(numbers), failed=failed, kept=Path(kept))


def keep(test: str, battery: str, number: int, *, failed: bool, kept: Path = KEPT) -> None:
    """Put what a test did into the file, in the place of what it did before."""
    every = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
    every[test] = {"battery": battery, "number": number, "failed": failed, "date": date.today().isoformat()}
    kept.write_text(json.dumps(dict(sorted(every.items())), indent=1) + "\n", encoding="utf-8")
