"""Tail to tail: the tail bends with the trunk, and the ground carries it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks
from suchus.robot.control.sensed import Sensed, finite
from suchus.robot.control.shared import Shared
from suchus.robot.design import Robot, layout, servo_ranges
from suchus.robot.motion import Batch, Gait
from suchus.robot.motion.limbs import bounded


@dataclass(frozen=True, slots=True, kw_only=True)
class TailRule:
    """The tail's pitch gives way until its servo holds nothing, so that the ground carries the tail on any slope.

    d(pitch)/dt = -rate torque, within a range. A gait that lifts its tail keeps it lifted.
    """

    rate: float = 0.3
    """Rate at which it gives way [rad/(s N m)]; faster gains more uphill, this drifts least on slopes to the side."""
    lowest: float = 0.55
    """Farthest down [rad]; beyond, the tail would lift the hind feet."""
    highest: float = -0.05
    """Farthest up [rad]; level, the tail no longer touches."""

    def __post_init__(self) -> None:
        with Checks("tail_rule", self) as checks:
            checks.number("rate", 0.0, 100.0, "rad/(s N m)")
            checks.number("lowest", -1.3, 1.3, "rad")
            checks.number("highest", -1.3, 1.3, "rad")
            checks.that(self.highest <= self.lowest, "highest must be at most lowest: down is positive")


class TailController:
    """The tails of a batch."""

    def __init__(
        self,
        rules: Sequence[TailRule | None],
        robots: Sequence[Robot],
        gaits: Sequence[Gait],
        period: float,
    ) -> None:
        """Gather the rates of the batch, and the range within which each tail may pitch.

        Args:
            rules: rule of each run; None for a run without one.
            robots: robot of each run.
            gaits: gait of each run.
            period: control period [s].
        """
        joint_count = max(len(layout(robots[0]).tail_pitch), 1)
        self._target_pitch = np.array([gait.number("tail_pitch") / joint_count for gait in gaits])
        self._pitch = self._target_pitch
        self._is_active = np.array([rule is not None for rule in rules]) & (self._pitch >= 0.0)
        self._has_rule = bool(self._is_active.any())
        if not self._has_rule:
            return
        self._step = period * np.array([0.0 if rule is None else rule.rate for rule in rules])
        self._column = layout(robots[0]).tail_pitch[0]
        lower_bound, upper_bound = np.array([servo_ranges(robot)[self._column] for robot in robots]).T
        for i, rule in enumerate(rules):
            if rule is not None:
                lower_bound[i] = max(lower_bound[i], min(rule.highest, self._pitch[i]))
                upper_bound[i] = min(upper_bound[i], max(rule.lowest, self._pitch[i]))
        self._lower_bound, self._upper_bound = lower_bound, upper_bound

    @staticmethod
    def step(shared: Shared, gaits: Batch, clock: Float[np.ndarray, " run"]) -> Shared:
        """Let the bend follow the trunk, with the gait's phase lag; where no trunk bends, it follows the limbs.

        Args:
            shared: what spine and limbs say.
            gaits: gaits of the runs.
            clock: since the walk began, for bodies without limbs [cycle].
        """
        (_, trunk_steady), (tail, steady) = gaits.swing_and_offset("trunk"), gaits.swing_and_offset("tail")
        ratio = gaits.swing_ratio("tail", "trunk")
        # bend and direction together are the trunk's whole wave, swing times order parameter
        wave = shared.trunk_bend - trunk_steady - 1j * (shared.trunk_direction - trunk_steady)
        follows = ratio.values * wave
        if not ratio.are_finite:
            follows = np.where(np.isfinite(ratio.values), follows, tail * gaits.axis_phase(shared.limb_phase, clock))
        return shared.updated_by("tail", tail_bend=-steady - follows.real, tail_direction=-steady + follows.imag)

    def take_over(self, predecessor: "TailController") -> None:
        """Continue from the tails of the same runs where the gait demands the same pitch."""
        self._pitch = np.where(
            self._is_active & (self._target_pitch == predecessor._target_pitch), predecessor._pitch, self._target_pitch
        )

    def correct(self, targets: Float[np.ndarray, "run servo"], sensed: Sensed) -> Float[np.ndarray, "run servo"]:
        """Return the targets with the tail pitched by the torque feedback of one more control period."""
        if not self._has_rule:
            return targets
        gives = self._step * finite(sensed.servo_torque[:, self._column])
        self._pitch = bounded(self._pitch - gives, self._lower_bound, self._upper_bound)
        corrected = targets.copy()
        corrected[:, self._column] = np.where(self._is_active, self._pitch, targets[:, self._column])
        return corrected
