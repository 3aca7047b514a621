"""The layout of a robot: bodies, hinges, servos and limbs in order, derived from the design and spelled nowhere else.

Hinges: those of the limbs, girdle by girdle from the front, left before right, from hip to foot; then of the axis from
the root forward; then from the root backward. Servos: those of the same hinges, where they have one; then the cables.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Literal

import numpy as np

from suchus.core.errors import UnknownName
from suchus.robot.design.body import Robot, bends_trunk
from suchus.robot.design.hinge import Cable, Hinge
from suchus.robot.design.limb import Girdle, Limb
from suchus.robot.design.segment import Inertia

Axis = tuple[float, float, float]
_FORWARD_AXES: dict[str, Axis] = {"yaw": (0.0, 0.0, 1.0), "pitch": (0.0, 1.0, 0.0), "roll": (1.0, 0.0, 0.0)}
_BACKWARD_AXES: dict[str, Axis] = {"yaw": (0.0, 0.0, 1.0), "pitch": (0.0, -1.0, 0.0), "roll": (-1.0, 0.0, 0.0)}
LIMB_AXES: Mapping[str, Axis] = {"yaw": (0.0, 0.0, -1.0), "pitch": (-1.0, 0.0, 0.0), "roll": (0.0, -1.0, 0.0)}
"""Axes of the turns of a left limb at zero posture."""


@dataclass(frozen=True, slots=True)
class LayoutBody:
    """A moving body: a segment of the axis or a link of a limb."""

    name: str
    """Name of the body in the model."""
    parent: int
    """Its place among the bodies; -1 for the root."""
    offset: Axis
    """Its origin in the frame of its parent, all hinges at zero [m]."""
    shift: float
    """Distance by which the origin of its segment lies ahead of its frame, which stands at its hinges [m]."""
    hinges: tuple[tuple[Hinge, str, Axis], ...]
    """Its hinges in the order in which they turn it: the design, the full name, the axis in its own frame."""
    inertia: Inertia | None
    """Where its mass lies in its own frame, if its design says so."""


@dataclass(frozen=True, slots=True)
class LimbPlace:
    """A limb and its neighbours."""

    name: str
    """As ``LF``."""
    girdle: Girdle
    """Index of the girdle on which it sits [-]."""
    number: int
    """Number of the girdle, from the front [-]."""
    side: float
    """1 left, -1 right [-]."""
    hinges: slice
    """Its hinges among all."""
    servos: slice
    """Its servos among all."""
    driven_hinges: slice | tuple[int, ...]
    """Those of its hinges that a servo turns, of its own ones."""
    contralateral: int
    """The limb on the other side of its girdle."""
    ipsilateral: tuple[int, ...]
    """The limbs on its side of the next girdles ahead and behind."""
    diagonal: tuple[int, ...]
    """The limbs on the other side of the next girdles ahead and behind."""
    tip: int
    """Place of its last link among the bodies."""


@dataclass(frozen=True, slots=True)
class Layout:
    """Names, order and places of what a robot has. Places among servos and hinges are columns of arrays."""

    robot: Robot
    """The robot that it is the layout of."""
    bodies: tuple[LayoutBody, ...]
    """Every moving body; a parent stands before its children."""
    hinges: tuple[str, ...]
    """Every hinge."""
    servos: tuple[str, ...]
    """Every servo."""
    limbs: tuple[LimbPlace, ...]
    """Every limb."""
    servo_hinges: tuple[int, ...]
    """The hinge that each servo turns directly; -1 for a cable."""
    forward_hinges: slice
    """Hinges of the axis from the root forward."""
    backward_hinges: slice
    """Hinges of the axis from the root backward."""
    axial_yaw: tuple[int, ...]
    """Servos that bend the axis sideways directly, from head to tail."""
    axial_pitch: tuple[int, ...]
    """Servos that bend the axis up and down, from head to tail."""
    axial_left: tuple[float, ...]
    """For each of ``axial_yaw`` 1 where a positive angle bends the body to the left (concave there), else -1 [-]."""
    axial_positions: tuple[float, ...]
    """For each of ``axial_yaw`` its place along the body, 0 at the snout, 1 at the tip of the tail [-]."""
    trunk_yaw: tuple[int, ...]
    """Servos that bend the trunk sideways, from the root to the foremost girdle; positive is left."""
    trunk_pitch: tuple[int, ...]
    """Servos that bend the trunk up and down, from the root to the foremost girdle; positive is down."""
    tail_yaw: tuple[int, ...]
    """Servos that bend the tail sideways directly, from the root; positive is right."""
    tail_pitch: tuple[int, ...]
    """Servos that pitch the tail, from the root; positive is down."""
    cables: tuple[int, ...]
    """Servos that pull cables."""
    passive: tuple[int, ...]
    """Hinges that no servo turns directly."""
    trunk: tuple[str, ...]
    """Bodies of the axis from the root forward."""
    tail: tuple[str, ...]
    """Bodies of the axis behind the root."""

    @property
    def limb_names(self) -> tuple[str, ...]:
        """Names of the limbs."""
        return tuple(limb.name for limb in self.limbs)

    def limb(self, name: str) -> LimbPlace:
        """Return a limb by name.

        Raises:
            UnknownName: there is no such limb.
        """
        for limb in self.limbs:
            if limb.name == name:
                return limb
        raise UnknownName("limb", name, self.limb_names)

    def cable_positions(self, servo: int) -> tuple[float, ...]:
        """Return where along the body the hinges are that a servo bends by its cable; see ``axial_positions``."""
        return tuple(_place(self.robot, name) for name in self.cable(servo).hinges)

    def cable(self, servo: int) -> Cable:
        """Return the cable that a servo pulls."""
        return self.robot.cables[servo - len(self.servos) + len(self.robot.cables)]


@lru_cache(maxsize=256)
def layout(robot: Robot) -> Layout:
    """Return the layout of a robot."""
    root = robot.root_index
    forward_bodies = [_ahead_body(robot, i) for i in range(root - 1, -1, -1)]
    backward_bodies = [_behind_body(robot, i) for i in range(root + 1, len(robot.axis))]
    bodies = [LayoutBody(robot.root, -1, (0.0, 0.0, 0.0), 0.0, (), robot.axis[root].inertia)]
    bodies += [_with_parent(body, i) for i, body in enumerate(forward_bodies)]
    tips = []
    for girdle, name, side in _pairs(robot):
        parent = [body.name for body in bodies].index(girdle.segment)
        bodies += _limb_bodies(girdle, name, side, parent, len(bodies), bodies[parent].shift)
        tips.append(len(bodies) - 1)
    bodies += [_with_parent(body, -1 if i == 0 else len(bodies) - 1 + i) for i, body in enumerate(backward_bodies)]
    limb_hinges = [(f"{name}_{hinge.name}", hinge) for girdle, name, _ in _pairs(robot) for hinge in girdle.limb.hinges]
    axis_ahead = [(h.name, h) for body in forward_bodies for h, _, _ in body.hinges]
    axis_behind = [(h.name, h) for body in backward_bodies for h, _, _ in body.hinges]
    all_hinges = [*limb_hinges, *axis_ahead, *axis_behind]
    hinges = tuple(name for name, _ in all_hinges)
    servos = (*(name for name, hinge in all_hinges if hinge.servo is not None), *(cable.name for cable in robot.cables))
    turn = {name: hinge.turn for name, hinge in all_hinges}
    by_head = [name for name, _ in [*reversed(axis_ahead), *axis_behind]]

    def servos_with_turn(names: list[str], kind: str) -> tuple[int, ...]:
        return tuple(servos.index(name) for name in names if name in servos and turn[name] == kind)

    front, back = [name for name, _ in axis_ahead], [name for name, _ in axis_behind]
    yaws = servos_with_turn(by_head, "yaw")
    first_axis_hinge = len(limb_hinges)
    return Layout(
        robot=robot,
        bodies=tuple(bodies),
        hinges=hinges,
        servos=servos,
        limbs=_limbs(robot, hinges, servos, tips),
        servo_hinges=tuple(hinges.index(name) if name in hinges else -1 for name in servos),
        forward_hinges=slice(first_axis_hinge, first_axis_hinge + len(front)),
        backward_hinges=slice(first_axis_hinge + len(front), len(hinges)),
        axial_yaw=yaws,
        axial_pitch=servos_with_turn(by_head, "pitch"),
        axial_left=tuple(1.0 if servos[i] in front else -1.0 for i in yaws),
        axial_positions=tuple(_place(robot, servos[i]) for i in yaws),
        trunk_yaw=tuple(i for i in servos_with_turn(front, "yaw") if bends_trunk(servos[i])),
        trunk_pitch=servos_with_turn(_trunk_hinges(robot, front), "pitch"),
        tail_yaw=servos_with_turn(back, "yaw"),
        tail_pitch=servos_with_turn(back, "pitch"),
        cables=tuple(range(len(servos) - len(robot.cables), len(servos))),
        passive=tuple(i for i, (_, hinge) in enumerate(all_hinges) if hinge.servo is None),
        trunk=tuple(segment.name for segment in reversed(robot.axis[: root + 1])),
        tail=tuple(segment.name for segment in robot.axis[root + 1 :]),
    )


def servo_ranges(robot: Robot) -> np.ndarray:
    """Return the range of each servo, shape (servo, 2) [rad]: infinite for a crank, of the pulley for a cable.

    A pulley that bends N hinges by b together turns by N d sin(b / (2 N)) / r.
    """
    ranges, place = [], layout(robot)
    by_name = {name: hinge for body in place.bodies for hinge, name, _ in body.hinges}
    for i, name in enumerate(place.servos):
        if i in place.cables:
            cable = place.cable(i)
            half = np.float64(cable.bend_limit) / (2 * cable.joints)
            max_angle = float(cable.joints * cable.cord_spacing * np.sin(half) / cable.pulley)
            ranges.append((-max_angle, max_angle))
        else:
            ranges.append(by_name[name].range or (-np.inf, np.inf))
    return np.array(ranges)


def front_segment(robot: Robot) -> str:
    """Return the name of the segment of the front girdle, or of the root of a robot without limbs."""
    return robot.girdles[0].segment if robot.girdles else robot.root


def hips_behind_snout(robot: Robot, girdle: int) -> float:
    """Return the distance from a girdle's hips forward to the tip of the snout with a straight axis [m].

    Args:
        robot: the design.
        girdle: number of the girdle, from the front [-].
    """
    distance = 0.0
    for segment in robot.axis:
        if segment.name == robot.girdles[girdle].segment:
            return distance + segment.front - robot.girdles[girdle].at
        distance += segment.front + segment.rear
    raise UnknownName("segment", robot.girdles[girdle].segment, [segment.name for segment in robot.axis])


def behind_hips(robot: Robot) -> float:
    """Return how much of the straight body lies behind its hindmost hips [m]; 0 without limbs."""
    return robot.length - hips_behind_snout(robot, len(robot.girdles) - 1) if robot.girdles else 0.0


def hips_ahead(robot: Robot, girdle: int) -> float:
    """Return how far a girdle's hips are ahead of those of the hindmost girdle with a straight axis [m].

    Args:
        robot: the design.
        girdle: number of the girdle, from the front [-].
    """
    if girdle == len(robot.girdles) - 1:
        return 0.0
    names, distance = [segment.name for segment in robot.axis], -robot.girdles[-1].at
    for place in range(robot.root_index, names.index(robot.girdles[girdle].segment), -1):
        distance += robot.axis[place].front + robot.axis[place - 1].rear
    return distance + robot.girdles[girdle].at


def _pairs(robot: Robot) -> list[tuple[Girdle, str, float]]:
    return [(girdle, word + girdle.name, side) for girdle in robot.girdles for word, side in (("L", 1.0), ("R", -1.0))]


def _with_parent(body: LayoutBody, parent: int) -> LayoutBody:
    return replace(body, parent=0 if parent == -1 else parent)


def _ahead_body(robot: Robot, i: int) -> LayoutBody:
    """Return the body of segment ``i`` of the axis, which lies ahead of the root; its parent is set later."""
    segment, parent = robot.axis[i], robot.axis[i + 1]
    shift = 0.0 if parent.name == robot.root else parent.rear
    offset = shift + parent.front
    hinges = tuple((hinge, hinge.name, _FORWARD_AXES[hinge.turn]) for hinge in segment.hinges)
    inertia = _framed(segment.inertia, segment.rear, 1.0)
    return LayoutBody(segment.name, -1, (offset, 0.0, 0.0), segment.rear, hinges, inertia)


def _behind_body(robot: Robot, i: int) -> LayoutBody:
    """Return the body of segment ``i`` of the axis, which lies behind the root; its parent is set later."""
    segment, parent = robot.axis[i], robot.axis[i - 1]
    shift = 0.0 if parent.name == robot.root else 0.0 - parent.front
    offset = shift - parent.rear
    hinges = tuple((hinge, hinge.name, _BACKWARD_AXES[hinge.turn]) for hinge in parent.hinges)
    inertia = _framed(segment.inertia, -segment.front, 1.0)
    return LayoutBody(segment.name, -1, (offset, 0.0, 0.0), 0.0 - segment.front, hinges, inertia)


def _framed(inertia: Inertia | None, shift: float, side: float) -> Inertia | None:
    """Return the inertia of a body in the frame at its hinges; on the right side, the mirror image.

    Args:
        inertia: inertia of the left body; None if its design has none.
        shift: shift of the frame against the origin of the segment [m].
        side: 1 left, -1 right [-].
    """
    if inertia is None:
        return None
    (x, y, z), (xy, xz, yz) = inertia.centre, inertia.products
    return replace(inertia, centre=(x + shift, side * y, z), products=(side * xy, xz, side * yz))


def mirrored(axis: Axis, side: float) -> Axis:
    """Return the axis of a turn of a left limb for the limb of a side."""
    return side * axis[0] + 0.0, axis[1], side * axis[2] + 0.0


def _limb_bodies(
    girdle: Girdle, name: str, side: float, parent: int, first_index: int, shift: float
) -> list[LayoutBody]:
    """Return the bodies of one limb from the hip to the foot.

    Args:
        girdle: girdle that carries the limb.
        name: name of the limb.
        side: 1 left, -1 right [-].
        parent: index of the body that carries the girdle.
        first_index: index that the limb's first body will have.
        shift: shift of the parent's frame against the origin of its segment [m].
    """
    bodies, offset = [], (shift + girdle.at, side * girdle.aside, girdle.above)
    for i, link in enumerate(girdle.limb.links):
        hinges = tuple((h, f"{name}_{h.name}", mirrored(LIMB_AXES[h.turn], side)) for h in link.hinges)
        parent_index, inertia = parent if i == 0 else first_index + i - 1, _framed(link.inertia, 0.0, side)
        bodies.append(LayoutBody(f"{name}_{link.name}", parent_index, offset, 0.0, hinges, inertia))
        offset = (link.end[0], side * link.end[1], link.end[2])
    return bodies


def _driven_hinges(limb: Limb) -> slice | tuple[int, ...]:
    """Return which of a limb's hinges servos turn; of all of them a slice, which copies nothing."""
    with_servo = tuple(i for i, hinge in enumerate(limb.hinges) if hinge.servo is not None)
    return slice(None) if len(with_servo) == len(limb.hinges) else with_servo


