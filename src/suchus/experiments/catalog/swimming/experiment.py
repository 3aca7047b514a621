"""How does it swim: the pressure around the waving body, and the speed it reaches on its own?"""

import json
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from math import nan
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.article.verdict import Rule
from suchus.article.verdict.ladder import Voice, voices
from suchus.core.checks import Checks
from suchus.core.progress import portion
from suchus.experiments.catalog._similar import similar
from suchus.experiments.catalog.swimming.figure import (
    draw_forces,
    draw_free,
    draw_ladder,
    draw_quarters,
    draw_sides,
    film_pressure,
    film_vorticity,
)
from suchus.experiments.catalog.swimming.ladder import (
    MOTIONS,
    LadderSetting,
    Swims,
    measures,
    motions,
    run_ladder,
    swims,
)
from suchus.experiments.catalog.swimming.ladder import table as ladder_table
from suchus.experiments.catalog.swimming.rules import LADDER, RULES
from suchus.experiments.experiment import (
    Experiment,
    Extent,
    Measure,
    Measures,
    Outcome,
    Progress,
    SimulationResult,
    silent,
    staged,
)
from suchus.robot.design import Robot
from suchus.robot.design.water import Water
from suchus.robot.kinematics.wave import READINGS
from suchus.robot.robots import ROBOTS
from suchus.sim.metrics import swim_numbers
from suchus.swimming.water import (
    ExactWave,
    Fit,
    Motion,
    Quarters,
    RealWaterSpeed,
    SpeedEstimate,
    SwimMeasures,
    convex_higher,
    efficiency,
    fit,
    fits_of_readings,
    printed_wave,
    readings_table,
    real_water_speed,
    swim,
)
from suchus.swimming.water.resolved import FREE, TETHERED, SwimSetting, resolved_swim, towed_drag
from suchus.swimming.water.samples import check_checkpoint_folder, checkpoint_path, checkpoint_paths

