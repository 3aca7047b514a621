"""Numbers as people read them."""

from math import degrees


def quantity(value: float | None, unit: str) -> str:
    """Return a number with its unit; angles in degrees too. Nothing where there is no number."""
    if value is None:
        return ""
    shown = number(value)
    if unit == "rad":
        return f"{shown} rad ({number(degrees(value), 3)}°)"
    return shown if unit in ("-", "1", "") else f"{shown} {unit}"


def number(value: float, digits: int = 4) -> str:
    """Return a number to a few digits, with a true minus and powers of ten written out."""
    if isinstance(value, int):
        return str(value).replace("-", "−")
    mantissa, _, power = f"{value:.{digits}g}".partition("e")
    exponent = f" × 10^{int(power)}" if power else ""
    return f"{mantissa}{exponent}".replace("-", "−")
