"""What commands take from the viewer's pages is there: they are imported late, so that no type checker sees it."""

import ast
from pathlib import Path

import suchus.apps.cli
from suchus.apps.viewer import pages

FOLDER = Path(suchus.apps.cli.__file__).parent


def taken(source):
    """Return the attributes of ``pages`` that a source reads."""
    nodes = (node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Attribute))
    return {node.attr for node in nodes if isinstance(node.value, ast.Name) and node.value.id == "pages"}


def test_every_name_that_commands_take_from_the_pages_is_there():
    named = {name for file in FOLDER.glob("*.py") for name in taken(file.read_text(encoding="utf-8"))}
    assert {"Viewer", "WatchProcess"} <= named
    assert [name for name in sorted(named) if not hasattr(pages, name)] == []
