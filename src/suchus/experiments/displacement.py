"""How far does the robot crawl, with spine and tail and without?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from math import degrees
from typing import Any

import numpy as np
import xarray as xr

from suchus.design import Crocodile
from suchus.design.checks import Checks
from suchus.experiment import Experiment, Measure, Outcome, Progress, Replay, judge, silent, staged, stopwatch
from suchus.figures import LINES, captioned, panels, styled
from suchus.figures.crawls import draw_crawls
from suchus.figures.maps import draw_map
from suchus.figures.timeseries import draw_band, draw_lines, mark_cycles, mark_printed
from suchus.gaits import GAITS
from suchus.land import Ground, Run, simulate
from suchus.metrics import cost_of_transport, heading_change, slip
from suchus.metrics import displacement as displacement_of
from suchus.motion import START, Gait
from suchus.paper import CLAIMS, CYCLES
from suchus.replay import replay
from suchus.robots import ROBOTS

_ARMS = ("coordinated", "limbs_only")
_LIFT = 0.002  # [m]; below this way a ratio means nothing


@dataclass(frozen=True, slots=True, kw_only=True)
class Displacement(Experiment):
    """The article's two groups side by side, then the map of what decides their ratio.

    Forward is along the direction that the body faced at the start; the way is that of the centre of mass from the
    beginning of the first cycle to the end of the last.
    """

    title = "How far does it crawl, with spine and tail and without?"
    shows = "Section IV.B, Fig. 16"
    claims = ("displacement_coordinated", "displacement_limbs_only", "displacement_ratio", "bending_lengthens_stride")
    decides = (
        "The legs' stroke and the bend of the trunk decide, and both are free: at a fixed trunk bend the ratio falls "
        "from beyond ten at small strokes to below two at long ones. With the shown pair both displacements come out "
        "as printed; a designer who wants to know what a spine is worth should read the map. Bending late against the "
        "legs costs its gain, and bending in antiphase walks the robot backwards. Friction of the feet hardly matters."
    )

    robot: Crocodile = field(default_factory=lambda: ROBOTS["caiman"])
    """Who crawls."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The crawl with spine and tail."""
    control: Gait = field(default_factory=lambda: GAITS["limbs_only"])
    """The crawl of the control group, with the same legs."""
    cycles: int = int(CYCLES)
    """How many cycles are measured [-]."""
    repeats: int = 8
    """Runs per group with noise on the servos and another grip, for the spread [-]."""
    noise: float = 0.01
    """Standard deviation of the noise on every commanded angle in the repeats [rad]; a hobby servo's dead band."""
    grip_spread: float = 0.1
    """Half-width of the uniform spread of the friction in the repeats, as a part of it [-]."""
    strokes: tuple[float, ...] = (0.01, 0.02, 0.027, 0.04, 0.055, 0.07, 0.085)
    """Half strokes of the legs on the map [m]."""
    bends: tuple[float, ...] = (0.0, 0.3, 0.6, 0.9, 1.2217304763960306, 1.5)
    """Amplitudes of the trunk's bend on the map [rad]."""
    phases: tuple[float, ...] = (-0.5, -0.375, -0.25, -0.15, -0.075, 0.0, 0.075, 0.15, 0.25, 0.375, 0.5)
    """How late the trunk bends, for the curve [cycle]."""
    seed: int = 0
    """Of noise and grip."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("cycles", 1, 1000)
            check.whole("repeats", 1, 1000)
            check.whole("seed", 0, 2**31)
            check.number("noise", 0.0, 1.0, "rad")
            check.number("grip_spread", 0.0, 0.9, "")
            check.rising("strokes", 0.0, 0.3, "m")
            check.rising("bends", 0.0, 3.0, "rad")
            check.rising("phases", -1.0, 1.0, "cycle")

    def quick(self) -> "Displacement":
        """One cycle, two repeats, four corners of the map."""
        return replace(self, cycles=1, repeats=2, strokes=(0.02, 0.06), bends=(0.6, 1.2), phases=(0.0, 0.5))

    def run(self, progress: Progress = silent) -> Outcome:
        """Crawl."""
        with stopwatch() as seconds:
            duration = START + self.cycles * self.gait.period
            record = simulate(self._pair(), duration=duration, progress=staged(progress, "two groups", 0.0, 0.1))
            spread = simulate(
                self._repeats(), duration=duration, every=10, progress=staged(progress, "repeats", 0.1, 0.3)
            )
            record = record.merge(_renamed(spread)).merge(self._map(duration, staged(progress, "map", 0.3, 1.0)))
            return Outcome(
                experiment=self.name(),
                measures=self._measures(record),
                verdicts=self._verdicts(record),
                record=record,
                settings=self.settings(),
                replays=self._replays(record),
                seconds=seconds(),
            )

    def _replays(self, record: xr.Dataset) -> Mapping[str, Replay]:
        caption = "The same legs twice: with spine and tail, and, half transparent, with limbs only."
        page = partial(
            replay,
            record.isel(run=0),
            self.robot,
            ghost=record.isel(run=1),
            labels=("spine and tail", "limbs only"),
            title="Crawling with spine and tail, and without",
            caption=caption,
        )
        return {"crawl_replay.html": Replay(caption=caption, make=page)}

    def _pair(self) -> list[Run]:
        return [Run(robot=self.robot, gait=gait, label=arm) for arm, gait in zip(_ARMS, self._gaits(), strict=True)]

    def _gaits(self) -> tuple[Gait, Gait]:
        return self.gait, self.control

    def _repeats(self) -> list[Run]:
        grips = np.random.default_rng(self.seed).uniform(1 - self.grip_spread, 1 + self.grip_spread, self.repeats)
        return [
            Run(
                robot=self.robot,
                gait=gait,
                ground=Ground(grip=float(grip)),
                noise=self.noise,
                seed=self.seed + 1 + i,
                label=arm,
            )
            for arm, gait in zip(_ARMS, self._gaits(), strict=True)
            for i, grip in enumerate(grips)
        ]

    def _map(self, duration: float, progress: Any) -> xr.Dataset:
        """Return the forward way over stroke, bend and phase [m]."""
        limbs = [replace(self.control, stroke=s) for s in self.strokes]
        bent = [replace(self.gait, stroke=s, trunk_bend=b) for s in self.strokes for b in self.bends]
        late = [replace(self.gait, spine_phase=p) for p in self.phases]
        runs = [Run(robot=self.robot, gait=gait) for gait in (*limbs, *bent, *late)]
        way = _forward(simulate(runs, duration=duration, timestep=0.005, every=100, progress=progress)).values
        shape = (len(self.strokes), len(self.bends))
        cut = np.split(way, [len(limbs), len(limbs) + len(bent)])
        data = xr.Dataset(
            {
                "map_limbs_only": ("stroke", cut[0], {"units": "m"}),
                "map_coordinated": (("stroke", "bend"), cut[1].reshape(shape), {"units": "m"}),
                "late_coordinated": ("late", cut[2], {"units": "m"}),
            },
            coords={"stroke": list(self.strokes), "bend": list(self.bends), "late": list(self.phases)},
        )
        for name, unit, what in (
            ("stroke", "m", "half stroke of the legs"),
            ("bend", "rad", "bend of the trunk"),
            ("late", "1", "how late the trunk bends, in cycles"),
        ):
            data[name].attrs.update(units=unit, long_name=what)
        return data

    def _measures(self, record: xr.Dataset) -> Mapping[str, Measure]:
        way, turned = _forward(record).values, heading_change(record).values
        cost, slid, aside = cost_of_transport(record).values, slip(record).values, displacement_of(record).sel(xyz="y")
        spread = record.spread_forward
        measures = {"forward_ratio": Measure(float(way[0] / way[1]), "-")}
        for i, arm in enumerate(_ARMS):
            some = spread.where(record.spread_label == arm, drop=True)
            measures |= {
                f"forward_{arm}": Measure(float(way[i]), "m"),
                f"forward_{arm}_low": Measure(float(some.min()), "m"),
                f"forward_{arm}_high": Measure(float(some.max()), "m"),
                f"sideways_{arm}": Measure(float(aside[i]), "m"),
                f"heading_drift_{arm}": Measure(float(turned[i]), "rad"),
                f"slip_{arm}": Measure(float(slid[i]), "-"),
                f"cost_of_transport_{arm}": Measure(float(cost[i]), "-"),
            }
        ratio = _ratio(record)
        return measures | {
            "ratio_on_map_low": Measure(float(ratio.min()), "-"),
            "ratio_on_map_high": Measure(float(ratio.max()), "-"),
            "forward_antiphase": Measure(float(record.late_coordinated.min()), "m"),
        }

    def _verdicts(self, record: xr.Dataset) -> tuple[Any, ...]:
        way, ratio = _forward(record).values, _ratio(record)
        ours = (self.robot, self.gait) == (ROBOTS["caiman"], GAITS["belly_crawl"])
        chosen = (
            f"Leg stroke ({1000 * self.gait.stroke:.0f} mm) and trunk bend ({degrees(self.gait.trunk_bend):.0f} deg) "
            f"are free in the article{' and were chosen to give its two displacements' if ours else ''}."
        )
        return (
            judge("displacement_coordinated", float(way[0]), chosen),
            judge(
                "displacement_limbs_only", float(way[1]), "The same legs with the trunk straight and the tail lifted."
            ),
            judge(
                "displacement_ratio",
                float(way[0] / way[1]),
                f"{chosen} Other strokes and bends give {float(ratio.min()):.1f} to {float(ratio.max()):.1f}.",
                holds=bool(way[0] > way[1]),
            ),
            judge(
                "bending_lengthens_stride",
                float(way[0] - way[1]),
                "At the same stroke of the legs the girdles carry the feet farther; only the tail differs besides.",
                holds=bool(way[0] > way[1]),
            ),
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the crawls, the way over time and what decides it."""
        record = outcome.record
        return {
            "crawling": draw_crawls(self.robot, record, _ARMS),
            "displacement_over_time": self._drawn_way(record),
            "displacement_map": self._drawn_map(record),
        }

    def _drawn_way(self, record: xr.Dataset) -> Any:
        with styled():
            figure, axes = panels(1, 1, height=4.2)
            ax = axes[0, 0]
            x = record.centre_of_mass.sel(xyz="x")
            x = x - x.sel(time=START, method="nearest")
            for arm in _ARMS:
                some = record.spread_way.where(record.spread_label == arm, drop=True)
                draw_band(ax, some.rename(repeat="run", spread_time="time"), arm)
            draw_lines(ax, x, _ARMS)
            end = float(record.time[-1])
            cycles = (end - START) / float(record.period[0])
            printed = {arm: CLAIMS[f"displacement_{arm}"].value or 0.0 for arm in _ARMS}
            mark_cycles(ax, list(np.arange(START, end + 0.01, float(record.period[0]))))
            if cycles > 1.5:
                mark_printed(ax, printed, end)
            ax.set_ylabel("way forward [m]")
            ax.legend(loc="upper left")
        return captioned(
            figure,
            f"Way of the centre of mass over {cycles:.3g} cycles with identical leg commands. Diamonds: the article's "
            f"{printed['coordinated']:g} and {printed['limbs_only']:g} m. Bands: repeats with noise on the servos and "
            f"{self.grip_spread:.0%} of spread in the friction.",
        )

    def _drawn_map(self, record: xr.Dataset) -> Any:
        with styled(axes__grid=False):
            figure, axes = panels(1, 2, width=10.5, height=4.3, width_ratios=[1.25, 1])
            ratio = _ratio(record).assign_coords(stroke=record.stroke * 1000, bend=np.degrees(record.bend))
            ratio.stroke.attrs.update(units="mm", long_name="half stroke of the legs")
            ratio.bend.attrs.update(units="deg", long_name="bend of the trunk")
            printed = CLAIMS["displacement_ratio"].value
            ax = axes[0, 0]
            if min(ratio.shape) > 1:
                draw_map(ax, ratio.T, levels=(1, 1.5, 2, 3, 6, 12), label="ratio", emphasised=printed, form="%.3g")
            ax.plot(
                1000 * self.gait.stroke,
                degrees(self.gait.trunk_bend),
                "*",
                markersize=15,
                color="white",
                markeredgecolor="black",
            )
            ax.set_title("way with spine and tail / limbs only")
            ax = axes[0, 1]
            ax.axhline(0.0, color="#999999", linewidth=0.8)
            ax.plot(record.late, record.late_coordinated, marker="o", **(dict(LINES["coordinated"]) | {"label": None}))
            ax.set_xlabel("how late the trunk bends [cycle]")
            ax.set_ylabel("way forward [m]")
            ax.set_title("the spine's phase")
        return captioned(
            figure,
            "What decides the ratio. Left: way with spine and tail over way with limbs only; the star is the crawl of "
            "the other figure, the orange line the article's ratio. Right: bending late costs the gain, half a cycle "
            "late walks backwards.",
        )


def _forward(record: xr.Dataset) -> xr.DataArray:
    return displacement_of(record).sel(xyz="x")


def _renamed(spread: xr.Dataset) -> xr.Dataset:
    """Return the way over time of the repeats, under names of their own."""
    x = spread.centre_of_mass.sel(xyz="x", drop=True)
    x = x - x.sel(time=START, method="nearest", drop=True)
    data = xr.Dataset(
        {
            "spread_way": (("repeat", "spread_time"), x.values, {"units": "m"}),
            "spread_forward": ("repeat", _forward(spread).values, {"units": "m"}),
            "spread_label": ("repeat", spread.label.values, {"units": "1"}),
        },
        coords={"spread_time": spread.time.values},
    )
    data.spread_time.attrs["units"] = "s"
    return data


def _ratio(record: xr.Dataset) -> xr.DataArray:
    return record.map_coordinated / record.map_limbs_only.clip(min=_LIFT)


experiment = Displacement()
