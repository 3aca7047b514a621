"""Bodies that are not on the shelf, for tests of what any body with a capability can do."""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from body_files import eight
from suchus.robot import blueprint
from suchus.robot.design import Robot, crocodile
from suchus.robot.design.scale import rescale
from suchus.robot.robots import ROBOTS

__all__ = ["CAIMAN", "eel", "eight", "hatchling", "six"]

CAIMAN: Robot = ROBOTS["caiman"]


@lru_cache(maxsize=1)
def six() -> Robot:
    """A crocodile with six spine joints and servos in its tail, as a file says it."""
    return blueprint.read_design(Path(__file__).parent / "experiments" / "six.toml", Robot, ROBOTS)


def hatchling() -> Robot:
    """The article's tables in a body of 0.3 m."""
    return crocodile(replace(rescale(CAIMAN.tables, length_factor=0.3 / CAIMAN.length), name="hatchling"))


def eel() -> Robot:
    """A row of equal segments without limbs, every other joint of which bends up and down."""
    swimmer = ROBOTS["swimmer"]
    axis = [
        replace(
            segment,
            hinges=tuple(replace(h, name=h.name.replace("yaw", "pitch"), turn="pitch") for h in segment.hinges)
            if i % 2
            else segment.hinges,
        )
        for i, segment in enumerate(swimmer.axis)
    ]
    return replace(swimmer, name="eel", axis=tuple(axis))
