"""How high does the robot reach when it crawls, and when it stands on hind legs and tail?"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.article.paper import CLAIMS
from suchus.core.checks import Checks
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog.bipedal_reach.figure import (
    draw_angles,
    draw_ceiling,
    draw_heights,
    draw_limits,
    draw_pushes,
    draw_side_views,
)
from suchus.experiments.catalog.bipedal_reach.variants import (
    PARTS,
    fit_gait_to_legs,
    length,
    stand_control,
    upright_time,
    with_forebody,
    with_length,
)
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
    silent,
    staged,
)
from suchus.robot.control import OpenLoop
from suchus.robot.control.standing import BALANCE, Balance, Standing
from suchus.robot.design import STANDING, Robot
from suchus.robot.design.scale import control_period, rescale
from suchus.robot.gaits import GAITS
from suchus.robot.motion import START, Gait, hip_height
from suchus.robot.motion.rising import LEAD, cantilever_torque, max_snout_height, size_of, stretched_length
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, Tolerances, simulate
from suchus.sim.land.push_search import smallest_pushes
from suchus.sim.metrics import lead, longest_hold, peak_torque, reach, static_margin

_COARSE_TIMESTEP = 0.005  # [s]; time step of sweeps; reach and limits agree with those at 2 ms
_STANDING_FRACTION = 0.6  # [stretched length]; a robot with less reach has not stood up, or has fallen
_DIRECTIONS = {"fore": (1.0, 0.0, 0.0), "aft": (-1.0, 0.0, 0.0), "lateral": (0.0, 1.0, 0.0)}
_LIFTED_FRACTION = 0.37
"""Fraction of the stretched length from which the reach shows that the front has left the ground [-].

