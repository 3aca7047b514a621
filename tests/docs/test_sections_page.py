"""The page on water and land states what is in the shipped table of sections."""

import numpy as np
import pytest

import sections
from pages.stated import kept


def test_what_the_page_states_is_what_the_table_holds():
    """Renew with ``python tools/sections.py``."""
    found, held = sections.stated(), kept("sections")
    assert sorted(found) == sorted(held)
    for name, values in found.items():
        assert np.asarray(held[name]) == pytest.approx(np.asarray(values)), name
