"""Parameters of a simulated servo from an identification: inertia, friction, and gains that do not chatter."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from math import atan2, exp, log, pi, sqrt
from types import MappingProxyType

import numpy as np

from suchus.core.checks import require
from suchus.core.errors import InvalidDesign
from suchus.robot.design import Servo
from suchus.robot.motors.identified import IdentifiedServo, identified_servos

MIN_PHASE_MARGIN = pi / 4
"""Least phase margin of a servo's loop [rad]: 45 degrees, the usual margin of textbooks."""
MAX_STEP_ANGLE = 0.5
"""Greatest natural frequency of a loop times the control period [rad]: then it smooths the steps of its goals."""
DAMPING_RATIO = 1.0
"""Damping ratio of a loop without delay [-]: critical, so that the inertia does not ring."""
_DEFAULT_DELAY = 0.005  # [s]; the longest of the identified servos
_HALVINGS = 60  # of the interval in which the greatest stiffness is looked for


@dataclass(frozen=True, slots=True, kw_only=True)
class LoopGains:
    """Gains of a servo's loop, and how far it is from chatter."""

    kp: float
    """Proportional gain [N m/rad]: the stiffness that was wanted, or less."""
    kd: float
    """Derivative gain [N m s/rad]."""
    phase_margin: float
    """Phase margin [rad]."""
    natural_frequency: float
    """Natural frequency of the inertia on the stiffness [rad/s]."""


def phase_margin(inertia: float, damping: float, kp: float, kd: float, delay: float) -> float:
    """Return the phase margin of a loop with a delay on an inertia with viscous friction [rad].

    The open loop is ``(kp + kd s) exp(-delay s) / (s (inertia s + damping))``.

    Args:
        inertia: of rotor and load [kg m2].
        damping: viscous friction [N m s/rad].
        kp: proportional gain [N m/rad].
        kd: derivative gain [N m s/rad].
        delay: [s].
    """
    square = damping**2 - kd**2  # crossover: kp^2 + kd^2 w^2 = w^2 (inertia^2 w^2 + damping^2)
    crossover = sqrt((-square + sqrt(square**2 + 4.0 * inertia**2 * kp**2)) / 2.0) / inertia
    return pi / 2 + atan2(crossover * kd, kp) - atan2(inertia * crossover, damping) - crossover * delay


def loop_gains(
    inertia: float, stiffness: float, *, delay: float, control_period: float, damping: float = 0.0
) -> LoopGains:
    """Return gains that do not chatter: critical damping, and no more stiffness than delay and control period allow.

    The delay of the loop is that of the servo and half of a control period, for which a goal is held on average.

    Args:
        inertia: of rotor and load, seen at the shaft [kg m2].
        stiffness: that is wanted [N m/rad].
        delay: of the servo [s].
        control_period: time between two goals [s].
        damping: viscous friction of the gear [N m s/rad].

    Raises:
        InvalidDesign: a number is out of range.
    """
    require("loop_gains", "inertia", inertia, 1e-9, 100.0, "kg m2")
    require("loop_gains", "stiffness", stiffness, 1e-6, 1e7, "N m/rad")
    require("loop_gains", "delay", delay, 0.0, 1.0, "s")
    require("loop_gains", "control_period", control_period, 1e-5, 1.0, "s")
    require("loop_gains", "damping", damping, 0.0, 1e4, "N m s/rad")

    def gains(kp: float) -> LoopGains:
        """Return the gains of a stiffness."""
        frequency = sqrt(kp / inertia)
        kd = max(2.0 * DAMPING_RATIO * inertia * frequency - damping, 0.0)
        margin = phase_margin(inertia, damping, kp, kd, delay + control_period / 2.0)
        return LoopGains(kp=kp, kd=kd, phase_margin=margin, natural_frequency=frequency)

    def is_calm(kp: float) -> bool:
        """Return whether a stiffness keeps both margins."""
        result = gains(kp)
        return (
            result.phase_margin >= MIN_PHASE_MARGIN
            and result.natural_frequency * control_period <= MAX_STEP_ANGLE * (1.0 + 1e-12)
        )  # fmt: skip

    if is_calm(stiffness):
        return gains(stiffness)
    low, high = log(1e-12 * inertia), log(stiffness)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if is_calm(exp(middle)) else (low, middle)
    return gains(exp(low))


