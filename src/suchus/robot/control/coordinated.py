"""The closed loop: limbs, spine and tail each with a rule of its own, joined by the shared variables."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks, require
from suchus.core.errors import InvalidDesign, UnsuitedRobot
from suchus.robot.control.controller import Command, Runs, union_of_needs
from suchus.robot.control.heading import Heading, HeadingRule, Steering
from suchus.robot.control.limbs import LAWS, LimbLaw, Limbs, in_pairs
from suchus.robot.control.open_loop import OpenLoop
from suchus.robot.control.sensed import Sensed
from suchus.robot.control.shared import initial_shared
from suchus.robot.control.spine import SpineController, SpineRule
from suchus.robot.control.tail import TailController, TailRule
from suchus.robot.design import Robot, layout
from suchus.robot.motion import START, Batch, Gait, Steer

_SLACK = 1e-9  # [s]; times are multiples of the control period up to rounding
_STRAIGHT = Steer()  # nothing is steered; feet are drawn into what limbs reach


@dataclass(frozen=True, slots=True)
class Kick:
    """A disturbance of the clock: limbs that jump ahead."""

    at: float
    """Time of the kick [s]."""
    ahead: tuple[float, ...]
    """Phase by which each limb jumps, in the order of the robot's limbs, LF, RF, LH, RH of the article's [cycle]."""

    def __post_init__(self) -> None:
        require("kick", "at", self.at, 0.0, 86400.0, "s")
        for i, cycles in enumerate(self.ahead):
            require("kick", f"ahead[{i}]", cycles, -1.0, 1.0, "cycle")


@dataclass(frozen=True, slots=True, kw_only=True)
class Coordinated:
    """Three feedback rules over the gait's clock, and an optional heading loop.

    With the law ``off`` and no rule the commands are those of ``OpenLoop``, to the bit.

    Paper: section III.D, Fig. 10.
    """

    limbs: LimbLaw = LAWS["cross_load"]
    """Limb to limb; ``LAWS["off"]`` for none."""
    spine: SpineRule | None = field(default_factory=SpineRule)
    """Spine to spine; None for none: the trunk still follows the limbs' phases."""
    tail: TailRule | None = field(default_factory=TailRule)
    """Tail to tail; None for none: the tail still follows the trunk."""
    heading: HeadingRule | None = None
    """Rule that keeps the heading of the walk; None for none."""
    sharing: bool = True
    """Whether spine and tail hear of the limbs' phases; if not they follow the clock, each for itself."""
    random_start: bool = False
    """Whether the limbs begin with random phases, drawn with the run's seed, instead of the gait's."""
    kicks: tuple[Kick, ...] = ()
    """Limbs that jump ahead, and when."""
    load_noise: float = 0.0
    """Standard deviation of the noise on what each foot feels, as a part of the load [-]; drawn with the run's seed."""

    def __post_init__(self) -> None:
        with Checks("coordinated", self) as checks:
            checks.number("load_noise", 0.0, 10.0, "")

    @property
    def feels(self) -> bool:
        """Whether any rule is on."""
        return self.limbs.feels or any(rule is not None for rule in (self.spine, self.tail, self.heading))

    @property
    def needs(self) -> tuple[str, ...]:
        """What the rules that are on feel."""
        return union_of_needs(
            self.limbs.needs,
            ("servo_position",) if self.spine else (),
            ("servo_torque",) if self.tail else (),
            ("orientation", "servo_position") if self.heading else (),
        )

    def suited(self, robot: Robot, gait: Gait) -> "Coordinated":
        """Return the control with those of its rules that the robot's parts allow in a gait.

        A law that makes diagonal pairs is switched off in a gait without them.
        """
        place = layout(robot)
        return replace(
            self,
            limbs=LAWS["off"] if not place.limbs or (self.limbs.pairs and not in_pairs(place, gait)) else self.limbs,
            spine=self.spine if place.trunk_yaw else None,
            tail=self.tail if place.tail_pitch and gait.has("tail pitch") else None,
        )

    @staticmethod
    def start(runs: Runs, period: float) -> "Coordinator":
        """Start the rules of a batch, each run with its own."""
        return Coordinator(runs, period)


