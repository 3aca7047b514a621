"""Does it swim in, touch ground, stand and walk out, and go back into the water?"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import pi, radians, sin, tan
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from jaxtyping import Bool, Float

from suchus.core import rotation
from suchus.core.checks import Checks
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog._similar import similar
from suchus.experiments.catalog.shore.figure import draw_ashore, draw_decides
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
from suchus.robot.control import Amphibious, Control, DepthHold, HeadingHold, HeadingRule, OpenLoop, Swimming
from suchus.robot.design import GRAVITY, Robot
from suchus.robot.design.scale import control_period
from suchus.robot.design.water import Water
from suchus.robot.gaits import DRAFTED, GAITS, default_gait, suits
from suchus.robot.gaits.belly_crawl import LIMBS
from suchus.robot.motion import LIMBS_BACK, Gait, GaitInMetres, cycle_targets, draft_gait, straight_gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Lake, Run, Tolerances, simulate
from suchus.sim.land.afloat import check_floats, hovers
from suchus.sim.land.lake import up_direction
from suchus.sim.metrics import cycle_speeds, ground_force, mean_effort, settled_mean, swim_numbers
from suchus.sim.metrics.energy import METRES
from suchus.sim.model.hydrostatics import hydrostatics
from suchus.swimming.water import swim_of

_DRY_LEVEL, _DEEP_LEVEL = -10.0, 3.0
"""Levels of the water: far below dry land, and far above the ground [m]."""
_WADE = replace(
    GaitInMetres.from_gait(GAITS["semi_erect"], LIMBS), name="wade", period=1.6, duty_factor=0.5, stroke=0.05,
    hip_height=0.09, limb_phases=(0.0, 0.5, 0.5, 0.0), trunk_bend=0.0, tail_pitch=-0.1,
).gait(LIMBS)  # fmt: skip
"""A walk for feet that carry little weight. With a duty factor of a half the feet swing forward no faster than they
move back in stance, so that over a cycle the water pushes the robot back no more than forward; the slower the cycle,
the smaller the forces of the water are beside the friction of the ground. The tail is lifted, since pressed on the
ground it lifts the hind feet. The trunk is straight."""
_SAMPLE_INTERVAL, _PATH_INTERVAL = 4, 5
"""Control periods between two samples of a run, and samples of a run between two samples of a stored path [-]."""
MAX_TILT = np.radians(60)
"""Tilt of the body against gravity above which the robot has fallen [rad]."""
MAX_AFLOAT_LOAD = 0.01
"""Fraction of the weight on the ground below which the robot counts as afloat [-]."""
FINAL_DURATION = 2.0
"""Duration at the end over which the robot must be afloat to count as in the water [s]."""
_UNITS = {
    "ahead": ("m", "centre of mass beyond the water line, up the shore; less than 0 on the water's side"),
    "aside": ("m", "displacement of the centre of mass to the left"),
    "under": ("1", "volume under water over the whole volume"),
    "feet": ("1", "share of the weight that the feet carry"),
    "ground": ("1", "share of the weight that feet, belly and tail carry"),
    "walks": ("1", "1 where the limbs' phases advance, else 0"),
    "tilt": ("rad", "angle of the body's upward axis to the vertical"),
    "power": ("W", "power of all servos on the joints"),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Shore(Experiment):
    """The floating robot swims to a shore, feels ground, changes to its gait and walks out; and back into the water.

    It swims by the wave of (20) with its heading held, decides between swimming and walking by the load that feet,
    belly and tail carry, and lands with air let out in the gait ``wade``. It approaches obliquely, so that along its
    body the slope is less than that of the shore. Main runs: every slope with every friction scale, ``seeds`` times,
    each a robot that is built of the design, see ``land.Tolerances``. Beside them other gaits on every slope with one
    friction scale, other amounts of air let out on the steepest slope with every friction scale, and walks from land
    into the water on every slope. It has come ashore if its centre of mass is ``beyond`` the water line without
    falling; it is in the water if it swims at the end, floats free, and did not fall. The work per metre is measured
    in three more runs: the gait on level dry land, and the swim at the surface and at a constant depth.
    """

    title = "Does it swim in, touch ground, stand and walk out, and go back into the water?"
    shows = "Section I, whose robot is amphibious; beyond the article"
    answers = ("ashore_share", "time_ashore", "falls", "into_water_share", "speed_swimming", "speed_ashore")
    reproduces: ClassVar[bool] = False
    needs = ("limbs", "axis")
    answer_minima: ClassVar[Mapping[str, float]] = {"duration": 30.0, "seeds": 2}

    robot: Robot = field(default_factory=lambda: ROBOTS["floating_caiman"])
    """The robot; it must float."""
    gait: Gait = field(default_factory=lambda: GAITS["semi_erect"])
    """Gait in which it walks ashore."""
    wade: Gait = field(default_factory=lambda: _WADE)
    """Gait in which it lands, while the ground carries little of its weight."""
    approach: float = 0.85
    """Heading of the approach relative to straight up the shore, left positive [rad]; at 0.85 rad a slope of 15 degrees
    is 10 degrees along the body."""
    others: tuple[Gait, ...] = field(
        default_factory=lambda: tuple(GAITS[name] for name in ("belly_crawl", "low_crawl", "high_walk"))
    )
    """Other gaits in which it walks ashore, and in which it also lands."""
    slopes: tuple[float, ...] = (radians(5), radians(8), radians(12), radians(15))
    """Slopes of the shore [rad]."""
    friction_scales: tuple[float, ...] = (0.6, 0.75, 0.9, 1.0)
    """Factors on the friction of all the robot's surfaces [-]."""
    seeds: int = 2
    """Runs of each slope with each friction scale [-]."""
    tolerances: Tolerances = field(default_factory=Tolerances)
    """By how much the robots and their grounds differ from the design; the friction scale is that of the design."""
    air_released: float = 1.0
    """Share of the air of the hull that it lets out while it lands [-]."""
    other_air_released: tuple[float, ...] = (0.0, 0.5)
    """Other values of ``air_released``, simulated on the steepest slope [-]."""
    frequency: float = 1.0
    """Frequency of the swimming wave [Hz]."""
    clearance: float = 0.15
    """Depth of the water half a body length ahead of where it begins to swim [m]."""
    inland: float = 0.4
    """Distance from the beginning of the walk into the water to the water line [m]."""
    beyond: float = 1.0
    """Distance beyond the water line at which the centre of mass counts as ashore [m]."""
    duration: float = 50.0
    """Duration of every run to the shore or into the water [s]."""
    cycles: int = 16
    """Cycles of the gait over which the work per metre is measured, after as many cycles of settling [-]."""
    depth: float = 0.6
    """Depth of the root in the swim below the surface [m]."""
    timestep: float = 0.005
    """Time step of the physics [s]."""

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges."""
        with Checks(self.name(), self) as check:
            check.rising("slopes", 0.01, pi / 4, "rad")
            check.rising("friction_scales", 0.01, 10.0, "")
            check.whole("seeds", 1, 1000)
            check.number("air_released", 0.0, 1.0, "")
            check.number("approach", -1.2, 1.2, "rad")
            if self.other_air_released:
                check.rising("other_air_released", 0.0, 1.0, "")
            check.number("frequency", 0.05, 10.0, "Hz")
            check.number("clearance", 0.01, 10.0, "m")
            check.number("inland", 0.0, 100.0, "m")
            check.number("beyond", 0.0, 100.0, "m")
            check.number("duration", 0.2, 3600.0, "s")
            check.whole("cycles", 1, 1000)
            check.number("depth", 0.0, 100.0, "m")
            check.number("timestep", 1e-5, control_period(self.robot), "s")

    def quick(self) -> "Shore":
        """Return one slope with one friction scale, no other gaits, the first seconds."""
        smaller = replace(
            self, slopes=self.slopes[1:2], friction_scales=(1.0,), seeds=1, others=(), other_air_released=()
        )
        return replace(smaller, duration=2.0, cycles=1)

    def for_robot(self, robot: Robot) -> "Shore":
        """Return the same question for another robot; one without air lets none out."""
        variant = super(Shore, self).for_robot(robot)  # a class with slots has no short form
        aired = robot.hull is not None and robot.hull.air > 0.0
        return variant if aired else replace(variant, air_released=0.0, other_air_released=())

    def gaits_for_robot(self, robot: Robot) -> dict[str, Any]:
        """Return the gaits in which another robot walks ashore and lands: its own, or the first that can be steered."""
        walking_gait = default_gait(robot)
        if not walking_gait.has("steering"):
            candidates = (gait for gait in GAITS.values() if gait.has("steering") and gait.has("strokes"))
            walking_gait = next((gait for gait in candidates if suits(robot, gait)), None) or draft_gait(robot, DRAFTED)
        return {"gait": walking_gait, "wade": walking_gait, "others": ()}

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Simulate all runs as one batch: to the shore, with other gaits, with less air let out, and into the water."""
        check_floats(self.robot, Lake(level=_DEEP_LEVEL))
        cases = self._cases()
        runs = [run for _, _, run in cases]
        record = simulate(
            [self.tolerances.draw_run(run, run.seed) for run in runs],
            duration=self.duration,
            timestep=self.timestep,
            sample_stride=_SAMPLE_INTERVAL,
            progress=staged(progress, "runs to the shore", 0.0, 0.9),
        )
        case_paths = paths(record, runs, _PATH_INTERVAL)
        for name, values, unit in (
            ("kind", [kind for kind, _, _ in cases], "1"),
            ("walk", [run.gait.name for run in runs], "1"),
            ("slope", [abs(run.ground.uphill) for run in runs], "rad"),
            ("grip", [run.ground.friction_scale for run in runs], "1"),
            ("air_released", [air_fraction for _, air_fraction, _ in cases], "1"),
        ):
            case_paths[name] = ("case", np.array(values), {"units": unit})
        shown_index = self._shown_case_index(case_paths)
        back = cycle_targets(self.robot, straight_gait(self.robot, limbs=LIMBS_BACK), np.zeros(1))[0]
        floating = hydrostatics(self.robot, back, heel_count=3)
        metres = self._metres(staged(progress, "work per metre on land, at the surface and below", 0.9, 1.0))
        full_record = xr.merge(
            [record.isel(run=[shown_index]), case_paths, metres], combine_attrs="override", compat="no_conflicts"
        )
        full_record.attrs.update(
            record.attrs, beyond=self.beyond, shown=shown_index, line=water_line(runs[shown_index]),
            air_released=self.air_released, depth=self.depth, approach=self.approach,
            metacentric_height=floating.metacentric_height, length=self.robot.length, beat=self.frequency,
        )  # fmt: skip
        return SimulationResult(record=full_record, replays=self._replays(full_record))

    def _cases(self) -> list[tuple[str, float, Run]]:
        """Return kind, fraction of the air that is let out, and run of each case."""
        air_fraction = self.air_released
        cases: list[tuple[str, float, Run]] = []
        for slope in self.slopes:
            for scale in self.friction_scales:
                for _ in range(self.seeds):
                    cases.append(("ashore", air_fraction, self._run(self.gait, slope, scale, air_fraction, len(cases))))
        middle_scale = self.friction_scales[len(self.friction_scales) // 2]
        cases += [
            ("gait", air_fraction, self._run(gait, slope, middle_scale, air_fraction, 0))
            for gait in self.others
            for slope in self.slopes
        ]
        steepest_slope = self.slopes[-1]
        cases += [
            ("air", b, self._run(self.gait, steepest_slope, scale, b, 0))
            for b in self.other_air_released
            for scale in self.friction_scales
        ]
        ends = dict.fromkeys((self.friction_scales[0], self.friction_scales[-1]))
        cases += [
            ("into_water", air_fraction, self._run(self.gait, -slope, scale, air_fraction, 0))
            for slope in self.slopes
            for scale in ends
        ]
        return cases

    def _swim(self) -> Gait:
        return swim_of(self.robot, frequency=self.frequency)

    def _run(self, gait: Gait, uphill: float, scale: float, air_fraction: float, seed: int) -> Run:
        """Return a run up a shore from the water, or down into the water where ``uphill`` is negative.

        Args:
            gait: gait on land.
            uphill: slope ahead [rad].
            scale: factor on the friction of the robot's surfaces [-].
            air_fraction: fraction of the hull's air that is let out [-].
            seed: seed of the errors of the robot as built [-].
        """
        offshore = self.robot.length / 2 + self.clearance / tan(uphill) if uphill > 0 else self.inland
        course = self.approach if uphill > 0 else 0.0
        control = Amphibious(
            swim=self._swim(),
            swimming=Swimming(heading=HeadingHold(direction=course)),
            begins="swimming" if uphill > 0 else "walking",
            wade=self.wade if gait == self.gait else None,
            air_released=air_fraction,
            heading=HeadingRule(direction=course),
        )
        return Run(
            robot=self.robot,
            gait=gait,
            ground=Ground(uphill=uphill, friction_scale=scale),
            lake=Lake(level=offshore * sin(uphill)),
            control=control,
            seed=seed,
            label=f"{np.degrees(abs(uphill)):.0f} degrees, friction scale {scale:g}",
        )

    def _metres(self, progress: Progress) -> xr.Dataset:
        """Return speed and power of the servos on level dry land, at the surface and at depth."""
        level, deep_lake = Swimming(heading=HeadingHold()), Lake(level=max(_DEEP_LEVEL, 2.0 * self.robot.length))
        controls: dict[str, Control] = {"land": OpenLoop(), "surface": level}
        if hovers(self.robot, deep_lake):
            controls["deep"] = replace(level, depth=DepthHold(depth=self.depth))
        runs = [
            Run(robot=self.robot, gait=self.gait, lake=Lake(level=_DRY_LEVEL), control=control)
            if name == "land"
            else Run(robot=self.robot, gait=self._swim(), lake=deep_lake, control=control)
            for name, control in controls.items()
        ]
        duration = self.cycles * self.gait.period
        record = simulate(
            runs, duration=2 * duration, timestep=self.timestep, sample_stride=_SAMPLE_INTERVAL, progress=progress
        )
        means = [settled_mean(cycle_speeds(record.isel(run=i), self.gait.period)) for i in range(len(controls))]
        unsettled = [float(not (mean.is_settled and mean.start <= self.cycles)) for mean in means]
        return metres(record, list(controls), duration).assign(metre_unsettled=("where", unsettled, {"units": "1"}))

    def _shown_case_index(self, case_paths: xr.Dataset) -> int:
        """Return the index of the case that is drawn: on the second slope with the greatest friction scale."""
        main = case_paths.kind.values == "ashore"
        slope = self.slopes[min(1, len(self.slopes) - 1)]
        is_candidate = (
            main & np.isclose(case_paths.slope, slope) & np.isclose(case_paths.grip, self.friction_scales[-1])
        )
        return int(np.flatnonzero(is_candidate)[0])

    def _replays(self, record: xr.Dataset) -> Mapping[str, Replay]:
        """Return the replay of the case that is drawn, by file name."""
        end = ending(record)
        return replayed(
            "shore_replay.html",
            record.isel(run=0),
            self.robot,
            title="From the water onto the shore",
            caption=f"It swims to the shore with its limbs held back; {end}. Seen in the frame of the shore.",
        )

    def measure(self, record: xr.Dataset) -> Measures:
        """Return how many runs come ashore and when, by gait and by air let out, the falls, and the work per metre."""
        kind = record.kind.values
        times, has_fallen, has_capsized = times_ashore(record), find_fallen(record), find_capsized(record)
        main, is_into_water = kind == "ashore", kind == "into_water"
        ashore = times[main][np.isfinite(times[main])]
        slope, grip = record.slope.values, record.grip.values
        is_steepest = main & np.isclose(slope, slope[main].max())
        measures = Measures(
            {
                "ashore_share": Measure(_share(times, main), "-"),
                "falls": Measure(float(has_fallen[main].sum()), "-"),
                "capsized": Measure(float(has_capsized[main].sum()), "-"),
                "metacentric_height": Measure(record.attrs["metacentric_height"], "m"),
                "switches": Measure(float(record.switches.values[main].max()), "-"),
                "time_ashore": Measure(float(np.median(ashore)) if ashore.size else float("nan"), "s"),
                "time_ashore_longest": Measure(float(ashore.max()) if ashore.size else float("nan"), "s"),
                "into_water_share": Measure(float(in_water(record)[is_into_water].mean()), "-"),
                "falls_into_water": Measure(float(has_fallen[is_into_water].sum()), "-"),
                "switches_into_water": Measure(float(record.switches.values[is_into_water].max()), "-"),
                "ashore_share_steepest": Measure(_share(times, is_steepest), "-"),
                "ashore_share_least_grip": Measure(_share(times, main & np.isclose(grip, grip[main].min())), "-"),
                "ashore_share_most_grip": Measure(_share(times, main & np.isclose(grip, grip[main].max())), "-"),
            }
        )
        for i, air_fraction in enumerate(np.unique(record.air_released.values[(kind == "air") | is_steepest])):
            case_mask = ((kind == "air") | is_steepest) & (record.air_released.values == air_fraction)
            measures[f"air_released_{i}"] = Measure(float(air_fraction), "-")
            measures[f"ashore_share_air_released_{i}"] = Measure(_share(times, case_mask), "-")
        middle = float(record.grip.values[kind == "gait"].mean()) if (kind == "gait").any() else 0.0
        for name in np.unique(record.walk.values[(kind == "gait") | main]):
            case_mask = (kind == "gait") & (record.walk.values == name)
            if not case_mask.any():
                case_mask = main & np.isclose(grip, middle)
            if case_mask.any():
                measures[f"ashore_share_{name}"] = Measure(_share(times, case_mask), "-")
        return measures | _costs(record.isel(case=np.flatnonzero(main))) | _metre_costs(record)

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say how many runs came ashore, what this depends on, and the work per metre."""
        dependency_names = ("steepest", "least_grip", "most_grip", "air_released")
        names = [name.removeprefix("ashore_share_") for name in measures if name.startswith("ashore_share_")]
        metres = {ending: label for ending, label in METRES.items() if f"work_per_metre_{ending}" in measures}
        return self.render_explanation(
            measures, metres=metres, gaits=[name for name in names if not name.startswith(dependency_names)]
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw one run out of the water from the side, and how the time ashore depends on slope, friction and air."""
        return {"ashore": draw_ashore(self.robot, outcome.record), "decides": draw_decides(outcome.record)}


def paths(record: xr.Dataset, runs: list[Run], interval: int) -> xr.Dataset:
    """Return the downsampled path of each run, and its number of changes between swimming and walking.

    Args:
        record: record of the runs.
        runs: runs on even slopes in lakes of constant level.
        interval: number of samples of which one is kept; powers and shares are means over them.
    """
    ups = np.array([up_direction(run.ground) for run in runs])
    line = np.array([water_line(run) for run in runs])
    ashore = np.sign([run.ground.uphill for run in runs])  # whether the land is ahead of the line or behind it
    shares = _ground_share(record, ups)
    walks = walking(record.limb_phase.isel(leg=0).values)
    body_up = rotation.rotate(record.orientation.values, np.array([0.0, 0.0, 1.0]))
    values = {
        "ahead": ashore[:, None] * (record.centre_of_mass.sel(xyz="x").values - line[:, None]),
        "aside": record.centre_of_mass.sel(xyz="y").values,
        "under": record.share_under.values,
        "feet": record.feet_share.values,
        "ground": shares,
        "walks": walks.astype(float),
        "tilt": np.arccos(np.clip(np.einsum("rti,ri->rt", body_up, ups), -1.0, 1.0)),
        "power": record.servo_power.sum("servo", skipna=False).values,
    }
    means = ("feet", "ground", "power")
    count = record.sizes["time"] // interval
    blocks = {name: value[:, : count * interval].reshape(len(runs), count, interval) for name, value in values.items()}
    reduced = {name: value.mean(axis=-1) if name in means else value[..., 0] for name, value in blocks.items()}
    path_record = xr.Dataset(
        {name: (("case", "moment"), reduced[name], {"units": unit, "long_name": label})
         for name, (unit, label) in _UNITS.items()},
        coords={"moment": ("moment", record.time.values[: count * interval : interval], {"units": "s"})},
    )  # fmt: skip
    changes = np.diff(walks[:, 1:].astype(int), axis=1) != 0
    path_record["switches"] = ("case", changes.sum(axis=1), {"units": "1"})
    path_record["weight"] = ("case", GRAVITY * record.mass.values, {"units": "N"})
    return path_record


def water_line(run: Run) -> float:
    """Return the distance from the robot's beginning to where the surface meets the slope [m]."""
    assert run.lake is not None
    return run.lake.shore(run.ground.uphill)


def walking(phase: Float[np.ndarray, "run time"]) -> Bool[np.ndarray, "run time"]:
    """Return at which samples a limb's phase advances; the first sample has the value of the second."""
    moves = np.diff(phase, axis=1) > 1e-9
    return np.concatenate([moves[:, :1], moves], axis=1)


def _ground_share(record: xr.Dataset, ups: np.ndarray) -> np.ndarray:
    force = ground_force(record).transpose("run", "time", "xyz").values
    return np.asarray(np.einsum("rti,ri->rt", force, ups) / (GRAVITY * record.mass.values[:, None]))


def find_fallen(record: xr.Dataset) -> Bool[np.ndarray, " case"]:
    """Return which cases tilted by more than ``MAX_TILT``, or diverged."""
    return np.asarray(~(record.tilt < MAX_TILT).all("moment").values)


def find_capsized(record: xr.Dataset) -> Bool[np.ndarray, " case"]:
    """Return which cases first tilted by more than ``MAX_TILT`` while they swam and were afloat."""
    is_over_tilt = ~(record.tilt < MAX_TILT)
    free = (record.walks == 0.0) & (record.ground < MAX_AFLOAT_LOAD)
    first_index = is_over_tilt.argmax("moment")
    return np.asarray((is_over_tilt.any("moment") & free.isel(moment=first_index)).values)


def times_ashore(record: xr.Dataset) -> Float[np.ndarray, " case"]:
    """Return the time at which each case was first ashore, NaN for one that never was or fell [s]."""
    is_ashore = record.ahead.values >= record.attrs["beyond"]
    first_time = record.moment.values[is_ashore.argmax(axis=1)]
    return np.where(is_ashore.any(axis=1) & ~find_fallen(record), first_time, np.nan)


def ending(record: xr.Dataset) -> str:
    """Return the end of the case that is drawn, in words."""
    case = record.isel(case=[record.attrs["shown"]])
    is_walking, phrases = case.walks.values[0] > 0, []
    if find_capsized(case)[0]:
        first_index = int((~(case.tilt < MAX_TILT)).values[0].argmax())
        return f"after {float(case.moment[first_index]):.2g} s it capsizes"
    if is_walking.any():
        phrases.append(f"after {float(case.moment[is_walking.argmax()]):.0f} s it walks")
    else:
        phrases.append("it does not begin to walk")
    time = float(times_ashore(case)[0])
    if np.isfinite(time):
        phrases.append(f"after {time:.0f} s it is {record.attrs['beyond']:g} m beyond the water line")
    elif find_fallen(case)[0]:
        phrases.append("it falls")
    else:
        phrases.append(f"it does not get {record.attrs['beyond']:g} m beyond the water line")
    return ", and ".join(phrases)


def in_water(record: xr.Dataset) -> Bool[np.ndarray, " case"]:
    """Return which cases swim afloat on the water's side of the line for the last ``FINAL_DURATION`` seconds."""
    end = record.sel(moment=slice(float(record.moment[-1]) - FINAL_DURATION, None))
    free = (end.ground.mean("moment") < MAX_AFLOAT_LOAD) & (end.walks.max("moment") == 0.0)
    return np.asarray((free & (end.ahead < 0).all("moment")).values) & ~find_fallen(record)


def _share(times: np.ndarray, mask: np.ndarray) -> float:
    return float(np.isfinite(times[mask]).mean())


def metres(record: xr.Dataset, names: Sequence[str], duration: float) -> xr.Dataset:
    """Return speed along its course, power of the servos and error of the depth of each run, over its last seconds.

    Args:
        record: record with one run for each name.
        names: names of the conditions, in the order of the runs.
        duration: duration of the end that is measured [s].
    """
    excerpt = record.sel(time=slice(float(record.time[-1]) - duration - 1e-9, None))
    displacement_xy = (excerpt.centre_of_mass.isel(time=-1) - excerpt.centre_of_mass.isel(time=0)).sel(xyz=["x", "y"])
    displacements = displacement_xy.transpose("run", "xyz").values
    lateral_axes = np.stack([-displacements[:, 1], displacements[:, 0]], axis=-1) / np.maximum(
        np.linalg.norm(displacements, axis=-1, keepdims=True), 1e-12
    )
    tip = (excerpt.tail_tip - excerpt.centre_of_mass).sel(xyz=["x", "y"]).transpose("run", "time", "xyz").values
    depth = (excerpt.water_level - excerpt.position.sel(xyz="z")).mean("time")
    return xr.Dataset(
        {
            "metre_speed": (
                "where",
                np.hypot(*displacement_xy.transpose("xyz", "run").values) / duration,
                {"units": "m/s"},
            ),
            "metre_power": ("where", mean_effort(excerpt, "servo_power", 0.0).sum("servo").values, {"units": "W"}),
            "metre_depth": ("where", depth.values, {"units": "m"}),
            "metre_swing": ("where", np.ptp(np.einsum("rti,ri->rt", tip, lateral_axes), axis=1), {"units": "m"}),
            "metre_weight": ("where", GRAVITY * record.mass.values, {"units": "N"}),
        },
        coords={"where": list(names)},
    )


def _metre_costs(record: xr.Dataset) -> Measures:
    """Return speed, work over distance and cost of transport on land, at the surface and at depth."""
    measures = Measures()
    for condition in record["where"].values:
        condition_record = record.sel(where=condition)
        speed, work = (
            float(condition_record.metre_speed),
            float(condition_record.metre_power / condition_record.metre_speed),
        )
        measures[f"speed_{condition}"] = Measure(speed, "m/s")
        if condition != "land" and "metre_unsettled" in condition_record:
            measures[f"unsettled_{condition}"] = Measure(float(condition_record.metre_unsettled), "-")
        measures[f"work_per_metre_{condition}"] = Measure(work, "J/m")
        measures[f"net_cost_of_transport_{condition}"] = Measure(work / float(condition_record.metre_weight), "-")
        if condition != "land":
            numbers = swim_numbers(
                speed=speed, length=record.attrs["length"], frequency=record.attrs["beat"],
                swing=float(condition_record.metre_swing), viscosity=Water().viscosity,
            )  # fmt: skip
            measures |= similar(numbers, f"_{condition}")
    if "deep" not in record["where"].values:
        return measures
    error = abs(float(record.metre_depth.sel(where="deep")) - record.attrs["depth"])
    return measures | {"depth_error": Measure(error, "m")}


def _costs(record: xr.Dataset) -> Measures:
    """Return speed [m/s] and servo work over distance [J/m] while the robot swims, wades and walks ashore.

    Both are measured along the heading of the approach.
    """
    step, course = float(record.moment[1] - record.moment[0]), record.attrs["approach"]
    course_distance = np.cos(course) * record.ahead.values + np.sin(course) * record.aside.values
    speed = np.gradient(course_distance, step, axis=1)
    walks, submerged_fraction = record.walks.values > 0, record.under.values
    is_settled = (record.moment.values > 3.0)[None, :]
    measures = Measures()
    for name, mask in (
        ("swimming", ~walks & is_settled & (record.ground.values < MAX_AFLOAT_LOAD)),
        ("wading", walks & (submerged_fraction > 0.05)),
        ("ashore", walks & (submerged_fraction <= 0.0)),
    ):
        course_speed, power = speed[mask], record.power.values[mask]
        mean = float(course_speed.mean()) if course_speed.size else float("nan")
        measures[f"speed_{name}"] = Measure(mean, "m/s")
        measures[f"work_per_metre_{name}"] = Measure(
            float(power.mean()) / mean if course_speed.size else float("nan"), "J/m"
        )
    return measures


experiment = Shore()
