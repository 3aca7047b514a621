"""Figures made small enough to travel inside a page."""

import base64
import io
import re
from pathlib import Path

from markupsafe import Markup
from PIL import Image

_HEAVY = 60_000
"""Length of a drawing [byte] beyond which pixels may stand for it; sixty of them make less than 4 MB."""
_COLOURS = 64
"""Colours that a drawn figure needs [-]: a handful of lines and texts, and the steps of one map."""
_NUMBER = re.compile(r"-?\d+\.\d{3,}")
_DATA = re.compile(r'(?<= )(d|transform|x|y)="([^"]*)"')
_OVERHEAD = re.compile(r"<\?xml.*?\?>|<!DOCTYPE.*?>|<!--.*?-->|<metadata>.*?</metadata>", re.S)
_PLAIN_TEXT = "data:image/svg+xml,"


def embedded(svg: Path, png: Path) -> Markup:
    """Return a figure as a data URI: as a drawing, or as pixels if it is heavy and these are lighter.

    Args:
        svg: the figure as a drawing.
        png: the figure as pixels.
    """
    drawn = as_drawing(svg.read_text(encoding="utf-8"))
    if len(drawn) <= _HEAVY or not png.is_file():
        return drawn
    return min(drawn, as_pixels(png.read_bytes()), key=len)


def as_drawing(svg: str) -> Markup:
    """Return an SVG as a data URI, without what only editors need and with coordinates to a hundredth of a point."""
    slim = _DATA.sub(_rounded, _OVERHEAD.sub("", svg))
    slim = re.sub(r">\s+<", "><", slim).strip()
    if "'" in slim or "&" in slim:
        return Markup(f"data:image/svg+xml;base64,{base64.b64encode(slim.encode()).decode()}")
    escaped = re.sub(r"\s+", " ", slim).replace("%", "%25").replace("#", "%23").replace('"', "'")
    return Markup(_PLAIN_TEXT + escaped.replace("<", "%3C").replace(">", "%3E"))


def as_pixels(png: bytes) -> Markup:
    """Return a PNG as a data URI, with a palette of few colours."""
    with Image.open(io.BytesIO(png)) as picture:
        flat = Image.new("RGB", picture.size, "white")
        flat.paste(picture, mask=picture.getchannel("A") if picture.mode == "RGBA" else None)
    slim = io.BytesIO()
    flat.quantize(_COLOURS, dither=Image.Dither.NONE).save(slim, format="PNG", optimize=True)
    return Markup(f"data:image/png;base64,{base64.b64encode(slim.getvalue()).decode()}")


def _rounded(attribute: re.Match[str]) -> str:
    name, value = attribute.groups()
    if name == "transform" and "scale" in value:
        return attribute[0]  # small factors on the outlines of letters keep their digits
    return f'{name}="{_NUMBER.sub(lambda n: f"{float(n[0]):.2f}".rstrip("0").rstrip("."), value)}"'
