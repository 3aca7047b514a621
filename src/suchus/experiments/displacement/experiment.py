"""How far does the robot crawl, with spine and tail and without?"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import partial
from math import degrees, radians
from typing import Any

import numpy as np
import xarray as xr

from suchus.design import layout
from suchus.design.checks import Checks
from suchus.design.scale import coarse_step
from suchus.experiment import Measure, Outcome, Progress, Replay, Simulated, silent, staged
from suchus.experiments._two_groups import TwoGroups
from suchus.experiments.displacement.figure import draw_crawls, draw_map
from suchus.figures import COLOURS, LINES, captioned, panels, styled
from suchus.figures.timeseries import draw_band, draw_lines, mark_cycles, mark_printed
from suchus.gaits import CONDITIONS, conditions_of
from suchus.land import Run, simulate
from suchus.metrics import cost_of_transport, duty_factor, foot_clearance, heading_change, slip, two_feet_share
from suchus.metrics import displacement as displacement_of
from suchus.motion import START, FootPath, suits
from suchus.paper import CLAIMS, CYCLES
from suchus.replay import replay

_GROUPS = CONDITIONS[:2]
_LONG = 0.5  # [m]; of a body whose displacement is told to a centimetre
_LEAST = 0.00198  # [body length]; below this displacement a ratio means nothing


@dataclass(frozen=True, slots=True, kw_only=True)
class Displacement(TwoGroups):
    """The article's two groups side by side, what each part of spine and tail adds, and the map of what decides.

    Displacement is forward, along the direction that the body faced at the start, and that of the centre of mass from
    the beginning of the first cycle to the end of the last. The control group's tail lies still on the ground; with its
    tail in the air it is simulated beside. Of another body those conditions are run that its parts make possible, and
    of the map as much as its limbs reach.
    """

    title = "How far does it crawl, with spine and tail and without?"
    shows = "Section IV.B, Fig. 16"
    needs = ("limbs", "axis")

    strokes: tuple[float, ...] = tuple(metres / 0.027 for metres in (0.01, 0.02, 0.027, 0.04, 0.055, 0.07, 0.085))
    """Strokes of the limbs on the map, over those of the gait [-]; of the crawl from 10 to 85 mm."""
    bends: tuple[float, ...] = tuple(angle / radians(70) for angle in (0.0, 0.3, 0.6, 0.9, radians(70), 1.5))
    """Bends of the axis on the map, over those of the gait [-]; of the crawl's trunk up to 1.5 rad."""
    pitches: tuple[float, ...] = (0.1, 0.15, 0.2, 0.25, 0.3)
    """Steady angles of the tail's pitch joint, down positive, over its plausible range [rad]."""
    phases: tuple[float, ...] = (-0.5, -0.375, -0.25, -0.15, -0.075, 0.0, 0.075, 0.15, 0.25, 0.375, 0.5)
    """Phase lags of the axis behind the limbs, besides that of the gait, for the curve [cycle]."""

    def check(self, check: Checks) -> None:
        """Check what the map is drawn over."""
        check.rising("strokes", 0.0, 20.0, "")
        check.rising("bends", 0.0, 20.0, "")
        check.rising("pitches", -1.0, 1.0, "rad")
        check.rising("phases", -1.0, 1.0, "cycle")

    def quick(self) -> "Displacement":
        """One cycle, two repeats, four corners of the map."""
        strokes, bends = (0.02 / 0.027, 0.06 / 0.027), (0.6 / radians(70), 1.2 / radians(70))
        corners = replace(self, strokes=strokes, bends=bends, pitches=(0.1, 0.3))
        return replace(corners, cycles=1, repeats=2, phases=(0.0, 0.5))

    def simulate(self, progress: Progress = silent) -> Simulated:
        """Crawl in every condition, repeat with noise, and map what decides."""
        duration = START + self.cycles * self.gait.period
        gaits = conditions_of(self.robot, self.gait, self.control)
        runs = [Run(robot=self.robot, gait=gait, label=arm) for arm, gait in gaits.items()]
        record = simulate(runs, duration=duration, progress=staged(progress, "conditions", 0.0, 0.1))
        stage = staged(progress, "repeats", 0.1, 0.5)
        spread = simulate(
            self.repeated(runs), duration=duration, timestep=coarse_step(self.robot), every=10, progress=stage
        )
        found = self._mapped(duration, staged(progress, "map", 0.5, 1.0))
        record = record.merge(_renamed(spread, list(gaits), self.repeats)).merge(found)
        record.attrs["least"] = _LEAST * self.robot.length
        return Simulated(record=record, replays=self._replays(record))

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

    def _mapped(self, duration: float, progress: Any) -> xr.Dataset:
        """Return the displacement over stroke and bend, over the tail's pitch, and over the trunk's phase lag [m]."""
        strokes, bends, pitches = self._grid()
        limbs = [self.control.strode(s) for s in strokes]
        bent = [self.gait.strode(s).bent(b) for s in strokes for b in bends]
        pitched = [gait.lifted(p) for gait in (self.gait, self.control) for p in pitches]
        lagging = [self.gait.lagged(p) for p in self.phases]
        runs = [Run(robot=self.robot, gait=gait) for gait in (*limbs, *bent, *pitched, *lagging)]
        reached = _forward(
            simulate(runs, duration=duration, timestep=coarse_step(self.robot), every=100, progress=progress)
        ).values
        cut = np.split(reached, np.cumsum([len(limbs), len(bent), len(pitched)]))
        metres = {"units": "m"}
        data = xr.Dataset(
            {
                "map_limbs_only": ("stroke", cut[0], metres),
                "map_coordinated": (("stroke", "bend"), cut[1].reshape(len(strokes), -1), metres),
                "pitched": (("group", "pitch"), cut[2].reshape(2, -1), metres),
                "late_coordinated": ("late", cut[3], metres),
            },
            coords={
                "stroke": list(strokes),
                "bend": list(bends),
                "group": list(_GROUPS),
                "pitch": list(pitches),
                "late": list(self.phases),
            },
        )
        for name, unit, what in (
            ("stroke", "1", "strokes over those of the gait"),
            ("bend", "1", "bends over those of the gait"),
            ("pitch", "rad", "pitch of the tail, down positive"),
            ("late", "1", "phase lag of the trunk's bend, in cycles"),
        ):
            data[name].attrs.update(units=unit, long_name=what)
        return data

    def _grid(self) -> tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]:
        """Return strokes, bends and pitches of the tail on the map, as far as the body can follow them."""
        strides, lifts = self.gait.has("strokes"), self.gait.has("steering") and layout(self.robot).tail_pitch
        strokes = tuple(s for s in self.strokes if suits(self.robot, self.gait.strode(s))) if strides else ()
        bends = tuple(b for b in self.bends if suits(self.robot, self.gait.bent(b)))
        pitches = tuple(p for p in self.pitches if suits(self.robot, self.gait.lifted(p))) if lifts else ()
        return strokes or (1.0,), bends or (1.0,), pitches

    def measure(self, record: xr.Dataset) -> Mapping[str, Measure]:
        """Return displacements with their spread, what the feet did, and what each part adds."""
        forward, turned = _forward(record), heading_change(record)
        cost, slid, aside = cost_of_transport(record), slip(record), displacement_of(record).sel(xyz="y")
        duty, clear, two = duty_factor(record), foot_clearance(record), two_feet_share(record)
        measures: dict[str, Measure] = {}
        arms = [str(arm) for arm in record.condition.values]
        hind = {"leg": record.leg.values[-2:]}
        for i, arm in enumerate(arms):
            repeats = record.spread_forward.sel(condition=arm)
            measures |= {
                **_ranged(f"forward_{arm}", float(forward[i]), repeats, "m"),
                f"sideways_{arm}": Measure(float(aside[i]), "m"),
                f"heading_drift_{arm}": Measure(float(turned[i]), "rad"),
                f"slip_{arm}": Measure(float(slid[i]), "-"),
                f"cost_of_transport_{arm}": Measure(float(cost[i]), "-"),
                f"hind_duty_{arm}": Measure(float(duty.isel(run=i).sel(hind).max()), "-"),
                f"hind_clearance_{arm}": Measure(float(clear.isel(run=i).sel(hind).min()), "m"),
                f"two_feet_share_{arm}": Measure(float(two[i]), "-"),
            }
        for name, one, other in _GAINS:
            if not {one, other} <= set(arms):
                continue
            of = {arm: record.spread_forward.sel(condition=arm, drop=True) for arm in (one, other)}
            gain = float(forward[arms.index(one)] - forward[arms.index(other)])
            measures |= _ranged(f"gain_{name}", gain, of[one] - of[other], "m")
        for name, control in (("forward_ratio", "limbs_only"), ("forward_ratio_tail_lifted", "limbs_tail_lifted")):
            if control not in arms:
                continue
            apart = [record.spread_forward.sel(condition=arm, drop=True) for arm in ("coordinated", control)]
            quotient = float(forward[0] / forward[arms.index(control)])
            measures |= _ranged(name, quotient, apart[0] / apart[1], "-")
        ratio = _ratio(record)
        measures |= {
            "ratio_on_map_low": Measure(float(ratio.min()), "-"),
            "ratio_on_map_high": Measure(float(ratio.max()), "-"),
            "forward_antiphase": Measure(float(record.late_coordinated.min()), "m"),
        }
        if record.sizes["pitch"]:
            pitched = record.pitched.sel(group="coordinated")
            measures["forward_over_tail_pitch_low"] = Measure(float(pitched.min()), "m")
            measures["forward_over_tail_pitch_high"] = Measure(float(pitched.max()), "m")
        return measures

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the crawls, what each part adds, the displacement over time and what decides it."""
        record = outcome.record
        return {
            "crawling": draw_crawls(self.robot, record.isel(run=[0, 1]), _GROUPS),
            "parts": self._drawn_parts(record),
            "displacement_over_time": self._drawn_course(record),
            "displacement_map": self._drawn_map(record),
        }

    def _drawn_parts(self, record: xr.Dataset) -> Any:
        forward = _forward(record)
        arms = [str(arm) for arm in record.condition.values]
        with styled():
            figure, axes = panels(1, 1, height=1.0 + 0.5 * len(arms))
            ax = axes[0, 0]
            for i, arm in enumerate(arms):
                repeats, here = record.spread_forward.sel(condition=arm), len(arms) - i
                ax.plot([float(repeats.min()), float(repeats.max())], [here, here], color=COLOURS[arm], linewidth=7,
                        alpha=0.35, solid_capstyle="butt")  # fmt: skip
                ax.plot(float(forward[i]), here, "o", color=COLOURS[arm], markersize=9)
                if i == 0:
                    ax.plot([], [], "o", color=COLOURS["neutral"], markersize=9, label="without noise")
                    ax.plot([], [], color=COLOURS["neutral"], linewidth=7, alpha=0.35, label="range of repeats")
                ax.annotate(f"{float(forward[i]):.3g} m", (float(forward[i]), here), (0, 10), ha="center", fontsize=11,
                            textcoords="offset points")  # fmt: skip
            for arm in _GROUPS if self._article() else ():
                printed = CLAIMS[f"displacement_{arm}"].value
                label = "article" if arm == _GROUPS[0] else None
                ax.plot(printed, len(arms) - arms.index(arm), "D", markersize=11, markerfacecolor="none",
                        markeredgecolor="black", label=label)  # fmt: skip
            ax.set_yticks(range(len(arms), 0, -1), [str(LINES[arm]["label"]) for arm in arms])
            ax.set_ylim(0.4, len(arms) + 0.8)
            ax.set_xlim(left=min(0.0, float(record.spread_forward.min())))
            ax.set_xlabel("displacement forward [m]")
            ax.legend(loc="lower right")
        return captioned(
            figure,
            "What each part of spine and tail adds. Points: one run without noise; bars: the range of "
            f"{record.sizes['repeat']} repeats with noise on the servos and {self.friction_spread:.0%} of spread in "
            "the friction. All conditions command the same legs.",
        )

    def _drawn_course(self, record: xr.Dataset) -> Any:
        with styled():
            figure, axes = panels(1, 1, height=4.2)
            ax = axes[0, 0]
            x = record.centre_of_mass.isel(run=[0, 1]).sel(xyz="x")
            x = x - x.sel(time=START, method="nearest")
            for arm in _GROUPS:
                spread = record.spread_over_time.sel(condition=arm)
                band = spread.rename(repeat="run", spread_time="time")
                draw_band(ax, band, arm, label=f"repeats, {LINES[arm]['label']}")
            draw_lines(ax, x, _GROUPS)
            end = float(record.time[-1])
            cycles = (end - START) / float(record.period[0])
            printed = {arm: CLAIMS[f"displacement_{arm}"].value or 0.0 for arm in _GROUPS}
            mark_cycles(ax, list(np.arange(START, end + 0.01, float(record.period[0]))))
            shown = cycles == CYCLES and not self.unjudged()
            if shown:
                mark_printed(ax, printed, end)
            ax.set_ylabel("displacement forward [m]")
            ax.legend(loc="upper left")
        diamonds = " Diamonds: the article's {coordinated:g} and {limbs_only:g} m.".format(**printed) if shown else ""
        return captioned(
            figure,
            f"Displacement of the centre of mass over {cycles:.3g} cycles with identical leg commands.{diamonds} "
            f"Bands: repeats with noise on the servos and {self.friction_spread:.0%} of spread in the friction.",
        )

    def _stroke(self) -> float:
        """Return half the distance that a front foot moves back in stance [m]."""
        girdles = zip(layout(self.robot).robot.girdles, self.gait.limbs, strict=True)
        return next((girdle.limb.reach * limb.stroke for girdle, limb in girdles if isinstance(limb, FootPath)), 0.0)

    def _article(self) -> bool:
        """Whether the article's numbers are for this robot and its gaits."""
        shelf = type(self)()
        return all(getattr(self, name) == getattr(shelf, name) for name in ("robot", "gait", "control"))

    def _drawn_map(self, record: xr.Dataset) -> Any:
        pitched, absolute = (
            record.sizes["pitch"] > 0,
            self.gait.has("foot paths") and self.gait.number("trunk_bend") > 0,
        )
        with styled(axes__grid=False):
            ratios = [1.35, 1, 1] if pitched else [1.35, 1]
            figure, axes = panels(1, len(ratios), width=12.5, height=4.3, width_ratios=ratios)
            ratio, star = _ratio(record), (1.0, 1.0)
            if absolute:
                star = 1000 * self._stroke(), degrees(self.gait.number("trunk_bend"))
                ratio = ratio.assign_coords(stroke=record.stroke * star[0], bend=record.bend * star[1])
                ratio.stroke.attrs.update(units="mm", long_name="half stroke of the legs")
                ratio.bend.attrs.update(units="deg", long_name="bend of the trunk")
            printed = CLAIMS["displacement_ratio"].value if self._article() else None
            ax = axes[0, 0]
            if min(ratio.shape) > 1:
                draw_map(
                    ax,
                    ratio.T,
                    levels=(1, 1.5, 2, 3, 6, 12),
                    label="ratio of displacements [-]",
                    emphasised=printed,
                    form="%.3g",
                )
            ax.plot(
                *star, "*", markersize=15, color="white", markeredgecolor="black", label="crawl of the other figures"
            )
            ax.legend(loc="upper right", fontsize=10)
            ax.set_title("spine and tail over limbs only")
            if pitched:
                ax = axes[0, 1]
                for arm in _GROUPS:
                    ax.plot(np.degrees(record.pitch), record.pitched.sel(group=arm), marker="o", **LINES[arm])
                ours = degrees(self.gait.number("tail_pitch"))
                ax.axvline(ours, color=COLOURS["neutral"], linestyle=":", linewidth=1.2, label=_SHOWN)
                ax.set_xlabel("pitch of the tail, down [deg]")
                ax.set_ylabel("displacement forward [m]")
                ax.set_ylim(bottom=0.0)
                ax.legend(loc="center right")
                ax.set_title("pitch of the tail")
            ax = axes[0, -1]
            ax.axhline(0.0, color="#999999", linewidth=0.8)
            ax.plot(record.late, record.late_coordinated, marker="o", **(dict(LINES["coordinated"]) | {"label": None}))
            ax.set_xlabel("phase lag of the trunk [cycle]")
            ax.set_ylabel("displacement forward [m]")
            ax.set_title("phase lag of the trunk")
        line = ", the orange line the article's ratio" if self._article() else ""
        what = "" if absolute else " over shares of the strokes and bends of the robot's gait"
        middle = " Middle: the steady pitch of the tail, the dotted line that of the crawl." if pitched else ""
        return captioned(
            figure,
            f"What decides. Left: the ratio of the displacements with spine and tail and with limbs only{what}; the "
            f"star is the crawl of the other figures{line}.{middle} Right: the phase lag of the trunk's bend behind "
            "the legs, with spine and tail.",
        )


