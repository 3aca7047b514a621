"""Simulate a batch of runs from beginning to end, or one: physics in MuJoCo, a controller for the whole batch."""

from collections.abc import Sequence
from functools import partial
from math import ceil, gcd

import numpy as np
import xarray as xr
from jaxtyping import Bool, Int

from suchus.core.checks import require
from suchus.core.errors import Diverged, InvalidDesign, out_of_memory
from suchus.core.progress import Progress, portion, silent
from suchus.robot.control import Control, OpenLoop
from suchus.robot.design import Robot
from suchus.robot.design.ground import Ground
from suchus.robot.design.scale import check_step, control_period, physics_step
from suchus.robot.gaits import gait_of
from suchus.robot.motion import START, Gait, check_limits
from suchus.robot.robots import ROBOTS
from suchus.sim.fault import Fault, check_faults
from suchus.sim.land.chatter_check import check_chatter
from suchus.sim.land.command_speed import CommandSpeeds
from suchus.sim.land.ending import EndRule
from suchus.sim.land.extent import check_extent
from suchus.sim.land.lake import Lake, check_lake
from suchus.sim.land.load_check import check_loads
from suchus.sim.land.loop import Loop, physics_steps
from suchus.sim.land.readings import with_equal_variables
from suchus.sim.land.run import Push, Run, check_pushes
from suchus.sim.land.step_division import divided_step
from suchus.sim.model import longest_step, topology


