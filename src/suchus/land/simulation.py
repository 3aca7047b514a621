"""Simulate runs: physics in MuJoCo, a controller for the whole batch at every control period."""

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr

from suchus.design.checks import require
from suchus.design.scale import check_step, control_period, physics_step
from suchus.errors import InvalidDesign
from suchus.fault import check_faults
from suchus.land.lake import check_lake
from suchus.land.loop import Loop, physics_steps
from suchus.land.push import check_pushes
from suchus.land.readings import with_equal_variables
from suchus.land.run import Run
from suchus.model import topology
from suchus.motion import check_limits

Progress = Callable[[float], None]


def simulate(
    runs: Sequence[Run],
    *,
    duration: float = 9.0,
    timestep: float | None = None,
    every: int = 1,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Simulate a batch of runs.

    The same runs give the same bytes, whatever the number of threads. A run that diverges ends there: its samples
    from then on are NaN, ``ended`` and ``cause`` say when and why, and the others go on.

    Args:
        runs: at least one; the robots must share their number of tail joints, and which servos have integral action.
        duration: [s].
        timestep: of the physics [s], a whole part of the control period; that of the robots' size if None.
        every: keep one sample of so many control periods.
        progress: called with the share that is done.

    Returns:
        A record with the dimensions ``run`` and ``time`` (see ``record.schema``), the first sample at time 0.
        Contact forces are means over the control period before each sample, torques those of its last physics step.

    Raises:
        InvalidDesign: no runs, robots of different topology, a bad duration or time step.
        OutsideLimits: a gait that a robot's joints cannot follow.
        UnknownName: a fault of a joint, or a push on a body, that does not exist.
    """
    runs = tuple(runs)
    if not runs:
        raise InvalidDesign("there are no runs to simulate; give at least one.")
    timestep = physics_step(runs[0].robot) if timestep is None else timestep
    steps, period = _check(runs, duration, timestep, every)
    ticks = round(duration / period)
    parts, order = [], []
    groups = _groups(runs)
    for number, members in enumerate(groups):
        grouped = [runs[i] for i in members]

        def report(share: float, done: int = number) -> None:
            if progress is not None:
                progress((done + share) / len(groups))

        parts.append(_simulate_group(grouped, ticks, steps, timestep, every, report))
        order.extend(members)
    parts = with_equal_variables(parts)
    record = parts[0] if len(parts) == 1 else xr.concat(parts, "run", join="exact", data_vars="minimal")
    if len(groups) > 1:
        record = record.isel(run=np.argsort(order))
    record = record.assign_coords(run=np.arange(len(runs)))
    record.attrs.update(timestep=timestep, control_period=period)
    return record


def _check(runs: Sequence[Run], duration: float, timestep: float, every: int) -> tuple[int, float]:
    """Refuse what cannot be simulated; return the physics steps in a control period, and that period [s]."""
    periods = {control_period(run.robot) for run in runs}
    if len(periods) > 1:
        raise InvalidDesign(
            f"the robots of one batch have control periods of {' and '.join(f'{one:g}' for one in sorted(periods))} s, "
            "since they differ so much in size; simulate them one after another."
        )
    (period,) = periods
    require("simulate", "duration", duration, period, 86400.0, "s")
    require("simulate", "every", every, 1, 10000, "control periods")
    steps = physics_steps(timestep, period)
    for robot in {run.robot for run in runs}:
        check_step(robot, timestep)
    if len({topology(run.robot) for run in runs}) > 1:
        raise InvalidDesign(
            "the robots of one batch must have the same bodies, hinges and servos (equally many tail joints, as an "
            "example), and integral action in the same servos; "
            "simulate them one after another."
        )
    for pair in {(run.robot, run.gait) for run in runs}:
        check_limits(*pair)
    for run in runs:
        check_faults(run.faults, run.robot, duration)
        check_pushes(run.pushes, run.robot, duration)
        if run.lake is not None:
            check_lake(run.robot, run.lake)
    return steps, period


def _groups(runs: Sequence[Run]) -> list[list[int]]:
    """Return the indices of the runs that share a controller: those whose controls are of one class.

    Runs on different types of relief, and runs in water and on dry land, have models of different sizes and run one
    after another.
    """
    groups: dict[object, list[int]] = {}
    for i, run in enumerate(runs):
        key = type(run.control), type(run.ground.relief), run.lake is None
        groups.setdefault(key, []).append(i)
    return list(groups.values())


def _simulate_group(
    runs: Sequence[Run], ticks: int, steps: int, timestep: float, every: int, progress: Progress
) -> xr.Dataset:
    loop = Loop(runs, ticks + 1, steps, timestep, samples=ticks // every + 1)
    for tick in range(ticks + 1):
        command = loop.disturb(tick, loop.decide(tick))
        if tick % every == 0:
            loop.readings.store(tick // every, command.phase, command.targets)
        if tick < ticks:
            loop.advance(tick, command.targets)
        if tick % 16 == 0:
            progress(tick / ticks)
    progress(1.0)
    return loop.readings.record(np.arange(0, ticks + 1, every) * control_period(runs[0].robot))
