"""What failed joints cost: displacements over time, changes against the intact robot, tracks on the ground."""

import itertools
from collections.abc import Sequence
from itertools import product
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from suchus.figures.style import COLOURS, LINES, captioned, panels, styled
from suchus.figures.timeseries import draw_band, mark_cycles
from suchus.metrics import loss
from suchus.motion import START
from suchus.paper import CLAIMS
from suchus.verdict import listed

_ARMS = ("coordinated", "limbs_only")
_MARKS = {"coordinated": "o", "limbs_only": "s", "limbs_tail_lifted": "D"}
_SHADES = ("#0072B2", "#56B4E9", "#D55E00", "#E69F00", "#009E73", "#B0558A")
_OFFSET = {"coordinated": 0.13, "limbs_only": -0.13}


def _named(joint: str) -> str:
    name = joint.replace("_", " ")
    return name if joint.endswith("knee") else f"{name} joint"


def _printed(joint: str, arm: str) -> float | None:
    """Return what the article says of a loss, None of a joint of which it says nothing."""
    claim = CLAIMS.get(f"fault_{joint}_{arm}")
    return None if claim is None else claim.value


def draw_losses(record: xr.Dataset) -> Figure:
    """Draw every reading of every fault: median and range of the change, beside what is printed.

    Args:
        record: of the campaign: ``forward`` and ``intact_forward`` over variation, arm, joint, kind and legs, and
            ``lifted_forward`` of the control group with its tail in the air.
    """
    ours = record.intact_forward.sel(arm="coordinated", drop=True)
    change = 100 * loss(record.forward, ours)
    bare = 100 * loss(record.intact_forward.sel(arm="limbs_only"), ours)
    readings = list(product(record.kind.values, record.legs.values))
    with styled():
        figure, axes = panels(1, 1, width=8.6, height=1.2 + 1.55 * record.sizes["joint"])
        ax = axes[0, 0]
        ticks, labels, top = [], [], 0.0
        for joint in record.joint.values:
            ax.text(0.0, top + 0.62, _named(str(joint)), fontweight="bold", transform=ax.get_yaxis_transform())
            ax.axhspan(top + 0.45, top - len(readings) + 0.45, color="#F4F4F4", zorder=0, linewidth=0)
            for i, (kind, legs) in enumerate(readings):
                for arm in _ARMS:
                    losses = change.sel(joint=joint, kind=kind, legs=legs, arm=arm)
                    _range(ax, losses, top - i + _OFFSET[arm], arm)
                judged = kind == record.attrs["judged_kind"] and legs == record.attrs["judged_legs"]
                if judged and joint in record.lost and "lifted_forward" in record:
                    lifted = 100 * loss(record.lifted_forward.sel(lost=joint), ours)
                    _range(ax, lifted, top - i + 2 * _OFFSET["limbs_only"], "limbs_tail_lifted")
                ticks.append(top - i)
                labels.append(f"{kind}, {'one leg' if legs == 'one' else 'both legs'}")
            for arm in _ARMS:
                printed, span = _printed(str(joint), arm), (top - len(readings) + 0.5, top + 0.4)
                if printed is not None:
                    x = [100 * printed] * 2
                    ax.plot(x, span, color=COLOURS[arm], linewidth=2.2, linestyle=(0, (1, 1)), zorder=1)
            top -= len(readings) + 1.25
        ax.axvline(float(bare.median()), color=COLOURS["limbs_only"], linewidth=1.2, zorder=0.5)
        ax.axvspan(
            float(bare.min()), float(bare.max()), color=COLOURS["limbs_only"], alpha=0.12, linewidth=0, zorder=0.4
        )
        ax.axvline(0.0, color=COLOURS["coordinated"], linewidth=1.2, zorder=0.5)
        ax.set_yticks(ticks, labels)
        ax.set_ylim(top + 1.6, 1.5)
        ax.tick_params(axis="y", length=0)
        ax.spines["left"].set_visible(False)
        ax.grid(False, axis="y")
        ax.set_xlabel("change of displacement against the intact robot with spine and tail [%]")
        keys = [
            *(
                Line2D([], [], color=COLOURS[a], marker=_MARKS[a], linewidth=2.5, label=LINES[a]["label"])
                for a in _MARKS
            ),
            Line2D([], [], color=COLOURS["neutral"], linewidth=2.2, linestyle=(0, (1, 1)), label="as printed"),
            Patch(color=COLOURS["limbs_only"], alpha=0.25, label="limbs only, intact"),
        ]
        figure.legend(handles=keys, loc="outside upper center", ncols=3, frameon=False)
    return captioned(
        figure,
        "What a failed joint costs, for every reading of the article's 'lost': median and range over the variations of "
        "gait and friction. Dotted: as printed; of the knees the article says nothing. Orange line and band: the "
        f"intact robot with limbs only.{_outwalked(record)} Yellow: limbs only with the tail in the air, in the judged "
        f"reading.",
    )


