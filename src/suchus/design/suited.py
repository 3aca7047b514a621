"""Bridge, to be removed: who needs the article's kind of robot says so."""

from typing import overload

from suchus.design import article
from suchus.design.body import Robot
from suchus.design.needs import check_needs
from suchus.design.tables import Tables

AnyRobot = Robot
Crocodile = Robot


def general(robot: Robot) -> Robot:
    """Return the robot."""
    return robot


@overload
def crocodile(robot: Tables) -> Robot: ...


@overload
def crocodile(robot: Robot, what: str) -> Robot: ...


def crocodile(robot: Robot | Tables, what: str = "") -> Robot:
    """Return a robot as the article's kind: four legs, a spine of five joints, a tail with one cable.

    Args:
        robot: any, or tables to make one of.
        what: needs it, as the beginning of a sentence: ``standing up``.

    Raises:
        UnsuitedRobot: it is another kind.
    """
    if isinstance(robot, Tables):
        return article.crocodile(robot)
    check_needs(robot, ("legs", "shells", "article_spine", "cable_tail"), what)
    return robot
