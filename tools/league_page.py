"""Put what ``suchus league`` predicted, and what became of it, into the documentation.

Usage: python tools/league_page.py OUT: reads the sealed predictions in OUT, as ``suchus league --out OUT`` left them,
keeps the outcomes in docs/league.json, and makes of these docs/league.md and its figure.
"""

import sys
from pathlib import Path

from suchus.contestants import CONTESTANTS, measured_file
from suchus.league import every, find
from suchus.league.page import FIGURE, OUTCOMES, PAGE, LeagueEntry, all_standings, draw, page, standing_text

DOCS = Path(__file__).parents[1] / "docs"
KEPT, PICTURE = DOCS / OUTCOMES, Path("pictures") / FIGURE


def text(standings: list[LeagueEntry]) -> str:
    """Return the page of the documentation."""
    return page(standings, PICTURE.as_posix())


def main(out: Path) -> None:
    """Write outcomes, page and figure."""
    names = every(CONTESTANTS)
    contestants = [find(CONTESTANTS, name) for name in names]
    standings = all_standings(out, contestants, {name: measured_file(name) for name in names})
    KEPT.write_text(standing_text(standings), encoding="utf-8")
    (DOCS / PAGE).write_text(text(standings), encoding="utf-8")
    draw(standings, DOCS / PICTURE)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
