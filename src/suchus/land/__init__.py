"""Simulation on land: a batch of runs from the start; one crawl is a batch of one."""

from suchus.design.ground import Ground
from suchus.land.arenas import ARENAS
from suchus.land.crawling import crawl
from suchus.land.faults import Deaf, Fault, Limp, Locked, Weak
from suchus.land.live import Live
from suchus.land.loop import CONTROL_PERIOD
from suchus.land.lost import KINDS, LEGS_LOST, LOST, angle_at, lost
from suchus.land.push import Push
from suchus.land.run import VACUUM, WATER, Afloat, Run
from suchus.land.simulation import simulate
from suchus.land.toppling import smallest_pushes

__all__ = [
    "ARENAS",
    "CONTROL_PERIOD",
    "KINDS",
    "LEGS_LOST",
    "LOST",
    "VACUUM",
    "WATER",
    "Afloat",
    "Deaf",
    "Fault",
    "Ground",
    "Limp",
    "Live",
    "Locked",
    "Push",
    "Run",
    "Weak",
    "angle_at",
    "crawl",
    "lost",
    "simulate",
    "smallest_pushes",
]
