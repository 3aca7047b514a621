"""One browser that watches a robot which somebody else moves: an emulated one, over its bus."""

from collections.abc import Callable, Mapping
from html import escape
from typing import Any, NamedTuple

import numpy as np
from viser import uplot

from suchus.apps.viewer.history import History
from suchus.apps.viewer.plots import Plots
from suchus.apps.viewer.server import BrowserPage
from suchus.apps.viewer.stage import WalkScene
from suchus.robot.design import Robot, layout

_DRAWN = 3  # frames for one renewal of numbers and track
_PLOT = 0.3  # [s]; between two redraws of the plots


class WatchedRobot(NamedTuple):
    """What is seen of a robot now."""

    time: float
    """Since it began [s]."""
    now: Mapping[str, np.ndarray]
    """By the names of ``record.VARIABLES``, without run and time."""
    level: float | None
    """Of the water above the ground where it began [m]; None on dry land."""
    state: str
    """What it does, in words."""


class WatchPage(BrowserPage):
    """A browser and a robot that moves by itself.

    Args:
        client: viser's handle of the browser.
        robot: the robot.
        look: returns what is seen now; called from a thread of the browser's.
    """

    def __init__(self, client: Any, robot: Robot, look: Callable[[], WatchedRobot]) -> None:
        super().__init__(client)
        self._look = look
        with client.gui.add_folder("Look"):
            self._skin = client.gui.add_checkbox("skin", initial_value=True, hint="Off: the shapes that are simulated.")
            self._follow = client.gui.add_checkbox("camera follows", initial_value=True)
        self._dock()
        self._plots = Plots(client.gui, uplot, robot)
        self._stage = WalkScene(client.scene, robot)
        self._stage.look("skin")
        self._skin.on_update(lambda _: self._stage.look("skin" if self._skin.value else "collision geoms"))
        self._history = History(layout(robot).limb_names)
        self._origin = self._look().now["centre_of_mass"]
        self._pictures, self._plotted, self._before = 0, 0.0, -1.0

    def draw(self, now: float, passed: float) -> None:
        """Draw the instant that is reached."""
        del passed
        seen = self._look()
        self._pictures += 1
        forward, aside, _ = seen.now["centre_of_mass"] - self._origin
        if seen.time != self._before:
            self._before = seen.time
            self._history.note(seen.time, seen.now, (float(forward), float(aside)))
        with self._client.atomic():
            self._stage.place(seen.now, (0.0, 0.0), follow=bool(self._follow.value))
            self._stage.show(seen.now)
            self._stage.flood(seen.level)
            if self._pictures % _DRAWN == 1:
                self._stage.go(seen.now["centre_of_mass"])
                self._status.content = _status(seen, float(forward), float(aside))
        if now - self._plotted > _PLOT:
            self._plotted = now
            self._plots.draw(self._history.table())


def _status(seen: WatchedRobot, forward: float, aside: float) -> str:
    """Return the head of the page as HTML."""
    cells = "".join(
        f'<div style="white-space:nowrap"><div style="font-size:11px;color:#666">{label}</div>'
        f'<div style="font-size:17px;font-weight:600" data-suchus="{label}">{value}</div></div>'
        for label, value in (
            ("time", f"{seen.time:.1f} s"),
            ("forward", f"{forward:+.3f} m"),
            ("to the left", f"{aside:+.3f} m"),
            *((("under water", f"{float(seen.now['share_under']):.0%}"),) if seen.level is not None else ()),
        )
    )
    return (
        f'<div style="padding:4px 12px;font-family:sans-serif">'
        f'<div style="display:flex;flex-wrap:wrap;gap:2px 12px">{cells}</div>'
        f'<div style="font-size:12px;color:#444" data-suchus="state">{escape(seen.state)}</div></div>'
    )
