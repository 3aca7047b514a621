"""Which robot a page is about: the one that its results were made with."""

from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import ValidationError

from suchus.blueprint import described_robot
from suchus.design import Robot
from suchus.errors import SuchusError
from suchus.report.result import Result
from suchus.robots import ROBOTS

ARTICLES = "caiman"
"""Name of the article's robot, shown where no result names one; verdicts are shown of no other."""


def robot_of(results: Sequence[Result]) -> tuple[Robot, dict[str, int]]:
    """Return the robot of most results, and how many results each other robot has, by name.

    A robot that this version of suchus cannot build any more does not count.
    """
    found = [robot for result in results if (robot := _robot(result.outcome.get("settings", {}))) is not None]
    if not found:
        return ROBOTS[ARTICLES], {}
    (most, _), *others = Counter(found).most_common()
    return most, {robot.name: count for robot, count in others}


def _robot(settings: Any) -> Robot | None:
    values = settings.get("robot") if isinstance(settings, Mapping) else None
    try:
        return described_robot(values) if isinstance(values, Mapping) else None
    except (ValidationError, SuchusError):
        return None
