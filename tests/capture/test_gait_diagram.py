import numpy as np
import pytest

from suchus.core.errors import InvalidDesign
from suchus.visual.figures import save
from suchus.visual.figures.gait_diagram import GaitTrack, bend_sign, gait_diagram, intervals

TIME = np.linspace(0.0, 8.0, 401)


def track(**changes):
    phase = TIME / 4
    values = {
        "time": TIME,
        "stance": np.array([np.mod(phase + p, 1) >= 0.5 for p in (0, 0.5, 0.5, 0)]),
        "spine": np.sin(2 * np.pi * phase),
        "tail": -np.sin(2 * np.pi * phase),
        "label": "a crawl",
    }
    return GaitTrack(**(values | changes))


def test_stretches_are_half_a_sample_wider_than_what_was_seen():
    time = np.arange(6.0)
    holds = np.array([True, True, False, False, True, True])
    assert intervals(time, holds) == [(0.0, 1.5), (3.5, 5.0)]
    assert intervals(time, np.zeros(6, dtype=bool)) == []


def test_signs_right_left_and_straight():
    np.testing.assert_array_equal(bend_sign(np.array([1.0, 0.01, -0.5, 0.0])), [1, 0, -1, 0])
    np.testing.assert_array_equal(bend_sign(np.radians([0.5, -0.9])), [0, 0])  # within a degree


def test_bars_cover_the_stance_and_nothing_else():
    figure = gait_diagram([track()], cycles=(0.0, 4.0, 8.0))
    bars = [bar for bar in figure.axes[0].patches if bar.get_y() < 3.5]
    assert sum(bar.get_width() for bar in bars) == pytest.approx(4 * 4.0, abs=0.2)
    assert {(round(bar.get_x()), round(bar.get_x() + bar.get_width())) for bar in bars if bar.get_width() > 0.1} == {
        (0, 2),
        (2, 4),
        (4, 6),
        (6, 8),
    }


def test_two_tracks_share_a_row_and_equal_figures_give_equal_bytes(tmp_path):
    files = []
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        files.append(save(gait_diagram([track(), track(label="another")]), tmp_path / name, "x"))
    for one, two in zip(*files, strict=True):
        assert one.read_bytes() == two.read_bytes()


def test_what_cannot_be_drawn_is_told():
    with pytest.raises(InvalidDesign, match="stance has shape"):
        track(stance=np.ones((3, 401), dtype=bool))
    with pytest.raises(InvalidDesign, match="increase"):
        track(time=TIME[::-1])
    with pytest.raises(InvalidDesign, match="3 were given"):
        gait_diagram([track()] * 3)
