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
        first, last = min(velocities.start, torques.start), max(velocities.stop, torques.stop)
        self._acts, self._felt = water[:, hydro.FORCE : hydro.FORCE + 4], sensors[:, first:last]
        self._did, self._all = np.zeros((steps, *self._acts.shape)), np.zeros((steps + 1, *self._felt.shape))
        speeds = self._all[..., velocities.start - first : velocities.stop - first]
        self._before, self._after = speeds[:-1], speeds[1:]
        self._torque = self._all[1:, :, torques.start - first : torques.stop - first]
        self._sum = np.zeros(self._torque.shape)
        self._share = np.full(steps, 1.0 / steps)

    def begin(self) -> None:
        """Keep what is felt before the first step."""
        self._all[0] = self._felt

    def read(self, step: int) -> None:
        """Keep what a physics step has left."""
        self._did[step] = self._acts
        self._all[step + 1] = self._felt

    def mean(self, into: np.ndarray, who: np.ndarray | slice) -> None:
        """Write the means of force and power of the water and of the power of the servos, shape (run, 5).

        The power of a servo in a step is its torque times the mean of its speeds before and after.

        Args:
            into: where to.
            who: runs for which they are written.
        """
        np.add(self._before, self._after, out=self._sum)
        into[who, :4] = (self._share @ self._did.reshape(len(self._did), -1)).reshape(-1, 4)[who]
        into[who, 4] = (0.5 * self._share @ np.vecdot(self._sum, self._torque))[who]
