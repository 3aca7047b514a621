"""Simulation on land: a batch of runs from the start; one crawl is a batch of one."""

from suchus.design.ground import ARENAS, Ground
from suchus.fault import Fault
from suchus.faults import Backlash, Deaf, Limp, Locked, LostFoot, Offset, Slow, Weak
from suchus.land.failed import FAILED_JOINTS, KINDS, LEGS_FAILED, angle_at, failing_joints, joint_failure
from suchus.land.lake import Lake, Wave
from suchus.land.live import Live
from suchus.land.loop import CONTROL_PERIOD
from suchus.land.push_search import smallest_pushes
from suchus.land.run import VACUUM, WATER, Afloat, Push, Run
from suchus.land.simulation import crawl, simulate
from suchus.land.tolerances import Tolerances

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
    "Fault",
    "Ground",
    "Lake",
    "Limp",
    "Live",
    "Locked",
    "LostFoot",
    "Offset",
    "Push",
    "Run",
    "Slow",
    "Tolerances",
    "Wave",
    "Weak",
    "angle_at",
    "crawl",
    "failing_joints",
    "joint_failure",
    "simulate",
    "smallest_pushes",
]
