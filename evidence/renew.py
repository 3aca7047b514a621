"""Compute kept results again: ``make renew NAME="turning swim_3d"``.

Usage: python -m evidence.renew NAME [OUTCOME.json]

An experiment is run in full here. A search, a study or an experiment that ran elsewhere is taken from the
``outcome.json`` or ``claims.json`` that it left. Of every other result the command that computes it is printed. The
pages that state the result are written anew.
"""

import json
import sys
import time
from collections.abc import Mapping, Sequence
from math import nan
from pathlib import Path
from typing import Any

from evidence import source
from evidence.registry import FORMS, RESULTS
from evidence.store import Origin, StoredResult, save
from suchus.core.errors import IncompatibleRecord, SuchusError


def store(name: str, values: Any, seconds: float | None = None) -> Path:
    """Keep a result that the code of this checkout computed on this machine, with its probe, and return its file.

    Args:
        name: of the result.
        values: the numbers.
        seconds: processor time of the computation [s]; None where it was not measured.

    Raises:
        IncompatibleRecord: there is no result of that name.
    """
    if name not in RESULTS:
        raise IncompatibleRecord(f"there is no result named {name!r}; add it to evidence/registry.py first.")
    kept = RESULTS[name]
    code = source.digest(source.reached(kept.modules)) if kept.modules else ""
    result = StoredResult(name=name, values=values, origin=Origin.here(seconds), source=code, probe=kept.bounded())
    return save(result)


def measures_of(outcome: Mapping[str, Any]) -> tuple[str, Any]:
    """Return the name and the numbers of a result from an outcome of an experiment in one of its forms, or of a search.

    Raises:
        IncompatibleRecord: no result has the settings of the outcome.
    """
    if "optimisation" in outcome:
        return f"optimise_{outcome['optimisation']}", outcome
    if "claims" in outcome and "agreement" in outcome:
        return "claims", outcome
    form = outcome["experiment"], {entry["name"]: entry["value"] for entry in outcome["differs"]}
    name = next((key for key, (of, settings) in FORMS.items() if (of, _texts(settings)) == form), None)
    if name is None:
        raise IncompatibleRecord(
            f"no result is kept of {form[0]} with other settings of {', '.join(form[1])}; run it as it is, or add the "
            "form to evidence/registry.py."
        )
    values = {key: measure["value"] for key, measure in outcome["measures"].items()}
    return name, {key: nan if value is None else value for key, value in sorted(values.items())}


def _texts(settings: Mapping[str, Any]) -> dict[str, str]:
    """Return settings as an outcome says how they differ from the catalogue's."""
    return {name: f"{value:g}" if isinstance(value, float) else str(value) for name, value in settings.items()}


def main(words: Sequence[str]) -> int:
    """Compute or take results; return 2 where a word is none of these."""
    for word in words:
        if not word.endswith(".json") and word not in RESULTS:
            print(f"There is no result named {word!r}; choose among {', '.join(RESULTS)}.", file=sys.stderr)
            return 2
    for word in words:
        try:
            if word.endswith(".json"):
                print(store(*measures_of(json.loads(Path(word).read_text(encoding="utf-8")))))
            elif (compute := RESULTS[word].compute) is not None:
                began = time.process_time()
                values = compute()
                print(store(word, values, time.process_time() - began))
            else:
                print(f"{word} is computed by: {RESULTS[word].renew}")
        except (SuchusError, OSError, ValueError, KeyError) as error:
            print(f"renew: {word}: {error}", file=sys.stderr)
            return 2
    from pages import stated  # noqa: PLC0415  the pages are written from what was stored just now

    stated.main()
    return 0


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))
    sys.exit(main(sys.argv[1:]))
