"""Walking that changes its gait, steers, and keeps its body level."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks, require
from suchus.core.errors import OutsideLimits
from suchus.robot.control.attitude import Attitude, AttitudeRule
from suchus.robot.control.controller import Command, Runs, union_of_needs
from suchus.robot.control.sensed import Sensed
from suchus.robot.control.switching import Switcher, SwitchRule
from suchus.robot.design import Robot, layout, servo_ranges
from suchus.robot.motion import START, Batch, Gait, Steer, trunk_amplitude
from suchus.robot.motion.transition import Transition, transition

_SLACK = 1e-9  # [s]
_GROWS = 0.5  # [cycle]; over which stroke and bends grow after a change of gait


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """A change of gait at a time of its own."""

    at: float
    """Time at which it begins [s]."""
    gait: Gait
    """Gait to which the walk changes."""

    def __post_init__(self) -> None:
        require("change", "at", self.at, 0.0, 86400.0, "s")


@dataclass(frozen=True, slots=True, kw_only=True)
class Walking:
    """The run's gait with steering, attitude feedback and changes of gait; runs that differ share a batch.

    Without any of these the servo angles equal those of ``OpenLoop``.
    """

    attitude: AttitudeRule | None = None
    """Rule that keeps the body level; None for none."""
    changes: tuple[Change, ...] = ()
    """Changes of gait that are asked for, in the order of their times."""
    switching: SwitchRule | None = None
    """Rule that changes the gait by what the sensors read; None for none."""
    bend: float = 0.0
    """Lasting bend of the trunk, left positive [rad]; to which side and how far it turns a robot in its gait is
    ``suchus.robot.gaits.trunk_steering``, to the left for most."""
    asymmetry: float = 0.0
    """Share by which left strokes are shorter and right strokes longer [-]; it steers to the left."""

    def __post_init__(self) -> None:
        with Checks("walking", self) as checks:
            checks.number("bend", -2.0, 2.0, "rad")
            checks.number("asymmetry", -3.0, 3.0, "")
            times = [change.at for change in self.changes]
            checks.that(times == sorted(times), f"walking.changes begin at {times} s; their times must increase")
            checks.that(
                not self.changes or self.switching is None, "walking has changes and switching; give one of them"
            )

    @property
    def feels(self) -> bool:
        """Whether any rule is on."""
        return self.attitude is not None or self.switching is not None

    @property
    def needs(self) -> tuple[str, ...]:
        """What the rules that are on feel."""
        return union_of_needs(
            ("orientation", "angular_velocity") if self.attitude else (),
            ("foot_pressure", "belly_pressure", "tail_pressure", "orientation") if self.switching else (),
        )

    @staticmethod
    def start(runs: Runs, period: float) -> "Walker":
        """Start walking, each run with its own control.

        Raises:
            OutsideLimits: a robot whose trunk cannot bend as far as it is asked to, or a gait of measured curves from
                which anything is asked.
        """
        for control, robot, gait in set(zip(runs.controls, runs.robots, runs.gaits, strict=True)):
            ladder = () if control.switching is None else control.switching.ladder
            later_gaits = (*(change.gait for change in control.changes), *ladder)
            for walk_gait in (gait, *later_gaits) if control != Walking() else ():
                walk_gait.needs_steering("a walk that is steered and changes its gait")
            _check_bend(control, robot, gait)
        return Walker(runs, period)


def _check_bend(control: Walking, robot: Robot, gait: Gait) -> None:
    """Refuse a steering bend for which the trunk has no servo or too little range."""
    place = layout(robot)
    if control.bend and not place.trunk_yaw:
        raise OutsideLimits(
            f"walking.bend is {control.bend:.3f} rad; robot {robot.name!r} has no servo that bends its trunk "
            "sideways: set it to 0, and steer by walking.asymmetry."
        )
    gait_bend = trunk_amplitude(robot, gait)
    max_bend = float(np.abs(servo_ranges(robot)[list(place.trunk_yaw)]).min(axis=1, initial=np.inf).sum())
    if abs(control.bend) + gait_bend > max_bend + 1e-9:
        raise OutsideLimits(
            f"gait {gait.name!r} bends the trunk by {gait_bend:.3f} rad and steering by "
            f"{abs(control.bend):.3f} rad; robot {robot.name!r} allows {max_bend:.3f} rad in all: "
            "lower walking.bend."
        )


class Walker:
    """The running controller of a batch of walks."""

    def __init__(self, runs: Runs, period: float) -> None:
        """Start every run in its own gait.

        Args:
            runs: controls, robots and gaits.
            period: control period [s].
        """
        controls, robots, gaits = runs.controls, runs.robots, runs.gaits
        self._controls, self._robots, self._gaits = list(controls), list(robots), list(gaits)
        self._period = period
        n = len(robots)
        self._began = np.full(n, START)
        self._cycles = np.zeros(n)  # cycles walked before the present gait [cycle]
        self._full = np.zeros(n)  # duration over which stroke and bends grow [s]; 0: at once
        self._script: dict[int, tuple[float, Transition, np.ndarray]] = {}
        self._bend = np.array([control.bend for control in controls])
        place = layout(robots[0])
        self._stroke = 1.0 - np.array([limb.side for limb in place.limbs]) * np.array(
            [[control.asymmetry] for control in controls]
        )
        self._attitude = Attitude([control.attitude for control in controls], robots, period)
        self._switcher = Switcher([control.switching for control in controls], robots, gaits, period)
        self._foot_lowering = np.zeros((n, len(place.limbs)))
        self._batch = Batch(self._robots, self._gaits)
        self._previous_command = self._walk(0.0)

    def rest(self) -> Float[np.ndarray, "run servo"]:
        """The posture of the first phases."""
        return self._previous_command.targets

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Return the servo angles of the gait, or of the transition to another gait.

        Args:
            tick: number of the control period.
            sensed: readings; None if no rule is on.
        """
        time = tick * self._period
        if sensed is not None:
            self._foot_lowering = (
                self._attitude.foot_lowering(sensed) if time >= START - _SLACK else np.zeros_like(self._foot_lowering)
            )
        self._finish(time)
        current = self._walk(time)
        for run, target_gait in self._requested_gaits(time, sensed, current.phase):
            course = transition(self._robots[run], self._gaits[run], target_gait)
            self._script[run] = (time, course, self._previous_command.targets[run].copy())
            self._cycles[run] += np.ceil((time - self._began[run]) / self._gaits[run].period)
            self._gaits[run] = target_gait
            self._batch = Batch(self._robots, self._gaits)
        for run, (start_time, course, start) in self._script.items():
            current.targets[run] = course.angles_at(time - start_time, start)
            current.phase[run] = self._previous_command.phase[run]
        self._previous_command = current
        return Command(current.targets.copy(), current.phase.copy())

    def _requested_gaits(self, time: float, sensed: Sensed | None, phase: np.ndarray) -> list[tuple[int, Gait]]:
        """Return the runs that begin another gait now, with that gait.

        Args:
            time: time since the beginning of the run [s].
            sensed: readings; None if no rule is on.
            phase: phase of the limbs, shape (run, limb) [cycle].
        """
        busy = set(self._script)
        requests = []
        for run, control in enumerate(self._controls):
            due = [change.gait for change in control.changes if change.at <= time + _SLACK]
            if run not in busy and due and due[-1] != self._gaits[run]:
                requests.append((run, due[-1]))
        if sensed is not None and time >= START - _SLACK:
            requests += self._switcher.decide(sensed, phase, self._gaits, busy)
        return requests

    def _finish(self, time: float) -> None:
        """End the transitions whose time has passed; their new gaits begin now."""
        for run, (start_time, course, _) in list(self._script.items()):
            if time >= start_time + course.duration - _SLACK:
                del self._script[run]
                self._began[run] = time
                self._full[run] = _GROWS * self._gaits[run].period

    def _walk(self, time: float) -> Command:
        """Return the intended posture of every run by its clock; runs in a transition ignore it.

        Args:
            time: time since the beginning of the run [s].
        """
        since = np.maximum(time - self._began, 0.0)
        size = np.where(self._full > 0, np.clip(since / np.maximum(self._full, 1e-9), 0.0, 1.0), 1.0)
        clock = since / self._batch.periods + self._cycles
        phases = clock[:, None] + self._batch.phases
        steer = Steer(size=size, stroke=self._stroke, lowering=self._foot_lowering, bend=self._bend)
        return Command(self._batch.targets(phases, self._batch.axis_phase(phases, clock), steer), phases)


controller = Walking
