"""Put what ``suchus reproduce --all`` found into the documentation.

Usage: python tools/verdict_table.py OUT: reads OUT/NAME/outcome.json of every experiment, keeps the result
``verdicts``, and writes docs/verdicts.md and the summary of the README. With ``--part``
OUT may hold some experiments only: of the others what the documentation keeps is judged by the rules of today, and the
other rows stay.
"""

import json
import sys
from pathlib import Path
from typing import Any

from evidence import renew, store
from pages import article
from pages.stated import kept, templates, wrapped
from suchus.article.paper import CLAIMS
from suchus.article.verdict import SHARES, SPARSE_SHARES, Rule, judge, ladder
from suchus.article.verdict.judging import fragile, shown_unit
from suchus.core.errors import IncompatibleRecord
from suchus.experiments import time_steps
from suchus.experiments.claims import RULES, known_claims

ROOT = Path(__file__).parents[1]
NAME = "verdicts"
README = ROOT / "README.md"
PAGE = ROOT / "docs" / "verdicts.md"
_KEPT = ("verdict", "measured", "low", "high", "unit", "fragile", "models", "time_step", "why")


def collected(out: Path, *, part: bool = False) -> dict[str, dict[str, Any]]:
    """Return what became of each claim, from a folder of ``suchus reproduce --all``, in the order of the table before.

    Args:
        out: the folder.
        part: whether claims without an outcome there are judged by what is kept, or else keep the row that they have.

    Raises:
        IncompatibleRecord: a claim has no verdict.
    """
    before: dict[str, dict[str, Any]] = kept(NAME) if NAME in store.names() else {}
    found: dict[str, dict[str, Any]] = before | judged_again() if part else {}
    for file in sorted(out.glob("*/outcome.json")):
        for verdict in json.loads(file.read_text(encoding="utf-8"))["verdicts"]:
            found[verdict["claim"]] = {name: verdict[name] for name in _KEPT if verdict.get(name, "") not in ([], "")}
    for claim, row in found.items():  # of the rules and shares that ship today, whatever shipped when it was run
        row["unit"] = shown_unit(RULES[claim], CLAIMS[claim]) if claim in RULES else row["unit"]
        row["fragile"] = claim in RULES and fragile(
            RULES[claim], row["verdict"], SHARES.get(claim) or SPARSE_SHARES.get(claim)
        )
    missing = [claim for claim in RULES if claim not in found]
    if missing:
        raise IncompatibleRecord(f"{out} has no verdict on {', '.join(missing)}; run suchus reproduce --all first.")
    return {claim: found[claim] for claim in dict.fromkeys([*before, *RULES]) if claim in RULES}


def judged_again() -> dict[str, dict[str, Any]]:
    """Return what the rules of today say of the measures that the documentation keeps."""
    found = {}
    for rule in RULES.values():
        if rule.experiment in store.names():
            verdict = judge(rule, kept(rule.experiment))
            time_step = step_caution(rule)
            row: dict[str, Any] = {
                "verdict": verdict.verdict,
                "measured": verdict.measured,
                "low": verdict.low,
                "high": verdict.high,
            }
            models = ladder.rows(verdict.voices, rule.form)
            row |= {"unit": verdict.unit, "fragile": verdict.fragile, "why": verdict.why}
            row |= {"time_step": time_step} if time_step else {}
            found[rule.claim] = row | ({"models": models} if models else {})
    return found


def step_caution(rule: Rule) -> str:
    """Return which other words a rule has within the changes with the time step of the measures that are kept."""
    compared = time_steps.COMPARED.get(rule.experiment)
    if compared is None:
        return ""
    return time_steps.caution(rule, kept(rule.experiment), compared.changes, known_claims(rule.experiment))


def written(readme: str, table: dict[str, dict[str, Any]]) -> str:
    """Return the README with results and summary in their places, of the words in ``docs/stated/readme``."""
    content = article.front(table)
    for name in ("verdicts", "result"):
        text = templates().get_template(f"readme/{name}.md").render(root="docs/", **content)
        start, end = f"<!-- {name}: made by tools/verdict_table.py -->", f"<!-- /{name} -->"
        readme = _between(readme, start, end, wrapped(text, width=len(text)).rstrip("\n"))
    return readme


def _between(text: str, start: str, end: str, middle: str) -> str:
    before, _, rest = text.partition(start)
    return f"{before}{start}\n{middle}\n{end}{rest.partition(end)[2]}"


def main(out: Path, *, part: bool) -> None:
    """Write table, README and the page of the verdicts."""
    table = collected(out, part=part)
    (store.save_part if part else renew.store)(NAME, table)
    README.write_text(written(README.read_text(encoding="utf-8"), table), encoding="utf-8")
    PAGE.write_text(article.verdicts(table), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), part="--part" in sys.argv[2:])
