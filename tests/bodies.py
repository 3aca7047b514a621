"""Bodies that are not on the shelf, for tests of what any body with a capability can do."""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

from suchus import blueprint
from suchus.design import Robot, crocodile
from suchus.design.scale import scaled
from suchus.robots import ROBOTS

CAIMAN: Robot = ROBOTS["caiman"]


@lru_cache(maxsize=1)
def six() -> Robot:
    """A crocodile with six spine joints and servos in its tail, as a file says it."""
    return blueprint.read(Path(__file__).parent / "experiments" / "six.toml", Robot, ROBOTS)


def hatchling() -> Robot:
    """The article's tables in a body of 0.3 m."""
    return crocodile(replace(scaled(CAIMAN.tables, length_factor=0.3 / CAIMAN.length), name="hatchling"))


def eight() -> Robot:
    """A body of eight legs, light ones in the middle, the hind ones not at the root's origin; no tables make it."""
    front, hind = CAIMAN.girdles
    light = replace(front.limb, links=tuple(replace(link, mass=0.01) for link in front.limb.links))
    middle = [replace(front, name=name, segment=f"spine_{i}", at=0.0, limb=light) for name, i in (("M", 3), ("N", 2))]
    return replace(CAIMAN, name="eight", girdles=(front, *middle, replace(hind, at=-0.02, above=-0.006)))


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
