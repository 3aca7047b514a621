"""The page of the atlas of flows: a summary of all rows, then each with its source, its set-up and its result."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from statistics import median

from suchus.atlas import CASES, GROUPS, AtlasRow, CurveComparison, Curves, FlowOutcome, compare, digest_of, published
from suchus.errors import SuchusError
from suchus.flow import ALONG_THE_SKIN

_SKIN = (
    "About values along the surface of a body the solver's documentation says: {solver} In these rows the vorticity "
    "is therefore not read with the solver's own `Surface` but from the equation of motion at the wall "
    "(`suchus.atlas.read_skin`); [limits](flow_limits.md) says how much more accurate that is. Pressures are relative "
    "to that of the far stream, by Bernoulli's equation from the inflow."
)
_HEAD = ("row", "rms over peak", "bound", "scatter of sources", "verdict", "cells", "processor time")


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """A row and its result."""

    row: AtlasRow
    """The row."""
    outcome: FlowOutcome | None
    """Outcome of its flow; None if it was not computed."""
    comparison: CurveComparison | None = None
    """Difference from the published data; None if there is nothing to compare."""
    failed: str = ""
    """The error, if there is no comparison; else empty."""
    curves: Curves = field(default_factory=dict)
    """Curves of the flow solver."""

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
        outcome = outcomes.get(row.case)
        found, failed = None, ""
        if outcome is not None:
            failed = outcome.failed
            try:
                found = None if failed else compare(row, outcome.curves)
            except SuchusError as error:
                failed = str(error)
        curves = {} if outcome is None else outcome.curves
        listed.append(Entry(row=row, outcome=outcome, comparison=found, failed=failed, curves=curves))
    return listed


def picture(group: str) -> str:
    """Return the path of a group's picture, beside the page."""
    return f"pictures/atlas_{group.lower().replace(' ', '_')}.png"


def summary(listed: Sequence[Entry]) -> str:
    """Return in a sentence or two how many rows agree, the median difference and the largest."""
    judged = [(e, e.comparison) for e in listed if e.comparison is not None and e.outcome and not e.outcome.quick]
    if not judged:
        return f"None of the {len(listed)} rows has been computed in full."
    above = [entry.row.name for entry, found in judged if not found.agrees]
    worst, most = max(judged, key=lambda pair: pair[1].rms)
    text = (
        f"Of {len(listed)} rows {len(judged)} were computed in full: the median rms difference is "
        f"{100 * median(found.rms for _, found in judged):.1f} % of the peak, the largest {100 * most.rms:.1f} % "
        f"({worst.row.name}); {len(judged) - len(above)} are within their bounds"
    )
    text += f", above are {', '.join(above)}." if above else "."
    failed = [entry.row.name for entry in listed if entry.word == "failed"]
    return text + (f" There is no comparison for {', '.join(failed)}, which failed." if failed else "")


def page(listed: Sequence[Entry]) -> str:
    """Return the page as Markdown."""
    costs = {e.outcome.case: e.outcome.seconds for e in listed if e.outcome is not None}
    lines = [
        "# Atlas of flows", "",
        "Published data of flows around bodies, many of which move, beside the results of `suchus.flow`. `suchus "
        "flow-atlas` computes the flows and `make atlas` writes this page from the results; nothing on it is typed in "
        "by hand. Exact answers and budgets, which have no published data, are on the page "
        "[validation](validation.md); [limits](flow_limits.md) says what the differences mean.", "",
        summary(listed) + f" All flows together took {sum(costs.values()) / 60:.0f} minutes of processor time.", "",
        "The difference of a row is the root mean square (rms) over the published points, divided by the largest "
        "published magnitude; for single numbers it is the rms of the relative differences. The scatter is the same "
        "measure between two sources. The bound was fixed before anything was computed: twice the scatter, at least 2 "
        "and at most 8 %, or the scatter itself if that is larger; 8 % where there is only one source. Rows above "
        "their bound are kept and marked.", "",
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
    cells += ["", "", ""] if found is None else [_percent(found.rms), _percent(found.bound), _percent(found.scatter)]
    cells += [word, "", ""] if outcome is None else [word, str(outcome.cells), f"{outcome.seconds:.0f} s"]
    return f"| {' | '.join(cells)} |"


def _percent(value: float | None) -> str:
    return "one source" if value is None else f"{100 * value:.1f} %"


def _section(entry: Entry) -> list[str]:
    """Return a row's own section."""
    row, case, outcome = entry.row, CASES[entry.row.case], entry.outcome
    effort = case.quick if outcome is not None and outcome.quick else case.full
    lines = ["", f"### {row.title} {{#{row.name}}}", "", *_words(entry)]
    found = entry.comparison
    if found is not None and row.kind == "numbers":
        lines += ["", "| quantity | computed | published | difference |", "|---|---|---|---|"]
        for name, ours, theirs in zip(published(row.data).columns["quantity"], found.ours, found.theirs, strict=True):
            lines.append(f"| {name} | {ours:.4g} | {theirs:.4g} | {100 * (ours / theirs - 1):+.1f} % |")
    setup = case.setup.format(cells=effort.cells, coarse=effort.coarse)
    about = " ".join(line if line.endswith(".") else f"{line}." for line in published(row.data).about)
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
                f"The source shows one instant and does not say of which cycle: of our {len(found.cycles)}, whose "
                f"differences are {_percent(min(found.cycles))} to {_percent(max(found.cycles))}, the one "
                f"{'whose pressure is ' if entry.row.cycle_of else ''}nearest to it counts."
            )
    if entry.row.note:
        sentences.append(entry.row.note)
    if outcome.digest != digest_of(CASES[entry.row.case], quick=outcome.quick):
        sentences.append("Computed by an earlier state of the solver or of this set-up.")
    return [" ".join(sentences)]
