"""One set of numbers for every size: what follows from a body's mass and length alone.

With the mass M, the length L and the time T = sqrt(L / g), everything that is neither an angle nor a share scales; the
coefficients are those of the article's robot, for servos before they were bought (``examples/former_caiman.toml``). A
salamander of 3 g and a body of 60 kg then walk alike.
"""

import re
from collections.abc import Iterable
from dataclasses import fields, is_dataclass, replace
from math import floor, log10, sqrt, tau
from typing import Any, TypeVar

from suchus.core.checks import require
from suchus.core.errors import InvalidDesign
from suchus.core.physics import GRAVITY
from suchus.robot.design.body import Robot
from suchus.robot.design.ground import Contact
from suchus.robot.design.hinge import Servo, Spring
from suchus.robot.design.meaning import meanings, unit
from suchus.robot.design.motor import Winding

T = TypeVar("T")
MIN_PERIODS_PER_GRAVITY_TIME = 20.0
"""The control period is at most this part of the gravity time; a tenth already jerks the feet loose [-]."""
PHYSICS_STEPS = 5
"""Physics steps in a control period [-]; the physics step is then a hundredth to a 250th of the gravity time."""
MIN_STEPS_PER_GRAVITY_TIME = 20.0
"""A physics step above this part of the gravity time is refused: a tenth loses a fifth of the stride [-]."""
_POWERS = {
    "kg": (1, 0, 0), "m": (0, 1, 0), "s": (0, 0, 1), "Hz": (0, 0, -1), "rad": (0, 0, 0),
    "N": (1, 1, -2), "J": (1, 2, -2), "W": (1, 2, -3),
    "V": (0, 0, 0), "A": (1, 2, -3), "K": (0, 0, 0),  # scaled motors keep supply and temperature
}  # fmt: skip
_UNIT = re.compile(r"^(kg|rad|Hz|N|J|W|V|A|K|m|s)(\d*)$")


def gravity_time(length: float) -> float:
    """Return the time that gravity needs for a body of a length, sqrt(L / g) [s]."""
    return sqrt(length / GRAVITY)


def control_period(robot: Robot) -> float:
    """Return the control period of a robot: the greatest of 1, 2, 5 times a power of ten below T / 20 [s].

    It is 10 ms for bodies of 0.4 to 1.6 m.
    """
    max_period = gravity_time(robot.length) / MIN_PERIODS_PER_GRAVITY_TIME
    power = floor(log10(max_period))
    digit = max(candidate for candidate in (1, 2, 5) if candidate * 10.0**power <= max_period)
    return round(digit * 10.0**power, 12)


def physics_step(robot: Robot) -> float:
    """Return the time step of the physics of a robot, a fifth of its control period [s]."""
    return control_period(robot) / PHYSICS_STEPS


def coarse_step(robot: Robot) -> float:
    """Return the time step for many runs of a robot, half of its control period [s].

    The article's robot gets as far with it within 0.1 %; see ``MIN_STEPS_PER_GRAVITY_TIME`` for others.
    """
    return control_period(robot) / 2


def check_step(robot: Robot, timestep: float) -> None:
    """Refuse a time step of the physics that is too long for a robot of its size.

    Raises:
        InvalidDesign: it is above a twentieth of the gravity time.
    """
    max_step = gravity_time(robot.length) / MIN_STEPS_PER_GRAVITY_TIME
    if timestep > max_step:
        raise InvalidDesign(
            f"simulate.timestep is {timestep:g} s; robot {robot.name!r} is {robot.length:.3g} m long and needs at most "
            f"{max_step:.2g} s, a twentieth of sqrt(length / g): take {physics_step(robot):g} s, its own."
        )


