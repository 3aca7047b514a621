"""How fast is each gait, and what does speed cost?"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite, nan
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from suchus.article.paper.animals import ANIMAL
from suchus.article.verdict import listed
from suchus.core import rotation
from suchus.core.checks import Checks
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.experiment import (
    Experiment,
    Extent,
    Measure,
    Measures,
    Outcome,
    Progress,
    Replay,
    SimulationResult,
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
from suchus.sim.metrics import (
    cost_of_transport,
    displacement,
    duty_factor,
    electrical_cost_of_transport,
    roll_peak_to_peak,
    time_window,
)
from suchus.visual.figures.gait_diagram import gait_lines
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_TOUCH_HEIGHT = 0.00495  # height below which the tail lies on the ground [body length]
_TOUCH_LOAD = 0.0029  # load above which the tail touches the ground [body weight]
_MIN_DISPLACEMENT_FRACTION = 0.01  # in each cycle [body length]; less is no walk, and has no cost of transport
_OWN_LINE_WIDTH, _OTHER_LINE_WIDTH = 2.0, 0.9
_FULL, _LINE = "servos of equal torque at any speed", "servos whose torque falls with speed"
_JUDGED_GAIT = "high_walk"
_WALKING = ANIMAL["high_walk_speed"]


@dataclass(frozen=True, slots=True, kw_only=True)
class SpeedRange(Experiment):
    """Every gait at several cycle times, on the robot as it is and with the other model of its legs' servos.

    Where the torque of any servo of its legs falls with speed, all of them give their full torque at any speed in the
    other model; where that of none does, all fall.

    Measured over whole cycles from the second on; the speed is that of the centre of mass along the initial heading,
    the Froude number speed squared over gravity times hip height, unknown for a table of angles, which says no height.
    A gait that moves the robot by less than 1 % of its length in a cycle has no cost of transport.
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
    judged_settings = ("robot", "gaits")
    judged_minima: ClassVar[Mapping[str, float]] = {"slower": 4, "cycles": 3}

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
    extent: Extent = "whole"
    """How much is simulated: for the verdicts gaits of which nothing is judged at their own cycle time alone, without
    the other model of the servos."""

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges, and an empty list of gaits."""
        with Checks(self.name(), self) as check:
            check.rising("slower", 0.1, 10.0, "")
            check.whole("cycles", 1, 1000)
            check.number("timestep", 1e-5, control_period(self.robot), "s")
            check.that(len(self.gaits) > 0, f"{self.name()}.gaits is empty; one gait at least is needed")

    def for_verdicts(self) -> "SpeedRange":
        """Return the same question with a range of cycle times of the high walk alone."""
        return replace(self, extent="verdicts")

    def quick(self) -> "SpeedRange":
        """Two gaits at two cycle times."""
        two = tuple(GAITS[name] for name in ("semi_erect", "high_walk"))
        return replace(self, gaits=two if set(two) <= set(self.gaits) else self.gaits[:1], slower=(1.0, 1.5), cycles=1)

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Walk in every gait, at every cycle time, with both models of the servos."""
        record, fastest = self._walk(progress)
        return SimulationResult(record=record, replays=self._replays(fastest))

    def _replays(self, fastest: Sequence[xr.Dataset]) -> Mapping[str, Replay]:
        """Return the replay of the first gait and the last, where there are two."""
        walks = [fastest[0], fastest[-1]] if len(fastest) > 1 else fastest
        end_time = min(float(walk.time[-1]) for walk in walks)
        walks = [walk.sel(time=slice(None, end_time)) for walk in walks]
        names = [str(walk.gait.item()).replace("_", " ") for walk in walks]
        ghost_text = f", and, half transparent, {names[1]}" if len(names) > 1 else ""
        return replayed(
            "speed_replay.html",
            walks[0],
            self.robot,
            ghost=walks[1] if len(walks) > 1 else None,
            labels=names,
            title="In a hurry",
            caption=f"At the shortest cycle that was tried: {names[0]}{ghost_text}.",
        )

    def _walk(self, progress: Progress) -> tuple[xr.Dataset, list[xr.Dataset]]:
        """Return the measured quantities, and the record of the fastest walk of each gait."""
        fastest, count = [], len(self.gaits)
        values = np.full((count, 2, len(self.slower), len(_UNITS)), np.nan)
        for i, gait in enumerate(self.gaits):
            walked = range(len(self.slower)) if self._has_range(gait) else [self._usual_index]
            robots = [self.robot, _with_other_servos(self.robot)] if self._has_range(gait) else [self.robot]
            slow_walks = [[k for k in walked if (self.slower[k] > 1.0) == is_slow] for is_slow in (False, True)]
            groups = [group for group in slow_walks if group]  # slow walks last longer: a batch of their own
            records = []
            for j, group in enumerate(groups):
                stage = staged(progress, gait.name, (i + j / len(groups)) / count, (i + (j + 1) / len(groups)) / count)
                quantities, record = self._measure_gait(gait, [self.slower[k] for k in group], robots, stage)
                values[i, : len(robots), group] = quantities.swapaxes(0, 1)
                records.append(record)
            fastest.append(records[0])
        return self._table(values), fastest

    def _has_range(self, gait: Gait) -> bool:
        """Return whether a gait walks at every cycle time, with both models of the servos."""
        judged = [candidate for candidate in self.gaits if candidate.name == _JUDGED_GAIT] or self.gaits
        return self.extent == "whole" or gait in judged

    @property
    def _usual_index(self) -> int:
        """Index of the factor with which gaits have about their own cycle time."""
        return int(np.argmin(np.abs(np.array(self.slower) - 1.0)))

    def _measure_gait(
        self, gait: Gait, slower: Sequence[float], robots: Sequence[Robot], progress: Any
    ) -> tuple[np.ndarray, xr.Dataset]:
        """Return ``_UNITS`` at some cycle times of a gait, shape (robot, slower, unit), and the first robot's fastest.

        Args:
            gait: the gait.
            slower: factors on its cycle time [-].
            robots: the robot with each model of the servos.
            progress: called with the fraction that is done.
        """
        max_duration, period = START + (self.cycles + 1) * gait.period * max(slower), control_period(self.robot)
        quantities, records = [], []
        for i, robot in enumerate(robots):
            runs = [Run(robot=robot, gait=replace(gait, period=gait.period * s)) for s in slower]
            record = simulate(
                runs,
                duration=float(np.ceil(round(max_duration / period, 6)) * period),
                timestep=self.timestep,
                progress=staged(progress, "", i / len(robots), (i + 1) / len(robots)),
            )
            quantities.append([self._measure_walk(record.isel(run=j), run) for j, run in enumerate(runs)])
            records.append(record.isel(run=0))
        return np.array(quantities), records[0]

    def _measure_walk(self, record: xr.Dataset, run: Run) -> list[float]:
        """Return the quantities of ``_UNITS``, in their order, over the measured cycles of one walk."""
        start, end = START + run.gait.period, START + (self.cycles + 1) * run.gait.period
        excerpt = time_window(record, start, end)
        speed = float(displacement(record, start, end).sel(xyz="x")) / (end - start)
        legs = [i for limb in layout(run.robot).limbs for i in range(limb.servos.start, limb.servos.stop)]
        fastest = float(abs(excerpt.servo_velocity.isel(servo=legs)).quantile(0.99, "time").max())
        height = hip_height(run.robot, run.gait)
        horizontal = displacement(record, start, end).sel(xyz=["x", "y"]).values
        is_moving = np.linalg.norm(horizontal) >= _MIN_DISPLACEMENT_FRACTION * run.robot.length * self.cycles
        return [
            run.gait.period,
            speed,
            float(duty_factor(record, start, end).mean()),
            float(cost_of_transport(record, start, end)) if is_moving else float("nan"),
            float(electrical_cost_of_transport(record, start, end)) if is_moving else float("nan"),
            speed**2 / (GRAVITY * height) if height > 0.0 else float("nan"),
            float(roll_peak_to_peak(record, start, end)),
            fastest,
            float((excerpt.tail_force.sel(xyz="z") > _TOUCH_LOAD * run.robot.mass * GRAVITY).mean()),
            _lying_fraction(run.robot, excerpt),
        ]

    def _table(self, values: np.ndarray) -> xr.Dataset:
        """Return measured quantities as a record.

        Args:
            values: the quantities of ``_UNITS``, shape (gait, servo_model, slower, quantity).
        """
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
        for name in record.gait.values:
            gait_record = record.sel(gait=name)
            own_record, other_record = (gait_record.sel(servo_model=model) for model in ("own", "other"))
            usual_cycle = own_record.isel(slower=self._usual_index)
            measures[f"speed_{name}"] = Measure(float(usual_cycle.speed), "m/s")
            if _is_range(gait_record):
                other_speed = float(other_record.isel(slower=self._usual_index).speed)
                measures |= {
                    f"speed_{name}_other_servos": Measure(other_speed, "m/s"),
                    f"servo_change_{name}": Measure(float(abs(other_record.speed / own_record.speed - 1.0).max()), "-"),
                    **ranged(f"speed_{name}_slowest", own_record.speed.min(), gait_record.speed.min("slower"), "m/s"),
                    **ranged(f"speed_{name}_fastest", own_record.speed.max(), gait_record.speed.max("slower"), "m/s"),
                    f"cost_{name}_least": Measure(float(own_record.cost.min()), "-"),
                }
            measures |= {
                f"cost_{name}": Measure(float(usual_cycle.cost), "-"),
                f"electrical_cost_{name}": Measure(float(usual_cycle.electrical_cost), "-"),
                f"duty_{name}": Measure(float(usual_cycle.duty), "-"),
                f"froude_{name}": Measure(float(usual_cycle.froude), "-"),
                f"roll_{name}": Measure(float(usual_cycle.rolled), "rad"),
                f"joint_speed_{name}": Measure(float(usual_cycle.joint_speed), "rad/s"),
            }
        animals = ANIMAL["high_walk_speed"]
        measures["animals_high_walk_slowest"] = Measure(animals.low, "m/s")
        measures["animals_high_walk_fastest"] = Measure(animals.high, "m/s")
        if "high_walk" in record.gait.values:
            high_walk = record.sel(gait="high_walk", servo_model="own")
            measures["tail_touches_high_walk"] = Measure(float(high_walk.tail_touches.mean()), "-")
            measures |= ranged("tail_on_ground_high_walk", high_walk.tail_lies.mean(), high_walk.tail_lies, "-")
        return measures

    def simulate_measures(self, measure_names: Collection[str], progress: Progress = silent) -> Measures:
        """Return at least the wanted measures; only gaits whose measures are wanted are simulated."""
        named_gaits = tuple(gait for gait in self.gaits if any(f"_{gait.name}" in name for name in measure_names))
        needs_all_gaits = not named_gaits or not all(
            any(f"_{gait.name}" in name for gait in named_gaits) for name in measure_names
        )
        variant = self if needs_all_gaits else replace(self, gaits=named_gaits)
        return super(SpeedRange, variant).simulate_measures(measure_names, progress)

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say how fast and how dear each gait is, and what the other model of the servos changes."""
        names = [gait.name for gait in self.gaits]
        moving = [name for name in names if isfinite(measures[f"cost_{name}"])]
        of_range = [name for name in moving or names if f"servo_change_{name}" in measures]
        names = moving or names
        speeds, costs = ("speed_{}_fastest", "cost_{}_least") if of_range == names else ("speed_{}", "cost_{}")
        fastest = max(names, key=lambda name: measures[speeds.format(name)])
        cheapest = min(names, key=lambda name: measures[costs.format(name)])
        return self.render_explanation(
            measures,
            moving=moving,
            fastest=fastest,
            top_speed=measures[speeds.format(fastest)],
            cheapest=cheapest,
            least_cost=measures[costs.format(cheapest)],
            of_range=of_range,
            is_whole=of_range == names,
            falls=_falling(self.robot)[0] > 0,
            changed=max((measures[f"servo_change_{name}"] for name in of_range), default=nan),
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
    "electrical_cost": "1",
    "froude": "1",
    "rolled": "rad",
    "joint_speed": "rad/s",
    "tail_touches": "1",
    "tail_lies": "1",
}


def _is_range(gait_record: xr.Dataset) -> bool:
    """Return whether a gait walked at every cycle time, with both models of the servos."""
    return bool(gait_record.period.notnull().all())


def _with_other_servos(robot: Robot) -> Robot:
    """Return a robot with the other model of its legs' servos."""
    return with_leg_servos(robot, with_full_torque if _falling(robot)[0] else with_speed_line)


