"""Whether a motion's velocity is the rate of its position. The wall moves with the one and stands at the other."""

from dataclasses import dataclass

import numpy as np

from suchus import rotation
from suchus.errors import InvalidDesign
from suchus.flow.pose import Motion, Pose, length

SHARE = 0.1
"""Difference of the two, over the larger one, from which they disagree [-]."""

QUIET = 0.05
"""Speed, over the fastest so far, below which differences count relative to that [-]."""

NOTHING = 1e-5
"""Distance by which the two may part in a step without further question [cells]."""

PATIENCE = 3
"""Times in a row that they must disagree: at a kink of the motion they do so once [-]."""

_LOOK = 0.01  # share of a step over which positions are compared


@dataclass(slots=True)
class Consistency:
    """A motion under watch."""

    name: str
    """Name of the body."""
    motion: Motion
    """The motion that is watched."""
    reach: float
    """Distance of the body's surface from the origin of its frame [m]."""
    cell: float
    """Side of a cell [m]."""
    top: float = 0.0
    """Fastest speed so far, of either kind [m/s]."""
    strikes: int = 0
    """Times in a row that velocity and positions disagreed [-]."""

    def start(self, time: float, dt: float) -> None:
        """Look at the first step, of about ``dt`` [s].

        Raises:
            InvalidDesign: they disagree, with both numbers.
        """
        for k in reversed(range(PATIENCE)):  # the message then tells of the start
            self.look(time + k * dt / PATIENCE, dt)
        self.strikes = 0

    def look(self, time: float, dt: float) -> None:
        """Compare velocity and positions at a time [s] in steps of ``dt`` [s].

        Raises:
            InvalidDesign: they disagree for the third time in a row, with both numbers.
        """
        span = _LOOK * dt
        now, soon, then = (self.motion(time + k * span) for k in range(3))
        axes = len(now.position)
        places = [np.array([*p.position, *_turn(now, p)]) for p in (now, soon, then)]
        spins = [now.spin] if axes == 2 else now.spins
        given, seen = np.array([*now.velocity, *spins]), (4 * places[1] - 3 * places[0] - places[2]) / (2 * span)
        size, moved, off = (self._speed(rate) for rate in (given, seen, given - seen))
        self.top = max(self.top, size, moved)
        if not (off > SHARE * max(size, moved, QUIET * self.top) and off * dt > NOTHING * self.cell):
            self.strikes = 0
            return
        self.strikes += 1
        if self.strikes < PATIENCE:
            return
        wrong = given - seen
        turning = length(wrong[axes:]) * self.reach > length(wrong[:axes])
        what, of = ("spin", "angle" if axes == 2 else "attitude") if turning else ("velocity", "position")

        def numbers(rate: np.ndarray) -> str:
            parts, unit = (rate[axes:], "rad/s") if turning else (rate[:axes], "m/s")
            text = ", ".join(f"{part:.4g}" for part in parts)
            return f"({text}) {unit}" if parts.size > 1 else f"{text} {unit}"

        raise InvalidDesign(
            f"at t = {time:.4g} s the motion of {self.name} gives the {what} {numbers(given)}, and its "
            f"{of} changes by {numbers(seen)}; give a Pose whose {what} is the rate of its {of}."
        )

    def _speed(self, rate: np.ndarray) -> float:
        axes = (len(rate) + 2) // 2  # 3 numbers in the plane, 6 in space
        return max(length(rate[:axes]), length(rate[axes:]) * self.reach)


def _turn(now: Pose, then: Pose) -> np.ndarray:
    """Return the angle of a pose in the plane, in space the rotation vector from another one to it [rad]."""
    if len(now.position) == 2:
        return np.array([then.angle])
    if now.pitch == then.pitch == 0 and now.roll == then.roll == 0:
        return np.array([0.0, 0.0, then.angle - now.angle])
    one, other = (rotation.from_angles(p.angle, p.pitch, p.roll) for p in (now, then))
    return rotation.to_vector(rotation.multiply(other, one * [1, -1, -1, -1]), np.zeros(3))
