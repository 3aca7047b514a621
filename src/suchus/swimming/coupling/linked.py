"""A robot as links, each with its own pose: limbs can paddle, and bodies can leave the plane.

Coordinates are all of the robot's own (``land.stepper``): six rates of the root, then every hinge. The flow sees the
robot turned by half a turn: its head is at the origin, its tail towards +x.
"""

from collections.abc import Callable
from functools import cached_property

import numpy as np
from jaxtyping import Float

from suchus import flow
from suchus.core import rotation
from suchus.flow.linked import extrapolate_links, interpolate_links
from suchus.flow.twist import Twists
from suchus.robot.design import Robot
from suchus.robot.design.profile import stations
from suchus.sim.land.links import LinkShape, RobotLinks
from suchus.swimming.coupling.chain import RECENT, ChainPath, ChainState

_HALF_TURN = np.diag([-1.0, -1.0, 1.0])
_ROD_TURN = np.array([np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0])  # turns x to where the rod's z was, up to a sign


class LinkChain:
    """The links of a robot over all of its coordinates, with the methods of ``chain.MidlineChain``.

    Args:
        robot: which.
        links: links of its model.
        start: place of the root at the beginning [m].
    """

    axis_count = 3
    """Axes in which it moves [-]."""

    def __init__(self, robot: Robot, links: RobotLinks, start: Float[np.ndarray, "3"]) -> None:
        """Take the links of a robot that begins at a position."""
        self.joints, self.names, self._links = links.joints, links.names, links
        number = [segment.name for segment in robot.axis].index(robot.root)
        root_offset = stations(robot)[number][0] + robot.axis[number].front
        self._corner = np.array([root_offset, 0.0, 0.0]) - _HALF_TURN @ start
        self.pieces = tuple(_piece(shape) for shape in links.shapes)
        volume = np.zeros(len(self.names))
        for piece in self.pieces:
            volume[piece.link] += piece.shape.volume(0.0)
        self._weights = volume / volume.sum()
        self._recent: dict[bytes, tuple[flow.LinkStates, np.ndarray]] = {}

    @property
    def size(self) -> int:
        """Coordinates [-]."""
        return 6 + len(self.joints)

    @cached_property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the coordinates."""
        return "root_x", "root_y", "root_z", "root_roll", "root_pitch", "root_yaw", *self.joints

    def flow_state(self, place: np.ndarray, rate: np.ndarray) -> ChainState:
        """Return a state of the robot; its coordinates are those of the chain."""
        return ChainState(place, rate)

    def of_robot(self, values: np.ndarray) -> np.ndarray:
        """Return a generalised force or an added mass in the robot's coordinates, which are those of the chain."""
        return values

    def _jacobian(self, place: np.ndarray) -> np.ndarray:
        """Return the Jacobian of the links in a posture, in the frame of the flow, from a cache of recent postures."""
        unit = place.copy()
        unit[3:7] /= np.linalg.norm(unit[3:7])
        key = unit.tobytes()
        if key not in self._recent:
            if len(self._recent) == RECENT:
                del self._recent[next(iter(self._recent))]
            rest_state = self._links.motion(unit, np.zeros(self.size))
            jacobian = self._links.jacobian(unit)
            flow_jacobian = np.concatenate([_HALF_TURN @ jacobian[:, :3], _HALF_TURN @ jacobian[:, 3:]], axis=1)
            positions = rest_state.position @ _HALF_TURN + self._corner
            zeros = np.zeros_like(positions)
            self._recent[key] = flow.LinkStates(positions, _HALF_TURN @ rest_state.matrix, zeros, zeros), flow_jacobian
        return self._recent[key][1]

    def states(self, posture: ChainState) -> flow.LinkStates:
        """Return the links in the frame of the flow."""
        jacobian = self._jacobian(posture.position)
        unit = posture.position.copy()
        unit[3:7] /= np.linalg.norm(unit[3:7])
        rate = jacobian @ posture.rate
        return self._recent[unit.tobytes()][0]._replace(velocity=rate[:, :3], spin=rate[:, 3:])

    def start_path(self, time: float, posture: ChainState) -> "LinkPath":
        """Return a path that begins at a posture."""
        return LinkPath(self, time, posture)

    def rotation_between(self, place: np.ndarray, other_place: np.ndarray) -> float:
        """Return the greatest angle between root and joints of two postures [rad]."""
        root = 2.0 * np.arccos(np.clip(abs(place[3:7] @ other_place[3:7]), 0.0, 1.0))
        return float(max(root, np.abs(place[7:] - other_place[7:]).max(initial=0.0)))

    def force(self, place: np.ndarray, loads: flow.FlowLoads, origin: np.ndarray) -> Float[np.ndarray, " coordinate"]:
        """Return the generalised force of the loads on the links [N, N m].

        Args:
            place: posture; with that in the middle of the step, force times velocity is the power to second order.
            loads: loads on the links; torques about ``loads.reference_point``.
            origin: origin of the grid's frame in the world of the flow [m].
        """
        jacobian = self._jacobian(place)
        force, torque = self._wrenches(place, loads, origin)
        return np.asarray(np.einsum("lck,lc->k", jacobian, np.concatenate([force, torque], axis=1)))

    def _wrenches(
        self, place: np.ndarray, loads: flow.FlowLoads, origin: np.ndarray
    ) -> tuple[Float[np.ndarray, "link 3"], Float[np.ndarray, "link 3"]]:
        """Return forces on the links and torques about their origins, in the frame of the flow."""
        link_origins = self.states(ChainState(place, np.zeros(self.size))).position - origin - loads.reference_point
        return loads.parts.force, loads.parts.moment - np.cross(link_origins, loads.parts.force)

    def link_loads(self, place: np.ndarray, loads: flow.FlowLoads, origin: np.ndarray) -> Float[np.ndarray, "link 4"]:
        """Return the load on each link in the world: force, and torque about the vertical through its origin."""
        force, torque = self._wrenches(place, loads, origin)
        return np.column_stack([force @ _HALF_TURN, torque[:, 2]])

    def unpressed(self, place: np.ndarray, pressed: np.ndarray, reference_point: np.ndarray) -> np.ndarray:  # noqa: ARG002
        """Return zeros: links are rigid between their joints, and the pressure inside them does no work."""
        return np.zeros((*pressed.shape[:-2], self.size))

    def twists(self, place: np.ndarray, rate: np.ndarray, origin: np.ndarray, axes: int) -> Twists:  # noqa: ARG002
        """Return the motion of the links at rates of the coordinates.

        Args:
            place: posture.
            rate: rate of the coordinates [m/s, rad/s].
            origin: origin of the grid's frame in the world of the flow [m].
            axes: number of axes of the flow, 3 [-].
        """
        states = self.states(ChainState(place, rate))
        return Twists(reference_points=states.position - origin, linear=states.velocity, angular=states.spin)

    def modes(self, place: np.ndarray, origin: np.ndarray, axes: int) -> list[Twists]:
        """Return the motions of the links at a unit rate of each coordinate; see ``twists``."""
        return [self.twists(place, unit, origin, axes) for unit in np.eye(self.size)]

    def centre(self, states: flow.LinkStates) -> tuple[np.ndarray, np.ndarray]:
        """Return position and velocity of the point that the grid follows: the mean of the links by volume."""
        return self._weights @ states.position, self._weights @ states.velocity

    def body(self, path: "LinkPath") -> flow.Linked:
        """Return the robot as a body of the flow that goes along a path, about its centre."""

        def motion(time: float) -> flow.LinkStates:
            states = path.links(time)
            centre, drift = self.centre(states)
            return states._replace(position=states.position - centre, velocity=states.velocity - drift)

        return flow.Linked(pieces=self.pieces, motion=motion)

    def motion(self, path: "LinkPath") -> Callable[[float], flow.Pose]:
        """Return the function that gives the pose of the body's centre at a time [s]."""

        def pose(time: float) -> flow.Pose:
            (x, y, z), (u, v, w) = (vector.tolist() for vector in self.centre(path.links(time)))
            return flow.Pose(position=(x, y, z), velocity=(u, v, w))

        return pose


