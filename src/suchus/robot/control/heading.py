"""A heading loop: the stroke of one side is changed by the error of the heading that the IMU measures."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from suchus.core.checks import Checks
from suchus.core.errors import OutsideLimits
from suchus.robot.control.facing import HeadingEstimator
from suchus.robot.control.sensed import Sensed
from suchus.robot.control.trunk_effect import no_trunk_steering
from suchus.robot.design import Robot, layout, servo_ranges
from suchus.robot.gaits import MIN_TRUNK_STEERING, trunk_steering
from suchus.robot.motion import Gait, max_stroke_factor, trunk_amplitude


@dataclass(frozen=True, slots=True, kw_only=True)
class HeadingRule:
    """Keeps the body's direction by walking with longer strokes on one side.

    The body's direction is that of the pelvis by the IMU plus half of the trunk's sensed bend. With psi its error,
    averaged over the last cycle, and T the period, the legs' strokes become A (1 - u) on the left and A (1 + u) on
    the right, and u = -(gain psi + integral_gain sum(psi dt)/T). The trunk's bend is shifted by ``trunk`` u. Strokes
    end at the limbs' reach and at the speed of their servos, the bend at the trunk's range, each by itself.

    The direction counts from the heading with which the walk begins. If the loop is switched on during a walk, it
    counts from the mean heading of the next cycle, in which nothing is steered.
    """

    direction: float = 0.0
    """Target heading, from the heading at the beginning of the walk, left positive [rad]."""
    gain: float = 3.0
    """Answer to the error [1/rad]; a unit of u turns the crawl by 0.3 to 0.5 rad a cycle, so 3 mends in one."""
    integral_gain: float = 1.0
    """Answer to the error that stays, per cycle [1/rad]; a limp leg needs a constant u of almost 2."""
    most: float = 2.0
    """Greatest size of u [-]; beyond 1 the shorter side strides backward. A leg's reach may allow less."""
    trunk: float | None = None
    """Lasting bend of the trunk per u, left positive [rad]; it helps where strokes have little effect. None:
    ``TRUNK_PER_STEERING`` toward the side to which a bend turns this robot in this gait, and 0 where that is not
    known, see ``suchus.robot.gaits.trunk_steering``."""
    rate: float = 4.0
    """Greatest change of u in a cycle [-], so that no servo is commanded to jump when the asked direction does."""

    def __post_init__(self) -> None:
        with Checks("heading_rule", self) as checks:
            checks.number("direction", -pi, pi, "rad")
            checks.number("gain", 0.0, 100.0, "1/rad")
            checks.number("integral_gain", 0.0, 100.0, "1/rad")
            checks.number("most", 0.0, 10.0, "")
            if self.trunk is not None:
                checks.number("trunk", -1.5, 1.5, "rad")
            checks.number("rate", 0.01, 1000.0, "")


TRUNK_PER_STEERING = 0.4
"""Lasting bend of the trunk per u, where a bend turns the robot [rad]."""


class Steering(NamedTuple):
    """What the heading loop adds to the posture."""

    stroke: Float[np.ndarray, "run limb"]
    """Fraction by which each leg's stroke is longer [-]."""
    trunk: Float[np.ndarray, " run"]
    """Lasting bend of the trunk [rad]."""

    @classmethod
    def straight(cls, runs: int, limbs: int) -> "Steering":
        """Return zero steering for every run."""
        return cls(np.zeros((runs, limbs)), np.zeros(runs))

    def is_active(self) -> Bool[np.ndarray, " run"]:
        """Return which runs are steered."""
        return self.stroke.any(axis=1) | (self.trunk != 0.0)


