"""Whether the fields of a frozen value hold what they are declared to hold: Python itself does not look."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields
from functools import cache
from numbers import Integral, Real
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

_WORDS = {float: "a number", int: "a whole number", str: "a text", bool: "true or false"}
_MAX_CHARACTERS = 60  # characters of a value in a message


def misfits(value: object) -> Iterator[tuple[str, str]]:
    """Yield name and complaint of each field of a dataclass that holds another kind of thing than it declares."""
    kind: Any = type(value)
    for name, hint, fits in _field_checks(kind):
        has = getattr(value, name)
        if not fits(has):
            expected_text = "a smaller number" if _huge(has) and fits(0.0) else _hint_text(hint)
            yield name, f"is {show(has)}; {expected_text} is needed"


def show(value: object) -> str:
    """Return a value as messages repeat it: as it is written, but not at length."""
    try:
        text = value.__name__ if isinstance(value, type) else repr(value)
    except ValueError:  # Python writes no number of more than 4300 digits
        text = "a number of thousands of digits"
    return text if len(text) <= _MAX_CHARACTERS else f"{text[: _MAX_CHARACTERS - 3]}..."


Fits = Callable[[Any], bool]
"""Whether a value is of a kind."""


@cache
def _field_checks(kind: Any) -> tuple[tuple[str, Any, Fits], ...]:
    """Return name, hint and check of each field of a dataclass; many values of few classes are made in a study."""
    hints = get_type_hints(kind)
    return tuple((field.name, hints[field.name], _check(hints[field.name])) for field in fields(kind))


def _huge(value: Any) -> bool:
    """Return whether a number is whole and beyond what double precision holds, so that nothing can be done with it."""
    return isinstance(value, Integral) and not -(2**1023) < int(value) < 2**1023


def is_number(value: Any) -> bool:
    """Return whether a value is a real number that double precision holds; truth values and texts are none."""
    if type(value) is float:  # most are
        return True
    return not isinstance(value, bool) and isinstance(value, Real) and not _huge(value)


def _is_integer(value: Any) -> bool:
    return not isinstance(value, bool) and isinstance(value, Integral) and not _huge(value)


def _check(hint: Any) -> Fits:
    """Return what tells whether a value is what a hint declares."""
    origin, inner = get_origin(hint), get_args(hint)
    if hint in (float, int):
        return is_number if hint is float else _is_integer
    if origin in (Union, UnionType):
        members = [_check(member) for member in inner]
        return lambda value: any(fits(value) for fits in members)
    if origin is Literal:
        return lambda value: isinstance(value, (str, int)) and value in inner
    if origin is tuple:
        return _row(inner)
    if origin is Mapping:
        return lambda value: isinstance(value, Mapping)
    if origin is Callable:
        return callable
    if hint is None or hint is type(None):
        return lambda value: value is None
    protocol, runtime = getattr(hint, "_is_protocol", False), getattr(hint, "_is_runtime_protocol", False)
    if hint is Any or not isinstance(hint, type) or origin is not None or (protocol and not runtime):
        return lambda _: True
    return lambda value: isinstance(value, hint)


def _row(inner: tuple[Any, ...]) -> Fits:
    """Return what tells whether a value is a tuple of declared items, of any length where the hints end with dots."""
    if Ellipsis in inner:
        fits = _check(inner[0])
        return lambda value: isinstance(value, tuple) and all(map(fits, value))
    element_checks = [_check(item) for item in inner]
    return lambda value: (
        isinstance(value, tuple)
        and len(value) == len(element_checks)
        and all(fits(item) for fits, item in zip(element_checks, value, strict=True))
    )


def _hint_text(hint: Any) -> str:
    """Return in words which values a type hint allows."""
    origin, inner = get_origin(hint), get_args(hint)
    if origin in (Union, UnionType):
        return " or ".join("nothing" if member is type(None) else _hint_text(member) for member in inner)
    if origin is Literal:
        return " or ".join(repr(literal) for literal in inner)
    if origin is tuple:
        return f"a tuple{'' if Ellipsis in inner else f' of {len(inner)}'}, each {_hint_text(inner[0])},"
    name = getattr(hint, "__name__", "value of another kind")
    return _WORDS.get(hint, f"{'an' if name[0] in 'AEIOU' else 'a'} {name}")
