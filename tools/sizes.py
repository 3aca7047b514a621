"""Put the sizes of the wings, and the processor time of the tests, into CONTRIBUTING.md. ``make sizes`` calls it.

What a room is for is the first line of its docstring. The processor time is what the last ``make test`` from a fresh
clone printed; where there was none in this checkout, the passage keeps what it says.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from pages import code, passages

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "CONTRIBUTING.md"
SECONDS = ROOT / ".venv" / ".processor_seconds"
LIMIT = 900
"""Processor time that `make test` may take from a fresh clone [s]."""
BESIDE = {
    "tests": "Theorems about all of the wings; what runs where stands in its README.",
    "tools": "What makes pages, pictures and releases; not installed.",
    "evidence": "Kept results, what shows that they are current, and the programs that renew them; not installed.",
    "bench": "Speeds: of land, flow, studies and environments.",
    "examples": "Programs of a page that users begin with.",
}
"""Folders with Python beside the package."""


class Room(NamedTuple):
    """A room of the package, or a folder beside it."""

    name: str
    """Its folder or module in ``src/suchus``, or its folder in the checkout, with a stroke at its end."""
    files: int
    """Python files [-]."""
    lines: int
    """Lines in them [-]."""
    purpose: str
    """What it is for, a sentence."""


def rooms() -> Iterator[Room]:
    """Yield all wings of the package, and then the folders beside it."""
    for name in code.wings():
        yield _room(name, code.SOURCE / name, code.about(name))
    for name, purpose in BESIDE.items():
        yield _room(f"{name}/", ROOT / name, purpose)


def table(found: list[Room]) -> str:
    """Return the rooms as a table with the sum of the package."""
    package = [room for room in found if not room.name.endswith("/")]
    total = Room("**all wings**", sum(room.files for room in package), sum(room.lines for room in package), "")
    told = [*package, total, *found[len(package) :]]
    rows = [f"| {room.name} | {room.files} | {room.lines} | {room.purpose} |\n" for room in told]
    return "| wing | files | lines | what it is for |\n|---|---:|---:|---|\n" + "".join(rows)


def time_taken(seconds: int) -> str:
    """Return the processor time of ``make test`` as a sentence."""
    return (
        f"`make test` from a fresh clone took {seconds // 60} min {seconds % 60} s of processor time (user and system, "
        f"installation and compilation\nincluded); {LIMIT // 60} min are allowed.\n"
    )


def main() -> None:
    """Write the page."""
    texts = {"sizes": table(list(rooms()))}
    if SECONDS.exists():
        texts["processor_time"] = time_taken(int(SECONDS.read_text()))
    PAGE.write_text(passages.put(PAGE.read_text(encoding="utf-8"), texts), encoding="utf-8")


def _room(name: str, place: Path, purpose: str) -> Room:
    """Count the Python files of a folder, or a module alone."""
    files = list(place.rglob("*.py")) if place.is_dir() else [place.with_suffix(".py")]
    return Room(name, len(files), sum(len(file.read_bytes().splitlines()) for file in files), purpose)


if __name__ == "__main__":
    main()
