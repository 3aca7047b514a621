"""How high does the robot reach when it crawls, and when it stands on hind legs and tail?"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from operator import attrgetter
from typing import Any

import numpy as np
import xarray as xr

from suchus.control import OpenLoop
from suchus.control.standing import BALANCE, Balance, Standing
from suchus.design import Crocodile, with_values
from suchus.design.checks import Checks
from suchus.errors import OutsideLimits
from suchus.experiment import Experiment, Measure, Outcome, Progress, Replay, Verdict, judge, silent, staged, stopwatch
from suchus.figures.standing import (
    draw_angles,
    draw_ceiling,
    draw_heights,
    draw_limits,
    draw_pushes,
    draw_side_views,
)
from suchus.gaits import GAITS
from suchus.kinematics.mass import cantilever_torque
from suchus.land import Run, simulate
from suchus.land.toppling import smallest_pushes
from suchus.metrics import held, lead, peak_torque, reach, static_margin
from suchus.motion import START, Gait
from suchus.motion.posture import plan
from suchus.motion.rising import LEAD, stand_up, stretched, tallest
from suchus.paper import CLAIMS
from suchus.replay import replay
from suchus.robots import ROBOTS

_COARSE = 0.005  # [s]; time step of sweeps; reach and limits agree with those at 2 ms
_SOON = 0.2  # [s]; when standing up begins in sweeps, where no crawl is needed
_UP = 0.6  # of the stretched length: who reaches less has not stood up, or has fallen
_WAYS = {"fore": (1.0, 0.0, 0.0), "aft": (-1.0, 0.0, 0.0), "lateral": (0.0, 1.0, 0.0)}
_PARTS = {
    "leg": ("hind_leg.femur", "hind_leg.tibia", "front_leg.femur", "front_leg.tibia"),
    "spine": ("spine.base", "spine.link"),
    "head": ("head.snout",),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class BipedalReach(Experiment):
    """From the crawl to standing on hind legs and tail, and down again into the crawl.

    The height that the robot reaches is that of the highest point of head and trunk, whatever part that is; legs and
    tail do not count. For the crawl it is the highest such point over a cycle, for standing the lowest while it
    stands. Pushes act on the thorax for 0.2 s.
    """

    title = "How high does it reach, crawling and standing on two legs?"
    shows = "Section IV.D, Figs 22 to 24"
    claims = (
        "height_crawl",
        "height_standing",
        "height_ratio",
        "height_from_legs",
        "height_from_spine_head_legs",
    )
    decides = (
        "Three numbers decide. The first pitch joint of the trunk must lift the level forebody as a cantilever; with a "
        "weaker servo or a heavier forebody nothing leaves the ground. The hind feet must get ahead of the centre of "
        "mass before that, which asks for a battery near the hips. The farther the mass then stands behind the feet, "
        "the harder the push that it bears; that costs little height, because the cosine of a small lean is near one. "
        "The printed 0.68 m is hind leg, spine and head in one straight line; the sole adds its radius."
    )

    robot: Crocodile = field(default_factory=lambda: ROBOTS["caiman"])
    """Who stands up."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """How it crawls before and after."""
    straight: Gait = field(default_factory=lambda: GAITS["limbs_only"])
    """From whose first posture it stands up in the sweeps: the trunk is straight, so that pushes come from ahead."""
    balance: Balance = BALANCE
    """How it keeps its balance when it stands."""
    hold: float = 60.0
    """How long it stands [s]."""
    least: float = 0.64
    """Reach that counts as standing for the time that it is held [m]; what an earlier study of this robot reached."""
    repeats: int = 4
    """Runs with noise on the servos, to see whether it stays up [-]."""
    noise: float = 0.01
    """Standard deviation of the noise on every commanded angle in the repeats [rad]; a hobby servo's dead band."""
    torques: tuple[float, ...] = (2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0)
    """Torques of the trunk's pitch servos on the map [N m]."""
    forebodies: tuple[float, ...] = (0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
    """Masses of thorax and head together on the map [kg]; the pelvis takes the rest, as if the battery moved."""
    hips: tuple[float, ...] = (0.07, 0.09, 0.11, 0.125, 0.135)
    """Heights of the hips in the crawls that show what the legs decide [m]; the last is near what the legs allow."""
    leads: tuple[float, ...] = (0.015, 0.025, 0.035)
    """Further commanded distances of the centre of mass behind the feet, for what a safe stand costs [m]."""
    pushes: tuple[float, ...] = (1.0, 2.0, 4.0, 6.0, 8.0, 11.0, 14.0, 17.0, 20.0)
    """Forces that are tried, before finer ones between two of them [N]."""
    finer: int = 4
    """Number of forces between two of them [-]."""
    wait: float = 3.0
    """How long a robot is left alone before a push and after it [s]; a fall takes less than 2 s."""
    timestep: float = 0.002
    """Of the physics in the run of the figures [s]; sweeps take 5 ms."""
    longer: float = 0.05
    """By which part legs, spine and head are lengthened, one after another [-]."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.number("hold", 1.0, 3600.0, "s")
            check.number("least", 0.1, 10.0, "m")
            check.whole("repeats", 1, 1000)
            check.number("noise", 0.0, 1.0, "rad")
            check.whole("finer", 0, 100)
            check.that(len(self.hips) > 1, f"{self.name()}.hips has {len(self.hips)} heights; two at least are needed")
            check.number("wait", 0.1, 60.0, "s")
            check.number("timestep", 1e-5, 0.01, "s")
            check.number("longer", 0.001, 0.2, "")

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
            timestep=_COARSE,
        )

    def run(self, progress: Progress = silent) -> Outcome:
        """Crawl, stand, sit, crawl; then what it takes and what it bears."""
        with stopwatch() as seconds:
            standing = Standing(at=START + self.gait.period, hold=self.hold, balance=self.balance)
            record = self._story(standing, staged(progress, "standing", 0.0, 0.2))
            for study, stage, start, end in (
                (self._limits, "torque and mass", 0.2, 0.4),
                (self._pushed, "pushes", 0.4, 0.85),
                (self._lengths, "lengths", 0.85, 1.0),
            ):
                record = record.merge(study(staged(progress, stage, start, end)))
            record = record.merge(self._ceiling())
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
        caption = "From the crawl up on hind legs and tail, and down again into the crawl."
        page = partial(replay, record, self.robot, labels=("standing up",), title="Standing up", caption=caption)
        return {"standing_replay.html": Replay(caption=caption, make=page)}

    def _story(self, standing: Standing, progress: Any) -> xr.Dataset:
        """Return the run of the figures, and the heights of its repeats."""
        duration = standing.down_from(self.robot) + self.gait.period
        calm = Run(robot=self.robot, gait=self.gait, control=standing)
        record = simulate(
            [calm], duration=duration, timestep=self.timestep, every=2, progress=lambda share: progress(0.5 * share)
        )
        blind = replace(calm, control=replace(standing, balance=None))
        shaken = [
            replace(run, noise=self.noise, seed=seed) for run in (calm, blind) for seed in range(1, 1 + self.repeats)
        ]
        repeats = simulate(
            shaken, duration=duration, timestep=_COARSE, every=10, progress=lambda share: progress(0.5 + 0.5 * share)
        )
        heights = reach(self.robot, repeats).values.reshape(2, self.repeats, -1)
        record = record.assign(reach=reach(self.robot, record), margin=static_margin(record), lead=lead(record))
        data = record.assign(
            {"repeat_reach": (("feedback", "repeat", "repeat_time"), heights, {"units": "m"})}
        ).assign_coords(feedback=["on", "off"], repeat_time=("repeat_time", repeats.time.values, {"units": "s"}))
        stages = (START, standing.at, standing.upright_from(self.robot), standing.upright_until(self.robot))
        data.attrs["stages"] = [*stages, standing.down_from(self.robot), duration]
        return data

    def _settled(self, robots: Sequence[Crocodile], leads: Sequence[float], progress: Any) -> xr.Dataset:
        """Return reach and lead of robots that stood up; zero where the postures are out of reach."""
        controls = [_stand_soon(robot, some, self.balance) for robot, some in zip(robots, leads, strict=True)]
        able = [control is not None for control in controls]
        found = {name: np.zeros(len(able)) for name in ("reach", "lead")}
        runs = [
            Run(robot=robot, gait=self.straight, control=control)
            for robot, control in zip(robots, controls, strict=True)
            if control is not None
        ]
        if not runs:
            return xr.Dataset({name: ("case", values, {"units": "m"}) for name, values in found.items()})
        duration = max(_up_at(run.robot) for run in runs) + self.wait
        record = simulate(runs, duration=duration, timestep=_COARSE, every=10, progress=progress)
        last = record.sel(time=slice(duration - 0.5, None))
        for i, case in enumerate(np.flatnonzero(able)):
            one = last.isel(run=i)
            found["reach"][case] = float(reach(runs[i].robot, one).min())
            found["lead"][case] = float(lead(one).mean())
        return xr.Dataset({name: ("case", values, {"units": "m"}) for name, values in found.items()})

    def _limits(self, progress: Any) -> xr.Dataset:
        """Return what robots with other trunk servos and other forebodies reach."""
        cells = [_heavier(self.robot, mass, torque) for torque in self.torques for mass in self.forebodies]
        found = self._settled(cells, [LEAD] * len(cells), progress)
        shape = len(self.torques), len(self.forebodies)
        cantilever = [cantilever_torque(_heavier(self.robot, mass, 1.0)) for mass in self.forebodies]
        data = xr.Dataset(
            {
                "map_reach": (("torque", "forebody"), found.reach.values.reshape(shape), {"units": "m"}),
                "map_cantilever": ("forebody", cantilever, {"units": "N m"}),
            },
            coords={"torque": list(self.torques), "forebody": list(self.forebodies)},
        )
        data.torque.attrs.update(units="N m", long_name="torque of the trunk's pitch servos")
        data.forebody.attrs.update(units="kg", long_name="mass of thorax and head")
        return data

    def _pushed(self, progress: Any) -> xr.Dataset:
        """Return the smallest pushes that topple, with feedback and without, over the lead."""
        leads = sorted({*self.leads, LEAD})
        balances = {"on": self.balance, "off": None}
        stood = self._settled([self.robot] * len(leads), leads, lambda share: progress(0.1 * share))
        runs = [
            Run(robot=self.robot, gait=self.straight, control=_stand_soon(self.robot, some, balance) or OpenLoop())
            for balance in balances.values()
            for some in leads
        ]
        forces = smallest_pushes(
            runs,
            list(_WAYS.values()),
            at=round(_up_at(self.robot) + self.wait, 2),
            levels=self.pushes,
            finer=self.finer,
            wait=self.wait,
            fell=lambda record: record.snout.sel(xyz="z").isel(time=-1) < _UP * stretched(self.robot),
            timestep=_COARSE,
            progress=lambda share: progress(0.1 + 0.9 * share),
        ).reshape(len(balances), len(leads), len(_WAYS))
        stands = stood.reach.values > _UP * stretched(self.robot)
        return xr.Dataset(
            {
                "push": (("feedback", "commanded", "way"), np.where(stands[:, None], forces, 0.0), {"units": "N"}),
                "lead_reach": ("commanded", np.where(stands, stood.reach, np.nan), {"units": "m"}),
                "lead_found": ("commanded", np.where(stands, stood.lead, np.nan), {"units": "m"}),
            },
            coords={"way": list(_WAYS), "commanded": leads, "feedback": list(balances)},
        )

    def _lengths(self, progress: Any) -> xr.Dataset:
        """Return how crawling and standing reach change with the lengths of legs, spine and head."""
        robots = [self.robot, *(_lengthened(self.robot, part, 1 + self.longer) for part in _PARTS)]
        stood = self._settled(robots, [LEAD] * len(robots), lambda share: progress(0.5 * share))
        crawls = [(self.robot, replace(self.gait, hip_height=hips)) for hips in self.hips]
        crawls += [(robot, _fitted(self.gait, robot, self.robot)) for robot in robots]
        runs = [Run(robot=robot, gait=gait) for robot, gait in crawls]
        record = simulate(
            runs,
            duration=START + self.gait.period,
            timestep=_COARSE,
            every=5,
            progress=lambda share: progress(0.5 + 0.5 * share),
        ).sel(time=slice(START, None))
        heights = np.array([float(reach(robot, record.isel(run=i)).max()) for i, (robot, _) in enumerate(crawls)])
        walking = heights[len(self.hips) :]
        longer = np.array(
            [_length(robot, part) - _length(self.robot, part) for robot, part in zip(robots[1:], _PARTS, strict=True)]
        )
        changes = np.stack([walking[1:] - walking[0], stood.reach.values[1:] - stood.reach.values[0]], axis=-1)
        way = record.centre_of_mass.sel(xyz="x")
        return xr.Dataset(
            {
                "crawl_reach": ("hip_height", heights[: len(self.hips)], {"units": "m"}),
                "crawl_way": (
                    "hip_height",
                    (way[: len(self.hips), -1] - way[: len(self.hips), 0]).values,
                    {"units": "m"},
                ),
                "gain": (("part", "pose"), changes / longer[:, None], {"units": "1"}),
            },
            coords={"hip_height": list(self.hips), "part": list(_PARTS), "pose": ["crawling", "standing"]},
        )

    def _ceiling(self) -> xr.Dataset:
        """Return how high any posture could reach over the distance of the centre of mass behind the feet."""
        behind = np.linspace(0.0, 0.1, 11)
        return xr.Dataset(
            {"ceiling": ("behind", tallest(self.robot, behind), {"units": "m"})},
            coords={"behind": ("behind", behind, {"units": "m"})},
        )

    def _measures(self, record: xr.Dataset) -> dict[str, Measure]:
        start, at, up, leave, down, _ = record.attrs["stages"]
        height, margin = record.reach.isel(run=0), record.margin.isel(run=0)
        crawling, upright = height.sel(time=slice(start, at)), height.sel(time=slice(up, leave))
        after = height.sel(time=slice(down, None))
        crawl, stand = float(crawling.max()), float(upright.min())
        measures = {
            "reach_crawl": Measure(crawl, "m"),
            "reach_standing": Measure(stand, "m"),
            "reach_ratio": Measure(stand / crawl, "-"),
            "held": Measure(float(held(height, self.least)), "s"),
            "margin_standing": Measure(float(margin.sel(time=slice(up, leave)).min()), "m"),
            "margin_rising": Measure(float(record.lead.isel(run=0).sel(time=slice(_lifts(height, at), up)).min()), "m"),
            "reach_after": Measure(float(after.max()), "m"),
            "way_after": Measure(
                float(
                    record.centre_of_mass.isel(run=0).sel(xyz="x").sel(time=slice(down, None))[[0, -1]].diff("time")[0]
                ),
                "m",
            ),
            "stretched_length": Measure(stretched(self.robot), "m"),
            "ceiling": Measure(float(record.ceiling.max()), "m"),
            "reach_crawl_high": Measure(float(record.crawl_reach.max()), "m"),
            "hips_at_printed_height": Measure(_hips_at(record, CLAIMS["height_crawl"].value or 0.0), "m"),
            "cantilever_torque": Measure(cantilever_torque(self.robot), "N m"),
        }
        for name, torque in zip(record.servo.values, peak_torque(record.isel(run=0), at, leave).values, strict=True):
            measures[f"torque_rising_{name}"] = Measure(float(torque), "N m")
        for feedback in ("on", "off"):
            stays = (record.repeat_reach.sel(feedback=feedback, repeat_time=slice(up, leave)) > self.least).all(
                "repeat_time"
            )
            measures[f"stays_up_{feedback}"] = Measure(float(stays.mean()), "-")
            for way in _WAYS:
                measures[f"push_{way}_{feedback}"] = Measure(
                    float(record.push.sel(feedback=feedback, commanded=LEAD, way=way)), "N"
                )
        for part in _PARTS:
            for pose in ("crawling", "standing"):
                measures[f"gain_{part}_{pose}"] = Measure(float(record.gain.sel(part=part, pose=pose)), "-")
        return measures

    def _verdicts(self, measures: Mapping[str, Measure]) -> tuple[Verdict, ...]:
        m = {name: measure.value for name, measure in measures.items()}
        hips, longest = 1000 * self.gait.hip_height, m["stretched_length"]
        gains = {pose: [m[f"gain_{part}_{pose}"] for part in _PARTS] for pose in ("crawling", "standing")}
        return (
            judge(
                "height_crawl",
                m["reach_crawl"],
                f"The top of the back, with the hips at {hips:.0f} mm; the article says neither what it measured nor "
                f"how high the hips are. The printed height takes hips at {1000 * m['hips_at_printed_height']:.0f} mm.",
            ),
            judge(
                "height_standing",
                m["reach_standing"],
                f"The snout, above {self.least:g} m for {m['held']:.0f} s, with trunk servos of "
                f"{self.robot.spine.pitch_servo.torque:g} N m; the level forebody asks for "
                f"{m['cantilever_torque']:.2f} N m. "
                f"Hind leg, spine and head in one line are {longest:.3f} m.",
                holds=m["reach_standing"] > 2 * m["reach_crawl"] and m["held"] >= 0.99 * self.hold,
            ),
            judge(
                "height_ratio",
                m["reach_ratio"],
                "The crawl shown is lower than the printed one, the stand almost as high; against a crawl that reaches "
                f"the printed height the ratio is {m['reach_standing'] / (CLAIMS['height_crawl'].value or 1.0):.2f}.",
                holds=m["reach_ratio"] > 2,
            ),
            judge(
                "height_from_legs",
                gains["crawling"][0],
                "Per millimetre of longer legs, with the gait's heights in proportion, the crawl reaches "
                f"{gains['crawling'][0]:.2f} mm higher; per millimetre of spine {gains['crawling'][1]:.2f}, of head "
                f"{gains['crawling'][2]:.2f} mm.",
                holds=gains["crawling"][0] > 0.25 and max(map(abs, gains["crawling"][1:])) < 0.1,
            ),
            judge(
                "height_from_spine_head_legs",
                min(gains["standing"]),
                "Per millimetre of hind leg, spine and head the stand reaches "
                f"{gains['standing'][0]:.2f}, {gains['standing'][1]:.2f} and {gains['standing'][2]:.2f} mm higher.",
                holds=min(gains["standing"]) > 0.5,
            ),
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw postures, angles and heights over time, and what decides them."""
        record = outcome.record
        return {
            "side_views": draw_side_views(self.robot, record),
            "angles": draw_angles(record),
            "height_over_time": draw_heights(record, self.hold),
            "torque_and_mass": draw_limits(self.robot, record, _UP * stretched(self.robot)),
            "ceiling": draw_ceiling(self.robot, record),
            "pushes": draw_pushes(record, LEAD),
        }


def _stand_soon(robot: Crocodile, some: float, balance: Balance | None) -> Standing | None:
    """Return a control that stands up at once and stays, or None for a robot that cannot take the postures."""
    try:
        rise = stand_up(robot, lead=some)
        plan(robot, rise, np.linspace(0.0, rise.duration, 200))
    except OutsideLimits:
        return None
    return Standing(at=_SOON, hold=86400.0, balance=balance, rise=rise)


def _up_at(robot: Crocodile) -> float:
    return Standing(at=_SOON, hold=0.0).upright_from(robot)


def _lifts(height: xr.DataArray, since: float) -> float:
    """Return when the front has left the ground for good: the reach passes a quarter of a metre [s]."""
    late = height.sel(time=slice(since, None))
    return float(late.time[np.argmax(late.values > 0.25)])


def _hips_at(record: xr.Dataset, height: float) -> float:
    """Return the height of the hips at which a crawl reaches a height [m], by a line through those tried."""
    line = np.polyfit(record.crawl_reach.values, record.hip_height.values, 1)
    return float(np.polyval(line, height))


def _heavier(robot: Crocodile, mass: float, torque: float) -> Crocodile:
    """Return the robot with another forebody, the pelvis taking the rest, and other pitch servos in the trunk."""
    own = robot.thorax.mass + robot.head.mass
    return with_values(
        robot,
        {
            "thorax.mass": robot.thorax.mass * mass / own,
            "head.mass": robot.head.mass * mass / own,
            "pelvis.mass": max(robot.pelvis.mass + own - mass, 0.02),
            "spine.pitch_servo.torque": torque,
        },
    )


def _lengthened(robot: Crocodile, part: str, factor: float) -> Crocodile:
    """Return the robot with longer legs, a longer spine, or a longer head; masses stay."""
    return with_values(robot, {path: factor * attrgetter(path)(robot) for path in _PARTS[part]})


def _length(robot: Crocodile, part: str) -> float:
    """Return the length of a part, of the hind leg for the legs [m]."""
    leg = robot.hind_leg
    return {"leg": leg.femur + leg.tibia, "spine": robot.spine.length, "head": robot.head.snout}[part]


def _fitted(gait: Gait, robot: Crocodile, original: Crocodile) -> Gait:
    """Return the gait with its heights and reaches in proportion to a robot's legs."""
    factor = _length(robot, "leg") / _length(original, "leg")
    sizes = {name: factor * getattr(gait, name) for name in ("hip_height", "front_reach", "hind_reach")}
    return replace(gait, **sizes)


experiment = BipedalReach()
