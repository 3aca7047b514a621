"""Forward kinematics of any tree of hinges: bodies, feet and centre of mass.

Everything is in the frame of the root: x forward, y left, z up. Angles come in the order of
``suchus.robot.design.joint_names``.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.robot.design import Robot, layout
from suchus.robot.design.layout import Axis
from suchus.robot.design.pieces import foam_centres
from suchus.robot.kinematics.given import broadcast_to_shape, numbers, rows


class BodyFrames(NamedTuple):
    """The frames of all bodies of ``layout(robot).bodies``, in the frame of the root."""

    positions: Float[np.ndarray, "*batch body 3"]
    """Origins [m]."""
    turns: Float[np.ndarray, "*batch body 3 3"]
    """Rotation matrices."""


class Landmarks(NamedTuple):
    """Points of the body in the frame of the root."""

    feet: Float[np.ndarray, "*batch limb 3"]
    """Centres of the feet in the order of the layout's limbs [m]."""
    snout: Float[np.ndarray, "*batch 3"]
    """Tip of the snout [m]."""
    tail: Float[np.ndarray, "*batch 3"]
    """Tip of the tail [m]."""


def frames(robot: Robot, angles: Float[np.ndarray, "*batch joint"]) -> BodyFrames:
    """Return where every body is.

    Args:
        robot: the robot.
        angles: angles of every hinge [rad].

    Raises:
        InvalidDesign: no array of numbers, or not one for each of the robot's hinges.
    """
    place = layout(robot)
    angles = rows(angles, len(place.hinges), f"the posture of {robot.name}, an angle for each hinge,")
    hinge_index, batch = {name: i for i, name in enumerate(place.hinges)}, angles.shape[:-1]
    sines, cosines = np.sin(angles)[..., None], np.cos(angles)[..., None]
    places = np.zeros((*batch, len(place.bodies), 3))
    turns = np.zeros((*batch, len(place.bodies), 3, 3))
    for i, body in enumerate(place.bodies):
        if body.parent < 0:
            turns[..., i, :, :] = np.eye(3)
            continue
        x, y, z = (turns[..., body.parent, :, k] for k in range(3))
        dx, dy, dz = body.offset
        places[..., i, :] = places[..., body.parent, :] + dx * x + dy * y + dz * z
        columns = [x, y, z]
        for _, name, axis in body.hinges:  # each turns about one axis of the frame, in cyclic order
            axis_index = next(k for k in range(3) if axis[k])
            s, c = axis[axis_index] * sines[..., hinge_index[name], :], cosines[..., hinge_index[name], :]
            first_column, second_column = columns[axis_index - 2], columns[axis_index - 1]
            columns[axis_index - 2], columns[axis_index - 1] = (
                c * first_column + s * second_column,
                c * second_column - s * first_column,
            )
        for k, column in enumerate(columns):
            turns[..., i, :, k] = column
    return BodyFrames(places, turns)


def rotation(axis: Axis, angle: Float[np.ndarray, "*batch"]) -> Float[np.ndarray, "*batch 3 3"]:
    """Return the matrices of turns about one axis of unit length (Rodrigues)."""
    x, y, z = broadcast_to_shape(rows(axis, 3, "the axis"), (3,), "the axis")
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = numbers(angle, "the angle", finite=False)
    s, c = np.sin(angle)[..., None, None], np.cos(angle)[..., None, None]
    return np.asarray(np.eye(3) + s * cross + (1.0 - c) * (cross @ cross))


def landmarks(robot: Robot, angles: Float[np.ndarray, "*batch joint"]) -> Landmarks:
    """Return feet, snout and tail tip.

    Args:
        robot: the robot.
        angles: angles of every hinge [rad].

    Raises:
        InvalidDesign: no array of numbers, or not one for each of the robot's hinges.
    """
    place, body_frames = layout(robot), frames(robot, angles)
    feet = np.zeros((*body_frames.positions.shape[:-2], len(place.limbs), 3))
    for i, limb in enumerate(place.limbs):
        end = limb.girdle.limb.links[-1].end
        feet[..., i, :] = _point(body_frames, limb.tip, (end[0], limb.side * end[1], end[2]))
    front, rear = place.robot.axis[0], place.robot.axis[-1]
    names = [body.name for body in place.bodies]
    nose, tip = names.index(front.name), names.index(rear.name)
    return Landmarks(
        feet=feet,
        snout=_point(body_frames, nose, (place.bodies[nose].shift + front.front, 0.0, 0.0)),
        tail=_point(body_frames, tip, (place.bodies[tip].shift - rear.rear, 0.0, 0.0)),
    )


def centre_of_mass(robot: Robot, angles: Float[np.ndarray, "*batch joint"]) -> Float[np.ndarray, "*batch 3"]:
    """Return the centre of mass of a posture [m]; arguments as for ``landmarks``."""
    masses, moments = body_masses(robot)
    body_frames, total_mass = frames(robot, angles), masses.sum()
    rotated = np.einsum("...bij,bj->...i", body_frames.turns, moments / total_mass, optimize=True)
    return np.asarray(np.einsum("b,...bi->...i", masses / total_mass, body_frames.positions) + rotated)


@lru_cache(maxsize=64)
def body_masses(robot: Robot) -> tuple[np.ndarray, np.ndarray]:
    """Return the mass of each body with its foam [kg], and its mass times its centre in its own frame [kg m]."""
    place = layout(robot)
    segments = {segment.name: segment for segment in place.robot.axis}
    rows = []
    for i, body in enumerate(place.bodies):
        for shape in segments[body.name].shapes if body.name in segments else ():
            x, y, z = shape.centre
            rows.append((i, (x + body.shift, y, z), shape.mass))
    for limb in place.limbs:
        links = limb.girdle.limb.links
        for number, link in enumerate(links):
            end = np.array([link.end[0], limb.side * link.end[1], link.end[2]])
            rows.append((limb.tip - len(links) + 1 + number, tuple(end / 2), link.mass))
        rows.append((limb.tip, tuple(end), limb.girdle.limb.foot.mass))
    masses, moments = np.zeros(len(place.bodies)), np.zeros((len(place.bodies), 3))
    for i, centre, mass in rows:
        masses[i] += mass
        moments[i] += mass * np.array(centre)
    for i, body in enumerate(place.bodies):
        if body.inertia is not None:
            moments[i] = masses[i] * np.array(body.inertia.centre)
    hull, names = place.robot.hull, [body.name for body in place.bodies]
    if hull is not None:
        for foam in hull.foam:
            i, mass = names.index(foam.body), hull.density * foam.volume
            masses[i] += mass
            moments[i] += mass * np.array(foam_centres(robot)[foam.body])
    return masses, moments


def _point(body_frames: BodyFrames, body: int, offset: Axis) -> np.ndarray:
    return np.asarray(body_frames.positions[..., body, :] + body_frames.turns[..., body, :, :] @ np.array(offset))
