"""The fuzzer; see docs/reliability.md. ``hostile.py`` holds the cases, ``long_form.py`` those that take long."""

import json
import os
import time

import pytest
from hostile import KINDS, Hang, Range
from long_form import COUNT, FIRST, OUTCOME, PAGE, passage, run


@pytest.fixture(scope="session")
def place(tmp_path_factory):
    return Range(tmp_path_factory.mktemp("fuzz"))


@pytest.mark.parametrize("part", range(8))
def test_two_thousand_hostile_cases_end_in_a_result_or_a_sentence(place, part):
    for number in range(part, FIRST, 8):
        try:
            place.case(number)
        except BaseException as error:
            error.add_note(f"case {number}: {KINDS[number % len(KINDS)].__name__}")
            raise


def test_what_waits_is_a_hang_and_what_the_code_raises_passes(place, monkeypatch):
    def waits(place, dice):
        time.sleep(60.0)

    def breaks(place, dice):
        raise IndexError("a bare one")

    monkeypatch.setattr("hostile.PATIENCE", 0.2)
    monkeypatch.setattr("hostile._LOOK", 0.1)
    monkeypatch.setattr("hostile.KINDS", (waits, breaks))
    with pytest.raises(Hang, match="waits"):
        place.case(0)
    with pytest.raises(IndexError, match="bare"):
        place.case(1)


def test_the_page_says_what_the_long_form_found():
    found = json.loads(OUTCOME.read_text())
    assert passage(found) in PAGE.read_text()
    assert found["cases"] == sum(found["kinds"].values()) <= found["asked"] == COUNT
    assert set(found["kinds"]) == {kind.__name__ for kind in KINDS}
    assert f"**{len(found['failures'])}** of them failed" in PAGE.read_text()


@pytest.mark.validate
def test_fifty_thousand_hostile_cases(tmp_path):
    count = int(os.environ.get("SUCHUS_FUZZ", COUNT))
    found = run(tmp_path, count, keep=count >= json.loads(OUTCOME.read_text())["cases"])
    assert (found["cases"], found["failures"]) == (count, [])
