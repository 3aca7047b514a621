"""The page of the atlas of flows: published data beside ours, as a table, in words and in plots."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from io import BytesIO
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evidence.atlas import (
    CASES,
    GRIDS,
    GROUPS,
    ROWS,
    AtlasRow,
    CurveComparison,
    Curves,
    FlowOutcome,
    GridConvergence,
    compare,
    digest_of,
    flow_on,
    published,
    row_convergence,
)
from evidence.atlas.convergence import FORMAL, SAFETY
from suchus.core.errors import SuchusError
from suchus.core.files import write
from suchus.flow import ALONG_THE_SKIN
from suchus.visual.figures.style import COLOURS, new, styled

_COLUMNS = 3
_OURS = COLOURS["ours"]
_ABOVE = COLOURS["alarm"]
_SMALL: dict[str, Any] = {"fontsize": 8}
_FARTHEST = 1.4  # times the published peak, to which the plot of all points reaches
_SKIN = (
    "About values along the surface of a body the solver's documentation says: {solver} In these rows the vorticity "
    "is therefore not read with the solver's own `Surface` but from the equation of motion at the wall "
    "(`evidence.atlas.read_skin`); [limits](flow_limits.md) says how much more accurate that is. "
    "Pressures are relative "
    "to that of the far stream, by Bernoulli's equation from the inflow."
)
_HEAD = (
    "row", "rms over peak", "rms over range", "bound", "scatter of sources", "source's own error",
    "uncertainty on three grids", "order", "verdict", "cells", "processor time",
)  # fmt: skip


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """A row and its result."""

    row: AtlasRow
    """The row."""
    outcome: FlowOutcome | None
    """Outcome of its flow on the finest grid that was computed; None if none was."""
    comparison: CurveComparison | None = None
    """Difference from the published data; None if there is nothing to compare."""
    failed: str = ""
    """The error, if there is no comparison; else empty."""
    curves: Curves = field(default_factory=dict)
    """Curves of the flow solver."""
    convergence: GridConvergence = field(default_factory=GridConvergence)
    """What the flow's grids say of the row."""
    coarser: tuple[FlowOutcome, ...] = ()
    """Outcomes of the flow on its coarser grids, in the order of their numbers."""

    @property
    def word(self) -> str:
        """Its verdict, in a word or two."""
        if self.outcome is None:
            return "not computed"
        if self.comparison is None:
            return "failed"
        if self.outcome.quick:
            return "trial"
        return "agrees" if self.comparison.agrees else "above its bound"

    @property
    def bad(self) -> bool:
        """Whether it is marked: a judged row above its bound, or one that failed."""
        return self.word in ("above its bound", "failed")


def entries(rows: Sequence[AtlasRow], outcomes: Mapping[str, FlowOutcome]) -> list[Entry]:
    """Return each row with its result; outcomes are found by the names of the flows."""
    listed = []
    for row in rows:
        numbers = range(1, len(CASES[row.case].grids) + 1)
        there = [one for grid in numbers if (one := outcomes.get(flow_on(row.case, grid))) is not None]
        outcome = there[0] if there else None
        found, failed = None, ""
        if outcome is not None:
            failed = outcome.failed
            try:
                found = None if failed else compare(row, outcome.curves)
            except SuchusError as error:
                failed = str(error)
        curves = {} if outcome is None else outcome.curves
        entry = Entry(
            row=row, outcome=outcome, comparison=found, failed=failed, curves=curves, coarser=tuple(there[1:])
        )  # fmt: skip
        listed.append(replace(entry, convergence=_convergence(entry)))
    return listed


def _convergence(entry: Entry) -> GridConvergence:
    """Return what the grids say, of which all have to be by the same code."""
    if entry.outcome is None or entry.comparison is None or entry.outcome.quick:
        return GridConvergence(refusal="the row is not judged")
    every = (entry.outcome, *entry.coarser)
    failed = [one for one in every if one.failed]
    if failed:
        return GridConvergence(refusal=f"{failed[0].cells} cells failed")
    return row_convergence(entry.row, {one.grid: (one.cells, one.curves) for one in every})


def picture(group: str) -> str:
    """Return the path of a group's picture, beside the page."""
    return f"pictures/atlas_{group.lower().replace(' ', '_')}.png"


