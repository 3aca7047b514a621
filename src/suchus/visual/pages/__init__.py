"""What every page is made of: one frame, one style sheet, one folder of templates, and how numbers are written."""

from suchus.visual.pages.rendering import (
    UNKNOWN,
    as_drawing,
    as_pixels,
    embed_json,
    embedded,
    number,
    origin_text,
    quantity,
    render,
    tied,
)

__all__ = [
    "UNKNOWN",
    "as_drawing",
    "as_pixels",
    "embed_json",
    "embedded",
    "number",
    "origin_text",
    "quantity",
    "render",
    "tied",
]
