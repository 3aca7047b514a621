"""Passages of a page that a tool writes: each stands between ``<!-- stated: NAME -->`` and ``<!-- end -->``."""

import re
from collections.abc import Mapping

_PASSAGE = re.compile(r"(<!-- stated: (\w+) -->\n)(.*?)(<!-- end -->)", re.DOTALL)


def names(page: str) -> list[str]:
    """Return the names of the passages of a page, in their order."""
    return [found[2] for found in _PASSAGE.finditer(page)]


def put(page: str, texts: Mapping[str, str]) -> str:
    """Return a page with the texts in the passages of these names; the others stay as they are."""
    return _PASSAGE.sub(lambda found: found[1] + texts.get(found[2], found[3]) + found[4], page)


def put_below(page: str, texts: Mapping[str, str]) -> str:
    """Return a page with a text below the end of each passage of these names."""
    return _PASSAGE.sub(lambda match: match[0] + texts.get(match[2], ""), page)