def summary(listed: Sequence[Entry]) -> str:
    """Return in a sentence or two how many rows agree, the median difference and the largest."""
    judged = [(e, e.comparison) for e in listed if e.comparison is not None and e.outcome and not e.outcome.quick]
    if not judged:
        return f"None of the {len(listed)} rows has been computed in full."
    above = [entry.row.name for entry, found in judged if not found.agrees]
    ranges = [found.over_range for _, found in judged if found.over_range is not None]
    ranged = f" (of curves {100 * median(ranges):.1f} % of their range)" if ranges else ""
    coarser = [entry.row.name for entry, _ in judged if entry.outcome is not None and entry.outcome.grid > 1]
    worst, most = max(judged, key=lambda pair: pair[1].rms)
    text = (
        f"Of {len(listed)} rows {len(judged)} were computed{'' if coarser else ' in full'}: the median rms difference "
        f"is {100 * median(found.rms for _, found in judged):.1f} % of the peak{ranged}, the largest "
        f"{100 * most.rms:.1f} % ({worst.row.name}); {len(judged) - len(above)} are within their bounds"
    )
    text += f", above are {', '.join(above)}." if above else "."
    known = [entry.convergence.uncertainty for entry in listed if entry.convergence.uncertainty is not None]
    if known:
        text += (
            f" Three grids converge for {len(known)} of them, whose own uncertainty is {100 * median(known):.1f} % in "
            "the median."
        )
    if coarser:
        text += f" The finest grids of {', '.join(coarser)} have not been computed, and the next ones count."
    failed = [entry.row.name for entry in listed if entry.word == "failed"]
    return text + (f" There is no comparison for {', '.join(failed)}, which failed." if failed else "")


def page(listed: Sequence[Entry]) -> str:
    """Return the page as Markdown."""
    costs = {one.flow: one.seconds for entry in listed for one in _every(entry)}
    lines = [
        "# Atlas of flows", "",
        "Published data of flows around bodies, many of which move, beside the results of `suchus.flow`. `python -m "
        "evidence.atlas` computes the flows and `make atlas` writes this page from the results; nothing on it is typed "
        "in by hand. Exact answers and budgets, which have no published data, are on the page "
        "[validation](validation.md); [limits](flow_limits.md) says what the differences mean.", "",
        f"{summary(listed)} {_so_far(listed)} took {sum(costs.values()) / 60:.0f} minutes of processor time.", "",
        "The difference of a row is the root mean square (rms) over the published points, divided by the largest "
        "published magnitude, and beside it by the range from the least published value to the largest; for single "
        "numbers it is the rms of the relative differences. The scatter is the same "
        "measure between two sources. The source's own error is what it states, or half a unit of the last digit that "
        "it prints, or how far points that were read off its figure scatter about a smooth curve, over the peak. The "
        "bound was fixed before anything was computed: twice the scatter, at least 2 "
        "and at most 8 %, or the scatter itself if that is larger; 8 % where there is only one source. Rows above "
        "their bound are kept and marked.", "",
        f"Each flow is computed on {GRIDS} grids. Where a row's changes from grid to grid become smaller, the grid "
        f"convergence index ({SAFETY:g} times the error that the observed order estimates, or the order {FORMAL:g} "
        "where the observed one is higher; Roache 1994, Celik et al. 2008) is the uncertainty of the finest, over the "
        "same peak. As Celik et al. have it, changes may turn back; the row's section says at which share of its "
        "points they do, and where the order is low the index is large. It holds for the cells alone, neither for the "
        "domain nor for the source. Where the changes grow there is no index.", "",
        f"![All points, computed over published values, and the difference of each row with its bound]"
        f"({picture('parity')})",
        "", f"| {' | '.join(_HEAD)} |", "|" + "---|" * len(_HEAD),
        *(_summary_line(entry) for entry in listed),
    ]  # fmt: skip
    for group, rows in GROUPS.items():
        members = [entry for entry in listed if entry.row in rows]
        if members:
            lines += ["", f"## {group}"]
            if any(entry.outcome is not None for entry in members):
                lines += ["", f"![{group}: published points and our curves]({picture(group)})"]
            if any(entry.row.skin for entry in members):
                lines += ["", _SKIN.format(solver=ALONG_THE_SKIN)]
            for entry in members:
                lines += _section(entry)
    return "\n".join(lines) + "\n"


