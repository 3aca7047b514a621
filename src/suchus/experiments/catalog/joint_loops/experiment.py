"""What does an integral term in the joint controllers improve, and what does it cost?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from math import radians
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.article.paper import CYCLES
from suchus.core.checks import Checks
from suchus.experiments.catalog.joint_loops import figure as pictures
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
from suchus.robot.design import Robot, layout
from suchus.robot.design.scale import control_period, physics_step
from suchus.robot.design.servos import with_servos
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import START, Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.land.stand import on_stand
from suchus.sim.metrics import displacement, require_complete, rms_torque, time_window
from suchus.visual.figures import captioned

TESTS = ("step", "load", "let_go")
"""A step without load, a load without a step, and a step of a clamped joint that is then released."""
_CLAMP_PERIODS = 100  # [control period]; long enough for the integral to reach its limit


@dataclass(frozen=True, slots=True, kw_only=True)
class JointLoops(Experiment):
    """The PID loop of one joint on a stand, then all of them in the crawl, with several integral gains.

    The robot needs a servo that turns the named joint directly, and a gait with which it can crawl.
    """

    title = "What does an integral term in the joint controllers improve, and what does it cost?"
    shows = "Section III.D, Fig. 10"
    answers = (
        "droop_taken",
        "load_error_pid",
        "step_error_pid",
        "ripple_pid",
        "tracking_by_droop",
        "tracking_by_damping",
    )
    needs = ("limbs",)
    judged_settings = ("robot", "gait", "joint", "step")
    judged_minima: ClassVar[Mapping[str, float]] = {"integrals": 3, "cycles": CYCLES, "seconds": 4.0}
    answer_minima: ClassVar[Mapping[str, float]] = {"seconds": 4.0, "cycles": 2}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot whose servos are tested."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The crawl whose torque is the load."""
    joint: str = "LH_pitch"
    """The servo that is tested on the stand."""
    integrals: tuple[float, ...] = (0.0, 5.0, 20.0)
    """Integral gains of all servos, the first of them zero [N m/(rad s)]; 20 ends the plausible range."""
    step: float = radians(10.0)
    """Height of the step [rad]."""
    seconds: float = 4.0
    """Simulated duration after each change [s]."""
    cycles: int = int(CYCLES)
    """Number of cycles of the crawl that are measured [-]."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.rising("integrals", 0.0, 1e4, "N m/(rad s)")
            check.that(len(self.integrals) > 1 and self.integrals[0] == 0.0, "integrals must begin with 0 and go on")
            check.number("step", 0.01, 1.0, "rad")
            check.number("seconds", 0.02, 100.0, "s")
            check.whole("cycles", 1, 1000)

    def quick(self) -> "JointLoops":
        """Return two gains, a second each, one cycle."""
        return replace(self, integrals=(0.0, 20.0), seconds=1.0, cycles=1)

    def gaits_for_robot(self, robot: Robot) -> dict[str, Any]:
        """Return the robot's own gait, and the left hind servo that lifts the limb, or its only one."""
        hind = layout(robot).limbs[-2]
        servos = layout(robot).servos[hind.servos]
        return {"gait": default_gait(robot), "joint": servos[min(1, len(servos) - 1)]}

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Simulate the crawl with every gain, then the joint on the stand under the load of the crawl."""
        robots = [with_servos(self.robot, partial(replace, ki=ki)) for ki in self.integrals]
        crawls = require_complete(
            xr.concat([self._crawl_record(i, robot, progress) for i, robot in enumerate(robots)], "run")
        )
        walk = time_window(crawls)
        load = float(rms_torque(crawls.isel(run=0)).sel(servo=self.joint))
        data = _tracking(walk, self.robot, displacement(crawls).sel(xyz="x").values)
        progress("stand", 0.7)
        step = physics_step(self.robot)
        data["angle"] = (("test", "ki", "time"), np.array(self._stand_angles(robots, load)), {"units": "rad"})
        unlimited = with_servos(robots[-1], lambda servo: replace(servo, integral_limit=servo.torque))
        data["unlimited_angle"] = (
            ("test", "time"),
            np.array(self._stand_angles([unlimited], load))[:, 0],
            {"units": "rad", "long_name": "angle where the integral may build up all of the servo's torque"},
        )
        data = data.assign_coords(
            ki=("ki", list(self.integrals), {"units": "N m/(rad s)", "long_name": "integral gain"}),
            test=list(TESTS),
            time=("time", step * np.arange(1, round(self.seconds / step) + 1), {"units": "s", "long_name": "time"}),
        )
        kp = self.robot.servo(self.joint).kp
        attrs = {"gripped": self.clamp_duration, "joint": self.joint, "step": self.step, "load": load, "kp": kp}
        return SimulationResult(record=data.assign_attrs(attrs))

    @property
    def clamp_duration(self) -> float:
        """Duration for which the joint is clamped, a second for the article's robot [s]."""
        return _CLAMP_PERIODS * control_period(self.robot)

    def _crawl_record(self, index: int, robot: Robot, progress: Progress) -> xr.Dataset:
        """Simulate the crawl with one of the gains; servos with and without an integral term cannot share a batch.

        Args:
            index: index of the gain.
            robot: robot whose servos have this gain.
            progress: callback that gets the finished fraction.
        """
        run = Run(robot=robot, gait=self.gait, label=f"ki {self.integrals[index]:g}")
        stage_length = 0.7 / len(self.integrals)
        stage = staged(progress, "crawl", index * stage_length, (index + 1) * stage_length)
        return simulate([run], duration=START + self.cycles * self.gait.period, progress=stage)

    def _stand_angles(self, robots: list[Robot], load: float) -> list[list[np.ndarray]]:
        """Return the joint's angle over time in each of ``TESTS`` with each gain [rad].

        Args:
            robots: robots with one integral gain each.
            load: load of the second test [N m].
        """
        step = physics_step(self.robot)
        free_steps, clamp_steps = round(self.seconds / step), round(self.clamp_duration / step)
        zeros, step_target = np.zeros(free_steps), np.full(free_steps, self.step)
        no_clamp = np.zeros(free_steps, dtype=bool)
        angles: list[list[np.ndarray]] = [[], [], []]
        for robot in robots:
            step_test = on_stand(robot, self.joint, target=step_target, load=zeros, gripped=no_clamp, timestep=step)
            load_test = on_stand(robot, self.joint, target=zeros, load=zeros + load, gripped=no_clamp, timestep=step)
            release_test = on_stand(
                robot,
                self.joint,
                target=np.full(clamp_steps + free_steps, self.step),
                load=np.zeros(clamp_steps + free_steps),
                gripped=np.arange(clamp_steps + free_steps) < clamp_steps,
                timestep=step,
            )
            for test_angles, angle in zip(
                angles, (step_test.angle, load_test.angle, release_test.angle[clamp_steps:]), strict=True
            ):
                test_angles.append(angle)
        return angles

    def measure(self, record: xr.Dataset) -> Measures:
        """Return rise time, overshoot, droop and wind-up of each gain, and the errors of the crawl."""
        step, last_gain = record.attrs["step"], len(record.ki) - 1
        measures = Measures()
        for i, ki in enumerate(record.ki.values):
            gain_record, name = record.isel(ki=i), f"ki_{ki:g}".replace(".", "_")
            measures |= {
                f"rise_time_{name}": Measure(
                    rise_time(record.time.values, gain_record.angle.sel(test="step").values, step), "s"
                ),
                f"overshoot_{name}": Measure(overshoot(gain_record.angle.sel(test="step").values, step), "-"),
                f"overshoot_let_go_{name}": Measure(overshoot(gain_record.angle.sel(test="let_go").values, step), "-"),
                f"droop_{name}": Measure(abs(float(gain_record.angle.sel(test="load")[-1])), "rad"),
                f"tracking_error_{name}": Measure(float(np.sqrt(gain_record.error_ms.mean())), "rad"),
                f"forward_{name}": Measure(float(gain_record.forward), "m"),
            }
        droop = abs(float(record.angle.isel(ki=0).sel(test="load")[-1]))
        total = float(record.error_ms.isel(ki=0).sum())
        by_load = 1.0 - float(record.less_droop_ms.sum()) / total
        measures |= _loop_errors("pid", record.angle.isel(ki=last_gain), step, droop)
        measures |= _loop_errors("pid_unlimited", record.unlimited_angle, step, droop)
        return measures | {
            "load": Measure(record.attrs["load"], "N m"),
            "droop_by_kp": Measure(record.attrs["load"] / record.attrs["kp"], "rad"),
            "tracking_by_droop": Measure(by_load, "-"),
            "tracking_by_damping": Measure(1.0 - float(record.less_both_ms.sum()) / total - by_load, "-"),
        }

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the tests on the stand and the errors of the crawl."""
        return {
            "joint_on_stand": captioned(
                pictures.on_stand(outcome.record),
                f"{self.joint} with the pelvis fixed in the air, with several integral gains. Left: a step. Middle: a "
                "load as the crawl asks for, from time zero on. Right: let go after it was clamped at zero, "
                "commanded to the step's height; an integral term has wound up meanwhile.",
            ),
            "tracking_in_crawl": captioned(
                pictures.tracking(outcome.record),
                f"Commanded less actual angle in the crawl. Above: of {self.joint} without an integral term, and what "
                "droop, the torque over the proportional gain, accounts for. Below: root mean square of all servos of "
                "each kind with several integral gains.",
            ),
        }


def _loop_errors(loop: str, angle: xr.DataArray, step: float, droop: float) -> Measures:
    """Return the errors of a loop on the stand after load and step, its ripple, and what its integral takes away.

    Args:
        loop: name of the loop, with which the names of the measures end.
        angle: angle of the joint, dimensions ``test`` and ``time`` [rad].
        step: height of the step [rad].
        droop: error under the load without an integral term [rad].
    """
    load_error = abs(float(angle.sel(test="load")[-1]))
    final_interval = angle.sel(time=slice(angle.time[-1] - 0.5, None))
    return Measures(
        {
            f"load_error_{loop}": Measure(load_error, "rad"),
            f"step_error_{loop}": Measure(abs(float(angle.sel(test="step")[-1]) - step), "rad"),
            f"ripple_{loop}": Measure(float((final_interval.max("time") - final_interval.min("time")).max()), "rad"),
            f"droop_taken_{loop}": Measure(1.0 - load_error / droop, "-"),
        }
    )


def rise_time(time: np.ndarray, angle: np.ndarray, step: float) -> float:
    """Return the time that an angle takes from a tenth to nine tenths of a step [s]; NaN if it does not get there.

    Args:
        time: times of the samples [s].
        angle: angle over time [rad].
        step: height of the step [rad].
    """
    crossings = [np.flatnonzero(angle >= fraction * step) for fraction in (0.1, 0.9)]
    return float(time[crossings[1][0]] - time[crossings[0][0]]) if crossings[1].size else float("nan")


def overshoot(angle: np.ndarray, step: float) -> float:
    """Return the fraction of a step by which an angle exceeds it [-]; zero if it does not."""
    return max(float(angle.max()) / step - 1.0, 0.0)


def _tracking(walk: xr.Dataset, robot: Robot, forward: np.ndarray) -> xr.Dataset:
    """Return the tracking errors of the crawls, and the errors that remain without droop and without damping.

    Without an integral term a servo's torque is kp times its angle error, measured from its slew-limited target, minus
    kd times its speed. The torque over kp is therefore the droop, and kd over kp times the speed is the lag.

    Args:
        walk: record with one run for each gain, the first without an integral term.
        robot: robot whose gains kp and kd the runs share.
        forward: displacement of each run [m].
    """
    names = layout(robot).servos
    kp, kd = (xr.DataArray([getattr(robot.servo(n), gain) for n in names], dims="servo") for gain in ("kp", "kd"))
    walk = walk.sel(servo=list(names))
    error = walk.servo_target - walk.servo_angle
    first_run = walk.isel(run=0)
    droop = first_run.servo_torque / kp
    less_droop = error.isel(run=0) - droop
    squared = {"units": "rad2"}
    data = xr.Dataset(
        {
            "error_ms": (("ki", "servo"), (error**2).mean("time").transpose("run", "servo").values, squared),
            "less_droop_ms": ("servo", (less_droop**2).mean("time").values, squared),
            "less_both_ms": (
                "servo",
                ((less_droop - kd / kp * first_run.servo_velocity) ** 2).mean("time").values,
                squared,
            ),
            "crawl_error": (
                ("servo", "crawl_time"),
                error.isel(run=0).transpose("servo", "time").values,
                {"units": "rad"},
            ),
            "crawl_droop": (("servo", "crawl_time"), droop.transpose("servo", "time").values, {"units": "rad"}),
            "forward": ("ki", forward, {"units": "m", "long_name": "displacement forward"}),
        }
    )
    return data.assign_coords(servo=list(names), crawl_time=("crawl_time", walk.time.values, {"units": "s"}))


experiment = JointLoops()
