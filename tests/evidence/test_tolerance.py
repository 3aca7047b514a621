"""Ranges within which numbers mean the same: wide enough for another processor, and narrow enough for a change."""

import math

import pytest

from evidence import tolerance
from evidence.tolerance import bounded, moved, read

NUMBERS = {
    "rise": 1e-3,
    "fraction": 0.9,
    "fraction_low": 0.8,
    "fraction_high": 1.0,
    "radius_off": 0.073,
    "coupling_residual": 4.58e-3,
    "grounds": 3.0,
    "none": math.nan,
    "endless": math.inf,
    "zero": 0.0,
}


@pytest.mark.parametrize(
    ("name", "value", "noticed"),
    [
        ("rise", 1.1e-3, False),
        ("rise", 1.3e-3, True),
        ("rise", -1e-3, True),  # a millimetre down instead of up, which two millimetres would have allowed
        ("fraction", 1.05, False),
        ("fraction", 0.65, True),
        ("fraction_low", 0.65, False),
        ("radius_off", 0.0791, False),  # measured on two processors
        ("radius_off", 0.1, True),
        ("coupling_residual", 3.63e-3, False),  # measured on two processors
        ("coupling_residual", 9.5e-3, True),
        ("coupling_residual", 2.0e-3, True),
        ("grounds", 4.0, True),
        ("none", 0.0, True),
        ("endless", 1e9, True),
        ("zero", 1e-12, False),
        ("zero", 1e-6, True),
    ],
)
def test_a_number_notices_a_change_of_what_it_means(name, value, noticed):
    stored = bounded(NUMBERS)
    assert moved(stored, NUMBERS) == {}
    assert (name in moved(stored, NUMBERS | {name: value})) == noticed


def test_a_name_that_is_missing_or_new_is_noticed():
    stored = bounded(NUMBERS)
    assert list(moved(stored, {name: value for name, value in NUMBERS.items() if name != "rise"})) == ["rise"]
    assert list(moved(stored, NUMBERS | {"new": 1.0})) == ["new"]


def test_ranges_read_back_as_they_were_written():
    stored = bounded(NUMBERS)
    back = read({name: entry.plain() for name, entry in stored.items()})
    assert repr(back) == repr(stored)


def test_every_reason_is_explained():
    assert {entry.reason for entry in bounded(NUMBERS).values()} == set(tolerance.REASONS)
