"""A page of results: text, tables and pictures in one HTML file that needs nothing else."""

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined
from matplotlib.figure import Figure

from suchus.core.files import versions
from suchus.visual import figures


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
        svg, _ = figures.save(figure, folder, name)
        text = base64.b64encode(svg.read_bytes()).decode()
        sources[name] = (f"data:image/svg+xml;base64,{text}", figures.caption(figure))
    environment = Environment(
        loader=PackageLoader("suchus.experiments.study"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    page_sections = [
        {
            "title": section.title,
            "texts": section.texts,
            "links": section.links,
            "pictures": [sources[name] for name in section.figures],
            "tables": section.tables,
        }
        for section in sections
    ]
    foot = f"suchus {versions()['suchus']}, MuJoCo {versions()['mujoco']}."
    page = environment.get_template("result_table.html").render(
        title=title, lead=lead, sections=page_sections, foot=foot
    )
    path = folder / "index.html"
    path.write_text(page, encoding="utf-8")
    return path
