"""Could the robot gallop, and which servos would it take?"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.core.checks import Checks
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog.gallop_limits.gaits import BOUNDS, TROTS, SearchedGait
from suchus.experiments.experiment import (
    Experiment,
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
from suchus.robot.design import Robot, Servo, layout
from suchus.robot.design.body import servos_of
from suchus.robot.design.scale import control_period
from suchus.robot.design.servos import with_full_torque, with_named_servos, with_speed_line
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START, Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, Tolerances, simulate
from suchus.sim.metrics import displacement, flight_share, time_window
from suchus.visual.figures import captioned
from suchus.visual.figures.style import COLOURS, panels, styled

_RUN_UP = 1.0  # [s]; before the measurement begins
_MAX_SERVO_SPEED = 30.0  # [rad/s]; no-load speed out of the reach of a hobby servo of this torque
_FAST_PERIOD = 0.48  # [s]; period of the walks; the robot's own servos are far too slow for it


@dataclass(frozen=True, slots=True, kw_only=True)
class GallopLimits(Experiment):
    """Bounding gaits with servos of growing speed and torque, and the fastest trots and walks with the same servos.

    Every servo has a straight torque-speed line. Bounds and trots were found by a search with the cross-entropy method
    over twelve parameters, for leg servos of 3 N m and one no-load speed. On the map all servos get the same commands,
    and the robot as designed walks in each gait with each servo; the fastest gait of each kind counts. The fastest
    bound and the fastest trot or walk with servos like the robot's own are then walked by robots that are built of the
    design, which alone are judged. A robot flies while no part of it touches the ground.
    """

    title = "Could the robot gallop, and which servos would it take?"
    shows = "Section II.A"
    answers = ("speed_bound", "flight_bound", "bound_over_walk", "servo_speed_needed", "gallops_share")
    needs = ("legs", "shells", "article_spine", "cable_tail")
    judged_settings = ("robot", "bounds", "trots", "walks", "tolerances")
    judged_minima: ClassVar[Mapping[str, float]] = {
        "speeds": 4, "torques": 3, "seconds": 3.0, "repeats": 6,
    }  # fmt: skip
    answer_minima: ClassVar[Mapping[str, float]] = {"seconds": 3.0, "repeats": 6}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that should gallop."""
    bounds: tuple[SearchedGait, ...] = BOUNDS
    """Bounding gaits, each found for another servo: both front feet step together, then both hind feet."""
    trots: tuple[SearchedGait, ...] = TROTS
    """Trots, found by the same search with the same servos, for an equal comparison."""
    walks: tuple[Gait, ...] = field(
        default_factory=lambda: tuple(replace(GAITS[name], period=_FAST_PERIOD) for name in ("semi_erect", "high_walk"))
    )
    """Walks of the catalog, at short periods, that a gallop must also outrun."""
    speeds: tuple[float, ...] = (5.0, 7.0, 10.0, 14.0, 20.0, 30.0, 60.0)
    """No-load speeds of the servos [rad/s]; hobby servos reach 7 to 12, the last is out of any servo's reach."""
    torques: tuple[float, ...] = (1.5, 3.0, 4.9)
    """Torque limits of the legs' servos [N m]; the last is that of the article's robot."""
    trunk_over_legs: float = 4.0 / 3.0
    """Torque limit of the servos that pitch the trunk over the legs' [-]; so in the search for bounds and trots."""
    others_over_legs: float = 2.5 / 3.0
    """Torque limit of all other servos over the legs' [-]; so in the search for bounds and trots."""
    repeats: int = 6
    """Number of robots built of the design with servos like its own [-]; their median and its interval are judged, for
    which at least six are needed."""
    tolerances: Tolerances = field(default_factory=Tolerances)
    """Tolerances of the robots built of the design, and of their grounds."""
    seconds: float = 3.0
    """Measured duration of each run, after one further second [s]."""
    timestep: float = 0.002
    """Time step of the physics [s]. A bound outran trot and walk with a tenth of the map's servos at 5 ms, and with
    three tenths at 2 ms."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.rising("speeds", 0.1, 1e3, "rad/s")
            check.rising("torques", 1e-6, 1e6, "N m")
            check.number("trunk_over_legs", 0.1, 10.0, "")
            check.number("others_over_legs", 0.1, 10.0, "")
            check.number("seconds", 0.05, 60.0, "s")
            check.number("timestep", 1e-5, control_period(self.robot), "s")
            check.whole("repeats", 1, 1000)
            for name in ("bounds", "walks"):
                check.that(len(getattr(self, name)) > 0, f"{self.name()}.{name} is empty; one gait at least is needed")

    def for_verdicts(self) -> "GallopLimits":
        """Return the same question with a coarser map.

        It has the speeds up to the own servo's, the next, and the highest up to ``_MAX_SERVO_SPEED``.
        """
        slower = [speed for speed in self.speeds if speed <= self._leg_servo.speed]
        faster = [speed for speed in self.speeds[len(slower) :] if speed <= _MAX_SERVO_SPEED]
        speeds = (*slower, *dict.fromkeys((*faster[:1], *faster[-1:])))
        return replace(self, speeds=speeds or self.speeds)

    def quick(self) -> "GallopLimits":
        """Return two speeds, one torque, one robot as built, half a second, a coarse step."""
        return replace(self, speeds=(7.0, 30.0), torques=(2.5,), repeats=1, seconds=0.5, timestep=0.005)

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Simulate every gait with every servo on the map, then robots as built with servos like the robot's own."""
        searched = [("bound", candidate) for candidate in self.bounds] + [
            ("trot", candidate) for candidate in self.trots
        ]
        kinds = [*(kind for kind, _ in searched), *("walk" for _ in self.walks)]
        gaits: list[Gait] = [*(candidate.gait for _, candidate in searched), *self.walks]
        cells = [(torque, speed) for torque in self.torques for speed in self.speeds]
        runs = [
            Run(robot=self._robot_with_servos(*cell), gait=gait, label=gait.name) for cell in cells for gait in gaits
        ]
        record = self._walk(runs, staged(progress, "map", 0.0, 0.9))
        shape = (len(self.torques), len(self.speeds), len(gaits))
        data = xr.Dataset(
            {
                name: (("torque", "servo_speed", "gait"), values.values.reshape(shape), values.attrs)
                for name, values in self._quantities(record).items()
            }
            | {"map_run": (("torque", "servo_speed", "gait"), np.arange(len(runs)).reshape(shape))},
            coords={
                "torque": ("torque", list(self.torques), {"units": "N m", "long_name": "torque limit"}),
                "servo_speed": ("servo_speed", list(self.speeds), {"units": "rad/s", "long_name": "no-load speed"}),
                "gait": [f"{gait.name} {gait.period:g} s" for gait in gaits],
                "kind": ("gait", kinds),
            },
            attrs={"own_torque": self._leg_servo.torque, "own_speed": self._leg_servo.speed},
        )
        own_servo = dict(zip(("torque", "servo_speed"), cells[self._own_cell(cells)], strict=True))
        fastest = [int(fastest_gaits(data, *group).sel(own_servo).map_run) for group in COMPARED.values()]
        built = self._walk(
            self.tolerances.repeats([runs[run] for run in fastest], self.repeats),
            staged(progress, "as built", 0.9, 1.0),
        )
        for name, values in self._quantities(built).items():
            of_robots = values.values.reshape(len(COMPARED), self.repeats)
            attrs = values.attrs | {"long_name": f"{values.attrs['long_name']}, of each robot that is built"}
            data[f"built_{name}"] = (("compared", "repeat"), of_robots, attrs)
        data = data.assign_coords(compared=list(COMPARED))
        replays = self._replays(record, cells, data)
        return SimulationResult(record=data.drop_vars("map_run"), replays=replays)

    def _walk(self, runs: Sequence[Run], progress: Progress) -> xr.Dataset:
        """Return the record of runs over the measured duration and the second before it."""
        duration = round(START + _RUN_UP + self.seconds, 2)
        return simulate(runs, duration=duration, timestep=self.timestep, effort=False, progress=progress)

    def _quantities(self, record: xr.Dataset) -> dict[str, xr.DataArray]:
        """Return speed forward [m/s], share of flight [-] and speed of the leg joints [rad/s] of each run."""
        window = time_window(record, START + _RUN_UP)
        joint_speed = abs(window.servo_velocity.isel(servo=self._leg_servo_indices)).quantile(0.99, "time").max("servo")
        quantities = {
            "speed": (displacement(record, START + _RUN_UP).sel(xyz="x") / self.seconds, "m/s", "speed forward"),
            "flight": (flight_share(record, START + _RUN_UP), "1", "share of the time in which nothing touches"),
            "joint_speed": (joint_speed, "rad/s", "99th percentile of the fastest leg joint"),
        }
        return {
            name: values.assign_attrs(units=unit, long_name=long_name)
            for name, (values, unit, long_name) in quantities.items()
        }

    def _own_cell(self, cells: Sequence[tuple[float, float]]) -> int:
        """Return the index of the cell whose servos are most like the robot's own.

        Args:
            cells: torque limit [N m] and no-load speed [rad/s] of each cell of the map.
        """
        own = self._leg_servo
        return min(
            range(len(cells)),
            key=lambda i: abs(cells[i][0] - own.torque) / own.torque + abs(cells[i][1] - own.speed) / own.speed,
        )

    @property
    def _leg_servo(self) -> Servo:
        """The servo of the legs as designed."""
        return self.robot.hind_leg.servo

    @property
    def _leg_servo_indices(self) -> list[int]:
        """Indices of the servos of the legs."""
        body_layout = layout(self.robot)
        return [index for limb in body_layout.limbs for index in range(*limb.servos.indices(len(body_layout.servos)))]

    def _robot_with_servos(self, torque: float, speed: float) -> Robot:
        """Return the robot with other servos, each with a straight torque-speed line.

        Args:
            torque: torque limit of the legs' servos [N m]; the others are in proportion.
            speed: no-load speed of all servos [rad/s].
        """
        leg_servos = {layout(self.robot).servos[index] for index in self._leg_servo_indices}

        def over_legs(name: str) -> float:
            """Return the torque limit of a servo over that of the legs' servos [-]."""
            return (
                1.0 if name in leg_servos else self.trunk_over_legs if "spine_pitch" in name else self.others_over_legs
            )

        return with_named_servos(
            self.robot,
            {
                name: with_speed_line(replace(with_full_torque(servo), torque=torque * over_legs(name), speed=speed))
                for name, servo in servos_of(self.robot).items()
            },
        )

    def _replays(
        self, record: xr.Dataset, cells: Sequence[tuple[float, float]], map_of_gaits: xr.Dataset
    ) -> Mapping[str, Replay]:
        """Return the replay of the fastest bound of all, and of the fastest with servos most like the robot's own.

        Args:
            record: record of all runs of the map.
            cells: torque limit [N m] and no-load speed [rad/s] of each cell of the map.
            map_of_gaits: ``speed`` (torque, servo_speed, gait) [m/s] and ``map_run``, with the ``kind`` of each gait.
        """
        bound = map_of_gaits.isel(gait=map_of_gaits.kind.values == "bound")
        speeds, runs = (bound[name].values.reshape(len(cells), -1) for name in ("speed", "map_run"))
        shown = [int(np.argmax(speeds.max(1))), self._own_cell(cells)]
        servo_texts = ["{:g} N m and {:g} rad/s".format(*cells[cell]) for cell in shown]
        best_run, own_run = (int(runs[cell, np.argmax(speeds[cell])]) for cell in shown)
        return replayed(
            "gallop_replay.html",
            record.isel(run=best_run),
            self.robot,
            ghost=record.isel(run=own_run),
            labels=tuple(servo_texts),
            title="Could it gallop?",
            caption=f"Bounds with servos of {servo_texts[0]}, and, half transparent, of {servo_texts[1]}.",
        )

    def measure(self, record: xr.Dataset) -> Measures:
        """Return the speed of a bound with the robot's servos and with better ones, and the speed a gallop needs."""
        bound, walks = fastest_gaits(record, "bound"), fastest_gaits(record, "trot", "walk")
        design_servo = {"torque": record.attrs["own_torque"], "servo_speed": record.attrs["own_speed"]}
        own_cell = record.speed.sel(design_servo, method="nearest")
        gallops = (bound.speed > walks.speed) & (bound.flight >= MIN_FLIGHT_FRACTION)
        pays = gallops.sel(torque=design_servo["torque"], method="nearest")
        best = bound.isel(bound.speed.argmax(["torque", "servo_speed"]))
        built_bound, built_walk = (record.sel(compared=name) for name in COMPARED)
        ratio = built_bound.built_speed / built_walk.built_speed
        return estimated("bound_over_walk", ratio, "-") | Measures(
            {
                "speed_bound": Measure(float(built_bound.built_speed.median()), "m/s"),
                "flight_bound": Measure(float(built_bound.built_flight.median()), "-"),
                "joint_speed_bound": Measure(float(built_bound.built_joint_speed.median()), "rad/s"),
                "speed_walk": Measure(float(built_walk.built_speed.median()), "m/s"),
                "speed_bound_best": Measure(float(best.speed), "m/s"),
                "flight_bound_best": Measure(float(best.flight), "-"),
                "joint_speed_best": Measure(float(best.joint_speed), "rad/s"),
                "torque_best": Measure(float(best.torque), "N m"),
                "servo_speed_best": Measure(float(best.servo_speed), "rad/s"),
                "servo_speed_own": Measure(float(own_cell.servo_speed), "rad/s"),
                "torque_own": Measure(float(own_cell.torque), "N m"),
                "servo_speed_needed": Measure(_min_paying_speed(pays.servo_speed.values, pays.values), "rad/s"),
                "gallops_share": Measure(float(gallops.mean()), "-"),
            }
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw speed and flight of the bound over the servos' speed, with the speed of the fastest walk."""
        bound, walks = simulated_gaits(outcome.record, "bound"), simulated_gaits(outcome.record, "trot", "walk")
        figure = captioned(
            draw_gallop_limits(bound, walks, outcome.record.attrs["own_speed"]),
            "The fastest bounding gait with servos of growing no-load speed and torque (colours). Left: its speed; "
            "dashed: the fastest trot or walk. Right: the share of the time in which nothing touches the ground. "
            "Each point is what the robot as designed did with that servo. The grey line is the robot's own servo.",
        )
        return {"gallop_limits": figure}


COMPARED: Mapping[str, tuple[str, ...]] = {"bound": ("bound",), "trot or walk": ("trot", "walk")}
"""Kinds of gaits whose fastest with servos like the robot's own are walked by robots as built, by name."""
MIN_FLIGHT_FRACTION = 0.1
"""Flight fraction from which a bound counts as a gallop [-]; with less it is a walk that stumbles."""


def simulated_gaits(record: xr.Dataset, *kinds: str) -> xr.Dataset:
    """Return the fastest simulated gait of some kinds with every servo, dimensions ``torque`` and ``servo_speed``.

    Args:
        record: record of the experiment.
        kinds: ``bound``, ``trot`` or ``walk``.
    """
    candidates = record.isel(gait=np.isin(record.kind.values, kinds))
    return candidates.isel(gait=candidates.speed.argmax("gait")).transpose("torque", "servo_speed", ...)


def fastest_gaits(record: xr.Dataset, *kinds: str) -> xr.Dataset:
    """Return speed [m/s], flight [-] and joint speed [rad/s] of the fastest gait of some kinds with every servo.

    A better servo can be limited to the torque and speed of a weaker or slower one. A gait that is fast with the lesser
    servo therefore counts with all better ones too. Otherwise a bound would be compared with walks that were not
    searched for its servo.

    Args:
        record: record of the experiment.
        kinds: ``bound``, ``trot`` or ``walk``.
    """
    best = simulated_gaits(record, *kinds)
    cells, (torque_count, speed_count) = np.arange(best.speed.size).reshape(best.speed.shape), best.speed.shape
    best_cells = [
        cells[: i + 1, : j + 1].ravel()[np.argmax(best.speed.values[: i + 1, : j + 1])]
        for i in range(torque_count)
        for j in range(speed_count)
    ]
    names = [name for name in ("speed", "flight", "joint_speed", "map_run") if name in best.variables]
    return best.assign(
        {name: (best[name].dims, best[name].values.ravel()[best_cells].reshape(best[name].shape)) for name in names}
    )


def _min_paying_speed(speeds: np.ndarray, pays: np.ndarray) -> float:
    """Return the lowest speed from which on all faster servos pay off [rad/s]; infinite if not even the fastest does.

    Args:
        speeds: no-load speeds, increasing [rad/s].
        pays: whether a gallop pays off at each speed.
    """
    all_faster_pay = np.flip(np.logical_and.accumulate(np.flip(pays)))
    return float(speeds[all_faster_pay][0]) if all_faster_pay.any() else float("inf")


def draw_gallop_limits(bound: xr.Dataset, walk: xr.Dataset, own_speed: float) -> Figure:
    """Draw speed [m/s] and share of flight of a bound over the servos' no-load speed [rad/s].

    Args:
        bound: the fastest bound, with ``speed`` and ``flight`` (torque, servo_speed).
        walk: the fastest trot or walk, the same.
        own_speed: no-load speed of the robot's own servos [rad/s].
    """
    shades = matplotlib.colormaps["viridis"](np.linspace(0.8, 0.1, bound.sizes["torque"]))
    with styled():
        figure, axes = panels(1, 2, width=11.0, height=4.6)
        for shade, torque in zip(shades, bound.torque.values, strict=True):
            bounding, walking = bound.sel(torque=torque), walk.sel(torque=torque)
            axes[0, 0].plot(
                bounding.servo_speed, bounding.speed, marker="o", color=shade, label=f"bound, {torque:g} N m"
            )
            axes[0, 0].plot(bounding.servo_speed, walking.speed, color=shade, linestyle=(0, (4, 2)))
            axes[0, 1].plot(bounding.servo_speed, 100 * bounding.flight, marker="o", color=shade)
        for ax in axes.flat:
            ax.set_xscale("log")
            ax.set_xticks(bound.servo_speed.values, [f"{speed:g}" for speed in bound.servo_speed.values])
            ax.minorticks_off()
            ax.axvline(own_speed, color=COLOURS["neutral"], linewidth=1.0)
            ax.set_xlabel("no-load speed of the servos [rad/s]")
        axes[0, 0].plot([], [], color="#333333", linestyle=(0, (4, 2)), label="fastest trot or walk")
        axes[0, 0].set_ylabel("speed forward [m/s]")
        axes[0, 1].set_ylabel("in flight [% of the time]")
        figure.legend(loc="outside upper center", ncols=bound.sizes["torque"] + 1)
    return figure


experiment = GallopLimits()
