"""A heading loop: the stroke of one side is changed by the error of the heading that the IMU measures."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float

from suchus.core.checks import Checks
from suchus.robot.control.facing import HeadingEstimator
from suchus.robot.control.sensed import Sensed
from suchus.robot.design import Robot, layout
from suchus.robot.motion import Gait, max_stroke_factor


@dataclass(frozen=True, slots=True, kw_only=True)
class HeadingRule:
    """Keeps the body's direction by walking with longer strokes on one side.

    The body's direction is that of the pelvis by the IMU plus half of the trunk's sensed bend. With psi its error,
    averaged over the last cycle, and T the period, the legs' strokes become A (1 - u) on the left and A (1 + u) on
    the right, and u = -(gain psi + integral_gain sum(psi dt)/T).
    """

    direction: float = 0.0
    """Asked direction against the one at the beginning of the walk, left positive [rad]."""
    gain: float = 3.0
    """Answer to the error [1/rad]; a unit of u turns the crawl by 0.3 to 0.5 rad a cycle, so 3 mends in one."""
    integral_gain: float = 1.0
    """Answer to the error that stays, per cycle [1/rad]; a limp leg needs a constant u of almost 2."""
    most: float = 2.0
    """Most that u becomes [-]; beyond 1 the shorter side strides backward. A leg's reach may allow less."""
    trunk: float = 0.4
    """Lasting bend of the trunk per u, left positive [rad]; it helps where strokes have little effect."""

    def __post_init__(self) -> None:
        with Checks("heading_rule", self) as checks:
            checks.number("direction", -pi, pi, "rad")
            checks.number("gain", 0.0, 100.0, "1/rad")
            checks.number("integral_gain", 0.0, 100.0, "1/rad")
            checks.number("most", 0.0, 10.0, "")
            checks.number("trunk", -1.5, 1.5, "rad")


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
        """Gather the gains of the batch, and the greatest steering that each robot's limbs allow.

        Args:
            rules: one for each run; None for a run without one.
            robots: one for each run.
            gaits: one for each run.
            period: of control [s].
        """
        neutral_rule = HeadingRule(gain=0.0, integral_gain=0.0, trunk=0.0)
        settings = [rule or neutral_rule for rule in rules]
        self._direction, self._gain, self._integral_gain, self._trunk = (
            np.array([getattr(rule, name) for rule in settings])
            for name in ("direction", "gain", "integral_gain", "trunk")
        )
        self._runs = np.arange(len(gaits))
        self._cycle = np.array([max(1, round(gait.period / period)) for gait in gaits])
        self._max_steering = np.array([_steering_limit(*setup) for setup in zip(settings, robots, gaits, strict=True)])
        self._facing = HeadingEstimator(robots, [int(cycle) for cycle in self._cycle])
        self._limb_sides = np.array([limb.side for limb in layout(robots[0]).limbs])
        self._offset = np.zeros(len(gaits))

    def step(self, sensed: Sensed, *, walking: bool | Bool[np.ndarray, " run"]) -> Steering:
        """Return the steering that the present heading error demands.

        Args:
            sensed: what is felt.
            walking: which runs walk; the others are not steered, and begin anew with what stays. False: nothing is felt
                either.
        """
        if walking is False:
            return Steering.straight(len(self._runs), len(self._limb_sides))
        error = self._facing.feel(sensed) - self._direction
        offset = np.clip(
            self._offset - self._integral_gain * error / self._cycle, -self._max_steering, self._max_steering
        )
        self._offset = np.where(walking, offset, 0.0)
        steer = np.where(
            walking, np.clip(self._offset - self._gain * error, -self._max_steering, self._max_steering), 0.0
        )
        return Steering(-self._limb_sides * steer[:, None], self._trunk * steer)

    def take_over(self, predecessor: "Heading") -> None:
        """Continue from the loops of the same runs; the mean over the last cycle starts again."""
        self._facing.take_over(predecessor._facing)
        self._offset = np.clip(predecessor._offset, -self._max_steering, self._max_steering)


def _steering_limit(rule: HeadingRule, robot: Robot, gait: Gait) -> float:
    """Return the greatest steering command u that the limbs can follow [-]; 0 in a gait without strokes."""
    if not gait.has("strokes"):
        return 0.0
    if rule.gain == rule.integral_gain == 0.0:  # nothing steers; computing the limbs' reach would be slow
        return rule.most
    return min(rule.most, max(max_stroke_factor(robot, gait) - 1.0, 0.0))
