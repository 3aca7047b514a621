"""Compute the table of drag and added mass of elliptic sections that ``water.sections`` reads.

``python tools/sections.py FOLDER [JOBS]``: flows that are in the folder, of the same set-up by the same code, are kept,
so that it may be stopped and begun again; then the table in the package is written anew.
"""

import sys
from pathlib import Path

from suchus.atlas import sections
from suchus.atlas.computing import FlowProgress, compute_all
from suchus.water.sections import write_table


def main(folder: Path, jobs: int) -> None:
    """Compute what is not there yet, and write the table."""

    def tell(said: FlowProgress) -> None:
        if said.outcome is not None:
            print(f"{said.case}: {said.outcome.seconds:.0f} s {said.outcome.failed}", flush=True)

    outcomes = compute_all(sections.cases(), folder, jobs=jobs, quick=False, tell=tell)
    print(write_table(outcomes))


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1)
