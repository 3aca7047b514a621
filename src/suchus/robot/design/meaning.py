"""The meaning of the fields of a frozen value: the docstring below each, read from the source."""

import ast
import inspect
import re
import textwrap
from functools import cache
from itertools import pairwise

from suchus.core.files.provenance import is_docstring


def meanings(kind: type) -> dict[str, str]:
    """Return the docstring of each field by name, inherited ones first; empty where the source is not at hand."""
    docstrings: dict[str, str] = {}
    for base in reversed(kind.__mro__):
        docstrings |= _own_meanings(base)
    return docstrings


def unit(meaning: str) -> str:
    """Return the unit that a meaning names last in brackets, as ``m`` in ``From hip to knee [m].``."""
    units = re.findall(r"\[([^\]]*)\]", meaning)
    return str(units[-1]) if units else ""


@cache
def _own_meanings(kind: type) -> dict[str, str]:
    """Return the docstrings of the fields that a class itself defines; cached, since parsing takes 10 ms."""
    try:
        source = textwrap.dedent(inspect.getsource(kind))
    except (OSError, TypeError):
        return {}
    (definition,) = ast.parse(source).body
    body = definition.body if isinstance(definition, ast.ClassDef) else []
    docstrings = {}
    for field, text in pairwise(body):
        if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name) and is_docstring(text):
            docstrings[field.target.id] = inspect.cleandoc(ast.literal_eval(text.value))  # type: ignore[attr-defined]
    return docstrings
