"""The page of the league states the outcomes that are kept, and these are what was sealed."""

from hashlib import sha256

import pytest

import league_page
from evidence.league import every, find
from evidence.league.cases import CONTESTANTS
from evidence.league.page import PAGE
from evidence.league.sealing import prediction_text

KEPT = league_page.kept()


def test_the_page_is_made_of_the_outcomes_that_are_kept():
    text = (league_page.DOCS / PAGE).read_text(encoding="utf-8")
    assert text == league_page.text(KEPT)
    other = [KEPT[0].__class__(**{**{name: getattr(KEPT[0], name) for name in KEPT[0].__slots__}, "title": "Else"})]
    assert text != league_page.text(other + KEPT[1:])


@pytest.mark.parametrize("one", KEPT, ids=[one.name for one in KEPT])
def test_what_is_kept_is_what_was_sealed(one):
    told = prediction_text(one.units, one.prediction)
    assert sha256(told.encode()).hexdigest() == one.seal.prediction
    assert one.seal.contestant == one.name


def test_everyone_on_the_shelf_is_on_the_page():
    assert [one.name for one in KEPT] == list(every(CONTESTANTS))
    for one in KEPT:
        contestant = find(CONTESTANTS, one.name)
        assert dict(one.units) == {name: quantity.unit for name, quantity in contestant.predicts.items()}
        assert set(one.seal.refused) | {rung for rungs in one.prediction.values() for rung in rungs} >= set(
            contestant.rungs
        )
