"""Two outcomes side by side: numbers with their difference, verdicts, settings, figures and replays."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import inf
from pathlib import Path
from typing import Any

from suchus.apps.report.outcome_page import answer
from suchus.apps.report.result import OUTCOME, MediaFile, Picture, Result, is_unchanged
from suchus.core.errors import IncompatibleRecord
from suchus.core.files import write
from suchus.visual.pages import render

_MAX_SETTING_LENGTH = 80
"""Letters of a setting that the page shows [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasureComparison:
    """One measure of both outcomes."""

    name: str
    """Name of the measure."""
    unit: str
    """Unit of the measure; both units where they differ."""
    first_value: float | None
    """Value in the first outcome; None where it has none."""
    second_value: float | None
    """Value in the second."""
    difference: float | None
    """Second less first, in ``unit``; None where one is missing or the units differ."""
    relative_difference: float | None
    """The difference over the size of the first [-]; None where the first is zero."""


@dataclass(frozen=True, slots=True, kw_only=True)
class VerdictComparison:
    """One claim, and what both outcomes say of it."""

    quantity: str
    """Quantity that the claim is about."""
    location: str
    """Place in the article: section, figure or table."""
    first_verdict: str
    """Verdict of the first outcome; empty where it has none."""
    second_verdict: str
    """Verdict of the second."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """One setting in which the outcomes differ."""

    name: str
    """Dotted path."""
    first_value: str
    """Value in the first outcome; empty where it has none."""
    second_value: str
    """Value in the second."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """What two outcomes have in common, and in what they differ."""

    names: tuple[str, str]
    """Names of the two outcomes."""
    results: tuple[Result, Result]
    """The two outcomes."""
    measures: tuple[MeasureComparison, ...]
    """Every measure of either: those that carry the answer first, then the largest relative difference."""
    sentences: tuple[str, str] = ("", "")
    """The answer of each outcome in words."""
    verdicts: tuple[VerdictComparison, ...]
    """Every claim that either judges, those with another verdict first."""
    settings: tuple[Setting, ...]
    """Every setting in which they differ."""

    @property
    def common_measures(self) -> tuple[MeasureComparison, ...]:
        """Measures of which both outcomes have a number."""
        return tuple(
            measure for measure in self.measures if measure.first_value is not None and measure.second_value is not None
        )

    @property
    def unmatched_measures(self) -> tuple[MeasureComparison, ...]:
        """Measures of which only one outcome has a number, or none."""
        return tuple(
            measure for measure in self.measures if measure.first_value is None or measure.second_value is None
        )

    @property
    def changed_verdicts(self) -> tuple[VerdictComparison, ...]:
        """Claims that both judge, and differently."""
        common_verdicts = (verdict for verdict in self.verdicts if verdict.first_verdict and verdict.second_verdict)
        return tuple(verdict for verdict in common_verdicts if verdict.first_verdict != verdict.second_verdict)


def compare(result_a: Result, result_b: Result, names: tuple[str, str]) -> Comparison:
    """Set two outcomes side by side.

    Args:
        result_a: an outcome.
        result_b: another, to be compared with it.
        names: what they are called.

    Raises:
        IncompatibleRecord: they are of two experiments, have no measure in common, or one was changed by hand.
    """
    for result in (result_a, result_b):
        if not is_unchanged(result):
            raise IncompatibleRecord(
                f"{result.folder / OUTCOME} was changed after suchus wrote it, so that its numbers prove nothing: run "
                "the experiment again."
            )
    if result_a.name != result_b.name:
        raise IncompatibleRecord(
            f"{result_a.folder} answers {result_a.name} and {result_b.folder} answers {result_b.name}; compare two "
            "outcomes of one experiment."
        )
    measures_of_both = result_a.outcome["measures"], result_b.outcome["measures"]
    measures = [_compare_measure(name, *measures_of_both) for name in _union(result_a, result_b)]
    if not any(measure.first_value is not None and measure.second_value is not None for measure in measures):
        raise IncompatibleRecord(
            f"{result_a.folder} ({result_a.name}) and {result_b.folder} ({result_b.name}) have no measure in common; "
            "compare two outcomes of one experiment."
        )
    answers = list(dict.fromkeys([*result_a.outcome.get("answers", ()), *result_b.outcome.get("answers", ())]))
    measures.sort(
        key=lambda measure: (
            measure.difference is None,
            answers.index(measure.name) if measure.name in answers else len(answers),
            -_size(measure),
        )
    )  # a stable sort: equal measures keep their order
    verdicts = list(_pair_verdicts(result_a.outcome["verdicts"], result_b.outcome["verdicts"]))
    verdicts.sort(
        key=lambda verdict: (
            verdict.first_verdict == verdict.second_verdict,
            not (verdict.first_verdict and verdict.second_verdict),
        )
    )
    flat = [dict(_flat(result.outcome.get("settings", {}))) for result in (result_a, result_b)]
    differ = [name for name in dict.fromkeys([*flat[0], *flat[1]]) if flat[0].get(name) != flat[1].get(name)]
    return Comparison(
        names=names,
        sentences=(answer(result_a.outcome["decides"]), answer(result_b.outcome["decides"])),
        results=(result_a, result_b),
        measures=tuple(measures),
        verdicts=tuple(verdicts),
        settings=tuple(
            Setting(name=n, first_value=_shorten(flat[0].get(n)), second_value=_shorten(flat[1].get(n))) for n in differ
        ),
    )


def write_comparison(comparison: Comparison, path: str | Path) -> Path:
    """Write the page of a comparison and return its path; replays stay where they are and are shown from there.

    Raises:
        Unwritable: the place cannot be written to.
    """
    path = Path(path)
    text = render_comparison(comparison, path.parent)
    return write(path, text)


def render_comparison(comparison: Comparison, page_folder: str | Path) -> str:
    """Return the page as text.

    Args:
        comparison: what to show.
        page_folder: the folder of the page, from which it shows the replays.
    """
    page_folder = Path(page_folder)
    a, b = comparison.results
    content: dict[str, Any] = {
        "it": comparison,
        "titles": list(dict.fromkeys([a.outcome["title"], b.outcome["title"]])),
        "pictures": _pairs({p.name: p for p in a.pictures}, {p.name: p for p in b.pictures}),
        "replays": _pairs({r.file.name: r for r in a.replays}, {r.file.name: r for r in b.replays}),
    }
    return render("compare.html", page_folder, **content)


def _pairs(
    a: Mapping[str, Picture] | Mapping[str, MediaFile], b: Mapping[str, Picture] | Mapping[str, MediaFile]
) -> list[tuple[str, tuple[Any, Any]]]:
    return [(name, (a.get(name), b.get(name))) for name in dict.fromkeys([*a, *b])]


def _union(a: Result, b: Result) -> list[str]:
    return list(dict.fromkeys([*a.outcome["measures"], *b.outcome["measures"]]))


def _compare_measure(
    name: str, first_measures: Mapping[str, Any], second_measures: Mapping[str, Any]
) -> MeasureComparison:
    """Return one measure of two outcomes with its difference, absolute and relative."""
    a, b = first_measures.get(name), second_measures.get(name)
    units = list(dict.fromkeys(entry["unit"] for entry in (a, b) if entry))
    values = [entry["value"] if entry else None for entry in (a, b)]
    difference = relative_difference = None
    if len(units) == 1 and values[0] is not None and values[1] is not None:
        difference = values[1] - values[0]
        relative_difference = difference / abs(values[0]) if values[0] else None
    return MeasureComparison(
        name=name,
        unit=" / ".join(units),
        first_value=values[0],
        second_value=values[1],
        difference=difference,
        relative_difference=relative_difference,
    )


def _size(measure: MeasureComparison) -> float:
    """Return the relative difference of a measure, by which measures of all units are sorted."""
    if measure.relative_difference is None:
        return inf if measure.difference else 0.0
    return abs(measure.relative_difference)


def _pair_verdicts(
    rows_a: Sequence[Mapping[str, Any]], rows_b: Sequence[Mapping[str, Any]]
) -> Iterator[VerdictComparison]:
    """Yield each claim with its verdict in two outcomes, in the order of the first outcome."""
    first_verdicts, second_verdicts = ({row["claim"]: row for row in rows} for rows in (rows_a, rows_b))
    for claim in dict.fromkeys([*first_verdicts, *second_verdicts]):
        verdict_pair = first_verdicts.get(claim) or second_verdicts[claim]
        verdict_words = [
            str(by_claim[claim]["verdict"]) if claim in by_claim else ""
            for by_claim in (first_verdicts, second_verdicts)
        ]
        yield VerdictComparison(
            quantity=verdict_pair["quantity"],
            location=verdict_pair["where"],
            first_verdict=verdict_words[0],
            second_verdict=verdict_words[1],
        )


def _flat(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Yield every value of nested settings with its dotted path."""
    if isinstance(value, Mapping):
        for name, child in value.items():
            yield from _flat(child, f"{path}.{name}".lstrip("."))
    elif isinstance(value, list) and any(isinstance(item, Mapping) for item in value):
        for i, child in enumerate(value):
            yield from _flat(child, f"{path}[{i}]")
    else:
        yield path, value


def _shorten(value: Any) -> str:
    text = "" if value is None else str(value)
    return text if len(text) <= _MAX_SETTING_LENGTH else f"{text[: _MAX_SETTING_LENGTH - 1]}…"
