"""Does the article's leg kinematics hold?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.article.paper import LEG_CHAIN
from suchus.article.paper.tables import Chain
from suchus.core.checks import Checks
from suchus.experiments.catalog._frames import draw_frames, frames_of
from suchus.experiments.catalog.leg_kinematics import figure as pictures
from suchus.experiments.experiment import Experiment, Measure, Measures, Outcome, Progress, SimulationResult, silent
from suchus.robot.design import LEGS, Robot, leg_joints, servo_names
from suchus.robot.design.measures import LegMeasures
from suchus.robot.gaits import GAITS
from suchus.robot.kinematics import leg, printed
from suchus.robot.motion import Gait, movement
from suchus.robot.robots import ROBOTS

_FRAME_ANGLES = (0.35, 0.3, 0.8, 0.0)
"""Angles at which the frames are drawn [rad]."""

EXACT_TOLERANCE = 1e-9
"""Foot error up to which a solution counts as exact [m]."""
BRANCHES = tuple((knee, side) for knee in (1, -1) for side in (1, -1))
_AXES = ("outward", "ahead", "down")
ERROR_EDGES = np.logspace(-19, 0, 77)
"""Edges of the histogram of foot errors [m]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LegKinematics(Experiment):
    """Compare the printed leg kinematics with the full solution over the whole workspace."""

    title = "Does the printed leg kinematics find the joint angles for every point in reach?"
    shows = "Section III.A: Table I, eqs (1) to (14)"
    answers = (
        "round_trip_error",
        "printed_inverse_holds",
        "printed_foot_error_median",
        "printed_foot_error_max",
        "reach_far",
    )
    needs = ("legs",)
    follows_gait = False
    judged_settings = ("robot", "gait", "other_gait")
    judged_minima: ClassVar[Mapping[str, float]] = {"points": 10_000, "phases": 100}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot; its hind leg is examined."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """The gait whose foot positions (14) has to solve: the article's crawl with sprawled legs."""
    other_gait: Gait = field(default_factory=lambda: GAITS["high_walk"])
    """A gait with erect legs, for comparison."""
    points: int = 100_000
    """Number of random foot points, spread evenly over the reachable shell [-]."""
    phases: int = 400
    """Number of phases of a cycle at which the feet of the gaits are evaluated [-]."""
    grid: int = 201
    """Points along each side of the maps [-]."""
    seed: int = 0
    """Seed of the random points [-]."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("points", 1, 10_000_000)
            check.whole("phases", 1, 100_000)
            check.whole("grid", 2, 2000)
            check.whole("seed", 0, 2**31)

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Solve the inverse for random points on all branches and as printed, then for the feet of the gaits."""
        hind = self.robot.hind_leg
        progress("random foot points", 0.0)
        points = _points(hind, _shell(hind, self.points, self.seed))
        progress("maps of the workspace", 0.5)
        record = xr.merge([points, _histogram(points), _section(hind, self.grid), _top(hind, self.grid)])
        record = xr.merge([record, _knee_curve(hind), _sweep(hind), _postures(hind), self._steps(), _frames(hind)])
        counts = {"leg_servos": len(leg_joints()) / len(LEGS), "actuators": len(servo_names())}
        reach = {"near": hind.reach[0], "far": hind.reach[1], "hip_offset": hind.hip_offset, "floor": hind.tibia}
        return SimulationResult(record=record.assign_attrs(counts | reach))

    def _steps(self) -> xr.Dataset:
        """Return the foot error of (14) along the gaits, each leg with its own lengths [m]."""
        errors = []
        for gait in (self.gait, self.other_gait):
            phase = np.arange(self.phases)[:, None] / self.phases + np.array(gait.limb_phases)
            foot_positions = movement(self.robot, gait).foot_positions(phase)
            legs = [self.robot.front_leg if name in ("LF", "RF") else self.robot.hind_leg for name in LEGS]
            errors.append([_printed_error(limb, foot_positions[:, i]) for i, limb in enumerate(legs)])
        metre = {"units": "m", "long_name": "foot error of (14) along the gait"}
        return xr.Dataset(
            {"step_error": (("of_gait", "leg", "sample"), np.array(errors), metre)},
            coords={"of_gait": ["gait", "other_gait"], "leg": list(LEGS)},
        )

    def measure(self, record: xr.Dataset) -> Measures:
        """Return the fractions of the workspace and of the gaits at which (14) is exact, and its errors elsewhere."""
        foot_error = record.error_printed
        is_wrong = foot_error > EXACT_TOLERANCE
        quarter = (record.foot.sel(axis="outward") > record.attrs["hip_offset"]) & (record.foot.sel(axis="down") > 0)
        return Measures(
            {
                "round_trip_error": Measure(float(record.error_ours.max()), "m"),
                "printed_inverse_holds": Measure(float((~is_wrong).mean()), "-"),
                "printed_inverse_fails": Measure(float(is_wrong.mean()), "-"),
                "printed_inverse_holds_outboard_below": Measure(_fraction(~is_wrong, quarter), "-"),
                "printed_inverse_holds_elsewhere": Measure(_fraction(~is_wrong, ~quarter), "-"),
                "printed_inverse_holds_crawl": Measure(_exact(record, "gait"), "-"),
                "printed_inverse_holds_high_walk": Measure(_exact(record, "other_gait"), "-"),
                "printed_foot_error_median": Measure(float(foot_error.where(is_wrong).median()), "m"),
                "printed_foot_error_max": Measure(float(foot_error.max()), "m"),
                "knee_error_of_eq_10_median": Measure(float(record.error_knee.median()), "rad"),
                "knee_undefined_by_eq_10": Measure(float(record.error_knee.isnull().mean()), "-"),
                "table_1_by_label_error_median": Measure(float(record.error_label.median()), "m"),
                "reach_near": Measure(record.attrs["near"], "m"),
                "reach_far": Measure(record.attrs["far"], "m"),
                "shell_within_joint_limits": Measure(float(record.within_limits.mean()), "-"),
                "leg_servos": Measure(float(record.attrs["leg_servos"]), "-"),
                "actuators": Measure(float(record.attrs["actuators"]), "-"),
            }
        )

    def draw(self, outcome: Outcome) -> dict[str, Any]:
        """Return the maps of error and workspace, and the misprints."""
        return {
            "inverse_as_printed": pictures.leg_inverse(outcome.record),
            "workspace": pictures.leg_workspace(outcome.record),
            "misprints": pictures.leg_misprints(outcome.record),
            "frames": draw_frames(
                outcome.record,
                ("midline", "hip", "", "knee", "foot"),
                "The frames of the left hind leg, as Fig. 6 and Table I need them for (8) to (14): X_0 outward, Y_0 "
                "forward, Z_0 down. Frames 1 and 2, yaw and pitch of the hip, have one origin.",
            ),
        }

    def quick(self) -> "LegKinematics":
        """Return it with few phases and a coarse map; shares of points need all points."""
        return replace(self, phases=50, grid=41)


