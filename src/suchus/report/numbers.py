"""Numbers as people read them."""

import re
from math import degrees

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def quantity(value: float | None, unit: str, digits: int = 4) -> str:
    """Return a number with its unit; angles in degrees too. Nothing where there is no number."""
    if value is None:
        return ""
    shown = number(value, digits)
    if unit == "rad":
        return f"{shown} rad ({number(degrees(value), 3)}°)"
    return shown if unit in ("-", "1", "") else f"{shown} {unit}"


def number(value: float, digits: int = 4) -> str:
    """Return a number to a few digits, with a true minus and powers of ten written out."""
    if isinstance(value, int):
        return str(value).replace("-", "−")
    mantissa, _, power = f"{value:.{digits}g}".partition("e")
    exponent = f" × 10{str(int(power)).translate(_RAISED)}" if power else ""
    return mantissa.replace("-", "−") + exponent


def tied(text: str) -> str:
    """Return a text whose ``Fig. 16`` and ``eq. (14)`` do not break over lines."""
    return re.sub(r"\b(Figs?|Table|Section|eqs?)(\.?) ", "\\1\\2\N{NO-BREAK SPACE}", text)
