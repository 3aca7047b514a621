"""Spine to spine: the trunk's bend follows the limbs, and its joints share each other's error."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Complex, Float

from suchus.core.checks import Checks
from suchus.robot.control.sensed import Sensed, decay_factor, finite
from suchus.robot.control.shared import Shared
from suchus.robot.design import Robot, layout, servo_ranges
from suchus.robot.motion import Batch
from suchus.robot.motion.limbs import bounded, in_steps


@dataclass(frozen=True, slots=True, kw_only=True)
class SpineRule:
    """Every yaw joint of the trunk adds a fraction of the bend that all of them together lack.

    With B the bend that the limbs' phases ask for and q the sensed yaw angles, e is the low-passed B - sum(q), and
    each joint is commanded its part of B, a third in the article's robot, and share e. A joint that is stuck, weak or
    sagging is so made up for by the others.
    """

    share: float = 0.3
    """Part of the missing bend that each joint takes over [-]; 0.6 is stable too and makes up for more."""
    delay: float = 0.1
    """Time constant of the low-pass filter on the missing bend [s]; longer than a servo needs, shorter than a step."""

    def __post_init__(self) -> None:
        with Checks("spine_rule", self) as checks:
            checks.number("share", 0.0, 2.0, "")
            checks.number("delay", 0.0, 10.0, "s")


class SpineController:
    """The trunks of a batch."""

    def __init__(
        self,
        rules: Sequence[SpineRule | None],
        robots: Sequence[Robot],
        period: float,
    ) -> None:
        """Gather the gains of the batch and the ranges of the trunk's servos.

        Args:
            rules: rule of each run; None for a run without one.
            robots: robot of each run.
            period: control period [s].
        """
        self._is_active = np.array([rule is not None for rule in rules])
        self._has_rule = bool(self._is_active.any())
        self._share = np.array([0.0 if rule is None else rule.share for rule in rules])[:, None]
        self._keep = np.array([0.0 if rule is None else decay_factor(rule.delay, period) for rule in rules])
        self._yaw = in_steps(layout(robots[0]).trunk_yaw)
        self._are_all_active = bool(self._is_active.all())
        ranges = np.array([servo_ranges(robot)[self._yaw] for robot in robots])
        self._lower_bound, self._upper_bound = ranges[..., 0], ranges[..., 1]
        self._lacking = np.zeros(len(robots))

    @staticmethod
    def step(
        shared: Shared,
        gaits: Batch,
        clock: Float[np.ndarray, " run"],
        axis: Complex[np.ndarray, " run"] | None = None,
    ) -> Shared:
        """Let the bend follow the limbs: each of four pulls with a quarter of the amplitude.

        Args:
            shared: what the limbs say.
            gaits: gaits of the runs.
            clock: since the walk began, for bodies without limbs [cycle].
            axis: what ``gaits.axis_phase`` returns of them, if it is known already [-].
        """
        axis = gaits.axis_phase(shared.limb_phase, clock) if axis is None else axis
        bend, direction = gaits.bend_of("trunk", axis), gaits.bend_of("trunk", 1j * axis)
        return shared.updated_by("spine", trunk_bend=bend, trunk_direction=direction)

    def take_over(self, predecessor: "SpineController") -> None:
        """Continue from the trunks of the same runs."""
        self._lacking = predecessor._lacking

    def correct(
        self, targets: Float[np.ndarray, "run servo"], target_bend: Float[np.ndarray, " run"], sensed: Sensed
    ) -> Float[np.ndarray, "run servo"]:
        """Return the targets with the missing bend shared out.

        Args:
            targets: servo angles [rad].
            target_bend: bend of the trunk [rad].
            sensed: sensor readings of the robots.
        """
        if not self._has_rule:
            return targets
        lacking = target_bend - finite(sensed.servo_position[:, self._yaw]).sum(axis=1)
        self._lacking = lacking + self._keep * (self._lacking - lacking)
        asked = targets[:, self._yaw]
        commanded = bounded(asked + self._share * self._lacking[:, None], self._lower_bound, self._upper_bound)
        if not self._are_all_active:
            commanded = np.where(self._is_active[:, None], commanded, asked)
        corrected = targets.copy()
        corrected[:, self._yaw] = commanded
        return corrected
