"""How tightly does it turn, and does it walk the circle that was asked for?"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import gcd
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.core.checks import Checks
from suchus.core.errors import NotConverged, OutsideLimits
from suchus.experiments.catalog._replayed import replayed
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
from suchus.robot.control import TurningCurve, Walking, turn
from suchus.robot.design import Robot, layout, servo_ranges
from suchus.robot.design.scale import control_period
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START, Gait, trunk_amplitude
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Run, simulate
from suchus.sim.metrics import heading_change
from suchus.visual.figures.gait_diagram import gait_lines
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_STRAIGHT = 1e-3  # [1/m]; no radius beyond a kilometre
_CIRCLE_STRIDE = 5  # [-]; control periods for each sample of a circle, 20 samples a second of the article's robot


@dataclass(frozen=True, slots=True, kw_only=True)
class Turning(Experiment):
    """Curvature of the path against curvature offset, unequal strokes, and both; then circles on command.

    The circles are walked to the left where the curve was measured, and to either side on grounds of other friction.

    The curvature is the change of heading over the path length, over whole cycles from the second on. The path is
    measured from cycle to cycle, so that the swaying within one does not count. Bends stop where the trunk's joints do.
    """

    title = "How tightly does it turn, and does it walk the circle that was asked for?"
    shows = "Section II.B"
    answers = (
        "tightest_bend_low_crawl",
        "tightest_bend_semi_erect",
        "tightest_bend_high_walk",
        "tightest_both_semi_erect",
    )
    reproduces: ClassVar[bool] = False
    needs = ("limbs",)
    answer_minima: ClassVar[Mapping[str, float]] = {"cycles": 10, "bends": 4}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that turns."""
    gaits: tuple[Gait, ...] = field(
        default_factory=lambda: tuple(GAITS[n] for n in ("low_crawl", "semi_erect", "high_walk"))
    )
    """The gaits that it walks in."""
    bends: tuple[float, ...] = (0.0, 0.17, 0.35, 0.52, 0.79)
    """Curvature offsets of the trunk [rad]."""
    asymmetries: tuple[float, ...] = (0.0, 0.25, 0.5, 0.75, 1.0)
    """Fractions by which left strokes are shorter and right ones longer [-]."""
    mixtures: tuple[float, ...] = (0.0, 0.1, 0.2, 0.3, 0.45, 0.6, 0.8, 1.0)
    """Shares of the last bend together with, on sprawled legs, the last asymmetry [-]."""
    asked: tuple[float, ...] = (0.6, 0.8, 1.2, 2.0, 3.0)
    """Radii of the commanded circles [m]."""
    friction_scales: tuple[float, ...] = (0.8, 1.25)
    """Frictions of the grounds on which the circles are walked to either side, over that on which the curve is measured
    [-]; on that ground itself they are walked to the left."""
    cycles: int = 10
    """Number of cycles that are measured, after one more [-]."""
    timestep: float = 0.005
    """Time step of the physics [s], at most 0.01."""

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges, and an empty list of gaits."""
        with Checks(self.name(), self) as check:
            check.rising("bends", 0.0, 2.0, "rad")
            check.rising("asymmetries", 0.0, 1.0, "")
            check.rising("mixtures", 0.0, 1.0, "")
            check.rising("asked", 0.05, 1000.0, "m")
            check.rising("friction_scales", 0.1, 10.0, "")
            check.whole("cycles", 1, 1000)
            check.number("timestep", 1e-5, control_period(self.robot), "s")
            check.that(len(self.gaits) > 0, f"{self.name()}.gaits is empty; one gait at least is needed")

    def quick(self) -> "Turning":
        """One gait, three mixtures, one circle."""
        return replace(
            self,
            gaits=(GAITS["semi_erect"],) if GAITS["semi_erect"] in self.gaits else self.gaits[:1],
            bends=(0.0, 0.52),
            asymmetries=(0.0, 0.5),
            mixtures=(0.0, 0.5, 1.0),
            asked=(1.0,),
            friction_scales=(0.8,),
            cycles=3,
        )

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Turn in every gait, and walk circles on command."""
        rows, record_pairs = [], []
        for i, gait in enumerate(self.gaits):
            share = i / len(self.gaits), (i + 1) / len(self.gaits)
            row, pair = self._gait_curvatures(gait, staged(progress, gait.name, *share))
            rows.append(row)
            record_pairs.append(pair)
        record = xr.concat(rows, "gait").assign_coords(gait=[gait.name for gait in self.gaits])
        tightest = int(record.curvature_mixture.max("mixture").values.argmax())
        return SimulationResult(record=record, replays=self._replays(record_pairs[tightest]))

    def _replays(self, pair: tuple[xr.Dataset, xr.Dataset]) -> Mapping[str, Replay]:
        """Return the replay of the gait that turns tightest, and of its first circle."""
        circle_text = f"on a circle of {self.asked[0]:.3g} m, or the tightest it can walk on command"
        return replayed(
            "turning_replay.html",
            pair[0],
            self.robot,
            ghost=pair[1],
            labels=("as tightly as it can", "on a circle"),
            title=f"Turning, {str(pair[0].gait.item()).replace('_', ' ')}",
            overlaid=True,
            caption=f"Turning as tightly as it can, and, half transparent, {circle_text}.",
        )

    def _gait_curvatures(self, gait: Gait, progress: Any) -> tuple[xr.Dataset, tuple[xr.Dataset, xr.Dataset]]:
        """Return the curvatures of one gait, and its tightest turn and first circle as records.

        Args:
            gait: the gait.
            progress: called with the fraction that is done.
        """
        bend_margin = self._bend_margin(gait)
        bend_controls = [Walking(bend=min(bend, bend_margin)) for bend in self.bends]
        asymmetry_controls = [Walking(asymmetry=share) for share in self.asymmetries]
        max_mixture = (
            min(self.bends[-1], bend_margin),
            self.asymmetries[-1] if gait.has("strokes") and not gait.erect else 0.0,
        )
        mixture_controls = [Walking(bend=m * max_mixture[0], asymmetry=m * max_mixture[1]) for m in self.mixtures]
        controls = [*bend_controls, *asymmetry_controls, *mixture_controls]
        runs = [Run(robot=self.robot, gait=gait, control=control) for control in controls]
        record = self._walk(runs, staged(progress, "", 0.0, 0.7))
        curvatures = self._curvatures(gait, record)
        a, b = len(bend_controls), len(bend_controls) + len(asymmetry_controls)
        curve = _curve(max_mixture, self.mixtures, curvatures[b:])
        tightest = np.inf if curve is None else curve.tightest
        circles = [
            mixture_controls[-1] if curve is None else turn(curve, max(radius, 1.001 * tightest))
            for radius in self.asked
        ]
        circle_record = self._circles(gait, circles, staged(progress, "", 0.7, 1.0))
        all_curvatures = self._curvatures(gait, circle_record)
        circle_curvatures = all_curvatures[: len(circles)]
        is_walked = np.array(self.asked) >= tightest
        radius_ratio = self._radius_ratios(all_curvatures[len(circles) :])
        data = xr.Dataset(
            {
                "curvature_bend": ("bend", curvatures[:a], {"units": "1/m"}),
                "curvature_asymmetry": ("asymmetry", curvatures[a:b], {"units": "1/m"}),
                "curvature_mixture": ("mixture", curvatures[b:], {"units": "1/m"}),
                "radius": (
                    "asked",
                    np.where(is_walked, 1.0 / np.maximum(circle_curvatures, _STRAIGHT), np.nan),
                    {"units": "m"},
                ),
                "radius_ratio": (
                    ("friction", "side", "asked"),
                    np.where(is_walked, radius_ratio, np.nan),
                    {"units": "1", "long_name": "radius over the commanded one, on other grounds and to either side"},
                ),
            },
            coords={
                "friction": list(self.friction_scales),
                "side": ["left", "right"],
                "bend": list(self.bends),
                "asymmetry": list(self.asymmetries),
                "mixture": list(self.mixtures),
                "asked": list(self.asked),
            },
        )
        for name, unit in (
            ("bend", "rad"),
            ("asymmetry", "1"),
            ("mixture", "1"),
            ("asked", "m"),
            ("friction", "1"),
        ):
            data[name].attrs["units"] = unit
        return data, (record.isel(run=b + int(curvatures[b:].argmax())), circle_record.isel(run=0))

    def _circles(self, gait: Gait, circles: Sequence[Walking], progress: Any) -> xr.Dataset:
        """Return the record of circles to the left, then of those on each ground of another friction to either side.

        Args:
            gait: the gait.
            circles: controls that walk them to the left.
            progress: called with the fraction that is done.
        """
        both_sides = [
            Walking(bend=side * control.bend, asymmetry=side * control.asymmetry)
            for side in (1.0, -1.0)
            for control in circles
        ]
        runs = [Run(robot=self.robot, gait=gait, control=control) for control in circles]
        runs += [
            Run(robot=self.robot, gait=gait, control=control, ground=Ground(friction_scale=scale))
            for scale in self.friction_scales
            for control in both_sides
        ]
        return self._walk(runs, progress, max_stride=_CIRCLE_STRIDE)

    def _radius_ratios(self, curvatures: np.ndarray) -> np.ndarray:
        """Return radii of circles over the commanded ones, shape (friction, side, circle) [-].

        Args:
            curvatures: curvatures of their paths, left positive, ground by ground, those to the left first [1/m].
        """
        curvatures = curvatures.reshape(len(self.friction_scales), 2, -1) * np.array([1.0, -1.0])[:, None]
        return np.asarray(1.0 / np.maximum(curvatures, _STRAIGHT) / np.array(self.asked))

    def _bend_margin(self, gait: Gait) -> float:
        """Return the bend of the trunk that its joints allow beyond the amplitude of the gait [rad]."""
        yaw = list(layout(self.robot).trunk_yaw)
        gait.needs_steering(self.name())
        gait_bend = trunk_amplitude(self.robot, gait)
        return max(float(np.abs(servo_ranges(self.robot)[yaw]).min(axis=1, initial=np.inf).sum()) - gait_bend, 0.0)

    def _end(self, gait: Gait) -> float:
        return START + (self.cycles + 1) * gait.period

    def _walk(self, runs: Sequence[Run], progress: Any, *, max_stride: int = 1) -> xr.Dataset:
        """Return the record of walks in one gait.

        Args:
            runs: the walks.
            progress: called with the fraction that is done.
            max_stride: control periods for each sample at most [-]; the ends of the cycles are always sampled.

        Raises:
            OutsideLimits: a limb cannot follow strokes that are so unequal.
        """
        gait, period = runs[0].gait, control_period(self.robot)
        common = gcd(round(START / period), round(gait.period / period))
        stride = max(stride for stride in range(1, max_stride + 1) if common % stride == 0)
        try:
            return simulate(
                runs,
                duration=self._end(gait),
                timestep=self.timestep,
                sample_stride=stride,
                effort=False,
                progress=progress,
            )
        except NotConverged as error:
            asymmetry = max(abs(run.control.asymmetry) for run in runs if isinstance(run.control, Walking))
            raise OutsideLimits(
                f"robot {self.robot.name!r} cannot walk gait {gait.name!r} with strokes of asymmetry {asymmetry:g}: "
                f"{str(error).partition(':')[0]}; give smaller --asymmetries."
            ) from error

    def _curvatures(self, gait: Gait, record: xr.Dataset) -> np.ndarray:
        """Return the curvature of each path [1/m]."""
        end = self._end(gait)
        cycles = START + gait.period * np.arange(1, self.cycles + 2)
        points = record.centre_of_mass.sel(xyz=["x", "y"]).sel(time=cycles, method="nearest")
        length = ((points.diff("time") ** 2).sum("xyz") ** 0.5).sum("time")
        return np.asarray(heading_change(record, START + gait.period, end) / length)

    def measure(self, record: xr.Dataset) -> Measures:
        """Return the tightest radius of every gait by bend, by stroke and by both, and how well circles come out."""
        measures = Measures()
        for name in record.gait.values:
            of_gait = record.sel(gait=name)
            radius_errors = abs(of_gait.radius / of_gait.asked - 1.0)
            friction_errors = abs(of_gait.radius_ratio - 1.0)
            measures |= {
                f"tightest_bend_{name}": Measure(_radius(of_gait.curvature_bend), "m"),
                f"tightest_asymmetry_{name}": Measure(_radius(of_gait.curvature_asymmetry), "m"),
                f"tightest_both_{name}": Measure(_radius(of_gait.curvature_mixture), "m"),
                f"circles_walked_{name}": Measure(float(of_gait.radius.notnull().sum()), "-"),
                f"radius_off_{name}": Measure(float(radius_errors.max()), "-"),
                f"radius_off_friction_{name}": Measure(float(friction_errors.max()), "-"),
                f"bend_times_radius_{name}": Measure(
                    float(of_gait.bend[-1] * _radius(of_gait.curvature_bend[-1:])), "m"
                ),
            }
        return measures

    def explain(self, measures: Mapping[str, float]) -> str:
        """Return by which means each gait turns tightest, and the errors of commanded circles, in words."""
        names = [gait.name for gait in self.gaits]
        return self.render_explanation(
            measures,
            circles=len(names) * len(self.asked),
            walked=sum(measures[f"circles_walked_{name}"] for name in names),
            off=max(measures[f"radius_off_{name}"] for name in names),
            off_friction=max(measures[f"radius_off_friction_{name}"] for name in names),
            frictions=self.friction_scales,
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw curvatures and circles."""
        return {"turning": draw_turning(outcome.record, gait_lines(outcome.record.gait.values))}


def _curve(max_mixture: tuple[float, float], mixtures: Sequence[float], curvatures: np.ndarray) -> TurningCurve | None:
    """Return the rising part of a measured turning curve; None if it does not rise.

    Args:
        max_mixture: bend [rad] and asymmetry [-] at mixture 1.
        mixtures: fractions of ``max_mixture`` [-].
        curvatures: measured, of each mixture [1/m].
    """
    level, rising = curvatures, 1
    while rising < len(level) and level[rising] > level[rising - 1] + _STRAIGHT:
        rising += 1
    if rising < 2:
        return None
    return TurningCurve(
        bend=max_mixture[0],
        asymmetry=max_mixture[1],
        mixtures=tuple(float(m) for m in mixtures[:rising]),
        curvatures=tuple(float(c) for c in level[:rising]),
    )


def _radius(curvature: xr.DataArray) -> float:
    return float(1.0 / max(float(curvature.max()), _STRAIGHT))


def draw_turning(record: xr.Dataset, lines: Mapping[str, Mapping[str, Any]]) -> Figure:
    """Draw curvature over bend and asymmetry, and the measured over the commanded radius.

    Args:
        record: record of the experiment ``turning``.
        lines: style of each gait.
    """
    with styled():
        figure, axes = panels(1, 3, width=11.5, height=4.0)
        for ax, name, label, scale in (
            (axes[0, 0], "bend", "curvature offset of the trunk [deg]", 180 / np.pi),
            (axes[0, 1], "asymmetry", "asymmetry of strokes [-]", 1.0),
        ):
            for gait in record.gait.values:
                ax.plot(scale * record[name], record[f"curvature_{name}"].sel(gait=gait), **lines[str(gait)])
            ax.set_xlabel(label)
            ax.set_ylabel("curvature of the path [1/m]")
            ax.set_ylim(-0.1, max(2.8, 1.05 * float(record.curvature_mixture.max())))
        axes[0, 0].legend(loc="upper left")
        ax = axes[0, 2]
        radii = record.asked.values
        ax.fill_between(radii, 0.9 * radii, 1.1 * radii, color="#E3E3E3", zorder=0, label="within 10 %")
        ax.plot(radii, radii, color=COLOURS["neutral"], linewidth=0.9, label="_measured = commanded")
        for gait in record.gait.values:
            style = dict(lines[str(gait)]) | {"linestyle": "none", "label": f"_{gait}"}
            ax.plot(radii, record.radius.sel(gait=gait), **style)
        ax.set_xlabel("commanded radius [m]")
        ax.set_ylabel("measured radius [m]")
        ax.legend(loc="upper left")
    return captioned(
        figure,
        "How the robot turns: left and middle, curvature of its path with a bent trunk and with unequal strokes; "
        "right, a turn command that mixes both.",
    )


experiment = Turning()
