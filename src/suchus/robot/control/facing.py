"""The heading of robots, averaged over their cycle."""

from collections.abc import Sequence
from math import pi

import numpy as np
from jaxtyping import Float

from suchus.core import rotation
from suchus.robot.control.sensed import Sensed, finite
from suchus.robot.design import Robot, layout


class HeadingEstimator:
    """Direction of the pelvis by the IMU plus half of the trunk's sensed bend, averaged over the last cycle.

    Args:
        robots: of a batch; they share a layout.
        cycle: length of each robot's cycle in control periods.
    """

    def __init__(self, robots: Sequence[Robot], cycle: Sequence[int]) -> None:
        self._yaw = list(layout(robots[0]).trunk_yaw)
        self._cycle, self._runs = np.array(cycle), np.arange(len(cycle))
        self._summed = np.zeros((int(self._cycle.max()) + 1, len(cycle)))  # ring buffer of the longest cycle
        self._count = 0
        self._walks = False
        self._previous_facing = np.zeros(len(cycle))
        self._turn_angle = np.zeros(len(cycle))

    def feel(self, sensed: Sensed) -> Float[np.ndarray, " run"]:
        """Return the heading of each robot since the first call, left positive, averaged over its last cycle [rad]."""
        trunk = finite(sensed.servo_position[:, self._yaw]).sum(1)
        facing = rotation.yaw(finite(sensed.orientation)) + trunk / 2
        if self._walks:
            self._turn_angle = self._turn_angle + (facing - self._previous_facing + pi) % (2 * pi) - pi
        self._walks, self._previous_facing = True, facing
        self._count += 1
        size = len(self._summed)
        slot, previous_slot = self._count % size, (self._count - 1) % size
        self._summed[slot] = self._summed[previous_slot] + self._turn_angle
        window = np.minimum(self._cycle, self._count)
        return np.asarray((self._summed[slot] - self._summed[(self._count - window) % size, self._runs]) / window)

    def take_over(self, predecessor: "HeadingEstimator") -> None:
        """Continue from another estimator of the same runs; the mean over the last cycle starts again."""
        self._walks, self._turn_angle = predecessor._walks, predecessor._turn_angle
        self._previous_facing = predecessor._previous_facing