def _outwalked(record: xr.Dataset) -> str:
    """Return which printed losses of limbs only leave more than the article's own intact robot with limbs only."""
    ours, bare = (CLAIMS[f"displacement_{arm}"].value or 0.0 for arm in _ARMS)
    intact = bare / ours - 1.0
    less = [p for j in record.lost.values if (p := _printed(j, "limbs_only")) is not None and p > intact]
    if not less:
        return ""
    return (
        f" The article's own intact robot with limbs only is at {intact:+.0%}; its "
        f"{listed([f'{p:+.0%}' for p in less])} with a failed joint let a damaged robot out-walk it."
    )


def _range(ax: Axes, values: xr.DataArray, y: float, arm: str) -> None:
    low, middle, high = (float(values.quantile(q)) for q in (0.0, 0.5, 1.0))
    ax.plot([low, high], [y, y], color=COLOURS[arm], linewidth=2.5, alpha=0.55, solid_capstyle="round", zorder=3)
    ax.plot([middle], [y], marker=_MARKS[arm], markersize=6, color=COLOURS[arm], zorder=4)


def draw_over_time(record: xr.Dataset, kind: str, legs: str) -> Figure:
    """Draw displacement over time with one kind of fault, a panel per joint; the form of Figs 18 to 21.

    Args:
        record: of the campaign: ``track`` and ``intact_track`` over time, on the ground.
        kind: ``limp`` or ``locked``.
        legs: ``one`` or ``both``.
    """
    path, intact = record.track.sel(on_ground="x"), record.intact_track.sel(on_ground="x")
    end, period = float(record.time[-1]), float(record.period)
    of = "one leg" if legs == "one" else "both legs"
    with styled():
        rows = (record.sizes["lost"] + 1) // 2
        figure, axes = panels(rows, 2, width=10.5, height=3.5 * rows, sharex=True, sharey=True)
        for ax in axes.flat[record.sizes["lost"] :]:
            ax.set_axis_off()
        for number, (ax, joint) in enumerate(zip(axes.flat, record.lost.values, strict=False)):
            for arm in _ARMS:
                paths = path.sel(joint=joint, kind=kind, legs=legs, arm=arm).rename(variation="run")
                draw_band(ax, paths, arm)
                ax.plot(record.time, paths.median("run"), **LINES[arm])
                whole = intact.sel(arm=arm).median("variation")
                ax.plot(record.time, whole, color=COLOURS[arm], linewidth=1.3, linestyle=(0, (1, 1.5)))
                printed = _printed(joint, arm)
                if end > START + 1.5 * period and printed is not None:
                    x, y = end, (1.0 + printed) * (CLAIMS["displacement_coordinated"].value or 0.0)
                    ax.plot(
                        x, y, "D", color=COLOURS[arm], markeredgecolor="black", markersize=8, zorder=5, clip_on=False
                    )
            mark_cycles(ax, list(np.arange(START, end + 0.01, period)))
            ax.set_xlim(START, end)
            known = _printed(str(joint), "coordinated") is not None
            ax.set_title(f"Fig. {18 + number}: {_named(joint)}" if known else _named(str(joint)))
        for ax in axes[:, 0]:
            ax.set_ylabel("displacement forward [m]")
        for ax in axes[-1]:
            ax.set_xlabel("time [s]")
        figure.legend(handles=_keys(), loc="outside upper center", ncols=4, frameon=False)
    return captioned(
        figure,
        f"Displacement of the centre of mass with a {kind} joint in {of} of a girdle: medians and ranges over the "
        "variations of gait and friction. Dotted: the intact robots. Diamonds: what the "
        f"article's percentages make of its {CLAIMS['displacement_coordinated'].value:g} m.",
    )


