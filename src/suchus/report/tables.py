"""The robot and its free parameters as rows of tables."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

from suchus.design import Chosen, unit_at, value_at
from suchus.design.meaning import meanings, unit
from suchus.report.numbers import number, quantity


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """One field of a robot or gait."""

    field: str
    """Dotted path."""
    value: str
    """Its value with its unit."""
    meaning: str
    """Meaning of the number, from the docstring of its field."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ChosenNumber:
    """One number that the article does not give."""

    field: str
    """Dotted path."""
    value: str
    """Our value with its unit."""
    low: str
    """Least plausible value."""
    high: str
    """Greatest plausible value."""
    why: str
    """The reason."""


def parts(design: Any) -> dict[str, tuple[Row, ...]]:
    """Return the rows of each part of a robot, by the part's name."""
    about = meanings(type(design))
    found: dict[str, tuple[Row, ...]] = {}
    for f in fields(design):
        part = getattr(design, f.name)
        if is_dataclass(part):
            meaning = about.get(f.name, "")
            title = f"{f.name.replace('_', ' ')}: {meaning[:1].lower()}{meaning[1:]}"
            found[title] = tuple(rows(part, f.name))
    return found


def rows(design: Any, path: str = "") -> Iterator[Row]:
    """Yield a row for every number below a frozen value."""
    about = meanings(type(design))
    for f in fields(design):
        value, meaning = getattr(design, f.name), about.get(f.name, "")
        below = f"{path}.{f.name}".lstrip(".")
        if is_dataclass(value):
            yield from rows(value, below)
        else:
            yield Row(field=below, value=_shown(value, unit(meaning)), meaning=_plain(meaning))


def choices(design: Any, chosen: Sequence[Chosen]) -> tuple[ChosenNumber, ...]:
    """Return a row for every number that the article does not give."""
    return tuple(_choice(design, one) for one in chosen)


def _choice(design: Any, one: Chosen) -> ChosenNumber:
    value, own = value_at(design, one.field), unit_at(design, one.field)
    return ChosenNumber(
        field=one.field, value=_shown(value, own), low=number(one.low), high=number(one.high), why=one.why
    )


def _shown(value: Any, unit: str) -> str:
    if isinstance(value, tuple):
        return " to ".join(_shown(item, unit) for item in value) if len(value) == 2 else ", ".join(map(str, value))
    return quantity(value, unit) if isinstance(value, (int, float)) else str(value)


def _plain(meaning: str) -> str:
    """A meaning without the brackets of its unit and the marks of its code words."""
    return re.sub(r"\s*\[[^\]]*\]", "", " ".join(meaning.split())).replace("``", "").removeprefix(".")
