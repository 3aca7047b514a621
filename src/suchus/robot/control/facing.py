"""The heading of robots, averaged over their cycle."""

from collections.abc import Sequence
from math import pi

import numpy as np
from jaxtyping import Bool, Float

from suchus.core import rotation
from suchus.robot.control.sensed import Sensed, finite
from suchus.robot.design import Robot, layout

_MIN_UPRIGHT = 0.3
"""Vertical component of the body's upward axis above which its left side is counted as the left one in full [-]."""


def left_side_sign(sensed: Sensed) -> Float[np.ndarray, " run"]:
    """Return the sign with which a bend to the body's left turns it to the left of the world [-].

    It is 1 for a robot that stands or swims upright, -1 for one that has rolled onto its back, and 0 for one that lies
    on its side, whose lateral bends point up and down.
    """
    upright = rotation.upward(finite(sensed.orientation))[..., 2]
    return np.asarray(np.clip(upright / _MIN_UPRIGHT, -1.0, 1.0))


class HeadingEstimator:
    """Direction of the pelvis by the IMU plus half of the trunk's sensed bend, averaged over the last cycle.

    A heading counts from a reference. For a robot that begins at rest it is the heading at the first call, since
    nothing swings yet. For a robot that walks already it is the mean over the first whole cycle, which must pass first.

    Args:
        robots: robots of a batch; they share a layout.
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
        self._reference = np.zeros(len(cycle))
        self._first_reference_tick = np.zeros(len(cycle), dtype=int)

    def begin_in_motion(self) -> None:
        """Take the mean over the first whole cycle as the reference, for robots that walk before the first call."""
        self._first_reference_tick = self._cycle

    @property
    def has_reference(self) -> Bool[np.ndarray, " run"]:
        """Whether the reference of each robot is known; only then do its headings have a meaning."""
        return np.asarray(self._count >= self._first_reference_tick)

    def feel(self, sensed: Sensed) -> Float[np.ndarray, " run"]:
        """Return the heading of each robot against its reference, left positive, averaged over its last cycle [rad]."""
        trunk = finite(sensed.servo_position[:, self._yaw]).sum(1)
        facing = rotation.yaw(finite(sensed.orientation)) + left_side_sign(sensed) * trunk / 2
        if self._walks:
            self._turn_angle = self._turn_angle + (facing - self._previous_facing + pi) % (2 * pi) - pi
        self._walks, self._previous_facing = True, facing
        self._count += 1
        size = len(self._summed)
        slot, previous_slot = self._count % size, (self._count - 1) % size
        self._summed[slot] = self._summed[previous_slot] + self._turn_angle
        window = np.minimum(self._cycle, self._count)
        mean = (self._summed[slot] - self._summed[(self._count - window) % size, self._runs]) / window
        self._reference = np.where(self._count <= self._first_reference_tick, mean, self._reference)
        return np.asarray(mean - self._reference)

    def take_over(self, predecessor: "HeadingEstimator") -> None:
        """Continue from another estimator of the same runs, whose cycles may have another length."""
        self._walks, self._turn_angle = predecessor._walks, predecessor._turn_angle
        self._previous_facing, self._reference = predecessor._previous_facing, predecessor._reference
        # the time that a predecessor still needs to find its reference
        missing = np.maximum(predecessor._first_reference_tick - predecessor._count, 0)
        size, old_size = len(self._summed), len(predecessor._summed)
        self._count = min(predecessor._count, old_size - 1, size - 1)
        for age in range(self._count + 1):
            slot, old_slot = (self._count - age) % size, (predecessor._count - age) % old_size
            self._summed[slot] = predecessor._summed[old_slot]
        self._first_reference_tick = np.where(missing > 0, self._count + missing, 0)
