"""Change between swimming and walking by the sensed ground load."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import pi
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float

from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign
from suchus.robot.control.controller import Command, Controller, Runs, union_of_needs
from suchus.robot.control.heading import Heading, HeadingRule
from suchus.robot.control.sensed import Sensed, decay_factor, finite
from suchus.robot.control.swimming import Swimming
from suchus.robot.design import GRAVITY, Robot, layout
from suchus.robot.motion import START, Batch, Bend, FixedLimbs, Gait, Steer, check_limits

_SLACK = 1e-9  # [s]
_GROWS = 0.5  # [cycle]; over which stroke and bends grow when the walk begins


@dataclass(frozen=True, slots=True, kw_only=True)
class Amphibious:
    """Swims where the water carries the robot and walks in the run's gait where the ground does.

    The sensed load is the low-pass-filtered contact force of feet, belly and tail, as a fraction of body weight. Above
    ``touch`` the robot lands: it lets air out and walks in the gait ``wade`` until the load exceeds ``aground``. Then
    it takes the air in again and walks in the run's gait. It swims again when its feet have carried less than
    ``afloat`` for a whole cycle, in which each foot had its stance; the load on belly and tail does not count for
    this. A change of posture takes ``change``; after it ``patience`` must pass before the next one. While the robot
    swims, the phases of its limbs stand still.
    """

    swim: Gait
    """Gait in which it swims."""
    swimming: Swimming = field(default_factory=Swimming)
    """What it holds as it swims, at the surface."""
    begins: Literal["swimming", "walking"] = "swimming"
    """In what it begins."""
    touch: float = 0.02
    """Share of the weight on the ground from which it walks [-]; a snout on the sand carries 0.035 to 0.05."""
    afloat: float = 0.02
    """Share of the weight on the feet below which they do not push [-]; at a friction of 0.6 a share of 0.02 holds
    against 0.4 N on the floating caiman, the drag of its walking posture at 0.2 m/s."""
    aground: float = 0.8
    """Share of the weight on the ground from which it has landed [-]; on dry land it is 1 in the mean, with dips."""
    wade: Gait | None = None
    """In which it walks while it lands; None for the run's gait."""
    memory: float = 0.4
    """Time constant of the low pass [s]."""
    change: float = 1.2
    """How long a change of posture takes [s]."""
    patience: float = 1.0
    """Least time between the end of a change and the next [s]."""
    air_released: float = 0.0
    """Share of the air of the hull that it lets out while it lands [-]."""
    pump: float = 0.25
    """Rate at which the share of the air changes [1/s]."""
    heading: HeadingRule | None = None
    """Which keeps the direction of the walk; None for none."""

    def __post_init__(self) -> None:
        with Checks("amphibious", self) as check:
            check.number("touch", 0.0, 1.0, "")
            check.number("afloat", 0.0, 1.0, "")
            check.number("aground", 0.0, 1.0, "")
            check.that(
                max(self.afloat, self.touch) < self.aground,
                f"amphibious.aground is {self.aground:g}, amphibious.touch {self.touch:g} and amphibious.afloat "
                f"{self.afloat:g}; aground must be the greatest, so that it lands before it has landed",
            )
            check.number("memory", 0.0, 60.0, "s")
            check.number("change", 0.05, 60.0, "s")
            check.number("patience", 0.0, 600.0, "s")
            check.number("air_released", 0.0, 1.0, "")
            check.number("pump", 1e-3, 100.0, "1/s")
            check.that(
                self.begins in ("swimming", "walking"),
                f"amphibious.begins is {str(self.begins)[:40]!r}; swimming or walking is allowed",
            )
            check.that(
                self.swimming.depth is None,
                "amphibious.swimming holds a depth; a robot that comes ashore swims at the surface: leave out "
                "swimming.depth",
            )

    @property
    def feels(self) -> bool:
        """Whether it reads sensors: always."""
        return True

    @property
    def needs(self) -> tuple[str, ...]:
        """Sensors of the ground load, and those of the rules for swim and heading."""
        return union_of_needs(
            ("foot_pressure", "belly_pressure", "tail_pressure"),
            self.swimming.needs,
            ("orientation", "servo_position") if self.heading else (),
        )

    @staticmethod
    def start(runs: Runs, period: float) -> "Amphibian":
        """Start it for a batch, each run with its own control.

        Raises:
            OutsideLimits: a robot cannot follow its swim, or a gait has measured curves.
            InvalidDesign: a robot that is to let air out has no air.
        """
        controls, robots, gaits = runs.controls, runs.robots, runs.gaits
        wades = tuple(control.wade or gait for control, gait in zip(controls, gaits, strict=True))
        for gait in (*gaits, *wades):
            gait.needs_steering("a walk that begins and ends in water")
        for control, robot in zip(controls, robots, strict=True):
            hull = robot.hull
            if control.air_released > 0.0 and (hull is None or hull.air == 0.0):
                raise InvalidDesign(
                    f"amphibious.air_released is {control.air_released:g}, and robot {robot.name!r} has no air that it "
                    "could let out: leave it at 0, or give the robot a design.Hull with air."
                )
        for robot, swim in {*zip(robots, (control.swim for control in controls), strict=True)}:
            check_limits(robot, swim)
        swimmers = runs._replace(
            controls=tuple(control.swimming for control in controls), gaits=tuple(control.swim for control in controls)
        )
        swims = Swimming.start(swimmers, period)
        return Amphibian(controls, robots, gaits, wades, swims, period)


