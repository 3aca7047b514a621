"""Text that may be printed: without control characters, and without those that turn the direction of writing round."""

from collections.abc import Mapping
from typing import Any
from unicodedata import category

from suchus.core.errors import UnreadableFile

_DIRECTIONS = frozenset("\u061c\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
"""Marks that change the direction in which a terminal or an editor writes what follows."""
_SPACES = "\t\n\r"
MAX_NESTING = 100
"""Levels of tables and lists in a file, at most [-]."""


def unprintable(text: str, *, allow_lines: bool = False) -> str | None:
    """Return the first character of a text that must not be printed, as an escape; None where there is none.

    Args:
        text: any text.
        allow_lines: whether tabulators and line ends are allowed.
    """
    if text.isascii() and text.isprintable():
        return None
    for character in text:
        if allow_lines and character in _SPACES:
            continue
        if category(character) in ("Cc", "Zl", "Zp", "Cs") or character in _DIRECTIONS:
            return character.encode("unicode_escape").decode()
    return None


def escaped(text: str) -> str:
    """Return the beginning of a text with characters outside ASCII as escapes."""
    return text[:60].encode("unicode_escape").decode()


def name_complaint(name: str) -> str | None:
    """Return why a text is no name, a clause; None where it is one."""
    character = unprintable(name)
    if character is None:
        return None
    return (
        f"the name '{escaped(name)}' holds the character {character}, which steers a "
        "terminal or turns its writing round; letters, digits and signs are allowed: rename it"
    )


def check_content(label: object, content: Any, *, check_texts: bool = True) -> None:
    """Refuse tables of a file that nest too deeply, and texts in them that must not be printed.

    Args:
        label: the file, for messages.
        content: what was read from it: tables, lists, texts, numbers.
        check_texts: whether keys and texts are looked at; those of results are escaped where they are printed.

    Raises:
        UnreadableFile: it nests more than ``MAX_NESTING`` levels, or a key or a text holds such a character.
    """
    level = [content]
    for _ in range(MAX_NESTING + 1):
        next_level: list[Any] = []
        for item in level:
            if isinstance(item, str) and check_texts:
                _check_text(label, item)
            elif isinstance(item, Mapping):
                for key in item if check_texts else ():
                    _check_text(label, str(key))
                next_level += item.values()
            elif isinstance(item, list):
                next_level += item
        level = next_level
        if not level:
            return
    raise UnreadableFile(
        f"{label} nests tables or lists more than {MAX_NESTING} levels deep; no file of suchus needs so many: "
        "flatten it."
    )


def _check_text(label: object, text: str) -> None:
    character = unprintable(text, allow_lines=True)
    if character is not None:
        raise UnreadableFile(
            f"{label} holds the text '{escaped(text)}' with the character {character}, "
            "which steers a terminal or turns its writing round; letters, digits and signs are allowed: remove it."
        )