ARMS = ("trunk and tail", "trunk only", "tail only", "as printed", "exact wave", "exact wave as printed")
"""Conditions: the motions whose slices are compared while swimming freely, the first three of them the ladder's."""
_OF_RUNGS = tuple(f"_{rung}{end}" for rung in LADDER for end in ("", "_low", "_high", "_apart"))
"""Endings of the names of the ladder's measures."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaneSwims(Experiment):
    """The robot's own outline in a two-dimensional flow, its joints fitted to (20).

    Tethered, as in the article's Fig. 17: the snout is fixed, and every cycle but the first is measured. Values are
    those of the last cycle, ``_low`` and ``_high`` those of all measured cycles. ``pressure_difference`` is the mean
    pressure along the convex side of the tail less that along the concave side; the bend between the tail's root and
    its tip says which side is convex. ``pressure_moves`` is by how many tail lengths its place moves towards the tip
    from T/4 to 3T/4: the mean position along the tail, weighted with the size of the difference.

    Free: from rest, in a grid that travels along. The speed is the mean of the last cycle; ``efficiency`` is the power
    that towing the straight body at that speed takes over the power of the joints.

    What the claims say is asked of six models, the rungs of a ladder (``rules.LADDER``): the two slender-body theories,
    the slice with the midline that is commanded and with the one that the joints take in six degrees of freedom, these
    swims themselves, with the force of each section, and the body in three dimensions. On each, trunk and tail, the
    tail alone and the trunk alone swim freely from rest for ``cycles``, and the first is held at its snout where the
    water is resolved. Measures that end in the name of a rung are means over the most cycles whose halves agree;
    ``_low`` and ``_high`` are the ends of the halves and of a start to either side, in three dimensions also of the
    grids of a kept study; ``_apart`` is how far they lie apart. ``gain_tail_share`` and ``gain_spine_share`` are the
    shares of the speed that are missing without the swing of the tail and of the spine, ``pressure_convex_share`` and
    ``pressure_fall_share`` the pressure difference at T/4 and its fall to 3T/4 over its mean size. Theories and
    sections are of real water, the others of water at ``reynolds``.

    The printed direction and the wave that the midline follows exactly are compared with the slice too. Other readings
    of (20) are tethered in more viscous water, at ``readings_reynolds``.

    Everything is per metre of depth but ``servo_load_peak``, the torque at a servo's shaft over its limit: there every
    section is as high as the robot's and feels the flow's pressures.
    """

    title = "How does it swim?"
    shows = "Section IV.B, eq. (20), Fig. 17"
    answers = ("speed_free", "speed_as_printed", "gain_tail_share_space", "gain_spine_share_space",
               "gain_spine_share_slice", "misfit")  # fmt: skip
    needs = ("trunk", "tail_yaw")
    judged_settings = ("robot", "reading", "frequency", "reynolds")
    judged_minima: ClassVar[Mapping[str, float]] = {"cells": 80, "space_cells": 68, "cycles": 10}
    answer_minima: ClassVar[Mapping[str, float]] = {"cells": 80, "cycles": 10}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that swims."""
    reading: str = "I"
    """Letter of the reading of (20), see ``kinematics.wave.READINGS``."""
    frequency: float = 1.0
    """Frequency of the wave, which the article does not give [Hz], 0.01 to 20."""
    reynolds: float = 7000.0
    """Frequency times length squared over viscosity [-]; the robot's own would be 1e6, beyond any affordable grid."""
    cells: int = 80
    """Cells per body length of the slices [-]."""
    space_cells: int = 68
    """Cells per body length in three dimensions [-]."""
    cycles: int = 10
    """Cycles of every swim of the ladder, from rest; the fields of the last are shown [-]."""
    arm_cycles: int = 6
    """Cycles after which the conditions (directions, exact wave) are compared [-]."""
    readings: tuple[str, ...] = ("A", "C", "F", "H", "K")
    """Further readings of (20) whose thrust is measured [-], but for ``reading``; the joints cannot make the others."""
    readings_reynolds: float = 1000.0
    """Reynolds number of these [-]; their tails are up to four times as fast and would need a finer grid."""
    readings_cells: int = 40
    """Cells per body length of these [-]."""
    tow: float = 4.0
    """Distance over which the straight body is towed, its drag the mean over the last length [body length]."""
    extent: Extent = "whole"
    """How much swims: the whole, or what the verdicts need. Then neither other directions nor other readings of (20)
    swim, a rung of the ladder leaves out the swims of claims on which rungs before it disagree, and the straight body
    is not towed, so that the efficiency is left out."""
    frames: int = 20
    """Pictures of each film, over one cycle [-], 1 to 200."""
    keep: str = ""
    """Folder for what is finished of an interrupted run, from which it goes on, until its result is saved; empty
    keeps nothing."""

    def __post_init__(self) -> None:
        """Refuse unknown readings of (20), and settings outside their ranges."""
        with Checks("swimming", self) as check:
            check.number("frequency", 0.01, 20.0, "Hz")
            check.number("reynolds", 10.0, 2e4, "")
            check.number("readings_reynolds", 10.0, 2e4, "")
            unknown = [letter for letter in (self.reading, *self.readings) if letter not in READINGS]
            check.that(
                not unknown, f"swimming.readings of (20) are {', '.join(READINGS)}; there is no {', '.join(unknown)}"
            )
            for name in ("cells", "space_cells", "readings_cells"):
                check.whole(name, 32, 1024)
            check.number("tow", 1.5, 100.0, "body lengths")
            check.whole("frames", 1, 200)
            for name in ("cycles", "arm_cycles"):
                check.whole(name, 2, 100)

    def quick(self) -> "PlaneSwims":
        """A coarse grid, viscous water, few cycles."""
        return replace(
            self, cells=32, space_cells=40, cycles=2, arm_cycles=2, reynolds=1000.0, readings=("H",), readings_cells=32,
            tow=2.0, frames=3,
        )  # fmt: skip

    def for_verdicts(self) -> "PlaneSwims":
        """Return the same question with the swims that its verdicts need, and films of fewer pictures."""
        return replace(self, extent="verdicts", readings=(), frames=min(self.frames, 10))

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Swim tethered and free, in every motion, on every rung of the ladder, as far as ``extent`` says."""
        climb, printed_fit, slices = self.ladder_setting(), self._fit(1), dict[str, xr.Dataset]()
        wave_fit, is_whole = climb.wave_fit, self.extent == "whole"

        def swim_slices(names: Collection[str]) -> Swims:
            """Return the slice's swims of some names, and those that the record shows."""
            stage = staged(progress, "slice", 0.0, 0.3)
            names = {*names, MOTIONS[0], "held"}
            slices.update(swims(climb, "slice", motions(wave_fit.gait), stage, frames=self.frames, swim_names=names))
            return slices

        claims = None if is_whole else self.claims
        rungs = run_ladder(climb, staged(progress, "", 0.3, 0.8), slices=swim_slices, claims=claims)
        held_swim, free_swim = slices["held"], slices[MOTIONS[0]].drop_vars(("course", "course_centre"))
        parts = [_prefixed(held_swim, "held"), _prefixed(free_swim, "free")]
        if is_whole:
            printed_swim = self._held_swim("as printed", printed_fit, staged(progress, "as printed", 0.8, 0.85))
            printed_forces = printed_swim[["thrust", "aside", "power", "cycle_thrust"]]
            parts.insert(1, _prefixed(printed_forces, "printed"))
        parts.append(self._conditions(printed_fit, slices, staged(progress, "directions", 0.85, 0.92)))
        readings, table = self._readings(staged(progress, "readings of (20)", 0.92, 0.96))
        record = xr.merge([*parts, readings, rungs], join="exact")
        record["model_speed"] = swim(self.robot, wave_fit.gait).speed
        record["printed_model_speed"] = swim(self.robot, printed_fit.gait).speed
        if is_whole:
            drag = self._drag(float(free_swim.speed[-1]), staged(progress, "towed", 0.96, 1.0))
            record["towed_drag"] = ((), drag, {"units": "N/m"})
        record["servo_limit"] = ("held_servo", [self.robot.servo(str(s)).torque for s in held_swim.servo.values])
        record.servo_limit.attrs["units"] = "N m"
        record.attrs |= {"misfit": wave_fit.misfit, **rungs.attrs}
        progress("films", 1.0)
        films = {"swimming_vorticity.gif": film_vorticity(record), "swimming_pressure.gif": film_pressure(record)}
        numbers = {name: float(measure.value) for name, measure in measures(rungs, self.robot.length)}
        tables = {"readings.md": table, "ladder.md": ladder_table(numbers, self.unable(record))}
        swam = [f"{rung} {name}" for rung in ("slice", "slice_taken", "space") for name in (*MOTIONS, "held")]
        names = ("held as printed", *(f"free {arm}" for arm in ARMS[len(MOTIONS) :]), *swam)
        return SimulationResult(
            record=record, tables=tables, films=films, checkpoint_files=checkpoint_paths(self.keep, names)
        )

    def simulate_measures(self, measure_names: Collection[str], progress: Progress = silent) -> Measures:
        """Return at least the wanted measures; if they are the ladder's, only the ladder swims.

        Swims that no verdict needs are left out too: once two rungs disagree on a claim, slower rungs do not swim for
        it, and their measures are NaN.
        """
        if not all(name.endswith(_OF_RUNGS) for name in measure_names):
            return super(PlaneSwims, self).simulate_measures(measure_names, progress)
        claims = [rule.claim for rule in RULES if rule.needs & set(measure_names)]
        return Measures(measures(run_ladder(self.ladder_setting(), progress, claims=claims), self.robot.length))

    def unable(self, record: xr.Dataset) -> Mapping[str, str]:
        """Return the reasons why rungs of the ladder could not run, by name."""
        reasons: Mapping[str, str] = json.loads(record.attrs["unable"])
        return reasons

    def measure(self, record: xr.Dataset) -> Measures:
        """Return what the tethered and the free body did, and how fast each motion swims."""
        held_swim, free_swim = select_swim(record, "held"), select_swim(record, "free")
        return Measures(
            {"misfit": Measure(float(record.attrs["misfit"]), "-")},
            _thrusts(record, held_swim, self.reading),
            _tethered(held_swim),
            _free_swim(record, free_swim, self.robot, self.frequency, self.reynolds),
            _envelope(free_swim, self.robot),
            _condition_measures(record),
            measures(record, self.robot.length),
            _loads(held_swim, self.robot),
        )

    def real_water_speed(self, measures: Mapping[str, float]) -> RealWaterSpeed:
        """Return the speed of trunk and tail in real water, over the models that apply.

        Args:
            measures: numbers of the run by name.
        """
        real = self.frequency * self.robot.length**2 / Water().viscosity
        estimates = []
        for model in ("sections", "resistive", "reactive", "slice", "space"):
            speed = measures.get(f"speed_trunk_and_tail_{model}", nan)
            reynolds = self.reynolds if model in ("slice", "space") else real
            estimates.append(SpeedEstimate(model=model, speed=speed, low=speed, high=speed, reynolds=reynolds))
        return real_water_speed(estimates, real)

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say what spine and tail add by each model, and how fast it swims in real water."""
        return self.render_explanation(measures, real_water=self.real_water_speed(measures))

    def _setting(self, cycles: int, *, cells: int, reynolds: float, is_held: bool = True) -> SwimSetting:
        viscosity = self.frequency * self.robot.length**2 / reynolds
        return SwimSetting(cells=cells, viscosity=viscosity, cycles=cycles, free=TETHERED if is_held else FREE)

    def ladder_setting(self) -> LadderSetting:
        """Return the setting of the ladder.

        Raises:
            Unwritable: unfinished swims cannot be kept where they are to be.
        """
        check_checkpoint_folder(self.keep)
        return LadderSetting(
            robot=self.robot, wave_fit=self._fit(-1), viscosity=self.frequency * self.robot.length**2 / self.reynolds,
            cycles=self.cycles, cells=self.cells, space_cells=self.space_cells, keep=self.keep,
        )  # fmt: skip

    def _fit(self, sign: int) -> Fit:
        wave = printed_wave(self.robot, self.reading, frequency=self.frequency, sign=sign)
        return fit(self.robot, wave, name=f"(20), reading {self.reading}")

    def _held_swim(self, name: str, wave_fit: Fit, progress: Progress) -> xr.Dataset:
        """Return a swim in the slice with the snout fixed; it resumes from its checkpoint in ``keep``."""
        checkpoint = checkpoint_path(self.keep, f"held {name}")
        setting = self._setting(self.arm_cycles, cells=self.cells, reynolds=self.reynolds)
        return resolved_swim(
            self.robot, wave_fit.gait, setting, turn=wave_fit.head, checkpoint=checkpoint, progress=progress
        )

    def _conditions(self, printed_fit: Fit, slices: Swims, progress: Progress) -> xr.Dataset:
        """Return the speed in every condition and cycle; the first three are the ladder's slices.

        Of the extent ``verdicts`` there are only those that swam there.

        Args:
            printed_fit: gait in the printed direction.
            slices: swims of the ladder's slice, by motion.
            progress: called with the fraction that is done.
        """
        exact = [
            ExactWave(name=name, wave=printed_wave(self.robot, self.reading, frequency=self.frequency, sign=sign))
            for name, sign in zip(ARMS[4:], (-1, 1), strict=True)
        ]
        motions_by_arm: dict[str, Motion] = dict(zip(ARMS[3:], (printed_fit.gait, *exact), strict=True))
        setting = self._setting(self.arm_cycles, cells=self.cells, reynolds=self.reynolds, is_held=False)
        arms = ARMS if self.extent == "whole" else [arm for arm in MOTIONS if arm in slices]
        speeds = np.full((len(arms), max(self.arm_cycles, self.cycles)), np.nan)
        for i, arm in enumerate(arms):
            if arm in slices:
                swim_record = slices[arm]
            else:
                checkpoint, stage = (
                    checkpoint_path(self.keep, f"free {arm}"),
                    portion(progress, i - len(MOTIONS), len(motions_by_arm)),
                )
                swim_record = resolved_swim(
                    self.robot, motions_by_arm[arm], setting, checkpoint=checkpoint, progress=stage
                )
            speeds[i, : swim_record.sizes["cycle"]] = swim_record.speed.values
        data = xr.Dataset({"arm_speed": (("arm", "cycle"), speeds, {"units": "m/s"})})
        return data.assign_coords(arm=list(arms), cycle=np.arange(1, speeds.shape[1] + 1))

    def _readings(self, progress: Progress) -> tuple[xr.Dataset, str]:
        """Return the mean thrust of further readings, and a table of all of them."""
        fits_by_letter = {reading.letter: reading for reading in fits_of_readings(self.robot, frequency=self.frequency)}
        further = [letter for letter in self.readings if letter != self.reading]
        setting, thrust = (
            self._setting(min(4, self.cycles), cells=self.readings_cells, reynolds=self.readings_reynolds),
            [],
        )
        for i, letter in enumerate(further):
            wave_fit, stage = fits_by_letter[letter].fit, portion(progress, i, len(further))
            if wave_fit is None:
                thrust.append(float("nan"))
                continue
            held_swim = resolved_swim(self.robot, wave_fit.gait, setting, turn=wave_fit.head, progress=stage)
            thrust.append(float(held_swim.cycle_thrust[1:].mean()))
        thrusts = {
            letter: f"{value:.1f} N/m at Re {self.readings_reynolds:.0f}"
            for letter, value in zip(further, thrust, strict=True)
        }
        data = xr.Dataset({"reading_thrust": ("reading", thrust, {"units": "N/m"})})
        return data.assign_coords(reading=further), readings_table(fits_by_letter.values(), thrusts)

    def _drag(self, speed: float, progress: Progress) -> float:
        progress("towing", 0.0)
        min_speed = 0.02 * self.robot.length
        setting = self._setting(1, cells=self.cells, reynolds=self.reynolds)
        return towed_drag(self.robot, max(abs(speed), min_speed), setting, lengths=self.tow)

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the fields, the two sides of the tail, the forces, the free swim."""
        record = outcome.record
        return {
            "swimming_ladder": draw_ladder(self._claim_voices(record)),
            "swimming_pressure": draw_quarters(record),
            "swimming_sides": draw_sides(record),
            "swimming_forces": draw_forces(record),
            "swimming_free": draw_free(record),
        }

    def _claim_voices(self, record: xr.Dataset) -> list[tuple[Rule, tuple[Voice, ...]]]:
        """Return the result of each rung for each claim."""
        numbers = {name: float(measure.value) for name, measure in measures(record, self.robot.length)}
        return [(rule, voices(rule, numbers, self.unable(record))) for rule in RULES]


