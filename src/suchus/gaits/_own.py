"""Which gait belongs to a robot: gaits say for whom they were made, and nothing else does."""

from suchus.catalog import Catalog
from suchus.design import Robot, layout
from suchus.errors import UnsuitedRobot
from suchus.motion import Gait, suits


def gait_of(shelf: Catalog[Gait], robot: Robot) -> Gait:
    """Return the gait in which a robot walks unless another one is asked for.

    A gait made for a robot of its name comes first, then one made for another robot whose limbs it can move: of a robot
    that pitches its tail those first that lay it down, of any other robot those that leave it alone.

    Args:
        shelf: of gaits; a module says by ``made_for`` for which robots its gait is.
        robot: on the shelf or not.

    Raises:
        UnsuitedRobot: no gait of the shelf suits it.
    """
    made = {name: tuple(shelf.beside(name, "made_for", ())) for name in shelf}
    named = [name for name, robots in made.items() if robot.name in robots]
    pitches = bool(layout(robot).tail_pitch)
    others = [name for name, robots in made.items() if robots and name not in named]
    others.sort(key=lambda name: shelf[name].has("tail pitch") != pitches)
    for name in named + others:
        if suits(robot, shelf[name]):
            return shelf[name]
    limbs = ", ".join(layout(robot).limb_names) or "no limbs"
    raise UnsuitedRobot(
        f"no gait on the shelf suits robot {robot.name!r}, which has {limbs}: give one of its own, as a TOML file."
    )
