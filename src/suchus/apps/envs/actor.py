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
        delay: control periods by which commanded angles reach the servos late.
    """

    def __init__(
        self, initial_target: Float[np.ndarray, "run servo"], periods: int, limbs: int, delay: int = 0
    ) -> None:
        self.target, self.periods = initial_target, periods
        self._begin, self._elapsed_periods = initial_target.copy(), 0
        self._phase = np.zeros((len(initial_target), limbs))
        self._late_commands = [initial_target.copy() for _ in range(delay)]  # the oldest first

    def rest(self) -> Float[np.ndarray, "run servo"]:
        """Return the angles in which the robots begin [rad]."""
        return self.target

    def aim(self, target: Float[np.ndarray, "run servo"]) -> None:
        """Set the angles that the next action commands [rad]."""
        self._begin[:], self.target[:], self._elapsed_periods = self.target, target, 0

    def restart(self, robot: int, target: Float[np.ndarray, " servo"]) -> None:
        """Let a robot begin anew at some angles [rad]; nothing that was commanded before reaches it.

        Args:
            robot: index of the robot.
            target: its angles.
        """
        self.target[robot] = target
        for late_command in self._late_commands:
            late_command[robot] = target

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Return the angles at the end of the next control period."""
        del tick, sensed
        self._elapsed_periods += 1
        fraction = self._elapsed_periods / self.periods
        command = self._begin + fraction * (self.target - self._begin)
        if self._late_commands:
            self._late_commands.append(command)
            command = self._late_commands.pop(0)
        return Command(command, self._phase)