def _prefixed(record: xr.Dataset, name: str) -> xr.Dataset:
    """Return a record whose variables and dimensions carry the name of the swim."""
    return record.rename({str(old): f"{name}_{old}" for old in {*record.variables, *record.dims}})


def select_swim(record: xr.Dataset, name: str) -> xr.Dataset:
    """Return one swim of the record as ``water.resolved`` gave it."""
    start = f"{name}_"
    variables = record[[str(v) for v in record.data_vars if str(v).startswith(start)]]
    return variables.rename(
        {
            str(v): str(v).removeprefix(start)
            for v in {*variables.variables, *variables.dims}
            if str(v).startswith(start)
        }
    )


def _thrusts(record: xr.Dataset, held_swim: xr.Dataset, reading: str) -> Iterator[tuple[str, Measure]]:
    """Yield the mean thrust of the tethered body, its scatter over the cycles, and that of other readings [N/m]."""
    cycle_thrusts = held_swim.cycle_thrust[1:]
    yield f"thrust_mean_{reading}", Measure(float(cycle_thrusts.mean()), "N/m")
    yield "thrust_scatter", Measure(float(np.ptp(cycle_thrusts.values)), "N/m")
    if "printed_cycle_thrust" in record:
        yield "thrust_mean_as_printed", Measure(float(record.printed_cycle_thrust[1:].mean()), "N/m")
    for letter in record.reading.values:
        yield f"thrust_mean_{letter}", Measure(float(record.reading_thrust.sel(reading=letter)), "N/m")


