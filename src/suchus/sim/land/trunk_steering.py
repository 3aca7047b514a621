"""How a curvature offset of the trunk turns a robot in a gait: found by walking."""

from suchus.core.checks import require
from suchus.robot.control import Walking
from suchus.robot.design import Robot
from suchus.robot.motion import START, Gait
from suchus.sim.land.run import Run
from suchus.sim.land.simulation import simulate
from suchus.sim.metrics import heading_change

DEFAULT_BEND = 0.3
"""Lasting bend of the trunk in the two walks [rad]."""
DEFAULT_CYCLES = 4
"""Cycles over which the change of heading is taken, after one more [-]."""


def measure_trunk_steering(
    robot: Robot, gait: Gait, *, bend: float = DEFAULT_BEND, cycles: int = DEFAULT_CYCLES
) -> float:
    """Return the change of heading per cycle over the curvature offset of the trunk, both left positive [rad/rad].

    The robot walks once with the trunk bent to the left and once to the right, on even ground. A gait of the shelf
    keeps the number in its module, as ``trunk_steering = {"caiman": 0.9}``; the controllers read it there.

    Args:
        robot: the robot.
        gait: the gait.
        bend: bend angle of the trunk, above 0 to 1.5 [rad].
        cycles: number of cycles that are measured [-].

    Raises:
        OutsideLimits: the trunk cannot bend as far, or the gait has measured curves.
    """
    require("measure_trunk_steering", "bend", bend, 1e-3, 1.5, "rad")
    require("measure_trunk_steering", "cycles", cycles, 1, 1000, "")
    runs = [Run(robot=robot, gait=gait, control=Walking(bend=side * bend)) for side in (1.0, -1.0)]
    end = START + (cycles + 1) * gait.period
    left, right = heading_change(simulate(runs, duration=end), START + gait.period, end).values
    return float(left - right) / (2.0 * bend * cycles)