def _limbs(robot: Robot, hinges: tuple[str, ...], servos: tuple[str, ...], tips: list[int]) -> tuple[LimbPlace, ...]:
    """Return the limbs in order, each with its hinges, servos and neighbours.

    Args:
        robot: the design.
        hinges: names of all hinges.
        servos: names of all servos.
        tips: index of each limb's last body.
    """
    pairs, limbs = _pairs(robot), []
    for i, (girdle, name, side) in enumerate(pairs):
        number, right = divmod(i, 2)
        neighbours = [n for n in (number - 1, number + 1) if 0 <= n < len(robot.girdles)]
        hinge_indices = [hinges.index(f"{name}_{hinge.name}") for hinge in girdle.limb.hinges]
        servo_indices = [
            servos.index(f"{name}_{hinge.name}") for hinge in girdle.limb.hinges if hinge.servo is not None
        ]
        start = servo_indices[0] if servo_indices else 0
        limbs.append(
            LimbPlace(
                name=name,
                girdle=girdle,
                number=number,
                side=side,
                hinges=slice(hinge_indices[0], hinge_indices[-1] + 1),
                servos=slice(start, start + len(servo_indices)),
                driven_hinges=_driven_hinges(girdle.limb),
                contralateral=2 * number + 1 - right,
                ipsilateral=tuple(2 * n + right for n in neighbours),
                diagonal=tuple(2 * n + 1 - right for n in neighbours),
                tip=tips[i],
            )
        )
    return tuple(limbs)


