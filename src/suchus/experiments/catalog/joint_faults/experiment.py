"""How far does the robot still get when joints of its legs fail?"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from itertools import combinations, compress, product
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.article.paper import CLAIMS
from suchus.core.checks import Checks
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog._two_groups import TwoGroups
from suchus.experiments.catalog.joint_faults.figure import (
    draw_locking_positions,
    draw_matrix,
    draw_over_time,
    draw_tracks,
)
from suchus.experiments.experiment import (
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
    displacement,
    heading_change,
    loss,
    path_length,
    require_complete,
    swing_height,
    swing_lift,
    swing_loads,
    swing_unloaded,
    time_window,
)

_SUPPORT_PREFIXES = ("support_share_", "tail_load_", "foot_", "com_")
"""Prefixes of the measures of the loads that carry the body."""
_HINGES_PER_LIMB = 2
"""Hinges of a limb, from the hip on, whose faults are steered and whose locking position is varied [-]."""
_STATED_REPEATS = 2
"""Robots that walk for the verdicts in conditions that are not judged, whose loss is only stated [-]."""
ARMS = ("coordinated", "limbs_only")
"""With spine and tail, and without."""
_CELL_DIMS = ("joint", "kind", "legs")
_SAMPLING_STRIDE = 10  # [-]; physics steps per stored sample of the campaign


@dataclass(frozen=True, slots=True, kw_only=True)
class JointFaults(TwoGroups):
    """Front and hind; yaw, pitch and knee; limp and locked; one leg and both; with spine and tail and with limbs only.

    Each of these cells, and the intact robot of each group, is simulated in every repeat. The loss is given against
    the intact robot with spine and tail, as in the article (``loss_CELL_GROUP``). For limbs only it is also given
    against the group's own intact robot (``own_loss_CELL_limbs_only``). Two further conditions are simulated in the
    judged reading: ``steered`` with the feedback rules and the heading loop, and ``limbs_tail_lifted`` where a servo
    can lift the tail into the air. The displacement is along the initial direction of the body. On another body the
    joints of its own limbs fail.
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
    judged_settings = ("robot", "gait", "control_group", "lifted", "cycles", "hold", "kind", "legs", "tolerances")
    judged_minima: ClassVar[Mapping[str, float]] = {"repeats": 6}
    answer_minima: ClassVar[Mapping[str, float]] = {"cycles": 2, "repeats": 6}

    lifted: float = LIFTED
    """Pitch of the tail of the control group with its tail in the air, for comparison, down positive [rad]."""
    hold: float = 0.5
    """Position of a locked joint in the range of the gait's angles: 0 is the least angle, 1 the greatest [-].

    The paper does not give it. The default is the middle, because a servo without commands may stop anywhere. A fault
    ``Locked`` without an angle would hold the joint where it fails, which depends on the phase at the start of the run.
    Other positions are measured over ``holds``.
    """
    holds: tuple[float, ...] = (0.0, 0.25, 0.5, 0.75, 1.0)
    """Positions in that range at which one leg's joint is locked, for the curve [-]."""
    kind: Kind = "limp"
    """Kind of fault that is judged, a reading of the article's 'lost'.

    The paper does not give it. The default is limp, because a servo that 'cannot receive and execute commands' gets no
    pulses and exerts no torque.
    """
    legs: Legs = "one"
    """Whether the judged fault is in one leg or in both legs of a girdle; one, because the text names single joints."""
    hinges: int | None = None
    """Hinges of each limb, from the hip on, that fail one after another; None for all. The article names no knee
    [-]."""
    extent: Extent = "whole"
    """How much is simulated: without steering and places of locking for the verdicts, and with fewer robots in the
    conditions that are not judged: a fault in both legs, and the tail in the air."""
    repeats: int = 6
    """Number of robots built of the design for each condition and fault [-]; six at least give a median an interval."""
    timestep: float = 0.005
    """Time step of the physics [s]. A step of 2 ms changes no median by more than 3 percentage points. A step of 10 ms
    changes some by 6, and the effect of steering on a failed hind yaw joint."""

    def check(self, check: Checks) -> None:
        """Check places of locking, time step and tail."""
        check.number("hold", 0.0, 1.0, "")
        if self.hinges is not None:
            check.whole("hinges", 1, 100)
        check.rising("holds", 0.0, 1.0, "")
        check.number("timestep", 1e-5, control_period(self.robot), "s")
        check.number("lifted", -1.6, 1.6, "rad")

    def for_verdicts(self) -> "JointFaults":
        """Return the same question without failing knees, steering and places of locking.

        Fewer robots walk in conditions that are not judged.
        """
        return replace(self, hinges=_HINGES_PER_LIMB, extent="verdicts")

    def quick(self) -> "JointFaults":
        """One cycle, two repeats, two places of locking."""
        return replace(self, cycles=1, repeats=2, holds=(0.0, 1.0), timestep=0.01)

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Break joints."""
        record = self._campaign(staged(progress, "campaign", 0.0, 0.75))
        if self.extent == "whole":
            record = record.merge(self._locking_record(staged(progress, "places of locking", 0.75, 0.82)))
        record = record.merge(self._support(staged(progress, "support", 0.82, 0.9)))
        record = record.merge(self._comparison_record(staged(progress, "steered, and with the tail lifted", 0.9, 0.98)))
        record = record.assign_attrs(judged_kind=self.kind, judged_legs=self.legs)
        replays = self._replays(staged(progress, "replay", 0.98, 1.0))
        return SimulationResult(record=record, tables={"faults.csv": table(record)}, replays=replays)

    def simulate_measures(self, measure_names: Collection[str], progress: Progress = silent) -> Measures:
        """Return at least the requested measures; those of the support need no other faults."""
        if not all(name.startswith(_SUPPORT_PREFIXES) for name in measure_names):
            return super(JointFaults, self).simulate_measures(measure_names, progress)
        return _support_measures(self._support(progress))

    def measure(self, record: xr.Dataset) -> Measures:
        """Return the loss in every cell against both intact robots, and the loads that carry the body."""
        reading = f"{record.attrs['judged_kind']}_{record.attrs['judged_legs']}"
        intact = record.intact_forward.sel(arm="coordinated", drop=True)
        measures = Measures()
        for arm in ARMS:
            measures |= estimated(f"forward_{arm}", record.intact_forward.sel(arm=arm), "m")
        limbs_only_loss = displacement_change(record.intact_forward.sel(arm="limbs_only"), intact)
        measures |= estimated("loss_intact_limbs_only", limbs_only_loss, "-") | _cells(record)
        if "lifted_forward" in record:
            lifted_intact = record.lifted_intact_forward
            is_lifted = lifted_intact.notnull().values
            measures |= _estimated("forward_limbs_tail_lifted", lifted_intact, "m", is_lifted)
            lifted_loss = displacement_change(lifted_intact, intact)
            measures |= _estimated("loss_intact_limbs_tail_lifted", lifted_loss, "-", is_lifted)
        for joint in record.lost.values:
            name = f"loss_{joint}_{reading}"
            if "steered_forward" in record:
                measures |= estimated(
                    f"{name}_steered", displacement_change(record.steered_forward, intact).sel(lost=joint), "-"
                )
                heading_changes = record.steered_turn.sel(lost=joint)
                measures |= estimated(f"turn_{joint}_{reading}_steered", heading_changes, "rad")
            if "lifted_forward" in record:
                lifted_loss = displacement_change(record.lifted_forward, intact).sel(lost=joint)
                measures |= _estimated(f"{name}_limbs_tail_lifted", lifted_loss, "-", is_lifted)
        return measures | _effects(record) | _support_measures(record)

    def explain(self, measures: Mapping[str, float]) -> str:
        """Return the losses against each group's own intact robot, the decisive choice, and the effect of steering."""
        reading = f"_{self.kind}_{self.legs}"
        joints = [
            name.removeprefix("loss_").removesuffix(f"{reading}_coordinated")
            for name in measures
            if name.startswith("loss_") and name.endswith(f"{reading}_coordinated")
        ]
        can_steer = self.gait.has("steering")
        return self.render_explanation(measures, joints=joints, reading=reading, can_steer=can_steer)

    @property
    def _duration(self) -> float:
        return START + self.cycles * self.gait.period

    @property
    def _joints(self) -> tuple[str, ...]:
        """Names of the joints that fail."""
        joints = failing_joints(self.robot)
        return joints if self.hinges is None else joints[: self.hinges * len(self.robot.girdles)]

    @property
    def _failing_joints(self) -> tuple[str, ...]:
        """Names of the joints whose fault is also simulated with steering and at several locking positions."""
        return self._joints[: _HINGES_PER_LIMB * len(self.robot.girdles)]

    @property
    def _gaits(self) -> dict[str, Gait]:
        """Gaits of both groups, and of limbs only with the tail in the air where a servo can lift it."""
        limbs_only = self.control_group
        gaits = {"coordinated": self.gait, "limbs_only": limbs_only}
        if "limbs_tail_lifted" in conditions_of(self.robot, self.gait, limbs_only):
            gaits["limbs_tail_lifted"] = limbs_only.lifted(self.lifted, name="limbs_tail_lifted")
        return gaits

    def _faults_of(self, gait: Gait, joint: str) -> tuple[Fault, ...]:
        """Return the faults of a joint in the reading of the article that is judged."""
        return joint_failure(self.robot, gait, joint, self.kind, self.legs, hold=self.hold)

    @property
    def _stated_repeats(self) -> int:
        """Number of robots that walk in conditions that are not judged [-]."""
        return self.repeats if self.extent == "whole" else min(self.repeats, _STATED_REPEATS)

    def _repeat_runs(self, runs: list[Run]) -> list[Run]:
        """Return the repeats of runs, run by run; the i-th repeat of each is the same robot on the same ground."""
        return self.tolerances.repeats(runs, self.repeats, self.seed)

    def _walks_of(self, runs: list[Run], progress: Any) -> xr.Dataset:
        """Simulate runs of the campaign."""
        return require_complete(
            simulate(
                runs,
                duration=self._duration,
                timestep=self.timestep,
                sample_stride=_SAMPLING_STRIDE,
                effort=False,
                progress=progress,
            )
        )

    def _campaign(self, progress: Any) -> xr.Dataset:
        """Simulate every cell and the intact robots, and return displacements and tracks.

        They are NaN for repeats that are not simulated.
        """
        cells = list(product(self._joints, KINDS, LEGS_FAILED))
        runs = [
            Run(robot=self.robot, gait=self._gaits[arm], faults=faults)
            for arm in ARMS
            for faults in ((), *(joint_failure(self.robot, self._gaits[arm], *cell, hold=self.hold) for cell in cells))
        ]
        counts = [
            self.repeats,
            *(self.repeats if legs == self.legs else self._stated_repeats for _, _, legs in cells),
        ] * len(ARMS)
        is_walked = (np.arange(self.repeats) < np.array(counts)[:, None]).ravel()
        record = self._walks_of(list(compress(self._repeat_runs(runs), is_walked)), progress)
        net = (displacement(record).sel(xyz=["x", "y"]) ** 2).sum("xyz") ** 0.5
        quantities = {
            "forward": (displacement(record).sel(xyz="x"), "m", "displacement forward"),
            "net": (net, "m", "displacement on the ground"),
            "path": (path_length(record), "m", "path length, cycle by cycle"),
            "turn": (heading_change(record), "rad", "how far the body turned, left positive"),
        }
        distance = time_window(record).centre_of_mass.sel(xyz=["x", "y"])
        tracks = (distance - distance.isel(time=0)).transpose("run", "time", "xyz").values

        def of_repeats(values: np.ndarray) -> np.ndarray:
            """Return the values of the runs by arm, fault and repeat."""
            every = np.full((is_walked.size, *values.shape[1:]), np.nan)
            every[is_walked] = values
            return every.reshape(len(ARMS), 1 + len(cells), self.repeats, *values.shape[1:])

        data = xr.Dataset(coords={"arm": list(ARMS), "time": distance.time.values, "on_ground": ["x", "y"]})
        data = data.assign_coords(joint=list(self._joints), kind=list(KINDS), legs=list(LEGS_FAILED))
        for name, (array, unit, long_name) in quantities.items():
            store_cells(data, name, of_repeats(array.values), (), unit, long_name)
        store_cells(data, "track", of_repeats(tracks), ("time", "on_ground"), "m", "track of the centre of mass")
        data["time"].attrs["units"] = "s"
        data["period"] = ((), self.gait.period, {"units": "s"})
        return data

    def _locking_record(self, progress: Any) -> xr.Dataset:
        """Simulate one leg's joint locked at several positions of its range, for the robot as designed."""
        gaits, points = self._gaits, list(product(ARMS, self._failing_joints, self.holds))
        runs = [Run(robot=self.robot, gait=gaits[arm]) for arm in ARMS]
        runs += [
            Run(robot=self.robot, gait=gaits[a], faults=joint_failure(self.robot, gaits[a], j, "locked", hold=h))
            for a, j, h in points
        ]
        record = simulate(
            runs,
            duration=self._duration,
            timestep=self.timestep,
            sample_stride=_SAMPLING_STRIDE,
            effort=False,
            progress=progress,
        )
        distance = displacement(require_complete(record)).sel(xyz="x").values
        locked_distances = distance[len(ARMS) :].reshape(len(ARMS), len(self._failing_joints), len(self.holds))
        metre = {"units": "m"}
        data = xr.Dataset(
            {
                "held_intact_forward": ("arm", distance[: len(ARMS)], metre),
                "held_forward": (("arm", "lost", "hold"), locked_distances, metre),
            }
        )
        return data.assign_coords(arm=list(ARMS), lost=list(self._failing_joints), hold=list(self.holds))

    def _failed_pitch(self) -> list[Run]:
        """Return runs of the robot intact, with its right hind pitch joint limp, and with this joint locked.

        Where a limb has one hinge, that hinge fails.
        """
        hind = layout(self.robot).limbs[-1]
        servo = layout(self.robot).servos[hind.servos][-1 if hind.servos.stop - hind.servos.start == 1 else 1]
        angle = angle_at(self.robot, self.gait, servo, self.hold)
        return [
            Run(robot=self.robot, gait=self.gait, faults=faults)
            for faults in ((), (Limp(servo),), (Locked(servo, angle=angle),))
        ]

    def _support(self, progress: Any) -> xr.Dataset:
        """Return the loads that carry the body while the right hind leg, whose pitch joint fails, should swing."""
        runs, step = self._repeat_runs(self._failed_pitch()), coarse_step(self.robot)
        record = simulate(runs, duration=self._duration, timestep=step, effort=False, progress=progress)
        return support(require_complete(record), self.repeats)

    def _replays(self, progress: Any) -> Mapping[str, Replay]:
        """Return the replay of the crawl with the right hind pitch joint limp, and of the intact one."""
        runs, step = self._failed_pitch()[:2], coarse_step(self.robot)
        record = require_complete(simulate(runs, duration=self._duration, timestep=step, progress=progress))
        return replayed(
            "fault_replay.html",
            record.isel(run=1),
            self.robot,
            ghost=record.isel(run=0),
            labels=("right hind pitch joint limp", "intact"),
            title="One limp leg",
            caption="With the right hind pitch joint limp from the start, and, half transparent, intact.",
        )

    def _comparison_record(self, progress: Any) -> xr.Dataset:
        """Simulate the judged faults with steering, and with limbs only and the tail in the air."""
        joints, gaits = self._failing_joints, self._gaits
        steers = self.extent == "whole" and self.gait.has("steering")
        cases: list[tuple[Gait, tuple[Fault, ...], Control]] = []
        if steers:
            control = Coordinated(heading=HeadingRule()).suited(self.robot, self.gait)
            cases += [(self.gait, self._faults_of(self.gait, joint), control) for joint in joints]
        if lifted_gait := gaits.get("limbs_tail_lifted"):
            cases += [
                (lifted_gait, (), OpenLoop()),
                *((lifted_gait, self._faults_of(lifted_gait, j), OpenLoop()) for j in joints),
            ]
        data = xr.Dataset(coords={"lost": list(joints)})
        if not cases:
            return data
        runs = [Run(robot=self.robot, gait=gait, faults=faults, control=law) for gait, faults, law in cases]
        count = self._stated_repeats
        record = self._walks_of(self.tolerances.repeats(runs, count, self.seed), progress)
        not_walked = ((0, 0), (0, self.repeats - count))
        distance, heading_changes = (
            np.pad(values.values.reshape(len(cases), count), not_walked, constant_values=np.nan)
            for values in (displacement(record).sel(xyz="x"), heading_change(record))
        )
        dims, metre, joint_count = ("lost", "repeat"), {"units": "m"}, len(joints)
        if steers:
            data["steered_forward"] = (dims, distance[:joint_count], metre | {"long_name": "forward, steered"})
            data["steered_turn"] = (
                dims,
                heading_changes[:joint_count],
                {"units": "rad", "long_name": "turned, steered"},
            )
        if lifted_gait:
            intact, failed = distance[-joint_count - 1], distance[-joint_count:]
            data["lifted_intact_forward"] = ("repeat", intact, metre | {"long_name": "tail lifted, intact"})
            data["lifted_forward"] = (dims, failed, metre | {"long_name": "forward, tail lifted"})
        return data

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the matrix, the distance over time for both kinds of fault, the tracks, and the places of locking."""
        record, measures = outcome.record, outcome.measures
        return {
            "fault_matrix": draw_matrix(record, {name: measure.value for name, measure in measures.items()}),
            "faults_limp": draw_over_time(record, "limp", self.legs),
            "faults_locked": draw_over_time(record, "locked", self.legs),
            "fault_tracks": draw_tracks(record),
            **({"fault_places": draw_locking_positions(record)} if "held_forward" in record else {}),
        }


def store_cells(
    data: xr.Dataset, name: str, values: np.ndarray, extra_dims: tuple[str, ...], unit: str, long_name: str
) -> None:
    """Store the values of all cells in a dataset, as ``NAME`` and, for the intact robots, as ``intact_NAME``.

    Args:
        data: dataset that gets the variables.
        name: name of the variable.
        values: values of shape (arm, 1 + cell, repeat, ...), the intact robot first.
        extra_dims: names of the dimensions after the repeats.
        unit: unit of the values.
        long_name: description of the variable.
    """
    attrs = {"units": unit, "long_name": long_name}
    data[f"intact_{name}"] = (("arm", "repeat", *extra_dims), values[:, 0], attrs)
    shape = (len(values), data.sizes["joint"], len(KINDS), len(LEGS_FAILED), *values.shape[2:])
    data[name] = (("arm", *_CELL_DIMS, "repeat", *extra_dims), values[:, 1:].reshape(shape), attrs)


def support(record: xr.Dataset, repeats: int) -> xr.Dataset:
    """Return the loads that carry the body while the last limb, the right hind leg, is commanded to swing.

    Args:
        record: repeats of the intact robot, then of those with its pitch joint limp and locked.
        repeats: number of repeats of each [-].
    """
    leg, states = str(record.leg.values[-1]), ["intact", *KINDS]
    loads = swing_loads(record, leg).transpose("run", "part")
    shape, dims, metre = (len(states), repeats), ("state", "repeat"), {"units": "m"}
    free_attrs = {"units": "1", "long_name": f"share of its swing in which the {leg} foot is free"}
    return xr.Dataset(
        {
            "support": (
                (*dims, "part"),
                loads.values.reshape(*shape, -1),
                {"units": "N", "long_name": f"mean load while {leg} swings"},
            ),
            "lifted": (
                dims,
                swing_lift(record, leg).values.reshape(shape),
                metre | {"long_name": f"rise of the {leg} foot"},
            ),
            "free": (dims, swing_unloaded(record, leg).values.reshape(shape), free_attrs),
            "swing_height": (
                dims,
                swing_height(record, leg).values.reshape(shape),
                metre | {"long_name": f"centre of mass while {leg} swings"},
            ),
        },
        coords={"state": states, "part": [str(name) for name in loads.part.values]},
    )


def displacement_change(forward: xr.DataArray, intact: xr.DataArray) -> xr.DataArray:
    """Return the relative change of displacement against an intact robot [-].

    The result is NaN where the intact robot does not move forward itself.

    Args:
        forward: displacement with a fault [m].
        intact: displacement of the intact robot [m].
    """
    return loss(forward, intact.where(intact > 0.0))


def _cells(record: xr.Dataset) -> Measures:
    """Return the loss in every cell: against the intact robot with spine and tail, and for limbs only against its own.

    ``gain`` is the loss with limbs only minus the loss with spine and tail, each of its own displacement, repeat by
    repeat. A loss is at most the whole displacement, also for a robot that goes backwards.
    """
    common_change = displacement_change(record.forward, record.intact_forward.sel(arm="coordinated", drop=True))
    own_change = displacement_change(record.forward, record.intact_forward)
    bounded_change = own_change.clip(min=-1.0)
    gain = bounded_change.sel(arm="coordinated") - bounded_change.sel(arm="limbs_only")
    measures = Measures()
    for cell in product(record.joint.values, KINDS, LEGS_FAILED):
        indexers, name = dict(zip(_CELL_DIMS, cell, strict=True)), "_".join(cell)
        values: dict[str, tuple[xr.DataArray, str]] = {}
        for arm in ARMS:
            values[f"loss_{name}_{arm}"] = common_change.sel(arm=arm), "-"
            values[f"turn_{name}_{arm}"] = record.turn.sel(arm=arm), "rad"
        values[f"own_loss_{name}_limbs_only"] = own_change.sel(arm="limbs_only"), "-"
        values[f"gain_{name}"] = gain, "-"
        is_walked = record.forward.sel(indexers).notnull().all("arm").values
        for measure_name, (of_cells, unit) in values.items():
            measures |= _estimated(measure_name, of_cells.sel(indexers), unit, is_walked)
    return measures


def _estimated(name: str, values: xr.DataArray, unit: str, is_walked: np.ndarray) -> Measures:
    """Return the median over the repeats with its interval, and without one where not every repeat was simulated.

    Args:
        name: name of the measure.
        values: values (repeat).
        unit: unit of the values.
        is_walked: whether each repeat was simulated.
    """
    if is_walked.all():
        return estimated(name, values, unit)
    return Measures({name: Measure(float(np.median(values.values[is_walked])), unit)})


def _effects(record: xr.Dataset) -> Measures:
    """Return the mean difference of the change with spine and tail between two readings of one choice [-]."""
    change = displacement_change(record.forward, record.intact_forward).sel(arm="coordinated", joint=record.lost.values)
    change = change.median("repeat")
    effects = Measures()
    for dim in ("kind", "joint", "legs"):
        pairs = combinations(change[dim].values, 2)
        differences = [float(abs(change.sel({dim: a}) - change.sel({dim: b})).mean()) for a, b in pairs]
        effects[f"effect_of_{dim}"] = Measure(float(np.mean(differences)), "-")
    return effects


def _support_measures(record: xr.Dataset) -> Measures:
    """Return the loads that carry the body while the right hind leg should swing, and the height of the body."""
    measures = Measures()
    height, parts = record.swing_height, [str(body_part) for body_part in record.part.values]
    legs = [body_part for body_part in parts if body_part not in ("tail", "belly")]
    carriers = [
        "tail",
        *([legs[-3]] if len(legs) > 2 else []),
        legs[-2],
    ]  # the leg opposite to the last one and the leg ahead of it
    for state in (str(label) for label in record.state.values):
        load = record.support.sel(state=state)
        load_fraction = load.sel(part=carriers).sum("part") / load.sum("part")
        measures |= estimated(f"support_share_{state}", load_fraction, "-")
        measures |= estimated(f"tail_load_{state}", load.sel(part="tail"), "N")
        measures |= estimated(f"foot_lift_{state}", record.lifted.sel(state=state), "m")
        measures |= estimated(f"foot_free_{state}", record.free.sel(state=state), "-")
        measures |= estimated(f"com_height_{state}", height.sel(state=state), "m")
        if state != "intact":
            measures |= estimated(f"com_rise_{state}", height.sel(state=state) - height.sel(state="intact"), "m")
    return measures


def table(record: xr.Dataset) -> str:
    """Return medians over the repeats as CSV text, one row per cell and group, with the range of the changes."""
    coordinated = record.sel(arm="coordinated", drop=True)
    rows = [
        "joint,kind,legs,arm,forward_m,change,change_low,change_high,change_of_own_intact,net_change,path_change,"
        "turn_deg,printed_change"
    ]
    for *cell, arm in product(record.joint.values, KINDS, LEGS_FAILED, ARMS):
        cell_record = record.sel(dict(zip((*_CELL_DIMS, "arm"), (*cell, arm), strict=True)))
        change = displacement_change(cell_record.forward, coordinated.intact_forward)
        numbers = (
            cell_record.forward.median(),
            change.median(),
            change.min(),
            change.max(),
            displacement_change(cell_record.forward, cell_record.intact_forward).median(),
            displacement_change(cell_record.net, coordinated.intact_net).median(),
            displacement_change(cell_record.path, coordinated.intact_path).median(),
        )
        medians = [f"{float(number):.3f}" for number in numbers]
        turn_text = f"{float(np.degrees(cell_record.turn.median())):.1f}"
        claim = CLAIMS.get(f"fault_{cell[0]}_{arm}")  # the article does not mention the knee
        printed_text = f"{claim.value:.2f}" if claim is not None else ""
        rows.append(",".join((*map(str, cell), arm, *medians, turn_text, printed_text)))
    return "\n".join(rows) + "\n"


experiment = JointFaults()