def _summary_line(entry: Entry) -> str:
    found, outcome = entry.comparison, entry.outcome
    word = f"**{entry.word}**" if entry.bad else entry.word
    cells = [f"[{entry.row.name}](#{entry.row.name})"]
    if found is None:
        cells += [""] * 5
    else:
        cells += [_percent(found.rms), "" if found.over_range is None else _percent(found.over_range)]
        cells += [
            _percent(found.bound),
            _percent(found.scatter),
            "" if found.source_error is None else _fine_percent(found.source_error),
        ]
    index, order = entry.convergence.uncertainty, entry.convergence.order
    cells += ["none" if index is None else _percent(index), "" if order is None else f"{order:.1f}", word]
    every = _every(entry)
    cells += [", ".join(str(one.cells) for one in every), f"{sum(one.seconds for one in every):.0f} s"]
    if outcome is None:
        cells[6:] = ["", "", word, "", ""]
    return f"| {' | '.join(cells)} |"


def _so_far(listed: Sequence[Entry]) -> str:
    """Return what the processor time on the page is of: all flows on all their grids, or part of them."""
    whole = all(len(_every(entry)) == len(CASES[entry.row.case].grids) for entry in listed)
    return "All flows together" if whole else "The grids that were computed"


def _every(entry: Entry) -> tuple[FlowOutcome, ...]:
    """Return the outcomes of a row's flow on all of its grids."""
    return () if entry.outcome is None else (entry.outcome, *entry.coarser)


def _fine_percent(value: float) -> str:
    """Return a share in percent, of small ones the first digit."""
    return f"{100 * value:.1f} %" if value >= 5e-4 else f"{100 * value:.0e} %"


def _percent(value: float | None) -> str:
    return "one source" if value is None else f"{100 * value:.1f} %"


def _section(entry: Entry) -> list[str]:
    """Return a row's own section."""
    row, case, outcome = entry.row, CASES[entry.row.case], entry.outcome
    effort = case.full if outcome is None else case.effort(outcome.grid, quick=outcome.quick)
    lines = ["", f"### {row.title} {{#{row.name}}}", "", *_words(entry)]
    found = entry.comparison
    if found is not None and row.kind == "numbers":
        lines += ["", "| quantity | computed | published | difference |", "|---|---|---|---|"]
        for name, ours, theirs in zip(
            published(row.data).columns["quantity"], found.computed, found.published, strict=True
        ):
            lines.append(f"| {name} | {ours:.4g} | {theirs:.4g} | {100 * (ours / theirs - 1):+.1f} % |")
    setup = case.setup.format(cells=effort.cells, coarse=effort.coarse)
    about = " ".join(line if line.endswith(".") else f"{line}." for line in published(row.data).description)
    return [*lines, "", f"Published: {about}", "", f"Computed: {setup}"]


def _words(entry: Entry) -> list[str]:
    outcome, found = entry.outcome, entry.comparison
    if outcome is None:
        return ["**Not computed.**"]
    sentences = []
    if found is None:
        sentences.append(f"**Failed:** {entry.failed}")
    else:
        sign = "within" if found.agrees else "**above**"
        judged = "a trial, which is not judged" if outcome.quick else f"{sign} its bound of {_percent(found.bound)}"
        sentences.append(f"{_percent(found.rms)} over {found.x.size} points: {judged}.")
        if found.cycles:
            sentences.append(
                f"{entry.row.choice}: of our {len(found.cycles)}, whose "
                f"differences are {_percent(min(found.cycles))} to {_percent(max(found.cycles))}, the one "
                f"{_whose(entry.row)}nearest to the source counts."
            )
        sentences.append(_grid_words(entry))
    if entry.row.note:
        sentences.append(entry.row.note)
    if outcome.grid > 1:
        planned = CASES[entry.row.case].full.cells
        sentences.append(f"The finest of its grids, of {planned} cells, has not been computed: {outcome.cells} count.")
    if outcome.digest != digest_of(CASES[entry.row.case], quick=outcome.quick, grid=outcome.grid):
        sentences.append("Computed by an earlier state of the solver or of this set-up.")
    return [" ".join(sentence for sentence in sentences if sentence)]


def _whose(row: AtlasRow) -> str:
    """Return by which other row a cycle is chosen, with a space behind it; nothing if by its own."""
    return f"whose {row.cycle_of.computed_curve.removeprefix('uppermost ')} is " if row.cycle_of else ""


