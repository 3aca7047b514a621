"""What do coupled oscillators make of a single drive: walking, swimming, turning, and order from any start?"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace
from math import radians
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.animals.capture.angles import STANDING, standing_index
from suchus.core.checks import Checks
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog.pattern_generator import one_drive
from suchus.experiments.catalog.pattern_generator.figure import draw_land, draw_locks, draw_ramp, draw_sweep
from suchus.experiments.experiment import (
    Experiment,
    Extent,
    Measure,
    Measures,
    Outcome,
    Progress,
    Replay,
    SimulationResult,
    silent,
    staged,
)
from suchus.robot.control import Oscillators, PatternGenerator, oscillate
from suchus.robot.control.pattern_generator import STEERING_BEND
from suchus.robot.control.pattern_posture import axis_segments
from suchus.robot.design import Robot
from suchus.robot.design.scale import rescale_fields
from suchus.robot.gaits import GAITS, MIN_TRUNK_STEERING, default_gait, trunk_steering
from suchus.robot.motion import START, Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.land.afloat import floats
from suchus.sim.metrics import displacement, heading_change

_OSCILLATORS = Oscillators()
_DRIVE_MARGIN = 0.01  # above the highest drive of the limbs [-]; their oscillators are silent there
STRAIGHT = ("drive_low", "straight", "drive_high")
"""Walks by an equal drive on both sides: the lowest that moves the limbs, the one for walking, the highest."""
_TURNS = {"turn_gained": ("straight", "asymmetry")}
"""Measures that need some walks only, and the names of these walks."""
_SAMPLE_INTERVAL = 4  # control periods between stored samples of the oscillators
_MIN_SHORE_TIME = START + 1.5  # shortest run from the water; the sensed load settles before [s]
_MEASURED_FRACTION = 0.25  # last fraction of a sweep, over which frequencies are measured


@dataclass(frozen=True, slots=True, kw_only=True)
class PatternGeneratorExperiment(Experiment):
    """Phase oscillators under a drive: alone, then on the body on land.

    The sweep starts at the gait's phases and is measured after it has settled. A start counts as locked if the phase
    error of every active oscillator stays below ``within`` for at least ``hold`` cycles until the end. The reference is
    the state that a start at the gait's phases reaches; a phase shift that all oscillators share is no error. Turning
    is the change of the body's heading.
    """

    title = "What do coupled oscillators make of a single drive: walking, swimming, turning, order from any start?"
    shows = "Beyond the article: Ijspeert et al. 2007, Science 315, 1416"
    answers = ("frequency_walk", "frequency_swim", "frequency_jump", "lag_walk", "lag_swim", "locked_share")
    needs = ("limbs", "axis")
    judged_settings = ("robot", "gait", "walk", "swim", "asymmetry")
    judged_minima: ClassVar[Mapping[str, float]] = {"cycles": 5, "followed": 6.0}
    answer_minima: ClassVar[Mapping[str, float]] = {"cycles": 5, "followed": 12.0, "shore_time": 30.0}

    robot: Robot = field(default_factory=lambda: ROBOTS["salamander"])
    """The robot, with limbs and an axis that bends sideways."""
    gait: Gait = field(default_factory=lambda: GAITS["salamander_walk"])
    """Gait whose foot paths, bends and period the oscillators drive."""
    drives: tuple[float, ...] = (1.0, 1.5, 2.0, 2.5, 3.0, 3.25, 3.5, 4.0, 4.5, 5.0)
    """Drives of the sweep [-]."""
    walk: float = 2.0
    """Drive at which it walks, for starts and steering [-]."""
    swim: float = 4.0
    """Drive at which the limbs are silent, for starts [-]."""
    starts: int = 32
    """Random initial phases of all oscillators, the same at both drives [-]."""
    followed: float = 12.0
    """Duration for which each start is followed, in cycles of its drive [cycle]."""
    within: float = 0.1
    """Greatest phase error with which an oscillator counts as locked [rad]."""
    hold: float = 2.0
    """Duration for which all must stay locked until the end [cycle]."""
    asymmetry: float = 1.0
    """Drive of the right side minus that of the left one, for steering by it [-]."""
    cycles: int = 5
    """Duration of each walk on land, in periods of the gait [-]."""
    ramp: float = 14.0
    """Duration over which the drive rises from 1 to 5 and falls again, in periods of the gait [-]."""
    swimmer: Robot = field(default_factory=lambda: ROBOTS["floating_caiman"])
    """The robot that goes from the water onto the land by one drive, ``walk``; it must float."""
    swimmer_gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """Gait whose foot paths, bends and period its oscillators drive."""
    slope: float = radians(5)
    """Slope of the shore [rad]."""
    water_line: float = 2.2
    """Distance of the water line ahead of the robot, along the ground [m]."""
    shore_time: float = 30.0
    """Duration of the runs from the water [s]."""
    seed: int = 0
    """Seed of the first start; the others follow [-]."""
    extent: Extent = "whole"
    """How much is simulated: without the ramp of the drive and the runs from the water for the verdicts."""

    def __post_init__(self) -> None:
        """Refuse drives outside the range of the oscillators, and other settings outside their ranges."""
        min_drive, max_limb_drive, max_drive = *_OSCILLATORS.limb_drives, _OSCILLATORS.axis_drives[1]
        with Checks(self.name(), self) as check:
            check.rising("drives", min_drive, max_drive, "")
            check.number("walk", min_drive, max_limb_drive, "")
            check.number("swim", max_limb_drive + _DRIVE_MARGIN, max_drive, "")
            check.whole("starts", 1, 1000)
            check.number("followed", 1.0, 1000.0, "cycle")
            check.number("within", 1e-6, 3.0, "rad")
            check.number("hold", 0.1, 1000.0, "cycle")
            check.number("asymmetry", 0.0, 2.0, "")
            check.whole("cycles", 1, 1000)
            check.number("ramp", 1.0, 1000.0, "")
            check.number("slope", 0.01, 1.0, "rad")
            check.number("water_line", 0.0, 100.0, "m")
            check.number("shore_time", _MIN_SHORE_TIME, 3600.0, "s")
            check.whole("seed", 0, 2**31)

    def for_verdicts(self) -> "PatternGeneratorExperiment":
        """Return the same question without the ramp of the drive and the runs from the water onto the land."""
        return replace(self, extent="verdicts")

    def quick(self) -> "PatternGeneratorExperiment":
        """Three drives, four starts, short walks."""
        return replace(
            self, drives=(1.0, 3.0, 4.0), starts=4, followed=6.0, hold=0.5, cycles=1, ramp=2.0, shore_time=3.0
        )

    def for_robot(self, robot: Robot) -> "PatternGeneratorExperiment":
        """Return the same question for another robot, which goes from the water to the land itself where it floats."""
        variant = super(PatternGeneratorExperiment, self).for_robot(robot)  # a class with slots has no short form
        if robot == self.robot:
            return variant
        swimmer = robot if floats(robot) else self.swimmer
        sized = rescale_fields(
            self,
            ("water_line", "shore_time"),
            length_factor=swimmer.length / self.swimmer.length,
            mass_factor=swimmer.mass / self.swimmer.mass,
        )
        shore_settings = {"water_line": self.water_line, "shore_time": self.shore_time} | sized
        shore_settings["shore_time"] = max(shore_settings["shore_time"], _MIN_SHORE_TIME)
        return replace(variant, swimmer=swimmer, swimmer_gait=default_gait(swimmer), **shore_settings)

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Sweep the drive, start at random, ramp the drive, and walk."""
        parts = [self._sweep(staged(progress, "drive sweep", 0.0, 0.15))]
        parts += [
            self._starts(name, drive, staged(progress, f"random starts, {name}", start, start + 0.15))
            for name, drive, start in (("walk", self.walk, 0.15), ("swim", self.swim, 0.3))
        ]
        parts.append(self._walk_arms(self._arms, staged(progress, "walks", 0.45, 0.65)))
        replays: Mapping[str, Replay] = {}
        if self.extent == "whole":
            parts += [self._ramp(), self._shore(staged(progress, "one drive across the shore", 0.85, 1.0))]
            replays = self._replays(self._ramped_walk(staged(progress, "drive ramp", 0.65, 0.85)))
        record = xr.merge(parts).assign_attrs(
            within=self.within, hold=self.hold, silent_above=_OSCILLATORS.limb_drives[1], walk=self.walk, swim=self.swim
        )
        return SimulationResult(record=record, replays=replays)

    def simulate_measures(self, measure_names: Collection[str], progress: Progress = silent) -> Measures:
        """Return at least the wanted measures; if only turns are wanted, only their walks are simulated."""
        if not set(measure_names) <= _TURNS.keys():
            return super(PatternGeneratorExperiment, self).simulate_measures(measure_names, progress)
        arms = dict.fromkeys(arm for name in measure_names for arm in _TURNS[name])
        return _turn_measures(
            self._walk_arms({name: arm for name, arm in self._arms.items() if name in arms}, progress)
        )

    def measure(self, record: xr.Dataset) -> Measures:
        """Return frequencies, lags and indices over the drive, locks, strides and turns."""
        measures = (
            _sweep_measures(record)
            | _lock_measures(record, "walk", "")
            | _lock_measures(record, "swim", "_swim")
            | _turn_measures(record)
        )
        for arm in STRAIGHT:
            walk = record.sel(arm=arm)
            stride = float(walk.forward / walk.walked / record.attrs["length"])
            measures[f"stride_{arm}"] = Measure(stride, "L/cycle")
        return measures | one_drive.measures(record) if "shore_ahead" in record else measures

    def explain(self, measures: Mapping[str, float]) -> str:
        """Return what drive and steering do, and how the oscillators lock, in words."""
        return self.render_explanation(measures, standing=STANDING)

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the ramp, the sweep, the locks, and what drive and steering do on land."""
        record = outcome.record
        return {
            **({"drive_ramp": draw_ramp(record, self.robot)} if "ramp_drive" in record else {}),
            "drive_sweep": draw_sweep(record, _OSCILLATORS),
            "phase_locks": draw_locks(record),
            "walking_by_drive": draw_land(record),
        }

    def _sweep(self, progress: Progress) -> xr.Dataset:
        """Return settled frequencies, phases and amplitudes at every drive."""
        edge = _OSCILLATORS.limb_drives[1]
        drives = sorted({*self.drives, self.walk, self.swim, edge, edge + _DRIVE_MARGIN})
        controls = [PatternGenerator(drive=drive) for drive in drives]
        duration = self.followed * self.gait.period
        oscillation = oscillate(
            controls, self.robot, self.gait, duration=duration, sample_interval=_SAMPLE_INTERVAL, progress=progress
        )
        n, start_index = oscillation.wave.shape[2], int((1 - _MEASURED_FRACTION) * len(oscillation.time))
        rate = (oscillation.phase[:, -1] - oscillation.phase[:, start_index]) / (
            oscillation.time[-1] - oscillation.time[start_index]
        )
        phase = oscillation.phase[:, -1, :n] - oscillation.phase[:, -1, :1]
        segments = axis_segments(self.robot, self.gait)
        return xr.Dataset(
            {
                "frequency_axis": ("drive", rate[:, 0], {"units": "Hz", "long_name": "of the axis"}),
                "frequency_limbs": ("drive", rate[:, 2 * n], {"units": "Hz", "long_name": "of the limbs"}),
                "amplitude_axis": ("drive", oscillation.amplitude[:, -1, 0], {"units": "1"}),
                "amplitude_limbs": ("drive", oscillation.amplitude[:, -1, 2 * n], {"units": "1"}),
                "phase_axis": (("drive", "segment"), phase, {"units": "1", "long_name": "against the first [cycle]"}),
                "bend": (
                    "segment",
                    [segment.amplitude for segment in segments],
                    {"units": "rad", "long_name": "in the gait"},
                ),
            },
            coords={
                "drive": drives,
                "segment": np.arange(1, n + 1),
                "place": ("segment", [segment.axial_position for segment in segments], {"units": "1"}),
                "girdle": ("segment", [segment.limb_coupling.girdle for segment in segments]),
            },
            attrs={"frequency_scale": self._pace, "length": self.robot.length},
        )

    @property
    def _pace(self) -> float:
        """Factor on the published frequencies [-]; with it drive 2 gives the period of the gait."""
        return 1.0 / (self.gait.period * float(_OSCILLATORS.limbs(np.array(_OSCILLATORS.reference))[0]))

    def _starts(self, name: str, drive: float, progress: Progress) -> xr.Dataset:
        """Return the phase error of the farthest oscillator over time, for every random start [rad].

        Args:
            name: state of the record, ``walk`` or ``swim``.
            drive: drive of the oscillators [-].
            progress: called with the fraction that is done.
        """
        walks = drive <= _OSCILLATORS.limb_drives[1]
        law = _OSCILLATORS.limbs if walks else _OSCILLATORS.axis
        frequency = self._pace * float(law(np.array(drive))[0])
        control = PatternGenerator(drive=drive)
        controls = [control, *(replace(control, initial="random") for _ in range(self.starts))]
        seeds = [self.seed, *range(self.seed, self.seed + self.starts)]
        duration = self.followed / frequency
        oscillation = oscillate(
            controls,
            self.robot,
            self.gait,
            duration=duration,
            seeds=seeds,
            sample_interval=_SAMPLE_INTERVAL,
            progress=progress,
        )
        active = oscillation.amplitude[0, -1] > 0.0
        error = lock_error(oscillation.phase[1:][..., active], oscillation.phase[0, -1, active])
        cycles = (oscillation.time - oscillation.time[0]) * frequency
        dims = (f"{name}_start", f"{name}_cycle")
        return xr.Dataset(
            {f"{name}_error": (dims, error, {"units": "rad", "long_name": "greatest distance from the locked state"})},
            coords={dims[1]: (dims[1], cycles, {"units": "1", "long_name": "time [cycle]"})},
        )

    @property
    def _ramped(self) -> tuple[tuple[float, float], ...]:
        """The drive over the ramp: up in one half, down in the other."""
        end = self.ramp * self.gait.period
        min_drive, max_drive = _OSCILLATORS.axis_drives
        return (START, min_drive), (START + end / 2, max_drive), (START + end, min_drive)

    def _ramp(self) -> xr.Dataset:
        """Return drive, phases, amplitudes and bends of the oscillators over the ramp, without a body."""
        control = PatternGenerator(drive=self._ramped)
        oscillation = oscillate([control], self.robot, self.gait, duration=self.ramp * self.gait.period)
        drive = np.interp(oscillation.time, *np.array(self._ramped).T)
        return xr.Dataset(
            {
                "ramp_drive": ("ramp_time", drive, {"units": "1"}),
                "ramp_phase": (
                    ("ramp_time", "oscillator"),
                    oscillation.phase[0],
                    {"units": "1", "long_name": "[cycle]"},
                ),
                "ramp_amplitude": (("ramp_time", "oscillator"), oscillation.amplitude[0], {"units": "1"}),
                "ramp_wave": (
                    ("ramp_time", "segment"),
                    oscillation.wave[0],
                    {"units": "1", "long_name": "to the left"},
                ),
            },
            coords={
                "ramp_time": ("ramp_time", oscillation.time - START, {"units": "s"}),
                "oscillator": list(oscillation.names),
                "segment": np.arange(1, oscillation.wave.shape[2] + 1),
            },
        )

    @property
    def _arms(self) -> dict[str, PatternGenerator]:
        """Controls of the walks on land, by name."""
        min_drive, max_drive = _OSCILLATORS.limb_drives
        turn_per_bend = trunk_steering(self.robot, self.gait) or 0.0
        # where no side is known, the walk itself shows what a bend to the left does
        steering_bend = None if abs(turn_per_bend) >= MIN_TRUNK_STEERING else STEERING_BEND
        return {
            "drive_low": PatternGenerator(drive=min_drive),
            "straight": PatternGenerator(drive=self.walk),
            "drive_high": PatternGenerator(drive=max_drive),
            "asymmetry": PatternGenerator(drive=self.walk, asymmetry=self.asymmetry),
            "steering": PatternGenerator(drive=self.walk, steering=1.0, steering_gain=steering_bend),
            "steering_right": PatternGenerator(drive=self.walk, steering=-1.0, steering_gain=steering_bend),
        }

    def _walk_arms(self, arms: Mapping[str, PatternGenerator], progress: Progress) -> xr.Dataset:
        """Return displacement forward [m], change of heading [rad] and cycles walked [-] under each control.

        Args:
            arms: controls by name.
            progress: called with the fraction that is done.
        """
        runs = [Run(robot=self.robot, gait=self.gait, control=control, label=name) for name, control in arms.items()]
        duration = START + self.cycles * self.gait.period
        record = simulate(runs, duration=duration, sample_stride=_SAMPLE_INTERVAL, effort=False, progress=progress)
        phase = record.limb_phase.isel(leg=0)
        initial_phase = phase.sel(time=START, method="nearest")
        units = {"forward": "m", "turned": "rad", "walked": "1"}
        values = {
            "forward": displacement(record).sel(xyz="x").values,
            "turned": heading_change(record).values,
            "walked": (phase.isel(time=-1) - initial_phase).values,
        }
        return xr.Dataset(
            {name: ("arm", value, {"units": units[name]}) for name, value in values.items()},
            coords={"arm": list(arms)},
        )

    def _ramped_walk(self, progress: Progress) -> xr.Dataset:
        """Return the record of the walk under the ramp of the drive."""
        ramped = Run(robot=self.robot, gait=self.gait, control=PatternGenerator(drive=self._ramped))
        end = START + self.ramp * self.gait.period
        return simulate([ramped], duration=end, sample_stride=2, effort=False, progress=progress)

    def _shore(self, progress: Progress) -> xr.Dataset:
        """Return the stored part of the runs from the water onto the land by one drive."""
        runs = one_drive.runs(self.swimmer, self.swimmer_gait, self.walk, self.slope, self.water_line)
        record = simulate(
            runs, duration=self.shore_time, sample_stride=_SAMPLE_INTERVAL, effort=False, progress=progress
        )
        return one_drive.reduced(record, self.water_line)

    def _replays(self, ramped: xr.Dataset) -> Mapping[str, Replay]:
        """Return the replay of the walk under the drive ramp, by file name."""
        return replayed(
            "drive_ramp_replay.html",
            ramped.isel(run=0),
            self.robot,
            title="Walking under a rising and falling drive",
            caption="The drive rises and falls again: limbs and a standing wave first, then folded limbs and a faster "
            "wave.",
        )


def lock_error(phase: np.ndarray, place: np.ndarray) -> np.ndarray:
    """Return the greatest phase error of an oscillator, without the mean phase shift of all [rad].

    Args:
        phase: phase of the oscillators, shape (..., oscillator) [cycle].
        place: phase of the oscillators in the locked state, shape (oscillator,) [cycle].
    """
    phasor = np.exp(2j * np.pi * (phase - place))
    common = phasor.mean(axis=-1, keepdims=True)
    return np.asarray(np.abs(np.angle(phasor * np.conj(common))).max(axis=-1))


def _sweep_measures(record: xr.Dataset) -> Measures:
    """Return frequencies, lags and amplitudes at the two drives, and around the highest drive of the limbs."""
    edge = record.attrs["silent_above"]
    states = {"walk": record.attrs["walk"], "swim": record.attrs["swim"], "below": edge, "above": edge + _DRIVE_MARGIN}
    measures = Measures()
    for name, drive in states.items():
        drive_record = record.sel(drive=drive, method="nearest")
        measures[f"frequency_{name}"] = Measure(float(drive_record.frequency_axis), "Hz")
        if name in ("walk", "swim"):
            lags = _lags(drive_record.phase_axis.values)
            measures[f"standing_index_{name}"] = Measure(
                standing_index(record.bend.values, 2 * np.pi * drive_record.phase_axis.values), "-"
            )
            measures[f"lag_{name}"] = Measure(float(np.median(lags)), "cycle")
            measures[f"lag_{name}_least"] = Measure(float(lags.min()), "cycle")
            measures[f"lag_{name}_most"] = Measure(float(lags.max()), "cycle")
            measures[f"frequency_limbs_{name}"] = Measure(float(drive_record.frequency_limbs), "Hz")
            measures[f"amplitude_limbs_{name}"] = Measure(float(drive_record.amplitude_limbs), "-")
    jump = measures["frequency_above"].value / measures["frequency_below"].value
    return measures | {"frequency_jump": Measure(jump, "-")}


def _turn_measures(record: xr.Dataset) -> Measures:
    """Return the turn of each walk in a cycle, and its change by unequal drives [rad/cycle]."""
    turns, unit = record.turned / record.walked, "rad/cycle"
    measures = Measures((f"turn_{arm}", Measure(float(turns.sel(arm=arm)), unit)) for arm in record.arm.values)
    gained = abs(measures["turn_asymmetry"].value - measures["turn_straight"].value)
    return measures | {"turn_gained": Measure(gained, unit)}


def _lags(phase: np.ndarray) -> np.ndarray:
    """Return the phase lag of each segment behind the one ahead of it, -0.5 to 0.5 [cycle]; 0 of a single segment."""
    if len(phase) < 2:
        return np.zeros(1)
    return np.asarray(np.mod(-np.diff(phase) + 0.5, 1.0) - 0.5)


def _lock_measures(record: xr.Dataset, state: str, ending: str) -> Measures:
    """Return the fraction of starts that lock, and mean and greatest time until they do; NaN if none does.

    Args:
        record: record with ``STATE_error`` over starts and cycles [rad].
        state: ``walk`` or ``swim``.
        ending: ending of the names of the measures.
    """
    error, cycle = record[f"{state}_error"], record[f"{state}_cycle"]
    step = float(cycle[1] - cycle[0])
    since = (cycle.where(error > record.attrs["within"]).max(str(cycle.dims[0])) + step).fillna(0.0)
    locked = since.values[since.values <= float(cycle[-1]) - record.attrs["hold"]]
    return Measures(
        {
            f"locked_share{ending}": Measure(len(locked) / len(since), "-"),
            f"lock_cycles{ending}": Measure(float(locked.mean()) if len(locked) else float("nan"), "cycle"),
            f"lock_cycles{ending}_most": Measure(float(locked.max()) if len(locked) else float("nan"), "cycle"),
        }
    )


experiment = PatternGeneratorExperiment()
