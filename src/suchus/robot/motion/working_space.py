"""Where a robot can bring its snout while its feet stay where they are: on four feet, or on hind feet and tail.

Configurations are drawn at random: place, height and pitch of the pelvis, and the joints of the trunk within their
ranges. Inverse kinematics then finds the legs. Configurations are kept if every joint is within its range, the trunk is
above the ground, and the centre of mass is over the support polygon. Servo torques and the body's own thickness are
left out.
"""

from math import radians
from typing import NamedTuple

import numpy as np
from jaxtyping import Bool, Float
from scipy.stats import qmc

from suchus.robot.design import LEGS, Robot, joint_names, layout, spine_joints
from suchus.robot.kinematics import leg as leg_kinematics
from suchus.robot.kinematics import spine
from suchus.robot.kinematics.tree import centre_of_mass, frames, landmarks
from suchus.robot.motion.forms import GaitInMetres, limb_reaches
from suchus.robot.motion.gait import Gait

CRAWL_PITCH = (radians(-30), radians(45))
"""Pitches of the pelvis that are tried on four feet, front end up positive [rad]."""
STAND_PITCH = (0.0, radians(90))
"""Pitches of the pelvis that are tried on hind feet and tail [rad]."""
ARMS_TUCKED = (0.2, -0.3, 1.2)
"""Yaw, pitch and knee of front legs that carry nothing: near the trunk [rad]."""
_CHUNK = 2**15


class Configurations(NamedTuple):
    """Configurations that were kept; the world's origin lies on the ground midway between the hind feet, x forward."""

    snout: Float[np.ndarray, "n 3"]
    """Tip of the snout in the world [m]."""
    angles: Float[np.ndarray, "n joint"]
    """Angles of every hinge, in the order of ``joint_names(robot)`` [rad]."""
    pelvis: Float[np.ndarray, "n 3"]
    """x, z of the pelvis in the world [m], and its pitch, front end up positive [rad]."""
    sample_count: int
    """Number of postures that were drawn [-]."""


def sample_configurations(robot: Robot, gait: Gait, *, standing: bool, count: int, seed: int = 0) -> Configurations:
    """Return configurations of a robot that keeps its feet where they are.

    Hind feet, and on all fours front feet, stand where they stand in the middle of the gait's stance with the trunk
    straight.

    Args:
        robot: the design.
        gait: where the feet stand.
        standing: on hind feet and the tip of the straight tail, the front legs tucked, instead of on four feet.
        count: how many configurations are drawn, rounded up to a power of two [-].
        seed: seed of the drawing.
    """
    lower_bound, upper_bound = _box(robot, standing)
    metres = GaitInMetres.from_gait(gait, limb_reaches(robot))
    fractions = qmc.Sobol(len(lower_bound), rng=seed).random_base2(max(count - 1, 1).bit_length())
    samples = lower_bound + (upper_bound - lower_bound) * fractions
    parts = [
        _feasible(robot, metres, samples[start : start + _CHUNK], standing) for start in range(0, len(samples), _CHUNK)
    ]
    snout, angles, pelvis = (np.concatenate(fields) for fields in zip(*parts, strict=True))
    return Configurations(snout, angles, pelvis, len(samples))


