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
from suchus.paper import CLAIMS
from suchus.verdict import RULES
from suchus.verdict.judging import WORDS

ROOT = Path(__file__).parents[1]
TABLE = ROOT / "docs" / "verdicts.json"
README = ROOT / "README.md"
START, END = "<!-- verdicts: made by tools/verdict_table.py -->", "<!-- /verdicts -->"
QUESTIONS = "<!-- questions: made by tools/verdict_table.py -->", "<!-- /questions -->"
RESULT = "<!-- result: made by tools/verdict_table.py -->", "<!-- /result -->"
_KEPT = ("verdict", "measured", "low", "high", "unit", "fragile")
_PUT_IN = ("fitted", "by construction")


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
    judged = sum(count[word] for word in WORDS if word not in _PUT_IN)
    measured = ", ".join(f"{count[word]} {word}" for word in WORDS if word not in _PUT_IN)
    counted = " and ".join(f"{count[word]} {word}" for word in _PUT_IN)
    return (
        f"Of {len(table)} claims of the article {judged} could come out either way: {measured}; {fragile} of these are "
        f"fragile, since more than one in ten plausible designs say otherwise. {counted} agree because they were put "
        "in, and count for nothing."
    )


def result(table: dict[str, dict[str, Any]]) -> str:
    """Return three results with the article's numbers and the words of their verdicts, as a list of the README."""

    def word(*claims: str) -> str:
        words = dict.fromkeys(f"{table[c]['verdict']}{', fragile' if table[c]['fragile'] else ''}" for c in claims)
        return f"**{'; '.join(words)}**"

    def ours(claim: str) -> float:
        return float(table[claim]["measured"])

    def printed(claim: str) -> float:
        return CLAIMS[claim].value or 0.0

    ratio, still, moving = "displacement_ratio", "fault_front_yaw_limbs_only", "fault_front_yaw_coordinated"
    spine = ours("swim_spine_thrust")
    return "\n".join(
        (
            f"* **{ours(ratio):.1f} times** as far with spine and tail as with limbs only, at identical leg commands "
            f"(article: {printed(ratio):.1f}): {word(ratio)}.",
            f"* **{-ours(moving):.0%} or {-ours(still):.0%}** of the displacement is gone with a failed front yaw "
            f"joint, with a moving and with a still trunk (article: {-printed(moving):.0%} and {-printed(still):.0%}): "
            f"{word(moving, still)}.",
            f"* **{abs(spine):.2f} m/s {'faster' if spine > 0 else 'slower'}** is the free swim with the swing of the "
            f"spine than without (article: the spine gives thrust): {word('swim_spine_thrust')}.",
        )
    )


def questions() -> str:
    """Return the shelf of experiments as a table of the README."""
    rows = [f"| `{name}` | {one.title} | {one.shows} |" for name, one in EXPERIMENTS.items()]
    return "\n".join(["| experiment | question | article |", "|---|---|---|", *rows])


def written(readme: str, table: dict[str, dict[str, Any]]) -> str:
    """Return the README with result, summary and questions in their places."""
    counted = _between(readme, START, END, summary(table))
    return _between(_between(counted, *RESULT, result(table)), *QUESTIONS, questions())


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
