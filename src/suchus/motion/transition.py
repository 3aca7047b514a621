"""From one gait's posture to another's, a diagonal pair of legs after the other."""

from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.design import AnyRobot, Crocodile, crocodile, layout
from suchus.motion.gait import Gait
from suchus.motion.targets import servo_range, servo_targets

MEETING = 0.090
"""Least height of the hips at which legs change their posture [m]: a folded leg needs room."""
RAISED = 0.035
"""How high a pair is lifted while it turns [m]."""
_TIMES = (0.6, 0.3, 0.5, 0.3, 0.3, 0.5, 0.3, 0.7)  # [s]; between one key and the next
_PAIRS = ((0, 3), (1, 2))  # LF and RH, then RF and LH
_STANDING = 0.999  # [cycle]; a phase at which every foot is meant to stand


class Transition(NamedTuple):
    """A sequence of postures, each reached from the one before without a jolt; it starts wherever the robot is."""

    times: Float[np.ndarray, " key"]
    """When each posture is reached, since the beginning [s]."""
    targets: Float[np.ndarray, "key servo"]
    """Servo angles [rad]."""

    @property
    def duration(self) -> float:
        """Of the whole [s]."""
        return float(self.times[-1])

    def at(self, time: float, start: Float[np.ndarray, " servo"]) -> Float[np.ndarray, " servo"]:
        """Return the servo angles at a time, having begun with the angles ``start`` [rad]."""
        i = int(np.searchsorted(self.times, time, side="right"))
        if i >= len(self.times):
            return self.targets[-1]
        since, before = (self.times[i - 1], self.targets[i - 1]) if i > 0 else (0.0, start)
        share = np.clip((time - since) / (self.times[i] - since), 0.0, 1.0)
        return np.asarray(before + (1.0 - np.cos(np.pi * share)) / 2.0 * (self.targets[i] - before))


@lru_cache(maxsize=64)
def transition(robot: AnyRobot, here: Gait, there: Gait, *, slower: float = 1.0) -> Transition:
    """Return the way from one gait's posture to another's: 3.5 s.

    The robot stops and goes to a height at which both postures can stand. Then LF and RH are lifted, take their new
    posture and are put down; RF and LH follow; then it goes to the height of the new gait.

    Args:
        robot: the design.
        here: the gait that it leaves.
        there: the gait that it begins.
        slower: factor on all times [-].
    """
    robot = crocodile(robot, "a change of gait")
    height = max(MEETING, min(here.hip_height, there.hip_height))
    old, new = replace(here, hip_height=height), replace(there, hip_height=height)
    legs = [old, old]  # of the first and the second pair
    keys = [_posture(robot, legs, (0.0, 0.0))]
    for pair in (0, 1):
        lift = (RAISED, 0.0) if pair == 0 else (0.0, RAISED)
        keys.append(_posture(robot, legs, lift))
        legs[pair] = new
        keys += [_posture(robot, legs, lift), _posture(robot, legs, (0.0, 0.0))]
    keys.append(_posture(robot, [there, there], (0.0, 0.0)))
    return Transition(slower * np.cumsum(_TIMES), np.array(keys))


def _posture(robot: Crocodile, gaits: list[Gait], lift: tuple[float, float]) -> np.ndarray:
    """Return the servo angles of a posture with straight trunk and tail, each pair of legs in its own gait."""
    place = layout(robot)
    targets = np.zeros(len(place.servos))
    for gait, pair, raised in zip(gaits, _PAIRS, lift, strict=True):
        still = replace(gait, stroke=0.0)
        lower = np.full(4, -raised)
        angles = servo_targets(
            robot, still, np.full(4, _STANDING), trunk=np.zeros(()), tail=np.zeros(()), lower=lower, clip=True
        )
        for leg in pair:
            targets[place.limbs[leg].servos] = angles[place.limbs[leg].servos]
        targets[place.tail_pitch[0]] += angles[place.tail_pitch[0]] / 2
    for i, name in enumerate(place.servos):
        targets[i] = np.clip(targets[i], *servo_range(robot, name))
    return targets
