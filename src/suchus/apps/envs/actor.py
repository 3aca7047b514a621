"""How the commanded angles of a pack go from one action to the next."""

import numpy as np
from jaxtyping import Float

from suchus.robot.control import Command, Sensed


class Actor:
    """The controller of a pack: commanded angles go in a straight line from those of one action to those of the next.

    Args:
        initial_target: angles in which the robots begin, shape (run, servo) [rad]; written by ``aim``.
        periods: control periods from one action to the next.
        limbs: limbs of a robot.
    """

    def __init__(self, initial_target: Float[np.ndarray, "run servo"], periods: int, limbs: int) -> None:
        self.target, self.periods = initial_target, periods
        self._begin, self._elapsed_periods = initial_target.copy(), 0
        self._phase = np.zeros((len(initial_target), limbs))

    def rest(self) -> Float[np.ndarray, "run servo"]:
        """Return the angles in which the robots begin [rad]."""
        return self.target

    def aim(self, target: Float[np.ndarray, "run servo"]) -> None:
        """Set the angles that the next action commands [rad]."""
        self._begin[:], self.target[:], self._elapsed_periods = self.target, target, 0

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Return the angles at the end of the next control period."""
        del tick, sensed
        self._elapsed_periods += 1
        fraction = self._elapsed_periods / self.periods
        return Command(self._begin + fraction * (self.target - self._begin), self._phase)