_SHOWN = "crawl of the other figures"


def _forward(record: xr.Dataset) -> xr.DataArray:
    return displacement_of(record).sel(xyz="x")


def _renamed(spread: xr.Dataset, arms: list[str], repeats: int) -> xr.Dataset:
    """Return the displacement over time of the repeats, by condition."""
    x = spread.centre_of_mass.sel(xyz="x", drop=True).transpose("run", "time")
    x = x - x.sel(time=START, method="nearest", drop=True)
    dims, shape = ("condition", "repeat"), (len(arms), repeats)
    data = xr.Dataset(
        {
            "spread_over_time": ((*dims, "spread_time"), x.values.reshape(*shape, -1), {"units": "m"}),
            "spread_forward": (dims, _forward(spread).values.reshape(shape), {"units": "m"}),
        },
        coords={"condition": arms, "spread_time": spread.time.values},
    )
    data.spread_time.attrs["units"] = "s"
    return data


def _ranged(name: str, value: float, repeats: xr.DataArray, unit: str) -> dict[str, Measure]:
    """Return a number with the least and greatest of its repeats."""
    return {
        name: Measure(value, unit),
        f"{name}_low": Measure(float(repeats.min()), unit),
        f"{name}_high": Measure(float(repeats.max()), unit),
    }


_GAINS = (
    ("spine_swing", "coordinated", "tail_drag"),
    ("tail_swing", "coordinated", "tail_still"),
    ("tail_contact", "tail_still", "spine_only"),
    ("tail_contact_limbs_only", "limbs_only", "limbs_tail_lifted"),
)
"""What two conditions differ in, by which one gets farther than the other."""
_AXIS = {True: "spine and tail", False: "a bending trunk"}
"""How what bends is called, by whether trunk and tail can be told apart."""


def _ratio(record: xr.Dataset) -> xr.DataArray:
    return record.map_coordinated / record.map_limbs_only.clip(min=record.attrs["least"])


experiment = Displacement()
