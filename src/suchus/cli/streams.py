"""The surroundings of a command: its streams, its terminal, and what other programs have set for them."""

import os
import sys
from contextlib import suppress
from shutil import get_terminal_size

_NARROWEST, _WIDEST = 40, 500  # columns of a terminal that a help is set for


def prepare_streams() -> None:
    """Make sure that there are streams that take every letter, a width that text can be set in, and a way to draw.

    A stream that is closed becomes one that swallows everything: the next file that is opened must not take its
    number, and what is meant for people must not end up in it. Figures are only ever saved, so that no window is
    needed, whatever ``MPLBACKEND`` says.
    """
    if sys.stdout is None or sys.stderr is None:
        for number in range(3):
            _hold(number)
        sys.stdout = sys.stdout or open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115, PTH123  until we end
        sys.stderr = sys.stderr or open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115, PTH123
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")
    columns = get_terminal_size().columns
    if not _NARROWEST <= columns <= _WIDEST:
        os.environ["COLUMNS"] = str(min(max(columns, _NARROWEST), _WIDEST))
    if "matplotlib" not in sys.modules:
        os.environ["MPLBACKEND"] = "agg"


def _hold(number: int) -> None:
    try:
        os.fstat(number)
    except OSError:
        os.open(os.devnull, os.O_RDWR)  # takes the least number that is free


def drop_output() -> None:
    """Let what is still to be printed go nowhere, so that the end of the process does not complain of it again."""
    with suppress(OSError, ValueError):  # not every stream is a file
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def printable(text: str) -> str:
    """Return a text whose letters a terminal shows and does not obey."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in text)
