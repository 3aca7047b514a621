"""Moving pictures: a figure drawn again and again becomes a GIF, which every browser plays without a program."""

import io
from collections.abc import Callable

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

COLOURS_KEPT = 96
"""Colours of a film [-]; a field with two-sided colours needs no more, and each doubling adds a sixth to the file."""


def film(figure: Figure, show: Callable[[int], None], count: int, *, seconds: float, caption: str) -> bytes:
    """Return a film as the bytes of a GIF that plays over and over; equal figures give equal bytes.

    Args:
        figure: what is drawn; its size and resolution are the film's.
        show: changes what the figure shows to that of a frame, counted from 0.
        count: number of frames [-].
        seconds: how long it plays once [s].
        caption: what is to be seen; it travels in the file.
    """
    canvas = FigureCanvasAgg(figure)
    frames: list[Image.Image] = []
    for i in range(count):
        show(i)
        canvas.draw()  # type: ignore[no-untyped-call]
        figure.set_layout_engine("none")  # all frames keep the layout of the first
        picture = Image.fromarray(np.asarray(canvas.buffer_rgba())[..., :3])  # type: ignore[no-untyped-call]
        palette = frames[0] if frames else None
        if palette is None:
            frames.append(picture.quantize(COLOURS_KEPT, dither=Image.Dither.NONE))
        else:
            frames.append(picture.quantize(palette=palette, dither=Image.Dither.NONE))
    file = io.BytesIO()
    frames[0].save(
        file,
        format="GIF",
        save_all=True,
        append_images=frames[1:],
        duration=round(1000 * seconds / count),
        loop=0,
        optimize=False,
        comment=" ".join(caption.split()).encode(),
    )
    return file.getvalue()


def film_caption(data: bytes) -> str:
    """Return the caption that a film's file holds; empty without one."""
    with Image.open(io.BytesIO(data)) as image:
        comment = image.info.get("comment", b"")
    return comment.decode(errors="replace") if isinstance(comment, bytes) else str(comment)
