"""The page in a real browser, from a file, offline."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from suchus.core.rotation import rotate
from suchus.robot.design.ground import Ground, slope
from suchus.sim.record import ground_text
from suchus.visual import pages
from suchus.visual.replay import replay, save

playwright = pytest.importorskip("playwright.sync_api")
BROWSER = shutil.which("chromium") or shutil.which("chromium-browser")
FLAGS = [
    "--no-sandbox",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
SLOPE = Ground(uphill=0.15, sideways=-0.1)
pytestmark = pytest.mark.skipif(BROWSER is None, reason="no chromium is installed: the replay is not tried in one")


@pytest.fixture(scope="module")
def browser():
    with playwright.sync_playwright() as started:
        opened = started.chromium.launch(executable_path=BROWSER, args=FLAGS)
        yield opened
        opened.close()


@pytest.fixture(scope="module")
def address(robot, crawled, limped, tmp_path_factory):
    sloped = crawled.assign(stands_on=((), ground_text(SLOPE)))
    page = replay(
        sloped, robot, ghost=limped, labels=("intact", "one limp leg"), title="A limp leg", caption="What is seen."
    )
    return save(page, tmp_path_factory.mktemp("replay") / "run.html").as_uri()


@pytest.fixture(scope="module")
def page(browser, address):
    """The page at rest at the start, with everything that it complained of or asked for."""
    shown = browser.new_page(viewport={"width": 640, "height": 480})
    shown.complaints, shown.asked = [], []
    shown.on("console", lambda message: shown.complaints.append(message.text))
    shown.on("pageerror", lambda error: shown.complaints.append(str(error)))
    shown.on("request", lambda request: shown.asked.append(request.url))
    shown.goto(address + "#t=0")
    until(shown, "window.suchus && window.suchus.mass() !== null")
    yield shown
    shown.close()


def fits_a_phone(browser, address):
    """The page asks for no more than a phone's width, upright or on its side; what it shows is explained in sight."""
    return all(fits(browser, address, wide, high) for wide, high in ((390, 760), (844, 390)))


def fits(browser, address, wide, high):
    shown = browser.new_page(viewport={"width": wide, "height": high})
    shown.goto(address + "#t=0")
    until(shown, "window.suchus")
    taken = shown.evaluate("document.documentElement.scrollWidth")
    ends = shown.evaluate("[...document.querySelectorAll('footer *')].map((one) => one.getBoundingClientRect().right)")
    explained = shown.get_by_text("What is seen.")
    seen = explained.is_visible() and explained.bounding_box()["y"] < high / 2
    shown.close()
    return taken <= wide and max(ends) <= wide and seen


def until(shown, condition):
    for _ in range(200):
        if shown.evaluate(f"!!({condition})"):
            return
        shown.wait_for_timeout(50)
    raise AssertionError(f"{condition} never came true")


def test_it_plays_from_a_file_without_network_or_complaint(page, address):
    start = page.evaluate("window.suchus.state.time")
    page.get_by_role("button", name="Play").click()
    until(page, f"window.suchus.state.time > {start} + 0.05")
    page.get_by_role("button", name="Pause").click()
    assert not page.evaluate("window.suchus.state.playing")
    assert page.complaints == []
    assert page.asked == [address]


def test_the_time_slider_moves_the_robot(page, crawled):
    page.evaluate("window.suchus.seek(0)")
    until(page, "window.suchus.mass()[0][0] < 0.2")
    before, picture = page.evaluate("window.suchus.mass()[0]"), page.locator("main").screenshot()
    page.get_by_role("slider", name="Time").fill("2.4")
    expected = crawled.centre_of_mass.interp(time=2.4).values
    until(page, f"Math.abs(window.suchus.mass()[0][0] - {expected[0]}) < 1e-3")  # drawn one frame later
    after = page.evaluate("window.suchus.mass()[0]")
    assert after != before
    assert after == pytest.approx(expected, abs=1e-3)
    assert page.locator("main").screenshot() != picture


