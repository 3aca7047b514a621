"""One robot, one gait, one record."""

from collections.abc import Sequence

import xarray as xr

from suchus.control import Control, OpenLoop
from suchus.design import AnyRobot
from suchus.design.ground import Ground
from suchus.errors import Diverged
from suchus.fault import Fault
from suchus.gaits import GAITS
from suchus.land.lake import Lake
from suchus.land.push import Push
from suchus.land.run import Run
from suchus.land.simulation import simulate
from suchus.motion import AnyGait
from suchus.robots import ROBOTS


def crawl(
    robot: AnyRobot | str,
    gait: AnyGait | str,
    *,
    duration: float = 9.0,
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
        robot: who walks, or its name on the shelf.
        gait: how, or its name on the shelf.
        duration: including the first second, in which the robot settles [s].
        faults: what breaks, and when.
        pushes: forces from outside.
        ground: on what; level ground if None.
        lake: in which water; dry land if None.
        control: open loop if None.
        noise: standard deviation of noise on every servo angle commanded [rad].
        seed: of the noise.
        timestep: of the physics [s]; that of the robot's size if None.

    Returns:
        The record, without the dimension ``run`` (see ``record.schema``).

    Raises:
        Diverged: the physics came apart; the error carries the time and the record so far.
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
    record = simulate([run], duration=duration, timestep=timestep).isel(run=0)
    if record.cause.item():
        time = float(record.ended)
        raise Diverged(
            f"the crawl came apart at {time:.2f} s: {record.cause.item()}. "
            f"A shorter timestep than {record.timestep} s may help.",
            time=time,
            record=record.sel(time=slice(None, time + 1e-9)),
        )
    return record
