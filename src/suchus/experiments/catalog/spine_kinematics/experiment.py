"""Does the article's spine kinematics hold, and what can the spine do?"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import pi
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from suchus.core.checks import Checks
from suchus.experiments.catalog._frames import draw_frames, frames_of
from suchus.experiments.catalog.spine_kinematics import figure as pictures
from suchus.experiments.catalog.spine_kinematics.rules import EXACT
from suchus.experiments.experiment import (
    Experiment,
    Measure,
    Measures,
    Outcome,
    Progress,
    SimulationResult,
    estimated,
    silent,
)
from suchus.robot.design import Robot, spine_joints
from suchus.robot.design.measures import SpineMeasures
from suchus.robot.kinematics import printed, spine
from suchus.robot.robots import ROBOTS

_FRAME_ANGLES = (0.2, -0.15, 0.25, -0.15, 0.2)
"""Angles at which the frames are drawn [rad]."""

_METRE = {"units": "m"}
MILD = pi / 6
"""Greatest joint angle of the postures in which the misprint is measured; a crawl bends as much [rad]."""
_SEARCH_COUNT = 2000  # postures whose least bending is searched numerically, which is slow


@dataclass(frozen=True, slots=True, kw_only=True)
class SpineKinematics(Experiment):
    """Compare the printed spine kinematics with Table II, invert it, and map where the spine reaches."""

    title = "Is the printed end of the spine where Table II puts it, and can the spine be inverted?"
    shows = "Section III.B: Table II, eq. (15)"
    answers = (
        "straight_length",
        "straight_length_printed",
        "printed_error_mean",
        "mended_error_max",
        "bending_saved_median",
    )
    needs = ("shells", "article_spine")
    judged_settings = ("robot",)
    judged_minima: ClassVar[Mapping[str, float]] = {"postures": 10_000}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot whose spine is examined."""
    postures: int = 100_000
    """Number of random postures [-]."""
    grid: int = 90
    """Cells along the longer side of the maps [-]."""
    seed: int = 0
    """Seed of the random postures [-]."""

    def __post_init__(self) -> None:
        with Checks(self.name(), self) as check:
            check.whole("postures", 1, 10_000_000)
            check.whole("grid", 2, 2000)
            check.whole("seed", 0, 2**31)

    def quick(self) -> "SpineKinematics":
        """Return it with few postures."""
        return replace(self, postures=500, grid=24)

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Recover random postures by inverse kinematics, compare tip positions of (15) with exact ones.

        The workspace is mapped, too.
        """
        back = self.robot.spine
        angles = _random(back, self.postures, self.seed)
        progress("random postures", 0.0)
        inverted = _inverted(back, angles)
        progress("workspace and least bending", 0.5)
        parts = [inverted, _workspace(back, angles, self.grid), _errors(back, self.postures, self.seed), _turns(back)]
        record = xr.merge(
            [*parts, _family(self.robot), frames_of(spine.chain(back), _FRAME_ANGLES, np.eye(3))],
            combine_attrs="drop_conflicts",
        )
        return SimulationResult(record=record.assign_attrs(_facts(back)))

    def measure(self, record: xr.Dataset) -> Measures:
        """Return lengths and errors of (15), as printed and corrected, and the round-trip errors of the inverse."""
        length, error = record.attrs["straight_length"], record.error_printed
        return Measures(
            {
                "straight_length": Measure(length, "m"),
                "straight_length_printed": Measure(record.attrs["straight_length_printed"], "m"),
                "printed_error_share": Measure(float(error.max()) / length, "-"),
                "printed_error_mean": Measure(float(error.mean()), "m"),
                "printed_error_min": Measure(float(error.min()), "m"),
                "printed_error_max": Measure(float(error.max()), "m"),
                "printed_error_upward_max": Measure(float(record.error_upward.max()), "m"),
                "mended_error_max": Measure(float(record.error_mended.max()), "m"),
                "round_trip_error": Measure(float(record.error_inverse.max()), "m"),
                "round_trip_azimuth_error": Measure(float(record.error_azimuth.max()), "rad"),
                "original_angles_found": Measure(float((record.angle_missed < 1e-6).mean()), "-"),
            },
            estimated("bending_saved_median", record.bending_saved.values, "-"),
            {
                name: Measure(float(record.attrs[name]), "-")
                for name in ("straight_jacobian_rank", "spine_joints", "spine_lateral_joints", "spine_pitch_joints")
            },
        )

    def explain(self, measures: Mapping[str, float]) -> str:
        """Return the difference of (15) to Table II, its cause, and the freedom of the inverse, in words."""
        return self.render_explanation(measures, exact=EXACT)

    def draw(self, outcome: Outcome) -> dict[str, Any]:
        """Return the workspace, the misprint and the choice of the least bending."""
        return {
            "workspace": pictures.spine_workspace(outcome.record),
            "misprint": pictures.spine_misprint(outcome.record),
            "least_bending": pictures.spine_least_bending(outcome.record),
            "frames": draw_frames(
                outcome.record,
                ("pelvis", "yaw 1", "pitch 1", "yaw 2", "pitch 2", "yaw 3"),
                "The frames of the spine, as Fig. 8 and Table II need them: X_0 forward, Y_0 left, Z_0 up.",
                is_flat=True,
            ),
        }


def _random(back: SpineMeasures, count: int, seed: int) -> np.ndarray:
    """Return postures spread evenly over the joints' ranges [rad], shape (count, 5)."""
    lower_bound, upper_bound = np.array(
        [back.yaw_range, back.pitch_range, back.yaw_range, back.pitch_range, back.yaw_range]
    ).T
    return np.random.default_rng(seed).uniform(lower_bound, upper_bound, (count, 5))


