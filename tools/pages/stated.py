"""Passages of the pages that state what was measured: their words in ``docs/stated``, their numbers filled in by name.

A passage stands between ``<!-- stated: NAME -->`` and ``<!-- end -->`` of a page; its words are the Jinja template
``docs/stated/NAME.md``, in which ``{{ swim_3d.speed:.3f }}`` is a measure of the experiment ``swim_3d``, written as in
the explanations of the experiments themselves (``experiments.experiment.templates``). What was measured is kept: of an
experiment the measures of its full form, of a search its outcome, see ``results`` and ``evidence.registry``. A test
compares pages and results. ``make stale`` tells which results are old, and ``make renew`` computes them again.

Usage: python tools/pages/stated.py: write the passages of all pages anew.
"""

import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from math import floor, log10
from pathlib import Path
from textwrap import fill
from typing import Any

from jinja2 import Environment, meta

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from evidence import converge, renew, store
from pages import passages
from suchus.article.paper import AUTHORS, CLAIMS, TITLE
from suchus.article.verdict import SHARES, SPARSE_SHARES, judge, ladder
from suchus.article.verdict.judging import ROBUST
from suchus.experiments import experiment
from suchus.experiments.catalog import EXPERIMENTS
from suchus.experiments.catalog.policies.figure import condition_label
from suchus.experiments.claims import RULES, UNRULED, claims_of, known_claims

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
WORDS = DOCS / "stated"
WIDTH = 118


def three_digits(value: float) -> str:
    """Return a number to three digits, and to whole ones from a hundred on."""
    return f"{value:.0f}" if abs(value) >= 100.0 else f"{value:.{max(0, 2 - floor(log10(abs(value) or 1.0)))}f}"


def explained(experiment: str, measures: Mapping[str, float]) -> str:
    """Return what an experiment's report says decided it."""
    return EXPERIMENTS[experiment].explain(measures)


def asked(experiment: str, measures: Mapping[str, float]) -> list[dict[str, Any]]:
    """Return the claims that several models are asked: key, quantity, word, a row of each model."""
    found = []
    for rule in EXPERIMENTS[experiment].rules():
        verdict = judge(rule, measures, {})
        rows = ladder.rows(verdict.voices, rule.form)
        named = [row | {"name": voice.rung.name} for row, voice in zip(rows, verdict.voices, strict=True)]
        told = {"claim": rule.claim, "quantity": verdict.claim.quantity, "word": verdict.verdict, "rows": named}
        found.append(told | {"contested": ladder.contested(verdict.voices)})
    return found


def judged(experiment: str, measures: Mapping[str, float]) -> list[dict[str, str]]:
    """Return the claims that an experiment states itself: the statement, the word, the interval and the reason."""
    claims, verdicts = claims_of(experiment), []
    for rule in EXPERIMENTS[experiment].rules():
        if rule.claim in claims:
            verdict = judge(rule, measures, claims=claims)
            ends = [f"{measures[f'{rule.measure}{end}']:+.2f}" for end in ("_low", "_high")]
            unit = "" if claims[rule.claim].unit == "-" else f" {claims[rule.claim].unit}"
            verdicts.append(
                {
                    "sense": claims[rule.claim].sense,
                    "word": verdict.verdict,
                    "interval": f"{ends[0]} to {ends[1]}{unit}",
                    "why": verdict.why,
                }
            )
    return verdicts


def numbers(measures: Mapping[str, float], start: str, end: str = "") -> list[float]:
    """Return the numbers that names of measures hold between start and end, ``0_03`` for 0.03, in order."""
    between = (name.removeprefix(start).removesuffix(end) for name in measures if name[: len(start)] == start)
    return sorted(float(text.replace("_", ".")) for text in between if re.fullmatch(r"\d+(_\d+)?", text))


def greatest(measures: Mapping[str, float], start: str) -> float:
    """Return the greatest of the measures whose names begin so."""
    return max(value for name, value in measures.items() if name.startswith(start))


def naturally(names: Iterable[str]) -> list[str]:
    """Return names in order, numbers in them by their size."""
    return sorted(names, key=lambda name: [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)])


