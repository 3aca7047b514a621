"""The article as data: its tables, claims, misprints and signs; imports the standard library only."""

from suchus.article.paper.claim import Claim
from suchus.article.paper.claims import CLAIMS
from suchus.article.paper.errata import ERRATA, Misprint
from suchus.article.paper.signs import BendAngles, JointSums, to_bend_angles
from suchus.article.paper.tables import (
    CRAWL_END,
    CRAWL_START,
    CYCLE_PERIOD,
    CYCLES,
    FEMUR,
    LEG_CHAIN,
    LIMB_REACH,
    SNAPSHOT_TIMES,
    SPINE_CHAIN,
    TABLE_I,
    TABLE_II,
    TAIL_JOINTS,
    TIBIA,
)

TITLE = "Structure design and coordinated motion analysis of bionic crocodile robot"
AUTHORS = ("Jun Wang", "Jingya Zheng", "Yuhang Zhao", "Kai Yang")

__all__ = [
    "AUTHORS",
    "CLAIMS",
    "CRAWL_END",
    "CRAWL_START",
    "CYCLES",
    "CYCLE_PERIOD",
    "ERRATA",
    "FEMUR",
    "LEG_CHAIN",
    "LIMB_REACH",
    "SNAPSHOT_TIMES",
    "SPINE_CHAIN",
    "TABLE_I",
    "TABLE_II",
    "TAIL_JOINTS",
    "TIBIA",
    "TITLE",
    "BendAngles",
    "Claim",
    "JointSums",
    "Misprint",
    "to_bend_angles",
]
