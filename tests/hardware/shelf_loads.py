"""What the servos of a robot bear in each gait of the shelf, and whether the servos that are named would do."""

from collections.abc import Mapping, Sequence
from typing import Any

from suchus.design import Robot
from suchus.errors import OutsideLimits
from suchus.gaits import GAITS, suits
from suchus.hardware import ServoLoad, check_loads, loads_of_each, overloaded, share_at_limit
from suchus.hardware.limits import AT_LIMIT, stronger
from suchus.land import Run, simulate
from suchus.metrics import between
from suchus.motion import START, Gait


def measured(
    robot: Robot, *, cycles: int, timestep: float | None = None, names: Sequence[str] = tuple(GAITS)
) -> dict[str, dict[str, Any]]:
    """Return for each gait whether it is exported, what is said, and for each servo at its limit how it is.

    ``then`` is the share of the walk at the limit of servos of the class that is named [-].
    """
    gaits = [GAITS[name] for name in names if suits(robot, GAITS[name])]
    every = loads_of_each(robot, gaits, cycles=cycles, timestep=timestep)
    weak = [{name: load for name, load in borne.items() if load.at_limit > AT_LIMIT} for borne in every]
    then = _with_named(robot, gaits, weak, cycles, timestep)
    return {
        gait.name: {
            "exported": _exported(robot, gait, borne),
            "said": overloaded(borne),
            "most": max(load.at_limit for load in borne.values()),
            "servos": {name: _servo(load, then[gait.name][name]) for name, load in some.items()},
        }
        for gait, borne, some in zip(gaits, every, weak, strict=True)
    }


def _servo(load: ServoLoad, then: float) -> dict[str, Any]:
    return {"at_limit": load.at_limit, "off": load.off, "would_do": load.stock, "then": then}


def _with_named(
    robot: Robot,
    gaits: Sequence[Gait],
    weak: Sequence[Mapping[str, ServoLoad]],
    cycles: int,
    timestep: float | None,
) -> dict[str, dict[str, float]]:
    """Return the share at the limit of the servos that are named, each gait with its own."""
    asked = [(gait, some) for gait, some in zip(gaits, weak, strict=True) if some]
    robots = [stronger(robot, some) for _, some in asked]
    runs = [Run(robot=one, gait=gait) for one, (gait, _) in zip(robots, asked, strict=True)]
    ends = [START + cycles * gait.period for gait, _ in asked]
    record = simulate(runs, duration=max(ends), timestep=timestep)
    found: dict[str, dict[str, float]] = {gait.name: {} for gait in gaits}
    for i, ((gait, some), one, end) in enumerate(zip(asked, robots, ends, strict=True)):
        shares = share_at_limit(one, between(record.isel(run=i), end=end))
        found[gait.name] = {name: float(shares.sel(servo=name)) for name in some}
    return found


def _exported(robot: Robot, gait: Gait, borne: Mapping[str, ServoLoad]) -> bool:
    try:
        check_loads(robot, gait, borne)
    except OutsideLimits:
        return False
    return True
