"""Identification of servos from a log: inertia, friction, torque constant, delay and play, with intervals.

The robot waves its limbs while its trunk is held in the air. Then the load of each servo follows from the masses of the
robot's file, and the measured current is linear in what is not known. In a control period the mean torque of a servo is

    ``k I = load + J dw/dt + c sign(w) + b w + constant``,

with the torque constant k, the current I, the reflected inertia J, Coulomb friction c and viscous friction b. Divided
by k it is fitted to the motion. Noise of the motion would bias least squares, so that the same terms of the goals,
which have none, are the instruments (Janot, Vandanjon and Gautier 2014, IEEE Trans. Control Syst. Technol. 22, 132).
The goal acts on the same torque through the servo's loop, from which delay and play follow.

A robot that walks on its feet bears forces that nobody measures. While a foot swings, its limb is free, and if it
swings quickly, the inertia follows with the maker's torque constant (``identify_walking``). Its own torque constant and
friction do not: the load of a swinging limb is small, and its friction has one direction in most of the swing.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from math import pi
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Bool, Float

from suchus.core.errors import IncompatibleRecord
from suchus.hardware.calibrate import FitEstimate
from suchus.hardware.log import foot_centers, hinge_angles
from suchus.hardware.protocols import servo_table
from suchus.robot.design import Robot, layout, servo_ranges
from suchus.robot.motion import START, Curve, Gait, servo_parts
from suchus.robot.motors import motors
from suchus.sim.model.inverse import held_torques
from suchus.visual.skin import poses

MIN_DURATION = 8.0
"""Duration of a log from which servos are identified [s]."""
MAX_UNEXPLAINED = 0.5
"""Greatest root mean square of the current that the motion does not explain, over that of the current [-]."""
MAX_RELATIVE_ERROR = 0.15
"""Greatest half width of the interval of an inertia or torque constant over its value, from which a log is too calm
[-]."""
MODEL_ERROR = 0.02
"""Error of the model beside the scatter, as a fraction of a number: steps of registers, friction within a period
[-]."""
MAX_UNEXPLAINED_SWING = 0.1
"""The same of a swinging limb with the maker's torque constant, beyond which its foot is taken for one that touches the
ground [-]."""
_MIN_SWING_TIME = 2.0  # [s]; turning of a servo in swings, from which its inertia is found
_MIN_LIFT = 0.05  # of the limb's reach; rise of a foot from which it counts as one that swings [-]
_LIFTED = 0.3  # of the rise of a foot, above which it is in the air [-]
_LIFT_MARGIN = 2  # control periods around a swing that do not count [-]
_TRUNK_ACCELERATION = 0.15  # of gravity; acceleration and tilt of a walking trunk, which nobody measures [-]
_SWING_MODEL_ERROR = 0.05  # error of an inertia beside the scatter, of its value [-]
_MIN_SPEED = 0.05  # [rad/s]; below it the direction of the friction is not known
_SMOOTHING = 7  # control periods over which the terms of a fit are averaged [-]
_MIN_MINORITY = 0.05  # of the time that a servo is off to its rarer side, from which play is seen [-]
_MAX_LAG = 30  # control periods up to which a delay is looked for [-]
_INDEPENDENT_SAMPLES = 12  # that a cycle of the motion has, terms being averaged over some control periods [-]
_CORRELATION_LAGS = 50  # control periods over which residuals may be correlated [-]
_Z_95 = 1.96  # standard deviations on either side that hold 95 %


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoIdentification:
    """A servo as a log shows it; each number has the half width of its 95 % interval."""

    torque_constant: FitEstimate
    """Torque at the output shaft for each ampere [N m/A]."""
    armature: FitEstimate
    """Rotor inertia seen at the output shaft [kg m2]."""
    friction: FitEstimate
    """Coulomb friction [N m]."""
    damping: FitEstimate
    """Viscous friction [N m s/rad]."""
    delay: FitEstimate
    """Time from a goal to its torque, the age of the readings included; not a number where it is not seen [s]."""
    play: FitEstimate
    """Play, whole width; not a number for a servo that is off its goal to one side alone [rad]."""
    unexplained: float
    """Root mean square of the current that the motion does not explain, over that of the current [-]."""


_WAVE_PERIOD = 10.0  # [s]; the wave that servos are identified from repeats itself
_SLOW_CYCLES, _QUICK_CYCLES = (5, 6, 7, 8, 9), (12, 14, 16, 18, 20)  # in that period, of its two swings [-]
_SLOW_SWING, _QUICK_SWING = 0.25, 0.08  # amplitudes [rad]
_MAX_SPEED_FRACTION = 0.5  # of a servo's speed, which the wave uses [-]
_GOLDEN = 0.618034  # fractional parts of its multiples spread evenly over 0 to 1 [-]

QUANTITIES: Mapping[str, str] = {
    "torque_constant": "Nm_per_A", "armature": "kgm2", "friction": "Nm", "damping": "Nms_per_rad", "delay": "s",
    "play": "rad",
}  # fmt: skip
"""The numbers of a ``ServoIdentification``, each with its unit as columns of tables write it."""


@dataclass(frozen=True, slots=True)
class _LoggedMotion:
    """Means over the control periods of a log, all arrays of shape (control_period, servo)."""

    current: np.ndarray
    """Current [A]."""
    angle: np.ndarray
    """Angle [rad]."""
    speed: np.ndarray
    """Speed [rad/s]."""
    acceleration: np.ndarray
    """Acceleration [rad/s2]."""
    load: np.ndarray
    """Torque that moves the bodies of the robot [N m]."""
    goal_speed: np.ndarray
    """Speed of the goals, as late as the angles follow them [rad/s]."""
    goal_acceleration: np.ndarray
    """Acceleration of the goals, likewise [rad/s2]."""
    goal_load: np.ndarray
    """Torque that would move the bodies of the robot along the goals [N m]."""
    is_known: np.ndarray
    """Whether all of it was measured."""


def waving_gait(robot: Robot, period: float = _WAVE_PERIOD) -> Gait:
    """Return a movement in which every servo swings with two frequencies, from which ``identify_servos`` finds it.

    Each servo swings by up to 0.33 rad about the nearest angle to zero that leaves room for it, with frequencies and
    phases of its own. Swings are smaller where the range or half of the servo's speed allows less. A crank, which
    turns all round, swings about zero.

    Args:
        robot: the robot that is held by its trunk.
        period: time after which the movement repeats itself [s].
    """
    parts, curves = servo_parts(robot), []
    clock = np.arange(4 * max(_QUICK_CYCLES)) / (4 * max(_QUICK_CYCLES))
    for i, (name, (low, high)) in enumerate(zip(layout(robot).servos, servo_ranges(robot), strict=True)):
        slow, quick = _SLOW_CYCLES[i % 5], _QUICK_CYCLES[(2 * i + i // 5) % 5]
        swing = _SLOW_SWING * np.sin(2 * pi * (slow * clock + i * _GOLDEN))
        swing += _QUICK_SWING * np.sin(2 * pi * (quick * clock + i * _GOLDEN**2))
        max_speed = 2 * pi / period * (slow * _SLOW_SWING + quick * _QUICK_SWING)
        reach = _SLOW_SWING + _QUICK_SWING
        scale = min(1.0, _MAX_SPEED_FRACTION * robot.servo(name).speed / max_speed, 0.5 * (high - low) / reach)
        center = float(np.clip(0.0, low + scale * reach, high - scale * reach))
        angles = tuple(float(round(angle, 6)) for angle in center + scale * swing)
        curves.append(Curve(servo=name, part=parts[name], angles=angles))
    limb_count = len(layout(robot).limbs)
    return Gait(name=f"{robot.name}_wave", period=period, limb_phases=(0.0,) * limb_count, curves=tuple(curves))


def identify_servos(
    record: xr.Dataset, robot: Robot, models: Mapping[str, str] | None = None
) -> tuple[Mapping[str, ServoIdentification], Mapping[str, str]]:
    """Return what a log of a robot that is held in the air shows of its servos.

    Servos of one model share their torque constant, which follows from those that carry a load. Servos that turn no
    hinge of their own, such as those of cables, are left out.

    Args:
        record: log of one drive, with ``servo_current``; goals act after the sample in which they stand.
        robot: the robot, with the masses of its bodies.
        models: model of each servo by its name; one and the same for all where it is None.

    Returns:
        Of each servo its numbers, by its name; and of each that the log does not show a clause that says why.

    Raises:
        IncompatibleRecord: the log has no currents, is too short or too calm, or its currents do not follow from the
            robot's weight and inertia, as of a robot that stands on the ground.
    """
    period = _check_log(record, robot)
    motion = _motion(record, robot, period)
    goals, names = record.servo_target.values, layout(robot).servos
    refusals: dict[str, str] = {}
    balances: dict[str, _Balance] = {}
    for i, name in enumerate(names):
        seconds = _turning_time(motion, i, period)
        if not np.isfinite(motion.load[:, i]).any():
            refusals[name] = "it turns no hinge of its own"
        elif seconds < 0.25 * MIN_DURATION:
            refusals[name] = f"it turned faster than {_MIN_SPEED:g} rad/s for {seconds:.3g} s only"
        else:
            balances[name] = _Balance(motion, i)
    model_of = {name: (models or {}).get(name, "") for name in names}
    constants = {model: _shared_constant(balances, model, model_of) for model in set(model_of.values())}
    identified = {}
    for i, name in enumerate(names):
        constant = constants[model_of[name]]
        if name not in balances:
            continue
        if constant is None or not constant.half < MAX_RELATIVE_ERROR * abs(constant.value):
            refusals[name] = f"the torque constant is {constant or 'not known'} N m/A only"
            continue
        result = balances[name].identify(constant)
        if isinstance(result, str):
            refusals[name] = result
        else:
            loop = _identify_loop(motion, goals[:, i], i, period, constant)
            identified[name] = ServoIdentification(unexplained=balances[name].unexplained, **result, **loop)
    if not identified:
        name, refusal = next(iter(refusals.items()))
        raise IncompatibleRecord(f"the log identifies no servo; of {name}: {refusal}. {_remedy(robot)}")
    return identified, refusals


def identify_walking(
    record: xr.Dataset, robot: Robot, models: Mapping[str, str]
) -> tuple[Mapping[str, ServoIdentification], Mapping[str, str]]:
    """Return what a log of a robot that walks on its feet shows of the servos of its limbs.

    A limb is free while its foot is lifted, which the measured angles say. Then inertia, weight and friction account
    for the current. The inertia is counted with the makers' torque constants. Torque constant, friction and damping are
    not numbers: only a robot that is held in the air shows them.

    Args:
        record: log of one drive, with ``servo_current``; goals act after the sample in which they stand.
        robot: the robot, with the masses of its bodies.
        models: model of each servo by its name.

    Returns:
        Of each servo its numbers, by its name; and of each that the log does not show a clause that says why.

    Raises:
        IncompatibleRecord: the log has no currents, is too short, or no limb swings quickly enough.
        UnknownName: a model whose torque constant is not known.
    """
    record = record.sel(time=slice(START, None))  # before it the robot goes to its first posture, and stands
    period = _check_log(record, robot)
    motion = _motion(record, robot, period)
    swings = _swings(record.servo_angle.values, robot)
    swinging = replace(motion, is_known=motion.is_known & swings)
    names, limb_servos = layout(robot).servos, {i for limb in layout(robot).limbs for i in _places(limb.servos)}
    identified, refusals = {}, {}
    for i, name in enumerate(names):
        seconds = _turning_time(swinging, i, period)
        if i not in limb_servos or not np.isfinite(motion.load[:, i]).any():
            refusals[name] = "it turns no joint of a limb, so that it is never free of the ground"
        elif seconds < _MIN_SWING_TIME:
            refusals[name] = (
                f"it turned faster than {_MIN_SPEED:g} rad/s for {seconds:.3g} s of all swings only, and "
                f"{_MIN_SWING_TIME:g} s are needed"
            )
        else:
            constant = FitEstimate(value=servo_table(models[name]).torque_per_ampere, half=0.0)
            balance = _Balance(swinging, i)
            armature = balance.swing_inertia(constant.value)
            if isinstance(armature, str):
                refusals[name] = armature
            else:
                loop = _identify_loop(motion, record.servo_target.values[:, i], i, period, constant)
                unknown = FitEstimate(value=float("nan"), half=float("inf"))
                identified[name] = ServoIdentification(
                    torque_constant=unknown, armature=armature, friction=unknown, damping=unknown,
                    unexplained=balance.unexplained_with(constant.value), **loop,
                )  # fmt: skip
    if not identified:
        candidates = [name for i, name in enumerate(names) if i in limb_servos] or [*names]
        raise IncompatibleRecord(
            f"the log identifies no servo; of {candidates[0]}: {refusals[candidates[0]]}. Walk for "
            f"{2 * MIN_DURATION:g} s or more in a gait whose feet are lifted and swing within half a second, as "
            f"high_walk. {_remedy(robot)}"
        )
    return identified, refusals


def _places(servos: slice) -> range:
    """Return the places of the servos of a limb."""
    return range(servos.start, servos.stop)


def _swings(angles: Float[np.ndarray, "sample servo"], robot: Robot) -> Bool[np.ndarray, "control_period servo"]:
    """Return in which control periods the foot of each servo's limb is in the air; never for servos of no limb.

    The height of a foot counts from the root of the robot, and from the height of this foot in stance, so that a body
    that is not level changes nothing.

    Args:
        angles: measured angles of the servos [rad].
        robot: the robot.
    """
    count, robot_layout = len(angles), layout(robot)
    filled = np.where(np.isfinite(angles), angles, 0.0)
    level = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
    heights = foot_centers(robot, poses(robot, np.zeros((count, 3)), level, hinge_angles(robot, filled)))[..., 2]
    swings = np.zeros((count - 1, angles.shape[1]), dtype=bool)
    for limb, height in zip(robot_layout.limbs, heights.T, strict=True):
        low, high = np.percentile(height, [5.0, 95.0])
        if high - low < _MIN_LIFT * limb.girdle.limb.reach:
            continue
        is_lifted = height > low + _LIFTED * (high - low)
        window = np.ones(2 * _LIFT_MARGIN + 2)
        is_free = np.convolve(is_lifted, window, mode="full")[_LIFT_MARGIN + 1 :][: count - 1] >= window.size - 0.5
        swings[:, limb.servos] = is_free[:, None]
    return swings


def _turning_time(motion: _LoggedMotion, i: int, period: float) -> float:
    """Return for how long a servo turned and everything of it was measured [s]."""
    return float(_turns(motion, i).sum()) * period


def _turns(motion: _LoggedMotion, i: int) -> Bool[np.ndarray, " control_period"]:
    """Return in which control periods a servo turned and everything of it was measured."""
    is_known = motion.is_known[:, i] & np.isfinite(motion.load[:, i]) & np.isfinite(motion.current[:, i])
    return np.asarray(is_known & (np.abs(motion.speed[:, i]) > _MIN_SPEED))


def _shared_constant(balances: Mapping[str, "_Balance"], model: str, model_of: Mapping[str, str]) -> FitEstimate | None:
    """Return the torque constant of the servos of a model, the weighted mean of what each shows; None without any."""
    estimates = [
        balance.inverse_constant for name, balance in balances.items() if model_of[name] == model and balance.is_free
    ]
    estimates = [estimate for estimate in estimates if estimate.value > 0.0]
    if not estimates:
        return None
    weights = np.array([1.0 / max(estimate.half, 1e-12) ** 2 for estimate in estimates])
    mean = float(weights @ [estimate.value for estimate in estimates] / weights.sum())
    return _widened(_inverse(mean, float(weights.sum() ** -0.5)))


def _check_log(record: xr.Dataset, robot: Robot) -> float:
    """Refuse a log that is too short or lacks currents; return its control period [s]."""
    if "servo_current" not in record or not np.isfinite(record.servo_current).any():
        raise IncompatibleRecord(
            "the log holds no servo_current, without which no torque constant can be found; drive servos that tell "
            "their current, as Dynamixel X and Feetech STS do."
        )
    duration = float(record.time[-1] - record.time[0]) if record.sizes["time"] > 1 else 0.0
    if duration < MIN_DURATION:
        raise IncompatibleRecord(
            f"the log lasts {duration:.3g} s; {MIN_DURATION:g} s at least are needed to tell inertia from friction. "
            f"{_remedy(robot)}"
        )
    if tuple(map(str, record.servo.values)) != layout(robot).servos:
        raise IncompatibleRecord(f"the log has other servos than robot {robot.name!r}; name the robot that was driven.")
    return float(np.median(np.diff(record.time.values)))


def _remedy(robot: Robot) -> str:
    """Return a sentence that says with what motion servos can be identified."""
    return (
        f"Hold {robot.name} by its trunk in the air, and drive a gait for {2 * MIN_DURATION:g} s or more in which "
        "joints swing by 0.3 rad or more with periods of about one second."
    )


def _motion(record: xr.Dataset, robot: Robot, period: float) -> _LoggedMotion:
    """Return means over the control periods of a log.

    The mean speed of a period follows from its two angles, its mean acceleration from the two speeds that servos tell.
    """
    angles, speeds = record.servo_angle.values, record.servo_velocity.values
    angle, speed = 0.5 * (angles[1:] + angles[:-1]), np.diff(angles, axis=0) / period
    acceleration = np.diff(speeds, axis=0) / period
    is_known = np.isfinite(angle) & np.isfinite(speed) & np.isfinite(acceleration)
    if "servo_heard" in record:
        heard = record.servo_heard.values > 0
        is_known &= heard[1:] & heard[:-1]
    load = _load(robot, *(np.where(is_known, values, 0.0) for values in (angle, speed, acceleration)))
    goal = np.where(np.isfinite(record.servo_target.values), record.servo_target.values, 0.0)
    goal = _followed(_moving_mean(goal, np.ones(len(goal), dtype=bool)), angles)
    goal_speed = np.gradient(goal, period, axis=0)
    goal_acceleration = np.gradient(goal_speed, period, axis=0)
    instruments = tuple(0.5 * (values[1:] + values[:-1]) for values in (goal, goal_speed, goal_acceleration))
    return _LoggedMotion(
        current=record.servo_current.values[1:], angle=angle, speed=speed, acceleration=acceleration, load=load,
        goal_speed=instruments[1], goal_acceleration=instruments[2], goal_load=_load(robot, *instruments),
        is_known=is_known,
    )  # fmt: skip


def _load(robot: Robot, angle: np.ndarray, speed: np.ndarray, acceleration: np.ndarray) -> np.ndarray:
    """Return the torques that move the bodies of a robot along a motion of its servos [N m].

    The torques have the shape (control_period, servo).
    """
    return held_torques(
        robot, hinge_angles(robot, angle), _hinge_rates(robot, speed), _hinge_rates(robot, acceleration)
    )


def _followed(goal: Float[np.ndarray, "sample servo"], angles: Float[np.ndarray, "sample servo"]) -> np.ndarray:
    """Return the goals of each servo as late, in whole control periods, as its angle follows them best."""
    late_goal = goal.copy()
    for i in range(goal.shape[1]):
        is_known = np.isfinite(angles[:, i])
        misfits = []
        for lag in range(_MAX_LAG):
            late = np.concatenate([np.full(lag, goal[0, i]), goal[: len(goal) - lag, i]])
            misfits.append(float(np.std((late - angles[:, i])[is_known])) if is_known.any() else 0.0)
        lag = int(np.argmin(misfits))
        late_goal[lag:, i] = goal[: len(goal) - lag, i]
        late_goal[:lag, i] = goal[0, i]
    return late_goal


def _hinge_rates(robot: Robot, rates: Float[np.ndarray, "sample servo"]) -> Float[np.ndarray, "sample hinge"]:
    """Return rates of all hinges from those of servos; hinges without a servo of their own are taken as at rest."""
    robot_layout = layout(robot)
    hinge_rates = np.zeros((len(rates), len(robot_layout.hinges)))
    for servo, hinge in enumerate(robot_layout.servo_hinges):
        if hinge >= 0:
            hinge_rates[:, hinge] = rates[:, servo]
    return hinge_rates


class _Balance:
    """The balance of torques of one servo over a log.

    Args:
        motion: means over control periods.
        i: place of the servo.
    """

    def __init__(self, motion: _LoggedMotion, i: int) -> None:
        """Fit the current by the motion, the torque constant being unknown."""
        speed, goal_speed = motion.speed[:, i], motion.goal_speed[:, i]
        self.current, self.load = motion.current[:, i], motion.load[:, i]
        constant = np.ones_like(speed)
        self._terms = np.column_stack([motion.acceleration[:, i], np.sign(speed), speed, constant])
        self._instruments = np.column_stack([motion.goal_acceleration[:, i], np.sign(goal_speed), goal_speed, constant])
        self.is_used = _turns(motion, i)
        self._goal_load = motion.goal_load[:, i]
        self._joint_fit = self._fit(
            np.column_stack([self.load, self._terms]), self.current,
            np.column_stack([self._goal_load, self._instruments]),
        )  # fmt: skip

    def _fit(self, terms: np.ndarray, values: np.ndarray, instruments: np.ndarray) -> "_Fit":
        """Return the fit of a series by terms, all averaged over some control periods."""
        smooth_terms, smooth_instruments = (_moving_mean(columns, self.is_used) for columns in (terms, instruments))
        return _Fit(smooth_terms, _moving_mean(values[:, None], self.is_used)[:, 0], self.is_used, smooth_instruments)

    @property
    def unexplained(self) -> float:
        """Root mean square of the current that the motion does not explain, over that of the current [-]."""
        return float(self._joint_fit.residual.std() / max(float(self.current[self.is_used].std()), 1e-12))

    def unexplained_with(self, torque_constant: float) -> float:
        """Return the same with a known torque constant [N m/A]."""
        torque = torque_constant * self.current - self.load
        fit = self._fit(self._terms, torque, self._instruments)
        return float(fit.residual.std() / max(float(torque[self.is_used].std()), 1e-12))

    def swing_inertia(self, torque_constant: float) -> FitEstimate | str:
        """Return the inertia of a limb that swings below a walking trunk [kg m2], or a clause that says why not.

        To the scatter comes the torque by which tilt and acceleration of the trunk change the load.

        Args:
            torque_constant: torque constant of the maker [N m/A].
        """
        unexplained = self.unexplained_with(torque_constant)
        if unexplained > MAX_UNEXPLAINED_SWING:
            return (
                f"{unexplained:.0%} of its current in the swings does not follow from weight, inertia and friction, as "
                "if its foot touched the ground"
            )
        torque = torque_constant * self.current - self.load
        fit = self._fit(self._terms, torque, self._instruments)
        columns = _moving_mean(self._terms, self.is_used)[self.is_used]
        unmeasured = (_TRUNK_ACCELERATION * float(np.sqrt((self.load[self.is_used] ** 2).mean()))) ** 2
        variance = unmeasured / _INDEPENDENT_SAMPLES * np.linalg.pinv(columns.T @ columns / len(columns))[0, 0]
        half = np.sqrt(fit.half(0) ** 2 + _Z_95**2 * variance + (_SWING_MODEL_ERROR * fit.value(0)) ** 2)
        armature = FitEstimate(value=fit.value(0), half=float(half))
        if not armature.half < MAX_RELATIVE_ERROR * abs(armature.value):
            return f"its inertia is {armature} kg m2 only: it swings too calmly to tell it from friction"
        return armature

    @property
    def is_free(self) -> bool:
        """Whether the current follows from weight and inertia, as of a limb that touches nothing."""
        return self.unexplained < MAX_UNEXPLAINED

    @property
    def inverse_constant(self) -> FitEstimate:
        """One over the torque constant, as this servo alone shows it [A/(N m)]."""
        return FitEstimate(value=self._joint_fit.value(0), half=self._joint_fit.half(0))

    def identify(self, torque_constant: FitEstimate) -> dict[str, FitEstimate] | str:
        """Return the numbers of the balance with a known torque constant, or a clause that says why there are none."""
        if not self.is_free:
            return (
                f"{self.unexplained:.0%} of its current does not follow from the weight and inertia of the robot, as "
                "if the robot stood on the ground or pushed against something"
            )
        low, mean, high = (
            self._fit(self._terms, constant * self.current - self.load, self._instruments)
            for constant in (
                torque_constant.value - torque_constant.half, torque_constant.value,
                torque_constant.value + torque_constant.half,
            )
        )  # fmt: skip
        names = ("armature", "friction", "damping")
        estimates = {
            name: FitEstimate(
                value=mean.value(k), half=float(np.hypot(mean.half(k), 0.5 * (high.value(k) - low.value(k))))
            )
            for k, name in enumerate(names)
        }
        armature = estimates["armature"]
        if not armature.half < MAX_RELATIVE_ERROR * abs(armature.value):
            return f"its inertia is {armature} kg m2 only: the motion is too calm to tell it from friction"
        return {**estimates, "torque_constant": torque_constant}


def _moving_mean(
    values: Float[np.ndarray, "control_period term"], is_used: Bool[np.ndarray, " control_period"]
) -> np.ndarray:
    """Return the mean of the used rows within ``_SMOOTHING`` control periods around each row.

    The mean averages out the registers' steps.
    """
    weights = np.convolve(is_used, np.ones(_SMOOTHING), mode="same")
    filled = np.where(is_used[:, None], values, 0.0)
    sums = np.apply_along_axis(np.convolve, 0, filled, np.ones(_SMOOTHING), "same")
    return np.asarray(sums / np.maximum(weights, 1.0)[:, None])


def _identify_loop(
    motion: _LoggedMotion, goal: Float[np.ndarray, " sample"], i: int, period: float, torque_constant: FitEstimate
) -> dict[str, FitEstimate]:
    """Return delay and play of servo i; not numbers where the motion does not show them.

    A delay of whole control periods and a fraction of one mixes two goals one after the other, exactly so in the mean
    over a period. The angle by which a servo is off its late goal is its torque over its stiffness, half of its play to
    the side on which it is off, and a part for its damping. This is fitted for each number of whole periods, and the
    best is taken. Within its play a servo has no torque, and says nothing. A play that is not seen is left out of the
    fit of the delay.

    Args:
        motion: means over control periods.
        goal: what the servo was sent [rad].
        i: place of the servo.
        period: control period [s].
        torque_constant: of the servo [N m/A].
    """
    torque, angle = torque_constant.value * motion.current[:, i], motion.angle[:, i]
    lag, fit, minority = _late_fit(motion.is_known[:, i], goal, angle, torque, motion.speed[:, i], has_play=True)
    play = FitEstimate(value=2.0 * fit.value(3), half=2.0 * fit.half(3) + _STEP)
    if minority < _MIN_MINORITY or not fit.value(1) > 0.0:
        play = FitEstimate(value=float("nan"), half=float("inf"))
    if not play.value > play.half:
        lag, fit, _ = _late_fit(motion.is_known[:, i], goal, angle, torque, motion.speed[:, i], has_play=False)
    delay = FitEstimate(value=(lag + fit.value(0)) * period, half=(fit.half(0) + _DELAY_ERROR) * period)
    if not fit.value(1) > 0.0 or not delay.half < _MAX_LAG * period:
        delay = FitEstimate(value=float("nan"), half=float("inf"))
    return {"delay": delay, "play": play}


def _late_fit(
    is_known: Bool[np.ndarray, " control_period"], goal: np.ndarray, angle: np.ndarray, torque: np.ndarray,
    speed: np.ndarray,
    *, has_play: bool,
) -> tuple[int, "_Fit", float]:  # fmt: skip
    """Return the best number of whole control periods of delay, its fit, and how much time is on the rarer side [-].

    Args:
        is_known: whether each period was measured.
        goal: what the servo was sent, shape (sample,) [rad].
        angle: mean angle of each period [rad].
        torque: mean torque [N m].
        speed: mean speed [rad/s].
        has_play: whether play is fitted.
    """
    fits = []
    for lag in range(_MAX_LAG):
        late, later = (np.concatenate([np.full(k, np.nan), goal[:-1]])[: len(angle)] for k in (lag, lag + 1))
        side = np.sign(late - angle)
        terms = np.column_stack([late - later, torque, speed, *([side] if has_play else []), np.ones_like(torque)])
        is_used = is_known & np.isfinite(terms).all(axis=1) & (torque != 0.0)
        is_used[: _MAX_LAG + 1] = False
        fit = _Fit(_moving_mean(terms, is_used), _moving_mean((late - angle)[:, None], is_used)[:, 0], is_used)
        minority = float(np.mean(side[is_used] > 0.0)) if is_used.any() else 0.0
        fits.append((float((fit.residual**2).mean()) if is_used.any() else np.inf, lag, fit, minority))
    _, lag, fit, minority = min(fits, key=lambda entry: entry[0])
    return lag, fit, min(minority, 1.0 - minority)


_DELAY_ERROR = 0.2
"""Error of a delay beside the scatter [control period]."""
_STEP = 2 * pi / 4096
"""Step of the angles of servos with 4096 steps a turn [rad]."""


class _Fit:
    """A linear fit, with a covariance that holds where residuals are correlated in time (Newey and West 1987).

    To it comes what the model leaves out. That repeats with every cycle of the motion, so that it counts as a scatter
    of ``_INDEPENDENT_SAMPLES``, however long the log is.

    Args:
        terms: shape (control_period, term).
        values: shape (control_period,).
        is_used: periods that count, shape (control_period,).
        instruments: terms without noise in the place of the others, shape (control_period, term); None for least
            squares.
    """

    def __init__(
        self, terms: np.ndarray, values: np.ndarray, is_used: Bool[np.ndarray, " control_period"],
        instruments: np.ndarray | None = None,
    ) -> None:  # fmt: skip
        scale = np.maximum(np.abs(terms[is_used]).max(axis=0), 1e-300)
        columns = np.where(is_used[:, None], terms / scale, 0.0)
        rows = columns if instruments is None else np.where(is_used[:, None], instruments / scale, 0.0)
        values = np.where(is_used, values, 0.0)
        inverse = np.linalg.pinv(rows.T @ columns)
        self.coefficients = inverse @ (rows.T @ values)
        residual = values - columns @ self.coefficients
        self.residual = residual[is_used]
        scores = rows * residual[:, None]
        meat = scores.T @ scores
        for lag in range(1, _CORRELATION_LAGS + 1):
            product = scores[lag:].T @ scores[:-lag]
            meat += (1.0 - lag / (_CORRELATION_LAGS + 1)) * (product + product.T)
        systematic = (
            float((self.residual**2).mean())
            / _INDEPENDENT_SAMPLES
            * np.linalg.pinv(columns.T @ columns / max(int(is_used.sum()), 1))
        )
        self.covariance = (inverse @ meat @ inverse.T + systematic) / np.outer(scale, scale)
        self.coefficients = self.coefficients / scale

    def value(self, number: int) -> float:
        """Return a coefficient."""
        return float(self.coefficients[number])

    def half(self, number: int) -> float:
        """Return the half width of the interval of a coefficient."""
        return _Z_95 * float(np.sqrt(max(self.covariance[number, number], 0.0)))


def _inverse(value: float, half: float) -> FitEstimate:
    """Return one over a number, by the delta method."""
    return FitEstimate(value=1.0 / value, half=half / value**2)


def _widened(estimate: FitEstimate) -> FitEstimate:
    """Return an estimate whose interval holds the error of the model, too."""
    return FitEstimate(value=estimate.value, half=float(np.hypot(estimate.half, MODEL_ERROR * estimate.value)))


def identification_table(identified: Mapping[str, ServoIdentification]) -> str:
    """Return identified servos as CSV: each number, and half of the width of its interval."""
    head = ",".join(f"{name}_{unit},{name}_half" for name, unit in QUANTITIES.items())
    rows = [
        ",".join(
            [
                name,
                *(f"{estimate.value:.6g},{estimate.half:.3g}" for estimate in _estimates(servo).values()),
                f"{servo.unexplained:.3g}",
            ]
        )
        for name, servo in identified.items()
    ]
    return "\n".join([f"servo,{head},unexplained", *rows]) + "\n"


def _estimates(servo: ServoIdentification) -> dict[str, FitEstimate]:
    return {field.name: getattr(servo, field.name) for field in fields(servo) if field.name in QUANTITIES}


def bam_parameters(servo: ServoIdentification, motor_name: str) -> str:
    """Return a servo as JSON of the project Better Actuator Models, with its model m1 of friction.

    Args:
        servo: the servo as it was identified.
        motor_name: name of the servo as it is sold; one that suchus does not know gives no resistance.

    Source: ``bam/params`` of https://github.com/Rhoban/bam: kt [N m/A], R [Ohm], armature [kg m2], friction_base [N m],
    friction_viscous [N m s/rad], q_offset [rad].
    """
    motor = motors().get(motor_name)
    parameters: dict[str, Any] = {"kt": servo.torque_constant.value}
    if motor is not None:
        parameters["R"] = motor.volts / motor.stall_current
    parameters |= {
        "armature": servo.armature.value,
        "q_offset": 0.0,
        "friction_base": max(servo.friction.value, 0.0),
        "friction_viscous": max(servo.damping.value, 0.0),
        "model": "m1",
        "actuator": motor_name.lower(),
    }
    return json.dumps(parameters, indent=2) + "\n"
