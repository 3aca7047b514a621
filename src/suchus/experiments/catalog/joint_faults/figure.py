"""What failed joints cost: displacements over time, changes against the intact robot, tracks on the ground."""

import itertools
from collections.abc import Mapping, Sequence
from itertools import product
from math import nan
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from suchus.article.paper import CLAIMS
from suchus.article.verdict import listed
from suchus.experiments.experiment import write
from suchus.robot.motion import START
from suchus.visual.figures.style import COLOURS, LINES, captioned, panels, styled
from suchus.visual.figures.timeseries import draw_band, mark_cycles

_ARMS = ("coordinated", "limbs_only")
_SHADES = ("#0072B2", "#56B4E9", "#D55E00", "#E69F00", "#009E73", "#B0558A")


def _joint_label(joint: str) -> str:
    """Return the name of a joint as figures write it."""
    name = joint.replace("_", " ")
    return name if joint.endswith("knee") else f"{name} joint"


def _printed_loss(joint: str, arm: str) -> float | None:
    """Return the loss that the article prints for a joint [-]; None for a joint that the article does not mention."""
    claim = CLAIMS.get(f"fault_{joint}_{arm}")
    return None if claim is None else claim.value


def draw_matrix(record: xr.Dataset, measures: Mapping[str, float]) -> Figure:
    """Draw the loss in every cell as heat maps with numbers: joints by kind and legs, a panel for each group.

    Args:
        record: record of the campaign, for its joints, kinds and legs.
        measures: ``loss_CELL_GROUP`` and ``own_loss_CELL_limbs_only`` with their intervals [-].
    """
    rows = [str(joint) for joint in record.joint.values]
    columns = [f"{kind}_{legs}" for kind, legs in product(record.kind.values, record.legs.values)]
    maps = (
        ("With spine and tail, of its own displacement [%]", "loss_{}_coordinated", "coordinated"),
        ("With limbs only, of its own displacement [%]", "own_loss_{}_limbs_only", ""),
        ("With limbs only, of that with spine and tail [%]", "loss_{}_limbs_only", "limbs_only"),
    )
    counts = record.forward.notnull().sum("repeat")
    few_text = (
        f" Cells without an interval: of {int(counts.min())} robots." if bool(counts.min() < counts.max()) else ""
    )
    with styled():
        figure, axes = panels(len(maps), 1, width=5.4, height=len(maps) * (1.0 + 0.46 * len(rows)))
        for ax, (title, name, arm) in zip(axes[:, 0], maps, strict=True):
            names = [[name.format(f"{row}_{column}") for column in columns] for row in rows]
            change = np.array([[100.0 * measures[measure_name] for measure_name in row_names] for row_names in names])
            ax.imshow(np.clip(change, -100.0, 100.0), cmap="RdBu", vmin=-130.0, vmax=130.0, aspect="auto")
            for (i, j), value in np.ndenumerate(change):
                ends = [100.0 * measures.get(f"{names[i][j]}{end}", nan) for end in ("_low", "_high")]
                _cell(ax, i, j, value, ends)
            ax.set_xticks(range(len(columns)), [column.replace("_", ",\n") for column in columns])
            ax.set_yticks(range(len(rows)), [_row(row, arm) for row in rows])
            ax.tick_params(length=0)
            ax.grid(False)
            ax.set_title(title)
    return captioned(
        figure,
        "What a failed joint costs: change of displacement [%], median and interval over the repeats, for every "
        f"reading of the article's 'lost' (limp or locked, one leg or both).{few_text}{_outwalked(record)}",
    )


def _cell(ax: Axes, row: int, column: int, value: float, interval: Sequence[float]) -> None:
    """Write the change of displacement and its interval into a cell of the matrix.

    Args:
        ax: axes of the heat map.
        row: row of the cell.
        column: column of the cell.
        value: median change [%]; NaN where the intact robot does not move forward.
        interval: lower and upper bound of the change [%]; NaN where too few repeats give none.
    """
    colour = "white" if abs(value) > 88.0 else "#222222"
    if not np.isfinite(value):
        ax.text(column, row, "nothing to lose", ha="center", va="center", fontsize=7, color="#222222")
        return
    ax.text(column, row - 0.14, write(value, "+.0f"), ha="center", va="center", fontsize=11, color=colour)
    lower_bound, upper_bound = interval
    if not np.isfinite(interval).all():
        return
    ax.text(
        column,
        row + 0.27,
        f"{write(lower_bound, '+.0f')} to {write(upper_bound, '+.0f')}",
        ha="center",
        va="center",
        fontsize=7.5,
        color=colour,
    )


