"""The midlines that a robot's joints take of a commanded swim in six degrees of freedom, for the swims by CFD."""

from collections.abc import Sequence
from typing import NamedTuple

import xarray as xr

from suchus.core.progress import Progress, silent
from suchus.robot.control import Swimming
from suchus.robot.design import Robot, with_values
from suchus.robot.design.flotation import float_hull
from suchus.robot.motion import LIMBS_UP, Gait, with_limbs
from suchus.sim.land import Lake, Run, simulate
from suchus.sim.land.afloat import capacity
from suchus.swimming.water import Outline, Undulation, motion_of_record, undulation, unevenness

AS_TAKEN = " as taken"
"""How the names of motions end whose midlines are those that the joints take."""
TAKEN = tuple(motion + AS_TAKEN for motion in ("trunk and tail", "tail only"))
"""Names of the midlines that the joints take in six degrees of freedom."""
_SETTLE, _AVERAGED = 5, 3  # [cycle]; before the joints' angles are taken and while they are


class TakenMidline(NamedTuple):
    """What the joints take of one command."""

    name: str
    """One of ``TAKEN``."""
    motion: Undulation
    """The midline, joint by joint."""
    relative_error: float
    """Rms angle off what was commanded, over that [-]."""


def bare(robot: Robot) -> Robot:
    """Return a robot without a hull, of which the midline is."""
    return with_values(robot, {"hull": None})


def swum_in_sections(robot: Robot, motions: Sequence[Gait], cycles: int, progress: Progress = silent) -> xr.Dataset:
    """Return the record of swims at the surface in six degrees of freedom, one run for each motion.

    Args:
        robot: robot that swims; if it has no hull and would sink it gets one with which it floats.
        motions: motions that are commanded; the limbs are held up.
        cycles: number of cycles that are swum [-].
        progress: told the share that is done.
    """
    lake = Lake(level=2.0)
    volume, weight = capacity(robot, lake)
    sinks = robot.hull is None and volume < weight
    floating = with_values(robot, {"hull": float_hull(robot)}) if sinks else robot
    runs = [
        Run(robot=floating, gait=with_limbs(robot, gait, LIMBS_UP), lake=lake, control=Swimming()) for gait in motions
    ]
    return simulate(runs, duration=cycles / motions[0].frequency, progress=progress)


def midlines(robot: Robot, motion: Gait, stations: int) -> list[TakenMidline]:
    """Return the midlines of trunk and tail, and of the tail alone, as the joints take them at the surface.

    Args:
        robot: robot that swims; without a hull it gets one with which it floats.
        motion: motion that is commanded.
        stations: stations of the midline [-].
    """
    meant = (motion, motion.straightened("trunk"))
    record = swum_in_sections(robot, meant, _SETTLE + _AVERAGED)
    outline, found = Outline(bare(robot), stations), []
    for i, (name, one) in enumerate(zip(TAKEN, meant, strict=True)):
        bends = motion_of_record(outline, record.isel(run=i), frequency=motion.frequency, cycles=_AVERAGED, name=name)
        found.append(TakenMidline(name, bends, unevenness(bends, undulation(outline, one))))
    return found
