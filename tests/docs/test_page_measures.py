"""What single pages state and no experiment measures: a new run of it gives what is kept."""

import math
from collections.abc import Mapping
from typing import Any

import pytest

import page_measures
from pages.stated import kept, made, sources

LONG = {"printed_direction"}
"""Sources that take more than seconds."""


def flat(value: Any, path: str = "") -> dict[str, float]:
    """Return all numbers of nested mappings and lists, by their paths."""
    if isinstance(value, Mapping | list):
        items = value.items() if isinstance(value, Mapping) else enumerate(value)
        return {name: number for key, one in items for name, number in flat(one, f"{path}.{key}").items()}
    return {path: float(value)}


def check(name: str) -> None:
    """Compare a source with a new run; renew with ``python tools/page_measures.py NAME``."""
    computed = flat(page_measures.SOURCES[name]())
    assert all(math.isfinite(number) for number in computed.values())
    assert computed == pytest.approx(flat(kept(name)), rel=0.02, abs=1e-3)


@pytest.mark.parametrize("name", sorted(set(page_measures.SOURCES) - LONG))
def test_what_is_measured_in_seconds_is_what_is_kept(name):
    check(name)


@pytest.mark.validate
@pytest.mark.parametrize("name", sorted(LONG))
def test_what_takes_longer_is_what_is_kept(name):
    check(name)


def test_every_source_is_stated_on_a_page():
    assert set(page_measures.SOURCES) <= {source for name in made() for source in sources(name)}
