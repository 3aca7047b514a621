"""Figures of the experiment ``policies``."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure

from suchus.visual.figures.style import COLOURS, captioned, panels, styled

ARM_LABELS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "policy": "the policy",
        "policy_told": "the policy, told of the fault",
        "fault_policy": "the policy trained to be told of faults",
        "fault_policy_told": "the policy trained to be told of faults, told of the fault",
        "untold_policy": "the policy trained with untold faults",
        "untold_policy_told": "the policy trained with untold faults, told of the fault",
        "still_axis": "the policy with a still axis",
        "open_loop": "the gait by hand",
        "feedback": "the feedback rules",
    }
)
"""Controls in words."""
_ARM_STYLES: Final[Mapping[str, tuple[str, str]]] = MappingProxyType(
    {
        "policy": (COLOURS["policy"], "o"),
        "policy_told": (COLOURS["policy"], "D"),
        "fault_policy": (COLOURS["coordinated"], "s"),
        "fault_policy_told": (COLOURS["coordinated"], "P"),
        "untold_policy": (COLOURS["tail_still"], "<"),
        "untold_policy_told": (COLOURS["tail_still"], ">"),
        "still_axis": (COLOURS["limbs_tail_lifted"], "X"),
        "open_loop": (COLOURS["limbs_only"], "^"),
        "feedback": (COLOURS["tail_drag"], "v"),
    }
)
_CONDITION_LABELS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "undisturbed": "undisturbed",
        "heavier": "with more mass",
        "latency": "with late commands",
        "slippery": "on slippery ground",
        "play": "with play in the gears",
    }
)


def condition_label(condition: str) -> str:
    """Return a condition in words, to be read after a noun."""
    kind, _, joint = condition.partition("_")
    return _CONDITION_LABELS.get(condition, f"with {joint} {kind}")


def draw_tracking(record: Any) -> Figure:
    """Draw the commands of undisturbed walks and what each control reached, one panel each.

    Args:
        record: record of the experiment ``policies``.
    """
    grid = record.isel(case=record.condition.values == "undisturbed")
    arms = [arm for arm in grid.arm.values if np.isfinite(grid.speed.sel(arm=arm)).all()]
    with styled():
        figure, axes = panels(1, len(arms), width=3.4 * max(len(arms), 2), height=4.0, sharex=True, sharey=True)
        for ax, arm in zip(axes[0], arms, strict=True):
            colour, _ = _ARM_STYLES[arm]
            reached = grid.sel(arm=arm)
            ax.plot(grid.commanded_speed, grid.commanded_turn, "+", color="black", markersize=11, label="commanded")
            ax.plot(
                reached.speed.values.ravel(),
                reached.turn.values.ravel(),
                "o",
                color=colour,
                markersize=4.5,
                alpha=0.6,
                label="reached",
            )
            ax.set_title(ARM_LABELS[arm])
            ax.set_xlabel("speed [m/s]")
        axes[0, 0].set_ylabel("turning rate, left positive [rad/s]")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=2)
    return captioned(
        figure,
        "Commanded speeds and turning rates (crosses) and what robots as built reached under them, one panel for each "
        "control. Who fell stands at zero.",
    )


def draw_errors(outcome: Any) -> Figure:
    """Draw the tracking error of each control in each condition, with its interval over robots where there is one.

    Args:
        outcome: outcome of the experiment ``policies``; its measures are drawn.
    """
    record, measures = outcome.record, outcome.measures
    conditions = list(dict.fromkeys(map(str, record.condition.values)))
    arms = [str(arm) for arm in record.arm.values]
    with styled():
        figure, axes = panels(1, 1, width=8.0, height=2.0 + 0.55 * len(conditions))
        ax = axes[0, 0]
        for i, arm in enumerate(arms):
            colour, marker = _ARM_STYLES[arm]
            offset = 0.7 * ((i + 0.5) / len(arms) - 0.5)
            rows = [
                (row + offset, *(100.0 * measures[f"{name}{end}"].value for end in ("", "_low", "_high")))
                for row, condition in enumerate(conditions)
                if (name := f"tracking_error_{condition}_{arm}") in measures
            ]
            height, value, low, high = np.array(rows).T
            ax.hlines(height, low, high, color=colour, linewidth=1.6)
            ax.plot(value, height, marker, color=colour, markersize=6, linestyle="none", label=ARM_LABELS[arm])
        ax.set_yticks(range(len(conditions)), [condition_label(condition) for condition in conditions])
        ax.set_ylim(len(conditions) - 0.5, -0.5)
        ax.set_xlim(0.0, None)
        ax.set_xlabel("tracking error over the greatest command [%]")
        figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return captioned(
        figure,
        "Tracking error straight ahead in each condition, the median over robots as built and, as a line, its 95 % "
        "interval where there are six robots or more. Each control gets the same robots.",
    )
