"""Any robot: an axis, girdles with limbs, what drives them, and how it meets the ground."""

from collections import Counter
from dataclasses import dataclass, field, fields
from itertools import pairwise
from math import fsum
from typing import TypeVar

from suchus.core.checks import Checks
from suchus.core.errors import UnsuitedRobot
from suchus.core.kinds import show
from suchus.robot.design.ground import Contact
from suchus.robot.design.hinge import Cable, Hinge, Servo
from suchus.robot.design.hull import Hull
from suchus.robot.design.limb import Girdle
from suchus.robot.design.measures import (
    HeadMeasures,
    LegMeasures,
    PelvisMeasures,
    SpineMeasures,
    TailMeasures,
    ThoraxMeasures,
    head_of,
    leg_of,
    pelvis_of,
    spine_of,
    tail_of,
    thorax_of,
)
from suchus.robot.design.segment import Segment
from suchus.robot.design.tables import Tables

M = TypeVar("M")
_TRUNK_YAW = "spine_yaw_"
"""How the names begin of the yaw hinges between the root and the foremost girdle, and of no others."""
MAX_SERVOS = 31
"""Servos at most [-]: MuJoCo can switch off so many one by one."""


class _Hashed:
    """Remembers its hash: functions of a whole robot are cached, and a robot has hundreds of numbers."""

    __slots__ = ("_hash",)
    _hash: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Robot(_Hashed):
    """Any robot with an axis, as data.

    World: x forward, y left, z up. At zero posture all frames are parallel and every limb points where its links say.
    """

    name: str
    """Name, as messages, tables and files show it."""
    root: str
    """The segment that carries the free joint: that of the hindmost girdle, or any one of a body without limbs."""
    axis: tuple[Segment, ...]
    """Segments of the axis, from the snout to the tip of the tail."""
    girdles: tuple[Girdle, ...]
    """Girdles, from the front to the hind one."""
    cables: tuple[Cable, ...]
    """Cables, each over hinges with springs that follow each other."""
    contact: Contact
    """Friction, stiffness and damping of the contact of its surfaces with the ground."""
    hull: Hull | None = None
    """Foam and air that make it float; None for a robot without."""
    tables: Tables | None = field(default=None, init=False, compare=False, repr=False)
    """The tables where ``design.crocodile`` made it of them; whoever wants them asks ``design.article.tables_of``."""

    def __post_init__(self) -> None:
        with Checks("robot", self) as check:
            _check_names(self, check)
        with Checks("robot", self) as check:
            _check_axis(self, check)
            _check_limbs(self, check)
            _check_drives(self, check)

    def __hash__(self) -> int:
        """Return the hash of all compared fields, computed once."""
        try:
            return self._hash
        except AttributeError:
            compared_values = tuple(getattr(self, definition.name) for definition in fields(self) if definition.compare)
            object.__setattr__(self, "_hash", hash(compared_values))
            return self._hash

    @property
    def mass(self) -> float:
        """Mass of the whole robot [kg]."""
        shapes = [shape.mass for segment in self.axis for shape in segment.shapes]
        limbs = [mass for girdle in self.girdles for mass in girdle.limb.masses]
        return fsum([*shapes, *limbs, *limbs, 0.0 if self.hull is None else self.hull.mass])

    @property
    def length(self) -> float:
        """Length from the tip of the snout to the tip of the tail when straight [m]."""
        return fsum(end for segment in self.axis for end in (segment.front, segment.rear))

    @property
    def axis_hinges(self) -> tuple[Hinge, ...]:
        """Segments of the axis, from head to tail."""
        return tuple(hinge for segment in self.axis for hinge in segment.hinges)

    @property
    def root_index(self) -> int:
        """Index of the root among the segments of the axis [-]."""
        return [segment.name for segment in self.axis].index(self.root)

    def servo(self, name: str) -> Servo:
        """Return the servo that carries a name of ``design.servo_names(robot)``."""
        return servos_of(self)[name]

    @property
    def hind_leg(self) -> LegMeasures:
        """The measures of the hind girdle's left limb; ``UnsuitedRobot`` if it is no leg of yaw, pitch and knee."""
        return self.leg("LH")

    @property
    def front_leg(self) -> LegMeasures:
        """The measures of the front girdle's left limb; ``UnsuitedRobot`` if it is no leg of yaw, pitch and knee."""
        return self.leg("LF")

    def leg(self, name: str) -> LegMeasures:
        """Return the measures of the left limb of the front (``LF``, ``RF``) or hind girdle (``LH``, ``RH``)."""
        leg = leg_of(self.girdles[0 if name.endswith("F") else -1]) if self.girdles else None
        return self._has(leg, "legs of yaw, pitch and knee")

    @property
    def spine(self) -> SpineMeasures:
        """The measures of its spine; ``UnsuitedRobot`` if its joints do not turn by yaw and pitch in turn."""
        return self._has(spine_of(self), "a spine of equal links whose joints turn by yaw and pitch in turn")

    @property
    def tail(self) -> TailMeasures:
        """The measures of its tail; ``UnsuitedRobot`` if it is no row of plates with a passive end."""
        return self._has(tail_of(self), "a tail that pitches, bends in equal joints and ends in passive segments")

    @property
    def pelvis(self) -> PelvisMeasures:
        """The measures of its shell ``pelvis``; ``UnsuitedRobot`` without one."""
        return self._has(pelvis_of(self), "a shell called pelvis")

    @property
    def thorax(self) -> ThoraxMeasures:
        """The measures of its shell ``thorax``; ``UnsuitedRobot`` without one."""
        return self._has(thorax_of(self), "a shell called thorax")

    @property
    def head(self) -> HeadMeasures:
        """The measures of its shell ``head``; ``UnsuitedRobot`` without one."""
        return self._has(head_of(self), "a shell called head")

    def _has(self, measures: M | None, description: str) -> M:
        if measures is None:
            raise UnsuitedRobot(f"robot {self.name!r} lacks {description}: choose another robot.")
        return measures


