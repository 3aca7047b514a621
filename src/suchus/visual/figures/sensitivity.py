"""How claims fare over many designs and gaits: the shares in which they hold; of one, its number and its border."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from scipy import stats

from suchus.article.paper import CLAIMS
from suchus.article.verdict.judging import ROBUST
from suchus.sim.metrics.decisive import MAX_CHANCE
from suchus.visual.figures.style import COLOURS, captioned, panels, styled

_TRUE, _FALSE = "#0072B2", "#D55E00"
_MAX_PARAMETERS = 8


def draw_shares(
    rows: Sequence[Mapping[str, Any]],
    annotations: Mapping[str, str],
    shipped: Mapping[str, tuple[float, float, float]] | None = None,
) -> Figure:
    """Draw in which share of the designs each claim holds, with its 95 % interval, and what turns it.

    Args:
        rows: ``claim``, ``true`` and ``interval`` of each [-].
        annotations: what to write beside a claim, by claim.
        shipped: share and interval of the same claims in another, larger sample [-].
    """
    with styled():
        figure, axes = panels(1, 1, width=11.5, height=1.3 + 0.42 * len(rows))
        ax, spacing = axes[0, 0], 0.16 if shipped else 0.0
        for robust_range in ((0, 100 * (1 - ROBUST)), (100 * ROBUST, 100)):
            ax.axvspan(*robust_range, color=COLOURS["grid"], alpha=0.6, linewidth=0, zorder=0)
        for i, row in enumerate(reversed(rows)):
            intervals = [(i + spacing, (row["true"], *row["interval"]), "ours", "o", "this run")]
            if shipped and row["claim"] in shipped:
                intervals.append((i - spacing, shipped[row["claim"]], "printed", "D", "shipped table"))
            for y, interval, colour, mark, label in intervals:
                percentage, lower_bound, upper_bound = (100 * x for x in interval)
                style = {"color": COLOURS[colour], "label": label if i == len(rows) - 1 and shipped else f"_{label}"}
                ax.plot(
                    [lower_bound, upper_bound],
                    [y, y],
                    color=COLOURS[colour],
                    linewidth=2.2,
                    alpha=0.5,
                    label=f"_interval of {label}",
                )
                ax.plot(percentage, y, mark, markersize=6, **style)
            if row["claim"] in annotations:
                ax.text(102, i, annotations[row["claim"]], va="center", fontsize=10)
        ax.set_yticks(range(len(rows)), [row["claim"].replace("_", " ") for row in reversed(rows)], fontsize=11)
        ax.set_xlim(0, 100)
        ax.set_ylim(-0.6, len(rows) - 0.4)
        ax.set_xlabel("designs and gaits in which the statement holds [%]")
        ax.grid(False, axis="y")
        if shipped:
            ax.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2)
    return captioned(
        figure,
        "In which share of the plausible designs and gaits the statement of each claim holds, with 95 % intervals. In "
        f"the grey bands at least {ROBUST:.0%} of the designs agree; beside other claims stands the free number that "
        "best predicts where the statement holds, and on which side, where one does beyond chance.",
    )


def draw_claim(record: xr.Dataset, claim: str) -> Figure:
    """Draw one claim over all samples.

    Args:
        record: record of the sweep: ``number`` and ``holds`` over claim and sample, ``correlation`` over claim and
            parameter, ``value`` over sample and parameter, and the border.
        claim: key of the claim.
    """
    claimed = record.sel(claim=claim)
    is_finite = np.isfinite(claimed.number.values)
    number, holds = claimed.number.values[is_finite], claimed.holds.values[is_finite].astype(bool)
    with styled():
        figure, axes = panels(1, 3, width=13.0, height=4.3, width_ratios=[1.0, 0.8, 1.0])
        left_axes, middle_axes, right_axes = axes[0]
        _numbers(left_axes, number, holds, claim)
        _correlations(middle_axes, claimed, len(number))
        _plane(right_axes, claimed, is_finite, holds)
    percentage = f"{100 * holds.mean():.0f} %" if holds.size else "none"
    return captioned(
        figure,
        f"{CLAIMS[claim].sense} True in {percentage} of {len(number)} samples. Left: {CLAIMS[claim].quantity}; "
        "the line is the article's number. Middle: rank correlation with the parameters it follows most; within the "
        "grey band it could be chance. Right: the two that separate best; blue is the side of the decision boundary "
        "where it is true more often.",
    )


def _numbers(ax: Axes, number: np.ndarray, holds: np.ndarray, claim: str) -> None:
    """Draw the histogram of a claim's number, split by whether the claim holds, with the article's number.

    Args:
        ax: axes to draw on.
        number: the measured number of each sample, (sample,).
        holds: whether the claim holds in each sample, (sample,).
        claim: key of the claim.
    """
    article_value, unit = CLAIMS[claim].value, CLAIMS[claim].unit
    if number.size:
        lower_bound, upper_bound = np.quantile(number, (0.01, 0.99))
        if article_value is not None:
            lower_bound, upper_bound = min(lower_bound, article_value), max(upper_bound, article_value)
        edges = np.linspace(lower_bound, upper_bound + 1e-9, 33).tolist()
        if claim == "displacement_ratio":
            ax.set_xscale("log")
            edges = np.geomspace(lower_bound, upper_bound * (1 + 1e-9), 33).tolist()
            ax.set_xticks([0.5, 1, 2, 5, 10, 20, 50], ["0.5", "1", "2", "5", "10", "20", "50"])
            ax.minorticks_off()
        clipped = np.clip(number, lower_bound, upper_bound)
        ax.hist([clipped[holds], clipped[~holds]], edges, stacked=True, color=[_TRUE, _FALSE], label=["true", "false"])
    if article_value is not None:
        ax.axvline(article_value, color=COLOURS["printed"], linestyle=(0, (4, 2)), label="as printed")
    ax.set_xlabel(f"{_axis_label(claim)} [{unit}]")
    ax.set_ylabel("samples [-]")
    ax.yaxis.set_major_locator(MaxNLocator(integer=True))
    ax.grid(False, axis="x")
    ax.set_title(f"the sentence is true in {100 * holds.mean():.0f} %" if holds.size else "no predictor")
    if number.size or article_value is not None:
        ax.legend(loc="best", fontsize=10)


def _axis_label(claim: str) -> str:
    """Return the axis label of a claim's quantity, short enough for the axis."""
    if claim.startswith("fault_") and CLAIMS[claim].value is not None:
        return "change of displacement"
    labels = {
        "displacement_ratio": "displacement, spine and tail / limbs only",
        "com_fluctuation": "std of height, spine and tail / limbs only",
        "fault_tolerance": "faults better borne with spine and tail",
    }
    return labels.get(claim, "displacement forward")


