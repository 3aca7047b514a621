"""The page on capture states what is read of films of the article's crawl."""

import pytest

import filmed_crawl
from pages.stated import kept

KEPT = kept(filmed_crawl.NAME)


def test_the_crawl_that_is_filmed_does_what_is_kept_and_a_film_of_it_is_read_so():
    """Renew with ``python tools/filmed_crawl.py``."""
    record = filmed_crawl.filmed()
    assert filmed_crawl.simulated(record) == pytest.approx(KEPT["simulated"], rel=0.02, abs=0.01)
    assert filmed_crawl.commanded() == pytest.approx(KEPT["commanded"])
    for name, value in filmed_crawl.reading(record, 0).items():
        assert value == pytest.approx(KEPT["mean"][name], abs=4.0 * KEPT["std"][name] + 1e-9), name


@pytest.mark.parametrize(
    ("phase", "reference", "value"), [(0.98, 0.0, -0.02), (0.02, 0.0, 0.02), (-0.49, 0.5, 0.51), (0.49, 0.5, 0.49)]
)
def test_a_phase_is_told_by_the_value_next_to_a_reference(phase, reference, value):
    assert filmed_crawl.near(phase, reference) == pytest.approx(value)


@pytest.mark.validate
def test_all_films_are_read_as_is_kept():
    results = filmed_crawl.measured()
    for part in ("mean", "std"):
        assert results[part] == pytest.approx(KEPT[part], rel=0.02, abs=0.01)
