"""The words of ``suchus reproduce`` beside those of whole runs: what the short forms leave out is to change none.

``python -m evidence.short_forms SHORT WHOLE`` reads the outcomes of ``suchus reproduce --out SHORT`` and of whole runs,
of ``suchus reproduce --all --out WHOLE`` or of ``suchus run NAME --out WHOLE`` for each experiment that judges a claim.
The outcome is the result ``short_forms`` of the store. It ends with 1 where a word differs.
"""

import argparse
import json
import sys
from pathlib import Path
from typing import Any

from suchus.core.errors import IncompatibleRecord
from suchus.experiments.claims import RULES

NAME = "short_forms"


def compared(short: Path, whole: Path) -> dict[str, Any]:
    """Return by experiment how many measures each form has, and the word of each claim in both: short, then whole.

    Args:
        short: folder of ``suchus reproduce``.
        whole: folder of whole runs.

    Raises:
        IncompatibleRecord: a claim has no word in one of them, or the whole run is none.
    """
    experiments: dict[str, Any] = {}
    for name in sorted({rule.experiment for rule in RULES.values()}):
        outcomes = [_outcome(folder / name) for folder in (short, whole)]
        if "--for-verdicts" in outcomes[1]["command"].split():
            raise IncompatibleRecord(f"{whole / name} was run in the short form; run suchus run {name} --out {whole}.")
        words = [{verdict["claim"]: verdict["verdict"] for verdict in outcome["verdicts"]} for outcome in outcomes]
        asked = [claim for claim, rule in RULES.items() if rule.experiment == name]
        missing = [claim for claim in asked if any(claim not in form for form in words)]
        if missing:
            raise IncompatibleRecord(f"{name} has no word on {', '.join(missing)} in {short} or in {whole}.")
        experiments[name] = {
            "measures": [float(len(outcome["measures"])) for outcome in outcomes],
            "words": {claim: [form[claim] for form in words] for claim in asked},
        }
    return experiments


def differing(experiments: dict[str, Any]) -> list[str]:
    """Return the claims whose words differ."""
    return [
        claim
        for entry in experiments.values()
        for claim, (short_word, whole_word) in entry["words"].items()
        if short_word != whole_word
    ]


def _outcome(folder: Path) -> Any:
    file = folder / "outcome.json"
    if not file.is_file():
        raise IncompatibleRecord(f"there is no {file}; run its experiment first.")
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except ValueError as error:
        raise IncompatibleRecord(f"{file} is damaged ({error}); run its experiment again.") from error


def main() -> int:
    """Compare both, keep the result, and print the claims whose words differ.

    Returns:
        0 if every word is the same, 1 if one differs, 2 if they cannot be compared.
    """
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("short", type=Path, help="folder of suchus reproduce")
    parser.add_argument("whole", type=Path, help="folder of whole runs")
    arguments = parser.parse_args()
    from evidence import renew  # noqa: PLC0415  the registry imports this module

    try:
        experiments = compared(arguments.short, arguments.whole)
    except IncompatibleRecord as error:
        print(f"short_forms: {error}", file=sys.stderr)
        return 2
    renew.store(NAME, experiments)
    for claim in differing(experiments):
        print(f"{claim}: another word in the short form")
    return 1 if differing(experiments) else 0


if __name__ == "__main__":
    sys.exit(main())