class Coordinator:
    """The controllers of limbs, spine and tail of a batch, and the posture that they ask for together."""

    def __init__(self, runs: Runs, period: float) -> None:
        """Start the oscillators and rules of a batch.

        Args:
            runs: controls, robots, gaits and seeds.
            period: control period [s].

        Raises:
            InvalidDesign: a kick has not one phase for each limb.
            UnsuitedRobot: a robot lacks the parts that one of its rules needs.
        """
        controls, robots, gaits, seeds, _ = runs
        for gait in gaits:
            gait.needs_steering("the closed loop")
        for setting in set(zip(controls, robots, gaits, strict=True)):
            _refuse_others(*setting)
        limbs = len(layout(robots[0]).limbs)
        self._period = period
        self._table = OpenLoop.start(runs._replace(controls=(OpenLoop(),) * len(robots)), period)
        self._gaits = Batch(robots, gaits)
        phase_lead = np.zeros((len(robots), limbs))
        noise: dict[int, tuple[float, np.random.Generator]] = {}
        self._kicks: dict[int, list[tuple[int, np.ndarray]]] = {}
        for run, (control, gait, seed) in enumerate(zip(controls, gaits, seeds, strict=True)):
            if control.random_start:
                phase_lead[run] = np.random.default_rng([seed, 0]).random(limbs) - gait.limb_phases
            if control.load_noise > 0.0:
                noise[run] = control.load_noise, np.random.default_rng([seed, 1])
            for kick in control.kicks:
                self._kicks.setdefault(int(np.ceil(kick.at / period - _SLACK)), []).append((run, np.array(kick.ahead)))
        self._noise = _LoadNoise(noise, limbs) if noise else None
        self._hears = np.array([control.sharing for control in controls])[:, None]
        self._limbs = Limbs([control.limbs for control in controls], robots, gaits, phase_lead, period)
        self._spine = SpineController([control.spine for control in controls], robots, period)
        self._tail = TailController([control.tail for control in controls], robots, gaits, period)
        steers = any(control.heading is not None for control in controls)
        self._heading = Heading([control.heading for control in controls], robots, gaits, period) if steers else None
        self._shared = initial_shared(len(robots), limbs)
        self._all_hear = bool(self._hears.all())
        self._steering = Steering.straight(len(robots), limbs)
        self._has_walked = False

    def take_over(self, predecessor: "Coordinator") -> None:
        """Continue from another coordinator of the same runs, with other gaits or rules."""
        self._limbs.take_over(predecessor._limbs)
        self._spine.take_over(predecessor._spine)
        self._tail.take_over(predecessor._tail)
        self._shared = predecessor._shared
        self._has_walked = predecessor._has_walked
        if self._heading is not None and predecessor._heading is not None:
            self._heading.take_over(predecessor._heading)
        elif self._has_walked:
            self.begin_in_motion()

    def begin_in_motion(self) -> None:
        """Let the heading loops count from the mean heading of the coming cycle, for robots that move already."""
        self._has_walked = True
        if self._heading is not None:
            self._heading.begin_in_motion()

    def rest(self) -> Float[np.ndarray, "run servo"]:
        """The posture of the first phases."""
        self._share(0, None, walking=False)
        return self._posture()

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Return the servo targets after every controller has read the shared variables and its sensors.

        Args:
            tick: number of the control period.
            sensed: readings; None if no rule is on.
        """
        walking = tick * self._period >= START - _SLACK
        for run, phase_lead in self._kicks.get(tick, ()):
            self._limbs.kick(run, phase_lead)
        if sensed is not None and self._noise is not None:
            sensed = replace(sensed, foot_pressure=self._noise.disturb(sensed.foot_pressure))
        self._share(tick, sensed, walking=walking)
        if sensed is not None and self._heading is not None:
            self._steering = self._heading.step(sensed, walking=walking)
        self._has_walked = self._has_walked or walking
        targets = self._posture()
        if sensed is not None and walking:
            targets = self._spine.correct(targets, self._shared.trunk_bend + self._steering.trunk, sensed)
            targets = self._tail.correct(targets, sensed)
        return Command(targets, self._shared.limb_phase)

    def _clock(self, tick: int) -> Float[np.ndarray, " run"]:
        """Return the time since the walk began [cycle]."""
        return np.asarray(max(tick * self._period - START, 0.0) / self._gaits.periods)

    def _share(self, tick: int, sensed: Sensed | None, *, walking: bool) -> None:
        """Let limbs, spine and tail write their shared variables, in this order."""
        self._planned = self._table.command(tick, None)
        phases, clock = self._planned.phase, self._clock(tick)
        limbs = self._limbs.step(self._shared, sensed, phases, walking=walking)
        heard = limbs
        if not self._all_hear:
            heard = replace(limbs, limb_phase=np.where(self._hears, limbs.limb_phase, phases))
        self._axis = self._gaits.axis_phase(heard.limb_phase, clock)
        spine_state = self._spine.step(heard, self._gaits, clock, self._axis)
        axis_state = self._tail.step(spine_state, self._gaits, clock)
        self._shared = axis_state if self._all_hear else replace(axis_state, limb_phase=limbs.limb_phase)

    def _posture(self) -> Float[np.ndarray, "run servo"]:
        """Return the servo angles; those of the table for runs without phase lead and steering."""
        table = self._planned.targets
        is_adjusted: np.ndarray = np.logical_or.reduce(self._limbs.phase_lead, axis=1)
        if self._heading is not None:
            is_adjusted |= self._steering.is_active()
        if not is_adjusted.any():
            return table
        steer = _STRAIGHT
        if self._heading is not None:
            steer = Steer(stroke=1.0 + self._steering.stroke, bend=self._steering.trunk)
        targets = self._gaits.targets(self._shared.limb_phase, self._axis, steer)
        return targets if is_adjusted.all() else np.where(is_adjusted[:, None], targets, table)


class _LoadNoise:
    """Noise on what feet feel, drawn for many control periods at a time: the numbers are those of single draws."""

    _DRAWN = 256  # control periods

    def __init__(self, loudness_and_rng: Mapping[int, tuple[float, np.random.Generator]], limbs: int) -> None:
        """Begin with the noise of the first control periods.

        Args:
            loudness_and_rng: standard deviation [-] and generator of each run that has noise.
            limbs: number of limbs of each robot.
        """
        self._runs = list(loudness_and_rng)
        self._loudness = np.array([loudness for loudness, _ in loudness_and_rng.values()])[:, None]
        self._rngs, self._limbs = [rng for _, rng in loudness_and_rng.values()], limbs
        self._noise, self._next = np.zeros((len(self._runs), 0, limbs)), 0

    def disturb(self, pressure: Float[np.ndarray, "run limb"]) -> Float[np.ndarray, "run limb"]:
        """Return the pressures of one more control period with their noise [N]."""
        if self._next == self._noise.shape[1]:
            self._noise = np.stack([rng.standard_normal((self._DRAWN, self._limbs)) for rng in self._rngs])
            self._next = 0
        disturbed = pressure.copy()
        disturbed[self._runs] *= np.maximum(1.0 + self._loudness * self._noise[:, self._next], 0.0)
        self._next += 1
        return disturbed


def _refuse_others(control: Coordinated, robot: Robot, gait: Gait) -> None:
    """Refuse a control whose kicks or rules do not fit the robot.

    Raises:
        InvalidDesign: a kick has not one phase for each limb.
        UnsuitedRobot: the robot lacks the parts that a rule needs.
    """
    place = layout(robot)
    for kick in control.kicks:
        if len(kick.ahead) != len(place.limbs):
            raise InvalidDesign(
                f"kick.ahead has {len(kick.ahead)} numbers; {', '.join(place.limb_names) or 'no limbs'} of robot "
                f"{robot.name!r} need one each."
            )
    if control.heading is not None and not place.limbs:
        raise UnsuitedRobot(
            f"the heading loop strides longer on one side and needs limbs to walk on; robot {robot.name!r} lacks that: "
            "leave the loop out."
        )
    fit = control.suited(robot, gait)
    for rule, needs in (
        ("spine", "servos that bend the trunk sideways"),
        ("tail", "a servo that pitches the tail and a gait that lays it down"),
    ):
        if getattr(fit, rule) != getattr(control, rule):
            raise UnsuitedRobot(
                f"the feedback rule {rule} to {rule} needs {needs}; robot {robot.name!r} with gait {gait.name!r} lacks "
                "that: leave the rule out, as Coordinated.suited does."
            )


controller = Coordinated
