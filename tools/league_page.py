"""Put what ``python -m evidence.league`` predicted, and what became of it, into the documentation.

Usage: python tools/league_page.py OUT: reads the sealed predictions in OUT, as ``python -m evidence.league --out OUT``
left them, keeps the outcomes in results/league.json, and makes of these docs/league.md and its figure.
"""

import json
import sys
from pathlib import Path

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


def main(out: Path) -> None:
    """Write outcomes, page and figure."""
    names = every(CONTESTANTS)
    contestants = [find(CONTESTANTS, name) for name in names]
    standings = all_standings(out, contestants, {name: measured_file(name) for name in names})
    renew.store("league", json.loads(standing_text(standings)))
    (DOCS / PAGE).write_text(text(standings), encoding="utf-8")
    draw(standings, DOCS / PICTURE)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
