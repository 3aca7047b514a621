"""The viewer in a real browser. One server, one browser, several pages: starting either is what takes time."""

import shutil
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from time import monotonic, sleep
from types import SimpleNamespace
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest
import xarray as xr
from tests.wakes import ringed

from suchus.apps.viewer import Session
from suchus.apps.viewer.bodies import pieces
from suchus.apps.viewer.replay import takes
from suchus.apps.viewer.swim import films, vortex_film
from suchus.core.files import save
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.faults import Limp
from suchus.sim.land import Run, simulate

pages = pytest.importorskip("suchus.apps.viewer.pages", reason="the extra viewer is not installed")
_stand_back = pytest.importorskip("suchus.apps.viewer.server")._stand_back
playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")

BROWSER = next(
    (path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None
)
pytestmark = [
    pytest.mark.skipif(BROWSER is None, reason="no browser (chromium) on this machine"),
    pytest.mark.filterwarnings("default"),  # viser's threads outlive its server for a moment
]
SOFTWARE = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
PATIENCE = 120.0  # [s]; a busy machine without a graphics card draws a picture every few seconds


class Watched:
    """A server of live walks, and the sessions that it opened."""

    def __init__(self) -> None:
        self.sessions: list[Session] = []

        def page(client: Any) -> Any:
            self.sessions.append(Session(ROBOTS["caiman"], replace(GAITS["belly_crawl"], period=1.0)))
            return pages.LivePage(client, self.sessions[-1])

        self.viewer = pages.Viewer(page, port=0, max_browsers=2)


@pytest.fixture(scope="module")
def watched() -> Iterator[Watched]:
    found = Watched()
    yield found
    found.viewer.stop()


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with playwright.sync_playwright() as driver:
        found = driver.chromium.launch(executable_path=BROWSER, args=SOFTWARE)
        yield found
        found.close()


@pytest.fixture
def tabs(browser: Any) -> Iterator[Callable[[str], Any]]:
    """Opens a page; all are closed when the test is over, so that one that failed leaves nothing to be drawn."""
    found: list[Any] = []

    def opened(url: str) -> Any:
        page = browser.new_page(viewport={"width": 480, "height": 320})  # small: every pixel is drawn in software
        found.append(page)
        page.set_default_timeout(1000 * PATIENCE)
        page.goto(url, wait_until="commit")
        return page

    yield opened
    for page in found:
        page.close()


def wait_for(condition: Callable[[], object]) -> None:
    end = monotonic() + PATIENCE
    while not condition():
        assert monotonic() < end, "it never came to that"
        sleep(0.05)


def press(page: Any, name: str) -> None:
    """Press a button by its label; scrolling to it would wait for the picture to be drawn."""
    page.get_by_role("button", name=name, exact=True).first.evaluate("button => button.click()")


def turn(page: Any, knob: str, then: float, done: Callable[[], object]) -> None:
    """Type a number into the box of a slider until it is taken; a busy page loses keys when it draws itself anew."""
    row = f"//label[text()='{knob}']/ancestor::div[contains(@class, 'mantine-Flex-root')][1]"
    box = page.locator(f"xpath={row}//input[contains(@class, 'mantine-NumberInput-input')]")
    end = monotonic() + PATIENCE
    while not done():
        assert monotonic() < end, f"{knob} never became {then}"
        box.evaluate("box => box.focus()")
        page.keyboard.press("Control+A")
        page.keyboard.type(f"{then:g}")
        page.keyboard.press("Enter")
        patient = monotonic() + 10.0
        while not done() and monotonic() < patient:
            sleep(0.05)


def stands_still(session: Session) -> bool:
    """Return whether no time passes in a walk; a page may finish a picture that it has begun."""
    before = session.instant().time
    sleep(0.5)
    return session.instant().time == before


def shown(page: Any, what: str) -> str:
    return str(page.locator(f'[data-suchus="{what}"]').first.text_content())


def noticed(page: Any) -> str:
    return " ".join(page.locator('[data-suchus="notice"]').all_text_contents())


CONTRAST = """() => {
  const parts = (text) => (text.match(/[\\d.]+/g) || []).map(Number);
  const linear = (x) => x / 255 <= 0.04045 ? x / 255 / 12.92 : ((x / 255 + 0.055) / 1.055) ** 2.4;
  const light = (rgb) => 0.2126 * linear(rgb[0]) + 0.7152 * linear(rgb[1]) + 0.0722 * linear(rgb[2]);
  const ground = (one) => {
    for (; one; one = one.parentElement) {
      const [r, g, b, a = 1] = parts(getComputedStyle(one).backgroundColor);
      if (a > 0.5) return [r, g, b];
    }
    return [255, 255, 255];
  };
  const shown = (one) => !one.children.length && one.textContent.trim() && one.getClientRects().length;
  return [...document.querySelectorAll("label, span, div, p, button")].filter(shown).map((one) => {
    const [a, b] = [parts(getComputedStyle(one).color), ground(one)].map(light);
    return [(Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05), one.textContent.trim()];
  }).sort((a, b) => a[0] - b[0]);
}"""
"""Contrast of every word on a page with what lies behind it [-], and the word; the least first."""


@pytest.mark.parametrize(("wide", "high", "sheet"), [(1280, 800, 0.0), (1920, 1080, 0.0), (390, 800, 0.42)])
def test_the_whole_robot_is_seen_between_the_panels_and_above_the_sheet_of_a_phone(wide, high, sheet):
    seen = SimpleNamespace(image_width=wide, image_height=high)
    _stand_back(seen, *pages.camera(ROBOTS["caiman"]))
    ahead = np.array(seen.look_at) - seen.position
    ahead /= np.linalg.norm(ahead)
    right = np.cross(ahead, [0.0, 0.0, 1.0])
    right /= np.linalg.norm(right)
    room = wide if sheet else wide - 700
    for point in ([0.5, 0.0, 0.05], [-0.6, 0.0, 0.0], [0.2, 0.25, 0.0], [0.2, -0.25, 0.0]):  # snout, tail, front feet
        line = np.array(point) - seen.position
        x, y = (line @ side / (line @ ahead) / np.tan(0.36) for side in (right, np.cross(right, ahead)))
        assert abs(x) * high < room
        assert 2 * sheet - 1 < y < 1


def test_a_walk_is_watched_steered_and_broken(tabs, watched):
    first = tabs(watched.viewer.url)
    first.locator('[data-suchus="forward"]').wait_for(state="attached")
    mine = watched.sessions[-1]
    (client,) = watched.viewer._server.get_clients().values()
    bones = sum(len(piece.bones) for piece in pieces(ROBOTS["caiman"]))
    assert 128 < 2 * bones < client._websock_connection.get_message_buffer().max_window_size / 4  # places and turns
    words = first.evaluate(CONTRAST)
    assert len(words) > 40
    assert words[0][0] >= 4.5, words[0]
    turn(first, "limb stroke [% of reach]", 25, lambda: mine.settings.gait.number("stroke") == pytest.approx(0.25))
    turn(first, "hip height [% of reach]", 110, lambda: "cannot follow 110 % of reach" in noticed(first))
    assert 0.52 < mine.settings.gait.height < 1.2
    turn(first, "hip height [% of reach]", 55, lambda: mine.settings.gait.height == pytest.approx(0.55))

    press(first, "make it limp")
    wait_for(lambda: mine.settings.broken == (Limp("LF_yaw"),))
    wait_for(lambda: shown(first, "failed") == "LF yaw limp")
    first.close()
    wait_for(lambda: watched.viewer.watching == 0)


@pytest.mark.slow("a browser draws two pages at once")
def test_walks_in_two_browsers_do_not_disturb_each_other(tabs, watched, tmp_path):
    first = tabs(watched.viewer.url)
    first.locator('[data-suchus="forward"]').wait_for(state="attached")
    mine = watched.sessions[-1]
    press(first, "make it limp")
    wait_for(lambda: mine.settings.broken == (Limp("LF_yaw"),))

    second = tabs(watched.viewer.url)
    second.locator('[data-suchus="forward"]').wait_for(state="attached")
    other = watched.sessions[-1]
    assert other is not mine
    assert other.settings.gait == replace(GAITS["belly_crawl"], period=1.0)
    assert other.settings.broken == ()

    for session in (mine, other):
        session.set_number("speed", 2.0)
    mine.reset()
    for session in (mine, other):
        wait_for(lambda session=session: session.instant().time > 4.0)
    lame, sound = (look.forward / (look.time - 1.0) for look in (mine.instant(), other.instant()))
    assert lame < 0.9 * sound

    first.get_by_label("pause").evaluate("box => box.click()")  # a busy browser shows a walk of some seconds ago
    wait_for(lambda: shown(first, "state") == "paused")
    wait_for(lambda: shown(first, "forward") == f"{mine.instant().forward:+.3f} m")
    wait_for(lambda: stands_still(mine))
    before = other.instant().time
    wait_for(lambda: other.instant().time > before)

    second.close()
    wait_for(lambda: watched.viewer.watching == 1)
    wait_for(lambda: stands_still(other))  # the browser is gone, and its walk with it
    first.screenshot(path=tmp_path / "viewer.png")
    assert (tmp_path / "viewer.png").stat().st_size > 20_000
    first.close()
    wait_for(lambda: watched.viewer.watching == 0)


def test_a_record_and_a_swim_are_played_back(tabs, tmp_path):
    runs = [Run(robot=ROBOTS["caiman"], gait=GAITS[name], label=name) for name in ("belly_crawl", "limbs_only")]
    walk = takes(save(simulate(runs, duration=1.5, timestep=0.005, sample_stride=5), tmp_path / "walk.nc"))
    swim, curves = films(save(swimming(), tmp_path / "swim.nc"))
    space = vortex_film(save(ringed(), tmp_path / "space.nc"))
    for page, told in (
        (lambda client: pages.ReplayPage(client, walk, walk), "ghost 1: limbs_only"),
        (lambda client: pages.SwimPage(client, swim, curves), "of the last cycle"),
        (lambda client: pages.VortexPage(client, space), "surfaces of Q = 4 1/s²"),
    ):
        viewer = pages.Viewer(page, port=0)
        try:
            tab = tabs(viewer.url)
            tab.get_by_text(told).wait_for(state="attached")
            tab.close()
        finally:
            viewer.stop()


def swimming() -> xr.Dataset:
    line = np.linspace(0.0, 1.0, 9)
    data = {"free_vorticity": (("free_frame", "free_y", "free_x"), np.random.default_rng(0).normal(size=(3, 8, 20)))}
    for name, values in (("x", line), ("y", 0 * line), ("heading", 0 * line), ("half_width", 0.05 + 0 * line)):
        data[f"free_midline_{name}"] = (("free_frame", "free_station"), np.tile(values, (3, 1)))
    coords = {"free_x": np.linspace(-0.3, 2.0, 20), "free_y": np.linspace(-0.5, 0.5, 8), "free_frame": [0.3, 0.6, 1.0]}
    return xr.Dataset(data, coords=coords)


def test_one_browser_too_many_is_told_so(watched):
    told: list[str] = []
    crowd = SimpleNamespace(client_id=10**6, gui=SimpleNamespace(add_markdown=told.append))
    watched.viewer._pages = {1: None, 2: None}
    try:
        watched.viewer._connect_client(crowd)
    finally:
        watched.viewer._pages = {}
    assert "All 2 places are taken" in told[0]


def test_a_taken_port_is_told_in_a_sentence(watched):
    port = urlsplit(watched.viewer.url).port
    with pytest.raises(pages.CannotServe, match="take another --port"):
        pages.Viewer(lambda client: None, port=port)


def test_only_this_computer_can_look(watched):
    assert watched.viewer._server.get_host() == "127.0.0.1"
    assert watched.viewer._server.request_share_url() is None
    assert Path(BROWSER or "").exists()
