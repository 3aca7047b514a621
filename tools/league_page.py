"""Write docs/league.md, its figure and the outcomes that it is made of, from the sealed predictions of the league.

Usage: python tools/league_page.py OUT [DOCS]: reads OUT/*/prediction.json and seal.json, which `suchus league --out
OUT` left, opens what was measured, and writes DOCS/league.md, DOCS/league.json and DOCS/pictures/league.png.
"""

import sys
from pathlib import Path

from lighter import lighten
from suchus.contestants import CONTESTANTS, measured_file
from suchus.errors import SuchusError
from suchus.league import every, find
from suchus.league.page import FIGURE, OUTCOMES, PAGE, all_standings, draw, page, standing_text

DOCS = Path(__file__).parents[1] / "docs"
PICTURE = f"pictures/{FIGURE}"


def main(out: Path, docs: Path = DOCS) -> Path:
    """Write the page and return its place.

    Raises:
        IncompatibleRecord: no prediction is sealed there.
        UnreadableFile: a prediction was changed after it had been sealed.
    """
    names = every(CONTESTANTS)
    found = all_standings(
        out, [find(CONTESTANTS, name) for name in names], {name: measured_file(name) for name in names}
    )
    lighten(draw(found, docs / PICTURE))
    (docs / OUTCOMES).write_text(standing_text(found), encoding="utf-8")
    (docs / PAGE).write_text(page(found, PICTURE), encoding="utf-8")
    return docs / PAGE


if __name__ == "__main__":
    try:
        print(main(*(Path(word) for word in sys.argv[1:3])))
    except (SuchusError, TypeError) as error:
        sys.exit(f"league_page: {error if isinstance(error, SuchusError) else __doc__}")
