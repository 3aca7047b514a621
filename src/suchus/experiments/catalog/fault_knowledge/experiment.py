"""What does the robot gain from knowing which joint has failed?"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import ceil
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
import xarray as xr

from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign
from suchus.experiments.catalog._two_groups import TwoGroups
from suchus.experiments.catalog.fault_knowledge.figure import draw_gains, draw_over_time, draw_table
from suchus.experiments.catalog.fault_knowledge.searched import INTACT, SearchedGaits, read_searches
from suchus.experiments.experiment import (
    Measure,
    Measures,
    Outcome,
    Progress,
    SimulationResult,
    estimated,
    silent,
    staged,
)
from suchus.robot.control import Change, Walking
from suchus.robot.design import Robot
from suchus.robot.design.scale import control_period
from suchus.robot.motion import START, Gait
from suchus.robot.motion.transition import transition_duration
from suchus.sim.land import KINDS, Fault, Run, joint_failure, simulate
from suchus.sim.metrics import displacement, heading, require_complete, time_window

ARMS = ("coordinated", "limbs_only")
"""With spine and tail, and without."""
KEPT = "kept"
"""Name of the gait in which the robot walks until its joint fails, and further on if it does not know of it."""
STATES = (KEPT, INTACT, "told")
"""The robot that does not know of its fault, the one that changes to the best gait of the intact robot, and the one
that knows which joint has failed."""
_CROSSED = ("coordinated", "limp")
"""Group and kind of fault of which every joint is walked in every gait; the gaits were searched for limp joints."""
_GROWTH = 0.5  # [cycle]; over which stroke and bends grow after a change of gait
_SAMPLING_STRIDE = 10  # [-]; control periods per stored sample


class FaultWalk(NamedTuple):
    """One condition of the campaign."""

    arm: str
    kind: str
    joint: str
    gait: str
    """``kept``, ``intact`` or the joint for whose failure the gait was searched."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FaultKnowledge(TwoGroups):
    """One joint fails during the walk; after a delay the robot knows which, and changes its gait.

    Each joint fails limp and locked, with spine and tail and with limbs only. A robot that does not know of its fault
    keeps its gait (``kept``). One that knows changes to the gait that ``suchus optimise fault`` found for this joint
    (``told``); it was searched limp, and a robot that knows which joint has failed need not know how. The search alone
    makes a gait better, also without a fault. Therefore a third robot changes at the same time to the gait that the
    same search, with the same budget, found for the intact robot (``intact``). At last the robot with spine and tail
    walks with every limp joint in the gaits of the other joints: the best single gait for all joints needs no knowledge
    of the joint (``single``).

    ``forward`` is the displacement in the last cycles, when the new gait is reached, along the mean heading in the
    first of them. ``total`` counts from the fault on along the first heading, with the delay and the change of gait.
    """

    title = "What does the robot gain from knowing which joint has failed?"
    shows = "Beyond the article, after section IV.C"
    answers = (
        "gain_limp_coordinated",
        "joint_gain_limp_coordinated",
        "gain_limp_limbs_only",
        "difference_limp",
        "total_gain_limp_coordinated",
    )
    needs = ("foot_paths", "axis")
    reproduces = False
    judged_settings = (
        "robot", "gait", "control_group", "cycles", "settled", "onset", "delay", "hold", "searches", "tolerances",
    )  # fmt: skip
    judged_minima: ClassVar[Mapping[str, float]] = {"repeats": 6}
    answer_minima: ClassVar[Mapping[str, float]] = {"cycles": 4, "settled": 2, "repeats": 6}

    cycles: int = 4
    """Number of cycles from the fault to the end [-]."""
    settled: int = 2
    """Number of cycles at the end whose displacement is measured [-]; two, as in the article."""
    onset: float = 0.5
    """Time that the robot walks before the joint fails [cycle]."""
    delay: float = 0.5
    """Time from the fault until the robot knows of it [cycle]: half a cycle shows any joint that does not follow."""
    hold: float = 0.5
    """Position of a locked joint in the range of the gait's angles: 0 is the least angle, 1 the greatest [-]."""
    repeats: int = 6
    """Number of robots built of the design for each condition [-]; six at least give a median an interval."""
    searches: str = ""
    """Path of the ``outcome.json`` of ``suchus optimise fault`` for the robot; empty for the one that is kept."""
    timestep: float = 0.005
    """Time step of the physics [s]."""

    def check(self, check: Checks) -> None:
        """Check the times, the position of locking and the time step."""
        check.number("onset", 0.0, 1000.0, "cycles")
        check.number("delay", 0.0, 1000.0, "cycles")
        check.number("hold", 0.0, 1.0, "")
        check.whole("settled", 1, 1000)
        check.number("timestep", 1e-5, control_period(self.robot), "s")

    def for_robot(self, robot: Robot) -> Self:
        """Return the same question for another robot, with as many cycles as its change of gait needs."""
        question = super(FaultKnowledge, self).for_robot(robot)
        return replace(question, cycles=max(question.cycles, ceil(question._needed_cycles)))

    @property
    def _needed_cycles(self) -> float:
        """Least number of cycles from the fault to the end, after which the settled cycles are settled [-]."""
        change = transition_duration(self.robot) / self.gait.period
        return self.delay + change + _GROWTH + self.settled

    def quick(self) -> "FaultKnowledge":
        """One robot as built, and one cycle in the new gait."""
        return replace(self, cycles=3, settled=1, onset=0.25, delay=0.25, repeats=1, timestep=0.01)

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Let joints fail in every gait.

        Raises:
            UnsuitedRobot: no gaits were searched for this robot.
            InvalidDesign: too few cycles for the change of gait.
        """
        if self.cycles < self._needed_cycles:
            raise InvalidDesign(
                f"{self.name()}.cycles is {self.cycles}; delay, change of gait and {self.settled} settled cycles of "
                f"robot {self.robot.name!r} need {ceil(self._needed_cycles)}: raise cycles, or lower settled."
            )
        searched = read_searches(self.searches, self.robot, self.gait)
        joints = searched.joints
        cells = [
            FaultWalk(arm, kind, joint, gait)
            for arm, kind, joint in product(ARMS, KINDS, joints)
            for gait in (KEPT, INTACT, *(joints if (arm, kind) == _CROSSED else (joint,)))
        ]
        cells += [FaultWalk(arm, "", "", gait) for arm in ARMS for gait in (KEPT, INTACT)]
        record = require_complete(
            simulate(
                self.tolerances.repeats([self.walk(cell, searched) for cell in cells], self.repeats, self.seed),
                duration=self._fault_time + self.cycles * self.gait.period,
                timestep=self.timestep,
                sample_stride=_SAMPLING_STRIDE,
                effort=False,
                progress=staged(progress, "walks", 0.0, 1.0),
            )
        )
        return SimulationResult(record=self._cell_record(record, cells, searched))

    @property
    def _fault_time(self) -> float:
        """Time at which the joint fails [s]."""
        return START + self.onset * self.gait.period

    def walk(self, cell: FaultWalk, searched: SearchedGaits) -> Run:
        """Return the walk of one condition."""
        walk_gait = self.gait if cell.arm == "coordinated" else self.control_group
        control = Walking()
        if cell.gait != KEPT:
            control = Walking(changes=(Change(
                at=self._fault_time + self.delay * self.gait.period, gait=self._searched_gait(cell, searched),
            ),))  # fmt: skip
        return Run(
            robot=self.robot, gait=walk_gait, faults=self._faults(cell, walk_gait), control=control,
            label=" ".join(part for part in cell if part),
        )  # fmt: skip

    def _searched_gait(self, cell: FaultWalk, searched: SearchedGaits) -> Gait:
        """Return the searched gait of a condition."""
        return searched.gaits[f"{cell.gait}_{cell.arm}"]

    def _faults(self, cell: FaultWalk, gait: Gait) -> tuple[Fault, ...]:
        """Return the fault of a condition, which begins during the walk; none for the intact robot."""
        if not cell.joint:
            return ()
        faults = joint_failure(self.robot, gait, cell.joint, cell.kind, hold=self.hold)  # type: ignore[arg-type]
        return tuple(replace(fault, at=self._fault_time) for fault in faults)  # type: ignore[type-var]

    def _cell_record(self, record: xr.Dataset, cells: Sequence[FaultWalk], searched: SearchedGaits) -> xr.Dataset:
        """Return the displacements of all conditions by arm, kind, joint and state, and of a limp joint by gait.

        Args:
            record: record of all walks, cell by cell.
            cells: conditions.
            searched: gaits of the search.
        """
        window = time_window(record, self._fault_time)
        position = window.centre_of_mass.sel(xyz="x", drop=True).transpose("run", "time")
        quantities = {
            "forward": (
                settled_displacement(record, self.settled, self.gait.period),
                "displacement along the heading in the settled cycles",
            ),
            "total": (displacement(record, self._fault_time).sel(xyz="x"), "displacement forward since the fault"),
            "track": (position - position.isel(time=0), "displacement forward since the fault, mean over the joints"),
        }
        data = xr.Dataset(
            {"period": ((), self.gait.period, {"units": "s"})},
            attrs={"searched_evaluations": searched.evaluations, "searched_seed": searched.seed},
        )
        for name, (values, long_name) in quantities.items():
            attrs = {"units": "m", "long_name": long_name}
            by_gait = self._by_cell(values.values, cells, searched.joints)
            states = states_of(by_gait)
            data[name] = (states.mean("joint") if name == "track" else states).assign_attrs(attrs)
            if name == "forward":
                crossed = dict(zip(("arm", "kind"), _CROSSED, strict=True))
                data["gait_forward"] = by_gait.sel(crossed, drop=True).assign_attrs(attrs)
                unbroken = values.values[-2 * len(ARMS) * self.repeats :].reshape(len(ARMS), 2, self.repeats)
                data["unbroken_forward"] = (("arm", "reference", "repeat"), unbroken, attrs)
        seconds = window.time.values - self._fault_time
        return data.assign_coords(reference=[KEPT, INTACT], time=("time", seconds, {"units": "s"}))

    def _by_cell(self, values: np.ndarray, cells: Sequence[FaultWalk], joints: Sequence[str]) -> xr.DataArray:
        """Return values of all walks over arm, kind, joint, gait and repeat; NaN for conditions that were not walked.

        Args:
            values: values of shape (walk, ...), cell by cell.
            cells: conditions; those without a fault are left out.
            joints: joints that fail.
        """
        coords: dict[str, list[str]] = {"arm": [*ARMS], "kind": [*KINDS], "joint": [*joints]}
        coords["gait"] = [KEPT, INTACT, *joints]
        shape = [len(names) for names in coords.values()]
        table = np.full((*shape, self.repeats, *values.shape[1:]), np.nan)
        for number, cell in enumerate(cells):
            if cell.joint:
                index = tuple(names.index(name) for names, name in zip(coords.values(), cell, strict=True))
                table[index] = values[number * self.repeats : (number + 1) * self.repeats]
        further_dims = ("time",) if values.ndim > 1 else ()
        return xr.DataArray(table, dims=(*coords, "repeat", *further_dims), coords=coords)

    def measure(self, record: xr.Dataset) -> Measures:
        """Return displacements and gains of every fault, and their means over the joints."""
        measures = Measures()
        for arm, name in product(ARMS, (KEPT, INTACT)):
            measures |= estimated(f"unbroken_{arm}_{name}", record.unbroken_forward.sel(arm=arm, reference=name), "m")
        for arm, kind, joint in product(ARMS, KINDS, record.joint.values):
            cell = record.forward.sel(arm=arm, kind=kind, joint=joint)
            for state in STATES:
                measures |= estimated(f"forward_{joint}_{kind}_{arm}_{state}", cell.sel(state=state), "m")
            measures |= estimated(f"gain_{joint}_{kind}_{arm}", cell.sel(state="told") - cell.sel(state=KEPT), "m")
        for kind in KINDS:
            means = {arm: record.forward.sel(arm=arm, kind=kind).mean("joint") for arm in ARMS}
            gains = {arm: mean.sel(state="told") - mean.sel(state=KEPT) for arm, mean in means.items()}
            fractions = {
                arm: mean.sel(state="told") / record.unbroken_forward.sel(arm=arm, reference=INTACT)
                for arm, mean in means.items()
            }
            for arm in ARMS:
                for state in STATES:
                    measures |= estimated(f"forward_{kind}_{arm}_{state}", means[arm].sel(state=state), "m")
                measures |= estimated(f"gain_{kind}_{arm}", gains[arm], "m")
                search_gain = means[arm].sel(state=INTACT) - means[arm].sel(state=KEPT)
                measures |= estimated(f"search_gain_{kind}_{arm}", search_gain, "m")
                measures |= estimated(f"loss_{kind}_{arm}_told", fractions[arm] - 1.0, "-")
                measures |= _walk_measures(record, arm, kind)
            measures |= estimated(f"difference_{kind}", gains["coordinated"] - gains["limbs_only"], "m")
            measures |= estimated(f"tolerance_{kind}", fractions["coordinated"] - fractions["limbs_only"], "-")
        by_gait = record.gait_forward.mean("joint")
        single = by_gait.isel(gait=int(by_gait.median("repeat").argmax("gait")))
        crossed = dict(zip(("arm", "kind"), _CROSSED, strict=True))
        told = record.forward.sel(crossed).sel(state="told").mean("joint")
        measures |= estimated("forward_limp_coordinated_single", single, "m")
        measures |= estimated("joint_gain_limp_coordinated", told - single, "m")
        return measures

    def explain(self, measures: Mapping[str, float]) -> str:
        """Return what knowing brings, what of it the search alone brings, and what limbs only gain."""
        return self.render_explanation(measures, arms=ARMS, kinds=KINDS)

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw displacements of each fault, the mean displacement over time, and every fault in every gait."""
        record = outcome.record
        numbers = {name: measure.value for name, measure in outcome.measures.items()}
        return {
            "fault_knowledge": draw_gains(record, numbers),
            "fault_knowledge_time": draw_over_time(record),
            "fault_knowledge_gaits": draw_table(record),
        }


