"""Pictures of the documentation become lighter, and look the same."""

import numpy as np
import pytest
from PIL import Image

from lighter import COLOURS, lighten


def drawing(path, mode="RGBA"):
    """A disc on white with soft edges, as a plot has them."""
    y, x = np.mgrid[:200, :300]
    inside = np.clip(60.5 - np.hypot(x - 150, y - 100), 0.0, 1.0)[..., None]
    colour = inside * np.array([0, 114, 178]) + (1 - inside) * 255
    noise = np.random.default_rng(0).integers(0, 2, colour.shape)  # without it the file is light as it is
    Image.fromarray(np.clip(colour + noise, 0, 255).astype(np.uint8)).convert(mode).save(path)
    return path


def test_a_picture_takes_fewer_bytes_and_hardly_changes(tmp_path):
    path = drawing(tmp_path / "disc.png")
    before, size = np.asarray(Image.open(path).convert("RGB"), float), path.stat().st_size
    assert lighten(path) == path
    assert path.stat().st_size < 0.7 * size
    after = Image.open(path)
    assert after.mode == "P"
    assert len(after.getcolors()) <= COLOURS
    assert abs(np.asarray(after.convert("RGB"), float) - before).mean() < 2.0


def test_what_is_transparent_becomes_white(tmp_path):
    path = tmp_path / "clear.png"
    pixels = np.random.default_rng(0).integers(0, 256, (80, 80, 4), dtype=np.uint8)
    pixels[:40, :, 3], pixels[40:, :, 3] = 0, 255
    Image.fromarray(pixels).save(path)
    lighten(path)
    assert (np.asarray(Image.open(path).convert("RGB"))[:40] > 250).all()


@pytest.mark.parametrize("mode", ["P", "1"])
def test_a_picture_that_would_not_get_lighter_stays_as_it_is(tmp_path, mode):
    path = tmp_path / "same.png"
    drawing(tmp_path / "disc.png").rename(path)
    Image.open(path).convert("RGB").convert(mode).save(path, optimize=True)
    before = path.read_bytes()
    lighten(path)
    assert path.read_bytes() == before
