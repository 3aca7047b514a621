"""The page of the league says what its sealed outcomes say, and nothing of them was changed."""

import hashlib

import pytest

import league_page as tool
from suchus.contestants import CONTESTANTS
from suchus.errors import IncompatibleRecord
from suchus.league import every
from suchus.league.page import OUTCOMES, PAGE, page, standing_text, standings_of
from suchus.league.sealing import prediction_text

STANDINGS = standings_of(tool.DOCS / OUTCOMES)


def test_the_page_is_made_of_its_outcomes():
    assert (tool.DOCS / PAGE).read_text() == page(STANDINGS, tool.PICTURE)
    assert standing_text(STANDINGS) == (tool.DOCS / OUTCOMES).read_text()
    assert (tool.DOCS / tool.PICTURE).is_file()


def test_every_prediction_is_the_one_that_was_sealed():
    for one in STANDINGS:
        assert one.name in every(CONTESTANTS)
        text = prediction_text(one.units, one.prediction)
        assert hashlib.sha256(text.encode()).hexdigest() == one.seal.prediction


def test_a_folder_without_predictions_is_refused(tmp_path):
    with pytest.raises(IncompatibleRecord, match="no sealed prediction"):
        tool.main(tmp_path, tmp_path)
