"""How fast and how well does it swim at other frequencies, amplitudes and wavelengths?"""

from collections.abc import Callable, Mapping
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.core.checks import Checks
from suchus.core.jobs import at_scheduler, conduct_sweep
from suchus.experiments.catalog._similar import similar
from suchus.experiments.catalog.swim_sweep.figure import draw_check, draw_maps
from suchus.experiments.experiment import (
    Experiment,
    Measure,
    Measures,
    Outcome,
    Progress,
    SimulationResult,
    silent,
    staged,
)
from suchus.robot.design import Robot
from suchus.robot.motion import Gait, movement
from suchus.robot.robots import ROBOTS
from suchus.sim.metrics import swim_numbers
from suchus.swimming.water import MODELS, SwimMeasures, fit, max_amplitude_factor, printed_wave, survey
from suchus.swimming.water.resolved import SwimSetting, resolved_swim
from suchus.swimming.water.samples import check_checkpoint_folder

_PEERS = (
    ("C. porosus, 0.3 to 1.1 m", "sustained speed rises with size, in body lengths it falls", "Elsworth et al. 2003"),
    ("Crocodilians", "speed is set by the frequency, not by the wave's speed", "abstract on I. lesueurii"),
    ("Crocodilians", "amplitude grows to the tail's tip; slip below 1", "Fish 2021, Integr. Comp. Biol."),
    ("Salamandra", "0.9 to 1.3 Hz swimming, 0.39 to 0.52 rad per joint", "simulation_parameters.py of its CPG"),
    ("Pleurobot", "0.8 rad per joint, a tenth of a cycle later each: one wave per body", "its published configuration"),
)  # fmt: skip

_HERTZ = 1.0  # [Hz]; frequency of the points
_SWIM_UNITS = {"speed": "m/s", "water_cost_of_transport": "1", "gain": "1", "strouhal": "1", "slip": "1"}
"""Stored numbers of a swim by CFD, with units; see ``water.SwimMeasures``."""


def swim_point(robot: Robot, setting: SwimSetting, motion: Gait, progress: Progress) -> xr.Dataset:
    """Return the numbers of one swim from rest by CFD.

    Args:
        robot: the robot that swims.
        setting: grid, water and duration.
        motion: gait at 1 Hz.
        progress: called with the fraction that is done.
    """
    numbers = SwimMeasures.from_record(
        resolved_swim(robot, motion, setting, progress=progress), motion.frequency
    )._asdict()
    return xr.Dataset({name: ((), numbers[name], {"units": unit}) for name, unit in _SWIM_UNITS.items()})


