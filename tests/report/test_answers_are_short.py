"""What stands beside the hero of an outcome's page is an answer: a few sentences that are read at once."""

import pytest

from evidence import store
from suchus.apps.report.outcome_page import _sentences, answer
from suchus.experiments.catalog import EXPERIMENTS

MAX_WORDS = 80
MAX_SENTENCES = 3
OTHERWISE_STORED = {"policies"}
"""Experiments whose results are stored in another form than their measures."""


@pytest.mark.parametrize("name", sorted({*EXPERIMENTS} & {*store.names()} - OTHERWISE_STORED))
def test_an_answer_is_short(name):
    measures = store.load(name).values
    text = answer(EXPERIMENTS[name].explain(measures))
    assert 5 <= len(text.split()) <= MAX_WORDS
    assert 1 <= len(_sentences(text)) <= MAX_SENTENCES
