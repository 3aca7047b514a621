"""Servos whose inertia, friction and electrical constants were identified from motion, and the rule for all others.

The identification is that of BAM, Better Actuator Models (Duclusaud et al., ICRA 2025,
https://github.com/Rhoban/bam). Makers' numbers are those of ``suchus.robot.motors.motors``; neither replaces the other.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

import numpy as np

from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign, UnknownName
from suchus.core.reading import read_toml
from suchus.robot.design import Motor, Servo
from suchus.robot.motors import motors

IDENTIFIED = Path(__file__).with_name("identified.toml")
"""The identified servos."""
_STRIBECK = ("stribeck_friction", "stribeck_speed", "stribeck_exponent")
_LOAD = (
    "motor_load_friction", "external_load_friction", "motor_load_stribeck", "external_load_stribeck",
)  # fmt: skip
_QUADRATIC = ("motor_load_quadratic", "external_load_quadratic")


@dataclass(frozen=True, slots=True, kw_only=True)
class IdentifiedServo:
    """A servo as it was identified from motion; None stands for what its source does not give."""

    name: str
    """Servo, supply and model of friction."""
    motor: str
    """The same servo among those that are sold (``motors``); empty where it is not there."""
    model: Literal["m1", "m4", "m6"]
    """Model of friction: m1 is Coulomb and viscous; m4 adds Stribeck and load; m6 tells motor and load apart."""
    volts: float
    """Supply [V]."""
    torque_constant: float
    """Torque at the output shaft for each ampere [N m/A]."""
    resistance: float
    """Resistance of the winding [Ohm]."""
    armature: float
    """Rotor inertia seen at the output shaft [kg m2]."""
    friction: float
    """Coulomb friction at any speed without load [N m]."""
    damping: float
    """Viscous friction [N m s/rad]; that of the winding comes on top, see ``winding_damping``."""
    stribeck_friction: float | None = None
    """Friction that is added at rest [N m]."""
    stribeck_speed: float | None = None
    """Speed at which a factor of 1/e of it is left [rad/s]."""
    stribeck_exponent: float | None = None
    """Exponent of the speed in its decay [-]."""
    motor_load_friction: float | None = None
    """Friction for each newton metre of the motor [-]."""
    external_load_friction: float | None = None
    """Friction for each newton metre of the load [-]."""
    motor_load_stribeck: float | None = None
    """The same for the motor, added at rest [-]."""
    external_load_stribeck: float | None = None
    """The same for the load, added at rest [-]."""
    motor_load_quadratic: float | None = None
    """Friction for each squared newton metre of the motor, where the load drives it back [1/(N m)]."""
    external_load_quadratic: float | None = None
    """Friction for each squared newton metre of the load, where the motor drives it [1/(N m)]."""
    delay: float | None = None
    """Time from a command to its effect [s]."""
    max_speed: float | None = None
    """Greatest speed that the identification allows [rad/s]."""
    heldout_error: float | None = None
    """Mean absolute error of the angle in recordings that were kept out [rad]."""
    source: str
    """Where the numbers come from."""

    def __post_init__(self) -> None:
        """Refuse numbers that no servo has, and a servo without a source."""
        with Checks(f"identified servo {self.name}", self) as check:
            check.number("volts", 0.1, 1000.0, "V")
            check.number("torque_constant", 1e-6, 1e3, "N m/A")
            check.number("resistance", 1e-3, 1e4, "Ohm")
            check.number("armature", 1e-9, 100.0, "kg m2")
            check.number("friction", 0.0, 1e3, "N m")
            check.number("damping", 0.0, 1e3, "N m s/rad")
            check.choice("model", ("m1", "m4", "m6"))
            check.that(bool(self.source.strip()), "source is empty; say where its numbers come from")
            check.that(not self.motor or self.motor in motors(), f"motor is {self.motor!r}, which is not sold")

    @property
    def stall_torque(self) -> float:
        """Torque at standstill at its supply, friction not taken off [N m]."""
        return self.torque_constant * self.volts / self.resistance

    @property
    def stall_current(self) -> float:
        """Current at standstill at its supply [A]."""
        return self.volts / self.resistance

    @property
    def winding_damping(self) -> float:
        """Damping by the voltage that the turning motor induces [N m s/rad]."""
        return self.torque_constant**2 / self.resistance

    @property
    def missing(self) -> tuple[str, ...]:
        """Numbers of its model of friction that its source does not give."""
        needed = {"m1": (), "m4": (*_STRIBECK, *_LOAD), "m6": (*_STRIBECK, *_LOAD, *_QUADRATIC)}[self.model]
        return tuple(name for name in needed if getattr(self, name) is None)

    def friction_torque(self, motor_torque: float, external_torque: float, speed: float) -> float:
        """Return the greatest torque by which dry friction resists, without the viscous one [N m].

        Args:
            motor_torque: of the motor at the output shaft [N m].
            external_torque: of the load on the shaft [N m].
            speed: of the shaft [rad/s].

        Raises:
            InvalidDesign: numbers of its model are missing.

        Source: BAM, ``Model.compute_frictions``.
        """
        if self.missing:
            raise InvalidDesign(
                f"{self.name} has no {', '.join(self.missing)} in its source: take its model m1, or another servo."
            )
        if self.model == "m1":
            return self.friction
        values: dict[str, Any] = {name: getattr(self, name) or 0.0 for name in (*_STRIBECK, *_LOAD, *_QUADRATIC)}
        at_rest = float(np.exp(-(abs(speed / values["stribeck_speed"]) ** values["stribeck_exponent"])))
        load = abs(external_torque * values["external_load_friction"] - motor_torque * values["motor_load_friction"])
        load_at_rest = abs(
            external_torque * values["external_load_stribeck"] - motor_torque * values["motor_load_stribeck"]
        )
        quadratic = 0.0
        if np.sign(external_torque) != np.sign(motor_torque):
            if abs(external_torque) < abs(motor_torque):
                quadratic = values["external_load_quadratic"] * external_torque**2
            elif abs(external_torque) > abs(motor_torque):
                quadratic = values["motor_load_quadratic"] * motor_torque**2
        return float(self.friction + load + at_rest * (values["stribeck_friction"] + load_at_rest + quadratic))


@lru_cache(maxsize=1)
def identified_servos() -> Mapping[str, IdentifiedServo]:
    """Return the servos that were identified, by name."""
    tables = read_toml(IDENTIFIED)
    return MappingProxyType({name: IdentifiedServo(name=name, **table) for name, table in tables.items()})


def identified_servo(name: str) -> IdentifiedServo:
    """Return a servo that was identified.

    Raises:
        UnknownName: there is none of that name.
    """
    if name not in identified_servos():
        raise UnknownName("identified servo", name, list(identified_servos()))
    return identified_servos()[name]


def identifications_of(motor: Motor | str) -> tuple[IdentifiedServo, ...]:
    """Return the identifications of a servo that is sold; none where nobody identified it."""
    name = motor if isinstance(motor, str) else motor.name
    return tuple(servo for servo in identified_servos().values() if servo.motor == name)


def rule_servo(servo: IdentifiedServo) -> Servo:
    """Return the servo that the rule for unidentified servos gives, from the torque of an identified one.

    The rule is that of ``Servo.from_motor``: inertia, friction and damping in proportion to the torque at standstill.
    """
    speed = servo.max_speed or servo.volts / servo.torque_constant
    return Servo.from_motor(
        Motor(
            name=servo.name, maker="", family="", protocol="pwm", model_number=0, volts=servo.volts,
            volts_range=(0.9 * servo.volts, 1.1 * servo.volts), stall_torque=servo.stall_torque, no_load_speed=speed,
            stall_current=servo.stall_current, idle_current=0.0, continuous_torque=0.2 * servo.stall_torque,
            temperature_limit=70.0, play=0.0, steps=4096, turn=6.283, mass=0.05, size=(0.04, 0.02, 0.04),
            price=(0.0, 0.0),
        )
    )  # fmt: skip


def rule_ratios() -> Mapping[str, tuple[float, float]]:
    """Return inertia and Coulomb friction of each identified servo over those of the rule, by name [-].

    Friction is compared for the model m1 alone, since the others split it; it is NaN for them.
    """
    ratios = {}
    for name, servo in identified_servos().items():
        rule = rule_servo(servo)
        friction_ratio = servo.friction / rule.friction if servo.model == "m1" else float("nan")
        ratios[name] = (servo.armature / rule.armature, friction_ratio)
    return MappingProxyType(ratios)


def identified_table() -> str:
    """Return the identified servos as a table in Markdown, with makers' numbers beside them."""
    head = (
        "| servo, model | inertia [g m2] | Coulomb [mN m] | viscous [mN m s/rad] | delay [ms] | kt [N m/A] | R [Ohm] | "
        "standstill [N m] | maker's standstill [N m] | error, held out [mrad] | inertia over the rule's |"
    )
    lines = [head, "|---|" + "---:|" * 10]
    ratios = rule_ratios()
    for name, servo in identified_servos().items():
        maker = f"{motors()[servo.motor].stall_torque:.2f}" if servo.motor else ""
        cells = [
            f"[{name}]({servo.source.split(',')[0]})", f"{1e3 * servo.armature:.1f}", f"{1e3 * servo.friction:.1f}",
            f"{1e3 * servo.damping:.1f}", "" if servo.delay is None else f"{1e3 * servo.delay:.1f}",
            f"{servo.torque_constant:.3f}", f"{servo.resistance:.2f}", f"{servo.stall_torque:.2f}", maker,
            "" if servo.heldout_error is None else f"{1e3 * servo.heldout_error:.1f}", f"{ratios[name][0]:.1f}",
        ]  # fmt: skip
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)
