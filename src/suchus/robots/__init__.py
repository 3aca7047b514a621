"""The shelf of robots: one file, one robot, declared as ``robot`` with its ``chosen`` numbers."""

from typing import Any

from suchus.catalog import Catalog

ROBOTS: Catalog[Any] = Catalog("robot", "suchus.robots", "suchus.design:AnyRobot")
"""Of either kind; who needs one of them says so by the type of its field."""

__all__ = ["ROBOTS"]
