"""Which posture for which ground, and can the robot choose by what it feels?"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise, permutations
from math import isfinite, nan
from typing import Any, ClassVar, Literal

import numpy as np
import xarray as xr

from suchus.core.checks import Checks
from suchus.core.errors import UnsuitedRobot
from suchus.core.intervals import look_confidence, planned_looks
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog.terrain.figure import draw_on_bumps, draw_rough
from suchus.experiments.experiment import (
    Experiment,
    Extent,
    Measure,
    Measures,
    Outcome,
    Progress,
    Replay,
    SimulationResult,
    estimated,
    estimated_fraction,
    silent,
    staged,
)
from suchus.robot.control import AttitudeRule, Change, Control, SwitchRule, Walking
from suchus.robot.design import GRAVITY, Robot, layout
from suchus.robot.design.ground import BUMPS_START, STONE, Bumps, Relief, Step, Stone, profile
from suchus.robot.design.scale import control_period
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import START, Gait, suits
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Run, Tolerances, simulate
from suchus.sim.metrics import cost_of_transport, displacement, heading_change, tilt, time_window
from suchus.visual.figures.gait_diagram import GAIT_LINES

_TOUCH = 0.5 / (
    ROBOTS["caiman"].mass * GRAVITY
)  # belly load that counts as contact [body weight]; half a newton of the caiman
_CONTACT_DISTANCE = 0.00495  # distance at which a foot counts as stopped by an obstacle [body length]
_LADDER = {"crawl": 0.85, "semi_erect": 1.0, "high_walk": 1.12}
"""Heights of the three postures of another body, over the height of its gait [-]."""
_STEPS = 1.75  # factor on the cycles of another body, whose steps are shorter [-]
Surface = Literal["even", "bumps"]
MAX_TILT = np.radians(60)
"""Roll or pitch above which the robot has fallen [rad]."""
MIN_ROUGH_HEIGHT = 0.03
"""Least height of what counts as rough ground for the article's robot [m]: a third of the legs' hip height in the
sprawled crawl is less. For others it is in proportion to their length."""
_HEIGHT_TOLERANCE = 1e-9  # heights that differ by less are equal [m]
SINGLE = ("low_crawl", "semi_erect", "high_walk", "high_walk_level")
"""Arms that keep one posture."""
_COMPARED_ARMS = ("low_crawl", "high_walk_level")
FLAT_ARMS = ("low_crawl", "high_walk")
"""Arms whose costs on even ground are compared, of more robots than walk on the other grounds."""
_STRUCTURE_ARMS = ("low_crawl", "high_walk", "high_walk_level")
"""Arms of the two structures that the article compares."""
_ROUGH_MEASURES = (
    "met_judged", "rough_grounds", "erect_open_loop_ahead_share", "erect_open_loop_kept_share", "erect_ahead_share",
    *(f"falls_rough_{name}" for name in _STRUCTURE_ARMS),
)  # fmt: skip
"""Measures of the two structures on rough grounds."""
_STRUCTURE_MEASURES = ("flat_cost_ratio", *_ROUGH_MEASURES)


@dataclass(frozen=True, slots=True, kw_only=True)
class Terrain(Experiment):
    """Low crawl, semi-erect walk, high walk without and with the IMU, and the robot that switches, on rough ground.

    ``low_crawl`` and ``high_walk`` walk open loop, ``semi_erect`` and ``high_walk_level`` answer the IMU. ``switching``
    begins semi-erect and returns to it, ``thrifty`` begins crawling and returns to that, where they walk; both go
    up when the belly touches. Each seed has its own bumps, the correlation lengths in turn, and its own place of step
    or stone, and a robot and a floor of its own, see ``land.Tolerances``. A run has fallen once it rolled or pitched by
    more than 60 degrees. It has met an obstacle once a front foot came to the bumps or the edge of the
    step, or the chest to the stone. Another body walks its own gait at three heights in the place of the three gaits.
    """

    title = "Which posture for which ground, and can the robot choose by what it feels?"
    shows = "Section II.B, Fig. 3"
    answers = ("erect_ahead_share", "flat_cost_ratio", "met_judged", "transitions_upright", "transition_after_least")
    needs = ("foot_paths",)
    judged_settings = ("robot", "crawl", "semi_erect", "high_walk", "surfaces")
    judged_minima: ClassVar[Mapping[str, float]] = {
        "bumps": 2, "steps": 3, "stones": 3, "transitions": 6, "seeds": 4, "flat_robots": 6, "walked": 14.0,
    }  # fmt: skip
    answer_minima: ClassVar[Mapping[str, float]] = {"seeds": 4, "walked": 10.0}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that walks."""
    crawl: Gait = field(default_factory=lambda: GAITS["low_crawl"])
    """The sprawled gait."""
    semi_erect: Gait = field(default_factory=lambda: GAITS["semi_erect"])
    """The gait between the sprawled and the erect one."""
    high_walk: Gait = field(default_factory=lambda: GAITS["high_walk"])
    """The erect gait."""
    bumps: tuple[float, ...] = (0.04, 0.06)
    """Heights of random bumps [m]."""
    steps: tuple[float, ...] = (0.03, 0.04, 0.05)
    """Heights of a step up [m]."""
    stones: tuple[float, ...] = (0.04, 0.06, 0.10)
    """Heights of a stone between the feet [m]."""
    correlations: tuple[float, ...] = (0.06, 0.10)
    """Correlation lengths of the bumps, in turn over the seeds [m]."""
    surfaces: tuple[Surface, ...] = ("even", "bumps")
    """Grounds on which postures turn into each other; the bumps are 30 mm high."""
    transitions: int = 6
    """Number of the six transitions between the three postures that are tried [-]."""
    switching: bool = True
    """Whether a robot that begins semi-erect and rises when its belly touches walks too."""
    thrifty: bool = False
    """Whether a robot that begins in the crawl and rises when its belly touches walks too."""
    seeds: int = 4
    """Greatest number of runs of each posture on each ground [-]. After half of them sampling ends if the claim on
    rough grounds has a word by then."""
    early_end: bool = True
    """Whether sampling on rough grounds ends after half of the seeds if the claim has a word by then."""
    flat_robots: int = 12
    """Number of robots, each built of the design, of which the cost on even ground is compared [-]; at least six are
    needed for an interval of the median."""
    tolerances: Tolerances = field(default_factory=Tolerances)
    """By how much the robots and grounds of the seeds differ from their design."""
    walked: float = 14.0
    """Duration for which each run walks [s], 0.5 to 3600."""
    timestep: float = 0.005
    """Time step of the physics [s], at most 0.01."""
    extent: Extent = "whole"
    """How much is simulated: without the walks of the pictures for the verdicts, and without what walks cost on rough
    ground."""

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges, and empty lists of surfaces and correlation lengths."""
        with Checks(self.name(), self) as check:
            for heights in ("bumps", "steps", "stones"):
                if getattr(self, heights):
                    check.rising(heights, 1e-5, 0.5, "m")
            check.that(
                len(self.correlations) > 0, f"{self.name()}.correlations is empty; one length at least is needed"
            )
            check.that(len(self.surfaces) > 0, f"{self.name()}.surfaces is empty; even or bumps is needed")
            check.whole("transitions", 1, 6)
            check.whole("seeds", 1, 1000)
            check.whole("flat_robots", 1, 1000)
            check.number("walked", 0.5, 3600.0, "s")
            check.number("timestep", 1e-5, control_period(self.robot), "s")

    def for_verdicts(self) -> "Terrain":
        """Return the same question without the robot that switches and the walks of the pictures.

        Fewer robots walk on even ground.
        """
        return replace(self, switching=False, flat_robots=min(self.flat_robots, 6), extent="verdicts")

    def quick(self) -> "Terrain":
        """Three grounds, one seed, a short walk, two transitions on even ground."""
        return replace(
            self,
            bumps=(0.03,),
            steps=(),
            stones=(0.04,),
            surfaces=("even",),
            transitions=2,
            seeds=1,
            flat_robots=1,
            walked=1.5,
        )

    def gaits_for_robot(self, robot: Robot) -> dict[str, Any]:
        """Return three postures of the robot's own gait, low, usual and high, as far as its limbs reach.

        Raises:
            UnsuitedRobot: its own gait puts no feet at a height.
        """
        base_gait = default_gait(robot)
        if not base_gait.has("foot paths"):
            raise UnsuitedRobot(
                f"{self.name()} needs a gait of foot paths; robot {robot.name!r} has {base_gait.name!r}."
            )
        duration_factor = base_gait.period / self.semi_erect.period * _STEPS
        settings: dict[str, Any] = {"walked": round(self.walked * duration_factor, 2)}
        for name, share in _LADDER.items():
            heights = [base_gait.height * (1.0 + fraction * (share - 1.0)) for fraction in (1.0, 0.5, 0.25, 0.0)]
            candidates = [replace(base_gait, name=f"{base_gait.name}_{name}", height=height) for height in heights]
            settings[name] = base_gait if share == 1.0 else next(gait for gait in candidates if suits(robot, gait))
        return settings

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Walk on every ground, and turn every posture into every other."""
        ground_record = self._ground_record(staged(progress, "grounds", 0.0, 0.85))
        ground_record["flat_cost"] = self._flat_costs(ground_record, staged(progress, "even ground", 0.85, 0.9))
        change_record = self._changes(staged(progress, "transitions", 0.9, 0.97))
        if self.extent == "verdicts":
            return SimulationResult(record=ground_record.merge(change_record))
        record = self._example(staged(progress, "example", 0.97, 1.0)).merge(ground_record).merge(change_record)
        return SimulationResult(record=record, replays=self._replays(record))

    def simulate_measures(self, measure_names: Collection[str], progress: Progress = silent) -> Measures:
        """Return at least the wanted measures; for those of crawl and high walk only these conditions are simulated."""
        names = {name.removesuffix("_low").removesuffix("_high") for name in measure_names}
        if not all(name in _STRUCTURE_MEASURES or name.startswith("transition") for name in names):
            return super(Terrain, self).simulate_measures(measure_names, progress)
        needs_rough = any(name in _ROUGH_MEASURES for name in names)
        variant = self if needs_rough else replace(self, bumps=(), steps=(), stones=())
        ground_record = variant._ground_record(staged(progress, "grounds", 0.0, 0.8), _STRUCTURE_ARMS)
        ground_record["flat_cost"] = self._flat_costs(ground_record, staged(progress, "even ground", 0.8, 0.9))
        change_record = self._changes(staged(progress, "transitions", 0.9, 1.0))
        measures, rough_record = _flat(ground_record) | _transitions(change_record), _rough_grounds(ground_record)
        return (
            measures | _rough_measures(rough_record, ground_record) | _falls(rough_record) if needs_rough else measures
        )

    def measure(self, record: xr.Dataset) -> Measures:
        """Return how far each posture gets on each kind of ground, who met and who fell, and the transitions."""
        rough_record = _rough_grounds(record)
        measures = Measures()
        for arm in record.arm.values:
            of_arm = record.sel(arm=arm)
            flat = of_arm.isel(ground=0, seed=0)
            even_forward = of_arm.forward.isel(ground=0).mean("seed")
            measures |= {
                f"flat_forward_{arm}": Measure(float(flat.forward), "m"),
                f"flat_cost_{arm}": Measure(float(flat.cost), "-"),
                f"falls_{arm}": Measure(float(of_arm.fell.sum()), "-"),
                f"belly_{arm}": Measure(float(of_arm.belly.mean()), "-"),
                f"aside_{arm}": Measure(float(abs(of_arm.aside).mean()), "m"),
            }
            for kind in dict.fromkeys(record.kind.values):
                kind_record = of_arm.isel(
                    ground=np.flatnonzero((record.kind.values == kind) & (record.height.values > 0))
                )
                measures[f"kept_{kind}_{arm}"] = Measure(float(kind_record.forward.mean() / even_forward), "-")
                measures[f"met_{kind}_{arm}"] = Measure(float(kind_record.met.mean()), "-")
        return measures | {
            **_flat(record),
            **_rough_measures(rough_record, record),
            **_falls(rough_record),
            **(_switching(record) if "switching" in record.arm.values else {}),
            "grounds": Measure(float(record.sizes["ground"]), "-"),
            **_transitions(record),
        }

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say what each posture keeps of its displacement on rough ground, and what switching is worth."""
        shares = {kind: measures.get(f"kept_{kind}_low_crawl", nan) for kind in ("bumps", "step", "stone")}
        return self.render_explanation(measures, kinds=[kind for kind, share in shares.items() if isfinite(share)])

    def _replays(self, record: xr.Dataset) -> Mapping[str, Replay]:
        """Return the replay of the semi-erect walk over bumps, with the low crawl half transparent, by file name."""
        height = f"{1000 * self._shown_height:.3g}"
        return replayed(
            "terrain_replay.html",
            record.isel(run=1),
            self.robot,
            ghost=record.isel(run=0),
            labels=("semi-erect", "low crawl"),
            title="Over bumps, semi-erect and low",
            caption=f"Semi-erect with the IMU, and, half transparent, low, over one field of {height} mm bumps.",
        )

    def _shown_relief(self) -> Bumps:
        return self._bumps(self._shown_height, self.correlations[-1], 2)

    @property
    def _shown_height(self) -> float:
        return 0.04 * self._size

    @property
    def _size(self) -> float:
        """Length of the robot over that of the article's robot [-]."""
        return round(self.robot.length / ROBOTS["caiman"].length, 9)

    def _bumps(self, height: float, correlation: float, seed: int) -> Bumps:
        size = self._size
        return Bumps(height=height, correlation=correlation, start=BUMPS_START * size, seed=seed, scale=size)

    def arms(self) -> Mapping[str, tuple[Gait, Control]]:
        """Return gait and control of every condition."""
        ladder, level = (self.crawl, self.semi_erect, self.high_walk), AttitudeRule()
        arms: dict[str, tuple[Gait, Control]] = {
            "low_crawl": (self.crawl, Walking()),
            "semi_erect": (self.semi_erect, Walking(attitude=level)),
            "high_walk": (self.high_walk, Walking()),
            "high_walk_level": (self.high_walk, Walking(attitude=level)),
        }
        if self.switching:
            rule = SwitchRule(ladder=ladder, home=1)
            arms["switching"] = (self.semi_erect, Walking(attitude=level, switching=rule))
        if self.thrifty:
            arms["thrifty"] = (self.crawl, Walking(attitude=level, switching=SwitchRule(ladder=ladder, home=0)))
        return arms

    def grounds(self) -> list[tuple[str, float, list[Relief | None]]]:
        """Return kind, height and the relief of every seed."""
        places = np.random.default_rng(0).uniform(-1.0, 1.0, (self.seeds, 2))
        size = self._size
        rows: list[tuple[str, float, list[Relief | None]]] = [("bumps", 0.0, [None] * self.seeds)]
        for height in self.bumps:
            lengths = [self.correlations[seed % len(self.correlations)] for seed in range(self.seeds)]
            fields = [self._bumps(height, length, seed) for seed, length in enumerate(lengths)]
            rows.append(("bumps", height, list(fields)))
        for height in self.steps:
            rows.append(("step", height, [Step(at=float((0.66 + 0.06 * x) * size), height=height) for x, _ in places]))
        for height in self.stones:
            stones = [
                replace(
                    STONE,
                    at=float((0.75 + 0.05 * x) * size),
                    aside=float(0.02 * y * size),
                    height=height,
                    length=STONE.length * size,
                    width=STONE.width * size,
                )
                for x, y in places
            ]
            rows.append(("stone", height, list(stones)))
        return rows

    def _ground_record(self, progress: Progress, names: Collection[str] = ()) -> xr.Dataset:
        """Return the quantities of ``_UNITS`` by ground, condition and seed, until the claim has a word.

        Args:
            progress: called with the fraction that is done.
            names: conditions that walk; all if empty.
        """
        looks, parts = planned_looks(self.seeds) if self.early_end else (self.seeds,), []
        for first, count in pairwise((0, *looks)):
            stage = staged(progress, "", first / looks[-1], count / looks[-1])
            parts.append(self._walks_of_seeds(range(first, count), stage, names))
            record = xr.concat(parts, "seed", join="exact", data_vars="minimal")
            record["looks"] = ((), len(looks), {"units": "1", "long_name": "planned looks of sequential sampling"})
            rough_record = _rough_grounds(record)
            if not rough_record.sizes["ground"] or self.has_word(
                "erect_structure_rough", _rough_measures(rough_record, record) | _falls(rough_record)
            ):
                break
        return record

    def _walks_of_seeds(self, seeds: range, progress: Progress, names: Collection[str]) -> xr.Dataset:
        """Return the quantities of ``_UNITS`` by ground, condition and some of the seeds.

        Args:
            seeds: the seeds.
            progress: called with the fraction that is done.
            names: conditions that walk; all if empty.
        """
        grounds, arms = self.grounds(), {name: arm for name, arm in self.arms().items() if name in names or not names}
        runs = [
            self.tolerances.draw_run(
                Run(
                    robot=self.robot,
                    gait=gait,
                    control=control,
                    ground=Ground(relief=reliefs[seed]),
                    label=arm,
                    seed=seed,
                ),
                seed,
            )
            for _, _, reliefs in grounds
            for arm, (gait, control) in arms.items()
            for seed in seeds
        ]
        even_count = len(arms) * len(seeds) if self.extent == "verdicts" else len(runs)
        share, others = even_count / len(runs), runs[even_count:]
        tables = [self._walk(runs[:even_count], staged(progress, "", 0.0, share), has_cost=True)]
        if others:
            tables.append(self._walk(others, staged(progress, "", share, 1.0), has_cost=False))
        table = np.concatenate(tables).reshape(len(grounds), len(arms), -1, len(_UNITS))
        data = xr.Dataset(
            {
                name: (("ground", "arm", "seed"), table[..., i], {"units": unit})
                for i, (name, unit) in enumerate(_UNITS.items())
            },
            coords={"arm": list(arms), "kind": ("ground", [kind for kind, _, _ in grounds])},
        )
        data["height"] = ("ground", [height for _, height, _ in grounds], {"units": "m"})
        data["walked"] = ((), self.walked, {"units": "s"})
        data["size_of_robot"] = ((), self._size, {"units": "1", "long_name": "length over that of the article's robot"})
        return data

    def _walk(self, runs: Sequence[Run], progress: Progress, *, has_cost: bool) -> np.ndarray:
        """Return the quantities of ``_UNITS`` of some runs, shape (run, quantity).

        Args:
            runs: the runs.
            progress: called with the fraction that is done.
            has_cost: whether their cost of transport is measured, which is NaN otherwise.
        """
        record = simulate(
            runs,
            duration=START + self.walked,
            timestep=self.timestep,
            sample_stride=5,
            effort=has_cost,
            progress=progress,
        )
        is_met = [_meets_obstacle(record.isel(run=j), run) for j, run in enumerate(runs)]
        return _run_quantities(record, is_met, has_cost=has_cost)

    def _flat_costs(self, ground_record: xr.Dataset, progress: Progress) -> xr.DataArray:
        """Return the cost of transport of crawl and high walk on even ground, by condition and robot [-].

        Args:
            ground_record: record of the grounds, of which the first is even; the robots of its seeds count first.
            progress: called with the fraction that is done.
        """
        arms = {name: arm for name, arm in self.arms().items() if name in FLAT_ARMS}
        seeds = range(ground_record.sizes["seed"], self.flat_robots)
        runs = [
            self.tolerances.draw_run(Run(robot=self.robot, gait=gait, control=control, label=name, seed=seed), seed)
            for name, (gait, control) in arms.items()
            for seed in seeds
        ]
        cost = ground_record.cost.isel(ground=0, drop=True).sel(arm=list(FLAT_ARMS)).values[:, : self.flat_robots]
        if runs:
            record = simulate(
                runs, duration=START + self.walked, timestep=self.timestep, sample_stride=5, progress=progress
            )
            cost = np.concatenate([cost, cost_of_transport(record).values.reshape(len(arms), -1)], axis=1)
        return xr.DataArray(
            cost,
            dims=("flat_arm", "robot_built"),
            coords={"flat_arm": list(FLAT_ARMS)},
            attrs={"units": "1", "long_name": "cost of transport on even ground of each robot that is built"},
        )

    @property
    def _pace(self) -> float:
        """Time scale of the robot over that of the article's robot, by Froude scaling [-]."""
        return self._size**0.5

    def _sample_time(self, seconds: float) -> float:
        """Return a time after the start, scaled with the body, at a sample of the record [s]."""
        sample = 5 * control_period(self.robot)
        return START + float(np.ceil(round(seconds * self._pace / sample, 6)) * sample)

    def _changes(self, progress: Any) -> xr.Dataset:
        """Return the tilt of the body during each transition between postures, and the distance walked afterwards."""
        pairs = list(permutations((self.crawl, self.semi_erect, self.high_walk), 2))[: self.transitions]
        bumps = self._bumps(0.03 * self._size, self.correlations[-1], 1)
        runs = [
            Run(
                robot=self.robot,
                gait=start_gait,
                control=Walking(attitude=AttitudeRule(), changes=(Change(at=START + self._pace, gait=end_gait),)),
                ground=Ground(relief=bumps if surface == "bumps" else None),
                label=f"{start_gait.name} to {end_gait.name}",
            )
            for start_gait, end_gait in pairs
            for surface in self.surfaces
        ]
        record = simulate(
            runs, duration=self._sample_time(6.0), timestep=self.timestep, sample_stride=5, progress=progress
        )
        max_tilts = _most_tilt(record).reshape(len(pairs), len(self.surfaces))
        final_distance = (
            displacement(record, self._sample_time(4.6)).sel(xyz="x").values.reshape(len(pairs), len(self.surfaces))
        )
        return xr.Dataset(
            {
                "change_tilt": (("change", "surface"), max_tilts, {"units": "rad"}),
                "change_after": (("change", "surface"), final_distance, {"units": "m"}),
            },
            coords={"change": [f"{a.name} to {b.name}" for a, b in pairs], "surface": list(self.surfaces)},
        )

    def _example(self, progress: Any) -> xr.Dataset:
        """Return three robots on one field of bumps, for the figure."""
        arms = self.arms()
        relief = self._shown_relief()
        runs = [
            Run(robot=self.robot, gait=arms[arm][0], control=arms[arm][1], ground=Ground(relief=relief), label=arm)
            for arm in ("low_crawl", "semi_erect", "high_walk_level")
        ]
        record = simulate(
            runs, duration=START + self.walked / 2, timestep=self.timestep, sample_stride=5, progress=progress
        )
        positions = np.arange(-1.2, 2.4, 0.01) * self._size
        profile_record = xr.Dataset(
            {"ground_height": ("along", profile(relief, positions), {"units": "m"})}, coords={"along": positions}
        )
        profile_record.along.attrs["units"] = "m"
        profile_record["shown_height"] = (
            (),
            self._shown_height,
            {"units": "m", "long_name": "of the bumps that are shown"},
        )
        return record.merge(profile_record)

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the postures on bumps, and the distance on every ground."""
        record = outcome.record
        posture_text = "the sprawled crawl, semi-erect legs, and erect legs with elbows behind and knees ahead"
        if not self.high_walk.erect:
            posture_text = "the robot's own gait low, as usual and high"
        return {
            **({"postures": draw_on_bumps(self.robot, record, posture_text)} if "shown_height" in record else {}),
            "rough_ground": draw_rough(record, GAIT_LINES),
        }


_UNITS = {"forward": "m", "aside": "m", "turned": "rad", "fell": "1", "cost": "1", "belly": "1", "met": "1"}


def _run_quantities(record: xr.Dataset, is_met: Sequence[bool], *, has_cost: bool) -> np.ndarray:
    """Return the quantities of ``_UNITS``, shape (run, quantity).

    Args:
        record: record of the runs.
        is_met: whether each robot reached the obstacle.
        has_cost: whether the record holds what the servos do.
    """
    excerpt, displacements = time_window(record), displacement(record)
    columns: Sequence[Any] = (
        displacements.sel(xyz="x"),
        displacements.sel(xyz="y"),
        heading_change(record),
        _most_tilt(record) > MAX_TILT,
        cost_of_transport(record) if has_cost else np.full(record.sizes["run"], nan),
        (excerpt.belly_force.sel(xyz="z").sum("segment") > _TOUCH * GRAVITY * record.mass).mean("time"),
        is_met,
    )
    return np.stack([np.asarray(column, dtype=float) for column in columns], axis=-1)


def _meets_obstacle(record: xr.Dataset, run: Run) -> bool:
    """Return whether a robot reached the obstacle in its path; True on even ground, which has none.

    Args:
        record: record of one run.
        run: the run.
    """
    robot_layout = layout(run.robot)
    relief, feet = run.ground.relief, record.foot_position.isel(leg=[0, 1]).sel(xyz="x")
    head, foot = robot_layout.robot.axis[0], robot_layout.limbs[0].girdle.limb.foot.radius
    match relief:
        case Bumps():
            return bool(feet.max() >= relief.start)
        case Step():
            return bool(feet.max() >= relief.at - foot - _CONTACT_DISTANCE * run.robot.length)
        case Stone():
            chest = float(record.snout.sel(xyz="x").max()) - (head.front + head.rear)
            pressed = bool((record.belly_force.sel(xyz="z").sum("segment") > _TOUCH * GRAVITY * run.robot.mass).any())
            return pressed or chest >= relief.at - 0.5 * relief.length
    return True


def _most_tilt(record: xr.Dataset) -> np.ndarray:
    angles = tilt(time_window(record))
    return np.maximum(abs(angles["roll"]).max("time").values, abs(angles["pitch"]).max("time").values)


def _flat(record: xr.Dataset) -> Measures:
    """Return what the crawl costs on even ground, of what the high walk costs, of robots as built."""
    crawl, high_walk = (record.flat_cost.sel(flat_arm=name, drop=True) for name in FLAT_ARMS)
    return estimated("flat_cost_ratio", crawl / high_walk, "-")


def _rough_measures(rough_record: xr.Dataset, record: xr.Dataset) -> Measures:
    """Return the fraction of rough grounds on which erect legs get farther; NaN if a robot did not reach its obstacle.

    Each seed of each kind and height is a ground of its own, and a robot of its own. Farther is in metres, and as a
    fraction of the same robot's displacement on even ground.

    Args:
        rough_record: record of the rough grounds.
        record: record of all grounds, the even one first.
    """
    met_fraction = (
        float(rough_record.met.sel(arm=list(_COMPARED_ARMS)).mean("seed").min())
        if rough_record.sizes["ground"]
        else 0.0
    )
    distances = rough_record.forward.stack(one=("ground", "seed"))
    crawl, erect, level = (distances.sel(arm=arm, drop=True) for arm in _STRUCTURE_ARMS)
    even_distances = record.forward.isel(ground=0, drop=True)
    kept = (rough_record.forward / even_distances).stack(one=("ground", "seed"))
    crawl_kept, erect_kept = (kept.sel(arm=arm, drop=True) for arm in FLAT_ARMS)
    is_judged, confidence = met_fraction >= 1.0, look_confidence(int(record.looks))
    semi_erect_measures = Measures()

    def share(name: str, is_ahead: xr.DataArray) -> Measures:
        return estimated_fraction(name, is_ahead if is_judged else [float("nan")], confidence=confidence)

    if "semi_erect" in rough_record.arm.values:
        semi = distances.sel(arm="semi_erect", drop=True)
        semi_erect_measures = share("semi_erect_ahead_of_both_share", (semi > level) & (semi > crawl))
    return Measures(
        {
            "met_judged": Measure(met_fraction, "-"),
            "rough_grounds": Measure(float(rough_record.sizes["ground"] * rough_record.sizes["seed"]), "-"),
        },
        share("erect_open_loop_ahead_share", erect > crawl),
        share("erect_open_loop_kept_share", erect_kept > crawl_kept),
        share("erect_ahead_share", level > crawl),
        semi_erect_measures,
    )


def _rough_grounds(record: xr.Dataset) -> xr.Dataset:
    """Return the part of a record on grounds of at least ``MIN_ROUGH_HEIGHT`` height."""
    return record.isel(
        ground=np.flatnonzero(
            record.height.values >= MIN_ROUGH_HEIGHT * float(record.size_of_robot) - _HEIGHT_TOLERANCE
        )
    )


def _falls(rough_record: xr.Dataset) -> Measures:
    """Return the number of falls of each condition on rough grounds."""
    fell = rough_record.fell.sum(("ground", "seed"))
    return Measures((f"falls_rough_{arm}", Measure(float(fell.sel(arm=arm)), "-")) for arm in rough_record.arm.values)


def _transitions(record: xr.Dataset) -> Measures:
    """Return the fraction of upright transitions, their greatest tilt, and the least distance walked after them."""
    return Measures(
        {
            "transitions": Measure(float(record.change_tilt.size), "-"),
            "transitions_upright": Measure(float((record.change_tilt < MAX_TILT).mean()), "-"),
            "transition_after_least": Measure(float(record.change_after.min()), "m"),
        },
        {
            f"transition_tilt_{surface}": Measure(float(record.change_tilt.sel(surface=surface).max()), "rad")
            for surface in record.surface.values
        },
        {"transition_tilt": Measure(float(record.change_tilt.max()), "rad")},
    )


def _switching(record: xr.Dataset) -> Measures:
    """Return how far the switching robot gets beside the best single posture, and how often it falls."""
    share = _share_of_best(record)
    low_grounds = record.isel(
        ground=np.flatnonzero(record.height.values <= 0.04 * float(record.size_of_robot) + _HEIGHT_TOLERANCE)
    )
    return Measures(
        {
            "switching_share_of_best_worst": Measure(float(share.min()), "-"),
            "switching_worst_height": Measure(float(record.height[int(share.argmin("ground"))]), "m"),
            "switching_grounds_within_5_percent": Measure(float((share >= 0.95).sum()), "-"),
            "switching_falls_up_to_40_mm": Measure(float(low_grounds.fell.sel(arm="switching").sum()), "-"),
        }
    )


def _share_of_best(record: xr.Dataset) -> xr.DataArray:
    """Return the displacement of the switching robot over that of the best single posture, by ground [-]."""
    distance = record.forward.mean("seed")
    return distance.sel(arm="switching", drop=True) / distance.sel(arm=list(SINGLE)).max("arm")


experiment = Terrain()
