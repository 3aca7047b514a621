"""A film becomes a page on which its points are clicked, and what is clicked becomes a table that capture reads."""

import json
import re
import shutil

import numpy as np
import pytest
from PIL import Image, ImageDraw

import suchus
from suchus.animals.capture import UnusableTracks, observe, read_tracks
from suchus.animals.digitise import MAX_FRAMES, digitising_page
from suchus.animals.pictures import frames
from suchus.apps.cli import main
from suchus.core.errors import UnreadableFile

SIZE = (320, 200)
PLACES = {
    "hip": [(100.0, 80.0), (110.5, 81.0), (121.0, 82.0)],
    "shoulder": [(160.0, 80.0), (171.0, 80.0), (181.0, 79.5)],
}
BROWSER = shutil.which("chromium") or shutil.which("chromium-browser")
PATIENCE = 120_000  # [ms]
TO_SCREEN = """([x, y]) => {
  const { scale, left, top, box } = layout();
  return [box.left + left + scale * x, box.top + top + scale * y];
}"""


def picture(places):
    """Return a frame with a dot at each place."""
    drawn = Image.new("RGB", SIZE, "black")
    for x, y in places:
        ImageDraw.Draw(drawn).ellipse((x - 3, y - 3, x + 3, y + 3), fill="white")
    return drawn


@pytest.fixture
def film(tmp_path):
    """A GIF of three frames that are shown for 40, 60 and 40 ms."""
    first, *rest = [picture(places) for places in zip(*PLACES.values(), strict=True)]
    path = tmp_path / "walk.gif"
    first.save(path, save_all=True, append_images=rest, duration=[40, 60, 40], loop=0)
    return path


def facts_of(page):
    return json.loads(re.search(r'id="facts">(.*?)</script>', page, re.S).group(1))


def test_the_frames_of_a_gif_have_the_times_at_which_they_are_shown(film):
    assert [frame.time for frame in frames(film)] == pytest.approx([0.0, 0.04, 0.1])
    assert facts_of(digitising_page(film))["times"] == pytest.approx([0.0, 0.04, 0.1])


def test_a_given_rate_goes_before_the_films_own_and_frames_are_left_out_by_time_and_number(film):
    assert facts_of(digitising_page(film, rate=50.0))["times"] == pytest.approx([0.0, 0.02, 0.04])
    assert facts_of(digitising_page(film, every=2))["times"] == pytest.approx([0.0, 0.1])
    assert facts_of(digitising_page(film, start=0.04))["times"] == pytest.approx([0.04, 0.1])
    assert facts_of(digitising_page(film, end=0.05))["times"] == pytest.approx([0.0, 0.04])


def test_a_folder_of_pictures_needs_a_rate(film, tmp_path):
    folder = tmp_path / "shots"
    folder.mkdir()
    for i, frame in enumerate(frames(film)):
        frame.picture.convert("RGB").save(folder / f"{i:03}.png")
    with pytest.raises(UnusableTracks, match="--fps 25"):
        digitising_page(folder)
    assert facts_of(digitising_page(folder, rate=25.0))["times"] == pytest.approx([0.0, 0.04, 0.08])


def test_films_that_cannot_be_clicked_are_refused_in_a_sentence(film, tmp_path):
    with pytest.raises(UnusableTracks, match="at least 2 are needed"):
        digitising_page(film, start=0.09)
    with pytest.raises(UnusableTracks, match="above 0"):
        digitising_page(film, rate=0.0)
    with pytest.raises(UnusableTracks, match="every is 0"):
        digitising_page(film, every=0)
    (tmp_path / "broken.gif").write_bytes(b"GIF89a nothing")
    with pytest.raises(UnreadableFile, match="cannot be read as a picture"):
        digitising_page(tmp_path / "broken.gif")
    folder = tmp_path / "mixed"
    folder.mkdir()
    Image.new("RGB", (8, 8)).save(folder / "a.png")
    Image.new("RGB", (9, 8)).save(folder / "b.png")
    with pytest.raises(UnusableTracks, match="8 x 8 and of 9 x 8"):
        digitising_page(folder, rate=10.0)


def test_a_film_that_is_too_long_says_how_to_shorten_it(monkeypatch, film):
    monkeypatch.setattr("suchus.animals.digitise.MAX_FRAMES", 2)
    with pytest.raises(UnusableTracks, match="--every 2"):
        digitising_page(film)
    assert MAX_FRAMES > 1000
    digitising_page(film, every=2)


