"""Put what ``python -m evidence.league`` predicted, and what became of it, into the documentation.

Usage: python tools/league_page.py OUT: reads the sealed predictions in OUT, as ``python -m evidence.league --out OUT``
left them, keeps the outcomes in results/league.json, and makes of these docs/league.md and its figure. Outcomes of
contestants that have no folder in OUT stay as they are kept. Without OUT the page is made again of what is kept.
"""

import json
import sys
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from evidence import renew, store
from evidence.league import every, find
from evidence.league.cases import CONTESTANTS, measured_file
from evidence.league.page import FIGURE, PAGE, LeagueEntry, all_standings, draw, page, standing_of, standing_text

DOCS = Path(__file__).parents[1] / "docs"
PICTURE = Path("pictures") / FIGURE


def kept() -> list[LeagueEntry]:
    """Return the outcomes that are kept."""
    return [standing_of(entry) for entry in store.load("league").values]


def text(standings: list[LeagueEntry]) -> str:
    """Return the page of the documentation."""
    return page(standings, PICTURE.as_posix())


def gated(entry: LeagueEntry) -> LeagueEntry:
    """Return kept outcomes with today's word on whether what was measured is a steady swim."""
    unsteadiness = find(CONTESTANTS, entry.name).find_unsteadiness
    if unsteadiness is None or not entry.measured:
        return entry
    values = {name: float(np.atleast_1d(one.value)[0]) for name, one in entry.measured.items()}
    return replace(entry, unsteadiness=unsteadiness(values))


def main(out: Path | None) -> None:
    """Write outcomes, page and figure.

    Args:
        out: folder of sealed predictions; None for those that are kept.
    """
    names = every(CONTESTANTS)
    standings = kept()
    if out is not None:
        contestants = [find(CONTESTANTS, name) for name in names]
        renewed = {one.name: one for one in all_standings(out, contestants, {n: measured_file(n) for n in names})}
        stored = {one.name: gated(one) for one in standings if one.name in names}
        standings = [entry for name in names if (entry := renewed.get(name, stored.get(name))) is not None]
        renew.store("league", json.loads(standing_text(standings)))
    (DOCS / PAGE).write_text(text(standings), encoding="utf-8")
    with TemporaryDirectory() as folder:
        (DOCS / PICTURE).write_bytes(draw(standings, Path(folder) / FIGURE).read_bytes())


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
