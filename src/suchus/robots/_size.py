"""How big a robot is beside the article's: what was chosen for that one's size follows from it for others."""

from typing import NamedTuple

from suchus.catalog import Catalog
from suchus.design import Robot

_ARTICLE = "caiman"


class RelativeSize(NamedTuple):
    """A robot's size over that of the article's robot."""

    length: float
    """Length of the body [-]."""
    weight: float
    """Of the body [-]."""


def beside(shelf: Catalog[Robot], robot: Robot) -> RelativeSize:
    """Return the size of a robot over that of the article's.

    Args:
        shelf: of robots.
        robot: on the shelf or not.
    """
    article = shelf[_ARTICLE]
    return RelativeSize(robot.length / article.length, robot.mass / article.mass)
