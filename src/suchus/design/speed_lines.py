"""A whole robot whose servos lose torque with speed."""

from dataclasses import fields, is_dataclass, replace
from typing import Any

from suchus.design.robot import Crocodile
from suchus.design.servo import Servo


def with_speed_lines(robot: Crocodile) -> Crocodile:
    """Return a robot with ``Servo.with_speed_line`` in each of its servos, wherever its parts hold one."""
    return _limited(robot)  # type: ignore[no-any-return]


def _limited(part: Any) -> Any:
    if isinstance(part, Servo):
        return part.with_speed_line()
    if isinstance(part, tuple):
        ones = [_limited(one) for one in part]
        return tuple(ones) if any(new is not old for new, old in zip(ones, part, strict=True)) else part
    if is_dataclass(part) and not isinstance(part, type):
        found = {f.name: getattr(part, f.name) for f in fields(part) if f.init}
        changed = {name: _limited(value) for name, value in found.items()}
        changed = {name: value for name, value in changed.items() if value is not found[name]}
        return replace(part, **changed) if changed else part
    return part
