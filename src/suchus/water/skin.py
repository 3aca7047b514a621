"""What the water does along the skin: pressures on the two sides of the tail, and moments about the joints."""

import numpy as np
from jaxtyping import Float

from suchus import flow
from suchus.design import cable_joints
from suchus.water.outline import Outline

PLACES = 33
"""Places along the tail at which the pressures of its two sides are kept [-]."""


def joint_torques(outline: Outline, surface: flow.Surface, midline: flow.MidlineState) -> Float[np.ndarray, " 4"]:
    """Return the moment of the water about each yaw joint and the first cable joint, of what lies beyond it [N m/m].

    Beyond a joint of the trunk lies the part towards the snout, beyond that of the tail the part towards its tip.

    Args:
        outline: of the robot.
        surface: pressure and friction along the skin.
        midline: where the joints are now.
    """
    return _moments(outline, surface, midline, outline.places[:4], np.ones(surface.markers.station.size))


def servo_torques(outline: Outline, surface: flow.Surface, midline: flow.MidlineState) -> Float[np.ndarray, " 4"]:
    """Return what the water asks of the yaw servos and of the cable's servo, each at its own shaft [N m].

    Every section is as high as the robot is there and feels the pressures of the flow, which knows no height: water
    that goes over and under the body would ask for less. The cable bends its joints alike, so that its servo takes the
    mean of their moments, over the ratio of half the cords' distance to the pulley.

    Args:
        outline: of the robot.
        surface: pressure and friction along the skin.
        midline: where the joints are now.
    """
    tail, last = outline.robot.tail, 3 + len(cable_joints(outline.robot))
    high = 2.0 * np.interp(surface.markers.station, outline.s, outline.silhouette.half_height)
    moments = _moments(outline, surface, midline, outline.places[:last], high)
    return np.array([*moments[:3], moments[3:].mean() * tail.pulley / (0.5 * tail.cord_spacing)])


def _moments(
    outline: Outline, surface: flow.Surface, midline: flow.MidlineState, places: np.ndarray, high: np.ndarray
) -> np.ndarray:
    """Return the moment about joints of what the water does beyond them, markers being so high."""
    m = surface.markers
    fx, fy = surface.traction * m.length * high
    found = []
    for i, place in enumerate(places):
        x, y = np.interp(place, outline.s, midline.x), np.interp(place, outline.s, midline.y)
        beyond = m.station < place if i < 3 else m.station > place
        found.append(float(np.sum(((m.x - x) * fy - (m.y - y) * fx)[beyond])))
    return np.array(found)


def tail_sides(outline: Outline, surface: flow.Surface) -> Float[np.ndarray, "2 place"]:
    """Return the pressure on the robot's left and right of its tail, from root to tip [Pa]."""
    m = surface.markers
    places = np.linspace(root(outline), outline.robot.length, PLACES)
    out = np.empty((2, PLACES))
    for row, side in enumerate((-1.0, 1.0)):  # the midline runs to the tail: its left is the robot's right
        there = np.flatnonzero(m.side == side)
        order = there[np.argsort(m.station[there])]
        out[row] = np.interp(places, m.station[order], surface.pressure[order])
    return out


def convex_less_concave(outline: Outline, surface: flow.Surface, midline: flow.MidlineState) -> float:
    """Return the mean pressure along the convex side of the tail less that along the concave side [Pa]."""
    m, start = surface.markers, root(outline)
    means = []
    for side in (1.0, -1.0):
        part = (m.side == side) & (m.station > start)
        means.append(float(np.average(surface.pressure[part], weights=m.length[part])))
    # what bends to the right is convex on the left
    return (means[1] - means[0]) * float(np.sign(bend(outline, midline)))


def place_of_difference(sides: Float[np.ndarray, "2 place"]) -> float:
    """Return where the pressure difference sits, root 0 to tip 1: the mean place, weighted with the difference [-]."""
    weight = np.abs(sides[1] - sides[0])
    total = float(weight.sum())
    return float(weight @ np.linspace(0.0, 1.0, sides.shape[1])) / total if total > 0 else 0.5


def bend(outline: Outline, midline: flow.MidlineState) -> float:
    """Return how far the tail bends from its root to its tip, to the robot's right [rad]."""
    return float(midline.heading[-1] - np.interp(root(outline), outline.s, midline.heading))


def root(outline: Outline) -> float:
    """Return where the tail begins, from the snout [m]."""
    return outline.robot.length - outline.robot.tail.length + outline.robot.tail.offset
