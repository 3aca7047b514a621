"""From swimming to walking and back, by the load that the ground is felt to carry."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float

from suchus.control.controller import Command, Controller
from suchus.control.heading import Heading, HeadingRule
from suchus.control.sensed import Sensed, finite, keep
from suchus.control.swimming import Swimming
from suchus.design import GRAVITY, AnyRobot, general, layout
from suchus.design.checks import Checks
from suchus.errors import InvalidDesign
from suchus.motion import START, AnyGait, Gait, Pattern, steerable, steered

_SLACK = 1e-9  # [s]
_GROWS = 0.5  # [cycle]; over which stroke and bends grow when the walk begins


@dataclass(frozen=True, slots=True, kw_only=True)
class Amphibious:
    """Swims where the water carries the robot and walks in the run's gait where the ground does.

    Felt is what feet, belly and tail carry, in shares of the robot's weight, through a low pass. Above ``touch`` the
    robot walks, below ``afloat`` it swims, between the two it goes on as before; a change takes ``change``, in which
    nothing else is decided, and ``patience`` must pass before the next. While it swims its limbs' phases stand still.
    """

    swim: Swimming
    """How it swims; with its heading hold."""
    begins: Literal["swimming", "walking"] = "swimming"
    """In what it begins."""
    touch: float = 0.02
    """Share of the weight on the ground from which it walks [-]; a snout on the sand carries 0.035 to 0.05."""
    afloat: float = 0.004
    """Share of the weight on the ground below which it swims [-]."""
    memory: float = 0.4
    """Time constant of the low pass [s]."""
    change: float = 1.2
    """How long a change of posture takes [s]."""
    patience: float = 1.0
    """Least time between the end of a change and the next [s]."""
    breathe_out: float = 0.0
    """Share of the air of the hull that it lets out when it begins to walk, and takes in when it swims [-]."""
    pump: float = 0.25
    """Rate at which the share of the air changes [1/s]."""
    heading: HeadingRule | None = None
    """Which keeps the direction of the walk; None for none."""

    def __post_init__(self) -> None:
        with Checks("amphibious", self) as check:
            check.number("touch", 0.0, 1.0, "")
            check.number("afloat", 0.0, 1.0, "")
            check.that(
                self.afloat < self.touch,
                f"amphibious.afloat is {self.afloat:g} and amphibious.touch {self.touch:g}; afloat must be less, "
                "so that the robot does not change to and fro",
            )
            check.number("memory", 0.0, 60.0, "s")
            check.number("change", 0.05, 60.0, "s")
            check.number("patience", 0.0, 600.0, "s")
            check.number("breathe_out", 0.0, 1.0, "")
            check.number("pump", 1e-3, 100.0, "1/s")
            check.that(
                self.begins in ("swimming", "walking"),
                f"amphibious.begins is {str(self.begins)[:40]!r}; swimming or walking is allowed",
            )
            check.that(
                self.swim.depth is None,
                "amphibious.swim holds a depth; a robot that comes ashore swims at the surface: leave out swim.depth",
            )

    @property
    def feels(self) -> bool:
        """It decides by what it feels."""
        return True

    def start(
        self, robots: Sequence[AnyRobot], gaits: Sequence[AnyGait], seeds: Sequence[int], ticks: int, period: float
    ) -> "Amphibian":
        """Start it for every robot; see ``start_together``."""
        return self.start_together([self] * len(robots), robots, gaits, seeds, ticks, period)

    @staticmethod
    def start_together(
        controls: Sequence["Amphibious"],
        robots: Sequence[AnyRobot],
        gaits: Sequence[AnyGait],
        seeds: Sequence[int],
        ticks: int,
        period: float,
    ) -> "Amphibian":
        """Start it for a batch, each run with its own control.

        Raises:
            OutsideLimits: a robot cannot follow its swim, or a gait is a table of angles.
            UnsuitedRobot: a robot does not swim by trunk and cable.
            InvalidDesign: a robot that is to breathe out has no air.
        """
        ours = [steerable(gait, "a walk that begins and ends in water") for gait in gaits]
        for control, robot in zip(controls, robots, strict=True):
            hull = general(robot).hull
            if control.breathe_out > 0.0 and (hull is None or hull.air == 0.0):
                raise InvalidDesign(
                    f"amphibious.breathe_out is {control.breathe_out:g}, and robot {robot.name!r} has no air that it "
                    "could let out: leave it at 0, or give the robot a design.Hull with air."
                )
        swims = Swimming.start_together([one.swim for one in controls], robots, gaits, seeds, ticks, period)
        return Amphibian(controls, robots, ours, swims, period)


class Amphibian:
    """The running controller of a batch between water and land."""

    def __init__(
        self,
        controls: Sequence[Amphibious],
        robots: Sequence[AnyRobot],
        gaits: Sequence[Gait | Pattern],
        swims: Controller,
        period: float,
    ) -> None:
        self._period, self._swims, self._gaits = period, swims, list(gaits)
        self._touch, self._afloat, self._change, self._patience, self._out, self._pump = (
            np.array([getattr(control, name) for control in controls])
            for name in ("touch", "afloat", "change", "patience", "breathe_out", "pump")
        )
        self._kept = np.array([keep(control.memory, period) for control in controls])
        self._weight = np.array([robot.mass * GRAVITY for robot in robots])
        n, limbs = len(robots), len(layout(robots[0]).limbs)
        self.walking: Bool[np.ndarray, " run"] = np.array([control.begins == "walking" for control in controls])
        """Which robots walk, or are about to."""
        self._blend = self.walking.astype(float)  # 0 swims, 1 walks
        self._load = self._blend.copy()  # [-]; so that a robot on land does not begin by swimming
        self._since = np.where(self.walking, np.inf, 0.0)  # the last change [s]
        self._cycles = np.zeros(n)  # walked so far [cycle]
        self._grown = np.zeros(n)  # walked without a break [cycle]
        self._breath = 1.0 - self._out * self._blend
        self._cycle = np.array([gait.period for gait in gaits])
        self._phases = np.array([gait.limb_phases for gait in gaits])
        self._heading = Heading([one.heading for one in controls], robots, gaits, period)
        members: dict[object, list[int]] = {}
        for run, pair in enumerate(zip(robots, gaits, strict=True)):
            members.setdefault(pair, []).append(run)
        self._groups = [(robots[runs[0]], gaits[runs[0]], np.array(runs)) for runs in members.values()]
        self._stroke, self._trunk = np.ones((n, limbs)), np.zeros(n)

    @property
    def load(self) -> Float[np.ndarray, " run"]:
        """Share of the weight that the ground carries, through the low pass [-]."""
        return self._load

    def rest(self) -> Float[np.ndarray, "run servo"]:
        """The posture in which it begins."""
        return self._mixed(self._swims.rest())

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Feel, decide, and go on swimming, walking or changing."""
        time = tick * self._period
        if sensed is not None:
            self._feel(sensed)
            if time >= START - _SLACK:
                self._decide()
        swum = self._swims.command(tick, sensed).targets
        targets = self._mixed(swum)
        phase = self._phase
        if time >= START - _SLACK:
            self._advance()
        return Command(targets, phase, self._breath.copy())

    @property
    def _phase(self) -> np.ndarray:
        return self._cycles[:, None] + self._phases

    def _feel(self, sensed: Sensed) -> None:
        feet, belly = finite(sensed.foot_pressure), finite(sensed.belly_pressure)
        load = (feet.sum(axis=1) + belly.sum(axis=1) + finite(sensed.tail_pressure)) / self._weight
        self._load = load + self._kept * (self._load - load)
        walks = self._blend >= 1.0
        steer = self._heading.step(sensed, walking=walks)
        self._stroke, self._trunk = 1.0 + steer.stroke, steer.trunk

    def _decide(self) -> None:
        free = self._since >= self._change + self._patience
        other = np.where(self.walking, self._load < self._afloat, self._load > self._touch)
        turns = free & other
        self.walking = self.walking ^ turns
        self._since = np.where(turns, 0.0, self._since + self._period)

    def _advance(self) -> None:
        step = np.where(self.walking, 1.0, -1.0) * self._period / self._change
        walks = self._blend >= 1.0
        self._blend = np.clip(self._blend + step, 0.0, 1.0)
        self._cycles = self._cycles + walks * self._period / self._cycle
        self._grown = np.where(walks, self._grown + self._period / self._cycle, 0.0)
        asked = 1.0 - self._out * self.walking
        most = self._pump * self._period
        self._breath = self._breath + np.clip(asked - self._breath, -most, most)

    def _mixed(self, swum: np.ndarray) -> np.ndarray:
        """Return the posture between that of the swim and that of the walk, shape (run, servo) [rad]."""
        if not self._blend.any():
            return swum
        phase, none, walked = self._phase, np.zeros_like(self._stroke), np.zeros_like(swum)
        size = np.clip(self._grown / _GROWS, 0.0, 1.0)
        for robot, gait, runs in self._groups:
            walked[runs] = steered(
                robot, gait, phase[runs], trunk=self._trunk[runs], size=size[runs], stroke=self._stroke[runs],
                lower=none[runs],
            )  # fmt: skip
        share = (self._blend**2 * (3.0 - 2.0 * self._blend))[:, None]
        return np.asarray(swum + share * (walked - swum))