def _models(robot: Robot) -> tuple[str, str]:
    """Return labels of the legs' servos: the robot's own, and those of the other model."""
    falling, count = _falling(robot)
    if not falling:
        return _FULL, _LINE
    return _LINE if falling == count else f"servos of which {falling} of {count} lose torque with speed", _FULL


def _falling(robot: Robot) -> tuple[int, int]:
    """Return the number of limb servos whose torque falls with speed, and the number of limb servos [-]."""
    robot_layout, servos = layout(robot), servos_of(robot)
    limbs = [servos[name] for limb in robot_layout.limbs for name in robot_layout.servos[limb.servos]]
    return sum(servo.winding is not None for servo in limbs), len(limbs)


def _lying_fraction(robot: Robot, excerpt: xr.Dataset) -> float:
    """Return the mean fraction of the tail's length that lies on the ground; 0 of a body without a tail [-].

    Args:
        robot: robot of the record.
        excerpt: the measured cycles of one run.
    """
    robot_layout = layout(robot)
    if not robot_layout.tail:
        return 0.0
    sampled = excerpt.isel(time=slice(None, None, 5))
    body_frames = frames(robot, sampled.joint_angle.transpose("time", "joint").values)
    numbers = [i for i, body in enumerate(robot_layout.bodies) if body.name in robot_layout.tail]
    segments = [
        next(segment for segment in robot_layout.robot.axis if segment.name == robot_layout.bodies[i].name)
        for i in numbers
    ]
    last_body, tip_offset = numbers[-1], -(segments[-1].front + segments[-1].rear)
    tip = body_frames.positions[:, last_body] + tip_offset * body_frames.turns[:, last_body, :, 0]
    points = np.concatenate([body_frames.positions[:, numbers], tip[:, None]], axis=1)
    up_axis = rotation.upward(sampled.orientation.transpose("time", "wxyz").values)
    height = np.einsum("tk,tpk->tp", up_axis, points) + sampled.position.sel(xyz="z").values[:, None]
    lengths = np.array([segment.front + segment.rear for segment in segments])
    positions = np.concatenate([[0.0], np.cumsum(lengths)])
    share = positions / positions[-1]
    lies = (height - _radii(segments, positions) < _TOUCH_HEIGHT * robot.length).astype(float)
    return float(np.trapezoid(lies, share, axis=1).mean())


