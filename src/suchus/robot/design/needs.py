"""Requirements that a robot must meet for a task, and the error that names those it does not meet."""

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

from suchus.core.errors import UnsuitedRobot
from suchus.robot.design.article import tables_of
from suchus.robot.design.body import Robot
from suchus.robot.design.layout import layout
from suchus.robot.design.measures import head_of, leg_of, pelvis_of, spine_of, tail_of, thorax_of
from suchus.robot.design.tables import ARTICLE_JOINTS


class Need(NamedTuple):
    """Something that a robot has or lacks."""

    text: str
    """How it is called, after ``needs``."""
    is_met: Callable[[Robot], bool]
    """Whether a robot has it."""


def _feet(robot: Robot) -> bool:
    limbs = layout(robot).limbs
    return bool(limbs) and all(len(limb.girdle.limb.hinges) > 1 for limb in limbs)


def _trunk(robot: Robot) -> bool:
    return bool(layout(robot).trunk_yaw)


def _tail_yaw(robot: Robot) -> bool:
    place = layout(robot)
    cable_hinges = [place.hinges.index(place.cable(servo).hinges[0]) for servo in place.cables]
    return bool(place.tail_yaw) or any(hinge >= place.backward_hinges.start for hinge in cable_hinges)


def _legs(robot: Robot) -> bool:
    return len(robot.girdles) == 2 and all(leg_of(girdle) is not None for girdle in robot.girdles)


def _hind_legs(robot: Robot) -> bool:
    """Return whether the root carries legs of yaw, pitch and knee with a servo at every hinge."""
    hind = robot.girdles[-1] if robot.girdles else None
    return (
        hind is not None
        and hind.segment == robot.root
        and leg_of(hind) is not None
        and all(hinge.servo is not None for hinge in hind.limb.hinges)
    )


def _tail_root(robot: Robot) -> bool:
    root = robot.axis[robot.root_index]
    return any(hinge.turn == "pitch" and hinge.servo is not None for hinge in root.hinges)


def _shells(robot: Robot) -> bool:
    return None not in (pelvis_of(robot), thorax_of(robot), head_of(robot))


def _article_spine(robot: Robot) -> bool:
    spine = spine_of(robot)
    return spine is not None and spine.joints == ARTICLE_JOINTS and robot.axis[0].name == robot.girdles[0].segment


def _cable_tail(robot: Robot) -> bool:
    tail = tail_of(robot)
    return tail is not None and tail.cabled


NEEDS: Mapping[str, Need] = MappingProxyType(
    {
        "limbs": Need("limbs to walk on", lambda robot: bool(layout(robot).limbs)),
        "foot_paths": Need("limbs of several hinges, whose feet can be put at any height", _feet),
        "four_limbs": Need("four limbs", lambda robot: len(layout(robot).limbs) == 4),
        "trunk": Need("a trunk that bends sideways", _trunk),
        "trunk_pitch": Need("a trunk that bends up and down", lambda robot: bool(layout(robot).trunk_pitch)),
        "tail_yaw": Need("a tail that bends sideways", _tail_yaw),
        "tail_pitch": Need("a tail that bends up and down", lambda robot: bool(layout(robot).tail_pitch)),
        "axis": Need(
            "an axis that bends sideways", lambda robot: bool(layout(robot).axial_yaw or layout(robot).cables)
        ),
        "tables": Need(
            "the article's tables, of which it is made, as 'caiman'", lambda robot: tables_of(robot) is not None
        ),
        "spine": Need("a spine whose joints turn by yaw and pitch in turn", lambda robot: spine_of(robot) is not None),
        "tail": Need("a tail of equal plates with a passive end", lambda robot: tail_of(robot) is not None),
        "legs": Need("four legs of yaw, pitch and knee", _legs),
        "hind_legs": Need("hind legs of yaw, pitch and knee at its root", _hind_legs),
        "tail_root": Need("a tail that pitches at its root", _tail_root),
        "shells": Need("shells called pelvis, thorax and head", _shells),
        "article_spine": Need(
            f"the article's spine of {ARTICLE_JOINTS} joints",
            _article_spine,
        ),
        "cable_tail": Need(
            "the article's tail with a cable",
            _cable_tail,
        ),
        "salamander_joints": Need(
            "the joints of the robot 'salamander'",
            lambda robot: {"spine_yaw_2", "tail_yaw_5", "LF_elbow", "RH_roll"} <= set(layout(robot).servos),
        ),
    }
)
"""Everything that is asked of a robot anywhere, by name."""
MEASURED = ("legs", "shells", "spine", "tail")
"""The chains of whose measures the crocodile's skin and its dimension drawing are made; any other body is drawn by its
shapes."""
STANDING = ("hind_legs", "trunk_pitch", "tail_root")
"""What a body needs to stand up on hind legs and tail."""


def lacking(robot: Robot, needs: Sequence[str]) -> list[str]:
    """Return those of several needs that a robot does not meet."""
    return [name for name in needs if not NEEDS[name].is_met(robot)]


def check_needs(robot: Robot, needs: Sequence[str], consumer: str, *, remedy: str = "choose another robot") -> Robot:
    """Return a robot that has what is needed; refuse one that lacks something.

    Args:
        robot: any robot.
        needs: names of ``NEEDS``.
        consumer: needs it, as the beginning of a sentence.
        remedy: what the user can do, as the end of a sentence.

    Raises:
        UnsuitedRobot: it lacks something; the message names it.
    """
    missing = lacking(robot, needs)
    if missing:
        words = ", and ".join(NEEDS[name].text for name in missing)
        raise UnsuitedRobot(f"{consumer} needs {words}; robot {robot.name!r} lacks that: {remedy}.")
    return robot
