"""Does it crawl more steadily with spine and tail than without?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from scipy.stats import qmc

from suchus.design import Crocodile
from suchus.design.checks import Checks
from suchus.experiment import Experiment, Measure, Outcome, Progress, Replay, Verdict, judge, silent, staged, stopwatch
from suchus.figures.stability import draw_heights, draw_snapshots, draw_variations
from suchus.gaits import GAITS
from suchus.land import Ground, Run, simulate
from suchus.metrics import (
    displacement,
    height_peak_to_peak,
    height_std,
    line_distance,
    roll_peak_to_peak,
    support_distance,
    tilt,
)
from suchus.motion import START, Gait, longest_stroke
from suchus.paper import CYCLES, SNAPSHOT_TIMES
from suchus.replay import replay
from suchus.robots import ROBOTS

ARMS = ("coordinated", "tail_drag", "spine_only", "limbs_only")
_EQUAL = "limbs_only_equal_displacement"
_ON_LINE = 0.02  # [m]; a foot's width
_COARSE = 0.005  # [s]; time step of searches, measured to agree with 2 ms within 0.1 %


@dataclass(frozen=True, slots=True, kw_only=True)
class CrawlStability(Experiment):
    """The height of the centre of mass over time, for every combination of spine and tail.

    The article compares spine and tail together with neither, at the same leg commands. That mixes three things, so
    the four arms stand side by side here, and the group without spine and tail walks once more with strokes long
    enough to get as far. Fluctuation is the standard deviation over the cycles; the claim counts as reproduced when
    it is smaller with spine and tail in the crawl shown, and in most of the varied crawls too.
    """

    title = "Does it crawl more steadily with spine and tail than without?"
    shows = "Section IV.A, Figs 13 to 15"
    claims = (
        "com_fluctuation",
        "com_on_support_line",
        "tilt_limbs_only",
        "tail_supports",
        "spine_sinusoidal",
    )
    decides = (
        "The dragged tail steadies the body: it makes a tripod of every diagonal pair. The swinging trunk does the "
        "opposite, since it moves the centre of mass and carries the robot over four times the way in the same time. "
        "Together they are about as steady as the legs alone, and clearly steadier once both groups get equally far."
    )

    robot: Crocodile = field(default_factory=lambda: ROBOTS["caiman"])
    """Who crawls."""
    coordinated: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The crawl with spine and tail."""
    tail_drag: Gait = field(default_factory=lambda: GAITS["tail_drag"])
    """The crawl with the tail alone."""
    spine_only: Gait = field(default_factory=lambda: GAITS["spine_only"])
    """The crawl with the spine alone."""
    limbs_only: Gait = field(default_factory=lambda: GAITS["limbs_only"])
    """The crawl with neither."""
    cycles: int = int(CYCLES)
    """How many cycles are measured [-]."""
    variations: int = 32
    """Crawls with other strokes, bends, lifts, duty factors and friction, to see in how many the claim holds [-]."""
    seed: int = 0
    """Of the variations."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("cycles", 1, 1000)
            check.whole("variations", 1, 4096)
            check.whole("seed", 0, 2**31)

    def quick(self) -> "CrawlStability":
        """One cycle, two variations."""
        return replace(self, cycles=1, variations=2)

    def run(self, progress: Progress = silent) -> Outcome:
        """Crawl."""
        with stopwatch() as seconds:
            end = START + self.cycles * self.coordinated.period
            arms = [Run(robot=self.robot, gait=getattr(self, arm), label=arm) for arm in ARMS]
            record = simulate(arms, duration=end, progress=staged(progress, "four arms", 0.0, 0.1))
            stroke = self._equal_stroke(record, end, staged(progress, "equal displacement", 0.1, 0.3))
            equal = Run(robot=self.robot, gait=replace(self.limbs_only, stroke=stroke), label=_EQUAL)
            record = simulate([*arms, equal], duration=end, progress=staged(progress, "all arms", 0.3, 0.4))
            record = record.merge(self._vary(end, staged(progress, "variations", 0.4, 1.0)))
            record.attrs["equal_stroke"] = stroke
            measures = self._measures(record)
            return Outcome(
                experiment=self.name(),
                measures=measures,
                verdicts=self._verdicts(measures),
                record=record,
                settings=self.settings(),
                replays=self._replays(record),
                seconds=seconds(),
            )

    def _replays(self, record: xr.Dataset) -> Mapping[str, Replay]:
        caption = "With spine and tail, and, half transparent, with longer strokes of the legs alone, just as far."
        page = partial(
            replay,
            record.isel(run=0),
            self.robot,
            ghost=record.isel(run=-1),
            labels=("spine and tail", "legs alone, as far"),
            title="Two ways to get as far",
            caption=caption,
        )
        return {"stability_replay.html": Replay(caption=caption, make=page)}

    def _equal_stroke(self, record: xr.Dataset, end: float, progress: Any) -> float:
        """Return the stroke with which the legs alone get as far as the coordinated crawl [m]."""
        strokes = np.linspace(self.limbs_only.stroke, longest_stroke(self.robot, self.limbs_only), 10)
        runs = [Run(robot=self.robot, gait=replace(self.limbs_only, stroke=float(s))) for s in strokes]
        ways = simulate(runs, duration=end, timestep=_COARSE, every=100, progress=progress)
        reached = displacement(ways).sel(xyz="x").values
        wanted = float(displacement(record).sel(xyz="x")[0])
        return float(np.interp(wanted, np.maximum.accumulate(reached), strokes))

    def _vary(self, end: float, progress: Any) -> xr.Dataset:
        """Return fluctuation and way of varied crawls, for three arms with the same legs on the same ground."""
        low, high = np.array([0.01, 0.3, 0.02, 0.5, 0.6]), np.array([0.09, 1.5, 0.045, 0.7, 1.2])
        draws = qmc.Sobol(d=5, seed=self.seed).random(_power_of_two(self.variations))[: self.variations]
        names = ("coordinated", "tail_drag", "limbs_only")
        runs = []
        for stroke, bend, lift, duty, grip in low + draws * (high - low):
            gaits = [
                replace(gait, stroke=float(stroke), lift=float(lift), duty_factor=float(duty))
                for gait in (replace(self.coordinated, trunk_bend=float(bend)), self.tail_drag, self.limbs_only)
            ]
            runs += [Run(robot=self.robot, gait=gait, ground=Ground(grip=float(grip))) for gait in gaits]
        record = simulate(runs, duration=end, timestep=_COARSE, every=5, progress=progress)
        shape = (self.variations, len(names))
        return xr.Dataset(
            {
                "varied_std": (("variation", "arm"), height_std(record).values.reshape(shape), {"units": "m"}),
                "varied_roll": (
                    ("variation", "arm"),
                    roll_peak_to_peak(record).values.reshape(shape),
                    {"units": "rad"},
                ),
            },
            coords={"arm": list(names)},
        )

    def _measures(self, record: xr.Dataset) -> dict[str, Measure]:
        measures: dict[str, Measure] = {}
        std, pp, roll = height_std(record), height_peak_to_peak(record), roll_peak_to_peak(record)
        for i, arm in enumerate((*ARMS, _EQUAL)):
            measures |= {
                f"com_height_std_{arm}": Measure(float(std[i]), "m"),
                f"com_height_pp_{arm}": Measure(float(pp[i]), "m"),
                f"roll_pp_{arm}": Measure(float(roll[i]), "rad"),
                f"forward_{arm}": Measure(float(displacement(record).sel(xyz="x")[i]), "m"),
            }
        for i, arm in ((0, "coordinated"), (3, "limbs_only")):
            one = record.isel(run=i)
            for time in SNAPSHOT_TIMES:
                name = f"{arm}_{1000 * time:.0f}_ms"
                measures[f"support_distance_{name}"] = Measure(support_distance(one, time), "m")
                measures[f"line_distance_{name}"] = Measure(line_distance(one, time), "m")
                measures[f"lean_{name}"] = Measure(_lean(one, time), "rad")
        varied, reference = record.varied_std, record.varied_std.sel(arm="limbs_only")
        for arm in ("coordinated", "tail_drag"):
            measures[f"share_steadier_{arm}"] = Measure(float((varied.sel(arm=arm) < reference).mean()), "-")
        measures["stroke_equal_displacement"] = Measure(record.attrs["equal_stroke"], "m")
        measures["spine_sine_r2"] = Measure(_sine_share(record.isel(run=0)), "-")
        return measures

    def _verdicts(self, measures: Mapping[str, Measure]) -> tuple[Verdict, ...]:
        m = {name: measure.value for name, measure in measures.items()}
        change = m["com_height_std_coordinated"] / m["com_height_std_limbs_only"] - 1
        equal = m["com_height_std_coordinated"] / m[f"com_height_std_{_EQUAL}"] - 1
        tail = m["com_height_std_tail_drag"] / m["com_height_std_limbs_only"] - 1
        share, tail_share = m["share_steadier_coordinated"], m["share_steadier_tail_drag"]
        off = {a: [1000 * m[f"line_distance_{a}_{1000 * t:.0f}_ms"] for t in SNAPSHOT_TIMES] for a in ARMS[::3]}
        lean = {a: np.degrees([m[f"lean_{a}_{1000 * t:.0f}_ms"] for t in SNAPSHOT_TIMES]) for a in ARMS[::3]}
        return (
            judge(
                "com_fluctuation",
                change,
                f"The standard deviation changes by {change:+.0%} at equal leg commands, and is smaller in {share:.0%} "
                f"of the varied crawls; at equal displacement it changes by {equal:+.0%}, with the tail alone by "
                f"{tail:+.0%}.",
                holds=change < 0 and share > 0.5,
            ),
            judge(
                "com_on_support_line",
                max(off["coordinated"]) / 1000,
                f"At the three times the projected centre of mass is {min(off['coordinated']):.0f} to "
                f"{max(off['coordinated']):.0f} mm from the line of the two supporting feet with spine and tail and "
                f"{min(off['limbs_only']):.0f} to {max(off['limbs_only']):.0f} mm with limbs only, and neither falls: "
                f"a swing foot or the tail catches the body. On the line would be within {1000 * _ON_LINE:.0f} mm.",
                holds=max(off["coordinated"]) < 1000 * _ON_LINE,
            ),
            judge(
                "tilt_limbs_only",
                float(np.radians(lean["limbs_only"][0])),
                f"The pelvis leans by {_listed(lean['limbs_only'])} degrees at the three times with limbs only, by "
                f"{_listed(lean['coordinated'])} with spine and tail; without them the centre of mass is "
                f"{off['limbs_only'][0]:.0f} mm off the supporting line at the first.",
                holds=bool((lean["limbs_only"] > lean["coordinated"]).all() and off["limbs_only"][0] > 1000 * _ON_LINE),
            ),
            judge(
                "tail_supports",
                tail,
                f"With the trunk straight the dragged tail changes the fluctuation by {tail:+.0%} and the roll by "
                f"{m['roll_pp_tail_drag'] / m['roll_pp_limbs_only'] - 1:+.0%}; steadier in {tail_share:.0%} of the "
                "varied crawls.",
                holds=tail < 0 and tail_share > 0.5,
            ),
            judge(
                "spine_sinusoidal",
                m["spine_sine_r2"],
                f"A sine at the gait's frequency explains {m['spine_sine_r2']:.1%} of the sensed bend of the trunk.",
                holds=m["spine_sine_r2"] > 0.95,
            ),
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw height over time, the snapshots, the variations."""
        return {
            "height_of_mass": draw_heights(outcome.record, ARMS),
            "snapshots": draw_snapshots(
                self.robot, outcome.record, {"coordinated": 0, "limbs_only": 3}, SNAPSHOT_TIMES
            ),
            "varied_crawls": draw_variations(outcome.record),
        }


def _listed(numbers: np.ndarray) -> str:
    return ", ".join(f"{number:.1f}" for number in numbers)


def _lean(record: xr.Dataset, time: float) -> float:
    """Return the angle between the pelvis's vertical and the world's at one time [rad]."""
    lean = tilt(record.sel(time=[time], method="nearest"))
    return float(np.arccos(np.cos(lean["roll"][0]) * np.cos(lean["pitch"][0])))


def _sine_share(record: xr.Dataset) -> float:
    """Return how much of the trunk's sensed bend a sine at the gait's frequency explains [-]."""
    part = record.sel(time=slice(START, None))
    yaws = [part.servo_angle.sel(servo=f"spine_yaw_{i}").values for i in (1, 2, 3)]
    bend = np.sum(yaws, axis=0)
    turn = 2 * np.pi * (part.time.values - START) / float(record.period)
    terms = np.column_stack([np.ones_like(turn), np.cos(turn), np.sin(turn)])
    left = bend - terms @ np.linalg.lstsq(terms, bend, rcond=None)[0]
    return float(1 - left.var() / bend.var()) if bend.var() > 0 else 0.0


def _power_of_two(count: int) -> int:
    return 1 << max(count - 1, 0).bit_length()


experiment = CrawlStability()
