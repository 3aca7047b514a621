"""When do the feet stand, and which way do spine and tail bend meanwhile?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.article.paper import CYCLES
from suchus.core.checks import Checks
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.experiment import (
    Experiment,
    Measure,
    Measures,
    Outcome,
    Progress,
    SimulationResult,
    estimated,
    silent,
    staged,
)
from suchus.robot import blueprint
from suchus.robot.design import Robot, layout
from suchus.robot.gaits import GAITS
from suchus.robot.kinematics.tail import bend_of_servo
from suchus.robot.motion import START, Gait, as_table, intended
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, Tolerances, simulate
from suchus.sim.metrics import (
    bend_swings,
    diagonal_phase_error,
    duty_factor,
    limb_load,
    sensed_phase,
    smaller_swing,
    stance,
    time_window,
)
from suchus.visual.figures import captioned
from suchus.visual.figures.gait_diagram import GaitTrack, gait_diagram

_PARTS = ("spine", "tail")
_ANIMAL_GAIT = GAITS["animal_walk"]
_ANIMAL_PHASES = {
    name: phase - _ANIMAL_GAIT.limb_phases[0]
    for name, phase in zip(("LF", "RF", "LH", "RH"), _ANIMAL_GAIT.limb_phases, strict=True)
}
"""Phase lead of each foot of a walking salamander over its left front foot [cycle]."""
_CAPTION = "The crawl of the gait diagram: thick tracks are feet that stand."


@dataclass(frozen=True, slots=True, kw_only=True)
class GaitDiagram(Experiment):
    """The article's Fig. 12 for our crawl: as commanded, and from simulated foot pressures and joint angles.

    A foot stands when its pressure exceeds a seventieth of the weight, which is half a newton for the caiman. Phases
    are those of the first harmonic of stance. Bends are sums of joint angles: lateral ones of the yaw joints and
    cables, vertical ones of the pitch joints. Their signs are the article's: right and down are positive. A body
    without a tail, or without a trunk that bends, has no track of that part. The commanded cycle is also written as a
    gait file, a table of servo angles in which every angle can be changed.

    How far the stances of diagonal pairs are apart is judged of robots as built; everything else is shown of the robot
    exactly as designed, and that number of it as ``diagonal_phase_error_designed``.

    A body with two pairs of limbs is compared with an animal. No foot phases of a crocodilian are published as
    numbers, so the animal is a filmed salamander (the gait ``animal_walk``).
    """

    title = "When do the feet stand, and which way do spine and tail bend?"
    shows = "Section III.D, Fig. 12"
    answers = (
        "duty_factor_commanded",
        "duty_factor_greatest",
        "diagonal_phase_error",
        "spine_gain",
        "spine_lag",
        "tail_gain",
    )
    needs = ("limbs",)
    judged_settings = ("robot", "gait", "cycles", "tolerances")
    judged_minima: ClassVar[Mapping[str, float]] = {"repeats": 6}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that crawls."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The gait that is shown."""
    cycles: int = int(CYCLES)
    """Number of cycles that are shown [-]."""
    repeats: int = 6
    """Number of robots built of the design whose diagonal pairs are judged [-]."""
    tolerances: Tolerances = field(default_factory=Tolerances)
    """Tolerances of the robots built of the design, and of their grounds."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("cycles", 2, 1000)  # one cycle cannot show periodicity
            check.whole("repeats", 1, 1000)

    def quick(self) -> "GaitDiagram":
        """The same: it takes two seconds."""
        return replace(self)

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Crawl, exactly as designed and as built."""
        end = START + self.cycles * self.gait.period
        run = Run(robot=self.robot, gait=self.gait)
        runs = [run, *self.tolerances.repeats([run], self.repeats)]
        records = simulate(runs, duration=end, progress=staged(progress, "crawl", 0.0, 1.0))
        record = records.isel(run=0)
        record["built_diagonal_phase_error"] = (
            "repeat",
            [float(diagonal_phase_error(records.isel(run=1 + i))) for i in range(self.repeats)],
            {"units": "1", "long_name": "time between the stances of a diagonal pair, robots as built [cycle]"},
        )
        commanded = _commanded_bends(self.robot, record.servo_target.transpose("time", "servo").values)
        for body_part, bend in commanded.items():
            part, direction = body_part.removesuffix("_vertical"), _positive_direction(body_part)
            attrs = {"units": "rad", "long_name": f"commanded bend of the {part}, {direction} positive"}
            record[f"commanded_{body_part}"] = ("time", bend, attrs)
        sensed = _sensed_bends(self.robot, record)
        for body_part in commanded:
            record[f"sensed_{body_part}"] = (
                "time",
                sensed[body_part],
                {"units": "rad", "long_name": f"bend of the {body_part}"},
            )
        return SimulationResult(
            record=record,
            tables={"gait_table.toml": blueprint.render(as_table(self.robot, self.gait))},
            replays=replayed("gait_replay.html", record, self.robot, caption=_CAPTION),
        )

    def measure(self, record: xr.Dataset) -> Measures:
        """Return duty factors and phases by pressure, lags and amplitudes of the bends."""
        walk = time_window(record).isel(time=slice(0, -1))  # whole cycles: the last sample belongs to the next cycle
        legs = [str(leg) for leg in record.leg.values]
        duty, phase = duty_factor(record), sensed_phase(record)
        measures = Measures({f"duty_factor_{leg}": Measure(float(duty.sel(leg=leg)), "-") for leg in legs})
        measures |= {f"phase_{leg}": Measure(float(phase.sel(leg=leg)), "cycle") for leg in legs[1:]}
        for name in _bent_parts(record):
            bend = walk[f"sensed_{name}"].values
            lag, gain = _lag_and_gain(walk, bend, walk[f"commanded_{name}"].values)
            measures[f"{name}_lag"] = Measure(lag, "cycle")
            measures[f"{name}_amplitude"] = Measure(float(np.ptp(bend)) / 2, "rad")
            measures[f"{name}_gain"] = Measure(gain, "-")
            measures[f"{name}_changes_per_cycle"] = Measure(
                float(bend_swings(walk[f"sensed_{name}"], walk.period)), "-"
            )
        for name in _PARTS:
            if f"sensed_{name}_vertical" in walk:
                vertical_bend = walk[f"sensed_{name}_vertical"].values
                measures[f"{name}_vertical_mean"] = Measure(float(vertical_bend.mean()), "rad")
                measures[f"{name}_vertical_amplitude"] = Measure(float(np.ptp(vertical_bend)) / 2, "rad")
        if "sensed_tail" in walk:
            measures["tail_swing_least"] = Measure(float(smaller_swing(walk.sensed_tail)), "rad")
        if set(legs) == set(_ANIMAL_PHASES):
            phase_differences = [
                abs((float(phase.sel(leg=leg)) - _ANIMAL_PHASES[leg] + 0.5) % 1.0 - 0.5) for leg in legs
            ]
            measures["animal_phase_apart"] = Measure(max(phase_differences), "cycle")
        measures |= estimated("diagonal_phase_error", record.built_diagonal_phase_error.values, "cycle")
        return measures | {
            "duty_factor_greatest": Measure(float(duty.max()), "-"),
            "duty_factor_commanded": Measure(float(record.duty_factor), "-"),
            "diagonal_phase_error_designed": Measure(float(diagonal_phase_error(record)), "cycle"),
            "period": Measure(_period(walk), "s"),
            "cycles": Measure(
                float(round(float(walk.limb_phase.isel(leg=0)[-1] - walk.limb_phase.isel(leg=0)[0]))), "cycle"
            ),
        }

    def explain(self, measures: Mapping[str, float]) -> str:
        """Return how the motion of feet and joints differs from the commanded motion."""
        return self.render_explanation(
            measures, legs=layout(self.robot).limb_names, animal_duty=_ANIMAL_GAIT.duty_factor
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the simulated and the commanded gait diagram, and for a body of four limbs that of an animal."""
        walk = time_window(outcome.record)
        bends = {
            source: {
                body_part: walk[f"{source}_{body_part}"].values if f"{source}_{body_part}" in walk else None
                for body_part in (*_PARTS, *(f"{name}_vertical" for name in _PARTS))
            }
            for source in ("sensed", "commanded")
        }
        commanded_stance = (np.mod(walk.limb_phase, 1.0) >= 1.0 - walk.duty_factor).transpose("leg", "time").values
        sensed_stance = stance(walk).transpose("leg", "time").values
        time, legs = walk.time.values, tuple(str(leg) for leg in walk.leg.values)
        tracks = [
            GaitTrack(time=time, legs=legs, stance=sensed_stance, **bends["sensed"], label="simulated"),
            GaitTrack(time=time, legs=legs, stance=commanded_stance, **bends["commanded"], label="commanded"),
        ]
        marks = list(np.arange(START, time[-1] + 0.01, self.gait.period))
        figure = captioned(
            gait_diagram(tracks, cycles=marks),
            "Gait diagram in the form of the article's Fig. 12, black as simulated (foot pressure, joint angles), grey "
            "as commanded. Filled: a foot stands, or spine and tail bend to the right; open: they bend to the left. "
            "Below, the lateral angles, then the vertical ones.",
        )
        animal_figures = (
            {} if set(legs) != set(_ANIMAL_PHASES) else {"beside_an_animal": _draw_animal_comparison(walk, legs)}
        )
        return {"gait_diagram": figure, **animal_figures}


def _sensed_bends(robot: Robot, record: xr.Dataset) -> dict[str, np.ndarray]:
    """Return the simulated bends of spine and tail in the article's signs, right and down positive [rad].

    Args:
        robot: robot of the record.
        record: record of one run, with ``joint_angle`` (time, joint) [rad].

    Returns:
        Bends over time by ``spine``, ``tail``, and the same names with ``_vertical``.
    """
    body_layout = layout(robot)
    tail = {body_layout.servos[i] for i in body_layout.tail_yaw} | {
        name for i in body_layout.cables for name in body_layout.cable(i).hinges
    }
    hinges = {
        "spine": [body_layout.servos[i] for i in body_layout.trunk_yaw],
        "tail": sorted(tail, key=body_layout.hinges.index),
    }
    hinges |= {
        f"{body_part}_vertical": [body_layout.servos[i] for i in pitch]
        for body_part, pitch in _pitch_servos(robot).items()
    }
    signs = {"spine": -1.0}  # positive yaw bends the spine to the left and the tail to the right
    return {
        body_part: signs.get(body_part, 1.0) * record.joint_angle.sel(joint=names).sum("joint").values
        for body_part, names in hinges.items()
    }


def _draw_animal_comparison(walk: xr.Dataset, legs: tuple[str, ...]) -> Figure:
    """Draw the last whole cycle of a walk, and the mean cycle of the animal, both from phase zero of the first leg.

    Args:
        walk: record of one run.
        legs: names of the legs.
    """
    phase = walk.limb_phase.isel(leg=0).values
    cycle_start = phase[-1] - 1.0
    cycle = walk.isel(time=np.flatnonzero(phase >= cycle_start - 1e-9))
    cycle_phase = cycle.limb_phase.isel(leg=0).values
    shift = np.argmin(np.mod(cycle_phase, 1.0))
    clock = np.linspace(0.0, 1.0, 101)
    robot = ROBOTS["salamander"]
    begin = START + (1.0 - _ANIMAL_GAIT.limb_phases[0]) * _ANIMAL_GAIT.period
    bends = _commanded_bends(robot, intended(robot, _ANIMAL_GAIT, begin + clock * _ANIMAL_GAIT.period).targets)
    phase_leads = np.array([_ANIMAL_PHASES[leg] for leg in legs])[:, None]

    def roll_to_start(values: np.ndarray) -> np.ndarray:
        """Return values over one cycle, rolled along time such that they begin at phase zero."""
        return np.roll(values[..., :-1], -shift, axis=-1)

    sides = {
        body_part: roll_to_start(cycle[f"sensed_{body_part}"].values)
        for body_part in _PARTS
        if f"sensed_{body_part}" in cycle
    }
    robot_track = GaitTrack(
        time=np.mod(roll_to_start(cycle_phase), 1.0),
        legs=legs,
        stance=roll_to_start(stance(cycle).transpose("leg", "time").values),
        spine=sides.get("spine"),
        tail=sides.get("tail"),
        label="robot",
    )
    animal_track = GaitTrack(
        time=clock,
        legs=legs,
        stance=np.mod(clock + phase_leads, 1.0) >= 1.0 - _ANIMAL_GAIT.duty_factor,
        spine=bends["spine"],
        tail=bends["tail"],
        label="salamander",
    )
    return captioned(
        gait_diagram([robot_track, animal_track], unit="cycle"),
        "One cycle of the robot, black, by foot pressure and joint angles, beside the mean cycle of a walking "
        "salamander, Pleurodeles waltl, grey, by its filmed joint angles (Karakasiliotis et al. 2013), where a foot "
        "that goes forward swings. Both begin with the left front foot's swing. Filled: a foot stands, or spine and "
        "tail bend to the right; open: they bend to the left.",
    )


def _commanded_bends(robot: Robot, commanded: np.ndarray) -> dict[str, np.ndarray]:
    """Return the commanded bends of the parts that have servos, by the names of ``_sensed_bends`` [rad].

    Args:
        robot: robot that is commanded.
        commanded: commanded servo angles, shape (time, servo) [rad].
    """
    body_layout = layout(robot)
    bends: dict[str, np.ndarray] = {}
    if body_layout.trunk_yaw:
        bends["spine"] = -commanded[:, list(body_layout.trunk_yaw)].sum(axis=1)
    if body_layout.tail_yaw or body_layout.cables:
        cable_bend = sum(bend_of_servo(body_layout.cable(i), commanded[:, i]) for i in body_layout.cables)
        bends["tail"] = commanded[:, list(body_layout.tail_yaw)].sum(axis=1) + cable_bend
    vertical = {
        f"{body_part}_vertical": commanded[:, list(pitch)].sum(axis=1)
        for body_part, pitch in _pitch_servos(robot).items()
    }
    return bends | vertical


def _positive_direction(body_part: str) -> str:
    """Return the direction of a positive bend in the article's signs, by the names of ``_sensed_bends``."""
    return "down" if body_part.endswith("_vertical") else "right"


def _pitch_servos(robot: Robot) -> dict[str, tuple[int, ...]]:
    """Return the indices of the servos that bend spine and tail vertically, for those parts that have such servos."""
    body_layout = layout(robot)
    return {
        body_part: servos
        for body_part, servos in (("spine", body_layout.trunk_pitch), ("tail", body_layout.tail_pitch))
        if servos
    }


def _bent_parts(record: xr.Dataset) -> list[str]:
    """Return the parts of the body that servos bend sideways."""
    return [body_part for body_part in _PARTS if f"commanded_{body_part}" in record]


def _harmonic(record: xr.Dataset, values: np.ndarray) -> complex:
    """Return the complex amplitude of the first harmonic of values over time."""
    rotation = np.exp(-2j * np.pi * (record.time.values - START) / float(record.period))
    return complex(2 * np.mean((values - values.mean()) * rotation))


def _lag_and_gain(record: xr.Dataset, sensed: np.ndarray, commanded: np.ndarray) -> tuple[float, float]:
    """Return lag [cycle] and gain [-] of a sensed angle against the commanded one, from their first harmonics.

    Args:
        record: record of one run, for its times and its period.
        sensed: sensed angle over time [rad].
        commanded: commanded angle over time [rad].
    """
    commanded_harmonic, sensed_harmonic = _harmonic(record, commanded), _harmonic(record, sensed)
    if abs(commanded_harmonic) < 1e-6:
        return 0.0, float("nan")
    lag = -np.angle(sensed_harmonic / commanded_harmonic) / (2 * np.pi)
    return float(lag), abs(sensed_harmonic) / abs(commanded_harmonic)


def _period(record: xr.Dataset) -> float:
    """Return the time shift at which the loads of the feet agree best with themselves [s].

    Shifts from a half to one and a half of the commanded period are searched.
    """
    load = limb_load(record).sel(xyz="z").transpose("time", "leg").values
    step, period = float(record.time[1] - record.time[0]), float(record.period)
    shifts = np.arange(int(0.5 * period / step), min(int(1.5 * period / step), len(load) - 2))
    mismatches = [float(np.mean((load[n:] - load[:-n]) ** 2)) for n in shifts]
    return float(step * shifts[int(np.argmin(mismatches))])


experiment = GaitDiagram()
