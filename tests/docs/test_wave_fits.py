"""The page on swimming states how near the joints come to the body wave."""

import pytest

import wave_fits
from pages.stated import kept


@pytest.mark.slow("eight waves are fitted by least squares")
def test_what_the_page_states_is_what_the_fits_give():
    """Renew with ``python tools/wave_fits.py``."""
    found, held = wave_fits.stated(), kept(wave_fits.NAME)
    assert found["servos"] == held["servos"]
    assert list(found["rows"]) == list(held["rows"])
    for called, row in found["rows"].items():
        assert row["misfit"] == pytest.approx(held["rows"][called]["misfit"], rel=1e-3), called
        assert row["bends"] == pytest.approx(held["rows"][called]["bends"], abs=1e-3), called
