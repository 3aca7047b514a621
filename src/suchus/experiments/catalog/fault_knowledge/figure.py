"""What knowing of a failed joint brings: displacement by fault, over time, and of every fault in every gait."""

from collections.abc import Mapping

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from suchus.experiments.experiment import write
from suchus.visual.figures.style import COLOURS, LINES, SEQUENTIAL, captioned, panels, styled

_MARKS = {
    "kept": ("o", "white", "keeps its gait"),
    "intact": ("D", "#BBBBBB", "best gait of the intact robot"),
    "told": ("s", None, "gait of the failed joint"),
}
"""Marker, fill and label of each robot; None: the colour of its group."""
_DASHES = {"kept": (0, (1, 1.5)), "intact": (0, (5, 2)), "told": "-"}


def _words(joint: str) -> str:
    """Return the name of a joint as figures write it."""
    return joint.replace("_", " ")


def draw_gains(record: xr.Dataset, measures: Mapping[str, float]) -> Figure:
    """Draw the displacement of each fault for the three robots, a row for each kind of fault, a column for each group.

    Args:
        record: record of the experiment, for its joints, kinds and groups.
        measures: ``forward_JOINT_KIND_GROUP_STATE`` with its interval, ``unbroken_GROUP_STATE`` [m].
    """
    joints, arms, kinds = ([str(name) for name in record[dim].values] for dim in ("joint", "arm", "kind"))
    with styled():
        figure, axes = panels(
            len(kinds), len(arms), width=10.5, height=3.6 * len(kinds), sharex=True, sharey=True
        )  # fmt: skip
        for (row, kind), (column, arm) in ((r, c) for r in enumerate(kinds) for c in enumerate(arms)):
            ax = axes[row, column]
            for state in ("kept", "intact"):
                ax.axhline(
                    measures[f"unbroken_{arm}_{state}"],
                    color=COLOURS[arm],
                    linewidth=1.3,
                    linestyle=_DASHES[state],
                    label=f"_unbroken, {_MARKS[state][2]}",
                )
            for number, (state, (marker, fill, _)) in enumerate(_MARKS.items()):
                names = [f"forward_{joint}_{kind}_{arm}_{state}" for joint in joints]
                middle = np.array([measures[name] for name in names])
                ends = np.array([[measures[f"{name}{end}"] for name in names] for end in ("_low", "_high")])
                spread = np.nan_to_num(np.abs(ends - middle))
                ax.errorbar(
                    np.arange(len(joints)) + 0.2 * (number - 1), middle, yerr=spread, fmt=marker, color=COLOURS[arm],
                    markerfacecolor=fill or COLOURS[arm], markersize=7, capsize=3, linewidth=1.3,
                    label=_MARKS[state][2],
                )  # fmt: skip
            ax.set_xticks(range(len(joints)), [_words(joint).replace(" ", "\n") for joint in joints])
            ax.set_title(f"{LINES[arm]['label']}, {kind}")
        for ax in axes[:, 0]:
            ax.set_ylabel("displacement forward [m]")
        for ax in axes[-1]:
            ax.set_xlabel("failed joint")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=3, frameon=False)
    return captioned(
        figure,
        "Displacement in the settled cycles after a joint of the left leg has failed: the robot that keeps its gait, "
        "the one that changes to the best gait of the intact robot, and the one that knows the joint. Medians and "
        "their 95 % intervals. Lines: the unbroken robot in its own gait (dotted) and in the searched one (dashed).",
    )


def draw_over_time(record: xr.Dataset) -> Figure:
    """Draw the displacement since the fault over time, mean over the joints, a panel for each kind of fault.

    Args:
        record: record with ``track`` over arm, kind, state, repeat and time [m].
    """
    kinds = [str(kind) for kind in record.kind.values]
    cycles = record.time / record.period
    with styled():
        figure, axes = panels(1, len(kinds), width=10.5, height=4.2, sharex=True, sharey=True)
        for ax, kind in zip(axes[0], kinds, strict=True):
            for arm in (str(name) for name in record.arm.values):
                for state in ("kept", "told"):
                    track = record.track.sel(kind=kind, arm=arm, state=state)
                    ax.fill_between(
                        cycles, track.min("repeat"), track.max("repeat"), color=COLOURS[arm], alpha=0.18, linewidth=0
                    )
                    ax.plot(
                        cycles, track.median("repeat"), color=COLOURS[arm], linestyle=_DASHES[state],
                        label=f"{LINES[arm]['label']}, {_MARKS[state][2]}",
                    )  # fmt: skip
            ax.set_title(kind)
            ax.set_xlabel("time since the fault [cycle]")
        axes[0, 0].set_ylabel("displacement forward [m]")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside upper center", ncols=2, frameon=False)
    return captioned(
        figure,
        "Displacement since a joint has failed, along the first heading, mean over the joints: medians and ranges of "
        "the robots as built. The robot that knows its fault stops, takes the posture of the other gait, and walks on.",
    )


def draw_table(record: xr.Dataset) -> Figure:
    """Draw the displacement of every limp joint in every gait as a heat map, with spine and tail.

    Args:
        record: record with ``gait_forward`` over joint, gait and repeat [m].
    """
    joints, gaits = ([str(name) for name in record[dim].values] for dim in ("joint", "gait"))
    distances = record.gait_forward.median("repeat").transpose("joint", "gait").values
    smallest, largest = min(0.0, float(distances.min())), float(distances.max())
    with styled():
        figure, axes = panels(1, 1, width=1.1 * len(gaits) + 1.6, height=1.3 + 0.5 * len(joints))
        ax = axes[0, 0]
        ax.imshow(distances, cmap=SEQUENTIAL, vmin=smallest, vmax=largest, aspect="auto")
        for (i, j), value in np.ndenumerate(distances):
            colour = "#222222" if value - smallest > 0.55 * (largest - smallest) else "white"
            weight = "bold" if gaits[j] == joints[i] else "normal"
            ax.text(j, i, write(value, "+.2f"), ha="center", va="center", color=colour, fontweight=weight)
        ax.set_xticks(range(len(gaits)), [_words(gait).replace(" ", "\n") for gait in gaits])
        ax.set_yticks(range(len(joints)), [_words(joint) for joint in joints])
        ax.tick_params(length=0)
        ax.grid(False)
        ax.set(xlabel="gait searched for", ylabel="limp joint")
    return captioned(
        figure,
        "Every limp joint in every gait, with spine and tail: displacement in the settled cycles [m], medians over the "
        "robots as built. Bold: the gait of the joint that has failed.",
    )
