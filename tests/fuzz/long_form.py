"""The long form of the fuzzer: its cases, what came of them, and the passage of docs/reliability.md that says so.

``python tests/fuzz/long_form.py [COUNT]``; stopped early, what was run until then counts, and the next call goes on
behind it if neither suchus nor the cases have changed. The cases run in processes of their own, see ``farm.py``.
``python tests/fuzz/long_form.py --again`` runs those that failed once more, after they were mended, and ``--kind NAME``
those of one kind, after that became another.
"""

import hashlib
import json
import re
import sys
import tempfile
from collections import Counter
from datetime import date
from pathlib import Path
from typing import Any

from doors import Doors
from farm import alone, carried_out, kind_of

from suchus.core.files import code_digest, versions

COUNT = 100_000
"""How many cases there are."""
OUTCOME = Path(__file__).with_name("long_form.json")
PAGE = Path(__file__).parents[2] / "docs" / "reliability.md"
PROGRESS = Path(__file__).parents[2] / "build" / "long_form.json"
"""What was found so far, also while it is less than what ``OUTCOME`` holds of other code."""
_PASSAGE = re.compile(r"(<!-- fuzz: made by tests/fuzz/long_form.py -->\n).*?(\n<!-- /fuzz -->)", re.DOTALL)
_EVERY = 250  # numbers between two writings
_TOLD = ("suchus", "python", "mujoco", "numpy", "xarray", "h5netcdf")
_CASES = tuple(Path(__file__).with_name(name) for name in ("hostile.py", "doors.py", "farm.py"))


def run(place: Path, count: int = COUNT, *, keep: bool = False, so_far: dict[str, Any] | None = None) -> dict[str, Any]:
    """Run cases and return what came of them: dates, versions, counts, every failure.

    Args:
        place: an empty folder.
        count: how many cases; a batch of which each is judged counts as so many.
        keep: whether it is written to files too, now and then and at the end, see ``write``.
        so_far: what an earlier call found in the first of them, see ``kept``; they are not run again.
    """
    found = {**_about(), "next": 0, "failures": [], "longest_seconds": 0.0, "processor_seconds": 0.0, **(so_far or {})}
    found |= {"date": date.today().isoformat(), "failures": [*found["failures"]]}
    found |= {name: Counter(found.get(name, {})) for name in ("kinds", "refused")}
    try:
        for came in carried_out(Doors(place), range(found["next"], count)):
            if found["kinds"].total() >= count:
                break
            if came.error:
                found["failures"].append({"case": came.number, "kind": came.kind, "error": came.error})
            found["kinds"][came.kind] += came.count
            found["refused"][came.kind] += came.count * came.refused
            found["next"] = came.number + 1
            found["longest_seconds"] = max(found["longest_seconds"], came.seconds)
            found["processor_seconds"] += came.seconds
            if keep and found["next"] % _EVERY == 0:
                write(_rounded(found))
    finally:
        if keep:
            write(_rounded(found))
    return _rounded(found)


def again(place: Path, found: dict[str, Any]) -> dict[str, Any]:
    """Run the cases again that failed, and return what was found with those that pass now among the mended ones.

    Args:
        place: an empty folder.
        found: what ``run`` found; its cases are those of today, since a number means nothing else.
    """
    failed = {one["case"]: one for one in found["failures"]}
    other = [number for number, one in failed.items() if kind_of(number).__name__ != one["kind"]]
    if other:
        raise ValueError(f"cases {other} are others than those that failed")
    came = {one.number: one.error for one in carried_out(Doors(place), list(failed))}
    mended = [{**one, "source": _about()["source"]} for number, one in failed.items() if not came[number]]
    left = [{**one, "error": came[number]} for number, one in failed.items() if came[number]]
    return {**found, "failures": left, "mended": [*found.get("mended", []), *mended]}


def renewed(place: Path, found: dict[str, Any], kind: str) -> dict[str, Any]:
    """Return what was found with the cases of one kind run again, as it is now.

    Args:
        place: an empty folder.
        found: what ``run`` found.
        kind: whose cases.
    """
    numbers = [number for number in range(found["next"]) if kind_of(number).__name__ == kind]
    came = list(carried_out(Doors(place), numbers))
    about = {name: _about()[name] for name in ("date", "source")}
    failures = [{"case": one.number, "kind": kind, "error": one.error} for one in came if one.error]
    refused = {**found["refused"], kind: sum(one.count * one.refused for one in came)}
    return _rounded(
        {
            **found,
            "kinds": Counter({**found["kinds"], kind: sum(one.count for one in came)}),
            "refused": refused,
            "failures": [*(one for one in found["failures"] if one["kind"] != kind), *failures],
            "renewed": {**found.get("renewed", {}), kind: about},
            "longest_seconds": max(found["longest_seconds"], *(one.seconds for one in came)),
            "processor_seconds": found["processor_seconds"] + sum(one.seconds for one in came),
        }
    )


