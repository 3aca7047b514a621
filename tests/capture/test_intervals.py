"""The intervals of animals whose films are hard to read hold the truth in 95 of 100 cases."""

import json

import intervals
import pytest
from menagerie import AILMENTS, ailing, counted
from scipy.stats import binom

from suchus.robot.design import LEGS


def binomial(found):
    """Refuse a quantity, or a duty factor with an ailment, whose intervals hold the truth too seldom (1 %)."""
    for name, told in found.items():
        if "hold" in told:
            assert told["hold"] >= binom.ppf(0.01, told["intervals"], 0.95), name


def test_the_page_states_what_was_read():
    """Renew with ``python tests/capture/intervals.py``."""
    told = json.loads(intervals.KEPT.read_text())
    assert intervals.page(told) == intervals.PAGE.read_text(encoding="utf-8")
    found = intervals.numbers(told)
    binomial(found)
    assert found["animals"]["read"] >= 0.9 * found["animals"]["asked"]


def test_what_is_counted_and_what_is_too_seldom():
    right, wrong = {f"duty_{leg}": (0.01, 0.02) for leg in LEGS}, {f"duty_{leg}": (0.03, 0.02) for leg in LEGS}
    found = counted({0: right | {"stride": (0.1, 0.2)}, 6: None, 7: wrong})
    assert found["animals"] == {"asked": 3, "read": 2}
    assert found["duty"] == pytest.approx({"intervals": 8, "hold": 4, "error": 0.02236, "width": 0.02}, rel=1e-3)
    assert found[f"{AILMENTS[0]}: animals"] == {"asked": 2, "read": 1}
    assert found[f"{AILMENTS[1]}: duty"]["hold"] == 0
    assert found["stride"]["intervals"] == 1
    with pytest.raises(AssertionError, match="duty"):
        binomial(found)
    text = intervals.passage(found)
    assert "3 of 200 were drawn, of which 2 could be read" in text
    assert f"| {AILMENTS[0]} | 1 of 2 | 4 of 4, 100 % |" in text


def test_noise_makes_no_trunk_longer():
    for seed in (2002, 2008):
        filmed = ailing(seed)  # 8 mm of noise on links of a quarter of the trunk
        assert filmed.tracks.trunk_length() == pytest.approx(filmed.animal.trunk, rel=0.02)


@pytest.mark.validate
def test_the_intervals_of_two_hundred_animals_that_are_hard_to_read_hold_the_truth():
    found = intervals.numbers(intervals.run())
    assert found["animals"]["asked"] == intervals.COUNT
    assert found["animals"]["read"] >= 0.9 * intervals.COUNT
    binomial(found)
