"""The shelf of robots: one file, one robot, declared as ``robot`` with its ``chosen`` numbers."""

from suchus.catalog import Catalog
from suchus.design import Crocodile

ROBOTS: Catalog[Crocodile] = Catalog("robot", "suchus.robots", "suchus.design:Crocodile")

__all__ = ["ROBOTS"]
