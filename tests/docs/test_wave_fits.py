"""The page on swimming states how near the joints come to the body wave."""

import pytest

import wave_fits
from pages.stated import kept


def test_what_the_page_states_is_what_the_fits_give():
    """Renew with ``python tools/wave_fits.py``."""
    found, held = wave_fits.stated(), kept(wave_fits.NAME)
    assert found["servos"] == held["servos"]
    assert list(found["rows"]) == list(held["rows"])
    for called, row in found["rows"].items():
        told = held["rows"][called]
        assert (row["misfit"] is None) == (told["misfit"] is None), called
        assert row["bends"] == pytest.approx(told["bends"], abs=1e-3), called
        assert row["misfit"] is None or row["misfit"] == pytest.approx(told["misfit"], rel=1e-3), called
