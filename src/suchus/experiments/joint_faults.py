"""How far does the robot still get when joints of its legs are lost?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from scipy.stats import qmc

from suchus.control import Coordinated, HeadingRule
from suchus.design import Chosen, Crocodile, meaning, value_at, with_values
from suchus.design.checks import Checks
from suchus.experiment import Experiment, Outcome, Progress, Replay, silent, staged, stopwatch
from suchus.experiments import _fault_findings as findings
from suchus.experiments._fault_findings import ARMS
from suchus.figures.faults import draw_held, draw_losses, draw_over_time, draw_tracks
from suchus.gaits import GAITS
from suchus.land import KINDS, LEGS_LOST, LOST, Ground, Limp, Locked, Run, angle_at, lost, simulate
from suchus.land.lost import Kind, Legs
from suchus.metrics import (
    between,
    displacement,
    heading_change,
    path_length,
    swing_lift,
    swing_loads,
    whole,
)
from suchus.motion import START, Gait
from suchus.paper import CYCLES
from suchus.replay import replay
from suchus.robots import ROBOTS

_TRUNK = ("trunk_bend", "spine_phase", "tail_bend", "tail_phase", "tail_pitch")  # the rest of a gait is its legs


@dataclass(frozen=True, slots=True, kw_only=True)
class JointFaults(Experiment):
    """Front and hind, yaw and pitch, limp and locked, one leg and both, with spine and tail and without.

    All of it over variations of gait and friction. A change of displacement is measured against the intact run with
    spine and tail of the same variation, as the article does; ``faults.csv`` has it against the intact run of the same
    arm too. A fifth arm, ``steered``, repeats the judged reading with the feedback rules and the heading loop.
    Displacement is forward, along the direction that the body faced at the start.
    """

    title = "How far does it still crawl when joints of its legs are lost?"
    shows = "Section IV.C, Figs 18 to 21"
    claims = (*(f"fault_{joint}_{arm}" for joint in LOST for arm in ARMS), "fault_support", "fault_tolerance")
    decides = (
        "What 'lost' means decides more than which joint is lost, and the article does not say. A limp pitch joint "
        "drops its corner of the body and ends the walk; the same joint locked in mid-range costs little. A limp yaw "
        "joint turns the robot, so that forward, net and path displacement differ. And nearly all of what the article "
        "counts as the cost of a fault without the trunk is the cost of walking without the trunk: its intact robot "
        "with limbs only is already 78 % behind."
    )

    robot: Crocodile = field(default_factory=lambda: ROBOTS["caiman"])
    """Who crawls."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The crawl with spine and tail."""
    control: Gait = field(default_factory=lambda: GAITS["limbs_only"])
    """The crawl of the control group; its legs follow those of ``gait``."""
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
    """Of the physics [s]; 2 ms were measured to move no median by more than three points of a hundred."""
    seed: int = 0
    """Of the variations and their noise."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("cycles", 1, 1000)
            check.whole("variations", 1, 10_000)
            check.number("spread", 0.0, 1.0, "")
            check.number("grip_spread", 0.0, 0.9, "")
            check.number("noise", 0.0, 1.0, "rad")
            check.number("hold", 0.0, 1.0, "")
            check.rising("holds", 0.0, 1.0, "")
            check.number("timestep", 1e-5, 0.01, "s")
            check.whole("seed", 0, 2**31)

    def quick(self) -> "JointFaults":
        """One cycle, two variations, one place of locking."""
        return replace(self, cycles=1, variations=2, holds=(0.0, 1.0), timestep=0.01)

    def run(self, progress: Progress = silent) -> Outcome:
        """Break joints."""
        with stopwatch() as seconds:
            record = self._campaign(staged(progress, "campaign", 0.0, 0.8))
            record = record.merge(self._held(staged(progress, "places of locking", 0.8, 0.9)))
            lost_pitch = self._lost_pitch(staged(progress, "support", 0.9, 0.92))
            record = record.merge(_support(lost_pitch))
            record = record.merge(self._steered(staged(progress, "steered", 0.92, 1.0)))
            return Outcome(
                experiment=self.name(),
                measures=findings.measures(record, self.kind, self.legs),
                verdicts=findings.verdicts(record, self.kind, self.legs),
                record=record,
                settings=self.settings(),
                tables={"faults.csv": findings.table(record)},
                replays=self._replays(lost_pitch),
                seconds=seconds(),
            )

    @property
    def _duration(self) -> float:
        return START + self.cycles * self.gait.period

    def _varied(self) -> list[tuple[dict[str, Gait], float]]:
        """Return the gaits of both arms and the grip of each variation."""
        chosen: tuple[Chosen, ...] = GAITS.beside("belly_crawl", "chosen", ())
        points = qmc.LatinHypercube(len(chosen) + 1, rng=self.seed).random(max(self.variations - 1, 1))
        varied = [({"coordinated": self.gait, "limbs_only": self._limbs(self.gait)}, 1.0)]
        for point in points[: self.variations - 1]:
            values = {}
            for one, share in zip(chosen, point, strict=False):
                given, reach = value_at(self.gait, one.field), 0.5 * self.spread * (one.high - one.low)
                low, high = max(given - reach, min(one.low, given)), min(given + reach, max(one.high, given))
                values[one.field] = float(low + share * (high - low))
            gait = with_values(self.gait, values)
            grip = float(1.0 + self.grip_spread * (2.0 * point[-1] - 1.0))
            varied.append(({"coordinated": gait, "limbs_only": self._limbs(gait)}, grip))
        return varied

    def _limbs(self, gait: Gait) -> Gait:
        """Return the control group's gait with the legs of another."""
        return replace(gait, name=self.control.name, **{name: getattr(self.control, name) for name in _TRUNK})

    def _campaign(self, progress: Any) -> xr.Dataset:
        """Run everything in one batch and keep how far each got over time."""
        varied = self._varied()
        cells = list(product(LOST, KINDS, LEGS_LOST))
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
        data = data.assign_coords(joint=list(LOST), kind=list(KINDS), legs=list(LEGS_LOST), on_ground=["x", "y"])
        for name, (some, unit, what) in numbers.items():
            _lay(data, name, some.values.reshape(shape), (), unit, what)
        _lay(data, "track", tracks.reshape(*shape, -1, 2), ("time", "on_ground"), "m", "way of the centre of mass")
        told = meaning.meanings(Gait)
        for one in GAITS.beside("belly_crawl", "chosen", ()):
            values = [value_at(gaits["coordinated"], one.field) for gaits, _ in varied]
            data[f"gait_{one.field}"] = ("variation", values, {"units": meaning.unit(told[one.field])})
        data["grip"] = ("variation", [grip for _, grip in varied], {"units": "1", "long_name": "of all friction"})
        data["time"].attrs["units"] = "s"
        data["period"] = ((), self.gait.period, {"units": "s"})
        return data

    def _held(self, progress: Any) -> xr.Dataset:
        """Lock one leg's joint at several places of its range, in the gait as given."""
        gaits, _ = self._varied()[0]
        points = list(product(ARMS, LOST, self.holds))
        runs = [
            Run(robot=self.robot, gait=gaits[a], faults=lost(self.robot, gaits[a], j, "locked", hold=h))
            for a, j, h in points
        ]
        record = whole(simulate(runs, duration=self._duration, timestep=0.005, every=100, progress=progress))
        shape = (len(ARMS), len(LOST), len(self.holds))
        way = displacement(record).sel(xyz="x").values.reshape(shape)
        data = xr.Dataset({"held_forward": (("arm", "joint", "hold"), way, {"units": "m"})})
        return data.assign_coords(arm=list(ARMS), joint=list(LOST), hold=list(self.holds))

    def _lost_pitch(self, progress: Any) -> xr.Dataset:
        """Run the gait as given intact, with the right hind pitch joint limp, and with it locked."""
        angle = angle_at(self.robot, self.gait, "RH_pitch", self.hold)
        runs = [
            Run(robot=self.robot, gait=self.gait, faults=faults)
            for faults in ((), (Limp("RH_pitch"),), (Locked("RH_pitch", angle=angle),))
        ]
        return whole(simulate(runs, duration=self._duration, timestep=self.timestep, progress=progress))

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

    def _steered(self, progress: Any) -> xr.Dataset:
        """Run the judged reading of every joint once more with all feedback rules and the heading loop."""
        control = Coordinated(heading=HeadingRule())
        runs = [
            Run(
                robot=self.robot,
                gait=gaits["coordinated"],
                ground=Ground(grip=grip),
                faults=lost(self.robot, gaits["coordinated"], joint, self.kind, self.legs, hold=self.hold),
                control=control,
                noise=self.noise if i else 0.0,
                seed=self.seed + i,
            )
            for i, (gaits, grip) in enumerate(self._varied())
            for joint in LOST
        ]
        record = whole(simulate(runs, duration=self._duration, timestep=self.timestep, every=10, progress=progress))
        shape = (-1, len(LOST))
        way, turned = displacement(record).sel(xyz="x").values, heading_change(record).values
        steered = ("variation", "joint")
        return xr.Dataset(
            {
                "steered_forward": (steered, way.reshape(shape), {"units": "m", "long_name": "forward, steered"}),
                "steered_turn": (steered, turned.reshape(shape), {"units": "rad", "long_name": "turned, steered"}),
            },
            coords={"joint": list(LOST)},
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


def _lay(data: xr.Dataset, name: str, values: np.ndarray, more: tuple[str, ...], unit: str, what: str) -> None:
    """Put values of shape (variation, arm, 1 + fault, ...) into a dataset: the intact apart from the faults."""
    about = {"units": unit, "long_name": what}
    data[f"intact_{name}"] = (("variation", "arm", *more), values[:, :, 0], about)
    shape = (*values.shape[:2], len(LOST), len(KINDS), len(LEGS_LOST), *values.shape[3:])
    data[name] = (("variation", "arm", "joint", "kind", "legs", *more), values[:, :, 1:].reshape(shape), about)


def _support(lost_pitch: xr.Dataset) -> xr.Dataset:
    """Return what carries the body while the right hind leg is meant to swing."""
    loads = swing_loads(lost_pitch, "RH").transpose("run", "part")
    lifted = swing_lift(lost_pitch, "RH").values
    return xr.Dataset(
        {
            "support": (("state", "part"), loads.values, {"units": "N", "long_name": "mean load while RH swings"}),
            "lifted": ("state", lifted, {"units": "m", "long_name": "rise of the RH foot"}),
        },
        coords={"state": ["intact", *KINDS], "part": [str(name) for name in loads.part.values]},
    )


experiment = JointFaults()