def test_the_command_writes_the_page_and_says_what_comes_next(film, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert main(["capture", "walk.gif", "--digitise", "points.html"]) == 0
    assert "suchus capture walk_points.csv" in capsys.readouterr().out
    assert "default-src 'none'" in (tmp_path / "points.html").read_text()
    assert main(["capture", "walk.gif"]) == 2
    assert "--digitise points.html" in capsys.readouterr().err
    assert main(["capture", "walk.gif", "--digitise", "points.txt"]) == 2
    assert "--digitise FILE.html" in capsys.readouterr().err
    assert main(["capture", "walk.gif", "--digitise", "other.html", "--out", "walk.toml"]) == 2
    assert "cannot stand beside --digitise" in capsys.readouterr().err
    assert not (tmp_path / "other.html").exists()


def test_the_command_takes_a_folder_and_says_what_is_no_film(film, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "shots").mkdir()
    for i in range(2):
        Image.new("L", (8, 8), 255 * i).save(tmp_path / "shots" / f"{i}.png")
    assert main(["capture", "shots", "--digitise", "shots.html", "--fps", "25"]) == 0
    assert facts_of((tmp_path / "shots.html").read_text())["times"] == [0.0, 0.04]
    assert main(["capture", "shots"]) == 2
    assert "a folder of its pictures" in capsys.readouterr().err
    (tmp_path / "robot.toml").write_text("name = 'x'")
    assert main(["capture", "robot.toml", "--digitise", "other.html"]) == 2
    assert "robot.toml is no film; a video (.mp4" in capsys.readouterr().err
    assert main(["capture", "missing.gif", "--digitise", "other.html"]) == 2
    assert "there is no file missing.gif" in capsys.readouterr().err


@pytest.fixture(scope="module")
def browser():
    playwright = pytest.importorskip("playwright.sync_api")
    if BROWSER is None:
        pytest.skip("no chromium is installed: the page is not tried in one")
    with playwright.sync_playwright() as started:
        opened = started.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])
        yield opened
        opened.close()


def opened(browser, film, wide=900, high=600):
    page = film.with_suffix(".html")
    page.write_text(digitising_page(film))
    shown = browser.new_context(viewport={"width": wide, "height": high}, accept_downloads=True).new_page()
    shown.set_default_timeout(PATIENCE)
    shown.complaints = []
    shown.on("pageerror", lambda error: shown.complaints.append(str(error)))
    shown.on("console", lambda message: shown.complaints.append(message.text))
    shown.goto(page.as_uri())
    return shown


def click(shown, x, y):
    """Press and release the pointer on a place of the film."""
    place = shown.evaluate(TO_SCREEN, [x, y])
    shown.mouse.click(*place)


def saved(shown, place):
    with shown.expect_download() as download:
        shown.get_by_role("button", name="Save the table").click()
    download.value.save_as(place)
    return place


def test_what_is_clicked_is_the_table_that_capture_reads(browser, film, tmp_path):
    shown = opened(browser, film)
    for point, places in PLACES.items():
        shown.locator(f"[data-point={point}]").click()
        shown.evaluate("state.frame = 0; refresh()")
        for place in places:
            click(shown, *place)
    tracks = read_tracks(saved(shown, tmp_path / "walk_points.csv"))
    assert tracks.points == ("shoulder", "hip")  # in the order of the page
    assert tracks.time == pytest.approx([0.0, 0.04, 0.1])
    truth = np.stack([PLACES[point] for point in tracks.points], axis=1) * [1.0, -1.0]
    assert tracks.position == pytest.approx(truth, abs=1.0)  # a pixel of the screen
    assert shown.complaints == []


def test_a_point_that_is_not_visible_is_a_gap_and_undo_brings_it_back(browser, film, tmp_path):
    shown = opened(browser, film)
    for frame, place in enumerate(PLACES["hip"]):
        shown.evaluate("([frame, place]) => mark(frame, 'hip', place)", [frame, place])
        shown.evaluate("([frame, place]) => mark(frame, 'shoulder', place)", [frame, PLACES["shoulder"][frame]])
    shown.evaluate("state.frame = 1; state.point = 'hip'; refresh()")
    shown.get_by_role("button", name="Not visible here").click()
    tracks = read_tracks(saved(shown, tmp_path / "gap.csv"))
    assert np.isnan(tracks.position[1, tracks.points.index("hip")]).all()
    assert np.isfinite(tracks.position[[0, 2]]).all()
    shown.keyboard.press("Control+z")
    assert np.isfinite(read_tracks(saved(shown, tmp_path / "whole.csv")).position).all()


