"""Open loop: the gait as a table of servo angles over time."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.control.controller import Command, Runs
from suchus.control.sensed import Sensed
from suchus.motion import intended


@dataclass(frozen=True, slots=True)
class OpenLoop:
    """Commands that follow the gait's clock and nothing else."""

    @property
    def feels(self) -> bool:
        """Nothing is sensed."""
        return False

    @staticmethod
    def start(runs: Runs, period: float) -> "GaitTable":
        """Tabulate every gait; runs with the same robot and gait share their rows."""
        pairs = list(zip(runs.robots, runs.gaits, strict=True))
        unique = {pair: i for i, pair in enumerate(dict.fromkeys(pairs))}
        time = np.arange(runs.ticks) * period
        tables = [intended(robot, gait, time) for robot, gait in unique]
        phase, targets = np.stack([table.phase for table in tables]), np.stack([table.targets for table in tables])
        return GaitTable(targets, phase, np.array([unique[pair] for pair in pairs]))


class GaitTable:
    """Servo angles and limb phases of every distinct gait of a batch, by tick."""

    def __init__(
        self,
        targets: Float[np.ndarray, "gait tick servo"],
        phase: Float[np.ndarray, "gait tick limb"],
        row: np.ndarray,
    ) -> None:
        self._targets = targets
        self._phase = phase
        self._row = row

    def rest(self) -> Float[np.ndarray, "run servo"]:
        """The first row."""
        return self._targets[self._row, 0]

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Look up one tick."""
        del sensed
        return Command(self._targets[self._row, tick], self._phase[self._row, tick])


controller = OpenLoop
