"""Take the pictures of the viewer's pages and of a replay, in docs/pictures, with a browser.

Usage: python tools/viewer_pictures.py [live] [replay] [animal] [file]; needs the extra viewer, playwright and chromium.
"""

import shutil
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import xarray as xr
from playwright.sync_api import sync_playwright

from lighter import lighten
from suchus.capture import Camera, SyntheticAnimal, film_animal
from suchus.gaits import GAITS
from suchus.land import Run, simulate
from suchus.record import save
from suchus.replay import replay as replay_file
from suchus.robots import ROBOTS
from suchus.viewer import Session
from suchus.viewer.pages import LivePage, ReplayPage, Viewer
from suchus.viewer.replay import beside, takes

PICTURES = Path(__file__).parents[1] / "docs" / "pictures"
SIZE = {"width": 1400, "height": 860}
_SOFTWARE = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
_SLOWEST = 0.05  # playback speed [-]: hardly anything moves while the picture is taken
_PATIENCE = 300.0  # [s]; a browser without a graphics card draws a picture every few seconds
_SHOWN = 6.9  # [s]; time at which the replay as one file is shown
_PAINTED = 20.0  # [s] until scene and plots have been drawn


def live(client: Any) -> LivePage:
    """Return a page whose walk has gone on for 12 s, and 4 s more with a limp joint."""
    session = Session(ROBOTS["caiman"], GAITS["belly_crawl"])
    session.advance(12.0)
    session.lose("RF_yaw", "limp")
    session.advance(4.0)
    session.put("speed", _SLOWEST)
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
    page = ReplayPage(client, (take,), animals=(beside(tracks, take),))
    page._player.seek(1.4)
    page._player.speed = _SLOWEST
    return page


def _crawls() -> xr.Dataset:
    runs = [
        Run(robot=ROBOTS["caiman"], gait=GAITS[gait], label=label)
        for gait, label in (("belly_crawl", "spine and tail"), ("limbs_only", "limbs only"))
    ]
    return simulate(runs, duration=9.0, timestep=0.005, every=2)


DRAWN: dict[str, tuple[Callable[[Any], Any], str]] = {
    "live": (live, "viewer.png"),
    "replay": (replay, "viewer_replay.png"),
    "animal": (animal, "viewer_animal.png"),
}
"""What is shown, and the name of the picture, by the word on the command line."""


def take(name: str) -> Path:
    """Take a picture and return its path."""
    page, file = DRAWN[name]
    viewer = Viewer(page, port=0)
    try:
        with sync_playwright() as driver:
            browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=_SOFTWARE)
            tab = browser.new_page(viewport=SIZE)
            tab.set_default_timeout(1000 * _PATIENCE)
            tab.goto(viewer.url, wait_until="commit")
            tab.get_by_text("feet that stand").wait_for(state="attached")
            for button in tab.locator(".mantine-Notification-closeButton").all():
                button.evaluate("button => button.click()")
            tab.wait_for_timeout(1000 * _PAINTED)
            tab.screenshot(path=PICTURES / file)
            browser.close()
    finally:
        viewer.stop()
    return lighten(PICTURES / file)


def take_file() -> Path:
    """Take the picture of a replay as one file, near the end of the two crawls, and return its path."""
    record = _crawls()
    page = replay_file(
        record.isel(run=0), ROBOTS["caiman"], ghost=record.isel(run=1), labels=("spine and tail", "limbs only"),
        title="Crawling with spine and tail, and without",
    )  # fmt: skip
    with TemporaryDirectory() as folder, sync_playwright() as driver:
        place = Path(folder) / "replay.html"
        place.write_text(page, encoding="utf-8")
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=_SOFTWARE)
        tab = browser.new_page(viewport={"width": 1200, "height": 720})
        tab.goto(place.as_uri())
        tab.locator("#time").evaluate(
            f"slider => {{ slider.value = {_SHOWN}; slider.dispatchEvent(new Event('input')) }}"
        )
        tab.wait_for_timeout(1000 * _PAINTED)
        tab.screenshot(path=PICTURES / "replay.png")
        browser.close()
    return lighten(PICTURES / "replay.png")


if __name__ == "__main__":
    for word in sys.argv[1:] or (*DRAWN, "file"):
        if word not in (*DRAWN, "file"):
            sys.exit(f"viewer_pictures: {word!r} is not a picture; {', '.join(DRAWN)} or file is allowed.")
        print(take_file() if word == "file" else take(word))