def test_clicks_outlive_the_page_and_a_table_is_gone_on_with(browser, film, tmp_path):
    shown = opened(browser, film)
    shown.evaluate("mark(0, 'hip', [100, 80]); mark(2, 'tail_tip', [20, 90.5])")
    table = saved(shown, tmp_path / "table.csv")
    shown.reload()
    assert "2 clicks of an earlier visit" in shown.locator("#notice").text_content()
    assert shown.evaluate("[...state.marks]") == [["0 hip", [100, 80]], ["2 tail_tip", [20, 90.5]]]
    other = opened(browser, film)
    other.locator("#load").set_input_files(table)
    other.locator("#notice", has_text="2 clicks of table.csv").wait_for()
    assert other.evaluate("[...state.marks].sort()") == [["0 hip", [100, 80]], ["2 tail_tip", [20, 90.5]]]
    wrong = tmp_path / "wrong.csv"
    wrong.write_text("time [s],hip_x [px],hip_y [px]\n7.0,1,2\n")
    other.locator("#load").set_input_files(wrong)
    other.locator("#notice", has_text="another film").wait_for()
    assert other.evaluate("state.marks.size") == 2


@pytest.mark.parametrize("wide", [390, 1280])
def test_it_fits_the_screen_and_names_what_a_gait_needs(browser, film, wide):
    shown = opened(browser, film, wide, 800)
    assert shown.evaluate("document.documentElement.scrollWidth") <= wide
    assert "shoulder, hip, tail_base, tail_tip, LF, RF, LH, RH" in shown.locator("#count").text_content()
    shown.locator("#name").fill("spine_1")
    shown.get_by_role("button", name="Add").click()
    assert shown.evaluate("state.point") == "spine_1"
    assert shown.locator("#name").input_value() == "spine_2"
    shown.locator("#name").fill("1 bad")
    shown.get_by_role("button", name="Add").click()
    assert "begins with a letter" in shown.locator("#notice").text_content()


def test_a_film_that_is_clicked_whole_gives_the_gait_of_its_tracks(browser, tmp_path):
    """The sample lizard, drawn as a film and clicked to a pixel, walks as its own table does."""
    truth = read_tracks(suchus.sample("lizard"))
    low, high = np.nanmin(truth.position[..., :2], axis=(0, 1)), np.nanmax(truth.position[..., :2], axis=(0, 1))
    scale = 800.0 / (high - low)[0]
    places = (
        np.stack([(truth.position[..., 0] - low[0]) * scale, (high[1] - truth.position[..., 1]) * scale], axis=-1) + 10
    )
    size = tuple(int(v) for v in np.ceil((high - low) * scale) + 20)
    folder = tmp_path / "lizard"
    folder.mkdir()
    for i in range(len(truth.time)):
        Image.new("L", size).save(folder / f"{i:04}.png")
    rate = 1.0 / (truth.time[1] - truth.time[0])
    page = tmp_path / "lizard.html"
    page.write_text(digitising_page(folder, rate=rate))
    shown = browser.new_context(accept_downloads=True).new_page()
    shown.set_default_timeout(PATIENCE)
    shown.goto(page.as_uri())
    marks = [
        [f"{i} {point}", [round(float(x)), round(float(y))]]
        for i, row in enumerate(places)
        for point, (x, y) in zip(truth.points, row, strict=True)
        if np.isfinite(x)
    ]
    shown.evaluate(
        "([points, marks]) => { state.points = points; state.marks = new Map(marks); }", [list(truth.points), marks]
    )
    clicked = observe(read_tracks(saved(shown, tmp_path / "clicked.csv")))
    walk = observe(truth)
    assert clicked.numbers["period"].value == pytest.approx(walk.numbers["period"].value, rel=0.01)
    for leg in ("LF", "RF", "LH", "RH"):
        assert clicked.numbers[f"duty_{leg}"].value == pytest.approx(walk.numbers[f"duty_{leg}"].value, abs=0.03)
