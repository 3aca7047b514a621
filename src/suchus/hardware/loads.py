"""Loads of each servo of a robot: torque, speed, power, current and heat, from simulated walks, stands and swims."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import degrees, nan
from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import Float

from suchus.core.progress import Progress, portion, silent
from suchus.robot.control import Control, OpenLoop, Standing, Swimming
from suchus.robot.design import STANDING, Robot, Servo, check_needs, layout, with_servos
from suchus.robot.design.ground import Ground
from suchus.robot.motion import START, Gait
from suchus.sim.fault import Fault
from suchus.sim.land import Lake, Run, simulate
from suchus.sim.metrics import require_complete, time_window
from suchus.swimming.water import swim_of

AT_LIMIT = 0.02
"""Share of a walk that a servo may spend at its limit [-]; chosen so that the peak of a footfall passes."""
FULL, FULL_WOUND = 0.999, 0.95
"""Part of what a servo can give from which on it counts as being at its limit [-].

With a winding that depends on its speed, and torque and speed of a sample are a physics step apart, which blurs it by
up to 5 %; in walks at the limit hardly a sample lies between 0.5 and 0.9.
"""
STRENGTH_FACTOR = 4.0
"""How many times as strong the servos are whose torques show what a movement asks for [-]."""
_CYCLES, _HOLD = 2, 1.0  # of a gait, and of standing [s]


@dataclass(frozen=True, slots=True, kw_only=True)
class LoadCase:
    """A task of a robot, for which its servos are sized."""

    name: str
    """Its name in tables."""
    gait: Gait
    """The movement."""
    ground: Ground = field(default_factory=Ground)
    """Its ground."""
    faults: tuple[Fault, ...] = ()
    """What is broken."""
    control: Control = field(default_factory=OpenLoop)
    """What turns the gait into servo angles."""
    lake: Lake | None = None
    """Water; None on dry land."""
    seconds: float = 0.0
    """How long after the first second it goes on [s]; 0 for two cycles of the gait."""

    @property
    def end(self) -> float:
        """When it ends [s]."""
        return START + (self.seconds or _CYCLES * self.gait.period)

    def run(self, robot: Robot) -> Run:
        """Return it as a run of a robot."""
        return Run(
            robot=robot,
            gait=self.gait,
            ground=self.ground,
            faults=self.faults,
            control=self.control,
            lake=self.lake,
            label=self.name,
        )

    def slower(self, factor: float) -> "LoadCase":
        """Return it with a longer period of its gait."""
        return replace(self, gait=replace(self.gait, period=factor * self.gait.period), seconds=factor * self.seconds)


def cases(
    robot: Robot,
    gaits: Sequence[Gait],
    *,
    slopes: Sequence[float] = (),
    faults: Sequence[Fault] = (),
    standing: bool = False,
    water: bool = False,
) -> tuple[LoadCase, ...]:
    """Return the load cases of a robot: gaits on level ground, on slopes and with faults, standing up, a swim.

    Args:
        robot: the robot.
        gaits: how it walks.
        slopes: uphill, for each gait [rad].
        faults: one after the other, for each gait.
        standing: whether it stands up, from the first gait.
        water: whether it swims.

    Raises:
        UnsuitedRobot: it cannot stand up, or swim.
    """
    load_cases = [LoadCase(name=gait.name, gait=gait) for gait in gaits]
    for gait in gaits:
        for slope in slopes:
            name = f"{gait.name}, {degrees(slope):.3g} degrees uphill"
            load_cases.append(LoadCase(name=name, gait=gait, ground=Ground(uphill=slope)))
        load_cases += [LoadCase(name=f"{gait.name}, {fault.name}", gait=gait, faults=(fault,)) for fault in faults]
    if standing:
        check_needs(robot, STANDING, "suchus size --standing")
        control = Standing(at=START, hold=_HOLD)
        seconds = control.down_from(robot) - START
        load_cases.append(LoadCase(name="standing up", gait=gaits[0], control=control, seconds=seconds))
    if water:
        swim = swim_of(check_needs(robot, ["axis"], "suchus size --water"))
        load_cases.append(LoadCase(name="swimming", gait=swim, control=Swimming(), lake=Lake(level=robot.length)))
    return tuple(load_cases)


@dataclass(frozen=True, slots=True, kw_only=True)
class ServoLoad:
    """Load of one servo over a walk."""

    torque: float
    """Greatest torque [N m]."""
    limit: float
    """Limit of its torque [N m]."""
    at_limit: float
    """Share of the walk that it spends at the limit, which falls with its speed if it has a winding [-]."""
    first: float
    """Time at which it first reaches its limit, from the beginning of the walk [s]; NaN if it does not."""
    off: float
    """Greatest error against its commanded angle, but for the worst 2 % of the walk [rad]."""
    needed: float
    """98th percentile of the torque of a servo four times as strong in the same walk [N m]."""
    rms: float = 0.0
    """Root of the mean square of its torque, by which it gets warm [N m]."""
    speed: float = 0.0
    """Greatest speed of its shaft [rad/s]."""
    power: float = 0.0
    """Greatest mechanical power that it gives [W]."""
    line: float = 0.0
    """Torque over what it can give at its speed, but for the worst 2 % of the walk [-]."""
    current: float = nan
    """Mean current from the supply [A]; NaN without a winding.

    Heat of the winding and power against its back-EMF over the supply's voltage, as of a drive that chops it; nothing
    is given back. All torque is counted as current, though dry friction of the gear holds a part: an upper bound.
    """
    peak_current: float = nan
    """Greatest current from the supply [A]; NaN without a winding."""
    steady: float = nan
    """Temperature at which it stays if the walk goes on for ever [degC]; NaN where it does not warm up."""
    warm_after: float = nan
    """Time until it reaches its temperature limit [s]; infinite if it never does, NaN where it does not warm up."""
    tension: float = nan
    """Greatest tension of the cable that it pulls [N]; NaN where it pulls none."""
    radius: float = nan
    """Of a linear actuator, the radius over which torque is its force and by which an angle is its travel [m]; NaN of
    a servo that turns."""
    other: str = ""
    """Name of the servo that is sold and does, if that was looked for."""
    other_torque: float = nan
    """Torque of that servo at standstill [N m]."""


def loads(robot: Robot, gait: Gait, *, progress: Progress = silent) -> Mapping[str, ServoLoad]:
    """Return the loads of each servo in two cycles of a walk on level ground.

    Raises:
        Diverged: the simulation diverged.
        OutsideLimits: the joints cannot follow the gait.
    """
    (load_by_servo,) = loads_of_cases(robot, cases(robot, (gait,)), progress=progress)
    return load_by_servo


def loads_of_cases(
    robot: Robot, load_cases: Sequence[LoadCase], *, timestep: float | None = None, progress: Progress = silent
) -> list[Mapping[str, ServoLoad]]:
    """Return the loads of each servo in several cases, with the torque that four times as strong servos would give.

    Args:
        robot: the robot.
        load_cases: what it does.
        timestep: time step of the physics [s]; that of the robot's size if None.
        progress: told the share that is done.

    Raises:
        Diverged: the simulation diverged.
        OutsideLimits: the joints cannot follow a gait.
    """
    pairs = [(body, case) for case in load_cases for body in (cold(robot), with_strong_servos(robot))]
    records = records_of_each(pairs, timestep=timestep, progress=progress)
    return [
        measure_loads(robot, record, strong_record)
        for record, strong_record in zip(records[::2], records[1::2], strict=True)
    ]


def records_of_each(
    pairs: Sequence[tuple[Robot, LoadCase]], *, timestep: float | None = None, progress: Progress = silent
) -> list[xr.Dataset]:
    """Return the record of each case after its first second; cases of equal duration run as a batch.

    Raises:
        Diverged: a simulation diverged.
        OutsideLimits: the joints cannot follow a gait.
    """
    ends = sorted({case.end for _, case in pairs})
    record_by_case: dict[int, xr.Dataset] = {}
    for number, end in enumerate(ends):
        members = [i for i, (_, case) in enumerate(pairs) if case.end == end]
        runs = [pairs[i][1].run(pairs[i][0]) for i in members]
        share = portion(progress, number, len(ends))
        record = require_complete(simulate(runs, duration=end, timestep=timestep, progress=share))
        for i, member in enumerate(members):
            record_by_case[member] = time_window(record.isel(run=i)).assign_attrs(step=record.timestep)
    return [record_by_case[i] for i in range(len(pairs))]


def with_strong_servos(robot: Robot) -> Robot:
    """Return a robot with servos four times as strong at any speed; they show the torque that a movement requires."""
    return with_servos(robot, lambda servo: replace(servo, torque=STRENGTH_FACTOR * servo.torque, winding=None))


def cold(robot: Robot) -> Robot:
    """Return a robot whose servos do not warm up; they hardly do in some seconds, and such robots can share a batch."""

    def cooled(servo: Servo) -> Servo:
        return servo if servo.winding is None else replace(servo, winding=replace(servo.winding, heat=None))

    return with_servos(robot, cooled)


def measure_loads(robot: Robot, walk: xr.Dataset, strong_walk: xr.Dataset | None = None) -> Mapping[str, ServoLoad]:
    """Return the loads of each servo in a record.

    Args:
        robot: robot whose record it is, with its windings.
        walk: the part that counts.
        strong_walk: the same of ``with_strong_servos`` servos; that of the robot itself if None.
    """
    use, elapsed_time = walk.servo_torque_use, walk.time.values - START
    required_torque = (walk if strong_walk is None else strong_walk).servo_peak_torque
    tracking_error = np.abs(walk.servo_target - walk.servo_angle)
    load_by_servo = {}
    for name in layout(robot).servos:
        servo, servo_record = robot.servo(name), walk.sel(servo=name)
        peaks, speed = servo_record.servo_peak_torque.values, servo_record.servo_velocity.values
        mean_square, power = servo_record.servo_mean_square_torque.values, servo_record.servo_power.values
        full = use.sel(servo=name).values >= full_from(servo)
        cables = [cable for cable in robot.cables if cable.name == name]
        load_by_servo[name] = ServoLoad(
            torque=float(peaks.max()),
            limit=servo.torque,
            at_limit=float(full.mean()),
            first=float(elapsed_time[np.argmax(full)]) if full.any() else nan,
            off=float(np.quantile(tracking_error.sel(servo=name), 1.0 - AT_LIMIT)),
            needed=float(np.quantile(required_torque.sel(servo=name), 1.0 - AT_LIMIT)),
            rms=float(np.sqrt(mean_square.mean())),
            speed=float(np.abs(speed).max()),
            power=float(max(power.max(), 0.0)),
            line=float(np.quantile(use.sel(servo=name), 1.0 - AT_LIMIT)),
            tension=float(peaks.max() / cables[0].pulley) if cables else nan,
            radius=cables[0].pulley if cables and cables[0].linear is not None else nan,
        )
        load_by_servo[name] = replace(load_by_servo[name], **_electric(servo, mean_square, power))
    return load_by_servo


def _electric(servo: Servo, mean_square: np.ndarray, power: np.ndarray) -> dict[str, Any]:
    """Return currents and heat of a servo; empty without a winding. Currents are means over control periods.

    Args:
        servo: servo with its winding.
        mean_square: mean square of the torque in each control period, shape (time,) [N2 m2].
        power: mean mechanical power in it, shape (time,) [W].
    """
    winding = servo.winding
    if winding is None:
        return {}
    load_current = winding.stall_current * np.maximum(
        mean_square / servo.torque**2 + power / (servo.torque * servo.ideal_speed), 0.0
    )
    currents = winding.idle_current + load_current
    electric_loads = {"current": float(currents.mean()), "peak_current": float(currents.max())}
    heat = winding.heat
    if heat is None:
        return electric_loads
    loss = winding.volts * winding.stall_current * float(mean_square.mean()) / servo.torque**2
    return {**electric_loads, "steady": heat.steady_temperature(loss), "warm_after": heat.time_to_limit(loss)}


def full_from(servo: Servo) -> float:
    """Return the fraction of a servo's capability above which it counts as being at its limit [-]."""
    return FULL if servo.winding is None else FULL_WOUND


def share_at_limit(robot: Robot, record: xr.Dataset) -> xr.DataArray:
    """Return the fraction of the time that each servo is at its limit [-], over other dimensions of a record.

    Args:
        robot: robot whose record it is.
        record: record of the time that counts, as ``metrics.time_window`` cuts it.
    """
    full = xr.DataArray([full_from(robot.servo(str(name))) for name in record.servo.values], dims="servo")
    return (record.servo_torque_use >= full).mean("time")


def torque_use(servo: Servo, torque: Float[np.ndarray, " time"], speed: Float[np.ndarray, " time"]) -> float:
    """Return torque over the torque that a servo gives at its speed, exceeded in 2 % of the time [-].

    Args:
        servo: another servo than that of the record.
        torque: torque that a movement asks for [N m].
        speed: speed of the shaft [rad/s].
    """
    available_torque = servo.available_torque(np.sign(torque) * speed)
    return float(np.quantile(np.abs(torque) / np.maximum(available_torque, 1e-9), 1.0 - AT_LIMIT))
