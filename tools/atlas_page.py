"""Write docs/atlas.md and its pictures from the outcomes of the atlas of flows.

Usage: python tools/atlas_page.py OUT [DOCS]: reads OUT/flows/*.json, which `suchus flow-atlas --out OUT` left, and
writes DOCS/atlas.md, by default docs/atlas.md, and DOCS/pictures/atlas_*.png.
"""

import shutil
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from lighter import lighten
from suchus.atlas import CASES, load_outcomes
from suchus.errors import IncompatibleRecord, SuchusError
from suchus.figures.atlas import write_atlas
from suchus.writing import MANIFEST

DOCS = Path(__file__).parents[1] / "docs"


def main(out: Path, docs: Path = DOCS) -> Path:
    """Write the page and return its place.

    Raises:
        IncompatibleRecord: there is no outcome, or there are trials among them, which belong on no page.
    """
    found = load_outcomes(out, CASES.values())
    if not found:
        raise IncompatibleRecord(f"{out} holds no outcomes of the atlas; run suchus flow-atlas --out {out} first.")
    trials = [name for name, outcome in found.items() if outcome.quick]
    if trials:
        raise IncompatibleRecord(f"{', '.join(trials)} in {out} are quick trials; run suchus flow-atlas in full first.")
    with TemporaryDirectory() as made:
        page = write_atlas(found, Path(made))
        for picture in sorted((Path(made) / "pictures").glob("atlas_*.png")):
            lighten(picture)
        shutil.copytree(made, docs, dirs_exist_ok=True, ignore=shutil.ignore_patterns(MANIFEST))
    return docs / page.name


if __name__ == "__main__":
    try:
        print(main(*(Path(word) for word in sys.argv[1:3])))
    except (SuchusError, TypeError) as error:
        sys.exit(f"atlas_page: {error if isinstance(error, SuchusError) else __doc__}")
