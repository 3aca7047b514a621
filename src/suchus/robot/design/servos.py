"""A whole robot with other servos or springs, wherever its parts hold one."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any

from suchus.robot.design.article import rebuild
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
        return replace(
            design, **{name: _with_changed_servos(limb_design, change) for name, limb_design in parts.items()}
        )

    return rebuild(robot, in_limbs)


def with_speed_line(servo: Servo) -> Servo:
    """Return a servo whose torque falls linearly to zero at its speed; one with a winding stays as it is.

    The viscous friction of its gear is in that line.
    """
    return servo if servo.winding is not None else replace(servo, winding=LINE, damping=0.0)


def with_full_torque(servo: Servo) -> Servo:
    """Return a servo without a motor model, which gives its full torque at any speed and temperature."""
    return replace(servo, winding=None)


def with_speed_lines(robot: Robot) -> Robot:
    """Return a robot with ``with_speed_line`` for each of its servos."""
    return with_servos(robot, with_speed_line)


def with_servos(robot: Robot, change: Callable[[Servo], Servo]) -> Robot:
    """Return a robot with each of its servos changed; a linear actuator as the servo that would do the same."""
    return rebuild(robot, lambda design: _with_changed_servos(design, change))


def with_named_servos(robot: Robot, servos: Mapping[str, Servo]) -> Robot:
    """Return a robot with other servos in some places.

    Args:
        robot: the robot; it stays as it is. The limbs of a girdle mirror each other, so that either name changes both.
        servos: servos by the names of ``design.servo_names``; of two for one place the stronger counts. A linear
            actuator becomes one that does what the servo would on the cable's ``pulley``.
    """

    def with_servo(hinge: Hinge, names: Collection[str]) -> Hinge:
        """Return a hinge with the strongest of the servos that are given for its names."""
        matching_servos = sorted((servos[name] for name in names if name in servos), key=lambda servo: servo.torque)
        if not matching_servos or hinge.servo is None:
            return hinge
        return replace(
            hinge,
            drive=replace(hinge.drive, servo=matching_servos[-1])
            if isinstance(hinge.drive, Crank)
            else matching_servos[-1],
        )

    def limb(girdle: Girdle) -> Girdle:
        """Return a girdle whose limbs have the new servos."""
        links = tuple(
            replace(
                link,
                hinges=tuple(with_servo(h, [f"{side}{girdle.name}_{h.name}" for side in "LR"]) for h in link.hinges),
            )
            for link in girdle.limb.links
        )
        return replace(girdle, limb=replace(girdle.limb, links=links))

    axis = tuple(
        replace(segment, hinges=tuple(with_servo(hinge, [hinge.name]) for hinge in segment.hinges))
        for segment in robot.axis
    )
    cables = tuple(_with_drive(cable, servos[cable.name]) if cable.name in servos else cable for cable in robot.cables)
    return replace(robot, axis=axis, girdles=tuple(limb(girdle) for girdle in robot.girdles), cables=cables)


def with_spring(robot: Robot, hinges: Collection[str], stiffness: float) -> Robot:
    """Return a robot with another stiffness of the springs in some passive hinges of its axis.

    Args:
        robot: the robot; it stays as it is.
        hinges: names of hinges with springs.
        stiffness: stiffness of each [N m/rad].
    """

    def with_stiffness(hinge: Hinge) -> Hinge:
        if hinge.name not in hinges or not isinstance(hinge.drive, Spring):
            return hinge
        return replace(hinge, drive=replace(hinge.drive, stiffness=stiffness))

    axis = tuple(
        replace(segment, hinges=tuple(with_stiffness(hinge) for hinge in segment.hinges)) for segment in robot.axis
    )
    return replace(robot, axis=axis)


def _with_drive(cable: Cable, servo: Servo) -> Cable:
    """Return a cable with another drive: the servo itself, or the linear actuator that is equivalent to it."""
    linear = cable.linear
    drive = servo if linear is None else LinearActuator.from_servo(servo, cable.pulley, linear.travel)
    return replace(cable, servo=drive)


def _with_changed_servos(design: Any, change: Callable[[Servo], Servo], radius: float = 1.0) -> Any:
    """Return a part with its servos changed; a linear actuator as a servo on a pulley of a radius [m]."""
    if isinstance(design, Servo):
        return change(design)
    if isinstance(design, LinearActuator):
        servo = design.equivalent_servo(radius)
        new_servo = change(servo)
        return design if new_servo == servo else LinearActuator.from_servo(new_servo, radius, design.travel)
    if isinstance(design, Tail):
        radius = design.cord_spacing / 2
    elif isinstance(design, Cable):
        radius = design.pulley
    if isinstance(design, tuple):
        new_elements = [_with_changed_servos(element, change, radius) for element in design]
        return (
            tuple(new_elements)
            if any(new is not old for new, old in zip(new_elements, design, strict=True))
            else design
        )
    if is_dataclass(design) and not isinstance(design, type):
        old_fields = {f.name: getattr(design, f.name) for f in fields(design) if f.init}
        new_fields = {name: _with_changed_servos(value, change, radius) for name, value in old_fields.items()}
        new_fields = {name: value for name, value in new_fields.items() if value is not old_fields[name]}
        return replace(design, **new_fields) if new_fields else design
    return design
