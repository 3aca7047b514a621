"""Writing of a frozen value as TOML that reads back equal, with the meaning of each number as a comment."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

from suchus.core import writing
from suchus.robot.design.meaning import meanings


def write(value: object, path: str | Path, *, notes: Mapping[str, str] | None = None, head: Sequence[str] = ()) -> Path:
    """Write a robot or a gait as TOML and return the path.

    Args:
        value: the robot or the gait.
        path: the file.
        notes: what to add to the comments, by the place of a value, as ``axis[0].shapes[1].mass``.
        head: sentences to begin with, as comments.

    Raises:
        Unwritable: the place cannot be written to.
    """
    return writing.write(Path(path), render(value, notes=notes, head=head))


def render(value: object, *, notes: Mapping[str, str] | None = None, head: Sequence[str] = ()) -> str:
    """Return a robot or a gait as TOML; the meaning of each field follows as a comment, and its note if it has one.

    A robot of the article's kind is written as its tables, which are what people change.
    """
    value = getattr(value, "tables", None) or value
    comments = [f"# {_plain(sentence)}" for sentence in head]
    return "\n".join([*comments, *([""] if comments else []), "\n".join(_table(value, (), notes or {})).strip(), ""])


def _table(
    value: Any, path: tuple[str, ...], notes: Mapping[str, str], place: str = "", *, row: bool = False
) -> list[str]:
    """Return the lines of a table: its own values first, then the tables below it, as TOML needs it.

    Args:
        value: the frozen value.
        path: keys from the top of the file down to the table.
        notes: remarks by the place of a value.
        place: position of the table, with a dot at its end, as the notes name it.
        row: whether the table is an element of a list, which has double brackets.
    """
    field_meanings = meanings(type(value))
    items = {f.name: getattr(value, f.name) for f in fields(value) if f.init}
    name = ".".join(path)
    lines = ["", f"[[{name}]]" if row else f"[{name}]"] if path else []
    subtables: list[str] = []
    for name, item in items.items():
        if is_dataclass(item):
            subtables += _table(item, (*path, name), notes, f"{place}{name}.")
        elif isinstance(item, tuple) and item and all(is_dataclass(element) for element in item):
            for i, element in enumerate(item):
                subtables += _table(element, (*path, name), notes, f"{place}{name}[{i}].", row=True)
        elif item is not None:
            meaning = _plain(f"{field_meanings.get(name, '')} {_sentence(notes.get(place + name, ''))}")
            lines.append(f"{name} = {_inline(item)}" + (f"  # {meaning}" if meaning else ""))
    return lines + subtables


def _sentence(note: str) -> str:
    """Return a note as a sentence."""
    return f"{note[0].upper()}{note[1:]}." if note else ""


def _plain(text: str) -> str:
    """Return a text that fits in a comment: one line, without control characters."""
    return "".join(c if c.isprintable() else "?" for c in " ".join(text.split()))


def _inline(value: Any) -> str:
    """Return a value as TOML on one line.

    Raises:
        TypeError: TOML cannot hold a value of this type.
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (tuple, list)):
        return f"[{', '.join(_inline(item) for item in value)}]"
    if is_dataclass(value):
        value = {f.name: getattr(value, f.name) for f in fields(value)}
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(k)} = {_inline(v)}" for k, v in value.items() if v is not None) + "}"
    raise TypeError(f"a {type(value).__name__} has no form in TOML: {value!r}")
