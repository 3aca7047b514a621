"""The robot that the article's tables make: segment by segment, joint by joint."""

from collections.abc import Callable
from dataclasses import fields, replace
from functools import lru_cache
from typing import Any, NamedTuple, TypeVar

from suchus.core.errors import InvalidDesign
from suchus.robot.design.body import Robot
from suchus.robot.design.hinge import Cable, Hinge, LinearActuator, Servo, Spring
from suchus.robot.design.limb import Foot, Girdle, Limb, Link
from suchus.robot.design.measures import head_of, leg_of, pelvis_of, spine_of, tail_of, thorax_of
from suchus.robot.design.segment import Rod, Segment, Shell
from suchus.robot.design.tables import (
    LEG_SHARES,
    TIBIA_RADIUS_RATIO,
    Head,
    Leg,
    Pelvis,
    Spine,
    Tables,
    Tail,
    Thorax,
    tail_segments,
)

T = TypeVar("T")

PASSIVE_RANGE = 1.2
"""Stops of the passive joints of a tail to either side [rad]."""
_PASSIVE_ARMATURE = 1e-4  # [kg m2]
_SPARE = 1.5  # stop of a joint over its share of the greatest bend [-]


def crocodile(tables: Tables) -> Robot:
    """Return the robot of the article's kind that has these measures.

    The robot stores the tables, so that ``with_values`` can change one of their numbers and build the robot again.

    Raises:
        InvalidDesign: these measures make no robot.
    """
    tail = tables.tail
    robot = Robot(
        name=tables.name,
        root="pelvis",
        axis=(*_front_segments(tables), _pelvis(tables), *_tail(tail)),
        girdles=(
            _girdle("F", "thorax", tables.thorax.shoulder, tables.front_leg),
            _girdle("H", "pelvis", 0.0, tables.hind_leg),
        ),
        cables=() if tail.drive == "servos" else (_cable(tail),),
        contact=tables.contact,
        hull=tables.hull,
    )
    object.__setattr__(robot, "tables", tables)
    return robot


def rebuild(robot: Robot, change: Callable[[Any], Any]) -> Robot:
    """Return a robot with a change in its tables if it has some, else in itself.

    Args:
        robot: the robot; it stays as it is.
        change: takes ``Tables`` or a ``Robot`` and returns the same.
    """
    tables = tables_of(robot)
    remade_robot: Robot = change(robot) if tables is None else crocodile(change(tables))
    return remade_robot


@lru_cache(maxsize=256)
def tables_of(robot: Robot) -> Tables | None:
    """Return the tables that make a robot, remembered or read back from its measures; None if no tables make it.

    None where no tables make it.
    """
    if robot.tables is not None:
        return robot.tables
    tail, spine = tail_of(robot), spine_of(robot)
    pelvis, thorax, head = pelvis_of(robot), thorax_of(robot), head_of(robot)
    legs = [leg_of(girdle) for girdle in robot.girdles]
    if tail is None or spine is None or pelvis is None or thorax is None or head is None or len(legs) != 2:
        return None
    if not tail.cabled or not spine.link_masses or legs[0] is None or legs[1] is None:
        return None
    try:
        tables = Tables(
            name=robot.name,
            hind_leg=_from_measures(Leg, legs[1]),
            front_leg=_from_measures(Leg, legs[0]),
            pelvis=_from_measures(Pelvis, pelvis),
            spine=_from_measures(Spine, spine, link_mass=spine.link_masses[0]),
            thorax=_from_measures(Thorax, thorax),
            head=_from_measures(Head, head),
            tail=_from_measures(Tail, tail, plate=tail.plate, **_cord_drive(robot)),
            contact=robot.contact,
            hull=robot.hull,
        )
        return tables if crocodile(tables) == robot else None
    except InvalidDesign:
        return None


