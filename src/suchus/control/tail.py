"""Tail to tail: the tail bends with the trunk, and the ground carries it."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.control.sensed import Sensed, finite
from suchus.control.shared import Shared
from suchus.design import AnyRobot, layout, servo_ranges
from suchus.design.checks import Checks
from suchus.motion import Gait, Pattern, axis_bends, tail_bend


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
        robots: Sequence[AnyRobot],
        gaits: Sequence[Gait | Pattern],
        groups: Sequence[tuple[AnyRobot, Gait | Pattern, np.ndarray]],
        period: float,
    ) -> None:
        self._groups = groups
        self._asked = np.array([gait.tail_pitch if isinstance(gait, Gait) else 0.0 for gait in gaits])
        self._pitch = self._asked
        self._on = np.array([rule is not None for rule in rules]) & (self._pitch >= 0.0)
        if not self._on.any():
            return
        self._step = period * np.array([0.0 if rule is None else rule.rate for rule in rules])
        self._column = layout(robots[0]).tail_pitch[0]
        low, high = np.array([servo_ranges(robot)[self._column] for robot in robots]).T
        for i, rule in enumerate(rules):
            if rule is not None:
                low[i] = max(low[i], min(rule.highest, self._pitch[i]))
                high[i] = min(high[i], max(rule.lowest, self._pitch[i]))
        self._low, self._high = low, high

    def step(self, shared: Shared) -> Shared:
        """Let the bend follow the trunk, with the gait's phase lag; where no trunk bends, it follows the limbs."""
        bend, direction = np.empty_like(shared.tail_bend), np.empty_like(shared.tail_bend)
        for robot, gait, runs in self._groups:
            if isinstance(gait, Pattern):  # its tail is a part of one wave along the axis
                bend[runs] = axis_bends(robot, gait, shared.limb_phase[runs])[1]
                direction[runs] = axis_bends(robot, gait, shared.limb_phase[runs] + 0.25)[1]
            elif gait.trunk_bend > 0.0:
                scale, lag = gait.tail_bend / gait.trunk_bend, 2 * np.pi * gait.tail_phase
                now, later = shared.trunk_bend[runs], shared.trunk_direction[runs]
                bend[runs] = scale * (np.cos(lag) * now - np.sin(lag) * later)
                direction[runs] = scale * (np.cos(lag) * later + np.sin(lag) * now)
            else:
                bend[runs] = tail_bend(gait, shared.limb_phase[runs])
                direction[runs] = tail_bend(gait, shared.limb_phase[runs] + 0.25)
        return shared.written_by("tail", tail_bend=bend, tail_direction=direction)

    def take_over(self, before: "TailController") -> None:
        """Go on from where the tails of the same runs stand, as far as the gait asks for the same pitch."""
        self._pitch = np.where(self._on & (self._asked == before._asked), before._pitch, self._asked)

    def correct(self, targets: Float[np.ndarray, "run servo"], sensed: Sensed) -> Float[np.ndarray, "run servo"]:
        """Return the targets with the tail's pitch given way for one control period more."""
        if not self._on.any():
            return targets
        gives = self._step * finite(sensed.servo_torque[:, self._column])
        self._pitch = np.clip(self._pitch - gives, self._low, self._high)
        corrected = targets.copy()
        corrected[:, self._column] = np.where(self._on, self._pitch, targets[:, self._column])
        return corrected
