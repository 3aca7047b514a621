"""A legend covers nothing that a figure shows: what is under it is found, and it moves."""

from io import BytesIO

import numpy as np
import pytest
from matplotlib.image import imread

from suchus.visual.figures import panels, styled
from suchus.visual.figures.uncover import covering

DRAWN = {
    "line": lambda ax: ax.plot([0, 1], [0.95, 0.95], "-"),
    "points": lambda ax: ax.plot([0.0, 0.05, 1.0], [0.0, 0.95, 1.0], "o"),
    "scattered": lambda ax: ax.scatter([0.0, 0.05, 1.0], [0.0, 0.95, 1.0]),
    "bars": lambda ax: ax.bar([0.1, 0.9], [1.0, 0.2]),
    "band": lambda ax: ax.fill_between([0, 1], [0.5, 0.0], [1.0, 0.2]),
    "map": lambda ax: ax.pcolormesh([0, 0.5, 1], [0, 0.5, 1], [[np.nan, 1.0], [2.0, np.nan]]),
    "contours": lambda ax: ax.contourf([0, 1], [0, 1], [[0, 1], [2, 3]]),
    "picture": lambda ax: ax.imshow([[1.0]], extent=(0, 0.5, 0.5, 1), aspect="auto"),
    "words": lambda ax: ax.text(0.02, 0.95, "see here", va="top"),
    "labelled line across": lambda ax: ax.axhline(0.95, label="article"),
}
"""Something that a panel shows in its upper left corner."""


def figure_with(draw, **where):
    with styled(axes__grid=False):
        figure, axes = panels(1, 1)
        ax = axes[0, 0]
        draw(ax)
        ax.plot([], [], color="red", label="a robot with a name")
        ax.set(xlim=(0, 1), ylim=(0, 1), xlabel="time [s]", title="panel")
        ax.legend(**where)
    return figure, ax


def pixels(figure, seen):
    """Return a picture of a figure with the legend left out, and the rows and columns that the legend has in it."""
    legend = figure.axes[0].get_legend()
    legend.set_visible(seen)
    for part in (figure.axes[0].xaxis, figure.axes[0].yaxis, *figure.axes[0].spines.values()):
        part.set_visible(False)
    drawn = BytesIO()
    engine = figure.get_layout_engine()
    figure.set_layout_engine("none")
    figure.savefig(drawn, dpi=figure.dpi)
    figure.set_layout_engine(engine)
    legend.set_visible(True)
    drawn.seek(0)
    (x0, y0), (x1, y1) = legend.get_window_extent().get_points().round().astype(int)
    return imread(drawn)[::-1][y0:y1, x0:x1, :3]


@pytest.mark.parametrize("name", DRAWN)
def test_what_lies_under_a_legend_is_found_and_the_legend_moves(name):
    figure, _ = figure_with(DRAWN[name], loc="upper left")
    engine = figure.get_layout_engine()
    super(type(engine), engine).execute(figure)
    assert len(list(covering(figure))) == 1
    assert pixels(figure, seen=False).min() < 0.9  # and something is there to be seen
    engine.execute(figure)
    assert list(covering(figure)) == []
    assert pixels(figure, seen=False).min() == 1.0


def test_a_legend_on_free_paper_stays_where_it_was_put():
    figure, ax = figure_with(DRAWN["points"], loc="lower right")
    legend = ax.get_legend()
    figure.get_layout_engine().execute(figure)
    assert ax.get_legend() is legend
    assert legend._loc == 4


def test_a_mark_of_a_cycle_and_a_shade_across_are_ground():
    figure, _ = figure_with(lambda ax: (ax.axvline(0.1), ax.axvspan(0.0, 0.5)), loc="upper left")
    figure.get_layout_engine().execute(figure)
    assert figure.axes[0].get_legend()._loc == 2


def test_where_everything_is_full_the_legend_stands_below_the_label_and_keeps_its_words():
    figure, ax = figure_with(lambda ax: ax.plot(np.linspace(0, 1, 400), np.tile([0, 1], 200)), loc="upper left")
    figure.get_layout_engine().execute(figure)
    legend, renderer = ax.get_legend(), figure._get_renderer()
    assert [text.get_text() for text in legend.get_texts()] == ["a robot with a name"]
    assert legend.get_window_extent().y1 <= ax.xaxis.label.get_window_extent(renderer).y0
    assert legend.get_window_extent().y0 >= 0


def test_a_legend_lies_on_no_other_panel():
    with styled():
        figure, axes = panels(1, 2)
        axes[0, 0].plot([0, 1], [0, 1], label="a robot with a name")
        axes[0, 1].plot([0, 1], [1, 1])
        axes[0, 0].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
        figure.get_layout_engine().execute(figure)
    assert list(covering(figure)) == []
