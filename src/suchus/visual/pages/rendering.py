"""Templates that share a frame, parts, a style and the way numbers are written; figures that travel inside a page."""

import base64
import io
import json
import os
import re
from collections.abc import Mapping, Sequence
from functools import cache
from math import degrees, isnan
from pathlib import Path
from typing import Any
from urllib.parse import quote

from jinja2 import Environment, PackageLoader, StrictUndefined, pass_context
from jinja2.runtime import Context
from markupsafe import Markup, escape
from PIL import Image

from suchus.core.files import package_commit, versions

UNKNOWN = "unknown"
"""What stands in the place of a number that is none."""
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def quantity(value: float | None, unit: str, digits: int = 4) -> str:
    """Return a number with its unit; angles in degrees too. Nothing where there is no number.

    Args:
        value: value in ``unit``; None where it is not known.
        unit: as measures name it; ``-`` for none.
        digits: significant digits.
    """
    if value is None:
        return ""
    text = number(value, digits)
    if text == UNKNOWN:
        return text
    if unit == "rad":
        return f"{text} rad ({number(degrees(value), 3)}°)"
    return text if unit in ("-", "1", "") else f"{text} {'°C' if unit == 'degC' else unit}"


def number(value: float, digits: int = 4) -> str:
    """Return a number to a few digits, with a true minus and powers of ten written out; *unknown* for NaN."""
    if isinstance(value, int):
        return str(value).replace("-", "−")
    if isnan(value):
        return UNKNOWN
    mantissa, _, power = f"{value:.{digits}g}".partition("e")
    exponent = f" × 10{str(int(power)).translate(_SUPERSCRIPTS)}" if power else ""
    return mantissa.replace("-", "−") + exponent


def tied(text: str) -> str:
    """Return a text whose ``Fig. 16`` and ``eq. (14)`` do not break over lines."""
    return re.sub(r"\b(Figs?|Table|Section|eqs?)(\.?) ", "\\1\\2\N{NO-BREAK SPACE}", text)


def coded(text: str) -> Markup:
    """Return a text in which what stands between backticks is set as code."""
    return Markup(re.sub(r"`([^`]+)`", r"<code>\1</code>", str(escape(text))))


_HEAVY = 60_000
"""Length of a drawing [byte] beyond which pixels may stand for it; sixty of them make less than 4 MB."""
_COLOURS = 64
"""Colours that a drawn figure needs [-]: a handful of lines and texts, and the steps of one map."""
_NUMBER = re.compile(r"-?\d+\.\d{3,}")
_DATA = re.compile(r'(?<= )(d|transform|x|y)="([^"]*)"')
_OVERHEAD = re.compile(r"<\?xml.*?\?>|<!DOCTYPE.*?>|<!--.*?-->|<metadata>.*?</metadata>", re.S)
_PLAIN_TEXT = "data:image/svg+xml,"


def embedded(svg: str | Path, png: str | Path) -> Markup:
    """Return a figure as a data URI: as a drawing, or as pixels if it is heavy and these are lighter.

    Args:
        svg: the figure as a drawing.
        png: the figure as pixels.
    """
    svg, png = Path(svg), Path(png)
    drawing = as_drawing(svg.read_text(encoding="utf-8"))
    if len(drawing) <= _HEAVY or not png.is_file():
        return drawing
    return min(drawing, as_pixels(png.read_bytes()), key=len)


def as_drawing(svg: str) -> Markup:
    """Return an SVG as a data URI, without what only editors need and with coordinates to a hundredth of a point."""
    compact_svg = _DATA.sub(_rounded, _OVERHEAD.sub("", svg))
    compact_svg = re.sub(r">\s+<", "><", compact_svg).strip()
    if "'" in compact_svg or "&" in compact_svg:
        return Markup(f"data:image/svg+xml;base64,{base64.b64encode(compact_svg.encode()).decode()}")
    escaped = re.sub(r"\s+", " ", compact_svg).replace("%", "%25").replace("#", "%23").replace('"', "'")
    return Markup(_PLAIN_TEXT + escaped.replace("<", "%3C").replace(">", "%3E"))


def as_pixels(png: bytes, max_width: int | None = None) -> Markup:
    """Return a PNG as a data URI, with a palette of few colours.

    Args:
        png: the picture.
        max_width: width to which a wider one is made smaller [pixel]; None: it keeps its size.
    """
    with Image.open(io.BytesIO(png)) as picture:
        flat = Image.new("RGB", picture.size, "white")
        flat.paste(picture, mask=picture.getchannel("A") if picture.mode == "RGBA" else None)
    if max_width is not None and flat.width > max_width:
        flat = flat.resize((max_width, round(flat.height * max_width / flat.width)), Image.Resampling.LANCZOS)
    compact_png = io.BytesIO()
    flat.quantize(_COLOURS, dither=Image.Dither.NONE).save(compact_png, format="PNG", optimize=True)
    return Markup(f"data:image/png;base64,{base64.b64encode(compact_png.getvalue()).decode()}")


def _rounded(attribute: re.Match[str]) -> str:
    name, value = attribute.groups()
    if name == "transform" and "scale" in value:
        return attribute[0]  # small factors on the outlines of letters keep their digits
    return f'{name}="{_NUMBER.sub(lambda n: f"{float(n[0]):.2f}".rstrip("0").rstrip("."), value)}"'


def origin_text(version: str | None = None, commit: str | None = None, digests: Mapping[str, str] | None = None) -> str:
    """Return what made a page: suchus with its version, its commit and digests, as the foot of a page says it.

    Args:
        version: version of suchus; that which runs if None.
        commit: commit of its checkout; that which runs if None, left out if empty.
        digests: digests by name, of code and settings; empty ones are left out.
    """
    parts = {
        "commit": package_commit() if commit is None else commit,
        **({} if digests is None else digests),
    }
    made_by = f"suchus {versions()['suchus'] if version is None else version}".strip()
    return ", ".join([made_by, *(f"{name} {value}" for name, value in parts.items() if value)])


def embed_json(values: Mapping[str, Any] | Sequence[Any]) -> Markup:
    """Return values as JSON that is safe inside a page's script."""
    return Markup(json.dumps(values, separators=(",", ":")).replace("<", "\\u003c"))


def render(template: str, page_folder: str | Path | None = None, **content: Any) -> str:
    """Return a page as text.

    Args:
        template: name of its file in the folder of templates.
        page_folder: the folder of the page, from which it links files; None: the one that holds their folders.
        **content: what the template names.
    """
    folder = None if page_folder is None else Path(page_folder)
    known = {"version": versions()["suchus"], "origin": origin_text(), "page_folder": folder}
    return _environment().get_template(template).render(known | content) + "\n"


@cache
def _environment() -> Environment:
    """Return the templates with their filters; each is compiled once in a process."""
    environment = Environment(
        loader=PackageLoader("suchus.visual.pages"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {
        "quantity": quantity,
        "number": number,
        "tied": tied,
        "coded": coded,
        "deg": degrees,
        "link": _link,
    }
    environment.globals["source"] = _source
    return environment


def _source(name: str) -> Markup:
    """Return the text of a program among the templates, which a page's script holds."""
    templates = _environment()
    assert templates.loader is not None
    return Markup(templates.loader.get_source(templates, name)[0])


@pass_context
def _link(context: Context, file: Path) -> str:
    """Return how the page that is rendered names a file."""
    page_folder = context["page_folder"]
    return quote(Path(os.path.relpath(file, file.parent.parent if page_folder is None else page_folder)).as_posix())
