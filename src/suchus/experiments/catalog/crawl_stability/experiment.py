"""Does it crawl more steadily with spine and tail than without?"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.article.paper import SNAPSHOT_TIMES
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog._two_groups import TwoGroups, of_repeats, of_robots
from suchus.experiments.catalog.crawl_stability.figure import draw_heights, draw_snapshots, draw_spreads
from suchus.experiments.experiment import (
    Extent,
    Measure,
    Measures,
    Outcome,
    Progress,
    Replay,
    SimulationResult,
    estimated,
    silent,
    staged,
)
from suchus.robot.design.scale import coarse_step
from suchus.robot.gaits import conditions_of
from suchus.robot.motion import START, FootPath, max_stroke_factor
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import (
    displacement,
    duty_factor,
    height_peak_to_peak,
    height_std,
    line_distance,
    line_distance_max,
    roll_peak_to_peak,
    spine_sine_share,
    stance,
    support_distance,
    tail_load_share,
    tilt,
    two_feet_alone_share,
)

_EQUAL_DISPLACEMENT = "limbs_only_equal_displacement"
_SNAPSHOT_CONDITIONS = ("coordinated", "limbs_only", "limbs_tail_lifted")
"""Conditions whose snapshots are evaluated."""
_STATED = ("limbs_only", "tail_drag", _EQUAL_DISPLACEMENT)
"""Conditions that decide no word."""
_CHANGES = (
    ("com_height_pp_change", "com_height_pp", "coordinated", "limbs_only"),
    ("com_height_pp_change_tail_lifted", "com_height_pp", "coordinated", "limbs_tail_lifted"),
    ("com_height_pp_change_equal_displacement", "com_height_pp", "coordinated", _EQUAL_DISPLACEMENT),
    ("wagging_pp_change", "com_height_pp", "coordinated", "tail_still"),
    ("tail_contact_pp_change", "com_height_pp", "tail_still", "spine_only"),
    ("tail_contact_pp_change_limbs_only", "com_height_pp", "limbs_only", "limbs_tail_lifted"),
    ("spine_swing_pp_change", "com_height_pp", "coordinated", "tail_drag"),
    ("com_height_std_change", "com_height_std", "coordinated", "limbs_only"),
    ("roll_pp_change", "roll_pp", "coordinated", "limbs_only"),
)
"""Relative changes: name, quantity, condition, reference condition."""
_COMPARISON_MEASURES = (*(name for name, *_ in _CHANGES), "stroke_equal_displacement", "spine_sine_r2")
"""Measures that need more than the robots as built in one condition."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CrawlStability(TwoGroups):
    """The height of the centre of mass over time, for every combination of spine and tail.

    The article compares spine and tail together with neither of them, at the same leg commands. This comparison mixes
    four effects, so each combination is simulated here. Limbs only are simulated once more, with strokes that give
    the same displacement. Another body gets those conditions that its parts allow. The fluctuation is that of the
    article's Fig. 15: the highest minus the lowest height.
    """

    title = "Does it crawl more steadily with spine and tail than without?"
    shows = "Section IV.A, Figs 13 to 15"
    answers = (
        "com_height_pp_change_tail_lifted",
        "com_height_pp_change",
        "com_height_pp_coordinated",
        "com_height_pp_limbs_only",
        "roll_pp_coordinated",
        "roll_pp_limbs_only",
    )
    needs = ("limbs", "axis")
    answer_minima: ClassVar[Mapping[str, float]] = {"cycles": 2, "repeats": 6}

    extent: Extent = "whole"
    """How much is simulated: for the verdicts fewer robots in conditions that decide no word, and no work of servos."""

    def for_verdicts(self) -> "CrawlStability":
        """Return the same question with fewer robots in conditions that decide no word."""
        return replace(self, extent="verdicts")

    def quick(self) -> "CrawlStability":
        """One cycle, two repeats."""
        return replace(self, cycles=1, repeats=2)

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Simulate every condition, and limbs only with strokes for equal displacement, as designed and as built."""
        end = START + self.cycles * self.gait.period
        arms = conditions_of(self.robot, self.gait, self.control_group)
        runs = [Run(robot=self.robot, gait=gait, label=name) for name, gait in arms.items()]
        is_whole = self.extent == "whole"
        first_record = simulate(
            runs[:1], duration=end, effort=is_whole, progress=staged(progress, "first condition", 0.0, 0.1)
        )
        stroke_factor = self._equal_stroke(first_record, end, staged(progress, "equal displacement", 0.1, 0.4))
        runs.append(Run(robot=self.robot, gait=self.control_group.strode(stroke_factor), label=_EQUAL_DISPLACEMENT))
        record = simulate(runs, duration=end, effort=is_whole, progress=staged(progress, "as designed", 0.4, 0.5))
        built_progress = staged(progress, "robots as built", 0.5, 1.0)
        record = record.merge(self._built(runs, end, built_progress))
        record.attrs["equal_stroke"] = stroke_factor * self._stroke()
        return SimulationResult(record=record, replays=self._replays(record))

    def simulate_measures(self, measure_names: Collection[str], progress: Progress = silent) -> Measures:
        """Return at least the requested measures; only the conditions that they name are simulated."""
        if any(name.startswith(_COMPARISON_MEASURES) or _EQUAL_DISPLACEMENT in name for name in measure_names):
            return super(CrawlStability, self).simulate_measures(measure_names, progress)
        arms = conditions_of(self.robot, self.gait, self.control_group)
        requested_gaits = {arm: gait for arm, gait in arms.items() if any(f"_{arm}" in name for name in measure_names)}
        runs = [Run(robot=self.robot, gait=gait, label=arm) for arm, gait in requested_gaits.items()]
        end = START + self.cycles * self.gait.period
        record = self._built(runs, end, progress)
        return of_repeats(record, _UNITS) | self._snapshots(record)

    def _built(self, runs: Sequence[Run], end: float, progress: Progress) -> xr.Dataset:
        """Return the quantities of every condition and robot as built."""
        units = _UNITS | _snapshot_quantities()
        stated = _STATED if self.extent == "verdicts" else ()
        return self.repeated(runs, _quantities, units, end, progress, effort=False, stated=stated)

    def _replays(self, record: xr.Dataset) -> Mapping[str, Replay]:
        """Return the replay of the crawl with spine and tail and of that with longer strokes of the legs alone."""
        return replayed(
            "stability_replay.html",
            record.isel(run=0),
            self.robot,
            ghost=record.isel(run=-1),
            labels=("spine and tail", "legs alone, as far"),
            title="Two ways to get as far",
            caption="With spine and tail, and, half transparent, with longer strokes of the legs alone, just as far.",
        )

    def _equal_stroke(self, record: xr.Dataset, end: float, progress: Any) -> float:
        """Return the stroke with which the legs alone get as far as with spine and tail [stroke of the gait].

        The result is the longest stroke that the legs can follow where even that one does not get as far.

        Args:
            record: record of the condition with spine and tail.
            end: duration of each run [s].
            progress: callback that gets the finished fraction.
        """
        strokes = np.linspace(1.0, max_stroke_factor(self.robot, self.control_group), 10)
        runs = [Run(robot=self.robot, gait=self.control_group.strode(float(s))) for s in strokes]
        sweep = simulate(
            runs, duration=end, timestep=coarse_step(self.robot), sample_stride=100, effort=False, progress=progress
        )
        distances = displacement(sweep).sel(xyz="x").values
        target_distance = float(displacement(record).sel(xyz="x")[0])
        return float(np.interp(target_distance, np.maximum.accumulate(distances), strokes))

    def _stroke(self) -> float:
        """Return the longest half stroke of the gait's foot paths [m]; 0 where the gait has none."""
        girdles = zip(self.robot.girdles, self.control_group.limbs, strict=False)
        return max((g.limb.reach * abs(path.stroke) for g, path in girdles if isinstance(path, FootPath)), default=0.0)

    def measure(self, record: xr.Dataset) -> Measures:
        """Return the fluctuation in every condition, its changes, and the snapshots, of the robots as built."""
        measures = of_repeats(record, _UNITS)
        for name, quantity, arm, reference in _CHANGES:
            if {arm, reference} <= set(record.condition.values):
                values, reference_values = of_robots(record, quantity, arm, reference)
                measures |= estimated(name, values / reference_values - 1, "-")
        measures |= _designed_changes(record)
        measures |= {
            "stroke_equal_displacement": Measure(float(record.attrs["equal_stroke"]), "m"),
            "spine_sine_r2": Measure(float(spine_sine_share(record.isel(run=0))), "-"),
        }
        return measures | self._snapshots(record)

    def _snapshots(self, record: xr.Dataset) -> Measures:
        """Return the measures at the times of the article's snapshots, for each of the snapshot conditions."""
        measures = Measures()
        for condition in self._snapshot_runs(list(record.condition.values)):
            for quantity, unit in _snapshot_quantities().items():
                name_parts = quantity.removesuffix("_ms").rpartition("_")
                measure_name = (
                    f"{name_parts[0]}_{condition}_{name_parts[2]}_ms"
                    if quantity.endswith("_ms")
                    else f"{quantity}_{condition}"
                )
                (values,) = of_robots(record, quantity, condition)
                measures |= _estimate_if_majority(measure_name, values, unit)
        return measures

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say what the dragged tail, its swing and the trunk's swing each do to the height's fluctuation."""
        return self.render_explanation(measures, stroke=self._stroke())

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw height over time, the snapshots, the spread."""
        arms = [str(arm) for arm in outcome.record.condition.values][:-1]
        return {
            "height_of_mass": draw_heights(outcome.record, arms),
            "fluctuation": draw_spreads(outcome.record, arms),
            "snapshots": draw_snapshots(self.robot, outcome.record, self._snapshot_runs(arms), SNAPSHOT_TIMES),
        }

    @staticmethod
    def _snapshot_runs(arms: Sequence[str]) -> dict[str, int]:
        """Return the index of the run of each snapshot condition."""
        return {name: arms.index(name) for name in _SNAPSHOT_CONDITIONS if name in arms}


