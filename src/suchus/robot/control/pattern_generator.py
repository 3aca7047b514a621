"""A central pattern generator: phase oscillators of axis and limbs that a single drive lets walk, then swim."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import radians
from typing import Any, NamedTuple

import numpy as np
from jaxtyping import Float

from suchus.core.checks import Checks, Schedule, require
from suchus.core.errors import InvalidDesign, OutsideLimits, UnsuitedRobot
from suchus.core.progress import Progress, silent
from suchus.robot.control.controller import Command, Runs, union_of_needs
from suchus.robot.control.limbs import LAWS, LimbLaw, Loads
from suchus.robot.control.oscillators import Oscillators, Rhythm, couple, cut_couplings
from suchus.robot.control.pattern_load import LoadDrive, LoadRule
from suchus.robot.control.pattern_posture import PatternPosture, initial_phases, waves
from suchus.robot.control.sensed import Sensed
from suchus.robot.control.spine import SpineController, SpineRule
from suchus.robot.control.tail import TailController, TailRule
from suchus.robot.control.trunk_effect import no_trunk_steering
from suchus.robot.design import Robot, layout
from suchus.robot.design.scale import control_period
from suchus.robot.gaits import MIN_TRUNK_STEERING, trunk_steering
from suchus.robot.motion import START, Gait, check_limits


class TimeCourses:
    """What changes over time, for a batch; most of it is constant."""

    def __init__(self, values: Sequence[Schedule]) -> None:
        self._steady = np.array([0.0 if isinstance(value, tuple) else value for value in values], dtype=float)
        tables = group_indices([value if isinstance(value, tuple) else None for value in values])
        self._tables = [(np.array(table).T, runs) for table, runs in tables if table is not None]

    def values_at(self, time: float) -> Float[np.ndarray, " run"]:
        """Return the values at a time [s]."""
        current = self._steady.copy()
        for (times, values), runs in self._tables:
            current[runs] = np.interp(time, times, values)
        return current


def group_indices(keys: Sequence[Any]) -> list[tuple[Any, np.ndarray]]:
    """Return each distinct key with the indices of its occurrences."""
    indices: dict[Any, list[int]] = {}
    for i, key in enumerate(keys):
        indices.setdefault(key, []).append(i)
    return [(key, np.array(runs)) for key, runs in indices.items()]


class Rules:
    """The rules of spine and tail, for those runs of a batch that have them."""

    def __init__(
        self,
        spines: Sequence[SpineRule | None],
        tails: Sequence[TailRule | None],
        robots: Sequence[Robot],
        gaits: Sequence[Gait],
        period: float,
    ) -> None:
        """Start the rules of those runs that have one.

        Args:
            spines: rule of the spine, one for each run; None for a run without one.
            tails: rule of the tail, one for each run; None for a run without one.
            robots: robot of each run.
            gaits: gait of each run.
            period: control period [s].

        Raises:
            UnsuitedRobot: a robot lacks the servos that its rule needs.
        """
        self._trunk_yaw_servos = list(layout(robots[0]).trunk_yaw)
        self._spine_runs = [i for i, rule in enumerate(spines) if rule is not None]
        self._tail_runs = [i for i, rule in enumerate(tails) if rule is not None]
        self._spine: SpineController | None = None
        self._tail: TailController | None = None
        if self._spine_runs:
            if not self._trunk_yaw_servos:
                raise UnsuitedRobot(
                    f"the rule spine to spine needs servos that bend the trunk sideways; robot {robots[0].name!r} "
                    "lacks them: leave spine out."
                )
            self._spine = SpineController(
                [spines[i] for i in self._spine_runs], [robots[i] for i in self._spine_runs], period
            )
        if self._tail_runs:
            self._tail = TailController(
                [tails[i] for i in self._tail_runs],
                [robots[i] for i in self._tail_runs],
                [_with_tail(robots[i], gaits[i]) for i in self._tail_runs],
                period,
            )

    def correct(self, targets: Float[np.ndarray, "run servo"], sensed: Sensed) -> Float[np.ndarray, "run servo"]:
        """Correct the servo targets by the rules of spine and tail, in place, and return them [rad].

        The rule of the spine changes the bend of the trunk by the bend that the servos reached (``SpineController``).
        The rule of the tail changes its pitch by the load on its servo (``TailController``).

        Args:
            targets: servo angles of all runs; those of runs with a rule are changed in place.
            sensed: readings of all runs.
        """
        if self._spine is not None:
            targets_of_spine_runs = targets[self._spine_runs]
            target_bend = targets_of_spine_runs[:, self._trunk_yaw_servos].sum(axis=1)
            targets[self._spine_runs] = self._spine.correct(
                targets_of_spine_runs, target_bend, _sensed_of_runs(sensed, self._spine_runs)
            )
        if self._tail is not None:
            targets[self._tail_runs] = self._tail.correct(
                targets[self._tail_runs], _sensed_of_runs(sensed, self._tail_runs)
            )
        return targets


def _with_tail(robot: Robot, gait: Gait) -> Gait:
    """Return the gait if it pitches the tail and the robot can; refuse both otherwise."""
    if not (gait.has("tail pitch") and layout(robot).tail_pitch):
        raise UnsuitedRobot(
            f"the rule tail to tail needs a servo that pitches the tail and a gait that lays it down, as "
            f"'belly_crawl'; robot {robot.name!r} with gait {gait.name!r} lacks them: leave tail out."
        )
    return gait


def _sensed_of_runs(sensed: Sensed, runs: list[int]) -> Sensed:
    """Return the readings of some runs, as far as spine and tail read them."""
    return replace(sensed, servo_position=sensed.servo_position[runs], servo_torque=sensed.servo_torque[runs])


STEERING_BEND = radians(8)
"""Steady bend of each steering joint at ``steering`` 1, where the control gives none [rad]."""
_SLACK = 1e-9  # [s]; times are multiples of the control period up to rounding
_AMPLITUDE_TOLERANCE = 1e-9  # [-]; an amplitude below this is none


@dataclass(frozen=True, slots=True, kw_only=True)
class PatternGenerator:
    """Coupled phase oscillators, one for each limb and one for each side of each segment of the axis.

    A low drive lets the limbs walk, and they draw the axis along into a standing wave; above ``limb_drives`` they fall
    silent, and the axis is left to its own faster, travelling wave. Bends and foot paths are those of the run's gait,
    whose period and bends are those at the drive in the middle of the limbs' range, 2. A limb follows its path in full
    as long as it is active; as its amplitude dies it folds, or stands, or, a crank, stops. Angles of the axis are
    clipped to the ranges of its servos. The oscillators rest until the walk begins; then the drive acts.

    After Ijspeert, Crespi, Ryczko and Cabelguen 2007, Science 315, 1416; see ``Oscillators`` for the numbers.
    """

    drive: Schedule = 2.0
    """Drive of all oscillators, 0 to 10 [-]."""
    asymmetry: Schedule = 0.0
    """Drive of the right side minus that of the left one, -4 to 4 [-]; with the published numbers it hardly turns."""
    steering: Schedule = 0.0
    """Turning command, -1 to 1, to the left where positive [-]."""
    steering_gain: float | None = None
    """Steady bend to the left of each joint ahead of the hindmost limbs at ``steering`` 1 [rad]; of all joints without
    limbs. None: ``STEERING_BEND`` toward the side to which a bend turns this robot in this gait, see
    ``suchus.robot.gaits.trunk_steering``; to the left while the limbs are silent."""
    lag: float | None = None
    """Phase lag of each segment of the axis behind the one ahead of it [cycle]; None for one wave on the whole axis."""
    gradient: tuple[tuple[float, float], ...] = ((0.0, 1.0), (1.0, 1.0))
    """Place along the body, 0 at the snout and 1 at the tip of the tail, and factor on the bends there [-]."""
    lesions: tuple[tuple[str, str], ...] = ()
    """Couplings cut, in both directions: ``("axis_3", "axis_4")`` cuts the axis through; see
    ``oscillators.cut_couplings``."""
    initial: str | tuple[float, ...] = "gait"
    """Phases in which the oscillators begin.

    ``gait``: those of the gait, or of the wave along the axis where the limbs are silent. ``random``: by the run's
    seed. Or given, one for each oscillator: left side of the axis from the head, right side, limbs [cycle].
    """
    silent: str = "folded"
    """What silent limbs do: ``folded`` back along the body, or ``standing`` in the middle of their path."""
    pace: float | None = None
    """Factor on the published rates [-]; None: the gait's period at the drive in the middle."""
    limbs: LimbLaw = LAWS["off"]
    """Limb to limb: how loads and the trunk's torque slow the limbs' oscillators; ``LAWS["off"]`` for not at all."""
    spine: SpineRule | None = None
    """Spine to spine: what the trunk lacks of its commanded bend is shared out; None for none."""
    tail: TailRule | None = None
    """Tail to tail: the pitch of the tail gives way to the ground; None for none."""
    load: LoadRule | None = None
    """Load to drive: afloat the oscillators get more drive and swim; None for none."""
    oscillators: Oscillators = field(default_factory=Oscillators)
    """The numbers of the oscillators."""

    def __post_init__(self) -> None:
        with Checks("pattern_generator", self) as check:
            check.course("drive", 0.0, 10.0, "", start=0.0)
            check.course("asymmetry", -4.0, 4.0, "", start=0.0)
            check.course("steering", -1.0, 1.0, "", start=0.0)
            check.course("gradient", 0.0, 10.0, "", abscissa="place", start=0.0)
            if self.steering_gain is not None:
                check.number("steering_gain", -1.0, 1.0, "rad")
            if self.lag is not None:
                check.number("lag", -0.5, 0.5, "cycle")
            if self.pace is not None:
                check.number("pace", 1e-3, 1e3, "")
            has_phases = isinstance(self.initial, tuple) and all(abs(phase) <= 1e6 for phase in self.initial)
            check.that(
                has_phases or self.initial in ("gait", "random"),
                f"pattern_generator.initial is {str(self.initial)[:80]!r}; gait, random or a phase for each oscillator "
                "is allowed",
            )
            check.that(
                self.silent in ("folded", "standing"),
                f"pattern_generator.silent is {str(self.silent)[:80]!r}; folded or standing is allowed",
            )

    @property
    def feels(self) -> bool:
        """Whether any feedback rule is on."""
        return self.limbs.feels or any(rule is not None for rule in (self.spine, self.tail, self.load))

    @property
    def needs(self) -> tuple[str, ...]:
        """What the rules that are on feel."""
        return union_of_needs(
            self.limbs.needs,
            ("servo_position", "servo_torque") if self.spine or self.tail else (),
            ("foot_pressure", "belly_pressure", "tail_pressure") if self.load else (),
        )

    @staticmethod
    def start(runs: Runs, period: float) -> "Generator":
        """Start the pattern generators of a batch, each run with its own."""
        return Generator(runs.controls, runs.robots, runs.gaits, runs.seeds, period)