def servo_parameters(
    identified: IdentifiedServo, template: Servo, *, link_inertia: float = 0.0, load: float = 0.0,
    delay: float | None = None, control_period: float = 0.01,
) -> Servo:  # fmt: skip
    """Return a servo with inertia and friction of an identification, and gains that do not chatter.

    MuJoCo takes them as ``armature``, ``frictionloss`` and ``damping`` of the joint and as gains of the actuator. Its
    friction does not follow the load: that of the models m4 and m6 is taken at one load. Torque, speed and winding stay
    those of the template, as its maker says them; the damping of the winding is in their line of torque over speed.

    Args:
        identified: the identification.
        template: servo whose torque, speed, winding and wanted stiffness ``kp`` are taken.
        link_inertia: inertia of what the servo moves [kg m2].
        load: torque at which the friction of its gear is taken [N m].
        delay: of the servo [s]; that of the identification if None, or 5 ms where it has none.
        control_period: time between two goals [s].

    Raises:
        InvalidDesign: the identification lacks numbers of its model of friction, or a number is out of range.
    """
    require("servo_parameters", "link_inertia", link_inertia, 0.0, 100.0, "kg m2")
    require("servo_parameters", "load", load, 0.0, 1e4, "N m")
    friction = identified.friction if load == 0.0 else identified.friction_torque(load, -load, _SLIDING_SPEED)
    if delay is None:
        delay = _DEFAULT_DELAY if identified.delay is None else identified.delay
    gains = loop_gains(
        identified.armature + link_inertia, template.kp, delay=delay, control_period=control_period,
        damping=identified.damping,
    )  # fmt: skip
    return replace(
        template, armature=identified.armature, friction=friction, damping=identified.damping, kp=gains.kp, kd=gains.kd
    )


_SLIDING_SPEED = 1.0
"""Speed at which friction under load is taken [rad/s]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EstimatedNumber:
    """A number of a servo that nobody identified."""

    value: float
    """The number, in SI units."""
    factor: float
    """Factor by which it may be too great or too small, one standard deviation of the identified servos [-]."""


def estimated_parameters(stall_torque: float) -> Mapping[str, EstimatedNumber]:
    """Return inertia, friction and damping of a servo without an identification, from its torque at standstill.

    Each is the torque times the geometric mean of that ratio over the identified servos, one vote a servo, with the
    model m1 of friction. A servo without that model gives its inertia only. The factor is the geometric standard
    deviation of what the rule misses when the servo itself is left out of the mean.

    Args:
        stall_torque: torque at standstill [N m].

    Returns:
        ``armature`` [kg m2], ``friction`` [N m] and ``damping`` [N m s/rad].

    Raises:
        InvalidDesign: the torque is out of range.
    """
    require("estimated_parameters", "stall_torque", stall_torque, 1e-6, 1e5, "N m")
    estimates = {}
    for name, logs in _log_ratios().items():
        errors = [value - np.mean(np.delete(logs, k)) for k, value in enumerate(logs)]
        factor = exp(sqrt(float(np.mean(np.square(errors)))))
        estimates[name] = EstimatedNumber(value=stall_torque * exp(float(np.mean(logs))), factor=factor)
    return MappingProxyType(estimates)


@lru_cache(maxsize=1)
def _log_ratios() -> Mapping[str, np.ndarray]:
    """Return the logarithms of inertia, friction and damping over torque of the identified servos."""
    by_servo: dict[str, list[IdentifiedServo]] = {}
    for servo in identified_servos().values():
        by_servo.setdefault(servo.name.partition(",")[0], []).append(servo)
    chosen = [next((each for each in group if each.model == "m1"), group[0]) for group in by_servo.values()]
    ratios: dict[str, list[float]] = {"armature": [], "friction": [], "damping": []}
    for servo in chosen:
        for name, logs in ratios.items():
            if name == "armature" or servo.model == "m1":
                logs.append(log(getattr(servo, name) / servo.stall_torque))
    if min(map(len, ratios.values())) < 2:
        raise InvalidDesign("fewer than two servos are identified; no rule for the others follows from them.")
    return MappingProxyType({name: np.array(logs) for name, logs in ratios.items()})
