"""How far a number may move between processors and still mean the same.

Processors round differently, and contacts, servos at their limits and iterations amplify what they round. A bound
here is physical: it says which change of the quantity would change what it means, and holds on every processor.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

RESIDUAL = re.compile(r"residual|(^|_)(power_)?error(_|$)|noise|misfit")
"""Names of measures that say how far an iteration or a balance was off."""
DIFFERENCE = re.compile(r"(^|_)off(_|$)")
"""Names of measures that are a relative difference from a reference [-], or a difference of angles [rad]."""
SETTING = re.compile(r"^(cells|grids|cycles|designs|grounds|repeats|samples|starts|steps)(_|$)|_cells$")
"""Names of whole numbers that were set, not measured."""
RELATIVE = 0.02
"""Relative change within which a measure without an interval means the same [-]."""
SMALL = 2e-3
"""Absolute change that no reader looks at: two millimetres, two milliradians, two thousandths [SI unit]."""

REASONS: Mapping[str, str] = {
    "setting": "a number that was set: exact",
    "residual": "what an iteration or a balance leaves: a factor of two",
    "difference": "a difference from a reference: two per cent of the reference, or 0.02 rad",
    "repeat interval": "the width of its own interval over repeats",
    "rounding": "rounding that contacts and servos amplify: two per cent, or two thousandths of small numbers",
    "no number": "there was no number, and there is none",
}
"""What each word for a bound means."""


@dataclass(frozen=True, slots=True)
class Bounded:
    """A number with the range within which it means the same."""

    value: float
    """The number, in its own unit."""
    low: float
    """Lower end of the range; NaN where there is no number."""
    high: float
    """Upper end of the range; NaN where there is no number."""
    reason: str
    """Why the range is so wide: a key of ``REASONS``, or a sentence."""

    def holds(self, value: float) -> bool:
        """Return whether another value means the same."""
        if math.isnan(self.value):
            return math.isnan(value)
        return self.low <= value <= self.high

    def plain(self) -> dict[str, Any]:
        """Return it as JSON holds it."""
        return {"value": self.value, "low": self.low, "high": self.high, "reason": self.reason}


def bounded(numbers: Mapping[str, float], *, relative: float = RELATIVE, small: float = SMALL) -> dict[str, Bounded]:
    """Return each number with its range.

    Args:
        numbers: by name; ``NAME_low`` and ``NAME_high`` are the interval of ``NAME`` over repeats.
        relative: relative change that means the same [-].
        small: absolute change that no reader looks at, of numbers above five times as much [SI unit].
    """
    return {name: _bounded(name, float(value), numbers, relative, small) for name, value in numbers.items()}


def _bounded(name: str, value: float, numbers: Mapping[str, float], relative: float, small: float) -> Bounded:
    if math.isnan(value):
        return Bounded(value, math.nan, math.nan, "no number")
    if math.isinf(value) or (SETTING.search(name) and value == round(value)):
        return Bounded(value, value, value, "setting")
    if RESIDUAL.search(name):
        ends = sorted((0.5 * value, 2.0 * value))
        return Bounded(value, *ends, "residual") if value else _around(value, 1e-9, "rounding")
    if DIFFERENCE.search(name):
        return _around(value, max(relative, relative * abs(value)), "difference")
    width, size = _interval(name, numbers), max(relative * abs(value), min(small, 0.2 * abs(value)), 1e-9)
    return _around(value, width, "repeat interval") if width > size else _around(value, size, "rounding")


def _around(value: float, size: float, reason: str) -> Bounded:
    return Bounded(value, value - size, value + size, reason)


def _interval(name: str, numbers: Mapping[str, float]) -> float:
    """Return the width of the interval of a number or of the number whose end it is, 0 if there is none."""
    base = name.removesuffix("_low").removesuffix("_high")
    ends = numbers.get(f"{base}_low"), numbers.get(f"{base}_high")
    if None in ends or not all(math.isfinite(float(end)) for end in ends if end is not None):
        return 0.0
    low, high = (float(end) for end in ends if end is not None)
    return abs(high - low)


def moved(stored: Mapping[str, Bounded], numbers: Mapping[str, float]) -> dict[str, tuple[float, float]]:
    """Return the numbers that do not mean the same any more: by name the stored one and the new one.

    A name that is missing on either side counts as moved, with NaN in its place.
    """
    names = dict.fromkeys([*stored, *numbers])
    both = {name: (stored[name].value if name in stored else math.nan, numbers.get(name, math.nan)) for name in names}
    kept = {name for name in names if name in stored and name in numbers and stored[name].holds(float(numbers[name]))}
    return {name: pair for name, pair in both.items() if name not in kept}


def read(entries: Mapping[str, Mapping[str, Any]]) -> dict[str, Bounded]:
    """Return numbers with their ranges from what ``Bounded.plain`` made of them."""
    return {name: Bounded(**entry) for name, entry in entries.items()}
