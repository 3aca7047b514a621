"""Do the article's formulas for the cable-driven tail hold?"""

from dataclasses import dataclass, field, replace
from math import pi
from typing import Any

import numpy as np
import xarray as xr

from suchus.design import Crocodile, Tail, cable_joints, servo_names
from suchus.errors import OutsideLimits
from suchus.experiment import Experiment, Measure, Outcome, Progress, Verdict, judge, silent, stopwatch
from suchus.figures import tail as pictures
from suchus.kinematics import printed, tail
from suchus.robots import ROBOTS

SMALL = 0.05
"""A neglected term below this share of what is kept counts as small [-]."""
TAUT = 1e-4
"""Slack below this, a tenth of a millimetre, would not show on a real cord [m]."""
SHAPES = (0.0, pi / 2, pi)
"""Bends at which the tail is drawn [rad]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class TailBending(Experiment):
    """Follow cords, servo and joints of the tail from straight to a half turn, exactly and as printed."""

    title = "How good are the tail's formulas, from straight to bent by a half turn?"
    shows = "Section III.C: eqs (16) to (19)"
    claims = (
        "tail_quadratic_small",
        "tail_cords_inextensible",
        "tail_joint_positions",
        "tail_joints",
        "tail_actuators",
        "tail_share",
    )
    decides = (
        "The ratio of gap to cord spacing decides: the term that (17) drops is h/d tan(theta / 4N) of the one it "
        "keeps. It is small, yet it never vanishes: one cord always hangs loose by it and needs a spring. The "
        "positions of (19) fail already for a straight tail: the second line repeats the cosine of the first."
    )

    robot: Crocodile = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot whose tail is examined."""
    furthest: float = pi
    """The greatest bend [rad]; less if the gaps between the plates close before."""
    steps: int = 181
    """Number of bends from zero to the greatest [-]."""

    def quick(self) -> "TailBending":
        """Return it with few bends."""
        return replace(self, steps=19)

    def run(self, progress: Progress = silent) -> Outcome:
        """Bend the tail."""
        with stopwatch() as seconds:
            plates = self.robot.tail
            if not self.furthest > 0 or self.steps < 2:
                raise OutsideLimits(
                    f"tail_bending.furthest is {self.furthest:.4g} rad in {self.steps} steps; a positive angle in at "
                    "least 2 steps is allowed."
                )
            furthest = min(self.furthest, tail.bend_limit(plates))
            progress("bending the tail", 0.0)
            bend = np.linspace(0.0, furthest, self.steps)
            record = xr.merge([_cords(plates, bend), _shapes(plates, furthest)])
            record = record.assign_attrs(plate=plates.plate, gap=plates.gap, cord_spacing=plates.cord_spacing)
            measures = _measures(self.robot, record, furthest)
        return Outcome(
            experiment=self.name(),
            measures=measures,
            verdicts=_verdicts(measures),
            record=record,
            settings=self.settings(),
            seconds=seconds(),
        )

    def draw(self, outcome: Outcome) -> dict[str, Any]:
        """Return the bent tails, the error of (17) and what the cords do."""
        return {
            "positions": pictures.tail_positions(outcome.record),
            "error_of_eq_17": pictures.tail_cord_error(outcome.record),
            "cords_and_servo": pictures.tail_cords(outcome.record),
        }


def _cords(plates: Tail, bend: np.ndarray) -> xr.Dataset:
    """Return cords, their errors and the servo over the bend; the straight tail has no relative error."""
    toward, away = tail.cable_changes(plates, bend)
    kept_toward, kept_away = (plates.joints * c for c in printed.cable_changes_shortened(plates, bend))
    with np.errstate(invalid="ignore"):
        errors = [(kept - exact) / np.abs(exact) for kept, exact in ((kept_toward, toward), (kept_away, away))]
    long, part = {"units": "m"}, {"units": "-"}
    return xr.Dataset(
        {
            "toward": ("bend", toward, long | {"long_name": "cord towards the bend, exact"}),
            "away": ("bend", away, long | {"long_name": "cord away from the bend, exact"}),
            "shortened": ("bend", kept_away, long | {"long_name": "both cords by (17), without sign"}),
            "slack": ("bend", tail.slack(plates, bend), long | {"long_name": "slack"}),
            "error_toward": ("bend", -errors[0], part | {"long_name": "length pulled by (17), less the exact one"}),
            "error_away": ("bend", errors[1], part | {"long_name": "length given by (17), less the exact one"}),
            "neglected": (
                "bend",
                plates.gap / plates.cord_spacing * np.tan(bend / (4 * plates.joints)),
                part | {"long_name": "h/d tan(theta / 4N)"},
            ),
            "deficit": ("bend", bend - _reached(plates, kept_away), {"units": "rad", "long_name": "bend missing"}),
            "servo": ("bend", tail.servo_angle(plates, bend), {"units": "rad", "long_name": "wheel angle"}),
        },
        coords={"bend": ("bend", bend, {"units": "rad", "long_name": "bend of the tail"})},
    )