def _frames(hind: LegMeasures) -> xr.Dataset:
    """Return the frames of Table I for a leg that is slightly bent at every joint."""
    chain = Chain(a=(hind.hip_offset, 0.0, hind.femur, hind.tibia), alpha=LEG_CHAIN.alpha, d=LEG_CHAIN.d)
    return frames_of(chain, _FRAME_ANGLES, np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]))


def _shell(hind: LegMeasures, count: int, seed: int) -> np.ndarray:
    """Return points spread evenly over the reach of the foot, without joint limits, shape (count, 3) [m].

    Args:
        hind: lengths of the leg.
        count: number of points [-].
        seed: seed of the random generator [-].
    """
    rng = np.random.default_rng(seed)
    direction = rng.normal(size=(count, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    min_reach, max_reach = hind.reach
    return np.array([hind.hip_offset, 0, 0]) + direction * np.cbrt(rng.uniform(min_reach**3, max_reach**3, (count, 1)))


def _branch_errors(hind: LegMeasures, foot: np.ndarray, *, knee: int, side: int) -> np.ndarray:
    """Return the foot error of the full inverse on one branch [m]."""
    angles = leg.inverse(hind, foot, knee=knee, side=side)
    return np.asarray(np.linalg.norm(leg.forward(hind, angles) - foot, axis=-1))


def _printed_error(limb: LegMeasures, foot: np.ndarray) -> np.ndarray:
    """Return the foot error of (14) at each point [m]; infinite where (14) has no value."""
    errors = np.linalg.norm(leg.forward(limb, printed.leg_inverse(limb, foot)) - foot, axis=-1)
    return np.asarray(np.where(np.isfinite(errors), errors, np.inf))


def _points(hind: LegMeasures, foot: np.ndarray) -> xr.Dataset:
    """Return the errors of every solution at random points: the full one on its worst branch, and the printed ones.

    Args:
        hind: lengths of the leg.
        foot: random points, shape (point, 3) [m].
    """
    branch_errors = [_branch_errors(hind, foot, knee=k, side=s) for k, s in BRANCHES]
    knee_errors = np.abs(printed.knee_by_wrong_side(hind, foot) - leg.inverse(hind, foot)[:, 2])
    angles = np.random.default_rng(1).uniform(-1, 1, (len(foot), 4))
    label_errors = np.linalg.norm(printed.leg_table_by_label(angles) - leg.forward(hind, angles[:, :3]), axis=-1)
    is_within_limits = _within_limits(hind, foot).any(axis=0)
    metre = {"units": "m"}
    return xr.Dataset(
        {
            "foot": (("point_of_shell", "axis"), foot, metre | {"long_name": "random point in reach"}),
            "error_ours": (
                "point_of_shell",
                np.max(branch_errors, axis=0),
                metre | {"long_name": "worst of our branches"},
            ),
            "error_first": ("point_of_shell", branch_errors[0], metre | {"long_name": "our first branch"}),
            "error_printed": (
                "point_of_shell",
                _printed_error(hind, foot),
                metre | {"long_name": "foot error of (14)"},
            ),
            "error_knee": ("point_of_shell", knee_errors, {"units": "rad", "long_name": "error of the knee by (10)"}),
            "error_label": ("point_of_shell", label_errors, metre | {"long_name": "error of Table I by its labels"}),
            "within_limits": (
                "point_of_shell",
                is_within_limits,
                {"units": "1", "long_name": "within the joints' limits"},
            ),
        },
        coords={"axis": list(_AXES)},
    )


def _fraction(holds: xr.DataArray, selection: xr.DataArray) -> float:
    """Return the fraction of the selected points at which a condition holds [-]; zero if no point is selected."""
    return float((holds & selection).sum() / max(int(selection.sum()), 1))


def _exact(record: xr.Dataset, gait: str) -> float:
    """Return the fraction of the foot positions of a gait at which (14) is exact [-]."""
    return float((record.step_error.sel(of_gait=gait) <= EXACT_TOLERANCE).mean())


def _within_limits(hind: LegMeasures, foot: np.ndarray) -> np.ndarray:
    """Return for each branch which points lie within the joint limits, shape (branch, *batch); False out of reach.

    Args:
        hind: lengths and joint limits of the leg.
        foot: foot positions, shape (*batch, 3) [m].
    """
    is_allowed = np.zeros((len(BRANCHES), *foot.shape[:-1]), dtype=bool)
    is_reachable = leg.reachable(hind, foot)
    lower_bound, upper_bound = np.array([hind.yaw_range, hind.pitch_range, hind.knee_range]).T
    for i, (knee, side) in enumerate(BRANCHES):
        angles = leg.inverse(hind, foot[is_reachable], knee=knee, side=side)
        is_allowed[i, is_reachable] = np.all((angles >= lower_bound) & (angles <= upper_bound), axis=-1)
    return is_allowed


def _dexterity(hind: LegMeasures, foot: np.ndarray) -> np.ndarray:
    """Return the greatest |det J| over the branches within the limits, scaled to 1 at its maximum; NaN elsewhere.

    Args:
        hind: lengths and joint limits of the leg.
        foot: foot positions, shape (*batch, 3) [m].
    """
    best = np.full(foot.shape[:-1], np.nan)
    for allowed, (knee, side) in zip(_within_limits(hind, foot), BRANCHES, strict=True):
        J = leg.jacobian(hind, leg.inverse(hind, foot[allowed], knee=knee, side=side))
        best[allowed] = np.fmax(best[allowed], np.abs(np.linalg.det(J)))
    return best / (hind.femur * hind.tibia * hind.reach[1])


def _histogram(points: xr.Dataset) -> xr.Dataset:
    """Return the histogram of the foot error of the first branch and of (14), as fractions of the points [-]."""
    edges = {"units": "m", "long_name": "error of the foot, lower edge of the class"}
    share = {"units": "-", "long_name": "share of the points in the class"}
    counts = [
        np.histogram(np.maximum(points[name].values, ERROR_EDGES[0]), ERROR_EDGES)[0] / points.sizes["point_of_shell"]
        for name in ("error_first", "error_printed")
    ]
    return xr.Dataset(
        {"share_ours": ("error", counts[0], share), "share_printed": ("error", counts[1], share)},
        coords={"error": ("error", ERROR_EDGES[:-1], edges)},
    )


def _axis(values: np.ndarray, dim: str, long_name: str) -> tuple[str, np.ndarray, dict[str, str]]:
    """Return a coordinate of a map [m], as xarray takes it."""
    return dim, values, {"units": "m", "long_name": long_name}


def _section(hind: LegMeasures, grid: int) -> xr.Dataset:
    """Return printed error [m] and dexterity [-] on the vertical plane through the hip, across the body.

    Args:
        hind: lengths and joint limits of the leg.
        grid: points along each side [-].
    """
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


def _top(hind: LegMeasures, grid: int) -> xr.Dataset:
    """Return the dexterity on the level plane on which the foot of a sprawled leg stands [-].

    Args:
        hind: lengths and joint limits of the leg.
        grid: points along each side [-].
    """
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


def _knee_curve(hind: LegMeasures) -> xr.Dataset:
    """Return the knee angle over the distance from hip to foot, solved and by the printed (10) [rad]."""
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


def _sweep(hind: LegMeasures) -> xr.Dataset:
    """Return the path of the foot while the second joint turns alone, solved and by the labels of Table I [m]."""
    turn = np.linspace(-np.pi / 3, np.pi / 2, 121)
    angles = np.zeros((121, 4))
    angles[:, 1] = turn
    attrs = {"units": "m", "long_name": "foot"}
    return xr.Dataset(
        {
            "path_ours": (("turn", "axis"), leg.forward(hind, angles[:, :3]), attrs),
            "path_by_label": (("turn", "axis"), printed.leg_table_by_label(angles), attrs),
        },
        coords={
            "turn": ("turn", turn, {"units": "rad", "long_name": "second joint"}),
            "axis": list(_AXES),
        },
    )


def _postures(hind: LegMeasures) -> xr.Dataset:
    """Return hip, knee and foot of the leg sprawled, semi-erect and erect [m]."""
    a0 = hind.hip_offset
    posture_angles = {"sprawled": (0, 0, 90), "semi-erect": (0, 35, 70), "erect": (0, 66, 42)}  # [deg]
    angles = np.radians(list(posture_angles.values()))
    hip = np.broadcast_to([a0, 0.0, 0.0], (len(posture_angles), 3))
    points = np.stack([hip, leg.knee_point(hind, angles), leg.forward(hind, angles)], axis=1)
    return xr.Dataset(
        {"posture_points": (("posture", "point", "axis"), points, {"units": "m", "long_name": "hip, knee, foot"})},
        coords={"posture": list(posture_angles), "point": ["hip", "knee", "foot"], "axis": list(_AXES)},
    )


experiment = LegKinematics()
