"""A robot at its task as a picture, drawn as the figures draw it: no OpenGL, and no screen."""

from typing import Any

import numpy as np
import xarray as xr
from jaxtyping import UInt8
from matplotlib.backends.backend_agg import FigureCanvasAgg

from suchus.design import AnyRobot
from suchus.figures import new, styled
from suchus.figures.posture import draw_posture
from suchus.robots import beside_article

WIDTH, HEIGHT = 640, 480
"""Of a picture [pixel]."""
_DPI = 100
_PLACES = ((0.12, 0.622, 0.8, 0.333), (0.12, 0.09, 0.8, 0.52))
"""Of the two views, as shares of the picture: left, bottom, width, height."""
_SPAN, _WIDE, _TALL = 1.6, 0.5, 0.75  # [m]; what is seen of the article's robot: along the walk, across it, and up
_BELOW = 0.03  # [m]; what is seen below the ground


def picture(robot: AnyRobot, record: xr.Dataset, text: str) -> UInt8[np.ndarray, "height width 3"]:
    """Return a robot from above and from its right side, with its centre of mass, as red, green and blue.

    Args:
        robot: whose record it is.
        record: of one run, one sample.
        text: what is written above.
    """
    with styled(font__size=9, axes__titlesize=10, xtick__labelsize=8, ytick__labelsize=8, axes__labelsize=9):
        figure = new(width=WIDTH / _DPI, height=HEIGHT / _DPI)
        figure.set_dpi(_DPI)
        figure.set_layout_engine("none")  # finding a layout would take three quarters of the time
        above, side = (figure.add_axes(place) for place in _PLACES)
        above.tick_params(labelbottom=False)
        draw_posture(above, robot, record, 0.0)
        draw_posture(side, robot, record, 0.0, view="side")
        x, y = record.centre_of_mass.values[0, :2].tolist()
        span, wide, below, tall = (beside_article(robot).length * part for part in (_SPAN, _WIDE, _BELOW, _TALL))
        above.set(xlim=(x - span / 2, x + span / 2), ylim=(y - wide / 2, y + wide / 2), ylabel="left [m]", title=text)
        side.set(xlim=(x - span / 2, x + span / 2), ylim=(-below, tall), xlabel="forward [m]", ylabel="up [m]")
        canvas: Any = FigureCanvasAgg(figure)
        canvas.draw()
    return np.array(canvas.buffer_rgba())[..., :3]
