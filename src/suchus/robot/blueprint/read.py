"""From a TOML file to a frozen value; what the file does not say can come from a catalog.

A file of a robot describes it part by part, or gives the article's tables, of which ``design.crocodile`` makes one.
"""

import json
from collections.abc import Mapping
from copy import deepcopy
from dataclasses import asdict, fields
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, TypeVar, get_args, overload

from pydantic import TypeAdapter, ValidationError

from suchus.core.errors import UnreadableFile
from suchus.core.files import read_toml
from suchus.robot.blueprint.mistakes import MistakenFile, Place, closest, explain
from suchus.robot.design import Robot, Tables, crocodile

T = TypeVar("T")


@overload
def read_design(path: str | Path, kind: type[T], shelf: Mapping[str, Any]) -> T: ...


@overload
def read_design(path: str | Path, kind: UnionType, shelf: Mapping[str, Any]) -> Any: ...


def read_design(path: str | Path, kind: Any, shelf: Mapping[str, Any]) -> Any:
    """Read a robot or a gait from a TOML file.

    With ``base = "caiman"`` at the top the file changes numbers of that entry of the catalog. A design without a
    ``name`` is named after the file. If ``kind`` is a union, a file without ``base`` is of the kind that has most of
    its top-level keys.

    Args:
        path: the file.
        kind: the frozen dataclass that it describes, or a union of several.
        shelf: what ``base`` may name.

    Raises:
        UnreadableFile: the file is missing or no TOML.
        MistakenFile: values are missing, unknown, of the wrong kind or impossible; it names all of them.
    """
    path = Path(path)
    data = read_toml(path)
    base = data.pop("base", None)
    is_known_base = base is None or (isinstance(base, str) and base in shelf)
    kinds = tuple(candidate for candidate in get_args(kind) or (kind,) if candidate is not NoneType)
    allowed_kinds: tuple[Any, ...] = (*kinds, Tables) if Robot in kinds else kinds
    if base is not None and is_known_base:
        model = shelf[base]
        if isinstance(model, Robot) and model.tables is not None and closest(data, (Tables, Robot)) is Tables:
            model = model.tables
    else:
        best_kind = closest(data, allowed_kinds)
        shelf_models = (
            getattr(shelf_model, "tables", None) if best_kind is Tables else shelf_model
            for shelf_model in shelf.values()
        )
        model = next(shelf_model for shelf_model in shelf_models if isinstance(shelf_model, best_kind))
    if not isinstance(model, allowed_kinds):
        raise UnreadableFile(
            f"{path.name} starts from {base!r}, which is a {type(model).__name__}; a "
            f"{' or '.join(candidate.__name__ for candidate in kinds)} is needed here."
        )
    fallback = plain({name: value for name, value in asdict(model).items() if name in _settable_fields(model)})
    mistakes: dict[Place, str] = {}
    if not is_known_base:
        mistakes["base",] = f"is {base!r}; there is {', '.join(shelf)}"
    if base is not None:
        data = merged({**fallback, "name": path.stem}, data)
    value = validated({"name": path.stem, **data}, type(model), fallback, path.name, mistakes)
    return crocodile(value) if isinstance(value, Tables) else value


def parse_robot(values: Mapping[str, Any]) -> Robot:
    """Return the robot that the plain values of a result's settings describe.

    Args:
        values: values of a robot, or of the tables that it was made of, as ``dataclasses.asdict`` gives them.

    Raises:
        ValidationError: they describe none.
        InvalidDesign: they describe an impossible one.
    """
    values = values.get("tables") or values
    if closest(values, (Robot, Tables)) is Tables:
        return crocodile(TypeAdapter(Tables).validate_python(values))
    return TypeAdapter(Robot).validate_python(values)


def parse_table(data: Mapping[str, Any], kind: type[T], label: str) -> T:
    """Return the frozen value that a table of a file describes.

    Args:
        data: the table.
        kind: the frozen dataclass.
        label: what it is, for messages.

    Raises:
        MistakenFile: values are missing, unknown, of the wrong kind or impossible; it names all of them.
    """
    return validated(dict(data), kind, {}, label, {})


def _settable_fields(model: Any) -> set[str]:
    """Return the names of the fields that a file can set."""
    return {field.name for field in fields(model) if field.init}


def plain(value: Any) -> Any:
    """Return a value without the tables and fields that are None, which TOML does not have."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items() if item is not None}
    return tuple(plain(item) for item in value) if isinstance(value, (list, tuple)) else value


def validated(
    data: dict[str, Any], value_type: type[T], fallback: Mapping[str, Any], file_name: str, mistakes: dict[Place, str]
) -> T:
    """Return the value that a table describes, or refuse the table with all of its mistakes at once.

    A mistaken entry may hide others. It is therefore replaced by its value in ``fallback``, or removed, and the table
    is validated again, until no new mistake appears.

    Args:
        data: the table; mistaken entries are replaced in place.
        value_type: type of the value.
        fallback: a table without mistakes.
        file_name: name of the file, for messages.
        mistakes: mistakes that are known already, by their place in the table; new ones are added in place.

    Raises:
        MistakenFile: the table describes no value; all mistakes are named.
    """
    adapter = TypeAdapter(value_type)
    mended_places: set[Place] = set()
    while True:
        try:
            value = adapter.validate_json(json.dumps(data, default=str), strict=True, extra="forbid")
        except ValidationError as error:
            found_mistakes: dict[Place, str] = {}
            for detail in error.errors(include_url=False):
                found_mistakes |= explain(detail, value_type, data)
        else:
            break
        new_mistakes = {
            place: text
            for place, text in found_mistakes.items()
            if _container_place(place) not in mended_places and not _contains_mended(place, mended_places)
        }
        mistakes |= new_mistakes
        is_mended = [_mend(data, _container_place(place), fallback) for place in new_mistakes]
        if not is_mended or not all(is_mended):
            break
        mended_places |= {_container_place(place) for place in new_mistakes}
    if mistakes:
        raise MistakenFile(file_name, mistakes)
    return value


def _container_place(place: Place) -> Place:
    """The place of the list that an element stands in, else the place itself."""
    while place and isinstance(place[-1], int):
        place = place[:-1]
    return place


def _contains_mended(place: Place, mended_places: set[Place]) -> bool:
    """Return whether a complaint about a whole table may stem from a fallback value that was put into it."""
    return any(mended_place[: len(place)] == place for mended_place in mended_places)


def _mend(data: Any, place: Place, fallback: Any) -> bool:
    """Put the fallback value at a place, or remove a key that should not be there; return whether that was possible.

    Args:
        data: the table, changed in place.
        place: keys from the top of the table down to the mistake.
        fallback: a table without mistakes.
    """
    if not place:
        return False
    for key in place[:-1]:
        if not (isinstance(data, dict) and isinstance(fallback, dict) and key in data and key in fallback):
            return False
        data, fallback = data[key], fallback[key]
    data.pop(place[-1], None)
    if place[-1] in fallback:
        data[place[-1]] = deepcopy(fallback[place[-1]])
    return True


def merged(base: Mapping[str, Any], overrides: Mapping[str, Any]) -> dict[str, Any]:
    """Return a table in which the values of a second table replace those of the first, table by table.

    Args:
        base: the first table; it stays as it is.
        overrides: the second table.
    """
    table = dict(deepcopy(base))
    for key, value in overrides.items():
        current = table.get(key)
        table[key] = merged(current, value) if isinstance(current, dict) and isinstance(value, dict) else value
    return table
