"""The robot seen from above, limbs folded away: how wide it is along its midline, and how its joints bend that.

Frame: the snout at the origin when the base rests there, x towards the tail, y to the robot's right, so that x is
that of (20); a heading is the direction from head to tail. Arc length s runs from the snout to the tip of the tail.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.design import ARTICLE_BODY, Robot, cable_joints, check_needs
from suchus.design.profile import profile
from suchus.errors import InvalidDesign
from suchus.motion import Bends

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
    found = profile(check_needs(robot, ARTICLE_BODY, "the outline in the water"), s)
    return BodySilhouette(found.half_width, found.half_height)


class Base(NamedTuple):
    """Position of the snout and direction of the head."""

    x: Float[np.ndarray, "*b"]
    """[m]."""
    y: Float[np.ndarray, "*b"]
    """[m]."""
    heading: Float[np.ndarray, "*b"]
    """Direction from snout to neck [rad]."""
    x_rate: Float[np.ndarray, "*b"]
    """[m/s]."""
    y_rate: Float[np.ndarray, "*b"]
    """[m/s]."""
    heading_rate: Float[np.ndarray, "*b"]
    """[rad/s]."""


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


@dataclass(frozen=True)
class Outline:
    """The robot's midline, from its joints.

    Each joint's bend is smeared over its flexible length, the curvature as a raised cosine: to the next yaw joint's
    half way on either side in the trunk, to the next joint in tail and passive end. Where joints bend alike the
    curvature is even.
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
    def places(self) -> Float[np.ndarray, " joint"]:
        """Where the lateral joints are: three of the trunk from the pelvis forward, cable joints, passive ones [m]."""
        robot, tail = self.robot, self.robot.tail
        trunk = robot.head.snout + robot.spine.link * np.array([4.0, 2.0, 0.0])
        first = robot.head.snout + robot.spine.length + tail.offset + tail.root + tail.pitch / 2
        cable = first + tail.pitch * np.arange(len(cable_joints(robot)))
        fin = robot.length - tail.fin_length * (1.0 - np.arange(tail.fin_segments) / tail.fin_segments)
        return np.concatenate([trunk, cable, fin])

    @cached_property
    def reaches(self) -> Float[np.ndarray, " joint"]:
        """Half of the length over which each joint bends the midline [m]."""
        robot, tail = self.robot, self.robot.tail
        count = len(cable_joints(robot))
        fin = tail.fin_length / tail.fin_segments
        return np.array([*3 * [robot.spine.link], *count * [tail.pitch], *tail.fin_segments * [fin]])

    @cached_property
    def bending(self) -> Float[np.ndarray, "middle 4"]:
        """How the heading halfway between stations grows with the three yaw angles and the tail's bend [-]."""
        middle = 0.5 * (self.s[1:] + self.s[:-1])
        return self.bending_at(middle)

    def bending_at(self, s: Float[np.ndarray, " point"]) -> Float[np.ndarray, "point 4"]:
        """Return how the heading at points grows with the three yaw angles and the tail's bend [-].

        A trunk joint that turns the front end left turns what lies behind it right, seen from the front.
        """
        each, cables = self.joints_at(s), len(cable_joints(self.robot))
        return np.column_stack([each[:, :3], each[:, 3 : 3 + cables].mean(axis=1)])

    def passive_at(self, s: Float[np.ndarray, " point"]) -> Float[np.ndarray, "point fin"]:
        """Return how the heading at points grows with the bend of each passive joint, tip to the right [-]."""
        return self.joints_at(s)[:, 3 + len(cable_joints(self.robot)) :]

    def joints_at(self, s: Float[np.ndarray, " point"]) -> Float[np.ndarray, "point joint"]:
        """Return how the heading at points grows with the angle of each joint, in the order of ``places`` [-].

        It is the share of the joint's bend that lies ahead of the point; that of a trunk joint, which turns the front
        end left, counts to the right behind it.
        """
        along = np.clip((s[:, None] - self.places) / self.reaches, -1.0, 1.0)
        shares = np.asarray(0.5 * (1.0 + along + np.sin(np.pi * along) / np.pi))
        shares[:, :3] *= -1.0
        return shares

    def curve(self, bends: Bends, base: Base | None = None) -> MidlineCurve:
        """Return the midline, its stations equally far apart along it whatever the bends.

        Args:
            bends: lateral angles and their rates; the passive end is held straight.
            base: the snout; at rest at the origin, the head along x, if None.
        """
        angles = np.concatenate([bends.yaw, np.asarray(bends.tail)[..., None]], axis=-1)
        rates = np.concatenate([bends.yaw_rate, np.asarray(bends.tail_rate)[..., None]], axis=-1)
        if base is None:
            base = Base(*(np.zeros(angles.shape[:-1]) for _ in Base._fields))
        middle = angles @ self.bending.T + base.heading[..., None]
        spin = rates @ self.bending.T + base.heading_rate[..., None]
        step = self.robot.length / (self.stations - 1)
        at_stations = self.bending_at(self.s)
        return MidlineCurve(
            summed(base.x, step * np.cos(middle)),
            summed(base.y, step * np.sin(middle)),
            angles @ at_stations.T + base.heading[..., None],
            summed(base.x_rate, -step * np.sin(middle) * spin),
            summed(base.y_rate, step * np.cos(middle) * spin),
            rates @ at_stations.T + base.heading_rate[..., None],
        )


def summed(first: Float[np.ndarray, "*b"], steps: Float[np.ndarray, "*b step"]) -> Float[np.ndarray, "*b station"]:
    """Return where steps lead from a start."""
    start = np.asarray(first)[..., None]
    return np.concatenate([start, start + np.cumsum(steps, axis=-1)], axis=-1)