def _grid_words(entry: Entry) -> str:
    """Return what the grids say of a row in a sentence; nothing of a trial."""
    index, order = entry.convergence.uncertainty, entry.convergence.order
    if entry.outcome is None or entry.outcome.quick:
        return ""
    if index is None:
        return f"No uncertainty of its own from {GRIDS} grids: {entry.convergence.refusal}."
    cells = ", ".join(str(one.cells) for one in _every(entry))
    at = "" if order is None else f", observed order {order:.1f}"
    turning = entry.convergence.turning
    if turning:
        at += f", the change turning back at {_percent(turning)} of the points"
    found = entry.comparison
    beyond = found is not None and found.rms > index
    beside = "less than the difference, which finer cells would not remove" if beyond else "as much as the difference"
    return f"Its uncertainty from {cells} cells is {_percent(index)}{at}: {beside}."


def atlas_files(folder: Path, rows: Sequence[AtlasRow]) -> list[Path]:
    """Return where ``write_atlas`` writes: the page, and the pictures of rows."""
    groups = [group for group, members in GROUPS.items() if any(row in members for row in rows)]
    return [folder / "atlas.md", *(folder / picture(name) for name in ("parity", *groups))]


def write_atlas(
    outcomes: Mapping[str, FlowOutcome], folder: Path, rows: Sequence[AtlasRow] = tuple(ROWS.values())
) -> Path:
    """Write ``atlas.md`` and its pictures to a folder from the outcomes of the flows by name, and return the page.

    Raises:
        Unwritable: the folder takes nothing.
    """
    listed = entries(rows, outcomes)
    figures = {"parity": draw_parity(listed)}
    for group in GROUPS:
        members = [entry for entry in listed if entry.row in GROUPS[group] and entry.outcome is not None]
        if members:
            figures[group] = draw_group(members)
    for name, figure in figures.items():
        drawn = BytesIO()
        with styled():
            figure.savefig(drawn, dpi=100, format="png")
        write(folder / picture(name), drawn.getvalue())
    return write(folder / "atlas.md", page(listed))


def draw_group(listed: Sequence[Entry]) -> Figure:
    """Return a panel for each row."""
    high = -(-len(listed) // _COLUMNS)
    wide = min(len(listed), _COLUMNS)
    with styled():
        figure = new(width=3.5 * wide + 0.3, height=2.9 * high)
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
    axes.plot(found.x, found.published, "k.", markersize=3, label="published")
    axes.set_xlabel(row.labels[0], **_SMALL)
    axes.set_ylabel(row.labels[1], **_SMALL)
    axes.legend(loc="best", fontsize=7)


def _draw_numbers(axes: Axes, row: AtlasRow, found: CurveComparison) -> None:
    table = published(row.data)
    places = np.arange(len(found.x))
    for column in table.columns:
        if column != "quantity":
            axes.plot(table.values(column) / found.published, places, "k|", markersize=14, label="published")
    axes.plot(found.computed / found.published, places, "o", color=_OURS, label="computed")
    axes.set_yticks(places, table.columns["quantity"])
    axes.set_ylim(-0.6, len(places) + 0.1)
    reach = 1.2 * max(float(np.abs(found.computed / found.published - 1).max()), found.bound)
    axes.set_xlim(1 - reach, 1 + reach)
    axes.locator_params(axis="x", nbins=5)
    axes.set_xlabel("over the mean of the published [-]", **_SMALL)
    handles = dict(zip(*axes.get_legend_handles_labels()[::-1], strict=True))
    axes.legend(handles.values(), handles.keys(), loc="upper right", fontsize=7, ncols=2)


def draw_parity(listed: Sequence[Entry]) -> Figure:
    """Return all points, ours over theirs, each over the peak of its row, and the difference of each row."""
    with styled():
        figure = new(width=9.6, height=0.17 * len(listed) + 2.2)
        left, right = figure.subplots(1, 2)
        shown = [(entry, entry.comparison) for entry in listed if entry.comparison is not None]
        for entry, found in shown:
            peak = np.abs(found.published).max()
            colour = _ABOVE if entry.bad else _OURS
            left.plot(found.published / peak, found.computed / peak, ".", markersize=3, color=colour, alpha=0.5)
        left.axline((0, 0), slope=1, color="k", linewidth=0.8)
        left.set(xlabel="published, over the peak of its row [-]", ylabel="computed, over the same [-]", aspect="equal")
        left.set(xlim=(-_FARTHEST, _FARTHEST), ylim=(-_FARTHEST, _FARTHEST))
        left.set_anchor("N")
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
