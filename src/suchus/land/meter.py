"""What water and servos do to a batch over a control period."""

import numpy as np

from suchus import hydro


class Meter:
    """Keeps step by step what the water does to the robots and what their servos do; both jitter within a period.

    Args:
        water: of the batch, shape (run, ``hydro.NUMBERS``); read anew at every step.
        sensors: of the batch, shape (run, sensor); likewise.
        velocities: where the servos' speeds are among the sensors.
        torques: where their torques are.
        steps: of the physics in a control period.
    """

    def __init__(self, water: np.ndarray, sensors: np.ndarray, velocities: slice, torques: slice, steps: int) -> None:
        self._acts, self._felt = water[:, hydro.FORCE : hydro.FORCE + 4], sensors
        self._water = np.empty((steps, *self._acts.shape))
        self._all = np.empty((steps + 1, *self._felt.shape))
        speed = self._all[..., velocities]
        self._before, self._after, self._torque = speed[:-1], speed[1:], self._all[1:, :, torques]

    def begin(self) -> None:
        """Keep what is felt before the first step."""
        self._all[0] = self._felt

    def read(self, step: int) -> None:
        """Keep what a physics step has left."""
        self._water[step] = self._acts
        self._all[step + 1] = self._felt

    def mean(self, into: np.ndarray, who: np.ndarray | slice) -> None:
        """Write the means of force and power of the water and of the power of the servos, shape (run, 5).

        The power of a servo in a step is its torque times the mean of its speeds before and after.

        Args:
            into: where to.
            who: runs for which they are written.
        """
        work, steps = self._before + self._after, len(self._water)
        work *= self._torque
        into[who, :4] = self._water.sum(axis=0)[who] / steps
        into[who, 4] = work.sum(axis=(0, 2))[who] / (2 * steps)
