"""The table of Pythons and versions that docs/publishing.md shows is that of what was tried."""

import json
import re

import pytest

import matrix
from pages.passages import put

SOUND = {"date": "2026-01-02", "line": "ok: doctor", "sound": True, "versions": {"numpy": "2.2.0"}}


def test_the_page_shows_what_was_tried():
    """Renew with ``make matrix``."""
    page, every = matrix.PAGE.read_text(encoding="utf-8"), json.loads(matrix.KEPT.read_text(encoding="utf-8"))
    assert put(page, {"matrix": matrix.table(every)}) == page
    assert "/" not in re.sub(r"build/matrix/[\w.-]+\.log", "", json.dumps(every))  # no place of one machine


def test_a_row_for_each_python_and_a_column_for_each_end_of_the_ranges():
    rows = matrix.table({"3.12-lowest": SOUND, "3.13-newest": {**SOUND, "sound": False}}).splitlines()
    assert len(rows) == 2 + len(matrix.PYTHONS)
    assert rows[3] == "| 3.12 | not tried yet | 2026-01-02: ok: doctor (numpy 2.2.0) |"
    assert rows[4] == "| 3.13 | 2026-01-02 **fails**: ok: doctor (numpy 2.2.0) | not tried yet |"


def test_what_was_tried_is_kept_beside_the_others_without_what_the_installer_said(tmp_path, monkeypatch):
    monkeypatch.setattr(matrix, "KEPT", tmp_path / "matrix.json")
    monkeypatch.setattr(matrix, "PAGE", tmp_path / "page.md")
    matrix.KEPT.write_text(json.dumps({"3.11-newest": SOUND}), encoding="utf-8")
    matrix.PAGE.write_text("a\n<!-- stated: matrix -->\nold\n<!-- end -->\nb\n", encoding="utf-8")
    matrix.keep(matrix.Cell("3.12-lowest", "cannot be installed", sound=False, why="/home/me has no wheel"))
    every, page = json.loads(matrix.KEPT.read_text(encoding="utf-8")), matrix.PAGE.read_text(encoding="utf-8")
    assert every["3.11-newest"] == SOUND
    assert every["3.12-lowest"]["line"] == "cannot be installed"
    assert "/home/me" not in str(every) + page
    assert page == f"a\n<!-- stated: matrix -->\n{matrix.table(every)}<!-- end -->\nb\n"


def test_a_python_that_is_not_here_is_none():
    assert matrix.found("3.99") is None
    with pytest.raises(SystemExit):
        matrix.main(["--no-such-option"])
