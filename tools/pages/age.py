"""Marks, in the built pages, of passages whose results are not current."""

import json
from collections.abc import Iterable, Mapping
from functools import cache
from typing import Any

from evidence import stale
from evidence.registry import RESULTS
from evidence.store import load, names
from pages import passages
from pages.stated import made, sources

WORDS: Mapping[str, str] = {
    "old": "Old: computed with suchus {version} ({commit}); the code of today gives other numbers.",
    "possibly old": "Computed with suchus {version} ({commit}); the code has changed since, not checked here.",
    "not checked here": "Computed with suchus {version} ({commit}); not checked here.",
}
"""What a page says below a passage, by the state of its results."""
MISSING = "Not computed yet."
"""What it says where the store has no such result."""


def marked(markdown: str) -> str:
    """Return a page in which a line below each passage says which of its results are not current."""
    known = set(made())
    texts = {name: mark(sources(name)) for name in passages.names(markdown) if name in known}
    return passages.put_below(markdown, texts)


def mark(results: Iterable[str]) -> str:
    """Return the line below a passage: a result that is missing, else the oldest state of one that is not current.

    Nothing is returned where all are current.

    Args:
        results: names of the results that the passage states.
    """
    order = list(WORDS)
    states = {name: state(name) for name in results if name in RESULTS}
    listed = sorted(
        (order.index(word) if name in names() else -1, name) for name, word in states.items() if word in WORDS
    )
    if not listed:
        return ""
    worst, name = listed[0]
    if name not in names():
        return f"\n*{name}: {MISSING}*{{ .age }}\n"
    origin = load(name).origin
    text = WORDS[order[worst]].format(version=origin.version, commit=origin.commit or "commit unknown")
    return f"\n*{name}: {text}*{{ .age }}\n"


@cache
def state(name: str) -> str:
    """Return the state of a result: by its code, and by the last ``make stale`` if that looked at the same code."""
    if name not in names():
        return "not checked here"
    today = stale.status(RESULTS[name], by_probe=False)
    answer = _answers().get(name, {})
    if today.state == "possibly old" and today.code and answer.get("code") == today.code:
        return str(answer["state"])
    return today.state


@cache
def _answers() -> Mapping[str, Any]:
    """Return the answers of the last ``make stale``; none where there was none, or where they cannot be read."""
    try:
        answers = json.loads(stale.ANSWERS.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return answers if isinstance(answers, dict) else {}
