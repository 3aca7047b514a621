"""The table of docs/reliability.md that counts what the batteries did: run them and write it, ``make reliability``.

``python tools/reliability.py FILE ...`` runs those of some files of tests again, and ``--table`` writes the table of
what is kept, without running anything. A run that is interrupted changes nothing. The cases of the fuzzer are run by
``python tests/fuzz/long_form.py``, which takes much longer.
"""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from pages.passages import put

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "reliability.md"
KEPT, CASES = ROOT / "tests" / "batteries.json", ROOT / "tests" / "fuzz" / "long_form.json"
GUIDED = ROOT / "tests" / "fuzz" / "guided.json"
WAYS = {"blind": "blindly", "targets": "hypothesis' `target`", "atheris": "atheris"}
"""How cases are chosen, see ``tests/fuzz/guided.py``: first without guidance."""
PAYS = 1.1
"""How many times as many lines guided cases would have to reach to be worth their trouble [-]."""
BATTERIES = {
    "failed writes": (
        "every n-th open, write, close, rename, fsync, link and mkdir of a command fails; what was kept is whole, and "
        "the next run gives the same bytes",
        "swims that were forgotten before their result was saved; nothing fsynced; files left after exit code 2",
    ),
    "kills": (
        "processes of studies, searches, swims, sweeps and clusters are ended, most by SIGKILL; what was finished "
        "stays, and the end has the same bytes",
        "workers of `reproduce` that computed on; drafts that stayed",
    ),
    "flipped caches": (
        "kept kernels with flipped bits or cut are compiled anew, and give the right result",
        "a process that ended by SIGSEGV or SIGABRT until the cache was deleted by hand",
    ),
    "imitated processors": (
        "the same study, and values of the three libraries, on processors with and without fused multiply-add",
        "other bytes on another processor, and stores that mixed both without a word",
    ),
}
"""Of each battery what is done, and what it found, mended since."""
_FAILED = 1  # what pytest ends with where tests failed; other numbers say that it did not run them all
_FOUND = (
    "records in centimetres, degrees or milliseconds, with axes in another order or two variables exchanged, that were "
    "read as if they were in SI units"
)


def table(kept: Mapping[str, Mapping[str, Any]], cases: Mapping[str, Any]) -> str:
    """Return the table, a row for each battery.

    Args:
        kept: what each test did, see ``tests/batteries.py``.
        cases: results of the fuzzer's cases, see ``tests/fuzz/long_form.py``.
    """
    rows = ["| battery | what is done | how many | failed | run on | found, and mended since |"]
    rows.append("|---|---|---:|---:|---|---|")
    for name, (what, found) in BATTERIES.items():
        of = [one for one in kept.values() if one["battery"] == name]
        days = sorted({one["date"] for one in of}) or ["never"]
        when = days[0] if len(days) == 1 else f"{days[0]} to {days[-1]}"
        failed = sum(one["failed"] for one in of)
        rows.append(f"| {name} | {what} | {sum(one['number'] for one in of)} | {failed} | {when} | {found} |")
    what = f"hostile cases and cases that are nearly right, [{len(cases['kinds'])} kinds](#how-it-is-tested)"
    done = f"{cases['cases']} | {len(cases['failures'])} | {cases['date']}"
    return "\n".join([*rows, f"| fuzzer | {what} | {done} | {_FOUND} |"]) + "\n"


def guided(kept: Mapping[str, Mapping[str, Mapping[str, Any]]]) -> str:
    """Return what guidance by coverage is worth, a row for each number of cases.

    Args:
        kept: what each way reached, see ``tests/fuzz/guided.py``.
    """
    ways = [way for way in WAYS if way in kept]
    rows = [f"| cases | {' | '.join(WAYS[way] for way in ways)} |", f"|---:|{'---:|' * len(ways)}"]
    for count in sorted({int(count) for way in ways for count in kept[way]}):
        found = [kept[way].get(str(count)) for way in ways]
        told = [f"{one['lines']} lines, {one['robots'] / count:.0%} robots" if one else "" for one in found]
        rows.append(f"| {count} | {' | '.join(told)} |")
    ratios = [
        kept[way][count]["lines"] / kept[ways[0]][count]["lines"]
        for way in ways[1:]
        for count in kept[way].keys() & kept[ways[0]].keys()
    ]
    days = sorted({one["date"] for way in ways for one in kept[way].values()})
    best = f"at most {max(ratios):.2f} times as many as blind ones, where {PAYS:g} would be worth it"
    pays = max(ratios) >= PAYS
    verdict = "so they should be guided" if pays else "so the cases are drawn blindly, and most are nearly right"
    return "\n".join([*rows, "", f"On {' and '.join(days)} guided cases reached {best}: {verdict}."]) + "\n"


def write() -> None:
    """Write the passages of what is kept into the page."""
    kept, cases, ways = (json.loads(file.read_text(encoding="utf-8")) for file in (KEPT, CASES, GUIDED))
    passages = {"batteries": table(kept, cases), "guided": guided(ways)}
    PAGE.write_text(put(PAGE.read_text(encoding="utf-8"), passages), encoding="utf-8")


def tests() -> list[str]:
    """Return the files of the tests that count what they do."""
    files = sorted((ROOT / "tests").rglob("test_*.py"))
    return [str(file) for file in files if "@pytest.mark.battery(" in file.read_text(encoding="utf-8")]


def main(words: list[str]) -> int:
    """Run the batteries, unless only the table is asked for, and write it."""
    code = 0
    if "--table" not in words:
        with tempfile.TemporaryDirectory() as folder:
            made = Path(folder) / KEPT.name
            command = [sys.executable, "-m", "pytest", "-n0", "-m", "battery and not validate", *(words or tests())]
            environment = os.environ | {"SUCHUS_BATTERIES": str(made)}
            code = subprocess.run(command, cwd=ROOT, env=environment, check=False).returncode
            if code not in (0, _FAILED):
                return code
            before = json.loads(KEPT.read_text(encoding="utf-8")) if words else {}
            every = before | json.loads(made.read_text(encoding="utf-8"))
            KEPT.write_text(json.dumps(dict(sorted(every.items())), indent=1) + "\n", encoding="utf-8")
    write()
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