def _cord_drive(robot: Robot) -> dict[str, object]:
    """Return the fields of the tables that describe the drive of the tail's cords."""
    linear = robot.cables[0].linear
    return {"drive": "cable"} if linear is None else {"drive": "linear_actuator", "actuator": linear}


def _from_measures(kind: type[T], measures: NamedTuple, **extra_fields: object) -> T:
    """Return a part of the tables, filled with the measures of the same names.

    Args:
        kind: class of the part.
        measures: read from a robot.
        **extra_fields: fields that the measures do not have, by name.
    """
    names = {field.name for field in fields(kind)}  # type: ignore[arg-type]
    return kind(**{name: value for name, value in measures._asdict().items() if name in names}, **extra_fields)


def cable_names(tail: Tail) -> tuple[str, ...]:
    """Return the driven yaw joints of a tail from root to tip."""
    return tuple(f"tail_yaw_{i + 1}" for i in range(tail.joints))


def fin_names(tail: Tail) -> tuple[str, ...]:
    """Return the passive joints of a tail from root to tip, yaw before pitch in each."""
    return tuple(f"fin_{turn}_{i + 1}" for i in range(tail.fin_segments) for turn in ("yaw", "pitch"))


def _front_segments(tables: Tables) -> list[Segment]:
    """Return head with thorax, then the links of the spine back to the pelvis."""
    spine, thorax, head = tables.spine, tables.thorax, tables.head
    hinges = [_spine_hinge(tables, name) for name in spine.names]
    length = head.snout - thorax.shoulder
    front = Segment(
        name="thorax",
        front=head.snout,
        rear=0.0,
        shapes=(
            Shell(name="thorax", at=(thorax.shoulder / 2, 0, 0), half=thorax.half, mass=thorax.mass),
            Shell(
                name="head",
                at=(head.snout - length / 2, 0, 0),
                half=(length / 2, head.width / 2, head.height / 2),
                mass=head.mass,
            ),
        ),
        hinges=(hinges[-1],),
    )
    links = [
        Segment(
            name=f"spine_{i + 1}",
            front=spine.link,
            rear=0.0,
            shapes=(
                Rod(
                    name=f"spine_{i + 1}",
                    start=(0, 0, 0),
                    end=(spine.link, 0, 0),
                    radius=spine.radius,
                    mass=spine.link_mass,
                ),
            ),
            hinges=(hinge,),
        )
        for i, hinge in enumerate(hinges[:-1])
    ]
    return [front, *reversed(links)]


def _spine_hinge(tables: Tables, name: str) -> Hinge:
    spine = tables.spine
    if "yaw" in name:
        return Hinge(name=name, turn="yaw", range=spine.yaw_range, drive=spine.yaw_servo)
    return Hinge(name=name, turn="pitch", range=spine.pitch_range, drive=spine.pitch_servo)


def _pelvis(tables: Tables) -> Segment:
    """Return the segment of the hind girdle, whose hinge pitches the tail."""
    pelvis, tail = tables.pelvis, tables.tail
    half = (pelvis.length / 2, pelvis.width / 2, pelvis.height / 2)
    return Segment(
        name="pelvis",
        front=tables.spine.base,
        rear=tail.offset,
        shapes=(Shell(name="pelvis", at=(0, 0, 0), half=half, mass=pelvis.mass),),
        hinges=(Hinge(name="tail_pitch", turn="pitch", range=tail.pitch_range, drive=tail.pitch_servo),),
    )


def _tail(tail: Tail) -> list[Segment]:
    """Return the segments of the tail from its root to its tip."""
    joints = [(hinge,) for hinge in _driven_hinges(tail)] + [_passive(tail, i) for i in range(tail.fin_segments)]
    segments = []
    for i, (length, radius, mass) in enumerate(zip(*tail_segments(tail), strict=True)):
        name = f"tail_{i}" if i else "tail_root"
        rod = Rod(name=name, start=(0, 0, 0), end=(-length, 0, 0), radius=radius, mass=mass)
        hinges = joints[i] if i < len(joints) else ()
        segments.append(Segment(name=name, front=0.0, rear=length, shapes=(rod,), hinges=hinges))
    return segments


