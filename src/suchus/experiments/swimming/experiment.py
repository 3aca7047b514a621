"""How does it swim: the pressure around the waving body, and the speed it reaches on its own?"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.design import Robot
from suchus.design.checks import Checks
from suchus.experiment import Experiment, Measure, Outcome, Progress, Simulated, silent, staged
from suchus.experiments._taken import TAKEN, midlines
from suchus.experiments.swimming.figure import (
    draw_forces,
    draw_free,
    draw_quarters,
    draw_sides,
    film_pressure,
    film_vorticity,
)
from suchus.kinematics.wave import READINGS
from suchus.motion import Gait
from suchus.progress import portion
from suchus.robots import ROBOTS
from suchus.water import (
    ExactWave,
    Fit,
    Motion,
    Quarters,
    Sway,
    Swum,
    attempts,
    convex_higher,
    efficiency,
    fit,
    printed_wave,
    readings_table,
    swim,
    wave_form,
)
from suchus.water.resolved import FREE, TETHERED, SwimSetting, resolved_swim, towed_drag
from suchus.water.samples import all_kept, kept_in

ARMS = ("trunk and tail", "trunk only", "tail only", "as printed", "exact wave", "exact wave as printed")
"""Conditions: the motions that are compared while swimming freely."""
SETTLED = 4
"""Last cycles of the free swim over which its track is measured, fewer where it has fewer after the first [-]."""
_GAINS = {"tail": "trunk only", "spine": "tail only"}
"""The condition that lacks the swing of a part, by the name of the part."""


@dataclass(frozen=True, slots=True, kw_only=True)
class PlaneSwims(Experiment):
    """The robot's own outline in a two-dimensional flow, its joints fitted to (20).

    Tethered, as in the article's Fig. 17: the snout is fixed, and every cycle but the first is measured. Values are
    those of the last cycle, ``_low`` and ``_high`` those of all measured cycles. ``pressure_difference`` is the mean
    pressure along the convex side of the tail less that along the concave side; the bend between the tail's root and
    its tip says which side is convex. ``pressure_fall`` is by how much its size is smaller at 3T/4 than at T/4.
    ``pressure_moves`` is by how many tail lengths its place moves towards the tip meanwhile: the mean position along
    the tail, weighted with the size of the difference. ``force_angle_1_quarter`` is the angle between the force at T/4
    and the forward direction. ``thrust_asymmetry`` is the difference between the forces at T/4 and 3T/4, left and right
    swapped, over the greater part of the force.

    Free: from rest, in a grid that travels along. The speed is the mean of the last cycle; ``efficiency`` is the power
    that towing the straight body at that speed takes over the power of the joints. ``track_sway`` is the lateral
    amplitude of the centre of mass, ``track_noise`` twice the standard deviation of what is no sine of one cycle, both
    over the last four cycles and in body lengths. ``wave_share`` is the part of the midline's mean square swing that
    the nearest wave of the form (20) has. ``gain_tail_swim`` is the speed of trunk and tail less that of the trunk
    alone, ``gain_spine_swim`` less that of the tail alone.

    Trunk, tail, the printed direction, and the wave that the midline follows exactly are compared on a coarser grid.
    With ``taken`` the midlines that the same commands give in six degrees of freedom at the surface, where the water
    distributes the cable's bend among its joints, swim as further conditions; of these midlines only yaw counts. Other
    readings of (20) are tethered in more viscous water, at ``readings_reynolds``.

    Everything is per metre of depth but ``servo_load_peak``, the torque at a servo's shaft over its limit: there every
    section is as high as the robot's and feels the flow's pressures.
    """

    title = "How does it swim?"
    shows = "Section IV.B, eq. (20), Fig. 17"
    answers = ("speed_free", "speed_trunk_only", "speed_tail_only", "speed_as_printed", "power_held", "misfit")
    needs = ("trunk", "tail_yaw")
    judged_with = ("robot", "reading", "frequency", "reynolds")
    judged_from: ClassVar[Mapping[str, float]] = {
        "cells": 128, "coarse_cells": 80, "cycles": 4, "free_cycles": 8, "arm_cycles": 6,
    }  # fmt: skip

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that swims."""
    reading: str = "I"
    """Letter of the reading of (20), see ``kinematics.wave.READINGS``."""
    frequency: float = 1.0
    """Frequency of the wave, which the article does not give [Hz], 0.01 to 20."""
    reynolds: float = 7000.0
    """Frequency times length squared over viscosity [-]; the robot's own would be 1e6, beyond any affordable grid."""
    cells: int = 128
    """Cells per body length, tethered and free [-]."""
    coarse_cells: int = 80
    """The same where trunk, tail, directions and the exact wave are compared, and of the towed body [-]."""
    cycles: int = 4
    """Cycles of the tethered body; all but the first are measured, and the fields of the last are shown [-]."""
    free_cycles: int = 10
    """Cycles of the free body; speeds are of the last, the track of the last four [-]."""
    arm_cycles: int = 6
    """Cycles after which the conditions (trunk, tail, directions, exact wave) are compared [-]."""
    readings: tuple[str, ...] = ("A", "C", "F", "H", "K")
    """Further readings of (20) whose thrust is measured [-]; the joints cannot make the others."""
    readings_reynolds: float = 1000.0
    """Reynolds number of these [-]; their tails are up to four times as fast and would need a finer grid."""
    readings_cells: int = 40
    """Cells per body length of these [-]."""
    tow: float = 4.0
    """Distance over which the straight body is towed, its drag the mean over the last length [body length]."""
    frames: int = 20
    """Pictures of each film, over one cycle [-], 1 to 200."""
    taken: bool = False
    """Whether the midline that the joints take in six degrees of freedom swims too, with trunk and tail and with the
    tail alone: two more swims like those of trunk and tail."""
    keep: str = ""
    """Folder for what is finished of an interrupted run, from which it goes on, until its result is saved; empty
    keeps nothing."""

    def __post_init__(self) -> None:
        with Checks("swimming", self) as check:
            check.number("frequency", 0.01, 20.0, "Hz")
            check.number("reynolds", 10.0, 2e4, "")
            check.number("readings_reynolds", 10.0, 2e4, "")
            unknown = [letter for letter in (self.reading, *self.readings) if letter not in READINGS]
            check.that(
                not unknown, f"swimming.readings of (20) are {', '.join(READINGS)}; there is no {', '.join(unknown)}"
            )
            for name in ("cells", "coarse_cells", "readings_cells"):
                check.whole(name, 32, 1024)
            check.number("tow", 1.5, 100.0, "body lengths")
            check.whole("frames", 1, 200)
            for name in ("cycles", "free_cycles", "arm_cycles"):
                check.whole(name, 2, 100)

    def quick(self) -> "PlaneSwims":
        """A coarse grid, viscous water, few cycles."""
        return replace(
            self, cells=32, coarse_cells=32, cycles=2, free_cycles=2, arm_cycles=2, reynolds=1000.0, readings=("H",),
            readings_cells=32, tow=2.0, frames=3,
        )  # fmt: skip

    def simulate(self, progress: Progress = silent) -> Simulated:
        """Swim tethered and free, in every motion."""
        ours, printed = (self._fit(sign) for sign in (-1, 1))
        held = self._held("ours", ours, staged(progress, "tethered", 0.0, 0.08))
        printed_swim = self._held("as printed", printed, staged(progress, "as printed", 0.08, 0.16))
        free = self._free("ours", ours.gait, self.cells, self.free_cycles, staged(progress, "free", 0.16, 0.5))
        conditions = self._conditions(ours, printed, free, staged(progress, "trunk and tail separately", 0.5, 0.8))
        bent = self._taken(ours.gait, staged(progress, "midline of the joints", 0.8, 0.92)) if self.taken else []
        readings, table = self._readings(staged(progress, "readings of (20)", 0.92, 0.96))
        drag = self._drag(float(free.speed[-1]), staged(progress, "towed", 0.96, 1.0))
        printed_forces = printed_swim[["thrust", "aside", "power", "cycle_thrust"]]
        record = xr.merge(
            [
                _prefixed(held, "held"),
                _prefixed(printed_forces, "printed"),
                _prefixed(free, "free"),
                conditions,
                readings,
                *bent,
            ],
            join="exact",
        )
        record["model_speed"] = swim(self.robot, ours.gait).speed
        record["printed_model_speed"] = swim(self.robot, printed.gait).speed
        record["towed_drag"] = ((), drag, {"units": "N/m"})
        record["servo_limit"] = ("held_servo", [self.robot.servo(str(s)).torque for s in held.servo.values])
        record.servo_limit.attrs["units"] = "N m"
        record.attrs["misfit"] = ours.misfit
        progress("films", 1.0)
        films = {"swimming_vorticity.gif": film_vorticity(record), "swimming_pressure.gif": film_pressure(record)}
        names = ("held ours", "held as printed", *(f"free {arm}" for arm in ("ours", *ARMS, *TAKEN)))
        return Simulated(
            record=record, tables={"readings.md": table}, films=films, kept=all_kept(self.keep, names)
        )  # fmt: skip

    def measure(self, record: xr.Dataset) -> Mapping[str, Measure]:
        """Return what the tethered and the free body did, and how fast each motion swims."""
        held, free = part(record, "held"), part(record, "free")
        return {
            "misfit": Measure(float(record.attrs["misfit"]), "-"),
            **dict(_thrusts(record, held, self.reading)),
            **dict(_tethered(held)),
            **dict(_free_swim(record, free, self.robot, self.frequency)),
            **dict(_wave(free, self.robot)),
            **dict(_track(free, self.robot)),
            **dict(_compared(record)),
            **dict(_loads(held, self.robot)),
        }

    def _setting(
        self, free: tuple[bool, bool, bool], cells: int, cycles: int, reynolds: float | None = None
    ) -> SwimSetting:
        viscosity = self.frequency * self.robot.length**2 / (reynolds or self.reynolds)
        return SwimSetting(cells=cells, viscosity=viscosity, cycles=cycles, free=free, frames=self.frames)

    def _fit(self, sign: int) -> Fit:
        wave = printed_wave(self.robot, self.reading, frequency=self.frequency, sign=sign)
        return fit(self.robot, wave, name=f"(20), reading {self.reading}")

    def _held(self, name: str, fitted: Fit, progress: Progress) -> xr.Dataset:
        kept, setting = kept_in(self.keep, f"held {name}"), self._setting(TETHERED, self.cells, self.cycles)
        return resolved_swim(self.robot, fitted.gait, setting, turn=fitted.head, checkpoint=kept, progress=progress)

    def _free(self, name: str, motion: Motion, cells: int, cycles: int, progress: Progress) -> xr.Dataset:
        kept, setting = kept_in(self.keep, f"free {name}"), self._setting(FREE, cells, cycles)
        return resolved_swim(self.robot, motion, setting, checkpoint=kept, progress=progress)

    def _conditions(self, ours: Fit, printed: Fit, free: xr.Dataset, progress: Progress) -> xr.Dataset:
        """Return the speed in every condition and cycle; the first is the free swim itself on equal grids."""
        exact = [
            ExactWave(name=name, wave=printed_wave(self.robot, self.reading, frequency=self.frequency, sign=sign))
            for name, sign in zip(ARMS[4:], (-1, 1), strict=True)
        ]
        motions: tuple[Motion, ...] = (
            ours.gait, ours.gait.straightened("tail"), ours.gait.straightened("trunk"), printed.gait, *exact,
        )  # fmt: skip
        speeds = []
        for i, (arm, motion) in enumerate(zip(ARMS, motions, strict=True)):
            done = i == 0 and self.coarse_cells == self.cells and self.arm_cycles <= self.free_cycles
            stage = portion(progress, i, len(ARMS))
            swum = free if done else self._free(arm, motion, self.coarse_cells, self.arm_cycles, stage)
            speeds.append(swum.speed.values[: self.arm_cycles])
        data = xr.Dataset({"arm_speed": (("arm", "cycle"), np.array(speeds), {"units": "m/s"})})
        return data.assign_coords(arm=list(ARMS), cycle=np.arange(1, self.arm_cycles + 1))

    def _taken(self, motion: Gait, progress: Progress) -> list[xr.Dataset]:
        """Return speeds of the midlines that joints take in six degrees of freedom, and the error of their angles."""
        speeds, away = [], []
        bent = midlines(self.robot, motion, self.coarse_cells + 1)
        for i, (arm, bends, off) in enumerate(bent):
            stage = portion(progress, i, len(bent))
            speeds.append(self._free(arm, bends, self.coarse_cells, self.arm_cycles, stage).speed.values)
            away.append(off)
        data = xr.Dataset(
            {
                "taken_speed": (("taken_arm", "cycle"), np.array(speeds), {"units": "m/s"}),
                "taken_away": ("taken_arm", away, {"units": "1", "long_name": "rms angle off, over that commanded"}),
            }
        )
        return [data.assign_coords(taken_arm=list(TAKEN), cycle=np.arange(1, self.arm_cycles + 1))]

    def _readings(self, progress: Progress) -> tuple[xr.Dataset, str]:
        """Return the mean thrust of further readings, and a table of all of them."""
        tried = {one.letter: one for one in attempts(self.robot, frequency=self.frequency)}
        setting, thrust = self._setting(TETHERED, self.readings_cells, self.cycles, self.readings_reynolds), []
        for i, letter in enumerate(self.readings):
            fitted, part = tried[letter].fitted, portion(progress, i, len(self.readings))
            if fitted is None:
                thrust.append(float("nan"))
                continue
            held = resolved_swim(self.robot, fitted.gait, setting, turn=fitted.head, progress=part)
            thrust.append(float(held.cycle_thrust[1:].mean()))
        thrusts = {
            letter: f"{value:.1f} N/m at Re {self.readings_reynolds:.0f}"
            for letter, value in zip(self.readings, thrust, strict=True)
        }
        data = xr.Dataset({"reading_thrust": ("reading", thrust, {"units": "N/m"})})
        return data.assign_coords(reading=list(self.readings)), readings_table(tried.values(), thrusts)

    def _drag(self, speed: float, progress: Progress) -> float:
        progress("towing", 0.0)
        least = 0.02 * self.robot.length
        setting = self._setting(TETHERED, self.coarse_cells, 1)
        return towed_drag(self.robot, max(abs(speed), least), setting, lengths=self.tow)

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the fields, the two sides of the tail, the forces, the free swim."""
        record = outcome.record
        return {
            "swimming_pressure": draw_quarters(record),
            "swimming_sides": draw_sides(record),
            "swimming_forces": draw_forces(record),
            "swimming_free": draw_free(record),
        }


def _prefixed(record: xr.Dataset, name: str) -> xr.Dataset:
    """Return a record whose variables and dimensions carry the name of the swim."""
    return record.rename({str(old): f"{name}_{old}" for old in {*record.variables, *record.dims}})


def part(record: xr.Dataset, name: str) -> xr.Dataset:
    """Return one swim of the record as ``water.resolved`` gave it."""
    start = f"{name}_"
    mine = record[[str(v) for v in record.data_vars if str(v).startswith(start)]]
    return mine.rename(
        {str(v): str(v).removeprefix(start) for v in {*mine.variables, *mine.dims} if str(v).startswith(start)}
    )


def _thrusts(record: xr.Dataset, held: xr.Dataset, reading: str) -> Iterator[tuple[str, Measure]]:
    settled = held.cycle_thrust[1:]
    yield f"thrust_mean_{reading}", Measure(float(settled.mean()), "N/m")
    yield "thrust_scatter", Measure(float(np.ptp(settled.values)), "N/m")
    yield "thrust_mean_as_printed", Measure(float(record.printed_cycle_thrust[1:].mean()), "N/m")
    for letter in record.reading.values:
        yield f"thrust_mean_{letter}", Measure(float(record.reading_thrust.sel(reading=letter)), "N/m")


def _tethered(held: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    each = Quarters.each(held)
    yield "convex_higher_share", Measure(convex_higher(held), "-")
    yield "power_held", Measure(float(held.cycle_power[1:].mean()), "W/m")
    yield "force_noise", Measure(float(held.noise), "-")
    yield "thin_share", Measure(float(held["thin"]), "-")
    for i in range(4):
        yield from _ranged(f"pressure_difference_{i + 1}_quarter", [one.difference[i] for one in each], "Pa")
    for i in (0, 2):
        yield from _ranged(f"thrust_{i + 1}_quarter", [one.thrust[i] for one in each], "N/m")
        yield from _ranged(f"aside_{i + 1}_quarter", [one.aside[i] for one in each], "N/m")
    yield from _ranged("force_angle_1_quarter", [one.angle for one in each], "rad")
    yield from _ranged("pressure_fall", [one.fall for one in each], "Pa")
    yield from _ranged("pressure_moves", [one.moves for one in each], "-")
    yield from _ranged("thrust_asymmetry", [one.asymmetry for one in each], "-")


def _free_swim(record: xr.Dataset, free: xr.Dataset, robot: Robot, frequency: float) -> Iterator[tuple[str, Measure]]:
    swum = Swum.of(free, frequency)
    yield "speed_free", Measure(swum.speed, "m/s")
    yield "speed_free_lengths", Measure(swum.speed / robot.length, "1/s")
    yield "speed_free_gain_last_cycle", Measure(swum.gain, "-")
    yield "slip", Measure(swum.slip, "-")
    yield "strouhal", Measure(swum.strouhal, "-")
    yield "efficiency", Measure(efficiency(float(record.towed_drag), swum.speed, float(free.power[-1])), "-")
    yield "cost_of_transport", Measure(swum.cost_of_transport, "-")
    yield "head_yaw", Measure(swum.head_yaw, "rad")
    for model in record.model.values:
        yield f"speed_{model}", Measure(float(record.model_speed.sel(model=model)), "m/s")
        yield f"speed_as_printed_{model}", Measure(float(record.printed_model_speed.sel(model=model)), "m/s")


def _wave(free: xr.Dataset, robot: Robot) -> Iterator[tuple[str, Measure]]:
    """Return the share of a sine in the tail's swing, and the share of a wave of the form (20) in the midline's."""
    tip, swings, s = free.tip_share.values, free.swing.values, np.linspace(0.0, 1.0, free.swing.size)
    yield "tail_sine_share", Measure(float(free.sine_share[-1]), "-")
    yield "tail_sine_share_low", Measure(float(tip.min()), "-")
    yield "tail_sine_share_high", Measure(float(tip.max()), "-")
    least = int(swings.argmin())
    running = np.maximum.accumulate(np.maximum(swings[least:], np.finfo(float).tiny))
    dips = 1.0 - np.maximum(swings[least:], np.finfo(float).tiny) / running
    yield "envelope_growth", Measure(float(swings[-1] / running[0]), "-")
    yield "envelope_least_place", Measure(float(s[least]), "-")
    yield "envelope_dip", Measure(float(dips.max()), "-")
    linear, quadratic, waves, share = wave_form(s, swings, free.swing_late.values)
    sine = float(np.average(free.sine_share.values, weights=swings**2))
    yield "wave_share", Measure(sine * share, "-")
    yield "wave_waves_per_body", Measure(waves, "-")
    yield "wave_envelope_middle", Measure(abs(0.5 * linear + 0.25 * quadratic) / robot.length, "-")
    yield "wave_envelope_tip", Measure(abs(linear + quadratic) / robot.length, "-")


def _track(free: xr.Dataset, robot: Robot) -> Iterator[tuple[str, Measure]]:
    """Return how far the centre of mass sways to the side over the last cycles."""
    cycles = free.sizes["cycle"]
    count, each = max(min(SETTLED, cycles - 1), 1), (free.sizes["moment"] - 1) // cycles
    sway = Sway.of(free.centre_y.values[-(count * each + 1) :], count)
    yield "track_sway", Measure(sway.amplitude / robot.length, "-")
    yield "track_sway_low", Measure(sway.low / robot.length, "-")
    yield "track_sway_high", Measure(sway.high / robot.length, "-")
    yield "track_noise", Measure(sway.noise / robot.length, "-")
    yield "track_cycles", Measure(float(count), "-")
    yield "snout_sway", Measure(float(free.swing[0]) / robot.length, "-")


def _compared(record: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    """Return the speed of each condition in its last cycle, and the gain by tail and spine in the last two."""
    last = {str(arm): record.arm_speed.sel(arm=arm).values[-2:] for arm in record.arm.values}
    for arm, speeds in last.items():
        yield f"speed_{arm.replace(' ', '_')}", Measure(float(speeds[-1]), "m/s")
    if "taken_speed" in record:
        for arm in record.taken_arm.values:
            name, one = str(arm).replace(" ", "_"), record.sel(taken_arm=arm)
            yield f"speed_{name}", Measure(float(one.taken_speed[-1]), "m/s")
            yield f"misfit_{name}", Measure(float(one.taken_away), "-")
    both = last["trunk and tail"]
    for name, without in _GAINS.items():
        yield from _ranged(f"gain_{name}_swim", list(both - last[without]), "m/s")
    yield from _ranged("gain_tail_swim_share", list((both - last["trunk only"]) / both), "-")


def _loads(held: xr.Dataset, robot: Robot) -> Iterator[tuple[str, Measure]]:
    for joint in held.joint.values:
        yield f"joint_torque_peak_{joint}", Measure(float(abs(held.joint_torque.sel(joint=joint)).max()), "N m/m")
    for servo in held.servo.values:
        peak = float(abs(held.servo_torque.sel(servo=servo)).max())
        yield f"servo_load_peak_{servo}", Measure(peak / robot.servo(str(servo)).torque, "-")


def _ranged(name: str, values: list[float], unit: str) -> Iterator[tuple[str, Measure]]:
    """Return the value of the last cycle, with the least and the greatest of all cycles."""
    yield name, Measure(float(values[-1]), unit)
    yield f"{name}_low", Measure(float(min(values)), unit)
    yield f"{name}_high", Measure(float(max(values)), unit)


experiment = PlaneSwims()
