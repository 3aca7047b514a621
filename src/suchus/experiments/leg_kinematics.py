"""Does the article's leg kinematics hold?"""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import xarray as xr

from suchus.design import Crocodile, Leg, leg_joints, servo_names
from suchus.design.checks import Checks
from suchus.experiment import Experiment, Measure, Outcome, Progress, Verdict, judge, silent, stopwatch
from suchus.figures import kinematics as pictures
from suchus.kinematics import leg, printed
from suchus.robots import ROBOTS

EXACT = 1e-9
"""A foot nearer than this to where it should be counts as exact [m]."""
BRANCHES = tuple((knee, side) for knee in (1, -1) for side in (1, -1))
ERROR_EDGES = np.logspace(-19, 0, 77)
"""Edges of the histogram of foot errors [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LegKinematics(Experiment):
    """Compare the printed leg kinematics with the full solution over the whole workspace."""

    title = "Does the printed leg kinematics find the joint angles for every point in reach?"
    shows = "Section III.A: Table I, eqs (1) to (14)"
    claims = ("leg_inverse", "leg_servos", "actuator_count")
    decides = (
        "The quadrant decides. The printed arctan cannot tell a point from its opposite, so (14) holds for feet "
        "outboard of and below the hip and is half a turn off elsewhere. In the sprawled crawl the feet stay in that "
        "quarter."
    )

    robot: Crocodile = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot; its hind leg is examined."""
    points: int = 100_000
    """Number of random foot points, spread evenly over the reachable shell [-]."""
    grid: int = 201
    """Points along each side of the maps [-]."""
    seed: int = 0
    """Seed of the random points [-]."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("points", 1, 10_000_000)
            check.whole("grid", 2, 2000)
            check.whole("seed", 0, 2**31)

    def run(self, progress: Progress = silent) -> Outcome:
        """Solve the inverse for random points on all branches, and as printed."""
        with stopwatch() as seconds:
            hind = self.robot.hind_leg
            progress("random foot points", 0.0)
            foot = _shell(hind, self.points, self.seed)
            ours = max(_misses(hind, foot, knee=k, side=s).max() for k, s in BRANCHES)
            wrong = np.linalg.norm(leg.forward(hind, printed.leg_inverse(hind, foot)) - foot, axis=-1)
            progress("maps of the workspace", 0.5)
            record = xr.merge([_histogram(hind, foot, wrong), _section(hind, self.grid), _top(hind, self.grid)])
            record = xr.merge([record, _knee_curve(hind), _sweep(hind), _postures(hind)])
            measures = _measures(hind, foot, wrong, float(ours))
        return Outcome(
            experiment=self.name(),
            measures=measures,
            verdicts=_verdicts(measures),
            record=record.assign_attrs(
                near=hind.reach[0], far=hind.reach[1], hip_offset=hind.hip_offset, floor=hind.tibia
            ),
            settings=self.settings(),
            seconds=seconds(),
        )

    def draw(self, outcome: Outcome) -> dict[str, Any]:
        """Return the maps of error and workspace, and the misprints."""
        return {
            "inverse_as_printed": pictures.leg_inverse(outcome.record),
            "workspace": pictures.leg_workspace(outcome.record),
            "misprints": pictures.leg_misprints(outcome.record),
        }

    def quick(self) -> "LegKinematics":
        """Return it with few points."""
        return replace(self, points=2000, grid=41)


def _shell(hind: Leg, count: int, seed: int) -> np.ndarray:
    """Return points spread evenly over what the foot can reach, joint limits aside [m]."""
    rng = np.random.default_rng(seed)
    way = rng.normal(size=(count, 3))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    near, far = hind.reach
    return np.array([hind.hip_offset, 0, 0]) + way * np.cbrt(rng.uniform(near**3, far**3, (count, 1)))


def _misses(hind: Leg, foot: np.ndarray, *, knee: int, side: int) -> np.ndarray:
    angles = leg.inverse(hind, foot, knee=knee, side=side)
    return np.asarray(np.linalg.norm(leg.forward(hind, angles) - foot, axis=-1))


def _measures(hind: Leg, foot: np.ndarray, wrong: np.ndarray, ours: float) -> dict[str, Measure]:
    fails = wrong > EXACT
    knee = leg.inverse(hind, foot)[:, 2]
    by_ten = printed.knee_by_wrong_side(hind, foot)
    angles = np.random.default_rng(1).uniform(-1, 1, (len(foot), 4))
    label = np.linalg.norm(printed.leg_table_by_label(angles) - leg.forward(hind, angles[:, :3]), axis=-1)
    inside = _within_limits(hind, foot).any(axis=0)
    return {
        "round_trip_error": Measure(ours, "m"),
        "printed_inverse_holds": Measure(float(np.mean(~fails)), "-"),
        "printed_inverse_fails": Measure(float(np.mean(fails)), "-"),
        "printed_foot_error_median": Measure(float(np.median(wrong[fails])), "m"),
        "printed_foot_error_max": Measure(float(wrong.max()), "m"),
        "knee_error_of_eq_10_median": Measure(float(np.nanmedian(np.abs(by_ten - knee))), "rad"),
        "knee_undefined_by_eq_10": Measure(float(np.mean(np.isnan(by_ten))), "-"),
        "table_1_by_label_error_median": Measure(float(np.median(label)), "m"),
        "reach_near": Measure(hind.reach[0], "m"),
        "reach_far": Measure(hind.reach[1], "m"),
        "shell_within_joint_limits": Measure(float(np.mean(inside)), "-"),
        "leg_servos": Measure(float(len(leg_joints()) / 4), "-"),
        "actuators": Measure(float(len(servo_names())), "-"),
    }


def _verdicts(measures: dict[str, Measure]) -> tuple[Verdict, ...]:
    holds = measures["printed_inverse_holds"].value
    return (
        judge(
            "leg_inverse",
            holds,
            f"(14) brings the foot to its point in {holds:.0%} of the workspace: outboard of and below the hip. "
            "Elsewhere its arctan is half a turn off; atan2 and both knee signs mend it.",
            holds=holds == 1.0,
        ),
        judge("leg_servos", measures["leg_servos"].value, "The robot is built so: theta4 of Table I has no servo."),
        judge(
            "actuator_count",
            measures["actuators"].value,
            "The robot follows the counts of III.D; those of II.B and III.A add up to 14, 18 or 23.",
        ),
    )


def _within_limits(hind: Leg, foot: np.ndarray) -> np.ndarray:
    """Return for each branch which points the joints' limits allow, shape (branch, *batch); outside the reach none."""
    allowed = np.zeros((len(BRANCHES), *foot.shape[:-1]), dtype=bool)
    there = leg.reachable(hind, foot)
    low, high = np.array([hind.yaw_range, hind.pitch_range, hind.knee_range]).T
    for i, (knee, side) in enumerate(BRANCHES):
        angles = leg.inverse(hind, foot[there], knee=knee, side=side)
        allowed[i, there] = np.all((angles >= low) & (angles <= high), axis=-1)
    return allowed


