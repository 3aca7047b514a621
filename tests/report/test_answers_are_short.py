"""What stands beside the first figure of an outcome's page is an answer: two sentences that are read at once."""

import pytest

from evidence import store
from suchus.apps.report.outcome_page import answer
from suchus.experiments.catalog import EXPERIMENTS

MAX_WORDS = 80
LONG = {"fault_knowledge": 180, "joint_faults": 90, "spine_and_tail_map": 110, "swim_free": 110, "swimming": 110}
"""Answers of several models, joints or conditions, each with its number."""
OTHERWISE_STORED = {"policies"}
"""Experiments whose results are stored in another form than their measures."""


@pytest.mark.parametrize("name", sorted({*EXPERIMENTS} & {*store.names()} - OTHERWISE_STORED))
def test_an_answer_is_short(name):
    measures = store.load(name).values
    words = answer(EXPERIMENTS[name].explain(measures)).split()
    assert 5 <= len(words) <= LONG.get(name, MAX_WORDS)
