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
from suchus.experiment import Experiment, Measure, Outcome, Progress, Replay, judge, silent, staged, stopwatch
from suchus.figures.faults import draw_held, draw_losses, draw_over_time, draw_tracks
from suchus.gaits import GAITS
from suchus.land import KINDS, LEGS_LOST, LOST, Ground, Limp, Locked, Run, angle_at, lost, simulate
from suchus.land.lost import Kind, Legs
from suchus.metrics import (
    between,
    displacement,
    heading_change,
    loss,
    path_length,
    says,
    swing_lift,
    swing_loads,
    whole,
)
from suchus.motion import START, Gait
from suchus.paper import CLAIMS, CYCLES
from suchus.replay import replay
from suchus.robots import ROBOTS

_ARMS = ("coordinated", "limbs_only")
_CELLS = ("joint", "kind", "legs", "arm")
_TRUNK = ("trunk_bend", "spine_phase", "tail_bend", "tail_phase", "tail_pitch")  # the rest of a gait is its legs
_CARRIERS = ("tail", "RF", "LH")  # what the article says carries the body while the damaged RH swings


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
    claims = (*(f"fault_{joint}_{arm}" for joint in LOST for arm in _ARMS), "fault_support", "fault_tolerance")
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
                measures=self._measures(record),
                verdicts=self._verdicts(record),
                record=record,
                settings=self.settings(),
                tables={"faults.csv": _table(record)},
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
            for arm in _ARMS
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
        shape = (len(varied), len(_ARMS), 1 + len(cells))
        data = xr.Dataset(coords={"variation": range(shape[0]), "arm": list(_ARMS), "time": way.time.values})
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
        points = list(product(_ARMS, LOST, self.holds))
        runs = [
            Run(robot=self.robot, gait=gaits[a], faults=lost(self.robot, gaits[a], j, "locked", hold=h))
            for a, j, h in points
        ]
        record = whole(simulate(runs, duration=self._duration, timestep=0.005, every=100, progress=progress))
        shape = (len(_ARMS), len(LOST), len(self.holds))
        way = displacement(record).sel(xyz="x").values.reshape(shape)
        data = xr.Dataset({"held_forward": (("arm", "joint", "hold"), way, {"units": "m"})})
        return data.assign_coords(arm=list(_ARMS), joint=list(LOST), hold=list(self.holds))

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

    def _measures(self, record: xr.Dataset) -> Mapping[str, Measure]:
        change, measures = _changes(record), {}
        for arm in _ARMS:
            measures[f"forward_{arm}"] = Measure(float(record.intact_forward.sel(arm=arm)[0]), "m")
        bare = loss(record.intact_forward.sel(arm="limbs_only"), record.intact_forward.sel(arm="coordinated"))
        measures |= _ranged("loss_intact_limbs_only", bare, "-")
        for cell in product(LOST, KINDS, LEGS_LOST, _ARMS):
            at, name = dict(zip(_CELLS, cell, strict=True)), "_".join(cell)
            measures |= _ranged(f"loss_{name}", change["forward"].sel(at), "-")
            measures[f"net_loss_{name}"] = Measure(float(change["net"].sel(at).median()), "-")
            measures[f"path_loss_{name}"] = Measure(float(change["path"].sel(at).median()), "-")
            measures[f"turn_{name}"] = Measure(float(record.turn.sel(at).median()), "rad")
        kept = loss(record.steered_forward, record.intact_forward.sel(arm="coordinated", drop=True))
        for joint in LOST:
            name = f"{joint}_{self.kind}_{self.legs}_steered"
            measures |= _ranged(f"loss_{name}", kept.sel(joint=joint), "-")
            measures[f"turn_{name}"] = Measure(float(record.steered_turn.sel(joint=joint).median()), "rad")
        better, beyond = _bears_better(record), _kept(record).sel(arm="limbs_only")
        measures["share_spine_and_tail_bear_better"] = Measure(float(better.mean()), "-")
        measures["share_limbs_only_beyond_intact"] = Measure(float((beyond > 1.0).mean()), "-")
        measures["greatest_limbs_only_over_intact"] = Measure(float(beyond.median("variation").max()), "-")
        for state in record.state.values:
            measures[f"support_share_{state}"] = Measure(_carried(record, str(state)), "-")
            measures[f"foot_lift_{state}"] = Measure(float(record.lifted.sel(state=state)), "m")
        return measures

    def _verdicts(self, record: xr.Dataset) -> tuple[Any, ...]:
        change = _changes(record)["forward"].median("variation")
        judged = []
        for joint, arm in product(LOST, _ARMS):
            key, cells = f"fault_{joint}_{arm}", change.sel(joint=joint, arm=arm)
            value = float(cells.sel(kind=self.kind, legs=self.legs))
            judged.append(judge(key, value, self._why(record, cells, arm), holds=bool(says(key, np.array(value)))))
        better = _bears_better(record)
        by_joint = ", ".join(f"{j.replace('_', ' ')} {100 * float(better.sel(joint=j).mean()):.0f} %" for j in LOST)
        ahead = (record.forward.sel(arm="coordinated") > record.forward.sel(arm="limbs_only")).mean()
        carried = {str(state): _carried(record, str(state)) for state in record.state.values}
        return (
            *judged,
            judge(
                "fault_support",
                carried[self.kind],
                f"While the damaged right hind leg is meant to swing, tail, right front and left hind foot carry "
                f"{100 * carried[self.kind]:.0f} % of the weight with its pitch joint {self.kind}, "
                f"{100 * carried['intact']:.0f} % intact; the tail's own part is {_tail(record, self.kind):.1f} N. The "
                f"foot rises {1000 * float(record.lifted.sel(state=self.kind)):.0f} mm "
                f"(intact {1000 * float(record.lifted.sel(state='intact')):.0f} mm).",
                holds=carried[self.kind] > 0.5 and float(record.lifted.sel(state=self.kind)) > 0.002,
            ),
            judge(
                "fault_tolerance",
                float(better.mean()),
                "Part of all faults and variations in which more of its own intact displacement is kept with spine "
                f"and tail than with limbs only: {by_joint}. In metres it is ahead in {100 * float(ahead):.0f} %.",
                holds=float(better.mean()) > 0.5,
            ),
        )

    def _why(self, record: xr.Dataset, cells: xr.DataArray, arm: str) -> str:
        """Return what each reading of the fault gives, and how far the intact robot of the arm is behind."""
        told = "; ".join(
            f"{kind}, {legs} {100 * float(cells.sel(kind=kind, legs=legs)):+.0f} %"
            for kind, legs in product(KINDS, LEGS_LOST)
        )
        text = f"Medians over {self.variations} gaits and frictions: {told}; judged is {self.kind}, {self.legs}."
        if arm == "coordinated":
            return text
        bare = loss(record.intact_forward.sel(arm="limbs_only"), record.intact_forward.sel(arm="coordinated"))
        key = str(cells.joint.values)
        printed = CLAIMS[f"fault_{key}_limbs_only"].value or 0.0
        ways = {a: CLAIMS[f"displacement_{a}"].value or 0.0 for a in _ARMS}
        left = ways["coordinated"] * (1.0 + printed)
        text += f" The intact robot of limbs alone is already at {100 * float(bare.median()):+.0f} %."
        if left > ways["limbs_only"]:
            text += (
                f" The article's {100 * printed:+.0f} % leave {left:.2f} m, more than its own intact "
                f"{ways['limbs_only']:.2f} m."
            )
        return text

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


