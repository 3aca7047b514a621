"""How does a salamander's own swim, played joint by joint on its model, swim?"""

from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.core import rotation
from suchus.core.checks import Checks
from suchus.core.errors import SuchusError
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog._similar import similar
from suchus.experiments.catalog.salamander_swim import animal_swim as animal
from suchus.experiments.catalog.salamander_swim import own_size
from suchus.experiments.catalog.salamander_swim.rules import LADDER
from suchus.experiments.experiment import (
    Experiment,
    Measure,
    Measures,
    Outcome,
    Progress,
    Replay,
    SimulationResult,
    silent,
    staged,
)
from suchus.robot.design import Robot
from suchus.robot.design.water import Water
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Lake, Run, simulate
from suchus.sim.metrics import SwimNumbers, cycle_speeds, settled_mean, swim_numbers
from suchus.swimming.water import MODELS, Outline, cruise
from suchus.visual.figures.style import COLOURS, captioned, panels, styled


@dataclass(frozen=True, slots=True, kw_only=True)
class SalamanderSwim(Experiment):
    """The mean swimming cycle of Pleurodeles waltl, played on the robot built after it; nothing is fitted.

    The robot floats in fresh water, its limbs folded back; as it is lighter than the animal, part of it is above the
    surface, and nothing holds it upright but the water. Beside the coefficients as they are, the swim at the highest
    frequency is repeated with factors on each of them. Beside the model, which is 0.1 m long and lighter than the
    animal, swim the animal and others at their own length, mass and volume, each with its own wave.

    The two slender-body theories give a stride too (``rules.LADDER``), of a body that is aligned with its mean course.
    ``stride_sections`` is the mean of two halves of the measured cycles, ``_apart`` how far these are apart.
    """

    title = "How does a salamander's own swim, played joint by joint on its model, swim?"
    shows = "Beyond the article: kinematics of swimming salamanders"
    answers = ("stride_swim", "stride_off", "strouhal", "swing_tail", "share_under")
    needs = ("salamander_joints",)
    judged_settings = ("robot", "frequencies")
    judged_minima: ClassVar[Mapping[str, float]] = {"settle": 6, "cycles": 4}
    answer_minima: ClassVar[Mapping[str, float]] = {"settle": 6, "cycles": 4}

    robot: Robot = field(default_factory=lambda: ROBOTS["salamander"])
    """The robot that swims; a table of angles made for it is played."""
    frequencies: tuple[float, ...] = animal.FREQUENCIES
    """Frequencies of the swims [Hz]."""
    settle: int = 16
    """Cycles that are swum before anything is measured; ``unsettled_swims`` counts the swims that are not settled by
    then, by ``metrics.settled_mean`` [-]."""
    cycles: int = 10
    """Cycles that are measured [-]."""
    factors: tuple[float, ...] = (0.5, 2.0)
    """Factors on cross drag, friction, added mass and shed momentum, one of which is changed at a time, at the
    highest frequency [-]."""
    own_size: tuple[str, ...] = tuple(own_size.ANIMALS)
    """Animals that swim at their own length, mass and volume, see ``own_size.ANIMALS``."""

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges, and animals that are not in ``own_size.ANIMALS``."""
        with Checks(self.name(), self) as check:
            check.rising("frequencies", 0.1, 20.0, "Hz")
            check.whole("settle", 0, 1000)
            check.whole("cycles", 1, 1000)
            if self.factors:
                check.rising("factors", 0.05, 20.0, "")
            unknown = [name for name in self.own_size if name not in own_size.ANIMALS]
            check.that(not unknown, f"own_size names {', '.join(unknown)}; there is {', '.join(own_size.ANIMALS)}")

    def quick(self) -> "SalamanderSwim":
        """Return one frequency, two cycles after the first one, coefficients as they are, and one other animal."""
        return replace(
            self, frequencies=self.frequencies[:1], settle=1, cycles=2, factors=(), own_size=self.own_size[:1]
        )

    def for_verdicts(self) -> "SalamanderSwim":
        """Return the same question without other waters and animals of their own size, which no verdict reads."""
        return replace(self, factors=(), own_size=())

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Swim at every frequency, and in other waters at the highest."""
        water = Water()
        lake = Lake(level=2.0 * self.robot.length, water=water)
        waters = [lake]
        for factor in self.factors:
            drag, skin = factor * water.cross_drag, factor * water.thickening
            waters += [
                replace(lake, water=replace(water, cross_drag=drag)),
                replace(lake, water=replace(water, thickening=skin)),
                replace(lake, added_mass=factor),
                replace(lake, shedding=factor),
            ]
        records = []
        for i, frequency in enumerate(self.frequencies):
            gait = animal.animal_gait(self.robot, frequency)
            lakes = waters if i == len(self.frequencies) - 1 else waters[:1]
            runs = [
                Run(robot=self.robot, gait=gait, lake=lake_variant, label=f"{frequency:g} Hz") for lake_variant in lakes
            ]
            stage_bounds = (0.7 * i / len(self.frequencies), 0.7 * (i + 1) / len(self.frequencies))
            stage = staged(progress, f"swim at {frequency:g} Hz", *stage_bounds)
            records.append(simulate(runs, duration=(self.settle + self.cycles) / frequency, progress=stage))
        fastest_record = records[-1].isel(run=[0])
        full_record = fastest_record.merge(self._swims(records), combine_attrs="override", compat="no_conflicts")
        if self.own_size:
            animals = own_size.swim_animals(
                self.own_size, settle=self.settle, cycles=self.cycles,
                progress=staged(progress, "animals of their own size", 0.7, 1.0),
            )  # fmt: skip
            full_record = full_record.merge(animals, combine_attrs="override", compat="no_conflicts")
        return SimulationResult(record=full_record, replays=self._replays(full_record))

    def _swims(self, records: list[xr.Dataset]) -> xr.Dataset:
        """Return stride, swing and envelope of each swim, and the strides in other waters."""
        strides, envelopes, angle_errors, submerged_fractions, heel, unsettled = [], [], [], [], [], []
        for record, frequency in zip(records, self.frequencies, strict=True):
            start = self.settle / frequency
            strides.append([self._stride(record.isel(run=i), start, self.cycles) for i in range(record.sizes["run"])])
            means = [
                settled_mean(cycle_speeds(record.isel(run=i), 1.0 / frequency)) for i in range(record.sizes["run"])
            ]
            unsettled.append(sum(not (mean.is_settled and mean.start <= self.settle) for mean in means))
            envelopes.append(animal.envelope(self.robot, record.isel(run=0), start, 1.0 / frequency))
            names = [name for name in record.servo.values if name in record.joint.values]
            angle_error = record.joint_angle.sel(joint=names).values - record.servo_target.sel(servo=names).values
            angle_errors.append(float(np.sqrt((angle_error[0] ** 2).mean())))
            excerpt = record.isel(run=0).sel(time=slice(start - 1e-9, None))
            submerged_fractions.append(float(excerpt.share_under.mean()))
            heel.append(float(np.abs(rotation.heel(excerpt.orientation.values)).max()))
        units = {"units": "body length"}
        return xr.Dataset(
            {
                "stride": ("swim", [lengths[0] for lengths in strides], units),
                "stride_other": ("water", strides[-1], units),
                "stride_rung": (("rung", "swim", "half"), self._rungs(records), units),
                "swing": (("swim", "point"), [envelope.swing for envelope in envelopes], units),
                "missed": ("swim", angle_errors, {"units": "rad"}),
                "under": ("swim", submerged_fractions, {"units": "1"}),
                "heel": ("swim", heel, {"units": "rad"}),
                "unsettled": ("swim", unsettled, {"units": "1"}),
            },
            coords={
                "frequency": ("swim", list(self.frequencies), {"units": "Hz"}),
                "rung": list(LADDER),
                "place": ("point", envelopes[0].position, units),
            },
        )

    def _rungs(self, records: list[xr.Dataset]) -> np.ndarray:
        """Return the strides by rung, swim and half of the measured cycles [body length]; NaN where a theory cannot."""
        strides = np.full((len(LADDER), len(records), 2), np.nan)
        outline, length = Outline(self.robot), self.robot.length
        for i, (record, frequency) in enumerate(zip(records, self.frequencies, strict=True)):
            gait, half = animal.animal_gait(self.robot, frequency), self.cycles // 2 / frequency
            for rung, model in MODELS.items():
                with suppress(SuchusError):
                    strides[list(LADDER).index(rung), i] = (
                        cruise(outline, gait, model, Water()).speed / frequency / length
                    )
            for j in (0, 1) if self.cycles > 1 else ():
                start = self.settle / frequency + j * half
                excerpt = record.isel(run=0).sel(time=slice(None, start + half + 1e-9))
                strides[list(LADDER).index("sections"), i, j] = self._stride(excerpt, start, self.cycles // 2)
        return strides

    def _stride(self, record: xr.Dataset, start: float, cycles: int) -> float:
        """Return the displacement of the centre of mass in a cycle; negative if it moves tail first [body length]."""
        excerpt = record.sel(time=slice(start - 1e-9, None))
        path_ends = excerpt.centre_of_mass.transpose("time", "xyz").values[[0, -1], :2]
        facing = rotation.rotate(excerpt.orientation.transpose("time", "wxyz").values, np.array([1.0, 0.0, 0.0]))
        distance = float(np.hypot(*(path_ends[1] - path_ends[0]))) / cycles / self.robot.length
        return float(np.copysign(distance, (path_ends[1] - path_ends[0]) @ facing[:, :2].mean(axis=0)))

    def _replays(self, record: xr.Dataset) -> Mapping[str, Replay]:
        """Return the replay of the swim at the highest frequency, by file name."""
        return replayed(
            "animal_swim_replay.html",
            record.isel(run=0),
            self.robot,
            title="The swim of a salamander, played joint by joint",
            caption=f"Joint angles of a swimming salamander on its model, at {self.frequencies[-1]:g} cycles a second.",
        )

    def measure(self, record: xr.Dataset) -> Measures:
        """Return stride, Strouhal number and envelope of the swims, and how far off the animal's stride they are."""
        measures, strides = Measures(), record.stride.values
        for i, frequency in enumerate(record.frequency.values):
            name = f"{frequency:g}".replace(".", "_")
            measures[f"stride_swim_{name}"] = Measure(float(strides[i]), "body length")
            measures |= similar(self._numbers(frequency, strides[i], float(record.swing[i, -1])), f"_{name}")
        other_strides, mean = record.stride_other.values, float(strides.mean())
        mean_swing = record.swing.mean("swim").values
        swims = zip(record.frequency.values, strides, record.swing.values[:, -1], strict=True)
        mean_numbers = SwimNumbers(*np.mean([self._numbers(*swim) for swim in swims], axis=0).tolist())
        narrowest_index = int(mean_swing.argmin())
        return measures | {
            "stride_swim": Measure(mean, "body length"),
            "stride_off": Measure(mean / animal.STRIDE - 1.0, "-"),
            "stride_least": Measure(float(other_strides.min()), "body length"),
            "stride_most": Measure(float(other_strides.max()), "body length"),
            **similar(mean_numbers),
            "swing_snout": Measure(float(mean_swing[0]), "body length"),
            "swing_least": Measure(float(mean_swing[narrowest_index]), "body length"),
            "swing_least_at": Measure(float(record.place[narrowest_index]), "body length"),
            "swing_tail": Measure(float(mean_swing[-1]), "body length"),
            "share_under": Measure(float(record.under.mean()), "-"),
            "heel": Measure(float(record.heel.max()), "rad"),
            "unsettled_swims": Measure(float(record.unsettled.sum()), "-"),
            "angle_missed": Measure(float(record.missed.max()), "rad"),
            "trim_submerged": Measure(own_size.trim_submerged(self.robot), "rad"),
            **dict(_rung_measures(record)),
            **own_size.measures(record),
        }

    def _numbers(self, frequency: float, stride: float, swing: float) -> SwimNumbers:
        """Return the similarity numbers of a swim whose stride and tail swing are in body lengths."""
        length = self.robot.length
        return swim_numbers(
            speed=stride * length * frequency, length=length, frequency=frequency, swing=swing * length,
            viscosity=Water().viscosity,
        )  # fmt: skip

    def explain(self, measures: Mapping[str, float]) -> str:
        """Set the stride beside the animal's."""
        return self.render_explanation(
            measures, stride=animal.STRIDE, animals=own_size.ANIMAL_LABELS, rolled=own_size.ROLLOVER_HEEL
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the strides over the frequency, and how far the body swings along its length."""
        record = outcome.record
        figures = {"strides": draw_strides(record, animal.STRIDE), "envelope": draw_envelope(record)}
        return figures | ({"own_size": own_size.draw(record, animal.STRIDE)} if "animal" in record.dims else {})


def _rung_measures(record: xr.Dataset) -> Iterator[tuple[str, Measure]]:
    """Yield every rung's stride and its relative error, with bounds and spread over two halves of the cycles."""
    for rung in record.rung.values:
        halves = record.stride_rung.sel(rung=rung).mean("swim", skipna=False).values
        spread = float(np.ptp(halves)) / max(abs(float(halves.mean())), 1e-9)
        ends = {"": halves.mean(), "_low": halves.min(), "_high": halves.max()}
        for end, stride in ends.items():
            yield f"stride_{rung}{end}", Measure(float(stride), "body length")
            yield f"stride_off_{rung}{end}", Measure(float(stride) / animal.STRIDE - 1.0, "-")
        yield f"stride_{rung}_apart", Measure(spread, "-")
        yield f"stride_off_{rung}_apart", Measure(spread, "-")


def draw_strides(record: xr.Dataset, animal: float) -> Figure:
    """Draw the stride over the frequency beside the animal's, with the spread over other waters at the highest.

    Args:
        record: record with ``frequency`` and ``stride`` of each swim, and ``stride_other`` in other waters.
        animal: the animal's stride [body length].
    """
    frequency, stride, other_strides = record.frequency.values, record.stride.values, record.stride_other.values
    with styled():
        figure, axes = panels(1, 1, width=7.0, height=4.2)
        ax = axes[0, 0]
        ax.axhline(animal, color=COLOURS["neutral"], linewidth=1.2, linestyle=(0, (5, 2)), label="the animal, mean")
        ax.plot(frequency, stride, "o-", color=COLOURS["coordinated"], label="its angles on the model")
        if other_strides.size > 1:
            spread = [[stride[-1] - other_strides.min()], [other_strides.max() - stride[-1]]]
            ax.errorbar(frequency[-1:], stride[-1:], yerr=spread, color=COLOURS["coordinated"], capsize=4)
        ax.set(xlabel="frequency [Hz]", ylabel="stride [body lengths a cycle]")
        ax.set_ylim(0.0, 1.15 * max(animal, float(other_strides.max()), float(stride.max())))
        ax.legend(loc="lower left")
    spread_text = " The bar is the spread over other coefficients of the water."
    return captioned(
        figure,
        "How far the model comes in a cycle when it plays the swimming animal's joint angles, beside the animal."
        f"{spread_text if other_strides.size > 1 else ''}",
    )


def draw_envelope(record: xr.Dataset) -> Figure:
    """Draw how far the body swings from end to end over the place behind the snout, a line for each frequency.

    Args:
        record: record with ``frequency`` and ``swing`` of each swim, and ``place``.
    """
    shades = np.linspace(0.35, 1.0, record.sizes["swim"])
    with styled():
        figure, axes = panels(1, 1, width=7.0, height=4.2)
        ax = axes[0, 0]
        for swing, frequency, shade in zip(record.swing.values, record.frequency.values, shades, strict=True):
            ax.plot(record.place, swing, "o-", color=COLOURS["coordinated"], alpha=shade, label=f"{frequency:g} Hz")
        ax.set(xlabel="behind the snout [body length]", ylabel="swing from end to end [body length]")
        ax.set_ylim(bottom=0.0)
        ax.legend(loc="upper left")
    return captioned(
        figure,
        "How far snout, joints of the axis and tail tip swing across the mean course, from end to end, when the model "
        "plays the swimming animal's joint angles.",
    )


experiment = SalamanderSwim()
