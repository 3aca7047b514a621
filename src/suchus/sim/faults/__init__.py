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
from suchus.sim.faults.delayed import Delayed
from suchus.sim.faults.frozen import Frozen
from suchus.sim.faults.limp import Limp
from suchus.sim.faults.locked import Locked
from suchus.sim.faults.lost_foot import LostFoot
from suchus.sim.faults.offset import Offset
from suchus.sim.faults.slow import Slow
from suchus.sim.faults.weak import Weak
from suchus.sim.persistence import Persistence

__all__ = [
    "FAULTS",
    "Backlash",
    "Deaf",
    "Delayed",
    "Frozen",
    "Limp",
    "Locked",
    "LostFoot",
    "Offset",
    "Slow",
    "Weak",
    "from_table",
    "from_text",
    "numbers",
]

FAULTS: Catalog[type[Fault]] = Catalog(
    "fault", "suchus.sim.faults", "suchus.sim.fault:Fault", classes=True, name_of=methodcaller("kind")
)
"""The kinds of fault by name."""


def from_table(table: Mapping[str, Any]) -> Fault:
    """Return the fault that a table describes, as ``{kind = "weak", joint = "LF_yaw", fraction = 0.2, at = 4.0}``.

    The part that breaks stands under the name of the fault's first field, or under ``joint`` for all kinds. The fields
    of its ``Persistence`` stand beside the others, as ``duration = 0.5``.

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
    persistence = {}
    if "persistence" in fields_by_name:
        persistence = {key: values.pop(key) for key in _PERSISTENCE if key in values and key not in fields_by_name}
    for key, value in values.items():
        if key not in fields_by_name:
            raise UnknownName(f"field of the fault {make.kind()}", key[:60], fields_by_name)
        _check(make.kind(), key, value, types[key])
        if isinstance(value, int):  # a whole number in a file is a number like any other
            values[key] = float(value)
    if persistence:
        for key, value in persistence.items():
            _check(make.kind(), key, value, float)
        seed = persistence.pop("seed", 0)
        if seed != int(seed):
            raise InvalidDesign(f"seed of the fault {make.kind()} is {_show(seed)}; a whole number is needed.")
        values["persistence"] = Persistence(seed=int(seed), **{key: float(value) for key, value in persistence.items()})
    return make(**values)


def from_text(text: str, **defaults: float) -> Fault:
    """Return the fault that a text of a command line names, as ``limp:LF_yaw`` or ``weak:LF_yaw,fraction=0.2,at=4``.

    Args:
        text: kind, colon, part, and fields with their numbers after commas.
        **defaults: fields that the text may leave out, as ``at``.

    Raises:
        UnknownName: no such kind, or no such field of this kind.
        InvalidDesign: the part is missing, a field has no number, or a number is outside its range.
    """
    kind, _, words = text.partition(":")
    part, *settings = (word.strip() for word in words.split(","))
    if not part:
        raise InvalidDesign(
            f"the fault {_show(text)} names no part; say KIND:PART, as limp:LF_yaw, with {', '.join(FAULTS)}."
        )
    table: dict[str, Any] = {**defaults, "kind": kind.strip(), "joint": part}
    for setting in settings:
        name, _, number = (word.strip() for word in setting.partition("="))
        try:
            table[name] = float(number)
        except ValueError:
            raise InvalidDesign(
                f"the fault {_show(text)} has {_show(setting)}; a field and its number are needed, as at=4.0."
            ) from None
    return from_table(table)


def numbers(kind: type[Fault]) -> dict[str, float]:
    """Return the numbers of a kind of fault that have a default, by field, without the time."""
    spare: dict[str, float] = {}
    for field in fields(kind):  # type: ignore[arg-type]  # every fault is a dataclass
        if field.name != "at" and isinstance(_default(field), float):
            spare[field.name] = float(_default(field))
    return spare


_PERSISTENCE = tuple(field.name for field in fields(Persistence))


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
