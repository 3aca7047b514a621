"""How far does the robot still get when joints of its legs fail?"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from itertools import combinations, product
from typing import Any

import numpy as np
import xarray as xr

from suchus.article.paper import CLAIMS
from suchus.core.checks import Checks
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog._two_groups import TwoGroups
from suchus.experiments.catalog.joint_faults.figure import draw_held, draw_matrix, draw_over_time, draw_tracks
from suchus.experiments.experiment import (
    Measure,
    Measures,
    Outcome,
    Progress,
    Replay,
    Simulated,
    estimated,
    silent,
    staged,
)
from suchus.robot.control import Control, Coordinated, HeadingRule, OpenLoop
from suchus.robot.design import layout
from suchus.robot.design.scale import coarse_step, control_period
from suchus.robot.gaits import conditions_of
from suchus.robot.gaits.limbs_tail_lifted import LIFTED
from suchus.robot.motion import START, Gait
from suchus.sim.land import (
    KINDS,
    LEGS_FAILED,
    Fault,
    Limp,
    Locked,
    Run,
    angle_at,
    failing_joints,
    joint_failure,
    simulate,
)
from suchus.sim.land.failed import Kind, Legs
from suchus.sim.metrics import (
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

_OF_SUPPORT = ("support_share_", "tail_load_", "foot_", "com_")
"""How the names of the measures begin that are of what carries the body."""
_OF_A_LIMB = 2  # hinges of a limb, from the hip on, that are steered and locked in places; the article's yaw and pitch
ARMS = ("coordinated", "limbs_only")
"""With spine and tail, and without."""
_CELL = ("joint", "kind", "legs")
_EVERY = 10  # samples of the physics in which a run of the campaign is kept [-]


@dataclass(frozen=True, slots=True, kw_only=True)
class JointFaults(TwoGroups):
    """Front and hind; yaw, pitch and knee; limp and locked; one leg and both; with spine and tail and with limbs only.

    Each of these cells is run in every repeat, in which the intact robots of both groups walk too. What a fault costs
    is told against the group's own intact robot (``own_loss_CELL_limbs_only``; with spine and tail this is the same as
    the other), and against the intact robot with spine and tail, as in the article (``loss_CELL_GROUP``). Two more
    conditions are run in the judged reading: ``steered`` with the feedback rules and the heading loop, and
    ``limbs_tail_lifted``, limbs only with the tail in the air, where a servo lifts it. Displacement is forward, along
    the direction that the body faced at the start. The limbs of another body lose the joints that they have.
    """

    title = "How far does it still crawl when joints of its legs fail?"
    shows = "Section IV.C, Figs 18 to 21"
    answers = (
        "forward_coordinated",
        "forward_limbs_only",
        "loss_front_yaw_limp_one_coordinated",
        "own_loss_front_yaw_limp_one_limbs_only",
        "loss_hind_pitch_limp_one_coordinated",
        "own_loss_hind_pitch_limp_one_limbs_only",
    )
    needs = ("limbs",)
    judged_with = ("robot", "gait", "control_group", "lifted", "cycles", "hold", "kind", "legs", "tolerances")

    lifted: float = LIFTED
    """Pitch of the tail of the control group with its tail in the air, for comparison, down positive [rad]."""
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

    def check(self, check: Checks) -> None:
        """Check places of locking, time step and tail."""
        check.number("hold", 0.0, 1.0, "")
        check.rising("holds", 0.0, 1.0, "")
        check.number("timestep", 1e-5, control_period(self.robot), "s")
        check.number("lifted", -1.6, 1.6, "rad")

    def quick(self) -> "JointFaults":
        """One cycle, two repeats, two places of locking."""
        return replace(self, cycles=1, repeats=2, holds=(0.0, 1.0), timestep=0.01)

    def simulate(self, progress: Progress = silent) -> Simulated:
        """Break joints."""
        record = self._campaign(staged(progress, "campaign", 0.0, 0.75))
        record = record.merge(self._locked_at(staged(progress, "places of locking", 0.75, 0.82)))
        record = record.merge(self._support(staged(progress, "support", 0.82, 0.9)))
        record = record.merge(self._others(staged(progress, "steered, and with the tail lifted", 0.9, 0.98)))
        record = record.assign_attrs(judged_kind=self.kind, judged_legs=self.legs)
        replays = self._replays(staged(progress, "replay", 0.98, 1.0))
        return Simulated(record=record, tables={"faults.csv": table(record)}, replays=replays)

    def measured(self, wanted: Collection[str], progress: Progress = silent) -> Measures:
        """Return measures, those that are wanted at least; for what carries the body nothing else need fail."""
        if not all(name.startswith(_OF_SUPPORT) for name in wanted):
            return super(JointFaults, self).measured(wanted, progress)
        return _support_measures(self._support(progress))

    def measure(self, record: xr.Dataset) -> Measures:
        """Return what every cell costs against both intact robots, and what carries the body."""
        reading = f"{record.attrs['judged_kind']}_{record.attrs['judged_legs']}"
        ours = record.intact_forward.sel(arm="coordinated", drop=True)
        measures = Measures()
        for arm in ARMS:
            measures |= estimated(f"forward_{arm}", record.intact_forward.sel(arm=arm), "m")
        bare = lost(record.intact_forward.sel(arm="limbs_only"), ours)
        measures |= estimated("loss_intact_limbs_only", bare, "-") | _cells(record)
        if "lifted_forward" in record:
            measures |= estimated("forward_limbs_tail_lifted", record.lifted_intact_forward, "m")
            measures |= estimated("loss_intact_limbs_tail_lifted", lost(record.lifted_intact_forward, ours), "-")
        for joint in record.lost.values:
            name = f"loss_{joint}_{reading}"
            if "steered_forward" in record:
                measures |= estimated(f"{name}_steered", lost(record.steered_forward, ours).sel(lost=joint), "-")
                turned = record.steered_turn.sel(lost=joint)
                measures |= estimated(f"turn_{joint}_{reading}_steered", turned, "rad")
            if "lifted_forward" in record:
                lifted = lost(record.lifted_forward, ours).sel(lost=joint)
                measures |= estimated(f"{name}_limbs_tail_lifted", lifted, "-")
        return measures | _effects(record) | _support_measures(record)

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say what the judged faults cost of each group's own, which choice decides most, what steering does."""
        reading = f"_{self.kind}_{self.legs}"
        joints = [
            name.removeprefix("loss_").removesuffix(f"{reading}_coordinated")
            for name in measures
            if name.startswith("loss_") and name.endswith(f"{reading}_coordinated")
        ]
        return self.told(measures, joints=joints, reading=reading)

    @property
    def _duration(self) -> float:
        return START + self.cycles * self.gait.period

    @property
    def _joints(self) -> tuple[str, ...]:
        """Names of the joints that fail."""
        return failing_joints(self.robot)

    @property
    def _failing(self) -> tuple[str, ...]:
        """The joints whose loss is steered and locked in several places."""
        return self._joints[: _OF_A_LIMB * len(self.robot.girdles)]

    @property
    def _gaits(self) -> dict[str, Gait]:
        """The gaits of both groups, and of limbs only with the tail in the air where it can be lifted."""
        bare = self.control_group
        gaits = {"coordinated": self.gait, "limbs_only": bare}
        if "limbs_tail_lifted" in conditions_of(self.robot, self.gait, bare):
            gaits["limbs_tail_lifted"] = bare.lifted(self.lifted, name="limbs_tail_lifted")
        return gaits

    def _broken(self, gait: Gait, joint: str) -> tuple[Fault, ...]:
        """Return the faults of a joint in the judged reading."""
        return joint_failure(self.robot, gait, joint, self.kind, self.legs, hold=self.hold)

    def _built(self, runs: list[Run]) -> list[Run]:
        """Return the repeats of runs, run by run; the i-th of each is the same robot on the same ground."""
        return self.tolerances.repeats(runs, self.repeats, self.seed)

    def _repeats_of(self, runs: list[Run], progress: Any) -> xr.Dataset:
        """Return the repeats of runs, run by run."""
        repeated = self._built(runs)
        return whole(
            simulate(repeated, duration=self._duration, timestep=self.timestep, every=_EVERY, progress=progress)
        )

    def _campaign(self, progress: Any) -> xr.Dataset:
        """Run every cell and the intact robots of both groups in every repeat, and keep how far each got over time."""
        cells = list(product(self._joints, KINDS, LEGS_FAILED))
        runs = [
            Run(robot=self.robot, gait=self._gaits[arm], faults=faults)
            for arm in ARMS
            for faults in ((), *(joint_failure(self.robot, self._gaits[arm], *cell, hold=self.hold) for cell in cells))
        ]
        record = self._repeats_of(runs, progress)
        net = (displacement(record).sel(xyz=["x", "y"]) ** 2).sum("xyz") ** 0.5
        numbers = {
            "forward": (displacement(record).sel(xyz="x"), "m", "displacement forward"),
            "net": (net, "m", "displacement on the ground"),
            "path": (path_length(record), "m", "path length, cycle by cycle"),
            "turn": (heading_change(record), "rad", "how far the body turned, left positive"),
        }
        distance = between(record).centre_of_mass.sel(xyz=["x", "y"])
        tracks = (distance - distance.isel(time=0)).transpose("run", "time", "xyz").values
        shape = (len(ARMS), 1 + len(cells), self.repeats)
        data = xr.Dataset(coords={"arm": list(ARMS), "time": distance.time.values, "on_ground": ["x", "y"]})
        data = data.assign_coords(joint=list(self._joints), kind=list(KINDS), legs=list(LEGS_FAILED))
        for name, (array, unit, what) in numbers.items():
            lay(data, name, array.values.reshape(shape), (), unit, what)
        lay(data, "track", tracks.reshape(*shape, -1, 2), ("time", "on_ground"), "m", "track of the centre of mass")
        data["time"].attrs["units"] = "s"
        data["period"] = ((), self.gait.period, {"units": "s"})
        return data

    def _locked_at(self, progress: Any) -> xr.Dataset:
        """Lock one leg's joint at several places of its range, undisturbed."""
        gaits, points = self._gaits, list(product(ARMS, self._failing, self.holds))
        runs = [Run(robot=self.robot, gait=gaits[arm]) for arm in ARMS]
        runs += [
            Run(robot=self.robot, gait=gaits[a], faults=joint_failure(self.robot, gaits[a], j, "locked", hold=h))
            for a, j, h in points
        ]
        record = simulate(runs, duration=self._duration, timestep=self.timestep, every=_EVERY, progress=progress)
        distance = displacement(whole(record)).sel(xyz="x").values
        held = distance[len(ARMS) :].reshape(len(ARMS), len(self._failing), len(self.holds))
        metre = {"units": "m"}
        data = xr.Dataset(
            {
                "held_intact_forward": ("arm", distance[: len(ARMS)], metre),
                "held_forward": (("arm", "lost", "hold"), held, metre),
            }
        )
        return data.assign_coords(arm=list(ARMS), lost=list(self._failing), hold=list(self.holds))

    def _failed_pitch(self) -> list[Run]:
        """Return runs of the robot intact, with its right hind pitch joint limp, and with it locked.

        Of a limb with one hinge it is that one.
        """
        hind = layout(self.robot).limbs[-1]
        servo = layout(self.robot).servos[hind.servos][-1 if hind.servos.stop - hind.servos.start == 1 else 1]
        angle = angle_at(self.robot, self.gait, servo, self.hold)
        return [
            Run(robot=self.robot, gait=self.gait, faults=faults)
            for faults in ((), (Limp(servo),), (Locked(servo, angle=angle),))
        ]

    def _support(self, progress: Any) -> xr.Dataset:
        """Return what carries the body while the right hind leg, whose pitch joint fails, is meant to swing."""
        runs, step = self._built(self._failed_pitch()), coarse_step(self.robot)
        return support(whole(simulate(runs, duration=self._duration, timestep=step, progress=progress)), self.repeats)

    def _replays(self, progress: Any) -> Mapping[str, Replay]:
        runs, step = self._failed_pitch()[:2], coarse_step(self.robot)
        record = whole(simulate(runs, duration=self._duration, timestep=step, progress=progress))
        return replayed(
            "fault_replay.html",
            record.isel(run=1),
            self.robot,
            ghost=record.isel(run=0),
            labels=("right hind pitch joint limp", "intact"),
            title="One limp leg",
            caption="With the right hind pitch joint limp from the start, and, half transparent, intact.",
        )

    def _others(self, progress: Any) -> xr.Dataset:
        """Run the judged reading of the article's joints steered, and with limbs only and the tail in the air."""
        joints, gaits, steers = self._failing, self._gaits, self.gait.has("steering")
        cases: list[tuple[Gait, tuple[Fault, ...], Control]] = []
        if steers:
            control = Coordinated(heading=HeadingRule()).suited(self.robot, self.gait)
            cases += [(self.gait, self._broken(self.gait, joint), control) for joint in joints]
        if lifted := gaits.get("limbs_tail_lifted"):
            cases += [(lifted, (), OpenLoop()), *((lifted, self._broken(lifted, j), OpenLoop()) for j in joints)]
        data = xr.Dataset(coords={"lost": list(joints)})
        if not cases:
            return data
        runs = [Run(robot=self.robot, gait=gait, faults=faults, control=law) for gait, faults, law in cases]
        record = self._repeats_of(runs, progress)
        distance = displacement(record).sel(xyz="x").values.reshape(len(cases), self.repeats)
        turned = heading_change(record).values.reshape(len(cases), self.repeats)
        both, metre, many = ("lost", "repeat"), {"units": "m"}, len(joints)
        if steers:
            data["steered_forward"] = (both, distance[:many], metre | {"long_name": "forward, steered"})
            data["steered_turn"] = (both, turned[:many], {"units": "rad", "long_name": "turned, steered"})
        if lifted:
            intact, broken = distance[-many - 1], distance[-many:]
            data["lifted_intact_forward"] = ("repeat", intact, metre | {"long_name": "tail lifted, intact"})
            data["lifted_forward"] = (both, broken, metre | {"long_name": "forward, tail lifted"})
        return data

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the matrix, the distance over time for both kinds of fault, the tracks, and the places of locking."""
        record, measures = outcome.record, outcome.measures
        return {
            "fault_matrix": draw_matrix(record, {name: measure.value for name, measure in measures.items()}),
            "faults_limp": draw_over_time(record, "limp", self.legs),
            "faults_locked": draw_over_time(record, "locked", self.legs),
            "fault_tracks": draw_tracks(record),
            "fault_places": draw_held(record),
        }


def lay(data: xr.Dataset, name: str, values: np.ndarray, more: tuple[str, ...], unit: str, what: str) -> None:
    """Put values of shape (arm, 1 + cell, repeat, ...) into a dataset: the intact apart from the cells."""
    about = {"units": unit, "long_name": what}
    data[f"intact_{name}"] = (("arm", "repeat", *more), values[:, 0], about)
    shape = (len(values), data.sizes["joint"], len(KINDS), len(LEGS_FAILED), *values.shape[2:])
    data[name] = (("arm", *_CELL, "repeat", *more), values[:, 1:].reshape(shape), about)


def support(record: xr.Dataset, repeats: int) -> xr.Dataset:
    """Return what carries the body while the last limb, the right hind leg, is meant to swing.

    Args:
        record: of the repeats of the intact robot, and of those with its pitch joint limp and locked.
        repeats: how many of each.
    """
    leg, states = str(record.leg.values[-1]), ["intact", *KINDS]
    loads = swing_loads(record, leg).transpose("run", "part")
    shape, both, metre = (len(states), repeats), ("state", "repeat"), {"units": "m"}
    free = {"units": "1", "long_name": f"share of its swing in which the {leg} foot is free"}
    return xr.Dataset(
        {
            "support": (
                (*both, "part"),
                loads.values.reshape(*shape, -1),
                {"units": "N", "long_name": f"mean load while {leg} swings"},
            ),
            "lifted": (
                both,
                swing_lift(record, leg).values.reshape(shape),
                metre | {"long_name": f"rise of the {leg} foot"},
            ),
            "free": (both, swing_unloaded(record, leg).values.reshape(shape), free),
            "swing_height": (
                both,
                swing_height(record, leg).values.reshape(shape),
                metre | {"long_name": f"centre of mass while {leg} swings"},
            ),
        },
        coords={"state": states, "part": [str(name) for name in loads.part.values]},
    )


def lost(forward: xr.DataArray, intact: xr.DataArray) -> xr.DataArray:
    """Return the change of displacement against an intact robot [-]; NaN of one that does not get forward itself."""
    return loss(forward, intact.where(intact > 0.0))


def _cells(record: xr.Dataset) -> Measures:
    """Return what every cell costs: against the intact robot with spine and tail, and of limbs only against its own.

    ``gain`` is how much less of its own displacement the robot loses with spine and tail than with limbs only, repeat
    by repeat; of one that loses all, or goes backwards, nothing is left.
    """
    common = lost(record.forward, record.intact_forward.sel(arm="coordinated", drop=True))
    own = lost(record.forward, record.intact_forward)
    kept = own.clip(min=-1.0)
    gain = kept.sel(arm="coordinated") - kept.sel(arm="limbs_only")
    measures = Measures()
    for cell in product(record.joint.values, KINDS, LEGS_FAILED):
        at, name = dict(zip(_CELL, cell, strict=True)), "_".join(cell)
        for arm in ARMS:
            measures |= estimated(f"loss_{name}_{arm}", common.sel(at).sel(arm=arm), "-")
            measures |= estimated(f"turn_{name}_{arm}", record.turn.sel(at).sel(arm=arm), "rad")
        measures |= estimated(f"own_loss_{name}_limbs_only", own.sel(at).sel(arm="limbs_only"), "-")
        measures |= estimated(f"gain_{name}", gain.sel(at), "-")
    return measures


def _effects(record: xr.Dataset) -> Measures:
    """Return by how much the change with spine and tail differs on average between two readings of one thing [-]."""
    change = lost(record.forward, record.intact_forward).sel(arm="coordinated", joint=record.lost.values)
    change = change.median("repeat")
    effects = Measures()
    for dim in ("kind", "joint", "legs"):
        pairs = combinations(change[dim].values, 2)
        apart = [float(abs(change.sel({dim: a}) - change.sel({dim: b})).mean()) for a, b in pairs]
        effects[f"effect_of_{dim}"] = Measure(float(np.mean(apart)), "-")
    return effects


def _support_measures(record: xr.Dataset) -> Measures:
    """Return what carries the body while the right hind leg is meant to swing, and how high it is carried."""
    measures = Measures()
    height, parts = record.swing_height, [str(part) for part in record.part.values]
    legs = [part for part in parts if part not in ("tail", "belly")]
    carriers = ["tail", *([legs[-3]] if len(legs) > 2 else []), legs[-2]]  # beside the last leg and ahead of it
    for state in (str(one) for one in record.state.values):
        load = record.support.sel(state=state)
        share = load.sel(part=carriers).sum("part") / load.sum("part")
        measures |= estimated(f"support_share_{state}", share, "-")
        measures |= estimated(f"tail_load_{state}", load.sel(part="tail"), "N")
        measures |= estimated(f"foot_lift_{state}", record.lifted.sel(state=state), "m")
        measures |= estimated(f"foot_free_{state}", record.free.sel(state=state), "-")
        measures |= estimated(f"com_height_{state}", height.sel(state=state), "m")
        if state != "intact":
            measures |= estimated(f"com_rise_{state}", height.sel(state=state) - height.sel(state="intact"), "m")
    return measures


def table(record: xr.Dataset) -> str:
    """Return one row per cell and group: medians over the repeats, with the ranges that a paper needs."""
    ours = record.sel(arm="coordinated", drop=True)
    rows = [
        "joint,kind,legs,arm,forward_m,change,change_low,change_high,change_of_own_intact,net_change,path_change,"
        "turn_deg,printed_change"
    ]
    for *cell, arm in product(record.joint.values, KINDS, LEGS_FAILED, ARMS):
        one = record.sel(dict(zip((*_CELL, "arm"), (*cell, arm), strict=True)))
        change = lost(one.forward, ours.intact_forward)
        numbers = (
            one.forward.median(),
            change.median(),
            change.min(),
            change.max(),
            lost(one.forward, one.intact_forward).median(),
            lost(one.net, ours.intact_net).median(),
            lost(one.path, ours.intact_path).median(),
        )
        medians = [f"{float(number):.3f}" for number in numbers]
        turned = f"{float(np.degrees(one.turn.median())):.1f}"
        claim = CLAIMS.get(f"fault_{cell[0]}_{arm}")  # of the knee the article says nothing
        printed = f"{claim.value:.2f}" if claim is not None else ""
        rows.append(",".join((*map(str, cell), arm, *medians, turned, printed)))
    return "\n".join(rows) + "\n"


experiment = JointFaults()
