"""Translation of validation errors to sentences that name the place and the remedy."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from difflib import get_close_matches
from itertools import islice
from types import UnionType
from typing import Any, get_args

from suchus.core.checks import InvalidFields
from suchus.core.errors import InvalidDesign, UnreadableFile

Place = tuple[str | int, ...]
"""Keys from the top of a file down to a value."""

_HOMES = 2  # greatest number of places that are suggested for a field in the wrong table
_REQUIREMENTS: Mapping[str, str] = {
    "float_type": "a number is needed",
    "finite_number": "a finite number is needed",
    "int_type": "a whole number is needed",
    "int_from_float": "a whole number is needed",
    "string_type": "a text in quotes is needed",
    "bool_type": "true or false is needed",
    "tuple_type": "a list in brackets is needed",
    "dataclass_type": "a table is needed",
    "dict_type": "a table is needed",
    "mapping_type": "a table is needed",
    "int_parsing_size": "a smaller number is needed",
    "recursion_loop": "less deep nesting is needed",
}


class MistakenFile(UnreadableFile, InvalidDesign):
    """A file with values that are missing, unknown, of the wrong kind or impossible.

    Attributes:
        mistakes: text of each mistake by its place.
    """

    def __init__(self, name: str, mistakes: Mapping[Place, str]) -> None:
        """Join the mistakes of a file to one message.

        Args:
            name: name of the file.
            mistakes: what is wrong, by place.
        """
        self.mistakes = {dotted(place): text for place, text in mistakes.items()}
        descriptions = [f"{place} {text}".lstrip() for place, text in self.mistakes.items()]
        if len(descriptions) == 1:
            super().__init__(f"{name} has a mistake: {descriptions[0]}.")
        else:
            numbered_list = "; ".join(f"({i}) {description}" for i, description in enumerate(descriptions, 1))
            super().__init__(f"{name} has {len(descriptions)} mistakes: {numbered_list}.")


def dotted(place: Place) -> str:
    """Return a place as people write it: ``spine.yaw_range[0]``."""
    parts = (f"[{key}]" if isinstance(key, int) else f".{key}" for key in place)
    return "".join(parts).lstrip(".")


def explain(error: Mapping[str, Any], kind: type, data: Any) -> dict[Place, str]:
    """Return the texts of one pydantic error by place; one error can concern several fields.

    If a table may be of several kinds, pydantic reports errors for each; only the kind that fits the table's keys
    counts.

    Args:
        error: as pydantic tells it.
        kind: kind of the whole.
        data: what was validated.
    """
    location = _locate(tuple(error["loc"]), kind, data)
    if location is None:
        return {}
    place, owner = location
    cause = error.get("ctx", {}).get("error")
    if isinstance(cause, InvalidFields):
        return {(*place, *_keys(c.field)): c.text for c in cause.complaints}
    if error["type"] == "missing":
        return {place: "is missing"}
    if error["type"] == "unexpected_keyword_argument":
        return {place: _unknown(place, owner, kind)}
    return {place: f"is {_show(error['input'])}; {_requirement(error, cause)}"}


def _locate(loc: Place, kind: Any, data: Any) -> tuple[Place, Any] | None:
    """Return the place of an error and the kind of the table that it stands in; None if the file means another kind.

    Args:
        loc: place of the error as pydantic gives it, names of kinds included.
        kind: kind of the whole file.
        data: what was validated.
    """
    place: list[str | int] = []
    owner = kind
    for key in loc:
        kinds = (
            [candidate for candidate in get_args(kind) if is_dataclass(candidate)]
            if isinstance(kind, UnionType)
            else []
        )
        if len(kinds) > 1 and key in [candidate.__name__ for candidate in kinds]:  # type: ignore[union-attr]
            kind = closest(data, kinds)
            if kind.__name__ != key:
                return None
            continue
        place.append(key)
        kind = kinds[0] if len(kinds) == 1 else kind
        owner, kind = kind, _kind_at(kind, key)
        try:
            data = data[key]
        except (KeyError, IndexError, TypeError):
            data = None
    return tuple(place), owner


def closest(data: Any, kinds: Sequence[Any]) -> Any:
    """Return the kind that has most of a table's keys as fields; the first of several equal ones."""
    keys = set(data) if isinstance(data, Mapping) else set()
    return max(kinds, key=lambda kind: len(keys & {field.name for field in fields(kind) if field.init}))


def _kind_at(kind: Any, key: str | int) -> Any:
    """Return the kind of a field, or of an element of a list."""
    if isinstance(key, int):
        return next(iter(get_args(kind)), None)
    return next((f.type for f in fields(kind) if f.name == key), None) if is_dataclass(kind) else None


def _keys(field: str) -> Place:
    name, _, index = field.rstrip("]").partition("[")
    return () if not name else (name, int(index)) if index else (name,)


def _requirement(error: Mapping[str, Any], cause: Exception | None) -> str:
    """Return what a value must be instead, as the second half of a sentence."""
    context = error.get("ctx", {})
    if error["type"] in ("too_long", "too_short"):
        length = context.get("max_length", context.get("min_length"))
        return f"{length} values are needed"
    if error["type"] == "literal_error":
        return f"{context['expected']} is allowed"
    if cause is not None:
        return str(cause).rstrip(".")
    return _REQUIREMENTS.get(error["type"], "something else is needed")


def _unknown(place: Place, owner: Any, kind: type) -> str:
    """Return what to say of a field that its table does not have: where it belongs, or which name is similar.

    Args:
        place: position of the field in the file.
        owner: kind of the table that the field stands in.
        kind: kind of the whole file.
    """
    field_names = [f.name for f in fields(owner) if f.init] if is_dataclass(owner) else []
    homes = list(islice(_homes(str(place[-1]), kind), _HOMES + 1))
    if 0 < len(homes) <= _HOMES:
        return f"is not known there; it stands at {' and '.join(homes)}: move it"
    suggestions = get_close_matches(str(place[-1]), field_names, n=1, cutoff=0.5)
    if suggestions:
        return f"is not known (did you mean {dotted((*place[:-1], suggestions[0]))}?)"
    return f"is not known; there is {', '.join(field_names)}" if field_names else "is not known"


def _homes(name: str, kind: Any, place: str = "") -> Iterator[str]:
    """Yield the places where a design has a field of a name; elements of lists, as segments, are left out.

    Args:
        name: name of the field.
        kind: kind of the design.
        place: position of the design in the file, with a dot at its end.
    """
    if not is_dataclass(kind):
        return
    for field in fields(kind):
        if field.name == name:
            yield f"{place}{name}"
        yield from _homes(name, field.type, f"{place}{field.name}.")


def _show(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 40 else f"{text[:37]}..."
