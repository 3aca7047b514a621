"""All writers of pages share one frame, one style sheet and one folder of templates."""

import io
import re
from base64 import b64decode
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import suchus
from suchus.core.files import versions
from suchus.visual.pages import as_pixels, origin_text
from suchus.visual.pages.rendering import coded

PACKAGE = Path(suchus.__file__).parent
TEMPLATES = PACKAGE / "visual" / "pages" / "templates"
NO_PAGES = {"frame.html", "parts.html", "verdicts.html"}
PAGES = sorted(file.name for file in TEMPLATES.glob("*.html") if file.name not in NO_PAGES)


def parents(name):
    """Return the templates that a template extends, the nearest first."""
    extended = re.match(r'{% extends "(.+?)" %}', (TEMPLATES / name).read_text())
    return [extended[1], *parents(extended[1])] if extended else []


def test_every_page_stands_in_the_one_frame():
    assert len(PAGES) > 10
    assert {name: parents(name)[-1:] for name in PAGES} == {name: ["frame.html"] for name in PAGES}


def test_there_is_one_style_sheet_and_no_page_has_a_style_of_its_own():
    assert [file.relative_to(PACKAGE).as_posix() for file in PACKAGE.rglob("*.css")] == [
        "visual/pages/templates/style.css"
    ]
    assert [file.name for file in PACKAGE.rglob("*.html") if "<style" in file.read_text()] == ["frame.html"]
    assert {file.parent for file in PACKAGE.rglob("*.html")} == {TEMPLATES}


def test_the_foot_says_version_commit_and_digests_and_leaves_out_what_is_unknown():
    assert origin_text("0.2.0", "0123456789+", {"code": "", "settings": "abc"}) == (
        "suchus 0.2.0, commit 0123456789+, settings abc"
    )
    assert origin_text("", "", {}) == "suchus"
    assert origin_text().startswith(f"suchus {versions()['suchus']}")


@pytest.mark.parametrize(
    ("text", "page"), [("`suchus run a` answers.", "<code>suchus run a</code> answers."), ("a < `b", "a &lt; `b")]
)
def test_what_stands_between_backticks_is_code(text, page):
    assert coded(text) == page


@pytest.mark.parametrize(("width", "shown"), [(400, 200), (100, 100)])
def test_a_small_picture_is_made_smaller_and_never_larger(width, shown):
    data = io.BytesIO()
    Image.fromarray(np.full((width // 2, width, 3), 200, dtype=np.uint8)).save(data, format="PNG")
    small = b64decode(as_pixels(data.getvalue(), 200).partition(",")[2])
    with Image.open(io.BytesIO(small)) as picture:
        assert picture.size == (shown, shown // 2)
