"""The table beside a figure holds what the figure shows, with quantity and unit in its header."""

import csv
import io

import matplotlib as mpl
import numpy as np
import pytest

from suchus.visual.figures import new, panels, save, styled
from suchus.visual.figures.data import MAX_FIELD_VALUES, carry, table


def rows(figure):
    return list(csv.DictReader(io.StringIO(table(figure))))


def column(found, name, series):
    return [float(row[name]) for row in found if row["series"] == series]


@pytest.fixture
def plain():
    with styled():
        figure, axes = panels(2, 1, sharex=True)
        for ax, factor in zip(axes[:, 0], (1.0, 3.0), strict=True):
            ax.plot([0.0, 0.5], [factor, 2 * factor], color="C0", label="robot" if factor == 1.0 else None)
        axes[0, 0].set_ylabel("speed [m/s]")
        axes[1, 0].set_ylabel("force [N]")
        axes[1, 0].set_xlabel("time [s]")
        axes[0, 0].set_title("above")
    return figure


def test_lines_are_told_under_the_label_of_their_axes(plain):
    found = rows(plain)
    assert list(found[0]) == ["panel", "series", "time [s]", "speed [m/s]", "force [N]"]
    assert found[0] == {"panel": "1 above", "series": "robot", "time [s]": "0", "speed [m/s]": "1", "force [N]": ""}


def test_a_line_without_a_label_is_called_as_the_line_that_looks_alike(plain):
    assert {row["series"] for row in rows(plain)} == {"robot"}
    plain.axes[1].lines[0].set_linestyle("--")
    assert {row["series"] for row in rows(plain)} == {"robot", "force"}


def test_of_several_lines_without_a_label_each_has_a_number(plain):
    for color in ("C1", "C2"):
        plain.axes[1].plot([0.0, 0.5], [1.0, 1.0], color=color)
    assert {row["series"] for row in rows(plain)} == {"robot", "line 2", "line 3"}


def test_a_line_across_the_panel_is_a_guide(plain):
    plain.axes[1].axhline(2.0, color="C1")
    plain.axes[1].axvline(0.25, color="C2")
    assert {row["series"] for row in rows(plain)} == {"robot", "horizontal guide", "vertical guide"}


def test_error_bars_are_named_as_what_they_are_of(plain):
    plain.axes[1].errorbar([0.1], [1.0], yerr=[0.2], color="C1", capsize=4, label="filmed")
    names = {row["series"] for row in rows(plain)}
    assert {"filmed", "filmed, end of the bar"} <= names
    assert not [name for name in names if name.startswith("line")]


def test_a_label_that_is_kept_out_of_the_legend_still_names_its_series(plain):
    plain.axes[1].lines[0].set_label("_robot, other servos")
    assert {row["series"] for row in rows(plain)} == {"robot", "robot, other servos"}


def test_bars_stand_under_the_words_of_their_axis():
    with styled():
        figure, axes = panels(1, 1)
        axes[0, 0].bar([0, 1], [3.0, 4.0], label="ours")
        axes[0, 0].set_xticks([0, 1], ["left", "right"])
        axes[0, 0].set_ylabel("push [N]")
    assert [(r["category"], r["push [N]"]) for r in rows(figure)] == [("left", "3"), ("right", "4")]


def test_ticks_that_are_written_as_numbers_are_numbers():
    with styled():
        figure, axes = panels(1, 1)
        axes[0, 0].plot([0.5, 3.0], [1.0, 2.0], label="a")
        axes[0, 0].set_xticks([0.5, 4.0], ["0.5", "4"])
        axes[0, 0].set(xlabel="period [s]", ylabel="speed [m/s]")
    assert column(rows(figure), "period [s]", "a") == [0.5, 3.0]


def test_ticks_at_indices_that_are_written_as_numbers_are_those_numbers():
    with styled():
        figure, axes = panels(1, 1)
        axes[0, 0].imshow([[7.0, 8.0]], origin="lower")
        axes[0, 0].set_xticks([0, 1], ["5", "12"])
        axes[0, 0].set_yticks([0], ["0"])
        axes[0, 0].set(xlabel="slope [deg]", ylabel="air [%]")
    assert [(row["slope [deg]"], row["air [%]"], row["value"]) for row in rows(figure)] == [
        ("5", "0", "7"),
        ("12", "0", "8"),
    ]


def test_rounded_numbers_at_ticks_are_numbers_still():
    with styled():
        figure, axes = panels(1, 1)
        axes[0, 0].plot([1.0 / 3.0, 0.5, 1e-3], [1.0, 2.0, 3.0], label="a")
        axes[0, 0].set_xticks([1.0 / 3.0, 1e-3], ["0.33", "1e-3"])
        axes[0, 0].set(xlabel="period [s]", ylabel="speed [m/s]")
    assert column(rows(figure), "period [s]", "a") == [0.333333, 0.5, 0.001]