def _changes(record: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the changes against the intact run with spine and tail."""
    return {
        name: loss(record[name], record[f"intact_{name}"].sel(arm="coordinated", drop=True))
        for name in ("forward", "net", "path")
    }


def _kept(record: xr.Dataset) -> xr.DataArray:
    """Return the part of its own intact displacement that each arm keeps; going backwards is keeping nothing [-]."""
    return (record.forward / record.intact_forward).clip(min=0.0)


def _bears_better(record: xr.Dataset) -> xr.DataArray:
    """Tell where the robot keeps more of its own with spine and tail than with limbs only."""
    kept = _kept(record)
    return kept.sel(arm="coordinated") > kept.sel(arm="limbs_only")


def _ranged(name: str, values: xr.DataArray, unit: str) -> dict[str, Measure]:
    return {
        name: Measure(float(values.median()), unit),
        f"{name}_low": Measure(float(values.min()), unit),
        f"{name}_high": Measure(float(values.max()), unit),
    }


def _carried(record: xr.Dataset, state: str) -> float:
    load = record.support.sel(state=state)
    return float(load.sel(part=list(_CARRIERS)).sum() / load.sum())


def _tail(record: xr.Dataset, state: str) -> float:
    return float(record.support.sel(state=state, part="tail"))


def _table(record: xr.Dataset) -> str:
    """Return one row per fault and arm: medians over the variations, with ranges where a paper needs them."""
    change, own = _changes(record), loss(record.forward, record.intact_forward)
    head = "joint,kind,legs,arm,forward_m,change,change_low,change_high,change_of_own_intact,net_change,path_change,"
    rows = [head + "turn_deg,printed_change"]
    for cell in product(LOST, KINDS, LEGS_LOST, _ARMS):
        at = dict(zip(_CELLS, cell, strict=True))
        forward = change["forward"].sel(at)
        numbers = (
            record.forward.sel(at).median(),
            forward.median(),
            forward.min(),
            forward.max(),
            own.sel(at).median(),
            change["net"].sel(at).median(),
            change["path"].sel(at).median(),
        )
        told = [f"{float(number):.3f}" for number in numbers]
        turned = f"{float(np.degrees(record.turn.sel(at).median())):.1f}"
        printed = f"{CLAIMS[f'fault_{cell[0]}_{cell[3]}'].value:.2f}"
        rows.append(",".join((*cell, *told, turned, printed)))
    return "\n".join(rows) + "\n"


experiment = JointFaults()
