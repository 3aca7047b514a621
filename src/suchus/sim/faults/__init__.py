"""The catalog of faults: one file, one kind of fault, declared as ``fault``."""

from collections.abc import Mapping
from dataclasses import MISSING, Field, fields
from operator import methodcaller
from typing import Any, get_args, get_type_hints

from suchus.core.catalog import Catalog
from suchus.core.errors import InvalidDesign, UnknownName
from suchus.sim.fault import Fault
from suchus.sim.faults.backlash import Backlash
from suchus.sim.faults.deaf import Deaf
from suchus.sim.faults.limp import Limp
from suchus.sim.faults.locked import Locked
from suchus.sim.faults.lost_foot import LostFoot
from suchus.sim.faults.offset import Offset
from suchus.sim.faults.slow import Slow
from suchus.sim.faults.weak import Weak

__all__ = [
    "FAULTS",
    "Backlash",
    "Deaf",
    "Limp",
    "Locked",
    "LostFoot",
    "Offset",
    "Slow",
    "Weak",
    "from_table",
    "numbers",
]

FAULTS: Catalog[type[Fault]] = Catalog(
    "fault", "suchus.sim.faults", "suchus.sim.fault:Fault", classes=True, name_of=methodcaller("kind")
)
"""The kinds of fault by name."""


def from_table(table: Mapping[str, Any]) -> Fault:
    """Return the fault that a table describes, as ``{kind = "weak", joint = "LF_yaw", fraction = 0.2, at = 4.0}``.

    The part that breaks stands under the name of the fault's first field, or under ``joint`` for all kinds.

    Raises:
        UnknownName: no such kind, or no such field of this kind.
        InvalidDesign: the kind or the part is missing, or a value is of another type.
    """
    if "kind" not in table:
        raise InvalidDesign(f"a fault needs a kind ({', '.join(FAULTS)}); {_show(table)} has none.")
    make = FAULTS[str(table["kind"])[:60]]
    fields_by_name = {field.name: field for field in fields(make)}  # type: ignore[arg-type]  # every fault is a dataclass
    part_field = next(iter(fields_by_name))
    values = {part_field if key == "joint" else key: value for key, value in table.items() if key != "kind"}
    if part_field not in values:
        raise InvalidDesign(f"the fault {make.kind()} needs a {part_field}; {_show(table)} has none.")
    types = get_type_hints(make)
    for key, value in values.items():
        if key not in fields_by_name:
            raise UnknownName(f"field of the fault {make.kind()}", key[:60], fields_by_name)
        _check(make.kind(), key, value, types[key])
        if isinstance(value, int):  # a whole number in a file is a number like any other
            values[key] = float(value)
    return make(**values)


def numbers(kind: type[Fault]) -> dict[str, float]:
    """Return the numbers of a kind of fault that have a default, by field, without the time."""
    spare: dict[str, float] = {}
    for field in fields(kind):  # type: ignore[arg-type]  # every fault is a dataclass
        if field.name != "at" and isinstance(_default(field), float):
            spare[field.name] = float(_default(field))
    return spare


def _default(field: "Field[Any]") -> Any:
    return None if field.default is MISSING else field.default


def _check(kind: str, key: str, value: Any, declared_type: Any) -> None:
    """Refuse a value of a fault's table whose type differs from the declared one."""
    allowed = get_args(declared_type) or (declared_type,)
    if float in allowed:
        allowed = (*allowed, int)
    if not isinstance(value, allowed) or isinstance(value, bool):
        names = " or ".join(
            "a number" if allowed_type is float else "a text"
            for allowed_type in allowed
            if allowed_type in (float, str)
        )
        raise InvalidDesign(f"{key} of the fault {kind} is {_show(value)}; {names or 'another type'} is needed.")


def _show(value: Any) -> str:
    text = repr(dict(value) if isinstance(value, Mapping) else value)
    return text if len(text) <= 60 else f"{text[:57]}..."