class Generator:
    """The pattern generators of a batch."""

    def __init__(
        self,
        controls: Sequence[PatternGenerator],
        robots: Sequence[Robot],
        gaits: Sequence[Gait],
        seeds: Sequence[int],
        period: float,
    ) -> None:
        """Couple the oscillators of every run and set their first phases.

        Args:
            controls: settings, one for each run.
            robots: robot of each run, all with the same layout.
            gaits: gait of each run.
            seeds: seeds of random first phases, one for each run.
            period: control period [s].
        """
        self._period = period
        self._groups = _grouped(controls, robots, gaits)
        self._posture = [posture for i in range(len(controls)) for posture, runs in self._groups if i in runs]
        limbs = layout(robots[0]).limb_names
        self._limbs = slice(2 * len(self._posture[0].segments), None)
        n = self._limbs.start // 2
        self._sides = np.array([-0.5] * n + [0.5] * n + [-0.5, 0.5] * (len(limbs) // 2))
        self._numbers = group_indices([control.oscillators for control in controls])
        self._drive, self._asymmetry, self._steering = (
            TimeCourses([getattr(control, name) for control in controls]) for name in ("drive", "asymmetry", "steering")
        )
        self._shift = np.array([posture.shift for posture in self._posture])[:, None]
        self._gradient = np.array([_graded(*pair) for pair in zip(controls, self._posture, strict=True)])
        self._gain = np.array(
            [
                [_steering_bend(control) * segment.steers for segment in posture.segments]
                for control, posture in zip(controls, self._posture, strict=True)
            ]
        )
        self._walk_side = np.array([_walk_side(*setup) for setup in zip(controls, robots, gaits, strict=True)])
        self._full = [
            max(float(c.oscillators.axis(np.array(c.oscillators.reference))[1]), _AMPLITUDE_TOLERANCE) for c in controls
        ]
        self._min_amplitude = np.array(
            [max(_min_limb_amplitude(c.oscillators), _AMPLITUDE_TOLERANCE) for c in controls]
        )[:, None]
        self._max_fold_change, self._max_steering_change = (
            period * np.array([rate(posture) for posture in self._posture])[:, None]
            for rate in (PatternPosture.fold_rate, PatternPosture.bend_rate)
        )
        max_bend = np.abs(self._gain).max(axis=1, keepdims=True, initial=_AMPLITUDE_TOLERANCE)
        self._max_steering_change = self._max_steering_change / max_bend
        self.couplings = []
        """Couplings of each run; see ``oscillators.Couplings``."""
        phases = []
        self._sensed_drive = LoadDrive([control.load for control in controls], robots, period)
        _, amplitude = self._natural_rhythm(START)
        for i, (control, robot, gait, seed) in enumerate(zip(controls, robots, gaits, seeds, strict=True)):
            parts = [segment.limb_coupling for segment in self._posture[i].segments]
            lag = 1.0 / n if control.lag is None else control.lag
            couplings = couple(control.oscillators, parts, limbs, gait.limb_phases, lag)
            self.couplings.append(cut_couplings(couplings, control.lesions))
            has_active_limbs = bool(amplitude[i, self._limbs].any())
            phases.append(
                _initial(control, robot, gait, seed, self._posture[i], lag, has_active_limbs=has_active_limbs)
            )
        pace = np.array([_pace(*setup) for setup in zip(controls, robots, gaits, strict=True)])
        self._rhythm = Rhythm(
            self.couplings, [control.oscillators for control in controls], pace, np.array(phases), amplitude, period
        )
        self._loads = Loads([control.limbs for control in controls], robots, gaits, period)
        self._fraction = self._limb_fraction()
        self._steer = self._steering.values_at(0.0)[:, None]
        self._rules = Rules(
            [control.spine for control in controls], [control.tail for control in controls], robots, gaits, period
        )

    @property
    def phase(self) -> Float[np.ndarray, "run oscillator"]:
        """Phases of the oscillators, not wrapped [cycle]."""
        return self._rhythm.phase / (2 * np.pi)

    @property
    def amplitude(self) -> Float[np.ndarray, "run oscillator"]:
        """Amplitudes of the oscillators [-]."""
        return self._rhythm.amplitude

    @property
    def limb_phase(self) -> Float[np.ndarray, "run limb"]:
        """Phases of the limbs in their gait, not wrapped [cycle]."""
        return np.asarray(self.phase[:, self._limbs] + self._shift)

    @property
    def wave(self) -> Float[np.ndarray, "run segment"]:
        """Bend of each segment of the axis to the left, in amplitudes of the gait [-]."""
        outputs = self.amplitude * (1.0 + np.cos(self._rhythm.phase))
        n = self._limbs.start // 2
        return waves(outputs[:, :n], outputs[:, n : 2 * n], self._full) * self._gradient

    def rest(self) -> Float[np.ndarray, "run servo"]:
        """The posture of the first phases."""
        return self._targets()

    def advance(self, tick: int) -> None:
        """Advance the oscillators from the last control period to this one, once the walk has begun.

        Args:
            tick: number of the control period.
        """
        previous_time = (tick - 1) * self._period
        if previous_time >= START - _SLACK:
            frequency, amplitude = self._natural_rhythm(previous_time)
            if self._loads.has_feedback:
                frequency[:, self._limbs] *= 1.0 - self._loads.brake(self.limb_phase)
            self._rhythm.advance(frequency, amplitude)

    def command(self, tick: int, sensed: Sensed | None) -> Command:
        """Advance the oscillators by one control period and return the servo targets.

        Args:
            tick: number of the control period.
            sensed: readings; None if no rule is on.
        """
        if sensed is not None and self._loads.has_feedback:
            self._loads.feel(sensed)
        if sensed is not None and self._sensed_drive.has_feedback:
            self._sensed_drive.feel(sensed)
        self.advance(tick)
        self._fraction = _approach(self._fraction, self._limb_fraction(), self._max_fold_change)
        steering = self._steering.values_at(tick * self._period)[:, None]
        self._steer = _approach(self._steer, steering, self._max_steering_change)
        targets = self._targets()
        if sensed is not None and tick * self._period >= START - _SLACK:
            targets = self._rules.correct(targets, sensed)
        return Command(targets, self.limb_phase)

    def _natural_rhythm(self, time: float) -> tuple[np.ndarray, np.ndarray]:
        """Return own frequencies [Hz] and amplitudes [-] of all oscillators at a time."""
        common_drive = (
            self._drive.values_at(time) + self._sensed_drive.drive
            if self._sensed_drive.has_feedback
            else self._drive.values_at(time)
        )
        drive = common_drive[:, None] + self._asymmetry.values_at(time)[:, None] * self._sides
        frequency, amplitude = np.empty_like(drive), np.empty_like(drive)
        axis = slice(0, self._limbs.start)
        for parameters, runs in self._numbers:
            for group, law in ((axis, parameters.axis), (self._limbs, parameters.limbs)):
                frequency[runs, group], amplitude[runs, group] = law(drive[runs, group])
        return frequency, amplitude

    def _limb_fraction(self) -> Float[np.ndarray, "run limb"]:
        """Return how far the amplitude of each limb lets it follow its path, 0 to 1 [-]."""
        return np.asarray(np.clip(self.amplitude[:, self._limbs] / self._min_amplitude, 0.0, 1.0))

    def _targets(self) -> Float[np.ndarray, "run servo"]:
        """Return the servo angles [rad]."""
        fraction, wave, phase, steering = self._fraction, self.wave, self.limb_phase, self._steer
        if fraction.shape[1]:  # with silent limbs a bend turns the body to its own side
            steering = steering * (1.0 + fraction.mean(axis=1) * (self._walk_side - 1.0))[:, None]
        offset = steering * self._gain
        group_targets = [
            (runs, posture.targets(phase[runs], fraction[runs], wave[runs], offset[runs]))
            for posture, runs in self._groups
        ]
        targets = np.empty((len(phase), group_targets[0][1].shape[1]))
        for runs, angles in group_targets:
            targets[runs] = angles
        return targets


def _grouped(
    controls: Sequence[PatternGenerator], robots: Sequence[Robot], gaits: Sequence[Gait]
) -> list[tuple[PatternPosture, np.ndarray]]:
    """Return each distinct posture rule with the indices of its runs; refuse gaits that a robot cannot follow."""
    for robot, gait in set(zip(robots, gaits, strict=True)):
        check_limits(robot, gait)
    keys = list(zip(robots, gaits, (control.silent == "standing" for control in controls), strict=True))
    return [
        (PatternPosture(robot, gait, standing=standing), runs) for (robot, gait, standing), runs in group_indices(keys)
    ]


def _graded(control: PatternGenerator, posture: PatternPosture) -> list[float]:
    places, factors = zip(*control.gradient, strict=True)
    return [float(np.interp(segment.axial_position, places, factors)) for segment in posture.segments]


def _approach(current: np.ndarray, target: np.ndarray, max_change: np.ndarray) -> np.ndarray:
    """Return values that move from ``current`` to ``target`` by ``max_change`` at most, exactly where they arrive."""
    change = target - current
    is_near = np.abs(change) <= max_change
    return np.where(is_near, target, current + np.clip(change, -max_change, max_change))


def _steering_bend(control: PatternGenerator) -> float:
    """Return the steady bend to the left of each steering joint at ``steering`` 1, with silent limbs [rad]."""
    return STEERING_BEND if control.steering_gain is None else control.steering_gain


def _walk_side(control: PatternGenerator, robot: Robot, gait: Gait) -> float:
    """Return the factor on the steering bend while the limbs walk: -1 where a bend turns the robot to the other side.

    Raises:
        OutsideLimits: the robot is steered, and the effect of a bend in its gait is unknown or too small.
    """
    if control.steering_gain is not None or not layout(robot).limbs or not _is_steered(control):
        return 1.0
    turn_per_bend = trunk_steering(robot, gait)
    if turn_per_bend is None or abs(turn_per_bend) < MIN_TRUNK_STEERING:
        raise OutsideLimits(
            no_trunk_steering(robot, gait, "pattern_generator.steering", "pattern_generator.steering_gain")
        )
    return float(np.sign(turn_per_bend))


def _is_steered(control: PatternGenerator) -> bool:
    """Return whether the turning command is ever other than zero."""
    if isinstance(control.steering, tuple):
        return any(value for _, value in control.steering)
    return control.steering != 0.0


def _min_limb_amplitude(parameters: Oscillators) -> float:
    """Return the amplitude of limbs at the lowest drive that moves them [-]."""
    return float(parameters.limbs(np.array(parameters.limb_drives[0]))[1])


def _pace(control: PatternGenerator, robot: Robot, gait: Gait) -> float:
    """Return the factor on the published rates with which the oscillators keep the period of the gait [-].

    Raises:
        InvalidDesign: the oscillators do not turn at the reference drive.
    """
    if control.pace is not None:
        return control.pace
    parameters = control.oscillators
    law = parameters.limbs if layout(robot).limbs else parameters.axis
    frequency = float(law(np.array(parameters.reference))[0])
    if frequency <= 0.0:
        raise InvalidDesign(
            f"the oscillators do not turn at drive {parameters.reference:g}, so that no pace gives the period of gait "
            f"{gait.name!r}: set pattern_generator.pace."
        )
    return 1.0 / (gait.period * frequency)


def _initial(
    control: PatternGenerator,
    robot: Robot,
    gait: Gait,
    seed: int,
    posture: PatternPosture,
    lag: float,
    *,
    has_active_limbs: bool,
) -> np.ndarray:
    """Return the first phases of a run's oscillators, shape (oscillator,) [rad].

    Args:
        control: its settings.
        robot: the design.
        gait: its gait.
        seed: seed of random phases.
        posture: segments of the axis, and the phase shift between limbs and oscillators.
        lag: phase lag of each segment behind the one ahead of it [cycle].
        has_active_limbs: whether the drive moves the limbs.

    Raises:
        InvalidDesign: phases are given, and not one for each oscillator.
    """
    count = 2 * len(posture.segments) + len(gait.limb_phases)
    if control.initial == "random":
        return 2 * np.pi * np.random.default_rng([seed, 2]).random(count)
    if isinstance(control.initial, tuple):
        if len(control.initial) != count:
            raise InvalidDesign(
                f"pattern_generator.initial has {len(control.initial)} phases; robot {robot.name!r} has {count} "
                f"oscillators, {len(posture.segments)} on each side of its axis and one for each limb: give as many."
            )
        return 2 * np.pi * np.array(control.initial, dtype=float)
    limbs = [phase - posture.shift for phase in gait.limb_phases]
    return initial_phases(posture.segments, limbs, lag, has_active_limbs=has_active_limbs)


class OscillatorStates(NamedTuple):
    """Phases and amplitudes of oscillators that are integrated without a body."""

    time: Float[np.ndarray, " time"]
    """Time since the beginning of the run [s]."""
    phase: Float[np.ndarray, "run time oscillator"]
    """Phase of the oscillators, not wrapped [cycle]."""
    amplitude: Float[np.ndarray, "run time oscillator"]
    """Amplitude of the oscillators [-]."""
    wave: Float[np.ndarray, "run time segment"]
    """Bend of each segment of the axis to the left, in amplitudes of the gait [-]."""
    names: tuple[str, ...]
    """Names of the oscillators."""


def oscillate(
    controls: Sequence[PatternGenerator],
    robot: Robot,
    gait: Gait,
    *,
    duration: float,
    seeds: Sequence[int] | None = None,
    sample_interval: int = 1,
    progress: Progress = silent,
) -> OscillatorStates:
    """Let pattern generators turn without a body, from the time at which a walk begins.

    Args:
        controls: controls of the runs.
        robot: robot whose oscillators they are.
        gait: which they drive.
        duration: duration of the oscillation [s].
        seeds: seed of each run; all 0 if None.
        sample_interval: keep one sample of so many control periods.
        progress: told the share that is done.
    """
    require("oscillate", "duration", duration, 0.0, 86400.0, "s")
    period, runs = control_period(robot), len(controls)
    first_tick, ticks = round(START / period), round(duration / period)
    generator = Generator(controls, [robot] * runs, [gait] * runs, [0] * runs if seeds is None else seeds, period)
    samples = []
    for tick in range(first_tick, first_tick + ticks + 1):
        generator.advance(tick)
        if (tick - first_tick) % sample_interval == 0:
            samples.append((tick * period, generator.phase, generator.amplitude, generator.wave))
            progress("oscillating", (tick - first_tick) / max(ticks, 1))
    time, phase, amplitude, wave = zip(*samples, strict=True)
    return OscillatorStates(
        time=np.array(time),
        phase=np.stack(phase, axis=1),
        amplitude=np.stack(amplitude, axis=1),
        wave=np.stack(wave, axis=1),
        names=generator.couplings[0].names,
    )


controller = PatternGenerator
