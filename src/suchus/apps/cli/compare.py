"""``suchus compare A B``: two outcomes side by side, in the terminal and as a page."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import tyro
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from suchus.apps.cli.entry import BadCommand, printable
from suchus.apps.cli.options import parse
from suchus.apps.cli.word_checks import check_page
from suchus.apps.report import OUTCOME, Comparison, compare, load_result, number, quantity, write_comparison
from suchus.core.files import check_replaceable, check_writable

_MAX_ROWS = 24
"""Measures that the terminal shows; the page has all of them [-]."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CompareOptions:
    """Options of ``suchus compare``."""

    first: Annotated[Path, tyro.conf.Positional]
    """An outcome: the folder that suchus run wrote, such as out/displacement, or the outcome.json in it."""
    second: Annotated[Path, tyro.conf.Positional]
    """The outcome that is compared with it; differences are the second less the first."""
    out: Path = Path("compare.html")
    """The page with numbers, verdicts, figures and replays of both."""


def compare_outcomes(words: Sequence[str]) -> int:
    """Compare two outcomes, write the page, say where it is, and return 0.

    Raises:
        SuchusError: the words or a file make no sense, or the place cannot be written to.
    """
    description = (
        "Set two outcomes side by side: measures and their differences, verdicts, settings, figures and replays."
    )
    options = parse(CompareOptions, "suchus compare", words, description)
    check_page(options.out)
    check_writable(options.out.parent)
    check_replaceable(options.out)
    folders = [_folder(path) for path in (options.first, options.second)]
    names = (str(folders[0]), str(folders[1]))
    comparison = compare(load_result(folders[0]), load_result(folders[1]), names)
    page = write_comparison(comparison, options.out)
    _show(comparison)
    print(f"figures and replays of both, and all {len(comparison.measures)} measures: {page}")
    return 0


def _folder(path: Path) -> Path:
    """Return the folder of an outcome.

    Raises:
        BadCommand: the path is neither a folder nor an outcome.
    """
    if path.name == OUTCOME:
        return path.parent
    if path.is_dir():
        return path
    problem = "is no outcome" if path.exists() else "is not there"
    raise BadCommand(f"{path} {problem}: name the folder that suchus run wrote, or the {OUTCOME} in it.")


def _show(comparison: Comparison) -> None:
    """Print the settings, verdicts and measures in which two outcomes differ as tables."""
    console = Console(highlight=False)
    for letter, name in zip("AB", comparison.names, strict=True):
        console.print(escape(printable(f"{letter}: {name}")), soft_wrap=True)
    for letter, sentence in zip("AB", comparison.sentences, strict=True):
        if sentence:
            console.print(escape(printable(f"{letter} answers: {sentence}")), soft_wrap=True)
    _print(console, ("setting", "A", "B"), _settings(comparison)[:_MAX_ROWS])
    _print(
        console,
        ("claim judged differently", "A", "B"),
        [(o.quantity, o.first_verdict, o.second_verdict) for o in comparison.changed_verdicts],
    )
    rows = [
        (
            row.name,
            quantity(row.first_value, "-"),
            quantity(row.second_value, "-"),
            "" if row.unit == "-" else row.unit,
            "" if row.relative_difference is None else f"{number(float(f'{100 * row.relative_difference:.3g}'), 6)} %",
        )
        for row in comparison.measures[:_MAX_ROWS]
    ]
    _print(console, ("measure", "A", "B", "unit", "relative to A"), rows)


def _settings(comparison: Comparison) -> list[tuple[str, str, str]]:
    """Return a row for each setting that differs; settings of one list, such as a robot's axis, share a row."""
    groups: dict[str, list[tuple[str, str, str]]] = {}
    for setting in comparison.settings:
        row = setting.name, _rounded(setting.first_value), _rounded(setting.second_value)
        groups.setdefault(setting.name.partition("[")[0], []).append(row)
    return [
        rows[0] if len(rows) == 1 else (f"{name}[]", "", f"{len(rows)} of its settings differ")
        for name, rows in groups.items()
    ]


def _rounded(text: str) -> str:
    """Return a setting with its numbers in four digits."""
    return re.sub(r"\d+\.\d{4,}(e[+-]?\d+)?", lambda match: f"{float(match[0]):.4g}", text)


def _print(console: Console, head: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table whose first column is on the left; nothing without rows."""
    if not rows:
        return
    table = Table(box=None, padding=(0, 1, 0, 0))
    for i, heading in enumerate(head):
        table.add_column(heading, justify="left" if i == 0 else "right", overflow="fold", no_wrap=i == 0)
    for row in rows:
        table.add_row(*(escape(printable(cell)) for cell in row))
    console.print(table)
