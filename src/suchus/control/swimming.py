"""Swimming as a control: the wave on trunk and tail, a mean bend that steers, limbs held out or folded."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np
from jaxtyping import Float

from suchus.control.open_loop import Table
from suchus.control.suited import crocodiles
from suchus.design import AnyRobot, Crocodile, layout, servo_ranges
from suchus.design.checks import Checks
from suchus.errors import OutsideLimits
from suchus.kinematics import tail as tail_kinematics
from suchus.motion import AnyGait, Swim, bends, check_swim


@dataclass(frozen=True, slots=True, kw_only=True)
class Swimming:
    """A swimming motion in open loop; the gait of the run is not asked, and its limbs have no phase of their own.

    The amplitudes grow over ``ramp``. A mean bend of the tail steers, as a rudder does.
    """

    swim: Swim
    """The wave on the joints."""
    turn: float = 0.0
    """Mean bend of the tail, tip to the left positive, which turns the robot to the left [rad]."""
    trunk_turn: float = 0.0
    """Mean bend of the trunk, front end to the left positive [rad]."""
    limb_yaw: float = -pi / 2
    """How far all limbs point forward of straight out [rad]; back along the body at -90 degrees."""
    limb_pitch: float = -0.3
    """How far all limbs point down [rad]; up to the surface where negative: foam on them keeps the body upright."""
    ramp: float = 1.0
    """Over which the amplitudes grow [s]."""

    def __post_init__(self) -> None:
        with Checks("swimming", self) as check:
            check.number("turn", -pi, pi, "rad")
            check.number("trunk_turn", -pi, pi, "rad")
            check.number("limb_yaw", -pi, pi, "rad")
            check.number("limb_pitch", -pi, pi, "rad")
            check.number("ramp", 0.0, 60.0, "s")

    @property
    def feels(self) -> bool:
        """Nothing is sensed."""
        return False

    def targets(self, robot: Crocodile, time: Float[np.ndarray, " time"]) -> Float[np.ndarray, "time servo"]:
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

    def start(
        self,
        robots: Sequence[AnyRobot],
        gaits: Sequence[AnyGait],
        seeds: Sequence[int],
        ticks: int,
        period: float,
    ) -> Table:
        """Tabulate the swim for every robot.

        Raises:
            OutsideLimits: a robot cannot follow it.
        """
        return self.start_together([self] * len(robots), robots, gaits, seeds, ticks, period)

    @staticmethod
    def start_together(
        controls: Sequence["Swimming"],
        robots: Sequence[AnyRobot],
        gaits: Sequence[AnyGait],
        seeds: Sequence[int],
        ticks: int,
        period: float,
    ) -> Table:
        """Tabulate the swims of a batch, one per run.

        Raises:
            OutsideLimits: a robot cannot follow its swim.
        """
        del gaits, seeds
        ours = crocodiles(robots, "swimming by trunk and cable")
        pairs = list(zip(controls, ours, strict=True))
        unique = {pair: i for i, pair in enumerate(dict.fromkeys(pairs))}
        time = np.arange(ticks) * period
        targets, phases = [], []
        for control, robot in unique:
            check_swim(robot, control.swim)
            targets.append(control.targets(robot, time))
            _check(robot, targets[-1])
            phases.append(np.repeat((control.swim.frequency * time)[:, None], len(layout(robot).limbs), axis=1))
        return Table(np.array(targets), np.array(phases), np.array([unique[pair] for pair in pairs]))


def _check(robot: Crocodile, targets: np.ndarray) -> None:
    """Refuse angles beyond the joints' ranges."""
    ranges = servo_ranges(robot)
    least, most = targets.min(axis=0), targets.max(axis=0)
    for name, low, high, (least_here, most_here) in zip(layout(robot).servos, least, most, ranges, strict=True):
        if low < least_here - 1e-9 or high > most_here + 1e-9:
            raise OutsideLimits(
                f"swimming asks {name} of robot {robot.name!r} for {low:.3f} to {high:.3f} rad; {least_here:.3f} to "
                f"{most_here:.3f} rad is allowed: bend less, or steer less."
            )