def servo_for(mass: float, length: float) -> Servo:
    """Return the servo that suits a body of a size, like those of the article's robot.

    Args:
        mass: mass of the whole body [kg].
        length: length of the whole body [m].
    """
    require("servo_for", "mass", mass, 1e-6, 1e5, "kg")
    require("servo_for", "length", length, 1e-3, 100.0, "m")
    torque, time = mass * GRAVITY * length, gravity_time(length)
    return Servo(
        kp=1.17 * torque,
        ki=0.0,
        kd=0.055 * torque * time,
        integral_limit=0.0,
        torque=0.0875 * torque,
        speed=2.24 / time,
        armature=1.4e-3 * mass * length**2,
        friction=8e-4 * torque,
        damping=0.0046 * torque * time,
    )


JOINT_FREQUENCY_RATIO = 8.0
"""Natural frequency of a joint with half of the body and its water behind it, over that of the swim, at which a servo
does not swing with the water [-]."""
JOINT_LAG = 0.04
"""How far a joint of a swimmer is behind its command at the beat [rad]: 1.4 degrees of an amplitude of 33, where motors
of swimming robots follow within 2."""
_WATER = 2.0
"""Inertia of a swimming body together with the water beside it, over its own [-]; a round section has 2."""


def swim_servo_for(mass: float, length: float, beat: float | None = None) -> Servo:
    """Return the servo that holds a limbless body of a size in the water, at whatever phase.

    A servo in proportion to weight, as that of ``servo_for``, resonates with the inertia of body and water near the
    frequency of a swim. Here the stiffness follows from the moved inertia: half of the body and its water,
    ``_WATER m / 2 (L / 2)^2 / 3``, has a natural frequency of ``JOINT_FREQUENCY_RATIO`` times the beat. Damping
    delays a joint by
    ``kd / kp`` times its rate; it follows from ``JOINT_LAG`` and is far below the critical damping of half of the body,
    whose motion the water damps. More damping would not help: on a single segment it decays within a step of explicit
    physics (``model.longest_step``), and a servo at its limit would chatter. Torque and speed limits are never reached;
    the record has the torque that the water demands.

    Args:
        mass: mass of the whole body [kg].
        length: length of the whole body [m].
        beat: frequency of the swim [Hz]; that of a wave as long as the body that runs at 1.5 m/s to the root of its
            length over 1 m (dynamic similarity) if None.
    """
    require("swim_servo_for", "mass", mass, 1e-6, 1e5, "kg")
    require("swim_servo_for", "length", length, 1e-3, 100.0, "m")
    frequency = 1.5 / sqrt(length) if beat is None else beat
    require("swim_servo_for", "beat", frequency, 0.01, 100.0, "Hz")
    inertia, omega = _WATER * mass * length**2 / 24.0, tau * frequency
    stiffness = inertia * (JOINT_FREQUENCY_RATIO * omega) ** 2
    return Servo(
        kp=stiffness,
        ki=0.0,
        kd=JOINT_LAG * stiffness / omega,
        integral_limit=0.0,
        torque=0.5 * stiffness,
        speed=4.0 * omega,
        armature=1.4e-3 * mass * length**2,
        friction=0.0,
        damping=0.02 * inertia * omega,
    )


def spring_for(mass: float, length: float, mass_ratio: float) -> Spring:
    """Return a passive joint whose spring and damper are scaled to the mass and length of a body.

    Args:
        mass: mass of the whole body [kg].
        length: length of the whole body [m].
        mass_ratio: the mass of the segment over that of the heaviest one [-].
    """
    torque = mass * GRAVITY * length
    return Spring(
        stiffness=0.2 * torque * mass_ratio,
        damping=0.02 * torque * gravity_time(length) * mass_ratio,
        armature=2.8e-5 * mass * length**2,
    )


def contact_for(length: float, *, foot_friction: float, skin_friction: float) -> Contact:
    """Return how a body of a size meets the ground.

    Args:
        length: length of the body [m].
        foot_friction: friction coefficient of the feet [-].
        skin_friction: friction coefficient of the skin [-].
    """
    return Contact(
        foot_friction=foot_friction,
        skin_friction=skin_friction,
        time_constant=gravity_time(length) / 16,
        torsion=5e-3 * length,
        rolling=1e-4 * length,
        depth=1e-3 * length,
    )