def settled_displacement(record: xr.Dataset, cycles: int, period: float) -> xr.DataArray:
    """Return the displacement along the heading over the last cycles of each run [m].

    The heading is the mean over the first of these cycles, so that the swaying within a cycle does not count. A robot
    that a fault has turned before gets its displacement in full.

    Args:
        record: record of several runs.
        cycles: number of cycles.
        period: period of the cycle [s].
    """
    start = float(record.time[-1]) - cycles * period
    facing = heading(time_window(record, start, start + period)).mean("time")
    moved = displacement(record, start)
    return np.cos(facing) * moved.sel(xyz="x") + np.sin(facing) * moved.sel(xyz="y")


def _walk_measures(record: xr.Dataset, arm: str, kind: str) -> Measures:
    """Return what knowing brings over the whole walk since the fault, and from when on it is ahead.

    Args:
        record: record of the experiment.
        arm: group.
        kind: kind of fault.
    """
    total = record.total.sel(arm=arm, kind=kind).mean("joint")
    measures = estimated(f"total_gain_{kind}_{arm}", total.sel(state="told") - total.sel(state=KEPT), "m")
    track = record.track.sel(arm=arm, kind=kind).median("repeat")
    lead = (track.sel(state="told") - track.sel(state=KEPT)).values
    behind = np.flatnonzero(lead <= 0.0)
    is_ahead_at_end = bool(behind.size) and behind[-1] < lead.size - 1
    payback = float(record.time[behind[-1] + 1]) / float(record.period) if is_ahead_at_end else np.nan
    return measures | {f"payback_{kind}_{arm}": Measure(payback, "cycle")}


def states_of(values: xr.DataArray) -> xr.DataArray:
    """Return values of every gait as those of the robots of ``STATES``: the gait of the failed joint is ``told``.

    Args:
        values: values over ``joint`` and ``gait``, with a gait for each joint.
    """
    told = xr.concat([values.sel(joint=joint, gait=joint, drop=True) for joint in values.joint.values], "joint")
    told = told.assign_coords(joint=values.joint)
    states = [values.sel(gait=KEPT, drop=True), values.sel(gait=INTACT, drop=True), told]
    return xr.concat(states, "state").assign_coords(state=list(STATES))


experiment = FaultKnowledge()