class Heading:
    """The heading loops of a batch."""

    def __init__(
        self,
        rules: Sequence[HeadingRule | None],
        robots: Sequence[Robot],
        gaits: Sequence[Gait],
        period: float,
    ) -> None:
        """Gather the gains of the batch, and the greatest steering u that limbs and trunk of each robot can follow.

        The steering u [-] makes strokes longer on one side and shorter on the other, and bends the trunk; see
        ``HeadingRule``.

        Args:
            rules: heading rule of each run; None for a run without one.
            robots: robot of each run; all have the same layout.
            gaits: gait of each run.
            period: control period [s].
        """
        neutral_rule = HeadingRule(gain=0.0, integral_gain=0.0, trunk=0.0)
        filled_rules = [rule or neutral_rule for rule in rules]
        self._target_heading, self._gain, self._integral_gain = (
            np.array([getattr(rule, name) for rule in filled_rules]) for name in ("direction", "gain", "integral_gain")
        )
        self._runs = np.arange(len(gaits))
        self._steps_per_cycle = np.array([max(1, round(gait.period / period)) for gait in gaits])
        setups = list(zip(filled_rules, robots, gaits, strict=True))
        self._bend_per_steering = np.array([_bend_per_steering(*setup) for setup in setups])
        self._max_stroke_steering = np.array([_max_stroke_steering(*setup) for setup in setups])
        self._max_bend = np.array([_max_steady_bend(robot, gait) for _, robot, gait in setups])
        # beyond both limits more steering changes nothing, and would only wind up the integral
        max_bend_steering = self._max_bend / np.where(
            self._bend_per_steering != 0.0, np.abs(self._bend_per_steering), np.inf
        )
        self._max_steering = np.minimum(
            np.array([rule.most for rule in filled_rules]), np.maximum(self._max_stroke_steering, max_bend_steering)
        )
        self._max_change_per_step = np.array([rule.rate for rule in filled_rules]) / self._steps_per_cycle
        self._heading_estimator = HeadingEstimator(robots, [int(cycle) for cycle in self._steps_per_cycle])
        self._limb_sides = np.array([limb.side for limb in layout(robots[0]).limbs])
        self._error_integral, self._steering = np.zeros(len(gaits)), np.zeros(len(gaits))

    def begin_in_motion(self) -> None:
        """Count the direction from the mean heading of the coming cycle, for robots that walk already."""
        self._heading_estimator.begin_in_motion()

    def step(self, sensed: Sensed, *, walking: bool | Bool[np.ndarray, " run"]) -> Steering:
        """Return the steering that the present heading error demands.

        Args:
            sensed: sensor readings.
            walking: which runs walk; the others are not steered, and begin anew with what stays. False: nothing is felt
                either.
        """
        if walking is False:
            return Steering.straight(len(self._runs), len(self._limb_sides))
        error = self._heading_estimator.feel(sensed) - self._target_heading
        is_steered = walking & self._heading_estimator.has_reference
        step = -self._integral_gain * error / self._steps_per_cycle
        demand = self._error_integral + step - self._gain * error
        # anti-windup: integrate toward a limit only up to it
        is_answerable = (np.abs(demand) <= self._max_steering) | (demand * step < 0.0)
        self._error_integral = np.where(is_steered, self._error_integral + is_answerable * step, 0.0)
        target = np.clip(self._error_integral - self._gain * error, -self._max_steering, self._max_steering)
        change = np.clip(target - self._steering, -self._max_change_per_step, self._max_change_per_step)
        self._steering = np.where(is_steered, self._steering + change, 0.0)
        stroke = np.clip(self._steering, -self._max_stroke_steering, self._max_stroke_steering)
        bend = np.clip(self._bend_per_steering * self._steering, -self._max_bend, self._max_bend)
        return Steering(-self._limb_sides * stroke[:, None], bend)

    def take_over(self, predecessor: "Heading") -> None:
        """Continue from the loops of the same runs."""
        self._heading_estimator.take_over(predecessor._heading_estimator)
        self._error_integral, self._steering = (
            np.clip(state, -self._max_steering, self._max_steering)
            for state in (predecessor._error_integral, predecessor._steering)
        )


def _max_stroke_steering(rule: HeadingRule, robot: Robot, gait: Gait) -> float:
    """Return the greatest steering command u that the limbs and their servos can follow [-]; 0 without strokes."""
    if not gait.has("strokes"):
        return 0.0
    if rule.gain == rule.integral_gain == 0.0:  # nothing steers; computing the limbs' reach would be slow
        return rule.most
    return min(rule.most, max(max_stroke_factor(robot, gait, limit_speed=True) - 1.0, 0.0))


def _max_steady_bend(robot: Robot, gait: Gait) -> float:
    """Return the curvature offset of the trunk that its servos allow beyond the swing of the gait [rad]."""
    yaw = list(layout(robot).trunk_yaw)
    max_bend = float(np.abs(servo_ranges(robot)[yaw]).min(axis=1, initial=np.inf).sum())
    return max(max_bend - trunk_amplitude(robot, gait), 0.0)


def _bend_per_steering(rule: HeadingRule, robot: Robot, gait: Gait) -> float:
    """Return the curvature offset of the trunk per u, left positive [rad].

    Raises:
        OutsideLimits: nothing is known that would turn the robot: the gait has no strokes, and the effect of a bend is
            unknown or too small.
    """
    if rule.trunk is not None:
        return rule.trunk
    turn_per_bend = trunk_steering(robot, gait)
    if turn_per_bend is None or abs(turn_per_bend) < MIN_TRUNK_STEERING:
        if not gait.has("strokes") and (rule.gain or rule.integral_gain):
            raise OutsideLimits(no_trunk_steering(robot, gait, "the heading loop", "heading_rule.trunk"))
        return 0.0
    return float(np.copysign(TRUNK_PER_STEERING, turn_per_bend))
