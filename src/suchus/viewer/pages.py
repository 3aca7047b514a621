"""What needs viser: the server and its pages. Importing this fails where the extra ``viewer`` is not installed."""

from suchus.viewer.apart import WatchedApart
from suchus.viewer.live_page import LivePage
from suchus.viewer.replay_page import ReplayPage
from suchus.viewer.server import CannotServe, Viewer
from suchus.viewer.stage import camera
from suchus.viewer.swim_page import CAMERA as FROM_ABOVE
from suchus.viewer.swim_page import SwimPage, VortexPage
from suchus.viewer.watch_page import WatchedRobot, WatchPage

__all__ = [
    "FROM_ABOVE",
    "CannotServe",
    "LivePage",
    "ReplayPage",
    "SwimPage",
    "Viewer",
    "VortexPage",
    "WatchPage",
    "WatchedApart",
    "WatchedRobot",
    "camera",
]