@cache
def templates() -> Environment:
    """Return where the words of the passages come from."""
    environment = experiment.templates(WORDS)
    environment.filters["three_digits"] = three_digits
    environment.globals |= {"article": CLAIMS, "experiments": EXPERIMENTS, "explained": explained, "asked": asked,
                            "judged": judged,
                            "beyond_said": converge.beyond_said, "said": converge.said, "unsaid": converge.UNSAID,
                            "numbers": numbers, "known_claims": known_claims,
                            "greatest": greatest, "naturally": naturally,
                            "condition_label": condition_label}  # fmt: skip
    return environment


@cache
def sources(passage: str) -> tuple[str, ...]:
    """Return the names of what a passage states measures of: experiments, searches, the study of the claims."""
    environment, text = templates(), (WORDS / f"{passage}.md").read_text(encoding="utf-8")
    named = meta.find_undeclared_variables(environment.parse(text))
    return tuple(sorted(named - set(environment.globals)))


def made() -> list[str]:
    """Return the names of all passages whose words we have."""
    return sorted(file.stem for file in WORDS.glob("[a-z]*.md"))


def pages() -> list[Path]:
    """Return the pages that have passages of ours, README among them."""
    return [
        page
        for page in [*sorted(DOCS.glob("*.md")), ROOT / "README.md"]
        if set(passages.names(page.read_text("utf-8"))) & set(made())
    ]


def kept(source: str) -> dict[str, Any]:
    """Return the numbers of a result of the store; of the validation its rows, by case and quantity."""
    values: Any = store.load(source).values
    return validation_rows(values) if source == "validation" else values


def validation_rows(listed: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return the rows of the flow solver's validation, by case and quantity: ``ours``, ``theirs`` and ``grid``.

    Args:
        listed: the rows as they are kept.
    """
    rows: dict[str, Any] = {}
    for row in listed:
        rows.setdefault(row["case"], {})[row["quantity"]] = {name: row[name] for name in ("ours", "theirs", "grid")}
    return rows


def text_of(passage: str, instead: Mapping[str, Mapping[str, Any]] | None = None) -> str:
    """Return a passage as it says what was measured, ``instead`` taking the place of measures, by source."""
    measured = {name: kept(name) | dict((instead or {}).get(name, {})) for name in sources(passage)}
    return wrapped(templates().get_template(f"{passage}.md").render(measured))


def filled(page: str, instead: Mapping[str, Mapping[str, Any]] | None = None) -> str:
    """Return a page whose passages say what was measured, ``instead`` taking the place of measures, by source."""
    ours = set(made())
    return passages.put(page, {name: text_of(name, instead) for name in passages.names(page) if name in ours})


def wrapped(text: str, width: int = WIDTH) -> str:
    """Return Markdown with paragraphs and items filled, tables as they are, and one empty line between blocks."""
    blocks = (block.strip("\n") for block in re.split(r"\n\s*\n", text))
    return "\n\n".join(block if block[0] == "|" else _filled(block, width) for block in blocks if block) + "\n"


def _filled(block: str, width: int) -> str:
    """Return a paragraph, or items each of which begins a line, in lines of a width."""
    items = [" ".join(item.split()) for item in re.split(r"\n(?=[*-] )", block)]
    return "\n".join(
        fill(item, width, subsequent_indent="  " * (item[:2] in ("* ", "- ")), break_long_words=False,
             break_on_hyphens=False) for item in items
    )  # fmt: skip


def _of_today(rows: Mapping[str, Any]) -> dict[str, Any]:
    """Return the fractions of designs that today's rules judged; what another rule judged says nothing."""
    return {claim: row for claim, row in rows.items() if claim in RULES and row.rule == RULES[claim].asked}


def page(name: str, **content: Any) -> str:
    """Return a whole page that is made of what the catalogs hold, its words in ``docs/stated/pages``."""
    known = {"authors": AUTHORS, "title": TITLE, "robust": ROBUST, "unruled": UNRULED, "rules": RULES}
    known |= {"shares": _of_today(SHARES), "too_few": _of_today(SPARSE_SHARES)}
    return templates().get_template(f"pages/{name}.md").render(known | content) + "\n"


def keep(source: str, measured: Mapping[str, Any]) -> None:
    """Keep what was measured by the code of today."""
    renew.store(source, dict(sorted(measured.items())))


def main() -> None:
    """Write the passages of all pages anew."""
    for page in pages():
        page.write_text(filled(page.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
