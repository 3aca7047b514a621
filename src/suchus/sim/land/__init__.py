"""Simulation on land: a batch of runs from the start; one crawl is a batch of one."""

from suchus.robot.design.ground import ARENAS, Grains, Ground
from suchus.sim.fault import Fault
from suchus.sim.faults import Backlash, Deaf, Delayed, Frozen, Limp, Locked, LostFoot, Offset, Slow, Weak
from suchus.sim.immersion.sea import Wave
from suchus.sim.land.ending import EndRule
from suchus.sim.land.failed import FAILED_JOINTS, KINDS, LEGS_FAILED, angle_at, failing_joints, joint_failure
from suchus.sim.land.lake import Lake
from suchus.sim.land.live import Live
from suchus.sim.land.loop import CONTROL_PERIOD
from suchus.sim.land.push_search import smallest_pushes
from suchus.sim.land.run import VACUUM, WATER, Afloat, Push, Run
from suchus.sim.land.simulation import crawl, simulate
from suchus.sim.land.step_division import divide_steps
from suchus.sim.land.tolerances import Tolerances
from suchus.sim.land.trunk_steering import measure_trunk_steering
from suchus.sim.persistence import Persistence

__all__ = [
    "ARENAS",
    "CONTROL_PERIOD",
    "FAILED_JOINTS",
    "KINDS",
    "LEGS_FAILED",
    "VACUUM",
    "WATER",
    "Afloat",
    "Backlash",
    "Deaf",
    "Delayed",
    "EndRule",
    "Fault",
    "Frozen",
    "Grains",
    "Ground",
    "Lake",
    "Limp",
    "Live",
    "Locked",
    "LostFoot",
    "Offset",
    "Persistence",
    "Push",
    "Run",
    "Slow",
    "Tolerances",
    "Wave",
    "Weak",
    "angle_at",
    "crawl",
    "divide_steps",
    "failing_joints",
    "joint_failure",
    "measure_trunk_steering",
    "simulate",
    "smallest_pushes",
]
