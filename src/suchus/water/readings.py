"""Every reading of (20) on one robot: what its joints can make of it, or why they cannot."""

from collections.abc import Iterable, Mapping
from typing import NamedTuple

from suchus.design import Robot
from suchus.errors import OutsideLimits
from suchus.kinematics.wave import READINGS
from suchus.water.fit import Fit, fit
from suchus.water.waves import printed_wave


class Attempt(NamedTuple):
    """A reading that was tried."""

    letter: str
    """Letter of ``kinematics.wave.READINGS``."""
    fitted: Fit | None
    """The nearest motion of the joints, None if they cannot make the wave."""
    refusal: str
    """Why not: the joint and by how much."""


def attempts(robot: Robot, *, frequency: float, sign: int = -1) -> list[Attempt]:
    """Return what a robot's joints make of (20) in each of its readings.

    Args:
        robot: whose joints.
        frequency: which the article does not give [Hz].
        sign: -1 runs from head to tail; 1 as printed.
    """
    found = []
    for letter in READINGS:
        wave = printed_wave(robot, letter, frequency=frequency, sign=sign)
        try:
            found.append(Attempt(letter, fit(robot, wave, name=f"(20), reading {letter}"), ""))
        except OutsideLimits as refused:
            found.append(Attempt(letter, None, str(refused)))
    return found


def readings_table(tried: Iterable[Attempt], thrust: Mapping[str, str]) -> str:
    """Return a Markdown table of readings: units, misfit, what the joints make of it, thrust.

    Args:
        tried: the readings.
        thrust: what was measured of some of them, by letter.
    """
    lines = ["| reading of (20) | units | misfit | joints | thrust |", "|---|---|---|---|---|"]
    for letter, fitted, refusal in tried:
        misfit = "" if fitted is None else f"{100 * fitted.misfit:.1f} %"
        joints = refusal or READINGS[letter].verdict
        lines.append(f"| {letter} | {READINGS[letter].meaning} | {misfit} | {joints} | {thrust.get(letter, '')} |")
    return "\n".join(lines) + "\n"
