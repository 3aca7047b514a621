"""Put what a full ``suchus reproduce`` found, and the shelf's questions, into the documentation.

Usage: python tools/verdict_table.py OUT: reads OUT/NAME/outcome.json of every experiment, writes docs/verdicts.json,
and the summary into the README.
"""

import json
import sys
from collections import Counter
from pathlib import Path
from typing import Any

from suchus.errors import IncompatibleRecord
from suchus.experiments import EXPERIMENTS
from suchus.verdict import RULES
from suchus.verdict.judging import WORDS

ROOT = Path(__file__).parents[1]
TABLE = ROOT / "docs" / "verdicts.json"
README = ROOT / "README.md"
START, END = "<!-- verdicts: made by tools/verdict_table.py -->", "<!-- /verdicts -->"
QUESTIONS = "<!-- questions: made by tools/verdict_table.py -->", "<!-- /questions -->"
_KEPT = ("verdict", "measured", "low", "high", "unit", "fragile")
_TOLD = ("fitted", "by construction")


def collected(out: Path) -> dict[str, dict[str, Any]]:
    """Return what became of each claim, from a folder that ``suchus reproduce`` made.

    Raises:
        IncompatibleRecord: a claim has no verdict there.
    """
    found: dict[str, dict[str, Any]] = {}
    for file in sorted(out.glob("*/outcome.json")):
        for verdict in json.loads(file.read_text(encoding="utf-8"))["verdicts"]:
            found[verdict["claim"]] = {name: verdict[name] for name in _KEPT}
    missing = [claim for claim in RULES if claim not in found]
    if missing:
        raise IncompatibleRecord(f"{out} has no verdict on {', '.join(missing)}; run suchus reproduce in full first.")
    return {claim: found[claim] for claim in RULES}


def summary(table: dict[str, dict[str, Any]]) -> str:
    """Return the counts of the words as a paragraph of the README."""
    count = Counter(row["verdict"] for row in table.values())
    fragile = sum(row["fragile"] for row in table.values())
    judged = sum(count[word] for word in WORDS if word not in _TOLD)
    measured = ", ".join(f"{count[word]} {word}" for word in WORDS if word not in _TOLD)
    told = " and ".join(f"{count[word]} {word}" for word in _TOLD)
    return (
        f"Of {len(table)} claims of the article {judged} could come out either way: {measured}; {fragile} of these are "
        f"fragile, since more than one in ten plausible designs say otherwise. {told} agree because they were put in, "
        "and count for nothing."
    )


def questions() -> str:
    """Return the shelf of experiments as a table of the README."""
    rows = [f"| `{name}` | {one.title} | {one.shows} |" for name, one in EXPERIMENTS.items()]
    return "\n".join(["| experiment | question | article |", "|---|---|---|", *rows])


def written(readme: str, table: dict[str, dict[str, Any]]) -> str:
    """Return the README with summary and questions in their places."""
    return _between(_between(readme, START, END, summary(table)), *QUESTIONS, questions())


def _between(text: str, start: str, end: str, middle: str) -> str:
    before, _, rest = text.partition(start)
    return f"{before}{start}\n{middle}\n{end}{rest.partition(end)[2]}"


def main(out: Path) -> None:
    """Write table and README."""
    table = collected(out)
    TABLE.write_text(json.dumps(table, indent=1) + "\n", encoding="utf-8")
    README.write_text(written(README.read_text(encoding="utf-8"), table), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
