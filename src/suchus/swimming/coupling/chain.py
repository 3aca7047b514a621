"""The midline of a robot over its joints: position, velocity, and generalised forces of the water.

Coordinates are those of the root in its plane and the lateral joints (``land.stepper``). The flow sees the robot from
above. Its head is at the origin, its tail towards +x, and y points to the robot's right: the frame is the world turned
by half a turn.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import ClassVar, NamedTuple

import numpy as np
from jaxtyping import Float

from suchus import flow
from suchus.flow.twist import Twists
from suchus.robot.design.profile import stations
from suchus.swimming.water.outline import Outline

RECENT = 8
"""Postures whose midlines are remembered [-]."""


class ChainState(NamedTuple):
    """Coordinates and rates of a chain in the frame of the flow."""

    position: Float[np.ndarray, " coordinate"]
    """Root (x, y, angle) and joints [m, rad]."""
    rate: Float[np.ndarray, " coordinate"]
    """Their rates [m/s, rad/s]."""


BodyState = tuple[flow.MidlineState, flow.Pose]
"""A midline about its centre, and where that is."""


class Points(NamedTuple):
    """The midline at some arc lengths; ``jacobian`` its derivatives by the coordinates."""

    position: Float[np.ndarray, "2 point"]
    """Where they are [m]."""
    heading: Float[np.ndarray, " point"]
    """Direction from head to tail [rad]."""
    jacobian: Float[np.ndarray, "2 point coordinate"]
    """Derivative of the places [-, m]."""
    turning: Float[np.ndarray, "point coordinate"]
    """Derivative of the headings [1/m, -]."""


@dataclass(frozen=True)
class MidlineChain:
    """A robot's midline over its joints, divided into parts that contain no joint."""

    outline: Outline
    """The robot and its stations."""
    parts: int
    """Parts, at least [-]."""
    start: tuple[float, float] = (0.0, 0.0)
    """Place of the root in the world at the beginning [m]."""
    axis_count: ClassVar[int] = 2
    """Axes in which it moves [-]."""

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the joints that bend it."""
        return self.outline.joints

    @property
    def size(self) -> int:
        """Coordinates [-]."""
        return 3 + len(self.joints)

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the coordinates."""
        return "root_x", "root_y", "root_yaw", *self.joints

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the links."""
        return tuple(f"link_{k + 1}" for k in range(int(self.links.max()) + 1))

    @cached_property
    def _signs(self) -> np.ndarray:
        """Signs that convert coordinates of the robot to those of the chain and back."""
        return np.array([-1.0, -1.0] + (self.size - 2) * [1.0])

    def flow_state(self, place: np.ndarray, rate: np.ndarray) -> ChainState:
        """Return a state of the robot in the frame of the flow."""
        flow_place, moving = self._signs * place, self._signs * rate
        flow_place[:2] += np.array([self.root + self.start[0], self.start[1]])
        return ChainState(flow_place, moving)

    def of_robot(self, values: np.ndarray) -> np.ndarray:
        """Return a generalised force or an added mass of the robot's coordinates; their signs are not the flow's."""
        return self._signs * values if values.ndim == 1 else self._signs[:, None] * values * self._signs

    def start_path(self, time: float, posture: ChainState) -> "ChainPath":
        """Return a path that begins at a posture."""
        return ChainPath(time, posture)

    def rotation_between(self, place: np.ndarray, other_place: np.ndarray) -> float:
        """Return the greatest angle between root and joints of two postures [rad]."""
        return float(np.abs(place[2:] - other_place[2:]).max())

    @cached_property
    def root(self) -> float:
        """Position of the root's origin, from the snout [m]."""
        robot = self.outline.robot
        number = [segment.name for segment in robot.axis].index(robot.root)
        return stations(robot)[number][0] + robot.axis[number].front

    @cached_property
    def ends(self) -> Float[np.ndarray, " end"]:
        """Arc lengths of the ends of the parts, from snout to tip [m]."""
        places, length = np.sort(self.outline.joint_positions), self.outline.robot.length
        coarse, part_length = [0.0, *places.tolist(), length], length / self.parts
        fine = [np.linspace(a, b, max(int((b - a) / part_length), 1), endpoint=False) for a, b in pairwise(coarse)]
        return np.array([*np.concatenate(fine), length])

    @property
    def cuts(self) -> tuple[float, ...]:
        """Arc lengths at which the body is divided [m]."""
        return tuple(self.ends[1:-1].tolist())

    @cached_property
    def links(self) -> Float[np.ndarray, " part"]:
        """Index of the link that each part belongs to, from the head on [-]."""
        middle = 0.5 * (self.ends[1:] + self.ends[:-1])
        return np.searchsorted(np.sort(self.outline.joint_positions), middle)

    @cached_property
    def _shares(self) -> tuple[np.ndarray, np.ndarray]:
        """Factors of the joint angles in the heading, between stations and at stations [-]."""
        s, at_root = self.outline.s, self.outline.joints_at(np.array([self.root]))
        return self.outline.joints_at(0.5 * (s[1:] + s[:-1])) - at_root, self.outline.joints_at(s) - at_root

    def midline(self, place: np.ndarray) -> Points:
        """Return the stations in a posture; positions and derivatives are sums of tangents from the root."""
        (middle, station), joints = self._shares, place[3:]
        tangent, normal = self._tangents(place[2] + middle @ joints)
        jacobian = np.zeros((2, self.outline.stations, self.size))
        jacobian[0, :, 0] = jacobian[1, :, 1] = 1.0
        turns = np.column_stack([np.ones(len(middle)), middle])
        jacobian[:, :, 2:] = self._from_root(np.einsum("cs,sk->cks", normal, turns)).transpose(0, 2, 1)
        turning = np.zeros((self.outline.stations, self.size))
        turning[:, 2], turning[:, 3:] = 1.0, station
        positions = self._from_root(tangent) + place[:2, None]
        return Points(positions, place[2] + station @ joints, jacobian, turning)

    def _tangents(self, heading: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the vectors from station to station for headings between them, and their normals [m]."""
        tangent = self.outline.robot.length / (self.outline.stations - 1) * np.stack([np.cos(heading), np.sin(heading)])
        return tangent, np.stack([-tangent[1], tangent[0]])

    def _from_root(self, steps: np.ndarray) -> np.ndarray:
        """Return the positions to which steps along the last axis lead, from the root on."""
        summed = np.zeros((*steps.shape[:-1], steps.shape[-1] + 1))
        np.cumsum(steps, axis=-1, out=summed[..., 1:])
        s = self.outline.s
        k = min(max(int(np.searchsorted(s, self.root)) - 1, 0), s.size - 2)
        share = (self.root - s[k]) / (s[k + 1] - s[k])
        return summed - ((1 - share) * summed[..., k] + share * summed[..., k + 1])[..., None]

    @cached_property
    def _means(self) -> Float[np.ndarray, "part station"]:
        """Weights of the stations in the mean over each part; values are linear between stations [-]."""
        s = self.outline.s
        weights = np.zeros((len(self.ends) - 1, s.size))
        for part_index, (a, b) in enumerate(pairwise(self.ends)):
            nodes = np.array([a, *s[(s > a) & (s < b)], b])
            size = 0.5 * np.diff(nodes) / (b - a)
            shares = np.array([np.interp(nodes, s, unit) for unit in np.eye(s.size)])
            weights[part_index] = shares[:, :-1] @ size + shares[:, 1:] @ size
        return weights

    def centres(self, place: np.ndarray) -> Points:
        """Return the centres of the parts in a posture, from a cache of recent postures.

        A centre is the mean over a part that bends. A force that is distributed along the part does its work at the
        mean velocity.
        """
        cache, key = self._recent_centres, place.tobytes()
        if key not in cache:
            if len(cache) == RECENT:
                del cache[next(iter(cache))]
            line, mean = self.midline(place), self._means
            cache[key] = Points(line.position @ mean.T, mean @ line.heading, mean @ line.jacobian, mean @ line.turning)
        return cache[key]

    @cached_property
    def _recent_centres(self) -> dict[bytes, Points]:
        return {}

    @cached_property
    def _weights(self) -> np.ndarray:
        """Fraction of the body's volume at each station; it gives the centre that the grid follows [-]."""
        half_width, half_height = self.outline.silhouette
        return np.asarray(half_width * half_height / (half_width * half_height).sum())

    def state(self, posture: ChainState, min_half_width: float) -> BodyState:
        """Return the midline about its centre, and the pose of the centre, in the frame of the flow.

        Args:
            posture: posture of the chain.
            min_half_width: half-width below which the body is thickened [m].
        """
        middle, station = self._shares
        (place, rate), station_angles = posture, station @ np.stack([posture.position[3:], posture.rate[3:]], axis=1)
        tangent, normal = self._tangents(place[2] + middle @ place[3:])
        swept = self._from_root(np.concatenate([tangent, normal * (rate[2] + middle @ rate[3:])]))
        heading, turn = place[2] + station_angles[:, 0], rate[2] + station_angles[:, 1]
        line = swept + np.concatenate([place[:2], rate[:2]])[:, None]
        centre = line @ self._weights
        x, y, u, v = line - centre[:, None]
        line_state = flow.MidlineState(
            x=x, y=y, heading=heading, half_width=self.outline.silhouette.half_width, x_rate=u, y_rate=v,
            heading_rate=turn,
        )  # fmt: skip
        pose = flow.Pose(position=(centre[0], centre[1]), velocity=(centre[2], centre[3]))
        return (line_state.thickened(min_half_width) if min_half_width > 0.0 else line_state), pose

    def force(self, place: np.ndarray, loads: flow.FlowLoads, origin: np.ndarray) -> Float[np.ndarray, " coordinate"]:
        """Return the generalised force of the loads on the parts [N, N m; in the plane per metre of depth].

        Args:
            place: posture; with that in the middle of the step, force times velocity is the power to second order.
            loads: loads on the parts; torques about ``loads.reference_point``.
            origin: origin of the grid's frame in the world of the flow [m].
        """
        points = self.centres(place)
        pull, turn = loads.parts.force[:, :2], loads.parts.torque
        offset = points.position.T - origin - loads.reference_point[:2]
        torque = turn - (offset[:, 0] * pull[:, 1] - offset[:, 1] * pull[:, 0])
        generalised_force = np.einsum("cpk,pc->k", points.jacobian, pull) + torque @ points.turning
        return generalised_force + self.unpressed(place, loads.internal_pressure, origin + loads.reference_point[:2])

    @cached_property
    def _bends(self) -> np.ndarray:
        """Bend of each part per angle of each joint, over the length of the part, shape (part, joint) [1/m]."""
        return np.diff(self.outline.joints_at(self.ends), axis=0) / np.diff(self.ends)[:, None]

    def unpressed(self, place: np.ndarray, pressed: np.ndarray, reference_point: np.ndarray) -> np.ndarray:
        """Return the generalised force that cancels the moments between the parts.

        A real body has no pressure inside, but the body of the flow has. Across a section this pressure is a moment. It
        does work on rigid pieces that turn against each other, and it has no effect on the water.

        Args:
            place: posture.
            pressed: of the parts, shape (..., part, 1 + axis); see ``flow.FlowLoads``.
            reference_point: point of its moments, in the world of the flow [m].

        Returns:
            Shape (..., coordinate) [N m; in the plane per metre of depth].
        """
        points = self.centres(place)
        offset, normals = (
            points.position.T - reference_point,
            np.stack([-np.sin(points.heading), np.cos(points.heading)], axis=1),
        )
        moment = ((pressed[..., 1:3] - pressed[..., :1] * offset) * normals).sum(axis=-1)
        return np.concatenate([np.zeros((*moment.shape[:-1], 3)), moment @ self._bends], axis=-1)

    def link_loads(self, place: np.ndarray, loads: flow.FlowLoads, origin: np.ndarray) -> Float[np.ndarray, "link 4"]:
        """Return the load on each link in the world: force, and torque about the vertical through its middle."""
        points = self.centres(place).position.T - origin
        pull, turn = loads.parts.force[:, :2], loads.parts.torque
        link_loads = np.zeros((len(self.names), 4))
        for link in range(len(link_loads)):
            is_of_link = self.links == link
            middle = points[is_of_link].mean(axis=0) - loads.reference_point[:2]
            total = pull[is_of_link].sum(axis=0)
            link_loads[link, :2] = -total[0], -total[1]
            link_loads[link, 3] = turn[is_of_link].sum() - (middle[0] * total[1] - middle[1] * total[0])
        return link_loads

    def twists(self, place: np.ndarray, rate: np.ndarray, origin: np.ndarray, axes: int) -> Twists:
        """Return the motion of the parts as rigid pieces.

        Args:
            place: posture.
            rate: rate of the coordinates [m/s, rad/s].
            origin: origin of the grid's frame in the world of the flow [m].
            axes: number of axes of the flow [-].
        """
        points = self.centres(place)
        reference_points, linear = points.position.T - origin, (points.jacobian @ rate).T
        turn = (points.turning @ rate)[:, None]
        if axes == 3:
            reference_points, linear = (
                np.column_stack([vectors, np.zeros(len(vectors))]) for vectors in (reference_points, linear)
            )
            turn = np.column_stack([np.zeros((len(turn), 2)), turn])
        return Twists(reference_points=reference_points, linear=linear, angular=turn)

    def modes(self, place: np.ndarray, origin: np.ndarray, axes: int) -> list[Twists]:
        """Return the motions of the parts at a unit rate of each coordinate; see ``twists``."""
        return [self.twists(place, unit, origin, axes) for unit in np.eye(self.size)]

    def body(
        self, path: "ChainPath", axes: int, min_half_width: float, half_height: np.ndarray
    ) -> flow.Midline | flow.Trunk:
        """Return the robot as a body of the flow that moves along a path."""

        def spine(time: float) -> flow.MidlineState:
            return path.evaluate(time, lambda posture: self.state(posture, min_half_width))[0]

        if axes == 2:
            return flow.Midline(spine=spine, cuts=self.cuts)
        return flow.Trunk(spine=spine, half_height=half_height, cuts=self.cuts)

    def motion(self, path: "ChainPath", axes: int, min_half_width: float) -> Callable[[float], flow.Pose]:
        """Return the function that gives the pose of the body's centre at a time [s]."""
        return lambda time: path.evaluate(time, lambda posture: self.state(posture, min_half_width))[1].in_dimensions(
            axes
        )


class ChainPath:
    """The path of a chain through one step: the cubic with the positions and rates at both ends."""

    def __init__(self, time: float, posture: ChainState) -> None:
        self._start, self._end, self._times = posture, posture, (time, time)
        self._states_by_time: dict[float, BodyState] = {}

    def evaluate(self, time: float, state: Callable[[ChainState], BodyState]) -> BodyState:
        """Return a function of the posture at a time [s], from a cache; all calls must use the same function."""
        if time not in self._states_by_time:
            self._states_by_time[time] = state(self.posture_at(time))
        return self._states_by_time[time]

    def go(self, time: float, posture: ChainState, end: float, then: ChainState) -> None:
        """Set the path from a posture at a time to a posture at another time [s]."""
        self._times, self._start, self._end = (time, end), posture, then
        self._states_by_time.clear()

    def posture_at(self, time: float) -> ChainState:
        """Return the posture at a time [s], extrapolated at constant rates beyond the ends."""
        (start_time, end_time), (p, v), (q, w) = self._times, self._start, self._end
        if time <= start_time or end_time == start_time:
            return ChainState(p + (time - start_time) * v, v)
        if time >= end_time:
            return ChainState(q + (time - end_time) * w, w)
        h = end_time - start_time
        t = (time - start_time) / h
        place = (1 + 2 * t) * (1 - t) ** 2 * p + h * t * (1 - t) ** 2 * v
        place = place + t * t * (3 - 2 * t) * q + h * t * t * (t - 1) * w
        rate = 6 * t * (1 - t) * (q - p) / h + (1 - t) * (1 - 3 * t) * v + t * (3 * t - 2) * w
        return ChainState(place, rate)