def _radii(segments: Sequence[Segment], positions: np.ndarray) -> np.ndarray:
    """Return the half height of a tail at its joints and its tip, interpolated between the segments' middles [m].

    Args:
        segments: segments of the tail, from the root.
        positions: positions of joints and tip, along the tail from its root [m].
    """
    segment_radii = np.array(
        [max(s.radius if isinstance(s, Rod) else s.half[2] for s in segment.shapes) for segment in segments]
    )
    middles = (positions[1:] + positions[:-1]) / 2
    radii = np.interp(positions, middles, segment_radii)
    if len(segments) > 1:
        radii[0] = segment_radii[0] + (segment_radii[1] - segment_radii[0]) * (positions[0] - middles[0]) / (
            middles[1] - middles[0]
        )
        radii[-1] = segment_radii[-1] + (segment_radii[-1] - segment_radii[-2]) * (positions[-1] - middles[-1]) / (
            middles[-1] - middles[-2]
        )
    return np.maximum(radii, 0.0)


def draw_speed_range(record: xr.Dataset, lines: Mapping[str, Mapping[str, Any]], servos: tuple[str, str]) -> Figure:
    """Draw speed, cost, duty factor and Froude number over cycle time, the other model of the servos thinly.

    Args:
        record: record of the experiment ``speed_range``.
        lines: style of each gait.
        servos: names of the two servo models, the robot's own first.
    """
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
                for model, width in (("other", _OTHER_LINE_WIDTH), ("own", _OWN_LINE_WIDTH)):
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
        if bool((record.froude > 0.0).any()):
            axes[1, 1].set_yscale("log")
        else:
            axes[1, 1].text(0.5, 0.5, "unknown: no hip height", transform=axes[1, 1].transAxes, ha="center")
        for ax in axes[1]:
            ax.set_xlabel("cycle time [s]")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        models = [
            Line2D([], [], color=COLOURS["printed"], linewidth=width) for width in (_OWN_LINE_WIDTH, _OTHER_LINE_WIDTH)
        ]
        handles, labels = [*handles, *models, band], [*labels, *servos, f"{_WALKING.who}, high walk"]
        figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize=11)
    at_own_time = [str(gait) for gait in record.gait.values if not _is_range(record.sel(gait=gait))]
    gaits_text = f" ({listed(at_own_time)} at its own alone)".replace("_", " ") if at_own_time else ""
    return captioned(
        figure,
        f"Every gait over its cycle time{gaits_text}. Thin: legs with {servos[1]}. The cost of servos whose torque "
        f"falls includes what their motors lose. Band: what {_WALKING.who} do in the high walk.",
    )


experiment = SpeedRange()
