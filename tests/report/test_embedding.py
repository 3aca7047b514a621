import base64
import io
from urllib.parse import unquote

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from suchus.visual.figures import captioned, panels, save, styled
from suchus.visual.pages import as_drawing, as_pixels, embedded


@pytest.fixture
def light(tmp_path):
    with styled():
        figure, axes = panels()
        axes[0, 0].plot([0, 1], [0.123456789, 1 / 3], label="50 %")
        axes[0, 0].legend()
    return save(captioned(figure, 'A "light" one & its <clip>.'), tmp_path, "light")


@pytest.fixture
def heavy(tmp_path):
    with styled():
        figure, axes = panels()
        axes[0, 0].plot(np.random.default_rng(0).normal(size=(400, 60)))
    return save(figure, tmp_path, "heavy")


def pixels(source):
    png = base64.b64decode(source.partition(",")[2])
    return np.asarray(Image.open(io.BytesIO(png)).convert("RGB"), dtype=int)


def test_a_light_drawing_stays_a_drawing_and_a_heavy_one_becomes_pixels(light, heavy):
    assert embedded(*light).startswith("data:image/svg+xml")
    assert embedded(*heavy).startswith("data:image/png")


def test_a_drawing_loses_its_overhead_and_nothing_else(light):
    svg = light[0].read_text()
    source = as_drawing(svg)
    assert len(source) < 0.9 * len(svg)
    slim = unquote(source)
    assert slim.count("<path") == svg.count("<path")
    assert "metadata" not in slim
    assert "0.123457" not in slim


def test_letters_keep_the_digits_of_their_scale():
    svg = '<svg><g transform="translate(1.23456 2) scale(0.015625)"><path d="M 1.23456 2"/></g></svg>'
    slim = unquote(as_drawing(svg))
    assert "scale(0.015625)" in slim
    assert "M 1.23 2" in slim


def test_nothing_in_a_drawing_can_leave_its_attribute():
    for text in ("<svg><text>it's</text></svg>", "<svg><text>a &amp; b</text></svg>", '<svg><text>"></text></svg>'):
        source = as_drawing(text)
        assert not set(source) & set("\"'<>") or source.startswith("data:image/svg+xml,")
        assert '"' not in source
        assert "<" not in source


def test_pixels_are_those_of_the_figure(light):
    png = light[1].read_bytes()
    with Image.open(io.BytesIO(png)) as picture:
        before = np.asarray(picture.convert("RGB"), dtype=int)
    after = pixels(as_pixels(png))
    assert after.shape == before.shape
    assert np.abs(after - before).mean() < 2.0
    assert len(as_pixels(png)) < 4 / 3 * len(png)


def test_a_transparent_figure_gets_a_white_ground(tmp_path):
    path = tmp_path / "clear.png"
    Figure(figsize=(1, 1)).savefig(path, transparent=True)
    assert pixels(as_pixels(path.read_bytes())).min() == 255
