"""Simulation on land: a batch of runs from the start; one crawl is a batch of one."""

from suchus.design.ground import Ground
from suchus.fault import Fault
from suchus.faults import Backlash, Deaf, Limp, Locked, LostFoot, Offset, Slow, Weak
from suchus.land.arenas import ARENAS
from suchus.land.crawling import crawl
from suchus.land.lake import Lake, Wave
from suchus.land.live import Live
from suchus.land.loop import CONTROL_PERIOD
from suchus.land.lost import KINDS, KNEES, LEGS_LOST, LOST, angle_at, lost, lost_joints
from suchus.land.push import Push
from suchus.land.run import VACUUM, WATER, Afloat, Run
from suchus.land.simulation import simulate
from suchus.land.toppling import smallest_pushes

__all__ = [
    "ARENAS",
    "CONTROL_PERIOD",
    "KINDS",
    "KNEES",
    "LEGS_LOST",
    "LOST",
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
    "Wave",
    "Weak",
    "angle_at",
    "crawl",
    "lost",
    "lost_joints",
    "simulate",
    "smallest_pushes",
]
