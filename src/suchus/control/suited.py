"""Controllers that need the article's kind of robot say so."""

from collections.abc import Sequence

from suchus.design import ARTICLE_BODY, Robot, check_needs


def crocodiles(robots: Sequence[Robot], what: str) -> list[Robot]:
    """Return the robots of a batch as the article's kind.

    Args:
        robots: any robots.
        what: needs it, as the beginning of a sentence.

    Raises:
        UnsuitedRobot: one is another kind.
    """
    return [check_needs(robot, ARTICLE_BODY, what) for robot in robots]
