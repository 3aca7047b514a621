"""The passage of the page on servo commands that states what the servos bear in each gait of the shelf."""

from collections.abc import Mapping
from math import degrees
from typing import Any


def table(measured: Mapping[str, Mapping[str, Any]]) -> str:
    """Return a row for each servo that stands at its torque limit, and a sentence on the gaits without one.

    Args:
        measured: by gait, from ``tests/hardware/shelf_loads.py``.
    """
    lines = ["| gait | servo | at its limit | off its command | would do | such a one is at its limit | exported |"]
    lines += ["|---|---|---|---|---|---|---|"]
    for gait, load in measured.items():
        lines += [
            f"| `{gait}` | `{name}` | {100 * one['at_limit']:.0f} % | {degrees(one['off']):.0f} degrees | "
            f"{one['would_do']} | {100 * one['then']:.1f} % | {'yes' if load['exported'] else 'refused'} |"
            for name, one in load["servos"].items()
        ]
    below = [f"`{gait}` {100 * load['most']:.1f} %" for gait, load in measured.items() if not load["servos"]]
    return "\n".join(lines) + f"\n\nBelow 2 % in every servo, here the one that is there most: {', '.join(below)}.\n"
