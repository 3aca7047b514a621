"""The long form of the fuzzer: its cases, what came of them, and the passage of docs/reliability.md that says so.

``python tests/fuzz/long_form.py [COUNT]``; stopped early, what was run until then counts.
"""

import json
import re
import sys
import tempfile
import time
from collections import Counter
from datetime import date
from pathlib import Path
from typing import Any

from hostile import KINDS, Hang, Range

from suchus.record import code_digest, versions

FIRST, COUNT = 2_000, 50_000
"""Number of the first case, which is where those of the short form end, and how many there are."""
OUTCOME = Path(__file__).with_name("long_form.json")
PAGE = Path(__file__).parents[2] / "docs" / "reliability.md"
_PASSAGE = re.compile(r"(<!-- fuzz: made by tests/fuzz/long_form.py -->\n).*?(\n<!-- /fuzz -->)", re.DOTALL)
_EVERY = 250  # cases between two writings
_TOLD = ("suchus", "python", "mujoco", "numpy", "xarray", "h5netcdf")


def run(place: Path, count: int = COUNT, *, keep: bool = False) -> dict[str, Any]:
    """Run cases and return what came of them: dates, versions, counts, every failure.

    Args:
        place: an empty folder.
        count: how many cases.
        keep: whether it is written to ``OUTCOME`` and ``PAGE`` too, now and then and at the end.
    """
    cases, kinds, failures, longest = Range(place), Counter[str](), [], 0.0
    found: dict[str, Any] = {}
    begun = time.process_time()
    try:
        for number in range(FIRST, FIRST + count):
            before = time.process_time()
            try:
                cases.case(number)
            except (Exception, Hang) as error:
                told = f"{type(error).__name__}: {error}"[:300]
                failures.append({"case": number, "kind": KINDS[number % len(KINDS)].__name__, "error": told})
            kinds[KINDS[number % len(KINDS)].__name__] += 1
            longest = max(longest, time.process_time() - before)
            if keep and kinds.total() % _EVERY == 0:
                found = _found(kinds, failures, longest, begun)
                write(found)
    finally:
        found = _found(kinds, failures, longest, begun)
        if keep:
            write(found)
    return found


def _found(kinds: Counter[str], failures: list[dict[str, Any]], longest: float, begun: float) -> dict[str, Any]:
    return {
        "date": date.today().isoformat(),
        "versions": {name: version for name, version in versions().items() if name in _TOLD},
        "source": code_digest(".")[:12],
        "asked": COUNT,
        "cases": kinds.total(),
        "kinds": dict(sorted(kinds.items())),
        "failures": failures,
        "longest_seconds": round(longest, 1),
        "processor_seconds": round(time.process_time() - begun),
    }


def write(found: dict[str, Any]) -> None:
    """Write what came of the cases, and the passage of the page that says so."""
    OUTCOME.write_text(json.dumps(found, indent=1) + "\n")
    PAGE.write_text(_PASSAGE.sub(lambda old: old[1] + passage(found) + old[2], PAGE.read_text()))


def passage(found: dict[str, Any]) -> str:
    """Return the passage of the page."""
    made_by = ", ".join(f"{name} {version}" for name, version in found["versions"].items())
    rows = "\n".join(f"| {name.replace('_', ' ')} | {count} |" for name, count in found["kinds"].items())
    numbers = f"{found['cases']:,} of the {found['asked']:,}".replace(",", " ")
    return (
        f"Of the long form {numbers} cases have run, on {found['date']} with\n{made_by} (source {found['source']}).\n"
        f"**{len(found['failures'])}** of them failed. They took {found['processor_seconds']} s of a processor, the\n"
        f"longest {found['longest_seconds']} s.\n\n| kind | cases |\n|---|---|\n{rows}"
    )


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        came = run(Path(folder), int(sys.argv[1]) if len(sys.argv) > 1 else COUNT, keep=True)
    for failure in came["failures"]:
        print(failure)
