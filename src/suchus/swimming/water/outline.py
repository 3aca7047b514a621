"""Outline of the robot from above, without limbs: its width along the midline, and the bend by its joints.

The snout is at the origin when the base rests there, x points towards the tail, y to the robot's right: x is that of
(20). A heading is the direction from head to tail. Arc length s runs from the snout to the tip of the tail.
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
    """Return half width and half height of the straight robot along its midline, without limbs.

    Args:
        robot: the design.
        s: from the snout [m].
    """
    sections = profile(robot, s)
    return BodySilhouette(sections.half_width, sections.half_height)


class MidlineCurve(NamedTuple):
    """A bent midline and its velocity; every array has the shape (*b, station)."""

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
    """A servo that bends the midline: at its hinge, or by a cable at several hinges."""

    name: str
    """Name of the servo."""
    joints: tuple[int, ...]
    """Its hinges among ``Outline.joints``, which share its bend evenly."""
    is_ahead_of_root: bool
    """Whether they lie ahead of the root, so that a moment about them is that of what lies toward the snout."""


@dataclass(frozen=True)
class Outline:
    """A robot's midline over its joints.

    The bend of each joint is distributed over a length, with a raised cosine as curvature. A joint between rigid
    segments reaches half way to the nearest joint on either side. A joint in a cable section or a passive end, which
    are flexible, reaches to the nearest joint. The curvature is constant where such joints bend equally.
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
        """Half width and half height of the body at the stations."""
        return silhouette(self.robot, self.s)

    @cached_property
    def joints(self) -> tuple[str, ...]:
        """The hinges that bend the midline sideways: those ahead of the root from there forward, then those behind."""
        place, lateral = layout(self.robot), {h.name for h in self.robot.axis_hinges if h.turn == "yaw"}
        return tuple(
            name
            for name in (*place.hinges[place.forward_hinges], *place.hinges[place.backward_hinges])
            if name in lateral
        )

    @cached_property
    def joint_count_ahead(self) -> int:
        """Number of ``joints`` ahead of the root.

        A positive angle of such a joint turns the front end left; behind the root it turns the tip right.
        """
        place = layout(self.robot)
        return sum(name in place.hinges[place.forward_hinges] for name in self.joints)

    @cached_property
    def servos(self) -> tuple[LateralServo, ...]:
        """The servos that bend the midline, in the order of ``motion.lateral_servos``."""
        place, order = layout(self.robot), {name: i for i, name in enumerate(self.joints)}
        hinges = {name: place.cable(place.servos.index(name)).hinges for name in self._cables}
        joints_by_servo = {
            name: tuple(order[joint] for joint in hinges.get(name, (name,))) for name in lateral_servos(self.robot)
        }
        return tuple(
            LateralServo(name, joints, joints[0] < self.joint_count_ahead) for name, joints in joints_by_servo.items()
        )

    def servo_torques(self, moments: Float[np.ndarray, "*b joint"]) -> Float[np.ndarray, "*b servo"]:
        """Return the torques of ``servos`` for moments about ``joints``, each at its own shaft [N m].

        A cable bends its joints equally. Its servo carries the mean of their moments, over the ratio of half the
        distance of the cords to the pulley radius.
        """
        cables = {cable.name: cable.pulley / (0.5 * cable.cord_spacing) for cable in self.robot.cables}
        columns = [
            moments[..., list(servo.joints)].mean(axis=-1) * cables.get(servo.name, 1.0) for servo in self.servos
        ]
        return np.stack(columns, axis=-1)

    @cached_property
    def passive(self) -> tuple[int, ...]:
        """Indices of ``joints`` without a servo."""
        driven_joints = {joint for servo in self.servos for joint in servo.joints}
        return tuple(i for i in range(len(self.joints)) if i not in driven_joints)

    @property
    def tail_root(self) -> float:
        """Position at which the tail begins, at the end of the root's segment, from the snout [m]."""
        return tail_root(self.robot)

    @property
    def _cables(self) -> tuple[str, ...]:
        return tuple(cable.name for cable in self.robot.cables)

    @cached_property
    def joint_positions(self) -> Float[np.ndarray, " joint"]:
        """Positions of the joints, from the snout [m]."""
        ends = np.cumsum([segment.front + segment.rear for segment in self.robot.axis])
        hinge_positions = {
            h.name: end for segment, end in zip(self.robot.axis, ends, strict=True) for h in segment.hinges
        }
        return np.array([hinge_positions[name] for name in self.joints])

    @cached_property
    def spacings(self) -> Float[np.ndarray, " joint"]:
        """Distance from each joint to the nearest one with the same kind of drive [m].

        Kinds are a servo of its own, the same cable, or none. For a single joint the distance is that to the nearest
        joint of any kind, or to the nearer end of the body.
        """
        cables = {joint: servo.name for servo in self.servos if servo.name in self._cables for joint in servo.joints}
        drive = ["" if i in self.passive else cables.get(i, "servo") for i in range(len(self.joints))]
        distances = np.abs(self.joint_positions[:, None] - self.joint_positions)
        np.fill_diagonal(distances, np.inf)
        same_drive_distances = np.where(np.array(drive)[:, None] == np.array(drive), distances, np.inf).min(
            axis=1, initial=np.inf
        )
        nearest_distances = np.where(
            np.isfinite(same_drive_distances), same_drive_distances, distances.min(axis=1, initial=np.inf)
        )
        ends = np.minimum(self.joint_positions, self.robot.length - self.joint_positions)
        return np.asarray(np.where(np.isfinite(nearest_distances), nearest_distances, ends))

    @cached_property
    def reaches(self) -> Float[np.ndarray, " joint"]:
        """Half of the length over which the bend of each joint is distributed [m]."""
        rigid = [servo.joints[0] for servo in self.servos if servo.name not in self._cables]
        share = np.ones(len(self.joints))
        share[rigid] = 0.5
        return np.asarray(share * self.spacings)

    def bending_at(self, s: Float[np.ndarray, " point"]) -> Float[np.ndarray, "point servo"]:
        """Return the derivative of the heading at points with respect to the bend of each of ``servos`` [-]."""
        joint_bends = self.joints_at(s)
        shares = [joint_bends[:, list(servo.joints)].mean(axis=1) for servo in self.servos]
        return np.array(shares).reshape(len(self.servos), len(s)).T

    def passive_at(self, s: Float[np.ndarray, " point"]) -> Float[np.ndarray, "point passive"]:
        """Return the derivative of the heading at points with respect to each passive joint [-]."""
        return self.joints_at(s)[:, list(self.passive)]

    def joints_at(self, s: Float[np.ndarray, " point"]) -> Float[np.ndarray, "point joint"]:
        """Return the derivative of the heading at points with respect to each joint, in the order of ``joints`` [-].

        A joint's bend is distributed over some length; its part ahead of the point counts. The sign is negative for
        joints ahead of the root, because they turn the front end to the left.
        """
        reach_fraction = np.clip((s[:, None] - self.joint_positions) / self.reaches, -1.0, 1.0)
        shares = np.asarray(0.5 * (1.0 + reach_fraction + np.sin(np.pi * reach_fraction) / np.pi))
        shares[:, : self.joint_count_ahead] *= -1.0
        return shares


def tail_root(robot: Robot) -> float:
    """Return where the tail of a straight robot begins, at the end of its root's segment, from the snout [m]."""
    return sum(segment.front + segment.rear for segment in robot.axis[: robot.root_index + 1])


def cumulative_positions(
    start_value: Float[np.ndarray, "*b"], steps: Float[np.ndarray, "*b step"]
) -> Float[np.ndarray, "*b station"]:
    """Return the positions to which steps lead from a start."""
    start = np.asarray(start_value)[..., None]
    return np.concatenate([start, start + np.cumsum(steps, axis=-1)], axis=-1)