def _box(robot: Robot, standing: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return the lower and upper bounds of the sampled x, z and pitch of the pelvis and of the trunk's joints.

    Args:
        robot: the design.
        standing: on hind feet and tail instead of four feet.
    """
    leg_reach, links = robot.hind_leg.reach[1], robot.spine
    ranges = [links.yaw_range if "yaw" in name else links.pitch_range for name in spine_joints()]
    pitch = STAND_PITCH if standing else CRAWL_PITCH
    pelvis = [(-leg_reach, leg_reach), (robot.pelvis.height / 2, robot.hind_leg.foot_radius + leg_reach), pitch]
    lower_bound, upper_bound = np.array([*pelvis, *ranges]).T
    return lower_bound, upper_bound


def _feasible(
    robot: Robot, gait: GaitInMetres, samples: np.ndarray, standing: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return snout, angles and pelvis of those sampled configurations that meet all conditions.

    Args:
        robot: the design.
        gait: where the feet stand.
        samples: x, z and pitch of the pelvis and angles of the trunk, shape (n, number).
        standing: on hind feet and tail instead of four feet.
    """
    pelvis, trunk = samples[:, :3], samples[:, 3:]
    angles = np.zeros((len(samples), len(joint_names(robot))))
    first_joint = joint_names(robot).index(spine_joints()[0])
    angles[:, first_joint : first_joint + trunk.shape[1]] = trunk
    good = np.ones(len(samples), dtype=bool)
    hind = np.array([0.0, robot.hind_leg.hip_offset + gait.hind_reach, robot.hind_leg.foot_radius])
    _place(robot, angles, good, ("LH", "RH"), _to_pelvis(pelvis, hind), _to_pelvis(pelvis, hind * [1, -1, 1]))
    if standing:
        angles[:, 0:3] = angles[:, 3:6] = ARMS_TUCKED
    else:
        front_foot_x = robot.spine.length + robot.thorax.shoulder + gait.front_ahead - gait.hind_ahead
        front = np.array([front_foot_x, robot.front_leg.hip_offset + gait.front_reach, robot.front_leg.foot_radius])
        T = spine.forward(robot.spine, trunk)
        shoulder = T[:, :3, 3] + robot.thorax.shoulder * T[:, :3, 0]
        left_foot, right_foot = (
            np.einsum("nji,nj->ni", T[:, :3, :3], _to_pelvis(pelvis, front * [1, side, 1]) - shoulder)
            for side in (1, -1)
        )
        _place(robot, angles, good, ("LF", "RF"), left_foot, right_foot)
    joints = _to_world(pelvis, spine.joints(robot.spine, trunk))
    good &= (joints[..., 2] >= robot.spine.radius).all(axis=1)
    if standing:
        good &= _tail_laid(robot, angles, pelvis)
    angles, pelvis = angles[good], pelvis[good]
    marks = landmarks(robot, angles)
    snout = _to_world(pelvis, marks.snout)
    com, feet, tip = (_to_world(pelvis, p) for p in (centre_of_mass(robot, angles), marks.feet, marks.tail))
    corners = (
        [feet[:, LEGS.index("LH")], tip, feet[:, LEGS.index("RH")]]
        if standing
        else [feet[:, LEGS.index(name)] for name in ("LF", "LH", "RH", "RF")]
    )
    upright = is_inside(com[:, :2], np.stack(corners, axis=1)[..., :2]) & (snout[:, 2] >= robot.head.height / 2)
    return snout[upright], angles[upright], pelvis[upright]


def _place(robot: Robot, angles: np.ndarray, good: np.ndarray, names: tuple[str, str], *feet: np.ndarray) -> None:
    """Write the angles of two legs, and clear the mark of configurations whose feet are out of reach.

    Args:
        robot: the design.
        angles: angles of every hinge, shape (n, joint), changed in place [rad].
        good: marks of feasible configurations, shape (n,), changed in place.
        names: names of the two legs.
        *feet: their positions in the frame of their girdle, shape (n, 3) [m].
    """
    for name, foot in zip(names, feet, strict=True):
        links, limb, index = robot.leg(name), layout(robot).limb(name), 3 * LEGS.index(name)
        point = np.stack([limb.side * foot[..., 1], foot[..., 0], -foot[..., 2]], axis=-1)  # in the leg's D-H frame
        good &= leg_kinematics.reachable(links, point)
        angles[good, index : index + 3] = leg_kinematics.inverse(links, point[good])
        lower_bound, upper_bound = np.array([links.yaw_range, links.pitch_range, links.knee_range]).T
        good &= ((angles[:, index : index + 3] >= lower_bound) & (angles[:, index : index + 3] <= upper_bound)).all(
            axis=1
        )


def _tail_laid(robot: Robot, angles: np.ndarray, pelvis: np.ndarray) -> Bool[np.ndarray, " n"]:
    """Write the tail pitch at which its tip touches the ground; return which configurations can do that.

    Args:
        robot: the design.
        angles: angles of every hinge, shape (n, joint), changed in place [rad].
        pelvis: x, z and pitch, shape (n, 3) [m], [rad].
    """
    tail = robot.tail
    drop = (pelvis[:, 1] - tail.offset * np.sin(pelvis[:, 2]) - tail.radius_tip) / (tail.length - tail.offset)
    pitch = np.arcsin(np.clip(drop, -1.0, 1.0)) - pelvis[:, 2]
    place = layout(robot)
    angles[:, place.servo_hinges[place.tail_pitch[0]]] = pitch
    lower_bound, upper_bound = tail.pitch_range
    return np.asarray((np.abs(drop) <= 1.0) & (pitch >= lower_bound) & (pitch <= upper_bound))


def _turn(pelvis: np.ndarray) -> np.ndarray:
    s, c, zero_array, unit_array = (
        np.sin(pelvis[:, 2]),
        np.cos(pelvis[:, 2]),
        np.zeros(len(pelvis)),
        np.ones(len(pelvis)),
    )
    return np.stack([c, zero_array, -s, zero_array, unit_array, zero_array, s, zero_array, c], axis=-1).reshape(
        -1, 3, 3
    )


def _position(pelvis: np.ndarray) -> np.ndarray:
    return np.stack([pelvis[:, 0], np.zeros(len(pelvis)), pelvis[:, 1]], axis=-1)


def _to_pelvis(pelvis: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Return a point of the world in the frame of each pelvis [m]."""
    return np.einsum("nji,nj->ni", _turn(pelvis), point - _position(pelvis))


def _to_world(pelvis: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return points of each pelvis' frame, (n, 3) or (n, point, 3), in the world [m]."""
    turn, origin = _turn(pelvis), _position(pelvis)
    if points.ndim == 2:
        return origin + np.einsum("nij,nj->ni", turn, points)
    return origin[:, None] + np.einsum("nij,npj->npi", turn, points)


def is_inside(point: Float[np.ndarray, "n 2"], corners: Float[np.ndarray, "n corner 2"]) -> Bool[np.ndarray, " n"]:
    """Return whether a point lies in a convex polygon whose corners go around anticlockwise, seen from above."""
    edges = np.roll(corners, -1, axis=1) - corners
    offsets = point[:, None] - corners
    return np.asarray((edges[..., 0] * offsets[..., 1] - edges[..., 1] * offsets[..., 0] >= 0).all(axis=1))


def outline(
    robot: Robot, angles: Float[np.ndarray, "n joint"], pelvis: Float[np.ndarray, "n 3"]
) -> tuple[Float[np.ndarray, "n point 3"], Float[np.ndarray, "n 4 3 3"]]:
    """Return the midline from tail tip to snout, and hip, knee and foot of each leg, in the world [m].

    Args:
        robot: the design.
        angles: angles of every hinge [rad].
        pelvis: x, z and pitch, see ``Configurations``.
    """
    place, body_frames, marks = layout(robot), frames(robot, angles), landmarks(robot, angles)
    names = [body.name for body in place.bodies]
    axis = [names.index(segment.name) for segment in reversed(robot.axis)]  # from the tail; frames stand at the joints
    line = np.concatenate([marks.tail[:, None], body_frames.positions[:, axis], marks.snout[:, None]], axis=1)
    legs = np.empty((len(angles), len(place.limbs), 3, 3))
    for i, limb in enumerate(place.limbs):
        legs[:, i, :2] = _to_world(pelvis, body_frames.positions[:, limb.tip - 1 : limb.tip + 1])
        legs[:, i, 2] = _to_world(pelvis, marks.feet[:, i])
    return _to_world(pelvis, line), legs


class Extent(NamedTuple):
    """How much a cloud of points fills, between a lower and an upper estimate."""

    value: float
    """Middle of both [m2] or [m3]."""
    lower_estimate: float
    """Cells whose neighbours on every side hold points too."""
    upper_estimate: float
    """Cells that hold points, and those that more points would have found, after Chao."""


def extent(points: Float[np.ndarray, "n d"], cell: float) -> Extent:
    """Return the area or volume that points fill, by counting the cells of a grid.

    The edge of what is filled runs through the cells without a neighbour. Chao's estimate of the cells that were
    missed is ``f1 (f1 - 1) / (2 (f2 + 1))`` with f1 and f2 the numbers of cells that hold one and two points.

    Args:
        points: points in the plane or in space [m].
        cell: edge of a cell [m].
    """
    if len(points) == 0:
        return Extent(0.0, 0.0, 0.0)
    place = np.floor((points - points.min(axis=0)) / cell).astype(int) + 1
    counts = np.zeros(place.max(axis=0) + 2, dtype=np.int64)
    np.add.at(counts, tuple(place.T), 1)
    is_occupied = counts > 0
    is_interior = is_occupied.copy()
    for axis in range(points.shape[1]):
        is_interior &= np.roll(is_occupied, 1, axis) & np.roll(is_occupied, -1, axis)
    single_count, double_count = int((counts == 1).sum()), int((counts == 2).sum())
    unseen = single_count * (single_count - 1) / (2 * (double_count + 1))
    size = cell ** points.shape[1]
    lower_estimate, upper_estimate = size * int(is_interior.sum()), size * (int(is_occupied.sum()) + unseen)
    return Extent(0.5 * (lower_estimate + upper_estimate), lower_estimate, upper_estimate)
