"""Holding a pitch under water: air moves between the front and the rear chambers of the hull."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from jaxtyping import Float

from suchus.core import rotation
from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign
from suchus.robot.control.sensed import Sensed, decay_factor, finite
from suchus.robot.design import Robot
from suchus.robot.design.pieces import chambers


@dataclass(frozen=True, slots=True, kw_only=True)
class PitchHold:
    """Keeps the pitch of a swim under water by air that moves between the chambers of the hull.

    Let theta be the pitch minus its target, nose down positive, and q its rate, both low-pass-filtered because a
    swimming robot pitches periodically. The fraction of the hull's air that moves from the rear to the front chambers
    is gain theta + rate_gain q + integral_gain sum(theta dt), within the limits of the chambers. It changes at a rate
    of ``pump`` at most.
    """

    pitch: float = 0.0
    """Asked pitch, nose down positive [rad]."""
    dive: float = 0.0
    """How much more it pitches nose down for each metre that it is too high, and nose up where it is too deep [rad/m]:
    so that the swim itself takes it there."""
    steepest: float = 0.3
    """Greatest change of the asked pitch by ``dive`` [rad]."""
    gain: float = 0.2
    """Answer to the error of the pitch [1/rad]; 0.1 of the floating caiman's air rights it as much as 25 degrees do."""
    rate_gain: float = 0.4
    """Answer to its rate [s/rad]."""
    integral_gain: float = 0.02
    """Answer to the error that stays [1/(rad s)]."""
    memory: float = 0.5
    """Time constant of the low pass [s]."""
    pump: float = 0.1
    """Greatest rate at which the share of the air that has moved changes [1/s]."""

    def __post_init__(self) -> None:
        with Checks("pitch_hold", self) as check:
            check.number("pitch", -pi / 3, pi / 3, "rad")
            check.number("dive", 0.0, 100.0, "rad/m")
            check.number("steepest", 0.0, pi / 3, "rad")
            check.number("gain", 0.0, 100.0, "1/rad")
            check.number("rate_gain", 0.0, 100.0, "s/rad")
            check.number("integral_gain", 0.0, 100.0, "1/(rad s)")
            check.number("memory", 0.0, 60.0, "s")
            check.number("pump", 1e-3, 100.0, "1/s")


class PitchHolds:
    """The pitch holds of a batch.

    Args:
        rules: rule of each run, None for none.
        depths: depths that the runs hold, NaN for none [m].
        robots: robot of each run.
        period: control period [s].

    Raises:
        InvalidDesign: a robot whose pitch is held has no front or no rear chamber.
    """

    def __init__(
        self, rules: Sequence[PitchHold | None], depths: Sequence[float], robots: Sequence[Robot], period: float
    ) -> None:
        neutral_rule = PitchHold(gain=0.0, rate_gain=0.0, integral_gain=0.0)
        self._is_active = np.array([rule is not None for rule in rules])
        self._rule = {
            name: np.array([getattr(rule or neutral_rule, name) for rule in rules])
            for name in PitchHold.__dataclass_fields__
        }
        for rule, robot in zip(rules, robots, strict=True):
            if rule is not None and min(chambers(robot)) == 0.0:
                raise InvalidDesign(
                    f"the pitch of robot {robot.name!r} is held, and its hull has no air that could move between a "
                    "front and a rear chamber: give it design.Hull.chambers, or leave out swimming.pitch."
                )
        air = np.array([chambers(robot) for robot in robots])
        air[air.sum(axis=1) == 0.0] = 1.0
        self._share = air / air.sum(axis=1, keepdims=True)
        self._asked_depth, self._period = np.array(depths), period
        self._decay = np.array([decay_factor(value, period) for value in self._rule["memory"]])
        self._filtered: np.ndarray | None = None
        self._offset, self._air_shift = np.zeros(len(rules)), np.zeros(len(rules))

    def split(self, air_fraction: Float[np.ndarray, " run"], sensed: Sensed) -> Float[np.ndarray, "run 2"]:
        """Return the fraction of the air that the front and the rear chambers keep [-].

        Args:
            air_fraction: share of the whole air that is kept, NaN where it is not commanded [-].
            sensed: sensor readings of the robots.
        """
        rule, (front, rear) = self._rule, self._share.T
        error = rotation.pitch(finite(sensed.orientation)) - self._target_pitch(sensed)
        reading = np.stack([error, finite(sensed.angular_velocity)[:, 1]])
        self._filtered = reading if self._filtered is None else reading + self._decay * (self._filtered - reading)
        theta, rate = self._filtered
        offset = self._offset + rule["integral_gain"] * theta * self._period
        target_shift = offset + rule["gain"] * theta + rule["rate_gain"] * rate
        max_step = rule["pump"] * self._period
        next_shift = self._air_shift + np.clip(target_shift - self._air_shift, -max_step, max_step)
        retained_fraction = finite(air_fraction)
        # chambers cannot be more than empty or full
        min_shift = np.maximum(-retained_fraction * front, -(1.0 - retained_fraction) * rear)
        max_shift = np.minimum((1.0 - retained_fraction) * front, retained_fraction * rear)
        self._air_shift = np.where(self._is_active, np.clip(next_shift, min_shift, max_shift), 0.0)
        # anti-windup: integrate only within the limits of the chambers
        is_answerable = (target_shift >= min_shift) & (target_shift <= max_shift)
        self._offset = np.where(is_answerable, offset, self._offset)
        fraction = np.where(self._share > 0.0, self._share, 1.0)
        return np.asarray(air_fraction[:, None] + self._air_shift[:, None] * _TO_AND_FRO / fraction)

    def _target_pitch(self, sensed: Sensed) -> Float[np.ndarray, " run"]:
        """Return the target pitch of each run, nose down positive [rad]."""
        rule = self._rule
        if sensed.depth is None:
            return np.asarray(rule["pitch"])
        height_error = finite(self._asked_depth - finite(sensed.depth))
        return np.asarray(rule["pitch"] + np.clip(rule["dive"] * height_error, -rule["steepest"], rule["steepest"]))


_TO_AND_FRO = np.array([1.0, -1.0])
"""Air that moves ahead comes to the front chambers and from the rear ones."""
