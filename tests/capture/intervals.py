"""How often the intervals of ``suchus capture`` hold the truth, and the passage of docs/capture_evidence.md on it.

``python tests/capture/intervals.py [COUNT]``; stopped early, what was read until then counts, and the next call goes on
behind it if neither the reading nor the animals have changed.
"""

import hashlib
import json
import sys
from pathlib import Path
from typing import Any

from menagerie import AILMENTS, ailing, counted, read

from suchus.core.files import code_digest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tools"))
from pages.passages import put  # noqa: E402

FIRST, COUNT = 2000, 200
"""Number of the first animal of ``menagerie.ailing``, and how many there are."""
KEPT = Path(__file__).with_name("intervals.json")
PAGE = ROOT / "docs" / "capture_evidence.md"
READS = tuple(
    f"animals/capture/{name}.py"
    for name in (
        *("angles", "animal", "camera", "cycle", "exchange", "feet", "film", "late", "names", "pauses", "screen"),
        *("strides", "surface", "swings", "tracks", "walk"),
    )
)
"""What films are made and read with; the rest of the room reads no number."""
_NAMES = {
    "duty": "duty factor, four feet",
    "phase": "phase of three feet [cycle]",
    "period": "period [s]",
    "stride": "stride [trunk]",
    "stride_length": "stride [m]",
    "step": "step of four feet [m]",
    "speed": "speed [m/s]",
    "turning": "turning [rad per cycle]",
    "spine_lateral": "trunk's bend [rad]",
    "spine_rightmost": "spine rightmost [cycle]",
    "tail_lateral": "tail's bend [rad]",
    "tail_lag": "tail's lag [cycle]",
}


def run(count: int = COUNT) -> dict[str, Any]:
    """Read animals that are not read yet, keep what came of each, and return all."""
    told = kept()
    for seed in range(FIRST, FIRST + count):
        if str(seed) not in told["animals"]:
            found = read(ailing(seed))
            told["animals"][str(seed)] = found and {name: [f"{x:.3g}" for x in pair] for name, pair in found.items()}
            KEPT.write_text(json.dumps(told, indent=None, separators=(",", ":")).replace('},"', '},\n"') + "\n")
            PAGE.write_text(page(told))
    return told


def kept() -> dict[str, Any]:
    """Return what was read so far with the code that there is; nothing if it was other code."""
    animals = Path(__file__).with_name("menagerie.py").read_bytes()
    source = hashlib.sha256(code_digest(*READS).encode() + animals).hexdigest()[:12]
    told: dict[str, Any] = json.loads(KEPT.read_text()) if KEPT.exists() else {}
    return told if told.get("source") == source else {"source": source, "animals": {}}


def numbers(told: dict[str, Any]) -> dict[str, dict[str, float]]:
    """Return what became of the animals, see ``menagerie.counted``."""
    every = told["animals"].items()
    pairs = {int(seed): one and {name: tuple(map(float, two)) for name, two in one.items()} for seed, one in every}
    return counted(pairs)


def page(told: dict[str, Any]) -> str:
    """Return the page with the passage on these animals."""
    return put(PAGE.read_text(encoding="utf-8"), {"intervals": passage(numbers(told))})


def passage(found: dict[str, dict[str, float]]) -> str:
    """Return the passage: how many could be read, and two tables."""
    lines = [
        f"{found['animals']['asked']} of {COUNT} were drawn, of which {found['animals']['read']} could be read.",
        "",
    ]
    lines += ["| of all | intervals that hold the truth | error, root mean square | median of ± |", "|---|---|---|---|"]
    lines += [_row(text, found[name]) for name, text in _NAMES.items() if name in found]
    lines += ["", "| duty factor, by what goes wrong | could be read | intervals that hold the truth | error | ± |"]
    lines += ["|---|---|---|---|---|"]
    for ailment in AILMENTS:
        films, duty = found[f"{ailment}: animals"], found.get(f"{ailment}: duty")
        if duty:
            lines.append(_row(f"{ailment} | {films['read']} of {films['asked']}", duty))
    return "\n".join(lines) + "\n"


def _row(text: str, told: dict[str, float]) -> str:
    held = f"{told['hold']} of {told['intervals']}, {100 * told['hold'] / told['intervals']:.0f} %"
    return f"| {text} | {held} | {told['error']:.3f} | {told['width']:.3f} |"


if __name__ == "__main__":
    print(passage(numbers(run(int(sys.argv[1]) if len(sys.argv) > 1 else COUNT))))
