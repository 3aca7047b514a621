"""The bodies of a robot: segments of the axis and links of the limbs, with hinges, shapes and sites."""

from math import pi
from typing import Any

import mujoco

from suchus.design import Contact, Hinge, Layout, LimbPlace, Robot, Rod, Segment, Servo, Spring
from suchus.design.pieces import foam_centres
from suchus.design.segment import Point
from suchus.model.names import IMU, SNOUT, TAIL_TIP
from suchus.model.surface import shell, skin, sole

_SITE = 0.002  # [m]; as they are drawn
_LEAST = 1e-9  # [kg] of foam; less than MuJoCo takes for a mass


def add_bodies(root: Any, place: Layout) -> None:
    """Give the root its shape and hang all other bodies on it.

    Args:
        root: the ``MjsBody`` that carries the free joint.
        place: the layout of the robot.
    """
    robot = place.robot
    segments = {segment.name: segment for segment in robot.axis}
    links = {
        limb.tip - i: (limb, len(limb.girdle.limb.links) - 1 - i)
        for limb in place.limbs
        for i in range(len(limb.girdle.limb.links))
    }
    made: list[Any] = []
    for number, body in enumerate(place.bodies):
        here = root if body.parent < 0 else made[body.parent].add_body(name=body.name, pos=list(body.offset))
        made.append(here)
        for hinge, name, axis in body.hinges:
            _add_hinge(here, hinge, name, list(axis))
        if number in links:
            _add_link(here, *links[number], robot.contact)
        else:
            _add_segment(here, segments[body.name], body.shift, robot)


def _add_hinge(body: Any, hinge: Hinge, name: str, axis: list[float]) -> None:
    made: dict[str, Any] = {"name": name, "type": mujoco.mjtJoint.mjJNT_HINGE, "axis": axis}
    if hinge.range is not None:
        made |= {"range": list(hinge.range), "limited": mujoco.mjtLimited.mjLIMITED_TRUE}
    servo = hinge.servo
    if servo is not None:
        made |= {"armature": servo.armature, "frictionloss": servo.friction, "damping": servo.damping}
    elif isinstance(hinge.drive, Spring):
        spring = hinge.drive
        made |= {"stiffness": spring.stiffness, "damping": spring.damping, "armature": spring.armature}
    body.add_joint(**made)


def _add_segment(body: Any, segment: Segment, shift: float, robot: Robot) -> None:
    for shape in segment.shapes:
        if isinstance(shape, Rod):
            start, end = _moved(shape.start, shift), _moved(shape.end, shift)
            skin(body, shape.name, start, end, shape.radius, shape.mass, robot.contact)
        else:
            shell(body, shape.name, _moved(shape.at, shift), shape.half, shape.mass, robot.contact)
    if segment.name == robot.root:
        body.add_site(name=IMU, pos=[shift, 0, 0], size=[2 * _SITE, 0, 0])
    if segment is robot.axis[0]:
        body.add_site(name=SNOUT, pos=[shift + segment.front, 0, 0], size=[_SITE, 0, 0])
    if segment is robot.axis[-1]:
        body.add_site(name=TAIL_TIP, pos=[shift - segment.rear, 0, 0], size=[_SITE, 0, 0])


def _moved(point: Point, shift: float) -> list[float]:
    return [point[0] + shift, point[1], point[2]]


def _add_link(body: Any, limb: LimbPlace, number: int, contact: Contact) -> None:
    design = limb.girdle.limb
    link = design.links[number]
    end = [link.end[0], limb.side * link.end[1], link.end[2]]
    skin(body, f"{limb.name}_{link.name}", [0, 0, 0], end, link.radius, link.mass, contact)
    if number == len(design.links) - 1:
        sole(body, f"{limb.name}_foot", end, design.foot.radius, design.foot.mass, contact)
        body.add_site(name=f"{limb.name}_foot", pos=end, size=[_SITE, 0, 0])


def add_foam(spec: Any, place: Layout) -> None:
    """Add the mass of the robot's foam: balls of its volume around its centres, which touch nothing."""
    hull = place.robot.hull
    if hull is None:
        return
    at = foam_centres(place.robot)
    for foam in hull.foam:
        if foam.volume * hull.density < _LEAST:
            continue
        spec.body(foam.body).add_geom(
            name=f"{foam.body}_foam",
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[(3 * foam.volume / (4 * pi)) ** (1 / 3), 0, 0],
            pos=list(at[foam.body]),
            mass=hull.density * foam.volume,
            contype=0,
            conaffinity=0,
            priority=1,
            group=4,
        )


def lay_cables(spec: Any, robot: Robot) -> None:
    """Lay the cables: the length of each is the sum of its hinges' angles times half the cord spacing.

    That is the first order of the exact change in length, whose relative error is below 1.2 % up to 180 degrees.
    """
    for cable in robot.cables:
        servo: Servo = cable.servo
        tendon = spec.add_tendon(
            name=cable.name,
            frictionloss=servo.friction / cable.pulley,
            damping=servo.damping / cable.pulley**2,
        )
        for joint in cable.hinges:
            tendon.wrap_joint(joint, cable.cord_spacing / 2)
