"""A film of a flow has the frames that were asked for, and what is no film is refused."""

import io
from itertools import pairwise

import numpy as np
import pytest
from PIL import Image

from suchus import flow
from suchus.core.errors import InvalidDesign, UnknownName
from suchus.visual.figures.film import film_caption
from suchus.visual.figures.flow import FieldFilm


def stirred(*films, until=0.4):
    grid = flow.Grid.covering((-1.0, 1.0), (-0.5, 0.5), cell=1 / 16)
    moving = flow.Oscillation(frequency=1.0, heave=(0.2, 0.0))
    body = flow.Body(shape=flow.Cylinder(diameter=0.3), motion=moving)
    sim = flow.Simulation(flow.Setup(grid=grid, viscosity=0.02, bodies=(body,), step=0.01, coarse=True))
    sim.run(until, watch=films, progress=False)
    return sim


def frames(path):
    with Image.open(io.BytesIO(path.read_bytes())) as gif:
        shown = []
        for i in range(gif.n_frames):
            gif.seek(i)
            shown.append(np.asarray(gif.convert("RGB")).copy())
        return shown, gif.info["duration"]


@pytest.mark.parametrize("what", ["vorticity", "pressure"])
def test_a_film_has_a_frame_for_each_interval_and_moves(what, tmp_path):
    film = FieldFilm(interval=0.1, field_name=what, speed=0.5)
    stirred(film)
    path = film.save(tmp_path / "stirred.gif")
    shown, duration = frames(path)
    assert len(shown) == 5  # after the first step, and at 0.1, 0.2, 0.3 and 0.4 s
    assert all((one != other).any() for one, other in pairwise(shown))
    assert duration == pytest.approx(1000 * (0.39 + 0.1) / 0.5 / 5, abs=10)
    assert film_caption(path.read_bytes()) == f"{what} of a flow from 0.01 to 0.4 s"


def test_what_is_no_film_is_refused(tmp_path):
    with pytest.raises(InvalidDesign, match="interval of a film is 0"):
        FieldFilm(interval=0.0)
    with pytest.raises(InvalidDesign, match="speed of a film is nan"):
        FieldFilm(interval=0.1, speed=float("nan"))
    with pytest.raises(InvalidDesign, match="limit of a film is 0"):
        FieldFilm(interval=0.1, limit=0.0)
    with pytest.raises(UnknownName, match="vorticity"):
        FieldFilm(interval=0.1, field_name="heat")
    with pytest.raises(InvalidDesign, match="holds no frame"):
        FieldFilm(interval=0.1).save(tmp_path / "none.gif")
    with pytest.raises(InvalidDesign, match=r"the ending \.gif"):
        FieldFilm(interval=0.1).save(tmp_path / "none.mp4")
    box = flow.Grid.covering(*[(-1.0, 1.0)] * 3, cell=1 / 8)
    with pytest.raises(InvalidDesign, match="plane flows"):
        flow.Simulation(flow.Setup(grid=box, viscosity=0.1)).run(0.1, watch=FieldFilm(interval=0.1), progress=False)
