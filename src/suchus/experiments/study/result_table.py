"""A page of results: text, tables and pictures in one HTML file that needs nothing else."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from matplotlib.figure import Figure

from suchus.visual import figures
from suchus.visual.pages import embedded, render


@dataclass(frozen=True, slots=True, kw_only=True)
class ResultTable:
    """Rows of words and numbers."""

    caption: str
    """Caption of the table."""
    heads: Sequence[str]
    """Headings of the columns."""
    rows: Sequence[Sequence[str]]
    """As they are to be read."""
    words: Sequence[int] = (0,)
    """Which columns hold words; the others are set as numbers."""

    @property
    def numeric(self) -> tuple[int, ...]:
        """Indices of the columns that hold numbers."""
        return tuple(i for i in range(len(self.heads)) if i not in self.words)


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """A part of the page."""

    title: str
    """Its heading."""
    texts: Sequence[str] = ()
    """Paragraphs."""
    links: Sequence[tuple[str, str]] = ()
    """Files beside the page and what they are called."""
    figures: Sequence[str] = ()
    """Names of figures."""
    tables: Sequence[ResultTable] = ()
    """After the figures."""


def write_tables(
    folder: Path, title: str, lead: str, sections: Sequence[Section], pictures: Mapping[str, Figure]
) -> Path:
    """Write ``index.html`` and its pictures into a folder and return the page's path; equal figures give equal bytes.

    Args:
        folder: which exists.
        title: title of the page.
        lead: its first sentence or two.
        sections: what follows.
        pictures: pictures by name; each is written as SVG and PNG beside the page, which holds a copy.
    """
    sources = {}
    for name, figure in pictures.items():
        sources[name] = (embedded(*figures.save(figure, folder, name)), figures.caption(figure))
    page = render("tables.html", folder, title=title, lead=lead, sections=sections, pictures=sources)
    path = folder / "index.html"
    path.write_text(page, encoding="utf-8")
    return path