def test_the_camera_stands_upright_beside_a_slope(page):
    """In the frame of the ground, in which everything is drawn, what is up leans back."""
    azimuth, elevation = page.evaluate("[window.suchus.camera.azimuth, window.suchus.camera.elevation]")
    up = [-np.sin(elevation) * np.cos(azimuth), -np.sin(elevation) * np.sin(azimuth), np.cos(elevation)]
    seen = rotate(slope(SLOPE.uphill, SLOPE.sideways), np.array(page.evaluate("window.suchus.up()")))
    assert seen == pytest.approx(up, abs=1e-6)


def test_controls_are_named_and_the_keyboard_works(page):
    for role, name in (
        ("combobox", "Speed"),
        ("combobox", "View"),
        ("combobox", "Compare"),
        ("checkbox", "foot forces"),
    ):
        assert page.get_by_role(role, name=name).count() == 1
    assert "Three-dimensional replay" in page.locator("canvas").get_attribute("aria-label")
    page.locator("canvas").focus()
    azimuth = page.evaluate("window.suchus.camera.azimuth")
    page.keyboard.press("ArrowLeft")
    assert page.evaluate("window.suchus.camera.azimuth") != azimuth
    page.keyboard.press("End")
    assert page.evaluate("window.suchus.state.time") == pytest.approx(2.5, abs=0.1)


def test_the_second_run_can_be_hidden_and_the_view_changed(page):
    until(page, "window.suchus.mass().length === 2")
    page.get_by_role("combobox", name="Compare").select_option("hidden")
    until(page, "window.suchus.mass().length === 1")
    page.get_by_role("combobox", name="View").select_option("above")
    assert page.evaluate("window.suchus.camera.elevation") > 1.5
    page.get_by_role("button", name="Switch between light and dark").click()
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"


def test_a_phone_shows_the_scene_and_folds_the_controls(browser, address):
    for width, is_open in ((390, False), (1280, True)):
        shown = browser.new_page(viewport={"width": width, "height": 844})
        shown.goto(address + "#t=0")
        until(shown, "window.suchus && window.suchus.mass() !== null")
        assert shown.locator("#controls").get_attribute("open") == ("" if is_open else None)
        assert shown.get_by_role("combobox", name="View").count() == is_open
        scene = shown.locator("#scene").bounding_box()
        assert scene["height"] > 844 / 2
        shown.locator(".head").first.wait_for(state="attached")
        assert shown.locator(".head").first.is_visible()
        shown.close()


def test_it_fits_a_phone(browser, address):
    assert fits_a_phone(browser, address)


def test_in_water_the_depth_is_said_and_the_camera_looks_at_the_swimmer(browser, robot, crawled, tmp_path):
    below = np.where(crawled.time < 1.5, 0.6, -0.2)
    wet = crawled.assign(water_level=("time", crawled.centre_of_mass.sel(xyz="z").values + below))
    shown = browser.new_page()
    shown.goto(save(replay(wet, robot), tmp_path / "wet.html").as_uri() + "#t=1")
    until(shown, "window.suchus && window.suchus.mass()")
    assert "centre of mass 0.60 m deep" in shown.locator("#told").inner_text()
    shown.evaluate("window.suchus.seek(2)")
    until(shown, 'document.getElementById("told").textContent.includes("centre of mass 0.20 m above the water")')
    assert shown.evaluate("window.suchus.camera.target[2] - window.suchus.mass()[0][2]") == pytest.approx(0.0)
    shown.close()


def test_without_webgl_there_is_a_picture(browser, address):
    shown = browser.new_page()
    shown.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    shown.goto(address)
    assert shown.locator("#still svg").is_visible()
    assert not shown.locator("#play").is_visible()
    shown.close()


def test_the_player_names_no_address():
    folder = Path(pages.__file__).parent / "templates"
    names_of_kinds = "http://www.w3.org/2000/svg"  # not fetched: it says what the icon is
    texts = (file.read_text().replace(names_of_kinds, "") for file in folder.iterdir())
    assert not any("http:" in text or "https:" in text for text in texts)
