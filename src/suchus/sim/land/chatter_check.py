"""A check of each record: servos that chatter."""

import warnings
from collections.abc import Sequence

import numpy as np
import xarray as xr

from suchus.core.errors import Doubtful
from suchus.robot.motion import START
from suchus.sim.land.run import Run
from suchus.sim.metrics.chatter import CHATTER_HARMONIC, chatter

MAX_CHATTER = 0.3
"""Fraction of the power of the servos' torques above ten times the gait's frequency from which a run warns [-].

The robots of the catalog stay below 0.2 in their own gaits; a loop that rings is above one half.
"""


def check_chatter(record: xr.Dataset, runs: Sequence[Run]) -> None:
    """Warn of the run whose servos chatter the most.

    Runs whose record does not hold what the servos do, or lasts no cycle after the first second, are not looked at.

    Args:
        record: record of ``simulate``, in the order of the runs.
        runs: runs of the record.

    Warns:
        Doubtful: ``chatter`` of a run is above ``MAX_CHATTER``.
    """
    time = record.time.values
    if "servo_mean_torque" not in record or np.count_nonzero(time >= START - 1e-9) < _MIN_SAMPLES:
        return
    fractions = np.nan_to_num(np.atleast_1d(chatter(record).values))
    sim = int(np.argmax(fractions))
    if fractions[sim] <= MAX_CHATTER:
        return
    run, count = runs[sim], int((fractions > MAX_CHATTER).sum())
    batch_text = f"; {count} of {len(runs)} runs of the batch chatter" if len(runs) > 1 else ""
    text = (
        f"the servos of run {sim}, {run.label or run.gait.name!r}, chatter: {fractions[sim]:.0%} of the power of their "
        f"torques is above {CHATTER_HARMONIC:g} times the gait's frequency, and {MAX_CHATTER:.0%} at most is usual"
        f"{batch_text}. Work, heat and cost of transport are those of the chatter. Less stiffness (kp) or a derivative "
        "gain (kd) in proportion to the inertia would do, see suchus.robot.motors.servo_parameters.loop_gains."
    )
    warnings.warn(Doubtful(text, kind="kd", size=float(fractions[sim])), stacklevel=3)


_MIN_SAMPLES = 4
"""Samples after the first second from which a record is looked at [-]."""
