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

_FRAMES_PER_RENEWAL = 3  # frames for one renewal of numbers and track
_PLOT_INTERVAL = 0.3  # [s]; between two redraws of the plots


class WatchedRobot(NamedTuple):
    """State of a watched robot."""

    time: float
    """Time since the robot began to move [s]."""
    state: Mapping[str, np.ndarray]
    """Values by the names of ``record.VARIABLES``, without run and time."""
    level: float | None
    """Level of the water above the ground at the start [m]; None on dry land."""
    status: str
    """Description of what the robot does."""


class WatchPage(BrowserPage):
    """A browser and a robot that moves by itself.

    Args:
        client: viser's handle of the browser.
        robot: the robot.
        get_robot: returns what is seen now; called from a thread of the browser's.
    """

    def __init__(self, client: Any, robot: Robot, get_robot: Callable[[], WatchedRobot]) -> None:
        super().__init__(client)
        self._get_robot = get_robot
        with client.gui.add_folder("Look"):
            self._skin = client.gui.add_checkbox("skin", initial_value=True, hint="Off: the shapes that are simulated.")
            self._follow = client.gui.add_checkbox("camera follows", initial_value=True)
        self._dock()
        self._plots = Plots(client.gui, uplot, robot)
        self._stage = WalkScene(client.scene, robot)
        self._stage.show_geometry("skin")
        self._skin.on_update(lambda _: self._stage.show_geometry("skin" if self._skin.value else "collision geoms"))
        self._history = History(layout(robot).limb_names)
        self._origin = self._get_robot().state["centre_of_mass"]
        self._pictures, self._plotted, self._last_time = 0, 0.0, -1.0

    def draw(self, clock: float, elapsed: float) -> None:
        """Draw the instant that is reached."""
        del elapsed
        watched_robot = self._get_robot()
        self._pictures += 1
        forward, lateral_displacement, _ = watched_robot.state["centre_of_mass"] - self._origin
        if watched_robot.time != self._last_time:
            self._last_time = watched_robot.time
            self._history.note(watched_robot.time, watched_robot.state, (float(forward), float(lateral_displacement)))
        with self._client.atomic():
            self._stage.set_pose(watched_robot.state, (0.0, 0.0), follow=bool(self._follow.value))
            self._stage.show(watched_robot.state)
            self._stage.flood(watched_robot.level)
            if self._pictures % _FRAMES_PER_RENEWAL == 1:
                self._stage.extend_track(watched_robot.state["centre_of_mass"])
                self._status.content = _status(watched_robot, float(forward), float(lateral_displacement))
        if clock - self._plotted > _PLOT_INTERVAL:
            self._plotted = clock
            self._plots.draw(self._history.table())


def _status(watched_robot: WatchedRobot, forward: float, lateral_displacement: float) -> str:
    """Return the head of the page as HTML."""
    cells = "".join(
        f'<div style="white-space:nowrap"><div style="font-size:11px;color:#666">{label}</div>'
        f'<div style="font-size:17px;font-weight:600" data-suchus="{label}">{value}</div></div>'
        for label, value in (
            ("time", f"{watched_robot.time:.1f} s"),
            ("forward", f"{forward:+.3f} m"),
            ("to the left", f"{lateral_displacement:+.3f} m"),
            *(
                (("under water", f"{float(watched_robot.state['share_under']):.0%}"),)
                if watched_robot.level is not None
                else ()
            ),
        )
    )
    return (
        f'<div style="padding:4px 12px;font-family:sans-serif">'
        f'<div style="display:flex;flex-wrap:wrap;gap:2px 12px">{cells}</div>'
        f'<div style="font-size:12px;color:#444" data-suchus="state">{escape(watched_robot.status)}</div></div>'
    )
