"""The plots of the atlas of flows: published data beside ours, and how near each row comes to agreement."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from suchus.atlas import GROUPS, ROWS, AtlasRow, CurveComparison, FlowOutcome, published
from suchus.figures.atlas_page import Entry, entries, page, picture
from suchus.figures.style import COLOURS, styled
from suchus.record import new_file

_COLUMNS = 3
_OURS = COLOURS["ours"]
_ABOVE = COLOURS["alarm"]
_SMALL: dict[str, Any] = {"fontsize": 8}
_FARTHEST = 1.4  # times the published peak, to which the plot of all points reaches


def write_atlas(
    outcomes: Mapping[str, FlowOutcome], folder: Path, rows: Sequence[AtlasRow] = tuple(ROWS.values())
) -> Path:
    """Write ``atlas.md`` and its pictures to a folder from the outcomes of the flows by name, and return the page.

    Raises:
        Unwritable: the folder takes nothing.
    """
    listed = entries(rows, outcomes)
    drawn = {"parity": draw_parity(listed)}
    for group in GROUPS:
        members = [entry for entry in listed if entry.row in GROUPS[group] and entry.outcome is not None]
        if members:
            drawn[group] = draw_group(members)
    for name, figure in drawn.items():
        path = folder / picture(name)
        with new_file(path) as draft, styled():
            figure.savefig(draft, dpi=100)
    with new_file(folder / "atlas.md") as draft:
        draft.write_text(page(listed), encoding="utf-8")
    return folder / "atlas.md"


def draw_group(listed: Sequence[Entry]) -> Figure:
    """Return a panel for each row."""
    high = -(-len(listed) // _COLUMNS)
    wide = min(len(listed), _COLUMNS)
    with styled():
        figure = Figure(figsize=(3.5 * wide + 0.3, 2.9 * high), layout="constrained")
        panels = np.ravel(figure.subplots(high, wide, squeeze=False))
        for axes, entry in zip(panels, listed, strict=False):
            _draw(axes, entry)
        for axes in panels[len(listed) :]:
            axes.axis("off")
    return figure


def _draw(axes: Axes, entry: Entry) -> None:
    row, found = entry.row, entry.comparison
    difference = "not computed" if found is None else f"{100 * found.rms:.1f} %"
    axes.set_title(f"{row.name}: {difference}", color=_ABOVE if entry.bad else "black", **_SMALL)
    if found is None:
        axes.text(0.5, 0.5, entry.word, ha="center", va="center", transform=axes.transAxes, **_SMALL)
    elif row.kind == "numbers":
        _draw_numbers(axes, row, found)
    else:
        _draw_curve(axes, entry, found)
    axes.tick_params(labelsize=8)


def _draw_curve(axes: Axes, entry: Entry, found: CurveComparison) -> None:
    row, curve = entry.row, entry.curves[found.curve]
    low, high = found.x.min(), found.x.max()
    if row.kind == "loop":
        curve = np.append(curve, curve[:, :1], axis=1)
    else:
        curve = curve[:, np.argsort(curve[0], kind="stable")]
        curve = curve[:, (curve[0] >= low) & (curve[0] <= high)]
    axes.plot(curve[0], curve[1], color=_OURS, linewidth=1.4, label="computed")
    axes.plot(found.x, found.theirs, "k.", markersize=3, label="published")
    axes.set_xlabel(row.labels[0], **_SMALL)
    axes.set_ylabel(row.labels[1], **_SMALL)
    axes.legend(loc="best", fontsize=7)


def _draw_numbers(axes: Axes, row: AtlasRow, found: CurveComparison) -> None:
    table = published(row.data)
    places = np.arange(len(found.x))
    for column in table.columns:
        if column != "quantity":
            axes.plot(table.values(column) / found.theirs, places, "k|", markersize=14, label="published")
    axes.plot(found.ours / found.theirs, places, "o", color=_OURS, label="computed")
    axes.set_yticks(places, table.columns["quantity"])
    axes.set_ylim(-0.6, len(places) + 0.1)
    reach = 1.2 * max(float(np.abs(found.ours / found.theirs - 1).max()), found.bound)
    axes.set_xlim(1 - reach, 1 + reach)
    axes.locator_params(axis="x", nbins=5)
    axes.set_xlabel("over the mean of the published [-]", **_SMALL)
    handles = dict(zip(*axes.get_legend_handles_labels()[::-1], strict=True))
    axes.legend(handles.values(), handles.keys(), loc="upper right", fontsize=7, ncols=2)


def draw_parity(listed: Sequence[Entry]) -> Figure:
    """Return all points, ours over theirs, each over the peak of its row, and the difference of each row."""
    with styled():
        figure = Figure(figsize=(9.6, 0.17 * len(listed) + 2.2), layout="constrained")
        left, right = figure.subplots(1, 2)
        shown = [(entry, entry.comparison) for entry in listed if entry.comparison is not None]
        for entry, found in shown:
            peak = np.abs(found.theirs).max()
            colour = _ABOVE if entry.bad else _OURS
            left.plot(found.theirs / peak, found.ours / peak, ".", markersize=3, color=colour, alpha=0.5)
        left.axline((0, 0), slope=1, color="k", linewidth=0.8)
        left.set(xlabel="published, over the peak of its row [-]", ylabel="computed, over the same [-]", aspect="equal")
        left.set(xlim=(-_FARTHEST, _FARTHEST), ylim=(-_FARTHEST, _FARTHEST))
        for place, (entry, found) in enumerate(reversed(shown)):
            colour = _ABOVE if entry.bad else _OURS
            right.plot([0, 100 * found.rms], [place, place], color=colour, linewidth=3)
            right.plot(100 * found.bound, place, "k|", markersize=7, label="bound" if place == 0 else None)
        right.set_yticks(range(len(shown)), [entry.row.name for entry, _ in reversed(shown)], fontsize=7)
        right.set(xlabel="rms difference over the peak [%]", ylim=(-0.8, max(len(shown), 1) - 0.2))
        right.set_xlim(left=0.0)
        if shown:
            right.legend(loc="upper right", fontsize=8)
    return figure
