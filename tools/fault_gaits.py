"""Keep the gaits that ``suchus optimise fault`` found in the package, for the experiment ``fault_knowledge``.

Usage: python tools/fault_gaits.py out/optimise/fault/result/outcome.json

It keeps of the outcome what the experiment reads, and what made it: seed, budget, versions, and the displacement at the
beginning and at the end of each search.
"""

import json
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from suchus.core.errors import SuchusError
from suchus.core.files import write
from suchus.experiments.catalog.fault_knowledge.searched import KEPT_SEARCHES, read_searches
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS

_KEPT = ("optimisation", "robot", "gait", "seed", "population", "duration", "timestep", "versions")
_DIGITS = 6  # significant digits of a number of a gait


def essentials(outcome: Mapping[str, Any]) -> dict[str, Any]:
    """Return what is kept of the outcome of a search: what made it, and the best gait of each condition."""
    arms = {}
    for name, arm in outcome["arms"].items():
        best = arm["best"][name]
        fields = {field: {"best": float(f"{number['best']:.{_DIGITS}g}")} for field, number in best["fields"].items()}
        arms[name] = {
            "tried": arm["tried"],
            "start": arm["start"],
            "best": {name: {"aims": best["aims"], "fields": fields}},
        }
    return {**{key: outcome[key] for key in _KEPT}, "arms": arms}


def main(paths: list[str]) -> int:
    """Keep the outcome of a search; return 2 where there is none."""
    if len(paths) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        searched = read_searches(paths[0], ROBOTS["caiman"], GAITS["belly_crawl"])
        outcome = json.loads(Path(paths[0]).read_text(encoding="utf-8"))
    except SuchusError as error:
        print(f"fault_gaits: {error}", file=sys.stderr)
        return 2
    write(KEPT_SEARCHES, json.dumps(essentials(outcome), indent=1, ensure_ascii=False) + "\n")
    print(f"{KEPT_SEARCHES}: {len(searched.gaits)} gaits, {searched.evaluations} candidates each")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