def _trunk_hinges(robot: Robot, forward_hinges: list[str]) -> list[str]:
    """Return the hinges between the root and the foremost girdle; without limbs all hinges ahead of the root."""
    if not robot.girdles:
        return forward_hinges
    names = [segment.name for segment in robot.axis]
    neck_segments = robot.axis[: names.index(robot.girdles[0].segment)]
    neck = {hinge.name for segment in neck_segments for hinge in segment.hinges}
    return [name for name in forward_hinges if name not in neck]


def _place(robot: Robot, hinge: str) -> float:
    """Return the distance of a hinge from the snout over the length of the body [-]."""
    distance = 0.0
    for segment in robot.axis:
        distance += segment.front + segment.rear
        if any(candidate.name == hinge for candidate in segment.hinges):
            return distance / robot.length
    raise UnknownName("hinge", hinge, [h.name for h in robot.axis_hinges])


LegName = Literal["LF", "RF", "LH", "RH"]
LEGS: tuple[LegName, ...] = ("LF", "RF", "LH", "RH")
_SPINE = ("spine_yaw_1", "spine_pitch_1", "spine_yaw_2", "spine_pitch_2", "spine_yaw_3")


def leg_joints() -> tuple[str, ...]:
    """Return the twelve leg joints, ``LF_yaw`` to ``RH_knee``."""
    return tuple(f"{leg}_{joint}" for leg in LEGS for joint in ("yaw", "pitch", "knee"))


def spine_joints() -> tuple[str, ...]:
    """Return the five spine joints of the article from the pelvis forward."""
    return _SPINE


def cable_joints(robot: Robot) -> tuple[str, ...]:
    """Return the driven yaw joints of the tail from root to tip."""
    return robot.tail.driven


def servo_names(robot: Robot | None = None) -> tuple[str, ...]:
    """Return the servos of a robot; without one, those of the article's."""
    if robot is not None:
        return layout(robot).servos
    return (*leg_joints(), *_SPINE, "tail_pitch", "tail_cable")


def joint_names(robot: Robot) -> tuple[str, ...]:
    """Return every hinge of a robot."""
    return layout(robot).hinges
