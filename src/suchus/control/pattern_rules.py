"""The article's rules of spine and tail over a pattern generator."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from suchus.control.sensed import Sensed
from suchus.control.spine import SpineController, SpineRule
from suchus.control.tail import TailController, TailRule
from suchus.design import Robot, layout
from suchus.errors import UnsuitedRobot
from suchus.motion import Gait


class Rules:
    """The rules of spine and tail, for those runs of a batch that have them."""

    def __init__(
        self,
        spines: Sequence[SpineRule | None],
        tails: Sequence[TailRule | None],
        robots: Sequence[Robot],
        gaits: Sequence[Gait],
        period: float,
    ) -> None:
        self._yaw = list(layout(robots[0]).trunk_yaw)
        self._spined = [i for i, one in enumerate(spines) if one is not None]
        self._tailed = [i for i, one in enumerate(tails) if one is not None]
        self._spine: SpineController | None = None
        self._tail: TailController | None = None
        if self._spined:
            if not self._yaw:
                raise UnsuitedRobot(
                    f"the rule spine to spine needs servos that bend the trunk sideways; robot {robots[0].name!r} "
                    "lacks them: leave spine out."
                )
            self._spine = SpineController([spines[i] for i in self._spined], [robots[i] for i in self._spined], period)
        if self._tailed:
            self._tail = TailController(
                [tails[i] for i in self._tailed],
                [robots[i] for i in self._tailed],
                [_with_tail(robots[i], gaits[i]) for i in self._tailed],
                period,
            )

    def correct(self, targets: Float[np.ndarray, "run servo"], sensed: Sensed) -> Float[np.ndarray, "run servo"]:
        """Return the targets as the rules change them."""
        if self._spine is not None:
            mine = targets[self._spined]
            asked = mine[:, self._yaw].sum(axis=1)
            targets[self._spined] = self._spine.correct(mine, asked, _felt(sensed, self._spined))
        if self._tail is not None:
            targets[self._tailed] = self._tail.correct(targets[self._tailed], _felt(sensed, self._tailed))
        return targets


def _with_tail(robot: Robot, gait: Gait) -> Gait:
    if not (gait.has("tail pitch") and layout(robot).tail_pitch):
        raise UnsuitedRobot(
            f"the rule tail to tail needs a servo that pitches the tail and a gait that lays it down, as "
            f"'belly_crawl'; robot {robot.name!r} with gait {gait.name!r} lacks them: leave tail out."
        )
    return gait


def _felt(sensed: Sensed, runs: list[int]) -> Sensed:
    """Return the readings of some runs, as far as spine and tail read them."""
    return replace(sensed, servo_position=sensed.servo_position[runs], servo_torque=sensed.servo_torque[runs])
