"""Holding a heading and a depth while swimming: a mean bend steers, air let out and taken in dives and rises."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks
from suchus.robot.control.facing import HeadingEstimator, left_side_sign
from suchus.robot.control.sensed import Sensed, decay_factor, finite
from suchus.robot.design import Robot
from suchus.robot.design.pieces import chambers
from suchus.robot.kinematics.trim import spare_volume


@dataclass(frozen=True, slots=True, kw_only=True)
class HeadingHold:
    """Keeps the direction of a swim by the mean bend of tail and trunk.

    With psi the error of the direction, averaged over the last cycle, tail and trunk bend by a fraction u of ``turn``
    and ``trunk_turn``, their greatest mean bends, and u = -(gain psi + integral_gain sum(psi dt)), within -1 and 1. A
    robot that has rolled onto its back bends to its other side, and one that lies on its side does not bend.
    """

    direction: float = 0.0
    """Heading to hold, from the heading at the beginning, left positive [rad]."""
    gain: float = 2.0
    """Answer to the error [1/rad]; u = 1 turns the swim by some 0.2 rad/s, so 2 mends an error within 3 s."""
    integral_gain: float = 0.05
    """Answer to the error that stays [1/(rad s)]."""
    turn: float = 0.6
    """Greatest mean bend of the tail, that at u = 1, tip to the left [rad]."""
    trunk_turn: float = 0.3
    """Greatest mean bend of the trunk, that at u = 1, front end to the left [rad]."""

    def __post_init__(self) -> None:
        with Checks("heading_hold", self) as check:
            check.number("direction", -pi, pi, "rad")
            check.number("gain", 0.0, 100.0, "1/rad")
            check.number("integral_gain", 0.0, 100.0, "1/(rad s)")
            check.number("turn", 0.0, pi, "rad")
            check.number("trunk_turn", 0.0, pi, "rad")


@dataclass(frozen=True, slots=True, kw_only=True)
class DepthHold:
    """Keeps a depth by the air in the hull.

    Let e be the depth of the root minus its target, and w its sinking speed. The fraction of the air that is kept is
    that of neutral buoyancy plus gain e + rate_gain w + integral_gain sum(e dt), within 0 and 1. It changes at a rate
    of ``pump`` at most. Errors beyond ``near`` are not integrated.
    """

    depth: float
    """Asked depth of the root below the level [m]."""
    gain: float = 2.0
    """Answer to the error [1/m]."""
    rate_gain: float = 4.0
    """Answer to the sinking speed [s/m]."""
    integral_gain: float = 0.1
    """Answer to the error that stays [1/(m s)]."""
    near: float = 0.1
    """Error up to which it adds up [m]; on the way down from the surface nothing is to be learnt."""
    pump: float = 0.25
    """Greatest rate at which the share of the air changes [1/s]."""

    def __post_init__(self) -> None:
        with Checks("depth_hold", self) as check:
            check.number("depth", 0.0, 1000.0, "m")
            check.number("gain", 0.0, 100.0, "1/m")
            check.number("rate_gain", 0.0, 100.0, "s/m")
            check.number("integral_gain", 0.0, 100.0, "1/(m s)")
            check.number("near", 0.0, 1000.0, "m")
            check.number("pump", 1e-3, 100.0, "1/s")


def neutral_air_fraction(robot: Robot) -> float:
    """Return the fraction of its hull's air with which a robot under fresh water neither sinks nor rises [-].

    Raises:
        InvalidDesign: its hull has no air, or not enough of it.
    """
    return 1.0 - spare_volume(robot) / sum(chambers(robot))


class HeadingHolds:
    """The heading holds of a batch."""

    def __init__(
        self, rules: Sequence[HeadingHold | None], robots: Sequence[Robot], cycle: Sequence[int], period: float
    ) -> None:
        """Gather the gains of the batch.

        Args:
            rules: rule of each run; None for a run without one.
            robots: robot of each run.
            cycle: length of each gait's cycle in control periods.
            period: control period [s].
        """
        neutral_rule = HeadingHold(gain=0.0, integral_gain=0.0, turn=0.0, trunk_turn=0.0)
        active_rules = [rule or neutral_rule for rule in rules]
        self._direction, self._gain, self._integral, self._turn, self._trunk = (
            np.array([getattr(rule, name) for rule in active_rules])
            for name in ("direction", "gain", "integral_gain", "turn", "trunk_turn")
        )
        self._facing, self._period = HeadingEstimator(robots, cycle), period
        self._offset = np.zeros(len(active_rules))

    def bend(self, sensed: Sensed) -> tuple[Float[np.ndarray, " run"], Float[np.ndarray, " run"]]:
        """Return the mean bends of tail and trunk, left positive [rad]."""
        error, side = self._facing.feel(sensed) - self._direction, left_side_sign(sensed)
        # anti-windup: integrate only while a bend turns the robot
        self._offset = np.clip(self._offset - np.abs(side) * self._integral * error * self._period, -1.0, 1.0)
        hinge_counts = side * np.clip(self._offset - self._gain * error, -1.0, 1.0)
        return self._turn * hinge_counts, self._trunk * hinge_counts


class DepthHolds:
    """The depth holds of a batch."""

    def __init__(self, rules: Sequence[DepthHold | None], robots: Sequence[Robot], period: float) -> None:
        """Gather the gains of the batch, and the air with which each robot is neutrally buoyant.

        Args:
            rules: rule of each run; None for a run without one.
            robots: robot of each run.
            period: control period [s].
        """
        self._is_active = np.array([rule is not None for rule in rules])
        neutral_rule = DepthHold(depth=0.0)
        active_rules = [rule or neutral_rule for rule in rules]
        self._rule = {
            name: np.array([getattr(rule, name) for rule in active_rules]) for name in DepthHold.__dataclass_fields__
        }
        self._neutral = np.array(
            [1.0 if rule is None else neutral_air_fraction(robot) for rule, robot in zip(rules, robots, strict=True)]
        )
        self._period, self._decay = period, decay_factor(0.2, period)
        self._previous_depth: np.ndarray | None = None
        self._sinking, self._offset = np.zeros(len(active_rules)), np.zeros(len(active_rules))
        self._air_fraction = np.ones(len(active_rules))

    def air_fraction(self, sensed: Sensed) -> Float[np.ndarray, " run"] | None:
        """Return the fraction of the air that each robot keeps, NaN for a run without a rule [-]."""
        if sensed.depth is None or not self._is_active.any():
            return None
        rule, depth = self._rule, finite(sensed.depth)
        speed = np.zeros_like(depth) if self._previous_depth is None else (depth - self._previous_depth) / self._period
        self._previous_depth = depth
        self._sinking = speed + self._decay * (self._sinking - speed)
        error = depth - rule["depth"]
        offset = self._offset + rule["integral_gain"] * error * self._period
        target_fraction = self._neutral + rule["gain"] * error + rule["rate_gain"] * self._sinking + offset
        # anti-windup: integrate only within the limits of the air
        is_answerable = (target_fraction >= 0.0) & (target_fraction <= 1.0) & (np.abs(error) <= rule["near"])
        self._offset = np.where(is_answerable, offset, self._offset)
        max_step = rule["pump"] * self._period
        self._air_fraction = self._air_fraction + np.clip(
            np.clip(target_fraction, 0.0, 1.0) - self._air_fraction, -max_step, max_step
        )
        return np.where(self._is_active, self._air_fraction, np.nan)
