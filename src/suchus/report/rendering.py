"""Where the pages of results come from: templates that share a frame, a style and the way tables are written."""

import os
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any
from urllib.parse import quote

from jinja2 import Environment, PackageLoader, StrictUndefined, pass_context
from jinja2.runtime import Context
from markupsafe import Markup

from suchus.report.numbers import number, quantity


def render(template: str, place: Path | None, content: dict[str, Any], **filters: Any) -> str:
    """Return a page as text.

    Args:
        template: name of its file.
        place: the folder of the page, from which it links files; None: the one that holds their folders.
        content: what the template names.
        filters: of the template, beside ``quantity``, ``number`` and ``link``.
    """
    environment = _environment(tuple(filters.items()))
    style = Markup(environment.get_template("style.css").render())
    return environment.get_template(template).render(style=style, page_folder=place, **content) + "\n"


@cache
def _environment(filters: tuple[tuple[str, Callable[..., Any]], ...]) -> Environment:
    """Return templates with their filters; each is compiled once in a process."""
    environment = Environment(
        loader=PackageLoader("suchus.report"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"quantity": quantity, "number": number, "link": _link, **dict(filters)}
    return environment


@pass_context
def _link(context: Context, file: Path) -> str:
    """Return how the page that is rendered names a file."""
    place = context["page_folder"]
    return quote(Path(os.path.relpath(file, file.parent.parent if place is None else place)).as_posix())
