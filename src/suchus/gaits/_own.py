"""Which gait belongs to a robot: gaits say for whom they were made, and nothing else does."""

from suchus.catalog import Catalog
from suchus.design import AnyRobot, crocodile_like, layout
from suchus.errors import InvalidDesign, NotConverged, OutsideLimits, UnknownName, Unreachable, UnsuitedRobot
from suchus.motion import AnyGait, check_limits

_CRAWL = "belly_crawl"


def gait_of(shelf: Catalog[AnyGait], robot: AnyRobot) -> AnyGait:
    """Return the gait in which a robot walks unless another one is asked for.

    A gait made for a robot of its name comes first, then one made for another robot whose limbs it can move; robots of
    the article's tables crawl.

    Args:
        shelf: of gaits; a module says by ``made_for`` for which robots its gait is.
        robot: on the shelf or not.

    Raises:
        UnsuitedRobot: no gait of the shelf suits it.
    """
    made = {name: tuple(shelf.beside(name, "made_for", ())) for name in shelf}
    named = [name for name, robots in made.items() if robot.name in robots]
    others = [name for name, robots in made.items() if robots and name not in named]
    for name in named + ([_CRAWL] if crocodile_like(robot) else others):
        if suits(robot, shelf[name]):
            return shelf[name]
    limbs = ", ".join(layout(robot).limb_names) or "no limbs"
    raise UnsuitedRobot(
        f"no gait on the shelf suits robot {robot.name!r}, which has {limbs}: give one of its own, as a TOML file."
    )


def suits(robot: AnyRobot, gait: AnyGait) -> bool:
    """Return whether a robot's joints can follow a gait."""
    try:
        check_limits(robot, gait)
    except (InvalidDesign, NotConverged, OutsideLimits, UnknownName, Unreachable):
        return False
    return True
