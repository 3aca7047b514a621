"""The catalog of gaits: one file, one gait, declared as ``gait`` with its ``chosen`` numbers."""

from dataclasses import replace
from functools import lru_cache
from operator import attrgetter
from pathlib import Path

from suchus.core.catalog import Catalog
from suchus.core.errors import OutsideLimits, SuchusError, UnreadableFile, UnsuitedRobot
from suchus.core.files import read_toml
from suchus.robot.design import Robot, layout
from suchus.robot.design.scale import control_period, gravity_time
from suchus.robot.gaits._animal_swim import ANIMAL_SWIM
from suchus.robot.gaits.limbs_tail_lifted import LIFTED
from suchus.robot.motion import Gait, divide_axis, draft_gait, form_of, suits
from suchus.robot.robots import ROBOTS


def _read_gait(path: Path) -> Gait:
    """Return the gait that a file describes, for the robot that its base was made for.

    Raises:
        UnreadableFile: the file gives lengths in metres or places along the body, and its base belongs to no robot.
    """
    from suchus.robot import blueprint  # noqa: PLC0415  half of the time of an import that reads no file

    data = read_toml(path)
    base = data.get("base")
    robot_names = GAITS.beside(base, "made_for", ()) if isinstance(base, str) and base in GAITS else ()
    if form_of(data) is not None and not robot_names:
        raise UnreadableFile(
            f"{path.name} gives metres or places along the body, which are those of a robot: start it from a gait that "
            "is made for one (base), give the file's path with its robot, or write the gait in limbs and axis, whose "
            "lengths are shares of the limbs' reach."
        )
    return blueprint.read_gait(path, ROBOTS[robot_names[0] if robot_names else "caiman"], GAITS)


GAITS: Catalog[Gait] = Catalog(
    "gait", "suchus.robot.gaits", "suchus.robot.motion:Gait", name_of=attrgetter("name"), read_file=_read_gait
)
"""The gaits of the catalog."""

CONDITIONS = ("coordinated", "limbs_only", "limbs_tail_lifted", "tail_still", "spine_only", "tail_drag")
"""With spine and tail; with limbs only, the tail lying still; with limbs only, the tail in the air; with the trunk and
a tail dragged still; with the trunk and the tail in the air; with a straight trunk and a tail that swings."""


DRAFTED = "drafted_gait"
"""Name of the gait of a robot that none of the catalog suits."""
MAX_LENGTH_RATIO = 1.5
"""Lengths of two robots whose ratio is below this are about the same: the shorter one takes no quicker gait [-]."""


def default_gait(robot: Robot) -> Gait:
    """Return the default gait of a robot.

    A gait made for a robot of this name comes first. Next come gaits made for other robots whose limbs turn about the
    same axes, in the size of this robot (``in_size``): for a robot that pitches its tail first those that lay the tail
    down, for any other robot first those that do not. Only ``made_for`` in the module of a gait says for which robots
    it was made. If none of these gaits suits the robot, one is drafted, ``DRAFTED``: a walk in which every other limb
    steps, or a wave along a body without limbs.

    Args:
        robot: in the catalog or not.

    Raises:
        UnsuitedRobot: no gait of the catalog suits it, and none can be drafted.
    """
    robots_by_gait = {name: tuple(GAITS.beside(name, "made_for", ())) for name in GAITS}
    own_names = [name for name, robots in robots_by_gait.items() if robot.name in robots]
    pitches = bool(layout(robot).tail_pitch)
    other_names = [name for name, robots in robots_by_gait.items() if robots and name not in own_names]
    other_names.sort(key=lambda name: GAITS[name].has("tail pitch") != pitches)
    for name in own_names + other_names:
        maker: Robot = ROBOTS[robot.name if robot.name in ROBOTS and name in own_names else robots_by_gait[name][0]]
        gait = in_size(GAITS[name], robot, maker)
        if _turns(robot) == _turns(maker) and suits(robot, gait):
            return gait
    try:
        return _drafted(robot)
    except SuchusError as error:
        limbs = ", ".join(layout(robot).limb_names) or "no limbs"
        raise UnsuitedRobot(
            f"no gait in the catalog suits robot {robot.name!r}, which has {limbs}, and none can be drafted: {error} "
            "Give one of its own, as a TOML file."
        ) from error


def in_size(gait: Gait, robot: Robot, maker: Robot) -> Gait:
    """Return a gait as a robot of another size moves in it: in the time that gravity takes for that size.

    Everything else of a gait is an angle or a share of a limb, and fits any size. For robots of about the same length
    it is the gait itself, so that a design and its variants move alike.

    Args:
        gait: gait for the robot ``maker``.
        robot: robot that is to move in it.
        maker: for whom it was made.
    """
    if 1 / MAX_LENGTH_RATIO < robot.length / maker.length < MAX_LENGTH_RATIO:
        return gait
    period, step = gait.period * gravity_time(robot.length) / gravity_time(maker.length), control_period(robot)
    return replace(gait, period=round(max(1, round(period / step)) * step, 12))


