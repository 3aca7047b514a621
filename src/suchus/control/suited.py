"""Controllers that need the article's kind of robot and gait say so."""

from collections.abc import Sequence

from suchus.design import AnyRobot, Crocodile, crocodile
from suchus.errors import UnsuitedRobot
from suchus.motion import AnyGait, Gait


def crocodiles(robots: Sequence[AnyRobot], what: str) -> list[Crocodile]:
    """Return the robots of a batch as the article's kind.

    Args:
        robots: in either form.
        what: needs it, as the beginning of a sentence.

    Raises:
        UnsuitedRobot: one is another kind.
    """
    return [crocodile(robot, what) for robot in robots]


def leg_gaits(gaits: Sequence[AnyGait], what: str) -> list[Gait]:
    """Return the gaits of a batch as the article's kind.

    Args:
        gaits: of either kind.
        what: needs it, as the beginning of a sentence.

    Raises:
        UnsuitedRobot: one is a pattern of any body.
    """
    found = []
    for gait in gaits:
        if not isinstance(gait, Gait):
            raise UnsuitedRobot(
                f"{what} needs a gait of four legs with a trunk and a tail, as 'belly_crawl'; gait {gait.name!r} is a "
                "pattern of any body: walk it in open loop."
            )
        found.append(gait)
    return found
