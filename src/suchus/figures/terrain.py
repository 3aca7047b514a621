"""Postures on rough ground, their speeds, and how they turn."""

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from suchus.design import AnyRobot
from suchus.figures.posture import draw_posture
from suchus.figures.style import COLOURS, captioned, panels, styled
from suchus.paper.animals import ANIMAL

GAIT_LINES: Mapping[str, Mapping[str, Any]] = MappingProxyType(
    {
        "belly_crawl": {"color": "#767676", "marker": "v", "linestyle": (0, (1, 1.2)), "label": "belly crawl"},
        "low_crawl": {"color": "#009E73", "marker": "s", "linestyle": (0, (5, 2)), "label": "low crawl"},
        "semi_erect": {"color": "#0072B2", "marker": "o", "linestyle": "-", "label": "semi-erect"},
        "high_walk": {"color": "#D55E00", "marker": "^", "linestyle": (0, (5, 1.5, 1, 1.5)), "label": "high walk"},
        "high_walk_level": {"color": "#E69F00", "marker": "D", "linestyle": "-", "label": "high walk, IMU"},
        "switching": {"color": "#B0558A", "marker": "*", "linestyle": (0, (3, 1)), "label": "switching"},
        "thrifty": {
            "color": "#56B4E9",
            "marker": "P",
            "linestyle": (0, (3, 1, 1, 1)),
            "label": "switching, from crawl",
        },
    }
)
"""Colour, marker, dashes and label of each gait or arm."""
_MORE = ("#56B4E9", "#F0E442", "#B0558A")


def gait_lines(names: Iterable[Any]) -> Mapping[str, Mapping[str, Any]]:
    """Return ``GAIT_LINES`` with lines for further gaits, which are called by their names."""
    others = [str(name) for name in names if str(name) not in GAIT_LINES]
    return {
        **GAIT_LINES,
        **{
            name: {
                "color": COLOURS["coordinated"] if i == 0 else _MORE[i % len(_MORE)],
                "marker": "o",
                "linestyle": "-",
                "label": name.replace("_", " "),
            }
            for i, name in enumerate(others)
        },
    }


_THICK, _THIN = 2.0, 0.9
_SERVOS = ("servos of equal torque at any speed", "servos whose torque falls with speed")
_KINDS = {"bumps": "random bumps", "step": "a step up", "stone": "a stone in the path"}
_WALKING = ANIMAL["high_walk_speed"]
_USUAL = 1.01  # [m]; length of the article's robot, for which the pictures' sizes are


def draw_speed_range(record: xr.Dataset, lines: Mapping[str, Mapping[str, Any]]) -> Figure:
    """Draw speed, cost, duty factor and Froude number over cycle time, the servos with a speed line thinly."""
    with styled():
        figure, axes = panels(2, 2, width=9.6, height=8.0, sharex=True)
        rows = (
            ("speed", "speed [m/s]", 1.0),
            ("cost", "cost of transport [-]", 1.0),
            ("duty", "duty factor [-]", 1.0),
            ("froude", "Froude number [-]", 1.0),
        )
        for ax, (name, label, scale) in zip(axes.flat, rows, strict=True):
            for gait in record.gait.values:
                for model, width in (("line", _THIN), ("slew", _THICK)):
                    one = record.sel(gait=gait, servo_model=model)
                    style = dict(lines[str(gait)]) | {"linewidth": width, "markersize": 3 if model == "line" else 6}
                    if model == "line":
                        style |= {"label": f"_{style['label']}, {_SERVOS[1]}", "alpha": 0.7}
                    ax.plot(one.period, scale * one[name], **style)
            ax.set_xscale("log")
            ax.set_xticks([0.5, 1, 2, 4], ["0.5", "1", "2", "4"])
            ax.minorticks_off()
            ax.set_ylabel(label)
        band = axes[0, 0].axhspan(_WALKING.low, _WALKING.high, color="#EFE3C8", zorder=0)
        axes[0, 0].set_ylim(0.0, max(0.75, 1.1 * float(record.speed.max())))
        axes[0, 1].set_ylim(0.0, None)
        axes[1, 1].set_yscale("log")
        for ax in axes[1]:
            ax.set_xlabel("cycle time [s]")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        models = [Line2D([], [], color=COLOURS["printed"], linewidth=width) for width in (_THICK, _THIN)]
        handles, labels = [*handles, *models, band], [*labels, *_SERVOS, f"{_WALKING.who}, high walk"]
        figure.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=11)
    return captioned(
        figure,
        "Every gait over its cycle time. Thin: legs whose servos lose torque with speed, whose cost includes what the "
        f"motor loses. Band: what {_WALKING.who} do in the high walk.",
    )


