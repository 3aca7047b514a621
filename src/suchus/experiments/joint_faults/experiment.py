"""How far does the robot still get when joints of its legs fail?"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import combinations, product
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from scipy import stats
from scipy.stats import qmc

from suchus.control import Control, Coordinated, HeadingRule, OpenLoop
from suchus.design import Chosen, Robot, layout, unit_at, value_at, with_values
from suchus.design.checks import Checks
from suchus.design.scale import coarse_step
from suchus.experiment import Experiment, Measure, Outcome, Progress, Replay, Simulated, ends, estimated, silent, staged
from suchus.experiments._replayed import replayed
from suchus.experiments.joint_faults.figure import draw_held, draw_losses, draw_over_time, draw_tracks
from suchus.gaits import GAITS, conditions_of, control_group
from suchus.gaits.limbs_tail_lifted import LIFTED
from suchus.land import (
    KINDS,
    LEGS_FAILED,
    Fault,
    Ground,
    Limp,
    Locked,
    Run,
    angle_at,
    failing_joints,
    joint_failure,
    simulate,
)
from suchus.land.failed import Kind, Legs
from suchus.metrics import (
    between,
    displacement,
    heading_change,
    loss,
    path_length,
    swing_height,
    swing_lift,
    swing_loads,
    swing_unloaded,
    whole,
)
from suchus.motion import START, Gait, suits
from suchus.paper import CLAIMS, CYCLES
from suchus.robots import ROBOTS

_OF_A_LIMB = 2  # hinges of a limb, from the hip on, whose loss is repeated and steered; the article's yaw and pitch
ARMS = ("coordinated", "limbs_only")
"""With spine and tail, and without."""
_CELLS = ("joint", "kind", "legs", "arm")


@dataclass(frozen=True, slots=True, kw_only=True)
class JointFaults(Experiment):
    """Front and hind; yaw, pitch and knee; limp and locked; one leg and both; with spine and tail and with limbs only.

    All of it over variations of gait and friction. A change of displacement is measured against the intact run with
    spine and tail of the same variation, as the article does; ``faults.csv`` has it against the intact run of the same
    condition too. Two more conditions are run in the judged reading: ``steered`` with the feedback rules and the
    heading loop, and ``limbs_tail_lifted``, limbs only with the tail in the air, where a servo lifts it. Displacement
    is forward, along the direction that the body faced at the start. The limbs of another body lose the joints that
    they have.
    """

    title = "How far does it still crawl when joints of its legs fail?"
    shows = "Section IV.C, Figs 18 to 21"
    answers = (
        "forward_coordinated",
        "loss_front_yaw_limp_one_coordinated",
        "loss_front_pitch_limp_one_coordinated",
        "loss_hind_yaw_limp_one_coordinated",
        "loss_hind_pitch_limp_one_coordinated",
        "share_spine_and_tail_bear_better",
    )
    needs = ("limbs",)
    judged_with = ("robot", "gait", "control_group", "lifted", "cycles", "hold", "kind", "legs")
    judged_from: ClassVar[Mapping[str, float]] = {"variations": 8, "repeats": 4}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot whose joints fail."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The crawl with spine and tail."""
    control: Gait | None = None
    """The gait of the control group, which has the same legs; None for the gait with its axis still."""
    lifted: float = LIFTED
    """Pitch of the tail of the control group with its tail in the air, for comparison, down positive [rad]."""
    cycles: int = int(CYCLES)
    """Number of cycles that are measured [-]."""
    variations: int = 8
    """Gaits and frictions [-]; the first is the gait as given, without noise."""
    spread: float = 0.25
    """Part of each plausible range of the gait's numbers that the variations cover, about the number given [-]."""
    friction_spread: float = 0.2
    """Half-width of the uniform spread of the friction, as a fraction of it [-]."""
    noise: float = 0.01
    """Standard deviation of the noise on every commanded angle [rad]; a hobby servo's dead band."""
    repeats: int = 4
    """Runs of the judged reading in the gait as given, with noise and another friction, for the spread [-]."""
    repeat_friction_spread: float = 0.1
    """Half-width of the uniform spread of the friction in the repeats, as a fraction of it [-]."""
    hold: float = 0.5
    """Where a locked joint holds in the range that the gait asks of it: 0 least, 1 greatest [-].

    Not in the paper; the middle, because a servo that no longer hears commands may stop anywhere and the middle is
    farthest from both ends. ``Locked`` without an angle would hold where the joint is when it fails, which at the
    start of a run is an accident of the phase; what other places do is measured over ``holds``.
    """
    holds: tuple[float, ...] = (0.0, 0.25, 0.5, 0.75, 1.0)
    """Places in that range at which one leg's joint is locked, for the curve [-]."""
    kind: Kind = "limp"
    """The reading of the article's 'lost' that is judged.

    Not in the paper; limp, because a servo that 'cannot receive and execute commands' gets no pulses, and gives way.
    """
    legs: Legs = "one"
    """Whether one leg or both of a girdle are judged; one, because the text speaks of individual joints."""
    timestep: float = 0.005
    """Time step of the physics [s]; 2 ms were measured to move no median by more than 3 points of a hundred, while
    10 ms move some by 6 and change what steering does to a failed hind yaw joint."""
    seed: int = 0
    """Seed of the variations and their noise [-]."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("cycles", 1, 1000)
            check.whole("variations", 1, 10_000)
            check.number("spread", 0.0, 1.0, "")
            check.number("friction_spread", 0.0, 0.9, "")
            check.whole("repeats", 1, 10_000)
            check.number("repeat_friction_spread", 0.0, 0.9, "")
            check.number("noise", 0.0, 1.0, "rad")
            check.number("hold", 0.0, 1.0, "")
            check.rising("holds", 0.0, 1.0, "")
            check.number("timestep", 1e-5, 0.01, "s")
            check.number("lifted", -1.6, 1.6, "rad")
            check.whole("seed", 0, 2**31)
        control_group(self.gait, self.control)

    def quick(self) -> "JointFaults":
        """One cycle, two variations, one place of locking."""
        return replace(self, cycles=1, variations=2, repeats=1, holds=(0.0, 1.0), timestep=0.01)

    def simulate(self, progress: Progress = silent) -> Simulated:
        """Break joints."""
        record = self._campaign(staged(progress, "campaign", 0.0, 0.75))
        record = record.merge(self._spread(staged(progress, "repeats", 0.75, 0.83)))
        record = record.merge(self._locked_at(staged(progress, "places of locking", 0.83, 0.9)))
        lost_pitch = self._failed_pitch(staged(progress, "support", 0.9, 0.92))
        record = record.merge(support(lost_pitch))
        record = record.merge(self._others(staged(progress, "steered, and with the tail lifted", 0.92, 1.0)))
        record = record.assign_attrs(judged_kind=self.kind, judged_legs=self.legs)
        return Simulated(record=record, tables={"faults.csv": table(record)}, replays=self._replays(lost_pitch))

    def measure(self, record: xr.Dataset) -> Mapping[str, Measure]:
        """Return what every loss costs in every reading, how far faults are borne, and what carries the body."""
        reading = f"{record.attrs['judged_kind']}_{record.attrs['judged_legs']}"
        ours = record.intact_forward.sel(arm="coordinated", drop=True)
        measures: dict[str, Measure] = {}
        for arm in ARMS:
            measures[f"forward_{arm}"] = Measure(float(record.intact_forward.sel(arm=arm)[0]), "m")
        lifts, steers = "lifted_forward" in record, "steered_forward" in record
        if lifts:
            measures["forward_limbs_tail_lifted"] = Measure(float(record.lifted_intact_forward[0]), "m")
        measures |= _over_variations(
            "loss_intact_limbs_only", loss(record.intact_forward.sel(arm="limbs_only"), ours), "-"
        )
        if lifts:
            measures |= _over_variations("loss_intact_limbs_tail_lifted", loss(record.lifted_intact_forward, ours), "-")
        measures |= _readings(record)
        for joint in record.lost.values:
            name = f"loss_{joint}_{reading}"
            if steers:
                measures |= _over_variations(f"{name}_steered", loss(record.steered_forward, ours).sel(lost=joint), "-")
                turned = record.steered_turn.sel(lost=joint).median()
                measures[f"turn_{joint}_{reading}_steered"] = Measure(float(turned), "rad")
            if lifts:
                measures |= _over_variations(
                    f"{name}_limbs_tail_lifted", loss(record.lifted_forward, ours).sel(lost=joint), "-"
                )
            for arm in ARMS:
                losses = loss(record.repeat_forward.sel(arm=arm), record.repeat_intact_forward.sel(arm="coordinated"))
                measures |= ends(f"{name}_{arm}_repeated", losses.sel(lost=joint), "-")
        return measures | _effects(record) | tolerance(record) | _support_measures(record)

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say which choice of reading decides most, what walking without the trunk costs, and what steering does."""
        ends = f"_{KINDS[0]}_{LEGS_FAILED[0]}_coordinated"
        others = {
            name.removeprefix("loss_").removesuffix(ends): loss
            for name, loss in measures.items()
            if name.startswith("loss_") and name.endswith(ends) and f"{name}_repeated_low" not in measures
        }
        return self.told(measures, others=others, only_knees=all("knee" in joint for joint in others))

    @property
    def _duration(self) -> float:
        return START + self.cycles * self.gait.period

    def _varied(self) -> list[tuple[dict[str, Gait], float]]:
        """Return the gaits of both conditions and the friction scale of each variation."""
        chosen = self._plausible
        if not chosen:
            return self._varied_together()
        points = qmc.LatinHypercube(len(chosen) + 1, rng=self.seed).random(max(self.variations - 1, 1))
        varied = [(self._arms(self.gait), 1.0)]
        for point in points[: self.variations - 1]:
            values = {}
            for one, share in zip(chosen, point, strict=False):
                given, reach = value_at(self.gait, one.field), 0.5 * self.spread * (one.high - one.low)
                low, high = max(given - reach, min(one.low, given)), min(given + reach, max(one.high, given))
                values[one.field] = float(low + share * (high - low))
            gait = with_values(self.gait, values)
            gait = gait if suits(self.robot, gait) else self.gait
            scale = float(1.0 + self.friction_spread * (2.0 * point[-1] - 1.0))
            varied.append((self._arms(gait), scale))
        return varied

    @property
    def _plausible(self) -> tuple[Chosen, ...]:
        """The gait's numbers with their plausible ranges; none of a gait that does not stand on the shelf."""
        name = self.gait.name
        return tuple(GAITS.beside(name, "chosen", ())) if name in GAITS and GAITS[name] == self.gait else ()

    def _varied_together(self) -> list[tuple[dict[str, Gait], float]]:
        """Return the same for a gait without plausible ranges, of which all strokes and all bends vary together."""
        points = qmc.LatinHypercube(3, rng=self.seed).random(max(self.variations - 1, 1))
        varied = [(self._arms(self.gait), 1.0)]
        for point in points[: self.variations - 1]:
            stroke, bend = 1.0 + 0.5 * self.spread * (2.0 * point[:2] - 1.0)
            gait = self.gait.strode(float(stroke)).bent(float(bend))
            gait = gait if suits(self.robot, gait) else self.gait
            varied.append((self._arms(gait), float(1.0 + self.friction_spread * (2.0 * point[-1] - 1.0))))
        return varied

    @property
    def _joints(self) -> tuple[str, ...]:
        """Names of the joints that fail."""
        return failing_joints(self.robot)

    @property
    def _failing(self) -> tuple[str, ...]:
        """The joints whose loss is repeated, steered and locked in several places."""
        return self._joints[: _OF_A_LIMB * len(self.robot.girdles)]

    @property
    def control_group(self) -> Gait:
        """The gait of the control group."""
        return control_group(self.gait, self.control)

    @property
    def _lifts(self) -> bool:
        """Whether the control group can lift its tail."""
        return "limbs_tail_lifted" in conditions_of(self.robot, self.gait, self.control_group)

    def _arms(self, gait: Gait) -> dict[str, Gait]:
        """Return the gaits of all conditions with the legs of one gait."""
        limbs_only = _with_axis(gait, self.control_group)
        lifted = limbs_only.lifted(self.lifted, name="limbs_tail_lifted") if self._lifts else limbs_only
        return {"coordinated": gait, "limbs_only": limbs_only, "limbs_tail_lifted": lifted}

    def _broken(self, gait: Gait, joint: str) -> tuple[Fault, ...]:
        """Return the faults of a joint in the judged reading."""
        return joint_failure(self.robot, gait, joint, self.kind, self.legs, hold=self.hold)

    def _campaign(self, progress: Any) -> xr.Dataset:
        """Run everything in one batch and keep how far each got over time."""
        varied = self._varied()
        cells = list(product(self._joints, KINDS, LEGS_FAILED))
        runs = [
            Run(
                robot=self.robot,
                gait=gaits[arm],
                ground=Ground(friction_scale=scale),
                faults=faults,
                noise=self.noise if i else 0.0,
                seed=self.seed + i,
            )
            for i, (gaits, scale) in enumerate(varied)
            for arm in ARMS
            for faults in ((), *(joint_failure(self.robot, gaits[arm], *cell, hold=self.hold) for cell in cells))
        ]
        record = whole(simulate(runs, duration=self._duration, timestep=self.timestep, every=10, progress=progress))
        net = (displacement(record).sel(xyz=["x", "y"]) ** 2).sum("xyz") ** 0.5
        numbers = {
            "forward": (displacement(record).sel(xyz="x"), "m", "displacement forward"),
            "net": (net, "m", "displacement on the ground"),
            "path": (path_length(record), "m", "path length, cycle by cycle"),
            "turn": (heading_change(record), "rad", "how far the body turned, left positive"),
        }
        distance = between(record).centre_of_mass.sel(xyz=["x", "y"])
        tracks = (distance - distance.isel(time=0)).transpose("run", "time", "xyz").values
        shape = (len(varied), len(ARMS), 1 + len(cells))
        data = xr.Dataset(coords={"variation": range(shape[0]), "arm": list(ARMS), "time": distance.time.values})
        data = data.assign_coords(
            joint=list(self._joints), kind=list(KINDS), legs=list(LEGS_FAILED), on_ground=["x", "y"]
        )
        for name, (array, unit, what) in numbers.items():
            lay(data, name, array.values.reshape(shape), (), unit, what)
        lay(data, "track", tracks.reshape(*shape, -1, 2), ("time", "on_ground"), "m", "track of the centre of mass")
        for row in self._plausible:
            values = [value_at(gaits["coordinated"], row.field) for gaits, _ in varied]
            name = "_".join(re.findall(r"\w+", row.field))
            data[f"gait_{name}"] = ("variation", values, {"units": unit_at(self.gait, row.field)})
        data["grip"] = ("variation", [scale for _, scale in varied], {"units": "1", "long_name": "friction scale"})
        data["time"].attrs["units"] = "s"
        data["period"] = ((), self.gait.period, {"units": "s"})
        return data

    def _spread(self, progress: Any) -> xr.Dataset:
        """Repeat the judged reading in the gait as given, with noise on the servos and other friction."""
        gaits, _ = self._varied()[0]
        spread = self.repeat_friction_spread
        scales = np.random.default_rng(self.seed).uniform(1 - spread, 1 + spread, self.repeats)
        runs = [
            Run(
                robot=self.robot,
                gait=gaits[arm],
                ground=Ground(friction_scale=float(scale)),
                faults=faults,
                noise=self.noise,
                seed=self.seed + 1 + i,
            )
            for i, scale in enumerate(scales)
            for arm in ARMS
            for faults in ((), *(self._broken(gaits[arm], joint) for joint in self._failing))
        ]
        distance = self._forward(runs, progress).reshape(self.repeats, len(ARMS), 1 + len(self._failing))
        metre = {"units": "m", "long_name": "displacement forward, repeated"}
        data = xr.Dataset(
            {
                "repeat_intact_forward": (("repeat", "arm"), distance[:, :, 0], metre),
                "repeat_forward": (("repeat", "arm", "lost"), distance[:, :, 1:], metre),
            }
        )
        return data.assign_coords(arm=list(ARMS), lost=list(self._failing))

    def _forward(self, runs: list[Run], progress: Any) -> np.ndarray:
        """Return the displacement forward of each run [m]."""
        record = simulate(runs, duration=self._duration, timestep=self.timestep, every=10, progress=progress)
        return np.asarray(displacement(whole(record)).sel(xyz="x").values)

    def _locked_at(self, progress: Any) -> xr.Dataset:
        """Lock one leg's joint at several places of its range, in the gait as given."""
        gaits, _ = self._varied()[0]
        points = list(product(ARMS, self._failing, self.holds))
        runs = [
            Run(robot=self.robot, gait=gaits[a], faults=joint_failure(self.robot, gaits[a], j, "locked", hold=h))
            for a, j, h in points
        ]
        distance = self._forward(runs, progress).reshape(len(ARMS), len(self._failing), len(self.holds))
        data = xr.Dataset({"held_forward": (("arm", "lost", "hold"), distance, {"units": "m"})})
        return data.assign_coords(arm=list(ARMS), lost=list(self._failing), hold=list(self.holds))

    def _failed_pitch(self, progress: Any) -> xr.Dataset:
        """Run the gait as given intact, with the right hind pitch joint limp, and with it locked.

        Of a limb with one hinge it is that one.
        """
        hind = layout(self.robot).limbs[-1]
        servo = layout(self.robot).servos[hind.servos][-1 if hind.servos.stop - hind.servos.start == 1 else 1]
        angle = angle_at(self.robot, self.gait, servo, self.hold)
        runs = [
            Run(robot=self.robot, gait=self.gait, faults=faults)
            for faults in ((), (Limp(servo),), (Locked(servo, angle=angle),))
        ]
        return whole(simulate(runs, duration=self._duration, timestep=coarse_step(self.robot), progress=progress))

    def _replays(self, lost_pitch: xr.Dataset) -> Mapping[str, Replay]:
        return replayed(
            "fault_replay.html",
            lost_pitch.isel(run=1),
            self.robot,
            ghost=lost_pitch.isel(run=0),
            labels=("right hind pitch joint limp", "intact"),
            title="One limp leg",
            caption="With the right hind pitch joint limp from the start, and, half transparent, intact.",
        )

    def _others(self, progress: Any) -> xr.Dataset:
        """Run the judged reading of the article's joints steered, and with limbs only and the tail in the air."""
        joints, steers = self._failing, self.gait.has("steering")
        varied, runs = self._varied(), []
        for i, (gaits, scale) in enumerate(varied):
            cases: list[tuple[Gait, tuple[Fault, ...], Control]] = []
            if steers:
                ours = gaits["coordinated"]
                control = Coordinated(heading=HeadingRule()).suited(self.robot, ours)
                cases += [(ours, self._broken(ours, joint), control) for joint in joints]
            if self._lifts:
                lifted = gaits["limbs_tail_lifted"]
                cases += [(lifted, (), OpenLoop()), *((lifted, self._broken(lifted, j), OpenLoop()) for j in joints)]
            runs += [
                Run(
                    robot=self.robot,
                    gait=gait,
                    ground=Ground(friction_scale=scale),
                    faults=faults,
                    control=law,
                    noise=self.noise if i else 0.0,
                    seed=self.seed + i,
                )
                for gait, faults, law in cases
            ]
        data = xr.Dataset(coords={"lost": list(joints)})
        if not runs:
            return data
        record = whole(simulate(runs, duration=self._duration, timestep=self.timestep, every=10, progress=progress))
        distance = displacement(record).sel(xyz="x").values.reshape(len(varied), -1)
        turned = heading_change(record).values.reshape(len(varied), -1)
        both, metre, many = ("variation", "lost"), {"units": "m"}, len(joints)
        if steers:
            data["steered_forward"] = (both, distance[:, :many], metre | {"long_name": "forward, steered"})
            data["steered_turn"] = (both, turned[:, :many], {"units": "rad", "long_name": "turned, steered"})
        if self._lifts:
            intact, broken = distance[:, -many - 1], distance[:, -many:]
            data["lifted_intact_forward"] = ("variation", intact, metre | {"long_name": "tail lifted, intact"})
            data["lifted_forward"] = (both, broken, metre | {"long_name": "forward, tail lifted"})
        return data

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the losses, the distance over time for both kinds of fault, the tracks, and the places of locking."""
        record = outcome.record
        return {
            "fault_losses": draw_losses(record),
            "faults_limp": draw_over_time(record, "limp", self.legs),
            "faults_locked": draw_over_time(record, "locked", self.legs),
            "fault_tracks": draw_tracks(record),
            "fault_places": draw_held(record),
        }


def _with_axis(gait: Gait, other: Gait) -> Gait:
    """Return a gait with the name of another one and what that one does with the axis."""
    limbs = tuple(curve for curve in gait.curves if curve.part == "limb")
    axial = tuple(curve for curve in other.curves if curve.part != "limb")
    return replace(gait, name=other.name, axis=other.axis, curves=(*limbs, *axial))


def lay(data: xr.Dataset, name: str, values: np.ndarray, more: tuple[str, ...], unit: str, what: str) -> None:
    """Put values of shape (variation, arm, 1 + fault, ...) into a dataset: the intact apart from the faults."""
    about = {"units": unit, "long_name": what}
    data[f"intact_{name}"] = (("variation", "arm", *more), values[:, :, 0], about)
    shape = (*values.shape[:2], data.sizes["joint"], len(KINDS), len(LEGS_FAILED), *values.shape[3:])
    data[name] = (("variation", "arm", "joint", "kind", "legs", *more), values[:, :, 1:].reshape(shape), about)


def support(lost_pitch: xr.Dataset) -> xr.Dataset:
    """Return what carries the body while the last limb, the right hind leg, is meant to swing."""
    leg = str(lost_pitch.leg.values[-1])
    loads = swing_loads(lost_pitch, leg).transpose("run", "part")
    lifted, free = swing_lift(lost_pitch, leg).values, swing_unloaded(lost_pitch, leg).values
    height = swing_height(lost_pitch, leg).values
    return xr.Dataset(
        {
            "support": (("state", "part"), loads.values, {"units": "N", "long_name": f"mean load while {leg} swings"}),
            "lifted": ("state", lifted, {"units": "m", "long_name": f"rise of the {leg} foot"}),
            "free": ("state", free, {"units": "1", "long_name": f"share of its swing in which the {leg} foot is free"}),
            "swing_height": ("state", height, {"units": "m", "long_name": f"centre of mass while {leg} swings"}),
        },
        coords={"state": ["intact", *KINDS], "part": [str(name) for name in loads.part.values]},
    )


def _readings(record: xr.Dataset) -> dict[str, Measure]:
    """Return what every reading of every failure costs in both conditions."""
    change = _changes(record)
    measures: dict[str, Measure] = {}
    for cell in product(record.joint.values, KINDS, LEGS_FAILED, ARMS):
        reading, name = dict(zip(_CELLS, cell, strict=True)), "_".join(cell)
        measures |= _over_variations(f"loss_{name}", change["forward"].sel(reading), "-")
        measures[f"net_loss_{name}"] = Measure(float(change["net"].sel(reading).median()), "-")
        measures[f"path_loss_{name}"] = Measure(float(change["path"].sel(reading).median()), "-")
        measures[f"turn_{name}"] = Measure(float(record.turn.sel(reading).median()), "rad")
    return measures


def _effects(record: xr.Dataset) -> dict[str, Measure]:
    """Return by how much the change with spine and tail differs on average between two readings of one thing [-]."""
    change = _changes(record)["forward"].sel(arm="coordinated", joint=record.lost.values).median("variation")
    effects = {}
    for name, dim in (("kind", "kind"), ("joint", "joint"), ("legs", "legs")):
        pairs = combinations(change[dim].values, 2)
        apart = [float(abs(change.sel({dim: a}) - change.sel({dim: b})).mean()) for a, b in pairs]
        effects[f"effect_of_{name}"] = Measure(float(np.mean(apart)), "-")
    return effects


def tolerance(record: xr.Dataset) -> dict[str, Measure]:
    """Return how much more of its own the robot keeps with spine and tail, and how probable that is by chance.

    The variations are independent of each other, the faults within one of them are not: the exact sign test counts
    variations, by the mean over all faults of the article's joints.
    """
    failed = record.lost.values if "lost" in record.coords else record.joint.values
    share_kept = _kept(record).sel(joint=failed)
    ours, bare = (share_kept.sel(arm=arm, drop=True) for arm in ARMS)
    better, gain = ours > bare, (ours - bare).mean(("joint", "kind", "legs"))
    won, decided = int((gain > 0).sum()), int((gain != 0).sum())
    chance = float(stats.binomtest(won, decided, 0.5, alternative="greater").pvalue) if decided else 1.0
    ahead = record.forward.sel(arm="coordinated") > record.forward.sel(arm="limbs_only")
    measures = {
        "share_spine_and_tail_bear_better": Measure(float(better.mean()), "-"),
        "share_variations_bear_better": Measure(won / share_kept.sizes["variation"], "-"),
        "chance_spine_and_tail_bear_better": Measure(chance, "-"),
        "share_spine_and_tail_ahead": Measure(float(ahead.sel(joint=failed).mean()), "-"),
        "share_limbs_only_beyond_intact": Measure(float((bare > 1.0).mean()), "-"),
        "greatest_limbs_only_over_intact": Measure(float(bare.median("variation").max()), "-"),
    }
    for joint in failed:
        measures[f"share_bear_better_{joint}"] = Measure(float(better.sel(joint=joint).mean()), "-")
    return measures


def _support_measures(record: xr.Dataset) -> dict[str, Measure]:
    """Return what carries the body while the right hind leg is meant to swing, and how high it is carried."""
    measures: dict[str, Measure] = {}
    height, parts = record.swing_height, [str(part) for part in record.part.values]
    legs = [part for part in parts if part not in ("tail", "belly")]
    carriers = ["tail", *([legs[-3]] if len(legs) > 2 else []), legs[-2]]  # beside the last leg and ahead of it
    for state in (str(one) for one in record.state.values):
        load = record.support.sel(state=state)
        measures |= {
            f"support_share_{state}": Measure(float(load.sel(part=carriers).sum() / load.sum()), "-"),
            f"tail_load_{state}": Measure(float(load.sel(part="tail")), "N"),
            f"foot_lift_{state}": Measure(float(record.lifted.sel(state=state)), "m"),
            f"foot_free_{state}": Measure(float(record.free.sel(state=state)), "-"),
            f"com_height_{state}": Measure(float(height.sel(state=state)), "m"),
            f"com_rise_{state}": Measure(float(height.sel(state=state) - height.sel(state="intact")), "m"),
        }
    return measures


def table(record: xr.Dataset) -> str:
    """Return one row per fault and condition: medians over the variations, with ranges where a paper needs them."""
    change, change_of_own = _changes(record), loss(record.forward, record.intact_forward)
    head = "joint,kind,legs,arm,forward_m,change,change_low,change_high,change_of_own_intact,net_change,path_change,"
    rows = [head + "turn_deg,printed_change"]
    for cell in product(record.joint.values, KINDS, LEGS_FAILED, ARMS):
        reading = dict(zip(_CELLS, cell, strict=True))
        forward = change["forward"].sel(reading)
        numbers = (
            record.forward.sel(reading).median(),
            forward.median(),
            forward.min(),
            forward.max(),
            change_of_own.sel(reading).median(),
            change["net"].sel(reading).median(),
            change["path"].sel(reading).median(),
        )
        medians = [f"{float(number):.3f}" for number in numbers]
        turned = f"{float(np.degrees(record.turn.sel(reading).median())):.1f}"
        claim = CLAIMS.get(f"fault_{cell[0]}_{cell[3]}")  # of the knee the article says nothing
        printed = f"{claim.value:.2f}" if claim is not None else ""
        rows.append(",".join((*cell, *medians, turned, printed)))
    return "\n".join(rows) + "\n"


def _changes(record: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the changes against the intact run with spine and tail."""
    return {
        name: loss(record[name], record[f"intact_{name}"].sel(arm="coordinated", drop=True))
        for name in ("forward", "net", "path")
    }


def _kept(record: xr.Dataset) -> xr.DataArray:
    """Return the part of its own intact displacement that each condition keeps [-]; going backwards is 0."""
    return (record.forward / record.intact_forward).clip(min=0.0)


def _over_variations(name: str, values: xr.DataArray, unit: str) -> dict[str, Measure]:
    return estimated(name, values, unit)


experiment = JointFaults()
