"""A file of a measurement is refused by its form before a prediction begins, and read after the seal."""

import json

import pytest

from evidence.league import every, find
from evidence.league.cases import CONTESTANTS
from evidence.league.command import main
from evidence.league.sealing import check_measured
from suchus.core.errors import UnreadableFile

NAME = next(iter(every(CONTESTANTS)))
QUANTITIES = find(CONTESTANTS, NAME).asking(()).predicts
QUANTITY, KIND = next(iter(QUANTITIES.items()))
GOOD = {"value": 2.0, "low": 1.0, "high": 3.0, "unit": KIND.unit, "source": "a ruler"}


@pytest.mark.parametrize(
    ("content", "says"),
    [
        ([], "holds a list; a table is needed"), (3, "holds a int; a table"),
        ({"none": GOOD}, "which is not predicted"),
        ({QUANTITY: [1]}, "a table of value, low, high"), ({QUANTITY: GOOD | {"source": ""}}, "says nothing of source"),
        ({QUANTITY: GOOD | {"unit": "furlong"}}, "convert it"), ({QUANTITY: GOOD | {"value": "two"}}, "finite numbers"),
        ({QUANTITY: GOOD | {"value": float("nan")}}, "finite numbers"),
        ({QUANTITY: GOOD | {"low": 2.5}}, "lies between"),
        ({QUANTITY: GOOD | {"high": [1.0, 2.0]}}, "as many of each"),
    ],
)  # fmt: skip
def test_a_file_that_measures_nothing_is_refused_before_any_work(content, says, tmp_path, capsys):
    file = tmp_path / "it.json"
    file.write_text(json.dumps(content))
    with pytest.raises(UnreadableFile, match=says):
        check_measured(QUANTITIES, file)
    assert main([NAME, "--out", str(tmp_path / "league"), "--measured", str(file)]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert not (tmp_path / "league").exists()


def test_a_measurement_is_taken(tmp_path):
    file = tmp_path / "it.json"
    file.write_text(json.dumps({QUANTITY: GOOD}))
    check_measured(QUANTITIES, file)
