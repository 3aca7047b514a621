"""Do the article's formulas for the cable-driven tail hold?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import product
from math import pi
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.article.paper import CYCLES
from suchus.core.errors import OutsideLimits
from suchus.experiments.catalog.tail_bending import figure as pictures
from suchus.experiments.catalog.tail_bending.rules import EQUAL_ANGLE_TOLERANCE
from suchus.experiments.experiment import (
    Experiment,
    Measure,
    Measures,
    Outcome,
    Progress,
    SimulationResult,
    silent,
    staged,
)
from suchus.robot.design import Robot, cable_joints, servo_names
from suchus.robot.design.measures import TailMeasures
from suchus.robot.gaits import GAITS
from suchus.robot.kinematics import printed, tail
from suchus.robot.motion import START, Gait
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import require_complete, tail_joint_spread, time_window

SHAPES = (0.0, pi / 2, pi)
"""Bends at which the tail is drawn [rad]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TailBending(Experiment):
    """Follow cords, servo and joints of the tail from straight to a half turn, exactly and as printed.

    The formulas assume that all joints turn by the same angle. Two crawls test this assumption: the article's, and one
    with a straight trunk and a swinging tail.
    """

    title = "How good are the tail's formulas, from straight to bent by a half turn and in the crawl?"
    shows = "Section III.C: eqs (16) to (19)"
    answers = (
        "error_of_eq_17_max",
        "slack_max",
        "printed_last_joint_error_max",
        "printed_last_joint_error_share",
        "bend_limit_of_gaps",
    )
    needs = ("cable_tail",)
    follows_gait = False
    judged_settings = ("robot", "furthest", "gait", "cycles")
    judged_minima: ClassVar[Mapping[str, float]] = {"steps": 91}
    answer_minima: ClassVar[Mapping[str, float]] = {"cycles": 2}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot whose tail is examined."""
    furthest: float = pi
    """The greatest bend [rad]; less if the gaps between the plates close before."""
    steps: int = 181
    """Number of bends from zero to the greatest [-]."""

    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The crawl in which the angles of the joints are compared."""
    straight: Gait = field(default_factory=lambda: GAITS["tail_drag"])
    """The same crawl with a straight trunk, for comparison."""
    cycles: int = int(CYCLES)
    """Cycles of the crawls [-]."""

    def quick(self) -> "TailBending":
        """Return it with few bends and one cycle."""
        return replace(self, steps=19, cycles=1)

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Bend the tail by formulas, and let it swing in the crawls."""
        plates = self.robot.tail
        if not self.furthest > 0 or self.steps < 2 or self.cycles < 1:
            raise OutsideLimits(
                f"tail_bending.furthest is {self.furthest:.4g} rad in {self.steps} steps, cycles is {self.cycles}; a "
                "positive angle in at least 2 steps and one cycle at least are allowed."
            )
        furthest = min(self.furthest, tail.bend_limit(plates))
        progress("bending the tail", 0.0)
        bend = np.linspace(0.0, furthest, self.steps)
        parts = [_cords(plates, bend, self.linear), _shapes(plates, furthest), _errors(plates, furthest)]
        record = xr.merge([*parts, self._crawls(staged(progress, "crawling", 0.1, 1.0))])
        facts = {"plate": plates.plate, "gap": plates.gap, "cord_spacing": plates.cord_spacing} | _facts(self.robot)
        return SimulationResult(record=record.assign_attrs(facts | {"plausible_error": self._plausible(furthest)}))

    @property
    def linear(self) -> bool:
        """Whether a linear actuator moves the cords of the tail, and no servo by a pulley."""
        return any(cable.linear is not None and cable.hinges == self.robot.tail.driven for cable in self.robot.cables)

    def _crawls(self, progress: Any) -> xr.Dataset:
        """Return the angles of the cable joints over time in both crawls, not a number if the legs cannot follow."""
        runs = [Run(robot=self.robot, gait=gait) for gait in (self.gait, self.straight)]
        end = START + self.cycles * self.gait.period
        joints, passive = list(cable_joints(self.robot)), list(self.robot.tail.passive[::2])  # of pairs, yaw first
        try:
            record = time_window(require_complete(simulate(runs, duration=end, progress=progress)))
        except OutsideLimits:  # the formulas hold for robots with any legs
            time, angles = np.array([START, end]), np.full((len(runs), 2, len(joints)), np.nan)
            bend = np.full((len(runs), 2), np.nan)
        else:
            time = record.time.values
            angles = record.joint_angle.sel(joint=joints).transpose("run", "time", "joint").values
            bend = record.joint_angle.sel(joint=passive).sum("joint").transpose("run", "time").values
        angle_attrs = {"units": "rad", "long_name": "angle of a tail joint, tip right positive"}
        bend_attrs = {"units": "rad", "long_name": "bend of the tail's passive end, tip right positive"}
        return xr.Dataset(
            {
                "crawl_angle": (("crawl", "time", "joint"), angles, angle_attrs),
                "end_bend": (("crawl", "time"), bend, bend_attrs),
            },
            coords={"crawl": ["gait", "straight"], "time": ("time", time, {"units": "s"}), "joint": joints},
        )

    def _plausible(self, furthest: float) -> float:
        """Return the worst error of (17) at the ends of the plausible ranges of gap and cord spacing [-]."""
        ranges = {c.field: (c.low, c.high) for c in ROBOTS.beside("caiman", "chosen", ())}
        cases = product(ranges["tail.gap"], ranges["tail.cord_spacing"])
        plates = self.robot.tail
        designs = (plates._replace(gap=gap, pitch=plates.plate + gap, cord_spacing=spacing) for gap, spacing in cases)
        max_errors = [
            _errors(plates_varied, min(furthest, tail.bend_limit(plates_varied))).error_at_end.max()
            for plates_varied in designs
        ]
        return float(max(max_errors))

    def measure(self, record: xr.Dataset) -> Measures:
        """Return errors of the formulas, what the cords do, counts, and how equally the joints turn."""
        facts = record.attrs
        bent_record = record.isel(bend=slice(1, None))
        opposed = (bent_record.toward < 0) & (bent_record.away > 0)
        measures = Measures(
            {
                "error_of_eq_17_max": Measure(float(np.nanmax(np.abs([record.error_toward, record.error_away]))), "-"),
                "error_of_eq_17_plausible": Measure(facts["plausible_error"], "-"),
                "cable_section_length": Measure(facts["section"], "m"),
                "cords_opposed_share": Measure(float(opposed.mean()), "-"),
                "cord_pulled_max": Measure(float(-record.toward.min()), "m"),
                "slack_max": Measure(float(record.slack.max()), "m"),
                "bend_deficit_max": Measure(float(record.deficit.max()), "rad"),
                "printed_last_joint_error_straight": Measure(float(record.printed_miss[0]), "m"),
                "printed_last_joint_error_max": Measure(float(record.printed_miss.max()), "m"),
                "printed_last_joint_error_share": Measure(float(record.printed_miss.max()) / facts["section"], "-"),
                "bend_limit_of_gaps": Measure(facts["bend_limit_of_gaps"], "rad"),
                "servo_at_bend_limit": Measure(facts["servo_at_bend_limit"], "rad"),
            },
            {name: Measure(float(facts[name]), "-") for name in ("tail_joints", "tail_actuators", "tail_share")},
            {"end_bend": Measure(float(np.ptp(record.end_bend.sel(crawl="gait").values)), "rad")},
        )
        for degrees in record.at.values:
            at_bend = record.sel(at=degrees)
            measures |= {
                f"cord_toward_{degrees}": Measure(float(at_bend.cord_toward), "m"),
                f"cord_away_{degrees}": Measure(float(at_bend.cord_away), "m"),
                f"slack_{degrees}": Measure(float(-at_bend.cord_toward - at_bend.cord_away), "m"),
                f"error_of_eq_17_toward_{degrees}": Measure(float(at_bend.error_17_toward), "-"),
                f"error_of_eq_17_away_{degrees}": Measure(float(at_bend.error_17_away), "-"),
            }
        return measures | _spreads(record)

    def explain(self, measures: Mapping[str, float]) -> str:
        """Say how large the dropped term is, what it does to the cords, and how alike the joints turn."""
        return self.render_explanation(measures, alike=EQUAL_ANGLE_TOLERANCE)

    def draw(self, outcome: Outcome) -> dict[str, Any]:
        """Return the bent tails, the error of (17) and what the cords do."""
        return {
            "positions": pictures.tail_positions(outcome.record),
            "error_of_eq_17": pictures.tail_cord_error(outcome.record),
            "cords_and_servo": pictures.tail_cords(outcome.record),
            "joints_in_the_crawl": pictures.tail_joints(outcome.record, EQUAL_ANGLE_TOLERANCE),
        }


def _cords(plates: TailMeasures, bend: np.ndarray, linear: bool) -> xr.Dataset:
    """Return cords, drive and errors of the formulas over the bend; the straight tail has no relative error of (17).

    Args:
        plates: measures of the tail.
        bend: bend angle of the whole tail [rad].
        linear: whether a linear actuator moves the cords.
    """
    toward_change, away_change = tail.cable_changes(plates, bend)
    shortened_toward, shortened_away = (plates.joints * c for c in printed.cable_changes_shortened(plates, bend))
    last_joint_error = (tail.joint_positions(plates, bend) - printed.joint_positions(plates, bend))[:, -1]
    with np.errstate(invalid="ignore"):
        errors = [
            (shortened - exact) / np.abs(exact)
            for shortened, exact in ((shortened_toward, toward_change), (shortened_away, away_change))
        ]
    length_attrs, ratio_attrs = {"units": "m"}, {"units": "-"}
    return xr.Dataset(
        {
            "toward": ("bend", toward_change, length_attrs | {"long_name": "cord towards the bend, exact"}),
            "away": ("bend", away_change, length_attrs | {"long_name": "cord away from the bend, exact"}),
            "shortened": ("bend", shortened_away, length_attrs | {"long_name": "both cords by (17), without sign"}),
            "slack": ("bend", tail.slack(plates, bend), length_attrs | {"long_name": "slack"}),
            "error_toward": (
                "bend",
                -errors[0],
                ratio_attrs | {"long_name": "length pulled by (17), less the exact one"},
            ),
            "error_away": ("bend", errors[1], ratio_attrs | {"long_name": "length given by (17), less the exact one"}),
            "neglected": (
                "bend",
                plates.gap / plates.cord_spacing * np.tan(bend / (4 * plates.joints)),
                ratio_attrs | {"long_name": "h/d tan(theta / 4N)"},
            ),
            "deficit": (
                "bend",
                bend - _bend_of_cord(plates, shortened_away),
                {"units": "rad", "long_name": "bend missing"},
            ),
            "servo": (
                (
                    "bend",
                    plates.pulley * tail.servo_angle(plates, bend),
                    length_attrs | {"long_name": "actuator's travel"},
                )
                if linear
                else ("bend", tail.servo_angle(plates, bend), {"units": "rad", "long_name": "pulley angle"})
            ),
            "printed_miss": (
                "bend",
                np.linalg.norm(last_joint_error, axis=-1),
                length_attrs | {"long_name": "last joint by (19), its miss"},
            ),
        },
        coords={"bend": ("bend", bend, {"units": "rad", "long_name": "bend of the tail"})},
    )


def _bend_of_cord(plates: TailMeasures, cord_change: np.ndarray) -> np.ndarray:
    """Return the bend at which the cord towards it is shorter by ``cord_change`` [rad]: (16), solved for theta.

    Args:
        plates: measures of the tail.
        cord_change: length by which the cord is shorter [m].
    """
    diagonal = np.hypot(plates.cord_spacing, plates.gap)
    tilt = np.arctan2(plates.gap, plates.cord_spacing)
    half = tilt + np.arcsin((cord_change / plates.joints - plates.gap) / diagonal)
    return np.asarray(2 * plates.joints * half)


def _shapes(plates: TailMeasures, furthest: float) -> xr.Dataset:
    """Return positions of joints and end of the tail at the bends of ``SHAPES``, exact and as printed [m]."""
    bend = np.array([b for b in SHAPES if b <= furthest + 1e-9])
    length_attrs = {"units": "m"}
    return xr.Dataset(
        {
            "joints_ours": (("shape", "pivot", "axis"), tail.joint_positions(plates, bend), length_attrs),
            "joints_printed": (("shape", "pivot", "axis"), printed.joint_positions(plates, bend), length_attrs),
            "end": (("shape", "axis"), tail.end_position(plates, bend), length_attrs),
        },
        coords={
            "shape": ("shape", bend, {"units": "rad", "long_name": "bend of the tail"}),
            "pivot": np.arange(1, plates.joints + 1),
            "axis": ["back", "right"],
        },
    )


def _errors(plates: TailMeasures, furthest: float) -> xr.Dataset:
    """Return changes of the cords [m] and errors of (17) [-] at a few bends, and the errors at the greatest bend.

    Args:
        plates: measures of the tail.
        furthest: greatest bend [rad].
    """
    degrees = [d for d in (30, 90, 180) if np.radians(d) <= furthest + 1e-9]
    bend = np.append(np.radians(degrees), furthest)
    toward_change, away_change = tail.cable_changes(plates, bend)
    shortened = plates.joints * printed.cable_changes_shortened(plates, bend)[1]
    errors = np.stack([shortened / -toward_change - 1, shortened / away_change - 1])
    error_attrs = {"units": "-", "long_name": "relative error of (17)"}
    return xr.Dataset(
        {
            "cord_toward": ("at", toward_change[:-1], {"units": "m"}),
            "cord_away": ("at", away_change[:-1], {"units": "m"}),
            "error_17_toward": ("at", errors[0, :-1], error_attrs),
            "error_17_away": ("at", errors[1, :-1], error_attrs),
            "error_at_end": ("cord", np.abs(errors[:, -1]), error_attrs),
        },
        coords={"at": ("at", degrees, {"units": "deg", "long_name": "bend of the tail"}), "cord": ["toward", "away"]},
    )


def _facts(robot: Robot) -> dict[str, float]:
    """Return lengths [m], limits [rad] and counts of a tail."""
    plates = robot.tail
    return {
        "section": plates.joints * (plates.plate + plates.gap),
        "bend_limit_of_gaps": tail.bend_limit(plates),
        "servo_at_bend_limit": float(tail.servo_angle(plates, plates.bend_limit)),
        "tail_joints": len(cable_joints(robot)),
        "tail_actuators": sum(name.startswith("tail") for name in servo_names()),
        "tail_share": plates.length / robot.length,
    }


def _spreads(record: xr.Dataset) -> Measures:
    """Return the largest spread of the tail joints in each crawl [rad], and how often it is above its tolerance [-]."""
    spread = tail_joint_spread(record.crawl_angle, [str(name) for name in record.joint.values])
    measures = Measures()
    for crawl, end in (("gait", ""), ("straight", "_straight")):
        of_crawl = spread.sel(crawl=crawl)
        measures[f"tail_joint_spread{end}"] = Measure(float(of_crawl.max()), "rad")
        measures[f"tail_joint_spread_share{end}"] = Measure(
            float((of_crawl > EQUAL_ANGLE_TOLERANCE).where(of_crawl.notnull()).mean()), "-"
        )
    return measures


experiment = TailBending()
