"""Warn of runs whose controllers command servos faster than these can turn."""

import warnings
from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from suchus.core.errors import Doubtful
from suchus.robot.design import layout
from suchus.robot.design.body import servos_of
from suchus.sim.land.run import Run

OVERSPEED_TOLERANCE = 0.01
"""Excess of the commanded speed over the servo's, as a fraction of the latter, from which a run warns [-]."""


class CommandSpeeds:
    """Greatest speeds at which controllers turn the commanded angles, before noise and faults.

    Args:
        runs: runs that share a controller.
        period: control period [s].
    """

    def __init__(self, runs: Sequence[Run], period: float) -> None:
        """Note the speed of each servo of each robot."""
        self._runs, self._period = runs, period
        limits = {
            robot: [servos_of(robot)[name].speed for name in layout(robot).servos]
            for robot in {run.robot for run in runs}
        }
        self._limits = np.array([limits[run.robot] for run in runs])
        self._previous: np.ndarray | None = None
        self.max_speeds: Float[np.ndarray, "run servo"] = np.zeros(self._limits.shape)
        """Greatest commanded speed of each servo so far [rad/s]."""

    def observe(self, targets: Float[np.ndarray, "run servo"], has_ended: Bool[np.ndarray, " run"]) -> None:
        """Take in the angles that are commanded in the next control period.

        Args:
            targets: the commanded angles [rad].
            has_ended: whether each run has ended, so that nothing counts that it is commanded.
        """
        if self._previous is not None:
            speeds = np.abs(targets - self._previous) / self._period
            np.fmax(self.max_speeds, speeds, out=self.max_speeds, where=~has_ended[:, None])
        self._previous = targets.copy()

    def warn(self) -> None:
        """Warn of the servo whose commanded speed is the most beyond its own.

        Warns:
            Doubtful: a servo is commanded to turn faster than its speed by more than ``OVERSPEED_TOLERANCE``.
        """
        ratios = self.max_speeds / self._limits
        run_index, servo = np.unravel_index(np.argmax(ratios), ratios.shape)
        ratio = float(ratios[run_index, servo])
        if ratio <= 1.0 + OVERSPEED_TOLERANCE:
            return
        run, count = self._runs[int(run_index)], int((ratios.max(axis=1) > 1.0 + OVERSPEED_TOLERANCE).sum())
        batch_text = f"; {count} of {len(self._runs)} runs of the batch do so" if len(self._runs) > 1 else ""
        message = (
            f"gait {run.gait.name!r} commands {layout(run.robot).servos[servo]} of robot {run.robot.name!r} to turn at "
            f"{self.max_speeds[run_index, servo]:.3g} rad/s; the servo's speed is "
            f"{self._limits[run_index, servo]:.3g} rad/s, so its target lags{batch_text}. "
            "A longer period, smaller angles or a faster servo would do."
        )
        warnings.warn(Doubtful(message, kind="servo_speed", size=ratio), stacklevel=2)
