"""A gait that was seen, slowed down until the servos of a robot can follow it."""

from dataclasses import replace
from typing import TypeVar

from suchus.design import Robot
from suchus.motion import Gait, Pattern, shortest_period

_Seen = TypeVar("_Seen", Gait, Pattern)


def within_speed(robot: Robot, gait: _Seen, notes: list[str]) -> _Seen:
    """Return a gait with a period in which no servo has to turn faster than it can.

    Args:
        robot: who shall walk.
        gait: what was seen.
        notes: gets a sentence if the period had to be made longer.
    """
    needed, slow = shortest_period(robot, gait)
    if needed <= gait.period:
        return gait
    notes.append(
        f"in a cycle of {gait.period:.2f} s {slow} would have to turn faster than its servo can; the period is "
        f"{needed:.2f} s"
    )
    return replace(gait, period=round(needed + 5e-5, 4))  # never rounded to below what is needed