def _keys() -> list[Line2D]:
    return [
        *(Line2D([], [], **(dict(LINES[arm]) | {"linewidth": 1.9})) for arm in _ARMS),
        Line2D([], [], color=COLOURS["neutral"], linewidth=1.3, linestyle=(0, (1, 1.5)), label="intact"),
        Line2D([], [], color=COLOURS["neutral"], marker="D", linestyle="", markeredgecolor="black", label="as printed"),
    ]


def draw_tracks(record: xr.Dataset) -> Figure:
    """Draw the ways on the ground in the gait as given, a panel per joint: limp joints turn the robot.

    Args:
        record: of the campaign; the first variation is the gait as given.
    """
    given = record.isel(variation=0).sel(arm="coordinated")
    looks: dict[tuple[str, str], dict[str, Any]] = {
        ("limp", "one"): {"color": "#B0558A", "label": "limp, one leg"},
        ("limp", "both"): {"color": "#B0558A", "label": "limp, both legs", "linestyle": (0, (3, 1.2))},
        ("locked", "one"): {"color": "#009E73", "label": "locked, one leg"},
        ("locked", "both"): {"color": "#009E73", "label": "locked, both legs", "linestyle": (0, (3, 1.2))},
    }
    with styled():
        girdles, hinges = _grid(record.joint.values)
        figure, axes = panels(girdles, hinges, width=2.0 + 3.5 * hinges, height=2.8 * girdles, sharex=True, sharey=True)
        for ax, joint in zip(axes.T.flat, record.joint.values, strict=True):
            whole = given.intact_track.transpose("on_ground", "time").values
            ax.plot(*whole, color="#333333", linewidth=1.6, label="intact")
            _arrow(ax, whole[:, -1], float(given.intact_turn), "#333333")
            for (kind, legs), look in looks.items():
                walks = given.sel(joint=joint, kind=kind, legs=legs)
                path = walks.track.transpose("on_ground", "time").values
                ax.plot(*path, **look)
                _arrow(ax, path[:, -1], float(walks.turn), look["color"])
            ax.set_title(_named(str(joint)))
            ax.set_aspect("equal")
        for ax in axes[:, 0]:
            ax.set_ylabel("to the left [m]")
        for ax in axes[-1]:
            ax.set_xlabel("forward [m]")
        figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=5, frameon=False)
    return captioned(
        figure,
        "Tracks of the centre of mass seen from above, with spine and tail, the left joint or both failed; arrows show "
        "the heading at the end.",
    )


def _grid(joints: Sequence[str]) -> tuple[int, int]:
    """Return the number of girdles and of hinges in a limb, of joints that are listed hinge by hinge."""
    girdles = len(dict.fromkeys(str(joint).partition("_")[0] for joint in joints))
    return girdles, len(joints) // girdles


def _arrow(ax: Axes, at: np.ndarray, facing: float, colour: str) -> None:
    ahead = at + 0.07 * np.array([np.cos(facing), np.sin(facing)])
    ax.plot(*ahead, alpha=0.0)  # keeps the tip within the limits
    look = {"arrowstyle": "-|>", "color": colour, "linewidth": 1.6, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", xy=tuple(ahead), xytext=tuple(at), arrowprops=look, annotation_clip=False)


def draw_held(record: xr.Dataset) -> Figure:
    """Draw how the change depends on where a locked joint holds.

    Args:
        record: of the campaign: ``held_forward`` over condition, failed joint and hold.
    """
    whole = float(record.intact_forward.sel(arm="coordinated")[0])
    change = 100 * (record.held_forward / whole - 1.0)
    marks = dict(zip(record.lost.values, itertools.cycle("oD^vsP"), strict=False))
    with styled():
        figure, axes = panels(1, 2, width=10.5, height=4.2, sharex=True, sharey=True)
        for ax, arm in zip(axes[0], _ARMS, strict=True):
            bare = 100 * (float(record.intact_forward.sel(arm=arm)[0]) / whole - 1.0)
            ax.axhline(bare, color=COLOURS[arm], linewidth=1.3, linestyle=(0, (1, 1.5)))
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
