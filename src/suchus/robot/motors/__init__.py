"""The catalog of servos as they are bought, in one TOML file in which each number has its source beside it."""

from collections.abc import Mapping
from dataclasses import fields
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any

from suchus.core.errors import UnknownName
from suchus.core.reading import read_toml
from suchus.robot.design import Motor

SHIPPED = Path(__file__).with_name("motors.toml")
"""The servos that suchus knows."""
_IMPLICIT_FIELDS = ("name", "sources")  # fields that a table does not say
_PAIR = {"value", "source"}


@lru_cache(maxsize=1)
def motors() -> Mapping[str, Motor]:
    """Return the servos that suchus knows, by name.

    They are made without pydantic, which would take a fifth of the time of an import; a test reads the same file as a
    user's is read.
    """
    catalog = {}
    for name, table in read_toml(SHIPPED).items():
        values, sources, _ = split(table)
        motor_fields: dict[str, Any] = {
            field: tuple(value) if isinstance(value, list) else value for field, value in values.items()
        }
        catalog[name] = Motor(name=name, sources=tuple(sources.items()), **motor_fields)
    return MappingProxyType(catalog)


def motor(name: str) -> Motor:
    """Return a servo that suchus knows.

    Raises:
        UnknownName: it does not.
    """
    if name not in motors():
        raise UnknownName("motor", name, list(motors()))
    return motors()[name]


def split(table: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, str], dict[str, str]]:
    """Return the values of a servo's table, their sources, and the mistakes in its form, each by field.

    Args:
        table: table of one servo, as TOML gives it.
    """
    values: dict[str, Any] = {}
    sources: dict[str, str] = {}
    odd: dict[str, str] = {}
    field_names = [field.name for field in fields(Motor) if field.name not in _IMPLICIT_FIELDS]
    for field, entry in table.items():
        if field in _IMPLICIT_FIELDS:
            odd[field] = f"stands in the file by itself; there is {', '.join(field_names)}"
        elif not isinstance(entry, dict):
            values[field] = entry
        elif set(entry) != _PAIR or not isinstance(entry["source"], str):
            odd[field] = 'is a table; {value = ..., source = "..."} is needed'
        else:
            values[field], sources[field] = entry["value"], entry["source"]
    return values, sources, odd