def servos_of(robot: Robot) -> dict[str, Servo]:
    """Return every servo by name, those of limbs first; of a linear actuator the servo that would do the same."""
    servos = {}
    for girdle in robot.girdles:
        for side in "LR":
            for hinge in girdle.limb.hinges:
                if hinge.servo is not None:
                    servos[f"{side}{girdle.name}_{hinge.name}"] = hinge.servo
    servos |= {hinge.name: hinge.servo for hinge in robot.axis_hinges if hinge.servo is not None}
    return servos | {cable.name: cable.turning for cable in robot.cables}


def bends_trunk(hinge: str) -> bool:
    """Tell by its name whether a hinge bends the trunk sideways; bodies must name those hinges, and no others, so."""
    return hinge.startswith(_TRUNK_YAW)


def _check_names(robot: Robot, check: Checks) -> None:
    """Report an axis without segments, a root or girdle on an unknown segment, and names that are used twice."""
    check.that(len(robot.axis) > 0, "the axis has no segment; give it one")
    segment_names = [segment.name for segment in robot.axis]
    check.that(
        robot.root in segment_names,
        f"root is {show(robot.root)}, no segment of the axis; there is {', '.join(segment_names)}",
    )
    for girdle in robot.girdles:
        check.that(
            girdle.segment in segment_names,
            f"girdle {girdle.name} sits on {show(girdle.segment)}, no segment of the axis; there is "
            f"{', '.join(segment_names)}",
        )
    limb_names = [f"{side}{girdle.name}" for girdle in robot.girdles for side in "LR"]
    link_names = [
        f"{limb}_{link.name}" for g in robot.girdles for limb in (f"L{g.name}", f"R{g.name}") for link in g.limb.links
    ]
    hinge_and_cable_names = [hinge.name for hinge in robot.axis_hinges] + [cable.name for cable in robot.cables]
    shape_names = [shape.name for segment in robot.axis for shape in segment.shapes]
    limb_hinges = [hinge.name for girdle in robot.girdles for hinge in girdle.limb.hinges]
    check.printable(
        [robot.name, *segment_names, *link_names, *limb_names, *hinge_and_cable_names, *limb_hinges, *shape_names]
    )
    for kind, group_names in (
        ("segments or links", [*segment_names, *link_names]),
        ("limbs", limb_names),
        ("hinges or cables", hinge_and_cable_names),
        ("shapes", shape_names),
    ):
        duplicates = [name for name, count in Counter(group_names).items() if count > 1]
        check.that(not duplicates, f"several {kind} are called {', '.join(duplicates)}; each needs a name of its own")


