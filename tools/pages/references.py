"""What a text names of the article: ``Eqs (2) to (4)``, ``Figs 5, 9``, ``Table I``."""

import re
from collections.abc import Iterator

_NAMED = re.compile(r"\b(eqs?|figs?)\b\.?\s*((?:\(?\d+\)?[a-z]?(?:\s*(?:to|and|,|-)\s*)?)+)", re.I)
_TABLE = re.compile(r"\bTables?\s+((?:I{1,3})(?:\s*(?:,|and)\s*I{1,3})*)")
_RANGE = re.compile(r"(\d+)\)?[a-z]?\s*(?:to|-)\s*\(?(\d+)|(\d+)")


def named(text: str) -> tuple[str, ...]:
    """Return the equations, figures and tables that a text names, such as ``eq 14``, ``fig 16``, ``table I``."""
    return tuple(dict.fromkeys([*_numbered(text), *(f"table {n}" for t in _TABLE.findall(text) for n in _romans(t))]))


def _numbered(text: str) -> Iterator[str]:
    for kind, numbers in _NAMED.findall(text):
        for first, last, single in _RANGE.findall(numbers):
            for number in range(int(first or single), int(last or single) + 1):
                yield f"{kind.lower().rstrip('s')} {number}"


def _romans(text: str) -> list[str]:
    return re.findall(r"I+", text)