def rescale(design: T, *, length_factor: float, mass_factor: float | None = None) -> T:
    """Return a robot, a gait or a part in another size: every number by the power of its unit, gravity as it is.

    Times go with the square root of the length. A robot of the article's kind is then one
    that no tables make: what they leave as it is, as a few millimetres of its shells, scales too.

    Args:
        design: a frozen value whose docstrings name the units.
        length_factor: factor on lengths [-].
        mass_factor: factor on masses [-]; the cube of ``length_factor`` if None.

    Raises:
        InvalidDesign: a factor is not positive, or the scaled value cannot be.
    """
    require("scaled", "length_factor", length_factor, 1e-4, 1e4, "")
    mass_scale = length_factor**3 if mass_factor is None else mass_factor
    require("scaled", "mass_factor", mass_scale, 1e-12, 1e12, "")
    return _scaled(design, (mass_scale, length_factor, sqrt(length_factor)))


def rescale_fields(design: Any, names: Iterable[str], *, length_factor: float, mass_factor: float) -> dict[str, Any]:
    """Return some fields of a frozen value in another size, each by the power of its unit.

    Args:
        design: design whose docstrings name the units.
        names: names of the fields.
        length_factor: factor on lengths [-].
        mass_factor: factor on masses [-].
    """
    field_meanings = meanings(type(design))
    resized = {}
    for name in names:
        value = getattr(design, name)
        factor = _factor(unit(field_meanings.get(name, "")), (mass_factor, length_factor, sqrt(length_factor)))
        is_numeric = isinstance(value, float) or (
            _numbers(value) and any(isinstance(component, float) for component in value)
        )
        if is_numeric and factor != 1.0:
            resized[name] = (
                tuple(factor * component for component in value) if isinstance(value, tuple) else factor * value
            )
    return resized


def _scaled(design: Any, factors: tuple[float, float, float]) -> Any:
    """Return a value with every number scaled by its unit.

    Args:
        design: a frozen value, a tuple of such values, or anything else, which stays as it is.
        factors: on mass, length and time [-].
    """
    if isinstance(design, tuple):
        return tuple(_scaled(item, factors) for item in design)
    if not is_dataclass(design):
        return design
    field_meanings = meanings(type(design))
    new_values = {}
    for field in (field for field in fields(design) if field.init):
        value = getattr(design, field.name)
        if is_dataclass(value) or (isinstance(value, tuple) and value and is_dataclass(value[0])):
            new_values[field.name] = _scaled(value, factors)
        elif isinstance(value, float) or _numbers(value):
            factor = _factor(unit(field_meanings.get(field.name, "")), factors)
            if factor != 1.0:
                new_values[field.name] = (
                    tuple(factor * component for component in value) if _numbers(value) else factor * value
                )
    if isinstance(design, Winding) and new_values:
        new_values["motor"] = ""  # no maker sells it in another size
    return replace(design, **new_values)


def _numbers(value: Any) -> bool:
    return isinstance(value, tuple) and bool(value) and all(isinstance(element, (int, float)) for element in value)


def _factor(name: str, factors: tuple[float, float, float]) -> float:
    """Return the factor on numbers of a unit as docstrings write it, ``N m s/rad`` or ``kg m2``; 1 if unknown."""
    factor = 1.0
    numerator, _, denominator = name.partition("/")
    for units, sign in ((numerator, 1), (denominator.strip("()"), -1)):
        for word in units.split():
            unit_match = _UNIT.match(word)
            if unit_match:
                for base_factor, power in zip(factors, _POWERS[unit_match[1]], strict=True):
                    factor *= base_factor ** (sign * power * int(unit_match[2] or 1))
    return factor
