"""Do the three feedback rules coordinate the robot, and what are they good for?"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import reduce
from itertools import pairwise
from math import radians
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.core.checks import Checks
from suchus.core.intervals import CONFIDENCE, look_confidence, planned_looks
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog.feedback.figure import draw_fans, draw_gain, draw_onset, draw_topology, draw_tracks
from suchus.experiments.catalog.feedback.together import Part, simulate_parts
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
    estimated_fraction,
    silent,
    staged,
)
from suchus.robot.control import LAWS, Coordinated, HeadingRule, Kick, Runs
from suchus.robot.control.topology import topology
from suchus.robot.design import Robot, layout
from suchus.robot.design.scale import control_period
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import START, Gait, movement
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Ground, Limp, Locked, Push, Run, Tolerances
from suchus.sim.metrics import heading
from suchus.sim.metrics.coordination import PHASE_TOLERANCE, cycles_until, phase_error

_LIMB_RULE_ONLY: Mapping[str, Any] = {"spine": None, "tail": None}
STARTS: Mapping[str, Coordinated] = {
    **{law: Coordinated(limbs=LAWS[law], random_start=True, **_LIMB_RULE_ONLY) for law in LAWS},
    "closed_noisy": Coordinated(random_start=True, load_noise=0.3),
    "isolated_noisy": Coordinated(random_start=True, load_noise=0.3, sharing=False),
}
"""Controls of the random starts: each law alone, then all rules with noisy feet, with and without sharing."""
_DISTANCE_LAWS = ("closed_noisy", "isolated_noisy")
"""Laws whose displacement is measured, with as many starts as the claim on sharing needs; for the others only the
phases are."""
_JUDGED_LAWS = ("off", "cross_load", "wrong_sign")
"""Laws whose fraction of starts that converge is judged; they get more and shorter starts than the others."""
ARMS: Mapping[str, Coordinated] = {
    "open": Coordinated(limbs=LAWS["off"], **_LIMB_RULE_ONLY),
    "limbs": Coordinated(**_LIMB_RULE_ONLY),
    "spine": Coordinated(limbs=LAWS["off"], tail=None),
    "tail": Coordinated(limbs=LAWS["off"], spine=None),
    "closed": Coordinated(),
    "steered": Coordinated(heading=HeadingRule()),
}
"""Controls that are disturbed: no rule, each rule alone, all three, all three with the heading loop."""
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
"""Disturbances; each begins after one cycle, except that a slope exists from the start."""
_CLAIM_LAWS = ("off", "cross_load", "wrong_sign", *_DISTANCE_LAWS)
_CLAIM_DISTURBANCES = ("none", "locked_spine", "uphill")
_TOLD_DISTURBANCES = (*_CLAIM_DISTURBANCES, "kick", "push", "limp_yaw")
"""Those of the claims, and those that the reasons of the verdicts and the explanation name."""
_TOLD_LAWS = ("off", "own_load", "cross_load", "wrong_sign", *_DISTANCE_LAWS)
"""Those of the claims, and those that the reasons of the verdicts and the explanation name."""
_START_MEASURES = {
    *(f"{name}{end}" for name in ("converged_cross_load", "converged_wrong_sign", "way_gain_shared", "way_shared",
      "way_isolated") for end in ("", "_low", "_high")),
    "way_shared_least", "way_isolated_least",
}  # fmt: skip
"""Measures of the claims for which the starts under the laws of the claims suffice."""
_DISTURBED_MEASURES = {
    "distortion", "spine_lacking_spine", "spine_lacking_open", "spine_lacking_growth", "kept_undisturbed_spine",
    "tail_load_tail", "tail_load_open", "tail_pitch_drift", "kept_undisturbed_tail", "locked_spine_loss_closed",
    "locked_spine_loss_open",
}  # fmt: skip
"""Measures of the claims for which the disturbances of the claims suffice."""
REPORTED_ARMS = ("open", "closed", "steered")
"""Controls whose measures are reported."""
_TOLD_ARMS: Mapping[str, tuple[str, ...]] = {
    "none": ("limbs", "spine", "tail"), "locked_spine": ("spine",), "uphill": ("tail",), "limp_yaw": ("steered",),
}  # fmt: skip
"""Disturbances of which more is told than of walks without a rule and with all three, and the controls of that."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Feedback(Experiment):
    """Random limb phases under every law, then nine disturbances with and without the rules.

    A start converges when the largest of the four phase errors (two diagonal pairs, two girdles) stays within
    0.1 cycle until the end of the run, and for at least ``hold`` cycles. Recovery is the displacement along the initial
    heading over the ``after`` cycles from the disturbance on. Drift is the distance down a lateral slope, the mean of
    both sides. A body without a servo that pitches its tail has no rule for the tail.
    """

    title = "Do three feedback rules coordinate limbs, spine and tail, and what do they help against?"
    shows = "Sections II.B and III.D, Fig. 10"
    answers = (
        "converged_cross_load",
        "cycles_to_converge",
        "kick_kept_open",
        "kick_kept_closed",
        "uphill_gain_closed",
        "turning_limp_yaw_steered",
    )
    needs = ("limbs", "trunk")
    judged_settings = ("robot", "gait", "kick", "slope", "push", "noise")
    judged_minima: ClassVar[Mapping[str, float]] = {
        "starts": 16, "compared_starts": 6, "sharing_starts": 12, "judged_cycles": 6, "cycles": 12, "hold": 2.0,
        "after": 5,
    }  # fmt: skip
    answer_minima: ClassVar[Mapping[str, float]] = {"starts": 16, "judged_cycles": 6, "cycles": 12}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that crawls."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """Gait of the robot; its limbs must form diagonal pairs."""
    starts: int = 72
    """Number of random initial limb phases of each law whose converged fraction is judged [-]: if all of 72 converge,
    the exact interval begins above 95 %."""
    compared_starts: int = 16
    """Number of random initial limb phases of each law that is only compared [-]: the first of the judged laws'."""
    sharing_starts: int = 32
    """Greatest number of random initial limb phases with and without sharing [-]. After half of them sampling ends if
    the claim has a word by then, and for the verdicts after a quarter of them."""
    early_end: bool = True
    """Whether sampling with and without sharing ends before the last start if the claim has a word by then."""
    judged_cycles: int = 7
    """Simulated duration of each start whose converged fraction is judged [cycle]. The slowest of 72 starts converges
    after 3.5 cycles, and the wrong sign has as long."""
    cycles: int = 12
    """Simulated duration of each other start [cycle]."""
    hold: float = 2.0
    """Duration for which the limbs must stay coordinated until the end [cycle]."""
    after: int = 5
    """Simulated duration from the disturbance on [cycle]."""
    kick: tuple[float, ...] = (0.5, 0.0, 0.0, 0.2)
    """Phase jump of each limb, in the order of the robot's limbs [cycle]; the default is almost the farthest from the
    gait."""
    slope: float = radians(10)
    """Slope of the ground [rad]."""
    push: tuple[float, float, float] = (0.0, 20.0, 0.0)
    """Force on the foremost girdle's segment for 0.3 s [N]; 5 N does nothing even without feedback."""
    noise: float = 0.3
    """Standard deviation of the noise on the sensed loads of the feet, as a fraction of the load [-]."""
    disturbances: tuple[str, ...] = DISTURBANCES
    """Names of the disturbances that are simulated; the measures of others are not known."""
    extent: Extent = "whole"
    """How much is simulated: the whole, or what the verdicts and their reasons need. Then the law that feels the
    trunk's torque is left out, so are single rules and the heading loop under disturbances in which nothing is told of
    them, and a start ends as soon as it is known whether it converges, see ``known.KnownStarts``; the first of each law
    goes on. Sampling with and without sharing has three looks in the place of two."""
    tolerances: Tolerances = field(default_factory=Tolerances)
    """Tolerances of the robots of the starts, each built of the design, and of their grounds."""
    seed: int = 0
    """Seed of the first start and its robot; the others follow."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("starts", 1, 1000)
            check.whole("compared_starts", 1, 1000)
            check.whole("sharing_starts", 1, 1000)
            check.whole("judged_cycles", 1, 1000)
            check.whole("cycles", 1, 1000)
            check.number("hold", 0.1, 1000.0, "cycle")
            check.whole("after", 1, 1000)
            check.each("kick", layout(self.robot).limb_names, -1.0, 1.0, "cycle")
            check.number("slope", 0.0, 0.5, "rad")
            check.each("push", ("forward", "left", "up"), -1e3, 1e3, "N")
            check.number("noise", 0.0, 10.0, "")
            check.whole("seed", 0, 2**31)
            unknown = [name for name in self.disturbances if name not in DISTURBANCES]
            check.that(
                not unknown,
                f"{self.name()}.disturbances are {', '.join(DISTURBANCES)}; there is no {', '.join(unknown)}",
            )
            check.that(
                "none" in self.disturbances,
                f"{self.name()}.disturbances lacks 'none', with which the others are compared; add it",
            )

    def for_verdicts(self) -> "Feedback":
        """Return the same question with fewer starts of the laws that are only compared, and fewer disturbances.

        A judged start has six cycles: the slowest converges after 3.5 and holds for two. It ends once it is known
        whether it converges. Those with and without sharing keep their twelve: after eight the gain by sharing still
        grows.
        """
        return replace(
            self,
            extent="verdicts",
            compared_starts=min(self.compared_starts, 6),
            judged_cycles=min(self.judged_cycles, 6),
            disturbances=tuple(name for name in self.disturbances if name in _TOLD_DISTURBANCES),
        )

    def quick(self) -> "Feedback":
        """Two starts, few and short cycles."""
        return replace(
            self, gait=replace(self.gait, period=2.0), starts=2, compared_starts=2, sharing_starts=2, judged_cycles=2,
            cycles=2, hold=0.5, after=1,
        )  # fmt: skip

    def gaits_for_robot(self, robot: Robot) -> dict[str, Any]:
        """Return the robot's own gait, and a kick for each of its limbs.

        Raises:
            OutsideLimits: its own gait has measured curves.
        """
        gait = default_gait(robot)
        gait.needs_steering(self.name())
        kick = (*self.kick, *(0.0,) * len(gait.limb_phases))[: len(gait.limb_phases)]
        return {"gait": gait, "kick": kick}

    def _suited_control(self, control: Coordinated) -> Coordinated:
        return control.suited(self.robot, self.gait)

    @property
    def _arms(self) -> dict[str, Coordinated]:
        """Those of ``ARMS`` whose rule the body can follow, by name."""
        return {
            name: self._suited_control(control)
            for name, control in ARMS.items()
            if name != "tail" or self._suited_control(control).tail is not None
        }

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Simulate crawls from random initial phases, then disturbances of a robot whose phases are right."""
        laws = tuple(STARTS) if self.extent == "whole" else _TOLD_LAWS
        starts, disturbed, pair = self._records(progress, laws, self.disturbances)
        return SimulationResult(record=xr.merge([starts, disturbed]), replays=self._replays(pair))

    def simulate_measures(self, measure_names: Collection[str], progress: Progress = silent) -> Measures:
        """Return at least the requested measures; those of the claims need fewer laws and disturbances."""
        if not set(measure_names) <= _START_MEASURES | _DISTURBED_MEASURES:
            return super(Feedback, self).simulate_measures(measure_names, progress)
        needs_disturbances = not set(measure_names) <= _START_MEASURES
        starts, disturbed, _ = self._records(progress, _CLAIM_LAWS, _CLAIM_DISTURBANCES if needs_disturbances else ())
        measures = start_measures(starts, self.gait, self.hold)
        if needs_disturbances:
            measures |= disturbed_measures(disturbed, self.gait, self.hold, self.after)
        return Measures({name: measures[name] for name in measure_names})

    def measure(self, record: xr.Dataset) -> Measures:
        """Return how many starts converge, and the effect of each rule on each disturbance."""
        return start_measures(record, self.gait, self.hold) | disturbed_measures(
            record, self.gait, self.hold, self.after
        )

    def _replays(self, pair: xr.Dataset) -> Mapping[str, Replay]:
        """Return the replay of one random start with feedback, and without as a transparent ghost, by its file name.

        Args:
            pair: record of two runs, that with feedback first.
        """
        return replayed(
            "feedback_replay.html",
            pair.isel(run=0),
            self.robot,
            ghost=pair.isel(run=1),
            labels=("feeling its loads", "without feedback"),
            title="Finding the gait",
            caption=(
                "From limbs out of step: loads felt across the body bring them into the gait, and, half transparent, "
                "without feedback they stay as they are."
            ),
        )

    @property
    def _front_segment(self) -> str:
        """Name of the segment at the foremost girdle."""
        return self.robot.girdles[0].segment

    @property
    def _push_duration(self) -> float:
        """Duration of the push [s]: 0.3 s for a body as long as the article's."""
        period = control_period(self.robot)
        return max(1, round(0.3 * (self.robot.length / ROBOTS["caiman"].length) ** 0.5 / period)) * period

    @property
    def _disturbance_time(self) -> float:
        """Time at which the disturbance begins [s]."""
        return START + self.gait.period

    @property
    def _looks(self) -> tuple[int, ...]:
        """Numbers of starts with and without sharing after which sampling may end [-]."""
        count = min(self.sharing_starts, self.starts)
        return planned_looks(count, 2 if self.extent == "whole" else 3) if self.early_end else (count,)

    def _records(
        self, progress: Progress, laws: Collection[str], disturbances: Sequence[str] = ()
    ) -> tuple[xr.Dataset, xr.Dataset, xr.Dataset]:
        """Simulate random starts and disturbances, those with and without sharing until their claim has a word.

        Args:
            progress: callback that gets the finished fraction.
            laws: names of ``STARTS`` to simulate, the judged laws among them; the result is NaN for the others.
            disturbances: names of ``DISTURBANCES`` to simulate.

        Returns:
            Limb phases (law, start, start_time, leg) [cycle] and displacements (law, start, start_time) [m], NaN where
            a law has fewer or shorter starts than another; the record of the disturbances, see
            ``_disturbance_record``, empty without any; the record of the first start under the laws ``cross_load`` and
            ``off``.
        """
        judged_laws, sharing_laws = ([law for law in laws if law in group] for group in (_JUDGED_LAWS, _DISTANCE_LAWS))
        compared_laws = [law for law in laws if law not in (*judged_laws, *sharing_laws)]
        groups = [
            (names, starts, cycles)
            for names, starts, cycles in (
                (judged_laws, range(self.starts), self.judged_cycles),
                (compared_laws, range(min(self.compared_starts, self.starts)), self.cycles),
                (sharing_laws, range(self._looks[0]), self.cycles),
            )
            if names
        ]
        parts = [self._start_part(*group) for group in groups]
        if disturbances:
            parts.append(self._disturbance_part(disturbances))
        records = self._simulate(parts, staged(progress, "random starts and disturbances", 0.0, 0.8))
        data = [self._start_data(*group, record) for group, record in zip(groups, records, strict=False)]
        if sharing_laws:
            data[-1] = self._sharing_record(data[-1], staged(progress, "more starts", 0.8, 1.0))
        starts = reduce(xr.Dataset.combine_first, data).reindex(law=list(STARTS)).drop_vars("start")
        disturbed = self._disturbance_record(disturbances, records[-1]) if disturbances else xr.Dataset()
        cells = self._cells(judged_laws, range(self.starts))
        return starts, disturbed, records[0].isel(run=[cells.index((law, 0)) for law in ("cross_load", "off")])

    def _simulate(self, parts: Sequence[Part], progress: Progress) -> list[xr.Dataset]:
        """Return the record of each part."""
        return simulate_parts(parts, progress, known_after=None if self.extent == "whole" else self.hold)

    def _sharing_record(self, first_starts: xr.Dataset, progress: Progress) -> xr.Dataset:
        """Simulate more random starts with and without sharing until the claim has a word, or there are no more.

        Args:
            first_starts: limb phases and displacements of the starts up to the first look.
            progress: callback that gets the finished fraction.
        """
        laws, looks, parts = [str(law) for law in first_starts.law.values], self._looks, [first_starts]
        for end, next_end in pairwise((*looks, looks[-1])):
            record = xr.concat(parts, "start", join="exact", data_vars="minimal")
            record["sharing_looks"] = (
                (),
                len(looks),
                {"units": "1", "long_name": "planned looks of sequential sampling"},
            )
            if end == looks[-1] or self.has_word("shared_variables", sharing_measures(record, self.gait, self.hold)):
                break
            stage = staged(progress, "", end / looks[-1], next_end / looks[-1])
            parts.append(self._further_starts(laws, range(end, next_end), stage))
        return record

    def _further_starts(self, laws: Sequence[str], starts: range, progress: Progress) -> xr.Dataset:
        """Return limb phases and displacements of some more random starts of some laws, see ``_start_data``."""
        (record,) = self._simulate([self._start_part(laws, starts, self.cycles)], progress)
        return self._start_data(laws, starts, self.cycles, record)

    def _controls(self, laws: Sequence[str]) -> dict[str, Coordinated]:
        """Return the controls of some laws of ``STARTS`` as the body allows them, by name."""
        return {law: self._suited_control(STARTS[law]) for law in laws}

    def _open_loop_laws(self, laws: Sequence[str]) -> list[str]:
        """Return those of some laws that sense nothing, so that their phases follow without physics."""
        controls = self._controls(laws)
        return [law for law, control in controls.items() if not control.feels and law not in _DISTANCE_LAWS]

    def _cells(self, laws: Sequence[str], starts: range) -> list[tuple[str, int]]:
        """Return law and number of the starts that are simulated: of a law that senses nothing the first alone."""
        open_loop_laws = self._open_loop_laws(laws)
        return [(law, i) for law in laws for i in starts if i == 0 or law not in open_loop_laws]

    def _start_part(self, laws: Sequence[str], starts: range, cycles: int) -> Part:
        """Return the runs of some random starts of some laws.

        Args:
            laws: names of ``STARTS``.
            starts: numbers of the starts.
            cycles: simulated duration of each [cycle].
        """
        controls, cells = self._controls(laws), self._cells(laws, starts)
        runs = [
            self.tolerances.draw_run(
                Run(robot=self.robot, gait=self.gait, control=controls[law], seed=self.seed + i), self.seed + i
            )
            for law, i in cells
        ]
        return Part(runs, cycles, np.array([i == 0 or law in _DISTANCE_LAWS for law, i in cells]))

    def _start_data(self, laws: Sequence[str], starts: range, cycles: int, record: xr.Dataset) -> xr.Dataset:
        """Return limb phases and displacements of some random starts of some laws, see ``_records``.

        Args:
            laws: names of ``STARTS``.
            starts: numbers of the starts.
            cycles: simulated duration of each [cycle].
            record: record of the runs of ``_start_part``.
        """
        controls, cells = self._controls(laws), self._cells(laws, starts)
        shape = (len(laws), len(starts), record.sizes["time"])
        phase, distance = np.full((*shape, record.sizes["leg"]), np.nan), np.full(shape, np.nan)
        for law in self._open_loop_laws(laws):
            phase[laws.index(law)] = self._phases(controls[law], starts, record.time.values)
        indices = tuple(np.array([(laws.index(law), i - starts.start) for law, i in cells]).T)
        phase[indices] = record.limb_phase.transpose("run", "time", "leg").values
        distance[indices] = record.centre_of_mass.sel(xyz="x").transpose("run", "time").values
        dims, metre = ("law", "start", "start_time"), {"units": "m"}
        return xr.Dataset(
            {
                "start_phase": ((*dims, "leg"), phase, {"units": "1", "long_name": "phase of each limb [cycle]"}),
                "start_way": (dims, distance, metre | {"long_name": "displacement of the centre of mass along x"}),
                "start_cycles": ("law", np.full(len(laws), float(cycles)), {"units": "1", "long_name": "[cycle]"}),
            },
            coords={
                "law": list(laws),
                "start": list(starts),
                "start_time": ("start_time", record.time.values, {"units": "s"}),
                "leg": record.leg.values,
            },
        )

    def _phases(self, control: Coordinated, starts: range, time: np.ndarray) -> np.ndarray:
        """Return the limb phases of some starts under an open-loop law, shape (start, time, limb) [cycle].

        No state of the body changes these phases, so no physics is simulated for them.

        Args:
            control: control whose law senses nothing.
            starts: numbers of the starts.
            time: times at which the phases are returned [s].
        """
        period, count = control_period(self.robot), len(starts)
        ticks = np.round(time / period).astype(int)
        seeds = tuple(self.seed + i for i in starts)
        runs = Runs((control,) * count, (self.robot,) * count, (self.gait,) * count, seeds, int(ticks[-1]) + 1)
        controller = control.start(runs, period)
        return np.stack([controller.command(int(tick), None).phase for tick in ticks], axis=1)

    def _disturbance_part(self, names: Sequence[str]) -> Part:
        """Return the runs of some disturbances under every control.

        Args:
            names: names of ``DISTURBANCES``.
        """
        arms = self._arms
        runs = [self._disturbed_run(arms[arm], name) for name in names for arm in arms if self._has_cell(name, arm)]
        return Part(runs, 1 + self.after, np.ones(len(runs), dtype=bool))

    def _disturbance_record(self, names: Sequence[str], record: xr.Dataset) -> xr.Dataset:
        """Return what disturbances do under every control.

        Args:
            names: names of ``DISTURBANCES``; the result is NaN for the others.
            record: record of the runs of ``_disturbance_part``.

        Returns:
            Position [m], heading [rad], missing bend of the trunk [rad] and limb phases [cycle] over (disturbance, arm,
            time); where a servo pitches the tail, also its commanded pitch [rad] and its torque [N m].
        """
        arms, body_layout = self._arms, layout(self.robot)
        is_cell = np.array([[self._has_cell(name, arm) for arm in arms] for name in names])
        dims = ("disturbance", "arm", "time")

        def gathered(quantity: np.ndarray) -> np.ndarray:
            """Return a quantity of all runs by disturbance and arm, NaN of the cells without a run."""
            values = np.full((*is_cell.shape, *quantity.shape[1:]), np.nan)
            values[is_cell] = quantity
            return values

        track = gathered(record.centre_of_mass.transpose("run", "time", "xyz").values)
        phase = record.limb_phase.transpose("run", "time", "leg").values
        trunk_bend = (
            record.servo_angle.isel(servo=list(body_layout.trunk_yaw)).sum("servo").transpose("run", "time").values
        )
        self.gait.needs_steering(self.name())
        commanded_motion = movement(self.robot, self.gait)
        missing_bend = commanded_motion.bend_of("trunk", commanded_motion.axis_phase(phase)) - trunk_bend
        data = xr.Dataset(
            {
                "x": (dims, track[..., 0], {"units": "m", "long_name": "distance forward"}),
                "y": (dims, track[..., 1], {"units": "m", "long_name": "distance to the left"}),
                "heading": (
                    dims,
                    gathered(heading(record).transpose("run", "time").values),
                    {"units": "rad", "long_name": "direction of the body"},
                ),
                "lacking": (dims, gathered(missing_bend), {"units": "rad", "long_name": "bend missing in the trunk"}),
                "limb_phase": ((*dims, "leg"), gathered(phase), {"units": "1", "long_name": "[cycle]"}),
            },
            coords={
                "disturbance": list(names),
                "arm": list(arms),
                "time": ("time", record.time.values, {"units": "s"}),
                "leg": record.leg.values,
            },
        )
        if "tail" in arms:
            tail_servo = body_layout.tail_pitch[0]
            pitch, torque = (
                gathered(quantity.isel(servo=tail_servo).transpose("run", "time").values)
                for quantity in (record.servo_target, record.servo_torque)
            )
            data["tail_pitch"] = (dims, pitch, {"units": "rad", "long_name": "commanded, down positive"})
            data["tail_load"] = (dims, torque, {"units": "N m", "long_name": "on the tail's pitch servo"})
        return data.reindex(disturbance=list(DISTURBANCES))

    def _has_cell(self, name: str, arm: str) -> bool:
        """Return whether a control walks under a disturbance."""
        return self.extent == "whole" or arm in ("open", "closed", *_TOLD_ARMS.get(name, ()))

    def _disturbed_run(self, control: Coordinated, name: str) -> Run:
        """Return the run of a control under a disturbance.

        Args:
            control: control of the robot.
            name: one of ``DISTURBANCES``.
        """
        run = Run(robot=self.robot, gait=self.gait, control=control, seed=self.seed, label=name)
        body_layout = layout(self.robot)
        match name:
            case "kick":
                return replace(run, control=replace(control, kicks=(Kick(self._disturbance_time, self.kick),)))
            case "load_noise":
                return replace(run, control=replace(control, load_noise=self.noise))
            case "locked_spine":
                return replace(
                    run,
                    faults=(
                        Locked(
                            body_layout.servos[body_layout.trunk_yaw[len(body_layout.trunk_yaw) // 2]],
                            at=self._disturbance_time,
                        ),
                    ),
                )
            case "limp_yaw":
                return replace(
                    run, faults=(Limp(body_layout.servos[body_layout.limbs[0].servos][0], at=self._disturbance_time),)
                )
            case "push":
                return replace(
                    run,
                    pushes=(
                        Push(
                            force=self.push,
                            at=self._disturbance_time,
                            duration=self._push_duration,
                            body=self._front_segment,
                        ),
                    ),
                )
            case "uphill" | "downhill":
                return replace(run, ground=Ground(uphill=self.slope if name == "uphill" else -self.slope))
            case "side_slope" | "other_side":
                return replace(run, ground=Ground(sideways=self.slope if name == "side_slope" else -self.slope))
        return run

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the starts, one of them as a gait diagram, what each rule gains, the tracks."""
        record = outcome.record
        error = phase_error(record.start_phase, self.gait).rename(start_time="time")
        cycles = (error.time - START) / self.gait.period
        is_followed = record.start_phase.isel(start=0).sel(law=["off", "own_load", "cross_load"]).notnull()
        is_followed = is_followed.all(("law", "leg")).values
        response = record.sel(time=slice(self._disturbance_time - 1e-9, None))
        tracks = [name for name in ("limp_yaw", "push", "side_slope") if name in self.disturbances]
        return {
            "random_starts": draw_fans(error.assign_coords(time=cycles), PHASE_TOLERANCE),
            "finding_the_gait": draw_onset(
                record.start_phase.assign_coords(start_time=cycles.values).isel(start_time=is_followed), self.gait
            ),
            "what_each_rule_gains": draw_gain(
                (response.x.isel(time=-1) - response.x.isel(time=0)).dropna("disturbance", how="all")
            ),
            "topology": draw_topology(topology(self.robot, self.gait)),
            **({"disturbed_tracks": draw_tracks(response, tracks)} if tracks else {}),
        }


def start_measures(record: xr.Dataset, gait: Gait, hold: float) -> Measures:
    """Return how many starts converge, how fast, with which phase error, and the gain by sharing the phases.

    Args:
        record: record of the random starts.
        gait: gait that the robots were commanded.
        hold: duration for which a start must stay coordinated to count as converged [cycle].
    """
    all_errors = phase_error(record.start_phase, gait).rename(start_time="time")
    period, measures = gait.period, Measures()
    for law in map(str, record.law.values):
        error = all_errors.sel(law=law).dropna("start", how="all").dropna("time", how="all")
        if not error.size:
            continue
        convergence_cycles = cycles_until(error, period, start=START, hold=hold)
        measures |= estimated_fraction(
            f"converged_{law}", np.isfinite(convergence_cycles), confidence=_confidence(record, law)
        )
        last_errors = error.where(error.time >= _end_times(error) - hold * period - 1e-9)
        measures[f"phase_error_{law}"] = Measure(float(last_errors.mean()), "-")
        if law in ("own_load", "cross_load", "body_limb", "closed_noisy"):
            cycles = float(record.start_cycles.sel(law=law))
            upper_quantile = np.quantile(np.minimum(convergence_cycles, cycles), 0.9)
            measures[f"cycles_to_converge_{law}"] = Measure(float(upper_quantile), "-")
    measures["cycles_to_converge"] = measures.pop("cycles_to_converge_cross_load")
    measures["converged_closed"] = measures["converged_cross_load"]
    measures["converged_open"] = measures["converged_off"]
    return measures | sharing_measures(record, gait, hold)


def _confidence(record: xr.Dataset, law: str) -> float:
    """Return the confidence of the intervals of a law [-], greater where sampling could end early."""
    return look_confidence(int(record.sharing_looks)) if law in _DISTANCE_LAWS else CONFIDENCE


def sharing_measures(record: xr.Dataset, gait: Gait, hold: float) -> Measures:
    """Return the displacement in a cycle with shared phases and without, and the gain by sharing, of the same starts.

    Args:
        record: record of the random starts with and without sharing.
        gait: gait that the robots were commanded.
        hold: duration at the end of the starts that is measured [cycle].
    """
    distances = record.start_way.sel(law=list(_DISTANCE_LAWS)).rename(start_time="time").dropna("time", how="all")
    has_started = distances.notnull().any("time").all("law").values
    distances = _last_seconds(distances.isel(start=has_started), hold * gait.period)
    distances = (distances.isel(time=-1) - distances.isel(time=0)) / hold
    measures, confidence = Measures(), look_confidence(int(record.sharing_looks))
    for name, law in zip(("shared", "isolated"), _DISTANCE_LAWS, strict=True):
        measures |= estimated(f"way_{name}", distances.sel(law=law), "m", confidence=confidence)
        measures[f"way_{name}_least"] = Measure(float(distances.sel(law=law).min()), "m")
    shared, isolated = (distances.sel(law=law, drop=True) for law in _DISTANCE_LAWS)
    return measures | estimated("way_gain_shared", shared - isolated, "m", confidence=confidence)


def disturbed_measures(record: xr.Dataset, gait: Gait, hold: float, cycles_after: int) -> Measures:
    """Return distances and turns after each disturbance, and the effect of the rules on them.

    Args:
        record: record of the disturbances.
        gait: gait of the robot; the disturbance begins after one cycle.
        hold: longest duration for which phases must stay coordinated to count as recovered [cycle].
        cycles_after: simulated duration after the disturbance [cycle].
    """
    disturbed_at = START + gait.period
    response = record.sel(time=slice(disturbed_at - 1e-9, None))
    change = response.isel(time=-1) - response.isel(time=0)
    changes = {(d, a): change.sel(disturbance=d, arm=a) for d in record.disturbance.values for a in record.arm.values}
    distance = {key: float(value.x) for key, value in changes.items()}
    measures = Measures()
    for name in record.disturbance.values:
        for arm in REPORTED_ARMS:
            measures[f"recovery_{name}_{arm}"] = Measure(distance[name, arm], "m")
            measures[f"heading_{name}_{arm}"] = Measure(float(changes[name, arm].heading), "rad")
    error = phase_error(record.limb_phase.sel(disturbance="kick", arm="closed"), gait)
    recovery_cycles = float(cycles_until(error, gait.period, start=disturbed_at, hold=min(hold, 0.5)))
    ratios = {
        "kick_kept_open": distance["kick", "open"] / distance["none", "open"],
        "kick_kept_closed": distance["kick", "closed"] / distance["none", "closed"],
        "cycles_after_kick": min(recovery_cycles, float(cycles_after)),
        "locked_spine_loss_open": 1.0 - distance["locked_spine", "open"] / distance["none", "open"],
        "locked_spine_loss_closed": 1.0 - distance["locked_spine", "closed"] / distance["none", "open"],
        "locked_spine_loss_of_own": 1.0 - distance["locked_spine", "closed"] / distance["none", "closed"],
        "uphill_gain_closed": distance["uphill", "closed"] / distance["uphill", "open"] - 1.0,
    }
    if ("uphill", "tail") in distance:
        ratios["uphill_gain_tail"] = distance["uphill", "tail"] / distance["uphill", "open"] - 1.0
    measures |= {name: Measure(value, "-") for name, value in ratios.items()}
    earlier_heading = response.heading.sel(time=response.time[-1] - gait.period, method="nearest")
    turning = (response.heading.isel(time=-1) - earlier_heading).sel(disturbance="limp_yaw")
    for arm in REPORTED_ARMS:
        drift = float(changes["other_side", arm].y - changes["side_slope", arm].y) / 2
        measures[f"drift_side_slope_{arm}"] = Measure(drift, "m")
        measures[f"turning_limp_yaw_{arm}"] = Measure(float(turning.sel(arm=arm)), "rad")
    return measures | _undisturbed_measures(record, gait) | _loop_measures(response, gait)


def _loop_measures(response: xr.Dataset, gait: Gait) -> Measures:
    """Return how well the loops of spine and tail hold what they control.

    Args:
        response: record of the disturbances from the disturbance on.
        gait: gait of the robot.
    """
    missing_bend = response.lacking.sel(disturbance="locked_spine")
    first_cycle_end = response.time[0] + gait.period
    final_error = {arm: _rms(_last_seconds(missing_bend.sel(arm=arm), gait.period)) for arm in ("open", "spine")}
    first_cycle_error = _rms(missing_bend.sel(arm="spine", time=slice(None, first_cycle_end)))
    measures = Measures(
        {
            "spine_lacking_open": Measure(final_error["open"], "rad"),
            "spine_lacking_spine": Measure(final_error["spine"], "rad"),
            "spine_lacking_growth": Measure(final_error["spine"] / first_cycle_error, "-"),
        }
    )
    if "tail_load" not in response:
        return measures
    uphill = response.sel(disturbance="uphill")
    load = {
        arm: abs(float(_last_seconds(uphill.tail_load.sel(arm=arm), gait.period).mean())) for arm in ("open", "tail")
    }
    pitch = uphill.tail_pitch.sel(arm="tail")
    previous_pitch = pitch.sel(time=slice(None, max(float(pitch.time[-1]) - gait.period, float(pitch.time[0]))))
    drift = abs(float(_last_seconds(pitch, gait.period).mean() - _last_seconds(previous_pitch, gait.period).mean()))
    return measures | {
        "tail_load_open": Measure(load["open"], "N m"),
        "tail_load_tail": Measure(load["tail"], "N m"),
        "tail_pitch_drift": Measure(drift, "rad"),
    }


def _undisturbed_measures(record: xr.Dataset, gait: Gait) -> Measures:
    """Return the effect of the rules on a robot whose phases are right, over the first two cycles.

    Args:
        record: record of the disturbances, with ``none`` among them.
        gait: gait of the robot.
    """
    first_cycles = record.sel(time=slice(START - 1e-9, START + 2 * gait.period + 1e-9), disturbance="none")
    change = first_cycles.isel(time=-1) - first_cycles.isel(time=0)
    distance = {arm: float(change.x.sel(arm=arm)) for arm in record.arm.values}
    clock = change.limb_phase.mean("leg")
    measures = Measures(
        {
            "distortion": Measure(abs(distance["limbs"] / distance["open"] - 1.0), "-"),
            "kept_undisturbed_spine": Measure(distance["spine"] / distance["open"], "-"),
            "way_gained": Measure(distance["closed"] / distance["open"] - 1.0, "-"),
            "clock_closed": Measure(float(clock.sel(arm="closed")) / float(clock.sel(arm="open")), "-"),
        }
    )
    if "tail_pitch" not in record:
        return measures
    pitch = record.tail_pitch.sel(arm="closed").isel(time=-1)
    return measures | {
        "kept_undisturbed_tail": Measure(distance["tail"] / distance["open"], "-"),
        "tail_pitch_level": Measure(float(pitch.sel(disturbance="none")), "rad"),
        "tail_pitch_uphill": Measure(float(pitch.sel(disturbance="uphill")), "rad"),
    }


def _end_times(error: xr.DataArray) -> xr.DataArray:
    """Return the time of the last sample of each start [s]; starts whose answer is known end before others."""
    return error.time.where(error.notnull()).max("time")


def _last_seconds(values: xr.DataArray, seconds: float) -> xr.DataArray:
    """Return the values of the last seconds of a time series."""
    return values.sel(time=slice(float(values.time[-1]) - seconds - 1e-9, None))


def _rms(values: xr.DataArray) -> float:
    """Return the root mean square."""
    return float((values**2).mean() ** 0.5)


experiment = Feedback()