def test_a_field_is_told_at_its_cells_with_the_label_of_its_colour_bar():
    with styled():
        figure, axes = panels(1, 1)
        mesh = axes[0, 0].pcolormesh([0.0, 1.0, 2.0], [0.0, 2.0], [[5.0, 7.0]])
        figure.colorbar(mesh, ax=axes[0, 0], label="reach [m]")
        axes[0, 0].set(xlabel="mass [kg]", ylabel="torque [N m]")
    assert [(r["mass [kg]"], r["torque [N m]"], r["reach [m]"]) for r in rows(figure)] == [
        ("0.5", "1", "5"),
        ("1.5", "1", "7"),
    ]


def test_panels_with_the_same_colours_share_the_label_of_one_bar_and_others_do_not():
    with styled():
        figure, axes = panels(1, 3)
        for ax, most in zip(axes[0], (5.0, 5.0, 9.0), strict=True):
            mesh = ax.pcolormesh([0.0, 1.0], [0.0, 2.0], [[4.0]], vmin=0.0, vmax=most)
            if ax is axes[0, 1]:
                figure.colorbar(mesh, ax=ax, label="reach [m]")
            ax.set(xlabel="mass [kg]", ylabel="torque [N m]")
    assert [(row["reach [m]"], row["value"]) for row in rows(figure)] == [("4", ""), ("4", ""), ("", "4")]


def test_what_was_computed_stands_in_the_place_of_the_smoothed_picture():
    with styled():
        figure, axes = panels(1, 1)
        image = axes[0, 0].imshow(np.zeros((8, 8)), origin="lower", extent=(0.0, 2.0, 0.0, 1.0))
        carry(image, np.array([[1.0, np.nan]]))
        axes[0, 0].set(xlabel="x [m]", ylabel="y [m]")
    assert [(r["x [m]"], r["y [m]"], r["value"]) for r in rows(figure)] == [("0.5", "0.5", "1"), ("1.5", "0.5", "")]


def test_a_fine_field_is_thinned_and_no_coarse_one():
    for size, kept in ((100, 100 * 100), (101, 51 * 51)):
        with styled():
            figure, axes = panels(1, 1)
            axes[0, 0].imshow(np.zeros((size, size)))
        assert len(rows(figure)) == kept <= MAX_FIELD_VALUES


def test_lines_across_a_panel_tell_their_one_number_and_colour_bars_nothing():
    with styled():
        figure, axes = panels(1, 1)
        axes[0, 0].axhline(0.73, label="article")
        axes[0, 0].axvspan(0.0, 1.0)
        axes[0, 0].set(xlabel="time [s]", ylabel="distance [m]")
    assert rows(figure) == [{"panel": "1", "series": "article", "distance [m]": "0.73"}]


def test_a_drawing_without_axes_is_in_metres():
    with styled():
        figure, axes = panels(1, 1)
        axes[0, 0].add_patch(mpl.patches.Circle((0.1, 0.2), 0.05, label="foot"))
        axes[0, 0].set_axis_off()
    assert rows(figure) == [{"panel": "1", "series": "foot", "x [m]": "0.1", "y [m]": "0.2"}]


def test_a_rectangle_tells_two_of_its_corners():
    with styled():
        figure, axes = panels(1, 1)
        axes[0, 0].add_patch(mpl.patches.Rectangle((0.0, 0.2), 1.0, 0.3, label="spine"))
        axes[0, 0].set(xlabel="x [m]", ylabel="height [m]")
    found = rows(figure)
    assert column(found, "height [m]", "spine") == [0.2, 0.5]
    assert column(found, "x [m]", "spine") == [0.0, 1.0]


def test_a_histogram_of_steps_tells_both_ends_of_each_step():
    with styled():
        figure, axes = panels(1, 1)
        axes[0, 0].stairs([3.0, 5.0], [1.0, 10.0, 100.0], label="ours")
        axes[0, 0].set(xlabel="error [mm]", ylabel="share [%]", xscale="log")
    found = rows(figure)
    assert column(found, "error [mm]", "ours") == [1.0, 10.0, 10.0, 100.0]
    assert column(found, "share [%]", "ours") == [3.0, 3.0, 5.0, 5.0]


def test_it_is_saved_beside_the_figure_and_an_empty_figure_has_none(plain, tmp_path):
    save(plain, tmp_path, "speeds")
    save(new(), tmp_path, "nothing")
    assert (tmp_path / "speeds.data.csv").read_text() == table(plain)
    assert not (tmp_path / "nothing.data.csv").exists()


def test_a_picture_in_colours_has_no_numbers():
    with styled():
        figure, axes = panels(1, 1)
        axes[0, 0].imshow(np.zeros((4, 4, 3), np.uint8))
        assert not table(figure)
        axes[0, 0].imshow(np.zeros((4, 4)))
        assert table(figure)
