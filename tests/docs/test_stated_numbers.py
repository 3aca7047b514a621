"""What the pages state was measured, and a new run measures it again."""

import copy
import math
from collections.abc import Iterator, Mapping
from itertools import islice
from typing import Any

import pytest

from evidence.renew import measures_of
from pages.passages import names
from pages.stated import filled, kept, made, pages, sources, text_of, wrapped
from suchus.core.errors import IncompatibleRecord
from suchus.experiments.experiment import write

STATED = {source: [name for name in made() if source in sources(name)] for name in made() for source in sources(name)}
"""Passages by what was measured."""


@pytest.fixture(scope="module")
def texts() -> dict[str, str]:
    return {page.name: page.read_text(encoding="utf-8") for page in pages()}


def test_the_pages_state_what_was_measured(texts):
    """Renew with ``python tools/pages/stated.py``, after the measures themselves."""
    for name, text in texts.items():
        assert filled(text) == text, name


def test_every_passage_stands_on_one_page(texts):
    placed = [name for name in names("".join(texts.values())) if name in made()]
    assert sorted(placed) == made()
    assert all(sources(name) for name in made())


@pytest.mark.parametrize(
    ("value", "form", "text"),
    [(0.1234, ".2f", "0.12"), (-0.001, ".0%", "0%"), (0.001, "+.0%", "+0%"), (0.0123, "mm.1f", "12.3"),
     (-1e-9, ".0e", "-1e-09"), (3.14159265, "deg.0f", "180")],
)  # fmt: skip
def test_a_number_is_written_as_it_is_named(value, form, text):
    assert write(value, form) == text


def test_paragraphs_and_items_are_filled_and_tables_are_not():
    row = f"| {'a ' * 80}|"
    text = f"{row}\n{row}\n\n\n{'word ' * 30}\n\n* {'item ' * 30}\n* short\n"
    lines = wrapped(text).splitlines()
    assert lines[:3] == [row, row, ""]
    assert max(len(line) for line in lines[3:]) <= 118
    assert [line[:2] for line in lines[6:]] == ["* ", "  ", "* "]


def _numbers(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the paths of all finite numbers but whole ones, which a count would be."""
    if isinstance(value, Mapping | list):
        items = value.items() if isinstance(value, Mapping) else enumerate(value)
        for key, one in items:
            yield from _numbers(one, (*path, key))
    elif isinstance(value, float) and math.isfinite(value):
        yield path


def _changed(value: Any, path: tuple[Any, ...]) -> Any:
    changed = copy.deepcopy(value)
    part = changed
    for key in path[:-1]:
        part = part[key]
    part[path[-1]] = part[path[-1]] * 3.0 + 0.3
    return changed


@pytest.mark.parametrize("source", list(STATED))
def test_other_numbers_make_other_passages(source):
    """A passage that no measure changes would be prose."""
    before = kept(source)
    texts = [text_of(name) for name in STATED[source]]
    changed = (
        [text_of(name, {source: _changed(before, path)}) for name in STATED[source]] for path in _numbers(before)
    )
    assert len(list(islice((other for other in changed if other != texts), 2))) == 2


def test_a_measure_that_is_no_number_is_kept_as_none():
    measures = {"speed_free": {"value": 0.1}, "slip": {"value": None}}
    outcome = {"experiment": "swimming", "differs": [], "measures": measures}
    name, found = measures_of(outcome)
    assert (name, found["speed_free"]) == ("swimming", 0.1)
    assert math.isnan(found["slip"])


def test_what_ran_in_another_form_is_kept_by_the_name_of_the_form_or_refused():
    for name, differs in (("swim_free", []), ("swim_free_space", [{"name": "water", "value": "space"}])):
        assert measures_of({"experiment": "swim_free", "differs": differs, "measures": {}}) == (name, {})
    other = {"experiment": "swim_free", "differs": [{"name": "cells", "value": 32}], "measures": {}}
    with pytest.raises(IncompatibleRecord, match="no result is kept of swim_free with other settings of cells"):
        measures_of(other)
