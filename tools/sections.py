"""Compute the table of drag and added mass of elliptic sections that ``water.sections`` reads.

``python tools/sections.py FOLDER [JOBS]``: flows that are in the folder, of the same set-up by the same code, are kept,
so that it may be stopped and begun again; then the table in the package and the page that states it are written anew.
"""

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from evidence.atlas import FlowOutcome, compute_all, sections
from pages.stated import keep
from pages.stated import main as write_pages
from suchus.swimming.water.sections import attached_coefficients, coefficients, held_out_errors, table


def stated() -> Mapping[str, Any]:
    """Return what the page states of the shipped table."""
    finer = {(one.aspect, one.keulegan): one for one in table()}  # the finer grid comes last
    round_, high = (finer[point] for point in sections.FINER)
    return {
        "drag": [[coefficients(a, k)[0] for k in sections.KEULEGANS] for a in sections.ASPECTS],
        "added": [[coefficients(a, k)[1] for k in sections.KEULEGANS] for a in sections.ASPECTS],
        "attached": [attached_coefficients(k)[0] for k in sections.KEULEGANS],
        "attached_added": attached_coefficients(1.0)[1],
        "attached_robot": attached_coefficients(5.0, 3600.0)[1],
        "held_out": float(held_out_errors().max()),
        "fine_round": [round_.drag, round_.added_mass],
        "published_round": list(sections.measured()),
        "fine_high": [high.drag, high.added_mass],
        "left": max(one.residual for one in table()),
    }


def main(folder: Path, jobs: int) -> None:
    """Compute what is not there yet, and write the table."""

    def tell(outcome: FlowOutcome) -> None:
        print(f"{outcome.case}: {outcome.seconds:.0f} s {outcome.failed}", flush=True)

    outcomes = compute_all(sections.cases(), folder, jobs=jobs, quick=False, finished=tell)
    print(sections.write_table(outcomes))
    keep("sections", stated())
    write_pages()


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1)