def _tethered(held_swim: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    """Yield pressure differences, forces and power of the tethered body at the quarters of the cycle."""
    cycle_quarters = Quarters.from_record(held_swim)
    yield "convex_higher_share", Measure(convex_higher(held_swim), "-")
    yield "power_held", Measure(float(held_swim.cycle_power[1:].mean()), "W/m")
    yield "force_noise", Measure(float(held_swim.noise), "-")
    yield "thin_share", Measure(float(held_swim["thin"]), "-")
    for i in range(4):
        yield from _ranged(
            f"pressure_difference_{i + 1}_quarter", [quarters.difference[i] for quarters in cycle_quarters], "Pa"
        )
    for i in (0, 2):
        yield from _ranged(f"thrust_{i + 1}_quarter", [quarters.thrust[i] for quarters in cycle_quarters], "N/m")
        yield from _ranged(f"aside_{i + 1}_quarter", [quarters.aside[i] for quarters in cycle_quarters], "N/m")
    yield from _ranged("pressure_moves", [quarters.moves for quarters in cycle_quarters], "-")


def _free_swim(
    record: xr.Dataset, free_swim: xr.Dataset, robot: Robot, frequency: float, reynolds: float
) -> Iterator[tuple[str, Measure]]:
    """Yield speed, efficiency and similarity numbers of the free body, and the speeds of the slender-body models.

    Args:
        record: record of the experiment.
        free_swim: the free swim, of ``select_swim``.
        robot: the robot that swims.
        frequency: frequency of the wave [Hz].
        reynolds: frequency times length squared over viscosity [-].
    """
    swim_result = SwimMeasures.from_record(free_swim, frequency)
    yield "speed_free", Measure(swim_result.speed, "m/s")
    yield "speed_free_lengths", Measure(swim_result.speed / robot.length, "1/s")
    yield "speed_free_gain_last_cycle", Measure(swim_result.gain, "-")
    yield "slip", Measure(swim_result.slip, "-")
    numbers = swim_numbers(
        speed=swim_result.speed, length=robot.length, frequency=frequency,
        swing=swim_result.strouhal * abs(swim_result.speed) / frequency,
        viscosity=frequency * robot.length**2 / reynolds,
    )  # fmt: skip
    yield from similar(numbers).items()
    if "towed_drag" in record:
        efficiency_of_swim = efficiency(float(record.towed_drag), swim_result.speed, float(free_swim.power[-1]))
        yield "efficiency", Measure(efficiency_of_swim, "-")
    yield "water_cost_of_transport", Measure(swim_result.water_cost_of_transport, "-")
    yield "head_yaw", Measure(swim_result.head_yaw, "rad")
    for model in record.model.values:
        yield f"speed_{model}", Measure(float(record.model_speed.sel(model=model)), "m/s")
        yield f"speed_as_printed_{model}", Measure(float(record.printed_model_speed.sel(model=model)), "m/s")


def _envelope(free_swim: xr.Dataset, robot: Robot) -> Iterator[tuple[str, Measure]]:
    """Yield the growth of the free body's swing from its narrowest place to the tip."""
    swings, s = free_swim.swing.values, np.linspace(0.0, 1.0, free_swim.swing.size)
    narrowest_index = int(swings.argmin())
    running = np.maximum.accumulate(np.maximum(swings[narrowest_index:], np.finfo(float).tiny))
    dips = 1.0 - np.maximum(swings[narrowest_index:], np.finfo(float).tiny) / running
    yield "envelope_growth", Measure(float(swings[-1] / running[0]), "-")
    yield "envelope_least_place", Measure(float(s[narrowest_index]), "-")
    yield "envelope_dip", Measure(float(dips.max()), "-")
    yield "snout_sway", Measure(float(swings[0]) / robot.length, "-")


def _condition_measures(record: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    """Return the speed of the conditions that are no rung of the ladder, in their last cycle."""
    for arm in (str(name) for name in record.arm.values if name not in MOTIONS):
        speeds = record.arm_speed.sel(arm=arm).values
        yield f"speed_{arm.replace(' ', '_')}", Measure(float(speeds[np.isfinite(speeds)][-1]), "m/s")


def _loads(held_swim: xr.Dataset, robot: Robot) -> Iterator[tuple[str, Measure]]:
    """Yield the peak torque of each joint [N m/m], and of each servo over its torque limit [-]."""
    for joint in held_swim.joint.values:
        yield f"joint_torque_peak_{joint}", Measure(float(abs(held_swim.joint_torque.sel(joint=joint)).max()), "N m/m")
    for servo in held_swim.servo.values:
        peak = float(abs(held_swim.servo_torque.sel(servo=servo)).max())
        yield f"servo_load_peak_{servo}", Measure(peak / robot.servo(str(servo)).torque, "-")


def _ranged(name: str, values: list[float], unit: str) -> Iterator[tuple[str, Measure]]:
    """Yield the value of the last cycle, with the least and the greatest of all cycles."""
    yield name, Measure(float(values[-1]), unit)
    yield f"{name}_low", Measure(float(min(values)), unit)
    yield f"{name}_high", Measure(float(max(values)), unit)


experiment = PlaneSwims()
