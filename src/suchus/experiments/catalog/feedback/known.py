"""When it is known of a random start whether its limbs find the gait, so that its run can end."""

import numpy as np
from jaxtyping import Bool, Float, Int

from suchus.robot.motion import START, Gait
from suchus.sim.metrics.coordination import PHASE_TOLERANCE, greatest_phase_error

_ROUNDING = 1e-9  # [cycle]; times are multiples of the sample period up to rounding


class KnownStarts:
    """Ends random starts of which it is known whether they converge.

    A start does not converge that is out of step when less than ``hold`` is left: it ends there, and is counted as a
    start that goes on is. A start that has been in step for ``hold`` converges. One that would leave again later is
    counted wrongly; in the whole experiment starts go on, and its figure shows whether any does.
    """

    def __init__(self, gait: Gait, cycles: float, hold: float, *, is_shown: Bool[np.ndarray, " run"]) -> None:
        """Begin with starts of which nothing is known.

        Args:
            gait: gait of all runs.
            cycles: duration of the starts [cycle].
            hold: least duration in step until the end of a start that converges [cycle].
            is_shown: whether each run lasts until the end, since figures show it.
        """
        self._gait, self._last_end, self._hold = gait, cycles - hold, hold
        self._is_shown = is_shown
        self._out_of_step = np.zeros(len(is_shown))
        self._cycle = 0.0

    def __call__(
        self, runs: Int[np.ndarray, " n"], time: float, phase: Float[np.ndarray, "n limb"]
    ) -> Bool[np.ndarray, " n"]:
        """Return which runs end now; see ``suchus.sim.land.EndRule``."""
        cycle = (time - START) / self._gait.period
        step, self._cycle = cycle - self._cycle, cycle
        if cycle < 0.0:
            return np.zeros(len(runs), dtype=bool)
        is_outside = greatest_phase_error(phase, self._gait) > PHASE_TOLERANCE
        self._out_of_step[runs[is_outside]] = cycle
        is_lost = is_outside & (cycle + step > self._last_end + _ROUNDING)
        is_found = cycle - self._out_of_step[runs] >= self._hold - _ROUNDING
        return np.asarray((is_lost | is_found) & ~self._is_shown[runs])
