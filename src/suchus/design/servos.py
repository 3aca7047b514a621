"""A whole robot with other servos, wherever its parts hold one."""

from collections.abc import Callable
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeVar

from suchus.design.general import AnyRobot
from suchus.design.robot import Crocodile
from suchus.design.servo import Servo

Kind = TypeVar("Kind", bound=AnyRobot)


def with_leg_servos(robot: AnyRobot, change: Callable[[Servo], Servo]) -> AnyRobot:
    """Return a robot with the servos of its limbs changed."""
    if isinstance(robot, Crocodile):
        front, hind = (replace(leg, servo=change(leg.servo)) for leg in (robot.front_leg, robot.hind_leg))
        return replace(robot, front_leg=front, hind_leg=hind)
    girdles: tuple[Any, ...] = _changed(robot.girdles, change)
    return replace(robot, girdles=girdles)


def with_speed_lines(robot: Kind) -> Kind:
    """Return a robot with ``Servo.with_speed_line`` in each of its servos."""
    return with_servos(robot, Servo.with_speed_line)


def with_servos(robot: Kind, change: Callable[[Servo], Servo]) -> Kind:
    """Return a robot with each of its servos changed."""
    changed: Kind = _changed(robot, change)
    return changed


def _changed(part: Any, change: Callable[[Servo], Servo]) -> Any:
    if isinstance(part, Servo):
        return change(part)
    if isinstance(part, tuple):
        ones = [_changed(one, change) for one in part]
        return tuple(ones) if any(new is not old for new, old in zip(ones, part, strict=True)) else part
    if is_dataclass(part) and not isinstance(part, type):
        found = {f.name: getattr(part, f.name) for f in fields(part) if f.init}
        changed = {name: _changed(value, change) for name, value in found.items()}
        changed = {name: value for name, value in changed.items() if value is not found[name]}
        return replace(part, **changed) if changed else part
    return part
