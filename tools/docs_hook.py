"""What mkdocs does besides: pages made of the code, formulas as MathML, and a place in the menu for every page."""

import re
import sys
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

sys.path.insert(0, str(Path(__file__).parents[1]))

from pages import age, article, gallery, laboratory, links, reference
from pages.code import rooms as rooms_of_code
from pages.mathml import Formulas
from pages.stated import page as stated_page

_FETCHED = '<script src="https://unpkg.com/iframe-worker/shim"></script>'
_formulas: dict[str, Formulas] = {}


def on_config(config: MkDocsConfig) -> MkDocsConfig:
    """Fill the menu's places for generated pages, and put pages that nobody listed at the end."""
    config.nav = [_filled(entry) for entry in config.nav or []]
    listed = set(_paths(config.nav))
    there = {path.relative_to(config.docs_dir).as_posix() for path in Path(config.docs_dir).glob("*.md")}
    if more := sorted(there - listed):
        config.nav.append({"More": more})
    return config


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages that are made of the code."""
    made = {
        "paper_map.md": article.paper_map(),
        "misprints.md": article.misprints(),
        "questions.md": stated_page("questions"),
    }
    for path, text in (made | reference.pages() | gallery.pages() | laboratory.pages()).items():
        files.append(File.generated(config, path, content=text))
    return files


def on_page_markdown(markdown: str, page: Page, **_: Any) -> str:
    """Mark what is old, keep formulas aside, and lead links to the laboratory and to the pages made of files."""
    _formulas[page.file.src_uri] = Formulas()
    return _formulas[page.file.src_uri].take(links.built(laboratory.linked(age.marked(markdown))))


def on_page_content(html: str, page: Page, **_: Any) -> str:
    """Put the formulas of a page back, as MathML."""
    return _formulas.pop(page.file.src_uri).put(html)


def on_post_page(output: str, page: Page, **_: Any) -> str:
    """Let the page bring its own worker for reading from a folder, and name its search box and its menus.

    Raises:
        LookupError: the theme no longer fetches it this way, or fetches something else.
    """
    if output.count(_FETCHED) != 1:
        raise LookupError(f"the theme's pages no longer have {_FETCHED}; see what they fetch now.")
    up = "../" * page.file.dest_uri.count("/")
    return _named(output).replace(_FETCHED, f'<script src="{up}worker_from_file.js"></script>')


def on_post_template(output: str, **_: Any) -> str:
    """Do the same for what is no page, such as that for a wrong address, which needs no worker."""
    return _named(output).replace(_FETCHED, "")


def _named(output: str) -> str:
    """Return a page whose search box and menus have names."""
    search = 'data-md-component="search" role="dialog"'
    output = output.replace(search, f'{search} aria-label="Search"')
    # a menu whose section has a page of its own is labelled by an empty label; its title stands in it
    output = re.sub(r'(<label class="md-nav__title" for="(__nav_[0-9_]+)")', r'\1 id="\2_title"', output)
    return re.sub(r'aria-labelledby="(__nav_[0-9_]+)_label"', r'aria-labelledby="\1_title"', output)


def _filled(entry: Any) -> Any:
    """Return an entry of the menu, and all below it, with the pages that are made of the code in their places."""
    match entry:
        case {"API reference": _}:
            rooms = [{f"suchus.{room}": f"api/{room}.md"} for room in rooms_of_code()]
            return {"API reference": ["api/index.md", *rooms]}
        case {"Examples": _}:
            shown = [{one.short: f"examples/{one.stem}.md"} for one in gallery.examples()]
            return {"Examples": ["examples/index.md", *shown]}
        case dict():
            return {title: _filled(below) for title, below in entry.items()}
        case list():
            return [_filled(below) for below in entry]
        case _:
            return entry


def _paths(nav: Any) -> list[str]:
    match nav:
        case str():
            return [nav]
        case dict():
            return [path for below in nav.values() for path in _paths(below)]
        case _:
            return [path for below in nav for path in _paths(below)]
