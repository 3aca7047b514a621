"""From a record to a picture: every figure is drawn from what was recorded and nothing else."""

from suchus.visual.figures.drawing import dimension_drawing
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