def _azimuth(T: np.ndarray) -> np.ndarray:
    return np.asarray(np.arctan2(T[..., 1, 0], T[..., 0, 0]))


def _facts(back: SpineMeasures) -> dict[str, float]:
    """Return lengths of the straight spine [m], the rank of its Jacobian, and counts of its joints."""
    straight = np.zeros(5)
    return {
        "straight_length": float(spine.forward(back, straight)[0, 3]),
        "straight_length_printed": float(printed.spine_position(back, straight)[0]),
        "straight_jacobian_rank": int(np.linalg.matrix_rank(spine.jacobian(back, straight), tol=1e-9)),
        "spine_joints": len(spine_joints()),
        "spine_lateral_joints": sum("yaw" in joint for joint in spine_joints()),
        "spine_pitch_joints": sum("pitch" in joint for joint in spine_joints()),
    }


def _inverted(back: SpineMeasures, angles: np.ndarray) -> xr.Dataset:
    """Return position, azimuth and joint errors of the inverse in random postures, on the worse of its two branches.

    Args:
        back: measures of the spine.
        angles: angles of the postures, shape (sample, 5) [rad].
    """
    T = spine.forward(back, angles)
    target, azimuth = T[:, :3, 3], _azimuth(T)
    position, heading = np.zeros(len(angles)), np.zeros(len(angles))
    angle_error = np.full(len(angles), np.inf)
    for branch in (1, -1):
        solution = spine.inverse(back, target, azimuth, first_yaw=angles[:, 0], branch=branch)
        round_trip = spine.forward(back, solution)
        position = np.maximum(position, np.linalg.norm(round_trip[:, :3, 3] - target, axis=1))
        heading = np.maximum(heading, np.abs(np.angle(np.exp(1j * (_azimuth(round_trip) - azimuth)))))
        angle_error = np.minimum(angle_error, np.abs(solution - angles).max(axis=1))
    subset = slice(0, _SEARCH_COUNT)
    easy = spine.least_bending(back, target[subset], azimuth[subset])
    saved = 1 - np.sum(easy**2, axis=1) / np.sum(angles[subset] ** 2, axis=1)
    rad = {"units": "rad"}
    return xr.Dataset(
        {
            "error_inverse": ("random", position, _METRE | {"long_name": "how far the inverse misses the point"}),
            "error_azimuth": ("random", heading, rad | {"long_name": "how far the inverse misses the azimuth"}),
            "angle_missed": ("random", angle_error, rad | {"long_name": "greatest angle off the posture itself"}),
            "bending_saved": ("few", saved, {"units": "1", "long_name": "squared angles saved by the least bending"}),
        }
    )