def _reached(plates: Tail, pulled: np.ndarray) -> np.ndarray:
    """Return the bend at which the cord towards it is shorter by ``pulled`` [rad]: (16), solved for theta."""
    far = np.hypot(plates.cord_spacing, plates.gap)
    tilt = np.arctan2(plates.gap, plates.cord_spacing)
    half = tilt + np.arcsin((pulled / plates.joints - plates.gap) / far)
    return np.asarray(2 * plates.joints * half)


def _shapes(plates: Tail, furthest: float) -> xr.Dataset:
    bend = np.array([b for b in SHAPES if b <= furthest + 1e-9])
    place = {"units": "m"}
    return xr.Dataset(
        {
            "joints_ours": (("shape", "joint", "axis"), tail.joint_positions(plates, bend), place),
            "joints_printed": (("shape", "joint", "axis"), printed.joint_positions(plates, bend), place),
            "end": (("shape", "axis"), tail.end_position(plates, bend), place),
        },
        coords={
            "shape": ("shape", bend, {"units": "rad", "long_name": "bend of the tail"}),
            "joint": np.arange(1, plates.joints + 1),
            "axis": ["back", "right"],
        },
    )


def _measures(robot: Crocodile, record: xr.Dataset, furthest: float) -> dict[str, Measure]:
    plates = robot.tail
    miss = np.linalg.norm(record.joints_ours - record.joints_printed, axis=-1)[:, -1]
    found = {
        "error_of_eq_17_max": Measure(float(np.nanmax(np.abs([record.error_toward, record.error_away]))), "-"),
        "cable_section_length": Measure(plates.joints * (plates.plate + plates.gap), "m"),
        "cord_pulled_max": Measure(float(-record.toward.min()), "m"),
        "slack_max": Measure(float(record.slack.max()), "m"),
        "bend_deficit_max": Measure(float(record.deficit.max()), "rad"),
        "printed_last_joint_error_straight": Measure(float(miss[0]), "m"),
        "printed_last_joint_error_max": Measure(float(miss.max()), "m"),
        "bend_limit_of_gaps": Measure(tail.bend_limit(plates), "rad"),
        "servo_at_bend_limit": Measure(float(tail.servo_angle(plates, plates.bend_limit)), "rad"),
        "tail_joints": Measure(float(len(cable_joints(robot))), "-"),
        "tail_actuators": Measure(float(sum(s.startswith("tail") for s in servo_names())), "-"),
        "tail_share": Measure(plates.length / robot.length, "-"),
    }
    for degrees in (d for d in (30, 90, 180) if np.radians(d) <= furthest + 1e-9):
        bend = np.radians(degrees)
        toward, away = tail.cable_changes(plates, bend)
        kept = plates.joints * printed.cable_changes_shortened(plates, bend)[1]
        found |= {
            f"cord_toward_{degrees}": Measure(float(toward), "m"),
            f"cord_away_{degrees}": Measure(float(away), "m"),
            f"slack_{degrees}": Measure(float(-toward - away), "m"),
            f"error_of_eq_17_toward_{degrees}": Measure(float(kept / -toward - 1), "-"),
            f"error_of_eq_17_away_{degrees}": Measure(float(kept / away - 1), "-"),
        }
    return found


def _verdicts(measures: dict[str, Measure]) -> tuple[Verdict, ...]:
    value = {name: measure.value for name, measure in measures.items()}
    worst, slack = value["error_of_eq_17_max"], value["slack_max"]
    return (
        judge(
            "tail_quadratic_small",
            worst,
            f"Up to the greatest bend (17) is off by at most {worst:.1%}; below {SMALL:.0%} counts as small.",
            holds=worst < SMALL,
        ),
        judge(
            "tail_cords_inextensible",
            slack / value["cord_pulled_max"],
            f"The two exact changes do not cancel: up to {1000 * slack:.1f} mm of cord hang loose, the measured share "
            "of what is pulled in. One cord needs a spring.",
            holds=slack < TAUT,
        ),
        judge(
            "tail_joint_positions",
            value["printed_last_joint_error_max"] / value["cable_section_length"],
            "(19) has two cosines and the wrong index: for a straight tail its last joint is "
            f"{1000 * value['printed_last_joint_error_straight']:.0f} mm off, and its joints are "
            "unevenly spaced; measured is the worst error over the length of the section.",
            holds=value["printed_last_joint_error_max"] < 1e-9,
        ),
        judge("tail_joints", value["tail_joints"], "The robot is built so: six hinges, one input."),
        judge("tail_actuators", value["tail_actuators"], "The robot is built so: a pitch servo and a cable servo."),
        judge(
            "tail_share", value["tail_share"], "The article gives no length of the tail; ours was chosen to fit this."
        ),
    )


experiment = TailBending()