_UNITS = {
    "com_height_pp": "m", "com_height_std": "m", "roll_pp": "rad", "forward": "m", "tail_load_share": "-",
    "hind_duty": "-",
}  # fmt: skip
"""Quantities of every condition, and their units."""
_SNAPSHOT_UNITS = {
    "support_distance": "m",
    "line_distance": "m",
    "standing_feet": "-",
    "lean": "rad",
    "lean_on_two_feet": "rad",
}
"""Quantities at each of the article's three snapshot times, and their units."""


def _snapshot_quantities() -> dict[str, str]:
    """Return the unit of each quantity that the article's snapshots show: of the whole crawl, then of each time."""
    crawl_units = {"line_distance_max": "m", "two_feet_alone_share": "-"}
    return crawl_units | {
        f"{name}_{1000 * time:.0f}_ms": unit for time in SNAPSHOT_TIMES for name, unit in _SNAPSHOT_UNITS.items()
    }


def _designed_changes(record: xr.Dataset) -> Measures:
    """Return the changes of the peak-to-peak height of the robot exactly as designed, as ``NAME_designed``.

    Random errors of robots as built enlarge a peak-to-peak value on average, so the design may lie outside of the
    interval of these robots.
    """
    labels = [str(label) for label in record.condition.values]
    heights = dict(zip(labels, height_peak_to_peak(record).values, strict=True))
    return Measures(
        {
            f"{name}_designed": Measure(float(heights[arm] / heights[reference] - 1.0), "-")
            for name, quantity, arm, reference in _CHANGES
            if quantity == "com_height_pp" and {arm, reference} <= heights.keys()
        }
    )


