"""From one gait's posture to another's, a diagonal pair of legs after the other."""

from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.design import AnyRobot, layout, servo_ranges
from suchus.design.scale import gravity_time
from suchus.errors import OutsideLimits
from suchus.motion.gait import Gait
from suchus.motion.pattern import Pattern
from suchus.motion.steered import steered
from suchus.motion.targets import servo_range, servo_targets

MEETING = 0.090
"""Least height of the hips at which legs change their posture [m]: a folded leg needs room."""
RAISED = 0.035
"""How high a pair is lifted while it turns [m]."""
_TIMES = (0.6, 0.3, 0.5, 0.3, 0.3, 0.5, 0.3, 0.7)  # [s]; between one key and the next
_LIFT = 0.2  # [limb reach]; the same for the limbs of any body
_USUAL = 0.319  # [s]; gravity time of a body of a metre, for which ``_TIMES`` are
_PAIRS = ((0, 3), (1, 2))  # LF and RH, then RF and LH
_STANDING = 0.999  # [cycle]; a phase at which every foot is meant to stand


class Transition(NamedTuple):
    """A sequence of postures, each reached from the one before without a jolt; it starts wherever the robot is."""

    times: Float[np.ndarray, " key"]
    """Time at which each posture is reached, since the beginning [s]."""
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
def transition(robot: AnyRobot, here: Gait | Pattern, there: Gait | Pattern, *, slower: float = 1.0) -> Transition:
    """Return the course from one gait's posture to another's: 3.5 s for a body of a metre, less for a smaller one.

    The robot stops and goes to a height at which both postures can stand. Then LF and RH, or the limbs of any body that
    swing in the first half of a cycle, are lifted, take their new posture and are put down; the others follow; then it
    goes to the height of the new gait.

    Args:
        robot: the design.
        here: the gait that it leaves.
        there: the gait that it begins.
        slower: factor on all times [-].

    Raises:
        OutsideLimits: one is a gait of the article's kind, the other is not.
    """
    if isinstance(here, Gait) and isinstance(there, Gait):
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
    if isinstance(here, Gait) or isinstance(there, Gait):
        raise OutsideLimits(
            f"a change from gait {here.name!r} to {there.name!r} mixes a gait of the article's kind with a pattern of "
            "any body: choose two of one kind."
        )
    pace = slower * gravity_time(robot.length) / _USUAL
    return Transition(pace * np.cumsum(_TIMES), _of_any_body(robot, here, there))


def _of_any_body(robot: AnyRobot, here: Pattern, there: Pattern) -> np.ndarray:
    """Return the postures of a change between two patterns, shape (key, servo) [rad]."""
    place = layout(robot)
    early = np.array([(phase - here.limb_phases[0] + 0.25) % 1.0 < 0.5 for phase in here.limb_phases], dtype=bool)
    reach = np.array([limb.girdle.limb.reach for limb in place.limbs])
    height = max(here.height, there.height)
    old, new = replace(here, height=height), replace(there, height=height)

    def standing(gait: Pattern, lifted: np.ndarray) -> np.ndarray:
        return steered(
            robot,
            gait,
            np.full(len(place.limbs), _STANDING),
            trunk=np.zeros(()),
            size=np.zeros(()),
            stroke=np.ones(len(place.limbs)),
            lower=-_LIFT * reach * lifted,
        )

    def mixed(turned: np.ndarray, lifted: np.ndarray) -> np.ndarray:
        found, newer = standing(old, lifted), standing(new, lifted)
        for limb, now in zip(place.limbs, turned, strict=True):
            if now:
                found[limb.servos] = newer[limb.servos]
        return found

    none = np.zeros(len(place.limbs), dtype=bool)
    keys = [mixed(none, none)]
    for before, pair in ((none, early), (early, ~early)):
        after = before | pair
        keys += [mixed(before, pair), mixed(after, pair), mixed(after, none)]
    low, high = servo_ranges(robot).T
    return np.clip(np.array([*keys, standing(there, none)]), low, high)


def _posture(robot: AnyRobot, gaits: list[Gait], lift: tuple[float, float]) -> np.ndarray:
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
        for servo in place.tail_pitch[:1]:
            targets[servo] += angles[servo] / 2
    for i, name in enumerate(place.servos):
        targets[i] = np.clip(targets[i], *servo_range(robot, name))
    return targets