@dataclass(frozen=True, slots=True, kw_only=True)
class SwimSweep(Experiment):
    """(20) fitted to the joints, every angle multiplied, at other frequencies and wavelengths.

    The whole map by the two slender-body models of the round body; some points by CFD as a check, from rest,
    their last cycle measured. By CFD the frequency is no independent parameter: at one Reynolds number
    f L^2 / nu, speeds are proportional to it. ``efficiency`` is the power that towing the straight body takes over that
    of the joints, ``water_cost_of_transport`` that of the joints over displaced weight and speed. What joints or servos
    cannot follow is hatched.
    """

    title = "How fast and how well does it swim at other frequencies, amplitudes and wavelengths?"
    shows = "Section IV.B, eq. (20); beyond the article"
    answers = (
        "speed_most_resistive",
        "efficiency_most_resistive",
        "error_mean_resistive",
        "speed_most_reactive",
        "efficiency_most_reactive",
        "error_mean_reactive",
    )
    reproduces: ClassVar[bool] = False
    needs = ("axis",)
    answer_minima: ClassVar[Mapping[str, float]] = {"frequencies": 6, "cycles": 6}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that swims."""
    reading: str = "I"
    """Letter of the reading of (20); only this one has a wavelength to change."""
    frequencies: tuple[float, ...] = (0.25, 0.5, 0.75, 1.0, 1.25, 1.5)
    """Frequencies of the map [Hz], 0.01 to 20."""
    amplitudes: tuple[float, ...] = (0.4, 0.7, 1.0, 1.3, 1.6)
    """Factors on all angles of the motion [-]."""
    waves: tuple[float, ...] = (0.6, 0.8, 1.0, 1.2, 1.4)
    """Waves per body length, at most 1.4, beyond which the trunk's joints cannot follow [-]."""
    points: tuple[tuple[float, float], ...] = ((0.6, 1.0), (1.0, 1.0), (1.4, 1.0), (1.0, 1.3))
    """Amplitude and waves per body length of the points that are checked by CFD [-]."""
    reynolds: float = 7000.0
    """Reynolds number of these points: frequency times length squared over viscosity [-]."""
    cells: int = 72
    """Cells per body length in these points [-]."""
    cycles: int = 6
    """Cycles of these points, of which the last is measured [-]."""
    keep: str = ""
    """Folder for finished points, from which an interrupted run continues; empty: none is kept."""
    scheduler: str = ""
    """Address of a Dask scheduler whose workers compute the points, as tcp://127.0.0.1:8786; empty: they are computed
    here."""

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges, and maps or lists of points that are too short."""
        with Checks("swim_sweep", self) as check:
            for name, lower_bound, upper_bound, unit in (
                ("frequencies", 0.01, 20.0, "Hz"), ("amplitudes", 0.01, 4.0, ""), ("waves", 0.1, 1.4, ""),
            ):  # fmt: skip
                check.rising(name, lower_bound, upper_bound, unit)
                check.that(len(getattr(self, name)) > 1, f"swim_sweep.{name} has one number; a map needs two")
            is_valid = [0.01 <= amplitude <= 4.0 and 0.1 <= waves <= 1.4 for amplitude, waves in self.points]
            check.that(
                all(is_valid) and is_valid != [],
                f"swim_sweep.points is {self.points}; an amplitude of 0.01 to 4 and 0.1 to 1.4 waves are needed "
                "of each, one point at least",
            )
            check.number("reynolds", 10.0, 2e4, "")
            check.whole("cells", 32, 1024)
            check.whole("cycles", 2, 100)

    def quick(self) -> "SwimSweep":
        """Return few points, a coarse grid and a low Reynolds number."""
        return replace(
            self, frequencies=(0.4, 0.8, 1.2, 1.6), amplitudes=(0.5, 1.1, 1.7), waves=(0.6, 0.9, 1.2, 1.4),
            points=((1.0, 1.0), (1.4, 1.0)), reynolds=1000.0, cells=32, cycles=2,
        )  # fmt: skip

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Compute the maps by the slender-body models, and the points by CFD."""
        with at_scheduler(self.scheduler or None) as client:  # refused before anything is computed
            return self._simulated(progress, client)

    def _simulated(self, progress: Progress, client: Any) -> SimulationResult:
        """Compute maps and points; ``client`` is the Dask client that computes the points, None computes them here."""
        check_checkpoint_folder(self.keep)
        gaits = {waves: self._fit(waves) for waves in {1.0, *self.waves}}
        by_frequency = self._map("frequency", self.frequencies, lambda a, f: replace(gaits[1.0].bent(a), period=1 / f))
        progress("slender-body models", 0.15)
        by_waves = self._map("waves", self.waves, lambda a, w: gaits[w].bent(a))
        progress("slender-body models", 0.3)
        points = self._points(staged(progress, "CFD", 0.3, 1.0), client)
        record = xr.merge([by_frequency, by_waves, points], join="exact", combine_attrs="no_conflicts")
        return SimulationResult(record=record, tables={"peers.md": self._peers(record)})

    def _fit(self, waves: float) -> Gait:
        wave = printed_wave(self.robot, self.reading, waves_per_body=waves)
        return fit(self.robot, wave, name=f"(20), {waves:.2g} waves per body").gait

    def _map(self, axis: str, values: tuple[float, ...], motion: Callable[[float, float], Gait]) -> xr.Dataset:
        """Return the results of the slender-body models on a grid of amplitude and another parameter.

        Args:
            axis: the other parameter, ``frequency`` or ``waves``.
            values: values of the other parameter, in Hz or waves per body length.
            motion: gait of an amplitude factor and a value of the other parameter.
        """
        motions = [motion(amplitude, value) for amplitude in self.amplitudes for value in values]
        flat = survey(self.robot, motions)
        shape = (len(self.amplitudes), len(values))
        data: dict[str, Any] = {}
        for name, variable in flat.data_vars.items():
            dims = ("model", "amplitude", axis) if "model" in variable.dims else ("amplitude", axis)
            sizes = (*variable.shape[:-1], *shape)
            data[f"{name}_by_{axis}"] = (dims, variable.values.reshape(sizes), variable.attrs)
        max_amplitudes = [max_amplitude_factor(self.robot, motion(1.0, value)) for value in values]
        data[f"most_amplitude_by_{axis}"] = (axis, max_amplitudes, {"units": "1"})
        units = {"frequency": "Hz", "waves": "1"}
        coords = {
            "model": flat.model.values.tolist(),
            "amplitude": ("amplitude", list(self.amplitudes), {"units": "1"}),
            axis: (axis, list(values), {"units": units[axis]}),
        }
        return xr.Dataset(data, coords=coords)

    def _points(self, progress: Progress, client: Any) -> xr.Dataset:
        """Return the points by CFD at 1 Hz, and their speeds by the slender-body models.

        Args:
            progress: called with the fraction that is done.
            client: Dask client that computes the points; None computes them here.
        """
        motions = [self._fit(waves).bent(amplitude) for amplitude, waves in self.points]
        setting = SwimSetting(cells=self.cells, viscosity=self.robot.length**2 / self.reynolds, cycles=self.cycles)
        work = partial(swim_point, self.robot, setting)
        with nullcontext(self.keep) if self.keep else TemporaryDirectory() as folder:
            swims = conduct_sweep(self.name(), work, motions, Path(folder), progress=progress, client=client)
        slender = survey(self.robot, motions)
        data: dict[str, Any] = {
            **{
                f"point_{name}": ("point", [float(swim[name]) for swim in swims], {"units": unit})
                for name, unit in _SWIM_UNITS.items()
            },
            "point_model_speed": (("model", "point"), slender.speed.values, {"units": "m/s"}),
            "point_amplitude": ("point", [amplitude for amplitude, _ in self.points], {"units": "1"}),
            "point_waves": ("point", [waves for _, waves in self.points], {"units": "1"}),
        }
        return xr.Dataset(data, attrs={"cells": self.cells, "cycles": self.cycles, "reynolds": self.reynolds})

    def measure(self, record: xr.Dataset) -> Measures:
        """Return the best of the maps, the errors of the slender-body models, and the speed of every point."""
        measures = Measures()
        possible = record.possible_by_frequency
        for model in record.model.values:
            speed = record.speed_by_frequency.sel(model=model).where(possible)
            by_waves = record.sel(model=model).where(record.possible_by_waves)
            measures[f"speed_most_{model}"] = Measure(float(speed.max()), "m/s")
            nominal_speed = speed.sel(amplitude=1.0, method="nearest")
            measures[f"speed_power_of_frequency_{model}"] = Measure(_power(record.frequency, nominal_speed), "-")
            measures[f"speed_power_of_amplitude_{model}"] = Measure(
                _power(record.amplitude, speed.isel(frequency=0)), "-"
            )
            measures[f"efficiency_most_{model}"] = Measure(float(by_waves.efficiency_by_waves.max()), "-")
            cheapest = float(by_waves.water_cost_of_transport_by_waves.min())
            measures[f"water_cost_of_transport_least_{model}"] = Measure(cheapest, "-")
            errors = record.point_model_speed.sel(model=model) / record.point_speed - 1
            measures[f"error_mean_{model}"] = Measure(float(errors.mean()), "-")
            measures[f"error_worst_{model}"] = Measure(float(errors[int(np.argmax(np.abs(errors.values)))]), "-")
            measures[f"order_agrees_{model}"] = Measure(_order(record, str(model)), "-")
        for i, (amplitude, waves) in enumerate(self.points):
            name = f"{amplitude:.1f}_waves_{waves:.1f}".replace(".", "_")
            speed = float(record.point_speed[i])
            measures[f"speed_amplitude_{name}"] = Measure(speed, "m/s")
            numbers = swim_numbers(
                speed=speed, length=self.robot.length, frequency=_HERTZ,
                swing=float(record.point_strouhal[i]) * abs(speed) / _HERTZ,
                viscosity=_HERTZ * self.robot.length**2 / self.reynolds,
            )  # fmt: skip
            measures |= similar(numbers, f"_amplitude_{name}")
        return measures

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say how the speed depends on frequency and amplitude, and how far the slender-body models are from CFD."""
        return self.render_explanation(measures, models=MODELS)

    def _peers(self, record: xr.Dataset) -> str:
        """Return a table of published motions of crocodilians and robots beside the caiman's."""
        motion = self._fit(1.0)
        slips = record.point_slip.values
        motion_text = (
            f"1 Hz; {', '.join(_amplitudes(self.robot, motion))}; one wave per body; slip {slips.min():.2f} to "
            f"{slips.max():.2f}"
        )
        rows = [(self.robot.name, motion_text, "this run"), *_PEERS]
        lines = ["| who | what | source |", "|---|---|---|", *(f"| {a} | {b} | {c} |" for a, b, c in rows)]
        return "\n".join(lines) + "\n"

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the maps of each model, and the check."""
        record = outcome.record
        maps = {f"swim_sweep_{model}": draw_maps(record, str(model)) for model in record.model.values}
        return {**maps, "swim_sweep_check": draw_check(record)}


def _power(quantity: xr.DataArray, speed: xr.DataArray) -> float:
    """Return the exponent of a quantity in the speed, from the first to the last possible motion [-].

    Args:
        quantity: parameter of each motion.
        speed: speed of each motion; NaN where the motion is impossible [m/s].
    """
    good = np.flatnonzero(np.isfinite(speed.values) & (speed.values > 0.0))
    if good.size < 2:
        return float("nan")
    ends = [good[0], good[-1]]
    rise, run = np.diff(np.log(speed.values[ends])), np.diff(np.log(quantity.values[ends]))
    return float((rise / run)[0])


def _order(record: xr.Dataset, model: str) -> float:
    """Return the share of the pairs of points that a slender-body model puts in the same order as CFD [-]."""
    cfd, slender = record.point_speed.values, record.point_model_speed.sel(model=model).values
    pairs = [(i, j) for i in range(cfd.size) for j in range(i)]
    agree = [(cfd[i] - cfd[j]) * (slender[i] - slender[j]) > 0.0 for i, j in pairs]
    return float(np.mean(agree)) if agree else float("nan")


def _amplitudes(robot: Robot, gait: Gait) -> list[str]:
    """Return the amplitudes of the joints of trunk and tail, from the root, in words."""
    yaw, words = movement(robot, gait).yaw, []
    for body_part in ("trunk", "tail"):
        bends = [f"{bend:.2f}" for bend in yaw.amplitude()[0][yaw.hinges.indices_in(body_part)]]
        from_root = bends[::-1] if body_part == "trunk" else bends
        if from_root:
            words.append(f"{body_part} {', '.join(dict.fromkeys(from_root))} rad per joint")
    return words


experiment = SwimSweep()
