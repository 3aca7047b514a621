"""How far does the robot still get when joints of its legs are lost?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import product
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from scipy.stats import qmc

from suchus.control import Control, Coordinated, HeadingRule, OpenLoop
from suchus.design import Chosen, Crocodile, meaning, value_at, with_values
from suchus.design.checks import Checks
from suchus.experiment import Experiment, Measure, Outcome, Progress, Replay, Simulated, silent, staged
from suchus.experiments import _fault_findings as findings
from suchus.experiments._fault_findings import ARMS, JOINTS
from suchus.experiments._fault_records import lay, support
from suchus.figures.faults import draw_held, draw_losses, draw_over_time, draw_tracks
from suchus.gaits import GAITS
from suchus.land import KINDS, LEGS_LOST, LOST, Fault, Ground, Limp, Locked, Run, angle_at, lost, simulate
from suchus.land.lost import Joint, Kind, Legs
from suchus.metrics import (
    between,
    displacement,
    heading_change,
    path_length,
    whole,
)
from suchus.motion import START, Gait
from suchus.paper import CYCLES
from suchus.replay import replay
from suchus.robots import ROBOTS

_TRUNK = ("trunk_bend", "spine_phase", "tail_bend", "tail_phase", "tail_pitch")  # the rest of a gait is its legs


_FINE = 0.005  # [s]; time step of the three runs whose loads and heights are read


@dataclass(frozen=True, slots=True, kw_only=True)
class JointFaults(Experiment):
    """Front and hind; yaw, pitch and knee; limp and locked; one leg and both; with spine and tail and with limbs only.

    All of it over variations of gait and friction. A change of displacement is measured against the intact run with
    spine and tail of the same variation, as the article does; ``faults.csv`` has it against the intact run of the same
    arm too. Two more arms are run in the judged reading: ``steered`` with the feedback rules and the heading loop, and
    ``limbs_tail_lifted``, limbs only with the tail in the air. Displacement is forward, along the direction that the
    body faced at the start.
    """

    title = "How far does it still crawl when joints of its legs are lost?"
    shows = "Section IV.C, Figs 18 to 21"
    judged_with = ("robot", "gait", "control", "lifted", "cycles", "hold", "kind", "legs")
    judged_from: ClassVar[Mapping[str, float]] = {"variations": 8, "repeats": 4}

    robot: Crocodile = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot whose joints are lost."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The crawl with spine and tail."""
    control: Gait = field(default_factory=lambda: GAITS["limbs_only"])
    """The crawl of the control group, its tail lying still; its legs follow those of ``gait``."""
    lifted: Gait = field(default_factory=lambda: GAITS["limbs_tail_lifted"])
    """The control group with its tail in the air, for comparison; its legs follow those of ``gait``."""
    cycles: int = int(CYCLES)
    """How many cycles are measured [-]."""
    variations: int = 8
    """Gaits and frictions [-]; the first is the gait as given, without noise."""
    spread: float = 0.25
    """Part of each plausible range of the gait's numbers that the variations cover, about the number given [-]."""
    grip_spread: float = 0.2
    """Half-width of the uniform spread of the friction, as a part of it [-]."""
    noise: float = 0.01
    """Standard deviation of the noise on every commanded angle [rad]; a hobby servo's dead band."""
    repeats: int = 4
    """Runs of the judged reading in the gait as given, with noise and another friction, for the spread [-]."""
    repeat_grip: float = 0.1
    """Half-width of the uniform spread of the friction in the repeats, as a part of it [-]."""
    hold: float = 0.5
    """Where a locked joint holds in the range that the gait asks of it: 0 least, 1 greatest [-].

    Not in the paper; the middle, because a servo that no longer hears commands may stop anywhere and the middle is
    farthest from both ends. ``Locked`` without an angle would hold where the joint is when it fails, which at the
    start of a run is an accident of the phase; what other places do is measured over ``holds``.
    """
    holds: tuple[float, ...] = (0.0, 0.25, 0.5, 0.75, 1.0)
    """Places in that range at which one leg's joint is locked, for the curve [-]."""
    kind: Kind = "limp"
    """The reading of 'lost' that is judged.

    Not in the paper; limp, because a servo that 'cannot receive and execute commands' gets no pulses, and gives way.
    """
    legs: Legs = "one"
    """Whether one leg or both of a girdle are judged; one, because the text speaks of individual joints."""
    timestep: float = 0.005
    """Time step of the physics [s]; 2 ms were measured to move no median by more than 3 points of a hundred, while
    10 ms move some by 6 and change what steering does to a lost hind yaw joint."""
    seed: int = 0
    """Seed of the variations and their noise [-]."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("cycles", 1, 1000)
            check.whole("variations", 1, 10_000)
            check.number("spread", 0.0, 1.0, "")
            check.number("grip_spread", 0.0, 0.9, "")
            check.whole("repeats", 1, 10_000)
            check.number("repeat_grip", 0.0, 0.9, "")
            check.number("noise", 0.0, 1.0, "rad")
            check.number("hold", 0.0, 1.0, "")
            check.rising("holds", 0.0, 1.0, "")
            check.number("timestep", 1e-5, 0.01, "s")
            check.whole("seed", 0, 2**31)

    def quick(self) -> "JointFaults":
        """One cycle, two variations, one place of locking."""
        return replace(self, cycles=1, variations=2, repeats=1, holds=(0.0, 1.0), timestep=0.01)

    def simulate(self, progress: Progress = silent) -> Simulated:
        """Break joints."""
        record = self._campaign(staged(progress, "campaign", 0.0, 0.75))
        record = record.merge(self._spread(staged(progress, "repeats", 0.75, 0.83)))
        record = record.merge(self._held(staged(progress, "places of locking", 0.83, 0.9)))
        lost_pitch = self._lost_pitch(staged(progress, "support", 0.9, 0.92))
        record = record.merge(support(lost_pitch))
        record = record.merge(self._others(staged(progress, "steered, and with the tail lifted", 0.92, 1.0)))
        record = record.assign_attrs(judged_kind=self.kind, judged_legs=self.legs)
        return Simulated(
            record=record, tables={"faults.csv": findings.table(record)}, replays=self._replays(lost_pitch)
        )

    def measure(self, record: xr.Dataset) -> Mapping[str, Measure]:
        """Return what every loss costs in every reading, how far faults are borne, and what carries the body."""
        return findings.measures(record)

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say which choice of reading decides most, what walking without the trunk costs, and what steering does."""
        return findings.explained(measures, self.kind, self.legs)

    @property
    def _duration(self) -> float:
        return START + self.cycles * self.gait.period

    def _varied(self) -> list[tuple[dict[str, Gait], float]]:
        """Return the gaits of both arms and the grip of each variation."""
        chosen: tuple[Chosen, ...] = GAITS.beside("belly_crawl", "chosen", ())
        points = qmc.LatinHypercube(len(chosen) + 1, rng=self.seed).random(max(self.variations - 1, 1))
        varied = [(self._arms(self.gait), 1.0)]
        for point in points[: self.variations - 1]:
            values = {}
            for one, share in zip(chosen, point, strict=False):
                given, reach = value_at(self.gait, one.field), 0.5 * self.spread * (one.high - one.low)
                low, high = max(given - reach, min(one.low, given)), min(given + reach, max(one.high, given))
                values[one.field] = float(low + share * (high - low))
            gait = with_values(self.gait, values)
            grip = float(1.0 + self.grip_spread * (2.0 * point[-1] - 1.0))
            varied.append((self._arms(gait), grip))
        return varied

    def _arms(self, gait: Gait) -> dict[str, Gait]:
        """Return the gaits of all arms with the legs of one gait."""
        limbs = {
            arm: replace(gait, name=other.name, **{name: getattr(other, name) for name in _TRUNK})
            for arm, other in (("limbs_only", self.control), ("limbs_tail_lifted", self.lifted))
        }
        return {"coordinated": gait} | limbs

    def _broken(self, gait: Gait, joint: Joint) -> tuple[Fault, ...]:
        """Return the faults of a joint in the judged reading."""
        return lost(self.robot, gait, joint, self.kind, self.legs, hold=self.hold)

    def _campaign(self, progress: Any) -> xr.Dataset:
        """Run everything in one batch and keep how far each got over time."""
        varied = self._varied()
        cells = list(product(JOINTS, KINDS, LEGS_LOST))
        runs = [
            Run(
                robot=self.robot,
                gait=gaits[arm],
                ground=Ground(grip=grip),
                faults=faults,
                noise=self.noise if i else 0.0,
                seed=self.seed + i,
            )
            for i, (gaits, grip) in enumerate(varied)
            for arm in ARMS
            for faults in ((), *(lost(self.robot, gaits[arm], *cell, hold=self.hold) for cell in cells))
        ]
        record = whole(simulate(runs, duration=self._duration, timestep=self.timestep, every=10, progress=progress))
        net = (displacement(record).sel(xyz=["x", "y"]) ** 2).sum("xyz") ** 0.5
        numbers = {
            "forward": (displacement(record).sel(xyz="x"), "m", "displacement forward"),
            "net": (net, "m", "displacement on the ground"),
            "path": (path_length(record), "m", "length of the way, cycle by cycle"),
            "turn": (heading_change(record), "rad", "how far the body turned, left positive"),
        }
        way = between(record).centre_of_mass.sel(xyz=["x", "y"])
        tracks = (way - way.isel(time=0)).transpose("run", "time", "xyz").values
        shape = (len(varied), len(ARMS), 1 + len(cells))
        data = xr.Dataset(coords={"variation": range(shape[0]), "arm": list(ARMS), "time": way.time.values})
        data = data.assign_coords(joint=list(JOINTS), kind=list(KINDS), legs=list(LEGS_LOST), on_ground=["x", "y"])
        for name, (some, unit, what) in numbers.items():
            lay(data, name, some.values.reshape(shape), (), unit, what)
        lay(data, "track", tracks.reshape(*shape, -1, 2), ("time", "on_ground"), "m", "way of the centre of mass")
        told = meaning.meanings(Gait)
        for one in GAITS.beside("belly_crawl", "chosen", ()):
            values = [value_at(gaits["coordinated"], one.field) for gaits, _ in varied]
            data[f"gait_{one.field}"] = ("variation", values, {"units": meaning.unit(told[one.field])})
        data["grip"] = ("variation", [grip for _, grip in varied], {"units": "1", "long_name": "of all friction"})
        data["time"].attrs["units"] = "s"
        data["period"] = ((), self.gait.period, {"units": "s"})
        return data

    def _spread(self, progress: Any) -> xr.Dataset:
        """Repeat the judged reading in the gait as given, with noise on the servos and other friction."""
        gaits, _ = self._varied()[0]
        grips = np.random.default_rng(self.seed).uniform(1 - self.repeat_grip, 1 + self.repeat_grip, self.repeats)
        runs = [
            Run(
                robot=self.robot,
                gait=gaits[arm],
                ground=Ground(grip=float(grip)),
                faults=faults,
                noise=self.noise,
                seed=self.seed + 1 + i,
            )
            for i, grip in enumerate(grips)
            for arm in ARMS
            for faults in ((), *(self._broken(gaits[arm], joint) for joint in LOST))
        ]
        way = self._forward(runs, progress).reshape(self.repeats, len(ARMS), 1 + len(LOST))
        metre = {"units": "m", "long_name": "displacement forward, repeated"}
        data = xr.Dataset(
            {
                "repeat_intact_forward": (("repeat", "arm"), way[:, :, 0], metre),
                "repeat_forward": (("repeat", "arm", "lost"), way[:, :, 1:], metre),
            }
        )
        return data.assign_coords(arm=list(ARMS), lost=list(LOST))

    def _forward(self, runs: list[Run], progress: Any) -> np.ndarray:
        """Return the displacement forward of each run [m]."""
        record = simulate(runs, duration=self._duration, timestep=self.timestep, every=10, progress=progress)
        return np.asarray(displacement(whole(record)).sel(xyz="x").values)

    def _held(self, progress: Any) -> xr.Dataset:
        """Lock one leg's joint at several places of its range, in the gait as given."""
        gaits, _ = self._varied()[0]
        points = list(product(ARMS, LOST, self.holds))
        runs = [
            Run(robot=self.robot, gait=gaits[a], faults=lost(self.robot, gaits[a], j, "locked", hold=h))
            for a, j, h in points
        ]
        way = self._forward(runs, progress).reshape(len(ARMS), len(LOST), len(self.holds))
        data = xr.Dataset({"held_forward": (("arm", "lost", "hold"), way, {"units": "m"})})
        return data.assign_coords(arm=list(ARMS), lost=list(LOST), hold=list(self.holds))

    def _lost_pitch(self, progress: Any) -> xr.Dataset:
        """Run the gait as given intact, with the right hind pitch joint limp, and with it locked."""
        angle = angle_at(self.robot, self.gait, "RH_pitch", self.hold)
        runs = [
            Run(robot=self.robot, gait=self.gait, faults=faults)
            for faults in ((), (Limp("RH_pitch"),), (Locked("RH_pitch", angle=angle),))
        ]
        return whole(simulate(runs, duration=self._duration, timestep=_FINE, progress=progress))

    def _replays(self, lost_pitch: xr.Dataset) -> Mapping[str, Replay]:
        caption = "The crawl with the right hind pitch joint limp from the start, and, half transparent, intact."
        page = partial(
            replay,
            lost_pitch.isel(run=1),
            self.robot,
            ghost=lost_pitch.isel(run=0),
            labels=("right hind pitch joint limp", "intact"),
            title="One limp leg",
            caption=caption,
        )
        return {"fault_replay.html": Replay(caption=caption, make=page)}

    def _others(self, progress: Any) -> xr.Dataset:
        """Run the judged reading of the article's joints steered, and with limbs only and the tail in the air."""
        control = Coordinated(heading=HeadingRule())
        varied, runs = self._varied(), []
        for i, (gaits, grip) in enumerate(varied):
            ours, lifted = gaits["coordinated"], gaits["limbs_tail_lifted"]
            cases: list[tuple[Gait, tuple[Fault, ...], Control]]
            cases = [(ours, self._broken(ours, joint), control) for joint in LOST]
            cases += [(lifted, (), OpenLoop()), *((lifted, self._broken(lifted, j), OpenLoop()) for j in LOST)]
            runs += [
                Run(
                    robot=self.robot,
                    gait=gait,
                    ground=Ground(grip=grip),
                    faults=faults,
                    control=law,
                    noise=self.noise if i else 0.0,
                    seed=self.seed + i,
                )
                for gait, faults, law in cases
            ]
        record = whole(simulate(runs, duration=self._duration, timestep=self.timestep, every=10, progress=progress))
        shape, steered = (len(varied), 2 * len(LOST) + 1), slice(len(LOST))
        way = displacement(record).sel(xyz="x").values.reshape(shape)
        turned = heading_change(record).values.reshape(shape)
        both, metre = ("variation", "lost"), {"units": "m"}
        return xr.Dataset(
            {
                "steered_forward": (both, way[:, steered], metre | {"long_name": "forward, steered"}),
                "steered_turn": (both, turned[:, steered], {"units": "rad", "long_name": "turned, steered"}),
                "lifted_intact_forward": ("variation", way[:, len(LOST)], metre | {"long_name": "tail lifted, intact"}),
                "lifted_forward": (both, way[:, len(LOST) + 1 :], metre | {"long_name": "forward, tail lifted"}),
            },
            coords={"lost": list(LOST)},
        )

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the losses, the way over time for both kinds of fault, the tracks, and the places of locking."""
        record = outcome.record
        return {
            "fault_losses": draw_losses(record),
            "faults_limp": draw_over_time(record, "limp", self.legs),
            "faults_locked": draw_over_time(record, "locked", self.legs),
            "fault_tracks": draw_tracks(record),
            "fault_places": draw_held(record),
        }


experiment = JointFaults()
