"""Does it crawl more steadily with spine and tail than without?"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from suchus.design.scale import coarse_step
from suchus.experiment import Measure, Outcome, Progress, Replay, Simulated, ranged, silent, staged
from suchus.experiments._replayed import replayed
from suchus.experiments._two_groups import TwoGroups
from suchus.experiments.crawl_stability.figure import draw_heights, draw_snapshots, draw_spreads
from suchus.gaits import conditions_of
from suchus.land import Run, simulate
from suchus.metrics import (
    displacement,
    height_peak_to_peak,
    height_std,
    line_distance,
    line_distance_max,
    loaded,
    roll_peak_to_peak,
    spine_sine_share,
    support_distance,
    tail_load_share,
    tilt,
)
from suchus.motion import START, FootPath, longest_strokes
from suchus.paper import SNAPSHOT_TIMES

_EQUAL = "limbs_only_equal_displacement"
_SHOWN = ("coordinated", "limbs_only", "limbs_tail_lifted")
"""Conditions whose snapshots are looked at."""
_CHANGES = (
    ("com_height_pp_change", "coordinated", "limbs_only"),
    ("com_height_pp_change_tail_lifted", "coordinated", "limbs_tail_lifted"),
    ("wagging_pp_change", "coordinated", "tail_still"),
    ("tail_contact_pp_change", "tail_still", "spine_only"),
    ("tail_contact_pp_change_limbs_only", "limbs_only", "limbs_tail_lifted"),
    ("spine_swing_pp_change", "coordinated", "tail_drag"),
)
"""Relative changes of the height's fluctuation: name, condition, what it is compared with."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CrawlStability(TwoGroups):
    """The height of the centre of mass over time, for every combination of spine and tail.

    The article compares spine and tail together with neither, at the same leg commands. That mixes four things, so all
    conditions stand side by side here, and the group without spine and tail walks once more with strokes long enough to
    get as far. Of another body those conditions are run that its parts make possible. Fluctuation is the amplitude that
    the article's Fig. 15 shows: the highest less the lowest height.
    """

    title = "Does it crawl more steadily with spine and tail than without?"
    shows = "Section IV.A, Figs 13 to 15"
    answers = (
        "com_height_pp_change",
        "com_height_pp_coordinated",
        "com_height_pp_limbs_only",
        "roll_pp_coordinated",
        "roll_pp_limbs_only",
    )
    needs = ("limbs", "axis")

    def quick(self) -> "CrawlStability":
        """One cycle, two repeats."""
        return replace(self, cycles=1, repeats=2)

    def simulate(self, progress: Progress = silent) -> Simulated:
        """Crawl in every condition, as far with the legs alone, and again with noise."""
        end = START + self.cycles * self.gait.period
        arms = conditions_of(self.robot, self.gait, self.control_group)
        runs = [Run(robot=self.robot, gait=gait, label=name) for name, gait in arms.items()]
        first = simulate(runs[:1], duration=end, progress=staged(progress, "first condition", 0.0, 0.1))
        share = self._equal_stroke(first, end, staged(progress, "equal displacement", 0.1, 0.4))
        equal = Run(robot=self.robot, gait=self.control_group.strode(share), label=_EQUAL)
        record = simulate([*runs, equal], duration=end, progress=staged(progress, "all conditions", 0.4, 0.6))
        record = record.merge(self._repeated(runs, end, staged(progress, "repeats", 0.6, 1.0)))
        record.attrs["equal_stroke"] = share * self._stroke()
        return Simulated(record=record, replays=self._replays(record))

    def _replays(self, record: xr.Dataset) -> Mapping[str, Replay]:
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
        """Return the stroke with which the legs alone get as far as with spine and tail, or their longest.

        In strokes of the gait.
        """
        strokes = np.linspace(1.0, longest_strokes(self.robot, self.control_group), 10)
        runs = [Run(robot=self.robot, gait=self.control_group.strode(float(s))) for s in strokes]
        tried = simulate(runs, duration=end, timestep=coarse_step(self.robot), every=100, progress=progress)
        reached = displacement(tried).sel(xyz="x").values
        wanted = float(displacement(record).sel(xyz="x")[0])
        return float(np.interp(wanted, np.maximum.accumulate(reached), strokes))

    def _stroke(self) -> float:
        """Return the longest half stroke of the gait's foot paths; 0 where it has none [m]."""
        girdles = zip(self.robot.girdles, self.control_group.limbs, strict=False)
        return max((g.limb.reach * abs(path.stroke) for g, path in girdles if isinstance(path, FootPath)), default=0.0)

    def _repeated(self, runs: list[Run], end: float, progress: Any) -> xr.Dataset:
        """Return the fluctuation of every condition in repeats with noise and another friction."""
        record = simulate(
            self.repeated(runs), duration=end, timestep=coarse_step(self.robot), every=2, progress=progress
        )
        shape = (len(runs), self.repeats)
        fluctuations = {"repeated_pp": height_peak_to_peak(record), "repeated_std": height_std(record)}
        data = {
            name: (("condition", "repeat"), values.values.reshape(shape), {"units": "m"})
            for name, values in fluctuations.items()
        }
        return xr.Dataset(data, coords={"condition": [run.label for run in runs]})

    def measure(self, record: xr.Dataset) -> Mapping[str, Measure]:
        """Return the fluctuation in every condition, its changes with their spread, and the snapshots."""
        measures: dict[str, Measure] = {}
        arms = [str(arm) for arm in record.condition.values]
        std, pp, roll = height_std(record), height_peak_to_peak(record), roll_peak_to_peak(record)
        for i, name in enumerate((*arms, _EQUAL)):
            measures |= {
                f"com_height_std_{name}": Measure(float(std[i]), "m"),
                f"com_height_pp_{name}": Measure(float(pp[i]), "m"),
                f"roll_pp_{name}": Measure(float(roll[i]), "rad"),
                f"forward_{name}": Measure(float(displacement(record).sel(xyz="x")[i]), "m"),
            }
        for name, arm, without in _CHANGES:
            if not {arm, without} <= set(arms):
                continue
            repeats_of_arm, repeats_without = (record.repeated_pp.sel(condition=c, drop=True) for c in (arm, without))
            change, repeats = pp[arms.index(arm)] / pp[arms.index(without)] - 1, repeats_of_arm / repeats_without - 1
            measures |= ranged(name, change, repeats, "-")
        equal = float(pp[0] / pp[len(arms)] - 1)
        measures |= {
            "com_height_pp_change_equal_displacement": Measure(equal, "-"),
            "com_height_std_change": Measure(float(std[0] / std[1] - 1), "-"),
            "roll_pp_change": Measure(float(roll[0] / roll[1] - 1), "-"),
            "stroke_equal_displacement": Measure(float(record.attrs["equal_stroke"]), "m"),
            "spine_sine_r2": Measure(float(spine_sine_share(record.isel(run=0))), "-"),
            "tail_load_share": Measure(float(tail_load_share(record.isel(run=0))), "-"),
        }
        for name, i in self._shown(arms).items():
            measures |= _looked_at(name, record.isel(run=i))
        return measures

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say what the dragged tail, its swing and the trunk's swing each do to the height's fluctuation."""
        return self.told(measures, stroke=self._stroke())

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw height over time, the snapshots, the spread."""
        arms = [str(arm) for arm in outcome.record.condition.values]
        return {
            "height_of_mass": draw_heights(outcome.record, arms),
            "fluctuation": draw_spreads(outcome.record, arms),
            "snapshots": draw_snapshots(self.robot, outcome.record, self._shown(arms), SNAPSHOT_TIMES),
        }

    @staticmethod
    def _shown(arms: Sequence[str]) -> dict[str, int]:
        """Return the conditions whose snapshots are looked at, and their runs."""
        return {name: arms.index(name) for name in _SHOWN if name in arms}