def _check_axis(robot: Robot, check: Checks) -> None:
    """Report girdles out of order, a root in the wrong segment, and yaw hinges with the wrong kind of name."""
    last_segment = robot.axis[-1]
    check.that(
        not last_segment.hinges,
        f"segment {last_segment.name} is the last one, so that its hinges join nothing; remove them",
    )
    place = {segment.name: i for i, segment in enumerate(robot.axis)}
    root = robot.root_index
    order = [(place[girdle.segment], -girdle.at) for girdle in robot.girdles]
    check.that(order == sorted(order), "the girdles must be listed from the front to the hind one")
    if robot.girdles:
        hindmost = robot.girdles[-1].segment
        check.that(
            robot.root == hindmost,
            f"root is {robot.root!r}; a body with limbs has its root in the hindmost girdle's segment, {hindmost!r}",
        )
        front = place[robot.girdles[0].segment]
        yaws = {h.name for s in robot.axis[front:root] for h in s.hinges if h.turn == "yaw"}
    else:
        yaws = {h.name for s in robot.axis[:root] for h in s.hinges if h.turn == "yaw"}
    named_yaws = {hinge.name for hinge in robot.axis_hinges if bends_trunk(hinge.name)}
    check.that(
        yaws == named_yaws,
        f"the yaw hinges between root and foremost girdle are {', '.join(sorted(yaws)) or 'none'}, those whose names "
        f"begin with {_TRUNK_YAW} {', '.join(sorted(named_yaws)) or 'none'}: name these hinges so, and no others",
    )


def _check_limbs(robot: Robot, check: Checks) -> None:
    """Report girdles off their segment, and limbs that are too short to carry the belly."""
    segments = {segment.name: segment for segment in robot.axis}
    for girdle in robot.girdles:
        segment = segments[girdle.segment]
        check.that(
            -segment.rear - 1e-9 <= girdle.at <= segment.front + 1e-9,
            f"girdle {girdle.name} sits {girdle.at:g} m along segment {segment.name}, which reaches from "
            f"{-segment.rear:g} to {segment.front:g} m: the parts do not join; move it there",
        )
        depth = girdle.limb.reach + girdle.limb.foot.radius
        belly = max(shape.bottom for axis_segment in robot.axis for shape in axis_segment.shapes) + girdle.above
        check.that(
            depth > belly,
            f"limb {girdle.name} reaches {depth:.3g} m below its hip but the belly hangs {belly:.3g} m below it: the "
            "foot cannot reach the ground; lengthen its links",
        )


def _check_drives(robot: Robot, check: Checks) -> None:
    """Report cables over hinges that do not fit, hinges with two drives, and servos of the wrong size."""
    order = [hinge.name for hinge in robot.axis_hinges]
    by_name = {hinge.name: hinge for hinge in robot.axis_hinges}
    drive_of_hinge: dict[str, str] = {}
    for cable in robot.cables:
        unknown = [name for name in cable.hinges if name not in by_name]
        check.that(not unknown, f"cable {cable.name} bends {', '.join(unknown)}, no hinge of the axis")
        if unknown:
            continue
        places = [order.index(name) for name in cable.hinges]
        follow = all(abs(b - a) == 1 and b - a == places[1] - places[0] for a, b in pairwise(places))
        has_one_turn = len({by_name[name].turn for name in cable.hinges}) == 1
        check.that(
            follow and has_one_turn,
            f"cable {cable.name} bends {', '.join(cable.hinges)}, which do not follow each other along the axis as "
            "hinges of one turn; name neighbours",
        )
        for name in cable.hinges:
            second = drive_of_hinge.get(name) or ("a servo of its own" if by_name[name].servo is not None else "")
            check.that(
                not second, f"hinge {name} has two drives, cable {cable.name} and {second}; take one of them away"
            )
            drive_of_hinge[name] = f"cable {cable.name}"
    servos = servos_of(robot)
    check.that(
        1 <= len(servos) <= MAX_SERVOS,
        f"robot {robot.name} has {len(servos)} servos; 1 to {MAX_SERVOS} are allowed",
    )
    check_scale(check, robot.name, servos, robot.mass, robot.length)


MAX_INERTIA_RATIO = 0.1
"""Rotor inertia of a servo over mass times length squared of its robot, at most [-]."""


def check_scale(check: Checks, robot: str, servos: dict[str, Servo], mass: float, length: float) -> None:
    """Refuse servos whose numbers belong to a body of another size.

    The rotor's inertia must be a small part of the body's, or the body moves as its motors and not as its mass.

    Args:
        check: collects what is wrong.
        robot: its name.
        servos: servos by name.
        mass: mass of the robot [kg].
        length: length of the robot [m].
    """
    for name, servo in servos.items():
        inertia_ratio = servo.armature / (mass * length**2)
        check.that(
            inertia_ratio <= MAX_INERTIA_RATIO,
            f"servo {name} of {robot} has an armature of {servo.armature:.3g} kg m2, {inertia_ratio:.3g} of mass "
            f"times length squared ({mass:.3g} kg, {length:.3g} m), where up to {MAX_INERTIA_RATIO:g} makes sense: "
            "it belongs to a larger robot; see suchus.robot.design.scale.rescale",
        )
        if inertia_ratio > MAX_INERTIA_RATIO:
            break
