"""Runs that have been identical so far: one of them is simulated for all, until they differ."""

from collections.abc import Sequence
from math import floor

import numpy as np

from suchus.land.run import Run
from suchus.motion import hip_height

_EARLY = 1e-6
"""By how much too early rather than too late a trouble may be awaited [control period]."""


class Deduplication:
    """The runs of a batch in groups that differ in nothing that the physics has felt yet.

    Such are the runs of one robot that is pushed in many ways, up to the push. Members of a group have the same robot,
    ground and first posture, and had the same commanded servo angles to the last bit; a run with another command, or is
    about to break or be pushed, leaves.

    Args:
        runs: the runs.
        first: the servo angles at the start, shape (run, servo) [rad].
        period: of control [s].
    """

    def __init__(self, runs: Sequence[Run], first: np.ndarray, period: float) -> None:
        groups: dict[object, list[int]] = {}
        for sim, run in enumerate(runs):
            key = (run.robot, run.ground, run.afloat, run.lake, hip_height(run.robot, run.gait), first[sim].tobytes())
            groups.setdefault(key, []).append(sim)
        self._groups = [members for members in groups.values() if len(members) > 1]
        self._leaves: dict[int, set[int]] = {}
        for sim, run in enumerate(runs):
            times = [*(fault.at for fault in run.faults), *(push.at for push in run.pushes)]
            if times:
                self._leaves.setdefault(max(floor(min(times) / period - _EARLY), 0), set()).add(sim)
        self._count = len(runs)
        self._number()

    def part(self, tick: int, targets: np.ndarray) -> None:
        """Let those leave whose first trouble is due, and those that have other commands than the others.

        Args:
            tick: number of the control period.
            targets: commanded servo angles in it, shape (run, servo) [rad].
        """
        if not self._groups:
            return
        leaving = self._leaves.get(tick, ())
        parted: list[list[int]] = []
        for members in self._groups:
            by_command: dict[object, list[int]] = {}
            for sim in members:
                by_command.setdefault(sim if sim in leaving else targets[sim].tobytes(), []).append(sim)
            parted += by_command.values()
        if len(parted) > len(self._groups):
            self._groups = [members for members in parted if len(members) > 1]
            self._number()

    def _number(self) -> None:
        """Note who follows whom."""
        self.first = np.ones(self._count, dtype=bool)
        self.others = np.array([sim for members in self._groups for sim in members[1:]], dtype=int)
        self.whom = np.array([members[0] for members in self._groups for _ in members[1:]], dtype=int)
        self.first[self.others] = False
