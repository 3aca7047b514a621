"""How a design refuses an impossible number."""

import math

from suchus.errors import InvalidDesign


def require(owner: str, field: str, value: float, low: float, high: float, unit: str) -> None:
    """Refuse a number outside its range, or one that is not a number.

    Args:
        owner: what the number belongs to, for the message.
        field: name of the field.
        value: the number.
        low: least allowed value.
        high: greatest allowed value.
        unit: unit of all three, for the message.

    Raises:
        InvalidDesign: the value is not finite, below ``low`` or above ``high``.
    """
    if not (isinstance(value, (int, float)) and math.isfinite(value) and low <= value <= high):
        raise InvalidDesign(f"{owner}.{field} is {value!r} {unit}; {low:g} to {high:g} {unit} is allowed.")


def require_range(owner: str, field: str, value: tuple[float, float], low: float, high: float, unit: str) -> None:
    """Refuse a pair that is not an increasing range within ``low`` to ``high``.

    Raises:
        InvalidDesign: an end is out of bounds, or the first is not below the second.
    """
    for end in value:
        require(owner, field, end, low, high, unit)
    if not value[0] < value[1]:
        raise InvalidDesign(f"{owner}.{field} is {value!r} {unit}; the first must be below the second.")