class LinkPath(ChainPath):
    """The path of a robot through one step: each link follows a cubic between its states at both ends."""

    def __init__(self, chain: LinkChain, time: float, posture: ChainState) -> None:
        super().__init__(time, posture)
        self._chain = chain
        self._states = (chain.states(posture),) * 2
        self._seen_links: dict[float, flow.LinkStates] = {}

    def go(self, time: float, posture: ChainState, end: float, then: ChainState) -> None:
        """Set the path from a posture at a time to a posture at another time [s]."""
        super().go(time, posture, end, then)
        self._states = self._chain.states(posture), self._chain.states(then)
        self._seen_links.clear()

    def posture_at(self, time: float) -> ChainState:
        """Return the posture at the end of the path that is nearer to a time [s]; between the ends only links exist."""
        start_time, end_time = self._times
        return self._start if abs(time - start_time) < abs(time - end_time) else self._end

    def links(self, time: float) -> flow.LinkStates:
        """Return the links at a time [s] in the frame of the flow, extrapolated at constant rates beyond the ends."""
        if time not in self._seen_links:
            (start_time, end_time), (start, end) = self._times, self._states
            span = end_time - start_time
            link_states = (
                interpolate_links(start, end, span, (time - start_time) / span)
                if span
                else extrapolate_links(end, time - end_time)
            )
            self._seen_links[time] = link_states
        return self._seen_links[time]


def _piece(shape: LinkShape) -> flow.LinkPiece:
    """Return a shape of a robot as a piece of a body of the flow."""
    if shape.kind == "ellipsoid":
        length, width, height = (2 * half for half in shape.size)
        ellipsoid: flow.Ellipsoid | flow.Spherocylinder = flow.Ellipsoid(length=length, width=width, height=height)
        return flow.LinkPiece(link=shape.link, shape=ellipsoid, position=shape.centre, quaternion=shape.turn)
    length = 2 * shape.size[1] if shape.kind == "rod" else 0.0
    w, x, y, z = rotation.multiply(np.array(shape.turn), _ROD_TURN).tolist()
    return flow.LinkPiece(
        link=shape.link,
        shape=flow.Spherocylinder(length=length, radius=shape.size[0]),
        position=shape.centre,
        quaternion=(w, x, y, z),
    )
