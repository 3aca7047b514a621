"""Servos as they are bought, from TOML files in which each number has its source beside it."""

from collections.abc import Mapping
from dataclasses import fields
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from suchus.blueprint.mistakes import MistakenFile, Place
from suchus.blueprint.read import validated
from suchus.design import Motor
from suchus.errors import UnknownName
from suchus.reading import read_toml

SHIPPED = Path(__file__).with_name("motors.toml")
"""The servos that suchus knows."""
_OWN = ("name", "sources")  # fields that a table does not say
_PAIR = {"value", "source"}


@lru_cache(maxsize=1)
def motors() -> Mapping[str, Motor]:
    """Return the servos that suchus knows, by name."""
    return read_motors(SHIPPED)


def motor(name: str) -> Motor:
    """Return a servo that suchus knows.

    Raises:
        UnknownName: it does not.
    """
    if name not in motors():
        raise UnknownName("motor", name, list(motors()))
    return motors()[name]


def read_motors(path: str | Path) -> Mapping[str, Motor]:
    """Read servos from a TOML file: a table for each, in which a number is ``{value = 2.94, source = "..."}``.

    A number may stand alone; its source is then empty. Texts have no source.

    Raises:
        UnreadableFile: the file is missing or no TOML.
        MistakenFile: values are missing, unknown, of the wrong kind or impossible, or there is no servo in it; it names
            all of them.
    """
    path = Path(path)
    data = read_toml(path)
    if not data:
        raise MistakenFile(path.name, {(): "has no servo; give a table for each, as in [my_servo]"})
    found: dict[str, Motor] = {}
    mistakes: dict[Place, str] = {}
    for name, table in data.items():
        if not isinstance(table, dict):
            mistakes[name,] = f"is {table!r:.40}; a table of a servo's numbers is needed"
            continue
        values, sources, odd = _split(table)
        mistakes |= {(name, field): text for field, text in odd.items()}
        try:
            whole = {**values, "name": name, "sources": [list(pair) for pair in sources.items()]}
            found[name] = validated(whole, Motor, {}, path.name, {})
        except MistakenFile as error:
            mistakes |= {
                (name, place) if place else (name,): text for place, text in error.mistakes.items() if place not in odd
            }
    if mistakes:
        raise MistakenFile(path.name, mistakes)
    return MappingProxyType(found)


def _split(table: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, str], dict[str, str]]:
    """Return the values of a table, their sources, and what is wrong with how they are written."""
    values: dict[str, Any] = {}
    sources: dict[str, str] = {}
    odd: dict[str, str] = {}
    known = [field.name for field in fields(Motor) if field.name not in _OWN]
    for field, given in table.items():
        if field in _OWN:
            odd[field] = f"stands in the file by itself; there is {', '.join(known)}"
        elif not isinstance(given, dict):
            values[field] = given
        elif set(given) != _PAIR or not isinstance(given["source"], str):
            odd[field] = 'is a table; {value = ..., source = "..."} is needed'
        else:
            values[field], sources[field] = given["value"], given["source"]
    return values, sources, odd
