"""Simulate runs with any model of the water: on land, with the section model, or with a flow around the robot."""

from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
import xarray as xr

from suchus.core.errors import Diverged, InvalidDesign
from suchus.core.fingerprint import fingerprint
from suchus.core.progress import Progress, portion, silent
from suchus.sim import land
from suchus.sim.land.readings import thin, with_equal_variables
from suchus.sim.land.run import Run
from suchus.swimming.coupling.swim import Swim
from suchus.swimming.water.samples import check_checkpoint_folder


def simulate(
    runs: Sequence[Run],
    *,
    duration: float = 9.0,
    timestep: float | None = None,
    sample_stride: int = 1,
    keep: Path | str | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Simulate runs with any water, as ``land.simulate`` does or with the flow around the robot.

    Runs without a flow are simulated together, as a batch; runs in a flow one after another. The same runs give the
    same bytes, whatever the number of threads.

    Args:
        runs: at least one; see ``land.simulate``.
        duration: [s].
        timestep: time step of the physics [s]; that of the robots' size, and in a flow of its steps, if None.
        sample_stride: keep one sample of so many control periods.
        keep: folder in which each run in a flow, robot and water, is kept as far as it has come, in a file named after
            the run; where it holds one, the run goes on from there, to the same bytes. None keeps nothing.
        progress: told the share that is done.

    Returns:
        A record with the dimensions ``run`` and ``time`` (see ``record.schema``). Where a run has a flow, all have the
        variables of ``record.COUPLED``, NaN for the others. A run that diverges ends there, as on land.

    Raises:
        InvalidDesign: see ``land.simulate`` and ``Swim``.
        OutsideLimits: a gait that a robot's joints cannot follow, or water too fast for the timestep.
        UnreadableFile: what is kept of a run is damaged.
        Unwritable: a run cannot be kept.
    """
    runs = tuple(runs)
    flow_indices = [i for i, run in enumerate(runs) if run.solved_flow is not None]
    if not flow_indices:
        return land.simulate(runs, duration=duration, timestep=timestep, sample_stride=sample_stride, progress=progress)
    check_checkpoint_folder("" if keep is None else str(keep))
    swims = [Swim(runs[i], duration, timestep=timestep) for i in flow_indices]  # refused before any is computed
    periods = {swim.stepper.period for swim in swims}
    if len(periods) > 1:
        raise InvalidDesign("the robots have different control periods; simulate them one after another.")
    plain_indices = [i for i in range(len(runs)) if i not in flow_indices]
    parts, order, count = [], [], len(flow_indices) + bool(plain_indices)
    if plain_indices:
        run_progress = portion(progress, 0, count)
        plain_runs = [runs[i] for i in plain_indices]
        parts.append(
            land.simulate(
                plain_runs, duration=duration, timestep=timestep, sample_stride=sample_stride, progress=run_progress
            )
        )
        order += plain_indices
    for number, (i, swim) in enumerate(zip(flow_indices, swims, strict=True), start=count - len(flow_indices)):
        with suppress(Diverged):  # its record says when and why
            kept_path = None if keep is None else Path(keep) / f"{fingerprint(swim.setup)[:16]}.kept-swim"
            run_progress = portion(progress, number, count)
            swim.go(swim.ticks * swim.stepper.period, progress=run_progress, checkpoint=kept_path)
        parts.append(thin(swim.record(), sample_stride))
        order.append(i)
    records = with_equal_variables(parts)
    record = records[0] if len(records) == 1 else xr.concat(records, "run", join="outer", data_vars="all")
    record = record.isel(run=np.argsort(order)).assign_coords(run=np.arange(len(runs)))
    record.attrs.update(timestep=swims[0].timestep, control_period=periods.pop())
    return record
