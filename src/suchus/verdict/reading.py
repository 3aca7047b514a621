"""Measures inside sentences: numbers that know how to be written in the unit that a reader expects."""

from collections.abc import Sequence
from math import degrees

_UNITS = {"mm": 1e3, "g": 1e3, "ms": 1e3, "MPa": 1e-6}


class Reading(float):
    """A number whose format may begin with a unit: ``{:mm.1f}`` writes metres as millimetres, ``{:deg.0f}`` degrees.

    The unit itself is left to the sentence. ``mm``, ``g`` and ``ms`` take metres, kilogrammes and seconds.
    """

    def __format__(self, form: str) -> str:
        """Write the number; a form without a unit is Python's own."""
        if form.startswith("deg"):
            return format(degrees(self), form.removeprefix("deg"))
        for unit, factor in _UNITS.items():
            if form.startswith((f"{unit}.", f"{unit}+")):
                return format(factor * float(self), form.removeprefix(unit))
        return format(float(self), form)


def compared(value: float, other: float, *, less: str, more: str, same: str = "the same", within: float = 0.0) -> str:
    """Return the word for how a value stands to another one.

    Args:
        value: the one that is spoken of.
        other: what it is compared with.
        less: the word where it is smaller.
        more: the word where it is greater.
        same: the word where both differ by at most ``within``.
        within: greatest difference that counts as none, as a share of the larger size [-].
    """
    if abs(value - other) <= within * max(abs(value), abs(other)):
        return same
    return less if value < other else more


def listed(items: Sequence[str]) -> str:
    """Return items as a list in a sentence: ``a, b and c``."""
    if len(items) < 2:
        return "".join(items)
    return f"{', '.join(items[:-1])} and {items[-1]}"
