"""The midlines that a robot's joints take of a commanded swim in six degrees of freedom, for the swims by CFD."""

from typing import NamedTuple

from suchus.control import Swimming
from suchus.design import Robot, with_values
from suchus.design.flotation import float_hull
from suchus.land import Lake, Run, simulate
from suchus.motion import LIMBS_UP, Gait, with_limbs
from suchus.water import Outline, Undulation, taken, undulation, unevenness

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
    away: float
    """Rms angle off what was commanded, over that [-]."""


def midlines(robot: Robot, motion: Gait, stations: int) -> list[TakenMidline]:
    """Return the midlines of trunk and tail, and of the tail alone, as the joints take them at the surface.

    Args:
        robot: who swims; without a hull it gets one with which it floats.
        motion: that is commanded.
        stations: of the midline [-].
    """
    bare = with_values(robot, {"hull": None})
    floating = robot if robot.hull is not None else with_values(bare, {"hull": float_hull(bare)})
    meant = (motion, motion.straightened("trunk"))
    runs = [
        Run(robot=floating, gait=with_limbs(robot, gait, LIMBS_UP), lake=Lake(level=2.0), control=Swimming())
        for gait in meant
    ]
    record = simulate(runs, duration=(_SETTLE + _AVERAGED) / motion.frequency)
    outline, found = Outline(bare, stations), []
    for i, (name, one) in enumerate(zip(TAKEN, meant, strict=True)):
        bends = taken(outline, record.isel(run=i), frequency=motion.frequency, cycles=_AVERAGED, name=name)
        found.append(TakenMidline(name, bends, unevenness(bends, undulation(outline, one))))
    return found
