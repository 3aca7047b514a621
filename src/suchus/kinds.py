"""Whether the fields of a frozen value hold what they are declared to hold: Python itself does not look."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields
from functools import cache
from numbers import Integral, Real
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

_WORDS = {float: "a number", int: "a whole number", str: "a text", bool: "true or false"}
_SHOWN = 60  # characters of a value in a message


def misfits(value: object) -> Iterator[tuple[str, str]]:
    """Yield name and complaint of each field of a dataclass that holds another kind of thing than it declares."""
    kind: Any = type(value)
    hints = _hints(kind)
    for field in fields(value):  # type: ignore[arg-type]
        has, hint = getattr(value, field.name), hints[field.name]
        if not _fits(has, hint):
            wanted = "a smaller number" if _huge(has) and _fits(0.0, hint) else _wanted(hint)
            yield field.name, f"is {show(has)}; {wanted} is needed"


def show(value: object) -> str:
    """Return a value as messages repeat it: as it is written, but not at length."""
    try:
        text = value.__name__ if isinstance(value, type) else repr(value)
    except ValueError:  # Python writes no number of more than 4300 digits
        text = "a number of thousands of digits"
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."


@cache
def _hints(kind: type) -> dict[str, Any]:
    return get_type_hints(kind)


def _huge(value: Any) -> bool:
    """Return whether a number is whole and beyond what double precision holds, so that nothing can be done with it."""
    return isinstance(value, Integral) and not -(2**1023) < int(value) < 2**1023


def _fits(value: Any, hint: Any) -> bool:
    origin, inner = get_origin(hint), get_args(hint)
    if hint is Any:
        return True
    if hint in (float, int):
        number = isinstance(value, Real if hint is float else Integral) and not isinstance(value, bool)
        return number and not _huge(value)
    if origin in (Union, UnionType):
        return any(_fits(value, one) for one in inner)
    if origin is Literal:
        return isinstance(value, (str, int)) and value in inner
    if origin is tuple:
        if not isinstance(value, tuple):
            return False
        each = [inner[0]] * len(value) if Ellipsis in inner else inner
        return len(each) == len(value) and all(_fits(item, one) for item, one in zip(value, each, strict=True))
    if origin is Mapping:
        return isinstance(value, Mapping)
    if origin is Callable:
        return callable(value)
    if hint is None or hint is type(None):
        return value is None
    if not isinstance(hint, type) or origin is not None:
        return True
    look = not getattr(hint, "_is_protocol", False) or getattr(hint, "_is_runtime_protocol", False)
    return isinstance(value, hint) if look else True


def _wanted(hint: Any) -> str:
    origin, inner = get_origin(hint), get_args(hint)
    if origin in (Union, UnionType):
        return " or ".join("nothing" if one is type(None) else _wanted(one) for one in inner)
    if origin is Literal:
        return " or ".join(repr(one) for one in inner)
    if origin is tuple:
        return f"a tuple{'' if Ellipsis in inner else f' of {len(inner)}'}, each {_wanted(inner[0])},"
    name = getattr(hint, "__name__", "value of another kind")
    return _WORDS.get(hint, f"{'an' if name[0] in 'AEIOU' else 'a'} {name}")
