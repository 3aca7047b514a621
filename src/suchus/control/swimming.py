"""Swimming as a control: the wave on trunk and tail, limbs held out, a mean bend that steers; heading, depth, pitch."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from jaxtyping import Float

from suchus.control.controller import Command, Runs
from suchus.control.holding import DepthHold, Depths, HeadingHold, Headings
from suchus.control.sensed import Sensed
from suchus.control.trim import Pitches, PitchHold
from suchus.design import ARTICLE_BODY, Robot, check_needs, layout, servo_ranges
from suchus.design.checks import Checks
from suchus.errors import OutsideLimits
from suchus.kinematics import tail as tail_kinematics
from suchus.motion import Swim, bends, check_swim


@dataclass(frozen=True, slots=True, kw_only=True)
class Swimming:
    """A swimming motion; the gait of the run is not asked, and its limbs have no phase of their own.

    The amplitudes grow over ``ramp``. A mean bend of the tail steers, as a rudder does; with ``heading``, ``depth`` and
    ``pitch`` the robot swims by what it feels.
    """

    swim: Swim
    """The wave on the joints."""
    turn: float = 0.0
    """Mean bend of the tail, tip to the left positive, which turns the robot to the left [rad]."""
    trunk_turn: float = 0.0
    """Mean bend of the trunk, front end to the left positive [rad]."""
    limb_yaw: float = -pi / 2
    """Angle by which all limbs point forward of straight out [rad]; back along the body at -90 degrees."""
    limb_pitch: float = -0.3
    """Angle by which all limbs point down [rad]; up to the surface where negative: foam on them keeps the body
    upright."""
    ramp: float = 1.0
    """Duration over which the amplitudes grow [s]."""
    heading: HeadingHold | None = None
    """Rule that keeps the heading; None for none."""
    depth: DepthHold | None = None
    """Rule that keeps the depth; None for none."""
    pitch: PitchHold | None = None
    """Rule that keeps the pitch at that depth; None for none."""

    def __post_init__(self) -> None:
        with Checks("swimming", self) as check:
            check.number("turn", -pi, pi, "rad")
            check.number("trunk_turn", -pi, pi, "rad")
            check.number("limb_yaw", -pi, pi, "rad")
            check.number("limb_pitch", -pi, pi, "rad")
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

    def targets(self, robot: Robot, time: Float[np.ndarray, " time"]) -> Float[np.ndarray, "time servo"]:
        """Return the servo angles over time, in the order of ``design.servo_names()`` [rad]."""
        place, now = layout(robot), bends(self.swim, time)
        grown = np.clip(time / self.ramp, 0.0, 1.0) if self.ramp > 0 else np.ones_like(time)
        grown = grown**2 * (3.0 - 2.0 * grown)
        out = np.zeros((len(time), len(place.servos)))
        for limb in place.limbs:
            out[:, limb.servos.start] = self.limb_yaw
            out[:, limb.servos.start + 1] = self.limb_pitch
        out[:, place.trunk_yaw] = grown[:, None] * now.yaw + self.trunk_turn / len(place.trunk_yaw)
        out[:, place.cables[0]] = tail_kinematics.servo_angle(robot.tail, grown * now.tail - self.turn)
        return out

    @staticmethod
    def start(runs: Runs, period: float) -> "SwimmingController":
        """Start the swims of a batch, one per run.

        Raises:
            OutsideLimits: a robot cannot follow its swim.
            InvalidDesign: a robot whose depth is controlled has too little air, or no two chambers for its pitch.
        """
        robots = [check_needs(robot, ARTICLE_BODY, "swimming by trunk and cable") for robot in runs.robots]
        return SwimmingController(runs.controls, robots, runs.ticks, period)


class SwimmingController:
    """The running swims of a batch: a table for each, to which what is felt adds."""

    def __init__(self, controls: Sequence[Swimming], robots: Sequence[Robot], ticks: int, period: float) -> None:
        pairs = list(zip(controls, robots, strict=True))
        unique = {pair: i for i, pair in enumerate(dict.fromkeys(pairs))}
        self._row = np.array([unique[pair] for pair in pairs])
        time, place = np.arange(ticks) * period, layout(robots[0])
        self._targets = np.array([control.targets(robot, time) for control, robot in unique])
        frequency = np.array([control.swim.frequency for control in controls])
        self._frequency, self._period = np.repeat(frequency[:, None], len(place.limbs), axis=1), period
        for (control, robot), targets in zip(unique, self._targets, strict=True):
            check_swim(robot, control.swim)
            _check(robot, targets)
            if control.heading is not None:
                for side in (-1.0, 1.0):
                    hold = control.heading
                    trunk, tail = np.array([side * hold.trunk_turn]), np.array([side * hold.turn])
                    _check(robot, bent(targets, robot, tail, trunk))
        self._robots = [(robot, np.flatnonzero([r == robot for r in robots])) for robot in dict.fromkeys(robots)]
        self._feels = any(control.feels for control in controls)
        cycle = [max(1, round(1.0 / (one * period))) for one in frequency]
        self._headings = Headings([one.heading for one in controls], robots, cycle, period)
        self._depths = Depths([one.depth for one in controls], robots, period)
        asked = [np.nan if one.depth is None else one.depth.depth for one in controls]
        self._pitches = Pitches([one.pitch for one in controls], asked, robots, period)

    def rest(self) -> Float[np.ndarray, "run servo"]:
        """The first posture."""
        return self._targets[self._row, 0]

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Look up one tick, and add what is felt."""
        targets, air_fraction = self._targets[self._row, tick], None
        if sensed is not None and self._feels:
            tail, trunk = self._headings.bend(sensed)
            for robot, runs in self._robots:
                targets[runs] = bent(targets[runs], robot, tail[runs], trunk[runs])
            kept = self._depths.air_fraction(sensed)
            air_fraction = None if kept is None else self._pitches.split(kept, sensed)
        return Command(targets, self._frequency * (tick * self._period), air_fraction)


