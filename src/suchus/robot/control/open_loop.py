"""Open loop: the gait as a table of servo angles over time."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks
from suchus.robot.control.controller import Command, Runs
from suchus.robot.control.sensed import Sensed
from suchus.robot.design.skeleton import skeleton
from suchus.robot.motion import START, intended


@dataclass(frozen=True, slots=True)
class OpenLoop:
    """Commands that follow the gait's clock and nothing else."""

    begin: float = START
    """Time at which the gait begins; until then its first posture is held [s]."""
    ramp: float = 0.0
    """Duration from then on over which strokes and bends grow from zero, without a jolt at either end [s]."""

    def __post_init__(self) -> None:
        with Checks("open_loop", self) as check:
            check.number("begin", 0.0, 86400.0, "s")
            check.number("ramp", 0.0, 86400.0, "s")

    @property
    def feels(self) -> bool:
        """Nothing is sensed."""
        return False

    @property
    def needs(self) -> tuple[str, ...]:
        """Nothing."""
        return ()

    @staticmethod
    def start(runs: Runs, period: float) -> "GaitTable":
        """Tabulate every distinct gait; runs with one skeleton, gait and control share their table.

        Raises:
            OutsideLimits: a gait of measured curves is to grow over a ramp.
        """
        keys = list(zip(runs.controls, map(skeleton, runs.robots), runs.gaits, strict=True))
        unique = {key: i for i, key in enumerate(dict.fromkeys(keys))}
        for control, _, gait in unique:
            if control.ramp > 0.0:
                gait.needs_steering("a ramp over which strokes and bends grow")
        time = np.arange(runs.ticks) * period
        tables = [
            intended(robot, gait, time, begin=control.begin, ramp=control.ramp) for control, robot, gait in unique
        ]
        phase, targets = np.stack([table.phase for table in tables]), np.stack([table.targets for table in tables])
        return GaitTable(targets, phase, np.array([unique[key] for key in keys]))


class GaitTable:
    """Servo angles and limb phases of every distinct gait of a batch, by tick."""

    def __init__(
        self,
        targets: Float[np.ndarray, "gait tick servo"],
        phase: Float[np.ndarray, "gait tick limb"],
        row: np.ndarray,
    ) -> None:
        """Hold the tables of a batch.

        Args:
            targets: servo angles of every distinct gait [rad].
            phase: phases of the limbs in every distinct gait [cycle].
            row: index of the gait of each run.
        """
        self._targets = targets
        self._phase = phase
        self._row = row

    def rest(self) -> Float[np.ndarray, "run servo"]:
        """The first row."""
        return self._targets[self._row, 0]

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Return the servo angles and phases of one control period from the tables."""
        del sensed
        return Command(self._targets[self._row, tick], self._phase[self._row, tick])


controller = OpenLoop
