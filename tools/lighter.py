"""Make PNG pictures lighter: 256 colours at most, where that takes fewer bytes.

Usage: python tools/lighter.py PICTURE.png ...
"""

import sys
from io import BytesIO
from pathlib import Path

from PIL import Image

COLOURS = 256
"""Colours that a picture keeps [-], as many as a palette has."""


def lighten(path: Path) -> Path:
    """Rewrite a picture with a palette if it then takes fewer bytes; return its path."""
    with Image.open(path) as picture:
        if picture.mode == "P":
            return path
        paper = Image.new("RGBA", picture.size, "white")
        flat = Image.alpha_composite(paper, picture.convert("RGBA")).convert("RGB")
    light = BytesIO()
    slim = flat.quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE, kmeans=3, dither=Image.Dither.NONE)
    slim.save(light, format="PNG", optimize=True)
    if light.tell() < path.stat().st_size:
        path.write_bytes(light.getvalue())
    return path


if __name__ == "__main__":
    for name in sys.argv[1:]:
        print(lighten(Path(name)))
