"""What decides each verdict, and the result: a page made of the rules."""

import json
from pathlib import Path
from typing import Any

from suchus.experiments import EXPERIMENTS
from suchus.paper import AUTHORS, CLAIMS, TITLE
from suchus.verdict import SHARES, Rule, rules_of
from suchus.verdict.shares import ROBUST

_TABLE = Path(__file__).parents[2] / "docs" / "verdicts.json"
_KINDS = {
    "measured": "measured",
    "construction": "by construction",
    "fitted": "fitted",
    "animals": "said of animals",
}
_INTRODUCTION = f"""# Verdicts

{", ".join(AUTHORS)}: *{TITLE}*. What this article claims, the rule that decides each claim, and the verdict of the last
full `suchus reproduce`.

* **reproduced**: it came out, and the printed number, as rounded, lies within the repeats of ours.
* **same sense**: another number, but the statement holds; or the robot does what the article says of animals.
* **contradicted**: the statement does not hold here.
* **not testable**: nothing was measured that could decide.
* **fitted**: a number that the article does not give was chosen so that its result comes out.
* **by construction**: an input, a count or a commanded motion is read back.

*Fitted* and *by construction* are no evidence and are counted apart. A verdict is **fragile** if fewer than
{ROBUST:.0%} of the plausible designs of [`suchus study claims`](studies.md) agree with it.

A rule is data (`suchus.verdict.RULES`): a measure, clauses that all must hold, and for a printed number its rounding
and the spread of repeats. The tests hold measures on each side of every clause, and `make mutate` breaks every rule
in every way: clauses dropped, reversed, moved by a twentieth, kinds exchanged, roundings doubled. Each break must
change a word. A run that is too short to meet what is judged, or that is of another robot or gait, is not judged at
all.
"""


def page() -> str:
    """Return the page of all rules and verdicts."""
    shares: dict[str, Any] = json.loads(_TABLE.read_text(encoding="utf-8")) if _TABLE.is_file() else {}
    lines = [_INTRODUCTION]
    for name, experiment in EXPERIMENTS.items():
        if rules := rules_of(name):
            lines += [f"## {experiment.title}", "", f"`suchus run {name}`", ""]
            for rule in rules:
                lines += _entry(rule, shares.get(rule.claim))
    return "\n".join([*lines, ""])


def _entry(rule: Rule, shares: dict[str, Any] | None) -> list[str]:
    claim = CLAIMS[rule.claim]
    lines = [f"### {claim.quantity} {{#{rule.claim}}}", "", f"> {claim.quote} ({claim.where})", "", claim.sense, ""]
    if shares:
        word = shares["verdict"] + (", fragile" if shares["fragile"] else "")
        lines += [f"**{word}**", ""]
    printed = "" if claim.value is None else f"; printed {claim.value:g} ± {claim.rounding:g} {claim.unit}"
    lines += [f"* `{rule.measure}`, {_KINDS[rule.kind]}{printed}"]
    lines += [f"* {clause}" for clause in rule.holds]
    if rule.band is not None:
        lines += [f"* Spread: {rule.band.of}."]
    return [*lines, f"* {_swept(rule)}", ""]


def _swept(rule: Rule) -> str:
    share = SHARES.get(rule.claim)
    if share is None:
        return f"Not tried on other designs: {rule.unswept or 'the study has not answered it'}."
    turned = f"; best predicted by `{share.turned_by}`" if share.turned_by else ""
    return (
        f"Holds in {share.share:.1%} ({share.low:.1%} to {share.high:.1%}) of {share.designs} plausible "
        f"designs{turned}."
    )
