"""Bridge, to be removed: who needs the article's kind of robot says so."""

from typing import overload

from suchus.design import article
from suchus.design.body import Robot
from suchus.design.tables import ARTICLE_JOINTS, Tables
from suchus.errors import UnsuitedRobot

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
    if robot.tables is None:
        raise UnsuitedRobot(
            f"{what} needs a crocodile-like robot given by the article's tables, as 'caiman'; robot {robot.name!r} is "
            "a body of its own: choose another robot."
        )
    if robot.spine.joints != ARTICLE_JOINTS or robot.tail.drive != "cable":
        raise UnsuitedRobot(
            f"{what} needs the article's spine of {ARTICLE_JOINTS} joints and a tail with a cable; robot "
            f"{robot.name!r} has {robot.spine.joints} joints and a tail with {robot.tail.drive}: choose another robot."
        )
    return robot
