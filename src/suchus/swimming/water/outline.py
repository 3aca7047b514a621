"""The robot seen from above, limbs folded away: how wide it is along its midline, and how its joints bend that.

Frame: the snout at the origin when the base rests there, x towards the tail, y to the robot's right, so that x is
that of (20); a heading is the direction from head to tail. Arc length s runs from the snout to the tip of the tail.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.core.errors import InvalidDesign
from suchus.robot.design import Robot, layout
from suchus.robot.design.profile import profile
from suchus.robot.motion import lateral_servos

STATIONS = 257
"""Points along the midline, 4 mm apart on a robot of 1 m [-]."""


class BodySilhouette(NamedTuple):
    """The body along its straight midline, the union of its pieces."""

    half_width: Float[np.ndarray, " station"]
    """Half-width, to either side [m]."""
    half_height: Float[np.ndarray, " station"]
    """Up and down [m]."""


def silhouette(robot: Robot, s: Float[np.ndarray, " station"]) -> BodySilhouette:
    """Return how far the straight robot reaches sideways and upwards, limbs left out.

    Args:
        robot: the design.
        s: from the snout [m].
    """
    sections = profile(robot, s)
    return BodySilhouette(sections.half_width, sections.half_height)


class MidlineCurve(NamedTuple):
    """A bent midline and how it moves; every array has the shape (*b, station)."""

    x: Float[np.ndarray, "*b station"]
    """[m]."""
    y: Float[np.ndarray, "*b station"]
    """[m]."""
    heading: Float[np.ndarray, "*b station"]
    """[rad]."""
    x_rate: Float[np.ndarray, "*b station"]
    """[m/s]."""
    y_rate: Float[np.ndarray, "*b station"]
    """[m/s]."""
    heading_rate: Float[np.ndarray, "*b station"]
    """[rad/s]."""


class LateralServo(NamedTuple):
    """What bends the midline at a command: a servo at its hinge, or a cable at several."""

    name: str
    """Name of the servo."""
    joints: tuple[int, ...]
    """Its hinges among ``Outline.joints``, which share its bend evenly."""
    ahead: bool
    """Whether they lie ahead of the root, so that a moment about them is that of what lies toward the snout."""


@dataclass(frozen=True)
class Outline:
    """A robot's midline, from its joints.

    Each joint's bend is smeared over a length, the curvature as a raised cosine: half way to the nearest joint on
    either side where a servo turns one hinge between rigid segments, as far as the nearest joint in a cable section
    and a passive end, which are flexible. Where such joints bend alike the curvature is even.
    """

    robot: Robot
    """Robot whose midline it is."""
    stations: int = STATIONS
    """Points along it [-]."""

    def __post_init__(self) -> None:
        if self.stations < 33:
            raise InvalidDesign(f"outline.stations is {self.stations}; at least 33 are needed to follow the joints.")

    @cached_property
    def s(self) -> Float[np.ndarray, " station"]:
        """Arc length from the snout [m]."""
        return np.linspace(0.0, self.robot.length, self.stations)

    @cached_property
    def silhouette(self) -> BodySilhouette:
        """How wide and high the body is at the stations."""
        return silhouette(self.robot, self.s)

    @cached_property
    def joints(self) -> tuple[str, ...]:
        """The hinges that bend the midline sideways: those ahead of the root from there forward, then those behind."""
        place, lateral = layout(self.robot), {h.name for h in self.robot.axis_hinges if h.turn == "yaw"}
        return tuple(name for name in (*place.hinges[place.ahead], *place.hinges[place.behind]) if name in lateral)

    @cached_property
    def ahead(self) -> int:
        """How many of ``joints`` lie ahead of the root.

        A positive angle turns the front end left there, and the tip right behind the root.
        """
        place = layout(self.robot)
        return sum(name in place.hinges[place.ahead] for name in self.joints)

    @cached_property
    def servos(self) -> tuple[LateralServo, ...]:
        """What bends the midline at a command, in the order of ``motion.lateral_servos``."""
        place, order = layout(self.robot), {name: i for i, name in enumerate(self.joints)}
        hinges = {name: place.cable(place.servos.index(name)).hinges for name in self._cables}
        joints_by_servo = {
            name: tuple(order[joint] for joint in hinges.get(name, (name,))) for name in lateral_servos(self.robot)
        }
        return tuple(LateralServo(name, joints, joints[0] < self.ahead) for name, joints in joints_by_servo.items())

    def at_servos(self, moments: Float[np.ndarray, "*b joint"]) -> Float[np.ndarray, "*b servo"]:
        """Return what moments about ``joints`` ask of ``servos``, each at its own shaft [N m].

        A cable bends its joints alike, so that its servo takes the mean of their moments, over the ratio of half the
        cords' distance to the pulley.
        """
        cables = {cable.name: cable.pulley / (0.5 * cable.cord_spacing) for cable in self.robot.cables}
        columns = [
            moments[..., list(servo.joints)].mean(axis=-1) * cables.get(servo.name, 1.0) for servo in self.servos
        ]
        return np.stack(columns, axis=-1)

    @cached_property
    def passive(self) -> tuple[int, ...]:
        """Those of ``joints`` that no servo moves."""
        driven_joints = {joint for servo in self.servos for joint in servo.joints}
        return tuple(i for i in range(len(self.joints)) if i not in driven_joints)

    @property
    def tail_root(self) -> float:
        """Where the tail begins, at the end of the root's segment, from the snout [m]."""
        return tail_root(self.robot)

    @property
    def _cables(self) -> tuple[str, ...]:
        return tuple(cable.name for cable in self.robot.cables)

    @cached_property
    def places(self) -> Float[np.ndarray, " joint"]:
        """Where the joints are, from the snout [m]."""
        ends = np.cumsum([segment.front + segment.rear for segment in self.robot.axis])
        hinge_positions = {
            h.name: end for segment, end in zip(self.robot.axis, ends, strict=True) for h in segment.hinges
        }
        return np.array([hinge_positions[name] for name in self.joints])

    @cached_property
    def spacings(self) -> Float[np.ndarray, " joint"]:
        """From each joint to the nearest one that is driven in the same way [m].

        That is by a servo of its own, by the same cable, or by nothing; of a single one the distance is that to the
        nearest of all, or to the nearer end of the body.
        """
        cables = {joint: servo.name for servo in self.servos if servo.name in self._cables for joint in servo.joints}
        drive = ["" if i in self.passive else cables.get(i, "servo") for i in range(len(self.joints))]
        distances = np.abs(self.places[:, None] - self.places)
        np.fill_diagonal(distances, np.inf)
        same_drive_distances = np.where(np.array(drive)[:, None] == np.array(drive), distances, np.inf).min(
            axis=1, initial=np.inf
        )
        nearest_distances = np.where(
            np.isfinite(same_drive_distances), same_drive_distances, distances.min(axis=1, initial=np.inf)
        )
        ends = np.minimum(self.places, self.robot.length - self.places)
        return np.asarray(np.where(np.isfinite(nearest_distances), nearest_distances, ends))

    @cached_property
    def reaches(self) -> Float[np.ndarray, " joint"]:
        """Half of the length over which each joint bends the midline [m]."""
        rigid = [servo.joints[0] for servo in self.servos if servo.name not in self._cables]
        share = np.ones(len(self.joints))
        share[rigid] = 0.5
        return np.asarray(share * self.spacings)

    @cached_property
    def bending(self) -> Float[np.ndarray, "middle servo"]:
        """How the heading halfway between stations grows with the bend of each of ``servos`` [-]."""
        return self.bending_at(0.5 * (self.s[1:] + self.s[:-1]))

    def bending_at(self, s: Float[np.ndarray, " point"]) -> Float[np.ndarray, "point servo"]:
        """Return the derivative of the heading at points with respect to the bend of each of ``servos`` [-]."""
        joint_bends = self.joints_at(s)
        shares = [joint_bends[:, list(servo.joints)].mean(axis=1) for servo in self.servos]
        return np.array(shares).reshape(len(self.servos), len(s)).T

    def passive_at(self, s: Float[np.ndarray, " point"]) -> Float[np.ndarray, "point passive"]:
        """Return how the heading at points grows with the bend of each passive joint [-]."""
        return self.joints_at(s)[:, list(self.passive)]

    def joints_at(self, s: Float[np.ndarray, " point"]) -> Float[np.ndarray, "point joint"]:
        """Return the derivative of the heading at points with respect to each joint, in the order of ``joints`` [-].

        A joint's bend is distributed over some length; its part ahead of the point counts. The sign is negative for
        joints ahead of the root, because they turn the front end to the left.
        """
        reach_fraction = np.clip((s[:, None] - self.places) / self.reaches, -1.0, 1.0)
        shares = np.asarray(0.5 * (1.0 + reach_fraction + np.sin(np.pi * reach_fraction) / np.pi))
        shares[:, : self.ahead] *= -1.0
        return shares


def tail_root(robot: Robot) -> float:
    """Return where the tail of a straight robot begins, at the end of its root's segment, from the snout [m]."""
    return sum(segment.front + segment.rear for segment in robot.axis[: robot.root_place + 1])


def summed(
    start_value: Float[np.ndarray, "*b"], steps: Float[np.ndarray, "*b step"]
) -> Float[np.ndarray, "*b station"]:
    """Return the positions to which steps lead from a start."""
    start = np.asarray(start_value)[..., None]
    return np.concatenate([start, start + np.cumsum(steps, axis=-1)], axis=-1)
