"""`suchus demo`: live where there is a browser and the extra, a page elsewhere, and nothing half-written."""

import re
import webbrowser
from types import SimpleNamespace

import pytest

from suchus.apps.cli import demo, doctor, main
from suchus.sim.land import simulate


class Browser(webbrowser.BaseBrowser):
    """Remembers what it opened."""

    def __init__(self, name="firefox"):
        super().__init__(name)
        self.opened = []

    def open(self, url, new=0, autoraise=True):
        self.opened.append(url)
        return True


@pytest.fixture
def opener(monkeypatch):
    found = Browser()
    monkeypatch.setattr(webbrowser, "get", lambda: found)
    return found


@pytest.fixture
def short(monkeypatch, tmp_path):
    """Walks of three seconds, in an empty folder whose name has a space."""
    monkeypatch.setattr(demo, "simulate", lambda runs, progress: simulate(runs, duration=5.0, progress=progress))
    folder = tmp_path / "an empty folder"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


def test_without_a_browser_a_page_is_written_and_named(short, capsys, opener):
    assert main(["demo", "--no-browser"]) == 0
    out = capsys.readouterr().out
    page = short / "suchus_demo.html"
    assert list(short.glob("[!.]*")) == [page]
    assert f"the walk, in any browser: {page}" in out
    assert page.read_text().startswith("<!DOCTYPE html>")
    told = {name: float(far) for name, far in re.findall(r"^  (.*?) +[-\d.]+ m/s, ([-\d.]+) m forward$", out, re.M)}
    assert list(told) == ["belly crawl", "limbs only"]
    assert told["belly crawl"] > 2 * told["limbs only"] > 0
    assert opener.opened == []


def test_without_the_extra_the_page_is_opened_and_the_extra_is_named(short, capsys, opener, monkeypatch):
    monkeypatch.setattr(demo, "find_spec", lambda name: None)
    monkeypatch.setattr(demo, "_replay_html", lambda walks: "<!doctype html>" * walks.sizes["run"])
    monkeypatch.setattr(demo, "simulate", lambda runs, progress: simulate(runs, duration=5.0, timestep=0.005))
    assert main(["demo", "--out", "here.html"]) == 0
    assert opener.opened == [(short / "here.html").as_uri()]
    assert "pip install 'suchus[viewer]'" in capsys.readouterr().out


@pytest.mark.filterwarnings("default")  # viser's threads outlive its server for a moment
def test_with_a_browser_the_walk_is_live(short, capsys, opener, monkeypatch):
    pages = pytest.importorskip("suchus.apps.viewer.pages", reason="the extra viewer is not installed")

    def interrupted(viewer):
        raise KeyboardInterrupt

    monkeypatch.setattr(pages.Viewer, "wait", interrupted)
    assert main(["demo"]) == 0
    (address,) = opener.opened
    assert address.startswith("http://localhost:")
    assert f"caiman, belly_crawl: open {address} in a browser" in capsys.readouterr().out
    assert list(short.iterdir()) == []


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--out", "walk.txt"], "say --out FILE.html"),
        (["--out", "/dev/null/walk.html"], "cannot be written"),
        (["--port", "99999"], "suchus: demo.port is 99999; 0 to 65535 is allowed"),
        (["--gait", "trot"], "no option named '--gait'"),
        (["now"], "one word too many"),
    ],
)
def test_bad_words_are_a_sentence_and_leave_nothing(words, said, short, capsys):
    assert main(["demo", "--no-browser", *words]) == 2
    err = capsys.readouterr().err
    assert said in err
    assert err.count("\n") == 1
    assert list(short.iterdir()) == []


def test_no_browser_and_one_of_letters_are_none(monkeypatch):
    def missing():
        raise webbrowser.Error("could not locate runnable browser")

    monkeypatch.setattr(webbrowser, "get", missing)
    assert doctor.browser() is None
    monkeypatch.setattr(webbrowser, "get", lambda: webbrowser.GenericBrowser("/usr/bin/lynx"))
    assert doctor.browser() is None
    drawing = webbrowser.GenericBrowser("/usr/bin/firefox")
    monkeypatch.setattr(webbrowser, "get", lambda: drawing)
    assert doctor.browser() is drawing
    assert doctor.browser_name(drawing) == "firefox"
    assert doctor.browser_name(SimpleNamespace()) == "SimpleNamespace"
