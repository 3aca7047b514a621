"""The reward of a step: the quantities that it is made of, in SI units, their weights, and their weighted sum."""

from dataclasses import dataclass, fields

import numpy as np
from jaxtyping import Bool, Float

from suchus.design.checks import Checks


@dataclass(frozen=True, slots=True, kw_only=True)
class Rewards:
    """Weights of the terms of the reward; each term is a quantity of one step in SI units, see ``Terms``.

    None of them is from the article. They were chosen so that a whole episode of the shelf's own motion is worth about
    ten, almost all of it from the one term that the task is about.
    """

    forward: float
    """Weight of the displacement of the centre of mass along the world's x axis, the robot's first heading [1/m]."""
    lateral_drift: float
    """Weight of the increase of the distance of the centre of mass from that axis; negative, a penalty [1/m]."""
    upright: float
    """Weight of the time with the snout above ``Task.least_height`` [1/s]."""
    work: float
    """Weight of the work of all servos, braking counted as much as driving; negative, a penalty [1/J]."""
    action_rate: float
    """Weight of the sum of the squared changes of all commanded angles between two steps; negative, a penalty
    [1/rad2]."""
    fall: float
    """Added once, when the episode ends by a fall or because the simulation diverged; negative, a penalty [-]."""
    approach: float = 0.0
    """Weight of the decrease of the distance that remains to ``Task.goal`` [1/m]."""
    goal: float = 0.0
    """Added once, when the goal is reached [-]."""

    def __post_init__(self) -> None:
        with Checks("rewards", self) as check:
            for f in fields(self):
                check.number(f.name, -1e4, 1e4, "")


@dataclass(frozen=True, slots=True, kw_only=True)
class Terms:
    """Terms of the reward of one step, for each robot; the weights of the same names are in ``Rewards``."""

    forward: Float[np.ndarray, " run"]
    """Displacement of the centre of mass along the world's x axis [m]."""
    lateral_drift: Float[np.ndarray, " run"]
    """Increase of the distance of the centre of mass from that axis, on either side [m]."""
    upright: Float[np.ndarray, " run"]
    """Time with the snout high enough at the end of the step: the whole step or nothing [s]."""
    work: Float[np.ndarray, " run"]
    """Sum of torque times speed over all servos, braking counted as much as driving [J]."""
    action_rate: Float[np.ndarray, " run"]
    """Sum of the squares of the changes of all commanded angles [rad2]."""
    approach: Float[np.ndarray, " run"]
    """Decrease of the distance that remains to the goal; 0 without a goal [m]."""
    goal: Bool[np.ndarray, " run"]
    """Whether the goal is reached [-]."""
    fall: Bool[np.ndarray, " run"]
    """Whether it fell, or the simulation diverged [-]."""

    @property
    def over(self) -> Bool[np.ndarray, " run"]:
        """Whether the episode ends here: by a fall, or at the goal [-]."""
        return np.asarray(self.fall | self.goal)

    def reward(self, weights: Rewards) -> Float[np.ndarray, " run"]:
        """Return the weighted sum [-]."""
        total = np.zeros(len(self.fall))
        for name in TERMS:
            total += getattr(weights, name) * getattr(self, name)
        return total


TERMS = tuple(f.name for f in fields(Terms))
"""Names of the terms, in the order in which they are summed."""
