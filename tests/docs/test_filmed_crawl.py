"""The page on capture states what is read of films of the article's crawl."""

import pytest

from evidence import filmed_crawl


@pytest.mark.parametrize(
    ("phase", "reference", "value"), [(0.98, 0.0, -0.02), (0.02, 0.0, 0.02), (-0.49, 0.5, 0.51), (0.49, 0.5, 0.49)]
)
def test_a_phase_is_told_by_the_value_next_to_a_reference(phase, reference, value):
    assert filmed_crawl.near(phase, reference) == pytest.approx(value)
