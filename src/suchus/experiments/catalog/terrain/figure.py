"""Pictures of postures on rough ground."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suchus.robot.design import Robot
from suchus.robot.robots import ROBOTS
from suchus.visual.figures.gait_diagram import GAIT_LINES
from suchus.visual.figures.posture import draw_posture
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_KINDS = {"bumps": "random bumps", "step": "a step up", "stone": "a stone in the path"}
_REFERENCE_LENGTH = ROBOTS["caiman"].length
"""Length of the robot for which the pictures' sizes are [m]."""
_FELL: Mapping[str, Any] = {"marker": "x", "linestyle": "none", "color": COLOURS["alarm"], "markersize": 11,
         "markeredgewidth": 2}  # fmt: skip


def draw_rough(record: xr.Dataset, lines: Mapping[str, Mapping[str, Any]]) -> Figure:
    """Draw the distance on bumps, steps and stones over height, or as bars where they are few; falls as crosses.

    Args:
        record: record of the experiment ``terrain``.
        lines: style of each condition.
    """
    kinds = [str(kind) for kind in dict.fromkeys(record.kind.values)]
    if record.sizes["ground"] <= 1 + len(kinds):
        return _rough_bars(record, lines)
    with styled():
        figure, axes = panels(1, len(kinds), width=11.5, height=4.6, sharey=True)
        for ax, kind in zip(axes[0], kinds, strict=True):
            grounds = record.isel(ground=np.flatnonzero((record.kind.values == kind) | (record.height.values == 0)))
            order = np.argsort(grounds.height.values)
            grounds = grounds.isel(ground=order)
            for arm in record.arm.values:
                arm_record = grounds.sel(arm=arm)
                x, y = 1000 * grounds.height.values, arm_record.forward.mean("seed").values
                ax.plot(x, y, **(dict(lines[str(arm)]) | {"markersize": 6}))
                fell = arm_record.fell.mean("seed").values
                ax.plot(x[fell > 0], y[fell > 0], **_FELL)
            ax.set_title(_KINDS[kind])
            ax.set_xlabel("height [mm]")
            ax.set_ylim(0.0, None)
        axes[0, 0].set_ylabel(f"displacement in {float(record.walked):g} s [m]")
        axes[0, 0].plot([], [], **_FELL, label="some robots fell")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=-(-len(labels) // 2), fontsize=10)
    return captioned(
        figure,
        f"Displacement on rough ground, means over {record.sizes['seed']} seeds; crosses where some robots fell. "
        f"Of those that keep one posture gets farthest: {_farthest(record, lines)}.",
    )


def _farthest(record: xr.Dataset, lines: Mapping[str, Mapping[str, Any]]) -> str:
    """Return on how many grounds each posture gets farthest, as a list in a sentence."""
    single = [arm for arm in record.arm.values if str(arm) not in ("switching", "thrifty")]
    best = record.forward.mean("seed").sel(arm=single).idxmax("arm").values
    counts = {str(arm): int((best == arm).sum()) for arm in single}
    phrases = [f"{lines[arm]['label']} on {count}" for arm, count in counts.items() if count]
    return f"{', '.join(phrases)} of {len(best)} grounds"


def _rough_bars(record: xr.Dataset, lines: Mapping[str, Mapping[str, Any]]) -> Figure:
    """Draw the distance of every condition on every ground as a bar: one height of a kind makes no line."""
    arms = [str(arm) for arm in record.arm.values]
    with styled(axes__grid=False):
        figure, axes = panels(1, record.sizes["ground"], width=11.5, height=3.6, sharex=True, sharey=True)
        for ax, ground in zip(axes[0], range(record.sizes["ground"]), strict=True):
            ground_record = record.isel(ground=ground)
            distances, height = ground_record.forward.mean("seed").values, 1000 * float(ground_record.height)
            ax.barh(range(len(arms)), distances, color=[lines[arm]["color"] for arm in arms], height=0.65)
            for row, (distance, fell) in enumerate(zip(distances, ground_record.fell.mean("seed").values, strict=True)):
                ax.annotate(
                    f"{distance:.2f}", (max(distance, 0.0), row), (4, 0), textcoords="offset points", va="center"
                )
                if fell > 0:
                    ax.plot(distance, row, **_FELL)
            ax.set_title(f"{_KINDS[str(ground_record.kind.item())]}, {height:.0f} mm" if height else "even ground")
            ax.set_xlabel(f"displacement in {float(record.walked):g} s [m]")
        axes[0, 0].set_yticks(range(len(arms)), [str(lines[arm]["label"]) for arm in arms])
        axes[0, 0].invert_yaxis()
        axes[0, 0].margins(x=0.18)
    return captioned(
        figure, "Displacement on each ground that was tried, means over the seeds; a cross where some robots fell."
    )


def draw_ground(ax: Axes, x: np.ndarray, height: Sequence[float] | np.ndarray) -> None:
    """Draw the profile of the ground, filled."""
    ax.fill_between(x, height, -0.06, color="#D9CDB8", zorder=0.2, linewidth=0)
    ax.plot(x, height, color=COLOURS["ground"], linewidth=1.4, zorder=0.3, label="_ground")


def draw_on_bumps(robot: Robot, record: xr.Dataset, posture_text: str) -> Figure:
    """Draw every run of a record from the side at its end, on the ground under it.

    Args:
        robot: robot that walked.
        record: record of the experiment.
        posture_text: what the postures are, from above to below.
    """
    with styled(axes__grid=False):
        figure, axes = panels(3, 1, width=8.6, height=6.6)
        for ax, run in zip(axes[:, 0], record.run.values, strict=True):
            run_record = record.sel(run=run)
            draw_posture(ax, robot, run_record, float(run_record.time[-1]), view="side", support=False, ground=False)
            draw_ground(ax, record.along.values, record.ground_height.values)
            ax.set_title(str(GAIT_LINES[str(run_record.label.item())]["label"]))
            middle, size = float(run_record.centre_of_mass.sel(xyz="x")[-1]), robot.length / _REFERENCE_LENGTH
            ax.set_xlim(middle - 0.68 * size, middle + 0.62 * size)
            ax.set_ylim(-0.06 * size, 0.26 * size)
            ax.set_ylabel("height [m]")
        axes[-1, 0].set_xlabel("along the path [m]")
    return captioned(
        figure,
        f"Three postures on the same bumps of {1000 * float(record.shown_height):.3g} mm, halfway through the walk: "
        f"{posture_text}. Filled feet stand.",
    )