def _row(joint: str, arm: str) -> str:
    """Return the label of a row: the name of the joint, and below it the loss that the article prints for a group."""
    printed_loss = _printed_loss(joint, arm)
    return (
        joint.replace("_", " ")
        if printed_loss is None
        else f"{joint.replace('_', ' ')}\n(printed {100 * printed_loss:+.0f})"
    )


def _outwalked(record: xr.Dataset) -> str:
    """Return a sentence on printed losses that are smaller than that of the article's own intact robot with limbs only.

    The sentence is empty where there are none.
    """
    coordinated_distance, limbs_only_distance = (CLAIMS[f"displacement_{arm}"].value or 0.0 for arm in _ARMS)
    intact = limbs_only_distance / coordinated_distance - 1.0
    outwalking_losses = [
        p for j in record.lost.values if (p := _printed_loss(j, "limbs_only")) is not None and p > intact
    ]
    if not outwalking_losses:
        return ""
    return (
        f" The article's own intact robot with limbs only is at {intact:+.0%}; its "
        f"{listed([f'{p:+.0%}' for p in outwalking_losses])} with a failed joint let a damaged robot out-walk it."
    )


def draw_over_time(record: xr.Dataset, kind: str, legs: str) -> Figure:
    """Draw displacement over time with one kind of fault, a panel per joint; the form of Figs 18 to 21.

    Args:
        record: record of the campaign: ``track`` and ``intact_track`` over time, on the ground.
        kind: ``limp`` or ``locked``.
        legs: ``one`` or ``both``.
    """
    path, intact = record.track.sel(on_ground="x"), record.intact_track.sel(on_ground="x")
    end, period = float(record.time[-1]), float(record.period)
    legs_text = "one leg" if legs == "one" else "both legs"
    with styled():
        rows = (record.sizes["lost"] + 1) // 2
        figure, axes = panels(rows, 2, width=10.5, height=3.5 * rows, sharex=True, sharey=True)
        for ax in axes.flat[record.sizes["lost"] :]:
            ax.set_axis_off()
        for number, (ax, joint) in enumerate(zip(axes.flat, record.lost.values, strict=False)):
            for arm in _ARMS:
                paths = path.sel(joint=joint, kind=kind, legs=legs, arm=arm).rename(repeat="run")
                draw_band(ax, paths, arm)
                ax.plot(record.time, paths.median("run"), **LINES[arm])
                intact_path = intact.sel(arm=arm).median("repeat")
                ax.plot(record.time, intact_path, color=COLOURS[arm], linewidth=1.3, linestyle=(0, (1, 1.5)))
                printed_loss = _printed_loss(joint, arm)
                if end > START + 1.5 * period and printed_loss is not None:
                    x, y = end, (1.0 + printed_loss) * (CLAIMS["displacement_coordinated"].value or 0.0)
                    ax.plot(
                        x, y, "D", color=COLOURS[arm], markeredgecolor="black", markersize=8, zorder=5, clip_on=False
                    )
            mark_cycles(ax, list(np.arange(START, end + 0.01, period)))
            ax.set_xlim(START, end)
            has_printed_loss = _printed_loss(str(joint), "coordinated") is not None
            ax.set_title(f"Fig. {18 + number}: {_joint_label(joint)}" if has_printed_loss else _joint_label(str(joint)))
        for ax in axes[:, 0]:
            ax.set_ylabel("displacement forward [m]")
        for ax in axes[-1]:
            ax.set_xlabel("time [s]")
        figure.legend(handles=_keys(), loc="outside upper center", ncols=4, frameon=False)
    return captioned(
        figure,
        f"Displacement of the centre of mass with a {kind} joint in {legs_text} of a girdle: medians and ranges over "
        f"the repeats. Dotted: the intact robots. Diamonds: what the article's percentages make of its "
        f"{CLAIMS['displacement_coordinated'].value:g} m.",
    )


def _keys() -> list[Line2D]:
    """Return the entries of the legend."""
    return [
        *(Line2D([], [], **(dict(LINES[arm]) | {"linewidth": 1.9})) for arm in _ARMS),
        Line2D([], [], color=COLOURS["neutral"], linewidth=1.3, linestyle=(0, (1, 1.5)), label="intact"),
        Line2D([], [], color=COLOURS["neutral"], marker="D", linestyle="", markeredgecolor="black", label="as printed"),
    ]


