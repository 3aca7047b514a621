"""A class has a name of its own: who reads a name anywhere in the package knows which class it is."""

import re
from collections import Counter
from pathlib import Path

import suchus

SOURCES = Path(suchus.__file__).parent


def shared_names(folder: Path) -> list[str]:
    """Return the names that several classes below a folder have, sorted."""
    texts = (path.read_text(encoding="utf-8") for path in folder.rglob("*.py"))
    names = Counter(name for text in texts for name in re.findall(r"^[ \t]*class (\w+) *[(\[:]", text, re.M))
    return sorted(name for name, number in names.items() if number > 1)


def test_no_two_classes_share_a_name():
    assert shared_names(SOURCES) == []


def test_a_shared_name_is_seen(tmp_path):
    (tmp_path / "one.py").write_text("class Band: ...\nclass Swim: ...\n")
    (tmp_path / "two.py").write_text("def made():\n    class Band: ...\n")
    assert shared_names(tmp_path) == ["Band"]