def simulate(
    runs: Sequence[Run],
    *,
    duration: float = 9.0,
    timestep: float | None = None,
    sample_stride: int = 1,
    effort: bool = True,
    fast: bool = False,
    ends: EndRule | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Simulate a batch of runs.

    The same runs give the same bytes, whatever the number of threads. A run that diverges ends there: its samples
    from then on are NaN, ``ended`` and ``cause`` say when and why, and the others go on.

    Args:
        runs: at least one; the robots must share their number of tail joints, and which servos have integral action
            and warm up.
        duration: [s].
        timestep: time step of the physics [s], a whole part of the control period; that of the robots' size if None,
            and where one is ``afloat`` the longest, no longer than that, with which explicit steps hold its joints.
            Within ``divide_steps`` it is divided.
        sample_stride: keep one sample of at most so many control periods: of the greatest number for which the first
            second, in which robots settle, and the run end with a sample.
        effort: whether the record holds what the servos do (``record.EFFORT``), without which there is no work, cost
            of transport or heat. It needs the sensors in each physics step.
        fast: whether contacts are solved in less time and with less accuracy, for training: friction cones are
            pyramids, and the solver makes ten steps of projected Gauss-Seidel. With the coarse time step two cycles of
            the caiman's crawls and of the strider's tripod get within 5 % as far as in full physics, and with a control
            period as the time step within 8 %; ``bench/fast_physics.py`` measures both, and the time.
        ends: asked after each sample which runs end with it, since what they were to show is known; None: each lasts
            for the duration.
        progress: told the share that is done.

    Returns:
        A record with the dimensions ``run`` and ``time`` (see ``record.schema``), the first sample at time 0.
        Contact forces are means over the control period before each sample. ``servo_torque`` is that of its last
        physics step. What servos do (``record.EFFORT``) is over all physics steps since the sample before.

    Raises:
        NoMemory: the memory does not suffice.
        InvalidDesign: no runs, robots of different topology, a bad duration or time step, more than the machine bears,
            or a robot that would begin inside a step, a stone or bumps.
        OutsideLimits: a gait that a robot's joints cannot follow.
        UnknownName: a fault of a joint, or a push on a body, that does not exist.

    Warns:
        Doubtful: a controller commands a servo to turn faster than its speed, before noise and faults; or the recorded
            contacts of a run do not carry its weight, see ``check_loads``; or the servos of a run chatter, see
            ``check_chatter``.
    """
    runs = tuple(runs)
    if not runs:
        raise InvalidDesign("there are no runs to simulate; give at least one.")
    timestep = divided_step(_own_step(runs) if timestep is None else timestep)
    period = _check(runs, duration, timestep, sample_stride)
    ticks = round(duration / period)
    sample_stride = _even_stride(sample_stride, ticks, round(START / period))
    check_extent(runs, duration, timestep, period, sample_stride)
    parts, order = [], []
    groups = _groups(runs)
    for number, members in enumerate(groups):
        grouped = [runs[i] for i in members]
        with out_of_memory():
            parts.append(
                _simulate_group(
                    grouped,
                    ticks,
                    timestep,
                    sample_stride,
                    portion(progress, number, len(groups)),
                    has_effort=effort,
                    fast=fast,
                    ends=None if ends is None else partial(_ended, ends, np.array(members)),
                )
            )
        order.extend(members)
    parts = with_equal_variables(parts)
    record = parts[0] if len(parts) == 1 else xr.concat(parts, "run", join="exact", data_vars="minimal")
    if len(groups) > 1:
        record = record.isel(run=np.argsort(order))
    record = record.assign_coords(run=np.arange(len(runs)))
    record.attrs.update(timestep=timestep, control_period=period)
    check_loads(record, runs)
    check_chatter(record, runs)
    return record


def _ended(
    ends: EndRule, members: Int[np.ndarray, " run"], sims: Int[np.ndarray, " n"], time: float, phase: np.ndarray
) -> Bool[np.ndarray, " n"]:
    """Return which runs of a group end, by their numbers in the whole batch.

    Args:
        ends: says which runs end.
        members: numbers in the batch of the runs of the group.
        sims: runs of the group that are asked about.
        time: time of the sample [s].
        phase: phase of their limbs, shape (n, limb) [cycle].
    """
    return ends(members[sims], time, phase)


def _even_stride(stride: int, ticks: int, start_ticks: int) -> int:
    """Return the greatest stride up to ``stride`` whose samples include the end of a run and that of its first second.

    Args:
        stride: control periods for each sample at most [-].
        ticks: control periods of the run [-].
        start_ticks: control periods in which robots settle; a run that ends before needs its end alone [-].
    """
    common = gcd(ticks, start_ticks) if ticks > start_ticks else ticks
    return max(candidate for candidate in range(1, stride + 1) if common % candidate == 0)


def _own_step(runs: Sequence[Run]) -> float:
    """Return the default time step of a batch of runs [s]."""
    step, period = physics_step(runs[0].robot), control_period(runs[0].robot)
    max_steps = [longest_step(robot) for robot in {run.robot for run in runs if run.afloat is not None}]
    return step if not max_steps or min(max_steps) >= step else period / ceil(period / min(max_steps))


def _check(runs: Sequence[Run], duration: float, timestep: float, stride: int) -> float:
    """Refuse what cannot be simulated; return the control period [s].

    Args:
        runs: runs of the batch.
        duration: duration of each run [s].
        timestep: time step of the physics [s].
        stride: control periods for each sample [-].
    """
    periods = {control_period(run.robot) for run in runs}
    if len(periods) > 1:
        period_text = " and ".join(f"{period:g}" for period in sorted(periods))
        raise InvalidDesign(
            f"the robots of one batch have control periods of {period_text} s, "
            "since they differ so much in size; simulate them one after another."
        )
    (period,) = periods
    require("simulate", "duration", duration, period, 86400.0, "s")
    require("simulate", "every", stride, 1, 10000, "control periods")
    physics_steps(timestep, period)
    for robot in {run.robot for run in runs}:
        check_step(robot, timestep)
    if len({topology(run.robot) for run in runs}) > 1:
        raise InvalidDesign(
            "the robots of one batch must have the same bodies, hinges and servos (equally many tail joints, as an "
            "example), and integral action in the same servos, and the same servos must warm up; "
            "simulate them one after another."
        )
    for pair in {(run.robot, run.gait) for run in runs}:
        check_limits(*pair)
    for run in runs:
        if run.solved_flow is not None:
            raise InvalidDesign(
                f"the water of run {run.label or run.gait.name!r} is a flow that is solved together with the robot; "
                "give the runs to suchus.swimming.coupling.simulate."
            )
        check_faults(run.faults, run.robot, duration)
        check_pushes(run.pushes, run.robot, duration)
        if run.lake is not None:
            check_lake(run.robot, run.lake)
    return period


def _groups(runs: Sequence[Run]) -> list[list[int]]:
    """Return the indices of the runs that share a controller: those whose controls are of one class.

    Runs on different types of relief, on hard ground and on grains, and in water and on dry land, have models of
    different sizes and run one after another.
    """
    groups: dict[object, list[int]] = {}
    for i, run in enumerate(runs):
        key = type(run.control), type(run.ground.relief), run.ground.grains is None, run.lake is None
        groups.setdefault(key, []).append(i)
    return list(groups.values())


def _simulate_group(
    runs: Sequence[Run],
    ticks: int,
    timestep: float,
    stride: int,
    progress: Progress,
    *,
    has_effort: bool,
    fast: bool = False,
    ends: EndRule | None = None,
) -> xr.Dataset:
    """Simulate runs that share a controller and return their record; every ``stride``-th control period is sampled.

    Args:
        runs: runs of the group.
        ticks: number of control periods.
        timestep: time step of the physics [s].
        stride: control periods for each sample [-].
        progress: called with the finished fraction.
        has_effort: whether the record holds what the servos do.
        fast: whether contacts are solved in less time and with less accuracy.
        ends: says after each sample which runs of the group end; None: none does.
    """
    loop = Loop(runs, timestep, ticks=ticks + 1, fast=fast)
    recorder = loop.recorder(ticks // stride + 1, has_effort=has_effort)
    speeds = CommandSpeeds(runs, loop.period)
    for tick in range(ticks + 1):
        loop.decide()
        speeds.observe(loop.intended_targets, loop.has_ended)
        if tick % stride == 0:
            recorder.store(tick // stride, loop.command.phase, loop.command.targets)
            if ends is not None:
                going = np.flatnonzero(loop.batch.alive)
                loop.end(going[ends(going, loop.time, loop.command.phase[going])])
                if not loop.batch.alive.any():
                    break
        if tick < ticks:
            is_sample = (tick + 1) % stride == 0
            need_readings = loop.feels or is_sample
            loop.advance(need_forces=need_readings, need_readings=need_readings, need_effort=has_effort)
            if has_effort and not is_sample:
                recorder.gather()
        if tick % 16 == 0:
            progress("simulating", tick / ticks)
    progress("simulating", 1.0)
    speeds.warn()
    return recorder.record(np.arange(0, ticks + 1, stride) * loop.period)


def crawl(
    robot: Robot | str,
    gait: Gait | str,
    *,
    duration: float | None = None,
    cycles: float | None = None,
    faults: Sequence[Fault] = (),
    pushes: Sequence[Push] = (),
    ground: Ground | None = None,
    lake: Lake | None = None,
    control: Control | None = None,
    noise: float = 0.0,
    seed: int = 0,
    timestep: float | None = None,
) -> xr.Dataset:
    """Let a robot walk.

    Args:
        robot: the robot that walks, or its name in the catalog.
        gait: the gait, its name in the catalog, or the path of its file.
        duration: including the first second, in which the robot settles [s]; 9 s where ``cycles`` is not given.
        cycles: cycles of the gait after that second, in the place of ``duration``, above 0 [-]: gaits of other cycle
            times are compared over equal cycles, and by their speed.
        faults: what breaks, and when.
        pushes: forces from outside.
        ground: the ground; level if None.
        lake: the water around the robot; dry land if None.
        control: open loop if None.
        noise: standard deviation of noise on every servo angle commanded [rad].
        seed: seed of the noise.
        timestep: time step of the physics [s]; that of the robot's size if None.

    Returns:
        The record, without the dimension ``run`` (see ``record.schema``).

    Raises:
        InvalidDesign: both ``duration`` and ``cycles`` are given, or one of them is out of range.
        Diverged: the simulation diverged; the error carries the time and the record so far.
        OutsideLimits: the robot's joints cannot follow the gait.
    """
    run = Run(
        robot=ROBOTS.resolve(robot),
        gait=gait_of(ROBOTS.resolve(robot), gait),
        ground=ground or Ground(),
        lake=lake,
        faults=tuple(faults),
        pushes=tuple(pushes),
        control=control or OpenLoop(),
        noise=noise,
        seed=seed,
    )
    record = simulate([run], duration=_duration(run.gait, duration, cycles), timestep=timestep).isel(run=0)
    if record.cause.item():
        time = float(record.ended)
        raise Diverged(
            f"the crawl diverged at {time:.2f} s: {record.cause.item()}. "
            f"A shorter timestep than {record.timestep} s may help.",
            time=time,
            record=record.sel(time=slice(None, time + 1e-9)),
        )
    return record


_DEFAULT_DURATION = 9.0
"""Duration of a crawl that names none [s]: one second to settle, and two cycles of the article's gait."""


def _duration(gait: Gait, duration: float | None, cycles: float | None) -> float:
    """Return how long to simulate [s].

    Raises:
        InvalidDesign: both are given, or ``cycles`` is out of range.
    """
    if cycles is None:
        return _DEFAULT_DURATION if duration is None else duration
    if duration is not None:
        raise InvalidDesign(f"crawl was given duration = {duration!r} s and cycles = {cycles!r}; give one of the two.")
    require("crawl", "cycles", cycles, 0.01, 10_000.0, "")
    return START + cycles * gait.period
