"""The site as readers get it: built once, strictly, then read page by page."""

import os
import re
import subprocess
import sys
import zlib
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import pytest

from pages import reference
from pages.code import rooms

ROOT = Path(__file__).parents[2]
FETCHING = {"script": "src", "img": "src", "link": "href", "iframe": "src", "source": "src", "video": "src"}


class Html(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.tags, self.words = [], []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.words.append(data)


@pytest.mark.slow("the documentation is built")
def test_the_site_builds_strictly_and_is_whole(tmp_path):
    for library in ("mkdocs", "material", "mkdocstrings", "latex2mathml"):
        pytest.importorskip(library)
    site = tmp_path / "site"
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(site)]
    quiet = os.environ | {"NO_MKDOCS_2_WARNING": "1", "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(command, cwd=ROOT, env=quiet, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-4000:]
    pages = {path.relative_to(site).as_posix(): Html(path.read_text()) for path in site.rglob("*.html")}
    assert len(pages) > 40
    nothing_is_fetched_from_the_network(pages)
    every_link_arrives(site, pages)
    every_picture_has_a_text(pages)
    every_menu_has_a_name_of_its_own(pages)
    no_markup_is_left_over(pages)
    every_public_name_has_an_entry(site)


def nothing_is_fetched_from_the_network(pages):
    for name, page in pages.items():
        for tag, attrs in page.tags:
            fetched = attrs.get(FETCHING.get(tag, ""), "")
            canonical = tag == "link" and attrs.get("rel") == "canonical"
            assert canonical or not re.match(r"(https?:)?//", fetched), (name, fetched)


def every_link_arrives(site, pages):
    marks = {name: {a.get("id") or a.get("name") for _, a in page.tags} for name, page in pages.items()}
    for name, page in pages.items():
        if name == "404.html":
            continue
        for tag, attrs in page.tags:
            href = unquote(attrs.get("href" if tag in ("a", "link") else "src") or "")
            if not href or re.match(r"[a-z]+:", href):
                continue
            path, _, mark = href.partition("#")
            target = (site / name).parent.joinpath(path).resolve() if path else site / name
            assert target.exists(), (name, href)
            if mark and target.suffix == ".html":
                assert mark in marks[target.relative_to(site.resolve()).as_posix()] | {"__top"}, (name, href)


def every_picture_has_a_text(pages):
    for name, page in pages.items():
        for tag, attrs in page.tags:
            assert tag != "img" or "alt" in attrs, (name, attrs)


def every_menu_has_a_name_of_its_own(pages):
    """Which of axe's rules is landmark-unique."""
    for name, page in pages.items():
        titles = [a["id"] for tag, a in page.tags if tag == "label" and a.get("class") == "md-nav__title" and "id" in a]
        menus = [a["aria-labelledby"] for tag, a in page.tags if tag == "nav" and "aria-labelledby" in a]
        assert titles == menus, name
        assert len(set(titles)) == len(titles), name


def no_markup_is_left_over(pages):
    for name, page in pages.items():
        text = "".join(page.words)
        assert not re.search(r"FORMULA\d+MARK|\$`|\]\[\]|^:::", text), name
        assert not any(tag == "merror" for tag, _ in page.tags), name


def every_public_name_has_an_entry(site):
    body = (site / "objects.inv").read_bytes().split(b"\n", 4)[4]
    known = {line.split(" ")[0] for line in zlib.decompress(body).decode().splitlines()}
    wanted = {name for room in rooms() for name in reference.names(room)} | set(reference.top().values())
    assert len(wanted) > 300
    assert wanted <= known, sorted(wanted - known)