def _driven_hinges(tail: Tail) -> list[Hinge]:
    """Return the yaw hinges that the cable bends, or that have a servo each."""
    limit = _SPARE * tail.bend_limit / tail.joints
    drive: Servo | Spring = tail.cable_servo
    if tail.drive != "servos":
        drive = Spring(stiffness=tail.joint_stiffness, damping=tail.joint_damping, armature=_PASSIVE_ARMATURE)
    return [Hinge(name=name, turn="yaw", range=(-limit, limit), drive=drive) for name in cable_names(tail)]


def _passive(tail: Tail, number: int) -> tuple[Hinge, Hinge]:
    """Return the yaw and the pitch hinge of one passive segment; stiffness falls linearly to half at the last segment.

    Args:
        tail: the measures.
        number: number of the passive segment, from the root [-].
    """
    softer = 1.0 - 0.5 * number / max(tail.fin_segments - 1, 1)
    names = fin_names(tail)[2 * number : 2 * number + 2]

    def hinge(name: str, stiffness: float) -> Hinge:
        spring = Spring(stiffness=softer * stiffness, damping=tail.fin_damping, armature=_PASSIVE_ARMATURE)
        turn = "yaw" if "yaw" in name else "pitch"
        return Hinge(name=name, turn=turn, range=(-PASSIVE_RANGE, PASSIVE_RANGE), drive=spring)  # type: ignore[arg-type]

    return hinge(names[0], tail.fin_stiffness_lateral), hinge(names[1], tail.fin_stiffness_vertical)


def _cable(tail: Tail) -> Cable:
    """Return the cable of the tail with its servo or its linear actuator."""
    cable = Cable(
        name="tail_cable",
        hinges=cable_names(tail),
        cord_spacing=tail.cord_spacing,
        pulley=tail.pulley,
        bend_limit=tail.bend_limit,
        servo=tail.cable_servo,
        gap=tail.gap,
    )
    if tail.drive != "linear_actuator":
        return cable
    ideal = LinearActuator.from_servo(tail.cable_servo, tail.pulley, cable.cord_travel(tail.bend_limit))
    return replace(cable, servo=tail.actuator or ideal, pulley=0.0)


def _girdle(name: str, segment: str, position: float, leg: Leg) -> Girdle:
    """Return a girdle with legs of yaw, pitch and knee.

    Args:
        name: ending of the limbs' names, ``F`` or ``H``.
        segment: name of the segment that carries it.
        position: position from the segment's origin forward to the hips [m].
        leg: the measures of the left leg.
    """

    def hinge(word: str, turn: str, limits: tuple[float, float]) -> Hinge:
        return Hinge(name=word, turn=turn, range=limits, drive=leg.servo)  # type: ignore[arg-type]

    femur = Link(
        name="femur",
        hinges=(hinge("yaw", "yaw", leg.yaw_range), hinge("pitch", "pitch", leg.pitch_range)),
        end=(0.0, leg.femur, 0.0),
        radius=leg.radius,
        mass=LEG_SHARES[0] * leg.mass,
    )
    tibia = Link(
        name="tibia",
        hinges=(hinge("knee", "pitch", leg.knee_range),),
        end=(0.0, leg.tibia, 0.0),
        radius=TIBIA_RADIUS_RATIO * leg.radius,
        mass=LEG_SHARES[1] * leg.mass,
    )
    foot = Foot(radius=leg.foot_radius, mass=LEG_SHARES[2] * leg.mass)
    return Girdle(
        name=name,
        segment=segment,
        at=position,
        aside=leg.hip_offset,
        above=0.0,
        limb=Limb(links=(femur, tibia), foot=foot),
    )
