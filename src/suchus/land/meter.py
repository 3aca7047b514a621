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
        self._acts, self._steps = water[:, hydro.FORCE : hydro.FORCE + 4], steps
        self._speed, self._torque = sensors[:, velocities], sensors[:, torques]
        count, servos = self._speed.shape
        self._did = np.zeros((steps, count, 4))
        self._speeds, self._torques = np.zeros((count, steps + 1, servos)), np.zeros((count, steps, servos))
        self._work = np.zeros((count, steps, servos))

    def begin(self) -> None:
        """Keep what is felt before the first step."""
        self._speeds[:, 0] = self._speed

    def read(self, step: int) -> None:
        """Keep what a physics step has left."""
        self._did[step] = self._acts
        self._speeds[:, step + 1] = self._speed
        self._torques[:, step] = self._torque

    def mean(self, into: np.ndarray, who: np.ndarray | slice) -> None:
        """Write the means of force and power of the water and of the power of the servos, shape (run, 5).

        The power of a servo in a step is its torque times the mean of its speeds before and after.

        Args:
            into: where to.
            who: runs for which they are written.
        """
        np.add(self._speeds[:, :-1], self._speeds[:, 1:], out=self._work)
        np.multiply(self._work, self._torques, out=self._work)
        into[who, :4] = np.add.reduce(self._did, axis=0)[who] / self._steps
        into[who, 4] = np.add.reduce(self._work.reshape(len(into), -1), axis=1)[who] / (2 * self._steps)