def draw_tracks(record: xr.Dataset) -> Figure:
    """Draw the tracks on the ground in one repeat, a panel per joint; arrows show the final heading.

    Args:
        record: record of the campaign; the first repeat is drawn.
    """
    repeat_record = record.isel(repeat=0).sel(arm="coordinated")
    styles: dict[tuple[str, str], dict[str, Any]] = {
        ("limp", "one"): {"color": "#B0558A", "label": "limp, one leg"},
        ("limp", "both"): {"color": "#B0558A", "label": "limp, both legs", "linestyle": (0, (3, 1.2))},
        ("locked", "one"): {"color": "#009E73", "label": "locked, one leg"},
        ("locked", "both"): {"color": "#009E73", "label": "locked, both legs", "linestyle": (0, (3, 1.2))},
    }
    with styled():
        girdles, hinges = _grid(record.joint.values)
        figure, axes = panels(girdles, hinges, width=2.0 + 3.5 * hinges, height=2.8 * girdles, sharex=True, sharey=True)
        for ax, joint in zip(axes.T.flat, record.joint.values, strict=True):
            intact_track = repeat_record.intact_track.transpose("on_ground", "time").values
            ax.plot(*intact_track, color="#333333", linewidth=1.6, label="intact")
            _arrow(ax, intact_track[:, -1], float(repeat_record.intact_turn), "#333333")
            for (kind, legs), style in styles.items():
                walks = repeat_record.sel(joint=joint, kind=kind, legs=legs)
                path = walks.track.transpose("on_ground", "time").values
                ax.plot(*path, **style)
                _arrow(ax, path[:, -1], float(walks.turn), style["color"])
            ax.set_title(_joint_label(str(joint)))
            ax.set_aspect("equal")
        for ax in axes[:, 0]:
            ax.set_ylabel("to the left [m]")
        for ax in axes[-1]:
            ax.set_xlabel("forward [m]")
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=5, frameon=False)
    return captioned(
        figure,
        "Tracks of the centre of mass in one repeat seen from above, with spine and tail, the left joint or both "
        "failed; arrows show the heading at the end.",
    )


def _grid(joints: Sequence[str]) -> tuple[int, int]:
    """Return the number of girdles and of hinges in a limb, of joints that are listed hinge by hinge."""
    girdles = len(dict.fromkeys(str(joint).partition("_")[0] for joint in joints))
    return girdles, len(joints) // girdles


def _arrow(ax: Axes, start: np.ndarray, facing: float, colour: str) -> None:
    """Draw an arrow of 0.07 m in the direction of the body.

    Args:
        ax: axes to draw on.
        start: start of the arrow on the ground [m].
        facing: heading of the body, left positive [rad].
        colour: colour of the arrow.
    """
    tip = start + 0.07 * np.array([np.cos(facing), np.sin(facing)])
    ax.plot(*tip, alpha=0.0, label="_tip of the heading arrow")  # extends the axis limits to the tip
    arrow_style = {"arrowstyle": "-|>", "color": colour, "linewidth": 1.6, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", xy=tuple(tip), xytext=tuple(start), arrowprops=arrow_style, annotation_clip=False)


def draw_locking_positions(record: xr.Dataset) -> Figure:
    """Draw the change of displacement over the position at which a joint is locked.

    Args:
        record: record with ``held_forward`` (arm, lost, hold) [m].
    """
    intact_distance = float(record.held_intact_forward.sel(arm="coordinated"))
    change = 100 * (record.held_forward / intact_distance - 1.0)
    marks = dict(zip(record.lost.values, itertools.cycle("oD^vsP"), strict=False))
    with styled():
        figure, axes = panels(1, 2, width=10.5, height=4.2, sharex=True, sharey=True)
        for ax, arm in zip(axes[0], _ARMS, strict=True):
            intact_change = 100 * (float(record.held_intact_forward.sel(arm=arm)) / intact_distance - 1.0)
            ax.axhline(intact_change, color=COLOURS[arm], linewidth=1.3, linestyle=(0, (1, 1.5)))
            for i, joint in enumerate(record.lost.values):
                ax.plot(
                    record.hold,
                    change.sel(arm=arm, lost=joint),
                    color=_SHADES[i % len(_SHADES)],
                    marker=marks[joint],
                    label=str(joint).replace("_", " "),
                )
            ax.set_title(LINES[arm]["label"])
            ax.set_xlabel("where it holds in its range [-]")
        axes[0, 0].set_ylabel("change of displacement [%]")
        handles, _ = axes[0, 0].get_legend_handles_labels()
        handles.append(Line2D([], [], color=COLOURS["neutral"], linewidth=1.3, linestyle=(0, (1, 1.5)), label="intact"))
        figure.legend(handles=handles, loc="outside upper center", ncols=5, frameon=False)
    return captioned(
        figure,
        "Where a locked joint holds: 0 and 1 are the least and the greatest angle that the gait asks of it (yaw: foot "
        "back and forward; pitch: foot up and down). One leg; change against the intact robot with spine and tail.",
    )
