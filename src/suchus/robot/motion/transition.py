"""From one gait's posture to another's, a diagonal pair of legs after the other."""

from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.article.paper import LIMB_REACH
from suchus.robot.design import Robot, layout, servo_ranges
from suchus.robot.design.scale import gravity_time
from suchus.robot.motion.gait import Gait
from suchus.robot.motion.limbs import Steer
from suchus.robot.motion.movement import movement

MIN_TRANSITION_HEIGHT = 0.090 / LIMB_REACH
"""Least height of the hips at which limbs change their posture [limb reach]: a folded limb needs room."""
LIFT_HEIGHT = 0.2
"""How high limbs are lifted while they turn [reach of the hindmost limb]."""
_TIMES = (0.6, 0.3, 0.5, 0.3, 0.3, 0.5, 0.3, 0.7)  # durations between keys [s]
_LENGTH = 1.01  # length of the body for which the times are [m]
_STANDING = 0.999  # [cycle]; a phase at which every foot is meant to stand


class Transition(NamedTuple):
    """A sequence of postures, each reached from the one before without a jolt; it starts wherever the robot is."""

    times: Float[np.ndarray, " key"]
    """Time at which each posture is reached, since the beginning [s]."""
    targets: Float[np.ndarray, "key servo"]
    """Servo angles [rad]."""

    @property
    def duration(self) -> float:
        """Duration of the whole transition [s]."""
        return float(self.times[-1])

    def angles_at(self, time: float, start: Float[np.ndarray, " servo"]) -> Float[np.ndarray, " servo"]:
        """Return the servo angles at a time [rad].

        Args:
            time: time since the beginning of the transition [s].
            start: servo angles at that beginning [rad].
        """
        i = int(np.searchsorted(self.times, time, side="right"))
        if i >= len(self.times):
            return self.targets[-1]
        since, previous = (self.times[i - 1], self.targets[i - 1]) if i > 0 else (0.0, start)
        fraction = np.clip((time - since) / (self.times[i] - since), 0.0, 1.0)
        return np.asarray(previous + (1.0 - np.cos(np.pi * fraction)) / 2.0 * (self.targets[i] - previous))


def transition_duration(robot: Robot) -> float:
    """Return the duration of a change of gait [s]: 3.5 s for a body of a metre, less for a smaller one."""
    return float(_key_times(robot)[-1])


def _key_times(robot: Robot) -> Float[np.ndarray, " key"]:
    """Return the times at which the postures of a change of gait are reached, since its beginning [s]."""
    return np.asarray(gravity_time(robot.length) / gravity_time(_LENGTH) * np.cumsum(_TIMES))


@lru_cache(maxsize=64)
def transition(robot: Robot, old_gait: Gait, new_gait: Gait) -> Transition:
    """Return the course from one gait's posture to another's, which takes ``transition_duration``.

    The robot stops and goes to a height at which both postures can stand. Then the limbs that swing in the first half
    of a cycle, LF and RH of four, are lifted, take their new posture and are put down; the others follow; then it goes
    to the height of the new gait. The axis is straight and changes its steady bends with the limbs.

    Args:
        robot: the design.
        old_gait: the gait that it leaves.
        new_gait: the gait that it begins.
    """
    place = layout(robot)
    is_first_pair = np.array(
        [(phase - old_gait.limb_phases[0] + 0.25) % 1.0 < 0.5 for phase in old_gait.limb_phases], dtype=bool
    )
    reach = place.limbs[-1].girdle.limb.reach if place.limbs else 0.0
    height = max(MIN_TRANSITION_HEIGHT, min(old_gait.height, new_gait.height))
    old, new = replace(old_gait, height=height), replace(new_gait, height=height)

    def standing(gait: Gait, lifted: np.ndarray) -> np.ndarray:
        steer = Steer(size=0.0, lowering=-LIFT_HEIGHT * reach * lifted[None])
        phase = np.full((1, len(place.limbs)), _STANDING)
        return np.asarray(movement(robot, gait).targets(phase, np.zeros(1, dtype=complex), steer)[0])

    def mixed(is_turned: np.ndarray, lifted: np.ndarray) -> np.ndarray:
        """Return the servo angles while some limbs have their new posture; the axis mixes both by their number.

        Args:
            is_turned: which limbs have their new posture.
            lifted: which limbs are lifted.
        """
        old_targets, new_targets = standing(old, lifted), standing(new, lifted)
        fraction = is_turned.mean() if is_turned.size else 1.0
        targets = (1.0 - fraction) * old_targets + fraction * new_targets
        for limb, is_new in zip(place.limbs, is_turned, strict=True):
            targets[limb.servos] = (new_targets if is_new else old_targets)[limb.servos]
        return targets

    no_limb = np.zeros(len(place.limbs), dtype=bool)
    keys = [mixed(no_limb, no_limb)]
    for previous_mask, pair in ((no_limb, is_first_pair), (is_first_pair, ~is_first_pair)):
        next_mask = previous_mask | pair
        keys += [mixed(previous_mask, pair), mixed(next_mask, pair), mixed(next_mask, no_limb)]
    lower_bound, upper_bound = servo_ranges(robot).T
    return Transition(
        _key_times(robot), np.clip(np.array([*keys, standing(new_gait, no_limb)]), lower_bound, upper_bound)
    )
