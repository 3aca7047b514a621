"""A page followed literally: its files are written, its code and its commands are run, its outputs are compared.

* A block with ``title="NAME"`` is a file to save.
* Other ``python`` blocks continue one session.
* In ``sh`` blocks, lines that begin with ``suchus`` are commands; ``python FILE`` runs a file. Lines that set up a
  machine are left alone.
* A ``text`` block is what the block before it prints; ``...`` stands for any lines.

Usage: python tools/pages/blocks.py PAGE.md [--write]: run a page in a new folder, and fill in what it prints.
"""

import contextlib
import io
import os
import re
import shlex
import sys
import tempfile
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from suchus.apps.cli import main

_FENCE = re.compile(r'^```(\w+)(?: title="([^"]+)")?\n(.*?)^```$', re.S | re.M)
_SETUP = ("git", "cd", "make", "python3", ".venv/bin/python", "pip", "uvx", "source", "export")


@dataclass(frozen=True, slots=True)
class Block:
    """A fenced block of a page."""

    language: str
    """As the fence names it."""
    title: str
    """Name of the file to save, empty if it is none."""
    text: str
    """What stands in it."""


class WrongOutput(AssertionError):
    """A page that promises another output than came."""


def blocks(page: str) -> list[Block]:
    """Return the fenced blocks of a page."""
    return [Block(language, title, text) for language, title, text in _FENCE.findall(page)]


def follow(page: str) -> list[str]:
    """Do what a page says, in the working folder, and return what each block prints.

    Raises:
        WrongOutput: a block printed something else than the page says.
    """
    session: dict[str, Any] = {"__name__": "__main__"}
    if "" not in sys.path:
        sys.path.insert(0, "")  # as for whoever starts Python there
    printed: list[str] = []
    for block in blocks(page):
        if block.language == "text":
            if not _alike(block.text, printed[-1]):
                raise WrongOutput(f"the page says\n{block.text}\nbut this was printed:\n{printed[-1]}")
            printed.append("")
        else:
            printed.append(_do(block, session))
    return printed


def filled(page: str) -> str:
    """Return the page with every ``text`` block as it is printed now."""
    said = follow(re.sub(r"^```text\n.*?^```$", "```text\n...\n```", page, flags=re.S | re.M))
    left = pairwise(said)
    before = ""

    def put(found: re.Match[str]) -> str:
        nonlocal before
        before, last = next(left, (said[-1], ""))[0], before
        return f"```text\n{last.rstrip()}\n```" if found[1] == "text" else found[0]

    return _FENCE.sub(put, page)


def _do(block: Block, session: dict[str, Any]) -> str:
    if block.title:
        path = Path(block.title)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(block.text, encoding="utf-8")
        return ""
    if block.language not in ("python", "sh"):
        return ""
    aside = io.StringIO()  # progress of a session; what commands say there is a part of the page
    with contextlib.redirect_stdout(io.StringIO()) as out:
        if block.language == "python":
            with contextlib.redirect_stderr(aside):
                exec(compile(block.text, "page", "exec"), session)
            return _trimmed(out)
        with contextlib.redirect_stderr(out):
            for line in block.text.splitlines():
                _command(shlex.split(line, comments=True))
    return _trimmed(out)


def _trimmed(out: io.StringIO) -> str:
    """Return what was printed, without spaces at the ends of lines."""
    return "\n".join(line.rstrip() for line in out.getvalue().splitlines()) + "\n"


def _command(words: list[str]) -> None:
    match words:
        case []:
            return
        case ["suchus" | ".venv/bin/suchus", *rest]:
            _suchus(rest)
        case ["python", file, *rest]:
            code = Path(file).read_text(encoding="utf-8")
            sys.argv = [file, *rest]
            exec(compile(code, file, "exec"), {"__name__": "__main__"})
        case [setup, *_] if setup in _SETUP:
            return
        case _:
            raise WrongOutput(f"{shlex.join(words)}: not a command that a page may ask for.")


def _suchus(words: list[str]) -> None:
    try:
        code = main(words)
    except SystemExit as error:
        code = error.code
    if code not in (0, None, 2):
        raise WrongOutput(f"suchus {shlex.join(words)} ended with {code}.")


def _alike(said: str, printed: str) -> bool:
    pattern = ".*".join(re.escape(part.strip()) for part in said.strip().split("..."))
    return re.fullmatch(pattern, printed.strip(), re.S) is not None


if __name__ == "__main__":
    place = Path(sys.argv[1]).absolute()
    text = place.read_text(encoding="utf-8")
    write = "--write" in sys.argv
    os.chdir(tempfile.mkdtemp())
    if write:
        place.write_text(filled(text), encoding="utf-8")
    else:
        print(*follow(text), sep="\n----\n")