def _correlations(ax: Axes, claimed: xr.Dataset, samples: int) -> None:
    """Draw the rank correlations of a claim's number with the parameters it follows most."""
    order = np.argsort(-abs(claimed.correlation.values))[:_MAX_PARAMETERS][::-1]
    values = claimed.correlation.values[order]
    ax.barh(range(len(order)), values, color=[_TRUE if v > 0 else _FALSE for v in values], height=0.65)
    ax.set_yticks(range(len(order)), [parameter_label(str(claimed.parameter.values[i])) for i in order], fontsize=10)
    limit = _chance(samples, claimed.sizes["parameter"])
    ax.axvspan(-limit, limit, color="#BBBBBB", alpha=0.45, linewidth=0, zorder=3)
    ax.axvline(0.0, color="#555555", linewidth=0.9)
    ax.set_xlim(-1.0, 1.0)
    ax.set_xlabel("rank correlation [-]")
    ax.grid(False, axis="y")
    ax.set_title("what its number follows")


def _chance(samples: int, parameters: int) -> float:
    """Return the rank correlation that the greatest of so many reaches by chance once in a hundred times."""
    if samples < 4:
        return 1.0
    t = stats.t.isf(MAX_CHANCE / parameters / 2, samples - 2)
    return float(t / np.sqrt(samples - 2 + t**2))


def parameter_label(parameter: str) -> str:
    """Return how a free number is called for people: ``gait.lift`` as ``lift (gait)``, a setting by its own name."""
    group, dot, name = parameter.partition(".")
    words = (name if dot else group).replace("_", " ").replace(".", ", ")
    return f"{words} ({group.replace('_', ' ')})" if dot and group != "robot" else words


def _plane(ax: Axes, claimed: xr.Dataset, is_finite: np.ndarray, holds: np.ndarray) -> None:
    """Draw the samples over the two parameters that separate best, with the decision boundary."""
    first_index = int(claimed.border_of)
    order = [int(i) for i in np.argsort(-abs(claimed.correlation.values))]
    if first_index < 0:
        first_index = order[0]
    second_index = next(i for i in order if i != first_index)
    x, y = (claimed.value.values[is_finite][:, i] for i in (first_index, second_index))
    size = float(np.clip(1600 / max(len(x), 1), 16, 60))
    for members, colour, mark, label in ((holds, _TRUE, "o", "true"), (~holds, _FALSE, "X", "false")):
        ax.scatter(x[members], y[members], s=size, color=colour, marker=mark, alpha=0.65, linewidth=0, label=label)
    if int(claimed.border_of) >= 0:
        border, edge = float(claimed.border_at), ax.get_xlim()
        ax.axvline(border, color="black", linewidth=1.4)
        ax.axvspan(border, edge[1] if claimed.border_above else edge[0], color=_TRUE, alpha=0.08, linewidth=0, zorder=0)
        ax.set_xlim(edge)
        ax.set_title(f"decision boundary at {border:.3g}, separation {float(claimed.border_separation):.2f}")
    else:
        ax.set_title("no decision boundary within the ranges")
    ax.xaxis.set_major_locator(MaxNLocator(4))
    for axis, i in ((ax.set_xlabel, first_index), (ax.set_ylabel, second_index)):
        axis(f"{parameter_label(str(claimed.parameter.values[i]))} [{claimed.parameter_unit.values[i]}]")
