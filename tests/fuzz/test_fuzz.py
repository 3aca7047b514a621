"""The fuzzer; see docs/reliability.md. ``hostile.py`` holds the cases, ``long_form.py`` those that take long."""

import json
import os
import time

import long_form
import pytest
from hostile import KINDS, Hang, Range
from long_form import COUNT, FIRST, OUTCOME, PAGE, passage, run


@pytest.fixture(scope="session")
def place(tmp_path_factory):
    return Range(tmp_path_factory.mktemp("fuzz"))


REST = pytest.mark.slow("seven eighths of 2 000 cases")


@pytest.mark.parametrize("part", [0, *(pytest.param(part, marks=REST) for part in range(1, 8))])
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


def test_the_long_form_goes_on_where_it_stopped_but_not_on_other_code(tmp_path, monkeypatch):
    numbers = []

    class Cases:
        def __init__(self, place):
            pass

        def case(self, number):
            numbers.append(number)
            if number == FIRST + 2:
                raise IndexError("a bare one")
            if number == FIRST + 4 and len(numbers) == 5:
                raise KeyboardInterrupt

    monkeypatch.setattr(long_form, "Range", Cases)
    for name in ("OUTCOME", "PROGRESS", "PAGE"):
        monkeypatch.setattr(long_form, name, tmp_path / name)
    long_form.PAGE.write_text(PAGE.read_text())
    long_form.OUTCOME.write_text('{"cases": 5}')
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path, 6, keep=True)
    first = long_form.kept()
    assert (first["cases"], [one["case"] for one in first["failures"]]) == (4, [FIRST + 2])
    assert long_form.PAGE.read_text() == PAGE.read_text()  # which tells of more cases
    found = run(tmp_path, 6, keep=True, so_far=first)
    assert numbers == [*range(FIRST, FIRST + 5), FIRST + 4, FIRST + 5]
    assert (found["cases"], found["failures"]) == (6, first["failures"])
    assert json.loads(long_form.OUTCOME.read_text()) == found
    assert "Of the long form 6 of the 50 000 cases" in long_form.PAGE.read_text()
    monkeypatch.setattr(long_form, "code_digest", lambda room: "other")
    assert long_form.kept() is None


@pytest.mark.validate
def test_fifty_thousand_hostile_cases(tmp_path):
    count = int(os.environ.get("SUCHUS_FUZZ", COUNT))
    before = long_form.kept()
    so_far = before if before and before["cases"] <= count else None
    found = run(tmp_path, count, keep=True, so_far=so_far)
    assert (found["cases"], found["failures"]) == (count, [])
