import subprocess
import sys

import matplotlib as mpl
import numpy as np
import pytest

from body_files import imported_quadruped
from suchus.robot.design import behind_hips
from suchus.robot.robots import ROBOTS
from suchus.visual.figures import (
    COLOURS,
    LINES,
    STYLE,
    WIDTH,
    caption,
    captioned,
    dimension_drawing,
    new,
    panels,
    save,
    styled,
)


def picture():
    with styled():
        figure, axes = panels(1, 2)
        axes[0, 0].plot([0, 1], [0, 1], **LINES["coordinated"])
        axes[0, 0].fill_between([0, 1], [0, 1], color=COLOURS["ours"], clip_on=True)
        axes[0, 1].imshow(np.eye(4))
    return captioned(figure, "A line\n  and an image.")


def test_equal_figures_give_equal_bytes(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    first, second = (save(picture(), tmp_path / folder, "same") for folder in "ab")
    assert [f.read_bytes() for f in first] == [f.read_bytes() for f in second]


def test_style_ends_with_its_block():
    before = dict(mpl.rcParams)
    picture()
    assert dict(mpl.rcParams) == before


def test_what_is_drawn_inside_the_block_follows_the_style():
    with styled():
        axes = new().add_subplot()
    assert axes.xaxis.label.get_size() == 12
    assert not axes.spines["top"].get_visible()


def test_a_caption_is_one_line():
    assert caption(picture()) == "A line and an image."
    assert caption(new()) == ""


def test_every_arm_has_its_own_colour_and_dashes():
    arms = ("coordinated", "limbs_only", "tail_drag", "spine_only")
    for look in ("color", "linestyle"):
        assert len({str(LINES[arm][look]) for arm in arms}) == len(arms)


def _luminance(colour):
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in mpl.colors.to_rgb(colour)]
    return float(np.dot([0.2126, 0.7152, 0.0722], linear))


@pytest.mark.parametrize("role", ["coordinated", "limbs_only", "tail_drag", "spine_only", "printed", "neutral"])
def test_lines_stand_out_from_the_paper(role):
    assert 1.05 / (_luminance(COLOURS[role]) + 0.05) > 3.0


@pytest.mark.parametrize("name", ROBOTS)
def test_the_drawing_shows_the_length_of_the_robot(name):
    robot = ROBOTS[name]
    figure = dimension_drawing(robot)
    written = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert f"{1000 * robot.length:.0f}" in written
    assert name in caption(figure)
    tailed = name not in ("strider", "swimmer")  # nothing behind the hips bends; no hips
    assert (f"{1000 * behind_hips(robot):.0f} mm of it tail" in caption(figure)) == tailed
    assert ("pale end of the tail" in caption(figure)) == (robot.tables is not None)


@pytest.mark.parametrize("name", ["caiman", "swimmer", "quadruped"])
def test_both_views_of_the_drawing_have_one_scale(name, tmp_path):
    """A flat body, one without legs, and one on legs so long that the height of the drawing is bound."""
    figure = dimension_drawing(imported_quadruped(tmp_path) if name == "quadruped" else ROBOTS[name])
    figure.draw_without_rendering()
    scales = [
        one
        for ax in figure.axes
        for one in (
            ax.get_window_extent().width / np.ptp(ax.get_xlim()),
            ax.get_window_extent().height / np.ptp(ax.get_ylim()),
        )
    ]
    assert scales == pytest.approx([scales[0]] * 4, rel=1e-6)


def test_figures_do_without_pyplot():
    code = "import suchus.visual.figures, sys; assert 'matplotlib.pyplot' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_text_is_read_in_a_column_of_a_journal():
    """A figure of the usual width, printed 85 mm wide, has letters of 5 points at least."""
    column = 85 / 25.4
    sizes = [STYLE[name] for name in ("font.size", "axes.labelsize", "legend.fontsize", "xtick.labelsize")]
    assert min(sizes) * column / WIDTH >= 5.0
