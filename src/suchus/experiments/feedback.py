"""Do the three feedback rules coordinate the robot, and what are they good for?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from math import degrees, radians
from typing import Any

import numpy as np
import xarray as xr

from suchus.control import LAWS, Coordinated, HeadingRule, Kick
from suchus.design import Crocodile
from suchus.experiment import Experiment, Measure, Outcome, Progress, Replay, Verdict, judge, silent, staged, stopwatch
from suchus.figures.feedback import draw_fans, draw_gain, draw_onset, draw_tracks
from suchus.gaits import GAITS
from suchus.land import Ground, Limp, Locked, Push, Run, simulate
from suchus.metrics import heading
from suchus.metrics.coordination import WITHIN, cycles_until, phase_error
from suchus.motion import START, Gait
from suchus.replay import replay
from suchus.robots import ROBOTS

_COARSE = 0.005  # [s]; time step, measured to agree with 2 ms within 0.1 %
_ALONE: Mapping[str, Any] = {"spine": None, "tail": None}
STARTS: Mapping[str, Coordinated] = {
    **{law: Coordinated(limbs=LAWS[law], random_start=True, **_ALONE) for law in LAWS},
    "closed_noisy": Coordinated(random_start=True, load_noise=0.3),
    "isolated_noisy": Coordinated(random_start=True, load_noise=0.3, sharing=False),
}
"""What brings random limb phases in order: each law alone, then all rules with noisy feet, sharing and not sharing."""
ARMS: Mapping[str, Coordinated] = {
    "open": Coordinated(limbs=LAWS["off"], **_ALONE),
    "limbs": Coordinated(**_ALONE),
    "spine": Coordinated(limbs=LAWS["off"], tail=None),
    "tail": Coordinated(limbs=LAWS["off"], spine=None),
    "closed": Coordinated(),
    "steered": Coordinated(heading=HeadingRule()),
}
"""Who is disturbed: no rule, each rule alone, all three, all three with the heading loop."""
SHOWN = ("open", "closed", "steered")
"""The arms whose measures are named."""
DISTURBANCES = (
    "none",
    "kick",
    "locked_spine",
    "uphill",
    "downhill",
    "side_slope",
    "other_side",
    "push",
    "limp_yaw",
    "load_noise",
)
"""What happens after one cycle; a slope is there from the beginning."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Feedback(Experiment):
    """Random limb phases under every law, then nine disturbances with and without the rules.

    Converged: the largest of the four phase errors (two diagonal pairs, two girdles) is within 0.1 cycle at every
    sample from some time on until the end of the run, and for at least ``hold`` cycles. Recovery is the way forward,
    along the direction faced at the start, over ``after`` cycles from the disturbance on. Drift is the way down a slope
    to the side, the mean of both sides.
    """

    title = "Do three feedback rules coordinate limbs, spine and tail, and what do they help against?"
    shows = "Sections II.B and III.D, Fig. 10"
    claims = ("feedback_rules", "shared_variables")
    decides = (
        "Load decides. A limb that waits while its foot still carries finds its place against the others from any "
        "start; told the loads of the other feet it does so four times faster and exactly. That mends what disturbs "
        "phases and nothing else: a stuck spine joint is made up for by the other joints, a slope by a tail that the "
        "ground carries, a push hardly and a limp leg by none of the three. Those turn the robot, and what turns must "
        "be felt: with the direction from the IMU and longer strokes on one side it walks straight again."
    )

    robot: Crocodile = field(default_factory=lambda: ROBOTS["caiman"])
    """Who crawls."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """How; its limbs must form diagonal pairs."""
    starts: int = 32
    """Random initial limb phases, the same for all laws [-]."""
    cycles: int = 12
    """How long each start is followed [cycle]."""
    hold: float = 2.0
    """For how long the limbs must stay coordinated until the end [cycle]."""
    after: int = 5
    """How long a disturbed robot is followed from the disturbance on [cycle]."""
    kick: tuple[float, float, float, float] = (0.5, 0.0, 0.0, 0.2)
    """How far LF, RF, LH, RH jump ahead [cycle]; together almost the farthest from the gait."""
    slope: float = radians(10)
    """Of the ground [rad]."""
    push: tuple[float, float, float] = (0.0, 20.0, 0.0)
    """Force on the thorax for 0.3 s [N]; 5 N does nothing even without feedback."""
    noise: float = 0.3
    """Standard deviation of the noise on what the feet feel, as a part of the load [-]."""
    seed: int = 0
    """Of the first start; the others follow."""

    def quick(self) -> "Feedback":
        """Two starts, few and short cycles."""
        return replace(self, gait=replace(self.gait, period=2.0), starts=2, cycles=2, hold=0.5, after=1)

    def run(self, progress: Progress = silent) -> Outcome:
        """Disturb it."""
        with stopwatch() as seconds:
            starts, pair = self._starts(staged(progress, "random starts", 0.0, 0.7))
            record = xr.merge(
                [
                    starts,
                    self._disturbed(staged(progress, "disturbances", 0.7, 1.0)),
                ]
            )
            measures = self._start_measures(record) | self._disturbed_measures(record)
            return Outcome(
                experiment=self.name(),
                measures=measures,
                verdicts=_verdicts(measures),
                record=record,
                settings=self.settings(),
                replays=self._replays(pair),
                seconds=seconds(),
            )

    def _replays(self, pair: xr.Dataset) -> Mapping[str, Replay]:
        caption = (
            "From limbs out of step: loads felt across the body bring them into the gait, and, half transparent, "
            "without feedback they stay as they are."
        )
        page = partial(
            replay,
            pair.isel(run=0),
            self.robot,
            ghost=pair.isel(run=1),
            labels=("feeling its loads", "without feedback"),
            title="Finding the gait",
            caption=caption,
        )
        return {"feedback_replay.html": Replay(caption=caption, make=page)}

    @property
    def _at(self) -> float:
        """When the disturbance comes [s]."""
        return START + self.gait.period

    def _starts(self, progress: Any) -> tuple[xr.Dataset, xr.Dataset]:
        """Return limb phases and way over time for every law and start, and one start as a record under two laws."""
        runs = [
            Run(robot=self.robot, gait=self.gait, control=control, seed=self.seed + i)
            for control in STARTS.values()
            for i in range(self.starts)
        ]
        duration = START + self.cycles * self.gait.period
        record = simulate(runs, duration=duration, timestep=_COARSE, every=10, progress=progress)
        shape = (len(STARTS), self.starts, record.sizes["time"])
        dims = ("law", "start", "start_time")
        phase = record.limb_phase.transpose("run", "time", "leg").values.reshape(*shape, 4)
        way = record.centre_of_mass.sel(xyz="x").transpose("run", "time").values.reshape(shape)
        pair = record.isel(run=[self.starts * list(STARTS).index(law) for law in ("cross_load", "off")])
        data = xr.Dataset(
            {
                "start_phase": ((*dims, "leg"), phase, {"units": "1", "long_name": "phase of each limb [cycle]"}),
                "start_way": (dims, way, {"units": "m", "long_name": "way of the centre of mass along x"}),
            },
            coords={
                "law": list(STARTS),
                "start_time": ("start_time", record.time.values, {"units": "s"}),
                "leg": record.leg.values,
            },
        )
        return data, pair

    def _disturbed(self, progress: Any) -> xr.Dataset:
        """Return track, direction, limb phases and tail pitch over time for every disturbance and arm."""
        runs = [self._disturb(control, name) for name in DISTURBANCES for control in ARMS.values()]
        duration = self._at + self.after * self.gait.period
        record = simulate(runs, duration=duration, timestep=_COARSE, every=10, progress=progress)
        dims, shape = ("disturbance", "arm", "time"), (len(DISTURBANCES), len(ARMS), record.sizes["time"])
        track = record.centre_of_mass.transpose("run", "time", "xyz").values
        phase = record.limb_phase.transpose("run", "time", "leg").values
        pitch = record.servo_target.sel(servo="tail_pitch").transpose("run", "time").values
        facing = heading(record).transpose("run", "time").values
        return xr.Dataset(
            {
                "x": (dims, track[..., 0].reshape(shape), {"units": "m", "long_name": "way forward"}),
                "y": (dims, track[..., 1].reshape(shape), {"units": "m", "long_name": "way to the left"}),
                "heading": (dims, facing.reshape(shape), {"units": "rad", "long_name": "direction of the body"}),
                "tail_pitch": (dims, pitch.reshape(shape), {"units": "rad", "long_name": "commanded, down positive"}),
                "limb_phase": ((*dims, "leg"), phase.reshape(*shape, 4), {"units": "1", "long_name": "[cycle]"}),
            },
            coords={
                "disturbance": list(DISTURBANCES),
                "arm": list(ARMS),
                "time": ("time", record.time.values, {"units": "s"}),
                "leg": record.leg.values,
            },
        )

    def _disturb(self, control: Coordinated, name: str) -> Run:
        run = Run(robot=self.robot, gait=self.gait, control=control, seed=self.seed, label=name)
        match name:
            case "kick":
                return replace(run, control=replace(control, kicks=(Kick(self._at, self.kick),)))
            case "load_noise":
                return replace(run, control=replace(control, load_noise=self.noise))
            case "locked_spine":
                return replace(run, faults=(Locked("spine_yaw_2", at=self._at),))
            case "limp_yaw":
                return replace(run, faults=(Limp("LF_yaw", at=self._at),))
            case "push":
                return replace(run, pushes=(Push(force=self.push, at=self._at, duration=0.3),))
            case "uphill" | "downhill":
                return replace(run, ground=Ground(uphill=self.slope if name == "uphill" else -self.slope))
            case "side_slope" | "other_side":
                return replace(run, ground=Ground(sideways=self.slope if name == "side_slope" else -self.slope))
        return run

    def _start_measures(self, record: xr.Dataset) -> dict[str, Measure]:
        """Return how many starts converge, how fast and how well, and what the phases' sharing is worth."""
        error = phase_error(record.start_phase, self.gait).rename(start_time="time")
        period = self.gait.period
        found = cycles_until(error, period, start=START, hold=self.hold)
        measures = {}
        for law in STARTS:
            cycles = found.sel(law=law).values
            measures[f"converged_{law}"] = Measure(float(np.isfinite(cycles).mean()), "-")
            measures[f"phase_error_{law}"] = Measure(float(_ending(error.sel(law=law), self.hold * period).mean()), "-")
            if law in ("own_load", "cross_load", "body_limb", "closed_noisy"):
                worst = np.quantile(np.minimum(cycles, self.cycles), 0.9)
                measures[f"cycles_to_converge_{law}"] = Measure(float(worst), "-")
        measures["cycles_to_converge"] = measures.pop("cycles_to_converge_cross_load")
        measures["converged_closed"] = measures["converged_cross_load"]
        measures["converged_open"] = measures["converged_off"]
        ways = _ending(record.start_way.rename(start_time="time"), self.hold * period)
        ways = (ways.isel(time=-1) - ways.isel(time=0)) / self.hold
        for name, law in (("shared", "closed_noisy"), ("isolated", "isolated_noisy")):
            measures[f"way_{name}"] = Measure(float(ways.sel(law=law).mean()), "m")
            measures[f"way_{name}_least"] = Measure(float(ways.sel(law=law).min()), "m")
        return measures

    def _disturbed_measures(self, record: xr.Dataset) -> dict[str, Measure]:
        """Return ways and turns after each disturbance, and what the rules make of them."""
        part = record.sel(time=slice(self._at - 1e-9, None))
        change = part.isel(time=-1) - part.isel(time=0)
        moved = {(d, a): change.sel(disturbance=d, arm=a) for d in DISTURBANCES for a in ARMS}
        way = {key: float(value.x) for key, value in moved.items()}
        measures = {}
        for name in DISTURBANCES:
            for arm in SHOWN:
                measures[f"recovery_{name}_{arm}"] = Measure(way[name, arm], "m")
                measures[f"heading_{name}_{arm}"] = Measure(float(moved[name, arm].heading), "rad")
        error = phase_error(record.limb_phase.sel(disturbance="kick", arm="closed"), self.gait)
        back = float(cycles_until(error, self.gait.period, start=self._at, hold=min(self.hold, 0.5)))
        shares = {
            "kick_kept_open": way["kick", "open"] / way["none", "open"],
            "kick_kept_closed": way["kick", "closed"] / way["none", "closed"],
            "cycles_after_kick": min(back, float(self.after)),
            "locked_spine_loss_open": 1.0 - way["locked_spine", "open"] / way["none", "open"],
            "locked_spine_loss_closed": 1.0 - way["locked_spine", "closed"] / way["none", "open"],
            "locked_spine_loss_of_own": 1.0 - way["locked_spine", "closed"] / way["none", "closed"],
            "uphill_gain_tail": way["uphill", "tail"] / way["uphill", "open"] - 1.0,
            "uphill_gain_closed": way["uphill", "closed"] / way["uphill", "open"] - 1.0,
        }
        measures |= {name: Measure(value, "-") for name, value in shares.items()}
        last = part.heading.sel(time=part.time[-1] - self.gait.period, method="nearest")
        turning = (part.heading.isel(time=-1) - last).sel(disturbance="limp_yaw")
        for arm in SHOWN:
            drift = float(moved["other_side", arm].y - moved["side_slope", arm].y) / 2
            measures[f"drift_side_slope_{arm}"] = Measure(drift, "m")
            measures[f"turning_limp_yaw_{arm}"] = Measure(float(turning.sel(arm=arm)), "rad")
        return measures | self._undisturbed_measures(record)

    def _undisturbed_measures(self, record: xr.Dataset) -> dict[str, Measure]:
        """Return what the rules do to a robot whose phases are right, over the first two cycles."""
        part = record.sel(time=slice(START - 1e-9, START + 2 * self.gait.period + 1e-9), disturbance="none")
        change = part.isel(time=-1) - part.isel(time=0)
        way = {arm: float(change.x.sel(arm=arm)) for arm in ARMS}
        clock = change.limb_phase.mean("leg")
        pitch = record.tail_pitch.sel(arm="closed").isel(time=-1)
        return {
            "distortion": Measure(abs(way["limbs"] / way["open"] - 1.0), "-"),
            "way_gained": Measure(way["closed"] / way["open"] - 1.0, "-"),
            "clock_closed": Measure(float(clock.sel(arm="closed")) / float(clock.sel(arm="open")), "-"),
            "tail_pitch_level": Measure(float(pitch.sel(disturbance="none")), "rad"),
            "tail_pitch_uphill": Measure(float(pitch.sel(disturbance="uphill")), "rad"),
        }

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the starts, one of them as a gait diagram, what each rule gains, the tracks."""
        record = outcome.record
        error = phase_error(record.start_phase, self.gait).rename(start_time="time")
        cycles = (error.time - START) / self.gait.period
        part = record.sel(time=slice(self._at - 1e-9, None))
        return {
            "random_starts": draw_fans(error.assign_coords(time=cycles), WITHIN),
            "finding_the_gait": draw_onset(record.start_phase.assign_coords(start_time=cycles.values), self.gait),
            "what_each_rule_gains": draw_gain(part.x.isel(time=-1) - part.x.isel(time=0)),
            "disturbed_tracks": draw_tracks(part, ("limp_yaw", "push", "side_slope")),
        }


def _ending(values: xr.DataArray, seconds: float) -> xr.DataArray:
    return values.sel(time=slice(float(values.time[-1]) - seconds - 1e-9, None))


def _verdicts(measures: Mapping[str, Measure]) -> tuple[Verdict, ...]:
    m = {name: measure.value for name, measure in measures.items()}
    stable = m["converged_cross_load"] >= 0.95 and m["converged_wrong_sign"] < 0.05 and m["distortion"] <= 0.03
    return (
        judge(
            "feedback_rules",
            m["converged_cross_load"],
            f"From random limb phases {m['converged_cross_load']:.0%} find the gait, 90 % of them within "
            f"{m['cycles_to_converge']:.1f} cycles; {m['converged_off']:.0%} without feedback, "
            f"{m['converged_own_load']:.0%} if every limb feels its own foot alone. From the right phases the way "
            f"changes by {m['way_gained']:+.1%}. A stuck spine joint costs {m['locked_spine_loss_closed']:.0%} of the "
            f"way instead of {m['locked_spine_loss_open']:.0%}. A push still turns the robot by "
            f"{degrees(m['heading_push_closed']):.0f} degrees ({degrees(m['heading_push_open']):.0f} without feedback) "
            f"and a limp front yaw by {degrees(m['heading_limp_yaw_closed']):.0f} "
            f"({degrees(m['heading_limp_yaw_open']):.0f}).",
            holds=stable and m["locked_spine_loss_closed"] < m["locked_spine_loss_open"],
        ),
        judge(
            "shared_variables",
            m["way_shared"],
            f"After random starts a cycle's way is {m['way_shared']:.2f} m (at least {m['way_shared_least']:.2f}) "
            f"where spine and tail hear of the limbs' phases, and {m['way_isolated']:.2f} m (at least "
            f"{m['way_isolated_least']:.2f}) where each follows the clock for itself.",
            holds=m["way_shared"] > m["way_isolated"] and m["way_shared_least"] > m["way_isolated_least"],
        ),
    )


experiment = Feedback()
