"""Passages of the pages that state what was measured: their words in ``docs/stated``, their numbers filled in by name.

A passage stands between ``<!-- stated: NAME -->`` and ``<!-- end -->`` of a page; its words are the Jinja template
``docs/stated/NAME.md``, in which ``{{ swim_3d.speed:.3f }}`` is a measure of the experiment ``swim_3d``, written as in
the explanations of the experiments themselves (``suchus.experiment.templates``). What was measured is kept: of an
experiment the measures of its full form, of a search its outcome, both in ``tests/docs/stated``; ``claims`` are the
shares that suchus ships. A test compares pages and measures; another, which ``make validate`` runs, compares the
measures with new runs.

Usage: python tools/pages/stated.py OUTCOME.json ...: keep what these outcomes measured, and write the pages anew.
"""

import json
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from math import floor, log10, nan
from pathlib import Path
from textwrap import fill
from typing import Any

from jinja2 import Environment, meta

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from pages import passages
from suchus import experiment
from suchus.experiments import EXPERIMENTS
from suchus.paper import AUTHORS, CLAIMS, TITLE
from suchus.verdict import RULES, SHARES, TOO_FEW, UNRULED, Verdict, counted, judge, ladder
from suchus.verdict.judging import ROBUST

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
WORDS = DOCS / "stated"
KEPT = ROOT / "tests" / "docs" / "stated"
CLAIM_SHARES = ROOT / "src" / "suchus" / "verdict" / "claims.json"
VERDICTS = DOCS / "verdicts.json"
VALIDATION = DOCS / "validation.json"
WIDTH = 118
FORMS: Mapping[str, tuple[str, Mapping[str, Any]]] = {
    **{name: (name, {}) for name in EXPERIMENTS},
    "swim_free_space": ("swim_free", {"water": "space"}),
    "swim_free_space_slow": ("swim_free", {"water": "space", "frequency": 0.5, "reynolds": 3500.0}),
}
"""What is run for measures that are kept, by source: experiments as they are, and with settings that pages state."""


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
                            "numbers": numbers,
                            "greatest": greatest, "naturally": naturally}  # fmt: skip
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
    """Return what was measured by an experiment, a search, the study of the claims, or the validation."""
    if source == "validation":
        return validation_rows()
    place = CLAIM_SHARES if source == "claims" else KEPT / f"{source}.json"
    found: dict[str, Any] = json.loads(place.read_text(encoding="utf-8"))
    return found


def validation_rows() -> dict[str, Any]:
    """Return the rows of the flow solver's validation, by case and quantity: ``ours`` and ``theirs``."""
    rows: dict[str, Any] = {}
    for row in json.loads(VALIDATION.read_text(encoding="utf-8")):
        values = {"ours": row["ours"], "theirs": row["theirs"], "grid": row["grid"]}
        rows.setdefault(row["case"], {})[row["quantity"]] = values
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


def elsewhere() -> dict[str, Verdict]:
    """Return the verdicts on the design that was searched for, of the claims whose control group walks only there."""
    measures = kept("lifted_design")
    asked = (rule for rule in RULES.values() if rule.control and rule.control.needs)
    return {rule.claim: judge(rule, measures, {}) for rule in asked if rule.needs <= set(measures)}


def page(name: str, **content: Any) -> str:
    """Return a whole page that is made of what the shelves hold, its words in ``docs/stated/pages``."""
    verdicts = json.loads(VERDICTS.read_text(encoding="utf-8")) if VERDICTS.is_file() else {}
    known = {"authors": AUTHORS, "title": TITLE, "robust": ROBUST, "shares": SHARES, "too_few": TOO_FEW,
             "verdicts": verdicts, "elsewhere": elsewhere(), "unruled": UNRULED,
             "rules": RULES, "servo_loads": kept("servo_loads"),
             "count": counted({claim: row["verdict"] for claim, row in verdicts.items()},
                              [claim for claim, row in verdicts.items() if row["fragile"]])}  # fmt: skip
    return templates().get_template(f"pages/{name}.md").render(known | content) + "\n"


def keep(source: str, measured: Mapping[str, Any]) -> None:
    """Keep what was measured."""
    text = json.dumps(dict(sorted(measured.items())), indent=1, ensure_ascii=False)
    (KEPT / f"{source}.json").write_text(text + "\n", encoding="utf-8")


def measured(outcome: Mapping[str, Any]) -> tuple[str, Mapping[str, Any]]:
    """Return the name and what is kept of an outcome of an experiment, in one of the ``FORMS``, or of a search."""
    if "optimisation" in outcome:
        return f"optimise_{outcome['optimisation']}", outcome
    form = outcome["experiment"], {one["name"]: one["value"] for one in outcome["differs"]}
    source = next((name for name, one in FORMS.items() if (one[0], _written(one[1])) == form), None)
    if source is None:
        raise KeyError(" ".join([form[0], *form[1]]))
    values = {name: one["value"] for name, one in outcome["measures"].items()}
    return source, {name: nan if value is None else value for name, value in values.items()}


def _written(settings: Mapping[str, Any]) -> dict[str, str]:
    """Return settings as an outcome says how they differ from the shelf's."""
    return {name: f"{value:g}" if isinstance(value, float) else str(value) for name, value in settings.items()}


def main(files: Sequence[str]) -> None:
    """Keep what the outcomes measured, and write the pages anew."""
    for file in files:
        keep(*measured(json.loads(Path(file).read_text(encoding="utf-8"))))
    for page in pages():
        page.write_text(filled(page.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
