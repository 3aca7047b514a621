"""What the fields of a frozen value mean: the docstring under each, read from its source."""

import ast
import inspect
import re
import textwrap
from functools import cache
from itertools import pairwise


def meanings(kind: type) -> dict[str, str]:
    """Return the docstring of each field by name, inherited ones first; empty where the source is not at hand."""
    found: dict[str, str] = {}
    for one in reversed(kind.__mro__):
        found |= _own(one)
    return found


def unit(meaning: str) -> str:
    """Return the unit that a meaning names last in brackets, as ``m`` in ``From hip to knee [m].``."""
    found = re.findall(r"\[([^\]]*)\]", meaning)
    return str(found[-1]) if found else ""


def _is_text(node: ast.stmt) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


@cache
def _own(kind: type) -> dict[str, str]:
    """Return what a class's own body says; to find it in the source takes 10 ms."""
    try:
        source = textwrap.dedent(inspect.getsource(kind))
    except (OSError, TypeError):
        return {}
    (definition,) = ast.parse(source).body
    body = definition.body if isinstance(definition, ast.ClassDef) else []
    found = {}
    for field, text in pairwise(body):
        if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name) and _is_text(text):
            found[field.target.id] = inspect.cleandoc(ast.literal_eval(text.value))  # type: ignore[attr-defined]
    return found