def _quantities(record: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the quantities of each run, by the names of ``_UNITS`` and of ``_snapshot_quantities``.

    The distance from the edge of the support is NaN in conditions without snapshots.
    """
    quantities = {
        "com_height_pp": height_peak_to_peak(record),
        "com_height_std": height_std(record),
        "roll_pp": roll_peak_to_peak(record),
        "forward": displacement(record).sel(xyz="x"),
        "tail_load_share": tail_load_share(record),
        "hind_duty": duty_factor(record).sel(leg=record.leg.values[-2:]).max("leg"),
        "line_distance_max": line_distance_max(record),
        "two_feet_alone_share": two_feet_alone_share(record),
    }
    moments = xr.Dataset(
        {"line_distance": line_distance(record), "standing_feet": stance(record).sum("leg"), "lean": _lean(record)}
    )
    moments["lean_on_two_feet"] = moments.lean.where(moments.standing_feet == 2)
    shown = np.flatnonzero(np.isin(record.label.values, _SNAPSHOT_CONDITIONS))
    for time in SNAPSHOT_TIMES:
        snapshot = moments.sel(time=time, method="nearest")
        distances = np.full(record.sizes["run"], np.nan)
        distances[shown] = [support_distance(record.isel(run=i), time) for i in shown]
        snapshot["support_distance"] = ("run", distances)
        quantities |= {f"{name}_{1000 * time:.0f}_ms": snapshot[name] for name in _SNAPSHOT_UNITS}
    return quantities


def _lean(record: xr.Dataset) -> xr.DataArray:
    """Return the angle between the pelvis's vertical axis and that of the world over time [rad]."""
    tilted = tilt(record)
    upright = np.cos(tilted["roll"].values) * np.cos(tilted["pitch"].values)
    return tilted["roll"].copy(data=np.arccos(upright))


def _estimate_if_majority(name: str, values: xr.DataArray, unit: str) -> Measures:
    """Estimate a measure from its finite values if these are the majority, else from all values.

    Args:
        name: name of the measure.
        values: one value per repeat, NaN where it is undefined.
        unit: unit of the values.
    """
    finite_values = values.values[np.isfinite(values.values)]
    return estimated(name, finite_values if 2 * finite_values.size > values.size else values, unit)


experiment = CrawlStability()
