"""A run becomes a film that plays at its own speed, without OpenGL; what cannot be encoded is refused in a sentence."""

import io
import sys

import numpy as np
import pytest
from PIL import Image

from suchus.apps.cli import main
from suchus.core.files import save
from suchus.visual.replay.video import ENDINGS, HEIGHT, WIDTH, NoVideo, video


@pytest.fixture(scope="module")
def short(crawled):
    return crawled.sel(time=slice(1.0, 1.6))


@pytest.fixture(scope="module")
def film(short, robot):
    return video(short, robot, ending=".webp", title="crawl")


def test_a_film_lasts_as_long_as_the_run_and_moves(film, short):
    with Image.open(io.BytesIO(film)) as pictures:
        assert pictures.size == (WIDTH, HEIGHT)
        shown = []
        duration = 0.0
        for i in range(pictures.n_frames):
            pictures.seek(i)
            shown.append(np.asarray(pictures.convert("RGB"), dtype=float))
            duration += pictures.info["duration"] / 1000.0
    span = float(short.time[-1] - short.time[0])
    assert duration == pytest.approx(span, abs=0.1)
    assert np.abs(shown[0] - shown[-1]).max() > 100.0


def test_the_same_run_makes_the_same_film(film, short, robot):
    assert video(short, robot, ending=".webp", title="crawl") == film


@pytest.mark.parametrize("ending", [".mp4", ".webm"])
def test_a_video_has_a_picture_for_every_frame(ending, short, robot):
    av = pytest.importorskip("av")
    with av.open(io.BytesIO(video(short, robot, ending=ending))) as container:
        pictures = list(container.decode(video=0))
    assert pictures[-1].time == pytest.approx(float(short.time[-1] - short.time[0]), abs=0.1)
    assert (pictures[0].width, pictures[0].height) == (WIDTH, HEIGHT)


def test_without_the_library_a_video_is_refused_with_the_remedy(short, robot, monkeypatch):
    monkeypatch.setitem(sys.modules, "av", None)
    with pytest.raises(NoVideo, match=r"pip install 'suchus\[capture\]'.* \.webp"):
        video(short, robot, ending=".mp4")


def test_the_command_writes_a_film_instead_of_the_page(short, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    save(short, tmp_path / "walk.nc")
    assert main(["replay", "walk.nc", "--video", "walk.webp"]) == 0
    assert "walk.webp" in capsys.readouterr().out
    assert sorted(file.name for file in tmp_path.glob("walk.*")) == ["walk.nc", "walk.webp"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--video", "walk.avi"], f"--video FILE{', FILE'.join(ENDINGS)}"),
        (["--video", "walk.webp", "--ghost", "0"], "--ghost is for the page"),
        (["--video", "walk.webp", "--out", "walk.html"], "--out is for the page"),
        (["--video", "walk.mp4"], "needs av"),
    ],
)
def test_what_makes_no_film_is_refused_before_anything_is_written(words, said, short, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(sys.modules, "av", None)
    save(short, tmp_path / "walk.nc")
    assert main(["replay", "walk.nc", *words]) == 2
    assert said in capsys.readouterr().err
    assert [file.name for file in tmp_path.glob("walk.*")] == ["walk.nc"]
