"""QR codes of the lessons' addresses: what segno computes, as a picture and in characters; nothing without segno."""

import io
import re
import sys

import numpy as np
import pytest
from rich.console import Console

from suchus.apps.cli import terminal
from suchus.apps.report.qr_code import qr_picture, qr_text

segno = pytest.importorskip("segno")
ADDRESS = "http://192.0.2.7:8080/bending.html"
HALVES = {"█": (1, 1), "▀": (1, 0), "▄": (0, 1), " ": (0, 0)}


def drawn(path):
    """Return the dark modules of a picture, whose rows are strokes: move to, then right by, and a line to the right."""
    modules = np.zeros((size := int(re.search(r'viewBox="0 0 (\d+)', path)[1]), size), dtype=int)
    strokes = re.search(r'stroke="#000" d="([^"]*)"', path)[1]
    column = row = 0.0
    for kind, first, second, length in re.findall(r"([Mm])(-?[\d.]+)[ ]?(-?[\d.]+)|h(-?\d+)", strokes):
        if kind:
            column, row = (float(first), float(second)) if kind == "M" else (column + float(first), row + float(second))
        else:
            modules[int(row), int(column) : int(column) + int(length)] = 1
            column += int(length)
    return modules


def test_picture_and_characters_are_the_modules_of_the_code():
    expected = np.array([[*row] for row in segno.make(ADDRESS, error="m", micro=False).matrix_iter(border=4)])
    assert 0.2 < expected.mean() < 0.6
    assert np.array_equal(drawn(qr_picture(ADDRESS)), expected)
    lines = qr_text(ADDRESS).split("\n")
    halves = np.array([[HALVES[character] for character in line] for line in lines])
    rows = halves.transpose(0, 2, 1).reshape(-1, expected.shape[1])
    assert np.array_equal(rows[: len(expected)], expected)
    assert not rows[len(expected) :].any()


def test_the_picture_says_what_it_is_and_another_address_is_another_code():
    picture = qr_picture(ADDRESS)
    assert f"<title>QR code of {ADDRESS}</title>" in picture
    assert qr_picture(ADDRESS.replace("bending", "waves")) != picture


def test_without_an_address_or_segno_there_is_none(monkeypatch):
    assert (qr_picture(""), qr_text("")) == ("", "")
    monkeypatch.setitem(sys.modules, "segno", None)
    assert (qr_picture(ADDRESS), qr_text(ADDRESS)) == ("", "")


@pytest.mark.parametrize(
    ("is_terminal", "encoding", "shown"), [(True, "utf-8", True), (False, "utf-8", False), (True, "ascii", False)]
)
def test_a_terminal_shows_it_dark_on_light(is_terminal, encoding, shown, monkeypatch):
    output = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    monkeypatch.setattr(
        terminal,
        "Console",
        lambda **words: Console(file=output, force_terminal=is_terminal, color_system="standard", **words),
    )
    terminal.print_code(qr_text(ADDRESS))
    output.flush()
    printed = output.buffer.getvalue().decode(encoding)
    assert ("\x1b[30;107m" in printed) is shown
    assert bool(printed) is shown