class Amphibian:
    """The running controller of a batch between water and land."""

    def __init__(
        self,
        controls: Sequence[Amphibious],
        robots: Sequence[Robot],
        gaits: Sequence[Gait],
        wades: Sequence[Gait],
        swims: Controller,
        period: float,
    ) -> None:
        """Start every run in the mode that its control begins with.

        Args:
            controls: settings, one for each run.
            robots: robot of each run.
            gaits: gaits of the walk on land, one for each run.
            wades: gaits of the walk while a robot lands, one for each run.
            swims: controller of the swims of the whole batch.
            period: control period [s].
        """
        self._period, self._swims = period, swims
        self._touch, self._afloat_load, self._aground, self._change, self._patience, self._air_released, self._pump = (
            np.array([getattr(control, name) for control in controls])
            for name in ("touch", "afloat", "aground", "change", "patience", "air_released", "pump")
        )
        self._decay = np.array([decay_factor(control.memory, period) for control in controls])
        self._weight = np.array([robot.mass * GRAVITY for robot in robots])
        n, limbs = len(robots), len(layout(robots[0]).limbs)
        self.walking: Bool[np.ndarray, " run"] = np.array([control.begins == "walking" for control in controls])
        """Which robots walk, or are about to."""
        self._blend = self.walking.astype(float)  # 0 swims, 1 walks [-]
        self.landing: Bool[np.ndarray, " run"] = np.zeros(n, dtype=bool)
        """Which robots walk, and are not yet carried by the ground."""
        self._landed = np.ones(n)  # 0 wades, 1 walks in the run's gait
        self._load = self._blend.copy()  # [-]; a robot that begins on land is loaded
        self._feet = self._load.copy()  # [-]; of the weight on the feet
        self._lifted = np.zeros(n)  # time for which the feet have carried less than ``afloat`` [s]
        self._since = np.where(self.walking, np.inf, 0.0)  # time since the last change [s]
        self._cycles = np.zeros(n)  # walked so far [cycle]
        self._unbroken_cycles = np.zeros(n)  # walked without a break [cycle]
        self._air_fraction = np.ones(n)
        self._cycle, self._wade_cycle = (
            np.array([gait.period for gait in batch_gaits]) for batch_gaits in (gaits, wades)
        )
        self._phases, self._wade_phases = (
            np.array([gait.limb_phases for gait in batch_gaits]) for batch_gaits in (gaits, wades)
        )
        self._heading = Heading([control.heading for control in controls], robots, gaits, period)
        self._batch, self._wade_batch = Batch(robots, gaits), Batch(robots, wades)
        self._stroke, self._trunk = np.ones((n, limbs)), np.zeros(n)

    @property
    def load(self) -> Float[np.ndarray, " run"]:
        """Share of the weight that the ground carries, through the low pass [-]."""
        return self._load

    def rest(self) -> Float[np.ndarray, "run servo"]:
        """The posture in which it begins."""
        return self._mixed(self._swims.rest())

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Return the servo angles and the air fraction of every run for one control period.

        Args:
            tick: number of the control period.
            sensed: readings.
        """
        time = tick * self._period
        if sensed is not None:
            self._feel(sensed)
            if time >= START - _SLACK:
                self._decide()
        swim_targets = self._swims.command(tick, sensed).targets
        targets = self._mixed(swim_targets)
        phase = self._phase
        if time >= START - _SLACK:
            self._advance()
        return Command(targets, phase, np.column_stack([self._air_fraction, self._air_fraction]))

    @property
    def _phase(self) -> np.ndarray:
        return self._cycles[:, None] + self._wade_phases + self._landed[:, None] * (self._phases - self._wade_phases)

    def _feel(self, sensed: Sensed) -> None:
        """Update the filtered loads of ground and feet, and the steering of the walk."""
        feet, belly = finite(sensed.foot_pressure), finite(sensed.belly_pressure)
        stands = feet.sum(axis=1) / self._weight
        load = stands + (belly.sum(axis=1) + finite(sensed.tail_pressure)) / self._weight
        self._load = load + self._decay * (self._load - load)
        self._feet = stands + self._decay * (self._feet - stands)
        walks = self._blend >= 1.0
        steer = self._heading.step(sensed, walking=walks)
        self._stroke, self._trunk = 1.0 + steer.stroke, steer.trunk

    def _decide(self) -> None:
        """Change between swimming and walking where the loads ask for it, and note who has landed."""
        self._lifted = np.where(self._feet < self._afloat_load, self._lifted + self._period, 0.0)
        is_change_due = np.where(self.walking, self._lifted >= 1.0 / self._rate, self._load > self._touch)
        is_changing = is_change_due & (self._since >= self._change + self._patience)
        self.landing = np.where(is_changing, ~self.walking, self.landing & (self._load < self._aground))
        self.walking = self.walking ^ is_changing
        self._since = np.where(is_changing, 0.0, self._since + self._period)

    @property
    def _rate(self) -> np.ndarray:
        """Return cycles over time, shape (run,) [1/s]."""
        return np.asarray((1.0 - self._landed) / self._wade_cycle + self._landed / self._cycle)

    def _advance(self) -> None:
        """Advance postures, clocks and air by one control period."""
        step = self._period / self._change
        walks = self._blend >= 1.0
        self._cycles = self._cycles + walks * self._rate * self._period
        self._unbroken_cycles = np.where(walks, self._unbroken_cycles + self._rate * self._period, 0.0)
        self._blend = np.clip(self._blend + np.where(self.walking, step, -step), 0.0, 1.0)
        landed = np.clip(self._landed + np.where(self.landing, -step, step), 0.0, 1.0)
        self._landed = np.where(
            walks | ~self.walking, landed, 1.0 - self.landing
        )  # a robot that begins to wade stands up
        air_target = 1.0 - self._air_released * self.landing
        max_step = self._pump * self._period
        self._air_fraction = self._air_fraction + np.clip(air_target - self._air_fraction, -max_step, max_step)

    def _mixed(self, swim_targets: np.ndarray) -> np.ndarray:
        """Return the posture between that of the swim and that of the walk, shape (run, servo) [rad].

        Args:
            swim_targets: servo angles of the swim, shape (run, servo) [rad].
        """
        if not self._blend.any():
            return swim_targets
        walk_targets = self._walk_posture(self._batch)
        if (self._landed < 1.0).any():
            wade_targets = self._walk_posture(self._wade_batch)
            walk_targets = wade_targets + _eased(self._landed) * (walk_targets - wade_targets)
        return np.asarray(swim_targets + _eased(self._blend) * (walk_targets - swim_targets))

    def _walk_posture(self, gaits: Batch) -> np.ndarray:
        """Return the postures of gaits at the present phases, shape (run, servo) [rad]."""
        steer = Steer(size=np.clip(self._unbroken_cycles / _GROWS, 0.0, 1.0), stroke=self._stroke, bend=self._trunk)
        return gaits.targets(self._phase, gaits.axis_phase(self._phase, self._cycles), steer)


def _eased(fraction: np.ndarray) -> np.ndarray:
    """Return fractions eased by 3 x^2 - 2 x^3, whose rate is zero at both ends, shape (run, 1)."""
    return np.asarray(fraction**2 * (3.0 - 2.0 * fraction))[:, None]


controller = Amphibious
_WAVE = Gait(
    name="wave",
    period=1.0,
    limb_phases=(0.0,) * 4,
    limbs=(FixedLimbs(angles=(-pi / 2, -0.15)),) * 2,
    axis=(
        Bend(part="trunk", amplitude=(0.33, 0.39, 1.08), lag=(-0.29, -0.11, 0.08)),
        Bend(part="tail", amplitude=(0.75,), lag=(0.39,)),
    ),
)
examples = (Amphibious(swim=_WAVE),)