The reach of a robot that lies or crawls is a fifth of this length. With the trunk bent up it is two fifths or more.
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class BipedalReach(Experiment):
    """From the crawl to standing on hind legs and tail, and back into the crawl.

    The reach is the height of the highest point of head and trunk; legs and tail do not count. For the crawl the
    maximum over a cycle counts, for standing the minimum during the stand. Pushes act on the thorax for 0.2 s.
    """

    title = "How high does it reach, crawling and standing on two legs?"
    shows = "Section IV.D, Figs 22 to 24"
    answers = ("reach_crawl", "reach_standing", "reach_ratio", "held_share", "push_lateral_on")
    needs = ("tables", *STANDING)
    judged_settings = ("robot", "gait", "balance", "least")
    judged_minima: ClassVar[Mapping[str, float]] = {"hold": 10.0, "repeats": 6, "hips": 3}
    answer_minima: ClassVar[Mapping[str, float]] = {"hold": 10.0, "repeats": 6}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that stands up."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The crawl before and after."""
    straight: Gait = field(default_factory=lambda: GAITS["limbs_only"])
    """Gait from whose first posture it stands up in the sweeps. Its trunk is straight, so the pushes act along the
    body."""
    balance: Balance = BALANCE
    """Feedback rule that keeps the balance of the stand."""
    hold: float = 60.0
    """Duration of standing [s]."""
    least: float = 0.64
    """Smallest reach that counts as standing [m]; an earlier study of this robot reached it."""
    repeats: int = 6
    """Number of robots built of the design that stand up; the heights are their medians [-]."""
    tolerances: Tolerances = field(default_factory=Tolerances)
    """Tolerances of the robots built of the design, and of their grounds."""
    torques: tuple[float, ...] = (2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0)
    """Torques of the trunk's pitch servos on the map [N m]."""
    forebodies: tuple[float, ...] = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
    """Masses of thorax and head together on the map [kg]; the pelvis takes up the difference."""
    hips: tuple[float, ...] = (0.07, 0.09, 0.11, 0.125, 0.135)
    """Hip heights of the crawls that vary the legs' height [m]; the last one is near the limit of the legs."""
    leads: tuple[float, ...] = (0.015, 0.025, 0.035)
    """Further commanded distances of the centre of mass behind the feet, which show how much height a safe stand
    costs [m]."""
    pushes: tuple[float, ...] = (1.0, 2.0, 4.0, 6.0, 8.0, 11.0, 14.0, 17.0, 20.0)
    """Forces of the first pass; the second pass refines between two of them; empty for no pushes [N]."""
    finer: int = 4
    """Number of forces of the second pass [-]."""
    wait: float = 3.0
    """Duration without a push before and after each push [s]; a fall takes less than 2 s."""
    timestep: float = 0.002
    """Time step of the physics in the run of the figures [s]; sweeps take 5 ms."""
    longer: float = 0.05
    """Fraction by which legs, spine and head are lengthened, one after another [-]."""
    extent: Extent = "whole"
    """How much is simulated: without pushes, the map of torque and mass, robots without feedback and the greatest reach
    of any posture for the verdicts."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.number("hold", 0.1, 3600.0, "s")
            check.number("least", 0.001, 100.0, "m")
            check.whole("repeats", 1, 1000)
            check.whole("finer", 0, 100)
            check.that(len(self.hips) > 1, f"{self.name()}.hips has {len(self.hips)} heights; two at least are needed")
            check.number("wait", 0.01, 60.0, "s")
            check.number("timestep", 1e-5, control_period(self.robot), "s")
            check.number("longer", 0.001, 0.2, "")

    def for_verdicts(self) -> "BipedalReach":
        """Return the same question without pushes, the map of torque and mass and robots without feedback.

        The stand is shorter: the article does not say for how long the robot stands.
        """
        return replace(self, hold=min(self.hold, self.judged_minima["hold"]), extent="verdicts")

    def quick(self) -> "BipedalReach":
        """A short stand, the corners of the map, few pushes."""
        return replace(
            self,
            hold=1.0,
            repeats=1,
            torques=(2.0, 5.0),
            forebodies=(0.4, 0.9),
            hips=(0.09, 0.125),
            leads=(),
            pushes=(2.0, 25.0),
            finer=0,
            wait=1.5,
            timestep=_COARSE_TIMESTEP,
        )

    def gaits_for_robot(self, robot: Robot) -> dict[str, Any]:
        """Return the gaits of a robot of another size, and the balance rule in that size."""
        return Experiment.gaits_for_robot(self, robot) | {
            "balance": rescale(self.balance, length_factor=size_of(robot) / size_of(self.robot))
        }

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Simulate crawling, standing and sitting down; then map the limits, push the robot, and vary its lengths."""
        standing = Standing(at=START + self.gait.period, hold=self.hold, balance=self.balance)
        record = self._standing_record(standing, staged(progress, "standing", 0.0, 0.2))
        if self.extent == "whole":
            record = record.merge(self._limits(staged(progress, "torque and mass", 0.2, 0.4)))
            record = record.merge(self._toppling_pushes(staged(progress, "pushes", 0.4, 0.85)))
            record = record.merge(self._ceiling())
        record = record.merge(self._lengths(staged(progress, "lengths", 0.85, 1.0)))
        record = record.assign_attrs(self._reference_values())
        return SimulationResult(record=record, replays=self._replays(record))

    def _reference_values(self) -> dict[str, float]:
        """Return the numbers that the measures compare with: lengths [m], torques [N m] and times [s]."""
        plausible = {parameter.field: parameter.high for parameter in GAITS.beside("belly_crawl", "chosen", ())}
        return {
            "least": self.least,
            "hold": self.hold,
            "stretched": stretched_length(self.robot),
            "cantilever": cantilever_torque(self.robot),
            "pitch_torque": self.robot.spine.pitch_servo.torque,
            "hip_height": hip_height(self.robot, self.gait),
            "hip_height_plausible": plausible["height"] * length(self.robot, "leg"),
            "up": _STANDING_FRACTION * stretched_length(self.robot),
            "commanded_lead": self._lead,
        }

    @property
    def _lead(self) -> float:
        """Commanded distance of the centre of mass behind the feet, unless a study sets another one [m]."""
        return LEAD * size_of(self.robot)

    def measure(self, record: xr.Dataset) -> Measures:
        """Return the heights with their spread, the toppling pushes, the torques, and the effect of the lengths."""
        _, rise_time, upright_time, leave_time, down_time, _ = record.attrs["stages"]
        facts, height, margin = record.attrs, record.reach.isel(run=0), record.margin.isel(run=0)
        highest_crawl = int(np.argmax(record.crawl_reach.values))
        measures = Measures(
            _heights(record),
            {
                "margin_standing": Measure(float(margin.sel(time=slice(upright_time, leave_time)).min()), "m"),
                "margin_rising": Measure(min_lead(record), "m"),
                "reach_after": Measure(float(height.sel(time=slice(down_time, None)).max()), "m"),
                "way_after": Measure(_forward_displacement(record.centre_of_mass.isel(run=0), down_time), "m"),
                "stretched_length": Measure(facts["stretched"], "m"),
                **_of_any_posture(record),
                "reach_high_crawl": Measure(float(record.crawl_reach[highest_crawl]), "m"),
                "distance_high_crawl": Measure(float(record.crawl_way[highest_crawl]), "m"),
                "hip_height": Measure(facts["hip_height"], "m"),
                "hip_height_plausible": Measure(facts["hip_height_plausible"], "m"),
                "cantilever_torque": Measure(facts["cantilever"], "N m"),
                "pitch_torque": Measure(facts["pitch_torque"], "N m"),
                **_of_the_map(record),
            },
        )
        for name, torque in zip(
            record.servo.values, peak_torque(record.isel(run=0), rise_time, leave_time).values, strict=True
        ):
            measures[f"torque_rising_{name}"] = Measure(float(torque), "N m")
        return measures | _pushes(record) | _gains(record)

    def _replays(self, record: xr.Dataset) -> Mapping[str, Replay]:
        """Return the replay of the run of the figures, by file name."""
        return replayed(
            "standing_replay.html",
            record,
            self.robot,
            labels=("standing up",),
            title="Standing up",
            caption="From the crawl up on hind legs and tail, and down again into the crawl.",
        )

    def _standing_record(self, standing: Standing, progress: Any) -> xr.Dataset:
        """Simulate the run of the figures, and its repeats with and without feedback.

        Args:
            standing: control that lets the robot stand up, hold the stand and sit down.
            progress: callback that gets the finished fraction.

        Returns:
            The record of the run, with ``repeat_reach`` (feedback, repeat, repeat_time) [m] and the stage times [s].
            For the verdicts there are repeats with feedback alone.
        """
        duration = standing.down_from(self.robot) + self.gait.period
        run = Run(robot=self.robot, gait=self.gait, control=standing)
        record = simulate(
            [run], duration=duration, timestep=self.timestep, sample_stride=2, progress=staged(progress, "", 0.0, 0.5)
        )
        by_feedback = {"on": run, "off": replace(run, control=replace(standing, balance=None))}
        if self.extent == "verdicts":
            del by_feedback["off"]
        repeats = simulate(
            self.tolerances.repeats(by_feedback.values(), self.repeats),
            duration=duration,
            timestep=_COARSE_TIMESTEP,
            sample_stride=10,
            effort=False,
            progress=staged(progress, "", 0.5, 1.0),
        )
        heights = reach(self.robot, repeats).values.reshape(len(by_feedback), self.repeats, -1)
        record = record.assign(reach=reach(self.robot, record), margin=static_margin(record), lead=lead(record))
        data = record.assign(
            {"repeat_reach": (("feedback", "repeat", "repeat_time"), heights, {"units": "m"})}
        ).assign_coords(feedback=[*by_feedback], repeat_time=("repeat_time", repeats.time.values, {"units": "s"}))
        stages = (START, standing.at, standing.upright_from(self.robot), standing.upright_until(self.robot))
        data.attrs["stages"] = [*stages, standing.down_from(self.robot), duration]
        return data

    def _stand_results(self, robots: Sequence[Robot], leads: Sequence[float], progress: Any) -> xr.Dataset:
        """Return reach and lead of each robot once it stands [m]; zero where its joints cannot take the postures.

        Args:
            robots: robots that stand up, one per case.
            leads: commanded distance of the centre of mass behind the feet, one per case [m].
            progress: callback that gets the finished fraction.
        """
        controls = [
            stand_control(*variant, self.balance, size_of(self.robot)) for variant in zip(robots, leads, strict=True)
        ]
        is_feasible = [control is not None for control in controls]
        results = {name: np.zeros(len(is_feasible)) for name in ("reach", "lead")}
        runs = [
            Run(robot=robot, gait=self.straight, control=control)
            for robot, control in zip(robots, controls, strict=True)
            if control is not None
        ]
        if not runs:
            return xr.Dataset({name: ("case", values, {"units": "m"}) for name, values in results.items()})
        duration = (
            max(upright_time(robot) for robot, feasible in zip(robots, is_feasible, strict=True) if feasible)
            + self.wait
        )
        record = simulate(
            runs, duration=duration, timestep=_COARSE_TIMESTEP, sample_stride=10, effort=False, progress=progress
        )
        final_interval = record.sel(time=slice(duration - 0.5, None))
        for i, case in enumerate(np.flatnonzero(is_feasible)):
            final_record = final_interval.isel(run=i)
            results["reach"][case] = float(reach(runs[i].robot, final_record).min())
            results["lead"][case] = float(lead(final_record).mean())
        return xr.Dataset({name: ("case", values, {"units": "m"}) for name, values in results.items()})

    def _limits(self, progress: Any) -> xr.Dataset:
        """Return the reach over the torque of the trunk's servos and the mass of the forebody."""
        cells = [with_forebody(self.robot, mass, torque) for torque in self.torques for mass in self.forebodies]
        stand_results = self._stand_results(cells, [self._lead] * len(cells), progress)
        shape = len(self.torques), len(self.forebodies)
        cantilever = [cantilever_torque(with_forebody(self.robot, mass, 1.0)) for mass in self.forebodies]
        data = xr.Dataset(
            {
                "map_reach": (("torque", "forebody"), stand_results.reach.values.reshape(shape), {"units": "m"}),
                "map_cantilever": ("forebody", cantilever, {"units": "N m"}),
            },
            coords={"torque": list(self.torques), "forebody": list(self.forebodies)},
        )
        data.torque.attrs.update(units="N m", long_name="torque of the trunk's pitch servos")
        data.forebody.attrs.update(units="kg", long_name="mass of thorax and head")
        return data

    def _toppling_pushes(self, progress: Any) -> xr.Dataset:
        """Return the smallest forces that topple the robot, with feedback and without, over the commanded lead [N].

        Beside them are the reach and the lead of each stand [m]; of no pushes these alone.
        """
        leads = sorted({*self.leads, self._lead})
        balances = {"on": self.balance, "off": None}
        stand_results = self._stand_results([self.robot] * len(leads), leads, staged(progress, "", 0.0, 0.1))
        stands = stand_results.reach.values > _STANDING_FRACTION * stretched_length(self.robot)
        stand_record = xr.Dataset(
            {
                "lead_reach": ("commanded", np.where(stands, stand_results.reach, np.nan), {"units": "m"}),
                "lead_found": ("commanded", np.where(stands, stand_results.lead, np.nan), {"units": "m"}),
            },
            coords={"commanded": leads},
        )
        if not self.pushes:
            return stand_record
        runs = [
            Run(robot=self.robot, gait=self.straight, control=control or OpenLoop())
            for balance in balances.values()
            for control in (stand_control(self.robot, lead, balance, size_of(self.robot)) for lead in leads)
        ]
        forces = smallest_pushes(
            runs,
            list(_DIRECTIONS.values()),
            start_time=round(upright_time(self.robot) + self.wait, 2),
            levels=self.pushes,
            refinement_count=self.finer,
            wait=self.wait,
            has_fallen=lambda record: (
                record.snout.sel(xyz="z").isel(time=-1) < _STANDING_FRACTION * stretched_length(self.robot)
            ),
            timestep=_COARSE_TIMESTEP,
            progress=staged(progress, "", 0.1, 1.0),
        ).reshape(len(balances), len(leads), len(_DIRECTIONS))
        forces = np.where(stands[:, None], forces, 0.0)
        return stand_record.assign(push=(("feedback", "commanded", "direction"), forces, {"units": "N"})).assign_coords(
            direction=list(_DIRECTIONS), feedback=list(balances)
        )

    def _lengths(self, progress: Any) -> xr.Dataset:
        """Return the reach of crawls over the hip height, and the gain of reach per added length of each body part."""
        robots = [self.robot, *(with_length(self.robot, body_part, 1 + self.longer) for body_part in PARTS)]
        stand_results = self._stand_results(robots, [self._lead] * len(robots), staged(progress, "", 0.0, 0.5))
        leg = length(self.robot, "leg")
        crawls = [(self.robot, self.gait.with_numbers(height=hips / leg)) for hips in self.hips]
        crawls += [(robot, fit_gait_to_legs(self.gait, robot, self.robot)) for robot in robots]
        runs = [Run(robot=robot, gait=gait) for robot, gait in crawls]
        record = simulate(
            runs,
            duration=START + self.gait.period,
            timestep=_COARSE_TIMESTEP,
            sample_stride=5,
            effort=False,
            progress=staged(progress, "", 0.5, 1.0),
        ).sel(time=slice(START, None))
        heights = np.array([float(reach(robot, record.isel(run=i)).max()) for i, (robot, _) in enumerate(crawls)])
        crawl_heights = heights[len(self.hips) :]
        length_increases = np.array(
            [
                length(robot, body_part) - length(self.robot, body_part)
                for robot, body_part in zip(robots[1:], PARTS, strict=True)
            ]
        )
        changes = np.stack(
            [crawl_heights[1:] - crawl_heights[0], stand_results.reach.values[1:] - stand_results.reach.values[0]],
            axis=-1,
        )
        com_x = record.centre_of_mass.sel(xyz="x")
        return xr.Dataset(
            {
                "crawl_reach": ("hip_height", heights[: len(self.hips)], {"units": "m"}),
                "crawl_way": (
                    "hip_height",
                    (com_x[: len(self.hips), -1] - com_x[: len(self.hips), 0]).values,
                    {"units": "m"},
                ),
                "gain": (("part", "pose"), changes / length_increases[:, None], {"units": "1"}),
            },
            coords={"hip_height": list(self.hips), "part": list(PARTS), "pose": ["crawling", "standing"]},
        )

    def _ceiling(self) -> xr.Dataset:
        """Return the greatest reach of any posture over the distance of the centre of mass behind the feet [m]."""
        leads = size_of(self.robot) * np.linspace(0.0, 0.1, 11)
        return xr.Dataset(
            {"ceiling": ("behind", max_snout_height(self.robot, leads), {"units": "m"})},
            coords={"behind": ("behind", leads, {"units": "m"})},
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw postures, angles and heights over time, and what decides them."""
        record, min_reach = outcome.record, _STANDING_FRACTION * stretched_length(self.robot)
        return {
            "side_views": draw_side_views(self.robot, record),
            "angles": draw_angles(self.robot, record),
            "height_over_time": draw_heights(record, self.hold),
            **({"torque_and_mass": draw_limits(self.robot, record, min_reach)} if "map_reach" in record else {}),
            **({"ceiling": draw_ceiling(self.robot, record)} if "ceiling" in record else {}),
            **({"pushes": draw_pushes(record, record.attrs["commanded_lead"])} if "push" in record else {}),
        }


def _heights(record: xr.Dataset) -> Measures:
    """Return reach when crawling and when standing, their ratio, and the duration of the stand, as built."""
    start, rise_time, upright_time, leave_time, _, _ = record.attrs["stages"]
    heights = record.repeat_reach.sel(feedback="on").rename(repeat_time="time")
    crawl = heights.sel(time=slice(start, rise_time)).max("time")
    stand = heights.sel(time=slice(upright_time, leave_time)).min("time")
    standing_time = longest_hold(heights, record.attrs["least"])
    return (
        estimated("reach_crawl", crawl, "m")
        | estimated(
            "hips_at_printed_height",
            _required_hip_height(record, CLAIMS["height_crawl"].value or 0.0, crawl.values),
            "m",
        )
        | estimated("reach_standing", stand, "m")
        | estimated("reach_ratio", stand / crawl, "-")
        | estimated("held", standing_time, "s")
        | estimated("held_share", standing_time / record.attrs["hold"], "-")
    )


def _pushes(record: xr.Dataset) -> Measures:
    """Return the fraction of the robots as built that stay upright, and the smallest toppling pushes [N].

    Both are given with feedback and without; the pushes are those on the robot as designed.
    """
    _, _, upright_time, leave_time, _, _ = record.attrs["stages"]
    measures = Measures()
    for feedback in record.feedback.values:
        height = record.repeat_reach.sel(feedback=feedback, repeat_time=slice(upright_time, leave_time))
        is_upright = (height > record.attrs["least"]).all("repeat_time")
        measures[f"stays_up_{feedback}"] = Measure(float(is_upright.mean()), "-")
        for direction in record.direction.values if "push" in record else ():
            force = record.push.sel(feedback=feedback, commanded=record.attrs["commanded_lead"], direction=direction)
            measures[f"push_{direction}_{feedback}"] = Measure(float(force), "N")
    return measures


def _gains(record: xr.Dataset) -> Measures:
    """Return the gain of reach per added length of legs, spine and head, for both poses [-]."""
    gains = Measures(
        {
            f"gain_{body_part}_{pose}": Measure(float(record.gain.sel(part=body_part, pose=pose)), "-")
            for body_part in record.part.values
            for pose in record.pose.values
        }
    )
    other_gains = record.gain.sel(pose="crawling", part=["spine", "head"])
    gains["gain_others_crawling"] = Measure(float(abs(other_gains).max()), "-")
    gains["gain_least_standing"] = Measure(float(record.gain.sel(pose="standing").min()), "-")
    return gains


def min_lead(record: xr.Dataset) -> float:
    """Return the smallest distance of the centre of mass behind the feet from lift-off of the front to standing [m].

    The result is NaN for a robot whose front does not leave the ground before it should stand.
    """
    _, rise_time, upright_time, *_ = record.attrs["stages"]
    rising = record.isel(run=0).sel(time=slice(rise_time, upright_time))
    lifted_samples = np.flatnonzero(rising.reach.values > _LIFTED_FRACTION * record.attrs["stretched"])
    return float(rising.lead[lifted_samples[0] :].min()) if lifted_samples.size else float("nan")


def _forward_displacement(position: xr.DataArray, start_time: float) -> float:
    """Return the forward displacement of a point after a start time [m].

    Args:
        position: position of the point (time, xyz) [m].
        start_time: time from which the displacement counts [s].
    """
    x = position.sel(xyz="x", time=slice(start_time, None))
    return float(x[-1] - x[0])


def _of_any_posture(record: xr.Dataset) -> Measures:
    """Return the greatest reach of any posture [m]; nothing where it was not searched."""
    return Measures({"ceiling": Measure(float(record.ceiling.max()), "m")} if "ceiling" in record else {})


def _of_the_map(record: xr.Dataset) -> Measures:
    """Return the fraction of robots on the map for which the cantilever torque alone predicts the outcome [-].

    There is nothing where no map was made.
    """
    if "map_reach" not in record:
        return Measures()
    stands = record.map_reach > record.attrs["up"]
    told_fraction = float((stands == (record.torque > record.map_cantilever)).mean())
    return Measures({"map_told_by_cantilever": Measure(told_fraction, "-")})


def _required_hip_height(record: xr.Dataset, height: float, crawl_heights: np.ndarray) -> np.ndarray:
    """Return the hip height at which each robot as built would reach a given height when it crawls [m].

    A line is fitted through the crawls of the design at several hip heights. The line is then shifted to the height
    that the robot as built reaches with its own hip height.

    Args:
        record: record of the experiment.
        height: reach to be attained [m].
        crawl_heights: reach of the robots as built in the crawl, any shape [m].
    """
    hip_heights, design_heights = record.hip_height.values, record.crawl_reach.values
    height_offset = crawl_heights - np.polyval(np.polyfit(hip_heights, design_heights, 1), record.attrs["hip_height"])
    required_height: np.ndarray = np.polyval(np.polyfit(design_heights, hip_heights, 1), height - height_offset)
    return required_height


experiment = BipedalReach()
