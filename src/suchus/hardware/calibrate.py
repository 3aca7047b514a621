"""Calibration of a robot that was built: joints of servos, zeros, stiffness and friction."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import radians

import numpy as np
import xarray as xr

from suchus.core.errors import BusFailure, IncompatibleRecord, InvalidDesign
from suchus.hardware.bus import Wiring
from suchus.hardware.drive import TickClock
from suchus.hardware.rig import Rig

NUDGE = radians(5.0)
"""Angle by which a servo is moved so that people see which one it is [rad]."""
_PACE = radians(20.0)  # [rad/s]; how fast
_READINGS = 10  # of each servo in a known posture; their median counts
_MIN_SAMPLES = 50  # samples from which a servo is judged
_Z_95 = 1.96  # standard deviations on either side that hold 95 %

Answer = Callable[[int, int], tuple[str, int]]
"""Asked with bus and number of the servo that has just moved to more steps: the joint that moved, and 1 where in its
positive sense, -1 where not."""


def find_wiring(rig: Rig, clock: TickClock, answer: Answer) -> Wiring:
    """Move each servo alone, forward and back, and return the wiring by the joint that moved.

    All other servos have no torque meanwhile. In the end no servo has torque.

    Args:
        rig: the open robot, wired as is believed; its names are not.
        clock: of its ticks.
        answer: says what moved; it is asked while the servo holds.

    Raises:
        BusFailure: a servo does not answer.
        InvalidDesign: a joint was named twice.
    """
    rig.check()
    clock.begin()
    tick, servo_by_joint = 0, {}
    rig.torque(False)
    try:
        for i, servo in enumerate(rig.servos):
            if not rig.asked[i]:
                servo_by_joint[servo.name] = servo
                continue
            rig.read()
            if not rig.now.heard[i]:
                rig.read()
            start_angle = rig.now.angle[i]
            if not np.isfinite(start_angle):
                raise BusFailure(f"number {servo.id} on bus {servo.bus} does not say where it is.")
            steps = int(rig.steps.of(rig.now.angle)[i])
            rig.surely("goal_position", {i: steps})
            rig.surely("torque_limit", {i: servo.table.full})
            rig.surely("torque_enable", {i: 1})
            nudge_steps = round(NUDGE / servo.table.step)
            count = max(1, round(NUDGE / _PACE / rig.period))
            trajectory = [steps + round(nudge_steps * (k + 1) / count) for k in range(count)]
            tick = _move_through(rig, clock, tick, i, [*trajectory, *count * [trajectory[-1]]])
            name, sign = answer(servo.bus, servo.id)
            tick = _move_through(rig, clock, tick, i, [*trajectory[::-1], steps])
            rig.surely("torque_enable", {i: 0})
            if name in servo_by_joint:
                raise InvalidDesign(
                    f"{name} was said to have moved with number {servo_by_joint[name].id} and with number "
                    f"{servo.id}; each joint has one servo: begin again, and look which one it is."
                )
            believed_servo = next((candidate for candidate in rig.servos if candidate.name == name), None)
            if believed_servo is None:
                raise InvalidDesign(f"{name} is no servo of {rig.robot.name!r}; there is {', '.join(rig.names)}.")
            servo_by_joint[name] = replace(
                servo, name=name, sign=sign, low=believed_servo.low, high=believed_servo.high
            )
    finally:
        for _ in range(3):
            rig.torque(False)
    return replace(rig.wiring, servo=tuple(servo_by_joint[name] for name in rig.names))


def _move_through(rig: Rig, clock: TickClock, tick: int, i: int, steps: list[int]) -> int:
    """Send a servo through positions, one for each tick, and return the number of the next tick."""
    for step in steps:
        rig.write("goal_position", {i: step})
        tick = max(clock.wait(tick + 1), tick + 1)
        rig.read()
    return tick


def find_zeros(rig: Rig, posture: np.ndarray) -> tuple[Wiring, np.ndarray]:
    """Return the wiring with new zeros, and the change of each zero [rad]: the robot is limp in a known posture.

    Args:
        rig: the open robot, which somebody holds in a posture.
        posture: posture that it is held in, shape (servo,) [rad].

    Raises:
        BusFailure: a servo does not answer.
    """
    rig.check()
    for _ in range(3):
        rig.torque(False)
    samples = []
    for _ in range(_READINGS):
        rig.read()
        samples.append(np.where(rig.now.heard, rig.now.angle, np.nan))
    has_answered = np.isfinite(samples).any(axis=0) | ~rig.asked
    if not has_answered.all():
        silent = [name for name, is_heard in zip(rig.names, has_answered, strict=True) if not is_heard]
        raise BusFailure(f"{' and '.join(silent[:4])} does not say where it is.")
    angles = np.where(rig.asked, np.nanmedian(np.where(rig.asked, samples, 0.0), axis=0), posture)
    zero_errors = angles - posture
    servo = tuple(
        replace(servo_place, zero=servo_place.zero + servo_place.sign * round(zero_errors[i] / servo_place.table.step))
        for i, servo_place in enumerate(rig.servos)
    )
    return replace(rig.wiring, servo=servo), zero_errors


@dataclass(frozen=True, slots=True, kw_only=True)
class FitEstimate:
    """A parameter of a servo with the half width of its 95 % interval."""

    value: float
    """The number."""
    half: float
    """Half of the width of its interval."""

    def __str__(self) -> str:
        return f"{self.value:.4g} +- {self.half:.2g}"


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoFit:
    """Parameters of one servo from a log."""

    stiffness: FitEstimate
    """Torque for each radian that it is off its goal [N m/rad]."""
    damping: FitEstimate
    """Torque against each radian per second [N m s/rad]."""
    play: FitEstimate
    """Way that it goes without a torque, whole width [rad]."""
    friction: FitEstimate
    """Torque that turns with the sense of its motion, against gravity, inertia and viscous friction [N m]."""
    offset: FitEstimate
    """Angle by which its zero is off [rad]."""


def fit_log(record: xr.Dataset) -> Mapping[str, ServoFit]:
    """Return the parameters of each servo that a log shows, by least squares; servos that hardly moved are left out.

    The error of a servo is its torque over its stiffness, plus half of its play in the sense of the torque, plus a term
    for damping. The error is linear in all of these parameters. The friction is the part of the torque that changes its
    sign with the speed, besides a constant and parts in proportion to angle, speed and acceleration.

    Move the joints to and fro, one at a time and without load: other motions blur the friction. Torques are computed
    from currents, and are as accurate as those.

    Args:
        record: record of one run; its goals act after the sample in which they stand.

    Raises:
        IncompatibleRecord: it holds no torques, or fewer samples than a fit needs.
    """
    goal, angle = record.servo_target.values[:-1], record.servo_angle.values[1:]
    speed, torque = record.servo_velocity.values[1:], record.servo_torque.values[1:]
    if len(goal) < _MIN_SAMPLES or not np.isfinite(torque).any():
        raise IncompatibleRecord(
            f"a log of {len(goal)} samples {'with' if np.isfinite(torque).any() else 'without'} torques tells "
            "nothing of "
            f"the servos; {_MIN_SAMPLES} samples with torques at least are needed."
        )
    period = float(np.median(np.diff(record.time.values)))
    fits = {}
    for i, name in enumerate(record.servo.values):
        is_valid = np.isfinite(goal[:, i] + angle[:, i] + speed[:, i] + torque[:, i])
        if "servo_heard" in record:
            is_valid &= record.servo_heard.values[1:, i] > 0
        goal_error, t, w, a = (series[is_valid, i] for series in (goal - angle, torque, speed, angle))
        if len(goal_error) < _MIN_SAMPLES or np.ptp(t) < 1e-6 or np.ptp(a) < 1e-4:
            continue
        constant = np.ones_like(goal_error)
        compliance, halves = _least_squares(np.column_stack([t, w, np.sign(t), constant]), goal_error)
        if not compliance[0] > 0.0:
            continue
        faster = np.gradient(w, period)
        friction_fit, friction_halves = _least_squares(np.column_stack([constant, a, faster, w, np.tanh(w / 0.02)]), t)
        stiffness = 1.0 / compliance[0]
        fits[str(name)] = ServoFit(
            stiffness=FitEstimate(value=stiffness, half=halves[0] * stiffness**2),
            damping=FitEstimate(value=compliance[1] * stiffness, half=halves[1] * stiffness),
            play=FitEstimate(value=2.0 * compliance[2], half=2.0 * halves[2]),
            friction=FitEstimate(value=friction_fit[4], half=friction_halves[4]),
            offset=FitEstimate(value=compliance[3], half=halves[3]),
        )
    if not fits:
        raise IncompatibleRecord("no servo of the log moved and gave a torque: drive a gait, and fit that log.")
    return fits


def _least_squares(columns: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return coefficients and half widths of their 95 % intervals, with the correlation of residuals in time.

    Args:
        columns: shape (sample, coefficient).
        values: shape (sample,).
    """
    coefficients, *_ = np.linalg.lstsq(columns, values, rcond=None)
    residual = values - columns @ coefficients
    count = max(len(values) - columns.shape[1], 1)
    autocorrelation = (
        float(np.clip(np.corrcoef(residual[:-1], residual[1:])[0, 1], 0.0, 0.99)) if residual.std() > 0.0 else 0.0
    )
    spread = residual.var() * len(values) / count * (1.0 + autocorrelation) / (1.0 - autocorrelation)
    half: np.ndarray = _Z_95 * np.sqrt(np.diag(spread * np.linalg.pinv(columns.T @ columns)))
    return coefficients, half


def fits_text(fits: Mapping[str, ServoFit]) -> str:
    """Return fits as a table: for each servo each number, and half of the width of its interval."""
    names = ("stiffness", "damping", "play", "friction", "offset")
    units = ("Nm_per_rad", "Nms_per_rad", "rad", "Nm", "rad")
    head = ",".join(f"{name}_{unit},{name}_half" for name, unit in zip(names, units, strict=True))
    rows = [
        ",".join(
            [name, *(f"{getattr(fit, quantity).value:.6g},{getattr(fit, quantity).half:.3g}" for quantity in names)]
        )
        for name, fit in fits.items()
    ]
    return "\n".join([f"servo,{head}", *rows]) + "\n"
