"""The fuzzer; see docs/reliability.md. ``hostile.py`` holds the cases."""

import os
from collections import Counter

import pytest
from hostile import KINDS, Range

SHORT, LONG = 2_000, 50_000


@pytest.fixture(scope="session")
def place(tmp_path_factory):
    return Range(tmp_path_factory.mktemp("fuzz"))


@pytest.mark.parametrize("part", range(8))
def test_two_thousand_hostile_cases_end_in_a_result_or_a_sentence(place, part):
    for number in range(part, SHORT, 8):
        _run(place, number)


@pytest.mark.validate
def test_fifty_thousand_hostile_cases(place):
    count = int(os.environ.get("SUCHUS_FUZZ", LONG))
    kinds = Counter(_run(place, SHORT + number) for number in range(count))
    print(f"\n{count} hostile cases: " + ", ".join(f"{n} {name}" for name, n in sorted(kinds.items())))
    assert set(kinds) == {kind.__name__ for kind in KINDS}


def _run(place, number):
    try:
        return place.case(number)
    except BaseException as error:
        error.add_note(f"case {number}: {KINDS[number % len(KINDS)].__name__}")
        raise
