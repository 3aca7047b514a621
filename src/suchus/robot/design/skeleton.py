"""The part of a robot's design that decides how a gait moves it: shapes, hinges and ranges, without masses."""

from dataclasses import replace
from functools import lru_cache

from suchus.robot.design.body import Robot
from suchus.robot.design.hinge import Cable, Crank, Hinge, Servo
from suchus.robot.design.limb import Girdle
from suchus.robot.design.segment import Segment

_MASS = 1.0  # [kg]; of every shape and link
_SERVO = Servo(
    kp=1.0, ki=0.0, kd=0.0, integral_limit=0.0, torque=1.0, speed=1.0, armature=1e-12, friction=0.0, damping=0.0
)


@lru_cache(maxsize=1024)
def skeleton(robot: Robot) -> Robot:
    """Return a robot with the same shapes, hinges, ranges and cables, whose masses and servos are all alike.

    Robots with equal skeletons do the same in a gait as long as nothing resists: postures, ranges and reaches are those
    of all of them. It is for telling that, and no robot to simulate.
    """
    return _intern(
        replace(
            robot,
            axis=tuple(_segment(segment) for segment in robot.axis),
            girdles=tuple(_girdle(girdle) for girdle in robot.girdles),
            cables=tuple(_cable(cable) for cable in robot.cables),
        )
    )


@lru_cache(maxsize=1024)
def _intern(robot: Robot) -> Robot:
    """Return the first of equal robots, so that equal robots are one object."""
    return robot


def _segment(segment: Segment) -> Segment:
    shapes = tuple(replace(shape, mass=_MASS) for shape in segment.shapes)
    return replace(segment, shapes=shapes, inertia=None, hinges=tuple(_hinge(hinge) for hinge in segment.hinges))


def _girdle(girdle: Girdle) -> Girdle:
    """Return a girdle whose links and feet have unit mass and whose servos are all equal."""
    limb = girdle.limb
    links = tuple(
        replace(link, mass=_MASS, inertia=None, hinges=tuple(_hinge(hinge) for hinge in link.hinges))
        for link in limb.links
    )
    return replace(girdle, limb=replace(limb, links=links, foot=replace(limb.foot, mass=_MASS)))


def _hinge(hinge: Hinge) -> Hinge:
    drive = Crank(servo=_SERVO) if isinstance(hinge.drive, Crank) else _SERVO
    return hinge if hinge.servo is None else replace(hinge, drive=drive)


def _cable(cable: Cable) -> Cable:
    return replace(cable, servo=_SERVO) if isinstance(cable.servo, Servo) else cable
