"""The reward of a step: the quantities that it is made of, in SI units, and their weighted sum."""

from dataclasses import dataclass, fields

import numpy as np
from jaxtyping import Bool, Float

from suchus.envs.task import Rewards


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
        for f in fields(self):
            total = total + getattr(weights, f.name) * getattr(self, f.name)
        return total