def bent(targets: np.ndarray, robot: Robot, tail: np.ndarray, trunk: np.ndarray) -> np.ndarray:
    """Return servo angles with mean bends of tail and trunk besides, within the tail's limit, shape (row, servo) [rad].

    Args:
        targets: shape (row, servo) [rad].
        robot: a robot with a cable tail.
        tail: its mean bend, tip to the left positive, shape (row,) [rad].
        trunk: its mean bend, front end to the left positive, shape (row,) [rad].
    """
    place, out = layout(robot), np.array(targets)
    cable = place.cables[0]
    most = robot.tail.bend_limit
    bend = tail_kinematics.bend_of_servo(robot.tail, out[:, cable]) - tail
    out[:, cable] = tail_kinematics.servo_angle(robot.tail, np.clip(bend, -most, most))
    out[:, place.trunk_yaw] += trunk[:, None] / len(place.trunk_yaw)
    return out


def _check(robot: Robot, targets: np.ndarray) -> None:
    """Refuse angles beyond the joints' ranges."""
    ranges = servo_ranges(robot)
    least, most = targets.min(axis=0), targets.max(axis=0)
    for name, low, high, (least_here, most_here) in zip(layout(robot).servos, least, most, ranges, strict=True):
        if low < least_here - 1e-9 or high > most_here + 1e-9:
            raise OutsideLimits(
                f"swimming asks {name} of robot {robot.name!r} for {low:.3f} to {high:.3f} rad; {least_here:.3f} to "
                f"{most_here:.3f} rad is allowed: bend less, or steer less."
            )


controller = Swimming
examples = (
    Swimming(
        swim=Swim(
            name="wave", frequency=1.0, yaw=(0.36, 0.13, 0.11), yaw_lag=(0.08, -0.11, -0.29), tail=0.75, tail_lag=-0.11
        )
    ),
)
