"""How much room does the snout reach, on four feet and on hind feet and tail?"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
import xarray as xr
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from suchus.core.checks import Checks
from suchus.experiments.experiment import Experiment, Measure, Measures, Outcome, Progress, SimulationResult, silent
from suchus.robot.design import LEGS, Robot
from suchus.robot.gaits import GAITS
from suchus.robot.motion import Gait
from suchus.robot.motion.working_space import Configurations, Extent, extent, outline, sample_configurations
from suchus.robot.robots import ROBOTS
from suchus.visual.figures import captioned
from suchus.visual.figures.style import COLOURS, panels, styled

STATES = ("crawling", "standing")
"""On four feet; on hind feet and tail."""
_ROLES = ("limbs_only", "coordinated")
_VIEWS = (("from the side", (0, 2), "height [m]"), ("from above", (0, 1), "to the left [m]"))


@dataclass(frozen=True, slots=True, kw_only=True)
class WorkingSpace(Experiment):
    """Volume and side-view area that the tip of the snout reaches without a step, by kinematics and balance.

    It needs a robot with four legs, a trunk that bends, a head and a tail, and a gait that says where its feet stand.
    """

    title = "How much room does the snout reach, on four feet and on hind feet and tail?"
    shows = "Section IV.D, Figs 23 and 24"
    answers = ("volume_crawling", "volume_standing", "volume_ratio", "area_ratio", "highest_standing")
    needs = ("legs", "shells", "article_spine", "tail")
    judged_settings = ("robot", "gait")
    judged_minima: ClassVar[Mapping[str, float]] = {"crawling": 2**19, "standing": 2**18}
    answer_minima: ClassVar[Mapping[str, float]] = {"crawling": 2**19, "standing": 2**18}

    robot: Robot = field(default_factory=lambda: ROBOTS["caiman"])
    """The robot that reaches."""
    gait: Gait = field(default_factory=lambda: GAITS["belly_crawl"])
    """Gait whose stance gives the places of the feet."""
    crawling: int = 2**19
    """Configurations that are drawn on four feet; about one in two hundred is possible [-]."""
    standing: int = 2**18
    """Configurations that are drawn on hind feet and tail; about one in ten is possible [-]."""
    cell: float = 0.025
    """Edge of the cells that are counted [m]."""
    seed: int = 0
    """Seed of the drawing [-]."""

    def __post_init__(self) -> None:
        """Refuse settings outside their ranges."""
        with Checks(self.name(), self) as check:
            check.whole("crawling", 1, 2**24)
            check.whole("standing", 1, 2**24)
            check.whole("seed", 0, 2**31)
            check.number("cell", 0.002, 0.2, "m")

    def quick(self) -> "WorkingSpace":
        """Return it with few configurations in coarse cells."""
        return replace(self, crawling=2**15, standing=2**13, cell=0.04)

    def simulate(self, progress: Progress = silent) -> SimulationResult:
        """Draw configurations and keep those that can be."""
        record = xr.Dataset(attrs={"cell": self.cell}, coords={"xyz": ["x", "y", "z"], "leg": ["LF", "LH"]})
        for state, share in zip(STATES, (0.0, 0.6), strict=True):
            progress(state, share)
            samples = sample_configurations(
                self.robot, self.gait, standing=state == "standing", count=getattr(self, state), seed=self.seed
            )
            record[f"snout_{state}"] = ((f"kept_{state}", "xyz"), samples.snout, {"units": "m"})
            record[f"tried_{state}"] = ((), samples.sample_count, {"units": "1"})
            record = record.merge(_highest_posture(self.robot, samples, state))
        return SimulationResult(record=record)

    def measure(self, record: xr.Dataset) -> Measures:
        """Return volumes, areas and heights of both states with what the counting leaves open."""
        cell, extents = record.attrs["cell"], {}
        measures = Measures()
        for state in STATES:
            snout = record[f"snout_{state}"].values
            mirrored_snout = np.concatenate(
                [snout, snout * [1.0, -1.0, 1.0]]
            )  # what a robot can do, its mirror image can
            extents[state] = {
                "volume": (extent(mirrored_snout, cell), "m3"),
                "area": (extent(snout[:, [0, 2]], cell), "m2"),
            }
            for name, (size, unit) in extents[state].items():
                measures |= {
                    f"{name}_{state}": Measure(size.value, unit),
                    f"{name}_{state}_low": Measure(size.lower_estimate, unit),
                    f"{name}_{state}_high": Measure(size.upper_estimate, unit),
                }
            measures[f"highest_{state}"] = Measure(float(snout[:, 2].max()) if len(snout) else float("nan"), "m")
            measures[f"possible_{state}"] = Measure(len(snout) / float(record[f"tried_{state}"]), "-")
        for name in ("volume", "area"):
            crawling_extent, standing_extent = (extents[state][name][0] for state in STATES)
            measures |= {
                f"{name}_ratio{end}": Measure(v, "-") for end, v in _quotient(standing_extent, crawling_extent).items()
            }
        return measures

    def draw(self, outcome: Outcome) -> Mapping[str, Any]:
        """Draw the room from the side and from above."""
        return {
            "working_space": captioned(
                draw_room(outcome.record, STATES),
                "Where the tip of the snout can be without a step: on four feet (orange) and on hind feet and tail "
                "(blue), from the side and from above, with the configuration of each that reaches highest. Feet stand "
                f"as in the gait; cells of {1000 * self.cell:g} mm.",
            )
        }


def _quotient(numerator: Extent, denominator: Extent) -> dict[str, float]:
    """Return the ratio of two extents with its bounds; NaN where the denominator is 0."""
    pairs = {
        "": (numerator.value, denominator.value),
        "_low": (numerator.lower_estimate, denominator.upper_estimate),
        "_high": (numerator.upper_estimate, denominator.lower_estimate),
    }
    return {end: a / b if b > 0 else float("nan") for end, (a, b) in pairs.items()}


def _highest_posture(robot: Robot, samples: Configurations, state: str) -> xr.Dataset:
    """Return midline and left legs of the posture in which the snout is highest [m].

    Args:
        robot: the robot.
        samples: possible postures.
        state: one of ``STATES``.
    """
    if not len(samples.snout):
        return xr.Dataset()
    best = int(np.argmax(samples.snout[:, 2]))
    line, legs = outline(robot, samples.angles[best : best + 1], samples.pelvis[best : best + 1])
    metres = {"units": "m"}
    left_legs = [LEGS.index("LF"), LEGS.index("LH")]
    return xr.Dataset(
        {
            f"body_{state}": (("point", "xyz"), line[0], metres),
            f"legs_{state}": (("leg", "end", "xyz"), legs[0, left_legs], metres),
        }
    )


def draw_room(record: xr.Dataset, states: Sequence[str]) -> Figure:
    """Draw the cells that the snout reaches in two states, and the highest configuration of each.

    Args:
        record: record with ``snout_STATE`` (kept, xyz), ``body_STATE`` (point, xyz), ``legs_STATE`` (leg, end, xyz)
            [m].
        states: their names, the smaller room first.
    """
    with styled():
        figure, axes = panels(1, 2, width=12.0, height=5.6)
        for ax, (title, (horizontal_axis, vertical_axis), label) in zip(axes[0], _VIEWS, strict=True):
            for state, role in reversed(tuple(zip(states, _ROLES, strict=True))):
                snout, colour = record[f"snout_{state}"].values, COLOURS[role]
                if vertical_axis == 1:
                    snout = np.concatenate([snout, snout * [1.0, -1.0, 1.0]])
                _fill_occupied_cells(ax, snout[:, [horizontal_axis, vertical_axis]], record.attrs["cell"], colour)
                ax.plot([], [], "s", color=colour, alpha=0.55, markersize=10, label=state)
            for state, role in zip(states, _ROLES, strict=True):
                if f"body_{state}" in record:
                    _posture(ax, record, state, (horizontal_axis, vertical_axis), COLOURS[role])
            ax.set_aspect("equal")
            ax.set(title=title, xlabel="ahead of the hind feet [m]", ylabel=label)
        axes[0, 0].axhline(0.0, color=COLOURS["ground"], linewidth=2.0, zorder=1)
        axes[0, 0].legend(loc="upper left")
    return figure


def _fill_occupied_cells(ax: Any, points: np.ndarray, cell_size: float, colour: str) -> None:
    """Draw the squares of a regular grid that contain at least one point, in one translucent colour.

    Args:
        ax: axes to draw on.
        points: points in the plane of the panel, shape (point, 2) [m].
        cell_size: side of a square [m].
        colour: colour of the squares.
    """
    if len(points) == 0:
        return
    edges = [np.arange(coordinates.min(), coordinates.max() + 2 * cell_size, cell_size) for coordinates in points.T]
    counts, _ = np.histogramdd(points, bins=edges)
    occupied = np.ma.masked_equal(counts.T > 0, False)
    ax.pcolormesh(*edges, occupied, cmap=ListedColormap([colour]), alpha=0.38, antialiased=False, linewidth=0, zorder=1)


def _posture(ax: Any, record: xr.Dataset, state: str, axes: tuple[int, int], colour: str) -> None:
    """Draw trunk, left legs and snout of the highest posture of a state.

    Args:
        ax: axes to draw on.
        record: record with ``body_STATE`` and ``legs_STATE`` [m].
        state: one of ``STATES``.
        axes: indices of the horizontal and the vertical coordinate in ``xyz``.
        colour: colour of the lines.
    """
    body, legs = record[f"body_{state}"].values[:, list(axes)], record[f"legs_{state}"].values[..., list(axes)]
    ax.plot(
        *body.T,
        color=colour,
        linewidth=4.0,
        solid_capstyle="round",
        solid_joinstyle="round",
        zorder=3,
        label=f"_trunk, {state}",
    )
    for leg in legs:
        ax.plot(*leg.T, color=colour, linewidth=2.2, marker="o", markersize=4, zorder=3, label=f"_leg, {state}")
    ax.plot(*body[-1], "o", color=colour, markersize=7, markeredgecolor="white", zorder=4, label=f"_snout, {state}")


experiment = WorkingSpace()
