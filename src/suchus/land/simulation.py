"""Simulate runs: physics in MuJoCo, a controller for the whole batch at every control period."""

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr

from suchus.control import Joinable
from suchus.design.checks import require
from suchus.errors import InvalidDesign
from suchus.fault import check_faults
from suchus.land.loop import CONTROL_PERIOD, Loop, physics_steps
from suchus.land.push import check_pushes
from suchus.land.run import Run
from suchus.model import topology
from suchus.motion import check_limits

Progress = Callable[[float], None]


def simulate(
    runs: Sequence[Run],
    *,
    duration: float = 9.0,
    timestep: float = 0.002,
    every: int = 1,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Simulate a batch of runs.

    The same runs give the same bytes, whatever the number of threads. A run that diverges ends there: its samples
    from then on are NaN, ``ended`` and ``cause`` say when and why, and the others go on.

    Args:
        runs: at least one; the robots must share their number of tail joints, and which servos have integral action.
        duration: [s].
        timestep: of the physics [s]; a whole part of the control period.
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
    steps = _check(runs, duration, timestep, every)
    ticks = round(duration / CONTROL_PERIOD)
    parts, order = [], []
    groups = _groups(runs)
    for number, members in enumerate(groups):
        some = [runs[i] for i in members]

        def report(share: float, done: int = number) -> None:
            if progress is not None:
                progress((done + share) / len(groups))

        parts.append(_simulate_group(some, ticks, steps, timestep, every, report))
        order.extend(members)
    record = parts[0] if len(parts) == 1 else xr.concat(parts, "run", join="exact", data_vars="minimal")
    record = record.isel(run=np.argsort(order)).assign_coords(run=np.arange(len(runs)))
    record.attrs.update(timestep=timestep, control_period=CONTROL_PERIOD)
    return record


def _check(runs: Sequence[Run], duration: float, timestep: float, every: int) -> int:
    """Refuse what cannot be simulated; return the number of physics steps in a control period."""
    if not runs:
        raise InvalidDesign("there are no runs to simulate; give at least one.")
    require("simulate", "duration", duration, CONTROL_PERIOD, 86400.0, "s")
    require("simulate", "every", every, 1, 10000, "control periods")
    steps = physics_steps(timestep)
    if len({topology(run.robot) for run in runs}) > 1:
        raise InvalidDesign(
            "the robots of one batch must have equally many tail joints, and integral action in the same servos; "
            "simulate them one after another."
        )
    for pair in {(run.robot, run.gait) for run in runs}:
        check_limits(*pair)
    for run in runs:
        check_faults(run.faults, run.robot, duration)
        check_pushes(run.pushes, run.robot, duration)
    return steps


def _groups(runs: Sequence[Run]) -> list[list[int]]:
    """Return the indices of the runs that share a controller: equal controls, or controls that can be joined.

    Runs on different types of relief have models of different sizes and run one after another.
    """
    groups: dict[object, list[int]] = {}
    for i, run in enumerate(runs):
        joined = isinstance(run.control, Joinable)
        key = type(run.control) if joined else run.control, type(run.ground.relief)
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
    return loop.readings.record(np.arange(0, ticks + 1, every) * CONTROL_PERIOD)
