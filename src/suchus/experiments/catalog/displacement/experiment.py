"""How far does the robot crawl, with spine and tail and without?"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import nan
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.article.paper import CLAIMS, CYCLES
from suchus.core.checks import Checks
from suchus.core.errors import InvalidDesign
from suchus.experiments.catalog._replayed import replayed
from suchus.experiments.catalog._two_groups import TwoGroups, of_repeats, of_robots
from suchus.experiments.catalog.displacement.figure import draw_course, draw_crawls, draw_parts, draw_sensitivity
from suchus.experiments.experiment import (
    Extent,
    Measure,
    Measures,
    Outcome,
    Progress,
    Replay,
    SimulationResult,
    ends,
    estimated,
    silent,
    staged,
)
from suchus.robot.control import Learned, Policy
from suchus.robot.design import lacking, layout
from suchus.robot.design.scale import coarse_step
from suchus.robot.gaits import CONDITIONS, belly_crawl, conditions_of
from suchus.robot.motion import START, FootPath, Gait, suits
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import (
    cost_of_transport,
    duty_factor,
    electrical_cost_of_transport,
    foot_clearance,
    heading_change,
    slip,
    two_feet_share,
)
from suchus.sim.metrics import displacement as displacement_of

_GROUPS = CONDITIONS[:2]
_STATED = ("limbs_tail_lifted", "spine_only")
"""Conditions that decide no word."""
POLICY = "policy"
"""Condition of a trained policy."""
_CRAWL = belly_crawl.metres
"""The crawl from which strokes and bends of the map are derived."""
_MIN_DISPLACEMENT_FRACTION = 0.00198  # [body length]; a ratio over less displacement is meaningless
_MIN_MOTION_FRACTION = 0.01  # in each cycle [body length]; less is no crawl, and has no cost of transport


@dataclass(frozen=True, slots=True, kw_only=True)
class Displacement(TwoGroups):
    """The article's two groups, the gain by each part of spine and tail, and a map over the free parameters.

    The displacement is that of the centre of mass from the start of the first cycle to the end of the last, along the
    initial direction of the body. The tail of the control group lies still on the ground; a further condition lifts
    it into the air. Another body gets those conditions that its parts allow, and the part of the map that its limbs
    reach.
    """

    title = "How far does it crawl, with spine and tail and without?"
    shows = "Section IV.B, Fig. 16"
    answers = (
        "forward_coordinated",
        "forward_limbs_only",
        "forward_ratio",
        "forward_policy",
        "gain_policy",
        "gain_spine_swing",
        "gain_tail_swing",
        "gain_tail_contact",
    )
    needs = ("limbs", "axis")
    answer_minima: ClassVar[Mapping[str, float]] = {"cycles": 2, "repeats": 6}

    strokes: tuple[float, ...] = tuple(
        stroke / _CRAWL.stroke for stroke in (0.01, 0.02, _CRAWL.stroke, 0.04, 0.055, 0.07, 0.085)
    )
    """Strokes of the limbs on the map, over those of the gait [-]; of the crawl from 10 to 85 mm."""
    bends: tuple[float, ...] = tuple(bend / _CRAWL.trunk_bend for bend in (0.0, 0.3, 0.6, 0.9, _CRAWL.trunk_bend, 1.5))
    """Bends of the axis on the map, over those of the gait [-]; of the crawl's trunk up to 1.5 rad."""
    pitches: tuple[float, ...] = (0.1, 0.15, 0.2, 0.25, 0.3)
    """Steady angles of the tail's pitch joint, down positive, over its plausible range [rad]."""
    policy: Policy | None = None
    """A trained policy that crawls beside the groups, at its greatest speed straight ahead; None for none."""
    phases: tuple[float, ...] = (-0.5, -0.375, -0.25, -0.15, -0.075, 0.0, 0.075, 0.15, 0.25, 0.375, 0.5)
    """Phase lags of the axis behind the limbs, besides that of the gait, for the curve [cycle]."""
    extent: Extent = "whole"
    """How much is simulated: for the verdicts fewer robots in conditions that decide no word, and no work of servos."""

    def check(self, check: Checks) -> None:
        """Check what the map is drawn over."""
        check.rising("strokes", 0.0, 20.0, "")
        check.rising("bends", 0.0, 20.0, "")
        check.rising("pitches", -1.0, 1.0, "rad")
        check.rising("phases", -1.0, 1.0, "cycle")
        if self.policy is not None:
            self.policy.check_robot(self.robot)

    def for_verdicts(self) -> "Displacement":
        """Return the same question with the ends of the map and the gait itself.

        Fewer robots walk in conditions that decide no word.
        """
        return replace(
            self, strokes=_ends_and(1.0, self.strokes), bends=_ends_and(1.0, self.bends),
            pitches=_ends_and(self.pitches[len(self.pitches) // 2], self.pitches), phases=_ends_and(0.0, self.phases),
            extent="verdicts",
        )  # fmt: skip

    def quick(self) -> "Displacement":
        """One cycle, two repeats, four corners of the map."""
        strokes = tuple(stroke / _CRAWL.stroke for stroke in (0.02, 0.06))
        bends = tuple(bend / _CRAWL.trunk_bend for bend in (0.6, 1.2))
        corners = replace(self, strokes=strokes, bends=bends, pitches=(0.1, 0.3))
        return replace(corners, cycles=1, repeats=2, phases=(0.0, 0.5))

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Simulate every condition as designed and as built, and the map over strokes, bends, pitches and phases."""
        duration = START + self.cycles * self.gait.period
        gaits = conditions_of(self.robot, self.gait, self.control_group)
        runs = [Run(robot=self.robot, gait=gait, label=arm) for arm, gait in gaits.items()]
        if self.policy is not None:
            control = Learned(policy=self.policy, forward=self.policy.max_speed)
            runs.append(Run(robot=self.robot, gait=self.policy.gait, control=control, label=POLICY))
        is_whole = self.extent == "whole"
        record = simulate(runs, duration=duration, effort=is_whole, progress=staged(progress, "conditions", 0.0, 0.1))
        built = self.repeated(
            runs,
            _quantities_and_costs if is_whole else _quantities,
            _UNITS,
            duration,
            staged(progress, "robots as built", 0.1, 0.5),
            effort=is_whole,
            stated=() if is_whole else _STATED,
        )
        record = record.merge(built)
        record = record.merge(self._displacement_map(duration, staged(progress, "map", 0.5, 1.0)))
        record.attrs["least"] = _MIN_DISPLACEMENT_FRACTION * self.robot.length
        return SimulationResult(record=record, replays=self._replays(record))

    def _replays(self, record: xr.Dataset) -> Mapping[str, Replay]:
        """Return the replay of the crawl with all of the axis and of that with limbs only."""
        axis = "a bending trunk" if lacking(self.robot, ("tail_yaw",)) else "spine and tail"
        return replayed(
            "crawl_replay.html",
            record.isel(run=0),
            self.robot,
            ghost=record.isel(run=1),
            labels=(axis, "limbs only"),
            title=f"Crawling with {axis}, and without",
            caption=f"The same legs twice: with {axis}, and, half transparent, with limbs only.",
        )

    def _displacement_map(self, duration: float, progress: Any) -> xr.Dataset:
        """Return the displacement over stroke and bend, over the tail's pitch, and over the trunk's phase lag [m].

        Args:
            duration: duration of each run [s].
            progress: callback that gets the finished fraction.
        """
        strokes, bends, pitches = self._grid()
        limb_gaits = [self.control_group.strode(s) for s in strokes]
        bent_gaits = [self.gait.strode(s).bent(b) for s in strokes for b in bends]
        pitched_gaits = [gait.lifted(p) for gait in (self.gait, self.control_group) for p in pitches]
        lagged_gaits = [self.gait.lagged(p) for p in self.phases]
        gaits = [*limb_gaits, *bent_gaits, *pitched_gaits, *lagged_gaits]
        different_gaits = list(dict.fromkeys(gaits))  # the gait itself is a point of each curve
        different_distances = _forward(
            simulate(
                [Run(robot=self.robot, gait=gait) for gait in different_gaits],
                duration=duration,
                timestep=coarse_step(self.robot),
                sample_stride=100,
                effort=False,
                progress=progress,
            )
        ).values
        distances = different_distances[[different_gaits.index(gait) for gait in gaits]]
        distance_groups = np.split(distances, np.cumsum([len(limb_gaits), len(bent_gaits), len(pitched_gaits)]))
        metres = {"units": "m"}
        data = xr.Dataset(
            {
                "map_limbs_only": ("stroke", distance_groups[0], metres),
                "map_coordinated": (("stroke", "bend"), distance_groups[1].reshape(len(strokes), -1), metres),
                "pitched": (("group", "pitch"), distance_groups[2].reshape(2, -1), metres),
                "late_coordinated": ("late", distance_groups[3], metres),
            },
            coords={
                "stroke": list(strokes),
                "bend": list(bends),
                "group": list(_GROUPS),
                "pitch": list(pitches),
                "late": list(self.phases),
            },
        )
        for name, unit, long_name in (
            ("stroke", "1", "strokes over those of the gait"),
            ("bend", "1", "bends over those of the gait"),
            ("pitch", "rad", "pitch of the tail, down positive"),
            ("late", "1", "phase lag of the trunk's bend, in cycles"),
        ):
            data[name].attrs.update(units=unit, long_name=long_name)
        return data

    def _grid(self) -> tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]:
        """Return those strokes, bends and tail pitches of the map that the body can follow."""
        has_strokes, has_tail_pitch = (
            self.gait.has("strokes"),
            self.gait.has("steering") and layout(self.robot).tail_pitch,
        )
        strokes = self._feasible(self.strokes, self.gait.strode) if has_strokes else ()
        bends = self._feasible(self.bends, self.gait.bent)
        pitches = self._feasible(self.pitches, self.gait.lifted) if has_tail_pitch else ()
        return strokes or (1.0,), bends or (1.0,), pitches

    def _feasible(self, candidates: Sequence[float], change: Callable[[float], Gait]) -> tuple[float, ...]:
        """Return the candidates that give a gait which the body can follow.

        Args:
            candidates: values of one gait parameter.
            change: returns the gait with a value of that parameter; may raise ``InvalidDesign``.
        """

        def is_feasible(candidate: float) -> bool:
            try:
                return suits(self.robot, change(candidate))
            except InvalidDesign:
                return False  # as a stroke beyond the limbs' reach

        return tuple(candidate for candidate in candidates if is_feasible(candidate))

    def measure(self, record: xr.Dataset) -> Measures:
        """Return the quantities of each condition, the gain by each part of the axis, and the ends of the map."""
        units = {name: unit for name, unit in _UNITS.items() if f"repeated_{name}" in record}
        measures = self._without_costs_at_rest(of_repeats(record, units))
        for name, arm, reference in _GAINS:
            if {arm, reference} <= set(record.condition.values):
                forward, reference_forward = of_robots(record, "forward", arm, reference)
                measures |= estimated(f"gain_{name}", forward - reference_forward, "m")
        for name, control in (("forward_ratio", "limbs_only"), ("forward_ratio_tail_lifted", "limbs_tail_lifted")):
            if control in record.condition.values:
                forward, control_forward = of_robots(record, "forward", "coordinated", control)
                measures |= estimated(name, forward / control_forward, "-")
        designed = displacement_of(record).sel(xyz="x").values
        for arm, distance in zip(record.condition.values, designed, strict=True):
            measures[f"forward_{arm}_designed"] = Measure(float(distance), "m")
        measures |= ends("ratio_on_map", _ratio(record), "-")
        measures["forward_antiphase"] = Measure(float(record.late_coordinated.min()), "m")
        if record.sizes["pitch"]:
            measures |= ends("forward_over_tail_pitch", record.pitched.sel(group="coordinated"), "m")
        return measures

    @property
    def _min_motion(self) -> float:
        """Displacement below which the robot does not move [m]."""
        return _MIN_MOTION_FRACTION * self.robot.length * self.cycles

    def _without_costs_at_rest(self, measures: Measures) -> Measures:
        """Return measures in which conditions that do not move have no cost of transport."""
        resting = tuple(
            f"{cost}_{name.removeprefix('forward_')}"
            for cost in ("cost_of_transport", "electrical_cost_of_transport")
            for name, measure in measures.items()
            if name.startswith("forward_") and abs(measure.value) < self._min_motion
        )
        return Measures({name: Measure(nan, "-") if name in resting else measure for name, measure in measures.items()})

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say how far it gets and what decides, or that it does not move."""
        return self.render_explanation(measures, least=self._min_motion, best_legs=self._search_command())

    def _search_command(self) -> str:
        """Return the command that searches each group's best legs; empty where the gait has no strokes to search."""
        if not self.gait.has("strokes"):
            return ""
        name = self.robot.name
        word = name if name in ROBOTS else f"{name}.toml"
        return "suchus optimise crawl" if name == "caiman" else f"suchus optimise crawl --robot {word}"

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the crawls, what each part adds, the displacement over time and what decides it."""
        record, printed_distances = outcome.record, {arm: CLAIMS[f"displacement_{arm}"].value or 0.0 for arm in _GROUPS}
        is_article = self._article()
        is_full_run = self.cycles == CYCLES and not self.unjudged()
        return {
            "crawling": draw_crawls(self.robot, record.isel(run=[0, 1]), _GROUPS),
            "parts": draw_parts(record, _forward(record), printed_distances if is_article else {}),
            "displacement_over_time": draw_course(record, _GROUPS, printed_distances if is_full_run else {}),
            "displacement_map": draw_sensitivity(
                record, _ratio(record), self.gait, self._stroke(), is_article=is_article
            ),
        }

    def _stroke(self) -> float:
        """Return half the distance that a front foot moves back in stance [m]."""
        girdles = zip(self.robot.girdles, self.gait.limbs, strict=True)
        return next((girdle.limb.reach * limb.stroke for girdle, limb in girdles if isinstance(limb, FootPath)), 0.0)

    def _article(self) -> bool:
        """Whether the article's numbers are for this robot and its gaits."""
        default_experiment = type(self)()
        return all(
            getattr(self, name) == getattr(default_experiment, name) for name in ("robot", "gait", "control_group")
        )


def _ends_and(value: float, values: tuple[float, ...]) -> tuple[float, ...]:
    """Return the first and the last of some rising values, and a value between them."""
    return tuple(sorted({values[0], value, values[-1]}))


def _forward(record: xr.Dataset) -> xr.DataArray:
    return displacement_of(record).sel(xyz="x")


_UNITS = {
    "forward": "m",
    "sideways": "m",
    "heading_drift": "rad",
    "slip": "-",
    "cost_of_transport": "-",
    "electrical_cost_of_transport": "-",
    "hind_duty": "-",
    "hind_clearance": "m",
    "two_feet_share": "-",
}
"""Quantities of every condition, and their units."""


def _quantities(record: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the quantities of each run by the names of ``_UNITS`` but costs; of both hind feet the worse counts."""
    hind = {"leg": record.leg.values[-2:]}
    return {
        "forward": _forward(record),
        "sideways": displacement_of(record).sel(xyz="y"),
        "heading_drift": heading_change(record),
        "slip": slip(record),
        "hind_duty": duty_factor(record).sel(hind).max("leg"),
        "hind_clearance": foot_clearance(record).sel(hind).min("leg"),
        "two_feet_share": two_feet_share(record),
    }


def _quantities_and_costs(record: xr.Dataset) -> dict[str, xr.DataArray]:
    """Return the quantities of each run by the names of ``_UNITS``; the record holds what the servos do."""
    costs = {
        "cost_of_transport": cost_of_transport(record),
        "electrical_cost_of_transport": electrical_cost_of_transport(record),
    }
    return _quantities(record) | costs


_GAINS = (
    ("spine_swing", "coordinated", "tail_drag"),
    ("tail_swing", "coordinated", "tail_still"),
    ("tail_contact", "tail_still", "spine_only"),
    ("tail_contact_limbs_only", "limbs_only", "limbs_tail_lifted"),
    (POLICY, POLICY, "coordinated"),
)
"""Gains: name, condition with the motion, condition without it."""


def _ratio(record: xr.Dataset) -> xr.DataArray:
    return record.map_coordinated / record.map_limbs_only.clip(min=record.attrs["least"])


experiment = Displacement()