def draw_turning(record: xr.Dataset, lines: Mapping[str, Mapping[str, Any]]) -> Figure:
    """Draw curvature against bend and asymmetry, and asked against measured radius."""
    with styled():
        figure, axes = panels(1, 3, width=11.5, height=4.0)
        for ax, name, label, scale in (
            (axes[0, 0], "bend", "curvature offset of the trunk [deg]", 180 / np.pi),
            (axes[0, 1], "asymmetry", "asymmetry of strokes [-]", 1.0),
        ):
            for gait in record.gait.values:
                ax.plot(scale * record[name], record[f"curvature_{name}"].sel(gait=gait), **lines[str(gait)])
            ax.set_xlabel(label)
            ax.set_ylabel("curvature of the path [1/m]")
            ax.set_ylim(-0.1, max(2.8, 1.05 * float(record.curvature_mixture.max())))
        axes[0, 0].legend(loc="upper left")
        ax = axes[0, 2]
        asked = record.asked.values
        ax.fill_between(asked, 0.9 * asked, 1.1 * asked, color="#E3E3E3", zorder=0, label="within 10 %")
        ax.plot(asked, asked, color=COLOURS["neutral"], linewidth=0.9)
        for gait in record.gait.values:
            style = dict(lines[str(gait)]) | {"linestyle": "none", "label": None}
            ax.plot(asked, record.radius.sel(gait=gait), **style)
        ax.set_xlabel("commanded radius [m]")
        ax.set_ylabel("measured radius [m]")
        ax.legend(loc="upper left")
    return captioned(
        figure,
        "How the robot turns: left and middle, curvature of its path with a bent trunk and with unequal strokes; "
        "right, a turn command that mixes both.",
    )


def draw_rough(record: xr.Dataset, lines: Mapping[str, Mapping[str, Any]]) -> Figure:
    """Draw the distance on bumps, steps and stones over height, or as bars where they are few; falls as crosses."""
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
                one = grounds.sel(arm=arm)
                x, y = 1000 * grounds.height.values, one.forward.mean("seed").values
                ax.plot(x, y, **(dict(lines[str(arm)]) | {"markersize": 6}))
                fell = one.fell.mean("seed").values
                ax.plot(x[fell > 0], y[fell > 0], "x", color=COLOURS["alarm"], markersize=11, markeredgewidth=2)
            ax.set_title(_KINDS[kind])
            ax.set_xlabel("height [mm]")
            ax.set_ylim(0.0, None)
        axes[0, 0].set_ylabel(f"displacement in {float(record.walked):g} s [m]")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), fontsize=10)
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
    counted = [f"{lines[arm]['label']} on {count}" for arm, count in counts.items() if count]
    return f"{', '.join(counted)} of {len(best)} grounds"


def _rough_bars(record: xr.Dataset, lines: Mapping[str, Mapping[str, Any]]) -> Figure:
    """Draw the distance of every condition on every ground as a bar: one height of a kind makes no line."""
    arms = [str(arm) for arm in record.arm.values]
    with styled(axes__grid=False):
        figure, axes = panels(1, record.sizes["ground"], width=11.5, height=3.6, sharex=True, sharey=True)
        for ax, ground in zip(axes[0], range(record.sizes["ground"]), strict=True):
            one = record.isel(ground=ground)
            distances, height = one.forward.mean("seed").values, 1000 * float(one.height)
            ax.barh(range(len(arms)), distances, color=[lines[arm]["color"] for arm in arms], height=0.65)
            for row, (distance, fell) in enumerate(zip(distances, one.fell.mean("seed").values, strict=True)):
                ax.annotate(
                    f"{distance:.2f}", (max(distance, 0.0), row), (4, 0), textcoords="offset points", va="center"
                )
                if fell > 0:
                    ax.plot(distance, row, "x", color=COLOURS["alarm"], markersize=11, markeredgewidth=2)
            ax.set_title(f"{_KINDS[str(one.kind.item())]}, {height:.0f} mm" if height else "even ground")
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
    ax.plot(x, height, color=COLOURS["ground"], linewidth=1.4, zorder=0.3)


def draw_on_bumps(robot: AnyRobot, record: xr.Dataset, said: str) -> Figure:
    """Draw every run of a record from the side at its end, on the ground under it.

    Args:
        robot: who walked.
        record: of the experiment.
        said: what the postures are, from above to below.
    """
    with styled(axes__grid=False):
        figure, axes = panels(3, 1, width=8.6, height=6.6)
        for ax, run in zip(axes[:, 0], record.run.values, strict=True):
            one = record.sel(run=run)
            draw_posture(ax, robot, one, float(one.time[-1]), view="side", support=False, ground=False)
            draw_ground(ax, record.along.values, record.ground_height.values)
            ax.set_title(str(GAIT_LINES[str(one.label.item())]["label"]))
            middle, size = float(one.centre_of_mass.sel(xyz="x")[-1]), robot.length / _USUAL
            ax.set_xlim(middle - 0.68 * size, middle + 0.62 * size)
            ax.set_ylim(-0.06 * size, 0.26 * size)
            ax.set_ylabel("height [m]")
        axes[-1, 0].set_xlabel("along the path [m]")
    return captioned(
        figure,
        f"Three postures on the same bumps of {1000 * float(record.shown_height):.3g} mm, halfway through the walk: "
        f"{said}. Filled feet stand.",
    )
