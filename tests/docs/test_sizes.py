"""The table of sizes in CONTRIBUTING.md names every room and says what it is for; ``make sizes`` renews its numbers."""

import re

from sizes import BESIDE, LIMIT, PAGE, ROOT, Room, rooms, table, time_taken


def test_every_room_stands_in_the_table_with_what_it_is_for():
    text, found = PAGE.read_text(encoding="utf-8"), list(rooms())
    listed = re.findall(r"^\| ([\w/]+) \| \d+ \| \d+ \| (.*) \|$", text, re.M)
    assert listed == [(room.name, room.purpose) for room in found]
    assert all(len(room.purpose) > 10 for room in found)


def test_every_folder_with_python_is_a_room_or_stands_beside_them():
    beside = {path.parent.name for path in ROOT.glob("*/*.py")} | {path.parts[-3] for path in ROOT.glob("*/*/*.py")}
    assert {name for name in beside if not name.startswith(".")} - {"src", "build", "docs"} <= {*BESIDE}
    package = ROOT / "src" / "suchus"
    inside = {path.relative_to(package).parts[0] for path in package.rglob("*.py")}
    named = {room.name for room in rooms() if not room.name.endswith("/")}
    assert {name.removesuffix(".py") for name in inside} - {"__init__", "__main__"} == named


def test_the_sum_is_that_of_the_rooms():
    told = table([Room("a", 2, 30, "A."), Room("b", 1, 5, "B."), Room("tests/", 9, 900, "T.")])
    assert "| **all wings** | 3 | 35 |  |\n| tests/ | 9 | 900 | T. |" in told


def test_the_processor_time_is_said_beside_what_is_allowed():
    assert "took 8 min 5 s of processor time" in time_taken(485)
    assert LIMIT == 900
    assert f"{LIMIT // 60} min are allowed" in PAGE.read_text(encoding="utf-8")
