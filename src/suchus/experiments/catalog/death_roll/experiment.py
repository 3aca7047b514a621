"""How fast does it roll about its long axis, and with what?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import pi, radians
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.core.checks import Checks
from suchus.core.progress import portion
from suchus.experiments.catalog.death_roll.figure import draw_cost, draw_rates, draw_roll, servo_groups
from suchus.experiments.experiment import (
    Experiment,
    Measure,
    Measures,
    Outcome,
    Progress,
    SimulationResult,
    silent,
    staged,
)
from suchus.robot.control import OpenLoop
from suchus.robot.design import Robot
from suchus.robot.motion import Gait, roll
from suchus.robot.robots import ROBOTS
from suchus.sim.land import VACUUM, WATER, Afloat, Run, simulate
from suchus.sim.metrics import mean_effort, peak_torque, require_complete, roll_rate, time_window
from suchus.sim.model import longest_step

_STIFFNESS_TOLERANCE = 1.25  # [-]; stiffness ratio from which the time steps are shortened
_MEDIA = ("vacuum", "water")
_ARMS = ("trunk", "tail", "c_shape", "s_shape", "lateral_only", "vertical_only", "reversed")


@dataclass(frozen=True, slots=True, kw_only=True)
class DeathRoll(Experiment):
    """The crocodile's roll from rest, without ground and gravity, with the limbs folded back.

    A bend that goes around the body once a cycle turns the body in the opposite sense. In vacuum no external moment
    acts, so the angular momentum must stay zero while the body turns. In water MuJoCo's ellipsoid drag acts, which
    models no wake and only part of the added mass. The rate is the rotation about the mean long axis over whole
    cycles, after a first cycle in which the bends grow.
    """

    title = "How fast does it roll about its long axis, and with what?"
    shows = "The roll that section I names; beyond the article"
    answers = (
        "rate_trunk_vacuum",
        "rate_tail_vacuum",
        "rate_c_shape_vacuum",
        "rate_c_shape_water",
        "power_c_shape_water",
    )
    reproduces: ClassVar[bool] = False
    needs = ("trunk", "trunk_pitch", "tail_yaw", "tail_pitch")
    answer_minima: ClassVar[Mapping[str, float]] = {"cycles": 3}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that rolls."""
    frequency: float = 1.0
    """Frequency of the bends [Hz], 0.05 to 5."""
    trunk: float = radians(60)
    """Amplitude of both bends of the trunk [rad]."""
    tail_lateral: float = radians(60)
    """Amplitude of the tail's lateral bend [rad]; the servo of the cable must be fast enough for it."""
    tail_vertical: float = radians(40)
    """Amplitude of the tail's pitch joint [rad]; the cable's end bends no more than this at the root."""
    cycles: int = 3
    """Number of cycles that are simulated; the first, in which the bends grow, is not measured [-]."""
    phases: tuple[float, ...] = (-0.25, -0.125, 0.0, 0.125, 0.25, 0.375, 0.5)
    """Phase lags of the trunk's vertical bend behind its lateral one, for the curve [cycle]."""
    bends: tuple[float, ...] = (radians(30), radians(60), radians(90))
    """Amplitudes of the trunk's bends, for the curve [rad]."""
    frequencies: tuple[float, ...] = (0.7, 1.0, 1.5, 2.0)
    """Frequencies of the trunk's bends, for the curve [Hz]; at 60 degrees the pitch servos allow 2.1 Hz."""
    timestep: float = 0.001
    """Time step of the physics [s]; the cable's servo is stiff, and beyond 1 ms Runge-Kutta steps do not hold it."""
    coarse_timestep: float = 0.002
    """Time step of the runs in which only the trunk bends [s]."""
    timesteps: tuple[float, ...] = (0.0025, 0.00125, 0.000625)
    """Time steps, falling, for the check of the angular momentum and the rate [s]."""

    def __post_init__(self) -> None:
        with Checks("death_roll", self) as check:
            check.whole("cycles", 2, 100)
            check.number("frequency", 0.05, 5.0, "Hz")
            check.that(min(self.frequencies) * self._duration >= 2.0, "every frequency needs two cycles in the run")

    def quick(self) -> "DeathRoll":
        """Two short cycles, one or two points on each curve."""
        return replace(
            self,
            frequency=2.0,
            cycles=2,
            trunk=radians(50),
            tail_lateral=radians(25),
            tail_vertical=radians(25),
            phases=(0.0, 0.25),
            bends=(radians(30),),
            frequencies=(2.0,),
            timesteps=(0.0025, 0.00125),
        )

    def for_robot(self, robot: Robot) -> "DeathRoll":
        """Return the same question for another robot, with time steps that are as stable for it as those of now."""
        variant = super(DeathRoll, self).for_robot(robot)  # super() without arguments fails in a class with slots
        step_factor, max_timestep = 1.0, max(self.timesteps) * longest_step(robot) / longest_step(self.robot)
        while step_factor * max(variant.timesteps) > _STIFFNESS_TOLERANCE * max_timestep:
            step_factor /= 2  # a control period remains a whole number of steps
        steps = tuple(step_factor * step for step in variant.timesteps)
        timestep, coarse = step_factor * variant.timestep, step_factor * variant.coarse_timestep
        return replace(variant, timestep=timestep, coarse_timestep=coarse, timesteps=steps)

    @property
    def _duration(self) -> float:
        return self.cycles / self.frequency

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Simulate rolls in vacuum and in water, and over phase, amplitude, frequency and time step."""
        arms = self._simulate(self._arms(), self.timestep, staged(progress, "arms", 0.0, 0.55))
        record = arms.assign(rate=(("run"), self._rates(arms, self.frequency), {"units": "Hz"}))
        record = record.merge(self._curves(staged(progress, "curves", 0.55, 0.9)))
        return SimulationResult(record=record.merge(self._steps(staged(progress, "time steps", 0.9, 1.0))))

    def _roll(self, *, frequency: float | None = None, **changes: Any) -> Gait:
        """Return the roll with the trunk alone, or with changed arguments of ``motion.roll``."""
        return roll(self.robot, period=1.0 / (frequency or self.frequency), **({"trunk": (self.trunk,) * 2} | changes))

    def _arms(self) -> dict[str, Gait]:
        """Return the gaits that are compared, by the names of ``_ARMS``."""
        tail = (self.tail_lateral, self.tail_vertical)
        return {
            "trunk": self._roll(),
            "tail": self._roll(trunk=(0.0, 0.0), tail=tail),
            "c_shape": self._roll(tail=tail),
            "s_shape": self._roll(tail=tail, tail_lag=0.5),
            "lateral_only": self._roll(trunk=(self.trunk, 0.0)),
            "vertical_only": self._roll(trunk=(0.0, self.trunk)),
            "reversed": self._roll(lag=-0.25),
        }

    def _simulate(
        self, rolls: Mapping[str, Gait], timestep: float, progress: Any, media: tuple[str, ...] = _MEDIA
    ) -> xr.Dataset:
        """Simulate all rolls in each medium.

        Args:
            rolls: gaits by label.
            timestep: time step of the physics [s].
            progress: callback that gets the finished fraction.
            media: ``vacuum`` or ``water``; the runs of the first one come first.
        """
        runs = [self._floating_run(gait, arm, medium) for medium in media for arm, gait in rolls.items()]
        record = require_complete(simulate(runs, duration=self._duration, timestep=timestep, progress=progress))
        return record.assign_coords(medium=("run", [medium for medium in media for _ in rolls]))

    def _floating_run(self, gait: Gait, arm: str, medium: str) -> Run:
        """Return the run of one roll in one medium; its bends grow over the first cycle."""
        fluid: Afloat = VACUUM if medium == "vacuum" else WATER
        control = OpenLoop(begin=0.0, ramp=gait.period)
        return Run(robot=self.robot, gait=gait, control=control, afloat=fluid, label=arm)

    def _window(self, frequency: float) -> float:
        """Return the start of the measurement [s]: whole cycles before the end, after the first cycle."""
        measured_cycles = int(frequency * self._duration + 1e-9) - 1
        return self._duration - measured_cycles / frequency

    def _rates(self, record: xr.Dataset, frequency: float) -> np.ndarray:
        return np.asarray(roll_rate(record, self._window(frequency)).values / (2 * pi))

    def _curves(self, progress: Any) -> xr.Dataset:
        """Return the rate over phase, amplitude and frequency of the trunk's bends [Hz]."""
        phases = {f"phase {p}": self._roll(lag=p) for p in self.phases}
        bends = {f"bend {b}": self._roll(trunk=(b, b)) for b in self.bends}
        frequencies = {f"frequency {f}": self._roll(frequency=f) for f in self.frequencies}
        phase_record = self._simulate(phases, self.coarse_timestep, staged(progress, "", 0.0, 0.25), ("vacuum",))
        sweep_record = self._simulate(bends | frequencies, self.coarse_timestep, staged(progress, "", 0.25, 1.0))
        medium_records = [sweep_record.isel(run=sweep_record.medium.values == medium) for medium in _MEDIA]
        count = len(bends)
        bend_rates = [
            self._rates(medium_record.isel(run=slice(0, count)), self.frequency) for medium_record in medium_records
        ]
        frequency_rates = [
            [self._rates(medium_record.isel(run=[count + i]), f)[0] for i, f in enumerate(self.frequencies)]
            for medium_record in medium_records
        ]
        data = xr.Dataset(
            {
                "rate_by_phase": ("late", self._rates(phase_record, self.frequency), {"units": "Hz"}),
                "rate_by_bend": (("fluid", "bend"), np.array(bend_rates), {"units": "Hz"}),
                "rate_by_frequency": (("fluid", "frequency"), np.array(frequency_rates), {"units": "Hz"}),
            },
            coords={
                "late": list(self.phases),
                "bend": list(self.bends),
                "frequency": list(self.frequencies),
                "fluid": list(_MEDIA),
            },
        )
        for name, unit in (("late", "1"), ("bend", "rad"), ("frequency", "Hz")):
            data[name].attrs["units"] = unit
        return data

    def _steps(self, progress: Any) -> xr.Dataset:
        """Return the spurious angular momentum in vacuum [kg m2/s] and the rate [Hz] over the time step."""
        momenta, rates, count = [], [], len(self.timesteps)
        for i, step in enumerate(self.timesteps):
            record = self._simulate({"trunk": self._roll()}, step, portion(progress, i, count), ("vacuum",))
            momenta.append(float(abs(record.angular_momentum).max()))
            rates.append(float(self._rates(record, self.frequency)[0]))
        data = xr.Dataset(
            {
                "momentum_by_timestep": ("timestep", momenta, {"units": "kg m2/s"}),
                "rate_by_timestep": ("timestep", rates, {"units": "Hz"}),
            },
            coords={"timestep": list(self.timesteps)},
        )
        data.timestep.attrs["units"] = "s"
        return data

    def measure(self, record: xr.Dataset) -> Measures:
        """Return rate, power and loads of each roll, and the residual angular momentum in vacuum."""
        start = self._window(self.frequency)
        torque, window = peak_torque(record, start), time_window(record, start)
        absolute_power, net_power = (
            mean_effort(record, name, start).sum("servo") for name in ("servo_absolute_power", "servo_power")
        )
        power = (absolute_power + net_power) / 2  # that of driving alone
        speed = abs(window.servo_velocity).max("time")
        measures = Measures()
        for medium in _MEDIA:
            for arm in _ARMS:
                run = int(np.flatnonzero((record.label == arm) & (record.medium == medium))[0])
                measures[f"rate_{arm}_{medium}"] = Measure(float(record.rate[run]), "Hz")
                if arm in ("trunk", "tail", "c_shape", "s_shape"):
                    measures[f"power_{arm}_{medium}"] = Measure(float(power[run]), "W")
                if arm == "c_shape":
                    for group, servos in servo_groups(self.robot).items():
                        for quantity, values, unit in (("torque", torque, "N m"), ("speed", speed, "rad/s")):
                            max_load = float(values.isel(run=run).sel(servo=list(servos)).max())
                            measures[f"{quantity}_peak_{group}_{medium}"] = Measure(max_load, unit)
        free = record.medium == "vacuum"
        trunk_rate, tail_rate, c_shape_rate = (
            measures[f"rate_{arm}_vacuum"].value for arm in ("trunk", "tail", "c_shape")
        )
        return measures | {
            "share_trunk": Measure(trunk_rate / c_shape_rate, "-"),
            "share_tail": Measure(tail_rate / c_shape_rate, "-"),
            "momentum_left_vacuum": Measure(float(abs(record.angular_momentum.isel(run=free.values)).max()), "kg m2/s"),
            "momentum_exchanged_water": Measure(
                float(abs(record.angular_momentum.isel(run=~free.values)).max()), "kg m2/s"
            ),
            "drift_vacuum": Measure(_drift(record.isel(run=free.values)), "m"),
            "rate_change_with_timestep": Measure(
                float(abs(record.rate_by_timestep[-1] / record.rate_by_timestep[-2] - 1.0)), "-"
            ),
        }

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say what the phase of the bends, the shape and the water do to the rate, and what limits it."""
        return self.render_explanation(
            measures, **{quantity: self._load(measures, quantity) for quantity in ("speed", "torque")}
        )

    def _load(self, measures: Mapping[str, float], quantity: str) -> float:
        """Return the greatest load of the C-shaped roll over the servo's limit [-].

        Args:
            measures: numbers of the run by name.
            quantity: ``torque`` or ``speed``.
        """
        return max(
            measures[f"{quantity}_peak_{group}_{medium}"]
            / min(getattr(self.robot.servo(servo), quantity) for servo in servos)
            for group, servos in servo_groups(self.robot).items()
            for medium in _MEDIA
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw one roll, what decides its rate, and what it costs."""
        record = outcome.record
        return {
            "death_roll": draw_roll(self.robot, record),
            "death_roll_rate": draw_rates(record),
            "death_roll_cost": draw_cost(self.robot, record, self._window(self.frequency)),
        }


def _drift(record: xr.Dataset) -> float:
    """Return the greatest distance of the centre of mass from its start [m]."""
    displacement = record.centre_of_mass - record.centre_of_mass.isel(time=0)
    return float(((displacement**2).sum("xyz") ** 0.5).max())


experiment = DeathRoll()
