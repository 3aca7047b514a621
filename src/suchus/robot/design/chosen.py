"""A number that the article does not give, with the reason for ours; and the same design with other numbers."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cache
from typing import Any, Protocol, Self, TypeVar, runtime_checkable

from suchus.core.errors import InvalidDesign, UnknownName
from suchus.robot.design.article import crocodile, tables_of
from suchus.robot.design.body import Robot
from suchus.robot.design.meaning import meanings, unit

T = TypeVar("T")
_STEP = re.compile(r"(\w+)|\[(\d+)\]")


@dataclass(frozen=True, slots=True, kw_only=True)
class Assumption:
    """The reason for the value of a field, and its plausible range."""

    field: str
    """Dotted path of the field from the robot or gait, as ``spine.pitch_servo.torque``."""
    low: float
    """Least plausible value, in the field's unit."""
    high: float
    """Greatest plausible value, in the field's unit."""
    why: str
    """Not in the paper; chosen because of this."""
    above: tuple[str, float] | None = None
    """Path of another field and a factor: the value is at least that field's value times the factor."""


@runtime_checkable
class HasNumbers(Protocol):
    """A value with numbers besides its fields, as the stroke of all limbs of a gait."""

    def numbers(self) -> Mapping[str, str]:
        """Return their names and units."""

    def number(self, name: str) -> float:
        """Return one of them."""

    def with_numbers(self, **numbers: float) -> Self:
        """Return the same value with others."""


def value_at(design: Any, path: str) -> Any:
    """Return the value of a field of a robot or gait.

    Args:
        design: the robot, the gait, or a part.
        path: dotted, as ``spine.pitch_servo.torque`` or ``spine.yaw_range[0]``.

    Raises:
        UnknownName: there is no such field.
    """
    for step in _steps(path):
        design = _step(_holder(design, step), step)
    return design


def with_values(design: T, values: Mapping[str, Any]) -> T:
    """Return a robot or gait that differs in some fields, checked once all of them are set.

    A robot of the article's kind has the fields of its tables too; where only those are named, it is made anew of the
    changed tables, so that all that follows from them changes with them.

    Args:
        design: the robot, the gait, or a part; it stays as it is.
        values: values by path, see ``value_at``.

    Raises:
        UnknownName: there is no such field.
        InvalidDesign: the values cannot be, alone or together.
    """
    tables = tables_of(design) if isinstance(design, Robot) else None
    if tables is not None and all(hasattr(tables, str(_steps(path)[0])) for path in values):
        return crocodile(with_values(tables, values))  # type: ignore[return-value]
    branches: dict[str | int, dict[str, Any]] = {}
    numbers: dict[str, Any] = {}
    for path, value in values.items():
        head, *remainder = _steps(path)
        if not remainder and head in _numbers(design):
            numbers[str(head)] = value
            continue
        _step(design, head)
        branches.setdefault(head, {})["".join(f"[{s}]" if isinstance(s, int) else f".{s}" for s in remainder)] = value
    new_values = {
        step: subvalues[""] if "" in subvalues else with_values(_step(design, step), subvalues)
        for step, subvalues in branches.items()
    }
    if isinstance(design, tuple):
        return type(design)(new_values.get(i, item) for i, item in enumerate(design))
    derived = [f.name for f in fields(design) if not f.init and f.name in new_values]  # type: ignore[arg-type]
    if derived:
        raise InvalidDesign(
            f"{derived[0]} follows from what a {type(design).__name__} was made of, and is not set: change the other "
            "fields."
        )
    new_design: Any = replace(design, **{str(step): value for step, value in new_values.items()})  # type: ignore[type-var]
    return new_design.with_numbers(**numbers) if numbers else new_design


def unit_at(design: Any, path: str) -> str:
    """Return the unit in which a field holds its numbers, ``-`` where it has none.

    Args:
        design: the robot, the gait, or a part.
        path: path of the field, see ``value_at``.

    Raises:
        UnknownName: there is no such field.
    """
    value_at(design, path)
    parent_path, _, name = path.rpartition(".")
    holder = value_at(design, parent_path) if parent_path else design
    if name in _numbers(holder):
        return _numbers(holder)[name]
    owner, name = type(_holder(holder, name)), name.partition("[")[0]
    return unit(meanings(owner).get(name, "")) or "-"


def _steps(path: str) -> list[str | int]:
    steps: list[str | int] = [int(index) if index else name for name, index in _STEP.findall(path)]
    if not steps:
        raise UnknownName("field", path, ())
    return steps


def _numbers(design: Any) -> Mapping[str, str]:
    """Return the names and units of the numbers that a value has besides its fields."""
    if not _has_numbers(design.__class__):
        return {}
    return {name: unit for name, unit in design.numbers().items() if not hasattr(design, name)}


def _holder(design: Any, step: str | int) -> Any:
    """Return the tables of a robot where they, and not the robot itself, have a field; else the design."""
    tables = tables_of(design) if isinstance(design, Robot) else None
    is_own_field = isinstance(design, Robot) and step in {field.name for field in fields(design) if field.init}
    return design if tables is None or is_own_field else tables


def _step(design: Any, step: str | int) -> Any:
    """Return the value of a field, an element or a number of a design.

    Raises:
        UnknownName: the design has nothing of that name.
    """
    names: Sequence[str | int] = _field_names(design.__class__)
    if isinstance(step, int):
        names = range(len(design)) if isinstance(design, tuple) else ()
    if step in names:
        return design[step] if isinstance(step, int) else getattr(design, step)
    if step in _numbers(design):
        return design.number(str(step))
    raise UnknownName("field", str(step), [*(str(name) for name in names), *_numbers(design)])


@cache
def _field_names(kind: type) -> tuple[str, ...]:
    """Return the names of the fields of a class; none where it is no dataclass."""
    return tuple(field.name for field in fields(kind)) if is_dataclass(kind) else ()


@cache
def _has_numbers(kind: type) -> bool:
    """Return whether the values of a class are ``HasNumbers``: to ask each value takes longer than to change it."""
    return issubclass(kind, HasNumbers)
