"""A check of each record: over a steady cycle the recorded contacts carry the weight."""

import warnings
from collections.abc import Sequence

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.core.errors import Doubtful
from suchus.robot.design import GRAVITY
from suchus.robot.motion import START
from suchus.sim.land.lake import up_direction
from suchus.sim.land.run import Run
from suchus.sim.metrics.contact import ground_force

LOAD_TOLERANCE = 0.01
"""Greatest difference of the recorded load from the weight, over the weight, without a warning [-]."""


def missing_load(record: xr.Dataset, runs: Sequence[Run]) -> Float[np.ndarray, " run"]:
    """Return the share of the weight that the recorded contacts of each run lack; negative where they carry more [-].

    It is the mean over the last whole cycle. What the body gains in speed over that cycle is counted, so that a fall
    or a jump lacks nothing. Not a number where the weight cannot be seen in the record: in water, without ground, under
    pushes, in runs that ended early or last no whole cycle, and where not every control period has a sample.

    Args:
        record: record of ``simulate``, in the order of the runs.
        runs: runs of the record.
    """
    time = record.time.values
    lacking = np.full(len(runs), np.nan)
    if len(time) < 3 or abs(time[1] - time[0] - record.attrs["control_period"]) > 1e-9:
        return lacking
    step = float(time[1] - time[0])
    forces = ground_force(record).transpose("run", "time", "xyz").values
    centres = record.centre_of_mass.transpose("run", "time", "xyz").values
    for sim, run in enumerate(runs):
        samples = round(run.gait.period / step)
        first = len(time) - 1 - samples
        is_dry = run.lake is None and run.afloat is None and run.solved_flow is None
        if not is_dry or run.pushes or record.cause.values[sim] or first < max(1, round(START / step)):
            continue
        up = up_direction(run.ground)
        speeds = [(centres[sim, sample] - centres[sim, sample - 1]) @ up / step for sample in (first, -1)]
        load = (forces[sim, first + 1 :] @ up).mean() / (run.robot.mass * GRAVITY)
        lacking[sim] = 1.0 + (speeds[1] - speeds[0]) / (samples * step * GRAVITY) - load
    return lacking


def check_loads(record: xr.Dataset, runs: Sequence[Run]) -> None:
    """Warn of runs whose recorded contacts do not carry the weight.

    Args:
        record: record of ``simulate``, in the order of the runs.
        runs: runs of the record.

    Warns:
        Doubtful: over the last cycle the recorded load misses the weight by more than ``LOAD_TOLERANCE``.
    """
    lacking = missing_load(record, runs)
    for sim in np.flatnonzero(np.abs(lacking) > LOAD_TOLERANCE).tolist():
        run = runs[sim]
        text = (
            f"the recorded contact forces of run {sim}, {run.label or run.gait.name!r}, carry {1.0 - lacking[sim]:.1%} "
            f"of the weight over its last cycle; in a steady walk they carry 100 % within {LOAD_TOLERANCE:.0%}. "
            "Let it run longer, with a shorter time step, and doubt its loads and duty factors until they do."
        )
        warnings.warn(Doubtful(text, kind="timestep", size=float(abs(lacking[sim]))), stacklevel=3)
