"""Attitude feedback: the height of the feet is changed by the roll and pitch that the IMU measures."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.article.paper import LIMB_REACH
from suchus.core import rotation
from suchus.core.checks import Checks
from suchus.robot.control.sensed import Sensed, decay_factor, finite
from suchus.robot.design import Robot, hips_ahead, layout
from suchus.robot.design.scale import gravity_time


@dataclass(frozen=True, slots=True, kw_only=True)
class AttitudeRule:
    """Keeps the body level over uneven ground: feet on the side that sinks push down, on the side that rises give way.

    With w a hip's distance from the midline and x its distance ahead of the middle between the girdles, a foot is
    lowered by -w (roll gain + roll rate gain) to the left of the midline, by the opposite to the right, and by
    x (pitch gain + pitch rate gain). Roll counts with the left side up, pitch with the nose down.

    The rates are those of the gyro, low-pass-filtered: unfiltered, every footfall shakes the servos. Times are those of
    the article's robot. For another robot they grow with the root of its length, as the time of a fall does.
    """

    roll: float = 1.0
    """Part of the roll that the feet make up for at once [-]; 1 levels the hips."""
    roll_rate: float = 0.1
    """The same for how fast it rolls [s]."""
    pitch: float = 0.7
    """Part of the pitch that the feet make up for at once [-]."""
    pitch_rate: float = 0.06
    """The same for how fast it pitches [s]."""
    memory: float = 0.04
    """Time constant of the low pass on both rates [s]; 0 for none."""
    washout: float = 3.0
    """Time over which roll and pitch are compared with their own means [s]: a slope is no stumble."""
    most: float = 0.03
    """Most that a foot is raised or lowered [m], with limbs as long as those of the article's robot; a leg gives little
    more. Other limbs as much of their reach."""

    def __post_init__(self) -> None:
        with Checks("attitude_rule", self) as checks:
            for field in ("roll", "roll_rate", "pitch", "pitch_rate"):
                checks.number(field, -10.0, 10.0, "")
            checks.number("memory", 0.0, 60.0, "s")
            checks.number("washout", 0.1, 600.0, "s")
            checks.number("most", 0.0, 0.1, "m")


class Attitude:
    """The attitude feedback of a batch; each run has its own rule or none."""

    def __init__(self, rules: Sequence[AttitudeRule | None], robots: Sequence[Robot], period: float) -> None:
        """Gather gains and hip positions of the batch.

        Args:
            rules: rule of each run; None for a run without one.
            robots: robot of each run.
            period: control period [s].
        """
        active_rules = [rule if rule is not None else _INACTIVE_RULE for rule in rules]
        time_scale = np.array([_time_scale(robot) for robot in robots])
        # shape (2, run, 1): roll and pitch
        self._gain = np.array([(rule.roll, rule.pitch) for rule in active_rules]).T[..., None]
        rate_gain = np.array([(rule.roll_rate, rule.pitch_rate) for rule in active_rules]).T
        self._rate_gain = (rate_gain * time_scale)[..., None]
        self._max_lift = np.array(
            [[rule.most * _size(robot)] for rule, robot in zip(active_rules, robots, strict=True)]
        )
        self._keep, self._rate_keep = (
            np.array(
                [
                    decay_factor(getattr(rule, name) * scale, period)
                    for rule, scale in zip(active_rules, time_scale, strict=True)
                ]
            )
            for name in ("washout", "memory")
        )
        self._lateral_offset = np.array(
            [[limb.side * limb.girdle.aside for limb in layout(robot).limbs] for robot in robots]
        )
        self._forward_offset = np.array([_hips_forward_of_center(robot) for robot in robots])
        self._mean, self._rate = np.zeros((2, len(robots))), np.zeros((2, len(robots)))
        self._is_initialised = False

    def foot_lowering(self, sensed: Sensed) -> Float[np.ndarray, "run limb"]:
        """Return how much lower each foot goes [m]."""
        tilt = np.stack([rotation.roll(sensed.orientation), rotation.pitch(sensed.orientation)])
        if not self._is_initialised:
            self._mean, self._is_initialised = tilt.copy(), True
        self._mean = tilt + self._keep * (self._mean - tilt)
        rate = finite(sensed.angular_velocity)[:, :2].T
        self._rate = rate + self._rate_keep * (self._rate - rate)
        roll, pitch = self._gain * (tilt - self._mean)[..., None] + self._rate_gain * self._rate[..., None]
        foot_lowering = -self._lateral_offset * roll + self._forward_offset * pitch
        return np.asarray(np.clip(np.nan_to_num(foot_lowering), -self._max_lift, self._max_lift))


_LENGTH = 1.01
"""Length of the robot for which the times of the rule are [m]."""
_INACTIVE_RULE = AttitudeRule(roll=0.0, roll_rate=0.0, pitch=0.0, pitch_rate=0.0)


def _hips_forward_of_center(robot: Robot) -> list[float]:
    """Return how far each limb's hips are ahead of the middle between the foremost and the hindmost girdle [m]."""
    hips = [hips_ahead(robot, limb.number) for limb in layout(robot).limbs]
    center = (hips[0] + hips[-1]) / 2 if hips else 0.0
    return [hip - center for hip in hips]


def _size(robot: Robot) -> float:
    """Return the reach of the hind limbs over that of the article's robot [-]."""
    limbs = layout(robot).limbs
    return round(limbs[-1].girdle.limb.reach / LIMB_REACH, 9) if limbs else 1.0


def _time_scale(robot: Robot) -> float:
    """Return the time that the robot takes to fall over that of the article's robot, by their lengths [-]."""
    return round(gravity_time(robot.length) / gravity_time(_LENGTH), 9)
