"""Take the pictures of the viewer's pages and of a replay, still and moving, in docs/pictures, with a browser.

Usage: python tools/viewer_pictures.py [live] [replay] [animal] [file] [film] [page]; needs the extra viewer,
playwright, chromium, and for the laboratory in one page its engine.
"""

import shutil
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import xarray as xr
from PIL import Image
from playwright.sync_api import Page, sync_playwright

from lighter import lighten
from suchus.animals.capture import Camera, SyntheticAnimal, film_animal
from suchus.apps.laboratory.page import laboratory_page
from suchus.apps.viewer import Session
from suchus.apps.viewer.pages import LivePage, ReplayPage, Viewer
from suchus.apps.viewer.replay import place_animal, takes
from suchus.core.files import save
from suchus.robot.gaits import GAITS, default_gait
from suchus.robot.motion import START
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.visual.replay import replay as replay_file

PICTURES = Path(__file__).parents[1] / "docs" / "pictures"
SIZE = {"width": 1400, "height": 860}
_SOFTWARE = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
_SLOWEST = 0.05  # playback speed [-]: hardly anything moves while the picture is taken
_PATIENCE = 300.0  # [s]; a browser without a graphics card draws a picture every few seconds
_SHOWN = 6.9  # [s]; time at which the replay as one file is shown
_PAINTED = 20.0  # [s] until scene and plots have been drawn
_SIMULATE = """(time) => {
  let before = -1, reached = 0;
  while (reached < time - 1e-6 && reached > before) { before = reached; reached = laboratory.page.advance(time); }
  laboratory.state.time = reached;
  laboratory.redraw();
}"""
_FRAMES = 60  # of the moving picture [-]


def live(client: Any) -> LivePage:
    """Return a page whose walk has gone on for 12 s, and 4 s more with a limp joint."""
    session = Session(ROBOTS["caiman"], GAITS["belly_crawl"])
    session.advance(12.0)
    session.break_part("RF_yaw", "limp")
    session.advance(4.0)
    session.set_number("speed", _SLOWEST)
    return LivePage(client, session)


def replay(client: Any) -> ReplayPage:
    """Return a page that plays a crawl near its end, with the crawl by limbs only as a ghost."""
    with TemporaryDirectory() as folder:
        both = takes(save(_crawls(), Path(folder) / "crawl.nc"))
    page = ReplayPage(client, both, both)
    page._player.seek(6.4)
    page._player.speed = _SLOWEST
    return page


def animal(client: Any) -> ReplayPage:
    """Return a page that plays a crawl with a lizard beside it, whose film is made up as in the eighth example."""
    lizard = SyntheticAnimal(
        trunk=0.12, tail=0.20, period=0.8, duty_factor=0.7, limb_phases=(0.0, 0.5, 0.25, 0.75), stride=0.15,
        outward=0.06, lift=0.02, spine_bend=0.5, spine_rightmost=0.2, tail_bend=0.7, tail_lag=1 / 3, tail_wave=0.0,
    )  # fmt: skip
    camera = Camera(rate=100.0, noise=0.0005, lost=0.05, heading=-0.7, scale=4000.0, heights=False, seed=0)
    tracks = replace(film_animal(lizard, camera, cycles=4), source="lizard.csv")
    with TemporaryDirectory() as folder:
        (take, _) = takes(save(_crawls(), Path(folder) / "crawl.nc"))
    page = ReplayPage(client, (take,), animals=(place_animal(tracks, take),))
    page._player.seek(1.4)
    page._player.speed = _SLOWEST
    return page


def _crawls() -> xr.Dataset:
    runs = [
        Run(robot=ROBOTS["caiman"], gait=GAITS[gait], label=label)
        for gait, label in (("belly_crawl", "spine and tail"), ("limbs_only", "limbs only"))
    ]
    return simulate(runs, duration=9.0, timestep=0.005, sample_stride=2)


DRAWN: dict[str, tuple[Callable[[Any], Any], str]] = {
    "live": (live, "viewer.png"),
    "replay": (replay, "viewer_replay.png"),
    "animal": (animal, "viewer_animal.png"),
}
"""What is shown, and the name of the picture, by the word on the command line."""


@contextmanager
def _browser(width: int, height: int) -> Iterator[Page]:
    """Open a page of a browser, as large as said [px]."""
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=_SOFTWARE)
        yield browser.new_page(viewport={"width": width, "height": height})
        browser.close()


