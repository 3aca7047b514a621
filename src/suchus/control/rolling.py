"""The death roll as a control: a table of servo angles over time, legs folded back."""

from dataclasses import dataclass

import numpy as np

from suchus.control.controller import Runs
from suchus.control.open_loop import GaitTable
from suchus.control.suited import crocodiles
from suchus.design import layout
from suchus.motion import Roll, check_roll, roll_targets


@dataclass(frozen=True, slots=True)
class Rolling:
    """Commands of a roll from time zero; the gait of the run is not asked, its limbs have no phase of their own."""

    roll: Roll
    """The motion."""

    @property
    def feels(self) -> bool:
        """Nothing is sensed."""
        return False

    @staticmethod
    def start(runs: Runs, period: float) -> GaitTable:
        """Tabulate the rolls of a batch, one per run.

        Raises:
            OutsideLimits: a robot cannot follow its roll.
        """
        ticks = runs.ticks
        ours = crocodiles(runs.robots, "a death roll")
        pairs = [(control.roll, robot) for control, robot in zip(runs.controls, ours, strict=True)]
        unique = {pair: i for i, pair in enumerate(dict.fromkeys(pairs))}
        time = np.arange(ticks) * period
        targets = np.empty((len(unique), ticks, len(layout(ours[0]).servos)))
        phase = np.empty((len(unique), ticks, 4))
        for (roll, robot), i in unique.items():
            check_roll(robot, roll)
            targets[i] = roll_targets(robot, roll, time)
            phase[i] = (roll.frequency * time)[:, None]
        return GaitTable(targets, phase, np.array([unique[pair] for pair in pairs]))


_ROLL = Roll(
    frequency=0.5, trunk_lateral=0.2, trunk_vertical=0.2, tail_lateral=0.2, tail_vertical=0.2, lag=0.25, tail_lag=0.25
)
controller = Rolling
examples = (Rolling(_ROLL),)