MIN_TRUNK_STEERING = 0.05
"""Change of heading per cycle and curvature offset of the trunk below which a bend does not steer [rad/rad]."""


def trunk_steering(robot: Robot, gait: Gait) -> float | None:
    """Return how a curvature offset of the trunk turns a robot in a gait of the shelf, both left positive [rad/rad].

    It is the change of heading in a cycle over the bend. The module of a gait declares it as ``trunk_steering``, for
    each robot on which it was measured (``suchus.sim.land.measure_trunk_steering``). A robot that is not among them
    gets the number of the first one whose limbs turn about the same axes.

    Args:
        robot: the robot.
        gait: the gait, or a variant of it under the same name.

    Returns:
        The change of heading per cycle and bend; None where it was not measured.
    """
    measured = GAITS.beside(gait.name, "trunk_steering", {}) if gait.name in GAITS else {}
    if robot.name in measured:
        return float(measured[robot.name])
    similar = (name for name in measured if _turns(ROBOTS[name]) == _turns(robot) and layout(robot).trunk_yaw)
    return next((float(measured[name]) for name in similar), None)


def _turns(robot: Robot) -> list[list[str]]:
    """Return about which axes the hinges of each pair of limbs turn."""
    return [[hinge.turn for hinge in girdle.limb.hinges] for girdle in robot.girdles]


def gait_of(robot: Robot, gait: Gait | str | Path | None, place: str | Path = Path()) -> Gait:
    """Return the gait that is meant for a robot: itself, by its name, by the path of its file, or the robot's own.

    Args:
        robot: robot for whose limbs a file's metres are, and in whose hinges its places.
        gait: the gait, its name, or the path of a TOML file; None for the robot's own.
        place: the folder from which paths are read.

    Raises:
        UnknownName: a name that is not in the catalog.
        UnreadableFile: there is no such file, or it is no TOML.
        MistakenFile: the file describes no gait that can be.
        UnsuitedRobot: none is given, no gait of the catalog suits the robot, and none can be drafted.
    """
    if gait is None:
        return default_gait(robot)
    path = GAITS.file(gait, place)
    if path is None:
        return GAITS.resolve(gait)
    from suchus.robot import blueprint  # noqa: PLC0415  half of the time of an import that reads no file

    return blueprint.read_gait(path, robot, GAITS)


@lru_cache(maxsize=64)
def _drafted(robot: Robot) -> Gait:
    return draft_gait(robot, DRAFTED)


def control_group(gait: Gait, replacement: Gait | None = None) -> Gait:
    """Return the control group of a gait: the same legs, its axis still.

    Args:
        gait: gait with all of the axis.
        replacement: gait to use as control group; None for the gait without the motion of its axis.

    Raises:
        OutsideLimits: the replacement has other legs, so that more than the axis would differ.
    """
    if replacement is None:
        return gait.without("axis", name="limbs_only")
    legs = ("period", "duty_factor", "limb_phases", "limbs", "height")
    differences = [name for name in legs if getattr(gait, name) != getattr(replacement, name)]
    if [c for c in gait.curves if c.part == "limb"] != [c for c in replacement.curves if c.part == "limb"]:
        differences.append("measured curves of the limbs")
    if differences:
        raise OutsideLimits(
            f"the control group {replacement.name!r} has other legs than gait {gait.name!r}: they differ in "
            f"{', '.join(differences)}, and only the axis may differ; leave control out for the gait with its "
            "axis still."
        )
    return replacement


def conditions_of(robot: Robot, gait: Gait, control: Gait) -> dict[str, Gait]:
    """Return the gaits of those of ``CONDITIONS`` that a robot's parts make possible, in their order.

    The tail is lifted only if a servo pitches it. The swing of tail or trunk is removed only if servos bend that part.

    Args:
        robot: the design.
        gait: gait with all of the axis.
        control: control with limbs only.
    """
    place, gait = layout(robot), divide_axis(robot, gait)
    tail_servos = {*place.tail_yaw, *place.tail_pitch, *place.cables}
    front_servos = set(place.axial_yaw) - tail_servos
    lifts = place.tail_pitch and gait.has("steering")
    conditions = {"coordinated": gait}
    if tail_servos or front_servos:
        conditions["limbs_only"] = control
        if lifts:
            conditions["limbs_tail_lifted"] = control.lifted(LIFTED, name="limbs_tail_lifted")
    if tail_servos and front_servos:
        still_gait = gait.without("tail", name="tail_still")
        conditions["tail_still"] = still_gait
        if lifts:
            conditions["spine_only"] = still_gait.lifted(LIFTED, name="spine_only")
        conditions["tail_drag"] = gait.straightened("neck", "trunk", name="tail_drag")
    return conditions


__all__ = [
    "ANIMAL_SWIM",
    "CONDITIONS",
    "DRAFTED",
    "GAITS",
    "MAX_LENGTH_RATIO",
    "conditions_of",
    "control_group",
    "default_gait",
    "gait_of",
    "in_size",
    "suits",
]  # fmt: skip
