"""Simulation on land: a batch of runs from the start; one crawl is a batch of one."""

from suchus.land.crawling import crawl
from suchus.land.faults import Deaf, Fault, Limp, Locked, Weak
from suchus.land.push import Push
from suchus.land.run import Ground, Run
from suchus.land.simulation import CONTROL_PERIOD, simulate

__all__ = [
    "CONTROL_PERIOD",
    "Deaf",
    "Fault",
    "Ground",
    "Limp",
    "Locked",
    "Push",
    "Run",
    "Weak",
    "crawl",
    "simulate",
]
