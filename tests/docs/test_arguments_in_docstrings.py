"""What docstrings describe under ``Args:`` are arguments: a renamed one leaves no description of the old name."""

import ast
import re
from pathlib import Path

SOURCE = Path(__file__).parents[2] / "src"


def signature(node):
    """Return the names of the arguments of a function, or of the constructor of a class; None where it has none."""
    if isinstance(node, ast.ClassDef):
        own = {part.name: part for part in node.body if isinstance(part, ast.FunctionDef)}
        if "__init__" not in own:
            return None  # fields are described where they stand
        node = own["__init__"]
    given = node.args
    every = [*given.posonlyargs, *given.args, *given.kwonlyargs, *filter(None, (given.vararg, given.kwarg))]
    return [argument.arg for argument in every]


def described(node):
    """Return the names that a docstring describes under ``Args:``."""
    section = re.search(r"^Args:\n((?: {4}.*\n|\n)+)", (ast.get_docstring(node) or "") + "\n", re.M)
    return re.findall(r"^ {4}\**(\w+)(?: \([^)]*\))?: ", section[1], re.M) if section else []


def wrong(source):
    """Return the functions and classes of a source whose docstrings describe what is no argument."""
    nodes = [n for n in ast.walk(ast.parse(source)) if isinstance(n, ast.FunctionDef | ast.ClassDef)]
    known = {id(node): signature(node) for node in nodes}
    return [
        (node.name, name) for node in nodes if known[id(node)] is not None for name in described(node)
        if name not in known[id(node)]
    ]  # fmt: skip


def test_every_described_argument_is_one():
    found = {str(file.relative_to(SOURCE)): wrong(file.read_text("utf-8")) for file in sorted(SOURCE.rglob("*.py"))}
    assert {name: names for name, names in found.items() if names} == {}


def test_an_old_argument_is_found():
    text = 'class Bus:\n    """A bus.\n\n    Args:\n        clocked: x.\n    """\n    def __init__(self, speed): ...\n'
    assert wrong(text) == [("Bus", "clocked")]
