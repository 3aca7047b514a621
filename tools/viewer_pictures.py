"""Take the pictures of the viewer's page, docs/pictures/viewer.png and viewer_replay.png, with a browser.

Usage: python tools/viewer_pictures.py [live] [replay]; needs the extra viewer, playwright and chromium.
"""

import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from playwright.sync_api import sync_playwright

from suchus.gaits import GAITS
from suchus.land import Run, simulate
from suchus.record import save
from suchus.robots import ROBOTS
from suchus.viewer import Session
from suchus.viewer.pages import LivePage, ReplayPage, Viewer
from suchus.viewer.replay import takes

PICTURES = Path(__file__).parents[1] / "docs" / "pictures"
SIZE = {"width": 1400, "height": 860}
_SOFTWARE = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
_SLOWEST = 0.05  # playback speed [-]: hardly anything moves while the picture is taken
_PATIENCE = 300.0  # [s]; a browser without a graphics card draws a picture every few seconds
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
    runs = [
        Run(robot=ROBOTS["caiman"], gait=GAITS[gait], label=label)
        for gait, label in (("belly_crawl", "spine and tail"), ("limbs_only", "limbs only"))
    ]
    with TemporaryDirectory() as folder:
        both = takes(save(simulate(runs, duration=9.0, timestep=0.005, every=2), Path(folder) / "crawl.nc"))
    page = ReplayPage(client, both, both)
    page._player.seek(6.4)
    page._player.speed = _SLOWEST
    return page


DRAWN: dict[str, tuple[Callable[[Any], Any], str]] = {
    "live": (live, "viewer.png"),
    "replay": (replay, "viewer_replay.png"),
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


if __name__ == "__main__":
    for word in sys.argv[1:] or DRAWN:
        if word not in DRAWN:
            sys.exit(f"viewer_pictures: {word!r} is not a picture; {' or '.join(DRAWN)} is allowed.")
        print(take(word))