def kept() -> dict[str, Any] | None:
    """Return what an earlier call found, if it was of the same code and versions; None otherwise."""
    about = {name: value for name, value in _about().items() if name != "date"}
    for file in (PROGRESS, OUTCOME):
        found: dict[str, Any] = json.loads(file.read_text()) if file.exists() else {}
        if all(found.get(name) == value for name, value in about.items()):
            return found
    return None


def _about() -> dict[str, Any]:
    """Return when and with which code and versions cases are run."""
    return {
        "date": date.today().isoformat(),
        "versions": {name: version for name, version in versions().items() if name in _TOLD},
        "source": hashlib.sha256(code_digest(".").encode() + b"".join(f.read_bytes() for f in _CASES)).hexdigest()[:12],
        "asked": COUNT,
    }


def _rounded(found: dict[str, Any]) -> dict[str, Any]:
    """Return what was found as it is kept."""
    return {
        **found,
        "cases": found["kinds"].total(),
        "kinds": dict(sorted(found["kinds"].items())),
        "refused": {kind: found["refused"][kind] for kind in sorted(found["kinds"])},
        "longest_seconds": round(found["longest_seconds"], 1),
        "processor_seconds": round(found["processor_seconds"]),
    }


def write(found: dict[str, Any]) -> None:
    """Write what came of the cases, and the passage of the page that says so unless it tells of more cases."""
    text = json.dumps(found, indent=1) + "\n"
    PROGRESS.parent.mkdir(exist_ok=True)
    PROGRESS.write_text(text)
    if found["cases"] >= json.loads(OUTCOME.read_text())["cases"]:
        OUTCOME.write_text(text)
        PAGE.write_text(_PASSAGE.sub(lambda old: old[1] + passage(found) + old[2], PAGE.read_text()))


def passage(found: dict[str, Any]) -> str:
    """Return the passage of the page."""
    made_by = ", ".join(f"{name} {version}" for name, version in found["versions"].items())
    kinds = found["kinds"].items()
    refused, cases, asked = found["refused"], *(f"{found[name]:,}".replace(",", " ") for name in ("cases", "asked"))
    begin = f"Of the long form {cases}" + f" of the {asked}" * (found["cases"] < found["asked"])
    rows = "\n".join(f"| {name.replace('_', ' ')} | {count} | {count - refused[name]} |" for name, count in kinds)
    renewed = "".join(
        f"Those of the kind {kind.replace('_', ' ')} ran again on {about['date']} (source {about['source']}).\n"
        for kind, about in found.get("renewed", {}).items()
    )
    passed = found["cases"] - sum(refused.values())
    mended = [f"case {one['case']} ({one['kind'].replace('_', ' ')})" for one in found.get("mended", [])]
    told = ""
    if mended:
        source = found["mended"][-1]["source"]
        told = f"{len(mended)} more had failed, were mended and pass (source {source}): {', '.join(mended)}.\n"
    return (
        f"{begin} cases have run, on {found['date']} with\n{made_by} (source {found['source']}).\n"
        f"{renewed}{passed} of them got through the door and did what they asked for, the others ended in a sentence.\n"
        f"**{len(found['failures'])}** of them failed. {told}They took {found['processor_seconds']} s of a processor, "
        f"the\nlongest {found['longest_seconds']} s.\n\n| kind | cases | through the door |\n|---|---|---|\n{rows}"
    )


if __name__ == "__main__":
    alone()
    with tempfile.TemporaryDirectory() as folder:
        if "--again" in sys.argv:
            came = again(Path(folder), json.loads(OUTCOME.read_text()))
            write(came)
        elif "--kind" in sys.argv:
            came = renewed(Path(folder), json.loads(OUTCOME.read_text()), sys.argv[sys.argv.index("--kind") + 1])
            write(came)
        else:
            came = run(Path(folder), int(sys.argv[1]) if len(sys.argv) > 1 else COUNT, keep=True, so_far=kept())
    for failure in came["failures"]:
        print(failure)
    sys.exit(1 if came["failures"] else 0)
