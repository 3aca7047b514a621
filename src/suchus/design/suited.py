"""Who needs the article's kind of robot says so: what cannot be done with any body is refused in a sentence."""

from suchus.design.general import AnyRobot
from suchus.design.robot import Crocodile
from suchus.design.spine import ARTICLE_JOINTS
from suchus.errors import UnsuitedRobot


def crocodile(robot: AnyRobot, what: str) -> Crocodile:
    """Return a robot as the article's kind: four legs, a spine of five joints, a tail with one cable.

    Args:
        robot: in either form.
        what: needs it, as the beginning of a sentence: ``standing up``.

    Raises:
        UnsuitedRobot: it is another kind.
    """
    if not isinstance(robot, Crocodile):
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
