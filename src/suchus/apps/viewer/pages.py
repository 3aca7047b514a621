"""What needs viser: the server and its pages. Importing this fails where the extra ``viewer`` is not installed."""

from suchus.apps.viewer.apart import WatchProcess
from suchus.apps.viewer.live_page import LivePage
from suchus.apps.viewer.replay_page import ReplayPage
from suchus.apps.viewer.server import CannotServe, Viewer
from suchus.apps.viewer.stage import camera
from suchus.apps.viewer.swim_page import CAMERA as FROM_ABOVE
from suchus.apps.viewer.swim_page import SwimPage, VortexPage
from suchus.apps.viewer.watch_page import WatchedRobot, WatchPage

__all__ = [
    "FROM_ABOVE",
    "CannotServe",
    "LivePage",
    "ReplayPage",
    "SwimPage",
    "Viewer",
    "VortexPage",
    "WatchPage",
    "WatchProcess",
    "WatchedRobot",
    "camera",
]
