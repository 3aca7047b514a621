"""One robot, one gait, one record."""

from collections.abc import Sequence

import xarray as xr

from suchus.control import Control, OpenLoop
from suchus.design import AnyRobot
from suchus.design.checks import require
from suchus.design.ground import Ground
from suchus.errors import Diverged, InvalidDesign
from suchus.fault import Fault
from suchus.gaits import GAITS
from suchus.land.lake import Lake
from suchus.land.push import Push
from suchus.land.run import Run
from suchus.land.simulation import simulate
from suchus.motion import START, Gait
from suchus.robots import ROBOTS


def crawl(
    robot: AnyRobot | str,
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
        robot: the robot that walks, or its name on the shelf.
        gait: the gait, or its name on the shelf.
        duration: including the first second, in which the robot settles [s]; 9 s where ``cycles`` is not given.
        cycles: cycles of the gait after that second, in the place of ``duration``, above 0 [-]: gaits of other cycle
            times are compared over equal cycles, and by their speed.
        faults: what breaks, and when.
        pushes: forces from outside.
        ground: the ground; level if None.
        lake: the water around the robot; dry land if None.
        control: open loop if None.
        noise: standard deviation of noise on every servo angle commanded [rad].
        seed: of the noise.
        timestep: of the physics [s]; that of the robot's size if None.

    Returns:
        The record, without the dimension ``run`` (see ``record.schema``).

    Raises:
        InvalidDesign: both ``duration`` and ``cycles`` are given, or one of them is out of range.
        Diverged: the simulation diverged; the error carries the time and the record so far.
        OutsideLimits: the robot's joints cannot follow the gait.
    """
    run = Run(
        robot=ROBOTS.resolve(robot),
        gait=GAITS.resolve(gait),
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


_USUAL = 9.0
"""Duration of a crawl that names none [s]: one second to settle, and two cycles of the article's gait."""


def _duration(gait: Gait, duration: float | None, cycles: float | None) -> float:
    """Return how long to simulate [s].

    Raises:
        InvalidDesign: both are given, or ``cycles`` is out of range.
    """
    if cycles is None:
        return _USUAL if duration is None else duration
    if duration is not None:
        raise InvalidDesign(f"crawl was given duration = {duration!r} s and cycles = {cycles!r}; give one of the two.")
    require("crawl", "cycles", cycles, 0.01, 10_000.0, "")
    return START + cycles * gait.period
