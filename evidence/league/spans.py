"""Which unknown makes an interval wide: each number at its least and greatest value, all others as likely.

Usage: python -m evidence.league.spans OUT NAME ...: writes ``OUT/NAME/spans.json`` beside a sealed prediction, for the
page. Nothing of it is sealed or judged.
"""

import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from evidence.league.cases import CONTESTANTS
from evidence.league.contestant import Contestant, Found, find
from evidence.league.sealing import read_seal
from suchus.core.files import path_exists, read_json, write
from suchus.core.progress import silent
from suchus.swimming.water.speed_range import DEFAULT_MODEL

SPANS = "spans.json"
"""File in a contestant's folder."""
Spans = Mapping[str, tuple[float, float]]
"""Answer at the least and at the greatest value of each number, over the answer with all numbers as likely [-]."""


def spans_of(contestant: Contestant, model: str = DEFAULT_MODEL) -> Spans:
    """Return how far each unknown alone moves the first quantity of a contestant, the farthest first.

    A number with which the model gives no answer is left out.

    Args:
        contestant: who.
        model: rung that is asked.
    """
    unknown = [name for name, number in contestant.inputs.items() if number.high > number.low]
    choices = [contestant.likely]
    for name in unknown:
        number = contestant.inputs[name]
        choices += [contestant.likely | {name: number.low}, contestant.likely | {name: number.high}]
    quantity = next(iter(contestant.predicts))
    answers = [_number(found, quantity) for found in contestant.rungs[model].work(choices, silent)]
    ratios = {
        name: (answers[1 + 2 * i] / answers[0], answers[2 + 2 * i] / answers[0]) for i, name in enumerate(unknown)
    }
    sound = {name: ends for name, ends in ratios.items() if np.isfinite(ends).all()}
    return dict(sorted(sound.items(), key=lambda item: -abs(item[1][1] - item[1][0])))


def read_spans(folder: Path) -> dict[str, tuple[float, float]]:
    """Return the spans in a contestant's folder; none where they were not computed."""
    if not path_exists(folder / SPANS):
        return {}
    return {name: (float(low), float(high)) for name, (low, high) in read_json(folder / SPANS).items()}


def _number(found: Found, quantity: str) -> float:
    return float(np.atleast_1d(np.asarray(found.get(quantity, np.nan), float))[0])


def main(out: Path, names: Sequence[str]) -> None:
    """Compute and write the spans of contestants whose predictions are sealed.

    Args:
        out: folder of the league.
        names: contestants.
    """
    for name in names:
        read_seal(out / name)
        write(out / name / SPANS, json.dumps(spans_of(find(CONTESTANTS, name)), indent=1) + "\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2:])
