import io

import numpy as np
from matplotlib.figure import Figure
from PIL import Image

from suchus.visual.figures import film, film_caption


def _film(count=3):
    figure = Figure(figsize=(2.0, 1.0), dpi=50)
    image = figure.add_subplot().imshow(np.zeros((4, 4)), vmin=0, vmax=count, cmap="cividis")
    shown = []

    def show(i):
        shown.append(i)
        image.set_data(np.full((4, 4), i))

    return film(figure, show, count, seconds=1.5, caption="A square\n changes its colour."), shown


def test_a_film_shows_every_frame_and_says_what_it_is():
    data, shown = _film()
    assert shown == [0, 1, 2]
    with Image.open(io.BytesIO(data)) as picture:
        assert picture.format == "GIF"
        assert picture.n_frames == 3
        assert picture.size == (100, 50)
        assert picture.info["duration"] == 500
        assert picture.info["loop"] == 0
        colours = []
        for i in range(3):
            picture.seek(i)
            colours.append(picture.convert("RGB").getpixel((50, 25)))
    assert len(set(colours)) == 3
    assert film_caption(data) == "A square changes its colour."


def test_the_same_film_has_the_same_bytes():
    assert _film()[0] == _film()[0]