def _dexterity(hind: Leg, foot: np.ndarray) -> np.ndarray:
    """Return the greatest |det J| over its branches within the limits, 1 at its greatest; NaN outside."""
    best = np.full(foot.shape[:-1], np.nan)
    for allowed, (knee, side) in zip(_within_limits(hind, foot), BRANCHES, strict=True):
        J = leg.jacobian(hind, leg.inverse(hind, foot[allowed], knee=knee, side=side))
        best[allowed] = np.fmax(best[allowed], np.abs(np.linalg.det(J)))
    return best / (hind.femur * hind.tibia * hind.reach[1])


def _histogram(hind: Leg, foot: np.ndarray, wrong: np.ndarray) -> xr.Dataset:
    ours = _misses(hind, foot, knee=1, side=1)
    edges = {"units": "m", "long_name": "error of the foot, lower edge of the class"}
    share = {"units": "-", "long_name": "share of the points in the class"}
    counts = [np.histogram(np.maximum(e, ERROR_EDGES[0]), ERROR_EDGES)[0] / len(e) for e in (ours, wrong)]
    return xr.Dataset(
        {"share_ours": ("error", counts[0], share), "share_printed": ("error", counts[1], share)},
        coords={"error": ("error", ERROR_EDGES[:-1], edges)},
    )


def _axis(values: np.ndarray, dim: str, what: str) -> tuple[str, np.ndarray, dict[str, str]]:
    return dim, values, {"units": "m", "long_name": what}


