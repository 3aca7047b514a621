"""From a record to a picture: every figure is drawn from what was recorded and nothing else."""

from typing import TYPE_CHECKING, Any

from suchus.visual.figures.film import film, film_caption
from suchus.visual.figures.style import (
    COLOURS,
    DIVERGING,
    LINES,
    SEQUENTIAL,
    STYLE,
    WIDTH,
    caption,
    captioned,
    limb_colours,
    new,
    panels,
    places,
    save,
    styled,
)

if TYPE_CHECKING:
    from suchus.visual.figures.drawing import dimension_drawing

__all__ = [
    "COLOURS",
    "DIVERGING",
    "LINES",
    "SEQUENTIAL",
    "STYLE",
    "WIDTH",
    "caption",
    "captioned",
    "dimension_drawing",
    "film",
    "film_caption",
    "limb_colours",
    "new",
    "panels",
    "places",
    "save",
    "styled",
]


def __getattr__(name: str) -> Any:
    """Return the drawing of a robot, which is imported when it is used: a figure of a flow needs no robot."""
    if name == "dimension_drawing":
        from suchus.visual.figures.drawing import dimension_drawing  # noqa: PLC0415  see above

        return dimension_drawing
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