def _density(x: np.ndarray, y: np.ndarray, cell: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    edges = [np.arange(v.min() - cell, v.max() + 2 * cell, cell) for v in (x, y)]
    counts = np.histogram2d(x, y, bins=edges)[0]
    return counts / len(x), *((e[:-1] + e[1:]) / 2 for e in edges)


def _workspace(back: SpineMeasures, angles: np.ndarray, grid: int) -> xr.Dataset:
    """Return the density of joint 5 from above and from the side over random postures, and a few named postures.

    Args:
        back: measures of the spine.
        angles: angles of the random postures, shape (sample, 5) [rad].
        grid: cells along the longer side of the maps [-].
    """
    x, y, z = spine.forward(back, angles)[:, :3, 3].T
    cell = float(np.ptp(y)) / grid  # [m]
    top, x1, y1 = _density(x, y, cell)
    side, x2, z2 = _density(x, z, cell)
    yaw, pitch = back.yaw_range[1], back.pitch_range[1]
    postures = {
        "straight": (0.0, 0.0, 0.0, 0.0, 0.0),
        "left": (yaw, 0.0, yaw, 0.0, yaw),
        "right": (-yaw, 0.0, -yaw, 0.0, -yaw),
        "down": (0.0, pitch, 0.0, pitch, 0.0),
        "up": (0.0, -pitch, 0.0, -pitch, 0.0),
    }
    share = {"units": "-", "long_name": "share of random postures in the cell"}
    return xr.Dataset(
        {
            "density_top": (("top_x", "top_y"), top, share),
            "density_side": (("side_x", "side_z"), side, share),
            "posture_points": (
                ("posture", "point", "axis"),
                _polyline(back, np.array(list(postures.values()))),
                _METRE,
            ),
        },
        coords={
            "top_x": ("top_x", x1, _METRE),
            "top_y": ("top_y", y1, _METRE),
            "side_x": ("side_x", x2, _METRE),
            "side_z": ("side_z", z2, _METRE),
            "posture": list(postures),
            "axis": list("xyz"),
        },
    )


def _polyline(back: SpineMeasures, angles: np.ndarray, *, head: float = 0.0) -> np.ndarray:
    """Return girdle, joints and, if it has a length, the head's tip [m], shape (*batch, point, 3)."""
    points = [np.zeros((*angles.shape[:-1], 1, 3)), spine.joints(back, angles)]
    if head:
        T = spine.forward(back, angles)
        points.append((T[..., :3, 3] + head * T[..., :3, 0])[..., None, :])
    return np.concatenate(points, axis=-2)


def _errors(back: SpineMeasures, count: int, seed: int) -> xr.Dataset:
    """Return the error of (15) in mildly bent random postures, as printed and with its missing term [m].

    Args:
        back: measures of the spine.
        count: number of postures [-].
        seed: seed of the postures [-].
    """
    angles = np.random.default_rng(seed + 1).uniform(-MILD, MILD, (count, 5))
    end, printed_end = spine.forward(back, angles)[:, :3, 3], printed.spine_position(back, angles)
    c1, c2, c3, c4, _ = np.cos(angles).T
    missing_term = (back.link * c4 - printed.LOST_TERM)[:, None] * (c2 * c3)[:, None]
    mended_end = printed_end + missing_term * np.stack([c1, np.sin(angles[:, 0]), np.zeros(count)], axis=1)
    error = np.linalg.norm(printed_end - end, axis=1)
    edges = np.linspace(0.0, 1.1 * back.link, 56)
    share = {"units": "-", "long_name": "share of the postures in the class"}
    return xr.Dataset(
        {
            "error_printed": ("mild", error, _METRE | {"long_name": "error of (15)"}),
            "error_upward": ("mild", np.abs(printed_end - end)[:, 2], _METRE | {"long_name": "error of Pz of (15)"}),
            "error_mended": (
                "mild",
                np.linalg.norm(mended_end - end, axis=1),
                _METRE | {"long_name": "error of (15) with its lost term"},
            ),
            "error_share": ("error", np.histogram(error, edges)[0] / count, share),
        },
        coords={"error": ("error", edges[:-1], {"units": "m", "long_name": "error of (15), lower edge of the class"})},
    )


def _turns(back: SpineMeasures) -> xr.Dataset:
    """Return the position of joint 5 while all yaw joints bend by the same angle, by Table II and as printed."""
    bend = np.linspace(-pi / 2, pi / 2, 121)
    angles = np.zeros((len(bend), 5))
    angles[:, ::2] = bend[:, None] / 3
    return xr.Dataset(
        {
            "track_ours": (("bend", "axis"), spine.forward(back, angles)[:, :3, 3], _METRE),
            "track_printed": (("bend", "axis"), printed.spine_position(back, angles), _METRE),
        },
        coords={"bend": ("bend", bend, {"units": "rad", "long_name": "bend of the trunk"}), "axis": list("xyz")},
    )


def _family(robot: Robot) -> xr.Dataset:
    """Return every posture that brings joint 5 to one point with one azimuth, and the least bent one."""
    back = robot.spine
    aim = spine.forward(back, np.radians([20.0, 20, -45, 40, -45]))
    target, azimuth = aim[:3, 3], float(_azimuth(aim))
    best = spine.least_bending(back, target, azimuth)
    yaw_angles = np.linspace(-pi / 2, pi / 2, 721)
    signs = np.array([[1], [-1]])
    cost = np.sum(spine.candidates(back, target, azimuth, first_yaw=yaw_angles, branch=signs) ** 2, axis=-1)
    branch = 1 if best[3] >= 0 else -1
    open_to = yaw_angles[np.isfinite(cost[0 if branch == 1 else 1])]
    first_yaws = np.linspace(open_to[0], open_to[-1], 9)[1:-1]
    family = spine.inverse(back, np.tile(target, (7, 1)), azimuth, first_yaw=first_yaws, branch=branch)
    return xr.Dataset(
        {
            "bending": (("branch", "first_yaw"), cost, {"units": "rad2", "long_name": "sum of the squared angles"}),
            "family_points": (("member", "node", "axis"), _polyline(back, family, head=robot.head.snout), _METRE),
            "best_points": (("node", "axis"), _polyline(back, best, head=robot.head.snout), _METRE),
            "best_angles": ("joint", best, {"units": "rad", "long_name": "least bent posture"}),
        },
        coords={
            "branch": [1, -1],
            "first_yaw": ("first_yaw", yaw_angles, {"units": "rad", "long_name": "first yaw angle"}),
            "joint": list(spine_joints()),
            "axis": list("xyz"),
        },
    )


experiment = SpineKinematics()
