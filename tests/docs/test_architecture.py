"""The page on the architecture names files and functions that are there, and every wing."""

import ast
import re
from pathlib import Path

import pytest

import suchus
from pages.code import SOURCE, wings

PAGE = (Path(__file__).parents[2] / "docs" / "architecture.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| [^|]+ \| `([\w/]+\.py)` \| `(\w+)` \|$", PAGE, re.M)


def defined(file):
    """Return the names that a module defines at its top."""
    names = set()
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            names.add(node.name)
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        names |= {target.id for target in targets if isinstance(target, ast.Name)}
    return names


@pytest.mark.parametrize(("file", "name"), ROWS)
def test_what_the_table_names_is_there(file, name):
    assert name in defined(SOURCE / file)


def test_the_table_has_twenty_rows_and_the_picture_every_wing():
    assert len(ROWS) == 20
    picture = PAGE.partition("```")[2].partition("```")[0]
    assert set(re.findall(r"^   (\w+)|(?<= )(hardware|flow)  ", picture, re.M)) != set()
    assert {wing for wing in wings() if f" {wing} " not in picture} == set()


@pytest.mark.parametrize("library", ["mujoco", "numba", "matplotlib"])
def test_libraries_are_imported_where_the_page_says(library):
    (cell,) = re.findall(rf"^\| `{library}` \| (.*) \|$", PAGE, re.M)
    places = [name for name in re.findall(r"`([\w.]+)`", cell) if " " not in name]
    importing = [
        ".".join(file.relative_to(SOURCE).with_suffix("").parts)
        for file in SOURCE.rglob("*.py")
        if re.search(rf"^\s*(?:import|from) {library}\b", file.read_text(encoding="utf-8"), re.M)
    ]
    assert [module for module in importing if not any(f"{module}.".startswith(f"{place}.") for place in places)] == []
    assert [place for place in places if not any(f"{module}.".startswith(f"{place}.") for module in importing)] == []


@pytest.mark.parametrize("wing", wings())
def test_each_wing_says_what_it_is_for_and_where_to_start(wing):
    text = ast.get_docstring(ast.parse((SOURCE / wing / "__init__.py").read_text(encoding="utf-8"))) or ""
    assert 0 < len(text.splitlines()) <= 30
    assert "Start reading with " in text


def test_no_wing_hides_a_name_of_the_package():
    """Importing ``suchus.swim`` as a wing would put a module where ``suchus.swim(...)`` is taught."""
    assert {*wings()} & {*suchus.__all__} == set()