def _looked_at(name: str, record: xr.Dataset) -> dict[str, Measure]:
    """Return what the article's three snapshots show of one condition, and the line of two standing feet."""
    apart, stands = line_distance(record), loaded(record).sum("leg")
    measures = {f"line_distance_max_{name}": Measure(float(line_distance_max(record)), "m")}
    for time in SNAPSHOT_TIMES:
        moment, lean = f"{name}_{1000 * time:.0f}_ms", _lean(record, time)
        feet = int(stands.sel(time=time, method="nearest"))
        measures |= {
            f"support_distance_{moment}": Measure(support_distance(record, time), "m"),
            f"line_distance_{moment}": Measure(float(apart.sel(time=time, method="nearest")), "m"),
            f"standing_feet_{moment}": Measure(feet, "-"),
            f"lean_{moment}": Measure(lean, "rad"),
            f"lean_on_two_feet_{moment}": Measure(lean if feet == 2 else float("nan"), "rad"),
        }
    return measures


def _lean(record: xr.Dataset, time: float) -> float:
    """Return the angle between the pelvis's vertical and the world's at one time [rad]."""
    lean = tilt(record.sel(time=[time], method="nearest"))
    return float(np.arccos(np.cos(lean["roll"][0]) * np.cos(lean["pitch"][0])))


experiment = CrawlStability()
