"""Where every part of a robot is: its bodies, its feet, its centre of mass, for any tree of hinges.

Everything is in the frame of the root: x forward, y left, z up. Angles come in the order of
``suchus.design.joint_names``.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.design import Robot, layout
from suchus.design.layout import Axis
from suchus.design.pieces import foam_centres
from suchus.kinematics.given import numbers, rows, spread_over


class BodyFrames(NamedTuple):
    """The frames of all bodies of ``layout(robot).bodies``, in the frame of the root."""

    places: Float[np.ndarray, "*batch body 3"]
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
        angles: of every hinge [rad].

    Raises:
        InvalidDesign: no array of numbers, or not one for each of the robot's hinges.
    """
    place = layout(robot)
    angles = rows(angles, len(place.hinges), f"the posture of {robot.name}, an angle for each hinge,")
    where = {name: i for i, name in enumerate(place.hinges)}
    batch = angles.shape[:-1]
    places = np.zeros((*batch, len(place.bodies), 3))
    turns = np.zeros((*batch, len(place.bodies), 3, 3))
    for i, body in enumerate(place.bodies):
        if body.parent < 0:
            turns[..., i, :, :] = np.eye(3)
            continue
        turn = turns[..., body.parent, :, :]
        places[..., i, :] = places[..., body.parent, :] + turn @ np.array(body.offset)
        for _, name, axis in body.hinges:
            turn = turn @ rotation(axis, angles[..., where[name]])
        turns[..., i, :, :] = turn
    return BodyFrames(places, turns)


def rotation(axis: Axis, angle: Float[np.ndarray, "*batch"]) -> Float[np.ndarray, "*batch 3 3"]:
    """Return the matrices of turns about one axis of unit length (Rodrigues)."""
    x, y, z = spread_over(rows(axis, 3, "the axis"), (3,), "the axis")
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = numbers(angle, "the angle", finite=False)
    s, c = np.sin(angle)[..., None, None], np.cos(angle)[..., None, None]
    return np.asarray(np.eye(3) + s * cross + (1.0 - c) * (cross @ cross))


def landmarks(robot: Robot, angles: Float[np.ndarray, "*batch joint"]) -> Landmarks:
    """Return feet, snout and tail tip.

    Args:
        robot: the robot.
        angles: of every hinge [rad].

    Raises:
        InvalidDesign: no array of numbers, or not one for each of the robot's hinges.
    """
    place, found = layout(robot), frames(robot, angles)
    feet = np.zeros((*found.places.shape[:-2], len(place.limbs), 3))
    for i, limb in enumerate(place.limbs):
        end = limb.girdle.limb.links[-1].end
        feet[..., i, :] = _point(found, limb.tip, (end[0], limb.side * end[1], end[2]))
    front, rear = place.robot.axis[0], place.robot.axis[-1]
    names = [body.name for body in place.bodies]
    nose, tip = names.index(front.name), names.index(rear.name)
    return Landmarks(
        feet=feet,
        snout=_point(found, nose, (place.bodies[nose].shift + front.front, 0.0, 0.0)),
        tail=_point(found, tip, (place.bodies[tip].shift - rear.rear, 0.0, 0.0)),
    )


def centre_of_mass(robot: Robot, angles: Float[np.ndarray, "*batch joint"]) -> Float[np.ndarray, "*batch 3"]:
    """Return the centre of mass of a posture [m]; arguments as for ``landmarks``."""
    bodies, points, masses = _masses(robot)
    found = frames(robot, angles)
    at = found.places[..., bodies, :] + np.einsum("...bij,bj->...bi", found.turns[..., bodies, :, :], points)
    return np.asarray(np.einsum("b,...bi->...i", masses / masses.sum(), at))


@lru_cache(maxsize=64)
def _masses(robot: Robot) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the body, the place in its frame [m] and the mass [kg] of every piece, foam included."""
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
    hull, names = place.robot.hull, [body.name for body in place.bodies]
    if hull is not None:
        at = foam_centres(robot)
        rows += [(names.index(foam.body), at[foam.body], hull.density * foam.volume) for foam in hull.foam]
    return np.array([row[0] for row in rows]), np.array([row[1] for row in rows]), np.array([row[2] for row in rows])


def _point(found: BodyFrames, body: int, at: Axis) -> np.ndarray:
    return np.asarray(found.places[..., body, :] + found.turns[..., body, :, :] @ np.array(at))
