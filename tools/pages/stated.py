"""Passages of the pages that state what was measured, made from the measures.

``passages`` says how a passage is marked. What was measured is kept: of an experiment the
measures of its full form, of a search its outcome, both in ``tests/docs/stated``; the shares of the claims are those
that suchus ships. A test compares pages and measures; ``make validate`` compares the measures with new runs.

Usage: python tools/pages/stated.py OUTCOME.json ...: keep what these outcomes measured, and write the pages anew.
"""

import json
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1]))

from pages import (
    passages,
    stated_calibration,
    stated_faults,
    stated_flow,
    stated_land,
    stated_studies,
    stated_water,
)
from suchus.experiments import EXPERIMENTS

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
KEPT = ROOT / "tests" / "docs" / "stated"
SHARES = ROOT / "src" / "suchus" / "verdict" / "claims.json"
Make = Callable[[Mapping[str, Any]], str]
PASSAGES: Mapping[str, Mapping[str, Make]] = {
    **stated_calibration.PASSAGES,
    **stated_faults.PASSAGES,
    **stated_flow.PASSAGES,
    **stated_land.PASSAGES,
    **stated_studies.PASSAGES,
    **stated_water.PASSAGES,
}
"""What makes each passage, by what was measured."""
MADE: Mapping[str, tuple[str, Make]] = {
    name: (source, make) for source, makers in PASSAGES.items() for name, make in makers.items()
}
"""By passage: what was measured, and what makes the passage of it."""


def pages() -> list[Path]:
    """Return the pages that have passages of ours, README among them."""
    return [
        page
        for page in [*sorted(DOCS.glob("*.md")), ROOT / "README.md"]
        if set(passages.names(page.read_text("utf-8"))) & set(MADE)
    ]


def kept(source: str) -> dict[str, Any]:
    """Return what was measured by an experiment, a search, or the study of the claims."""
    place = SHARES if source == "claims" else KEPT / f"{source}.json"
    found: dict[str, Any] = json.loads(place.read_text(encoding="utf-8"))
    return found


def filled(page: str, instead: Mapping[str, Mapping[str, Any]] | None = None) -> str:
    """Return a page whose passages say what was measured, ``instead`` taking the place of measures, by source."""
    texts = {}
    for name in passages.names(page):
        if name in MADE:
            source, make = MADE[name]
            texts[name] = make(kept(source) | dict((instead or {}).get(source, {})))
    return passages.put(page, texts)


def keep(source: str, measured: Mapping[str, Any]) -> None:
    """Keep what was measured."""
    text = json.dumps(dict(sorted(measured.items())), indent=1, ensure_ascii=False)
    (KEPT / f"{source}.json").write_text(text + "\n", encoding="utf-8")


def measured(outcome: Mapping[str, Any]) -> tuple[str, Mapping[str, Any]]:
    """Return the name and what is kept of an outcome of an experiment or a search."""
    if "optimisation" in outcome:
        return f"optimise_{outcome['optimisation']}", outcome
    if outcome["experiment"] not in EXPERIMENTS:
        raise KeyError(outcome["experiment"])
    found = {name: one["value"] for name, one in outcome["measures"].items()}
    taken = outcome["experiment"] == "swimming" and any(name.endswith("_as_taken") for name in found)
    return outcome["experiment"] + "_taken" * taken, found


def main(files: Sequence[str]) -> None:
    """Keep what the outcomes measured, and write the pages anew."""
    for file in files:
        keep(*measured(json.loads(Path(file).read_text(encoding="utf-8"))))
    for page in pages():
        page.write_text(filled(page.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
