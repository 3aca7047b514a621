"""Controllers that need the article's kind of robot say so."""

from collections.abc import Sequence

from suchus.design import Robot, crocodile


def crocodiles(robots: Sequence[Robot], what: str) -> list[Robot]:
    """Return the robots of a batch as the article's kind.

    Args:
        robots: in either form.
        what: needs it, as the beginning of a sentence.

    Raises:
        UnsuitedRobot: one is another kind.
    """
    return [crocodile(robot, what) for robot in robots]
