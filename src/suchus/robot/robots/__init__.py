"""The catalog of robots: one file, one robot, declared as ``robot`` with its ``chosen`` numbers."""

from operator import attrgetter
from pathlib import Path
from typing import Any, NamedTuple

from suchus.core.catalog import Catalog
from suchus.core.errors import UnreadableFile
from suchus.robot.design import Robot


class RelativeSize(NamedTuple):
    """A robot's size over that of the article's robot, for which much was chosen that others take in proportion."""

    length: float
    """Length of the body [-]."""
    weight: float
    """Weight of the body [-]."""


FOREIGN_ENDINGS = (".urdf", ".xml", ".mjcf")
"""Endings of files of other tools, which ``suchus import`` reads."""


def _read_robot(path: Path) -> Robot:
    """Return the robot of a TOML file.

    Raises:
        UnreadableFile: the file is one of another tool, or no robot.
    """
    if path.suffix.lower() in FOREIGN_ENDINGS:
        raise UnreadableFile(
            f"{path} is a robot of another tool: import it first with: suchus import {path}; then give "
            f"{path.stem}.toml."
        )
    from suchus.robot import blueprint  # noqa: PLC0415  half of the time of an import that reads no file

    blueprint.check_robot_format(path)
    blueprint.check_no_xml(path)
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


__all__ = ["FOREIGN_ENDINGS", "ROBOTS", "RelativeSize", "size_relative_to_article"]
