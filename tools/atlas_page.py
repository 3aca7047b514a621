"""Write docs/atlas.md and its pictures from the outcomes of the atlas of flows.

Usage: python tools/atlas_page.py OUT [DOCS]: reads OUT/flows/*.json, which `python -m evidence.atlas --out OUT` left,
and writes DOCS/atlas.md, by default docs/atlas.md, and DOCS/pictures/atlas_*.png. Into docs it also keeps what other
pages state of the rows, and writes their passages anew.
"""

import shutil
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from typing import Any

from evidence.atlas import CASES, GRIDS, ROWS, load_outcomes, published
from evidence.atlas.page import Entry, entries, write_atlas
from lighter import lighten
from pages.stated import keep
from pages.stated import main as write_pages
from suchus.core.errors import IncompatibleRecord, SuchusError
from suchus.core.writing import MANIFEST

DOCS = Path(__file__).parents[1] / "docs"


def stated(listed: Sequence[Entry]) -> Mapping[str, Any]:
    """Return what pages state of the rows: of each its numbers, and which differ by more than their grids explain."""
    rows = {
        entry.row.name: {
            "rms": found.rms,
            "over_range": found.over_range,
            "own": found.source_error,
            "bound": found.bound,
            "scatter": found.scatter,
            "cells": entry.outcome.cells,
            "grids": 1 + len(entry.coarser),
            "agrees": found.agrees,
            "index": entry.convergence.uncertainty,
            "order": entry.convergence.order,
            "refused": entry.convergence.refusal,
            "turning": entry.convergence.turning,
            "cycles": [min(found.cycles), max(found.cycles)] if found.cycles else [],
            "ours": dict(zip(_names(entry), found.computed.tolist(), strict=True))
            if entry.row.kind == "numbers"
            else {},
        }
        for entry in listed
        if entry.outcome is not None and (found := entry.comparison) is not None
    }
    known = {name: row for name, row in rows.items() if row["index"] is not None}
    costs = {one.flow: one.seconds for entry in listed if entry.outcome for one in (entry.outcome, *entry.coarser)}
    return {
        "rows": rows,
        "median": median(row["rms"] for row in rows.values()),
        "median_index": median(row["index"] for row in known.values()) if known else None,
        "minutes": sum(costs.values()) / 60,
        "converged": sorted(known),
        "beyond": sorted(name for name, row in known.items() if row["rms"] > row["index"]),
        "within": sorted(name for name, row in known.items() if row["rms"] <= row["index"]),
        "short": sorted(name for name, row in rows.items() if row["grids"] < GRIDS),
        "refused": sorted(set(rows) - set(known)),
        "turning": sorted(name for name, row in known.items() if row["turning"] > 0.5),
    }


def _names(entry: Entry) -> tuple[str, ...]:
    return published(entry.row.data).columns["quantity"]


def main(out: Path, docs: Path = DOCS) -> Path:
    """Write the page and return its place.

    Raises:
        IncompatibleRecord: there is no outcome, or there are trials among them, which belong on no page.
    """
    found = load_outcomes(out, CASES.values())
    if not found:
        raise IncompatibleRecord(
            f"{out} holds no outcomes of the atlas; run python -m evidence.atlas --out {out} first."
        )
    trials = [name for name, outcome in found.items() if outcome.quick]
    if trials:
        raise IncompatibleRecord(
            f"{', '.join(trials)} in {out} are quick trials; run python -m evidence.atlas in full first."
        )
    with TemporaryDirectory() as made:
        page = write_atlas(found, Path(made))
        for picture in sorted((Path(made) / "pictures").glob("atlas_*.png")):
            lighten(picture)
        shutil.copytree(made, docs, dirs_exist_ok=True, ignore=shutil.ignore_patterns(MANIFEST))
    if docs == DOCS:
        keep("atlas", stated(entries(tuple(ROWS.values()), found)))
        write_pages()
    return docs / page.name


if __name__ == "__main__":
    try:
        print(main(*(Path(word) for word in sys.argv[1:3])))
    except (SuchusError, TypeError) as error:
        sys.exit(f"atlas_page: {error if isinstance(error, SuchusError) else __doc__}")
