"""By how much robots that are built of one design differ from it, and their grounds from each other."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from math import radians

import numpy as np

from suchus.core.checks import Checks
from suchus.robot.design import Robot, servo_names
from suchus.robot.design.limb import Girdle
from suchus.robot.design.segment import Inertia, Segment
from suchus.sim.land.run import Run


@dataclass(frozen=True, slots=True, kw_only=True)
class Tolerances:
    """Errors of a built robot and its ground, each drawn evenly about the design or from none up to its size.

    None of them has a direction of its own: a servo's zero lies as often too far forward as too far back, and its play
    takes as much from a movement to one side as from that to the other.
    """

    zero_error: float = radians(1.0)
    """Greatest error of a servo's zero, to either side [rad]. A spline of 25 teeth sets the horn to 14.4 degrees; what
    is left is trimmed away by eye against a mark, to about a degree."""
    dead_band: float = radians(270.0 * 3.0 / 2000.0)
    """Greatest dead band of a servo, whole width [rad]: 3 us of 2000 us for 270 degrees, as data sheets of digital
    hobby servos say; a servo does not answer smaller changes of its command."""
    backlash: float = radians(20.0 / 60.0)
    """Greatest play of a servo's gear, whole width [rad]: 20 minutes of arc, data sheet of the Dynamixel MX-28."""
    friction: float = 0.1
    """Greatest error of the friction of ground and robot, as a part of it [-]. No data sheet: one material on the
    floors of one building."""
    mass: float = 0.05
    """Greatest error of the mass of each segment and each limb, as a part of it [-]. No data sheet: screws, glue,
    cables and fillings of printed parts, which a drawing leaves out."""

    def __post_init__(self) -> None:
        """Refuse errors that are negative or larger than any build has."""
        with Checks("tolerances", self) as check:
            for name in ("zero_error", "dead_band", "backlash"):
                check.number(name, 0.0, 1.0, "rad")
            check.number("friction", 0.0, 0.9, "")
            check.number("mass", 0.0, 0.9, "")

    def draw_run(self, run: Run, seed: int) -> Run:
        """Return a run with one robot that was built of its design, on one ground.

        Args:
            run: run as designed; its own zero errors and plays are replaced.
            seed: seed of the errors; runs of equal bodies with equal seeds get the same.
        """
        rng = np.random.default_rng(seed)
        servos = len(servo_names(run.robot))
        zero_error = rng.uniform(-self.zero_error, self.zero_error, servos)
        play = rng.uniform(0.0, self.dead_band, servos) + rng.uniform(0.0, self.backlash, servos)
        friction = rng.uniform(1.0 - self.friction, 1.0 + self.friction)
        masses = rng.uniform(1.0 - self.mass, 1.0 + self.mass, len(run.robot.axis) + len(run.robot.girdles))
        return replace(
            run,
            robot=with_masses(run.robot, masses.tolist()),
            ground=replace(run.ground, friction_scale=float(friction) * run.ground.friction_scale),
            zero_error=tuple(zero_error.tolist()),
            play=tuple(play.tolist()),
        )

    def repeats(self, runs: Iterable[Run], count: int, seed: int = 0) -> list[Run]:
        """Return so many built robots of each run, run by run; the i-th of each has the same errors."""
        seeds = np.random.SeedSequence(seed).generate_state(count).tolist()
        return [self.draw_run(run, robot_seed) for run in runs for robot_seed in seeds]


def with_masses(robot: Robot, factors: list[float]) -> Robot:
    """Return a robot with other masses: a factor for each segment of the axis, then one for each girdle's limbs."""
    axis = tuple(_segment(segment, factor) for segment, factor in zip(robot.axis, factors, strict=False))
    limbs = factors[len(robot.axis) :]
    girdles = tuple(_girdle(girdle, factor) for girdle, factor in zip(robot.girdles, limbs, strict=True))
    return replace(robot, axis=axis, girdles=girdles)


def _segment(segment: Segment, factor: float) -> Segment:
    shapes = tuple(replace(shape, mass=factor * shape.mass) for shape in segment.shapes)
    return replace(segment, shapes=shapes, inertia=_inertia(segment.inertia, factor))


def _girdle(girdle: Girdle, factor: float) -> Girdle:
    limb = girdle.limb
    links = tuple(replace(link, mass=factor * link.mass, inertia=_inertia(link.inertia, factor)) for link in limb.links)
    return replace(girdle, limb=replace(limb, links=links, foot=replace(limb.foot, mass=factor * limb.foot.mass)))


def _inertia(inertia: Inertia | None, factor: float) -> Inertia | None:
    """Return where a mass lies that is so many times as large."""
    if inertia is None:
        return None
    (xx, yy, zz), (xy, xz, yz) = inertia.moments, inertia.products
    products = (factor * xy, factor * xz, factor * yz)
    return replace(inertia, moments=(factor * xx, factor * yy, factor * zz), products=products)
