"""The catalog of robots: one file, one robot, declared as ``robot`` with its ``chosen`` numbers."""

from operator import attrgetter
from pathlib import Path
from typing import Any, NamedTuple

from suchus.core.catalog import Catalog
from suchus.robot.design import Robot


class RelativeSize(NamedTuple):
    """A robot's size over that of the article's robot, for which much was chosen that others take in proportion."""

    length: float
    """Length of the body [-]."""
    weight: float
    """Of the body [-]."""


def _read_robot(path: Path) -> Robot:
    from suchus.robot import blueprint  # noqa: PLC0415  half of the time of an import that reads no file

    robot: Robot = blueprint.read_design(path, Robot, ROBOTS)
    return robot


ROBOTS: Catalog[Any] = Catalog(
    "robot", "suchus.robot.robots", "suchus.robot.design:Robot", name_of=attrgetter("name"), read_file=_read_robot
)
"""Robots by name."""


def size_relative_to_article(robot: Robot) -> RelativeSize:
    """Return the size of a robot over that of the article's robot."""
    article = ROBOTS["caiman"]
    return RelativeSize(robot.length / article.length, robot.mass / article.mass)


__all__ = ["ROBOTS", "RelativeSize", "size_relative_to_article"]