def _section(hind: Leg, grid: int) -> xr.Dataset:
    """Map the upright plane through the hip, across the body."""
    x = np.linspace(hind.hip_offset - 1.05 * hind.reach[1], hind.hip_offset + 1.05 * hind.reach[1], grid)
    z = np.linspace(-1.05 * hind.reach[1], 1.05 * hind.reach[1], grid)
    foot = np.stack(np.broadcast_arrays(x[None, :], 0.0, z[:, None]), axis=-1)
    error = np.linalg.norm(leg.forward(hind, printed.leg_inverse(hind, foot)) - foot, axis=-1)
    error[~leg.reachable(hind, foot)] = np.nan
    dims = ("down", "outward")
    return xr.Dataset(
        {
            "printed_error": (dims, error, {"units": "m", "long_name": "foot error of (14)"}),
            "dexterity_section": (dims, _dexterity(hind, foot), {"units": "-", "long_name": "|det J|, scaled"}),
        },
        coords={
            "outward": _axis(x, "outward", "outward from the midline"),
            "down": _axis(z, "down", "below the hip"),
        },
    )


def _top(hind: Leg, grid: int) -> xr.Dataset:
    """Map the level plane in which the foot of a sprawled leg stands."""
    x = np.linspace(hind.hip_offset - 1.05 * hind.reach[1], hind.hip_offset + 1.05 * hind.reach[1], grid)
    y = np.linspace(-1.05 * hind.reach[1], 1.05 * hind.reach[1], grid)
    foot = np.stack(np.broadcast_arrays(x[None, :], y[:, None], hind.tibia), axis=-1)
    return xr.Dataset(
        {
            "dexterity_top": (
                ("ahead", "outward"),
                _dexterity(hind, foot),
                {"units": "-", "long_name": "|det J|, scaled"},
            )
        },
        coords={"ahead": _axis(y, "ahead", "ahead of the hip"), "outward": _axis(x, "outward", "outward")},
    )


def _knee_curve(hind: Leg) -> xr.Dataset:
    distance = np.linspace(hind.reach[0], hind.reach[1], 400)
    foot = np.stack(np.broadcast_arrays(hind.hip_offset + distance, 0.0, 0.0), axis=-1)
    angle = {"units": "rad", "long_name": "knee angle"}
    return xr.Dataset(
        {
            "knee_ours": ("distance", leg.inverse(hind, foot)[:, 2], angle),
            "knee_printed": ("distance", printed.knee_by_wrong_side(hind, foot), angle),
        },
        coords={"distance": ("distance", distance, {"units": "m", "long_name": "from hip to foot"})},
    )


def _sweep(hind: Leg) -> xr.Dataset:
    """Turn the second joint with the rest still, and follow the foot."""
    turn = np.linspace(-np.pi / 3, np.pi / 2, 121)
    angles = np.zeros((121, 4))
    angles[:, 1] = turn
    place = {"units": "m", "long_name": "foot"}
    return xr.Dataset(
        {
            "path_ours": (("turn", "axis"), leg.forward(hind, angles[:, :3]), place),
            "path_by_label": (("turn", "axis"), printed.leg_table_by_label(angles), place),
        },
        coords={
            "turn": ("turn", turn, {"units": "rad", "long_name": "second joint"}),
            "axis": ["outward", "ahead", "down"],
        },
    )


def _postures(hind: Leg) -> xr.Dataset:
    """Draw the leg sprawled, half erect and erect."""
    a0 = hind.hip_offset
    named = {"sprawled": (0, 0, 90), "half erect": (0, 35, 70), "erect": (0, 66, 42)}  # [deg]
    angles = np.radians(list(named.values()))
    hip = np.broadcast_to([a0, 0.0, 0.0], (len(named), 3))
    points = np.stack([hip, leg.knee_point(hind, angles), leg.forward(hind, angles)], axis=1)
    return xr.Dataset(
        {"posture_points": (("posture", "point", "axis"), points, {"units": "m", "long_name": "hip, knee, foot"})},
        coords={"posture": list(named), "point": ["hip", "knee", "foot"], "axis": ["outward", "ahead", "down"]},
    )


experiment = LegKinematics()
