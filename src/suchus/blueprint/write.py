"""From a frozen value to a TOML file that reads back equal, each number with its meaning beside it."""

import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

from suchus.design.meaning import meanings
from suchus.record import new_file


def write(value: object, path: Path) -> Path:
    """Write a robot or a gait as TOML and return the path.

    Raises:
        Unwritable: the place cannot be written to.
    """
    text = render(value)
    with new_file(path) as draft:
        draft.write_text(text, encoding="utf-8")
    return path


def render(value: object) -> str:
    """Return a robot or a gait as TOML; the meaning of each field follows as a comment."""
    return "\n".join(_table(value, ())).strip() + "\n"


def _table(value: Any, path: tuple[str, ...], *, row: bool = False) -> list[str]:
    """A table's own values first, then the tables below it, as TOML wants it; a row of tables has double brackets."""
    told = meanings(type(value))
    items = {f.name: getattr(value, f.name) for f in fields(value)}
    name = ".".join(path)
    lines = ["", f"[[{name}]]" if row else f"[{name}]"] if path else []
    below: list[str] = []
    for name, item in items.items():
        if is_dataclass(item):
            below += _table(item, (*path, name))
        elif isinstance(item, tuple) and item and all(is_dataclass(one) for one in item):
            for one in item:
                below += _table(one, (*path, name), row=True)
        elif item is not None:
            meaning = " ".join(told.get(name, "").split())
            lines.append(f"{name} = {_inline(item)}" + (f"  # {meaning}" if meaning else ""))
    return lines + below


def _inline(value: Any) -> str:
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