def take(name: str) -> Path:
    """Take a picture and return its path."""
    page, file = DRAWN[name]
    viewer = Viewer(page, port=0)
    try:
        with _browser(**SIZE) as tab:
            tab.set_default_timeout(1000 * _PATIENCE)
            tab.goto(viewer.url, wait_until="commit")
            tab.get_by_text("feet that stand").wait_for(state="attached")
            for button in tab.locator(".mantine-Notification-closeButton").all():
                button.evaluate("button => button.click()")
            tab.wait_for_timeout(1000 * _PAINTED)
            tab.screenshot(path=PICTURES / file)
    finally:
        viewer.stop()
    return lighten(PICTURES / file)


@contextmanager
def _crawls_shown(at: str = "", **size: int) -> Iterator[Page]:
    """Show the replay of the two crawls as one file, ``at`` what follows its address."""
    record = _crawls()
    page = replay_file(
        record.isel(run=0), ROBOTS["caiman"], ghost=record.isel(run=1), labels=("spine and tail", "limbs only"),
        title="Crawling with spine and tail, and without",
    )  # fmt: skip
    with TemporaryDirectory() as folder:
        place = Path(folder) / "replay.html"
        place.write_text(page, encoding="utf-8")
        with _browser(**size) as tab:
            tab.goto(place.as_uri() + at)
            yield tab


def take_file() -> Path:
    """Take the picture of a replay as one file, near the end of the two crawls, and return its path."""
    with _crawls_shown(width=1200, height=720) as tab:
        tab.locator("#time").evaluate(
            f"slider => {{ slider.value = {_SHOWN}; slider.dispatchEvent(new Event('input')) }}"
        )
        tab.wait_for_timeout(1000 * _PAINTED)
        tab.screenshot(path=PICTURES / "replay.png")
    return lighten(PICTURES / "replay.png")


def take_film() -> Path:
    """Take the moving picture of the two crawls, two cycles at twice their speed, and return its path."""
    pictures = []
    with _crawls_shown(at="#t=1", width=720, height=360) as tab:
        tab.add_style_tag(content="header, footer { display: none !important }")
        tab.evaluate(
            "() => { const { state, camera } = window.suchus; state.follow = state.support = state.forces = false;"
            "Object.assign(camera, { azimuth: -2.0, elevation: 0.6, distance: 1.8, target: [0.36, 0.36, 0.0] }); }"
        )
        for frame in range(_FRAMES + 1):
            tab.evaluate(f"window.suchus.seek({1.0 + 8.0 * frame / _FRAMES})")
            tab.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
            pictures.append(Image.open(BytesIO(tab.locator("main").screenshot())).convert("RGB"))
    lasting = [4000 // _FRAMES] * _FRAMES + [1500]
    pictures[0].save(
        PICTURES / "crawl.webp",
        save_all=True,
        append_images=pictures[1:],
        duration=lasting,
        loop=0,
        quality=55,
        method=6,
    )
    return PICTURES / "crawl.webp"


def take_page() -> Path:
    """Take the picture of the laboratory in one page after two cycles, and return its path."""
    robot = ROBOTS["caiman"]
    text = laboratory_page(robot, default_gait(robot))
    with TemporaryDirectory() as folder, _browser(width=1280, height=800) as tab:
        file = Path(folder) / "caiman.html"
        file.write_text(text, encoding="utf-8")
        tab.set_default_timeout(1000 * _PATIENCE)
        tab.emulate_media(reduced_motion="reduce")
        tab.goto(file.as_uri())
        tab.wait_for_function("document.body.dataset.live === 'ready'")
        tab.evaluate(_SIMULATE, START + 2 * default_gait(robot).period + 0.1)
        tab.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
        tab.screenshot(path=PICTURES / "page.png")
    return lighten(PICTURES / "page.png")


ONE_FILE = {"file": take_file, "film": take_film, "page": take_page}
"""How pictures of pages that are one file are taken, by the word on the command line."""


if __name__ == "__main__":
    for word in sys.argv[1:] or (*DRAWN, *ONE_FILE):
        if word not in (*DRAWN, *ONE_FILE):
            sys.exit(f"viewer_pictures: {word!r} is not a picture; {', '.join((*DRAWN, *ONE_FILE))} is allowed.")
        print(ONE_FILE[word]() if word in ONE_FILE else take(word))
