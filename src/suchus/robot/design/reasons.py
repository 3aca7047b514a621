"""Reasons for the many numbers of a design at once, by patterns of their paths."""

import re
from collections.abc import Iterator, Sequence
from dataclasses import fields, is_dataclass
from typing import Any, NamedTuple

from suchus.core.errors import InvalidDesign
from suchus.robot.design.chosen import Assumption


class Reason(NamedTuple):
    """The reason for all numbers whose paths match a pattern."""

    pattern: str
    """Regular expression, searched for in the path."""
    lower_fraction: float
    """Least plausible share of the value [-]."""
    upper_fraction: float
    """Greatest plausible share of the value [-]."""
    text: str
    """The reason."""


def numbers(design: Any, path: str = "") -> Iterator[tuple[str, float]]:
    """Yield the path and the value of every number of a design that is not zero."""
    if is_dataclass(design):
        for field in fields(design):
            if not field.init:
                continue
            yield from numbers(getattr(design, field.name), f"{path}.{field.name}".lstrip("."))
    elif isinstance(design, tuple):
        for i, element in enumerate(design):
            yield from numbers(element, f"{path}[{i}]")
    elif isinstance(design, (int, float)) and not isinstance(design, bool) and design != 0:
        yield path, design


def assumptions_of(design: Any, reasons: Sequence[Reason], published: Sequence[str] = ()) -> tuple[Assumption, ...]:
    """Return the reason for every number of a design that is neither zero nor published.

    Args:
        design: a robot or a gait.
        reasons: the first whose pattern matches counts.
        published: patterns of the paths of numbers that stand in a publication.

    Raises:
        InvalidDesign: a number has no reason.
    """
    choices = []
    for path, value in numbers(design):
        if any(re.search(pattern, path) for pattern in published):
            continue
        reason = next((candidate for candidate in reasons if re.search(candidate.pattern, path)), None)
        if reason is None:
            raise InvalidDesign(
                f"{path} of {design.name!r} is {value:g} without a reason; give one, or say its source."
            )
        lower_bound, upper_bound = sorted((reason.lower_fraction * value, reason.upper_fraction * value))
        choices.append(Assumption(field=path, low=lower_bound, high=upper_bound, why=reason.text))
    return tuple(choices)
