"""Shapes of arrays checked in the first calls of each function in each test.

A control loop calls with the same shapes thousands of times, and to look at all of them took most of the time of the
tests that walk.
"""

import sys
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from functools import reduce, wraps
from typing import Any

from beartype import beartype

CALLS = 10
"""How often a function is looked at in a test, arguments and result counted apart [-]."""
_calls: Counter[tuple[str, str]] = Counter()
_resting: list[Any] = []
_replaced: list[tuple[Any, str, Any]] = []
"""Methods that their classes show unchecked: the class, the name and the checked method."""


def checked(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that checks arguments or results; jaxtyping makes it of a signature, and it does nothing."""
    looked, name = beartype(function), (function.__module__, function.__qualname__)

    @wraps(function)
    def counted(*args: Any, **kwargs: Any) -> Any:
        _calls[name] += 1
        if _calls[name] == CALLS:
            _rest(*name)
        return looked(*args, **kwargs) if _calls[name] <= CALLS else None

    return counted


def begin() -> None:
    """Look at everything again: another test begins."""
    _calls.clear()
    while _resting:
        del _resting.pop().__no_type_check__
    while _replaced:
        setattr(*_replaced.pop())


def _rest(module: str, name: str) -> None:
    """Let jaxtyping call a function unchecked; it asks for the attribute of ``typing.no_type_check`` at each call.

    A class even shows its method unchecked; a module keeps its function, which may be pickled by its name. A version of
    jaxtyping that does not look at the attribute is only slower.
    """
    with suppress(AttributeError):  # what is made inside a function, or is a property, has no such place
        *path, last = name.split(".")
        place = reduce(getattr, path, sys.modules[module])
        function = getattr(place, last)
        unchecked = function.__wrapped__  # where jaxtyping looks first
        unchecked.__no_type_check__ = True
        _resting.append(unchecked)
        if isinstance(place, type) and vars(place).get(last) is function:  # neither inherited nor of the class as such
            setattr(place, last, unchecked)
            _replaced.append((place, last, function))
