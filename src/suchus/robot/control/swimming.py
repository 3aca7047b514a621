"""Swimming: a swimming gait from the first moment on, and rules that hold heading, depth and pitch."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks
from suchus.robot.control.controller import Command, Runs, union_of_needs
from suchus.robot.control.holding import DepthHold, DepthHolds, HeadingHold, HeadingHolds
from suchus.robot.control.sensed import Sensed
from suchus.robot.control.trim import PitchHold, PitchHolds
from suchus.robot.design import Robot
from suchus.robot.motion import Batch, Bend, Gait, Steer, check_limits, check_speeds


@dataclass(frozen=True, slots=True, kw_only=True)
class Swimming:
    """Plays the gait of the run from time zero on, its strokes and bends growing over ``ramp``.

    A steady bend of the tail, as ``gait.with_numbers(tail_offset=0.3)``, steers as a rudder does; with ``heading``,
    ``depth`` and ``pitch`` the robot swims by what it feels.
    """

    ramp: float = 1.0
    """Duration over which strokes and bends grow [s]."""
    heading: HeadingHold | None = None
    """Rule that keeps the heading; None for none."""
    depth: DepthHold | None = None
    """Rule that keeps the depth; None for none."""
    pitch: PitchHold | None = None
    """Rule that keeps the pitch at that depth; None for none."""

    def __post_init__(self) -> None:
        with Checks("swimming", self) as check:
            check.number("ramp", 0.0, 60.0, "s")
            check.that(
                self.pitch is None or self.depth is not None,
                "swimming.pitch is held by the air that a held depth lets out, and swimming.depth is None; give it a "
                "DepthHold, or leave out swimming.pitch",
            )

    @property
    def feels(self) -> bool:
        """Whether heading, depth or pitch are controlled."""
        return self.heading is not None or self.depth is not None

    @property
    def needs(self) -> tuple[str, ...]:
        """Sensors of the rules that are on."""
        return union_of_needs(
            ("orientation", "servo_position") if self.heading else (),
            ("depth",) if self.depth else (),
            ("orientation", "angular_velocity", "depth") if self.pitch else (),
        )

    @staticmethod
    def start(runs: Runs, period: float) -> "SwimmingController":
        """Start the swims of a batch, one per run.

        Raises:
            OutsideLimits: a robot cannot follow its gait, or what steers it asks for more.
            InvalidDesign: a robot whose depth is controlled has too little air, or no two chambers for its pitch.
        """
        for control, robot, gait in {*zip(runs.controls, runs.robots, runs.gaits, strict=True)}:
            if control.feels or control.ramp > 0.0:
                gait.needs_steering("a swim that grows from rest or is held")
            check_speeds(robot, gait)
            for side in (-1.0, 1.0) if control.heading is not None else ():
                check_limits(robot, _with_trunk_bend(gait, side * control.heading.trunk_turn))
        return SwimmingController(runs.controls, runs.robots, runs.gaits, period)


def _with_trunk_bend(gait: Gait, bend: float) -> Gait:
    """Return a gait whose trunk bends more to the left [rad]."""
    return replace(gait, axis=(*gait.axis, Bend(part="trunk", offset=bend)))


class SwimmingController:
    """The running swims of a batch: the postures of their gaits, corrected by feedback."""

    def __init__(
        self, controls: Sequence[Swimming], robots: Sequence[Robot], gaits: Sequence[Gait], period: float
    ) -> None:
        """Start the rules of heading, depth and pitch.

        Args:
            controls: settings, one for each run.
            robots: robot of each run.
            gaits: gait of each run.
            period: control period [s].
        """
        self._gaits, self._period = Batch(robots, gaits), period
        self._ramp = np.array([control.ramp for control in controls])
        self._feels = any(control.feels for control in controls)
        cycle = [max(1, round(gait.period / period)) for gait in gaits]
        self._headings = HeadingHolds([control.heading for control in controls], robots, cycle, period)
        self._depths = DepthHolds([control.depth for control in controls], robots, period)
        target_depths = [np.nan if control.depth is None else control.depth.depth for control in controls]
        self._pitches = PitchHolds([control.pitch for control in controls], target_depths, robots, period)
        self._zeros = np.zeros(len(controls))

    def rest(self) -> Float[np.ndarray, "run servo"]:
        """The first posture."""
        return self._posture(0.0, self._zeros, self._zeros)[0]

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Return the servo angles of the gait with the corrections of heading, depth and pitch.

        Args:
            tick: number of the control period.
            sensed: readings; None if nothing is controlled.
        """
        tail, trunk, air = self._zeros, self._zeros, None
        if sensed is not None and self._feels:
            tail, trunk = self._headings.bend(sensed)
            air_fraction = self._depths.air_fraction(sensed)
            air = None if air_fraction is None else self._pitches.split(air_fraction, sensed)
        return Command(*self._posture(tick * self._period, tail, trunk), air)

    def _posture(self, time: float, tail: np.ndarray, trunk: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return servo angles [rad] and phases of the limbs [cycle] at a time [s].

        Args:
            time: time since the beginning of the run [s].
            tail: steady bend of the tail of each run, left positive [rad].
            trunk: steady bend of the trunk of each run, left positive [rad].
        """
        clock = time / self._gaits.periods
        phase = clock[:, None] + self._gaits.phases
        steer = Steer(size=ramp_fraction(time, self._ramp), bend=trunk, tail=tail)
        return self._gaits.targets(phase, self._gaits.axis_phase(phase, clock), steer), phase


def ramp_fraction(time: float, ramp: Float[np.ndarray, " run"]) -> Float[np.ndarray, " run"]:
    """Return the fraction of a motion at a time [s]: 0 to 1 over a ramp, smooth at both ends [-]."""
    fraction = np.where(ramp > 0.0, np.clip(time / np.where(ramp > 0.0, ramp, 1.0), 0.0, 1.0), 1.0)
    return np.asarray(fraction**2 * (3.0 - 2.0 * fraction))


controller = Swimming
examples = (Swimming(),)
