"""What is asked of a robot before something is done with it, as data: who lacks it is refused in one sentence."""

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

from suchus.design.body import Robot
from suchus.design.layout import layout
from suchus.design.tables import ARTICLE_JOINTS
from suchus.errors import UnsuitedRobot


class Need(NamedTuple):
    """Something that a robot has or lacks."""

    words: str
    """How it is called, after ``needs``."""
    met: Callable[[Robot], bool]
    """Whether a robot has it."""


def _feet(robot: Robot) -> bool:
    limbs = layout(robot).limbs
    return bool(limbs) and all(len(limb.girdle.limb.hinges) > 1 for limb in limbs)


def _trunk(robot: Robot) -> bool:
    return bool(layout(robot).trunk_yaw)


NEEDS: Mapping[str, Need] = MappingProxyType(
    {
        "limbs": Need("limbs to walk on", lambda robot: bool(layout(robot).limbs)),
        "foot_paths": Need("limbs of several hinges, whose feet can be put at any height", _feet),
        "four_limbs": Need("four limbs", lambda robot: len(layout(robot).limbs) == 4),
        "trunk": Need("a trunk that bends sideways", _trunk),
        "axis": Need(
            "an axis that bends sideways", lambda robot: bool(layout(robot).axial_yaw or layout(robot).cables)
        ),
        "tables": Need(
            "a crocodile-like robot given by the article's tables, as 'caiman'",
            lambda robot: robot.tables is not None,
        ),
        "article_spine": Need(
            f"the article's spine of {ARTICLE_JOINTS} joints",
            lambda robot: robot.tables is not None and robot.spine.joints == ARTICLE_JOINTS,
        ),
        "cable_tail": Need(
            "the article's tail with a cable",
            lambda robot: robot.tables is not None and robot.tail.drive == "cable",
        ),
        "salamander_joints": Need(
            "the joints of the robot 'salamander'",
            lambda robot: {"spine_yaw_2", "tail_yaw_5", "LF_elbow", "RH_roll"} <= set(layout(robot).servos),
        ),
    }
)
"""Everything that is asked of a robot anywhere, by name."""


def lacking(robot: Robot, needs: Sequence[str]) -> list[str]:
    """Return those of several needs that a robot does not meet."""
    return [name for name in needs if not NEEDS[name].met(robot)]


def check_needs(robot: Robot, needs: Sequence[str], what: str) -> None:
    """Refuse a robot that lacks something.

    Args:
        robot: in either form.
        needs: names of ``NEEDS``.
        what: needs it, as the beginning of a sentence.

    Raises:
        UnsuitedRobot: it lacks something; the message names it.
    """
    missing = lacking(robot, needs)
    if missing:
        words = ", and ".join(NEEDS[name].words for name in missing)
        raise UnsuitedRobot(f"{what} needs {words}; robot {robot.name!r} lacks that: choose another robot.")
