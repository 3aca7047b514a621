"""A whole robot with other servos or springs, wherever its parts hold one."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any

from suchus.robot.design.article import remade
from suchus.robot.design.body import Robot
from suchus.robot.design.hinge import Cable, Crank, Hinge, LinearActuator, Servo, Spring
from suchus.robot.design.limb import Girdle
from suchus.robot.design.motor import LINE
from suchus.robot.design.tables import Tail

_LIMBS = ("girdles", "front_leg", "hind_leg")
"""Fields of a robot or of the article's tables that hold limbs."""


def with_leg_servos(robot: Robot, change: Callable[[Servo], Servo]) -> Robot:
    """Return a robot with the servos of its limbs changed."""

    def in_limbs(design: Any) -> Any:
        parts = {field.name: getattr(design, field.name) for field in fields(design) if field.name in _LIMBS}
        return replace(design, **{name: _changed(part, change) for name, part in parts.items()})

    return remade(robot, in_limbs)


def with_speed_line(servo: Servo) -> Servo:
    """Return a servo whose torque falls to nothing at its speed; one that has a winding already stays as it is.

    The viscous friction of its gear is in that line.
    """
    return servo if servo.winding is not None else replace(servo, winding=LINE, damping=0.0)


def with_full_torque(servo: Servo) -> Servo:
    """Return a servo that gives its torque at any speed and heat, up to its speed: one without a motor."""
    return replace(servo, winding=None)


def with_speed_lines(robot: Robot) -> Robot:
    """Return a robot with ``with_speed_line`` for each of its servos."""
    return with_servos(robot, with_speed_line)


def with_servos(robot: Robot, change: Callable[[Servo], Servo]) -> Robot:
    """Return a robot with each of its servos changed; a linear actuator as the servo that would do the same."""
    return remade(robot, lambda design: _changed(design, change))


def with_named_servos(robot: Robot, servos: Mapping[str, Servo]) -> Robot:
    """Return a robot with other servos in some places.

    Args:
        robot: the robot; it stays as it is. The limbs of a girdle mirror each other, so that either name changes both.
        servos: by the names of ``design.servo_names``; of two for one place the stronger counts. A linear actuator
            becomes one that does what the servo would on the cable's ``pulley``.
    """

    def other(hinge: Hinge, names: Collection[str]) -> Hinge:
        found = sorted((servos[name] for name in names if name in servos), key=lambda servo: servo.torque)
        if not found or hinge.servo is None:
            return hinge
        return replace(
            hinge, drive=replace(hinge.drive, servo=found[-1]) if isinstance(hinge.drive, Crank) else found[-1]
        )

    def limb(girdle: Girdle) -> Girdle:
        links = tuple(
            replace(
                link, hinges=tuple(other(h, [f"{side}{girdle.name}_{h.name}" for side in "LR"]) for h in link.hinges)
            )
            for link in girdle.limb.links
        )
        return replace(girdle, limb=replace(girdle.limb, links=links))

    axis = tuple(replace(one, hinges=tuple(other(hinge, [hinge.name]) for hinge in one.hinges)) for one in robot.axis)
    cables = tuple(_pulled(one, servos[one.name]) if one.name in servos else one for one in robot.cables)
    return replace(robot, axis=axis, girdles=tuple(limb(one) for one in robot.girdles), cables=cables)


def with_spring(robot: Robot, hinges: Collection[str], stiffness: float) -> Robot:
    """Return a robot with another stiffness of the springs in some passive hinges of its axis.

    Args:
        robot: the robot; it stays as it is.
        hinges: names of hinges with springs.
        stiffness: of each [N m/rad].
    """

    def with_other(hinge: Hinge) -> Hinge:
        if hinge.name not in hinges or not isinstance(hinge.drive, Spring):
            return hinge
        return replace(hinge, drive=replace(hinge.drive, stiffness=stiffness))

    axis = tuple(replace(one, hinges=tuple(with_other(hinge) for hinge in one.hinges)) for one in robot.axis)
    return replace(robot, axis=axis)


def _pulled(cable: Cable, servo: Servo) -> Cable:
    """Return a cable whose drive does what a servo does on its pulley."""
    linear = cable.linear
    other = servo if linear is None else LinearActuator.of(servo, cable.pulley, linear.travel)
    return replace(cable, servo=other)


def _changed(part: Any, change: Callable[[Servo], Servo], radius: float = 1.0) -> Any:
    """Return a part with its servos changed; a linear actuator as a servo on a pulley of a radius [m]."""
    if isinstance(part, Servo):
        return change(part)
    if isinstance(part, LinearActuator):
        servo = part.on(radius)
        other = change(servo)
        return part if other == servo else LinearActuator.of(other, radius, part.travel)
    if isinstance(part, Tail):
        radius = part.cord_spacing / 2
    elif isinstance(part, Cable):
        radius = part.pulley
    if isinstance(part, tuple):
        ones = [_changed(one, change, radius) for one in part]
        return tuple(ones) if any(new is not old for new, old in zip(ones, part, strict=True)) else part
    if is_dataclass(part) and not isinstance(part, type):
        found = {f.name: getattr(part, f.name) for f in fields(part) if f.init}
        changed = {name: _changed(value, change, radius) for name, value in found.items()}
        changed = {name: value for name, value in changed.items() if value is not found[name]}
        return replace(part, **changed) if changed else part
    return part
