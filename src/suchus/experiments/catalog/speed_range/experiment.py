"""How fast is each gait, and what does speed cost?"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from suchus.article.paper.animals import ANIMAL
from suchus.core import rotation
from suchus.core.checks import Checks
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.experiment import (
    Experiment,
    Measure,
    Measures,
    Outcome,
    Progress,
    Replay,
    Simulated,
    ranged,
    silent,
    staged,
)
from suchus.robot.design import GRAVITY, Robot, Rod, Segment, layout
from suchus.robot.design.body import servos_of
from suchus.robot.design.scale import control_period
from suchus.robot.design.servos import with_full_torque, with_leg_servos, with_speed_line
from suchus.robot.gaits import GAITS
from suchus.robot.kinematics.tree import frames
from suchus.robot.motion import START, Gait, hip_height
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import between, cost_of_transport, displacement, duty_factor, roll_peak_to_peak
from suchus.visual.figures.gait_diagram import gait_lines
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_TOUCHES = 0.00495  # [body length]; a tail this close to the ground lies on it
_LOADED = 0.0029  # of the weight; a tail that presses more on the ground touches it
_THICK, _THIN = 2.0, 0.9
_FULL, _LINE = "servos of equal torque at any speed", "servos whose torque falls with speed"
_WALKING = ANIMAL["high_walk_speed"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SpeedRange(Experiment):
    """Every gait at several cycle times, on the robot as it is and with the other model of its legs' servos.

    Where the torque of any servo of its legs falls with speed, all of them give their full torque at any speed in the
    other model; where that of none does, all fall.

    Measured over whole cycles from the second on; the speed is that of the centre of mass along the initial heading,
    the Froude number speed squared over gravity times hip height, without a number for a table of angles, which says no
    height.
    """

    title = "How fast is each gait, and what does speed cost?"
    shows = "Sections II.A and II.B, Fig. 3"
    answers = (
        "speed_belly_crawl",
        "speed_low_crawl",
        "speed_semi_erect",
        "speed_high_walk",
        "cost_high_walk",
        "froude_high_walk",
    )
    needs = ("limbs",)
    judged_with = ("robot", "gaits")
    judged_from: ClassVar[Mapping[str, float]] = {"slower": 4, "cycles": 3}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that walks."""
    gaits: tuple[Gait, ...] = field(
        default_factory=lambda: tuple(GAITS[n] for n in ("belly_crawl", "low_crawl", "semi_erect", "high_walk"))
    )
    """The gaits that it walks in."""
    slower: tuple[float, ...] = (0.35, 0.45, 0.6, 0.75, 1.0, 1.3, 1.8)
    """Factors on the cycle time of each gait [-]."""
    cycles: int = 3
    """Number of cycles that are measured, after one more [-]."""
    timestep: float = 0.005
    """Time step of the physics [s], at most 0.01; speeds at 2 ms are the same within 2 %."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.rising("slower", 0.1, 10.0, "")
            check.whole("cycles", 1, 1000)
            check.number("timestep", 1e-5, control_period(self.robot), "s")
            check.that(len(self.gaits) > 0, f"{self.name()}.gaits is empty; one gait at least is needed")

    def quick(self) -> "SpeedRange":
        """Two gaits at two cycle times."""
        two = tuple(GAITS[name] for name in ("semi_erect", "high_walk"))
        return replace(self, gaits=two if set(two) <= set(self.gaits) else self.gaits[:1], slower=(1.0, 1.5), cycles=1)

    def simulate(self, progress: Progress = silent) -> Simulated:
        """Walk in every gait, at every cycle time, with both models of the servos."""
        record, fastest = self._walk(progress)
        return Simulated(record=record, replays=self._replays(fastest))

    def _replays(self, fastest: Sequence[xr.Dataset]) -> Mapping[str, Replay]:
        """Return the replay of the first gait and the last, where there are two."""
        shown = [fastest[0], fastest[-1]] if len(fastest) > 1 else fastest
        until = min(float(walked.time[-1]) for walked in shown)
        shown = [walked.sel(time=slice(None, until)) for walked in shown]
        names = [str(walked.gait.item()).replace("_", " ") for walked in shown]
        beside = f", and, half transparent, {names[1]}" if len(names) > 1 else ""
        return replayed(
            "speed_replay.html",
            shown[0],
            self.robot,
            ghost=shown[1] if len(shown) > 1 else None,
            labels=names,
            title="In a hurry",
            caption=f"At the shortest cycle that was tried: {names[0]}{beside}.",
        )

    def _walk(self, progress: Progress) -> tuple[xr.Dataset, list[xr.Dataset]]:
        """Return what was measured, and the fastest walk of each gait as a record."""
        rows, fastest, count = [], [], len(self.gaits)
        parts = [
            [s for s in self.slower if (s > 1.0) == slow] for slow in (False, True)
        ]  # the long walks by themselves
        for i, gait in enumerate(self.gaits):
            found = [
                self._walked(
                    gait, part, staged(progress, gait.name, (i + 0.5 * j) / count, (i + 0.5 * j + 0.5) / count)
                )
                for j, part in enumerate(parts)
                if part
            ]
            rows.append(np.concatenate([values for values, _ in found], axis=1))
            fastest.append(found[0][1])
        return self._table(np.array(rows)), fastest

    def _walked(self, gait: Gait, slower: Sequence[float], progress: Any) -> tuple[np.ndarray, xr.Dataset]:
        """Return ``_UNITS`` at some cycle times of a gait, shape (servo_model, slower, unit), and its fastest walk."""
        longest, period = START + (self.cycles + 1) * gait.period * max(slower), control_period(self.robot)
        looked, shown = [], []
        for i, robot in enumerate((self.robot, _with_other(self.robot))):
            runs = [Run(robot=robot, gait=replace(gait, period=gait.period * s)) for s in slower]
            walked = simulate(
                runs,
                duration=float(np.ceil(round(longest / period, 6)) * period),
                timestep=self.timestep,
                progress=staged(progress, "", 0.5 * i, 0.5 * i + 0.5),
            )
            looked.append([self._look(walked.isel(run=j), run) for j, run in enumerate(runs)])
            shown.append(walked.isel(run=0))
        return np.array(looked), shown[0]

    def _look(self, walked: xr.Dataset, run: Run) -> list[float]:
        start, end = START + run.gait.period, START + (self.cycles + 1) * run.gait.period
        part = between(walked, start, end)
        speed = float(displacement(walked, start, end).sel(xyz="x")) / (end - start)
        legs = [i for limb in layout(run.robot).limbs for i in range(limb.servos.start, limb.servos.stop)]
        fastest = float(abs(part.servo_velocity.isel(servo=legs)).quantile(0.99, "time").max())
        height = hip_height(run.robot, run.gait)
        return [
            run.gait.period,
            speed,
            float(duty_factor(walked, start, end).mean()),
            float(cost_of_transport(walked, start, end)),
            speed**2 / (GRAVITY * height) if height > 0.0 else float("nan"),
            float(roll_peak_to_peak(walked, start, end)),
            fastest,
            float((part.tail_force.sel(xyz="z") > _LOADED * run.robot.mass * GRAVITY).mean()),
            _lying(run.robot, part),
        ]

    def _table(self, values: np.ndarray) -> xr.Dataset:
        dims = ("gait", "servo_model", "slower")
        data = xr.Dataset(
            {name: (dims, values[..., i], {"units": unit}) for i, (name, unit) in enumerate(_UNITS.items())},
            coords={
                "gait": [gait.name for gait in self.gaits],
                "servo_model": ["own", "other"],
                "slower": list(self.slower),
            },
        )
        data.slower.attrs["units"] = "1"
        return data

    def measure(self, record: xr.Dataset) -> Measures:
        """Return speed, cost and posture of every gait, and what is known of animals that walk high."""
        measures = Measures()
        usual = int(np.argmin(np.abs(np.array(self.slower) - 1.0)))
        for name in record.gait.values:
            both = record.sel(gait=name)
            own, other = (both.sel(servo_model=model) for model in ("own", "other"))
            usual_cycle = own.isel(slower=usual)
            measures |= {
                f"speed_{name}": Measure(float(usual_cycle.speed), "m/s"),
                f"speed_{name}_other_servos": Measure(float(other.isel(slower=usual).speed), "m/s"),
                **ranged(f"speed_{name}_slowest", own.speed.min(), both.speed.min("slower"), "m/s"),
                **ranged(f"speed_{name}_fastest", own.speed.max(), both.speed.max("slower"), "m/s"),
                f"cost_{name}": Measure(float(usual_cycle.cost), "-"),
                f"cost_{name}_least": Measure(float(own.cost.min()), "-"),
                f"duty_{name}": Measure(float(usual_cycle.duty), "-"),
                f"froude_{name}": Measure(float(usual_cycle.froude), "-"),
                f"roll_{name}": Measure(float(usual_cycle.rolled), "rad"),
                f"joint_speed_{name}": Measure(float(usual_cycle.joint_speed), "rad/s"),
            }
        animals = ANIMAL["high_walk_speed"]
        measures["animals_high_walk_slowest"] = Measure(animals.low, "m/s")
        measures["animals_high_walk_fastest"] = Measure(animals.high, "m/s")
        if "high_walk" in record.gait.values:
            high = record.sel(gait="high_walk", servo_model="own")
            measures["tail_touches_high_walk"] = Measure(float(high.tail_touches.mean()), "-")
            measures |= ranged("tail_on_ground_high_walk", high.tail_lies.mean(), high.tail_lies, "-")
        return measures

    def measured(self, wanted: Collection[str], progress: Progress = silent) -> Measures:
        """Return measures, those that are wanted at least; of single gaits no other gait is walked."""
        named = tuple(gait for gait in self.gaits if any(f"_{gait.name}" in name for name in wanted))
        whole = not named or not all(any(f"_{gait.name}" in name for gait in named) for name in wanted)
        asked = self if whole else replace(self, gaits=named)
        return super(SpeedRange, asked).measured(wanted, progress)

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say how fast and how dear each gait is, and what the other model of the servos changes."""
        names = [gait.name for gait in self.gaits]
        return self.told(
            measures,
            fastest=max(names, key=lambda name: measures[f"speed_{name}_fastest"]),
            cheapest=min(names, key=lambda name: measures[f"cost_{name}_least"]),
            falls=_falling(self.robot)[0] > 0,
            changed=max(
                abs(measures[f"speed_{name}_other_servos"] / measures[f"speed_{name}"] - 1.0) for name in names
            ),
            animals=ANIMAL["high_walk_speed"].who,
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw speed, cost, duty factor and Froude number over cycle time."""
        return {
            "speed_range": draw_speed_range(
                outcome.record,
                gait_lines(outcome.record.gait.values),
                _models(self.robot),
            )
        }


_UNITS = {
    "period": "s",
    "speed": "m/s",
    "duty": "1",
    "cost": "1",
    "froude": "1",
    "rolled": "rad",
    "joint_speed": "rad/s",
    "tail_touches": "1",
    "tail_lies": "1",
}


def _with_other(robot: Robot) -> Robot:
    """Return a robot with the other model of its legs' servos."""
    return with_leg_servos(robot, with_full_torque if _falling(robot)[0] else with_speed_line)


def _models(robot: Robot) -> tuple[str, str]:
    """Return in words what servos the legs have, and what servos in the other model."""
    falling, count = _falling(robot)
    if not falling:
        return _FULL, _LINE
    return _LINE if falling == count else f"servos of which {falling} of {count} lose torque with speed", _FULL


def _falling(robot: Robot) -> tuple[int, int]:
    """Return of how many servos of its limbs the torque falls with speed, and how many they have [-]."""
    place, servos = layout(robot), servos_of(robot)
    limbs = [servos[name] for limb in place.limbs for name in place.servos[limb.servos]]
    return sum(servo.winding is not None for servo in limbs), len(limbs)


def _lying(robot: Robot, part: xr.Dataset) -> float:
    """Return the share of the tail's length that lies on the ground, on average; 0 of a body without a tail [-]."""
    place = layout(robot)
    if not place.tail:
        return 0.0
    sampled = part.isel(time=slice(None, None, 5))
    found = frames(robot, sampled.joint_angle.transpose("time", "joint").values)
    numbers = [i for i, body in enumerate(place.bodies) if body.name in place.tail]
    segments = [next(one for one in place.robot.axis if one.name == place.bodies[i].name) for i in numbers]
    last, ahead = numbers[-1], -(segments[-1].front + segments[-1].rear)
    tip = found.places[:, last] + ahead * found.turns[:, last, :, 0]
    points = np.concatenate([found.places[:, numbers], tip[:, None]], axis=1)
    up = rotation.upward(sampled.orientation.transpose("time", "wxyz").values)
    height = np.einsum("tk,tpk->tp", up, points) + sampled.position.sel(xyz="z").values[:, None]
    lengths = np.array([segment.front + segment.rear for segment in segments])
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    share = along / along[-1]
    lies = (height - _radii(segments, along) < _TOUCHES * robot.length).astype(float)
    return float(np.trapezoid(lies, share, axis=1).mean())


def _radii(segments: Sequence[Segment], along: np.ndarray) -> np.ndarray:
    """Return how thick a tail is at its joints and its tip, on straight lines through its segments' middles [m]."""
    thick = np.array(
        [max(s.radius if isinstance(s, Rod) else s.half[2] for s in segment.shapes) for segment in segments]
    )
    middles = (along[1:] + along[:-1]) / 2
    found = np.interp(along, middles, thick)
    if len(segments) > 1:
        found[0] = thick[0] + (thick[1] - thick[0]) * (along[0] - middles[0]) / (middles[1] - middles[0])
        found[-1] = thick[-1] + (thick[-1] - thick[-2]) * (along[-1] - middles[-1]) / (middles[-1] - middles[-2])
    return np.maximum(found, 0.0)


def draw_speed_range(record: xr.Dataset, lines: Mapping[str, Mapping[str, Any]], servos: tuple[str, str]) -> Figure:
    """Draw speed, cost, duty factor and Froude number over cycle time, the other model of the servos thinly."""
    with styled():
        figure, axes = panels(2, 2, width=9.6, height=8.0, sharex=True)
        rows = (
            ("speed", "speed [m/s]", 1.0),
            ("cost", "cost of transport [-]", 1.0),
            ("duty", "duty factor [-]", 1.0),
            ("froude", "Froude number [-]", 1.0),
        )
        for ax, (name, label, scale) in zip(axes.flat, rows, strict=True):
            for gait in record.gait.values:
                for model, width in (("other", _THIN), ("own", _THICK)):
                    of_gait = record.sel(gait=gait, servo_model=model)
                    style = dict(lines[str(gait)]) | {"linewidth": width, "markersize": 3 if model == "other" else 6}
                    if model == "other":
                        style |= {"label": f"_{style['label']}, {servos[1]}", "alpha": 0.7}
                    ax.plot(of_gait.period, scale * of_gait[name], **style)
            ax.set_xscale("log")
            ax.set_xticks([0.5, 1, 2, 4, 8], ["0.5", "1", "2", "4", "8"])
            ax.minorticks_off()
            ax.set_ylabel(label)
        band = axes[0, 0].axhspan(_WALKING.low, _WALKING.high, color="#EFE3C8", zorder=0)
        axes[0, 0].set_ylim(0.0, max(0.75, 1.1 * float(record.speed.max())))
        axes[0, 1].set_ylim(0.0, None)
        axes[1, 1].set_yscale("log")
        for ax in axes[1]:
            ax.set_xlabel("cycle time [s]")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        models = [Line2D([], [], color=COLOURS["printed"], linewidth=width) for width in (_THICK, _THIN)]
        handles, labels = [*handles, *models, band], [*labels, *servos, f"{_WALKING.who}, high walk"]
        figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize=11)
    return captioned(
        figure,
        f"Every gait over its cycle time. Thin: legs with {servos[1]}. The cost of servos whose torque falls "
        f"includes what their motors lose. Band: what {_WALKING.who} do in the high walk.",
    )


experiment = SpeedRange()
