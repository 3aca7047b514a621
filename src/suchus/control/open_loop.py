"""Open loop: the gait as a table of servo angles over time."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.control.controller import Command
from suchus.control.sensed import Sensed
from suchus.design import Crocodile
from suchus.motion import Gait, limb_phase, servo_targets


@dataclass(frozen=True, slots=True)
class OpenLoop:
    """Commands that follow the gait's clock and nothing else."""

    @property
    def feels(self) -> bool:
        """Nothing is sensed."""
        return False

    def start(
        self,
        robots: Sequence[Crocodile],
        gaits: Sequence[Gait],
        seeds: Sequence[int],
        ticks: int,
        period: float,
    ) -> "Table":
        """Tabulate every gait; runs with the same robot and gait share their rows."""
        del seeds
        pairs = list(zip(robots, gaits, strict=True))
        unique = {pair: i for i, pair in enumerate(dict.fromkeys(pairs))}
        time = np.arange(ticks) * period
        phase = np.empty((len(unique), ticks, 4))
        targets = np.empty((len(unique), ticks, 19))
        for (robot, gait), i in unique.items():
            phase[i] = limb_phase(gait, time)
            targets[i] = servo_targets(robot, gait, phase[i])
        return Table(targets, phase, np.array([unique[pair] for pair in pairs]))


class Table:
    """Servo angles and limb phases of every distinct gait of a batch, by tick."""

    def __init__(
        self,
        targets: Float[np.ndarray, "gait tick 19"],
        phase: Float[np.ndarray, "gait tick 4"],
        row: np.ndarray,
    ) -> None:
        self._targets = targets
        self._phase = phase
        self._row = row

    def rest(self) -> Float[np.ndarray, "run 19"]:
        """The first row."""
        return self._targets[self._row, 0]

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Look up one tick."""
        del sensed
        return Command(self._targets[self._row, tick], self._phase[self._row, tick])
