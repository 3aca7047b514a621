"""``suchus demo``: a first walk, live in the browser where that can be, else as a page."""

from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated
from webbrowser import BaseBrowser

import tyro
import xarray as xr

from suchus.apps.cli.doctor import browser
from suchus.apps.cli.options import parse
from suchus.apps.cli.terminal import working
from suchus.apps.cli.view import ViewWalkOptions, serve_walk
from suchus.apps.cli.word_checks import check_page
from suchus.core.checks import require
from suchus.core.files import check_replaceable, check_writable
from suchus.core.progress import Progress, staged
from suchus.robot.gaits import GAITS
from suchus.robot.robots import ROBOTS
from suchus.sim.land import Run, simulate
from suchus.sim.metrics import displacement, speed
from suchus.visual.replay import replay, save

ROBOT, GAITS_SHOWN = "caiman", ("belly_crawl", "limbs_only")
"""Robot and gaits that are shown: live the first gait, on a page both side by side."""
_VIEWER_PACKAGES = ("viser", "mjviser")
"""Packages of the extra ``viewer``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DemoOptions:
    """Options of ``suchus demo``."""

    no_browser: Annotated[
        bool, tyro.conf.FlagCreatePairsOff, tyro.conf.arg(help="Open no browser: only write the page and name it.")
    ] = False
    out: Annotated[Path, tyro.conf.arg(help="The page that is written where no walk can be shown live.")] = Path(
        "suchus_demo.html"
    )
    port: Annotated[int, tyro.conf.arg(help="Port of a live walk; by default any that is free.")] = 0

    def __post_init__(self) -> None:
        require("demo", "port", self.port, 0, 65535, "")


def demo(words: Sequence[str]) -> int:
    """Show a first walk and return 0.

    With a browser and the extra ``viewer`` the walk is live and goes on until interrupted. Else a page is written that
    plays it, and opened where there is a browser.

    Raises:
        SuchusError: the words make no sense, or the page cannot be written.
    """
    description = "A robot walks: live in the browser, or on a page that plays offline."
    options = parse(DemoOptions, "suchus demo", words, description)
    opener = None if options.no_browser else browser()
    live = all(find_spec(name) for name in _VIEWER_PACKAGES)
    if opener is not None and live:
        return serve_walk(ViewWalkOptions(port=options.port), opener.open)
    return _write_page(options.out, opener, live)


def _write_page(output: Path, opener: BaseBrowser | None, live: bool) -> int:
    """Write the page, print its path and the results, and return 0.

    Args:
        output: path of the page.
        opener: browser that opens the page; None: none.
        live: whether the packages of a live walk are installed.
    """
    check_page(output)
    check_replaceable(output)
    check_writable(output.parent)
    with working() as bars:
        move = bars.reporter("demo")
        walks = _walks(staged(move, "walking", 0.0, 0.8))
        move("drawing", 0.9)
        path = save(_replay_html(walks), output).absolute()
    robot = ROBOTS[ROBOT]
    print(f"{robot.name}: a robot of {robot.length:.2f} m and {robot.mass:.1f} kg; two cycles of its crawl")
    for name in GAITS_SHOWN:
        forward = float(displacement(walks.sel(run=GAITS_SHOWN.index(name))).sel(xyz="x"))
        mean = float(speed(walks.sel(run=GAITS_SHOWN.index(name))))
        print(f"  {name.replace('_', ' '):12s} {mean:.3f} m/s, {forward:.2f} m forward")
    if opener is not None:
        opener.open(path.as_uri())
    print(f"the walk, in any browser: {path}")
    if not live:
        print("live, with sliders: pip install 'suchus[viewer]'")
    return 0


def _walks(progress: Progress) -> xr.Dataset:
    """Return the record of all gaits that are shown."""
    runs = [Run(robot=ROBOTS[ROBOT], gait=GAITS[name]) for name in GAITS_SHOWN]
    return simulate(runs, progress=progress)


def _replay_html(walks: xr.Dataset) -> str:
    """Return the walks as a page."""
    labels = [name.replace("_", " ") for name in GAITS_SHOWN]
    return replay(
        walks.isel(run=0),
        ROBOTS[ROBOT],
        ghost=walks.isel(run=1),
        labels=labels,
        title="A first walk",
        caption="The same legs, with spine and tail at work, and (half transparent) with the legs alone.",
    )
