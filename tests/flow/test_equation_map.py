"""The page that maps terms to functions names functions that exist, and the step reads in their order."""

import importlib
import inspect
import re
from pathlib import Path

import pytest

from suchus.flow.water import Fluid

PAGE = (Path(__file__).parents[2] / "docs" / "flow_theory.md").read_text(encoding="utf-8")
TABLE = PAGE.split("## Which function computes what", 1)[1].split("\n## ", 1)[0]
ROWS = [line for line in TABLE.splitlines() if line.startswith("|")][2:]
NAMES = [name for row in ROWS for name in re.findall(r"`([a-z]+(?:\.\w+)+)`", row.rsplit(" | ", 1)[-1])]


def there(name):
    """What a dotted name of the room stands for; None if there is no such thing."""
    module, *inner = name.split(".")
    try:
        found = importlib.import_module(f"suchus.flow.{module}")
    except ModuleNotFoundError:
        return None
    for part in inner:
        found = getattr(found, part, None)
    return found


def test_every_row_names_a_function():
    assert len(ROWS) > 15
    for row in ROWS:
        assert re.search(r"`[a-z]+(?:\.\w+)+`", row.rsplit(" | ", 1)[-1]), row


@pytest.mark.parametrize("name", NAMES)
def test_the_functions_of_the_page_exist(name):
    assert callable(there(name)) or hasattr(there(name), "py_func")


def test_a_name_that_is_gone_would_be_noticed():
    assert there("water.Fluid.nothing") is None
    assert there("nowhere.nothing") is None


def test_a_stage_advances_projects_and_collects_in_this_order():
    for what, order in ((Fluid._stages, ["take", "collect"]), (Fluid._take, ["advance", "project"])):
        assert re.findall(r"self\._(take|advance|project|collect)\(", inspect.getsource(what)) == order
