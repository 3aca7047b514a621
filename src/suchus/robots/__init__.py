"""The shelf of robots: one file, one robot, declared as ``robot`` with its ``chosen`` numbers."""

from suchus.catalog import Catalog
from suchus.design import AnyRobot

ROBOTS: Catalog[AnyRobot] = Catalog("robot", "suchus.robots", "suchus.design:AnyRobot")

__all__ = ["ROBOTS"]
